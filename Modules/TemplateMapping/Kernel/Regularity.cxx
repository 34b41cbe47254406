// SPDX-License-Identifier: BSD-3-Clause
#include "Regularity.h"

#include "BezierForm.h"

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

template Result<Regularity> MeasureRegularity(const BezierForm<2>&, double, std::int64_t, int);
template Result<Regularity> MeasureRegularity(const BezierForm<3>&, double, std::int64_t, int);
}
