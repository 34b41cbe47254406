// SPDX-License-Identifier: BSD-3-Clause
// Patches of an unstructured space as tensor-product spaces, private to the kernel.
#pragma once
#include "MeshPatches.h"
#include "UnstructuredData.h"

namespace knotwork
{
/// Clamped B-splines of a patch: the intervals of its sheets, every layer of facets as smooth as
/// the least smooth one of them. Its elements are the patch's cells, in their order.
template <int Dim>
Result<SplineSpacePtr<Dim>> MakePatchSpace(
  const UnstructuredData<Dim>& data, const MeshPatches<Dim>& layout, const MeshPatch<Dim>& patch);

/// Entry of a cell's own tensor array of (points)^Dim values for every entry of the same array in
/// the directions of its patch, first direction fastest.
template <int Dim>
std::vector<int> TurnedEntries(int points, const IntArray<Dim>& ahead);

/// The function of the unstructured space that every function of a patch is.
/// @return NotInSpace with the patch and the cell where it is none: C^1 or smoother across a side,
/// or an average of others (next to T-joints).
template <int Dim>
Result<std::vector<int>> FunctionsOfPatch(const SplineSpace<Dim>& space,
  const MeshPatches<Dim>& layout, int patch, const SplineSpace<Dim>& patchSpace);
}
