// SPDX-License-Identifier: BSD-3-Clause
// Exact linear algebra of LR B-splines, modulo primes.
#pragma once
#include "LRLineRows.h"
#include "PrimeField.h"

#include <map>
#include <unordered_map>

namespace knotwork
{
using ModularRow = std::vector<PrimeField::Number>;

/// Bernstein coefficients of the unscaled functions modulo a prime.
class LRModularRows
{
public:
  explicit LRModularRows(const LRData& data)
    : Data(data), Lines{ LRLineRows<PrimeField::Number>(data.Basis, 0),
        LRLineRows<PrimeField::Number>(data.Basis, 1) }
  {
  }

  void SetPrime(PrimeField::Number prime)
  {
    this->Field = PrimeField(prime);
    this->Unlucky = false;
    for (std::size_t d = 0; d < 2; ++d)
    {
      this->Knots[d].clear();
      for (const double knot : this->Data.Basis.Knots[d])
      {
        this->Knots[d].push_back(this->Field.OfDouble(knot));
      }
      this->Lines[d].Clear();
      this->Inverses[d].clear();
    }
  }

  const PrimeField& GetField() const { return this->Field; }
  /// Two knots are the same modulo the prime: its rows mean nothing.
  bool IsUnlucky() const { return this->Unlucky; }

  /// (p + 1)(q + 1) coefficients of a function on an element.
  void Get(int function, int element, ModularRow& result)
  {
    const std::array<int, 4>& box = this->Data.ElementKnots[static_cast<std::size_t>(element)];
    const int u = this->Find(0, function, box[0], box[2]);
    const int v = this->Find(1, function, box[1], box[3]);
    const IntArray<2>& degree = this->Data.Basis.Degree;
    result.clear();
    for (int j = 0; j <= degree[1]; ++j)
    {
      for (int i = 0; i <= degree[0]; ++i)
      {
        result.push_back(this->Field.Multiply(this->Lines[0].Row(u)[i], this->Lines[1].Row(v)[j]));
      }
    }
  }

private:
  int Find(std::size_t d, int function, int low, int high)
  {
    return this->Lines[d].Find(function, low, high,
      [this, d](const int* knots, int a, int b, PrimeField::Number* row)
      { this->Make(d, knots, a, b, row); });
  }

  void Make(std::size_t d, const int* knots, int low, int high, PrimeField::Number* row)
  {
    const std::vector<PrimeField::Number>& t = this->Knots[d];
    LRBlossomRow(
      this->Data.Basis.Degree[d], knots, low, high,
      [&](int u, int lower, int upper, PrimeField::Number a, PrimeField::Number b)
      {
        const PrimeField::Number left = this->Field.Multiply(
          this->Field.Subtract(t[static_cast<std::size_t>(upper)], t[static_cast<std::size_t>(u)]),
          a);
        const PrimeField::Number right = this->Field.Multiply(
          this->Field.Subtract(t[static_cast<std::size_t>(u)], t[static_cast<std::size_t>(lower)]),
          b);
        return this->Field.Multiply(
          this->Field.Add(left, right), this->InverseLength(d, lower, upper));
      },
      row);
  }

  PrimeField::Number InverseLength(std::size_t d, int lower, int upper)
  {
    const std::uint64_t key =
      (static_cast<std::uint64_t>(lower) << 32) | static_cast<std::uint64_t>(upper);
    const auto [place, isNew] = this->Inverses[d].try_emplace(key, 0);
    if (isNew)
    {
      const PrimeField::Number length =
        this->Field.Subtract(this->Knots[d][static_cast<std::size_t>(upper)],
          this->Knots[d][static_cast<std::size_t>(lower)]);
      this->Unlucky = this->Unlucky || length == 0;
      place->second = this->Field.Inverse(length);
    }
    return place->second;
  }

  const LRData& Data;
  PrimeField Field;
  std::array<std::vector<PrimeField::Number>, 2> Knots;
  std::array<LRLineRows<PrimeField::Number>, 2> Lines;
  std::array<std::unordered_map<std::uint64_t, PrimeField::Number>, 2> Inverses;
  bool Unlucky = false;
};

/// Row echelon form that grows row by row: reduced rows with leading ones.
class ModularEchelon
{
public:
  explicit ModularEchelon(const PrimeField& field) : Field(field) {}

  /// @return whether the row was independent of the rows before.
  bool Add(ModularRow row)
  {
    for (const auto& [pivot, other] : this->Rows)
    {
      this->Eliminate(row, other, pivot);
    }
    std::size_t pivot = 0;
    while (pivot < row.size() && row[pivot] == 0)
    {
      ++pivot;
    }
    if (pivot == row.size())
    {
      return false;
    }
    const PrimeField::Number scale = this->Field.Inverse(row[pivot]);
    for (PrimeField::Number& x : row)
    {
      x = this->Field.Multiply(x, scale);
    }
    this->Rows.emplace(pivot, std::move(row));
    return true;
  }

  std::size_t Rank() const { return this->Rows.size(); }

  /// A vector that all rows annihilate, 1 in the first column without pivot. @pre there is one.
  ModularRow Kernel(std::size_t columns) const
  {
    std::size_t free = 0;
    while (this->Rows.count(free) > 0)
    {
      ++free;
    }
    ModularRow x(columns, 0);
    x[free] = 1;
    for (auto row = this->Rows.rbegin(); row != this->Rows.rend(); ++row)
    {
      PrimeField::Number sum = 0;
      for (std::size_t c = row->first + 1; c < columns; ++c)
      {
        sum = this->Field.Add(sum, this->Field.Multiply(row->second[c], x[c]));
      }
      x[row->first] = this->Field.Subtract(0, sum);
    }
    return x;
  }

private:
  void Eliminate(ModularRow& row, const ModularRow& other, std::size_t pivot) const
  {
    const PrimeField::Number factor = row[pivot];
    if (factor == 0)
    {
      return;
    }
    for (std::size_t c = pivot; c < row.size(); ++c)
    {
      row[c] = this->Field.Subtract(row[c], this->Field.Multiply(factor, other[c]));
    }
  }

  const PrimeField& Field;
  std::map<std::size_t, ModularRow> Rows; // by pivot
};

/// Primes one after the other, those left out modulo which two knots are the same.
class LRPrimes
{
public:
  explicit LRPrimes(const LRData& data) : Rows(data) {}

  /// Calls use(rows) with a new prime until their product exceeds 2^bits or use says false.
  /// @return whether all calls said true.
  template <typename Use>
  bool Exceed(double bits, Use&& use)
  {
    PrimeField::Number prime = PrimeField::LargestPrime;
    for (double product = 0.0; product <= bits;)
    {
      this->Rows.SetPrime(prime);
      const bool good = use(this->Rows);
      if (!this->Rows.IsUnlucky())
      {
        if (!good)
        {
          return false;
        }
        product += std::log2(static_cast<double>(prime)) - 1e-6;
      }
      prime = PrimeField::PrimeBelow(prime);
    }
    return true;
  }

private:
  LRModularRows Rows;
};
}
