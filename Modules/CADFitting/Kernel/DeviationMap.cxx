// SPDX-License-Identifier: BSD-3-Clause
#include "DeviationMap.h"

#include "MeshTarget.h"
#include "QueryBlocks.h"
#include "ScanCheck.h"

#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/SampleIndex.h>
#include <knotwork/SplineCore/TriangleIndex.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

namespace knotwork
{
namespace
{
constexpr double LongEdge = 1.4;  ///< of the edges that are wanted: halves are not far below them
constexpr double NextEdge = 0.85; ///< of these, where that leaves too few points
constexpr int MaxRounds = 64;
constexpr int MaxModelPoints = 20000000;
constexpr std::size_t TrianglesAtOnce = 65536;

/// Edges in the middle of which a point is put, common ones once.
class EdgeMiddles
{
public:
  EdgeMiddles(const PointMatrix& points, double longest)
    : Points(points), Longest(longest), Next(static_cast<int>(points.rows()))
  {
  }
  /// -1: the edge stays.
  int Of(int a, int b)
  {
    if ((this->Points.row(a) - this->Points.row(b)).norm() <= this->Longest)
    {
      return -1;
    }
    const auto [entry, isNew] =
      this->Middles.emplace(std::array<int, 2>{ std::min(a, b), std::max(a, b) }, this->Next);
    this->Next += isNew ? 1 : 0;
    return entry->second;
  }
  int NumPoints() const { return this->Next; }
  void AddTo(PointMatrix& points) const
  {
    points.conservativeResize(this->Next, 3);
    for (const auto& [ends, middle] : this->Middles)
    {
      points.row(middle) = 0.5 * (points.row(ends[0]) + points.row(ends[1]));
    }
  }

private:
  const PointMatrix& Points;
  double Longest;
  int Next;
  std::map<std::array<int, 2>, int> Middles;
};

/// Adds the parts of a triangle whose edges get middles where they are long.
void DivideTriangle(const std::array<int, 3>& triangle, EdgeMiddles& middles,
  std::vector<std::array<int, 3>>& divided)
{
  // turned so that the edges which stay come last
  const auto& [a, b, c] = triangle;
  std::array<int, 3> corner = triangle;
  std::array<int, 3> middle{ middles.Of(a, b), middles.Of(b, c), middles.Of(c, a) };
  for (int turn = 0; turn < 2 && (middle[0] < 0 || (middle[2] >= 0 && middle[1] < 0)); ++turn)
  {
    corner = { corner[1], corner[2], corner[0] };
    middle = { middle[1], middle[2], middle[0] };
  }
  if (middle[0] < 0)
  {
    divided.push_back(corner);
  }
  else if (middle[1] < 0)
  {
    divided.push_back({ corner[0], middle[0], corner[2] });
    divided.push_back({ middle[0], corner[1], corner[2] });
  }
  else if (middle[2] < 0)
  {
    divided.push_back({ middle[0], corner[1], middle[1] });
    divided.push_back({ corner[0], middle[0], middle[1] });
    divided.push_back({ corner[0], middle[1], corner[2] });
  }
  else
  {
    divided.push_back({ corner[0], middle[0], middle[2] });
    divided.push_back({ middle[0], corner[1], middle[1] });
    divided.push_back({ middle[2], middle[1], corner[2] });
    divided.push_back(middle);
  }
}

Status TooMany(int samples)
{
  return { ErrorCode::TooLarge,
    "for " + std::to_string(samples) + " samples the model would have more than " +
      std::to_string(MaxModelPoints) + " points: lower their number" };
}

/// Halves the edges that are longer, once, in all triangles along them.
/// @return whether there were such.
Result<bool> DivideOnce(
  TriangleMesh& mesh, double longest, int samples, const ProgressCallback& progress)
{
  EdgeMiddles middles(mesh.Points, longest);
  std::vector<std::array<int, 3>> divided;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const double share = static_cast<double>(t) / static_cast<double>(mesh.Triangles.size());
    if (t % TrianglesAtOnce == 0 && progress && !progress(share))
    {
      return { ErrorCode::Aborted, "the division of the model's triangles stopped" };
    }
    DivideTriangle(mesh.Triangles[t], middles, divided);
    if (middles.NumPoints() > std::max<Eigen::Index>(mesh.Points.rows(), MaxModelPoints))
    {
      return TooMany(samples);
    }
  }
  const bool isDivided = divided.size() > mesh.Triangles.size();
  if (isDivided)
  {
    middles.AddTo(mesh.Points);
    mesh.Triangles = std::move(divided);
  }
  return isDivided;
}

/// Points that triangles have, in their order.
void DropUnused(TriangleMesh& mesh)
{
  std::vector<int> number(static_cast<std::size_t>(mesh.Points.rows()), -1);
  PointMatrix points(mesh.Points.rows(), 3);
  int count = 0;
  for (auto& triangle : mesh.Triangles)
  {
    for (int& corner : triangle)
    {
      int& own = number[static_cast<std::size_t>(corner)];
      if (own < 0)
      {
        points.row(count) = mesh.Points.row(corner);
        own = count++;
      }
      corner = own;
    }
  }
  mesh.Points = points.topRows(count);
}

/// Halves long edges until there are none, and points enough.
Status Divide(TriangleMesh& mesh, int samples, const ProgressCallback& progress)
{
  DropUnused(mesh);
  double area = 0.0;
  for (const auto& triangle : mesh.Triangles)
  {
    area += TriangleArea(mesh.Points, triangle);
  }
  // of triangles with equal sides, two a point
  double longest = LongEdge * std::sqrt(2.0 * area / (std::sqrt(3.0) * samples));
  double done = 0.0;
  for (int round = 0; round < MaxRounds && longest > 0.0; ++round)
  {
    const double next = done + 0.5 * (1.0 - done); // nobody knows how many rounds there are
    const auto isDivided = DivideOnce(mesh, longest, samples, PartOf(progress, done, next));
    if (!isDivided)
    {
      return isDivided.Status;
    }
    done = next;
    if (!isDivided.Value && mesh.Points.rows() >= samples)
    {
      break;
    }
    longest *= isDivided.Value ? 1.0 : NextEdge;
  }
  DropUnused(mesh); // neighbours near each other: closest points are found faster so
  return {};
}

/// A third of the area around every point.
Eigen::VectorXd PointAreas(const TriangleMesh& mesh)
{
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.Points.rows());
  for (const auto& triangle : mesh.Triangles)
  {
    for (const int corner : triangle)
    {
      areas[corner] += TriangleArea(mesh.Points, triangle) / 3.0;
    }
  }
  return areas;
}

/// What lies between model points and a scan, positive where the scan lies outside.
struct ScanDistances
{
  Eigen::VectorXd Distances;
  PointMatrix Nearest; ///< of the scan
};

/// Of a scan that is a surface: inside and outside are its own. Open ones are turned as most of
/// the model's normals say.
Result<ScanDistances> FromSurface(const FitTarget& scan, const PointMatrix& queries,
  const PointMatrix& outward, const TargetDistanceParams& params)
{
  const auto sides = SidesOf(scan, { params.Threads, PartOf(params.Progress, 0.0, 0.2) });
  if (!sides)
  {
    return sides.Status;
  }
  auto measured = MeasureTargetDistances(
    scan, queries, sides.Value, { params.Threads, PartOf(params.Progress, 0.2, 1.0) });
  if (!measured)
  {
    return measured.Status;
  }
  const bool isTurned =
    !scan.IsClosed() && measured->Feet.Normals.cwiseProduct(outward).sum() < 0.0;
  return ScanDistances{ measured->Distances * (isTurned ? 1.0 : -1.0),
    std::move(measured->Feet.Points) };
}

/// Of points, and of triangles that are no surface: on the side that the model's normal says.
Result<ScanDistances> FromParts(const TriangleMesh& scan, const PointMatrix& queries,
  const PointMatrix& outward, const TargetDistanceParams& params)
{
  ScanDistances found{ Eigen::VectorXd(queries.rows()), PointMatrix(queries.rows(), 3) };
  const bool isMesh = !scan.Triangles.empty();
  const TriangleIndex<3> triangles =
    isMesh ? TriangleIndex<3>(scan.Points, scan.Triangles) : TriangleIndex<3>();
  const SampleIndex points = isMesh ? SampleIndex() : SampleIndex(scan.Points);
  const Status status = RunInBlocks(static_cast<std::size_t>(queries.rows()), params.Threads,
    params.Progress, "the search for closest points",
    [&](Eigen::Index begin, Eigen::Index end)
    {
      for (Eigen::Index i = begin; i < end; ++i)
      {
        const double* const at = queries.row(i).data();
        if (isMesh)
        {
          const TriangleFoot foot = triangles.Nearest(at);
          found.Nearest.row(i) = triangles.PointAt(foot.Triangle, foot.Second, foot.Third);
        }
        else
        {
          found.Nearest.row(i) = scan.Points.row(points.Nearest(at).Item);
        }
        const Eigen::RowVector3d offset = found.Nearest.row(i) - queries.row(i);
        found.Distances[i] = offset.dot(outward.row(i)) < 0.0 ? -offset.norm() : offset.norm();
      }
      return Status();
    });
  return status ? Result<ScanDistances>(std::move(found)) : status;
}

Result<ScanDistances> DistancesFromScan(const TriangleMesh& scan, const PointMatrix& queries,
  const PointMatrix& outward, const TargetDistanceParams& params)
{
  if (!scan.Triangles.empty())
  {
    const auto surface = MakeMeshTarget(scan);
    if (surface)
    {
      return FromSurface(*surface.Value, queries, outward, params);
    }
  }
  return FromParts(scan, queries, outward, params);
}

/// The profile by area of the points that are near enough; others get no distance.
Status ProfileModel(DeviationMap& map, double largest)
{
  const Eigen::VectorXd areas = PointAreas(map.Model);
  Eigen::VectorXd kept(areas.size());
  Eigen::VectorXd weights(areas.size());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < areas.size(); ++i)
  {
    if (largest > 0.0 && std::abs(map.OfModel[i]) > largest)
    {
      map.OfModel[i] = std::numeric_limits<double>::quiet_NaN();
      ++map.NumWithout;
      continue;
    }
    kept[count] = map.OfModel[i];
    weights[count++] = areas[i];
  }
  if (count == 0)
  {
    return { ErrorCode::InvalidParameter,
      "no point of the model is within " + Digits(largest) +
        " of the scan: align it first, or raise the largest distance" };
  }
  map.ModelProfile = ProfileOf(kept.head(count), weights.head(count));
  return {};
}
}

Result<DeviationMap> MapDeviation(const TriangleMesh& scan, const FitTarget& target,
  TriangleMesh triangles, const DeviationMapParams& params)
{
  if (params.Samples < 100 || !(params.MaximumDistance >= 0.0))
  {
    return { ErrorCode::InvalidParameter,
      "at least 100 points of the model are needed, and the largest distance must be 0 or more" };
  }
  if (params.Samples > MaxModelPoints)
  {
    return TooMany(params.Samples);
  }
  if (Status status = CheckScan(scan); !status)
  {
    return status;
  }
  if (!target.HasSurface() || triangles.Triangles.empty())
  {
    return { ErrorCode::EmptyInput,
      "the model has no faces: give triangles, spline surfaces, a CAD file or a volume" };
  }
  const auto part = [&](double begin, double end) -> TargetDistanceParams {
    return { params.Threads, PartOf(params.Progress, begin, end) };
  };
  DeviationMap map;
  const auto sides = SidesOf(target, part(0.0, 0.1));
  if (!sides)
  {
    return sides.Status;
  }
  auto ofScan = MeasureTargetDistances(target, scan.Points, sides.Value, part(0.1, 0.5));
  if (!ofScan)
  {
    return ofScan.Status;
  }
  map.OfScan = std::move(ofScan.Value);
  map.ScanProfile = ProfileOf(map.OfScan.Distances);
  if (Status status = Divide(triangles, params.Samples, PartOf(params.Progress, 0.5, 0.6)); !status)
  {
    return status;
  }
  TargetPoints feet;
  if (Status status = FindOnTarget(target, triangles.Points, feet, part(0.6, 0.8)); !status)
  {
    return status;
  }
  map.Model = { feet.Points, std::move(triangles.Triangles) };
  auto ofModel =
    DistancesFromScan(scan, map.Model.Points, sides->Outward * feet.Normals, part(0.8, 1.0));
  if (!ofModel)
  {
    return ofModel.Status;
  }
  map.OfModel = std::move(ofModel->Distances);
  map.ScanPoints = std::move(ofModel->Nearest);
  const Status status = ProfileModel(map, params.MaximumDistance);
  return status ? Result<DeviationMap>(std::move(map)) : status;
}
}
