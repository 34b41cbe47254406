// SPDX-License-Identifier: BSD-3-Clause
// Meshes of finite elements as solvers' files have them.
#pragma once
#include <knotwork/SplineIO/MfemMesh.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace knotwork
{
using ElementShape = MfemShape;

/// Which element a row of nodes is.
struct ElementKind
{
  ElementShape Shape = ElementShape::Segment;
  int Degree = 1;
  bool IsComplete = true; ///< false: serendipity, without nodes in quadrilaterals and inside
  /// Of every node in the file's order: its steps of 1 / Degree in the reference cell: a unit
  /// segment, square or cube; x, y, z >= 0 with x + y + z <= 1 (tetrahedra), x + y <= 1 (triangles,
  /// wedges); the unit cube, whose upper face is the apex (0, 0, 1) (pyramids).
  std::vector<std::array<int, 3>> Places;
};

/// A group of elements with a name.
struct ElementGroup
{
  std::string Name;
  int Dimension = 0; ///< of its elements
  int Id = 0;
};

/// Nodes or elements that a file gives a name: Members are rows of the mesh.
struct ElementSet
{
  std::string Name;
  bool OfNodes = false;
  std::vector<std::int64_t> Members;
};

struct ElementMesh
{
  PointMatrix Points;                    ///< x 3
  std::vector<std::int64_t> NodeNumbers; ///< of the points in the file
  /// Group of the point element at a node, 0 without one; empty where there are none.
  std::vector<int> NodeGroups;
  std::vector<ElementKind> Kinds;
  std::vector<int> KindOf;                  ///< of every element: row of Kinds
  std::vector<std::int64_t> ElementNumbers; ///< in the file
  std::vector<int> Entities;                ///< geometric entity that an element lies on
  /// Row of GroupLists: the numbers of the groups that an element is in.
  std::vector<int> GroupListOf;
  std::vector<std::vector<int>> GroupLists;
  std::vector<ElementGroup> Groups; ///< those with names
  std::vector<ElementSet> Sets;
  std::vector<std::int64_t> Nodes; ///< points of all elements, in the order of Kinds
  std::vector<std::int64_t> Begin; ///< of every element in Nodes, and the end
  std::vector<std::string> LeftOut;
};

/// Parameters of a shape.
int DimensionOf(ElementShape shape);

/// Places of the nodes at corners and along edges, as ElementKind has them.
/// @param edges  of the middle nodes, by corners, in the order of the nodes.
std::vector<std::array<int, 3>> QuadraticPlaces(
  ElementShape shape, const std::vector<std::array<int, 2>>& edges);

/// Corners of a reference cell, around quadrilaterals.
const std::vector<std::array<int, 3>>& CornersOf(ElementShape shape);
}
