// SPDX-License-Identifier: BSD-3-Clause
#include "DomainBoundary.h"

#include "CoincidentPoints.h"
#include "DomainMeasure.h"
#include "NumberText.h"
#include "SideSplines.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
template <int Dim>
struct Arrangement
{
  std::array<SideOrigin, 2 * Dim> Sides;
  double Gap = std::numeric_limits<double>::infinity();
};

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
    this->Used.assign(this->Corners.size(), false);
    this->Known.fill(false);
    SideOrigin first;
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
  double Place(int role, const SideOrigin& origin)
  {
    this->Current.Sides[static_cast<std::size_t>(role)] = origin;
    double gap = 0.0;
    for (int c = 0; c < (1 << (Dim - 1)); ++c)
    {
      const std::size_t corner = static_cast<std::size_t>(PatchCorner<Dim>(role, c));
      const Point& point = this->Corners[static_cast<std::size_t>(origin.Input)]
                                        [static_cast<std::size_t>(origin.Corner(c))];
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
      for (const SideOrientation& orientation : SideOrientations(Dim - 1))
      {
        const SideOrigin origin{ orientation, static_cast<int>(input) };
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
  const std::array<SideOrigin, 2 * Dim>& origins, double tolerance)
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
          const int corner = PatchCorner<Dim>(a, i);
          if (corner != PatchCorner<Dim>(b, j))
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
              GivenSide(origins[static_cast<std::size_t>(a)].Input) + " and " +
              GivenSide(origins[static_cast<std::size_t>(b)].Input) + ", near (";
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

/// Brings all sides to the same degree and knots in each direction of the map.
template <int Dim>
Status MergeKnots(std::array<Spline<Dim - 1>, 2 * Dim>& sides,
  const std::array<SideOrigin, 2 * Dim>& origins, std::array<KnotVector, Dim>& knots)
{
  constexpr int D = Dim - 1;
  for (int d = 0; d < Dim; ++d)
  {
    std::vector<SideDirection<D>> users;
    for (int s = 0; s < 2 * Dim; ++s)
    {
      const auto directions = SideDirections<Dim>(s);
      for (int k = 0; k < D; ++k)
      {
        if (directions[static_cast<std::size_t>(k)] == static_cast<std::size_t>(d))
        {
          const std::size_t at = static_cast<std::size_t>(s);
          users.push_back({ &sides[at], k, origins[at].Input });
        }
      }
    }
    auto united = UniteKnots<D>(users, 1, 1);
    if (!united)
    {
      return united.Status;
    }
    knots[static_cast<std::size_t>(d)] = std::move(united.Value);
  }
  return {};
}

/// Weights of curves that meet become equal at the corners.
Status MatchWeights(std::array<Spline<1>, 4>& sides, const std::array<SideOrigin, 4>& origins)
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
      return NamedSide(product.Status, origins[1].Input);
    }
    sides[1] = std::move(product.Value);
  }
  return {};
}

/// A constant factor a face makes the weights at the corners equal; edges are compared later.
Status MatchWeights(std::array<Spline<2>, 6>& sides, const std::array<SideOrigin, 6>&)
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
      for (const std::size_t d : directions)
      {
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
        for (const std::size_t d : SideDirections<Dim>(o))
        {
          j += stride * index[d];
          stride *= counts[d];
        }
        const double gap = (side.ControlPoints.row(i) - other.ControlPoints.row(j)).norm();
        boundary.LargestGap = std::max(boundary.LargestGap, gap);
        const std::string where = "along the edge between " +
          GivenSide(boundary.Origins[static_cast<std::size_t>(o)].Input) + " (" + SideName<Dim>(o) +
          ") and " + GivenSide(boundary.Origins[static_cast<std::size_t>(s)].Input) + " (" +
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

/// Functions of a map in one direction at most.
static constexpr int MostInADirection = 4096;

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
  const auto prepared = PreparedSides<Dim>(boundary.Sides);
  if (!prepared)
  {
    return prepared.Status;
  }
  const std::vector<Spline<D>>& given = prepared->Sides;
  const bool rational = std::any_of(
    given.begin(), given.end(), [](const Spline<D>& side) { return side.IsRational(); });
  CompatibleBoundary<Dim> result;
  result.Size = prepared->Size;
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
      const SideOrigin& origin = result.Origins[s];
      result.Sides[s] = Reoriented<D>(given[static_cast<std::size_t>(origin.Input)], origin);
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
            if (PatchCorner<Dim>(static_cast<int>(s), i) == a &&
              PatchCorner<Dim>(static_cast<int>(o), j) == a)
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
  double functions = 1.0;
  for (const KnotVector& knots : result.Knots)
  {
    functions *= knots.NumFunctions();
    // the Laplacian of a direction is diagonalized as a full matrix
    if (knots.NumFunctions() > MostInADirection)
    {
      return { ErrorCode::TooLarge,
        "the map would have " + std::to_string(knots.NumFunctions()) +
          " functions in one direction, the limit is " + std::to_string(MostInADirection) +
          "; give sides with fewer elements, or parts of the domain" };
    }
  }
  if (Status status = CheckSize(functions, params.MaxFunctions); !status)
  {
    return status;
  }
  if (const Status status = ShareRows<Dim>(result, tolerance); !status)
  {
    return status;
  }
  result.LargestGap = std::max(result.LargestGap, JoinCoincidentPoints<Dim>(result, tolerance));
  return result;
}

template Result<CompatibleBoundary<2>> MakeCompatible<2>(
  const DomainBoundary<2>&, const BoundaryParams&);
template Result<CompatibleBoundary<3>> MakeCompatible<3>(
  const DomainBoundary<3>&, const BoundaryParams&);
}
