// SPDX-License-Identifier: BSD-3-Clause
// The space of given continuity on a mesh, private to the kernel.
#pragma once
#include "SplineSpace.h"
#include "UnstructuredData.h"

#include <string>

namespace knotwork
{
/// Where the continuity asked for has no basis of this kind.
struct Inadmissible
{
  enum class Reason
  {
    Negative,     ///< neither cell's coefficients are averages of the other's, across a facet
    Cycle,        ///< coefficients that depend on each other in a circle
    Disagreement, ///< two facets say different things of one coefficient
    Dependence    ///< functions alive on a cell are too few, too many or dependent
  };
  Reason Why = Reason::Dependence;
  int Cell = -1;
  int Side = -1; ///< -1: the cell itself
};
std::string Describe(const Inadmissible& place);

template <int Dim>
struct UnstructuredBuild
{
  SplineSpacePtr<Dim> Space; ///< none when something is inadmissible
  std::vector<Inadmissible> Places;
};

/// Every spline with the continuities of the data is one combination of the functions, with
/// non-negative extraction, partition of unity and (p + 1)^Dim functions alive on every cell that
/// are independent there; or the places that say why not.
/// @complexity O(cells (p + 1)^Dim).
template <int Dim>
UnstructuredBuild<Dim> BuildUnstructured(std::shared_ptr<const UnstructuredData<Dim>> data);
}
