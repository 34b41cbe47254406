// SPDX-License-Identifier: BSD-3-Clause
#include "BoxTree.h"

#include <cassert>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr int LeafSize = 6; // items a leaf aims at; measured flat between 4 and 12
}

BoxTree::BoxTree(const PointMatrixView& lower, const PointMatrixView& upper)
  : D(static_cast<int>(lower.cols())), Stride(static_cast<std::size_t>(lower.cols()))
{
  assert(this->D <= MaxDimension && lower.rows() == upper.rows() && lower.cols() == upper.cols());
  const int n = static_cast<int>(lower.rows());
  this->Order.resize(static_cast<std::size_t>(n));
  std::iota(this->Order.begin(), this->Order.end(), 0);
  int leaves = 1;
  while (static_cast<long long>(leaves) * LeafSize < n)
  {
    leaves *= 2;
  }
  this->FirstLeaf = leaves - 1;
  this->LeafStart.resize(static_cast<std::size_t>(leaves) + 1);
  for (int leaf = 0; leaf <= leaves; ++leaf)
  {
    this->LeafStart[static_cast<std::size_t>(leaf)] =
      static_cast<int>(static_cast<long long>(n) * leaf / leaves);
  }

  const PointMatrix centre = lower + upper;
  // Halves the leaves' range at the median of the widest direction, down to single leaves.
  const auto split = [&](const auto& self, int first, int last) -> void
  {
    if (last - first <= 1)
    {
      return;
    }
    const int middle = (first + last) / 2;
    const auto at = [&](int leaf)
    { return this->Order.begin() + this->LeafStart[static_cast<std::size_t>(leaf)]; };
    int direction = 0;
    double widest = -1.0;
    for (int d = 0; d < this->D; ++d)
    {
      const auto [low, high] = std::minmax_element(
        at(first), at(last), [&](int a, int b) { return centre(a, d) < centre(b, d); });
      const double width = low == at(last) ? 0.0 : centre(*high, d) - centre(*low, d);
      if (width > widest)
      {
        widest = width;
        direction = d;
      }
    }
    std::nth_element(at(first), at(middle), at(last),
      [&](int a, int b)
      {
        return centre(a, direction) != centre(b, direction)
          ? centre(a, direction) < centre(b, direction)
          : a < b;
      });
    self(self, first, middle);
    self(self, middle, last);
  };
  split(split, 0, leaves);
  this->Refit(lower, upper);
}

void BoxTree::Refit(const PointMatrixView& lower, const PointMatrixView& upper)
{
  assert(lower.rows() == this->NumItems() && upper.rows() == this->NumItems());
  assert(lower.cols() == this->D && upper.cols() == this->D);
  const int leaves = this->FirstLeaf + 1;
  const std::size_t nodes = static_cast<std::size_t>(this->FirstLeaf + leaves);
  this->Boxes.resize(nodes * 2 * this->Stride);
  const auto box = [&](int node)
  { return this->Boxes.data() + static_cast<std::size_t>(node) * 2 * this->Stride; };
  for (int leaf = 0; leaf < leaves; ++leaf)
  {
    double* b = box(this->FirstLeaf + leaf);
    std::fill(b, b + this->D, std::numeric_limits<double>::infinity());
    std::fill(b + this->D, b + 2 * this->D, -std::numeric_limits<double>::infinity());
    for (int i = this->LeafStart[static_cast<std::size_t>(leaf)];
         i < this->LeafStart[static_cast<std::size_t>(leaf) + 1]; ++i)
    {
      const int item = this->Order[static_cast<std::size_t>(i)];
      for (int d = 0; d < this->D; ++d)
      {
        b[d] = std::min(b[d], lower(item, d));
        b[this->D + d] = std::max(b[this->D + d], upper(item, d));
      }
    }
  }
  for (int node = this->FirstLeaf - 1; node >= 0; --node)
  {
    double* b = box(node);
    const double* left = box(2 * node + 1);
    const double* right = box(2 * node + 2);
    for (int d = 0; d < this->D; ++d)
    {
      b[d] = std::min(left[d], right[d]);
      b[this->D + d] = std::max(left[this->D + d], right[this->D + d]);
    }
  }
}
}
