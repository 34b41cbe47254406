// SPDX-License-Identifier: BSD-3-Clause
#include "RowEquations.h"

#include "SparseLeastSquares.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
template <int Dim>
RowEquations::RowEquations(
  const SplineSpace<Dim>& space, const std::vector<char>& known, int numComponents)
{
  if (space.IsIdentityMap() || std::find(known.begin(), known.end(), 0) == known.end())
  {
    return;
  }
  this->Numbers.assign(static_cast<std::size_t>(space.NumLocalFunctions), -1);
  this->Unknowns.assign(known.size(), -1);
  int equations = 0;
  for (std::size_t j = 0; j + 1 < space.RowStart.size(); ++j)
  {
    const auto begin = space.RowFunction.begin() + static_cast<std::ptrdiff_t>(space.RowStart[j]);
    const auto end = space.RowFunction.begin() + static_cast<std::ptrdiff_t>(space.RowStart[j + 1]);
    if (std::all_of(begin, end, [&](int f) { return known[static_cast<std::size_t>(f)] != 0; }))
    {
      continue;
    }
    this->Numbers[j] = equations++;
    this->Rows.push_back(this->Functions.size());
    this->Functions.insert(this->Functions.end(), begin, end);
    this->Entries.insert(this->Entries.end(),
      space.RowCoefficient.begin() + static_cast<std::ptrdiff_t>(space.RowStart[j]),
      space.RowCoefficient.begin() + static_cast<std::ptrdiff_t>(space.RowStart[j + 1]));
    for (auto f = begin; f != end; ++f)
    {
      int& column = this->Unknowns[static_cast<std::size_t>(*f)];
      if (column < 0 && !known[static_cast<std::size_t>(*f)])
      {
        column = static_cast<int>(this->Columns.size());
        this->Columns.push_back(*f);
      }
    }
  }
  if (equations > 0)
  {
    this->Rows.push_back(this->Functions.size());
  }
  this->Sums = PointMatrix::Zero(equations, numComponents);
  this->SumWeights = Eigen::VectorXd::Zero(equations);
}

void RowEquations::Add(int equation, double weight, const double* values)
{
  this->SumWeights[equation] += weight;
  for (Eigen::Index c = 0; c < this->Sums.cols(); ++c)
  {
    this->Sums(equation, c) += weight * values[c];
  }
}

void RowEquations::Solve(const Eigen::VectorXd* scale, PointMatrix& coefficients, int threads) const
{
  if (this->IsEmpty())
  {
    return;
  }
  const auto equations = static_cast<Eigen::Index>(this->Rows.size()) - 1;
  const auto unknowns = static_cast<Eigen::Index>(this->Columns.size());
  const auto scaleOf = [&](int f) { return scale ? (*scale)[f] : 1.0; };
  std::vector<Eigen::Triplet<double>> triplets;
  Eigen::MatrixXd rightSide = Eigen::MatrixXd::Zero(equations, coefficients.cols());
  for (Eigen::Index j = 0; j < equations; ++j)
  {
    const double weight = this->SumWeights[j];
    if (!(weight > 0.0))
    {
      continue;
    }
    const double root = std::sqrt(weight);
    rightSide.row(j) = this->Sums.row(j) / weight;
    for (std::size_t k = this->Rows[static_cast<std::size_t>(j)];
         k < this->Rows[static_cast<std::size_t>(j) + 1]; ++k)
    {
      const int f = this->Functions[k];
      rightSide.row(j) -= this->Entries[k] * coefficients.row(f);
      const int column = this->Unknowns[static_cast<std::size_t>(f)];
      if (column >= 0)
      {
        triplets.emplace_back(static_cast<int>(j), column, root * this->Entries[k] * scaleOf(f));
      }
    }
    rightSide.row(j) *= root;
  }
  if (triplets.empty())
  {
    return;
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> a(equations, unknowns);
  a.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::MatrixXd change = SolveSparseLeastSquares(a, rightSide, threads).Value;
  for (Eigen::Index u = 0; u < unknowns; ++u)
  {
    const int f = this->Columns[static_cast<std::size_t>(u)];
    coefficients.row(f) += scaleOf(f) * change.row(u);
  }
}

template RowEquations::RowEquations(const SplineSpace<1>&, const std::vector<char>&, int);
template RowEquations::RowEquations(const SplineSpace<2>&, const std::vector<char>&, int);
template RowEquations::RowEquations(const SplineSpace<3>&, const std::vector<char>&, int);
}
