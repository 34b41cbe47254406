// SPDX-License-Identifier: BSD-3-Clause
// Points on edges and faces of elements, private to the kernel.
#pragma once
#include "CurvedElements.h"

#include <Eigen/Core>

namespace knotwork
{
/// Corners around a face; triangles end with -1.
using FaceCorners = std::array<int, 4>;

/// Edges and faces of a shape, by its corners.
const std::vector<std::array<int, 2>>& EdgesOf(CellShape shape);
const std::vector<FaceCorners>& FacesOf(CellShape shape);

/// What is the same for all elements of one shape and order.
struct NodeTable
{
  /// One row a point within the shape, one column a point of it: where those within are when those
  /// around are anywhere.
  Eigen::MatrixXd Blend;
  std::vector<int> Inside;    ///< points within, ascending
  Eigen::MatrixXd ToBezier;   ///< coefficients x points
  Eigen::MatrixXd ErrorBound; ///< of products with ToBezier, times |points|
};

NodeTable MakeNodeTable(CellShape shape, int order);

/// Degree of all directions of a shape.
CellDegree DegreeOf(CellShape shape, int order);

/// Corners, edges, faces and insides of elements of one order, all of which have points of their
/// own. Points of faces are numbered from the lowest corner towards the lower one of its
/// neighbours, so that both elements of a face agree.
class NodeLattice
{
public:
  NodeLattice(const StraightElements& elements, int order);

  int Order;
  int NumCorners;
  std::vector<std::array<int, 2>> Edges; ///< lower corner first, ascending
  std::vector<FaceCorners> Faces;        ///< ascending
  std::vector<CellShape> Shapes;
  std::vector<int> Nodes; ///< points of the elements, in the order of the coefficients
  std::vector<std::size_t> Begin{ 0 };
  std::vector<std::vector<int>> FacesAt; ///< of every element: its faces, as FacesOf has them
  /// Points of every face, as those of an element that has its corners.
  std::vector<int> FaceNodes;
  std::vector<std::size_t> FaceBegin{ 0 };

  int NumNodes() const { return this->Count; }
  int NumElements() const { return static_cast<int>(this->Shapes.size()); }
  int FindEdge(int a, int b) const;
  int FindFace(const FaceCorners& corners) const; ///< -1: there is none
  bool IsVolume() const { return this->Volume; }
  CellShape FaceShape(int face) const
  {
    return this->Faces[static_cast<std::size_t>(face)][3] < 0 ? CellShape::Triangle
                                                              : CellShape::Quadrilateral;
  }
  /// Point of an edge, k steps of 1 / Order from its lower corner on.
  int EdgeNode(int edge, int k) const
  {
    return this->NumCorners + edge * (this->Order - 1) + k - 1;
  }
  /// Point of an edge or end of it, k steps from corner a on.
  int NodeBetween(int a, int b, int k) const;
  const NodeTable& Table(CellShape shape) const
  {
    return this->Tables[static_cast<std::size_t>(shape)];
  }

private:
  void CollectSides(const StraightElements& elements);
  void NumberFaces();
  void NumberElements(const StraightElements& elements);

  int Count = 0;
  bool Volume = false;
  std::array<NodeTable, NumCellShapes> Tables;
};
}
