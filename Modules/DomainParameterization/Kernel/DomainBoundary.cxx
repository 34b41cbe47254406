// SPDX-License-Identifier: BSD-3-Clause
#include "DomainBoundary.h"

#include "Bernstein.h"
#include "BezierForm.h"
#include "DomainMeasure.h"
#include "NumberText.h"
#include "Recovery.h"
#include "TensorSpace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
/// Knots closer than this part of the domain are one.
constexpr double KnotTolerance = 1e-12;
/// Weights that agree to this relative difference are one.
constexpr double WeightTolerance = 1e-10;

std::string Given(int side)
{
  return "side " + std::to_string(side);
}

Status Named(const Status& status, int side)
{
  return { status.Code, Given(side) + ": " + status.Detail };
}

/// Directions of the map that side 2 d + e has: all but d, increasing.
template <int Dim>
std::array<int, Dim - 1> SideDirections(int side)
{
  std::array<int, Dim - 1> directions{};
  int k = 0;
  for (int d = 0; d < Dim; ++d)
  {
    if (d != side / 2)
    {
      directions[static_cast<std::size_t>(k++)] = d;
    }
  }
  return directions;
}

/// The same side with other directions: new direction k is old direction axis[k], run backwards
/// when reversed[k] (knots t become begin + end - t; here the domain is [0, 1]).
template <int D>
Spline<D> Reoriented(
  const Spline<D>& spline, const std::array<int, D>& axis, const std::array<bool, D>& reversed)
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
    const std::size_t a = static_cast<std::size_t>(axis[k]);
    const KnotVector& old = spline.Space->Knots[a];
    counts[k] = old.NumFunctions();
    strides[k] = oldStride[a];
    knots[k] = old;
    if (reversed[k])
    {
      std::vector<double> turned(old.Knots().rbegin(), old.Knots().rend());
      for (double& t : turned)
      {
        t = 1.0 - t;
      }
      knots[k] = KnotVector::Create(old.Degree(), std::move(turned)).Value;
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

/// Control point of a corner; bit k of corner is the end in direction k.
template <int D>
int CornerFunction(const SplineSpace<D>& space, int corner)
{
  int function = 0;
  int stride = 1;
  for (int k = 0; k < D; ++k)
  {
    const int n = space.Knots[static_cast<std::size_t>(k)].NumFunctions();
    function += (corner >> k & 1) ? stride * (n - 1) : 0;
    stride *= n;
  }
  return function;
}

/// Both ends of a direction interpolated: knots repeated up to p + 1 times, functions outside the
/// domain dropped.
template <int D>
Result<Spline<D>> Clamped(Spline<D> spline, int direction)
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

/// A given side, checked, with Dim components, clamped on [0, 1]^D, without weights that do
/// nothing.
template <int Dim>
Result<Spline<Dim - 1>> Prepared(const Spline<Dim - 1>& given)
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
  for (int d = 0; d < D; ++d)
  {
    auto clamped = Clamped<D>(std::move(side), d);
    if (!clamped)
    {
      return clamped.Status;
    }
    side = std::move(clamped.Value);
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

template <int Dim>
struct Arrangement
{
  std::array<SideOrigin<Dim>, 2 * Dim> Sides;
  double Gap = std::numeric_limits<double>::infinity();
};

/// All ways a side can lie: axis permutations and reversals, the given one first.
template <int Dim>
std::vector<SideOrigin<Dim>> Orientations()
{
  constexpr int D = Dim - 1;
  std::vector<SideOrigin<Dim>> all;
  for (int swap = 0; swap < D; ++swap)
  {
    for (int flips = 0; flips < (1 << D); ++flips)
    {
      SideOrigin<Dim> origin;
      for (int k = 0; k < D; ++k)
      {
        origin.Axis[static_cast<std::size_t>(k)] = swap ? D - 1 - k : k;
        origin.Reversed[static_cast<std::size_t>(k)] = (flips >> k & 1) != 0;
      }
      all.push_back(origin);
    }
  }
  return all;
}

/// Corner of the given side that lies at corner `corner` of the map's side.
template <int Dim>
int GivenCorner(const SideOrigin<Dim>& origin, int corner)
{
  int given = 0;
  for (std::size_t k = 0; k < Dim - 1; ++k)
  {
    const bool upper = (corner >> k & 1) != 0;
    given |= static_cast<int>(upper != origin.Reversed[k]) << origin.Axis[k];
  }
  return given;
}

/// Corner of the map (bit d: the end in direction d) of a corner of its side.
template <int Dim>
int MapCorner(int side, int sideCorner)
{
  const auto directions = SideDirections<Dim>(side);
  int corner = (side % 2) << (side / 2);
  for (std::size_t k = 0; k < Dim - 1; ++k)
  {
    corner |= (sideCorner >> k & 1) << directions[k];
  }
  return corner;
}

template <int Dim>
class Matcher
{
public:
  using Point = Eigen::Matrix<double, 1, Dim>;
  /// Corner points of every given side.
  std::vector<std::array<Point, 1 << (Dim - 1)>> Corners;
  double Significant = 0.0; ///< smaller differences of gaps do not count

  /// The arrangement with the smallest gap; among equals the first in the order of the sides.
  Arrangement<Dim> Find()
  {
    this->All = Orientations<Dim>();
    this->Used.assign(this->Corners.size(), false);
    this->Known.fill(false);
    SideOrigin<Dim> first = this->All.front();
    first.Input = 0;
    this->Used[0] = true;
    const auto saved = this->Known;
    this->Place(0, first);
    this->Extend(0, 0.0);
    this->Known = saved;
    return this->Best;
  }

private:
  // After side 0 the sides that touch it, then the opposite one: each but the first is constrained
  // by corners already known.
  static int Role(std::size_t step)
  {
    return static_cast<int>(step) + 2 < 2 * Dim ? static_cast<int>(step) + 2 : 1;
  }

  /// Gap that a side would leave to the corners known so far; its own corners become known.
  double Place(int role, const SideOrigin<Dim>& origin)
  {
    this->Current.Sides[static_cast<std::size_t>(role)] = origin;
    double gap = 0.0;
    for (int c = 0; c < (1 << (Dim - 1)); ++c)
    {
      const std::size_t corner = static_cast<std::size_t>(MapCorner<Dim>(role, c));
      const Point& point = this->Corners[static_cast<std::size_t>(origin.Input)]
                                        [static_cast<std::size_t>(GivenCorner<Dim>(origin, c))];
      if (this->Known[corner])
      {
        gap = std::max(gap, (point - this->Points[corner]).norm());
      }
      else
      {
        this->Known[corner] = true;
        this->Points[corner] = point;
      }
    }
    return gap;
  }

  void Extend(std::size_t step, double gap)
  {
    if (step + 1 == 2 * Dim)
    {
      if (gap < this->Best.Gap - this->Significant)
      {
        this->Best = this->Current;
        this->Best.Gap = gap;
      }
      return;
    }
    // candidates in the order of the roles, so that sides given in this order keep theirs
    for (std::size_t shift = 0; shift < this->Used.size(); ++shift)
    {
      const std::size_t input = (static_cast<std::size_t>(Role(step)) + shift) % this->Used.size();
      if (this->Used[input])
      {
        continue;
      }
      this->Used[input] = true;
      for (SideOrigin<Dim> origin : this->All)
      {
        origin.Input = static_cast<int>(input);
        const auto known = this->Known;
        const auto points = this->Points;
        const double grown = std::max(gap, this->Place(Role(step), origin));
        if (grown < this->Best.Gap - this->Significant)
        {
          this->Extend(step + 1, grown);
        }
        this->Known = known;
        this->Points = points;
      }
      this->Used[input] = false;
    }
  }

  std::vector<SideOrigin<Dim>> All;
  std::vector<bool> Used;
  std::array<bool, (1 << Dim)> Known{};
  std::array<Point, (1 << Dim)> Points;
  Arrangement<Dim> Current;
  Arrangement<Dim> Best;
};

template <int Dim>
std::string CornerName(int corner)
{
  constexpr const char* names = "uvw";
  std::string text = "(";
  for (int d = 0; d < Dim; ++d)
  {
    text += std::string(d ? ", " : "") + names[d] + " = " + ((corner >> d & 1) ? "1" : "0");
  }
  return text + ")";
}

/// The largest distance between two sides at one corner, as an error.
template <int Dim>
Status GapError(const std::array<Spline<Dim - 1>, 2 * Dim>& sides,
  const std::array<SideOrigin<Dim>, 2 * Dim>& origins, double tolerance)
{
  double worst = -1.0;
  std::string detail;
  for (int a = 0; a < 2 * Dim; ++a)
  {
    for (int b = a + 1; b < 2 * Dim; ++b)
    {
      for (int i = 0; i < (1 << (Dim - 1)); ++i)
      {
        for (int j = 0; j < (1 << (Dim - 1)); ++j)
        {
          const int corner = MapCorner<Dim>(a, i);
          if (corner != MapCorner<Dim>(b, j))
          {
            continue;
          }
          const Spline<Dim - 1>& sideA = sides[static_cast<std::size_t>(a)];
          const Spline<Dim - 1>& sideB = sides[static_cast<std::size_t>(b)];
          const auto pointA = sideA.ControlPoints.row(CornerFunction(*sideA.Space, i));
          const auto pointB = sideB.ControlPoints.row(CornerFunction(*sideB.Space, j));
          const double distance = (pointA - pointB).norm();
          if (distance > worst)
          {
            worst = distance;
            detail = "gap of " + NumberText(distance) + " (allowed " + NumberText(tolerance) +
              ") at the corner " + CornerName<Dim>(corner) + " between " +
              Given(origins[static_cast<std::size_t>(a)].Input) + " and " +
              Given(origins[static_cast<std::size_t>(b)].Input) + ", near (";
            for (int c = 0; c < Dim; ++c)
            {
              detail += (c ? ", " : "") + NumberText(pointA[c]);
            }
            detail += ")";
          }
        }
      }
    }
  }
  return { ErrorCode::InvalidTopology, detail };
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

/// Brings all sides to the same degree and knots in each direction of the map.
template <int Dim>
Status MergeKnots(std::array<Spline<Dim - 1>, 2 * Dim>& sides,
  const std::array<SideOrigin<Dim>, 2 * Dim>& origins, std::array<KnotVector, Dim>& knots)
{
  constexpr int D = Dim - 1;
  for (int d = 0; d < Dim; ++d)
  {
    std::vector<std::pair<std::size_t, int>> users; // side and its direction
    for (int s = 0; s < 2 * Dim; ++s)
    {
      const auto directions = SideDirections<Dim>(s);
      for (int k = 0; k < D; ++k)
      {
        if (directions[static_cast<std::size_t>(k)] == d)
        {
          users.emplace_back(static_cast<std::size_t>(s), k);
        }
      }
    }
    const auto knotsOf = [&](const std::pair<std::size_t, int>& user) -> const KnotVector&
    { return sides[user.first].Space->Knots[static_cast<std::size_t>(user.second)]; };
    CommonKnots common;
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
        auto elevated = ElevateDegree<D>(sides[user.first], user.second, times);
        if (!elevated)
        {
          return Named(elevated.Status, origins[user.first].Input);
        }
        sides[user.first] = std::move(elevated.Value);
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
      const KnotVector& own = knotsOf(user);
      std::vector<double> snapped = own.Knots();
      for (double& t : snapped)
      {
        t = common.Breaks[FindBreak(common, t)];
      }
      for (std::size_t b = 0; b < common.Breaks.size(); ++b)
      {
        common.Multiplicities[b] = std::max(common.Multiplicities[b],
          static_cast<int>(std::count(snapped.begin(), snapped.end(), common.Breaks[b])));
      }
      if (const Status status = ReplaceKnots<D>(sides[user.first], user.second, snapped); !status)
      {
        return Named(status, origins[user.first].Input);
      }
    }
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
        auto inserted = InsertKnots<D>(sides[user.first], user.second, missing);
        if (!inserted)
        {
          return Named(inserted.Status, origins[user.first].Input);
        }
        sides[user.first] = std::move(inserted.Value);
      }
    }
    knots[static_cast<std::size_t>(d)] = knotsOf(users.front());
  }
  return {};
}

/// Numerator and denominator of a curve on [0, 1] times the linear function from 1 to ratio: the
/// same points at the same parameters, one degree more.
/// Homogeneous, so a polynomial curve of three components goes in and out.
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
  auto recovered = RecoverSpline<1>(high);
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

template <int D>
void MakeRational(Spline<D>& side)
{
  if (!side.IsRational())
  {
    side.Weights = Eigen::VectorXd::Ones(side.Space->NumFunctions);
  }
}

bool SameWeight(double a, double b)
{
  return std::abs(a - b) <= WeightTolerance * std::max(a, b);
}

/// Weights of curves that meet become equal at the corners.
Status MatchWeights(std::array<Spline<1>, 4>& sides, const std::array<SideOrigin<2>, 4>& origins)
{
  for (Spline<1>& side : sides)
  {
    MakeRational(side);
  }
  const auto begin = [&](std::size_t s) { return sides[s].Weights[0]; };
  const auto end = [&](std::size_t s) { return sides[s].Weights[sides[s].Weights.size() - 1]; };
  // a factor of exactly 1 leaves every bit as it is
  sides[2].Weights *= begin(0) / begin(2);
  sides[3].Weights *= end(0) / begin(3);
  sides[1].Weights *= end(2) / begin(1);
  if (!SameWeight(end(1), end(3)))
  {
    auto product = TimesLinear(sides[1], end(3) / end(1));
    if (!product)
    {
      return Named(product.Status, origins[1].Input);
    }
    sides[1] = std::move(product.Value);
  }
  return {};
}

/// A constant factor a face makes the weights at the corners equal; edges are compared later.
Status MatchWeights(std::array<Spline<2>, 6>& sides, const std::array<SideOrigin<3>, 6>&)
{
  for (Spline<2>& side : sides)
  {
    MakeRational(side);
  }
  const auto corner = [&](std::size_t s, int c)
  { return sides[s].Weights[CornerFunction(*sides[s].Space, c)]; };
  const double w000 = corner(0, 0);
  const double w010 = corner(0, 1);
  const double w001 = corner(0, 2);
  sides[2].Weights *= w000 / corner(2, 0);
  sides[3].Weights *= w010 / corner(3, 0);
  sides[4].Weights *= w000 / corner(4, 0);
  sides[5].Weights *= w001 / corner(5, 0);
  sides[1].Weights *= corner(2, 1) / corner(1, 0);
  return {};
}

/// Rows of control points that sides share become the same bits: those of the side with the lower
/// number. @return the largest distance and relative weight difference that were closed.
template <int Dim>
Status ShareRows(CompatibleBoundary<Dim>& boundary, double tolerance)
{
  constexpr int D = Dim - 1;
  std::array<int, Dim> counts{};
  for (std::size_t d = 0; d < Dim; ++d)
  {
    counts[d] = boundary.Knots[d].NumFunctions();
  }
  for (int s = 1; s < 2 * Dim; ++s)
  {
    Spline<D>& side = boundary.Sides[static_cast<std::size_t>(s)];
    const auto directions = SideDirections<Dim>(s);
    std::array<int, Dim> index{};
    index[static_cast<std::size_t>(s / 2)] =
      s % 2 ? counts[static_cast<std::size_t>(s / 2)] - 1 : 0;
    for (Eigen::Index i = 0; i < side.ControlPoints.rows(); ++i)
    {
      Eigen::Index rest = i;
      for (int k : directions)
      {
        const std::size_t d = static_cast<std::size_t>(k);
        index[d] = static_cast<int>(rest % counts[d]);
        rest /= counts[d];
      }
      for (int o = 0; o < s; ++o)
      {
        const std::size_t across = static_cast<std::size_t>(o / 2);
        if (o / 2 == s / 2 || index[across] != (o % 2 ? counts[across] - 1 : 0))
        {
          continue;
        }
        const Spline<D>& other = boundary.Sides[static_cast<std::size_t>(o)];
        Eigen::Index j = 0;
        Eigen::Index stride = 1;
        for (int k : SideDirections<Dim>(o))
        {
          j += stride * index[static_cast<std::size_t>(k)];
          stride *= counts[static_cast<std::size_t>(k)];
        }
        const double gap = (side.ControlPoints.row(i) - other.ControlPoints.row(j)).norm();
        boundary.LargestGap = std::max(boundary.LargestGap, gap);
        const std::string where = "along the edge between " +
          Given(boundary.Origins[static_cast<std::size_t>(o)].Input) + " (" + SideName<Dim>(o) +
          ") and " + Given(boundary.Origins[static_cast<std::size_t>(s)].Input) + " (" +
          SideName<Dim>(s) + ")";
        if (!(gap <= tolerance))
        {
          return { ErrorCode::InvalidTopology,
            "gap of " + NumberText(gap) + " (allowed " + NumberText(tolerance) +
              ") between control points " + where };
        }
        if (side.IsRational() && !SameWeight(side.Weights[i], other.Weights[j]))
        {
          return { ErrorCode::InvalidWeight,
            "weights " + NumberText(side.Weights[i]) + " and " + NumberText(other.Weights[j]) +
              " " + where + " are not proportional" };
        }
        side.ControlPoints.row(i) = other.ControlPoints.row(j);
        if (side.IsRational())
        {
          side.Weights[i] = other.Weights[j];
        }
        break;
      }
    }
  }
  return {};
}
}

template <>
std::string SideName<2>(int side)
{
  constexpr const char* names[4] = { "west (u = 0)", "east (u = 1)", "south (v = 0)",
    "north (v = 1)" };
  return side >= 0 && side < 4 ? names[side] : "no side";
}
template <>
std::string SideName<3>(int side)
{
  constexpr const char* names[6] = { "face u = 0", "face u = 1", "face v = 0", "face v = 1",
    "face w = 0", "face w = 1" };
  return side >= 0 && side < 6 ? names[side] : "no side";
}

template <int Dim>
Result<CompatibleBoundary<Dim>> MakeCompatible(
  const DomainBoundary<Dim>& boundary, const BoundaryParams& params)
{
  constexpr int D = Dim - 1;
  constexpr std::size_t NumSides = 2 * Dim;
  if (!(params.GapTolerance >= 0.0 && params.GapTolerance <= 0.1))
  {
    return { ErrorCode::InvalidParameter,
      "gap tolerance " + NumberText(params.GapTolerance) + " is outside [0, 0.1]" };
  }
  if (boundary.Sides.empty())
  {
    return { ErrorCode::EmptyInput, "the boundary has no sides" };
  }
  if (boundary.Sides.size() != NumSides)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(boundary.Sides.size()) + " sides; the boundary needs " +
        std::to_string(NumSides) + (Dim == 2 ? " curves" : " faces") };
  }
  std::array<Spline<D>, NumSides> given;
  Eigen::Matrix<double, 1, Dim> lower, upper;
  lower.setConstant(std::numeric_limits<double>::infinity());
  upper = -lower;
  bool rational = false;
  double height = 0.0;
  for (std::size_t s = 0; s < NumSides; ++s)
  {
    auto prepared = Prepared<Dim>(boundary.Sides[s]);
    if (!prepared)
    {
      return Named(prepared.Status, static_cast<int>(s));
    }
    given[s] = std::move(prepared.Value);
    lower = lower.cwiseMin(given[s].ControlPoints.colwise().minCoeff());
    upper = upper.cwiseMax(given[s].ControlPoints.colwise().maxCoeff());
    rational = rational || given[s].IsRational();
    const PointMatrix& points = boundary.Sides[s].ControlPoints;
    const double z = points.cols() > Dim ? points(0, Dim) : 0.0;
    height = s == 0 ? z : height;
    if (points.cols() > Dim && ((points.col(Dim).array() != height).any()))
    {
      return { ErrorCode::DimensionMismatch,
        Given(static_cast<int>(s)) + ": the curves do not lie in one plane of constant z" };
    }
  }
  CompatibleBoundary<Dim> result;
  result.Size = (upper - lower).norm();
  const double tolerance = params.GapTolerance * result.Size;

  Matcher<Dim> matcher;
  matcher.Significant = 1e-12 * result.Size;
  for (const Spline<D>& side : given)
  {
    matcher.Corners.emplace_back();
    for (int c = 0; c < (1 << D); ++c)
    {
      matcher.Corners.back()[static_cast<std::size_t>(c)] =
        side.ControlPoints.row(CornerFunction(*side.Space, c));
    }
  }
  result.Origins = matcher.Find().Sides;
  const auto arrange = [&]
  {
    for (std::size_t s = 0; s < NumSides; ++s)
    {
      const SideOrigin<Dim>& origin = result.Origins[s];
      result.Sides[s] =
        Reoriented<D>(given[static_cast<std::size_t>(origin.Input)], origin.Axis, origin.Reversed);
    }
  };
  arrange();
  double gap = 0.0;
  for (int a = 0; a < (1 << Dim); ++a) // all corners against all sides that have them
  {
    for (std::size_t s = 0; s < NumSides; ++s)
    {
      for (std::size_t o = 0; o < s; ++o)
      {
        for (int i = 0; i < (1 << D); ++i)
        {
          for (int j = 0; j < (1 << D); ++j)
          {
            if (MapCorner<Dim>(static_cast<int>(s), i) == a &&
              MapCorner<Dim>(static_cast<int>(o), j) == a)
            {
              const Spline<D>& side = result.Sides[s];
              const Spline<D>& other = result.Sides[o];
              gap = std::max(gap,
                (side.ControlPoints.row(CornerFunction(*side.Space, i)) -
                  other.ControlPoints.row(CornerFunction(*other.Space, j)))
                  .norm());
            }
          }
        }
      }
    }
  }
  if (!(gap <= tolerance))
  {
    return GapError<Dim>(result.Sides, result.Origins, tolerance);
  }
  result.LargestGap = gap;

  const double measure = SignedMeasure<Dim>(result.Sides);
  if (!(std::abs(measure) > 1e-14 * std::pow(result.Size, Dim)))
  {
    return { ErrorCode::InvalidTopology,
      std::string("the sides enclose no ") + (Dim == 2 ? "area" : "volume") };
  }
  if (measure < 0.0) // the last direction runs backwards
  {
    std::swap(result.Origins[NumSides - 2], result.Origins[NumSides - 1]);
    for (std::size_t s = 0; s + 2 < NumSides; ++s)
    {
      result.Origins[s].Reversed[D - 1] = !result.Origins[s].Reversed[D - 1];
    }
    arrange();
  }
  if (rational)
  {
    if (const Status status = MatchWeights(result.Sides, result.Origins); !status)
    {
      return status;
    }
  }
  if (const Status status = MergeKnots<Dim>(result.Sides, result.Origins, result.Knots); !status)
  {
    return status;
  }
  if (const Status status = ShareRows<Dim>(result, tolerance); !status)
  {
    return status;
  }
  return result;
}

template Result<CompatibleBoundary<2>> MakeCompatible<2>(
  const DomainBoundary<2>&, const BoundaryParams&);
template Result<CompatibleBoundary<3>> MakeCompatible<3>(
  const DomainBoundary<3>&, const BoundaryParams&);
}
