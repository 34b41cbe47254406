// SPDX-License-Identifier: BSD-3-Clause
#include "ClampedSpline.h"

#include "TensorSpace.h"

#include <algorithm>

namespace knotwork
{
namespace
{
/// The same in one direction: end knots repeated up to p + 1 times, functions outside the
/// domain dropped.
template <int D>
Result<Spline<D>> ClampedAlong(Spline<D> spline, int direction)
{
  const std::size_t d = static_cast<std::size_t>(direction);
  const KnotVector& knots = spline.Space->Knots[d];
  const int p = knots.Degree();
  const int last = knots.NumElements();
  std::vector<double> missing(
    static_cast<std::size_t>(std::max(0, p + 1 - knots.Multiplicity(0))), knots.Begin());
  missing.insert(missing.end(),
    static_cast<std::size_t>(std::max(0, p + 1 - knots.Multiplicity(last))), knots.End());
  if (!missing.empty())
  {
    auto inserted = InsertKnots<D>(spline, direction, missing);
    if (!inserted)
    {
      return inserted.Status;
    }
    spline = std::move(inserted.Value);
  }
  const KnotVector& full = spline.Space->Knots[d];
  const int firstAlive = full.Span(0) - p;
  const int numAlive = full.Span(full.NumElements() - 1) - firstAlive + 1;
  if (numAlive == full.NumFunctions())
  {
    return spline;
  }
  const auto begin = full.Knots().begin() + firstAlive;
  auto kept = KnotVector::Create(p, std::vector<double>(begin, begin + numAlive + p + 1));
  if (!kept)
  {
    return kept.Status;
  }
  Spline<D> result;
  std::array<KnotVector, D> newKnots = spline.Space->Knots;
  newKnots[d] = kept.Value;
  result.Space = MakeTensorSpace<D>(newKnots).Value;
  result.ControlPoints.resize(result.Space->NumFunctions, spline.ControlPoints.cols());
  result.Weights.resize(spline.IsRational() ? result.Space->NumFunctions : 0);
  std::array<int, D> index{};
  for (Eigen::Index i = 0; i < result.ControlPoints.rows(); ++i)
  {
    int from = 0;
    int stride = 1;
    for (std::size_t k = 0; k < D; ++k)
    {
      from += stride * (index[k] + (k == d ? firstAlive : 0));
      stride *= spline.Space->Knots[k].NumFunctions();
    }
    result.ControlPoints.row(i) = spline.ControlPoints.row(from);
    if (spline.IsRational())
    {
      result.Weights[i] = spline.Weights[from];
    }
    for (std::size_t k = 0; k < D && ++index[k] == newKnots[k].NumFunctions(); ++k)
    {
      index[k] = 0;
    }
  }
  return result;
}
}

template <int Dim>
Result<Spline<Dim>> Clamped(const Spline<Dim>& spline)
{
  Result<Spline<Dim>> result = spline;
  for (int d = 0; d < Dim && result; ++d)
  {
    result = ClampedAlong<Dim>(std::move(result.Value), d);
  }
  return result;
}

template Result<Spline<1>> Clamped<1>(const Spline<1>&);
template Result<Spline<2>> Clamped<2>(const Spline<2>&);
template Result<Spline<3>> Clamped<3>(const Spline<3>&);
}
