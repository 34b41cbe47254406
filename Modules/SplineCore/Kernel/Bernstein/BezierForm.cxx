// SPDX-License-Identifier: BSD-3-Clause
#include "BezierForm.h"
#include "Bernstein.h"
#include "Parallel.h"

namespace knotwork
{
template <int Dim>
BezierForm<Dim> MakeBezierForm(const Spline<Dim>& spline, int threads)
{
  const SplineSpace<Dim>& space = *spline.Space;
  BezierForm<Dim> form;
  form.Space = spline.Space;
  form.NumComponents = spline.NumComponents();
  form.Rational = spline.IsRational();
  const int planes = form.NumPlanes();

  const std::size_t numElements = space.Elements.size();
  form.Offsets.resize(numElements + 1);
  std::size_t offset = 0;
  for (std::size_t e = 0; e < numElements; ++e)
  {
    form.Offsets[e] = offset;
    offset += static_cast<std::size_t>(planes * NumTensorFunctions<Dim>(space.Elements[e].Degree));
  }
  form.Offsets[numElements] = offset;
  form.Data.resize(offset);

  // A polynomial spline on an identity map is read in place.
  PointMatrix copy;
  const double* coefficients = spline.ControlPoints.data();
  if (form.Rational || !space.IsIdentityMap())
  {
    copy = space.LocalCoefficients(
      form.Rational ? spline.HomogeneousPoints() : spline.ControlPoints, threads);
    coefficients = copy.data();
  }
  ParallelFor(numElements, 256, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const int e = static_cast<int>(i);
        const IntArray<Dim>& degree = space.Elements[i].Degree;
        const int n = NumTensorFunctions<Dim>(degree);
        const int* functions = space.LocalFunctions(e);
        double* block = form.Block(e);
        for (int j = 0; j < n; ++j)
        {
          const double* row = coefficients + static_cast<std::ptrdiff_t>(functions[j]) * planes;
          for (int c = 0; c < planes; ++c)
          {
            block[c * n + j] = row[c];
          }
        }
        const auto factors = space.Factors(e);
        for (int c = 0; c < planes; ++c)
        {
          ApplyFactors<Dim>(degree, factors, block + c * n, block + c * n);
        }
      }
    });
  return form;
}

template BezierForm<1> MakeBezierForm<1>(const Spline<1>&, int);
template BezierForm<2> MakeBezierForm<2>(const Spline<2>&, int);
template BezierForm<3> MakeBezierForm<3>(const Spline<3>&, int);
}
