// SPDX-License-Identifier: BSD-3-Clause
// The surface of a mesh of quadrilaterals or hexahedra, private to the kernel.
#pragma once
#include <knotwork/SplineCore/CellMesh.h>
#include <knotwork/SplineCore/Types.h>

namespace knotwork
{
/// What an edge may have in the place of its second quadrilateral.
enum EdgeEnds : int
{
  Rim = -1,      ///< the mesh ends
  EndOfPart = -2 ///< the part that is meant ends, and the mesh goes on
};

/// Quadrilaterals of a mesh, or the faces on the boundary of hexahedra, with their edges.
struct SurfaceMesh
{
  std::vector<CellSide> Facets;            ///< a face of a hexahedron; a quadrilateral: side -1
  std::vector<std::array<int, 4>> Quads;   ///< points in cyclic order, of hexahedra from outside
  std::vector<std::array<int, 4>> EdgesOf; ///< of a quadrilateral; k from corner k to k + 1
  std::vector<std::array<int, 2>> Edges;   ///< ends, the lower point first
  std::vector<std::array<int, 2>> QuadsOf; ///< of an edge; the second may be one of EdgeEnds
  std::vector<int> Points;                 ///< that are on the surface, ascending
  std::vector<int> EdgeStart;              ///< of every point of the mesh: into EdgesAt
  std::vector<int> EdgesAt;                ///< edges at the points

  /// The other end of an edge.
  int Across(int edge, int point) const
  {
    const auto& ends = this->Edges[static_cast<std::size_t>(edge)];
    return ends[0] == point ? ends[1] : ends[0];
  }
  /// Visits the edges at a point.
  template <class Visit>
  void ForEdges(int point, Visit&& visit) const
  {
    const auto at = static_cast<std::size_t>(point);
    for (int i = this->EdgeStart[at]; i < this->EdgeStart[at + 1]; ++i)
    {
      visit(this->EdgesAt[static_cast<std::size_t>(i)]);
    }
  }
};

/// @param isMeant  one a cell: whether its facets are in it; empty: all are.
template <int Dim>
SurfaceMesh MakeSurfaceMesh(const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology,
  const std::vector<char>& isMeant = {});

/// Points of the surface of the whole mesh that are not in a part of it.
template <int Dim>
std::vector<char> PointsBeside(
  const SurfaceMesh& part, const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology);

/// Mean length of the edges of the surface at every point; 0 inside.
std::vector<double> EdgeLengthsAt(const SurfaceMesh& surface, const PointMatrix& points);
}
