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

/// Disjoint sets of numbers of which each runs as the smallest member of its set or the other way
/// round: sets of the numbers and of as many turned around.
class SignedSets
{
public:
  /// Every number a set of its own.
  explicit SignedSets(int size = 0) : Sets(2 * size) {}
  /// @return the smallest member.
  int Find(int a) const { return std::min(this->Sets.Find(a), this->Sets.Find(this->Turned(a))); }
  /// Whether a runs the other way round than the smallest member.
  bool IsTurned(int a) const { return this->Sets.Find(a) > this->Sets.Find(this->Turned(a)); }
  /// Makes b run as a, or the other way round. @return false when they are one already and do not.
  bool Unite(int a, int b, bool turned)
  {
    const int other = turned ? this->Turned(b) : b;
    if (this->Sets.Find(a) == this->Sets.Find(this->Turned(other)))
    {
      return false;
    }
    this->Sets.Unite(a, other);
    this->Sets.Unite(this->Turned(a), this->Turned(other));
    return true;
  }

private:
  int Turned(int a) const
  {
    const int half = this->Sets.Size() / 2;
    return a < half ? a + half : a - half;
  }
  DisjointSets Sets;
};
}
