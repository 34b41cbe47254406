// SPDX-License-Identifier: BSD-3-Clause
#include "DomainBoundary.h"

#include "ArrangedPatch.h"
#include "CoincidentPoints.h"
#include "DomainMeasure.h"
#include <knotwork/SplineCore/Numbers.h>

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
            detail = "gap of " + Digits(distance) + " (allowed " + Digits(tolerance) +
              ") at the corner " + CornerName<Dim>(corner) + " between " +
              GivenSide(origins[static_cast<std::size_t>(a)].Input) + " and " +
              GivenSide(origins[static_cast<std::size_t>(b)].Input) + ", near " +
              PointText(pointA.data(), Dim);
          }
        }
      }
    }
  }
  return { ErrorCode::InvalidTopology, detail };
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
      "gap tolerance " + Digits(params.GapTolerance) + " is outside [0, 0.1]" };
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
  const auto layout = MakeCompatible<Dim>(prepared.Value, result.Origins, params);
  if (!layout)
  {
    return layout.Status;
  }
  const Spline<Dim>& patch = layout->Map.Patches.front();
  result.Knots = patch.Space->Knots;
  result.LargestGap = std::max(result.LargestGap, layout->LargestGap);
  for (std::size_t s = 0; s < NumSides; ++s)
  {
    auto side = SideSpline<Dim>(patch, static_cast<int>(s));
    if (!side)
    {
      return side.Status;
    }
    result.Sides[s] = std::move(side.Value);
  }
  result.LargestGap = std::max(result.LargestGap, JoinCoincidentPoints<Dim>(result, tolerance));
  return result;
}

template Result<CompatibleBoundary<2>> MakeCompatible<2>(
  const DomainBoundary<2>&, const BoundaryParams&);
template Result<CompatibleBoundary<3>> MakeCompatible<3>(
  const DomainBoundary<3>&, const BoundaryParams&);
}
