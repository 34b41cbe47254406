// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/FunctionInfo.h>
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// How a set of marked cells or boxes grows before the space is refined.
struct RefinementParams
{
  /// Cells of the *new* level added around the marked ones on every side, >= 0. New functions
  /// appear only where 2 * Extension + 2 >= p + 1 new cells lie side by side.
  int Extension = 0;
  /// 0: no grading. m >= 2: the truncated functions alive on an element belong to at most m
  /// successive levels (strictly admissible meshes of class m; Buffa & Giannelli, M3AS 26 (2016)
  /// 1-25).
  int AdmissibleClass = 0;
  /// Cells at this level are not refined further. At most 24.
  int MaxLevel = 24;
};

/// Truncated hierarchical B-spline space: dyadic levels above level-0 knots, Kraft's selection,
/// truncated basis. Functions are numbered level by level, within a level first direction fastest.
/// Elements are the leaves of the refinement tree.
/// @param boxes  any order, may overlap; a box of level l also refines what lies below it to level
/// l.
/// @return InvalidTopology for a box outside its level grid or of level < 1 or > 24; TooLarge.
/// @source  Kraft 1997; Giannelli, Juettler, Speleers, CAGD 29 (2012) 485-498.
/// @complexity O(cells * (p+1)^Dim), no cost for levels as such.
template <int Dim>
Result<SplineSpacePtr<Dim>> MakeHierarchicalSpace(
  const std::array<KnotVector, Dim>& knots, const std::vector<HierarchyBox<Dim>>& boxes);

/// The boxes that describe a space's Omega^1, Omega^2, ...: a canonical, disjoint list; empty for a
/// Tensor space. MakeHierarchicalSpace(knots, HierarchyBoxes(space)) is the same space.
template <int Dim>
std::vector<HierarchyBox<Dim>> HierarchyBoxes(const SplineSpace<Dim>& space);

/// Splits elements (ids of a Tensor or Hierarchical space): an element of level l with cell index i
/// gives the box [2i - ext, 2i + 2 + ext) of level l + 1, grown to whole parent cells and clipped.
/// @return a Hierarchical space (the same one when nothing is refined); InvalidParameter for a bad
/// id.
template <int Dim>
Result<SplineSpacePtr<Dim>> RefineElements(const SplineSpacePtr<Dim>& space,
  const std::vector<int>& elements, const RefinementParams& params = {});

/// Refines boxes (grown by the extension in cells of their level and to whole parent cells,
/// clipped).
template <int Dim>
Result<SplineSpacePtr<Dim>> RefineBoxes(const SplineSpacePtr<Dim>& space,
  const std::vector<HierarchyBox<Dim>>& boxes, const RefinementParams& params = {});

/// The same map in a space that contains the spline's own (Tensor or Hierarchical, made by
/// refinement): exact up to rounding, weights included.
/// @return DimensionMismatch when the level-0 knots differ, InvalidTopology when refined does not
/// contain the spline's hierarchy.
/// @complexity O(level functions of refined * stencil).
template <int Dim>
Result<Spline<Dim>> TransferToRefined(
  const Spline<Dim>& spline, const SplineSpacePtr<Dim>& refined);

/// The family's entry in the table.
template <int Dim>
const SpaceFamily<Dim>& HierarchicalFamily();
}
