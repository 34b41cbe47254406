// SPDX-License-Identifier: BSD-3-Clause
#include "FunctionMap.h"

#include <algorithm>
#include <numeric>

namespace knotwork
{
namespace
{
/// Comparing the arrays would call memcmp.
template <int Dim>
bool IsSame(const LevelIndex<Dim>& a, const LevelIndex<Dim>& b)
{
  bool same = true;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    same = same && a[d] == b[d];
  }
  return same;
}

/// Calls use(index) with the first index of every row of a block.
template <int Dim, typename Use>
void ForEachRow(const LevelIndex<Dim>& first, const IntArray<Dim>& shape, Use&& use)
{
  IntArray<Dim> rows = shape;
  rows[0] = 1;
  ForEachOffset<Dim>(rows,
    [&](const IntArray<Dim>& offset)
    {
      LevelIndex<Dim> index = first;
      for (std::size_t d = 1; d < Dim; ++d)
      {
        index[d] += offset[d];
      }
      use(index);
    });
}
}

template <int Dim>
FunctionMap<Dim>::FunctionMap(
  const LevelIndex<Dim>& lower, const LevelIndex<Dim>& upper, std::size_t cells)
  : Lower(lower)
{
  double volume = 1.0;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    this->Extent[d] = upper[d] - lower[d];
    volume *= static_cast<double>(this->Extent[d]);
  }
  this->Dense = volume <= 64.0 * static_cast<double>(cells);
  this->Table.assign(this->Dense ? static_cast<std::size_t>(volume) : std::size_t(64), 0);
}

template <int Dim>
std::size_t FunctionMap<Dim>::Linear(const LevelIndex<Dim>& index) const
{
  std::int64_t linear = 0;
  for (std::size_t d = Dim; d-- > 0;)
  {
    linear = linear * this->Extent[d] + (index[d] - this->Lower[d]);
  }
  return static_cast<std::size_t>(linear);
}

template <int Dim>
std::size_t FunctionMap<Dim>::Slot(const LevelIndex<Dim>& index) const
{
  std::uint64_t h = 0;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    h = (h ^ static_cast<std::uint64_t>(index[d])) * 0x9e3779b97f4a7c15u;
    h ^= h >> 32;
  }
  const std::size_t mask = this->Table.size() - 1;
  std::size_t slot = static_cast<std::size_t>(h) & mask;
  while (this->Table[slot] != 0 && !IsSame<Dim>(this->Indices[this->Table[slot] - 1], index))
  {
    slot = (slot + 1) & mask;
  }
  return slot;
}

template <int Dim>
void FunctionMap<Dim>::Grow()
{
  this->Table.assign(2 * this->Table.size(), 0);
  for (std::size_t i = 0; i < this->Indices.size(); ++i)
  {
    this->Table[this->Slot(this->Indices[i])] = static_cast<std::uint32_t>(i + 1);
  }
}

template <int Dim>
void FunctionMap<Dim>::CountBlock(
  const LevelIndex<Dim>& first, const IntArray<Dim>& shape, std::uint32_t value)
{
  ForEachRow<Dim>(first, shape,
    [&](LevelIndex<Dim> index)
    {
      if (this->Dense)
      {
        std::uint32_t* counters = this->Table.data() + this->Linear(index);
        for (int i = 0; i < shape[0]; ++i)
        {
          counters[i] += value;
        }
        return;
      }
      std::size_t next = 0; // neighbours often follow each other: one look saves the hashing
      for (int i = 0; i < shape[0]; ++i, ++index[0])
      {
        if (i > 0 && next < this->Indices.size() && IsSame<Dim>(this->Indices[next], index))
        {
          this->Counters[next++] += value;
          continue;
        }
        const std::size_t slot = this->Slot(index);
        if (this->Table[slot] != 0)
        {
          next = this->Table[slot];
          this->Counters[next - 1] += value;
          continue;
        }
        this->Indices.push_back(index);
        this->Counters.push_back(value);
        next = this->Indices.size();
        this->Table[slot] = static_cast<std::uint32_t>(next);
        if (2 * this->Indices.size() > this->Table.size())
        {
          this->Grow();
        }
      }
    });
}

template <int Dim>
std::vector<std::uint32_t> FunctionMap<Dim>::Finish()
{
  if (this->Dense)
  {
    LevelIndex<Dim> index = this->Lower;
    for (std::uint32_t& entry : this->Table)
    {
      if (entry != 0)
      {
        this->Counters.push_back(entry);
        this->Indices.push_back(index);
        entry = static_cast<std::uint32_t>(this->Indices.size());
      }
      for (std::size_t d = 0; d < Dim && ++index[d] == this->Lower[d] + this->Extent[d]; ++d)
      {
        index[d] = this->Lower[d];
      }
    }
    return std::move(this->Counters);
  }
  const auto before = [](const LevelIndex<Dim>& a, const LevelIndex<Dim>& b)
  { return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend()); };
  std::vector<std::uint32_t> order(this->Indices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
    [&](std::uint32_t a, std::uint32_t b) { return before(this->Indices[a], this->Indices[b]); });
  std::vector<LevelIndex<Dim>> indices(order.size());
  std::vector<std::uint32_t> counters(order.size());
  std::vector<std::uint32_t> numbers(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    indices[i] = this->Indices[order[i]];
    counters[i] = this->Counters[order[i]];
    numbers[order[i]] = static_cast<std::uint32_t>(i + 1);
  }
  for (std::uint32_t& entry : this->Table)
  {
    entry = entry == 0 ? 0 : numbers[entry - 1];
  }
  this->Indices = std::move(indices);
  this->Counters = {};
  return counters;
}

template <int Dim>
int FunctionMap<Dim>::Find(const LevelIndex<Dim>& index) const
{
  for (std::size_t d = 0; d < Dim; ++d)
  {
    if (index[d] < this->Lower[d] || index[d] >= this->Lower[d] + this->Extent[d])
    {
      return -1;
    }
  }
  const std::size_t slot = this->Dense ? this->Linear(index) : this->Slot(index);
  return static_cast<int>(this->Table[slot]) - 1;
}

template <int Dim>
void FunctionMap<Dim>::FindBlock(
  const LevelIndex<Dim>& first, const IntArray<Dim>& shape, int* numbers) const
{
  ForEachRow<Dim>(first, shape,
    [&](LevelIndex<Dim> index)
    {
      if (this->Dense)
      {
        const std::uint32_t* entries = this->Table.data() + this->Linear(index);
        numbers = std::transform(entries, entries + shape[0], numbers,
          [](std::uint32_t entry) { return static_cast<int>(entry) - 1; });
        return;
      }
      std::size_t next = 0;
      for (int i = 0; i < shape[0]; ++i, ++index[0])
      {
        const bool follows =
          i > 0 && next < this->Indices.size() && IsSame<Dim>(this->Indices[next], index);
        next = follows ? next + 1 : this->Table[this->Slot(index)];
        *numbers++ = static_cast<int>(next) - 1;
      }
    });
}

template class FunctionMap<1>;
template class FunctionMap<2>;
template class FunctionMap<3>;
}
