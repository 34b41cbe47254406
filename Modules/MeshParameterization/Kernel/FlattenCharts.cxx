// SPDX-License-Identifier: BSD-3-Clause
#include "FlattenCharts.h"

#include "DivideChart.h"
#include "FlattenMethods.h"
#include "FlattenReport.h"
#include "InjectiveMap.h"
#include "PlaneLoops.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr double Infinite = std::numeric_limits<double>::infinity();
constexpr int TrialIterations = 10; // after which a hopeless map is given up

/// What is known of a chart's map.
struct ChartMap
{
  bool Good = false;
  EdgeCrossing Crossing;     ///< of a map without flips
  double Stretch = Infinite; ///< infinite without a map, or when it flips
  PointMatrix UV;            ///< without rows when there is no map
  FlattenMethod Used = FlattenMethod::Hlle;
  std::string Reason; ///< why the method asked for was not used
  int RejectedEigenvectors = 0;
};

std::string Text(double value)
{
  std::ostringstream stream;
  stream.precision(3);
  stream << value;
  return stream.str();
}

/// Takes a map over when it is better than the one there is. @return whether it is good.
bool Consider(
  const DiscMesh& mesh, double limit, FlattenMethod method, PointMatrix uv, ChartMap& best)
{
  ChartMap map;
  map.Stretch = LargestStretch(mesh, uv);
  if (std::isfinite(map.Stretch))
  {
    map.Crossing = FindCrossing(mesh, uv);
  }
  map.Good = map.Stretch <= limit && !map.Crossing;
  map.Used = method;
  if (map.Good || best.UV.rows() == 0 || map.Stretch < best.Stretch)
  {
    map.UV = std::move(uv);
    map.Reason = std::move(best.Reason);
    map.RejectedEigenvectors = best.RejectedEigenvectors;
    best = std::move(map);
  }
  return best.Good;
}

std::string Fault(const Result<FlatMesh>& flat, const DiscMesh& mesh, const ChartMap& map)
{
  if (!flat)
  {
    return flat.Status.Message();
  }
  if (!std::isfinite(map.Stretch))
  {
    return "flips " + std::to_string(CountFlips(mesh, flat->UV)) + " triangles";
  }
  return map.Crossing ? "lets the boundary cross itself"
                      : "stretches " + Text(map.Stretch) + " times";
}

ChartMap MapChart(const DiscMesh& mesh, const FlattenParams& params, double limit)
{
  ChartMap best;
  if (!CheckDisc(mesh))
  {
    return best;
  }
  auto flat = RunFlattenMethod(mesh, params.Method, params);
  if (flat)
  {
    NormalizeSimilarity(mesh, flat->UV);
    best.RejectedEigenvectors = flat->RejectedEigenvectors;
    if (Consider(mesh, limit, params.Method, flat->UV, best))
    {
      return best;
    }
  }
  if (!params.Fallback || params.Method == FlattenMethod::Injective)
  {
    return best;
  }
  best.Reason = std::string(ToString(params.Method)) + " " + Fault(flat, mesh, best);
  auto injective = MapWithoutFlips(mesh);
  if (!injective)
  {
    return best;
  }
  PointMatrix& uv = injective->UV;
  // the conformal map's scale varies like exp(distance) where the best map's does like distance
  const bool hopeless = LargestStretch(mesh, uv) > std::exp(2.0 * limit);
  const int trial = std::min(TrialIterations, params.MaxIterations);
  if (!hopeless && RelaxMap(mesh, trial, uv) && LargestStretch(mesh, uv) < 2.0 * limit &&
    !FindCrossing(mesh, uv))
  {
    RelaxMap(mesh, params.MaxIterations - trial, uv);
  }
  NormalizeSimilarity(mesh, uv);
  Consider(mesh, limit, FlattenMethod::Injective, std::move(uv), best);
  return best;
}

/// Maps a chart, lays its triangles out in the cut mesh. @return without UV.
Result<ChartMap> LayChart(CutMesh& mesh, int chart, const FlattenParams& params, double limit)
{
  std::vector<int> triangles;
  for (std::size_t t = 0; t < mesh.Charts.size(); ++t)
  {
    if (mesh.Charts[t] == chart)
    {
      triangles.push_back(static_cast<int>(t));
    }
  }
  const auto part = TakePart(mesh, triangles);
  if (!part)
  {
    return part.Status;
  }
  ChartMap map = MapChart(part.Value.Mesh, params, limit);
  for (std::size_t i = 0; i < triangles.size() && map.UV.rows() > 0; ++i)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      mesh.UV[static_cast<std::size_t>(triangles[i])][k] =
        map.UV.row(part.Value.Mesh.Triangles[i][k]).transpose();
    }
  }
  if (map.UV.rows() == 0)
  {
    map.Stretch = Infinite;
  }
  for (auto* edge : { &map.Crossing.First, &map.Crossing.Second })
  {
    for (int& v : *edge)
    {
      v = v < 0 ? v : part.Value.Points[static_cast<std::size_t>(v)];
    }
  }
  return map;
}

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

/// Charts with their loops and measures, from the places of triangles.
Status CollectCharts(const CutMesh& mesh, std::vector<ChartMap>& maps, GeodesicEstimator geodesics,
  ChartedMesh& result)
{
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
    chart.Measures = MeasureMap(chart.Mesh, chart.UV, geodesics);
    chart.Used = maps[c].Used;
    chart.FallbackReason =
      chart.Used == maps[c].Used && !maps[c].Reason.empty() ? maps[c].Reason : "";
    chart.RejectedEigenvectors = maps[c].RejectedEigenvectors;
    result.Charts.push_back(std::move(chart));
  }
  return {};
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
  const double crease = charts.CreaseAngle * Pi / 180.0;
  std::vector<ChartMap> maps(1);
  int numCharts = 1;
  std::vector<int> changed{ 0 };
  for (;;)
  {
    maps.resize(static_cast<std::size_t>(numCharts));
    for (int chart : changed)
    {
      auto map = LayChart(cut, chart, params, charts.MaxStretch);
      if (!map)
      {
        return map.Status;
      }
      maps[static_cast<std::size_t>(chart)] = std::move(map.Value);
    }
    const auto worst = std::max_element(maps.begin(), maps.end(),
      [](const ChartMap& a, const ChartMap& b)
      { return (a.Good ? 0.0 : a.Stretch) < (b.Good ? 0.0 : b.Stretch); });
    if (worst->Good || numCharts >= charts.MaxCharts)
    {
      break;
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
  }
  Result<ChartedMesh> result;
  ChartedMesh& charted = result.Value;
  int without = 0;
  for (const ChartMap& map : maps)
  {
    without += map.UV.rows() == 0 ? 1 : 0;
    charted.WithinLimit = charted.WithinLimit && map.Good;
  }
  if (without > 0)
  {
    return { ErrorCode::NotConverged,
      std::to_string(without) + " of " + std::to_string(numCharts) +
        " charts are no discs yet; allow more charts" };
  }
  charted.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  charted.Reversed = surface->Reversed;
  charted.Components = surface->Components;
  if (Status status = CollectCharts(cut, maps, params.Geodesics, charted); !status)
  {
    return status;
  }
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
}
