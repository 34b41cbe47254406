// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy.h"

#include <algorithm>
#include <limits>

namespace knotwork
{
template <int Dim>
std::vector<DyadicKnots> MakeDyadicKnots(const std::array<KnotVector, Dim>& knots)
{
  std::vector<DyadicKnots> dyadic;
  for (const KnotVector& k : knots)
  {
    dyadic.emplace_back(k);
  }
  return dyadic;
}

template <int Dim>
Hierarchy<Dim> SelectFunctions(
  const std::vector<DyadicKnots>& knots, const HierarchyCells<Dim>& cells)
{
  // Both counters of a function in one word: its cells, and above them its refined cells.
  constexpr std::uint32_t refined = std::uint32_t(1) << 16;
  IntArray<Dim> shape;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    shape[d] = knots[d].Degree() + 1;
  }
  Hierarchy<Dim> hierarchy;
  hierarchy.Levels.resize(cells.size());
  for (std::size_t l = 0; l < cells.size(); ++l)
  {
    const int level = static_cast<int>(l);
    const auto firstFunction = [&](const HierarchyCell<Dim>& cell)
    {
      LevelIndex<Dim> first;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        first[d] = knots[d].FirstFunction(level, cell.Index[d]);
      }
      return first;
    };
    LevelIndex<Dim> lower, upper;
    lower.fill(std::numeric_limits<std::int64_t>::max());
    upper.fill(0);
    for (const auto& cell : cells[l])
    {
      const LevelIndex<Dim> first = firstFunction(cell);
      for (std::size_t d = 0; d < Dim; ++d)
      {
        lower[d] = std::min(lower[d], first[d]);
        upper[d] = std::max(upper[d], first[d] + shape[d]);
      }
    }
    HierarchyLevel<Dim>& result = hierarchy.Levels[l];
    result.Functions = FunctionMap<Dim>(lower, upper, cells[l].size());
    for (const auto& cell : cells[l])
    {
      result.Functions.CountBlock(
        firstFunction(cell), shape, cell.Element < 0 ? 1 + refined : std::uint32_t(1));
    }
    const std::vector<std::uint32_t> counters = result.Functions.Finish();

    std::array<IndexMemo<int>, Dim> supports;
    result.Ids.resize(counters.size());
    for (std::size_t i = 0; i < counters.size(); ++i)
    {
      std::uint32_t support = 1;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        support *= static_cast<std::uint32_t>(supports[d].Get(result.Functions.Index(i)[d],
          [&](std::int64_t function) { return knots[d].Support(level, function).Size(); }));
      }
      if (counters[i] % refined < support)
      {
        result.Ids[i] = HierarchyLevel<Dim>::Partial;
      }
      else if (counters[i] / refined == support)
      {
        result.Ids[i] = HierarchyLevel<Dim>::Covered;
      }
      else
      {
        result.Ids[i] = hierarchy.NumFunctions++;
      }
    }
  }
  return hierarchy;
}

template <int Dim>
void ParentStencil<Dim>::Find(const FunctionMap<Dim>& parents, const LevelIndex<Dim>& child)
{
  std::array<const DyadicKnots::TwoScaleRow*, Dim> rows;
  LevelIndex<Dim> first;
  IntArray<Dim> shape;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    rows[d] = &this->Memo[d].Get(
      child[d], [&](std::int64_t i) { return this->Knots[d].Parents(this->Level, i); });
    first[d] = rows[d]->First;
    shape[d] = rows[d]->Count;
  }
  std::size_t count = 1;
  for (int n : shape)
  {
    count *= static_cast<std::size_t>(n);
  }
  this->Numbers.resize(count);
  this->Weights.resize(count);
  parents.FindBlock(first, shape, this->Numbers.data());
  double* weight = this->Weights.data();
  ForEachOffset<Dim>(shape,
    [&](const IntArray<Dim>& offset)
    {
      double w = 1.0;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        w *= rows[d]->Weight[offset[d]];
      }
      *weight++ = w;
    });
}

template std::vector<DyadicKnots> MakeDyadicKnots<1>(const std::array<KnotVector, 1>&);
template std::vector<DyadicKnots> MakeDyadicKnots<2>(const std::array<KnotVector, 2>&);
template std::vector<DyadicKnots> MakeDyadicKnots<3>(const std::array<KnotVector, 3>&);
template Hierarchy<1> SelectFunctions<1>(const std::vector<DyadicKnots>&, const HierarchyCells<1>&);
template Hierarchy<2> SelectFunctions<2>(const std::vector<DyadicKnots>&, const HierarchyCells<2>&);
template Hierarchy<3> SelectFunctions<3>(const std::vector<DyadicKnots>&, const HierarchyCells<3>&);
template class ParentStencil<1>;
template class ParentStencil<2>;
template class ParentStencil<3>;
}
