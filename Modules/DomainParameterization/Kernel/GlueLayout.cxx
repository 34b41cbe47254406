// SPDX-License-Identifier: BSD-3-Clause
#include "PatchLayout.h"

#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <limits>
#include <map>

namespace knotwork
{
template <int Dim>
Result<GluedMap<Dim>> Glue(
  const MultiPatch<Dim>& layout, const std::vector<std::array<int, 1 << Dim>>& corners)
{
  const std::vector<Spline<Dim>>& patches = layout.Patches;
  std::vector<std::int64_t> first{ 0 };
  for (const Spline<Dim>& patch : patches)
  {
    first.push_back(first.back() + patch.Space->NumFunctions);
  }
  if (first.back() > std::numeric_limits<int>::max())
  {
    return { ErrorCode::TooLarge, "the layout has more than 2^31 - 1 control points" };
  }
  DisjointSets same(static_cast<int>(first.back()));
  for (const PatchInterface& shared : layout.Topology.Interfaces)
  {
    std::array<std::size_t, 2> patch{};
    std::array<std::vector<int>, 2> along;
    for (std::size_t i = 0; i < 2; ++i)
    {
      patch[i] = static_cast<std::size_t>(shared.Sides[i].Patch);
      along[i] = SideFunctions<Dim>(*patches[patch[i]].Space, shared.Sides[i].Side);
    }
    std::array<std::int64_t, 2> count{ 1, 1 };
    std::size_t k = 0;
    for (const std::size_t d : SideDirections<Dim>(shared.Sides[1].Side))
    {
      count[k++] = patches[patch[1]].Space->Knots[d].NumFunctions();
    }
    const std::int64_t width = shared.Orientation.OtherCount(count)[0];
    for (std::size_t j = 0; j < along[1].size(); ++j)
    {
      const std::int64_t own = static_cast<std::int64_t>(j);
      const auto at = shared.Orientation.OtherPoint({ own % count[0], own / count[0] }, count);
      const auto other = static_cast<std::size_t>(at[0] + width * at[1]);
      same.Unite(static_cast<int>(first[patch[0]]) + along[0][other],
        static_cast<int>(first[patch[1]]) + along[1][j]);
    }
  }
  GluedMap<Dim> map;
  map.Patches = patches;
  std::vector<int> numbers(static_cast<std::size_t>(first.back()), -1);
  std::vector<std::size_t> source; // where a number comes from
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    map.Functions.emplace_back();
    for (Eigen::Index row = 0; row < patches[p].Space->NumFunctions; ++row)
    {
      const int i = static_cast<int>(first[p] + row);
      const int root = same.Find(i);
      const std::size_t at = static_cast<std::size_t>(root);
      if (root == i)
      {
        numbers[at] = static_cast<int>(source.size());
        source.push_back(p);
      }
      map.Functions.back().push_back(numbers[at]);
      const std::size_t from = source[static_cast<std::size_t>(numbers[at])];
      const Eigen::Index fromRow = root - first[from];
      map.Patches[p].ControlPoints.row(row) = patches[from].ControlPoints.row(fromRow);
      if (map.Patches[p].IsRational())
      {
        map.Patches[p].Weights[row] = patches[from].Weights[fromRow];
      }
    }
  }
  map.Fixed.assign(source.size(), false);
  // a vertex, and in space an edge, is the same function in all patches that have it
  std::map<std::array<int, 2>, std::array<int, 2>> seen; // vertices; number, patch
  const auto meet = [&](std::array<int, 2> key, int number, std::size_t p) -> Status
  {
    const auto at = seen.emplace(key, std::array<int, 2>{ number, static_cast<int>(p) }).first;
    if (at->second[0] == number)
    {
      return {};
    }
    return { ErrorCode::InvalidTopology,
      "patches " + std::to_string(at->second[1]) + " and " + std::to_string(p) + " meet at " +
        (key[0] == key[1] ? "the vertex " + std::to_string(key[0])
                          : "the edge between the vertices " + std::to_string(key[0]) + " and " +
              std::to_string(key[1])) +
        ", but no patches with common sides join them there" };
  };
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const SplineSpace<Dim>& space = *patches[p].Space;
    for (int c = 0; c < (1 << Dim); ++c)
    {
      const int vertex = corners[p][static_cast<std::size_t>(c)];
      const int corner = CornerFunction<Dim>(space, c);
      const auto number = [&](int f) { return map.Functions[p][static_cast<std::size_t>(f)]; };
      if (const Status status = meet({ vertex, vertex }, number(corner), p); !status)
      {
        return status;
      }
      int stride = 1;
      for (int d = 0; d < Dim; ++d)
      {
        const int n = space.Knots[static_cast<std::size_t>(d)].NumFunctions();
        const int end = corners[p][static_cast<std::size_t>(c ^ (1 << d))];
        if (Dim == 3 && n > 2 && vertex < end)
        {
          // the first inner one seen from the lower vertex
          const int inner = corner + ((c >> d & 1) ? -stride : stride);
          if (const Status status = meet({ vertex, end }, number(inner), p); !status)
          {
            return status;
          }
        }
        stride *= n;
      }
    }
  }
  return map;
}

template Result<GluedMap<2>> Glue<2>(const MultiPatch<2>&, const std::vector<std::array<int, 4>>&);
template Result<GluedMap<3>> Glue<3>(const MultiPatch<3>&, const std::vector<std::array<int, 8>>&);
}
