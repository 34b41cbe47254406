// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SideFrames.h"

/// Private to the injectivity proof: sides of cells that are not glued, and what they share.
namespace knotwork
{
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

/// What two boundary sides share (of one side with itself: its own edges and corners).
std::vector<SideContact> FindContacts(const std::vector<BoundarySide>& boundary, int a, int b);
}
