// SPDX-License-Identifier: BSD-3-Clause
#include "SideSplines.h"

#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/ClampedSpline.h>
#include <knotwork/SplineCore/Recovery.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// Knots closer than this part of the domain are one.
constexpr double KnotTolerance = 1e-12;
/// Weights that agree to this relative difference are one.
constexpr double WeightTolerance = 1e-10;

/// The side with other knots of the same number and multiplicities.
template <int D>
Status ReplaceKnots(Spline<D>& spline, int direction, const std::vector<double>& values)
{
  std::array<KnotVector, D> knots = spline.Space->Knots;
  KnotVector& changed = knots[static_cast<std::size_t>(direction)];
  auto replaced = KnotVector::Create(changed.Degree(), values);
  if (!replaced)
  {
    return replaced.Status;
  }
  changed = replaced.Value;
  spline.Space = MakeTensorSpace<D>(knots).Value;
  return {};
}

/// Breaks and multiplicities of one direction over the sides that have it.
struct CommonKnots
{
  int Degree = 1;
  std::vector<double> Breaks;
  std::vector<int> Multiplicities;
};

/// Index of the common break that a value belongs to. @pre it belongs to one
std::size_t FindBreak(const CommonKnots& common, double value)
{
  std::size_t best = 0;
  for (std::size_t b = 1; b < common.Breaks.size(); ++b)
  {
    if (std::abs(common.Breaks[b] - value) < std::abs(common.Breaks[best] - value))
    {
      best = b;
    }
  }
  return best;
}

/// Every element cut in as many equal parts as minElements ask for, by simple knots.
void Subdivide(CommonKnots& common, int minElements)
{
  const int numElements = static_cast<int>(common.Breaks.size()) - 1;
  const int parts = (minElements + numElements - 1) / numElements;
  CommonKnots cut;
  for (std::size_t b = 0; b < common.Breaks.size(); ++b)
  {
    cut.Breaks.push_back(common.Breaks[b]);
    cut.Multiplicities.push_back(common.Multiplicities[b]);
    for (int i = 1; i < parts && b + 1 < common.Breaks.size(); ++i)
    {
      cut.Breaks.push_back(
        common.Breaks[b] + (common.Breaks[b + 1] - common.Breaks[b]) * i / parts);
      cut.Multiplicities.push_back(1);
    }
  }
  common.Breaks = cut.Breaks;
  common.Multiplicities = cut.Multiplicities;
}
/// One of PreparedSides.
template <int Dim>
Result<Spline<Dim - 1>> PreparedSide(const Spline<Dim - 1>& given)
{
  constexpr int D = Dim - 1;
  if (const Status status = given.Check(); !status)
  {
    return status;
  }
  const int c = given.NumComponents();
  if (given.Space->Kind != SpaceKind::Tensor)
  {
    return { ErrorCode::DimensionMismatch, "sides must be tensor-product splines" };
  }
  if (c != Dim && !(Dim == 2 && c == 3))
  {
    return { ErrorCode::DimensionMismatch,
      std::to_string(c) + " components; sides of this domain have " + std::to_string(Dim) };
  }
  Spline<D> side = given;
  side.ControlPoints = given.ControlPoints.leftCols(Dim);
  if (given.IsRational() && given.Weights.minCoeff() == given.Weights.maxCoeff())
  {
    side.Weights.resize(0);
  }
  auto clamped = Clamped<D>(side);
  if (!clamped)
  {
    return clamped.Status;
  }
  side = std::move(clamped.Value);
  for (int d = 0; d < D; ++d)
  {
    const KnotVector& knots = side.Space->Knots[static_cast<std::size_t>(d)];
    const double begin = knots.Begin();
    const double length = knots.End() - begin;
    std::vector<double> unit = knots.Knots();
    for (double& t : unit)
    {
      t = t == knots.End() ? 1.0 : (t - begin) / length;
    }
    if (const Status status = ReplaceKnots<D>(side, d, unit); !status)
    {
      return status;
    }
  }
  return side;
}
}

std::string GivenSide(int input)
{
  return "side " + std::to_string(input);
}

Status NamedSide(const Status& status, int input)
{
  return { status.Code, GivenSide(input) + ": " + status.Detail };
}

KnotVector ReversedKnots(const KnotVector& knots)
{
  std::vector<double> turned(knots.Knots().rbegin(), knots.Knots().rend());
  for (double& t : turned)
  {
    t = 1.0 - t;
  }
  return KnotVector::Create(knots.Degree(), std::move(turned)).Value;
}

template <int D>
Spline<D> Reoriented(const Spline<D>& spline, const SideOrientation& orientation)
{
  std::array<KnotVector, D> knots;
  std::array<int, D> counts{};
  std::array<int, D> strides{};
  std::array<int, D> oldStride{};
  int stride = 1;
  for (std::size_t d = 0; d < D; ++d)
  {
    oldStride[d] = stride;
    stride *= spline.Space->Knots[d].NumFunctions();
  }
  int first = 0;
  for (std::size_t k = 0; k < D; ++k)
  {
    const std::size_t a = static_cast<std::size_t>(orientation.Axis[k]);
    const KnotVector& old = spline.Space->Knots[a];
    counts[k] = old.NumFunctions();
    strides[k] = oldStride[a];
    knots[k] = old;
    if (orientation.Reversed[k])
    {
      knots[k] = ReversedKnots(old);
      first += strides[k] * (counts[k] - 1);
      strides[k] = -strides[k];
    }
  }
  Spline<D> result;
  result.Space = MakeTensorSpace<D>(knots).Value;
  result.ControlPoints.resize(spline.ControlPoints.rows(), spline.ControlPoints.cols());
  result.Weights.resize(spline.Weights.size());
  std::array<int, D> index{};
  for (Eigen::Index i = 0; i < result.ControlPoints.rows(); ++i)
  {
    int from = first;
    for (std::size_t k = 0; k < D; ++k)
    {
      from += strides[k] * index[k];
    }
    result.ControlPoints.row(i) = spline.ControlPoints.row(from);
    if (spline.IsRational())
    {
      result.Weights[i] = spline.Weights[from];
    }
    for (std::size_t k = 0; k < D && ++index[k] == counts[k]; ++k)
    {
      index[k] = 0;
    }
  }
  return result;
}

template <int Dim>
Result<SideList<Dim>> PreparedSides(const std::vector<Spline<Dim - 1>>& given)
{
  SideList<Dim> list;
  Eigen::Matrix<double, 1, Dim> lower, upper;
  lower.setConstant(std::numeric_limits<double>::infinity());
  upper = -lower;
  double height = 0.0;
  for (std::size_t s = 0; s < given.size(); ++s)
  {
    auto prepared = PreparedSide<Dim>(given[s]);
    if (!prepared)
    {
      return NamedSide(prepared.Status, static_cast<int>(s));
    }
    lower = lower.cwiseMin(prepared->ControlPoints.colwise().minCoeff());
    upper = upper.cwiseMax(prepared->ControlPoints.colwise().maxCoeff());
    const PointMatrix& points = given[s].ControlPoints;
    const double z = points.cols() > Dim ? points(0, Dim) : 0.0;
    height = s == 0 ? z : height;
    if (points.cols() > Dim && ((points.col(Dim).array() != height).any()))
    {
      return { ErrorCode::DimensionMismatch,
        GivenSide(static_cast<int>(s)) + ": the curves do not lie in one plane of constant z" };
    }
    list.Sides.push_back(std::move(prepared.Value));
  }
  list.Size = (upper - lower).norm();
  return list;
}

template <int D>
Result<KnotVector> UniteKnots(
  const std::vector<SideDirection<D>>& users, int minDegree, int minElements)
{
  const auto knotsOf = [](const SideDirection<D>& user) -> const KnotVector&
  { return user.Side->Space->Knots[static_cast<std::size_t>(user.Direction)]; };
  CommonKnots common;
  common.Degree = minDegree;
  for (const auto& user : users)
  {
    common.Degree = std::max(common.Degree, knotsOf(user).Degree());
  }
  std::vector<double> breaks;
  for (const auto& user : users)
  {
    const int times = common.Degree - knotsOf(user).Degree();
    if (times > 0)
    {
      auto elevated = ElevateDegree<D>(*user.Side, user.Direction, times);
      if (!elevated)
      {
        return NamedSide(elevated.Status, user.Input);
      }
      *user.Side = std::move(elevated.Value);
    }
    breaks.insert(breaks.end(), knotsOf(user).Breaks().begin(), knotsOf(user).Breaks().end());
  }
  std::sort(breaks.begin(), breaks.end());
  for (double b : breaks)
  {
    if (common.Breaks.empty() || b - common.Breaks.back() > KnotTolerance)
    {
      common.Breaks.push_back(b);
    }
  }
  common.Breaks.back() = 1.0;
  common.Multiplicities.assign(common.Breaks.size(), 0);
  for (const auto& user : users) // the sides' own numbers become the common ones
  {
    std::vector<double> snapped = knotsOf(user).Knots();
    for (double& t : snapped)
    {
      t = common.Breaks[FindBreak(common, t)];
    }
    for (std::size_t b = 0; b < common.Breaks.size(); ++b)
    {
      common.Multiplicities[b] = std::max(common.Multiplicities[b],
        static_cast<int>(std::count(snapped.begin(), snapped.end(), common.Breaks[b])));
    }
    if (const Status status = ReplaceKnots<D>(*user.Side, user.Direction, snapped); !status)
    {
      return NamedSide(status, user.Input);
    }
  }
  Subdivide(common, minElements);
  for (const auto& user : users)
  {
    std::vector<double> missing;
    const std::vector<double> present = knotsOf(user).Knots();
    for (std::size_t b = 0; b < common.Breaks.size(); ++b)
    {
      const auto count = std::count(present.begin(), present.end(), common.Breaks[b]);
      missing.insert(missing.end(),
        static_cast<std::size_t>(common.Multiplicities[b]) - static_cast<std::size_t>(count),
        common.Breaks[b]);
    }
    if (!missing.empty())
    {
      auto inserted = InsertKnots<D>(*user.Side, user.Direction, missing);
      if (!inserted)
      {
        return NamedSide(inserted.Status, user.Input);
      }
      *user.Side = std::move(inserted.Value);
    }
  }
  return knotsOf(users.front());
}
bool SameWeight(double a, double b)
{
  return std::abs(a - b) <= WeightTolerance * std::max(a, b);
}

template <int D>
void MakeRational(Spline<D>& side)
{
  if (!side.IsRational())
  {
    side.Weights = Eigen::VectorXd::Ones(side.Space->NumFunctions);
  }
}

Result<Spline<1>> TimesLinear(const Spline<1>& curve, double ratio)
{
  Spline<1> homogeneous;
  homogeneous.Space = curve.Space;
  homogeneous.ControlPoints = curve.HomogeneousPoints();
  auto elevated = ElevateDegree<1>(homogeneous, 0, 1);
  if (!elevated)
  {
    return elevated.Status;
  }
  const BezierForm<1> low = MakeBezierForm<1>(homogeneous, 1);
  BezierForm<1> high = MakeBezierForm<1>(elevated.Value, 1);
  const int p = curve.Space->Knots[0].Degree();
  for (int e = 0; e < curve.Space->NumElements(); ++e)
  {
    const auto& box = curve.Space->Elements[static_cast<std::size_t>(e)].Box;
    const std::vector<double> factor{ 1.0 + (ratio - 1.0) * box.Lower[0],
      1.0 + (ratio - 1.0) * box.Upper[0] };
    for (int c = 0; c < low.NumComponents; ++c)
    {
      const double* block = low.Block(e) + c * (p + 1);
      const std::vector<double> product =
        BernsteinProduct<1>({ p }, std::vector<double>(block, block + p + 1), { 1 }, factor);
      std::copy(product.begin(), product.end(), high.Block(e) + c * (p + 2));
    }
  }
  auto recovered = RecoverSpline<1>(high, 1);
  if (!recovered)
  {
    return recovered.Status;
  }
  Spline<1> result;
  result.Space = recovered.Value.Space;
  result.SetHomogeneousPoints(recovered.Value.ControlPoints, true);
  if (!(result.Weights.minCoeff() > 0.0))
  {
    return { ErrorCode::InvalidWeight,
      "weights at the corners fit no common map: the product with a linear function has a weight "
      "that is not positive" };
  }
  return result;
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Result<SideList<Dim>> PreparedSides<Dim>(const std::vector<Spline<Dim - 1>>&);          \
  template Spline<Dim - 1> Reoriented<Dim - 1>(const Spline<Dim - 1>&, const SideOrientation&);    \
  template Result<KnotVector> UniteKnots<Dim - 1>(                                                 \
    const std::vector<SideDirection<Dim - 1>>&, int, int);                                         \
  template void MakeRational<Dim - 1>(Spline<Dim - 1>&);
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
