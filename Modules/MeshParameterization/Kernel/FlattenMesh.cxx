// SPDX-License-Identifier: BSD-3-Clause
#include "FlattenMethods.h"
#include "FlattenReport.h"
#include "InjectiveMap.h"
#include "PlaneLoops.h"
#include "ReferenceMaps.h"
#include "SpectralMaps.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace knotwork
{
Status CheckFlattenParams(const FlattenParams& params)
{
  const auto bad = [](const char* text) { return Status(ErrorCode::InvalidParameter, text); };
  if (params.Neighbours < 6 || params.Neighbours > 50)
  {
    return bad("Neighbours outside [6, 50]");
  }
  if (params.Landmarks < 3 || params.Landmarks > 10000)
  {
    return bad("Landmarks outside [3, 10000]");
  }
  if (params.MaxIterations < 1 || params.MaxIterations > 10000)
  {
    return bad("MaxIterations outside [1, 10000]");
  }
  if (!(params.MinParticipation >= 0.0 && params.MinParticipation < 1.0))
  {
    return bad("MinParticipation outside [0, 1)");
  }
  return {};
}

Result<FlatMesh> RunFlattenMethod(
  const DiscMesh& mesh, FlattenMethod method, const FlattenParams& params)
{
  Result<FlatMesh> result;
  switch (method)
  {
    case FlattenMethod::Hlle:
      result = HessianEigenmap(mesh, params);
      break;
    case FlattenMethod::Isomap:
      result = LandmarkIsomap(mesh, params);
      break;
    case FlattenMethod::Laplacian:
      result = LaplacianEigenmap(mesh, params);
      break;
    case FlattenMethod::Lscm:
      result = LeastSquaresConformalMap(mesh);
      break;
    case FlattenMethod::Arap:
      result = AsRigidAsPossibleMap(mesh, params.MaxIterations);
      break;
    case FlattenMethod::Injective:
      result = InjectiveMap(mesh, params.MaxIterations);
      break;
  }
  if (result && !result.Value.UV.allFinite())
  {
    return { ErrorCode::SingularSystem, "coordinates are not finite" };
  }
  return result;
}

void SortLoopsByArea(DiscMesh& mesh, const PointMatrix& uv)
{
  const auto area = [&](const std::vector<int>& loop)
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const int a = loop[i];
      const int b = loop[(i + 1) % loop.size()];
      sum += uv(a, 0) * uv(b, 1) - uv(b, 0) * uv(a, 1);
    }
    return std::abs(sum);
  };
  std::stable_sort(mesh.Loops.begin(), mesh.Loops.end(),
    [&](const auto& a, const auto& b) { return area(a) > area(b); });
}

const char* ToString(FlattenMethod method)
{
  switch (method)
  {
    case FlattenMethod::Hlle:
      return "hlle";
    case FlattenMethod::Isomap:
      return "isomap";
    case FlattenMethod::Laplacian:
      return "laplacian";
    case FlattenMethod::Lscm:
      return "lscm";
    case FlattenMethod::Arap:
      return "arap";
    default:
      return "injective";
  }
}

Result<MeshParameterization> FlattenMesh(const TriangleMesh& mesh, const FlattenParams& params)
{
  const auto start = std::chrono::steady_clock::now();
  if (Status status = CheckFlattenParams(params); !status)
  {
    return status;
  }
  auto disc = CheckMesh(mesh, params.LargestComponent);
  if (!disc)
  {
    return disc.Status;
  }
  Result<MeshParameterization> result;
  MeshParameterization& map = result.Value;
  map.Mesh = std::move(disc.Value);
  map.Used = params.Method;
  auto flat = RunFlattenMethod(map.Mesh, params.Method, params);
  const bool mayFallBack = params.Fallback && params.Method == FlattenMethod::Hlle;
  if (!flat && !mayFallBack)
  {
    return flat.Status;
  }
  int flips = flat ? CountFlips(map.Mesh, flat->UV) : -1;
  if (mayFallBack && flips != 0)
  {
    const std::string reason = std::string(ToString(params.Method)) +
      (flat ? " flips " + std::to_string(flips) + " triangles" : ": " + flat.Status.Message());
    for (FlattenMethod method :
      { FlattenMethod::Arap, FlattenMethod::Injective, FlattenMethod::Lscm })
    {
      if (flips == 0 || method == params.Method)
      {
        continue;
      }
      auto other = RunFlattenMethod(map.Mesh, method, params);
      const int otherFlips = other ? CountFlips(map.Mesh, other->UV) : -1;
      if (other && (flips < 0 || otherFlips < flips))
      {
        flat = std::move(other);
        flips = otherFlips;
        map.Used = method;
        map.FallbackReason = reason;
      }
    }
    if (!flat)
    {
      return flat.Status;
    }
  }
  map.UV = std::move(flat->UV);
  map.RejectedEigenvectors = flat->RejectedEigenvectors;
  NormalizeSimilarity(map.Mesh, map.UV);
  SortLoopsByArea(map.Mesh, map.UV);
  map.Injective = CheckInjective(map.Mesh, map.UV);
  map.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  map.Measures = MeasureMap(map.Mesh, map.UV, params.Geodesics);
  return result;
}
}
