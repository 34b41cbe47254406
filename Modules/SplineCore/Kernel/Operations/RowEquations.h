// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SplineSpace.h"

namespace knotwork
{
/// Least squares for the functions that no functional determines alone: one equation a mixed row of
/// T that they appear in, (T P)_j = value_j, where value_j is a weighted mean of the local
/// coefficients found on the elements of the row.
class RowEquations
{
public:
  /// @param known  one flag a function: 0 for the functions to be found here.
  template <int Dim>
  RowEquations(const SplineSpace<Dim>& space, const std::vector<char>& known, int numComponents);

  bool IsEmpty() const { return this->Rows.empty(); }

  /// Number of the equation of a local function, or -1.
  int Equation(int localFunction) const
  {
    return this->Numbers.empty() ? -1 : this->Numbers[static_cast<std::size_t>(localFunction)];
  }

  /// Takes one observation (numComponents values) of a row with a positive weight.
  void Add(int equation, double weight, const double* values);

  /// Corrects the unknown rows of the coefficients, in place: the known rows stay, and of all
  /// least-squares solutions it takes the one nearest to the given values (after division by the
  /// functions' scale, in the norm of SparseLeastSquares.h), so zeros on input give the solution of
  /// minimum norm.
  /// @param scale  nullptr, or a positive number a function. @param threads  0 = all cores.
  void Solve(const Eigen::VectorXd* scale, PointMatrix& coefficients, int threads) const;

private:
  std::vector<int> Numbers;      ///< local function -> equation
  std::vector<int> Unknowns;     ///< function -> column, -1 for known ones and those in no row
  std::vector<int> Columns;      ///< column -> function
  std::vector<std::size_t> Rows; ///< equation -> first entry; one more than equations
  std::vector<int> Functions;
  std::vector<double> Entries;
  PointMatrix Sums; ///< weighted sums of the observations
  Eigen::VectorXd SumWeights;
};
}
