// SPDX-License-Identifier: BSD-3-Clause
#include "DyadicTree.h"

#include "DyadicKnots.h"
#include "Hierarchy.h"
#include "Refinement.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
constexpr std::size_t LocateBlockSize = 64;

/// Root cells and local parameters of up to LocateBlockSize points; cell -1 outside. One direction
/// and one step of the arithmetic at a time, so that the compiler uses vectors.
template <int Dim>
void LocateRootCells(const std::array<KnotVector, Dim>& knots, const double* u,
  std::ptrdiff_t stride, std::size_t n, int* cells, double* local)
{
  std::fill_n(cells, n, 0);
  bool inside[LocateBlockSize];
  std::fill_n(inside, n, true);
  int numCells = 1;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    double x[LocateBlockSize] = {};
    double lower[LocateBlockSize];
    double upper[LocateBlockSize];
    int elements[LocateBlockSize];
    for (std::size_t i = 0; i < n; ++i)
    {
      x[i] = u[static_cast<std::ptrdiff_t>(i) * stride + static_cast<std::ptrdiff_t>(d)];
    }
    knots[d].FindElements(x, n, elements);
    const double* breaks = knots[d].Breaks().data();
    for (std::size_t i = 0; i < n; ++i)
    {
      lower[i] = breaks[elements[i]];
      upper[i] = breaks[elements[i] + 1];
      cells[i] += numCells * elements[i];
    }
    const double slack = 1e-12 * (knots[d].End() - knots[d].Begin());
    const double begin = knots[d].Begin() - slack;
    const double end = knots[d].End() + slack;
    for (std::size_t i = 0; i < n; ++i)
    {
      inside[i] = inside[i] && x[i] >= begin && x[i] <= end;
    }
    for (std::size_t i = 0; i < n; ++i)
    {
      x[i] = std::clamp((x[i] - lower[i]) / (upper[i] - lower[i]), 0.0, 1.0);
    }
    for (std::size_t i = 0; i < n; ++i)
    {
      local[i * Dim + d] = x[i];
    }
    numCells *= knots[d].NumElements();
  }
  for (std::size_t i = 0; i < n; ++i)
  {
    cells[i] = inside[i] ? cells[i] : -1;
  }
}
}

template <int Dim>
void LocateInTree(const SplineSpace<Dim>& space, const double* u, std::ptrdiff_t stride,
  std::size_t n, int* elements, double* local)
{
  for (std::size_t begin = 0; begin < n; begin += LocateBlockSize)
  {
    const std::size_t count = std::min(LocateBlockSize, n - begin);
    double* t = local + begin * Dim;
    LocateRootCells<Dim>(space.Knots, u + static_cast<std::ptrdiff_t>(begin) * stride, stride,
      count, elements + begin, t);
    for (std::size_t i = begin; i < begin + count; ++i, t += Dim)
    {
      if (elements[i] < 0)
      {
        continue;
      }
      int node = space.RootCells[static_cast<std::size_t>(elements[i])];
      while (node < 0)
      {
        std::size_t child = 0;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          // doubling and subtracting one are exact, so no error builds up over the levels
          const bool upper = t[d] >= 0.5;
          t[d] = 2.0 * t[d] - (upper ? 1.0 : 0.0);
          child |= static_cast<std::size_t>(upper) << d;
        }
        node = space.Tree[(static_cast<std::size_t>(-1 - node) << Dim) + child];
      }
      elements[i] = node;
    }
  }
}

template <int Dim>
std::vector<ChartCell<Dim>> ChartsOfTree(const SplineSpace<Dim>& space, int& numCharts)
{
  std::vector<ChartCell<Dim>> cells(space.Elements.size());
  for (std::size_t e = 0; e < cells.size(); ++e)
  {
    ChartCell<Dim>& cell = cells[e];
    const auto& element = space.Elements[e];
    cell.Chart = numCharts;
    cell.Level = element.Level;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const KnotVector& knots = space.Knots[d];
      const int root = knots.FindElement(0.5 * (element.Box.Lower[d] + element.Box.Upper[d]));
      const double begin = knots.Breaks()[static_cast<std::size_t>(root)];
      const double end = knots.Breaks()[static_cast<std::size_t>(root) + 1];
      const auto index = static_cast<std::int64_t>(
        std::llround(std::ldexp((element.Box.Lower[d] - begin) / (end - begin), element.Level)));
      cell.Size[d] = std::int64_t{ 1 } << (ChartBits - element.Level);
      cell.Lower[d] = (std::int64_t{ root } << ChartBits) + index * cell.Size[d];
      cell.RimLow[d] = cell.Lower[d] == 0;
      cell.RimHigh[d] =
        cell.Lower[d] + cell.Size[d] == std::int64_t{ knots.NumElements() } << ChartBits;
    }
  }
  ++numCharts;
  return cells;
}

template <int Dim>
std::vector<FunctionInfo<Dim>> FunctionsOfLevels(const SplineSpace<Dim>& space)
{
  std::vector<FunctionInfo<Dim>> infos;
  infos.reserve(static_cast<std::size_t>(space.NumFunctions));
  const std::vector<DyadicKnots> knots = MakeDyadicKnots<Dim>(space.Knots);
  std::array<IndexMemo<double>, Dim> memo;
  const auto describe = [&](int level, const LevelIndex<Dim>& index)
  {
    FunctionInfo<Dim> info;
    info.Level = level;
    info.Index = index;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      info.Greville[d] =
        memo[d].Get(index[d], [&](std::int64_t i) { return knots[d].Greville(level, i); });
    }
    infos.push_back(info);
  };
  if (!space.Levels) // one level, all functions active
  {
    IntArray<Dim> shape;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      shape[d] = space.Knots[d].NumFunctions();
    }
    ForEachOffset<Dim>(shape,
      [&](const IntArray<Dim>& offset)
      {
        LevelIndex<Dim> index;
        std::copy(offset.begin(), offset.end(), index.begin());
        describe(0, index);
      });
    return infos;
  }
  for (std::size_t l = 0; l < space.Levels->Levels.size(); ++l)
  {
    memo = {};
    const HierarchyLevel<Dim>& level = space.Levels->Levels[l];
    for (std::size_t i = 0; i < level.Ids.size(); ++i)
    {
      if (level.Ids[i] >= 0)
      {
        describe(static_cast<int>(l), level.Functions.Index(i));
      }
    }
  }
  return infos;
}

template <int Dim>
std::vector<NetEdge> EdgesOfLevels(const SplineSpace<Dim>& space)
{
  using Key = std::array<std::int64_t, Dim + 1>; // level, index
  const auto infos = FunctionsOfLevels(space);
  const auto keyOf = [](const FunctionInfo<Dim>& info)
  {
    Key key;
    key[0] = info.Level;
    std::copy(info.Index.begin(), info.Index.end(), key.begin() + 1);
    return key;
  };
  std::map<Key, int> ids;
  for (std::size_t i = 0; i < infos.size(); ++i)
  {
    ids.emplace(keyOf(infos[i]), static_cast<int>(i));
  }
  std::vector<NetEdge> edges;
  for (std::size_t i = 0; i < infos.size(); ++i)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      Key key = keyOf(infos[i]);
      ++key[d + 1];
      const auto neighbour = ids.find(key);
      if (neighbour != ids.end())
      {
        edges.push_back({ static_cast<int>(i), neighbour->second, static_cast<int>(d) });
      }
    }
  }
  return edges;
}

template <int Dim>
SpaceDefinition DefinitionOfKnots(const SplineSpace<Dim>& space)
{
  SpaceDefinition definition;
  definition.Kind = space.Kind;
  definition.Dimension = Dim;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    definition.Degree[d] = space.Knots[d].Degree();
    definition.Knots[d] = space.Knots[d].Knots();
  }
  return definition;
}

template <int Dim>
Result<std::array<KnotVector, Dim>> KnotsOfDefinition(const SpaceDefinition& definition)
{
  std::array<KnotVector, Dim> knots;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    Result<KnotVector> made = KnotVector::Create(definition.Degree[d], definition.Knots[d]);
    if (!made)
    {
      return made.Status;
    }
    knots[d] = std::move(made.Value);
  }
  return knots;
}

template <int Dim>
Result<RefinedSpline<Dim>> RefineByLevels(
  const Spline<Dim>& spline, const std::vector<int>& marked, const RefinementParams& params)
{
  RefinedSpline<Dim> result;
  auto space = RefineElements<Dim>(spline.Space, marked, params);
  if (!space)
  {
    return space.Status;
  }
  auto transferred = TransferToRefined<Dim>(spline, space.Value);
  if (!transferred)
  {
    return transferred.Status;
  }
  result.Value = std::move(transferred.Value);
  result.Parents = ParentElements(*spline.Space, *result.Value.Space, 1);
  return result;
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template void LocateInTree<Dim>(                                                                 \
    const SplineSpace<Dim>&, const double*, std::ptrdiff_t, std::size_t, int*, double*);           \
  template std::vector<ChartCell<Dim>> ChartsOfTree<Dim>(const SplineSpace<Dim>&, int&);           \
  template std::vector<FunctionInfo<Dim>> FunctionsOfLevels<Dim>(const SplineSpace<Dim>&);         \
  template std::vector<NetEdge> EdgesOfLevels<Dim>(const SplineSpace<Dim>&);                       \
  template Result<RefinedSpline<Dim>> RefineByLevels<Dim>(                                         \
    const Spline<Dim>&, const std::vector<int>&, const RefinementParams&);                         \
  template SpaceDefinition DefinitionOfKnots<Dim>(const SplineSpace<Dim>&);                        \
  template Result<std::array<KnotVector, Dim>> KnotsOfDefinition<Dim>(const SpaceDefinition&);
KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
