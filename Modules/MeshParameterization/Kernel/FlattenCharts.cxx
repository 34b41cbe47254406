// SPDX-License-Identifier: BSD-3-Clause
#include "FlattenCharts.h"

#include "ChartLayout.h"
#include "DivideChart.h"
#include "FlattenMethods.h"
#include "FlattenReport.h"
#include "JoinCharts.h"
#include "PlaneLoops.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr double Infinite = std::numeric_limits<double>::infinity();
constexpr int MendingRounds = 5; // for maps that rounding has folded

Status CheckChartParams(const ChartParams& params)
{
  const auto bad = [](const char* text) { return Status(ErrorCode::InvalidParameter, text); };
  if (!(params.MaxStretch > 1.0 && std::isfinite(params.MaxStretch)))
  {
    return bad("MaxStretch not above 1");
  }
  if (params.MaxCharts < 1 || params.MaxCharts > 100000)
  {
    return bad("MaxCharts outside [1, 100000]");
  }
  if (!(params.CreaseAngle > 0.0 && params.CreaseAngle < 180.0))
  {
    return bad("CreaseAngle outside (0, 180)");
  }
  return {};
}

/// Charts with their loops side by side, from the places of triangles.
/// @return NotConverged: charts without a map.
Status CollectCharts(const CutMesh& mesh, const std::vector<ChartMap>& maps, FlattenMethod method,
  std::vector<MeshParameterization>& charts)
{
  charts.clear();
  const auto without =
    std::count_if(maps.begin(), maps.end(), [](const ChartMap& map) { return !map.Exists; });
  if (without > 0)
  {
    return { ErrorCode::NotConverged,
      std::to_string(without) + " of " + std::to_string(maps.size()) +
        " charts are no discs yet; allow more charts" };
  }
  std::vector<std::vector<int>> triangles(maps.size());
  for (std::size_t t = 0; t < mesh.Charts.size(); ++t)
  {
    triangles[static_cast<std::size_t>(mesh.Charts[t])].push_back(static_cast<int>(t));
  }
  for (std::size_t c = 0; c < maps.size(); ++c)
  {
    auto part = TakePart(mesh, triangles[c]);
    if (!part)
    {
      return part.Status;
    }
    MeshParameterization chart;
    chart.Mesh = std::move(part.Value.Mesh);
    chart.UV.resize(chart.Mesh.NumPoints(), 2);
    for (std::size_t i = 0; i < triangles[c].size(); ++i)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        chart.UV.row(chart.Mesh.Triangles[i][k]) =
          mesh.UV[static_cast<std::size_t>(triangles[c][i])][k].transpose();
      }
    }
    chart.Mesh.PointIds = std::move(part.Value.Points);
    chart.Mesh.TriangleIds = triangles[c];
    SortLoopsByArea(chart.Mesh, chart.UV);
    chart.Used = maps[c].Used;
    chart.FallbackReason = chart.Used == method ? std::string() : maps[c].Reason;
    chart.RejectedEigenvectors = maps[c].RejectedEigenvectors;
    charts.push_back(std::move(chart));
  }
  PlaceSideBySide(charts);
  for (MeshParameterization& chart : charts)
  {
    chart.Injective = CheckInjective(chart.Mesh, chart.UV);
  }
  return {};
}

/// Lays out the changed charts, and divides the worst ones until all are good or as many as may be.
Status MapAndDivide(CutMesh& cut, const FlattenParams& params, const ChartParams& charts,
  const std::vector<int>& holes, std::vector<int> changed, std::vector<ChartMap>& maps)
{
  const double crease = charts.CreaseAngle * Pi / 180.0;
  for (;;)
  {
    for (int chart : changed)
    {
      const auto part = TakePart(cut, cut.TrianglesOf(chart));
      if (!part)
      {
        return part.Status;
      }
      ChartMap& map = maps[static_cast<std::size_t>(chart)];
      map = MapChart(part.Value.Mesh, params, charts.MaxStretch);
      PlaceTriangles(part.Value, map, cut);
    }
    const auto worst = std::max_element(maps.begin(), maps.end(),
      [](const ChartMap& a, const ChartMap& b)
      { return (a.Good ? 0.0 : a.Stretch) < (b.Good ? 0.0 : b.Stretch); });
    int numCharts = static_cast<int>(maps.size());
    if (worst->Good || numCharts >= charts.MaxCharts)
    {
      return {};
    }
    const EdgeCrossing crossing =
      worst->Stretch <= charts.MaxStretch ? worst->Crossing : EdgeCrossing{};
    auto divided =
      DivideChart(cut, static_cast<int>(worst - maps.begin()), crossing, holes, crease, numCharts);
    if (!divided)
    {
      return divided.Status;
    }
    changed = std::move(divided.Value);
    maps.resize(static_cast<std::size_t>(numCharts));
  }
}

/// Charts that are good as long as places are exact, but lie over themselves as they are rounded in
/// the end, become ones to divide between what lies over each other.
/// @return whether there are some.
bool MarkFolded(const std::vector<MeshParameterization>& charts, std::vector<ChartMap>& maps)
{
  bool some = false;
  for (std::size_t c = 0; c < maps.size(); ++c)
  {
    const DiscMesh& mesh = charts[c].Mesh;
    if (!maps[c].Good || charts[c].Injective || mesh.Triangles.size() < 2)
    {
      continue;
    }
    some = true;
    maps[c].Good = false;
    maps[c].Crossing = {};
    if (IsCounterclockwise(mesh, charts[c].UV))
    {
      const EdgeCrossing overlap = FindOverlap(mesh.Loops, charts[c].UV);
      for (std::size_t k = 0; k < 2; ++k)
      {
        maps[c].Crossing.First[k] = mesh.PointIds[static_cast<std::size_t>(overlap.First[k])];
        maps[c].Crossing.Second[k] = mesh.PointIds[static_cast<std::size_t>(overlap.Second[k])];
      }
    }
  }
  return some;
}
}

Result<ChartedMesh> FlattenCharts(
  const TriangleMesh& mesh, const FlattenParams& params, const ChartParams& charts)
{
  const auto start = std::chrono::steady_clock::now();
  if (Status status = CheckFlattenParams(params); !status)
  {
    return status;
  }
  if (Status status = CheckChartParams(charts); !status)
  {
    return status;
  }
  const auto surface = CheckSurface(mesh, params.LargestComponent);
  if (!surface)
  {
    return surface.Status;
  }
  CutMesh cut(surface.Value);
  const std::vector<int> holes = FindSmallHoles(surface.Value);
  std::vector<ChartMap> maps(1);
  if (Status status = MapAndDivide(cut, params, charts, holes, { 0 }, maps); !status)
  {
    return status;
  }
  if (Status status = JoinCharts(cut, params, charts, maps); !status)
  {
    return status;
  }
  Result<ChartedMesh> result;
  ChartedMesh& charted = result.Value;
  if (Status status = CollectCharts(cut, maps, params.Method, charted.Charts); !status)
  {
    return status;
  }
  for (int round = 0; round < MendingRounds && MarkFolded(charted.Charts, maps); ++round)
  {
    CutMesh divided = cut;
    std::vector<ChartMap> dividedMaps = maps;
    std::vector<MeshParameterization> mended;
    Status status = MapAndDivide(divided, params, charts, holes, {}, dividedMaps);
    status = status ? CollectCharts(divided, dividedMaps, params.Method, mended) : status;
    if (status.Code == ErrorCode::Aborted)
    {
      return status;
    }
    if (!status)
    {
      break; // not to be mended: a result beyond the limit
    }
    cut = std::move(divided);
    maps = std::move(dividedMaps);
    charted.Charts = std::move(mended);
  }
  for (std::size_t c = 0; c < maps.size(); ++c)
  {
    charted.WithinLimit = charted.WithinLimit && maps[c].Good && charted.Charts[c].Injective;
  }
  charted.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (MeshParameterization& chart : charted.Charts)
  {
    chart.Measures = MeasureMap(chart.Mesh, chart.UV, params.Geodesics);
  }
  charted.Reversed = surface->Reversed;
  charted.Components = surface->Components;
  charted.Points.resize(static_cast<Eigen::Index>(cut.Points.size()), 3);
  for (std::size_t i = 0; i < cut.Points.size(); ++i)
  {
    charted.Points.row(static_cast<Eigen::Index>(i)) = cut.Points[i].transpose();
  }
  charted.Origins = std::move(cut.Origins);
  charted.Triangles = std::move(cut.Triangles);
  charted.TriangleIds = std::move(cut.TriangleIds);
  return result;
}

ChartedMesh OneChart(MeshParameterization map)
{
  ChartedMesh mesh;
  mesh.Points = map.Mesh.Points;
  mesh.Triangles = map.Mesh.Triangles;
  mesh.TriangleIds = map.Mesh.TriangleIds;
  mesh.Reversed = map.Mesh.Reversed;
  mesh.Components = map.Mesh.Components;
  mesh.Seconds = map.Seconds;
  for (int id : map.Mesh.PointIds)
  {
    PointOrigin origin;
    origin.Points[0] = id;
    origin.Weights[0] = 1.0;
    mesh.Origins.push_back(origin);
  }
  std::iota(map.Mesh.PointIds.begin(), map.Mesh.PointIds.end(), 0);
  std::iota(map.Mesh.TriangleIds.begin(), map.Mesh.TriangleIds.end(), 0);
  mesh.Charts.push_back(std::move(map));
  return mesh;
}

FlattenMeasures TotalMeasures(const ChartedMesh& mesh)
{
  FlattenMeasures total;
  total.MinSingularValue = Infinite;
  total.SingularValues.resize(static_cast<Eigen::Index>(mesh.Triangles.size()), 2);
  double area = 0.0;
  double points = 0.0;
  for (const MeshParameterization& chart : mesh.Charts)
  {
    const FlattenMeasures& m = chart.Measures;
    const double a = chart.Mesh.Area;
    const double n = chart.Mesh.NumPoints();
    area += a;
    points += n;
    total.FlippedTriangles += m.FlippedTriangles;
    total.MeanStretch += a * m.MeanStretch;
    total.MaxStretch = std::max(total.MaxStretch, m.MaxStretch);
    total.MinSingularValue = std::min(total.MinSingularValue, m.MinSingularValue);
    total.MaxSingularValue = std::max(total.MaxSingularValue, m.MaxSingularValue);
    total.MeanAreaDistortion += a * m.MeanAreaDistortion;
    total.MaxAreaDistortion = std::max(total.MaxAreaDistortion, m.MaxAreaDistortion);
    total.IsometryError += a * m.IsometryError * m.IsometryError;
    total.DistanceError += n * m.DistanceError * m.DistanceError;
    for (std::size_t t = 0; t < chart.Mesh.TriangleIds.size(); ++t)
    {
      total.SingularValues.row(chart.Mesh.TriangleIds[t]) =
        m.SingularValues.row(static_cast<Eigen::Index>(t));
    }
  }
  total.MeanStretch /= area;
  total.MeanAreaDistortion /= area;
  total.IsometryError = std::sqrt(total.IsometryError / area);
  total.DistanceError = std::sqrt(total.DistanceError / points);
  return total;
}
}
