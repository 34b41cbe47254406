// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/HierarchicalSpace.h>

namespace knotwork
{
/// The space of G+Smo's boxes. There a cell has the highest level of the boxes that cover it and a
/// box may end inside a cell of the level before; our spaces refine whole cells, so boxes whose
/// union does not consist of whole cells are refused.
/// @param boxes  of levels >= 0 (those of level 0 say nothing), any order, may overlap.
/// @param maxLocalFunctions  elements times functions an element that the space may have.
/// @return InvalidTopology, TooLarge, the builder's codes.
template <int Dim>
Result<SplineSpacePtr<Dim>> MakeGismoSpace(const std::array<KnotVector, Dim>& knots,
  std::vector<HierarchyBox<Dim>> boxes, double maxLocalFunctions);
}
