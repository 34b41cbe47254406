// SPDX-License-Identifier: BSD-3-Clause
#include "HexPadding.h"

#include "HexahedronQuality.h"
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/MeshUntangling.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;
using Quad = std::array<int, 4>;

constexpr double Smooth = 0.7071; ///< cosine of the angle between normals that is no edge
constexpr double Depth = 0.3;     ///< of the layer, of the cells under it

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// A side of a cell, its corners in tensor-product order as seen from outside.
struct Facet
{
  int Cell = 0;
  Quad Corners{};
  int Face = -1;  ///< of the model; -1: inside of a solid
  int Number = 0; ///< of cells that have it
};

/// A mesh of the points that cells have, and which they are.
struct UsedMesh
{
  UsedMesh(const std::vector<int>& corners, const std::vector<Vector3d>& places)
  {
    std::vector<int> numbers(places.size(), -1);
    for (const int corner : corners)
    {
      if (numbers[At(corner)] < 0)
      {
        numbers[At(corner)] = static_cast<int>(this->Nodes.size());
        this->Nodes.push_back(corner);
      }
      this->Mesh.Corners.push_back(numbers[At(corner)]);
    }
    this->Mesh.NumPoints = static_cast<int>(this->Nodes.size());
    this->Points.resize(this->Mesh.NumPoints, 3);
    for (std::size_t i = 0; i < this->Nodes.size(); ++i)
    {
      this->Points.row(static_cast<Eigen::Index>(i)) = places[At(this->Nodes[i])].transpose();
    }
  }

  CellMesh<3> Mesh;
  PointMatrix Points;
  std::vector<int> Nodes;
};

/// Points inside move freely, those of the layer on their faces; all others stay.
class LayerSlide final : public PointSlide
{
public:
  struct Place
  {
    const FaceChart* Chart;
    Eigen::Vector2d Parameters;
  };

  LayerSlide(const std::vector<int>& dimensions, const std::map<int, Place>& places)
    : Dimensions(dimensions), Places(places)
  {
  }

  bool IsFixed(int point) const override
  {
    return this->Dimensions[At(point)] < 3 && this->Places.count(point) == 0;
  }
  Eigen::RowVector3d Nearest(int point, const Eigen::RowVector3d& at) const override
  {
    const auto place = this->Places.find(point);
    if (place == this->Places.end())
    {
      return at;
    }
    Eigen::Vector2d guess = place->second.Parameters;
    return place->second.Chart->Project(at.transpose(), guess).transpose();
  }
  Eigen::Matrix<double, 3, Eigen::Dynamic> Directions(
    int point, const Eigen::RowVector3d& at) const override
  {
    const auto place = this->Places.find(point);
    if (place == this->Places.end())
    {
      return Eigen::Matrix3d::Identity();
    }
    Eigen::Vector2d guess = place->second.Parameters;
    place->second.Chart->Project(at.transpose(), guess);
    const Vector3d normal = place->second.Chart->Normal(guess);
    Eigen::Matrix<double, 3, Eigen::Dynamic> directions(3, 2);
    directions.col(0) = normal.unitOrthogonal();
    directions.col(1) = normal.cross(directions.col(0));
    return directions;
  }

private:
  const std::vector<int>& Dimensions; ///< of the entity that a point lies on
  const std::map<int, Place>& Places;
};

class Padding
{
public:
  Padding(const CADTopology& model, const FaceMesher& faces, const EdgeNodes& nodes, CADMesh& mesh,
    HexCells& cells)
    : Model(model), Faces(faces), Nodes(nodes), Mesh(mesh), Cells(cells)
  {
    this->FindFacets();
  }

  /// Facets under which a layer goes.
  bool Choose();
  /// @return whether all points of the layer have a place.
  bool Add();
  Status Move(int threads, const ProgressCallback& progress);
  int NumAdded() const { return static_cast<int>(this->Chosen.size()); }
  double Least(int threads) const;

private:
  void FindFacets();
  Vector3d NormalOf(const Facet& facet) const;
  bool Place(int node, Vector3d at, int copy);
  const FaceQuads& QuadsOf(int face) const { return this->Faces.Of(face).Quads; }

  const CADTopology& Model;
  const FaceMesher& Faces;
  const EdgeNodes& Nodes;
  CADMesh& Mesh;
  HexCells& Cells;
  std::vector<Facet> Facets;              ///< with a face of the model
  std::vector<std::vector<int>> FacetsAt; ///< nodes
  std::set<int> Chosen;                   ///< of Facets
  std::map<int, LayerSlide::Place> Places;
};

void Padding::FindFacets()
{
  for (const CADHexFacet& found : FindFacetsOnFaces(this->Model, this->Mesh, this->Cells))
  {
    Facet facet{ found.Cell, CornersOfHexSide(found.Side), found.Face, found.NumCells };
    for (int& corner : facet.Corners)
    {
      corner = this->Cells.Corners[At(8 * found.Cell + corner)];
    }
    this->Facets.push_back(facet);
  }
  this->FacetsAt.resize(this->Mesh.Points.size());
  for (std::size_t f = 0; f < this->Facets.size(); ++f)
  {
    for (const int corner : this->Facets[f].Corners)
    {
      this->FacetsAt[At(corner)].push_back(static_cast<int>(f));
    }
  }
}

Vector3d Padding::NormalOf(const Facet& facet) const
{
  const auto point = [&](std::size_t i) { return this->Mesh.Points[At(facet.Corners[i])]; };
  return (point(3) - point(0)).cross(point(2) - point(1)).normalized();
}

bool Padding::Choose()
{
  DisjointSets groups(static_cast<int>(this->Model.Faces.size()));
  std::map<std::pair<int, int>, std::vector<std::size_t>> bySides; ///< outer facets
  for (std::size_t f = 0; f < this->Facets.size(); ++f)
  {
    const Quad& corners = this->Facets[f].Corners;
    constexpr std::array<std::array<std::size_t, 2>, 4> Sides{ { { 0, 1 }, { 1, 3 }, { 3, 2 },
      { 2, 0 } } };
    for (const auto& side : Sides)
    {
      if (this->Facets[f].Number == 1)
      {
        bySides[std::minmax(corners[side[0]], corners[side[1]])].push_back(f);
      }
    }
  }
  std::set<int> bad; ///< faces
  for (const auto& [side, facets] : bySides)
  {
    if (facets.size() != 2)
    {
      continue;
    }
    const Facet& one = this->Facets[facets[0]];
    const Facet& other = this->Facets[facets[1]];
    if (this->NormalOf(one).dot(this->NormalOf(other)) < Smooth)
    {
      continue;
    }
    groups.Unite(one.Face, other.Face);
    if (one.Cell == other.Cell)
    {
      bad.insert(one.Face);
    }
  }
  std::set<int> roots;
  for (const int face : bad)
  {
    roots.insert(groups.Find(face));
  }
  for (std::size_t f = 0; f < this->Facets.size(); ++f)
  {
    if (this->Facets[f].Number == 1 && roots.count(groups.Find(this->Facets[f].Face)) > 0)
    {
      this->Chosen.insert(static_cast<int>(f));
    }
  }
  return !this->Chosen.empty();
}

/// Puts the copy of a node inside of a solid, or on the faces and edges that it lies on besides
/// those with a layer.
bool Padding::Place(int node, Vector3d at, int copy)
{
  std::set<int> others;
  for (const int f : this->FacetsAt[At(node)])
  {
    if (this->Chosen.count(f) == 0)
    {
      others.insert(this->Facets[At(f)].Face);
    }
  }
  this->Mesh.Points.push_back(at);
  this->Mesh.PointDimension.push_back(3);
  this->Mesh.PointEntity.push_back(-1);
  if (others.empty())
  {
    return true;
  }
  if (others.size() == 1)
  {
    const int face = *others.begin();
    const FaceQuads& quads = this->QuadsOf(face);
    double least = std::numeric_limits<double>::max();
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < quads.Points.size(); ++i)
    {
      const double distance = (quads.Points[i] - at).squaredNorm();
      if (distance < least)
      {
        least = distance;
        place = quads.Places[i];
      }
    }
    this->Mesh.Points.back() = this->Faces.Chart(face).Project(at, place);
    this->Mesh.PointDimension.back() = 2;
    this->Mesh.PointEntity.back() = face;
    this->Places[copy] = { &this->Faces.Chart(face), place };
    return true;
  }
  // along an edge that leads from the node between two of these faces
  for (int edge = 0; others.size() == 2 && edge < static_cast<int>(this->Model.Edges.size());
       ++edge)
  {
    const auto& ends = this->Model.Edges[At(edge)].Vertices;
    if ((ends[0] != node && ends[1] != node) || ends[0] == ends[1])
    {
      continue;
    }
    const bool isBetween = std::all_of(others.begin(), others.end(),
      [&](int face)
      {
        const auto& loops = this->Model.Faces[At(face)].Loops;
        return std::any_of(loops.begin(), loops.end(),
          [&](const std::vector<CADTopologyUse>& loop)
          {
            return std::any_of(loop.begin(), loop.end(),
              [&](const CADTopologyUse& use) { return use.Edge == edge; });
          });
      });
    if (isBetween)
    {
      const double step = Depth * this->Nodes.ShareOf(edge, 1);
      const int last = this->Nodes.Counts[At(edge)];
      this->Mesh.Points.back() = this->Model.EdgePoint(
        edge, ends[0] == node ? step : 1.0 - Depth * (1.0 - this->Nodes.ShareOf(edge, last - 1)));
      this->Mesh.PointDimension.back() = 1;
      this->Mesh.PointEntity.back() = edge;
      return true;
    }
  }
  return false;
}

bool Padding::Add()
{
  std::map<int, int> copies;
  std::map<int, std::vector<int>> cellsOf; ///< of nodes with a copy
  for (const int f : this->Chosen)
  {
    for (const int node : this->Facets[At(f)].Corners)
    {
      cellsOf[node];
    }
  }
  for (std::size_t i = 0; i < this->Cells.Corners.size(); ++i)
  {
    const auto found = cellsOf.find(this->Cells.Corners[i]);
    if (found != cellsOf.end())
    {
      found->second.push_back(static_cast<int>(i / 8));
    }
  }
  for (const auto& [node, cells] : cellsOf)
  {
    Vector3d middle = Vector3d::Zero();
    for (const int cell : cells)
    {
      for (std::size_t corner = 0; corner < 8; ++corner)
      {
        middle += this->Mesh.Points[At(this->Cells.Corners[8 * At(cell) + corner])] /
          (8.0 * static_cast<double>(cells.size()));
      }
    }
    const Vector3d here = this->Mesh.Points[At(node)];
    copies[node] = static_cast<int>(this->Mesh.Points.size());
    // cells are twice as deep as their middles
    if (!this->Place(node, here + 2.0 * Depth * (middle - here), copies[node]))
    {
      return false;
    }
    if (this->Mesh.PointDimension.back() == 3)
    {
      this->Mesh.PointEntity.back() = this->Cells.Bodies[At(cells.front())];
    }
  }
  for (int& corner : this->Cells.Corners)
  {
    const auto copy = copies.find(corner);
    corner = copy == copies.end() ? corner : copy->second;
  }
  for (const int f : this->Chosen)
  {
    const Facet& facet = this->Facets[At(f)];
    for (const int corner : facet.Corners)
    {
      this->Cells.Corners.push_back(copies[corner]);
    }
    this->Cells.Corners.insert(
      this->Cells.Corners.end(), facet.Corners.begin(), facet.Corners.end());
    this->Cells.Bodies.push_back(this->Cells.Bodies[At(facet.Cell)]);
    this->Cells.Layers.push_back(this->Cells.Layers[At(facet.Cell)]);
  }
  return true;
}

double Padding::Least(int threads) const
{
  const UsedMesh used(this->Cells.Corners, this->Mesh.Points);
  const auto jacobians = ScaledJacobians(used.Mesh, used.Points, threads);
  return jacobians ? *std::min_element(jacobians->begin(), jacobians->end()) : -1.0;
}

Status Padding::Move(int threads, const ProgressCallback& progress)
{
  constexpr double Poor = 0.5; ///< scaled Jacobian
  const UsedMesh used(this->Cells.Corners, this->Mesh.Points);
  const CellMesh<3>& mesh = used.Mesh;
  std::vector<int> dimensions;
  std::map<int, LayerSlide::Place> places;
  for (std::size_t i = 0; i < used.Nodes.size(); ++i)
  {
    dimensions.push_back(this->Mesh.PointDimension[At(used.Nodes[i])]);
    if (const auto place = this->Places.find(used.Nodes[i]); place != this->Places.end())
    {
      places.emplace(static_cast<int>(i), place->second);
    }
  }
  const auto jacobians = ScaledJacobians(mesh, used.Points, threads);
  if (!jacobians)
  {
    return jacobians.Status;
  }
  const auto topology = MeshTopology<3>::Make(mesh);
  if (!topology)
  {
    return topology.Status;
  }
  const LayerSlide slide(dimensions, places);
  UntanglingParams params;
  params.Slide = &slide;
  params.Progress = progress;
  for (int cell = 0; cell < mesh.NumCells(); ++cell)
  {
    if (jacobians.Value[At(cell)] < Poor)
    {
      params.Poor.push_back(cell);
    }
  }
  const auto moved = UntangleMesh<3>(mesh, topology.Value, used.Points, params);
  if (!moved)
  {
    return moved.Status;
  }
  for (std::size_t i = 0; i < used.Nodes.size(); ++i)
  {
    this->Mesh.Points[At(used.Nodes[i])] =
      moved->Points.row(static_cast<Eigen::Index>(i)).transpose();
  }
  return {};
}
}

Result<int> PadSmoothSurfaces(const CADTopology& model, const FaceMesher& faces,
  const EdgeNodes& nodes, CADMesh& mesh, HexCells& cells, int threads,
  const ProgressCallback& progress)
{
  Padding padding(model, faces, nodes, mesh, cells);
  if (!padding.Choose())
  {
    return 0;
  }
  const double least = padding.Least(threads);
  const CADMesh meshBefore = mesh;
  const HexCells cellsBefore = cells;
  Status padded = padding.Add() ? padding.Move(threads, progress)
                                : Status{ ErrorCode::InvalidTopology, "a point has no place" };
  if (!padded && padded.Code != ErrorCode::InvalidTopology)
  {
    return padded;
  }
  if (!padded || padding.Least(threads) <= least)
  {
    mesh = meshBefore;
    cells = cellsBefore;
    return 0;
  }
  return padding.NumAdded();
}
}
