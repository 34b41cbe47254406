// SPDX-License-Identifier: BSD-3-Clause
// Cuts that leave solids which can be swept.
#pragma once
#include <knotwork/CADModel/CADPieces.h>

#include <functional>

namespace knotwork
{
struct SweepCutsParams
{
  int MaxCuts = 3;
  int MaxTried = 24; ///< cuts of the same pieces, in CADPieces' order
  ProgressCallback Progress;
};

struct SweepCuts
{
  CADTopology Model;              ///< the pieces, composites joined
  std::vector<CADOperation> Cuts; ///< in this order
  std::vector<std::string> Notes; ///< of composites that stay in faces (JoinComposites)
};

/// Meshes pieces that can be swept. @return the share of cells that are not valid, 0: none;
/// InvalidTopology: others are to be tried.
using PieceMeshing = std::function<Result<double>(const CADTopology& model)>;

/// More cells that are not valid are no mesh: nothing that comes behind mends them.
inline constexpr double MostInvalidCells = 0.1;

/// The fewest cuts behind which all solids can be swept, and meshed: none where they can be as they
/// are. Of as many, those that leave the fewest solids. Pieces of which the fewest cannot be swept
/// are cut first, four of them; so cuts may be missed. Where cells are not valid, more cuts are
/// looked for; if they all fail, the pieces with the fewest such cells are meshed again at the end.
/// @return failures of CADPieces::Topology; those of the meshing: where nothing is found, that of
/// the solids as they are; InvalidTopology above MostInvalidCells; Aborted.
/// @complexity up to 1 + 4 (MaxCuts - 1) times MaxTried cuts.
Result<SweepCuts> FindSweepCuts(
  const CADPieces& pieces, const PieceMeshing& meshing, const SweepCutsParams& params = {});
}
