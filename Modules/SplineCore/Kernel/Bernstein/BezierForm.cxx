// SPDX-License-Identifier: BSD-3-Clause
#include "BezierForm.h"
#include "Bernstein.h"
#include "Parallel.h"

namespace knotwork
{
template <int Dim>
BezierElements<Dim>::BezierElements(const Spline<Dim>& spline, int threads)
  : Space(spline.Space), Planes(spline.NumComponents() + (spline.IsRational() ? 1 : 0)),
    Coefficients(spline.ControlPoints.data())
{
  // A polynomial spline on an identity map is read in place.
  if (spline.IsRational() || !this->Space->IsIdentityMap())
  {
    this->Copy = this->Space->LocalCoefficients(
      spline.IsRational() ? spline.HomogeneousPoints() : spline.ControlPoints, threads);
    this->Coefficients = this->Copy.data();
  }
}

template <int Dim>
void BezierElements<Dim>::Block(int e, double* block) const
{
  const IntArray<Dim>& degree = this->Space->Elements[static_cast<std::size_t>(e)].Degree;
  const int n = NumTensorFunctions<Dim>(degree);
  const int* functions = this->Space->LocalFunctions(e);
  for (int j = 0; j < n; ++j)
  {
    const double* row =
      this->Coefficients + static_cast<std::ptrdiff_t>(functions[j]) * this->Planes;
    for (int c = 0; c < this->Planes; ++c)
    {
      block[c * n + j] = row[c];
    }
  }
  const auto factors = this->Space->Factors(e);
  for (int c = 0; c < this->Planes; ++c)
  {
    ApplyFactors<Dim>(degree, factors, block + c * n, block + c * n);
  }
}

template <int Dim>
BezierForm<Dim> MakeBezierForm(const Spline<Dim>& spline, int threads)
{
  const SplineSpace<Dim>& space = *spline.Space;
  const BezierElements<Dim> elements(spline, threads);
  BezierForm<Dim> form;
  form.Space = spline.Space;
  form.NumComponents = spline.NumComponents();
  form.Rational = spline.IsRational();

  const std::size_t numElements = space.Elements.size();
  form.Offsets.resize(numElements + 1);
  std::size_t offset = 0;
  for (std::size_t e = 0; e < numElements; ++e)
  {
    form.Offsets[e] = offset;
    offset += static_cast<std::size_t>(
      elements.NumPlanes() * NumTensorFunctions<Dim>(space.Elements[e].Degree));
  }
  form.Offsets[numElements] = offset;
  form.Data.resize(offset);
  ParallelFor(numElements, 256, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        elements.Block(static_cast<int>(i), form.Block(static_cast<int>(i)));
      }
    });
  return form;
}

template class BezierElements<1>;
template class BezierElements<2>;
template class BezierElements<3>;
template BezierForm<1> MakeBezierForm<1>(const Spline<1>&, int);
template BezierForm<2> MakeBezierForm<2>(const Spline<2>&, int);
template BezierForm<3> MakeBezierForm<3>(const Spline<3>&, int);
}
