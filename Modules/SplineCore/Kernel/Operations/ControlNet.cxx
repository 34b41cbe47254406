// SPDX-License-Identifier: BSD-3-Clause
#include "ControlNet.h"

#include "HierarchicalSpace.h"
#include "LRSpace.h"

#include <algorithm>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
template <int Dim>
std::vector<NetEdge> BezierEdges(const SplineSpace<Dim>& space)
{
  std::vector<NetEdge> edges;
  std::set<std::array<int, 2>> seen;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const IntArray<Dim>& p = space.Elements[static_cast<std::size_t>(e)].Degree;
    const int* ids = space.LocalFunctions(e);
    for (int i = 0; i < NumTensorFunctions<Dim>(p); ++i)
    {
      int rest = i;
      int stride = 1;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        if (rest % (p[d] + 1) < p[d])
        {
          const int a = ids[i];
          const int b = ids[i + stride];
          if (seen.insert({ std::min(a, b), std::max(a, b) }).second)
          {
            edges.push_back({ a, b, static_cast<int>(d) });
          }
        }
        rest /= p[d] + 1;
        stride *= p[d] + 1;
      }
    }
  }
  return edges;
}
}

namespace
{
std::vector<NetEdge> LREdges(const LRBasis& basis)
{
  // the knots that two neighbours have in common: all but the first, all but the last
  const auto shared = [&basis](int f, int direction, int skip)
  {
    std::vector<int> key{ direction };
    for (int d = 0; d < 2; ++d)
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
    ids.emplace(shared(f, 0, 0), f);
    ids.emplace(shared(f, 1, 0), f);
  }
  std::vector<NetEdge> edges;
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    for (int d = 0; d < 2; ++d)
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
}

template <int Dim>
std::vector<NetEdge> ControlNetEdges(const SplineSpace<Dim>& space)
{
  if (space.Kind == SpaceKind::LocallyRefined)
  {
    return LREdges(space.LocallyRefined->Basis);
  }
  if (space.Kind == SpaceKind::Bezier)
  {
    return BezierEdges(space);
  }
  using Key = std::array<std::int64_t, Dim + 1>; // level, index
  const auto infos = DescribeFunctions(space);
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

template std::vector<NetEdge> ControlNetEdges<1>(const SplineSpace<1>&);
template std::vector<NetEdge> ControlNetEdges<2>(const SplineSpace<2>&);
template std::vector<NetEdge> ControlNetEdges<3>(const SplineSpace<3>&);
}
