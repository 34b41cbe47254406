// SPDX-License-Identifier: BSD-3-Clause
// What in a STEP file keeps it from being meshed with quadrilaterals and hexahedra.
#pragma once
#include "CADModify.h"

namespace knotwork
{
enum class CADSuggestionKind
{
  Sliver,       ///< a face that is thinner than Size
  TinyEdge,     ///< an edge that is shorter than Size
  TangentFaces, ///< faces that meet smoothly, to be taken as one
  Cut           ///< the extended surface of a face at a concave edge divides solids
};

struct CADSuggestion
{
  CADSuggestionKind Kind = CADSuggestionKind::Sliver;
  std::vector<int> Faces; ///< the sliver; those along the edge; those of the chain; the cut's tool
  double Size = 0.0;      ///< width, length, or largest angle between normals in degrees
  Eigen::Vector3d Point = Eigen::Vector3d::Zero(); ///< on the face or edge
  // of a cut: the model behind it
  int Solids = 0;
  int Swept = 0;  ///< solids that are swept from one face to another
  int Mapped = 0; ///< of these, with four sides and six faces
  int ConcaveEdges = 0;
};

struct CADSuggestParams
{
  LengthUnit Unit = LengthUnit::Millimetre;
  double Size = 0.0; ///< below it faces and edges are named; 0: a hundredth of the part's size
  double TangentAngle = 1; ///< degrees, in (0, 45]: faces meet smoothly below it
  int MaxCuts = 32;        ///< so many are tried, the longest concave edges first
};

struct CADSuggestions
{
  CADCounts Counts;
  double Size = 0.0; ///< that was used
  int Swept = 0;
  int Mapped = 0;
  int ConcaveEdges = 0;
  int UntriedCuts = 0;
  /// By kind; slivers and edges by size, chains by their first face, cuts by how many solids are
  /// not swept behind them, then by concave edges left.
  std::vector<CADSuggestion> List;
};

/// Reads a STEP file and looks for slivers, tiny edges, chains of tangent faces and cuts that leave
/// simpler solids. A face's width is that of the rectangle with its area and perimeter (the root of
/// its area when there is none). Cuts are tried, and those that divide a solid and keep the volume
/// are listed. A solid counts as swept when two faces without common vertices have as many edges
/// and loops and all other faces and edges lead from one to the other.
/// @return failures of ModifyCAD; InvalidParameter: Size below 0, TangentAngle, MaxCuts below 0.
Result<CADSuggestions> SuggestCADOperations(
  const std::string& file, const CADSuggestParams& params = {});
}
