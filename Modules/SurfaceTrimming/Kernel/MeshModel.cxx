// SPDX-License-Identifier: BSD-3-Clause
#include "ChartedModel.h"
#include "RegionEvidence.h"
#include "SnapSurfaces.h"
#include <knotwork/DomainParameterization/WorkBudget.h>
#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <numeric>
#include <string>

namespace knotwork
{
namespace
{
constexpr int ManyFaces = 1000;
constexpr double LeastEffort = 1e-6; ///< with which first nets are made
constexpr std::size_t FewFaces = 100;
constexpr std::size_t TrianglesOfFace = 6;

/// The faces of another part beside those that are there.
void Append(RegionModel&& part, RegionModel& all)
{
  for (TrimmedFace& face : part.Model.Faces)
  {
    for (TrimmedLoop& loop : face.Loops)
    {
      for (TrimmingCurve& use : loop.Curves)
      {
        use.Edge += all.Model.NumEdges;
        use.Vertices[0] += all.Model.NumVertices;
        use.Vertices[1] += all.Model.NumVertices;
      }
    }
    all.Model.Faces.push_back(std::move(face));
  }
  all.Model.NumEdges += part.Model.NumEdges;
  all.Model.NumVertices += part.Model.NumVertices;
  all.Work += part.Work;
  all.Verdicts.insert(all.Verdicts.end(), part.Verdicts.begin(), part.Verdicts.end());
  all.Certificates.insert(
    all.Certificates.end(), part.Certificates.begin(), part.Certificates.end());
  for (std::size_t t = 0; t < all.NumOfType.size(); ++t)
  {
    all.NumOfType[t] += part.NumOfType[t];
  }
  for (int RegionModel::*const count : { &RegionModel::NumRims, &RegionModel::NumPoleFaces,
         &RegionModel::NumEdges, &RegionModel::NumLines, &RegionModel::NumCircles,
         &RegionModel::NumSharpEdges, &RegionModel::NumVertices })
  {
    all.*count += part.*count;
  }
  for (double RegionModel::*const distance :
    { &RegionModel::MaxPointDistance, &RegionModel::MaxDistance, &RegionModel::MaxEdgeDistance,
      &RegionModel::MaxEdgeGap, &RegionModel::FreeDeviation, &RegionModel::MaxNormalAngle,
      &RegionModel::MaxVertexDistance, &RegionModel::Tolerance })
  {
    all.*distance = std::max(all.*distance, part.*distance);
  }
}

bool HasFreeForm(const SurfaceRecognition& recognition)
{
  return recognition.NumOfType[static_cast<std::size_t>(SurfaceType::FreeForm)] > 0;
}

/// Analytic faces and, beside them, charts with spline surfaces.
/// @param failed  result: analytic regions that are no faces, see ModelCharted.
Result<RegionModel> ModelMixed(const DiscMesh& surface, const SurfaceRecognition& recognition,
  const RegionModelParams& params, std::vector<int>& failed)
{
  FreeRegionParams free;
  free.Flatten = params.Flatten;
  free.Flatten.Threads = params.Threads;
  free.Charts = params.Charts;
  auto charted = ChartFreeRegions(surface, recognition, free);
  if (!charted)
  {
    failed.clear();
    return charted.Status;
  }
  const std::vector<int> origins = charted->Origins;
  auto model = ModelCharted(charted->Surface, charted->Recognition, &charted.Value, params, failed);
  std::vector<int> analytic;
  for (const int region : failed)
  {
    if (region < static_cast<int>(origins.size()))
    {
      analytic.push_back(origins[static_cast<std::size_t>(region)]);
    }
  }
  failed = std::move(analytic);
  return model;
}

/// A model of one part. Regions that are no faces as they are become ones of free form.
Result<RegionModel> ModelPart(
  const DiscMesh& surface, SurfaceRecognition& recognition, const RegionModelParams& params)
{
  constexpr int MaxReleases = 8;
  Result<RegionModel> model;
  for (int release = 0; release <= MaxReleases; ++release)
  {
    std::vector<int> failed;
    const double before = model.Value.Work;
    model = params.FreeForm && HasFreeForm(recognition)
      ? ModelMixed(surface, recognition, params, failed)
      : ModelCharted(surface, recognition, nullptr, params, failed);
    model.Value.Work += before;
    if (!params.FreeForm || failed.empty() || release == MaxReleases)
    {
      break;
    }
    for (const int region : failed)
    {
      SurfaceType& type = recognition.Regions[static_cast<std::size_t>(region)].Surface.Type;
      --recognition.NumOfType[static_cast<std::size_t>(type)];
      type = SurfaceType::FreeForm;
      ++recognition.NumOfType[static_cast<std::size_t>(type)];
    }
  }
  return model;
}

/// One region of free form.
SurfaceRecognition AllFree(const DiscMesh& surface, double tolerance)
{
  SurfaceRecognition all;
  RecognizedRegion& region = all.Regions.emplace_back();
  region.Triangles.resize(surface.Triangles.size());
  std::iota(region.Triangles.begin(), region.Triangles.end(), 0);
  all.RegionOfTriangle.assign(surface.Triangles.size(), 0);
  all.NumOfType[static_cast<std::size_t>(SurfaceType::FreeForm)] = 1;
  all.Tolerance = tolerance;
  all.Noise = tolerance;
  return all;
}

struct RecognizedPart
{
  DiscMesh Surface;
  SurfaceRecognition Recognition;
};

/// @param analytic  result: share of the area of surfaces that are not of free form.
Result<std::vector<RecognizedPart>> RecognizeParts(const TriangleMesh& mesh,
  const RecognitionParams& recognition, const RegionModelParams& params, double& analytic)
{
  const std::vector<MeshComponent> components = ConnectedComponents(mesh);
  if (components.empty())
  {
    return { ErrorCode::EmptyInput, "the mesh has no triangles" };
  }
  RecognitionParams own = recognition;
  own.Tolerance = recognition.Tolerance > 0.0
    ? recognition.Tolerance
    : 1e-3 * (mesh.Points.colwise().maxCoeff() - mesh.Points.colwise().minCoeff()).norm();
  own.MaxRegions = recognition.MaxRegions > 0 ? recognition.MaxRegions : ManyFaces;
  std::vector<RecognizedPart> parts;
  double area = 0.0;
  double known = 0.0;
  for (const MeshComponent& component : components)
  {
    auto surface = CheckComponent(mesh, component);
    if (!surface)
    {
      return surface.Status;
    }
    auto regions = RecognizeSurfaces(surface.Value, own);
    const bool mayBeFree = components.size() > 1 || !(params.LeastAnalytic > 0.0);
    if (regions.Status.Code == ErrorCode::NotInSpace && mayBeFree)
    {
      regions = AllFree(surface.Value, own.Tolerance);
    }
    if (!regions)
    {
      return regions.Status;
    }
    const bool isFree =
      HasFreeForm(regions.Value) || (params.FreeForm && IsPatchwork(surface.Value, regions.Value));
    const std::size_t faces = regions->Regions.size();
    if ((!isFree || !params.FreeForm) && faces > FewFaces &&
      faces * TrianglesOfFace > surface->Triangles.size())
    {
      return { ErrorCode::NotInSpace,
        std::to_string(faces) + " regions of " + std::to_string(surface->Triangles.size()) +
          " triangles are facets of a free shape" };
    }
    area += surface->Area;
    known += surface->Area *
      (isFree && params.FreeForm ? ReleaseDoubtfulRegions(surface.Value, regions.Value) : 1.0);
    parts.push_back({ std::move(surface.Value), std::move(regions.Value) });
  }
  analytic = known / area;
  return parts;
}
}

Result<RegionModel> ModelMesh(
  const TriangleMesh& mesh, const RecognitionParams& recognition, const RegionModelParams& params)
{
  double analytic = 0.0;
  RecognitionParams ofParts = recognition;
  ofParts.SnapDistance = std::min(recognition.SnapDistance, 0.0); // of all parts together
  auto parts = RecognizeParts(mesh, ofParts, params, analytic);
  if (!parts)
  {
    return parts.Status;
  }
  if (analytic < params.LeastAnalytic)
  {
    return { ErrorCode::NotInSpace,
      "planes, cylinders, spheres, cones and tori are only " + Digits(100.0 * analytic) +
        " % of the area, less than " + Digits(100.0 * params.LeastAnalytic) +
        " %; make spline faces of the whole" };
  }
  RegionModel all;
  if (recognition.SnapDistance > 0.0)
  {
    std::vector<SnappedPart> snapped;
    for (RecognizedPart& part : parts.Value)
    {
      snapped.push_back({ &part.Surface.Points, &part.Surface.Triangles, &part.Recognition });
    }
    all.Snapped = SnapSurfaces(
      snapped, std::min(recognition.SnapDistance, parts->front().Recognition.Tolerance));
  }
  WorkBudget budget(params.Trim.Effort, params.Trim.TimeLimit, {});
  RegionModelParams own = params;
  for (RecognizedPart& recognized : parts.Value)
  {
    own.Trim.Effort = std::max(params.Trim.Effort - all.Work, LeastEffort);
    own.Trim.TimeLimit = budget.SecondsLeft();
    auto part = ModelPart(recognized.Surface, recognized.Recognition, own);
    if (!part)
    {
      return part.Status;
    }
    Append(std::move(part.Value), all);
  }
  return all;
}
}
