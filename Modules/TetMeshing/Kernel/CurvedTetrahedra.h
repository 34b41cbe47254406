// SPDX-License-Identifier: BSD-3-Clause
// Points on edges and faces of tetrahedra, private to the kernel.
#pragma once
#include "SolidMesh.h"

#include <knotwork/SplineCore/BernsteinCells.h>

namespace knotwork
{
/// Corners, edges and faces of tetrahedra, all of whose edges and faces have points of their own.
struct NodeLattice
{
  int Order = 1;
  int NumCorners = 0;
  std::vector<std::array<int, 2>> Edges; ///< lower corner first, ascending
  std::vector<std::array<int, 3>> Faces; ///< of order 3, corners ascending, ascending
  std::vector<std::vector<int>> Cells;   ///< points as SolidMesh has them

  int NumNodes() const;
  int FindEdge(int a, int b) const;               ///< number of an edge
  int FindFace(std::array<int, 3> corners) const; ///< number of a face, of order 3
  /// Point of an edge, k steps of 1 / Order from its lower corner on.
  int EdgeNode(int edge, int k) const;
  int FaceNode(int face) const;
};

NodeLattice MakeLattice(const std::vector<std::array<int, 4>>& cells, int numCorners, int order);

/// Where points belong, and how far they have come there from where they were without a target.
class CurvedNodes
{
public:
  /// @param corners  of the straight tetrahedra.
  CurvedNodes(const NodeLattice& lattice, const PointMatrix& corners);

  /// Straight positions: of corners theirs, of edges between where the ends are placed, of faces
  /// what their edges make.
  Eigen::RowVector3d Base(int node) const;
  /// Moves a node; those of edges after their ends, those of faces after their edges.
  void Place(int node, const Eigen::RowVector3d& at);
  const PointMatrix& Positions() const { return this->At; }

  /// Certifies all cells; moves points of cells that are not valid back until all are.
  /// @param relaxed  one a cell: whether one of its points is not where it was placed.
  /// @return NotConverged with a straight cell that is not valid; the errors of ValidateJacobian.
  Result<JacobianCertificate> Relax(int threads, std::vector<char>& relaxed);

private:
  bool IsPlaced(int node) const { return this->Placed[static_cast<std::size_t>(node)] != 0; }
  Eigen::RowVector3d BaseAmong(int node, const PointMatrix& positions) const;
  void Update();
  /// @return false when all its points are where they are without a target.
  bool MoveBack(const std::vector<int>& nodes);

  const NodeLattice& Lattice;
  PointMatrix Corners;
  PointMatrix At;
  PointMatrix Offsets; ///< of placed nodes from their bases
  std::vector<char> Placed;
  std::vector<double> Shares; ///< of the offsets that are taken
};

/// Cells in Bernstein form, with the rounding of the conversion.
BernsteinCells MakeBernstein(
  const NodeLattice& lattice, const PointMatrix& points, const std::vector<int>& which);
}
