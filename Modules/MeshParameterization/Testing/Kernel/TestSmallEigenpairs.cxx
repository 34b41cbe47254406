// SPDX-License-Identifier: BSD-3-Clause
#include "HessianMatrix.h"
#include "MeshCases.h"
#include "MeshWeights.h"
#include "SmallEigenpairs.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
TEST(SmallEigenpairs, PathOfPointsHasCosines_ExactOracle)
{
  const int n = 60;
  Eigen::SparseMatrix<double> path(n, n);
  for (int i = 0; i < n; ++i)
  {
    path.insert(i, i) = i == 0 || i == n - 1 ? 1.0 : 2.0;
    if (i + 1 < n)
    {
      path.insert(i + 1, i) = -1.0;
    }
  }
  path.makeCompressed();
  const auto pairs = FindSmallEigenpairs(path, Eigen::VectorXd::Ones(n), 1e-4, 4);
  ASSERT_TRUE(pairs) << pairs.Status.Message();
  const double pi = std::acos(-1.0);
  for (int k = 1; k <= 4; ++k)
  {
    EXPECT_NEAR(pairs->Values[k - 1], 2.0 - 2.0 * std::cos(pi * k / n), 1e-12);
    for (int i = 0; i < n; ++i) // residual 1e-9 of the inverse, gaps of some 1e-3
    {
      const double cosine = std::sqrt(2.0 / n) * std::cos(pi * k * (i + 0.5) / n);
      EXPECT_NEAR(std::abs(pairs->Vectors(i, k - 1)), std::abs(cosine), 1e-8);
    }
  }
}

TEST(SmallEigenpairs, AgreeWithDenseSolver_CrossOracle)
{
  const auto disc = CheckMesh(Hill(0.12, 0.3).Mesh);
  ASSERT_TRUE(disc);
  const Eigen::SparseMatrix<double> matrix = HessianMatrix(disc.Value, 10, 1);
  const Eigen::VectorXd masses = VertexAreas(disc.Value);
  const auto pairs = FindSmallEigenpairs(matrix, masses, 1e-3, 3);
  ASSERT_TRUE(pairs);
  const Eigen::MatrixXd lower = matrix;
  const Eigen::MatrixXd full = lower.selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd diagonal = masses.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(full, diagonal);
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_NEAR(pairs->Values[k], dense.eigenvalues()[k + 1], 1e-9 * dense.eigenvalues()[4]);
  }
  const Eigen::MatrixXd gram = pairs->Vectors.transpose() * diagonal * pairs->Vectors;
  EXPECT_LE((gram - Eigen::MatrixXd::Identity(3, 3)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(HessianMatrix, LinearFunctionsOnThePlateHaveNoHessian_ExactOracle)
{
  const MeshCase plate = PlateWithHoles(0.06);
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  const Eigen::SparseMatrix<double> matrix = HessianMatrix(disc.Value, 12, 1);
  const Eigen::VectorXd linear = 3.0 * disc->Points.col(0) - 2.0 * disc->Points.col(1);
  const Eigen::VectorXd square = disc->Points.col(0).cwiseAbs2();
  const auto energy = [&](const Eigen::VectorXd& f)
  { return f.dot(matrix.selfadjointView<Eigen::Lower>() * f); };
  EXPECT_LE(std::abs(energy(linear)), 1e-10 * energy(square)); // rounding
}

TEST(HessianMatrix, DoesNotDependOnThreads_ExactOracle)
{
  const auto disc = CheckMesh(CylinderWithHoles(0.02).Mesh); // more than one chunk of 2048
  ASSERT_TRUE(disc);
  ASSERT_GT(disc->NumPoints(), 4096);
  const Eigen::SparseMatrix<double> one = HessianMatrix(disc.Value, 12, 1);
  const Eigen::SparseMatrix<double> many = HessianMatrix(disc.Value, 12, 4);
  ASSERT_EQ(one.nonZeros(), many.nonZeros());
  EXPECT_TRUE(std::equal(one.valuePtr(), one.valuePtr() + one.nonZeros(), many.valuePtr()));
}
}
}
