// SPDX-License-Identifier: BSD-3-Clause
#include "CADQuads.h"

#include "BodyGroups.h"
#include "FaceMesher.h"
#include <knotwork/MeshParameterization/MeshParameterization.h>
#include <knotwork/SplineCore/SizeLimit.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

class QuadMesher
{
public:
  QuadMesher(const CADTopology& model, const CADQuadsParams& params)
    : Model(model), Params(params), Faces(model, params)
  {
  }

  Result<CADQuads> Run();

private:
  Status CheckMapped() const;
  void FindMapped(const std::vector<RectangleFace>& equal);
  Status MeshFaces(const EdgeNodes& nodes, std::vector<int>& poor);
  void SeparateBodies(const std::vector<int>& groups, CADQuads& made) const;
  void RepeatSharedFaces(CADQuads& made) const;
  void Measure(CADQuads& made) const;
  Status Check(const CADQuads& made) const;

  const CADTopology& Model;
  const CADQuadsParams& Params;
  FaceMesher Faces;
  std::vector<bool> IsMapped; ///< with the present numbers
};

Status QuadMesher::CheckMapped() const
{
  for (int face = 0; face < static_cast<int>(this->Model.Faces.size()); ++face)
  {
    if (this->Params.Method == CADQuadMethod::Mapped &&
      this->Faces.Kind(face) == LogicalShapeKind::Other)
    {
      return { ErrorCode::InvalidTopology,
        FaceName(this->Model, face) +
          " is not mapped: its boundary is neither a loop with up to six corners, but for one, nor "
          "a ring; split it (cadmodify) or take Method automatic" };
    }
  }
  return {};
}

/// Rectangles and rings whose opposite sides have as many segments, and others that need not.
void QuadMesher::FindMapped(const std::vector<RectangleFace>& equal)
{
  this->IsMapped.clear();
  for (int face = 0; face < static_cast<int>(this->Model.Faces.size()); ++face)
  {
    const LogicalShapeKind kind = this->Faces.Kind(face);
    this->IsMapped.push_back(this->Params.Method != CADQuadMethod::Unstructured &&
      (kind == LogicalShapeKind::Polygon || kind == LogicalShapeKind::Segment ||
        kind == LogicalShapeKind::Disc));
  }
  for (const RectangleFace& one : equal)
  {
    this->IsMapped[At(one.Face)] = true;
  }
}

/// @param poor  result: faces whose quadrilaterals are none or bad.
Status QuadMesher::MeshFaces(const EdgeNodes& nodes, std::vector<int>& poor)
{
  constexpr double Poor = 0.05; ///< scaled Jacobian
  poor.clear();
  double numQuads = 0.0;
  for (int face = 0; face < static_cast<int>(this->Model.Faces.size()); ++face)
  {
    const Status& meshed = this->Faces.Mesh(face, nodes,
      !this->IsMapped[At(face)]                        ? FaceMethod::Paved
        : this->Params.Method == CADQuadMethod::Mapped ? FaceMethod::Grid
                                                       : FaceMethod::GridIfGood);
    if (meshed.Code == ErrorCode::TooLarge)
    {
      return { meshed.Code,
        FaceName(this->Model, face) + ": " + meshed.Detail +
          "; raise EdgeLength, Curvature or MaximumQuads" };
    }
    numQuads += static_cast<double>(this->Faces.Of(face).Quads.Quads.size());
    if (Status small = CheckSize(numQuads, this->Params.MaxQuads, "quadrilaterals", "MaximumQuads");
        !small)
    {
      return small;
    }
    if (!meshed || this->Faces.Of(face).Least < Poor)
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

void QuadMesher::Measure(CADQuads& made) const
{
  const CADMesh& mesh = made.Mesh;
  std::map<std::pair<int, int>, int> sides;
  std::vector<int> valence(mesh.Points.size(), 0);
  std::vector<bool> isOfFirst(mesh.Points.size(), false);
  for (std::size_t q = 0; q < mesh.Quads.size(); ++q)
  {
    const auto& quad = mesh.Quads[q];
    for (std::size_t i = 0; i < 4; ++i)
    {
      ++sides[std::minmax(quad[i], quad[(i + 1) % 4])];
      ++valence[At(quad[i])];
      isOfFirst[At(quad[i])] = isOfFirst[At(quad[i])] || made.BodyOfFace[q] == 0;
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
      if (mesh.PointDimension[p] == 2 && isOfFirst[p]) // of each face once
      {
        ++made.Faces[At(mesh.PointEntity[p])].ExtraordinaryPoints;
      }
    }
  }
  made.EulerNumber = used - static_cast<int>(sides.size()) + static_cast<int>(mesh.Quads.size());
}

/// @param groups  of the bodies: those of one keep the points that they have in common.
void QuadMesher::SeparateBodies(const std::vector<int>& groups, CADQuads& made) const
{
  CADMesh& mesh = made.Mesh;
  std::vector<int> corners;
  std::vector<int> groupOf;
  for (std::size_t q = 0; q < mesh.Quads.size(); ++q)
  {
    corners.insert(corners.end(), mesh.Quads[q].begin(), mesh.Quads[q].end());
    const auto& bodies = this->Model.Faces[At(mesh.QuadFace[q])].Bodies;
    groupOf.push_back(groups[At(bodies[At(made.BodyOfFace[q])])]);
  }
  for (const int point : SeparatePoints(corners, groupOf, static_cast<int>(mesh.Points.size())))
  {
    mesh.Points.push_back(mesh.Points[At(point)]);
    mesh.PointDimension.push_back(mesh.PointDimension[At(point)]);
    mesh.PointEntity.push_back(mesh.PointEntity[At(point)]);
  }
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    mesh.Quads[i / 4][i % 4] = corners[i];
  }
}

/// Quadrilaterals of faces that two bodies share once more, leading out of the second one.
void QuadMesher::RepeatSharedFaces(CADQuads& made) const
{
  CADMesh& mesh = made.Mesh;
  const std::size_t count = mesh.Quads.size();
  for (std::size_t q = 0; q < count; ++q)
  {
    const auto& bodies = this->Model.Faces[At(mesh.QuadFace[q])].Bodies;
    if (bodies.size() == 2 && bodies[0] != bodies[1])
    {
      const auto [a, b, c, d] = mesh.Quads[q];
      mesh.Quads.push_back({ a, d, c, b });
      mesh.QuadFace.push_back(mesh.QuadFace[q]);
      made.ScaledJacobians.push_back(made.ScaledJacobians[q]);
      made.BodyOfFace.push_back(1);
    }
  }
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
        FaceName(this->Model, made.Mesh.QuadFace[q]) +
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
              FaceName(this->Model, side.Face) +
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
  auto wishes = this->Faces.Wishes("MaximumQuads");
  if (!wishes)
  {
    return wishes.Status;
  }
  this->Faces.FindShapes();
  if (Status status = this->CheckMapped(); !status)
  {
    return status;
  }
  std::vector<RectangleFace> sides; ///< opposite ones have as many segments
  if (this->Params.Method != CADQuadMethod::Unstructured)
  {
    sides = this->Faces.Rectangles();
    for (const RectangleFace& rectangle : sides)
    {
      this->Faces.RaiseWishes(rectangle, wishes.Value);
    }
    sides.insert(sides.end(), this->Faces.Rings().begin(), this->Faces.Rings().end());
  }
  for (int round = 0;; ++round)
  {
    std::vector<RectangleFace> mapped = sides;
    auto divided = DivideEdges(this->Model, wishes.Value, {}, mapped);
    if (!divided)
    {
      return divided.Status;
    }
    const EdgeNodes nodes(this->Model, std::move(divided.Value));
    this->FindMapped(mapped);
    const auto left = std::find(this->IsMapped.begin(), this->IsMapped.end(), false);
    if (this->Params.Method == CADQuadMethod::Mapped && left != this->IsMapped.end())
    {
      return { ErrorCode::InvalidTopology,
        FaceName(this->Model, static_cast<int>(left - this->IsMapped.begin())) +
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
        const Status& failure = this->Faces.Of(face).Failure;
        if (!failure || this->Faces.Of(face).Least <= 0.0)
        {
          return { ErrorCode::InvalidTopology,
            FaceName(this->Model, face) +
              " cannot be meshed: " + (failure ? "its quadrilaterals fold over" : failure.Detail) +
              "; lower EdgeLength or Curvature, or split it (cadmodify)" };
        }
      }
      CADQuads made = this->Faces.Begin(nodes);
      for (int face = 0; face < static_cast<int>(this->Model.Faces.size()); ++face)
      {
        this->Faces.Append(face, made);
      }
      made.BodyOfFace.assign(made.Mesh.Quads.size(), 0);
      this->SeparateBodies(GroupsOfBodies(this->Model), made);
      if (Status checked = this->Check(made); !checked)
      {
        return checked;
      }
      if (this->Params.SolidsApart)
      {
        this->RepeatSharedFaces(made);
        std::vector<int> bodies(this->Model.Bodies.size());
        std::iota(bodies.begin(), bodies.end(), 0);
        this->SeparateBodies(bodies, made);
      }
      this->Measure(made);
      return made;
    }
    for (const int face : poor)
    {
      this->Faces.Halve(face, nodes, wishes.Value);
    }
  }
}
}

std::vector<std::string> JoinComposites(CADTopology& model)
{
  return model.JoinComposites(
    [](const PointMatrix& points,
      const std::vector<std::array<int, 3>>& triangles) -> Result<PointMatrix>
    {
      FlattenParams params;
      params.Method = FlattenMethod::Injective; // isometric where sheets unfold
      params.Threads = 1;
      const auto flat = FlattenMesh({ points, triangles }, params);
      if (!flat)
      {
        return flat.Status;
      }
      if (!flat->Injective)
      {
        return flat->Injective;
      }
      PointMatrix places = PointMatrix::Zero(points.rows(), 2);
      for (std::size_t i = 0; i < flat->Mesh.PointIds.size(); ++i)
      {
        places.row(flat->Mesh.PointIds[i]) = flat->UV.row(static_cast<Eigen::Index>(i));
      }
      return places;
    });
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
