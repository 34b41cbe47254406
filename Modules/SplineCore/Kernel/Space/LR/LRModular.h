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
/// @tparam Data  LRData or LRVolume.
template <typename Data>
class LRModularRows
{
public:
  using Basis = decltype(Data::Basis);
  static constexpr std::size_t Dim = std::tuple_size<decltype(Basis::Knots)>::value;

  explicit LRModularRows(const Data& data) : Space(data)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      this->Lines.emplace_back(data.Basis, static_cast<int>(d));
    }
  }

  void SetPrime(PrimeField::Number prime)
  {
    this->Field = PrimeField(prime);
    this->Unlucky = false;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      this->Knots[d].clear();
      for (const double knot : this->Space.Basis.Knots[d])
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

  /// The coefficients of a function on an element, first direction fastest.
  void Get(int function, int element, ModularRow& result)
  {
    const auto& box = this->Space.ElementKnots[static_cast<std::size_t>(element)];
    result.assign(1, 1);
    for (std::size_t d = Dim; d-- > 0;)
    {
      const int number = this->Find(d, function, box[d], box[d + Dim]);
      const auto n = static_cast<std::size_t>(this->Space.Basis.Degree[d]) + 1;
      this->Product.clear();
      for (const PrimeField::Number outer : result)
      {
        for (std::size_t i = 0; i < n; ++i)
        {
          this->Product.push_back(this->Field.Multiply(this->Lines[d].Row(number)[i], outer));
        }
      }
      result.swap(this->Product);
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
      this->Space.Basis.Degree[d], knots, low, high,
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

  const Data& Space;
  PrimeField Field;
  std::array<std::vector<PrimeField::Number>, Dim> Knots;
  std::vector<LRLineRows<PrimeField::Number, Basis>> Lines;
  std::array<std::unordered_map<std::uint64_t, PrimeField::Number>, Dim> Inverses;
  ModularRow Product;
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
template <typename Data>
class LRPrimes
{
public:
  explicit LRPrimes(const Data& data) : Rows(data) {}

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
  LRModularRows<Data> Rows;
};
}
