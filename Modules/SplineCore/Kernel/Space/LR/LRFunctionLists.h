// SPDX-License-Identifier: BSD-3-Clause
// What lists of functions by local knots say about themselves, for any number of parameters.
#pragma once
#include "ControlNet.h"
#include "FunctionInfo.h"

#include <array>
#include <map>
#include <vector>

namespace knotwork
{
/// Functions that differ by one knot step along a direction are neighbours in the control net.
/// @tparam Basis  LRBasis or LRVolumeBasis.
template <int Dim, typename Basis>
std::vector<NetEdge> LREdges(const Basis& basis)
{
  // the knots that two neighbours have in common: all but the first, all but the last
  const auto shared = [&basis](int f, int direction, int skip)
  {
    std::vector<int> key{ direction };
    for (int d = 0; d < Dim; ++d)
    {
      const int* local = basis.Local(f, d);
      const int n = basis.Degree[static_cast<std::size_t>(d)] + 2;
      key.insert(key.end(), local + (d == direction ? skip : 0),
        local + n - (d == direction ? 1 - skip : 0));
    }
    return key;
  };
  std::map<std::vector<int>, int> ids;
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    for (int d = 0; d < Dim; ++d)
    {
      ids.emplace(shared(f, d, 0), f);
    }
  }
  std::vector<NetEdge> edges;
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    for (int d = 0; d < Dim; ++d)
    {
      const auto neighbour = ids.find(shared(f, d, 1));
      if (neighbour != ids.end())
      {
        edges.push_back({ f, neighbour->second, d });
      }
    }
  }
  return edges;
}

template <int Dim, typename Basis>
std::vector<FunctionInfo<Dim>> DescribeLRFunctions(const Basis& basis)
{
  std::vector<FunctionInfo<Dim>> infos(static_cast<std::size_t>(basis.NumFunctions()));
  for (std::size_t f = 0; f < infos.size(); ++f)
  {
    infos[f].Index[0] = static_cast<std::int64_t>(f);
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const int* local = basis.Local(static_cast<int>(f), static_cast<int>(d));
      for (int i = 1; i <= basis.Degree[d]; ++i)
      {
        infos[f].Greville[d] +=
          basis.Knots[d][static_cast<std::size_t>(local[i])] / basis.Degree[d];
      }
    }
  }
  return infos;
}
}
