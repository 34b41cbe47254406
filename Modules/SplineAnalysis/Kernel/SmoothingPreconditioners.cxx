// SPDX-License-Identifier: BSD-3-Clause
#include "SmoothingPreconditioners.h"

#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace knotwork
{
TwoLevels::TwoLevels(const GalerkinSpace& space, int components, const std::vector<int>& numbers,
  const Eigen::SparseMatrix<double>& lower, const SymmetricMatrix<1>& matrix)
  : Matrix(matrix), CoarseOf(static_cast<std::size_t>(lower.cols()))
{
  constexpr double CellFunctions = 250; // in the mean, if points filled their box
  const Eigen::RowVectorXd low = space.Points.colwise().minCoeff();
  const Eigen::RowVectorXd size = space.Points.colwise().maxCoeff() - low;
  const double width =
    std::pow(size.prod() * CellFunctions / space.NumFunctions(), 1.0 / space.Dimension);
  std::unordered_map<std::uint64_t, int> cells;
  for (int f = 0; f < space.NumFunctions(); ++f)
  {
    std::uint64_t cell = 0;
    for (int d = 0; d < space.Dimension; ++d)
    {
      cell = cell << 20U | static_cast<std::uint64_t>((space.Points(f, d) - low[d]) / width);
    }
    for (int c = 0; c < components; ++c)
    {
      const int number =
        numbers[static_cast<std::size_t>(f) * static_cast<std::size_t>(components) +
          static_cast<std::size_t>(c)];
      if (number >= 0)
      {
        this->CoarseOf[static_cast<std::size_t>(number)] =
          cells
            .try_emplace(cell << 2U | static_cast<std::uint64_t>(c), static_cast<int>(cells.size()))
            .first->second;
      }
    }
  }
  // entries between cells, added column by column
  std::unordered_map<std::uint64_t, double> entries;
  for (Eigen::Index j = 0; j < lower.cols(); ++j)
  {
    const int column = this->CoarseOf[static_cast<std::size_t>(j)];
    for (Eigen::SparseMatrix<double>::InnerIterator it(lower, j); it; ++it)
    {
      const int row = this->CoarseOf[static_cast<std::size_t>(it.row())];
      const bool twice = row == column && it.row() != j;
      entries[static_cast<std::uint64_t>(std::max(row, column)) << 32U |
        static_cast<std::uint64_t>(std::min(row, column))] += twice ? 2.0 * it.value() : it.value();
    }
  }
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(entries.size());
  for (const auto& entry : entries)
  {
    triplets.emplace_back(static_cast<int>(entry.first >> 32U),
      static_cast<int>(entry.first & 0xffffffffU), entry.second);
  }
  const auto count = static_cast<Eigen::Index>(cells.size());
  Eigen::SparseMatrix<double> coarse(count, count);
  coarse.setFromTriplets(triplets.begin(), triplets.end());
  this->HasCoarse = static_cast<bool>(this->Coarse.Factorize(coarse));
  this->Sums.resize(count, 1);
}

void TwoLevels::Apply(const UnknownColumns<1>& side, UnknownColumns<1>& x)
{

  this->Matrix.GaussSeidel(side, x);
  if (!this->HasCoarse)
  {
    return;
  }
  this->Sums.setZero();
  for (Eigen::Index i = 0; i < side.size(); ++i)
  {
    this->Sums(this->CoarseOf[static_cast<std::size_t>(i)], 0) += side[i];
  }
  this->Coarse.Solve(this->Sums);
  for (Eigen::Index i = 0; i < side.size(); ++i)
  {
    x[i] += this->Sums(this->CoarseOf[static_cast<std::size_t>(i)], 0);
  }
}
}
