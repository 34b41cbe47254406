// SPDX-License-Identifier: BSD-3-Clause
#include "MapChart.h"
#include <knotwork/SplineCore/Numbers.h>

#include "FlattenMethods.h"
#include "FlattenReport.h"
#include "InjectiveMap.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int TrialIterations = 10;    // after which a hopeless map is given up
constexpr double LeastDecrease = 1e-4; // of the energy in an iteration: many maps are tried

/// What a map is worth, without its UV.
ChartMap Judge(const DiscMesh& mesh, double limit, FlattenMethod method, const PointMatrix& uv)
{
  ChartMap map;
  map.Stretch = LargestStretch(mesh, uv);
  if (std::isfinite(map.Stretch) && !IsCounterclockwise(mesh, uv))
  {
    map.Stretch = std::numeric_limits<double>::infinity();
  }
  if (std::isfinite(map.Stretch))
  {
    map.Crossing = FindCrossing(mesh, uv);
  }
  map.Good = map.Stretch <= limit && !map.Crossing;
  map.Used = method;
  map.Exists = true;
  return map;
}

/// Takes a map over when it is good, or better than one that is not.
void Keep(const ChartMap& map, PointMatrix uv, ChartMap& best)
{
  if (map.Good || !best.Exists || (!best.Good && map.Stretch < best.Stretch))
  {
    std::string reason = std::move(best.Reason);
    const int rejected = best.RejectedEigenvectors;
    best = map;
    best.UV = std::move(uv);
    best.Reason = std::move(reason);
    best.RejectedEigenvectors = rejected;
  }
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
  return map.Crossing ? "lets parts of the boundary meet"
                      : "stretches " + Digits(map.Stretch, 3) + " times";
}
}

ChartMap MapChart(const DiscMesh& mesh, const FlattenParams& params, double maxStretch)
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
    Keep(Judge(mesh, maxStretch, params.Method, flat->UV), flat->UV, best);
  }
  if (best.Good || !params.Fallback || params.Method == FlattenMethod::Injective)
  {
    return best;
  }
  best.Reason = std::string(ToString(params.Method)) + " " + Fault(flat, mesh, best);
  auto injective = MapWithoutFlips(mesh);
  if (!injective)
  {
    return best;
  }
  const auto consider = [&](const PointMatrix& uv)
  {
    ChartMap map = Judge(mesh, maxStretch, FlattenMethod::Injective, uv);
    Keep(map, uv, best);
    return map;
  };
  // the conformal map's scale varies like exp(distance) where the best map's does like distance
  if (consider(injective->UV).Stretch > std::exp(2.0 * maxStretch))
  {
    return best;
  }
  int iteration = 0;
  RelaxParams relax;
  relax.MaxIterations = params.MaxIterations;
  relax.LeastDecrease = LeastDecrease;
  relax.GoOn = [&](PointMatrix uv)
  {
    const bool wasGood = best.Good;
    NormalizeSimilarity(mesh, uv);
    const ChartMap map = consider(uv);
    // the boundary may come to cross itself while the energy falls: then the last good map stays
    const bool hopeless = map.Crossing || map.Stretch > 2.0 * maxStretch;
    return map.Good || (!wasGood && (++iteration < TrialIterations || !hopeless));
  };
  RelaxMap(mesh, relax, injective->UV);
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
