// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/MeshPatches.h>
#include <knotwork/SplineCore/MultiPatch.h>

namespace knotwork
{
/// The same map as tensor-product patches, C^1 or smoother inside: one a patch of FindSpacePatches,
/// with the intervals of its sheets. Sides that are one are stated, in part too where there are
/// T-joints (surfaces), and those on the mesh's boundary.
/// @return EmptyInput; DimensionMismatch unless the space is of kind Unstructured; Spline::Check's
/// codes.
/// @param layout  takes FindSpacePatches of the space; may be null.
template <int Dim>
Result<MultiPatch<Dim>> SplitIntoPatches(
  const Spline<Dim>& spline, int threads = 0, MeshPatches<Dim>* layout = nullptr);

/// A facet of the mesh on a side of a patch.
struct SideFacet
{
  CellSide Facet;   ///< as the patch's cell has it
  CellSide Other;   ///< as the cell beyond has it; Cell = -1 on the boundary
  PatchSide Beyond; ///< side of the patch there
};
/// Facets along a side, first direction fastest.
template <int Dim>
std::vector<SideFacet> FacetsOfSide(
  const SplineSpace<Dim>& space, const MeshPatches<Dim>& layout, const PatchSide& side);
}
