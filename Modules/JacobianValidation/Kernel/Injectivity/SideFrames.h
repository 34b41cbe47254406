// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BernsteinCells.h>

/// Private to the injectivity proof: sides of cells as cells of their own.
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
}
