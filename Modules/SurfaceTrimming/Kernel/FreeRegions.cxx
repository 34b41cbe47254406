// SPDX-License-Identifier: BSD-3-Clause
#include "FreeRegions.h"
#include <knotwork/MeshParameterization/MeshFeatures.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

double NumParameters(SurfaceType type)
{
  switch (type)
  {
    case SurfaceType::Plane:
      return 3.0;
    case SurfaceType::Sphere:
      return 4.0;
    case SurfaceType::Cylinder:
      return 5.0;
    case SurfaceType::Cone:
      return 6.0;
    case SurfaceType::Torus:
      return 7.0;
    case SurfaceType::FreeForm:
      break;
  }
  return HUGE_VAL;
}

/// Undirected edges of triangles with those beside them.
std::map<std::array<int, 2>, std::vector<int>> EdgesOf(
  const std::vector<std::array<int, 3>>& triangles)
{
  std::map<std::array<int, 2>, std::vector<int>> edges;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto [a, b] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      edges[{ a, b }].push_back(static_cast<int>(t));
    }
  }
  return edges;
}

/// Lengths of the borders of regions with others.
class Borders
{
public:
  Borders(const DiscMesh& surface, const SurfaceRecognition& recognition)
    : Recognition(recognition), Sharp(recognition.Regions.size(), 0.0),
      All(recognition.Regions.size(), 0.0)
  {
    const double least = std::cos(25.0 * 3.14159265358979323846 / 180.0);
    const auto normal = [&](int t) -> Eigen::Vector3d
    {
      const auto& [a, b, c] = surface.Triangles[At(t)];
      return (surface.Point(b) - surface.Point(a))
        .cross(surface.Point(c) - surface.Point(a))
        .normalized();
    };
    for (const auto& [edge, beside] : EdgesOf(surface.Triangles))
    {
      if (beside.size() != 2)
      {
        continue;
      }
      const int own = recognition.RegionOfTriangle[At(beside[0])];
      const int other = recognition.RegionOfTriangle[At(beside[1])];
      const double length = (surface.Point(edge[0]) - surface.Point(edge[1])).norm();
      const bool isSharp = normal(beside[0]).dot(normal(beside[1])) < least;
      for (const auto& [from, to] : { std::pair(own, other), std::pair(other, own) })
      {
        this->All[At(from)] += own != other ? length : 0.0;
        this->Sharp[At(from)] += own != other && isSharp ? length : 0.0;
        if (own != other && !isSharp)
        {
          this->Smooth[from][to] += length;
        }
      }
    }
  }

  /// Whether the mesh is sharp along most of a region's border, and goes on smoothly into what is
  /// of free form along little of it.
  bool EndAtEdges(int region) const
  {
    constexpr double LeastSharp = 0.5;
    constexpr double MostIntoFree = 0.25;
    double intoFree = 0.0;
    if (const auto smooth = this->Smooth.find(region); smooth != this->Smooth.end())
    {
      for (const auto& [other, length] : smooth->second)
      {
        const SurfaceType type = this->Recognition.Regions[At(other)].Surface.Type;
        intoFree += type == SurfaceType::FreeForm ? length : 0.0;
      }
    }
    const double all = this->All[At(region)];
    return all > 0.0 && this->Sharp[At(region)] >= LeastSharp * all &&
      intoFree <= MostIntoFree * all;
  }

private:
  const SurfaceRecognition& Recognition;
  std::map<int, std::map<int, double>> Smooth;
  std::vector<double> Sharp;
  std::vector<double> All;
};

constexpr double Exact = 0.02; ///< of the tolerance: distances that are none

/// Whether distances from the surface are nothing, or those of noise, or the region ends mostly at
/// sharp edges.
bool IsOnItsSurface(
  const DiscMesh& surface, const RecognizedRegion& region, bool endsAtEdges, double tolerance)
{
  constexpr double Enough = 3.0;    // points a parameter
  constexpr double Many = 6.0;      // by which residuals of few points do not pass for noise
  constexpr double MaxNoise = 0.5;  // of the tolerance: what grew as far as it could goes up to it
  constexpr double MaxAlike = 0.25; // correlation of neighbours; that of noise is about 0
  std::map<int, double> distances;
  for (const int t : region.Triangles)
  {
    for (const int corner : surface.Triangles[At(t)])
    {
      distances[corner] = region.Surface.Distance(surface.Point(corner));
    }
  }
  const double parameters = NumParameters(region.Surface.Type);
  const auto count = static_cast<double>(distances.size());
  // facets of any shape are planes, and their rows cylinders
  const bool isFlat = region.Surface.Type == SurfaceType::Plane && endsAtEdges;
  if (isFlat ? count < parameters + 2.0 : count < Enough * parameters)
  {
    return false;
  }
  double squares = 0.0;
  double largest = 0.0;
  for (const auto& [point, distance] : distances)
  {
    squares += distance * distance;
    largest = std::max(largest, std::abs(distance));
  }
  if (largest <= Exact * tolerance || endsAtEdges)
  {
    return true;
  }
  if (largest > MaxNoise * tolerance || count < Many * parameters)
  {
    return false;
  }
  double products = 0.0;
  double pairs = 0.0;
  for (const int t : region.Triangles)
  {
    const auto& corners = surface.Triangles[At(t)];
    for (std::size_t k = 0; k < 3; ++k)
    {
      products += distances[corners[k]] * distances[corners[(k + 1) % 3]];
      ++pairs;
    }
  }
  return products / pairs < MaxAlike * squares / count;
}

/// Sets that grow together.
class Unions
{
public:
  explicit Unions(std::size_t count) : Parents(count)
  {
    std::iota(this->Parents.begin(), this->Parents.end(), 0);
  }
  int Find(int i)
  {
    while (this->Parents[At(i)] != i)
    {
      this->Parents[At(i)] = this->Parents[At(this->Parents[At(i)])];
      i = this->Parents[At(i)];
    }
    return i;
  }
  void Join(int a, int b) { this->Parents[At(this->Find(a))] = this->Find(b); }

private:
  std::vector<int> Parents;
};

/// Parts of what is of free form: apart from each other by sharp edges, but for small ones.
class FreeParts
{
public:
  FreeParts(const DiscMesh& surface, const SurfaceRecognition& recognition)
    : Surface(surface), Edges(EdgesOf(surface.Triangles)), Sets(surface.Triangles.size())
  {
    this->IsFree.resize(surface.Triangles.size());
    for (std::size_t t = 0; t < this->IsFree.size(); ++t)
    {
      const auto region = At(recognition.RegionOfTriangle[t]);
      this->IsFree[t] = recognition.Regions[region].Surface.Type == SurfaceType::FreeForm;
    }
    const auto features = FindMeshFeatures(surface);
    this->ForFreePairs(
      [&](int s, int t, const std::array<int, 2>&)
      {
        if (!features || features->Regions[At(s)] == features->Regions[At(t)])
        {
          this->Sets.Join(s, t);
        }
      });
    while (this->JoinSmall(recognition.Tolerance))
    {
    }
  }

  /// Triangles of each part, ascending.
  std::vector<std::vector<int>> Collect()
  {
    std::map<int, std::vector<int>> parts;
    for (std::size_t t = 0; t < this->IsFree.size(); ++t)
    {
      if (this->IsFree[t])
      {
        parts[this->Sets.Find(static_cast<int>(t))].push_back(static_cast<int>(t));
      }
    }
    std::vector<std::vector<int>> all;
    for (auto& [set, triangles] : parts)
    {
      all.push_back(std::move(triangles));
    }
    std::sort(all.begin(), all.end());
    return all;
  }

private:
  template <typename Visit>
  void ForFreePairs(const Visit& visit)
  {
    for (const auto& [edge, triangles] : this->Edges)
    {
      if (triangles.size() == 2 && this->IsFree[At(triangles[0])] && this->IsFree[At(triangles[1])])
      {
        visit(triangles[0], triangles[1], edge);
      }
    }
  }

  /// Joins parts that are hardly wider than the tolerance to the neighbour with the longest common
  /// border. @return whether there were any.
  bool JoinSmall(double tolerance)
  {
    constexpr double Wide = 3.0; // tolerances
    std::map<int, double> areas;
    for (std::size_t t = 0; t < this->IsFree.size(); ++t)
    {
      if (this->IsFree[t])
      {
        areas[this->Sets.Find(static_cast<int>(t))] +=
          TriangleArea(this->Surface.Points, this->Surface.Triangles[t]);
      }
    }
    const auto isSmall = [&](int set) { return areas[set] < Wide * Wide * tolerance * tolerance; };
    std::map<std::pair<int, int>, double> borders;
    this->ForFreePairs(
      [&](int s, int t, const std::array<int, 2>& edge)
      {
        const int a = this->Sets.Find(s);
        const int b = this->Sets.Find(t);
        const double length = (this->Surface.Point(edge[0]) - this->Surface.Point(edge[1])).norm();
        for (const auto& [own, other] : { std::pair(a, b), std::pair(b, a) })
        {
          if (a != b && isSmall(own))
          {
            borders[{ own, other }] += length;
          }
        }
      });
    std::map<int, std::pair<double, int>> longest;
    for (const auto& [pair, length] : borders)
    {
      auto& best = longest[pair.first];
      best = std::max(best, { length, pair.second });
    }
    for (const auto& [own, best] : longest)
    {
      this->Sets.Join(own, best.second);
    }
    return !longest.empty();
  }

  const DiscMesh& Surface;
  std::map<std::array<int, 2>, std::vector<int>> Edges;
  Unions Sets;
  std::vector<char> IsFree;
};

std::array<int, 3> Turned(const std::array<int, 3>& triangle, std::size_t first)
{
  return { triangle[first], triangle[(first + 1) % 3], triangle[(first + 2) % 3] };
}

/// A place on an edge of the mesh.
struct EdgePlace
{
  std::array<int, 2> Edge{ -1, -1 }; ///< ascending
  double Share = 0.0;                ///< from the first one
};

/// A chart while points come to its rim.
struct GrowingChart
{
  std::vector<std::array<int, 3>> Triangles; ///< rows of Ids
  std::vector<int> Ids;                      ///< points of the mesh
  std::vector<Eigen::Vector2d> UV;
};

/// The points of triangles, each once for every fan of triangles around it: fans that touch in a
/// point only have it for themselves.
class FanPoints
{
public:
  /// @param corners  of triangles.
  explicit FanPoints(const std::vector<std::array<int, 3>>& corners) : Sets(3 * corners.size())
  {
    for (const auto& [edge, beside] : EdgesOf(corners))
    {
      for (std::size_t i = 1; i < beside.size(); ++i)
      {
        for (const int point : edge)
        {
          this->Sets.Join(CornerOf(corners, beside[0], point), CornerOf(corners, beside[i], point));
        }
      }
    }
    std::map<int, int> numbers;
    for (std::size_t t = 0; t < corners.size(); ++t)
    {
      auto& own = this->Triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int set = this->Sets.Find(static_cast<int>(3 * t + k));
        const auto [at, isNew] = numbers.try_emplace(set, static_cast<int>(this->Ids.size()));
        if (isNew)
        {
          this->Ids.push_back(corners[t][k]);
        }
        own[k] = at->second;
      }
    }
  }

  std::vector<std::array<int, 3>> Triangles; ///< rows of Ids
  std::vector<int> Ids;

private:
  static int CornerOf(const std::vector<std::array<int, 3>>& corners, int triangle, int point)
  {
    const auto& own = corners[At(triangle)];
    return 3 * triangle + static_cast<int>(std::find(own.begin(), own.end(), point) - own.begin());
  }

  Unions Sets;
};

class RegionCharter
{
public:
  RegionCharter(const DiscMesh& surface, const SurfaceRecognition& recognition)
    : Surface(surface), Recognition(recognition)
  {
    for (Eigen::Index i = 0; i < surface.Points.rows(); ++i)
    {
      this->Points.push_back(surface.Point(static_cast<int>(i)));
    }
  }

  Status Flatten(const FreeRegionParams& params)
  {
    const std::vector<std::vector<int>> parts =
      FreeParts(this->Surface, this->Recognition).Collect();
    for (std::size_t p = 0; p < parts.size(); ++p)
    {
      if (Status status = this->FlattenPart(parts[p], params); !status)
      {
        return { status.Code, "region of free form " + std::to_string(p) + ": " + status.Detail };
      }
      this->Made.SmoothRegion.resize(this->Charts.size(), static_cast<int>(p));
    }
    return {};
  }

  Result<ChartedRegions> Assemble();

private:
  Status FlattenPart(const std::vector<int>& triangles, const FreeRegionParams& params);
  void Split(std::vector<std::array<int, 3>>& triangles, std::vector<int>& regions) const;
  void Split(GrowingChart& chart) const;
  int FirstBetween(int from, int to) const;
  double ShareOf(const std::array<int, 2>& edge, int point) const;

  const DiscMesh& Surface;
  const SurfaceRecognition& Recognition;
  std::vector<Eigen::Vector3d> Points; ///< of the mesh, then where charts are cut
  std::map<int, EdgePlace> Places;     ///< of points that were made on edges
  /// Of an edge: points that were made on it, with their shares.
  std::map<std::array<int, 2>, std::map<double, int>> OnEdges;
  std::vector<GrowingChart> Charts;
  ChartedRegions Made;
};

Status RegionCharter::FlattenPart(const std::vector<int>& triangles, const FreeRegionParams& params)
{
  std::vector<std::array<int, 3>> corners;
  for (const int t : triangles)
  {
    corners.push_back(this->Surface.Triangles[At(t)]);
  }
  FanPoints fans(corners);
  const std::vector<int>& ids = fans.Ids;
  TriangleMesh part;
  part.Triangles = std::move(fans.Triangles);
  part.Points.resize(static_cast<Eigen::Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    part.Points.row(static_cast<Eigen::Index>(i)) = this->Surface.Points.row(ids[i]);
  }
  const auto charted = FlattenCharts(part, params.Flatten, params.Charts);
  if (!charted)
  {
    return charted.Status;
  }
  std::vector<int> numbers; // in the mesh, of points of the cut part
  for (std::size_t i = 0; i < charted->Origins.size(); ++i)
  {
    const PointOrigin& origin = charted->Origins[i];
    if (origin.Points[1] < 0)
    {
      numbers.push_back(ids[At(origin.Points[0])]);
      continue;
    }
    int number = static_cast<int>(this->Points.size());
    if (origin.Points[2] < 0)
    {
      const int a = ids[At(origin.Points[0])];
      const int b = ids[At(origin.Points[1])];
      EdgePlace place;
      place.Edge = { std::min(a, b), std::max(a, b) };
      place.Share = origin.Weights[a < b ? 1 : 0];
      number = this->OnEdges[place.Edge].try_emplace(place.Share, number).first->second;
      this->Places[number] = place;
    }
    numbers.push_back(number);
    if (At(number) == this->Points.size())
    {
      this->Points.emplace_back(charted->Points.row(static_cast<Eigen::Index>(i)).transpose());
    }
  }
  for (const MeshParameterization& map : charted->Charts)
  {
    GrowingChart& chart = this->Charts.emplace_back();
    chart.Triangles = map.Mesh.Triangles;
    for (std::size_t i = 0; i < map.Mesh.PointIds.size(); ++i)
    {
      chart.Ids.push_back(numbers[At(map.Mesh.PointIds[i])]);
      chart.UV.emplace_back(map.UV.row(static_cast<Eigen::Index>(i)).transpose());
    }
  }
  return {};
}

double RegionCharter::ShareOf(const std::array<int, 2>& edge, int point) const
{
  return point == edge[0] ? 0.0 : point == edge[1] ? 1.0 : this->Places.at(point).Share;
}

/// The next point that was made on the way along an edge of the mesh; -1: none.
int RegionCharter::FirstBetween(int from, int to) const
{
  const auto a = this->Places.find(from);
  const auto b = this->Places.find(to);
  const std::array<int, 2> edge = a != this->Places.end() ? a->second.Edge
    : b != this->Places.end()                             ? b->second.Edge
                              : std::array<int, 2>{ std::min(from, to), std::max(from, to) };
  const auto isOn = [&](int point)
  {
    const auto place = this->Places.find(point);
    return point == edge[0] || point == edge[1] ||
      (place != this->Places.end() && place->second.Edge == edge);
  };
  const auto points = this->OnEdges.find(edge);
  if (points == this->OnEdges.end() || !isOn(from) || !isOn(to))
  {
    return -1;
  }
  const double lower = std::min(this->ShareOf(edge, from), this->ShareOf(edge, to));
  const double upper = std::max(this->ShareOf(edge, from), this->ShareOf(edge, to));
  const auto next = points->second.upper_bound(lower);
  return next != points->second.end() && next->first < upper ? next->second : -1;
}

/// Divides triangles at points that were made on their edges.
void RegionCharter::Split(
  std::vector<std::array<int, 3>>& triangles, std::vector<int>& regions) const
{
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto [a, b, c] = Turned(triangles[t], k);
      if (const int middle = this->FirstBetween(a, b); middle >= 0)
      {
        triangles[t] = { a, middle, c };
        triangles.push_back({ middle, b, c });
        regions.push_back(int(regions[t]));
        --t; // there may be more
        break;
      }
    }
  }
}

/// The same on the rim of a chart.
void RegionCharter::Split(GrowingChart& chart) const
{
  for (std::size_t t = 0; t < chart.Triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto [a, b, c] = Turned(chart.Triangles[t], k);
      const int from = chart.Ids[At(a)];
      const int to = chart.Ids[At(b)];
      const int point = this->FirstBetween(from, to);
      if (point < 0)
      {
        continue;
      }
      const std::array<int, 2>& edge = this->Places.at(point).Edge;
      const double begin = this->ShareOf(edge, from);
      const double share = (this->ShareOf(edge, point) - begin) / (this->ShareOf(edge, to) - begin);
      const int middle = static_cast<int>(chart.Ids.size());
      chart.Ids.push_back(point);
      chart.UV.emplace_back((1.0 - share) * chart.UV[At(a)] + share * chart.UV[At(b)]);
      chart.Triangles[t] = { a, middle, c };
      chart.Triangles.push_back({ middle, b, c });
      --t;
      break;
    }
  }
}

Result<ChartedRegions> RegionCharter::Assemble()
{
  SurfaceRecognition& regions = this->Made.Recognition;
  regions.Tolerance = this->Recognition.Tolerance;
  regions.Noise = this->Recognition.Noise;
  std::vector<int> newRegion(this->Recognition.Regions.size(), -1);
  for (std::size_t r = 0; r < newRegion.size(); ++r)
  {
    const RecognizedRegion& region = this->Recognition.Regions[r];
    if (region.Surface.Type != SurfaceType::FreeForm)
    {
      newRegion[r] = static_cast<int>(regions.Regions.size());
      this->Made.Origins.push_back(static_cast<int>(r));
      regions.Regions.push_back(region);
      regions.Regions.back().Triangles.clear();
    }
  }
  this->Made.FirstChart = static_cast<int>(regions.Regions.size());
  TriangleMesh mesh;
  for (std::size_t t = 0; t < this->Surface.Triangles.size(); ++t)
  {
    const int region = newRegion[At(this->Recognition.RegionOfTriangle[t])];
    if (region >= 0)
    {
      mesh.Triangles.push_back(this->Surface.Triangles[t]);
      regions.RegionOfTriangle.push_back(region);
    }
  }
  this->Split(mesh.Triangles, regions.RegionOfTriangle);
  for (GrowingChart& chart : this->Charts)
  {
    this->Split(chart);
    const int region = static_cast<int>(regions.Regions.size());
    regions.Regions.emplace_back().Surface.Type = SurfaceType::FreeForm;
    for (const auto& [a, b, c] : chart.Triangles)
    {
      mesh.Triangles.push_back({ chart.Ids[At(a)], chart.Ids[At(b)], chart.Ids[At(c)] });
      regions.RegionOfTriangle.push_back(region);
    }
  }
  mesh.Points.resize(static_cast<Eigen::Index>(this->Points.size()), 3);
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    mesh.Points.row(static_cast<Eigen::Index>(i)) = this->Points[i].transpose();
  }
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    regions.Regions[At(regions.RegionOfTriangle[t])].Triangles.push_back(static_cast<int>(t));
  }
  for (const RecognizedRegion& region : regions.Regions)
  {
    ++regions.NumOfType[static_cast<std::size_t>(region.Surface.Type)];
  }
  auto checked = CheckSurface(mesh);
  if (!checked)
  {
    return checked.Status;
  }
  if (checked->Triangles != mesh.Triangles)
  {
    return { ErrorCode::InvalidTopology, "charts of free form do not fit to what is beside them" };
  }
  this->Made.Surface = std::move(checked.Value);
  for (const GrowingChart& growing : this->Charts)
  {
    ChartMesh& chart = this->Made.Charts.emplace_back();
    const auto count = static_cast<Eigen::Index>(growing.Ids.size());
    chart.Points.resize(count, 3);
    chart.UV.resize(count, 2);
    for (Eigen::Index i = 0; i < count; ++i)
    {
      const auto row = static_cast<std::size_t>(i);
      chart.Points.row(i) = this->Points[At(growing.Ids[row])].transpose();
      chart.UV.row(i) = growing.UV[row].transpose();
    }
    chart.PointIds.assign(growing.Ids.begin(), growing.Ids.end());
    chart.Triangles = growing.Triangles;
  }
  return std::move(this->Made);
}
}

double ReleaseDoubtfulRegions(const DiscMesh& surface, SurfaceRecognition& recognition)
{
  const Borders borders(surface, recognition);
  for (bool isNew = true; isNew;) // what is released is beside others
  {
    isNew = false;
    for (std::size_t r = 0; r < recognition.Regions.size(); ++r)
    {
      RecognizedRegion& region = recognition.Regions[r];
      if (region.Surface.Type != SurfaceType::FreeForm &&
        !IsOnItsSurface(
          surface, region, borders.EndAtEdges(static_cast<int>(r)), recognition.Tolerance))
      {
        region.Surface.Type = SurfaceType::FreeForm;
        isNew = true;
      }
    }
  }
  double analytic = 0.0;
  recognition.NumOfType = {};
  for (const RecognizedRegion& region : recognition.Regions)
  {
    ++recognition.NumOfType[static_cast<std::size_t>(region.Surface.Type)];
    for (const int t : region.Triangles)
    {
      analytic += region.Surface.Type == SurfaceType::FreeForm
        ? 0.0
        : TriangleArea(surface.Points, surface.Triangles[At(t)]);
    }
  }
  return analytic / surface.Area;
}

bool IsPatchwork(const DiscMesh& surface, const SurfaceRecognition& recognition)
{
  SurfaceRecognition left = recognition;
  ReleaseDoubtfulRegions(surface, left);
  double doubtful = 0.0;
  for (std::size_t r = 0; r < left.Regions.size(); ++r)
  {
    const RecognizedRegion& region = left.Regions[r];
    if (region.Surface.Type == SurfaceType::FreeForm &&
      region.MaxDistance > Exact * recognition.Tolerance)
    {
      for (const int t : region.Triangles)
      {
        doubtful += TriangleArea(surface.Points, surface.Triangles[At(t)]);
      }
    }
  }
  return doubtful > 0.5 * surface.Area;
}

Result<ChartedRegions> ChartFreeRegions(
  const DiscMesh& surface, const SurfaceRecognition& recognition, const FreeRegionParams& params)
{
  RegionCharter charter(surface, recognition);
  if (Status status = charter.Flatten(params); !status)
  {
    return status;
  }
  return charter.Assemble();
}
}
