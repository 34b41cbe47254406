// SPDX-License-Identifier: BSD-3-Clause
#include "TessellationParts.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}
}

template <int Dim>
std::vector<std::vector<ChartCell<Dim>>> MakeCharts(
  const std::vector<TessellationPatch<Dim>>& patches, int& numCharts)
{
  std::vector<std::vector<ChartCell<Dim>>> cells(patches.size());
  numCharts = 0;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const SplineSpace<Dim>& space = *patches[p].Geometry.Space;
    cells[p].resize(space.Elements.size());
    for (std::size_t e = 0; e < space.Elements.size(); ++e)
    {
      ChartCell<Dim>& cell = cells[p][e];
      const auto& element = space.Elements[e];
      cell.Chart = numCharts;
      if (!space.HasDomain)
      {
        ++numCharts;
        cell.Size.fill(std::int64_t{ 1 } << ChartBits);
        cell.RimLow.fill(true);
        cell.RimHigh.fill(true);
        continue;
      }
      cell.Level = element.Level;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        const KnotVector& knots = space.Knots[d];
        const int root = knots.FindElement(0.5 * (element.Box.Lower[d] + element.Box.Upper[d]));
        const double begin = knots.Breaks()[At(root)];
        const double end = knots.Breaks()[At(root + 1)];
        const auto index = static_cast<std::int64_t>(
          std::llround(std::ldexp((element.Box.Lower[d] - begin) / (end - begin), element.Level)));
        cell.Size[d] = std::int64_t{ 1 } << (ChartBits - element.Level);
        cell.Lower[d] = (std::int64_t{ root } << ChartBits) + index * cell.Size[d];
        cell.RimLow[d] = cell.Lower[d] == 0;
        cell.RimHigh[d] =
          cell.Lower[d] + cell.Size[d] == std::int64_t{ knots.NumElements() } << ChartBits;
      }
    }
    numCharts += space.HasDomain ? 1 : 0;
  }
  return cells;
}

int DisjointSets::Add()
{
  this->Parent.push_back(static_cast<int>(this->Parent.size()));
  return this->Parent.back();
}

int DisjointSets::Find(int a) const
{
  while (this->Parent[At(a)] != a)
  {
    this->Parent[At(a)] = this->Parent[At(this->Parent[At(a)])];
    a = this->Parent[At(a)];
  }
  return a;
}

void DisjointSets::Unite(int a, int b)
{
  a = this->Find(a);
  b = this->Find(b);
  this->Parent[At(std::max(a, b))] = std::min(a, b);
}

std::size_t VertexTable::Hash::operator()(const ChartPoint& p) const
{
  std::uint64_t h = static_cast<std::uint64_t>(p.Chart);
  for (const std::int64_t x : p.X)
  {
    h = (h ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
  }
  return static_cast<std::size_t>(h);
}

int VertexTable::At(const ChartPoint& point)
{
  const auto found = this->Map.find(point);
  if (found != this->Map.end())
  {
    return found->second;
  }
  const int vertex = this->Sets.Add();
  this->Map.emplace(point, vertex);
  return vertex;
}

std::array<std::int64_t, 2> GridSymmetry::Original(
  const std::array<std::int64_t, 2>& canonical, const std::array<std::int64_t, 2>& count) const
{
  std::array<std::int64_t, 2> a = canonical;
  if (this->Swap)
  {
    std::swap(a[0], a[1]);
  }
  for (std::size_t d = 0; d < 2; ++d)
  {
    if (this->Reverse[d])
    {
      a[d] = count[d] - 1 - a[d];
    }
  }
  return a;
}

SideKey MakeSideKey(
  char kind, const std::array<std::int64_t, 2>& count, int width, const std::vector<double>& words)
{
  SideKey best;
  const int symmetries = count[1] == 1 ? 2 : 8;
  for (int s = 0; s < symmetries; ++s)
  {
    GridSymmetry symmetry;
    symmetry.Reverse = { (s & 1) != 0, (s & 2) != 0 };
    symmetry.Swap = (s & 4) != 0;
    const std::array<std::int64_t, 2> size = symmetry.Count(count);
    std::vector<double> ordered{ static_cast<double>(size[0]), static_cast<double>(size[1]) };
    ordered.reserve(words.size() + 2);
    for (std::int64_t j = 0; j < size[1]; ++j)
    {
      for (std::int64_t i = 0; i < size[0]; ++i)
      {
        const auto at = symmetry.Original({ i, j }, count);
        const double* from = words.data() + (at[0] + count[0] * at[1]) * width;
        ordered.insert(ordered.end(), from, from + width);
      }
    }
    std::string bytes(1, kind);
    bytes.append(reinterpret_cast<const char*>(ordered.data()), ordered.size() * sizeof(double));
    if (s == 0 || bytes < best.Bytes)
    {
      best = { std::move(bytes), symmetry };
    }
  }
  return best;
}

void SideMatcher::Add(int side, const std::array<std::int64_t, 2>& count, int planes,
  const std::vector<double>& points, const std::vector<std::int64_t>& ids)
{
  std::vector<double> words(points);
  for (double& x : words)
  {
    x += 0.0; // -0 and 0 are one
  }
  this->Insert(side, MakeSideKey('p', count, planes, words));
  if (!ids.empty())
  {
    words.resize(ids.size());
    std::memcpy(words.data(), ids.data(), ids.size() * sizeof(double));
    this->Insert(side, MakeSideKey('i', count, 1, words));
  }
}

void SideMatcher::Insert(int side, SideKey key)
{
  const auto [found, isNew] = this->Map.emplace(std::move(key.Bytes), First{ side, key.Symmetry });
  if (!isNew && found->second.Side != side)
  {
    this->Matches.push_back({ found->second.Side, side, found->second.Symmetry, key.Symmetry });
  }
}

void CellSoup::AddCell(TessellationShape shape, const int* corners, int n, int patch, int element)
{
  this->Shapes.push_back(shape);
  this->Corners.insert(this->Corners.end(), corners, corners + n);
  this->Offsets.push_back(static_cast<std::int64_t>(this->Corners.size()));
  this->CellPatch.push_back(patch);
  this->CellElement.push_back(element);
}

template <int Dim>
BlockSide<Dim> ExtractSide(const TessellationPatch<Dim>& patch, int element, int direction, int end)
{
  const BezierForm<Dim>& form = patch.Geometry;
  const IntArray<Dim>& degree = form.Space->Elements[At(element)].Degree;
  const int n = NumTensorFunctions<Dim>(degree);
  const int planes = form.NumPlanes();
  BlockSide<Dim> side;
  std::array<int, 3> stride{ 1, 1, 1 };
  int axis = 0;
  for (int d = 0, s = 1; d < Dim; ++d)
  {
    stride[At(d)] = s;
    s *= degree[At(d)] + 1;
    if (d != direction)
    {
      side.Axes[At(axis)] = d;
      side.Count[At(axis)] = degree[At(d)] + 1;
      ++axis;
    }
  }
  const int base = end == 0 ? 0 : stride[At(direction)] * degree[At(direction)];
  const std::size_t firstId = form.Offsets[At(element)] / At(planes);
  const double* block = form.Block(element);
  for (std::int64_t j = 0; j < side.Count[1]; ++j)
  {
    for (std::int64_t i = 0; i < side.Count[0]; ++i)
    {
      std::int64_t at = base;
      at += side.Axes[0] < 0 ? 0 : i * stride[At(side.Axes[0])];
      at += side.Axes[1] < 0 ? 0 : j * stride[At(side.Axes[1])];
      for (int c = 0; c < planes; ++c)
      {
        side.Points.push_back(block[c * n + at]);
      }
      if (!patch.PointIds.empty())
      {
        side.Ids.push_back(patch.PointIds[firstId + At(at)]);
      }
    }
  }
  return side;
}

template std::vector<std::vector<ChartCell<1>>> MakeCharts<1>(
  const std::vector<TessellationPatch<1>>&, int&);
template std::vector<std::vector<ChartCell<2>>> MakeCharts<2>(
  const std::vector<TessellationPatch<2>>&, int&);
template std::vector<std::vector<ChartCell<3>>> MakeCharts<3>(
  const std::vector<TessellationPatch<3>>&, int&);
template BlockSide<1> ExtractSide<1>(const TessellationPatch<1>&, int, int, int);
template BlockSide<2> ExtractSide<2>(const TessellationPatch<2>&, int, int, int);
template BlockSide<3> ExtractSide<3>(const TessellationPatch<3>&, int, int, int);
}
