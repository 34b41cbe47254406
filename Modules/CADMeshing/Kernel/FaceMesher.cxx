// SPDX-License-Identifier: BSD-3-Clause
#include "FaceMesher.h"

#include "FaceGrids.h"
#include <knotwork/SplineCore/SizeLimit.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr int CoarseSegments = 8; ///< of the grid that tells what a mapped face needs

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}
}

Status CheckParams(const CADQuadsParams& params)
{
  if (!(params.EdgeLength >= 0.0 && std::isfinite(params.EdgeLength)))
  {
    return { ErrorCode::InvalidParameter, "EdgeLength must be 0 or a length" };
  }
  if (!(params.Curvature > 0.0 && params.Curvature <= 90.0))
  {
    return { ErrorCode::InvalidParameter, "Curvature must lie in (0, 90] degrees" };
  }
  if (params.MinDivisions < 1 || params.MinDivisions > 100000)
  {
    return { ErrorCode::InvalidParameter, "MinDivisions must lie in [1, 100000]" };
  }
  if (params.MaxQuads < 1)
  {
    return { ErrorCode::InvalidParameter, "MaxQuads must be positive" };
  }
  return {};
}

std::string FaceName(const CADTopology& model, int face)
{
  const CADTopologyFace& one = model.Faces[At(face)];
  return "face " + std::to_string(one.Ids.front()) +
    (one.Name.empty() ? std::string() : " ('" + one.Name + "')");
}

FaceMesher::FaceMesher(const CADTopology& model, const CADQuadsParams& params)
  : Model(model), Params(params),
    EdgeLength(params.EdgeLength > 0.0 ? params.EdgeLength : model.Diagonal / 20.0),
    Meshes(model.Faces.size())
{
}

Result<std::vector<int>> FaceMesher::Wishes(const char* option) const
{
  constexpr int LeastOfClosed = 8;
  std::vector<int> wishes;
  double sum = 0.0;
  for (const CADTopologyEdge& edge : this->Model.Edges)
  {
    const double byLength = edge.Length / this->EdgeLength;
    const double byTurning = edge.Turning / (this->Params.Curvature / 180.0 * Pi) - 1e-6;
    const double wish = std::max({ std::ceil(byLength - 0.5), std::ceil(byTurning),
      static_cast<double>(this->Params.MinDivisions),
      edge.Vertices[0] == edge.Vertices[1] ? static_cast<double>(LeastOfClosed) : 1.0 });
    sum += wish;
    if (Status small = CheckSize(sum, this->Params.MaxQuads, "segments of edges", option); !small)
    {
      return small;
    }
    wishes.push_back(static_cast<int>(wish));
  }
  return wishes;
}

void FaceMesher::FindShapes()
{
  for (int face = 0; face < static_cast<int>(this->Model.Faces.size()); ++face)
  {
    this->Charts.emplace_back(this->Model, face);
    this->Shapes.push_back(LogicalShapeOf(this->Model, this->Charts.back()));
    RectangleFace sides;
    sides.Face = face;
    const auto add = [&](std::size_t side, const std::vector<CADTopologyUse>& uses)
    {
      for (const CADTopologyUse& use : uses)
      {
        sides.Sides[side].push_back(use.Edge);
      }
    };
    if (this->Kind(face) == LogicalShapeKind::Ring)
    {
      add(0, this->Model.Faces[At(face)].Loops[0]);
      add(2, this->Model.Faces[At(face)].Loops[1]);
      this->AllRings.push_back(std::move(sides));
    }
    else if (this->IsRectangle(face))
    {
      const auto uses = this->Sides(face);
      for (std::size_t side = 0; side < 4; ++side)
      {
        add(side, uses[side]);
      }
      this->AllRectangles.push_back(std::move(sides));
    }
  }
}

std::vector<std::vector<CADTopologyUse>> FaceMesher::Sides(int face) const
{
  const std::vector<int>& corners = this->Shapes[At(face)].Corners;
  const auto& loop = this->Model.Faces[At(face)].Loops.front();
  const auto n = static_cast<int>(loop.size());
  std::vector<std::vector<CADTopologyUse>> sides(corners.size());
  for (std::size_t side = 0; side < corners.size(); ++side)
  {
    const int end = corners[(side + 1) % corners.size()];
    for (int use = corners[side]; use != end; use = (use + 1) % n)
    {
      if (loop[At(use)].Edge >= 0)
      {
        sides[side].push_back(loop[At(use)]);
      }
    }
  }
  return sides;
}

/// A grid of CoarseSegments segments along every side of a rectangle.
FaceQuads FaceMesher::CoarseGrid(int face) const
{
  const auto& uses = this->Model.Faces[At(face)].Loops.front();
  const auto& corners = this->Shapes[At(face)].Corners;
  const auto n = static_cast<int>(uses.size());
  const FaceChart& chart = this->Charts[At(face)];
  ChartLoop loop;
  for (std::size_t side = 0; side < 4; ++side)
  {
    double length = 0.0;
    std::vector<int> ofSide;
    for (int use = corners[side]; use != corners[(side + 1) % 4]; use = (use + 1) % n)
    {
      ofSide.push_back(use);
      length += this->Model.Edges[At(uses[At(use)].Edge)].Length;
    }
    double begin = 0.0;
    std::size_t at = 0;
    for (int i = 0; i < CoarseSegments; ++i)
    {
      const double here = length * i / CoarseSegments;
      const auto lengthOf = [&] { return this->Model.Edges[At(uses[At(ofSide[at])].Edge)].Length; };
      while (at + 1 < ofSide.size() && begin + lengthOf() <= here)
      {
        begin += lengthOf();
        ++at;
      }
      LoopPoint point;
      point.Place = chart.FromParameters(
        this->Model.UseParameters(face, 0, ofSide[at], std::min(1.0, (here - begin) / lengthOf())));
      loop.push_back(point);
    }
  }
  return MapRectangle(chart, loop, { 0, CoarseSegments, 2 * CoarseSegments, 3 * CoarseSegments });
}

void FaceMesher::RaiseWishes(const RectangleFace& rectangle, std::vector<int>& wishes) const
{
  const FaceQuads grid = this->CoarseGrid(rectangle.Face);
  const std::vector<Eigen::Vector3d> normals = NormalsOf(this->Charts[At(rectangle.Face)], grid);
  for (std::size_t direction = 0; direction < 2; ++direction)
  {
    const int along = direction == 0 ? 1 : CoarseSegments + 1;
    const int across = direction == 0 ? CoarseSegments + 1 : 1;
    double need = 0.0;
    for (int line = 0; line <= CoarseSegments; ++line)
    {
      double length = 0.0;
      double turning = 0.0;
      for (int i = 0; i < CoarseSegments; ++i)
      {
        const auto a = At(line * across + i * along);
        const auto b = a + At(along);
        length += (grid.Points[b] - grid.Points[a]).norm();
        turning += std::atan2(normals[a].cross(normals[b]).norm(), normals[a].dot(normals[b]));
      }
      need = std::max({ need, length / this->EdgeLength - 0.5,
        turning / (this->Params.Curvature / 180.0 * Pi) - 1e-6 });
    }
    for (const std::size_t side : { direction, direction + 2 })
    {
      double sum = 0.0;
      for (const int edge : rectangle.Sides[side])
      {
        sum += wishes[At(edge)];
      }
      for (const int edge : rectangle.Sides[side])
      {
        const double raised = std::ceil(wishes[At(edge)] * need / sum - 1e-9);
        wishes[At(edge)] = std::max(
          wishes[At(edge)], static_cast<int>(std::min<double>(raised, this->Params.MaxQuads)));
      }
    }
  }
}

/// Grids in a face, smoothed where they are bad or several meet.
Status FaceMesher::MapFace(int face, const std::vector<ChartLoop>& loops, FaceMesh& state) const
{
  constexpr double Bad = 0.3; ///< scaled Jacobian
  const FaceChart& chart = this->Charts[At(face)];
  auto mapped = MapShape(chart, loops, this->Shapes[At(face)],
    { this->EdgeLength, this->Params.MinDivisions, this->Params.MaxQuads });
  if (!mapped)
  {
    return mapped.Status;
  }
  state.Mapped = true;
  state.Quads = std::move(mapped.Value);
  const std::vector<Eigen::Vector3d> normals = NormalsOf(chart, state.Quads);
  state.Least = 1.0;
  for (int q = 0; q < static_cast<int>(state.Quads.Quads.size()); ++q)
  {
    state.Least = std::min(state.Least, ScaledJacobian(state.Quads, normals, q));
  }
  const LogicalShapeKind kind = this->Kind(face);
  if (state.Least < Bad || (kind != LogicalShapeKind::Rectangle && kind != LogicalShapeKind::Ring))
  {
    state.Least = SmoothFace(chart, state.Quads);
  }
  return {};
}

const Status& FaceMesher::Mesh(int face, const EdgeNodes& nodes, FaceMethod method)
{
  // scaled Jacobians; worse ones are meshed unstructured
  constexpr double LeastOfRectangles = 0.1;
  constexpr double LeastOfOthers = 0.3;
  const FaceChart& chart = this->Charts[At(face)];
  FaceMesh& state = this->Meshes[At(face)];
  std::vector<int> counts;
  for (const auto& loop : this->Model.Faces[At(face)].Loops)
  {
    for (const CADTopologyUse& use : loop)
    {
      counts.push_back(use.Edge < 0 ? 0 : nodes.Counts[At(use.Edge)]);
    }
  }
  const std::vector<ChartLoop> loops = ChartLoops(this->Model, chart, nodes);
  std::vector<int> loopNodes;
  std::vector<Eigen::Vector2d> loopPlaces;
  for (const ChartLoop& loop : loops)
  {
    for (const LoopPoint& point : loop)
    {
      loopNodes.push_back(point.Node);
      loopPlaces.push_back(point.Place);
    }
  }
  if (state.Counts == counts && state.LoopPlaces == loopPlaces)
  {
    std::map<int, int> renumbered;
    for (std::size_t i = 0; i < loopNodes.size(); ++i)
    {
      renumbered[state.LoopNodes[i]] = loopNodes[i];
    }
    for (int& node : state.Quads.Nodes)
    {
      node = node < 0 ? node : renumbered[node];
    }
    state.LoopNodes = std::move(loopNodes);
    return state.Failure;
  }
  state = {};
  state.Counts = counts;
  state.LoopNodes = std::move(loopNodes);
  state.LoopPlaces = std::move(loopPlaces);
  if (method != FaceMethod::Paved)
  {
    const Status mapped = this->MapFace(face, loops, state);
    if (!mapped && (method == FaceMethod::Grid || mapped.Code == ErrorCode::TooLarge))
    {
      state.Failure = mapped;
      return state.Failure;
    }
    if (method == FaceMethod::Grid ||
      (state.Mapped && state.Least > (this->IsRectangle(face) ? LeastOfRectangles : LeastOfOthers)))
    {
      return state.Failure;
    }
  }
  const ChartSizes sizes{ 2.0 * this->EdgeLength, 2.0 * this->Params.Curvature / 180.0 * Pi };
  auto paved = PaveFace(chart, loops, sizes, this->Params.MaxQuads);
  if (!paved && !(state.Mapped && state.Least > 0.0))
  {
    state.Quads = {};
    state.Mapped = false;
    state.Failure = paved.Status;
    return state.Failure;
  }
  const double least = paved ? SmoothFace(chart, paved.Value) : -1.0;
  if (!state.Mapped || least > state.Least)
  {
    state.Mapped = false;
    state.Quads = std::move(paved.Value);
    state.Least = least;
  }
  return state.Failure;
}

void FaceMesher::Halve(int face, const EdgeNodes& nodes, std::vector<int>& wishes) const
{
  constexpr double Bad = 0.1;
  const FaceQuads& quads = this->Meshes[At(face)].Quads;
  const std::vector<Eigen::Vector3d> normals = NormalsOf(this->Charts[At(face)], quads);
  std::set<int> edges;
  for (int q = 0; q < static_cast<int>(quads.Quads.size()); ++q)
  {
    if (ScaledJacobian(quads, normals, q) > Bad)
    {
      continue;
    }
    for (const int corner : quads.Quads[At(q)])
    {
      const int node = quads.Nodes[At(corner)];
      if (node >= static_cast<int>(this->Model.Vertices.size()))
      {
        edges.insert(
          static_cast<int>(std::upper_bound(nodes.First.begin(), nodes.First.end(), node) -
            nodes.First.begin() - 1));
      }
    }
  }
  for (const auto& loop : this->Model.Faces[At(face)].Loops)
  {
    for (const CADTopologyUse& use : loop)
    {
      if (use.Edge >= 0 && (edges.empty() || edges.count(use.Edge) > 0))
      {
        wishes[At(use.Edge)] = 2 * nodes.Counts[At(use.Edge)];
      }
    }
  }
}

void FaceMesher::Take(int face, FaceQuads quads)
{
  FaceMesh& state = this->Meshes[At(face)];
  state = {};
  state.Quads = std::move(quads);
  state.Least = SmoothFace(this->Charts[At(face)], state.Quads);
}

CADQuads FaceMesher::Begin(const EdgeNodes& nodes) const
{
  CADQuads made;
  made.Divisions = nodes.Counts;
  CADMesh& mesh = made.Mesh;
  mesh.Points = this->Model.Vertices;
  for (int v = 0; v < static_cast<int>(mesh.Points.size()); ++v)
  {
    mesh.PointDimension.push_back(0);
    mesh.PointEntity.push_back(v);
  }
  for (int e = 0; e < static_cast<int>(nodes.Counts.size()); ++e)
  {
    for (int i = 1; i < nodes.Counts[At(e)]; ++i)
    {
      mesh.Points.push_back(this->Model.EdgePoint(e, nodes.ShareOf(e, i)));
      mesh.PointDimension.push_back(1);
      mesh.PointEntity.push_back(e);
    }
  }
  return made;
}

std::vector<int> FaceMesher::Append(int face, CADQuads& made) const
{
  CADMesh& mesh = made.Mesh;
  const FaceMesh& state = this->Meshes[At(face)];
  std::vector<int> ids = state.Quads.Nodes;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    if (ids[i] < 0)
    {
      ids[i] = static_cast<int>(mesh.Points.size());
      mesh.Points.push_back(state.Quads.Points[i]);
      mesh.PointDimension.push_back(2);
      mesh.PointEntity.push_back(face);
    }
  }
  const bool turned = this->Model.Faces[At(face)].Reversed;
  const std::vector<Eigen::Vector3d> normals = NormalsOf(this->Charts[At(face)], state.Quads);
  for (int q = 0; q < static_cast<int>(state.Quads.Quads.size()); ++q)
  {
    made.ScaledJacobians.push_back(ScaledJacobian(state.Quads, normals, q));
  }
  for (const auto& quad : state.Quads.Quads)
  {
    std::array<int, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i)
    {
      corners[i] = ids[At(quad[turned ? 3 - i : i])];
    }
    mesh.Quads.push_back(corners);
    mesh.QuadFace.push_back(face);
  }
  CADFaceQuads numbers;
  numbers.Face = face;
  numbers.Mapped = state.Mapped;
  numbers.Quads = static_cast<int>(state.Quads.Quads.size());
  numbers.LeastScaledJacobian = state.Least;
  const auto measure = [&](const std::vector<int>& corners)
  {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    for (const int corner : corners)
    {
      middle += state.Quads.Points[At(corner)] / static_cast<double>(corners.size());
      place += state.Quads.Places[At(corner)] / static_cast<double>(corners.size());
    }
    const Eigen::Vector3d near = this->Charts[At(face)].Project(middle, place);
    numbers.Distance = std::max(numbers.Distance, (near - middle).norm());
  };
  for (const auto& quad : state.Quads.Quads)
  {
    measure({ quad[0], quad[1], quad[2], quad[3] });
    measure({ quad[0], quad[1] });
    measure({ quad[1], quad[2] });
    measure({ quad[2], quad[3] });
    measure({ quad[3], quad[0] });
  }
  made.LeastScaledJacobian = std::min(made.LeastScaledJacobian, numbers.LeastScaledJacobian);
  made.Distance = std::max(made.Distance, numbers.Distance);
  made.Faces.push_back(numbers);
  return ids;
}
}
