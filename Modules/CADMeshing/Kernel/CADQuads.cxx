// SPDX-License-Identifier: BSD-3-Clause
#include "CADQuads.h"

#include "EdgeDivisions.h"
#include "FaceQuads.h"
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

std::string NameOf(const CADTopology& model, int face)
{
  const CADTopologyFace& one = model.Faces[At(face)];
  return "face " + std::to_string(one.Ids.front()) +
    (one.Name.empty() ? std::string() : " ('" + one.Name + "')");
}

/// Quadrilaterals of a face for numbers of segments along its edges.
struct FaceState
{
  std::vector<int> Counts; ///< of its uses; empty: nothing is there yet
  bool Mapped = false;
  double Least = 0.0;
  FaceQuads Quads;
  std::vector<int> LoopNodes; ///< that Quads.Nodes are of
};

class QuadMesher
{
public:
  QuadMesher(const CADTopology& model, const CADQuadsParams& params)
    : Model(model), Params(params),
      EdgeLength(params.EdgeLength > 0.0 ? params.EdgeLength : model.Diagonal / 20.0),
      States(model.Faces.size())
  {
  }

  Result<CADQuads> Run();

private:
  Result<std::vector<int>> Wishes() const;
  Status FindRectangles();
  FaceQuads CoarseGrid(int face) const;
  void RaiseWishes(const RectangleFace& rectangle, std::vector<int>& wishes) const;
  Status MeshFaces(const EdgeNodes& nodes, std::vector<int>& poor);
  Status MeshFace(int face, const EdgeNodes& nodes);
  void Halve(int face, const EdgeNodes& nodes, std::vector<int>& wishes) const;
  CADQuads Join(const EdgeNodes& nodes) const;
  void Measure(CADQuads& made) const;
  Status Check(const CADQuads& made) const;

  const CADTopology& Model;
  const CADQuadsParams& Params;
  double EdgeLength;
  std::vector<FaceChart> Charts;
  std::vector<RectangleFace> Rectangles;        ///< all
  std::vector<std::vector<int>> CornersOfFaces; ///< uses; empty: no rectangle
  std::vector<bool> IsMapped;                   ///< with the present numbers
  std::vector<FaceState> States;
  std::vector<Status> Failures; ///< of faces
};

Result<std::vector<int>> QuadMesher::Wishes() const
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
    if (Status small = CheckSize(sum, this->Params.MaxQuads, "segments of edges", "MaximumQuads");
        !small)
    {
      return small;
    }
    wishes.push_back(static_cast<int>(wish));
  }
  return wishes;
}

Status QuadMesher::FindRectangles()
{
  this->CornersOfFaces.resize(this->Model.Faces.size());
  for (int face = 0; face < static_cast<int>(this->Model.Faces.size()); ++face)
  {
    this->Charts.emplace_back(this->Model, face);
    if (this->Params.Method == CADQuadMethod::Unstructured)
    {
      continue;
    }
    const std::vector<int> corners = RectangleCorners(this->Model, this->Charts.back());
    if (corners.empty())
    {
      if (this->Params.Method == CADQuadMethod::Mapped)
      {
        return { ErrorCode::InvalidTopology,
          NameOf(this->Model, face) +
            " is not mapped: its boundary is no loop with four corners; split it (cadmodify) or "
            "take Method automatic" };
      }
      continue;
    }
    RectangleFace rectangle;
    rectangle.Face = face;
    const auto& loop = this->Model.Faces[At(face)].Loops.front();
    for (std::size_t side = 0; side < 4; ++side)
    {
      const auto n = static_cast<int>(loop.size());
      const int end = corners[(side + 1) % 4];
      for (int use = corners[side]; use != end; use = (use + 1) % n)
      {
        rectangle.Sides[side].push_back(loop[At(use)].Edge);
      }
    }
    this->Rectangles.push_back(std::move(rectangle));
    this->CornersOfFaces[At(face)] = corners;
  }
  return {};
}

/// A grid of CoarseSegments segments along every side of a rectangle.
FaceQuads QuadMesher::CoarseGrid(int face) const
{
  const auto& uses = this->Model.Faces[At(face)].Loops.front();
  const auto& corners = this->CornersOfFaces[At(face)];
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

/// Lines of a grid may be longer and turn more than the sides that they run along.
void QuadMesher::RaiseWishes(const RectangleFace& rectangle, std::vector<int>& wishes) const
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

Status QuadMesher::MeshFace(int face, const EdgeNodes& nodes)
{
  constexpr double LeastOfMapped = 0.1; ///< scaled Jacobian; worse ones are meshed unstructured
  const FaceChart& chart = this->Charts[At(face)];
  FaceState& state = this->States[At(face)];
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
  for (const ChartLoop& loop : loops)
  {
    for (const LoopPoint& point : loop)
    {
      loopNodes.push_back(point.Node);
    }
  }
  if (state.Counts == counts)
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
    return this->Failures[At(face)];
  }
  state = {};
  state.Counts = counts;
  state.LoopNodes = std::move(loopNodes);
  this->Failures[At(face)] = {};
  if (this->IsMapped[At(face)])
  {
    std::vector<int> corners;
    for (const int use : this->CornersOfFaces[At(face)])
    {
      const ChartLoop& loop = loops.front();
      corners.push_back(
        static_cast<int>(std::find_if(loop.begin(), loop.end(),
                           [&](const LoopPoint& point) { return point.Use == use; }) -
          loop.begin()));
    }
    state.Quads = MapRectangle(chart, loops.front(), corners);
    state.Mapped = true;
    const std::vector<Eigen::Vector3d> normals = NormalsOf(chart, state.Quads);
    state.Least = 1.0;
    for (int q = 0; q < static_cast<int>(state.Quads.Quads.size()); ++q)
    {
      state.Least = std::min(state.Least, ScaledJacobian(state.Quads, normals, q));
    }
    if (state.Least < 0.3)
    {
      state.Least = SmoothFace(chart, state.Quads);
    }
    if (state.Least > LeastOfMapped || this->Params.Method == CADQuadMethod::Mapped)
    {
      return {};
    }
  }
  state.Mapped = false;
  const ChartSizes sizes{ 2.0 * this->EdgeLength, 2.0 * this->Params.Curvature / 180.0 * Pi };
  auto paved = PaveFace(chart, loops, sizes, this->Params.MaxQuads);
  if (!paved)
  {
    this->Failures[At(face)] = paved.Status;
    return paved.Status;
  }
  state.Quads = std::move(paved.Value);
  state.Least = SmoothFace(chart, state.Quads);
  return {};
}

/// @param poor  result: faces whose quadrilaterals are none or bad.
Status QuadMesher::MeshFaces(const EdgeNodes& nodes, std::vector<int>& poor)
{
  constexpr double Poor = 0.05; ///< scaled Jacobian
  poor.clear();
  double numQuads = 0.0;
  for (int face = 0; face < static_cast<int>(this->Model.Faces.size()); ++face)
  {
    const Status meshed = this->MeshFace(face, nodes);
    if (meshed.Code == ErrorCode::TooLarge)
    {
      return { meshed.Code,
        NameOf(this->Model, face) + ": " + meshed.Detail +
          "; raise EdgeLength, Curvature or MaximumQuads" };
    }
    numQuads += static_cast<double>(this->States[At(face)].Quads.Quads.size());
    if (Status small = CheckSize(numQuads, this->Params.MaxQuads, "quadrilaterals", "MaximumQuads");
        !small)
    {
      return small;
    }
    if (!meshed || this->States[At(face)].Least < Poor)
    {
      poor.push_back(face);
    }
    if (this->Params.Progress &&
      !this->Params.Progress((face + 1.0) / (static_cast<double>(this->Model.Faces.size()) + 1.0)))
    {
      return { ErrorCode::Aborted, "meshing was stopped" };
    }
  }
  return {};
}

/// Wishes twice as many segments of the edges at a face's bad quadrilaterals, of all when it has
/// none.
void QuadMesher::Halve(int face, const EdgeNodes& nodes, std::vector<int>& wishes) const
{
  constexpr double Bad = 0.1;
  const FaceQuads& quads = this->States[At(face)].Quads;
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

CADQuads QuadMesher::Join(const EdgeNodes& nodes) const
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
      mesh.Points.push_back(this->Model.EdgePoint(e, static_cast<double>(i) / nodes.Counts[At(e)]));
      mesh.PointDimension.push_back(1);
      mesh.PointEntity.push_back(e);
    }
  }
  for (int face = 0; face < static_cast<int>(this->Model.Faces.size()); ++face)
  {
    const FaceState& state = this->States[At(face)];
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
  }
  return made;
}

void QuadMesher::Measure(CADQuads& made) const
{
  const CADMesh& mesh = made.Mesh;
  std::map<std::pair<int, int>, int> sides;
  std::vector<int> valence(mesh.Points.size(), 0);
  for (const auto& quad : mesh.Quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      ++sides[std::minmax(quad[i], quad[(i + 1) % 4])];
      ++valence[At(quad[i])];
    }
  }
  std::vector<bool> isManifold(mesh.Points.size(), true);
  made.Closed = true;
  for (const auto& [side, count] : sides)
  {
    made.Closed = made.Closed && count >= 2;
    if (count != 2)
    {
      isManifold[At(side.first)] = false;
      isManifold[At(side.second)] = false;
    }
  }
  int used = 0;
  for (std::size_t p = 0; p < mesh.Points.size(); ++p)
  {
    used += valence[p] > 0 ? 1 : 0;
    if (isManifold[p] && valence[p] > 0 && valence[p] != 4)
    {
      ++made.ExtraordinaryPoints;
      if (mesh.PointDimension[p] == 2)
      {
        ++made.Faces[At(mesh.PointEntity[p])].ExtraordinaryPoints;
      }
    }
  }
  made.EulerNumber = used - static_cast<int>(sides.size()) + static_cast<int>(mesh.Quads.size());
}

/// What must hold whatever the method: quadrilaterals with four corners and, around every body,
/// sides with one quadrilateral to their left and one to their right, but for edges of one face.
Status QuadMesher::Check(const CADQuads& made) const
{
  std::vector<std::vector<std::size_t>> quadsOfFaces(this->Model.Faces.size());
  for (std::size_t q = 0; q < made.Mesh.Quads.size(); ++q)
  {
    auto corners = made.Mesh.Quads[q];
    std::sort(corners.begin(), corners.end());
    if (std::adjacent_find(corners.begin(), corners.end()) != corners.end())
    {
      return { ErrorCode::InvalidTopology,
        NameOf(this->Model, made.Mesh.QuadFace[q]) +
          " has a quadrilateral with equal corners; lower EdgeLength" };
    }
    quadsOfFaces[At(made.Mesh.QuadFace[q])].push_back(q);
  }
  for (const CADTopologyBody& body : this->Model.Bodies)
  {
    std::map<int, int> usesOfEdges;
    std::map<std::pair<int, int>, int> sides; ///< directed
    for (const CADTopologySide& side : body.Sides)
    {
      for (const auto& loop : this->Model.Faces[At(side.Face)].Loops)
      {
        for (const CADTopologyUse& use : loop)
        {
          ++usesOfEdges[use.Edge];
        }
      }
      for (const std::size_t q : quadsOfFaces[At(side.Face)])
      {
        const auto& quad = made.Mesh.Quads[q];
        for (std::size_t i = 0; i < 4; ++i)
        {
          const int a = quad[i];
          const int b = quad[(i + 1) % 4];
          ++sides[side.Reversed ? std::make_pair(b, a) : std::make_pair(a, b)];
        }
      }
    }
    for (const CADTopologySide& side : body.Sides)
    {
      for (const std::size_t q : quadsOfFaces[At(side.Face)])
      {
        const auto& quad = made.Mesh.Quads[q];
        for (std::size_t i = 0; i < 4; ++i)
        {
          const int a = quad[i];
          const int b = quad[(i + 1) % 4];
          const int there = sides[{ a, b }];
          const int back = sides.count({ b, a }) > 0 ? sides.at({ b, a }) : 0;
          if (there == 1 && back == 1)
          {
            continue;
          }
          const bool onEdge =
            made.Mesh.PointDimension[At(a)] < 2 && made.Mesh.PointDimension[At(b)] < 2;
          if (body.IsSolid || !onEdge || there + back > 1)
          {
            // an open shell, or one that meets itself, may be so
            const int edge = made.Mesh.PointDimension[At(a)] == 1 ? made.Mesh.PointEntity[At(a)]
              : made.Mesh.PointDimension[At(b)] == 1              ? made.Mesh.PointEntity[At(b)]
                                                                  : -1;
            if (onEdge && usesOfEdges[edge] != 2)
            {
              continue;
            }
            return { ErrorCode::InvalidTopology,
              NameOf(this->Model, side.Face) +
                " does not fit its neighbours; heal the file, or lower EdgeLength" };
          }
        }
      }
    }
  }
  return {};
}

Result<CADQuads> QuadMesher::Run()
{
  constexpr int Rounds = 4;
  auto wishes = this->Wishes();
  if (!wishes)
  {
    return wishes.Status;
  }
  if (Status found = this->FindRectangles(); !found)
  {
    return found;
  }
  for (const RectangleFace& rectangle : this->Rectangles)
  {
    this->RaiseWishes(rectangle, wishes.Value);
  }
  this->Failures.resize(this->Model.Faces.size());
  for (int round = 0;; ++round)
  {
    std::vector<RectangleFace> mapped = this->Rectangles;
    const EdgeNodes nodes(this->Model, DivideEdges(this->Model, wishes.Value, mapped));
    this->IsMapped.assign(this->Model.Faces.size(), false);
    for (const RectangleFace& rectangle : mapped)
    {
      this->IsMapped[At(rectangle.Face)] = true;
    }
    if (this->Params.Method == CADQuadMethod::Mapped && mapped.size() < this->Model.Faces.size())
    {
      const auto left = std::find(this->IsMapped.begin(), this->IsMapped.end(), false);
      return { ErrorCode::InvalidTopology,
        NameOf(this->Model, static_cast<int>(left - this->IsMapped.begin())) +
          " is not mapped: its opposite sides cannot have as many segments; lower EdgeLength or "
          "take Method automatic" };
    }
    std::vector<int> poor;
    if (Status meshed = this->MeshFaces(nodes, poor); !meshed)
    {
      return meshed;
    }
    if (poor.empty() || round + 1 == Rounds)
    {
      for (const int face : poor)
      {
        const Status& failure = this->Failures[At(face)];
        if (!failure || this->States[At(face)].Least <= 0.0)
        {
          return { ErrorCode::InvalidTopology,
            NameOf(this->Model, face) +
              " cannot be meshed: " + (failure ? "its quadrilaterals fold over" : failure.Detail) +
              "; lower EdgeLength or Curvature, or split it (cadmodify)" };
        }
      }
      CADQuads made = this->Join(nodes);
      this->Measure(made);
      if (Status checked = this->Check(made); !checked)
      {
        return checked;
      }
      return made;
    }
    for (const int face : poor)
    {
      this->Halve(face, nodes, wishes.Value);
    }
  }
}
}

Result<CADQuads> MeshQuads(const CADTopology& model, const CADQuadsParams& params)
{
  if (Status valid = CheckParams(params); !valid)
  {
    return valid;
  }
  if (model.Faces.empty())
  {
    return { ErrorCode::EmptyInput, "the model has no faces" };
  }
  try
  {
    return QuadMesher(model, params).Run();
  }
  catch (...)
  {
    return StatusOfException();
  }
}
}
