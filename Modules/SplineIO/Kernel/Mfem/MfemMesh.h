// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/SplineFile.h>

#include <cstdint>
#include <string_view>

namespace knotwork
{
/// Shapes of cells by the numbers that the format has for them.
enum class MfemShape
{
  Point = 0,
  Segment,
  Triangle,
  Quadrilateral,
  Tetrahedron,
  Hexahedron,
  Wedge,
  Pyramid
};

/// Corners are vertices of the mesh, around a quadrilateral, below and then above in a hexahedron;
/// -1 behind the last.
struct MfemCell
{
  MfemShape Shape = MfemShape::Point;
  int Attribute = 0;
  std::array<int, 8> Corners{ -1, -1, -1, -1, -1, -1, -1, -1 };
};

/// What a mesh file says: linear cells, cells that are polynomials, or the patches of splines.
struct MfemMesh
{
  int Dimension = 0;           ///< of the cells
  std::vector<MfemCell> Cells; ///< of a NURBS mesh: the patches
  int NumVertices = 0;
  /// Of the cells' polynomials in every direction, 0 where the cells are linear.
  int Degree = 0;
  bool IsSpline = false;
  /// Polynomial cells: the numbers of their Bernstein coefficients, first direction fastest (of
  /// simplices and wedges those whose exponents exist), those of cell c from CellBegin[c].
  /// Neighbours share the points of a common vertex, edge or face where their values agree.
  std::vector<int> CellPoints;
  std::vector<std::int64_t> CellBegin;
  PointMatrix Points; ///< x 3: the vertices, or the coefficients; none of splines
  SplineFile Splines; ///< of a NURBS mesh, with its multi-patch
  std::vector<std::string> Warnings;
};

/// Reads an MFEM mesh v1.0, v1.1 without non-conforming cells, v1.2 or v1.3, or an MFEM NURBS mesh
/// v1.0. Nodes that are not equidistant are turned into Bernstein coefficients by the inverse of
/// the Bernstein polynomials' values at the nodes.
/// @return InvalidFormat with the line; InvalidDegree, InvalidKnots, InvalidWeight, NonFiniteInput
/// for what it says; TooLarge for values beyond 1e60; InvalidTopology for vertices that are not
/// there and edges that do not fit; InvalidParameter for finite elements and kinds of meshes that
/// are not read, Medit's too; EmptyInput without a cell.
/// @complexity time and memory O(size of the text), whatever counts it claims.
Result<MfemMesh> ReadMfemMesh(std::string_view text);

/// Whether a text may begin like this.
bool LooksLikeMfemMesh(std::string_view beginning);
}
