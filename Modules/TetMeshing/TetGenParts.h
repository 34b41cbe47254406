// SPDX-License-Identifier: BSD-3-Clause
// What the program knotwork-tetgen takes and hands over, as arrays of the machine's numbers.
#pragma once
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace knotwork
{
/// Parts of the input: coordinates (double), corners of triangles (int); a point in each region
/// that has a bound of its own, and that volume (double, four each); of a background grid
/// coordinates (double), corners of tetrahedra (int), and lengths of edges at these corners
/// (double). Parts of the answer: coordinates (double), corners of tetrahedra, corners of
/// triangles, numbers of the input's triangles that these are parts of (int).
enum class TetGenInput
{
  Points,
  Triangles,
  Regions,
  SizePoints,
  SizeCells,
  Sizes,
  Count
};
enum class TetGenAnswer
{
  Points,
  Tetrahedra,
  Triangles,
  Sources,
  Oversized, ///< one number
  Count
};

/// Of a volume: what a tetrahedron may be larger than was asked for, by rounding.
inline constexpr double SizeMargin = 1e-9;

/// Of a regular tetrahedron.
inline double VolumeOfEdge(double length)
{
  return length * length * length / (6.0 * std::sqrt(2.0));
}

/// The edge of a regular tetrahedron.
inline double EdgeOfVolume(double volume)
{
  return std::cbrt(6.0 * std::sqrt(2.0) * volume);
}

template <typename Number>
std::string PackNumbers(const Number* from, std::size_t count)
{
  return { reinterpret_cast<const char*>(from), count * sizeof(Number) };
}

template <typename Number>
std::vector<Number> UnpackNumbers(const std::string& part)
{
  std::vector<Number> numbers(part.size() / sizeof(Number));
  std::memcpy(numbers.data(), part.data(), numbers.size() * sizeof(Number));
  return numbers;
}

/// The same of rows of numbers.
template <typename Number, std::size_t N>
std::string PackGroups(const std::vector<std::array<Number, N>>& groups)
{
  return groups.empty() ? std::string() : PackNumbers(groups.data()->data(), N * groups.size());
}

template <std::size_t N>
std::vector<std::array<int, N>> UnpackGroups(const std::string& part)
{
  const std::vector<int> numbers = UnpackNumbers<int>(part);
  std::vector<std::array<int, N>> groups(numbers.size() / N);
  for (std::size_t i = 0; i < groups.size() * N; ++i)
  {
    groups[i / N][i % N] = numbers[i];
  }
  return groups;
}
}
