// SPDX-License-Identifier: BSD-3-Clause
#include "PointClusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace knotwork
{
int PointClusters::Number(const double* point)
{
  // Cells of a grid much wider than the tolerance: the box around the point touches mostly one.
  const double width = 64.0 * this->Tolerance;
  std::array<std::array<double, 2>, 8> cell{};
  std::array<int, 8> choices{};
  for (int d = 0; d < this->D; ++d)
  {
    const auto k = static_cast<std::size_t>(d);
    const double x = point[d] + 0.0; // -0 and 0 are one
    cell[k] = width > 0.0 ? std::array<double, 2>{ std::floor((x - this->Tolerance) / width) + 0.0,
      std::floor((x + this->Tolerance) / width) + 0.0 }
                          : std::array<double, 2>{ x, x };
    choices[k] = cell[k][0] == cell[k][1] ? 1 : 2;
  }
  std::array<std::uint64_t, 256> touched{};
  std::size_t count = 1;
  touched[0] = static_cast<std::uint64_t>(this->D);
  for (std::size_t k = 0; k < static_cast<std::size_t>(this->D); ++k)
  {
    const std::size_t before = count;
    for (std::size_t i = 0; i < before; ++i)
    {
      const std::uint64_t prefix = touched[i];
      for (int c = 0; c < choices[k]; ++c)
      {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &cell[k][static_cast<std::size_t>(c)], sizeof bits);
        std::uint64_t hash = (prefix ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
        touched[c == 0 ? i : count++] = hash;
      }
    }
  }
  int number = -1;
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto [begin, end] = this->Cells.equal_range(touched[i]);
    for (auto it = begin; it != end; ++it)
    {
      const double* other = this->Points.data() + static_cast<std::ptrdiff_t>(it->second) * this->D;
      bool near = number < 0 || it->second < number;
      for (int d = 0; near && d < this->D; ++d)
      {
        near = std::abs(other[d] - point[d]) <= this->Tolerance;
      }
      number = near ? it->second : number;
    }
  }
  if (number < 0)
  {
    number = static_cast<int>(this->Points.size() / static_cast<std::size_t>(this->D));
    this->Points.insert(this->Points.end(), point, point + this->D);
    for (std::size_t i = 0; i < count; ++i)
    {
      this->Cells.emplace(touched[i], number);
    }
  }
  return number;
}
}
