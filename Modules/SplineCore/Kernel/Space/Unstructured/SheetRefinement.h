// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Refinement.h>

namespace knotwork
{
/// Halves the cells of sheets of parallel edges along these edges, the cells where sheets cross (or
/// one itself) in both directions; the map stays. Facets keep their continuity, those inside of old
/// cells get C^(p-1). Cells that come from one follow each other in their order, lower halves
/// first, the first direction fastest.
/// @param sheets  numbers (MeshTopology::FindSheets of MeshOf the space); none: the same spline.
/// @return DimensionMismatch for a space without a mesh; InvalidParameter for a sheet that is not
/// there; NotInSpace when the continuities have no basis on the new mesh; Spline::Check's codes.
/// @complexity O(cells (p + 1)^(Dim + 1)).
template <int Dim>
Result<RefinedSpline<Dim>> HalveSheets(const Spline<Dim>& spline, const std::vector<int>& sheets);
}
