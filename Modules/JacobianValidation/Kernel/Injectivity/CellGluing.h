// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BoundaryInjectivity.h"
#include "CellPieces.h"

/// Private to the injectivity proof: sides of cells, which of them are glued, and what the others
/// share.
namespace knotwork
{
/// A side of a cell as a cell of one dimension less. Its orientation is outward when det J > 0.
struct SideFrame
{
  CellShape Shape = CellShape::Curve;
  int NumCorners = 0;
  std::array<int, 4> Corners{}; ///< the cell's corners in the order of the side's
};
const SideFrame& GetSideFrame(CellShape shape, int side);
CellDegree SideDegree(CellShape shape, const CellDegree& degree, const SideFrame& frame);
/// Coefficients of the cell in the order of the side's.
std::vector<int> SideCoefficients(
  CellShape shape, const CellDegree& degree, const SideFrame& frame);
/// Local parameters of the cell at side parameters s.
std::array<double, 3> SideToCell(CellShape shape, const SideFrame& frame, const double* s);

/// Edges of a plane side: pairs of its corners, and the parameter along an edge of a point on it
/// (negative when it is not on it).
int NumSideEdges(CellShape side);
std::array<int, 2> SideEdge(CellShape side, int edge);
double EdgeParameter(CellShape side, int edge, const std::array<double, 3>& s);

/// An unglued side.
struct BoundarySide
{
  int Cell = -1;
  int Number = -1;
  SideFrame Frame;
  CellDegree Degree{};
  std::vector<double> Data;
  double Error = 0.0;
  int Patch = -1;
  int Component = -1;
  std::array<int, 4> Vertices{ -1, -1, -1, -1 }; ///< points of the complex
  std::array<int, 4> Places{ -1, -1, -1, -1 };   ///< points that coincide exactly are one place
  /// Edges of the complex (volumes only), and the line of their patch's parameter domain.
  std::array<int, 4> Edges{ -1, -1, -1, -1 };
  std::array<int, 4> Lines{ -1, -1, -1, -1 };
  std::array<std::array<double, 2>, 4> LineEnds{}; ///< at the edge's first and second corner
  std::array<bool, 4> CollapsedEdges{ false, false, false, false };
};

/// Where two sides meet: at corners, or along edges from A0 to A1 and B0 to B1 of their parameters.
struct SideContact
{
  bool IsEdge = false;
  int A = -1;
  int B = -1;
  double A0 = 0.0;
  double A1 = 1.0;
  double B0 = 0.0;
  double B1 = 1.0;
};

struct CellGluing
{
  std::vector<BoundarySide> Boundary;
  int NumComponents = 0;
  int NumInterfaces = 0;
  int NumSeams = 0;
  int NumCollapsed = 0;
  int NumTouching = 0;
  double InnerRounding = 0.0;
  /// The first of each kind, if any: cell and side.
  std::array<int, 4> Folded{ -1, -1, -1, -1 }; ///< cell, side, cell, side
  std::array<int, 2> Partial{ -1, -1 };
  std::array<int, 2> Open{ -1, -1 };
  std::array<int, 4> Torn{ -1, -1, -1, -1 }; ///< inner sides that differ by more than allowed
  double TornSize = 0.0;
  /// The first edge of a solid, if any, that is one point though all sides around it are glued:
  /// cell and two of its corners.
  std::array<int, 3> InnerPoint{ -1, -1, -1 };
};

/// @param signs  1 or -1 a cell: of det J.
CellGluing GlueCells(const BernsteinCells& cells, const CellComplex& complex,
  const std::vector<int>& signs, const InjectivityParams& params);

/// What two boundary sides share (of one side with itself: its own edges and corners).
std::vector<SideContact> FindContacts(const std::vector<BoundarySide>& boundary, int a, int b);
}
