// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>

namespace knotwork
{
/// Level and multi-index (in the level's tensor-product basis) of every function, and its anchor:
/// the centre of its Greville abscissae. Functions of a
/// LocallyRefined space all have level 0 and the number of the function as their first index. Empty
/// without a parameter domain.
template <int Dim>
struct FunctionInfo
{
  int Level = 0;
  std::array<std::int64_t, Dim> Index{};
  RealArray<Dim> Greville{};
};
template <int Dim>
std::vector<FunctionInfo<Dim>> DescribeFunctions(const SplineSpace<Dim>& space);
}
