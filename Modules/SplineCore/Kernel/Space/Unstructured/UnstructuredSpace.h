// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/CellMesh.h>
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Where a space on a mesh with extraordinary ridges is less smooth than C^(p-1).
enum class CreasePolicy
{
  Automatic,  ///< Full where that creases at most 40 % of the inner facets, else Motorcycle
              ///< (quadrilaterals) or Minimal (hexahedra)
  Full,       ///< C^0 on the base complex of the extraordinary ridges
  Motorcycle, ///< C^0 on tracks that end where they meet others; quadrilaterals only
  Minimal     ///< C^0 next to extraordinary ridges, then C^1, C^2 ... along the base complex
};

struct UnstructuredParams
{
  int Degree = 3; ///< in [1, 9], the same in all directions
  CreasePolicy Policy = CreasePolicy::Automatic;
  /// Inner facets that are C^0 whatever the policy, each seen from either cell.
  std::vector<CellSide> Features;
  /// Knot interval of every sheet of parallel edges (MeshTopology::FindSheets), positive; empty:
  /// all 1.
  std::vector<double> Lengths;
};

template <int Dim>
struct UnstructuredResult
{
  SplineSpacePtr<Dim> Space;
  CreasePolicy Policy = CreasePolicy::Full; ///< that was taken, never Automatic
  std::int64_t CreasedFacets = 0;           ///< inner facets with less than C^(p-1)
  std::int64_t InnerFacets = 0;
  /// Facets that are less smooth than the policy says, because it has no basis there: closed strips
  /// of less than p + 1 cells (Full), crossings of creases (Motorcycle, Minimal).
  std::int64_t Repairs = 0;
  std::int64_t ExtraordinaryRidges = 0;
  bool IsOrientable = true;
};

/// One space on any mesh of quadrilaterals or hexahedra: polynomials of degree p on every cell,
/// as smooth across facets as the policy says. Its functions are not negative, sum to one, and are
/// independent on every cell, where (p + 1)^Dim of them are alive.
/// @return the errors of MeshTopology::Make; InvalidDegree; InvalidParameter for a feature that is
/// no inner facet, lengths that are not positive and finite, Motorcycle for hexahedra; SizeMismatch
/// for lengths that are not one a sheet.
/// @complexity O(cells (p + 1)^Dim), each repair once more.
template <int Dim>
Result<UnstructuredResult<Dim>> MakeUnstructuredSpace(
  const CellMesh<Dim>& mesh, const UnstructuredParams& params = {});

/// The same for given continuity.
/// @param continuity  2 Dim a cell: order in [0, p - 1] across every side, the same from both
/// cells, ignored on the boundary.
/// @return InvalidParameter for an order out of range or one that differs between the cells;
/// NotInSpace for orders that have no such basis, with the facet or cell.
template <int Dim>
Result<SplineSpacePtr<Dim>> MakeUnstructuredSpace(const CellMesh<Dim>& mesh, int degree,
  const std::vector<int>& continuity, const std::vector<double>& lengths = {});

/// The mesh of an unstructured space, its continuities (-1 on the boundary) and lengths.
/// @pre space.Kind == SpaceKind::Unstructured.
template <int Dim>
const CellMesh<Dim>& MeshOf(const SplineSpace<Dim>& space);
template <int Dim>
std::vector<int> ContinuityOf(const SplineSpace<Dim>& space);

/// The family's entry in the table; curves have no such spaces.
template <int Dim>
const SpaceFamily<Dim>& UnstructuredFamily();
}
