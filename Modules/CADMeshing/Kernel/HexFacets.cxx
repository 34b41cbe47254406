// SPDX-License-Identifier: BSD-3-Clause
#include "HexFacets.h"

#include <algorithm>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
using Quad = std::array<int, 4>;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

Quad Sorted(Quad corners)
{
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// The faces that points of a mesh lie on, sorted.
class FacesOfPoints
{
public:
  FacesOfPoints(const CADTopology& model, const CADMesh& mesh)
    : Mesh(mesh), OfEdges(model.Edges.size()), OfVertices(model.Vertices.size())
  {
    for (int face = 0; face < static_cast<int>(model.Faces.size()); ++face)
    {
      for (const auto& loop : model.Faces[At(face)].Loops)
      {
        for (const CADTopologyUse& use : loop)
        {
          this->OfVertices[At(use.Vertex)].insert(face);
          if (use.Edge >= 0)
          {
            this->OfEdges[At(use.Edge)].insert(face);
          }
        }
      }
    }
  }

  bool IsOn(int point, int face) const
  {
    const int entity = this->Mesh.PointEntity[At(point)];
    switch (this->Mesh.PointDimension[At(point)])
    {
      case 0:
        return this->OfVertices[At(entity)].count(face) > 0;
      case 1:
        return this->OfEdges[At(entity)].count(face) > 0;
      case 2:
        return entity == face;
      default:
        return false;
    }
  }

private:
  const CADMesh& Mesh;
  std::vector<std::set<int>> OfEdges;
  std::vector<std::set<int>> OfVertices;
};
}

std::vector<CADHexFacet> FindFacetsOnFaces(
  const CADTopology& model, const CADMesh& mesh, const HexCells& cells)
{
  std::map<Quad, int> faceOfQuads;
  for (std::size_t q = 0; q < mesh.Quads.size(); ++q)
  {
    faceOfQuads[Sorted(mesh.Quads[q])] = mesh.QuadFace[q];
  }
  const FacesOfPoints faces(model, mesh);
  std::map<Quad, CADHexFacet> known; ///< without a point inside
  for (int side = 0; side < 6 * static_cast<int>(cells.Bodies.size()); ++side)
  {
    const CADHexFacet facet{ side / 6, side % 6 };
    Quad corners = CornersOfHexSide(facet.Side);
    for (int& corner : corners)
    {
      corner = cells.Corners[At(8 * facet.Cell + corner)];
    }
    if (std::any_of(corners.begin(), corners.end(),
          [&](int corner) { return mesh.PointDimension[At(corner)] > 2; }))
    {
      continue;
    }
    ++known.try_emplace(Sorted(corners), facet).first->second.NumCells;
  }
  std::vector<CADHexFacet> found;
  for (auto& [corners, facet] : known)
  {
    if (const auto face = faceOfQuads.find(corners); face != faceOfQuads.end())
    {
      facet.Face = face->second;
    }
    else if (facet.NumCells == 1)
    {
      for (const CADTopologySide& side : model.Bodies[At(cells.Bodies[At(facet.Cell)])].Sides)
      {
        const bool isOn = std::all_of(corners.begin(), corners.end(),
          [&, face = side.Face](int corner) { return faces.IsOn(corner, face); });
        facet.Face = isOn && facet.Face < 0 ? side.Face : facet.Face;
      }
    }
    if (facet.Face >= 0)
    {
      found.push_back(facet);
    }
  }
  std::sort(found.begin(), found.end(),
    [](const CADHexFacet& a, const CADHexFacet& b) {
      return std::array<int, 2>{ a.Cell, a.Side } < std::array<int, 2>{ b.Cell, b.Side };
    });
  return found;
}
}
