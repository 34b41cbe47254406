// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "LRKnotHash.h"
#include "LRSpace.h"

#include <algorithm>

namespace knotwork
{
/// Bernstein coefficients of univariate B-splines on the intervals between mesh lines, in numbers
/// of any kind; each is worked out once.
/// @tparam Basis  LRBasis or LRVolumeBasis.
template <typename Value, typename Basis = LRBasis>
class LRLineRows
{
public:
  /// The basis must outlive the object.
  LRLineRows(const Basis& basis, int direction)
    : Space(basis), Direction(direction), Degree(basis.Degree[static_cast<std::size_t>(direction)])
  {
    // equal local knot vectors share their cells; a table by hash holds the first function of each
    const auto n = static_cast<std::size_t>(basis.NumFunctions());
    std::size_t size = 64;
    while (size < 2 * n)
    {
      size *= 2;
    }
    std::vector<int> table(size, -1);
    this->Cells.resize(n);
    std::size_t cells = 0;
    for (int f = 0; f < basis.NumFunctions(); ++f)
    {
      const int* knots = basis.Local(f, direction);
      std::size_t slot = LRKnotHash(knots, this->Degree + 2) & (size - 1);
      while (table[slot] >= 0 &&
        !std::equal(knots, knots + this->Degree + 2, basis.Local(table[slot], direction)))
      {
        slot = (slot + 1) & (size - 1);
      }
      std::size_t& cell = this->Cells[static_cast<std::size_t>(f)];
      if (table[slot] >= 0)
      {
        cell = this->Cells[static_cast<std::size_t>(table[slot])];
        continue;
      }
      table[slot] = f;
      cell = cells;
      cells += static_cast<std::size_t>(knots[this->Degree + 1] - knots[0]);
    }
    this->Heads.assign(cells, -1);
  }

  /// Number of the row of a function between two knots inside one of its spans.
  int Number(int function, int low, int high)
  {
    const int* knots = this->Space.Local(function, this->Direction);
    const std::size_t cell =
      this->Cells[static_cast<std::size_t>(function)] + static_cast<std::size_t>(low - knots[0]);
    int& head = this->Heads[cell];
    for (int entry = head; entry >= 0; entry = this->Entries[static_cast<std::size_t>(entry)].Next)
    {
      if (this->Entries[static_cast<std::size_t>(entry)].High == high)
      {
        return entry;
      }
    }
    const int entry = this->Size();
    this->Entries.push_back({ cell, function, low, high, head });
    head = entry;
    return entry;
  }

  int Size() const { return static_cast<int>(this->Entries.size()); }

  /// Works out the rows of some numbers. Ranges that share no number may run at the same time.
  /// @param make  make(knots, low, high, row) writes p + 1 numbers: knots as LRBasis::Local.
  /// @pre Allocate() since the last new number.
  template <typename Make>
  void Fill(int begin, int end, Make&& make)
  {
    for (int k = begin; k < end; ++k)
    {
      const Entry& entry = this->Entries[static_cast<std::size_t>(k)];
      make(this->Space.Local(entry.Function, this->Direction), entry.Low, entry.High,
        this->Rows.data() + std::ptrdiff_t{ k } * (this->Degree + 1));
    }
  }
  void Allocate()
  {
    this->Rows.resize(this->Entries.size() * static_cast<std::size_t>(this->Degree + 1));
  }

  /// Number and row together.
  template <typename Make>
  int Find(int function, int low, int high, Make&& make)
  {
    const int before = this->Size();
    const int number = this->Number(function, low, high);
    if (number == before)
    {
      this->Allocate();
      this->Fill(number, number + 1, make);
    }
    return number;
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

  /// p + 1 numbers.
  const Value* Row(int number) const
  {
    return this->Rows.data() + std::ptrdiff_t{ number } * (this->Degree + 1);
  }

private:
  struct Entry
  {
    std::size_t Cell;
    int Function; // one of those with these knots
    int Low;
    int High;
    int Next;
  };

  const Basis& Space;
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
  // c: the points after some steps at low; the steps at high that are left end in a coefficient
  Value c[MaxDegree + 1] = {};
  c[degree - span] = Value(1);
  const auto step = [&](int u, int r, Value* values)
  {
    for (int j = degree; j >= r; --j)
    {
      values[j] = combine(u, local[j - 1], local[j + degree - r], values[j - 1], values[j]);
    }
  };
  for (int done = 0; done <= degree; ++done)
  {
    Value t[MaxDegree + 1];
    std::copy_n(c, degree + 1, t);
    for (int r = done + 1; r <= degree; ++r)
    {
      step(high, r, t);
    }
    row[degree - done] = t[degree];
    step(low, done + 1, c);
  }
}
}
