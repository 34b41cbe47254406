// SPDX-License-Identifier: BSD-3-Clause
// What the program knotwork-tetgen takes and hands over, as arrays of the machine's numbers.
#pragma once
#include <cstring>
#include <string>
#include <vector>

namespace knotwork
{
/// Parts of the input: coordinates (double), corners of triangles (int).
/// Parts of the answer: coordinates (double), corners of tetrahedra, corners of triangles, numbers
/// of the input's triangles that these are parts of (int).
enum class TetGenInput
{
  Points,
  Triangles,
  Count
};
enum class TetGenAnswer
{
  Points,
  Tetrahedra,
  Triangles,
  Sources,
  Count
};

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
}
