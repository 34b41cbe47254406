// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "LRSpace.h"

#include <algorithm>
#include <numeric>

namespace knotwork
{
/// Bernstein coefficients of univariate B-splines on the intervals between mesh lines, in numbers
/// of any kind; each is worked out once.
template <typename Value>
class LRLineRows
{
public:
  /// The basis must outlive the object.
  LRLineRows(const LRBasis& basis, int direction)
    : Basis(basis), Direction(direction), Degree(basis.Degree[static_cast<std::size_t>(direction)])
  {
    // equal local knot vectors get one number
    const int n = this->Degree + 2;
    std::vector<int> order(static_cast<std::size_t>(basis.NumFunctions()));
    std::iota(order.begin(), order.end(), 0);
    const auto less = [&](int a, int b)
    {
      const int* first = basis.Local(a, direction);
      const int* second = basis.Local(b, direction);
      return std::lexicographical_compare(first, first + n, second, second + n);
    };
    std::sort(order.begin(), order.end(), less);
    this->Cells.resize(order.size());
    std::size_t cells = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      const int* knots = basis.Local(order[i], direction);
      if (i == 0 || less(order[i - 1], order[i]))
      {
        first = cells;
        cells += static_cast<std::size_t>(knots[n - 1] - knots[0]);
      }
      this->Cells[static_cast<std::size_t>(order[i])] = first;
    }
    this->Heads.assign(cells, -1);
  }

  /// Offset of the row of p + 1 numbers of a function between two knots inside one of its spans.
  /// @param make  make(knots, low, high, row) writes it: knots as LRBasis::Local.
  template <typename Make>
  int Find(int function, int low, int high, Make&& make)
  {
    const int* knots = this->Basis.Local(function, this->Direction);
    const std::size_t cell =
      this->Cells[static_cast<std::size_t>(function)] + static_cast<std::size_t>(low - knots[0]);
    int& head = this->Heads[cell];
    for (int entry = head; entry >= 0; entry = this->Entries[static_cast<std::size_t>(entry)].Next)
    {
      if (this->Entries[static_cast<std::size_t>(entry)].High == high)
      {
        return entry * (this->Degree + 1);
      }
    }
    const auto entry = static_cast<int>(this->Entries.size());
    this->Entries.push_back({ cell, high, head });
    head = entry;
    Value row[MaxDegree + 1];
    make(knots, low, high, row);
    this->Rows.insert(this->Rows.end(), row, row + this->Degree + 1);
    return entry * (this->Degree + 1);
  }

  /// Forgets all rows.
  void Clear()
  {
    for (const Entry& entry : this->Entries)
    {
      this->Heads[entry.Cell] = -1;
    }
    this->Entries.clear();
    this->Rows.clear();
  }

  const Value* Row(int offset) const { return this->Rows.data() + offset; }

private:
  struct Entry
  {
    std::size_t Cell;
    int High;
    int Next;
  };
  const LRBasis& Basis;
  int Direction;
  int Degree;
  std::vector<std::size_t> Cells; // cell of a function's first knot
  std::vector<int> Heads;         // entries of the intervals that begin at a cell's knot
  std::vector<Entry> Entries;
  std::vector<Value> Rows;
};

/// Bernstein coefficients of B[knots] between two knots inside one of its spans: coefficient k is
/// the blossom at (low^{p-k}, high^k), by de Boor's steps.
/// @param combine  combine(u, lower, upper, a, b) = ((upper - u) a + (u - lower) b) / (upper -
/// lower) for knot indices u, lower < upper and numbers a, b. In floating point all terms are
/// positive, so there is no cancellation, and what vanishes is 0.
/// @param row  p + 1 numbers.
/// @source  Ramshaw, CAGD 6 (1989) 323-358 (blossoms); de Boor, J. Approx. Theory 6 (1972) 50-62.
template <typename Value, typename Combine>
void LRBlossomRow(int degree, const int* knots, int low, int high, Combine&& combine, Value* row)
{
  int span = 0; // knots[span] <= low < high <= knots[span + 1]
  while (knots[span + 1] <= low)
  {
    ++span;
  }
  // the 2p knots that matter on the span, the ends repeated; the function has number p - span
  int local[2 * MaxDegree];
  for (int j = 0; j < 2 * degree; ++j)
  {
    local[j] = knots[std::clamp(span - degree + 1 + j, 0, degree + 1)];
  }
  for (int k = 0; k <= degree; ++k)
  {
    Value c[MaxDegree + 1] = {};
    c[degree - span] = Value(1);
    for (int r = 1; r <= degree; ++r)
    {
      const int u = r <= degree - k ? low : high;
      for (int j = degree; j >= r; --j)
      {
        c[j] = combine(u, local[j - 1], local[j + degree - r], c[j - 1], c[j]);
      }
    }
    row[k] = c[degree];
  }
}
}
