// SPDX-License-Identifier: BSD-3-Clause
// Splines on unstructured meshes halved and raised in degree, private to the kernel.
#pragma once
#include "SheetRefinement.h"

namespace knotwork
{
/// Every cell into 2^Dim, numbered c 2^Dim + corner; facets keep their continuity, those inside of
/// old cells get C^(p-1).
/// @return NotInSpace when that has no basis.
template <int Dim>
Result<RefinedSpline<Dim>> HalveAllSheets(const Spline<Dim>& spline);
/// HalveSheets of all sheets through the cells. @param cells  that are there.
template <int Dim>
Result<RefinedSpline<Dim>> HalveSheetsOfCells(
  const Spline<Dim>& spline, const std::vector<int>& cells);
/// The same cells and continuities, with the degree raised by times > 0.
template <int Dim>
Result<Spline<Dim>> ElevateUnstructured(const Spline<Dim>& spline, int times);
}
