// SPDX-License-Identifier: BSD-3-Clause
// Vertices, edges and faces that cells share, and the nodes on them.
#pragma once
#include "MfemMesh.h"

namespace knotwork
{
/// One of MFEM's reference cells.
struct MfemReference
{
  int Dimension = 0;
  int NumCorners = 0;
  bool IsTensor = false;                   ///< a product of segments
  std::vector<std::array<int, 3>> Corners; ///< 0 or 1 a direction
  std::vector<std::array<int, 2>> Edges;   ///< by corners, of cells of two dimensions and more
  std::vector<std::vector<int>> Faces;     ///< by corners, of cells of three
};

const MfemReference& ReferenceOf(MfemShape shape);

/// Where a node of a cell is: on which of its vertices, edges, faces, or inside, and where there.
struct MfemPlace
{
  enum Kinds
  {
    Vertex,
    Edge,
    Face,
    Interior
  };
  Kinds Kind = Interior;
  int Which = 0;
  std::array<int, 2> At{};    ///< edge: steps from its first corner; face: from its first to its
                              ///< second, and to its last; interior: number
  std::array<int, 2> Count{}; ///< nodes from end to end in these directions
};

/// Places of the nodes of a cell with so many nodes a direction, first direction fastest. Simplices
/// and the triangles of wedges have as many in all their directions. @pre no pyramid.
std::vector<MfemPlace> LatticeOf(MfemShape shape, const std::array<int, 3>& count);

/// Edges and faces of all cells. They are numbered in the order in which cells meet them, but for
/// edges that are given.
class MfemEntities
{
public:
  /// @param edges  numbered first, in this order.
  MfemEntities(
    const std::vector<MfemCell>& cells, const std::vector<std::array<int, 2>>& edges = {});

  /// Number of edge or face `which` of a cell.
  int Edge(std::size_t cell, int which) const
  {
    return this->CellEdges[12 * cell + static_cast<std::size_t>(which)];
  }
  int Face(std::size_t cell, int which) const
  {
    return this->CellFaces[6 * cell + static_cast<std::size_t>(which)];
  }
  int NumEdges = 0;
  /// Corners as the first cell has them; the last of a triangle is -1.
  std::vector<std::array<int, 4>> Faces;

private:
  std::vector<int> CellEdges;
  std::vector<int> CellFaces;
};

/// Nodes of a mesh as MFEM numbers them: those of the vertices, then along edges from the vertex
/// of the lower number to the other, on faces as the first cell with the face sees them, inside
/// cells.
class MfemNumbering
{
public:
  MfemNumbering(const std::vector<MfemCell>& cells, int numVertices, const MfemEntities& entities)
    : Cells(cells), NumVertices(numVertices), Entities(entities)
  {
  }
  /// Tells the places of the nodes of the next cell. @return false when neighbours have other
  /// numbers of nodes on a common edge or face.
  bool Add(const std::vector<MfemPlace>& places);
  /// Ends the adding. @return the number of nodes.
  std::int64_t Finish();
  /// Number of the node at a place of a cell.
  std::int64_t Node(std::size_t cell, const MfemPlace& place) const;

private:
  const std::vector<MfemCell>& Cells;
  int NumVertices;
  const MfemEntities& Entities;
  std::size_t Added = 0;
  std::vector<std::int64_t> EdgeNodes; ///< how many, then where they begin
  std::vector<std::int64_t> FaceNodes;
  std::vector<std::int64_t> CellNodes;
};
}
