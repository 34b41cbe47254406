// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FunctionMap.h"
#include "SplineSpace.h"

namespace knotwork
{
/// The refinement of a hierarchical mesh while it changes: a 2^Dim tree over the level-0 cells.
/// Cells are only ever split, never merged.
template <int Dim>
class RefinementTree
{
public:
  static constexpr int NumChildren = 1 << Dim;

  /// Nothing refined.
  explicit RefinementTree(const std::array<KnotVector, Dim>& knots);
  /// The tree of a Tensor or Hierarchical space.
  explicit RefinementTree(const SplineSpace<Dim>& space);

  const LevelIndex<Dim>& Shape() const { return this->RootShape; }
  /// Number of leaves.
  std::size_t NumElements() const
  {
    return this->Roots.size() + this->Nodes.size() / NumChildren * (NumChildren - 1);
  }
  bool IsChanged() const { return this->Changed; }

  /// Refines all cells that meet the cells [lower, upper) of a level until that level is reached.
  /// @pre the box lies in the level's grid.
  /// @return false when there would be more than 2^31 - 1 cells; the tree is then incomplete.
  bool RefineBox(int level, const LevelIndex<Dim>& lower, const LevelIndex<Dim>& upper);

  /// Calls visit(level, cell, isRefined) for every cell, parents first, depth first over the
  /// level-0 cells, children in the order of SplineSpace::Tree.
  template <class Visit>
  void ForEachCell(Visit&& visit) const
  {
    LevelIndex<Dim> cell{};
    for (int node : this->Roots)
    {
      this->VisitCell(0, cell, node, visit);
      for (std::size_t d = 0; d < Dim && ++cell[d] == this->RootShape[d]; ++d)
      {
        cell[d] = 0;
      }
    }
  }

  /// Every refined cell of other is refined here. @pre same level-0 cells.
  bool Contains(const RefinementTree& other) const;

private:
  template <class Visit>
  void VisitCell(int level, const LevelIndex<Dim>& cell, int node, Visit& visit) const
  {
    visit(level, cell, node < 0);
    if (node >= 0)
    {
      return;
    }
    const std::size_t block = static_cast<std::size_t>(-1 - node) * NumChildren;
    for (int child = 0; child < NumChildren; ++child)
    {
      LevelIndex<Dim> index;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        index[d] = 2 * cell[d] + (child >> d & 1);
      }
      this->VisitCell(
        level + 1, index, this->Nodes[block + static_cast<std::size_t>(child)], visit);
    }
  }
  bool RefineNode(bool isRoot, std::size_t position, int level, const LevelIndex<Dim>& cell,
    int target, const LevelIndex<Dim>& lower, const LevelIndex<Dim>& upper);
  bool ContainsNode(int node, const RefinementTree& other, int otherNode) const;

  LevelIndex<Dim> RootShape{};
  std::vector<int> Roots; // 0: leaf, -1 - block: refined
  std::vector<int> Nodes; // blocks of 2^Dim
  bool Changed = false;
};
}
