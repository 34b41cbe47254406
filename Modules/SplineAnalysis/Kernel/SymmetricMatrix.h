// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "UnknownColumns.h"

#include <Eigen/SparseCore>

#include <array>

namespace knotwork
{
/// A symmetric matrix by its lower triangle, whose columns are divided into blocks of about as many
/// entries, a thread each. The bits of products do not depend on the number of threads.
template <int Width>
class SymmetricMatrix
{
public:
  using Columns = UnknownColumns<Width>;

  /// @param lower  compressed, with all entries of the diagonal; stays where it is.
  SymmetricMatrix(const Eigen::SparseMatrix<double>& lower, int threads);
  void Multiply(const Columns& x, Columns& y);
  /// One step of symmetric Gauss-Seidel, forth and back, from 0 within each block.
  void GaussSeidel(const Columns& side, Columns& x) const;

private:
  static constexpr std::size_t NumBlocks = 8;
  int Begin(Eigen::Index column) const { return this->Lower.outerIndexPtr()[column]; }
  int End(Eigen::Index column) const { return this->Lower.outerIndexPtr()[column + 1]; }
  int Row(int place) const { return this->Lower.innerIndexPtr()[place]; }
  double Value(int place) const { return this->Lower.valuePtr()[place]; }
  template <typename Body>
  void ForBlocks(const Body& body) const;

  const Eigen::SparseMatrix<double>& Lower;
  int Threads;
  std::array<Eigen::Index, NumBlocks + 1> Ends{};
  std::array<Columns, NumBlocks> Parts; ///< of a product, from the first row of a block
};
}
