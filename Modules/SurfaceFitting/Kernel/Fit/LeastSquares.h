// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ElementFunctions.h"
#include "ElementMoments.h"
#include "FitDivision.h"

namespace knotwork
{
struct LeastSquaresParams
{
  double Smoothing = 1e-9;
  /// Coefficients whose functions meet few points, or points only with their tails, stay near what
  /// they are: their squared changes get weights. A function amid as many points as elsewhere in
  /// its support, at least one, changes freely.
  bool IsDamped = false;
  double Accuracy = 0.0; ///< of the coefficients, > 0
  int MaxIterations = 300;
  int Threads = 0;
};

/// The equations of the coefficients that minimize the weighted sum of squared distances plus a
/// thin-plate energy: Smoothing times the mean weight of the points of an element times the energy
/// of every element in its own parameters, so that it means the same on every level of refinement.
/// With damping, elements whose points weigh less than the mean have less energy, down to a
/// hundredth.
/// All sums have a fixed order. Of several processes each has some of the rows, and all have the
/// solution.
/// @source  damping: Levenberg, Quart. Appl. Math. 2 (1944) 164-168, by functions.
class LeastSquaresSystem
{
public:
  /// functions, moments and division must outlive the object.
  LeastSquaresSystem(const ElementFunctions& functions, const ElementMoments& moments,
    const IntArray<2>& degree, int numComponents, const FitDivision& division,
    const LeastSquaresParams& params);

  /// After the moments of some elements have changed.
  void Update(const std::vector<int>& elements);

  /// Conjugate gradients from the given coefficients on, scaled by the diagonal; they end early
  /// where a direction without curvature or what is not finite is met, with what was reached
  /// before.
  /// @param coefficients  NumFunctions x c. @param fixed  not 0 where a function's coefficients
  /// stay as they are; empty: nowhere.
  void Solve(PointMatrix& coefficients, const std::vector<std::uint8_t>& fixed = {}) const;

private:
  /// Consecutive rows of the matrix, made and used by themselves.
  struct RowGroup
  {
    std::vector<std::size_t> Start;
    std::vector<int> Columns;
    std::vector<double> Values;
  };

  bool IsOwnRow(int function) const
  {
    return static_cast<std::size_t>(function) >= this->FirstRow &&
      static_cast<std::size_t>(function) < this->EndRow;
  }
  /// Unless none of the rows meets it.
  void MakeElement(int e);
  void ShareRows();
  void FindColumns(std::size_t begin, std::size_t end);
  void FillRow(std::size_t function, std::vector<int>& places);
  void Multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  void SolveColumn(
    const Eigen::VectorXd& right, const Eigen::VectorXd& scale, Eigen::VectorXd& x) const;

  const ElementFunctions& Functions;
  const ElementMoments& Moments;
  const FitDivision& Division;
  LeastSquaresParams Params;
  int Components;
  std::vector<double> Energy;            ///< of an element, times Smoothing
  double MeanWeight = 0.0;               ///< of the points of an element
  std::vector<double> Weights;           ///< of the points of an element
  double PointDamping = 0.0;             ///< of every function
  double DampingShare = 0.0;             ///< of the weight in a function's support
  double SquaredPeak = 1.0;              ///< of a function that these numbers are for
  std::vector<std::size_t> ElementStart; ///< of an element's alive^2 numbers
  UntouchedVector<double> ElementMatrices;
  UntouchedVector<double> ElementRight; ///< an entry of ElementFunctions x components
  std::size_t GroupRows = 1;
  std::vector<std::size_t> Parts; ///< of the rows, one a process
  std::size_t FirstRow = 0;       ///< of the own ones
  std::size_t EndRow = 0;
  std::vector<RowGroup> Groups;
  Eigen::VectorXd Diagonal;
  Eigen::VectorXd Damping; ///< added to the diagonal of what changes
  PointMatrix Right;
};
}
