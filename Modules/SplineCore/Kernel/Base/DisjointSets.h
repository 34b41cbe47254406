// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <numeric>
#include <vector>

namespace knotwork
{
/// Disjoint sets of the numbers 0 to Size() - 1; the representative is the smallest member,
/// whatever the order of the unions. Not for several threads at once: Find shortens paths.
/// @complexity O(log n) a call, amortized.
/// @source  Tarjan, van Leeuwen, J. ACM 31 (1984) 245-281 (path halving).
class DisjointSets
{
public:
  /// Every number a set of its own.
  explicit DisjointSets(int size = 0) : Parent(static_cast<std::size_t>(size))
  {
    std::iota(this->Parent.begin(), this->Parent.end(), 0);
  }
  /// @return the number of a new set.
  int Add()
  {
    this->Parent.push_back(this->Size());
    return this->Parent.back();
  }
  int Find(int a) const
  {
    while (this->Up(a) != a)
    {
      this->Up(a) = this->Up(this->Up(a));
      a = this->Up(a);
    }
    return a;
  }
  void Unite(int a, int b)
  {
    a = this->Find(a);
    b = this->Find(b);
    this->Up(std::max(a, b)) = std::min(a, b);
  }
  int Size() const { return static_cast<int>(this->Parent.size()); }

private:
  int& Up(int a) const { return this->Parent[static_cast<std::size_t>(a)]; }
  mutable std::vector<int> Parent;
};
}
