// SPDX-License-Identifier: BSD-3-Clause
#include "RefinementTree.h"

#include <algorithm>
#include <limits>

namespace knotwork
{
template <int Dim>
RefinementTree<Dim>::RefinementTree(const std::array<KnotVector, Dim>& knots)
{
  std::size_t cells = 1;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    this->RootShape[d] = knots[d].NumElements();
    cells *= static_cast<std::size_t>(knots[d].NumElements());
  }
  this->Roots.assign(cells, 0);
}

template <int Dim>
RefinementTree<Dim>::RefinementTree(const SplineSpace<Dim>& space) : RefinementTree(space.Knots)
{
  const auto link = [](int node) { return std::min(node, 0); };
  std::transform(space.RootCells.begin(), space.RootCells.end(), this->Roots.begin(), link);
  this->Nodes.resize(space.Tree.size());
  std::transform(space.Tree.begin(), space.Tree.end(), this->Nodes.begin(), link);
}

template <int Dim>
bool RefinementTree<Dim>::RefineNode(bool isRoot, std::size_t position, int level,
  const LevelIndex<Dim>& cell, int target, const LevelIndex<Dim>& lower,
  const LevelIndex<Dim>& upper)
{
  int node = isRoot ? this->Roots[position] : this->Nodes[position];
  if (node >= 0)
  {
    if (this->Nodes.size() > std::numeric_limits<int>::max() - NumChildren)
    {
      return false;
    }
    node = -1 - static_cast<int>(this->Nodes.size() / NumChildren);
    (isRoot ? this->Roots : this->Nodes)[position] = node;
    this->Nodes.resize(this->Nodes.size() + NumChildren, 0);
    this->Changed = true;
  }
  if (level + 1 == target)
  {
    return true;
  }
  const int shift = target - level - 1; // a child covers 2^shift cells of the target level
  const std::size_t block = static_cast<std::size_t>(-1 - node) * NumChildren;
  for (int child = 0; child < NumChildren; ++child)
  {
    LevelIndex<Dim> index;
    bool meets = true;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      index[d] = 2 * cell[d] + (child >> d & 1);
      meets = meets && index[d] << shift < upper[d] && (index[d] + 1) << shift > lower[d];
    }
    if (meets &&
      !this->RefineNode(
        false, block + static_cast<std::size_t>(child), level + 1, index, target, lower, upper))
    {
      return false;
    }
  }
  return true;
}

template <int Dim>
bool RefinementTree<Dim>::RefineBox(
  int level, const LevelIndex<Dim>& lower, const LevelIndex<Dim>& upper)
{
  double volume = 1.0;
  LevelIndex<Dim> first;
  IntArray<Dim> shape;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    if (lower[d] >= upper[d])
    {
      return true;
    }
    volume *= static_cast<double>(upper[d] - lower[d]);
    first[d] = lower[d] >> level;
    shape[d] = static_cast<int>((upper[d] - 1) >> level) - static_cast<int>(first[d]) + 1;
  }
  if (volume > std::numeric_limits<int>::max())
  {
    return false;
  }
  bool fits = true;
  ForEachOffset<Dim>(shape,
    [&](const IntArray<Dim>& offset)
    {
      LevelIndex<Dim> cell;
      std::size_t position = 0;
      for (std::size_t d = Dim; d-- > 0;)
      {
        cell[d] = first[d] + offset[d];
        position = position * static_cast<std::size_t>(this->RootShape[d]) +
          static_cast<std::size_t>(cell[d]);
      }
      fits = fits && this->RefineNode(true, position, 0, cell, level, lower, upper);
    });
  return fits;
}

template <int Dim>
bool RefinementTree<Dim>::ContainsNode(int node, const RefinementTree& other, int otherNode) const
{
  if (otherNode >= 0 || node >= 0)
  {
    return otherNode >= 0;
  }
  const std::size_t block = static_cast<std::size_t>(-1 - node) * NumChildren;
  const std::size_t otherBlock = static_cast<std::size_t>(-1 - otherNode) * NumChildren;
  for (std::size_t child = 0; child < NumChildren; ++child)
  {
    if (!this->ContainsNode(this->Nodes[block + child], other, other.Nodes[otherBlock + child]))
    {
      return false;
    }
  }
  return true;
}

template <int Dim>
bool RefinementTree<Dim>::Contains(const RefinementTree& other) const
{
  for (std::size_t i = 0; i < this->Roots.size(); ++i)
  {
    if (!this->ContainsNode(this->Roots[i], other, other.Roots[i]))
    {
      return false;
    }
  }
  return true;
}

template class RefinementTree<1>;
template class RefinementTree<2>;
template class RefinementTree<3>;
}
