// SPDX-License-Identifier: BSD-3-Clause
#include "SharedRows.h"

#include "DisjointSets.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace knotwork
{
namespace
{
/// Rows are equal when no coefficient differs by more.
constexpr double RowTolerance = 1e-12;

/// A number in [0, 1) for every function, as good as random: equal rows have nearly equal sums of
/// these, other rows hardly ever.
double Mark(int function)
{
  std::uint64_t h = (static_cast<std::uint64_t>(function) + 1) * 0x9e3779b97f4a7c15ULL;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
  return std::ldexp(static_cast<double>((h ^ (h >> 31)) >> 11), -53);
}

class RowMatcher
{
public:
  explicit RowMatcher(const BernsteinRows& rows) : Rows(rows) {}

  double Sum(int row) const
  {
    double sum = 0.0;
    for (std::size_t k = this->Begin(row); k < this->End(row); ++k)
    {
      sum += this->Rows.Coefficients[k] * Mark(this->Rows.Functions[k]);
    }
    return sum;
  }

  bool AreEqual(int a, int b) const
  {
    std::size_t i = this->Begin(a);
    std::size_t j = this->Begin(b);
    while (i < this->End(a) || j < this->End(b))
    {
      const bool hasA = i < this->End(a);
      const bool hasB = j < this->End(b);
      const int f = !hasB || (hasA && this->Rows.Functions[i] < this->Rows.Functions[j])
        ? this->Rows.Functions[i]
        : this->Rows.Functions[j];
      const double x = hasA && this->Rows.Functions[i] == f ? this->Rows.Coefficients[i++] : 0.0;
      const double y = hasB && this->Rows.Functions[j] == f ? this->Rows.Coefficients[j++] : 0.0;
      if (!(std::abs(x - y) <= RowTolerance))
      {
        return false;
      }
    }
    return true;
  }

private:
  std::size_t Begin(int row) const { return this->Rows.Start[static_cast<std::size_t>(row)]; }
  std::size_t End(int row) const { return this->Rows.Start[static_cast<std::size_t>(row) + 1]; }

  const BernsteinRows& Rows;
};

/// Whether a Bernstein point lies on a side.
template <int Dim>
bool IsOnSide(const IntArray<Dim>& degree, int point)
{
  for (const int p : degree)
  {
    if (point % (p + 1) == 0 || point % (p + 1) == p)
    {
      return true;
    }
    point /= p + 1;
  }
  return false;
}
}

template <int Dim>
BernsteinRows RowsOf(const ExtractionTable<Dim>& table)
{
  BernsteinRows rows;
  std::vector<std::size_t> order; // of the functions of an element, ascending
  for (std::size_t e = 0; e < table.NumElements(); ++e)
  {
    order.resize(table.FirstFunction[e + 1] - table.FirstFunction[e]);
    std::iota(order.begin(), order.end(), table.FirstFunction[e]);
    std::sort(order.begin(), order.end(),
      [&](std::size_t a, std::size_t b) { return table.Functions[a] < table.Functions[b]; });
    for (std::size_t i = 0; i < static_cast<std::size_t>(NumTensorFunctions<Dim>(table.Degrees[e]));
         ++i)
    {
      for (const std::size_t k : order)
      {
        const auto vector = static_cast<std::size_t>(table.Vectors[k]);
        const double coefficient = table.Coefficients[table.FirstCoefficient[vector] + i];
        if (coefficient != 0.0)
        {
          rows.Functions.push_back(table.Functions[k]);
          rows.Coefficients.push_back(coefficient);
        }
      }
      rows.Start.push_back(rows.Functions.size());
    }
  }
  return rows;
}

template <int Dim>
std::vector<int> FindEqualRows(const ExtractionTable<Dim>& table, const BernsteinRows& rows)
{
  struct Side
  {
    double Sum;
    int Row;
  };
  const auto count = static_cast<int>(rows.Start.size()) - 1;
  const RowMatcher matcher(rows);
  std::vector<Side> sides;
  int firstRow = 0;
  for (const IntArray<Dim>& degree : table.Degrees)
  {
    const int points = NumTensorFunctions<Dim>(degree);
    for (int i = 0; i < points; ++i)
    {
      if (IsOnSide<Dim>(degree, i))
      {
        sides.push_back({ matcher.Sum(firstRow + i), firstRow + i });
      }
    }
    firstRow += points;
  }
  std::sort(sides.begin(), sides.end(),
    [](const Side& a, const Side& b) { return a.Sum != b.Sum ? a.Sum < b.Sum : a.Row < b.Row; });
  // equal rows stand close together: each is compared with the first ones of the sets so far
  DisjointSets sets(count);
  std::vector<Side> open; // one of each set whose sum is near
  for (const Side& side : sides)
  {
    const double reach = 100.0 * RowTolerance;
    open.erase(std::remove_if(open.begin(), open.end(),
                 [&](const Side& other) { return side.Sum - other.Sum > reach; }),
      open.end());
    const auto found = std::find_if(open.begin(), open.end(),
      [&](const Side& other) { return matcher.AreEqual(other.Row, side.Row); });
    if (found != open.end())
    {
      sets.Unite(found->Row, side.Row);
      found->Sum = side.Sum;
    }
    else
    {
      open.push_back(side);
    }
  }
  std::vector<int> equal(static_cast<std::size_t>(count));
  std::vector<int> own;
  firstRow = 0;
  for (const IntArray<Dim>& degree : table.Degrees)
  {
    const int points = NumTensorFunctions<Dim>(degree);
    own.clear();
    for (int row = firstRow; row < firstRow + points; ++row)
    {
      equal[static_cast<std::size_t>(row)] = sets.Find(row);
      own.push_back(sets.Find(row));
    }
    std::sort(own.begin(), own.end());
    if (std::adjacent_find(own.begin(), own.end()) != own.end()) // too small to tell its points
    {
      std::iota(equal.begin() + firstRow, equal.begin() + firstRow + points, firstRow);
    }
    firstRow += points;
  }
  return equal;
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template BernsteinRows RowsOf<Dim>(const ExtractionTable<Dim>&);                                 \
  template std::vector<int> FindEqualRows<Dim>(const ExtractionTable<Dim>&, const BernsteinRows&);
KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
