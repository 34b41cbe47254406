// SPDX-License-Identifier: BSD-3-Clause
#include "CornerSolid.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Where the sides of a face are in its solid.
struct FaceSides
{
  std::vector<int> Corners;           ///< vertices, in the order of the loop
  std::vector<int> Sides;             ///< from each corner to the next one
  Vector3d Middle = Vector3d::Zero(); ///< of places along its loop
};

class CornerFinder
{
public:
  CornerFinder(const CADTopology& model, const FaceMesher& mesher, int body)
    : Model(model), Mesher(mesher), Body(model.Bodies[At(body)])
  {
  }

  bool Find(CornerSolid& solid)
  {
    std::map<std::vector<int>, std::vector<int>> facesOfSides;
    std::map<std::vector<int>, int> numbers;
    for (const CADTopologySide& side : this->Body.Sides)
    {
      const LogicalShapeKind kind = this->Mesher.Kind(side.Face);
      if ((kind != LogicalShapeKind::Rectangle && kind != LogicalShapeKind::Polygon) ||
        !this->Outward.emplace(side.Face, side.Reversed ? -1.0 : 1.0).second)
      {
        return false;
      }
      FaceSides& ofFace = this->Faces[side.Face];
      for (const auto& uses : this->Mesher.Sides(side.Face))
      {
        std::vector<int> edges;
        for (const CADTopologyUse& use : uses)
        {
          this->AddMiddle(use, ofFace);
          edges.push_back(use.Edge);
        }
        std::sort(edges.begin(), edges.end());
        const auto [known, isNew] = numbers.emplace(edges, static_cast<int>(solid.Sides.size()));
        if (isNew)
        {
          solid.Sides.push_back({ edges, { side.Face, -1 } });
        }
        else if (solid.Sides[At(known->second)].Faces[1] >= 0)
        {
          return false;
        }
        else
        {
          solid.Sides[At(known->second)].Faces[1] = side.Face;
        }
        ofFace.Corners.push_back(uses.front().Vertex);
        ofFace.Sides.push_back(known->second);
      }
      ofFace.Middle /= this->NumPlaces;
      this->NumPlaces = 0.0;
    }
    return std::all_of(solid.Sides.begin(), solid.Sides.end(),
             [&](const CornerSide& side) { return this->IsSharpAndConvex(side); }) &&
      this->FindCorners(solid);
  }

private:
  void AddMiddle(const CADTopologyUse& use, FaceSides& ofFace)
  {
    for (const double share : { 0.0, 0.25, 0.5, 0.75 })
    {
      ofFace.Middle += this->Model.EdgePoint(use.Edge, share);
      this->NumPlaces += 1.0;
    }
  }

  Vector3d NormalAt(int face, int edge) const
  {
    const auto& loop = this->Model.Faces[At(face)].Loops.front();
    const auto use = std::find_if(
      loop.begin(), loop.end(), [&](const CADTopologyUse& one) { return one.Edge == edge; });
    return this->Outward.at(face) *
      this->Model.FaceNormal(
        face, this->Model.UseParameters(face, 0, static_cast<int>(use - loop.begin()), 0.5));
  }

  /// By the normals in the middle of its edges: each face lies below the other one there.
  bool IsSharpAndConvex(const CornerSide& side) const
  {
    constexpr double MostTurn = 0.7071; // cosine of 45 degrees
    if (side.Faces[1] < 0)
    {
      return false;
    }
    return std::all_of(side.Edges.begin(), side.Edges.end(),
      [&](int edge)
      {
        const Vector3d place = this->Model.EdgePoint(edge, 0.5);
        const Vector3d first = this->NormalAt(side.Faces[0], edge);
        const Vector3d second = this->NormalAt(side.Faces[1], edge);
        return first.dot(second) < MostTurn &&
          first.dot(this->Faces.at(side.Faces[1]).Middle - place) < 0.0 &&
          second.dot(this->Faces.at(side.Faces[0]).Middle - place) < 0.0;
      });
  }

  bool FindCorners(CornerSolid& solid) const
  {
    struct Place
    {
      int Face;
      std::array<int, 2> Sides; ///< that begins there, that ends there
    };
    std::map<int, std::vector<Place>> places; ///< by vertices
    for (const auto& [face, ofFace] : this->Faces)
    {
      const std::size_t n = ofFace.Corners.size();
      for (std::size_t i = 0; i < n; ++i)
      {
        places[ofFace.Corners[i]].push_back(
          { face, { ofFace.Sides[i], ofFace.Sides[(i + n - 1) % n] } });
      }
    }
    for (const auto& [vertex, of] : places)
    {
      SolidCorner corner;
      corner.Vertex = vertex;
      if (of.size() != 3)
      {
        return false;
      }
      std::set<int> sides;
      for (const Place& place : of)
      {
        sides.insert(place.Sides.begin(), place.Sides.end());
      }
      if (sides.size() != 3)
      {
        return false;
      }
      std::copy(sides.begin(), sides.end(), corner.Sides.begin());
      for (std::size_t i = 0; i < 3; ++i)
      {
        const std::set<int> pair{ corner.Sides[i], corner.Sides[(i + 1) % 3] };
        const auto between = std::find_if(of.begin(), of.end(),
          [&](const Place& place)
          { return std::set<int>(place.Sides.begin(), place.Sides.end()) == pair; });
        if (between == of.end())
        {
          return false;
        }
        corner.Faces[i] = between->Face;
      }
      solid.Corners.push_back(corner);
    }
    // of a ball: no handles, no cavities
    return solid.Corners.size() + this->Faces.size() == solid.Sides.size() + 2;
  }

  const CADTopology& Model;
  const FaceMesher& Mesher;
  const CADTopologyBody& Body;
  std::map<int, double> Outward; ///< sign of the normals of faces
  std::map<int, FaceSides> Faces;
  double NumPlaces = 0.0;
};
}

std::optional<CornerSolid> CornersOf(const CADTopology& model, const FaceMesher& faces, int body)
{
  CornerSolid solid;
  return model.Bodies[At(body)].IsSolid && CornerFinder(model, faces, body).Find(solid)
    ? std::optional<CornerSolid>(std::move(solid))
    : std::nullopt;
}
}
