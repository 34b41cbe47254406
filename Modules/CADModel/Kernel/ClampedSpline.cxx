// SPDX-License-Identifier: BSD-3-Clause
#include "ClampedSpline.h"

#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>

namespace knotwork
{
template <int Dim>
Result<Spline<Dim>> Clamped(const Spline<Dim>& spline)
{
  Spline<Dim> result = spline;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const KnotVector& old = result.Space->Knots[d];
    const int order = old.Degree() + 1;
    std::vector<double> missing;
    missing.insert(
      missing.end(), static_cast<std::size_t>(order - old.Multiplicity(0)), old.Begin());
    missing.insert(missing.end(),
      static_cast<std::size_t>(order - old.Multiplicity(old.NumElements())), old.End());
    if (missing.empty())
    {
      continue;
    }
    auto inserted = InsertKnots<Dim>(result, static_cast<int>(d), missing);
    if (!inserted)
    {
      return inserted.Status;
    }
    // the functions between the first and the last clamped knots are what the domain needs
    const std::vector<double>& all = inserted->Space->Knots[d].Knots();
    const auto first = std::lower_bound(all.begin(), all.end(), old.Begin());
    const auto last = std::upper_bound(all.begin(), all.end(), old.End());
    auto knots = inserted->Space->Knots;
    const int oldCount = knots[d].NumFunctions();
    auto inner = KnotVector::Create(old.Degree(), { first, last });
    if (!inner)
    {
      return inner.Status;
    }
    knots[d] = inner.Value;
    const auto space = MakeTensorSpace<Dim>(knots);
    if (!space)
    {
      return space.Status;
    }
    int stride = 1;
    for (std::size_t e = 0; e < d; ++e)
    {
      stride *= knots[e].NumFunctions();
    }
    const int newCount = knots[d].NumFunctions();
    const int offset = static_cast<int>(first - all.begin());
    const PointMatrix points = inserted->HomogeneousPoints();
    PointMatrix kept(space.Value->NumFunctions, points.cols());
    for (int row = 0; row < space.Value->NumFunctions; ++row)
    {
      const int index = row / stride % newCount;
      const int block = row / (stride * newCount);
      kept.row(row) = points.row((block * oldCount + index + offset) * stride + row % stride);
    }
    Spline<Dim> next;
    next.Space = space.Value;
    next.SetHomogeneousPoints(kept, result.IsRational());
    result = std::move(next);
  }
  return result;
}

template Result<Spline<1>> Clamped<1>(const Spline<1>&);
template Result<Spline<2>> Clamped<2>(const Spline<2>&);
template Result<Spline<3>> Clamped<3>(const Spline<3>&);
}
