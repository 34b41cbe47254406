// SPDX-License-Identifier: BSD-3-Clause
#include "MapChart.h"

#include "FlattenMethods.h"
#include "FlattenReport.h"
#include "InjectiveMap.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace knotwork
{
namespace
{
constexpr int TrialIterations = 10;    // after which a hopeless map is given up
constexpr double LeastDecrease = 1e-4; // of the energy in an iteration: many maps are tried

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
  map.Exists = true;
  if (map.Good || !best.Exists || map.Stretch < best.Stretch)
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
  if (!hopeless && RelaxMap(mesh, trial, LeastDecrease, uv) &&
    LargestStretch(mesh, uv) < 2.0 * limit && !FindCrossing(mesh, uv))
  {
    RelaxMap(mesh, params.MaxIterations - trial, LeastDecrease, uv);
  }
  NormalizeSimilarity(mesh, uv);
  Consider(mesh, limit, FlattenMethod::Injective, std::move(uv), best);
  return best;
}

void PlaceTriangles(const ChartPart& part, ChartMap& map, CutMesh& mesh)
{
  for (std::size_t i = 0; i < part.Triangles.size() && map.Exists; ++i)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      mesh.UV[static_cast<std::size_t>(part.Triangles[i])][k] =
        map.UV.row(part.Mesh.Triangles[i][k]).transpose();
    }
  }
  map.UV.resize(0, 2);
  for (auto* edge : { &map.Crossing.First, &map.Crossing.Second })
  {
    for (int& v : *edge)
    {
      v = v < 0 ? v : part.Points[static_cast<std::size_t>(v)];
    }
  }
}
}
