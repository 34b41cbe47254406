// SPDX-License-Identifier: BSD-3-Clause
#include "SnapSurfaces.h"

#include "TriangleSag.h"

#include <knotwork/SplineCore/AngleBetween.h>
#include <knotwork/SplineCore/FitAnalyticSurface.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;

constexpr double Degree = 0.017453292519943295;
constexpr double LargestTurn = 2.0 * Degree; ///< what differs by more is not nearly equal
constexpr double LargestGrowth = 0.05;       ///< of radii, of the larger one's
constexpr double Neighbourhood = 2.0;        ///< of places, in moves of surfaces

/// A surface that may be snapped.
struct Candidate
{
  RecognizedRegion* Region = nullptr;
  std::vector<Vector3d> Points;
  double Area = 0.0;
  double MaxMove = 0.0;     ///< of the surface at the points
  double MaxDistance = 0.0; ///< of the points
  AnalyticSurface Surface;
  HeldParameters Held;
  int Direction = -1; ///< numbers of values; those of one surface alone are no common ones
  int Position = -1;
  int Size = -1;
};

/// A value of several candidates.
template <typename Value>
struct Group
{
  Value Common;
  double Weight = 0.0;
  std::vector<Candidate*> Members; ///< the one of the largest area first
};

/// Candidates whose values are near to that of the first one of a group, and their mean by area.
/// @param candidates  in the order of their areas.
/// @param take  whether a value is near to another one; its own form of it is the result then.
template <typename Value>
std::vector<Group<Value>> FindGroups(const std::vector<Candidate*>& candidates,
  const std::function<Value(const Candidate&)>& valueOf,
  const std::function<bool(const Value& first, Value& other)>& take)
{
  std::vector<Group<Value>> groups;
  std::vector<Value> firsts;
  for (Candidate* candidate : candidates)
  {
    Value value = valueOf(*candidate);
    std::size_t g = 0;
    while (g < groups.size() && !take(firsts[g], value))
    {
      ++g;
    }
    if (g == groups.size())
    {
      firsts.push_back(value);
      groups.push_back({ value, 0.0, {} });
    }
    Group<Value>& group = groups[g];
    group.Weight += candidate->Area;
    group.Common += (value - group.Common) * (candidate->Area / group.Weight);
    group.Members.push_back(candidate);
  }
  return groups;
}

bool IsAnalytic(SurfaceType type)
{
  return type != SurfaceType::FreeForm && !HasProfile(type);
}

Candidate CandidateOf(const SnappedPart& part, RecognizedRegion& region, double distance)
{
  Candidate candidate;
  candidate.Region = &region;
  candidate.Surface = region.Surface;
  candidate.MaxMove = distance;
  candidate.MaxDistance = std::max(part.Recognition->Tolerance, region.MaxDistance);
  std::set<int> points;
  for (const int t : region.Triangles)
  {
    const auto& corners = (*part.Triangles)[static_cast<std::size_t>(t)];
    points.insert(corners.begin(), corners.end());
    candidate.Area += TriangleArea(*part.Points, corners);
  }
  for (const int p : points)
  {
    candidate.Points.emplace_back(part.Points->row(p).transpose());
  }
  return candidate;
}

/// The foot of a point on a plane through the origin.
Vector3d Across(const Vector3d& direction, const Vector3d& point)
{
  return point - point.dot(direction) * direction;
}

/// Takes a surface whose held parts are what they shall be, the rest fitted again.
/// @return false: it is too far from the points or from the region's own surface; the candidate is
/// as it was.
bool Take(Candidate& candidate, AnalyticSurface surface, const HeldParameters& held)
{
  const AnalyticSurface start = surface;
  if (!FitSurface(candidate.Points, held, surface))
  {
    return false;
  }
  // what is held is held to the bit, or nearly so
  surface.Axis = held.Direction ? start.Axis : surface.Axis;
  if (held.Position && surface.Type == SurfaceType::Plane)
  {
    surface.Point = start.Point;
  }
  else if (held.Position)
  {
    surface.Point =
      Across(surface.Axis, start.Point) + surface.Point.dot(surface.Axis) * surface.Axis;
  }
  if (held.Size)
  {
    const bool isCone = surface.Type == SurfaceType::Cone;
    const bool isTorus = surface.Type == SurfaceType::Torus;
    surface.Angle = start.Angle;
    surface.MinorRadius = start.MinorRadius;
    surface.Radius = isCone || isTorus ? surface.Radius : start.Radius;
  }
  const AnalyticSurface& own = candidate.Region->Surface;
  for (const Vector3d& p : candidate.Points)
  {
    const double distance = surface.Distance(p);
    if (!(std::abs(distance) <= candidate.MaxDistance &&
          std::abs(distance - own.Distance(p)) <= candidate.MaxMove))
    {
      return false;
    }
  }
  candidate.Surface = surface;
  candidate.Held = held;
  return true;
}

/// The same direction on the side of another one.
Vector3d Aligned(const Vector3d& direction, const Vector3d& with)
{
  return direction.dot(with) < 0.0 ? Vector3d(-direction) : direction;
}

bool IsAcross(const Vector3d& a, const Vector3d& b)
{
  return std::abs(a.dot(b)) < std::sin(LargestTurn);
}

/// Directions across those of the frame become so exactly.
void Square(std::vector<Group<Vector3d>>& groups, std::vector<char>& isSquared)
{
  std::stable_sort(
    groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.Weight > b.Weight; });
  isSquared.assign(groups.size(), 0);
  const auto second = std::find_if(groups.begin() + 1, groups.end(),
    [&](const auto& group) { return IsAcross(group.Common, groups.front().Common); });
  if (second == groups.end())
  {
    return;
  }
  const Vector3d first = groups.front().Common;
  second->Common = Across(first, second->Common).normalized();
  const std::array<Vector3d, 3> frame{ first, second->Common, first.cross(second->Common) };
  isSquared.front() = 1;
  isSquared[static_cast<std::size_t>(second - groups.begin())] = 1;
  for (std::size_t g = 1; g < groups.size(); ++g)
  {
    Vector3d& common = groups[g].Common;
    if (isSquared[g] == 0 && AngleBetween(Aligned(frame[2], common), common) < LargestTurn)
    {
      common = Aligned(frame[2], common);
      isSquared[g] = 1;
    }
    for (std::size_t k = 0; k < frame.size() && isSquared[g] == 0; ++k)
    {
      if (IsAcross(frame[k], common))
      {
        common = Across(frame[k], common).normalized();
        isSquared[g] = 1;
      }
    }
  }
}

void SnapDirections(const std::vector<Candidate*>& candidates)
{
  std::vector<Candidate*> directed;
  for (Candidate* candidate : candidates)
  {
    if (candidate->Surface.Type != SurfaceType::Sphere)
    {
      directed.push_back(candidate);
    }
  }
  if (directed.empty())
  {
    return;
  }
  auto groups = FindGroups<Vector3d>(
    directed, [](const Candidate& candidate) { return candidate.Surface.Axis; },
    [](const Vector3d& first, Vector3d& other)
    {
      const Vector3d aligned = Aligned(other, first);
      const bool isNear = AngleBetween(first, aligned) < LargestTurn;
      other = isNear ? aligned : other;
      return isNear;
    });
  for (auto& group : groups)
  {
    group.Common.normalize();
  }
  std::vector<char> isSquared;
  Square(groups, isSquared);
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    for (Candidate* candidate : groups[g].Members)
    {
      AnalyticSurface surface = candidate->Surface;
      surface.Axis = Aligned(groups[g].Common, surface.Axis);
      const bool isOwn = groups[g].Members.size() == 1 && isSquared[g] == 0;
      if (isOwn || Take(*candidate, surface, { true, false, false }))
      {
        candidate->Held.Direction = true;
        candidate->Direction = static_cast<int>(g);
      }
    }
  }
}

/// Where a plane or an axis is, of those of one direction.
Vector3d PlaceOf(const Candidate& candidate)
{
  const AnalyticSurface& surface = candidate.Surface;
  return surface.Type == SurfaceType::Plane
    ? Vector3d(surface.Point.dot(surface.Axis) * surface.Axis)
    : Across(surface.Axis, surface.Point);
}

/// An axis of surfaces of revolution.
struct AxisLine
{
  Vector3d Direction;
  Vector3d Point;
  int Position = 0;
};

void SnapSpheres(
  const std::vector<Candidate*>& candidates, const std::vector<AxisLine>& lines, double near)
{
  for (Candidate* candidate : candidates)
  {
    if (candidate->Surface.Type != SurfaceType::Sphere)
    {
      continue;
    }
    for (const AxisLine& line : lines)
    {
      const Vector3d& centre = candidate->Surface.Point;
      AnalyticSurface surface = candidate->Surface;
      surface.Axis = line.Direction;
      surface.Point = line.Point + centre.dot(line.Direction) * line.Direction;
      if ((surface.Point - centre).norm() <= near &&
        Take(*candidate, surface, { true, true, false }))
      {
        candidate->Position = line.Position;
        break;
      }
    }
  }
}

void SnapPositions(const std::vector<Candidate*>& candidates, double near)
{
  std::map<std::array<int, 2>, std::vector<Candidate*>> alike; // planes and others by direction
  for (Candidate* candidate : candidates)
  {
    if (candidate->Direction >= 0)
    {
      const int isPlane = candidate->Surface.Type == SurfaceType::Plane ? 1 : 0;
      alike[{ candidate->Direction, isPlane }].push_back(candidate);
    }
  }
  int number = 0;
  std::vector<AxisLine> lines;
  for (const auto& [kind, members] : alike)
  {
    const auto groups = FindGroups<Vector3d>(members, PlaceOf,
      [near](const Vector3d& first, const Vector3d& other)
      { return (other - first).norm() <= near; });
    for (const auto& group : groups)
    {
      for (Candidate* candidate : group.Members)
      {
        AnalyticSurface surface = candidate->Surface;
        const Vector3d& axis = surface.Axis;
        surface.Point = candidate->Surface.Type == SurfaceType::Plane
          ? Vector3d(Across(axis, surface.Point) + group.Common)
          : Vector3d(group.Common + surface.Point.dot(axis) * axis);
        const bool isOwn = group.Members.size() == 1;
        if (isOwn || Take(*candidate, surface, { true, true, false }))
        {
          candidate->Held.Position = true;
          candidate->Position = number;
        }
      }
      if (kind[1] == 0)
      {
        lines.push_back({ group.Members.front()->Surface.Axis, group.Common, number });
      }
      ++number;
    }
  }
  SnapSpheres(candidates, lines, near);
}

double& SizeOf(AnalyticSurface& surface)
{
  return surface.Type == SurfaceType::Cone ? surface.Angle
    : surface.Type == SurfaceType::Torus   ? surface.MinorRadius
                                           : surface.Radius;
}

void SnapSizes(const std::vector<Candidate*>& candidates)
{
  int number = 0;
  for (const bool ofCones : { false, true })
  {
    std::vector<Candidate*> sized;
    for (Candidate* candidate : candidates)
    {
      const SurfaceType type = candidate->Surface.Type;
      if (type != SurfaceType::Plane && (type == SurfaceType::Cone) == ofCones)
      {
        sized.push_back(candidate);
      }
    }
    const auto groups = FindGroups<double>(
      sized,
      [](const Candidate& candidate)
      {
        AnalyticSurface surface = candidate.Surface;
        return SizeOf(surface);
      },
      [ofCones](const double& first, const double& other)
      {
        return std::abs(first - other) <=
          (ofCones ? LargestTurn : LargestGrowth * std::max(first, other));
      });
    for (const auto& group : groups)
    {
      for (Candidate* candidate : group.Members)
      {
        AnalyticSurface surface = candidate->Surface;
        SizeOf(surface) = group.Common;
        HeldParameters held = candidate->Held;
        held.Size = true;
        if (group.Members.size() == 1 || Take(*candidate, surface, held))
        {
          candidate->Size = number;
        }
      }
      ++number;
    }
  }
}

/// Numbers of values that two surfaces have at least, in the order of the regions.
std::vector<int> CommonNumbers(
  const std::vector<Candidate>& candidates, int Candidate::*const value, int& count)
{
  std::map<int, int> uses;
  for (const Candidate& candidate : candidates)
  {
    ++uses[candidate.*value];
  }
  std::map<int, int> numbers;
  std::vector<int> result;
  for (const Candidate& candidate : candidates)
  {
    const int own = candidate.*value;
    const bool isCommon = own >= 0 && uses[own] > 1;
    result.push_back(
      isCommon ? numbers.emplace(own, static_cast<int>(numbers.size())).first->second : -1);
  }
  count = static_cast<int>(numbers.size());
  return result;
}

bool IsSame(const AnalyticSurface& a, const AnalyticSurface& b)
{
  return a.Point == b.Point && a.Axis == b.Axis && a.Radius == b.Radius &&
    a.MinorRadius == b.MinorRadius && a.Angle == b.Angle;
}
}

SnappedValues SnapSurfaces(const std::vector<SnappedPart>& parts, double distance)
{
  std::vector<Candidate> candidates;
  std::vector<const SnappedPart*> partOf;
  for (const SnappedPart& part : parts)
  {
    for (RecognizedRegion& region : part.Recognition->Regions)
    {
      if (IsAnalytic(region.Surface.Type))
      {
        candidates.push_back(CandidateOf(part, region, distance));
        partOf.push_back(&part);
      }
    }
  }
  std::vector<Candidate*> ordered;
  for (Candidate& candidate : candidates)
  {
    ordered.push_back(&candidate);
  }
  std::stable_sort(ordered.begin(), ordered.end(),
    [](const Candidate* a, const Candidate* b) { return a->Area > b->Area; });
  SnapDirections(ordered);
  SnapPositions(ordered, Neighbourhood * distance);
  SnapSizes(ordered);

  SnappedValues snapped;
  const auto directions = CommonNumbers(candidates, &Candidate::Direction, snapped.NumDirections);
  const auto positions = CommonNumbers(candidates, &Candidate::Position, snapped.NumPositions);
  const auto sizes = CommonNumbers(candidates, &Candidate::Size, snapped.NumSizes);
  for (std::size_t i = 0; i < candidates.size(); ++i)
  {
    const Candidate& candidate = candidates[i];
    RecognizedRegion& region = *candidate.Region;
    region.Direction = directions[i];
    region.Position = positions[i];
    region.Size = sizes[i];
    if (IsSame(region.Surface, candidate.Surface))
    {
      continue;
    }
    ++snapped.NumSurfaces;
    if (candidate.Surface.Type != SurfaceType::Sphere)
    {
      region.Turn = AngleBetween(region.Surface.Axis, candidate.Surface.Axis) / Degree;
    }
    snapped.MaxTurn = std::max(snapped.MaxTurn, region.Turn);
    region.Surface = candidate.Surface;
    region.MaxDistance = MaxDistance(candidate.Points, region.Surface);
    region.MaxSag = 0.0;
    for (const int t : region.Triangles)
    {
      const auto& corners = (*partOf[i]->Triangles)[static_cast<std::size_t>(t)];
      const auto at = [&](std::size_t k) -> Vector3d
      { return partOf[i]->Points->row(corners[k]).transpose(); };
      region.MaxSag =
        std::max(region.MaxSag, MaxMiddleDistance(region.Surface, { at(0), at(1), at(2) }));
    }
  }
  return snapped;
}
}
