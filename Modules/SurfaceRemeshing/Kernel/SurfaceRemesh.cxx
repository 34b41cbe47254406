// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceRemesh.h"

#include "EdgeSizes.h"
#include "FarthestDistance.h"
#include "RemeshLoop.h"
#include "SoupTopology.h"
#include "TrianglePairs.h"

#include <knotwork/SplineCore/Numbers.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double MostTriangles = 5e6;
constexpr double SmallestShare = 0.005; ///< of the diagonal: lengths by curvature
constexpr double LargestShare = 0.1;
constexpr double DegreesOfRadian = 180.0 / M_PI;
constexpr double FinestTolerance = 1e-4; ///< of the diagonal: of distances
constexpr double CoarsestTolerance = 2e-3;
constexpr double LoopShare = 0.9; ///< of the progress

/// Calls use(a, b, length) with every edge.
template <typename Use>
void ForEachLength(const PointMatrix& points, const std::vector<MeshTriangle>& triangles, Use&& use)
{
  ForEachEdge(SortedSides(triangles),
    [&](const SoupSide* begin, const SoupSide*)
    {
      use(
        begin->First, begin->Second, (points.row(begin->First) - points.row(begin->Second)).norm());
    });
}

double LeastAngle(const PointMatrix& points, const std::vector<MeshTriangle>& triangles)
{
  double least = M_PI;
  for (const MeshTriangle& corners : triangles)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Eigen::Vector3d a =
        (points.row(corners[(k + 1) % 3]) - points.row(corners[k])).transpose();
      const Eigen::Vector3d b =
        (points.row(corners[(k + 2) % 3]) - points.row(corners[k])).transpose();
      least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return least * DegreesOfRadian;
}

void AddNumbers(
  const PointMatrix& points, const std::vector<MeshTriangle>& triangles, RemeshNumbers& sum)
{
  double length = 0.0;
  int edges = 0;
  ForEachLength(points, triangles,
    [&](int, int, double one)
    {
      length += one;
      ++edges;
    });
  const auto before = static_cast<double>(sum.Points + sum.Triangles - sum.Euler); // edges
  sum.MeanEdge = (sum.MeanEdge * before + length) / (before + edges);
  sum.LeastAngle = sum.Parts == 0 ? LeastAngle(points, triangles)
                                  : std::min(sum.LeastAngle, LeastAngle(points, triangles));
  ++sum.Parts;
  sum.Points += static_cast<int>(points.rows());
  sum.Triangles += static_cast<int>(triangles.size());
  sum.Euler += EulerNumber(triangles);
  for (const MeshTriangle& corners : triangles)
  {
    sum.Area += TriangleArea(points, corners);
  }
  sum.Volume += SignedVolume(points, triangles);
}

Status CheckLength(const char* name, double length)
{
  if (length >= 0.0 && length <= LargestNumber)
  {
    return {};
  }
  return { ErrorCode::InvalidParameter,
    std::string(name) + " is the length of edges, above 0, or 0 for one that fits the mesh; " +
      Digits(length) + " was given" };
}

Status CheckShare(const char* name, double share)
{
  if (share > 0.0 && share <= 1.0)
  {
    return {};
  }
  return { ErrorCode::InvalidParameter,
    std::string(name) + " is a share of the diagonal, above 0 and at most 1; " + Digits(share) +
      " was given" };
}

Status CheckParams(const TriangleMesh& mesh, const SurfaceRemeshParams& params)
{
  for (const Status& status :
    { CheckLength("Size", params.Size), CheckLength("SmallestSize", params.SmallestSize),
      CheckLength("LargestSize", params.LargestSize), CheckShare("Tolerance", params.Tolerance),
      CheckShare("Limit", params.Limit) })
  {
    if (!status)
    {
      return status;
    }
  }
  if (params.Iterations < 1 || params.Iterations > 1000)
  {
    return { ErrorCode::InvalidParameter,
      "there are 1 to 1000 iterations; " + std::to_string(params.Iterations) + " were asked for" };
  }
  if (params.Sizing != EdgeSizing::PerPoint)
  {
    return {};
  }
  if (static_cast<Eigen::Index>(params.Sizes.size()) != mesh.Points.rows())
  {
    return { ErrorCode::SizeMismatch,
      "there are " + std::to_string(params.Sizes.size()) + " lengths of edges for " +
        std::to_string(mesh.Points.rows()) + " points; give one a point" };
  }
  for (std::size_t i = 0; i < params.Sizes.size(); ++i)
  {
    if (!(params.Sizes[i] > 0.0 && params.Sizes[i] <= LargestNumber))
    {
      return { ErrorCode::InvalidParameter,
        "the length of edges at point " + std::to_string(i) + " is " + Digits(params.Sizes[i]) +
          "; lengths are above 0" };
    }
  }
  return {};
}

/// A part of the input on its way.
struct Part
{
  DiscMesh Surface;
  MeshFeatures Features;
  std::vector<double> Sizes;
};

Result<std::vector<Part>> PartsOf(const TriangleMesh& mesh, const MeshFeatureParams& params)
{
  if (mesh.Triangles.empty() || mesh.Points.rows() == 0)
  {
    return { ErrorCode::EmptyInput, "the mesh has no triangles" };
  }
  std::vector<Part> parts;
  for (const MeshComponent& component : ConnectedComponents(mesh))
  {
    auto surface = CheckComponent(mesh, component);
    if (!surface)
    {
      const bool isShape = surface.Status.Code == ErrorCode::InvalidTopology;
      return { surface.Status.Code,
        surface.Status.Detail + (isShape ? "; repair the mesh first (job repair)" : "") };
    }
    auto features = FindMeshFeatures(surface.Value, params);
    if (!features)
    {
      return features.Status;
    }
    parts.push_back({ std::move(surface.Value), std::move(features.Value), {} });
  }
  if (parts.empty())
  {
    return { ErrorCode::EmptyInput, "no triangle of the mesh has an area" };
  }
  return parts;
}

void SetSizes(const SurfaceRemeshParams& params, double diagonal, double meanEdge, Part& part)
{
  const auto count = static_cast<std::size_t>(part.Surface.NumPoints());
  switch (params.Sizing)
  {
    case EdgeSizing::Constant:
      part.Sizes.assign(count, params.Size > 0.0 ? params.Size : meanEdge);
      return;
    case EdgeSizing::Curvature:
    {
      const double largest =
        params.LargestSize > 0.0 ? params.LargestSize : LargestShare * diagonal;
      const double smallest = std::min(
        largest, params.SmallestSize > 0.0 ? params.SmallestSize : SmallestShare * diagonal);
      for (const double curvature : LargestCurvatures(part.Surface, part.Features))
      {
        part.Sizes.push_back(
          std::clamp(ChordOf(curvature, params.Tolerance * diagonal), smallest, largest));
      }
      break;
    }
    case EdgeSizing::PerPoint:
      for (const int id : part.Surface.PointIds)
      {
        part.Sizes.push_back(params.Sizes[static_cast<std::size_t>(id)]);
      }
      break;
  }
  LimitGrowth(part.Surface, part.Sizes);
}

/// Equilateral triangles of the lengths that are asked for.
double ExpectedTriangles(const Part& part)
{
  double sum = 0.0;
  for (const MeshTriangle& corners : part.Surface.Triangles)
  {
    double size = 0.0;
    for (const int corner : corners)
    {
      size += part.Sizes[static_cast<std::size_t>(corner)] / 3.0;
    }
    sum += TriangleArea(part.Surface.Points, corners) / (std::sqrt(3.0) / 4.0 * size * size);
  }
  return sum;
}

/// Adds a remeshed part.
void Append(const Part& part, const RemeshedPart& made, int regions, SurfaceRemesh& result)
{
  const auto first = static_cast<int>(result.Mesh.Points.rows());
  const auto chains = result.LineChains.empty()
    ? 0
    : *std::max_element(result.LineChains.begin(), result.LineChains.end()) + 1;
  result.Mesh.Points.conservativeResize(first + static_cast<Eigen::Index>(made.Points.size()), 3);
  for (std::size_t i = 0; i < made.Points.size(); ++i)
  {
    result.Mesh.Points.row(first + static_cast<Eigen::Index>(i)) = made.Points[i].transpose();
  }
  result.Sizes.insert(result.Sizes.end(), made.Sizes.begin(), made.Sizes.end());
  for (std::size_t t = 0; t < made.Triangles.size(); ++t)
  {
    const auto& [a, b, c] = made.Triangles[t];
    result.Mesh.Triangles.push_back({ first + a, first + b, first + c });
    result.TriangleIds.push_back(
      part.Surface.TriangleIds[static_cast<std::size_t>(made.TriangleIds[t])]);
    result.RegionIds.push_back(regions + made.Regions[t]);
    result.PartIds.push_back(result.After.Parts);
  }
  for (std::size_t i = 0; i < made.Lines.size(); ++i)
  {
    result.Lines.push_back({ first + made.Lines[i][0], first + made.Lines[i][1] });
    result.LineChains.push_back(chains + made.LineChains[i]);
  }
  for (const int corner : made.Corners)
  {
    result.Corners.push_back(first + corner);
  }
  AddNumbers(result.Mesh.Points.bottomRows(static_cast<Eigen::Index>(made.Points.size())),
    made.Triangles, result.After);
}

void CountFitting(SurfaceRemesh& result)
{
  int edges = 0;
  int fitting = 0;
  ForEachLength(result.Mesh.Points, result.Mesh.Triangles,
    [&](int a, int b, double length)
    {
      const double ratio = 2.0 * length /
        (result.Sizes[static_cast<std::size_t>(a)] + result.Sizes[static_cast<std::size_t>(b)]);
      ++edges;
      fitting += ratio >= 4.0 / 5.0 && ratio <= 4.0 / 3.0 ? 1 : 0;
    });
  result.FittingEdges = static_cast<double>(fitting) / edges;
}

/// Distances of a part and what it became, both ways.
Status CheckDistances(
  const DiscMesh& surface, const RemeshedPart& made, double limit, SurfaceRemesh& result)
{
  PointMatrix points(static_cast<Eigen::Index>(made.Points.size()), 3);
  for (std::size_t i = 0; i < made.Points.size(); ++i)
  {
    points.row(static_cast<Eigen::Index>(i)) = made.Points[i].transpose();
  }
  RemeshNumbers numbers;
  AddNumbers(points, made.Triangles, numbers);
  const double tolerance = std::clamp(0.1 * numbers.MeanEdge, FinestTolerance * result.Diagonal,
    std::clamp(0.1 * limit, FinestTolerance, CoarsestTolerance) * result.Diagonal);
  const TriangleIndex<3> given(surface.Points, surface.Triangles);
  const LargestDistance from = FarthestFrom(given, points, made.Triangles, tolerance);
  const LargestDistance to = FarthestFrom(
    TriangleIndex<3>(points, made.Triangles), surface.Points, surface.Triangles, tolerance);
  const LargestDistance& larger = from.Value > to.Value ? from : to;
  if (larger.Value <= limit * result.Diagonal)
  {
    result.DistanceFromInput = std::max(result.DistanceFromInput, from.Value);
    result.DistanceToInput = std::max(result.DistanceToInput, to.Value);
    return {};
  }
  return { ErrorCode::NotConverged,
    "the remeshed surface is " + Digits(larger.Value / result.Diagonal, 3) +
      " of the diagonal from the given one at " + PointText(larger.Place.data(), 3) +
      "; ask for shorter edges, or raise Limit" };
}

Result<SurfaceRemesh> Remesh(const TriangleMesh& mesh, const SurfaceRemeshParams& params)
{
  auto parts = PartsOf(mesh, params.Features);
  if (!parts)
  {
    return parts.Status;
  }
  if (Status status = CheckParams(mesh, params); !status)
  {
    return status;
  }
  SurfaceRemesh result;
  Eigen::AlignedBox3d box;
  for (const Part& part : parts.Value)
  {
    AddNumbers(part.Surface.Points, part.Surface.Triangles, result.Before);
    box.extend(part.Surface.Points.colwise().minCoeff().transpose());
    box.extend(part.Surface.Points.colwise().maxCoeff().transpose());
  }
  result.Diagonal = box.diagonal().norm();
  double expected = 0.0;
  std::vector<double> shares;
  for (Part& part : parts.Value)
  {
    SetSizes(params, result.Diagonal, result.Before.MeanEdge, part);
    shares.push_back(ExpectedTriangles(part));
    expected += shares.back();
  }
  if (!(expected <= MostTriangles))
  {
    return { ErrorCode::TooLarge,
      "about " + Digits(expected, 3) + " triangles would be made, and at most " +
        Digits(MostTriangles) + " are; ask for longer edges" };
  }
  double done = 0.0;
  int regions = 0;
  result.Mesh.Points.resize(0, 3);
  for (std::size_t i = 0; i < parts->size(); ++i)
  {
    const Part& part = parts.Value[i];
    const double share = expected > 0.0 ? shares[i] / expected : 0.0;
    const auto goesOn = [&](double ofPart)
    { return !params.Progress || params.Progress(done + LoopShare * share * ofPart); };
    RemeshedPart made;
    Status status;
    // what is measured on the way, at middles, is less than what counts in the end
    for (const double ofLimit : { 0.5, 0.25, 0.125 })
    {
      if (!RemeshPart(part.Surface, part.Features, part.Sizes,
            ofLimit * params.Limit * result.Diagonal, params.Iterations, goesOn, made))
      {
        return { ErrorCode::Aborted, "" };
      }
      status = CheckDistances(part.Surface, made, params.Limit, result);
      if (status)
      {
        break;
      }
    }
    if (!status)
    {
      return status;
    }
    Append(part, made, regions, result);
    regions += part.Features.NumRegions;
    done += share;
    if (params.Progress && !params.Progress(std::min(done, 1.0)))
    {
      return { ErrorCode::Aborted, "" };
    }
  }
  CountFitting(result);
  result.Intersections = static_cast<int>(
    FindIntersections(result.Mesh.Points, result.Mesh.Triangles, params.Threads).size());
  return result;
}
}

Result<SurfaceRemesh> RemeshSurface(const TriangleMesh& mesh, const SurfaceRemeshParams& params)
try
{
  return Remesh(mesh, params);
}
catch (...)
{
  return StatusOfException();
}
}
