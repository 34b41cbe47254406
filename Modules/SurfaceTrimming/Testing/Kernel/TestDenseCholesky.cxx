// SPDX-License-Identifier: BSD-3-Clause
#include "DenseCholesky.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <random>

namespace knotwork
{
namespace
{
/// B B^T + 1, entries of B in [-1, 1].
Eigen::MatrixXd Definite(Eigen::Index n, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> entry(-1.0, 1.0);
  const Eigen::MatrixXd factor =
    Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index, Eigen::Index) { return entry(random); });
  return factor * factor.transpose() + Eigen::MatrixXd::Identity(n, n);
}

/// Sizes below, at and above those of panels and blocks, against Eigen's factorization: rounding of
/// sums of n products.
TEST(DenseCholesky, FactorsAndSolves_CrossOracle)
{
  for (const Eigen::Index n : { 1, 3, 4, 11, 12, 13, 95, 96, 97, 108, 193, 301 })
  {
    const Eigen::MatrixXd matrix = Definite(n, static_cast<unsigned>(n));
    const Eigen::MatrixXd expected = matrix.llt().matrixL();
    Eigen::MatrixXd factor = matrix.triangularView<Eigen::Lower>();
    ASSERT_TRUE(FactorInPlace(factor, 1)) << n;
    Eigen::MatrixXd lower = factor.triangularView<Eigen::Lower>();
    const double tolerance = 1e-13 * static_cast<double>(n) * matrix.diagonal().maxCoeff();
    EXPECT_LT((lower - expected).cwiseAbs().maxCoeff(), tolerance) << n;
    const Eigen::MatrixXd solution = Eigen::MatrixXd::Ones(n, 2);
    Eigen::MatrixXd b = matrix * solution;
    SolveFactored(factor, b);
    EXPECT_LT((b - solution).cwiseAbs().maxCoeff(), 1e-8) << n; // condition up to 1e5
    Eigen::MatrixXd threaded = matrix.triangularView<Eigen::Lower>();
    ASSERT_TRUE(FactorInPlace(threaded, 3));
    EXPECT_EQ(threaded, factor) << n;
  }
}

TEST(DenseCholesky, IndefiniteMatricesAreRefused_ExactOracle)
{
  Eigen::MatrixXd matrix = Definite(200, 1);
  matrix(150, 150) = -1.0;
  EXPECT_FALSE(FactorInPlace(matrix, 1));
}
}
}
