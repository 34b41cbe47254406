// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceRepair.h"

#include "AlphaWrap.h"
#include "FarthestDistance.h"
#include "IntersectionRepair.h"
#include "OngoingRepair.h"
#include "OpenEdges.h"
#include "RepairDistances.h"
#include "SoupCleaning.h"
#include "SoupTopology.h"
#include "TrianglePairs.h"

#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double WrapToleranceShare = 2e-3; ///< of the diagonal: of distances of wraps

Status CheckInput(const TriangleMesh& mesh, const SurfaceRepairParams& params)
{
  const std::pair<const char*, double> shares[] = { { "Limit", params.Limit },
    { "LargestHole", params.LargestHole }, { "OverlapDepth", params.OverlapDepth },
    { "SmallestPart", params.SmallestPart } };
  for (const double share : { params.WrapAlpha, params.WrapOffset })
  {
    if (params.AlphaWrap && !(share > 0.0 && share <= 1.0))
    {
      return { ErrorCode::InvalidParameter,
        "WrapAlpha and WrapOffset are shares of the diagonal, above 0 and at most 1; " +
          Digits(share) + " was given" };
    }
  }
  for (const auto& [name, share] : shares)
  {
    if (!(share >= 0.0 && share <= 1.0))
    {
      return { ErrorCode::InvalidParameter,
        std::string(name) + " is a share of the diagonal, between 0 and 1; " + Digits(share) +
          " was given" };
    }
  }
  if (mesh.Triangles.empty())
  {
    return { ErrorCode::EmptyInput, "the mesh has no triangles" };
  }
  if (mesh.Points.cols() != 3)
  {
    return { ErrorCode::DimensionMismatch,
      "points of a surface have three coordinates, not " + std::to_string(mesh.Points.cols()) };
  }
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    if (!AllWithinLimit(mesh.Points.row(i)))
    {
      const bool finite = mesh.Points.row(i).array().isFinite().all();
      return { ErrorCode::NonFiniteInput,
        "point " + std::to_string(i) +
          (finite ? ": " + BeyondLimit() : " is not finite; remove it and its triangles") };
    }
  }
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    for (const int corner : mesh.Triangles[t])
    {
      if (corner < 0 || corner >= mesh.Points.rows())
      {
        return { ErrorCode::InvalidTopology,
          "triangle " + std::to_string(t) + " has a corner " + std::to_string(corner) +
            ", but there are " + std::to_string(mesh.Points.rows()) + " points" };
      }
    }
  }
  return {};
}

class Repair
{
public:
  Repair(const TriangleMesh& input, const SurfaceRepairParams& params)
    : Input(input), Ongoing{ params }
  {
  }

  Status Run(SurfaceRepair& result)
  {
    this->Start();
    for (const auto step : { &CleanSoup, &CloseOpenEdges, &RepairIntersections, &SettleParts })
    {
      this->Ongoing.Shown = this->Ongoing.Done;
      if (!this->Ongoing.GoesOn())
      {
        return { ErrorCode::Aborted, "" };
      }
      if (Status status = step(this->Work, this->Ongoing); !status)
      {
        return status;
      }
      this->Ongoing.Done += 0.25;
    }
    if (Status status = this->Finish(); !status)
    {
      return status;
    }
    result = std::move(this->Result);
    return {};
  }

  /// A surface around the input instead.
  Status Wrap(const std::string& reason, SurfaceRepair& result)
  {
    this->Start();
    SurfaceRepair& made = this->Result;
    const std::vector<char> degenerate =
      FindDegenerate(this->Work.Points, this->Work.Triangles, this->Ongoing.Params.Threads);
    this->Work.Filter([&](int t) { return !degenerate[static_cast<std::size_t>(t)]; });
    if (this->Work.Triangles.empty())
    {
      return { ErrorCode::EmptyInput, "no triangle of the mesh has an area" };
    }
    made.Mesh = WrapTriangles({ this->Work.Points, this->Work.Triangles },
      this->Ongoing.Params.WrapAlpha * made.Diagonal,
      this->Ongoing.Params.WrapOffset * made.Diagonal);
    made.Wrapped = true;
    made.WrapReason = reason;
    made.Changed = true;
    made.PointIds.assign(static_cast<std::size_t>(made.Mesh.Points.rows()), -1);
    made.TriangleIds.assign(made.Mesh.Triangles.size(), -1);
    made.After = this->NumbersOf(made.Mesh.Points, made.Mesh.Triangles);
    const double tolerance = WrapToleranceShare * made.Diagonal;
    made.DistanceFromInput = FarthestFrom(TriangleIndex<3>(this->Work.Points, this->Work.Triangles),
      made.Mesh.Points, made.Mesh.Triangles, tolerance)
                               .Value;
    made.DistanceToInput = FarthestFrom(TriangleIndex<3>(made.Mesh.Points, made.Mesh.Triangles),
      this->Work.Points, this->Work.Triangles, tolerance)
                             .Value;
    result = std::move(made);
    return {};
  }

private:
  void Start()
  {
    const PointMatrix& points = this->Input.Points;
    this->Result = {};
    this->FirstOfEqual = FirstOfEqualPoints(points);
    this->Work.Points = points;
    this->Work.Triangles = ReplaceCorners(this->Input.Triangles, this->FirstOfEqual);
    this->Work.Sources.resize(this->Work.Triangles.size());
    std::iota(this->Work.Sources.begin(), this->Work.Sources.end(), 0);
    this->Work.PointIds.resize(static_cast<std::size_t>(points.rows()));
    std::iota(this->Work.PointIds.begin(), this->Work.PointIds.end(), 0);
    const std::vector<int> given = UsedPoints(this->Input.Triangles);
    const std::vector<int> used = UsedPoints(this->Work.Triangles);
    this->Result.MergedPoints = static_cast<int>(given.size() - used.size());
    this->Result.Diagonal = this->Ongoing.Diagonal = DiagonalOf(points, used);
    this->Result.Before = this->NumbersOf(points, this->Work.Triangles);
  }

  static RepairNumbers NumbersOf(
    const PointMatrix& points, const std::vector<MeshTriangle>& triangles)
  {
    RepairNumbers numbers;
    numbers.Points = static_cast<int>(UsedPoints(triangles).size());
    numbers.Triangles = static_cast<int>(triangles.size());
    NumberParts(triangles, true, numbers.Parts);
    numbers.Euler = EulerNumber(triangles);
    for (const MeshTriangle& corners : triangles)
    {
      numbers.Area += TriangleArea(points, corners);
    }
    numbers.Volume = SignedVolume(points, triangles);
    return numbers;
  }

  Status Finish()
  {
    SurfaceRepair& result = this->Result;
    result.Actions = std::move(this->Ongoing.Actions);
    result.Closed = this->Ongoing.Closed;
    result.Changed = !result.Actions.empty() || result.MergedPoints > 0;
    if (!result.Changed)
    {
      result.Mesh = this->Input;
      result.PointIds = this->Work.PointIds;
      result.TriangleIds = this->Work.Sources;
      result.After = result.Before;
      return {};
    }
    this->Encode();
    return CheckDistances(this->Input, this->FirstOfEqual, this->Ongoing, result);
  }

  void Encode()
  {
    SurfaceRepair& result = this->Result;
    const std::vector<int> used = UsedPoints(this->Work.Triangles);
    std::vector<int> numbers(static_cast<std::size_t>(this->Work.Points.rows()), -1);
    result.Mesh.Points.resize(static_cast<Eigen::Index>(used.size()), 3);
    for (std::size_t i = 0; i < used.size(); ++i)
    {
      numbers[static_cast<std::size_t>(used[i])] = static_cast<int>(i);
      result.Mesh.Points.row(static_cast<Eigen::Index>(i)) = this->Work.Points.row(used[i]);
      result.PointIds.push_back(this->Work.PointIds[static_cast<std::size_t>(used[i])]);
    }
    result.Mesh.Triangles = ReplaceCorners(this->Work.Triangles, numbers);
    result.TriangleIds = this->Work.Sources;
    result.After = this->NumbersOf(result.Mesh.Points, result.Mesh.Triangles);
  }

  const TriangleMesh& Input;
  std::vector<int> FirstOfEqual;
  RepairSoup Work;
  OngoingRepair Ongoing;
  SurfaceRepair Result;
};
}

const char* ToString(RepairKind kind)
{
  switch (kind)
  {
    case RepairKind::DegenerateFace:
      return "degenerate_faces";
    case RepairKind::DuplicateFace:
      return "duplicate_faces";
    case RepairKind::LooseFace:
      return "loose_faces";
    case RepairKind::TurnedFace:
      return "turned_faces";
    case RepairKind::Junction:
      return "junctions";
    case RepairKind::Hole:
      return "holes";
    case RepairKind::Intersection:
      return "intersections";
    case RepairKind::DividedEdge:
      return "divided_edges";
    case RepairKind::DividedPoint:
      return "divided_points";
    case RepairKind::CutTip:
      return "cut_tips";
    case RepairKind::Overlap:
      return "overlaps";
    case RepairKind::InnerWall:
      return "inner_walls";
    case RepairKind::SmallPart:
      return "small_parts";
    case RepairKind::Patch:
      return "patches";
  }
  return "";
}

int SurfaceRepair::Count(RepairKind kind) const
{
  return static_cast<int>(std::count_if(this->Actions.begin(), this->Actions.end(),
    [kind](const RepairAction& action) { return action.Kind == kind; }));
}

knotwork::Result<SurfaceRepair> RepairSurface(
  const TriangleMesh& mesh, const SurfaceRepairParams& params)
try
{
  if (Status status = CheckInput(mesh, params); !status)
  {
    return status;
  }
  SurfaceRepair result;
  Status status = Repair(mesh, params).Run(result);
  if (params.AlphaWrap &&
    (status.Code == ErrorCode::InvalidTopology || status.Code == ErrorCode::NotConverged))
  {
    const std::string reason = status.Detail;
    status = Repair(mesh, params).Wrap(reason, result);
  }
  if (!status)
  {
    return status;
  }
  return result;
}
catch (...)
{
  return StatusOfException();
}
}
