// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace knotwork
{
/// Multi-index of a cell or of a function of a level.
template <int Dim>
using LevelIndex = std::array<std::int64_t, Dim>;

/// Visits the multi-indices of a box of the given shape, first direction fastest, as offsets.
template <int Dim, class Visit>
void ForEachOffset(const IntArray<Dim>& shape, Visit&& visit)
{
  IntArray<Dim> offset{};
  for (;;)
  {
    visit(offset);
    std::size_t d = 0;
    while (d < Dim && ++offset[d] == shape[d])
    {
      offset[d++] = 0;
    }
    if (d == Dim)
    {
      return;
    }
  }
}

/// The functions of one level that are alive on at least one existing cell, numbered first
/// direction fastest, with the lookup from multi-index to number.
///
/// Filled in two steps: CountBlock for every cell, then Finish. The lookup is an array over the
/// bounding box of all indices while that is not much larger than the number of cells, and a hash
/// table with open addressing otherwise.
template <int Dim>
class FunctionMap
{
public:
  FunctionMap() = default;
  /// @param lower, upper  bounding box [lower, upper) of all indices to come.
  /// @param cells         number of cells; decides on the kind of lookup.
  FunctionMap(const LevelIndex<Dim>& lower, const LevelIndex<Dim>& upper, std::size_t cells);

  /// Adds a value to the counters of a block of functions.
  void CountBlock(const LevelIndex<Dim>& first, const IntArray<Dim>& shape, std::uint32_t value);
  /// Numbers the functions. @return their counters.
  std::vector<std::uint32_t> Finish();

  std::size_t Size() const { return this->Indices.size(); }
  const LevelIndex<Dim>& Index(std::size_t function) const { return this->Indices[function]; }
  /// Number of a function, -1 when there is none.
  int Find(const LevelIndex<Dim>& index) const;
  /// Numbers of a block of functions, first direction fastest; the block lies in the bounding box.
  void FindBlock(const LevelIndex<Dim>& first, const IntArray<Dim>& shape, int* numbers) const;

private:
  std::size_t Slot(const LevelIndex<Dim>& index) const; // of the hash table
  std::size_t Linear(const LevelIndex<Dim>& index) const;
  void Grow();

  LevelIndex<Dim> Lower{};
  LevelIndex<Dim> Extent{};
  bool Dense = true;
  /// Dense: counter, later number + 1, of every index of the box. Else: number + 1 of the hash
  /// table's entries. 0 is empty.
  std::vector<std::uint32_t> Table;
  std::vector<LevelIndex<Dim>> Indices;
  std::vector<std::uint32_t> Counters; // hash table only
};
}
