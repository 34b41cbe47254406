// SPDX-License-Identifier: BSD-3-Clause
// The points of a mesh on a target, private to the kernel.
#pragma once
#include "MeshClassification.h"

#include <knotwork/SplineCore/MeshUntangling.h>

namespace knotwork
{
struct VertexFitParams
{
  /// Whether points of faces go onto them; else those of curves and corners only, and rims.
  bool Surfaces = true;
  /// Points that stay where they are, one a point; empty: none.
  std::vector<char> IsHeld;
  /// Whether cells that are folded on the target are untangled.
  bool Untangle = true;
  /// Cells that get a better shape though they are not folded.
  std::vector<int> Poor;
  int Rings = 2; ///< as UntanglingParams
  int MaxSweeps = 100;
  int Threads = 0;
  ProgressCallback Progress;
};

struct VertexFit
{
  PointMatrix Points;
  std::vector<int> FoldedBefore; ///< cells of the mesh as it was given
  std::vector<int> Folded;       ///< cells as they are now
};

/// Points of the surface to their closest points on what they are classified as, those of a curve
/// in their order along it; points inside by as much as a harmonic function of the mesh's edges
/// says. Where cells fold they are untangled, points sliding on the target.
/// @return the target's errors, those of UntangleMesh.
template <int Dim>
Result<VertexFit> MoveOntoTarget(const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology,
  const SurfaceMesh& surface, const MeshClassification& parts, const PointMatrix& points,
  const FitTarget& target, const VertexFitParams& params);
}
