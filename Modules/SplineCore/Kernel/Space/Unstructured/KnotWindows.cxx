// SPDX-License-Identifier: BSD-3-Clause
#include "KnotWindows.h"

#include "KnotVector.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace knotwork
{
std::size_t KnotWindows::Hash(const double* window) const
{
  std::uint64_t hash = 0;
  for (std::size_t i = 0; i < this->Size; ++i)
  {
    std::uint64_t word;
    std::memcpy(&word, window + i, sizeof word);
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

std::size_t KnotWindows::SlotOf(const double* window) const
{
  const std::size_t mask = this->Slots.size() - 1;
  std::size_t slot = this->Hash(window) & mask;
  while (this->Slots[slot] >= 0 &&
    !std::equal(window, window + this->Size,
      this->Values.data() + static_cast<std::size_t>(this->Slots[slot]) * this->Size))
  {
    slot = (slot + 1) & mask;
  }
  return slot;
}

int KnotWindows::Add(const double* window)
{
  const std::size_t slot = this->SlotOf(window);
  if (this->Slots[slot] >= 0)
  {
    return this->Slots[slot];
  }
  const int number = this->Count();
  this->Slots[slot] = number;
  this->Values.insert(this->Values.end(), window, window + this->Size);
  if (2 * static_cast<std::size_t>(number + 1) > this->Slots.size())
  {
    this->Slots.assign(2 * this->Slots.size(), -1);
    for (int i = 0; i <= number; ++i)
    {
      this->Slots[this->SlotOf(this->Values.data() + static_cast<std::size_t>(i) * this->Size)] = i;
    }
  }
  return number;
}

void KnotWindows::Finish()
{
  const auto p = static_cast<std::ptrdiff_t>(this->Degree);
  for (int i = 0; i < this->Count(); ++i) // also of those that are added here
  {
    const auto begin = this->Values.begin() + i * static_cast<std::ptrdiff_t>(this->Size);
    std::vector<double> reversed(begin, begin + 2 * p + 1);
    std::rotate(reversed.begin() + 1, reversed.begin() + 1 + p, reversed.end());
    const int number = this->Add(reversed.data());
    this->Reverse.push_back(number);
  }
}

std::vector<double> KnotWindows::LocalKnots(int window) const
{
  const double* values = this->Values.data() + static_cast<std::size_t>(window) * this->Size;
  const auto p = static_cast<std::size_t>(this->Degree);
  std::vector<double> knots(2 * p);
  for (std::size_t i = 0; i < p; ++i)
  {
    knots[p - 1 - i] = -values[1 + i];
    knots[p + i] = values[0] + values[1 + p + i];
  }
  return knots;
}

void KnotWindows::Extraction(int window, double* matrix) const
{
  ExtractionFromLocalKnots(this->Degree, this->LocalKnots(window).data(), matrix);
}

std::vector<double> ConvertLocalKnots(
  int degree, const std::vector<double>& target, const std::vector<double>& knots)
{
  constexpr double rounding = 1e-12;
  const auto n = static_cast<std::size_t>(degree + 1);
  std::vector<double> matrix(n * n);
  std::vector<double> d(n * n);
  for (std::size_t row = 0; row < n; ++row)
  {
    // after step r row i holds the coefficients of f(u_1, ..., u_r, t_i, ..., t_(i+p-r-1))
    std::fill(d.begin(), d.end(), 0.0);
    for (std::size_t i = 0; i < n; ++i)
    {
      d[i * n + i] = 1.0;
    }
    for (std::size_t r = 1; r < n; ++r)
    {
      const double u = target[row + r - 1];
      for (std::size_t i = n - 1; i >= r; --i)
      {
        const double low = knots[i - 1];
        const double s = (u - low) / (knots[i + n - 1 - r] - low);
        for (std::size_t k = 0; k < n; ++k)
        {
          d[i * n + k] = (1.0 - s) * d[(i - 1) * n + k] + s * d[i * n + k];
        }
      }
    }
    for (std::size_t k = 0; k < n; ++k)
    {
      const double entry = d[(n - 1) * n + k];
      matrix[row * n + k] = std::fabs(entry) < rounding ? 0.0
        : std::fabs(entry - 1.0) < rounding             ? 1.0
                                                        : entry;
    }
  }
  return matrix;
}

const WindowConversion& KnotWindows::Conversion(int to, int from)
{
  const auto [place, isNew] = this->Conversions.try_emplace({ to, from });
  WindowConversion& made = place->second;
  if (isNew)
  {
    made.Matrix = ConvertLocalKnots(this->Degree, this->LocalKnots(to), this->LocalKnots(from));
    made.IsConvex = std::all_of(
      made.Matrix.begin(), made.Matrix.end(), [](double entry) { return entry >= 0.0; });
  }
  return made;
}
}
