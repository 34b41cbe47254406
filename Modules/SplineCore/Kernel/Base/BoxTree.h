// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <vector>

namespace knotwork
{
/// Nearest item of a query, or Item = -1 when none lies within the bound.
struct NearestItem
{
  int Item = -1;
  double SquaredDistance = std::numeric_limits<double>::infinity();
};

/// Tree of axis-aligned boxes over n items (points, segments, elements, ...) for nearest-item
/// queries. The order is made once; items that move afterwards only need Refit(), which costs one
/// pass: what iterations that ask for closest points again and again live on (a k-d tree has to be
/// built anew). Queries are read-only and may run in parallel.
class BoxTree
{
public:
  static constexpr int MaxDimension = 4;

  BoxTree() = default;
  /// @param lower, upper  n x d with d in [1, 4], finite, lower <= upper; n = 0 is an empty tree.
  /// @complexity O(n log n).
  BoxTree(const PointMatrixView& lower, const PointMatrixView& upper);

  /// New boxes for the same n items. Correct for any move; fast while neighbours stay near each
  /// other.
  /// @complexity O(n).
  void Refit(const PointMatrixView& lower, const PointMatrixView& upper);

  int NumItems() const { return static_cast<int>(this->Order.size()); }
  int Dimension() const { return this->D; }

  /// The item with the smallest squared distance, of equal ones the lowest item: the answer does
  /// not depend on the shape of the tree.
  /// @param point            Dimension() values.
  /// @param squaredDistance  called as squaredDistance(item) -> double, not below the squared
  ///                         distance of point to the item's box.
  /// @param bound            only items with squared distance <= bound are found.
  template <typename SquaredDistance>
  NearestItem Nearest(const double* point, SquaredDistance&& squaredDistance,
    double bound = std::numeric_limits<double>::infinity()) const
  {
    NearestItem best;
    if (this->Order.empty())
    {
      return best;
    }
    best.SquaredDistance = bound;
    struct Entry
    {
      int Node;
      double Distance;
    };
    Entry stack[64]; // the tree is complete: one entry a level waits
    int top = 0;
    stack[top++] = { 0, this->BoxDistance(0, point) };
    while (top > 0)
    {
      const Entry entry = stack[--top];
      if (entry.Distance > best.SquaredDistance)
      {
        continue;
      }
      if (entry.Node >= this->FirstLeaf)
      {
        const std::size_t leaf = static_cast<std::size_t>(entry.Node - this->FirstLeaf);
        for (int i = this->LeafStart[leaf]; i < this->LeafStart[leaf + 1]; ++i)
        {
          const int item = this->Order[static_cast<std::size_t>(i)];
          const double distance = squaredDistance(item);
          if (distance < best.SquaredDistance ||
            (distance == best.SquaredDistance && (best.Item < 0 || item < best.Item)))
          {
            best = { item, distance };
          }
        }
        continue;
      }
      const int child = 2 * entry.Node + 1;
      Entry near{ child, this->BoxDistance(child, point) };
      Entry far{ child + 1, this->BoxDistance(child + 1, point) };
      if (far.Distance < near.Distance)
      {
        std::swap(near, far);
      }
      stack[top++] = far;
      stack[top++] = near;
    }
    if (best.Item < 0)
    {
      best.SquaredDistance = std::numeric_limits<double>::infinity();
    }
    return best;
  }

  /// Calls use(item) for the items of all leaves whose boxes meet [lower, upper]: all items whose
  /// own boxes do, and their neighbours in the tree. The order is fixed.
  /// @param use  may return whether to go on.
  template <typename Use>
  void ForNear(const double* lower, const double* upper, Use&& use) const
  {
    if (this->Order.empty())
    {
      return;
    }
    int stack[64];
    int top = 0;
    stack[top++] = 0;
    while (top > 0)
    {
      const int node = stack[--top];
      const double* box = this->Boxes.data() + static_cast<std::size_t>(node) * 2 * this->Stride;
      bool meets = true;
      for (int d = 0; d < this->D; ++d)
      {
        meets = meets && box[d] <= upper[d] && lower[d] <= box[this->D + d];
      }
      if (!meets)
      {
        continue;
      }
      if (node < this->FirstLeaf)
      {
        stack[top++] = 2 * node + 2;
        stack[top++] = 2 * node + 1;
        continue;
      }
      const std::size_t leaf = static_cast<std::size_t>(node - this->FirstLeaf);
      for (int i = this->LeafStart[leaf]; i < this->LeafStart[leaf + 1]; ++i)
      {
        const int item = this->Order[static_cast<std::size_t>(i)];
        if constexpr (std::is_same_v<std::invoke_result_t<Use, int>, bool>)
        {
          if (!use(item))
          {
            return;
          }
        }
        else
        {
          use(item);
        }
      }
    }
  }

private:
  double BoxDistance(int node, const double* point) const
  {
    const double* box = this->Boxes.data() + static_cast<std::size_t>(node) * 2 * this->Stride;
    double sum = 0.0;
    for (int d = 0; d < this->D; ++d)
    {
      const double gap = std::max({ box[d] - point[d], point[d] - box[this->D + d], 0.0 });
      sum += gap * gap;
    }
    return sum;
  }

  int D = 0;
  std::size_t Stride = 0;     // D as std::size_t
  int FirstLeaf = 0;          // nodes in heap order: children of k are 2k + 1 and 2k + 2
  std::vector<int> Order;     // items, leaf by leaf
  std::vector<int> LeafStart; // offsets into Order
  std::vector<double> Boxes;  // per node: D lower, D upper bounds
};
}
