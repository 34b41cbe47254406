// SPDX-License-Identifier: BSD-3-Clause
#include "TensorRestriction.h"
#include "TensorSpace.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// New control points along one direction as convex combinations of the old ones.
using LineOperator = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Adds to row `row` the blossom, at p arguments, of the polynomial piece that begins
/// at knot `from` or contains it, as a combination of the control points. When the arguments are
/// consecutive knots of a refinement the weights are discrete B-splines, non-negative at every
/// step.
/// @source  Cohen, Lyche, Riesenfeld, Computer Graphics and Image Processing 14 (1980) 87-111.
void AddBlossom(
  const KnotVector& knots, double from, const double* arguments, int row, Triplets& triplets)
{
  const std::vector<double>& t = knots.Knots();
  const int p = knots.Degree();
  const int numKnots = static_cast<int>(t.size());
  const int mu = static_cast<int>(std::upper_bound(t.begin(), t.end(), from) - t.begin()) - 1;
  double alpha[MaxDegree + 1] = { 1.0 }; // after step k alpha[i] belongs to function mu - k + i
  for (int k = 1; k <= p; ++k)
  {
    const double v = arguments[k - 1];
    double saved = 0.0;
    for (int i = 0; i < k; ++i)
    {
      const int lower = mu - k + 1 + i; // the function of degree k - 1 lives on [t_lower, t_upper]
      const int upper = lower + k;
      double ratio = 0.0; // a function that reaches beyond the knots does not exist
      double rise = 0.0;
      double fall = 0.0;
      if (lower >= 0 && upper < numKnots)
      {
        const double begin = t[static_cast<std::size_t>(lower)];
        const double end = t[static_cast<std::size_t>(upper)];
        ratio = alpha[i] / (end - begin);
        rise = v - begin;
        fall = end - v;
      }
      alpha[i] = saved + fall * ratio;
      saved = rise * ratio;
    }
    alpha[k] = saved;
  }
  for (int i = 0; i <= p; ++i)
  {
    const int function = mu - p + i;
    if (function >= 0 && function < knots.NumFunctions() && alpha[i] != 0.0)
    {
      triplets.emplace_back(row, function, alpha[i]);
    }
  }
}

LineOperator MakeOperator(int rows, int columns, const Triplets& triplets)
{
  LineOperator result(rows, columns);
  result.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

LineOperator InsertionOperator(const KnotVector& coarse, const KnotVector& fine)
{
  Triplets triplets;
  for (int j = 0; j < fine.NumFunctions(); ++j)
  {
    const double* knots = fine.Knots().data() + j;
    AddBlossom(coarse, knots[0], knots + 1, j, triplets);
  }
  return MakeOperator(fine.NumFunctions(), coarse.NumFunctions(), triplets);
}

/// Control point j of the elevated spline is the mean of the old blossom over the p + 1 ways to
/// leave one knot out of t'_{j+1} ... t'_{j+p+1}.
/// @source  Prautzsch, CAGD 1 (1984) 193-198; Goldman & Barry (blossoming).
LineOperator ElevationOperator(const KnotVector& low, const KnotVector& high)
{
  const int q = high.Degree();
  Triplets triplets;
  double arguments[MaxDegree];
  for (int j = 0; j < high.NumFunctions(); ++j)
  {
    const double* knots = high.Knots().data() + j;
    for (int left = 1; left <= q; ++left)
    {
      std::copy(knots + 1, knots + left, arguments);
      std::copy(knots + left + 1, knots + q + 1, arguments + left - 1);
      AddBlossom(low, knots[0], arguments, j, triplets);
    }
  }
  // dividing last keeps rows of a single point exact
  return MakeOperator(high.NumFunctions(), low.NumFunctions(), triplets) / q;
}

/// Knots for one degree more: every multiplicity grows by one. Beyond the domain's ends only as
/// many knots stay as the first and last functions need, so that the domain does not change.
Result<KnotVector> ElevatedKnots(const KnotVector& knots)
{
  std::vector<double> elevated;
  for (std::size_t i = 0; i < knots.Knots().size(); ++i)
  {
    const double u = knots.Knots()[i];
    elevated.push_back(u);
    if (i + 1 == knots.Knots().size() || knots.Knots()[i + 1] != u)
    {
      elevated.push_back(u);
    }
  }
  const auto begin = std::upper_bound(elevated.begin(), elevated.end(), knots.Begin());
  const auto end = std::lower_bound(elevated.begin(), elevated.end(), knots.End());
  const int order = knots.Degree() + 2;
  return KnotVector::Create(knots.Degree() + 1, std::vector<double>(begin - order, end + order));
}

/// The spline whose control points along a direction are operator times the old ones.
template <int Dim>
Result<Spline<Dim>> ApplyAlong(const Spline<Dim>& spline, std::size_t direction,
  const KnotVector& knots, const LineOperator& lineOperator)
{
  std::array<KnotVector, Dim> newKnots = spline.Space->Knots;
  Eigen::Index stride = 1;
  for (std::size_t d = 0; d < direction; ++d)
  {
    stride *= newKnots[d].NumFunctions();
  }
  newKnots[direction] = knots;
  auto space = MakeTensorSpace<Dim>(newKnots);
  if (!space)
  {
    return space.Status;
  }
  // rows of points with equal indices above the direction form one n x (stride * c) matrix
  const PointMatrix points = spline.HomogeneousPoints();
  const Eigen::Index rows = lineOperator.rows();
  const Eigen::Index columns = lineOperator.cols();
  const Eigen::Index width = stride * points.cols();
  PointMatrix newPoints(space.Value->NumFunctions, points.cols());
  for (Eigen::Index block = 0; block < points.rows() / (stride * columns); ++block)
  {
    const Eigen::Map<const PointMatrix> from(
      points.data() + block * columns * width, columns, width);
    Eigen::Map<PointMatrix>(newPoints.data() + block * rows * width, rows, width).noalias() =
      lineOperator * from;
  }
  Spline<Dim> result;
  result.Space = std::move(space.Value);
  result.SetHomogeneousPoints(newPoints, spline.IsRational());
  return result;
}

template <int Dim>
Status CheckInput(const Spline<Dim>& spline, int direction)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  if (spline.Space->Kind != SpaceKind::Tensor)
  {
    return { ErrorCode::DimensionMismatch, "the space is not a tensor product of knot vectors" };
  }
  if (direction < 0 || direction >= Dim)
  {
    return { ErrorCode::InvalidParameter,
      "direction " + std::to_string(direction) + " of a spline with " + std::to_string(Dim) };
  }
  return {};
}
}

template <int Dim>
Result<Spline<Dim>> InsertKnots(
  const Spline<Dim>& spline, int direction, const std::vector<double>& knots)
{
  if (Status status = CheckInput(spline, direction); !status)
  {
    return status;
  }
  const std::size_t d = static_cast<std::size_t>(direction);
  const KnotVector& coarse = spline.Space->Knots[d];
  for (std::size_t i = 0; i < knots.size(); ++i)
  {
    if (!std::isfinite(knots[i]))
    {
      return { ErrorCode::NonFiniteInput, "inserted knot " + std::to_string(i) };
    }
    if (knots[i] < coarse.Begin() || knots[i] > coarse.End())
    {
      return { ErrorCode::OutsideDomain, "inserted knot " + std::to_string(i) };
    }
  }
  if (knots.empty())
  {
    return spline;
  }
  std::vector<double> merged = coarse.Knots();
  merged.insert(merged.end(), knots.begin(), knots.end());
  std::sort(merged.begin(), merged.end());
  const auto fine = KnotVector::Create(coarse.Degree(), std::move(merged));
  if (!fine)
  {
    return fine.Status;
  }
  return ApplyAlong(spline, d, fine.Value, InsertionOperator(coarse, fine.Value));
}

template <int Dim>
Result<Spline<Dim>> ElevateDegree(const Spline<Dim>& spline, int direction, int times)
{
  if (Status status = CheckInput(spline, direction); !status)
  {
    return status;
  }
  const std::size_t d = static_cast<std::size_t>(direction);
  if (times < 0)
  {
    return { ErrorCode::InvalidParameter, std::to_string(times) + " elevations" };
  }
  const int degree = spline.Space->Knots[d].Degree();
  if (times > MaxDegree - degree)
  {
    return { ErrorCode::InvalidDegree,
      "degree " + std::to_string(degree) + " raised " + std::to_string(times) + " times" };
  }
  KnotVector knots = spline.Space->Knots[d];
  LineOperator lineOperator(knots.NumFunctions(), knots.NumFunctions());
  lineOperator.setIdentity();
  for (int i = 0; i < times; ++i)
  {
    auto elevated = ElevatedKnots(knots);
    if (!elevated)
    {
      return elevated.Status;
    }
    lineOperator = LineOperator(ElevationOperator(knots, elevated.Value) * lineOperator);
    knots = std::move(elevated.Value);
  }
  return times == 0 ? Result<Spline<Dim>>(spline) : ApplyAlong(spline, d, knots, lineOperator);
}

template <int Dim>
Result<Spline<Dim>> RestrictTensor(const Spline<Dim>& spline, const ParametricBox<Dim>& box)
{
  if (Status status = CheckInput(spline, 0); !status)
  {
    return status;
  }
  Spline<Dim> result = spline;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const KnotVector& knots = spline.Space->Knots[d];
    const double tolerance = 1e-12 * (knots.End() - knots.Begin());
    const auto snapped = [&](double end)
    {
      const std::vector<double>& breaks = knots.Breaks();
      const auto near = std::min_element(breaks.begin(), breaks.end(),
        [end](double a, double b) { return std::fabs(a - end) < std::fabs(b - end); });
      return std::fabs(*near - end) <= tolerance ? *near : end;
    };
    const double low = snapped(box.Lower[d]);
    const double high = snapped(box.Upper[d]);
    if (!(knots.Begin() <= low && low < high && high <= knots.End()))
    {
      return { ErrorCode::OutsideDomain, "the box in direction " + std::to_string(d) };
    }
    const auto order = static_cast<std::size_t>(knots.Degree() + 1);
    std::vector<double> inside(order, low);
    std::copy_if(knots.Knots().begin(), knots.Knots().end(), std::back_inserter(inside),
      [&](double t) { return low < t && t < high; });
    inside.insert(inside.end(), order, high);
    if (inside == knots.Knots())
    {
      continue;
    }
    const auto fine = KnotVector::Create(knots.Degree(), std::move(inside));
    if (!fine)
    {
      return fine.Status;
    }
    auto part = ApplyAlong(result, d, fine.Value, InsertionOperator(knots, fine.Value));
    if (!part)
    {
      return part.Status;
    }
    result = std::move(part.Value);
  }
  return result;
}

template <int Dim>
PointMatrix GrevillePoints(const SplineSpace<Dim>& space)
{
  PointMatrix points(space.NumFunctions, Dim);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    int rest = static_cast<int>(i);
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const KnotVector& knots = space.Knots[d];
      points(i, static_cast<Eigen::Index>(d)) = knots.Greville(rest % knots.NumFunctions());
      rest /= knots.NumFunctions();
    }
  }
  return points;
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Result<Spline<Dim>> InsertKnots<Dim>(                                                   \
    const Spline<Dim>&, int, const std::vector<double>&);                                          \
  template Result<Spline<Dim>> ElevateDegree<Dim>(const Spline<Dim>&, int, int);                   \
  template Result<Spline<Dim>> RestrictTensor<Dim>(const Spline<Dim>&, const ParametricBox<Dim>&); \
  template PointMatrix GrevillePoints<Dim>(const SplineSpace<Dim>&);

KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
