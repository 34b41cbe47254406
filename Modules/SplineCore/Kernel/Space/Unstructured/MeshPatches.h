// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/UnstructuredSpace.h>

namespace knotwork
{
/// A box of cells: all cells of a grid of Size[0] x Size[1] ... cells, first direction fastest.
template <int Dim>
struct MeshPatch
{
  IntArray<Dim> Size{};
  std::vector<int> Cells;
};

/// A mesh as boxes that meet along its cut facets.
template <int Dim>
struct MeshPatches
{
  std::vector<MeshPatch<Dim>> Patches; ///< in the order of their lowest cells
  std::vector<int> PatchOf;            ///< of every cell
  /// Place of every cell in its patch, and how it lies there: direction d of the patch goes out of
  /// side Ahead[d] of the cell.
  std::vector<IntArray<Dim>> IndexOf;
  std::vector<IntArray<Dim>> AheadOf;
  std::vector<CellSide> Cuts; ///< inner facets between patches (a patch may meet itself), each once
  /// Quadrilaterals: points where a track ends on another, inside of a side of a patch; each as a
  /// cell and its corner.
  std::vector<CellSide> TJoints;
};

/// Cuts a mesh along the base complex (CreasePolicy::Full: patches meet along whole sides) or along
/// the tracks of motorcycles (quadrilaterals: fewer patches, with T-joints), and features; strips
/// of cells that close without a cut are cut at one facet and all its opposites.
/// @return as MakeUnstructuredSpace; InvalidParameter for other policies.
/// @complexity O(cells), each strip that closes once more.
/// @source  Eppstein, Goodrich, Kim, Tamstorf, SGP 2008; Bommes, Lempfer, Kobbelt, CGF 30 (2011)
/// (base complex).
template <int Dim>
Result<MeshPatches<Dim>> FindMeshPatches(const CellMesh<Dim>& mesh,
  CreasePolicy policy = CreasePolicy::Full, const std::vector<CellSide>& features = {});

/// The same of a space, which is C^1 or smoother inside of every patch: cuts where it is C^0, and
/// where what is left is no box straight through its cells.
/// @pre space.Kind == SpaceKind::Unstructured.
template <int Dim>
MeshPatches<Dim> FindSpacePatches(const SplineSpace<Dim>& space);
}
