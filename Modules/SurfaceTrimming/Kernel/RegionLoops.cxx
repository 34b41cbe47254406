// SPDX-License-Identifier: BSD-3-Clause
#include "RegionLoops.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr double Turn = 2.0 * Pi;

using UseLoop = std::vector<ChainUseOfRegion>;

/// The loops of a region with it to the left in the parameter plane.
std::vector<UseLoop> OrientedLoops(const RegionChains& chains, int region, bool reversed)
{
  std::vector<UseLoop> loops = chains.Loops[static_cast<std::size_t>(region)];
  for (UseLoop& loop : loops)
  {
    if (reversed)
    {
      std::reverse(loop.begin(), loop.end());
      for (ChainUseOfRegion& use : loop)
      {
        use.Reversed = !use.Reversed;
      }
    }
  }
  return loops;
}

/// A point of a loop: of a chain by its use and number.
struct PathPoint
{
  Eigen::Vector2d Place;
  std::size_t Use = 0;
  std::size_t Point = 0; ///< of the chain
  int Vertex = -1;
};

/// Whether the mesh's points are meant, or where they lie on the surfaces.
enum class PointsOf
{
  Mesh,
  Surfaces
};

/// Parameters along a loop, unwrapped; the first point comes again at the end.
std::vector<PathPoint> PathOf(
  const UseLoop& loop, const RegionChains& chains, const AnalyticPatch& patch, PointsOf which)
{
  std::vector<PathPoint> path;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  for (std::size_t u = 0; u < loop.size(); ++u)
  {
    const RegionChain& chain = chains.Chains[static_cast<std::size_t>(loop[u].Chain)];
    const auto& points = which == PointsOf::Mesh ? chain.MeshPoints : chain.Points;
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i)
    {
      PathPoint point;
      point.Use = u;
      point.Point = loop[u].Reversed ? count - 1 - i : i;
      const bool isEnd = point.Point == 0 || point.Point + 1 == count;
      point.Vertex = isEnd ? chain.Vertices[point.Point == 0 ? 0 : 1] : -1;
      last = patch.ParametersNear(points[point.Point], last);
      point.Place = last;
      path.push_back(point);
    }
  }
  return path;
}

double AreaOf(const std::vector<PathPoint>& path)
{
  double area = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i)
  {
    const Eigen::Vector2d& a = path[i].Place;
    const Eigen::Vector2d& b = path[(i + 1) % path.size()].Place;
    area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return area;
}

std::array<int, 2> WindingOf(const std::vector<PathPoint>& path)
{
  const Eigen::Vector2d way = path.back().Place - path.front().Place;
  return { static_cast<int>(std::lround(way[0] / Turn)),
    static_cast<int>(std::lround(way[1] / Turn)) };
}

/// How a region lies in a parameter plane.
enum class Layout
{
  Whole, ///< the surface without any loop
  Disc,  ///< one outer loop
  Band,  ///< between two loops that run around
  Cap,   ///< between one that runs around and a pole
  None
};

struct LayoutOfRegion
{
  Layout Kind = Layout::None;
  int Winding = -1;
  std::array<int, 2> Around{ -1, -1 }; ///< loops that run around once: on and back
};

LayoutOfRegion FindLayout(
  const std::vector<std::vector<PathPoint>>& paths, const AnalyticPatch& patch)
{
  LayoutOfRegion layout;
  const SurfaceType type = patch.Surface().Type;
  if (paths.empty())
  {
    const bool isClosed = type == SurfaceType::Sphere || type == SurfaceType::Torus;
    layout.Kind = isClosed ? Layout::Whole : Layout::None;
    return layout;
  }
  int outer = 0;
  for (std::size_t l = 0; l < paths.size(); ++l)
  {
    const std::array<int, 2> winding = WindingOf(paths[l]);
    for (int d = 0; d < 2; ++d)
    {
      const int turns = patch.IsPeriodic(d) ? winding[static_cast<std::size_t>(d)] : 0;
      if (turns == 0)
      {
        continue;
      }
      int& around = layout.Around[turns > 0 ? 0 : 1];
      if (std::abs(turns) > 1 || around >= 0 || (layout.Winding >= 0 && layout.Winding != d))
      {
        return {};
      }
      layout.Winding = d;
      around = static_cast<int>(l);
    }
    const bool runsAround =
      layout.Around[0] == static_cast<int>(l) || layout.Around[1] == static_cast<int>(l);
    outer += !runsAround && AreaOf(paths[l]) > 0.0 ? 1 : 0;
  }
  if (layout.Winding < 0)
  {
    layout.Kind = outer == 1 ? Layout::Disc : Layout::None;
    return layout;
  }
  if (outer > 0)
  {
    return {};
  }
  const bool both = layout.Around[0] >= 0 && layout.Around[1] >= 0;
  // to the left of the loop that runs on is the upper pole
  const std::array<double, 2> poles = patch.Poles();
  const bool hasPole = layout.Winding == 0 && std::isfinite(poles[layout.Around[0] >= 0 ? 1 : 0]);
  layout.Kind = both ? Layout::Band : hasPole ? Layout::Cap : Layout::None;
  return layout;
}

std::vector<std::vector<PathPoint>> PathsOf(const std::vector<UseLoop>& loops,
  const RegionChains& chains, const AnalyticPatch& patch, PointsOf which)
{
  std::vector<std::vector<PathPoint>> paths;
  for (const UseLoop& loop : loops)
  {
    paths.push_back(PathOf(loop, chains, patch, which));
  }
  return paths;
}

/// Directions spread over half a sphere.
std::vector<Eigen::Vector3d> Directions()
{
  constexpr int Count = 200;
  const double golden = Pi * (3.0 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> directions{ Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(),
    Eigen::Vector3d::UnitY() };
  for (int i = 0; i < Count; ++i)
  {
    const double z = (i + 0.5) / Count;
    const double r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  return directions;
}

/// The axis of a sphere is free: the poles come far from the loops, outside of the region if that
/// can be.
AnalyticPatch SpherePatch(
  AnalyticSurface sphere, const std::vector<UseLoop>& loops, const RegionChains& chains)
{
  constexpr double Preferred = 0.35; // radians: poles that are nearer to a loop are a last resort
  std::vector<Eigen::Vector3d> candidates = Directions();
  std::vector<Eigen::Vector3d> points;
  for (const UseLoop& loop : loops)
  {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const ChainUseOfRegion& use : loop)
    {
      for (const Eigen::Vector3d& point : chains.Chains[static_cast<std::size_t>(use.Chain)].Points)
      {
        points.push_back((point - sphere.Point).normalized());
        mean += points.back();
      }
    }
    if (mean.norm() > 0.0)
    {
      candidates.push_back(mean.normalized());
    }
  }
  AnalyticPatch best(sphere, Eigen::Vector3d::UnitX());
  double most = -HUGE_VAL;
  for (const Eigen::Vector3d& axis : candidates)
  {
    sphere.Axis = axis;
    const AnalyticPatch patch(
      sphere, points.empty() ? Eigen::Vector3d::UnitX().eval() : points.front());
    const Layout kind = FindLayout(PathsOf(loops, chains, patch, PointsOf::Mesh), patch).Kind;
    double nearest = Pi;
    for (const Eigen::Vector3d& point : points)
    {
      nearest = std::min(nearest, std::acos(std::min(1.0, std::abs(point.dot(axis)))));
    }
    const double rank = kind == Layout::None          ? -2.0
      : kind == Layout::Disc || kind == Layout::Whole ? 2.0
      : kind == Layout::Band                          ? 1.0
                                                      : 0.0;
    const double score = Turn * (nearest < Preferred ? rank - 3.0 : rank) + nearest;
    if (score > most)
    {
      most = score;
      best = patch;
    }
  }
  return best;
}

AnalyticPatch ChoosePatch(
  const AnalyticSurface& surface, const std::vector<UseLoop>& loops, const RegionChains& chains)
{
  if (surface.Type == SurfaceType::Sphere)
  {
    return SpherePatch(surface, loops, chains);
  }
  Eigen::Vector3d reference = Eigen::Vector3d::UnitX();
  double longest = 0.0;
  for (const UseLoop& loop : loops)
  {
    for (const ChainUseOfRegion& use : loop)
    {
      const auto& points = chains.Chains[static_cast<std::size_t>(use.Chain)].Points;
      const Eigen::Vector3d along = points.back() - points.front();
      if (surface.Type == SurfaceType::Plane)
      {
        reference = along.norm() > longest ? along : reference;
        longest = std::max(longest, along.norm());
      }
      else if (longest == 0.0)
      {
        reference = points.front() - surface.Point;
        longest = reference.norm();
      }
    }
  }
  return { surface, reference };
}

/// The difference of two angles, by turns nearest to 0.
double AngleBetween(double a, double b)
{
  return a - b - Turn * std::round((a - b) / Turn);
}

constexpr double SameAngle = 1e-7;

class SeamSearch
{
public:
  SeamSearch(const std::vector<std::vector<PathPoint>>& paths, const LayoutOfRegion& layout)
    : Paths(paths), Plan(layout)
  {
  }

  /// @return false when there is no place.
  bool Find(double& place) const
  {
    double best = -HUGE_VAL;
    std::vector<double> candidates{ 0.0 };
    for (const int l : this->Plan.Around)
    {
      if (l >= 0)
      {
        for (const PathPoint& point : this->Paths[static_cast<std::size_t>(l)])
        {
          candidates.push_back(point.Place[this->Plan.Winding]);
        }
      }
    }
    constexpr int Even = 90;
    for (int i = 0; i < Even; ++i)
    {
      candidates.push_back(Turn * i / Even);
    }
    for (const double angle : candidates)
    {
      const double room = this->Room(angle);
      if (room <= 0.0 || !this->CrossesOnce(angle))
      {
        continue;
      }
      // files have the seam of a torus' turning circle at 0
      const double preference = this->Plan.Winding == 1 && angle == 0.0 ? 4.0 : 0.0;
      const double score = Turn * (this->NumVerticesAt(angle) + preference) + std::min(room, 0.5);
      if (score > best)
      {
        best = score;
        place = angle;
      }
    }
    return best > -HUGE_VAL;
  }

private:
  bool CrossesOnce(double angle) const
  {
    const auto turn = [&](const PathPoint& point)
    { return std::floor((point.Place[this->Plan.Winding] - angle) / Turn); };
    for (const int l : this->Plan.Around)
    {
      int crossings = 0;
      const auto* path = l >= 0 ? &this->Paths[static_cast<std::size_t>(l)] : nullptr;
      for (std::size_t i = 0; path && i + 1 < path->size(); ++i)
      {
        crossings += turn((*path)[i]) != turn((*path)[i + 1]) ? 1 : 0;
      }
      if (path && crossings != 1)
      {
        return false;
      }
    }
    return true;
  }

  int NumVerticesAt(double angle) const
  {
    int count = 0;
    for (const int l : this->Plan.Around)
    {
      bool isThere = false;
      if (l >= 0)
      {
        for (const PathPoint& point : this->Paths[static_cast<std::size_t>(l)])
        {
          isThere = isThere ||
            (point.Vertex >= 0 &&
              std::abs(AngleBetween(point.Place[this->Plan.Winding], angle)) <= SameAngle);
        }
      }
      count += isThere ? 1 : 0;
    }
    return count;
  }

  /// Angle to the nearest hole.
  double Room(double angle) const
  {
    double room = Pi;
    for (std::size_t l = 0; l < this->Paths.size(); ++l)
    {
      const int number = static_cast<int>(l);
      if (number == this->Plan.Around[0] || number == this->Plan.Around[1])
      {
        continue;
      }
      double lower = HUGE_VAL;
      double upper = -HUGE_VAL;
      for (const PathPoint& point : this->Paths[l])
      {
        lower = std::min(lower, point.Place[this->Plan.Winding]);
        upper = std::max(upper, point.Place[this->Plan.Winding]);
      }
      const double half = 0.5 * (upper - lower);
      room = std::min(room, std::abs(AngleBetween(0.5 * (lower + upper), angle)) - half);
    }
    return room;
  }

  const std::vector<std::vector<PathPoint>>& Paths;
  const LayoutOfRegion& Plan;
};

/// All points whose parameter is an angle.
AnalyticSurface SurfaceOfAngle(const AnalyticPatch& patch, int direction, double angle)
{
  constexpr double Flat = 1e-9;
  const AnalyticSurface& own = patch.Surface();
  AnalyticSurface surface;
  surface.Point = own.Point;
  surface.Axis = own.Axis;
  if (direction == 0)
  {
    surface.Type = SurfaceType::Plane;
    const Eigen::Vector3d out = patch.Point({ angle, 0.0 }) - own.Point;
    surface.Axis = own.Axis.cross(out).normalized();
    return surface;
  }
  surface.Radius = own.Radius;
  if (std::abs(std::sin(angle)) <= Flat)
  {
    surface.Type = SurfaceType::Plane;
    return surface;
  }
  surface.Type = SurfaceType::Cone;
  surface.Angle = std::atan(std::cos(angle) / std::sin(angle));
  return surface;
}

/// The vertex of a loop at an angle; a chain is divided when there is none.
int VertexAt(const UseLoop& loop, const std::vector<PathPoint>& path, const AnalyticPatch& patch,
  int direction, double angle, double farthest, const std::vector<AnalyticSurface>& surfaces,
  RegionChains& chains)
{
  constexpr double Near = 0.02; // of a segment: its end is taken
  for (const PathPoint& point : path)
  {
    if (point.Vertex >= 0 && std::abs(AngleBetween(point.Place[direction], angle)) <= SameAngle)
    {
      return point.Vertex;
    }
  }
  const auto turn = [&](const PathPoint& point)
  { return std::floor((point.Place[direction] - angle) / Turn); };
  std::size_t i = 0;
  while (turn(path[i]) == turn(path[i + 1]))
  {
    ++i;
  }
  const double from = AngleBetween(path[i].Place[direction], angle);
  const double to = AngleBetween(path[i + 1].Place[direction], angle);
  const double share = from / (from - to);
  const PathPoint& a = path[i];
  const PathPoint& b = path[i + 1];
  const int number = loop[a.Use].Chain;
  RegionChain& chain = chains.Chains[static_cast<std::size_t>(number)];
  std::vector<AnalyticSurface> all = SurfacesOf(chain.Regions, surfaces);
  all.push_back(SurfaceOfAngle(patch, direction, angle));
  const auto place = [&](const Eigen::Vector3d& point) { return MoveOnto(all, point, farthest); };
  const auto mayMove = [&](const PathPoint& point)
  {
    const bool isEnd = point.Point == 0 || point.Point + 1 == chain.Points.size();
    return !isEnd || chain.Vertices[0] < 0;
  };
  for (const PathPoint* end : { &a, &b })
  {
    if ((end == &a ? share : 1.0 - share) <= Near && mayMove(*end))
    {
      std::size_t at = end->Point;
      chain.Points[at] = place(chain.Points[at]);
      if (chain.Vertices[0] < 0 && (at == 0 || at + 1 == chain.Points.size()))
      {
        chain.Points.back() = chain.Points.front() = chain.Points[at];
        at = 0;
      }
      return chains.Split(number, at);
    }
  }
  const double own = a.Point < b.Point ? share : 1.0 - share;
  const std::size_t before = std::min(a.Point, b.Point);
  const auto between = [&](const std::vector<Eigen::Vector3d>& points) -> Eigen::Vector3d
  { return (1.0 - own) * points[before] + own * points[before + 1]; };
  const auto offset = static_cast<std::ptrdiff_t>(before) + 1;
  chain.PointIds.insert(chain.PointIds.begin() + offset, -1);
  chain.MeshPoints.insert(chain.MeshPoints.begin() + offset, between(chain.MeshPoints));
  chain.Points.insert(chain.Points.begin() + offset, place(between(chain.Points)));
  return chains.Split(number, before + 1);
}

Status NoLayout(int region, const AnalyticSurface& surface)
{
  return { ErrorCode::NotInSpace,
    "region " + std::to_string(region) + ", a " + ToString(surface.Type) +
      ", is no disc with holes when it is cut open once; divide it, or make spline faces" };
}
}

Status OpenRegion(const std::vector<AnalyticSurface>& surfaces, int region, double farthest,
  RegionChains& chains, RegionLoops& loops)
{
  const AnalyticSurface& surface = surfaces[static_cast<std::size_t>(region)];
  std::vector<UseLoop> oriented = OrientedLoops(chains, region, loops.Reversed);
  loops.Patch = ChoosePatch(surface, oriented, chains);
  // surfaces that hardly meet may do so in another order than the mesh's edges
  const LayoutOfRegion layout =
    FindLayout(PathsOf(oriented, chains, loops.Patch, PointsOf::Mesh), loops.Patch);
  if (layout.Kind == Layout::None)
  {
    return NoLayout(region, surface);
  }
  loops.Winding = layout.Winding;
  loops.Around = layout.Around;
  if (layout.Winding < 0)
  {
    return {};
  }
  auto paths = PathsOf(oriented, chains, loops.Patch, PointsOf::Surfaces);
  if (!SeamSearch(paths, layout).Find(loops.Seam))
  {
    return NoLayout(region, surface);
  }
  for (std::size_t k = 0; k < 2; ++k)
  {
    if (layout.Around[k] >= 0)
    {
      const auto l = static_cast<std::size_t>(layout.Around[k]);
      // the first division may have changed the other loop
      oriented = OrientedLoops(chains, region, loops.Reversed);
      paths = PathsOf(oriented, chains, loops.Patch, PointsOf::Surfaces);
      loops.SeamVertices[k] = VertexAt(
        oriented[l], paths[l], loops.Patch, layout.Winding, loops.Seam, farthest, surfaces, chains);
    }
  }
  return {};
}

namespace
{
struct Box
{
  Eigen::Vector2d Lower = Eigen::Vector2d::Constant(HUGE_VAL);
  Eigen::Vector2d Upper = Eigen::Vector2d::Constant(-HUGE_VAL);
  void Add(const Eigen::Vector2d& place)
  {
    this->Lower = this->Lower.cwiseMin(place);
    this->Upper = this->Upper.cwiseMax(place);
  }
  Eigen::Vector2d Centre() const { return 0.5 * (this->Lower + this->Upper); }
};

struct LaidOutLoop
{
  std::vector<LoopStep> Steps;
  Box Bounds;
  double Area = 0.0;
  int Around = -1; ///< as RegionLoops::SeamVertices

  void Move(const Eigen::Vector2d& by)
  {
    for (LoopStep& step : this->Steps)
    {
      step.Ends[0] += by;
      step.Ends[1] += by;
    }
    this->Bounds.Lower += by;
    this->Bounds.Upper += by;
  }
};

int VertexOf(const RegionChains& chains, const ChainUseOfRegion& use, std::size_t end)
{
  const auto& vertices = chains.Chains[static_cast<std::size_t>(use.Chain)].Vertices;
  return vertices[use.Reversed ? 1 - end : end];
}

/// Turns a loop so that it begins at a vertex; false when it does not come by.
bool BeginAt(int vertex, const RegionChains& chains, UseLoop& loop)
{
  const auto first = std::find_if(loop.begin(), loop.end(),
    [&](const ChainUseOfRegion& use) { return VertexOf(chains, use, 0) == vertex; });
  if (first == loop.end())
  {
    return false;
  }
  std::rotate(loop.begin(), first, loop.end());
  return true;
}

/// @param begin  of the loop; the parameter around which it runs is taken as it is.
LaidOutLoop LayOut(
  const UseLoop& loop, const std::vector<EdgeShape>& shapes, const RegionLoops& region, int around)
{
  constexpr int Samples = 48; // of an edge
  LaidOutLoop laid;
  laid.Around = around;
  PointMatrix t(Samples + 1, 1);
  const AnalyticPatch& patch = region.Patch;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  if (around >= 0)
  {
    last[region.Winding] = around == 0 ? region.Seam : region.Seam + Turn;
  }
  std::vector<Eigen::Vector2d> path;
  for (const ChainUseOfRegion& use : loop)
  {
    for (int i = 0; i <= Samples; ++i)
    {
      const double s = static_cast<double>(i) / Samples;
      t(i, 0) = use.Reversed ? 1.0 - s : s;
    }
    const PointMatrix points = shapes[static_cast<std::size_t>(use.Chain)].Points(t);
    LoopStep& step = laid.Steps.emplace_back();
    step.Chain = use.Chain;
    step.Reversed = use.Reversed;
    for (int i = path.empty() ? 0 : 1; i <= Samples; ++i)
    {
      Eigen::Vector2d place = patch.ParametersNear(points.row(i).transpose(), last);
      if (path.empty() && around >= 0)
      {
        place[region.Winding] = last[region.Winding];
      }
      last = place;
      path.push_back(place);
    }
    step.Ends[use.Reversed ? 1 : 0] = path[path.size() - 1 - Samples];
    step.Ends[use.Reversed ? 0 : 1] = path.back();
  }
  Eigen::Vector2d end = path.front();
  if (around >= 0)
  {
    end[region.Winding] += around == 0 ? Turn : -Turn;
  }
  path.back() = end;
  LoopStep& step = laid.Steps.back();
  step.Ends[step.Reversed ? 0 : 1] = end;
  for (std::size_t i = 0; i < path.size(); ++i)
  {
    const Eigen::Vector2d& a = path[i];
    const Eigen::Vector2d& b = path[(i + 1) % path.size()];
    laid.Area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    laid.Bounds.Add(a);
  }
  return laid;
}

/// Moves a loop by turns to where its middle is nearest to a place.
void MoveNear(const AnalyticPatch& patch, const Eigen::Vector2d& place, LaidOutLoop& loop)
{
  Eigen::Vector2d by = Eigen::Vector2d::Zero();
  for (int d = 0; d < 2; ++d)
  {
    if (patch.IsPeriodic(d))
    {
      by[d] = Turn * std::round((place[d] - loop.Bounds.Centre()[d]) / Turn);
    }
  }
  loop.Move(by);
}

Eigen::Vector2d EndOf(const LoopStep& step, std::size_t end)
{
  return step.Ends[step.Reversed ? 1 - end : end];
}

/// Joins the loops that run around by seams, and poles in the place of a missing one.
LaidOutLoop JoinAround(std::array<LaidOutLoop*, 2> around, const RegionLoops& region)
{
  const int d = region.Winding;
  const int e = 1 - d;
  const std::array<double, 2> turns{ region.Seam, region.Seam + Turn };
  std::array<LaidOutLoop, 2> parts;
  for (std::size_t k = 0; k < 2; ++k)
  {
    if (around[k])
    {
      parts[k] = *around[k];
      continue;
    }
    LoopStep& pole = parts[k].Steps.emplace_back();
    pole.Kind = LoopStepKind::Pole;
    for (std::size_t end = 0; end < 2; ++end)
    {
      pole.Ends[end][d] = turns[k == 0 ? end : 1 - end];
      pole.Ends[end][e] = region.Patch.Poles()[k];
      parts[k].Bounds.Add(pole.Ends[end]);
    }
  }
  if (region.Patch.IsPeriodic(e)) // a torus: the way from one to the other is less than a turn
  {
    const double sign = d == 0 ? 1.0 : -1.0;
    const double way =
      sign * (EndOf(parts[1].Steps.front(), 0)[e] - EndOf(parts[0].Steps.back(), 1)[e]);
    Eigen::Vector2d by = Eigen::Vector2d::Zero();
    by[e] = -sign * Turn * std::floor(way / Turn);
    parts[1].Move(by);
  }
  LaidOutLoop joined = parts[0];
  LoopStep seam;
  seam.Kind = LoopStepKind::Seam;
  seam.Ends = { EndOf(parts[0].Steps.back(), 1), EndOf(parts[1].Steps.front(), 0) };
  joined.Steps.push_back(seam);
  joined.Steps.insert(joined.Steps.end(), parts[1].Steps.begin(), parts[1].Steps.end());
  seam.Reversed = true;
  seam.Ends = { EndOf(parts[0].Steps.front(), 0), EndOf(parts[1].Steps.back(), 1) };
  joined.Steps.push_back(seam);
  joined.Bounds.Add(parts[1].Bounds.Lower);
  joined.Bounds.Add(parts[1].Bounds.Upper);
  return joined;
}

/// The range of the patch around the outer loop; curved edges get some room.
void SetRange(const Box& bounds, bool straight, RegionLoops& region)
{
  constexpr double Room = 0.01;
  AnalyticPatch& patch = region.Patch;
  Eigen::Vector2d lower = bounds.Lower;
  Eigen::Vector2d upper = bounds.Upper;
  const Eigen::Vector2d room = (straight ? 0.0 : Room) * (upper - lower);
  for (int d = 0; d < 2; ++d)
  {
    if (d == region.Winding)
    {
      lower[d] = region.Seam;
      upper[d] = region.Seam + Turn;
      continue;
    }
    const std::array<double, 2> poles =
      d == 1 ? patch.Poles() : std::array<double, 2>{ -HUGE_VAL, HUGE_VAL };
    const bool below = lower[d] > poles[0];
    const bool above = upper[d] < poles[1];
    const double least = below && std::isfinite(poles[0]) ? 0.5 * (lower[d] + poles[0]) : poles[0];
    const double most = above && std::isfinite(poles[1]) ? 0.5 * (upper[d] + poles[1]) : poles[1];
    lower[d] = below ? std::max(lower[d] - room[d], least) : lower[d];
    upper[d] = above ? std::min(upper[d] + room[d], most) : upper[d];
  }
  patch.SetRange(lower, upper);
}
}

Status LayOutLoops(
  int region, const RegionChains& chains, const std::vector<EdgeShape>& shapes, RegionLoops& loops)
{
  const Status failure = NoLayout(region, loops.Patch.Surface());
  std::vector<LaidOutLoop> laid;
  bool straight = true;
  std::vector<UseLoop> oriented = OrientedLoops(chains, region, loops.Reversed);
  for (std::size_t l = 0; l < oriented.size(); ++l)
  {
    UseLoop& loop = oriented[l];
    const auto found = std::find(loops.Around.begin(), loops.Around.end(), static_cast<int>(l));
    const int around =
      found == loops.Around.end() ? -1 : static_cast<int>(found - loops.Around.begin());
    if (around >= 0 && !BeginAt(loops.SeamVertices[static_cast<std::size_t>(around)], chains, loop))
    {
      return failure;
    }
    laid.push_back(LayOut(loop, shapes, loops, around));
    for (const ChainUseOfRegion& use : loop)
    {
      straight =
        straight && shapes[static_cast<std::size_t>(use.Chain)].Kind == EdgeShapeKind::Line;
    }
  }
  loops.Steps.clear();
  if (laid.empty())
  {
    const bool isSphere = loops.Patch.Surface().Type == SurfaceType::Sphere;
    loops.Patch.SetRange({ 0.0, isSphere ? -0.5 * Pi : 0.0 }, { Turn, isSphere ? 0.5 * Pi : Turn });
    return {};
  }
  LaidOutLoop outer;
  if (loops.Winding >= 0)
  {
    std::array<LaidOutLoop*, 2> around{ nullptr, nullptr };
    for (LaidOutLoop& loop : laid)
    {
      if (loop.Around >= 0)
      {
        around[static_cast<std::size_t>(loop.Around)] = &loop;
      }
    }
    outer = JoinAround(around, loops);
  }
  else
  {
    const auto largest = std::max_element(laid.begin(), laid.end(),
      [](const LaidOutLoop& a, const LaidOutLoop& b) { return a.Area < b.Area; });
    outer = *largest;
    largest->Around = 0;
    if (outer.Area <= 0.0)
    {
      return failure;
    }
  }
  loops.Steps.push_back(outer.Steps);
  for (LaidOutLoop& loop : laid)
  {
    if (loop.Around < 0)
    {
      MoveNear(loops.Patch, outer.Bounds.Centre(), loop);
      loops.Steps.push_back(loop.Steps);
    }
  }
  SetRange(outer.Bounds, straight && loops.Patch.Surface().Type == SurfaceType::Plane, loops);
  return {};
}
}
