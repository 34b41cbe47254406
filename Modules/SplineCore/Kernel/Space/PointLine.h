// SPDX-License-Identifier: BSD-3-Clause
// Bernstein points of elements on the grids of their levels, private to the kernel.
#pragma once
#include "SplineSpace.h"
#include "Types.h"

namespace knotwork
{
/// Integer position of an element in the grid of its level.
template <int Dim>
using CellIndex = std::array<std::int64_t, Dim>;

/// Elements of a space with a domain are the leaves of its refinement tree.
template <int Dim>
void IndexBelow(const SplineSpace<Dim>& space, int node, const CellIndex<Dim>& index,
  std::vector<CellIndex<Dim>>& all)
{
  if (node >= 0)
  {
    all[static_cast<std::size_t>(node)] = index;
    return;
  }
  const std::size_t block = static_cast<std::size_t>(-1 - node) << Dim;
  for (std::size_t child = 0; child < (std::size_t{ 1 } << Dim); ++child)
  {
    CellIndex<Dim> below;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      below[d] = 2 * index[d] + static_cast<std::int64_t>((child >> d) & 1);
    }
    IndexBelow<Dim>(space, space.Tree[block + child], below, all);
  }
}

template <int Dim>
std::vector<CellIndex<Dim>> IndexElements(const SplineSpace<Dim>& space)
{
  std::vector<CellIndex<Dim>> all(space.Elements.size());
  for (std::size_t root = 0; root < space.RootCells.size(); ++root)
  {
    CellIndex<Dim> index;
    std::size_t rest = root;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const auto n = static_cast<std::size_t>(space.Knots[d].NumElements());
      index[d] = static_cast<std::int64_t>(rest % n);
      rest /= n;
    }
    IndexBelow<Dim>(space, space.RootCells[root], index, all);
  }
  return all;
}

/// One direction of the points of a level grid: neighbouring cells share the points of their
/// interface where the basis is continuous; a break of multiplicity p + 1 has two points.
class PointLine
{
public:
  explicit PointLine(const KnotVector& knots) : P(knots.Degree())
  {
    std::int64_t doubled = 0;
    for (int b = 0; b < knots.NumElements(); ++b)
    {
      doubled += b > 0 && knots.Multiplicity(b) > this->P ? 1 : 0;
      this->Doubled.push_back(doubled);
    }
  }
  std::int64_t Position(int level, std::int64_t cell, int bernstein) const
  {
    return cell * this->P + bernstein + this->Doubled[static_cast<std::size_t>(cell >> level)];
  }
  std::int64_t Size() const
  {
    return static_cast<std::int64_t>(this->Doubled.size()) * this->P + 1 + this->Doubled.back();
  }

private:
  int P;
  std::vector<std::int64_t> Doubled; // breaks with two points up to each level-0 cell
};

/// Calls body(i, lattice index) for the Bernstein points of a tensor-product element.
template <int Dim, typename Body>
void ForBernstein(const IntArray<Dim>& degree, const Body& body)
{
  IntArray<Dim> index{};
  const int n = NumTensorFunctions<Dim>(degree);
  for (int i = 0; i < n; ++i)
  {
    body(i, index);
    for (std::size_t d = 0; d < Dim && ++index[d] > degree[d]; ++d)
    {
      index[d] = 0;
    }
  }
}

/// A hash of whole numbers, for tables of points.
template <typename Numbers>
std::size_t HashNumbers(std::uint64_t h, const Numbers& numbers)
{
  for (const auto x : numbers)
  {
    h = (h ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ULL;
    h ^= h >> 29;
  }
  return static_cast<std::size_t>(h);
}
}
