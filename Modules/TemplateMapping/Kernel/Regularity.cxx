// SPDX-License-Identifier: BSD-3-Clause
#include "Regularity.h"

#include <knotwork/SplineCore/BezierForm.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
double Regularity::Bound() const
{
  return *std::min_element(this->MinLower.begin(), this->MinLower.end());
}

template <int Dim>
Result<Regularity> MeasureRegularity(
  const BezierForm<Dim>& form, double relativeGap, std::int64_t maxBoxes, int threads)
{
  JacobianParams params;
  params.RelativeGap = relativeGap;
  params.MaxBoxes = maxBoxes;
  params.Threads = threads;
  auto certificate = ValidateJacobian(MakeBernsteinCells<Dim>(form), params);
  if (!certificate)
  {
    return certificate.Status;
  }
  Regularity regularity;
  const auto& elements = form.Space->Elements;
  regularity.MinLower.resize(elements.size());
  regularity.MaxUpper.resize(elements.size());
  for (std::size_t e = 0; e < elements.size(); ++e)
  {
    double volume = 1.0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      volume *= elements[e].Box.Upper[d] - elements[e].Box.Lower[d];
    }
    const CellCertificate& cell = certificate->Cells[e];
    const double lower = cell.MinLower / volume;
    const double upper = cell.MaxUpper / volume;
    // volume and quotient round by less than one part in 2^50
    regularity.MinLower[e] = lower - 0x1p-50 * std::abs(lower);
    regularity.MaxUpper[e] = upper + 0x1p-50 * std::abs(upper);
  }
  regularity.Certificate = std::move(certificate.Value);
  return regularity;
}

template <int Dim>
Result<InjectivityCertificate> ProveMapInjectivity(const BezierForm<Dim>& form,
  const JacobianCertificate& certificate, std::int64_t maxBoxes, int threads)
{
  const auto& elements = form.Space->Elements;
  CellComplex complex;
  complex.Patches.assign(elements.size(), 0);
  complex.Boxes.resize(elements.size());
  for (std::size_t e = 0; e < elements.size(); ++e)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      complex.Boxes[e].Lower[d] = elements[e].Box.Lower[d];
      complex.Boxes[e].Upper[d] = elements[e].Box.Upper[d];
    }
  }
  InjectivityParams params;
  params.MaxBoxes = maxBoxes;
  params.Threads = threads;
  return ProveInjectivity(MakeBernsteinCells<Dim>(form), complex, certificate, params);
}

template Result<Regularity> MeasureRegularity(const BezierForm<2>&, double, std::int64_t, int);
template Result<Regularity> MeasureRegularity(const BezierForm<3>&, double, std::int64_t, int);
template Result<InjectivityCertificate> ProveMapInjectivity(
  const BezierForm<2>&, const JacobianCertificate&, std::int64_t, int);
template Result<InjectivityCertificate> ProveMapInjectivity(
  const BezierForm<3>&, const JacobianCertificate&, std::int64_t, int);
}
