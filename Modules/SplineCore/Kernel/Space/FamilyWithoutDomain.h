// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChartCell.h"
#include "FunctionInfo.h"
#include "SpaceFamily.h"

#include <algorithm>

namespace knotwork
{
/// What families without a common parameter domain share: every element is a chart of its own.
template <int Dim>
class FamilyWithoutDomain : public SpaceFamily<Dim>
{
public:
  void Locate(const SplineSpace<Dim>&, const double*, std::ptrdiff_t, std::size_t n, int* elements,
    double*) const override
  {
    std::fill_n(elements, n, -1);
  }
  std::vector<FunctionInfo<Dim>> DescribeFunctions(const SplineSpace<Dim>&) const override
  {
    return {};
  }
  std::vector<ChartCell<Dim>> Charts(const SplineSpace<Dim>& space, int& numCharts) const override
  {
    std::vector<ChartCell<Dim>> cells(space.Elements.size());
    for (ChartCell<Dim>& cell : cells)
    {
      cell.Chart = numCharts++;
      cell.Size.fill(std::int64_t{ 1 } << ChartBits);
      cell.RimLow.fill(true);
      cell.RimHigh.fill(true);
    }
    return cells;
  }
};
}
