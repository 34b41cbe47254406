// SPDX-License-Identifier: BSD-3-Clause
#include "ThreadCases.h"
#include <knotwork/MeshParameterization/SparseCholesky.h>

#include <cmath>

namespace knotwork
{
namespace
{
/// Lower triangle of the Laplacian of a square grid of points, and 1 on the diagonal.
std::vector<Eigen::Triplet<double>> GridLaplacian(int side)
{
  std::vector<Eigen::Triplet<double>> lower;
  for (int j = 0; j < side; ++j)
  {
    for (int i = 0; i < side; ++i)
    {
      const int at = j * side + i;
      lower.emplace_back(at, at, 5.0);
      if (i > 0)
      {
        lower.emplace_back(at, at - 1, -1.0);
      }
      if (j > 0)
      {
        lower.emplace_back(at, at - side, -1.0);
      }
    }
  }
  return lower;
}

TEST(SparseCholesky, SolvesForAKnownSolution_ExactOracle)
{
  constexpr int side = 60;
  const Eigen::MatrixXd solution = Eigen::MatrixXd::NullaryExpr(side * side, 2,
    [](Eigen::Index i, Eigen::Index j) { return std::sin(0.7 * static_cast<double>(i + 3 * j)); });
  Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(side * side, 2);
  for (const Eigen::Triplet<double>& entry : GridLaplacian(side))
  {
    sides.row(entry.row()) += entry.value() * solution.row(entry.col());
    if (entry.row() != entry.col())
    {
      sides.row(entry.col()) += entry.value() * solution.row(entry.row());
    }
  }
  ASSERT_TRUE(SolvePositive(GridLaplacian(side), sides));
  EXPECT_LE((sides - solution).cwiseAbs().maxCoeff(), 1e-12); // condition 9
}

// Supernodes of thousands of rows, whose loops CHOLMOD would share among threads of OpenMP.
TEST(SparseCholesky, StaysInTheCallingThread_PropertyOracle)
{
  testing::ExpectOneThread(
    []
    {
      constexpr int side = 150;
      Eigen::MatrixXd sides = Eigen::MatrixXd::Ones(side * side, 1);
      return static_cast<bool>(SolvePositive(GridLaplacian(side), sides));
    });
}
}
}
