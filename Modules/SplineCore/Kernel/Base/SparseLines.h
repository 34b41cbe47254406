// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/SparseCore>

#include <algorithm>
#include <vector>

namespace knotwork
{
/// Some neighbouring rows of a matrix by rows, or columns of one by columns.
struct SparseLines
{
  std::vector<int> Sizes;   ///< entries of each line
  std::vector<int> Indices; ///< of the entries in their lines
  std::vector<double> Values;
};

/// A line whose entries are sums of terms in any order.
class SparseLineSum
{
public:
  explicit SparseLineSum(std::size_t size) : Sums(size, 0.0), IsUsed(size, 0) {}

  void Add(int index, double term)
  {
    const auto i = static_cast<std::size_t>(index);
    if (!this->IsUsed[i])
    {
      this->IsUsed[i] = 1;
      this->Indices.push_back(index);
    }
    this->Sums[i] += term;
  }
  /// Appends the line, its indices ascending, and begins the next one.
  void MoveTo(SparseLines& lines)
  {
    std::sort(this->Indices.begin(), this->Indices.end());
    lines.Sizes.push_back(static_cast<int>(this->Indices.size()));
    for (const int index : this->Indices)
    {
      const auto i = static_cast<std::size_t>(index);
      lines.Indices.push_back(index);
      lines.Values.push_back(this->Sums[i]);
      this->Sums[i] = 0.0;
      this->IsUsed[i] = 0;
    }
    this->Indices.clear();
  }

private:
  std::vector<double> Sums;
  std::vector<char> IsUsed;
  std::vector<int> Indices;
};

/// The matrix of all lines, in order; parts are emptied on the way.
/// @pre at most 2^31 - 1 entries.
template <int Order>
Eigen::SparseMatrix<double, Order> JoinLines(
  std::vector<SparseLines>& parts, Eigen::Index rows, Eigen::Index columns)
{
  std::size_t entries = 0;
  for (const SparseLines& part : parts)
  {
    entries += part.Indices.size();
  }
  Eigen::SparseMatrix<double, Order> matrix(rows, columns);
  matrix.resizeNonZeros(static_cast<Eigen::Index>(entries));
  int* outer = matrix.outerIndexPtr();
  int* inner = matrix.innerIndexPtr();
  double* value = matrix.valuePtr();
  *outer = 0;
  for (SparseLines& part : parts)
  {
    for (const int size : part.Sizes)
    {
      outer[1] = outer[0] + size;
      ++outer;
    }
    inner = std::copy(part.Indices.begin(), part.Indices.end(), inner);
    value = std::copy(part.Values.begin(), part.Values.end(), value);
    part = {};
  }
  return matrix;
}
}
