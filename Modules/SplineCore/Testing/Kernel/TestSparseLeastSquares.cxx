// SPDX-License-Identifier: BSD-3-Clause
#include "LRCases.h"
#include <knotwork/SplineCore/LRStrategies.h>
#include <knotwork/SplineCore/Recovery.h>
#include <knotwork/SplineCore/SparseLeastSquares.h>

#include <Eigen/QR>
#include <algorithm>
#include <ctime>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A random matrix of a rank, in four of five entries 0 before its columns are combined.
Eigen::MatrixXd RandomMatrix(Random& random, int rows, int columns, int rank)
{
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, columns);
  for (int c = 0; c < rank; ++c)
  {
    matrix(c, c) = random.In(1.0, 2.0);
    for (int r = 0; r < rows; ++r)
    {
      matrix(r, c) += random.Unit() < 0.2 ? random.In(-1.0, 1.0) : 0.0;
    }
  }
  for (int c = rank; c < columns; ++c)
  {
    matrix.col(c) = random.In(-1.0, 1.0) * matrix.col(random.Int(0, rank - 1)) +
      random.In(-1.0, 1.0) * matrix.col(random.Int(0, rank - 1));
  }
  return matrix;
}

/// The solution of least norm by a dense complete orthogonal decomposition.
Eigen::MatrixXd Dense(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b)
{
  Eigen::VectorXd scale = a.colwise().norm();
  scale = (scale.array() > 0.0).select(scale.cwiseInverse(), 0.0);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(1e-10);
  decomposition.compute(a * scale.asDiagonal());
  return scale.asDiagonal() * decomposition.solve(b);
}

/// Cubic LR B-splines, refined along a circle, so often.
SplineSpacePtr<2> AlongCircle(int elements, int levels, LRStrategy strategy)
{
  const KnotVector knots = KnotVector::Uniform(3, elements);
  auto space = InsertSegments(MakeTensorSpace<2>({ knots, knots }).Value, {}, 0).Value;
  for (int l = 0; l < levels; ++l)
  {
    std::vector<int> marked;
    for (int e = 0; e < space->NumElements(); ++e)
    {
      const auto& box = space->Elements[e].Box;
      const double x = 0.5 * (box.Lower[0] + box.Upper[0]) - 0.5;
      const double y = 0.5 * (box.Lower[1] + box.Upper[1]) - 0.5;
      if (std::fabs(std::hypot(x, y) - 0.3) < box.Upper[0] - box.Lower[0])
      {
        marked.push_back(e);
      }
    }
    LRStrategyParams params;
    params.Strategy = strategy;
    space = InsertSegments(space, SegmentsForElements(*space, marked, params).Value, 0).Value;
  }
  return space;
}

/// The rows of T.
Matrix Extraction(const SplineSpace<2>& space)
{
  Matrix matrix(space.NumLocalFunctions, space.NumFunctions);
  for (int j = 0; j < space.NumLocalFunctions; ++j)
  {
    matrix.startVec(j);
    for (std::size_t k = space.RowStart[j]; k < space.RowStart[j + 1]; ++k)
    {
      matrix.insertBack(j, space.RowFunction[k]) = space.RowCoefficient[k];
    }
  }
  matrix.finalize();
  return matrix;
}
}

TEST(SparseLeastSquares, AnyRankAsByADenseDecomposition_CrossOracle)
{
  for (unsigned seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int columns = random.Int(1, 30);
    const int rank = random.Int(1, columns);
    Eigen::MatrixXd a = RandomMatrix(random, random.Int(rank, 60), columns, rank);
    a.col(random.Int(0, columns - 1)) *= 1e-3;
    Eigen::MatrixXd b(a.rows(), 2); // one in the range of A, one of full length
    b.col(0) = a * Eigen::VectorXd::Ones(columns);
    for (double& value : b.col(1))
    {
      value = random.In(-1.0, 1.0);
    }
    const Eigen::MatrixXd expected = Dense(a, b);
    const SparseSolution found = SolveSparseLeastSquares(a.sparseView(), b, 0);
    // conditions below 1e4, of the normal equations below 1e8
    for (int c = 0; c < 2; ++c)
    {
      EXPECT_LE((found.Value - expected).col(c).norm(), 1e-9 * (1.0 + expected.col(c).norm()));
    }
    EXPECT_LE((a * found.Value - b).col(0).norm(), 1e-13 * (1.0 + b.col(0).norm()));
  }
}

TEST(SparseLeastSquares, ZerosStayZero_ExactOracle)
{
  Matrix a(3, 3);
  a.insert(0, 0) = 2.0;
  a.insert(2, 2) = 0.0; // stored
  const Eigen::MatrixXd b = Eigen::Vector3d(6.0, 5.0, 4.0);
  const Eigen::MatrixXd x = SolveSparseLeastSquares(a, b, 0).Value;
  EXPECT_DOUBLE_EQ(x(0), 3.0);
  EXPECT_EQ(x(1), 0.0);
  EXPECT_EQ(x(2), 0.0);
  EXPECT_EQ(SolveSparseLeastSquares(Matrix(2, 3), Eigen::MatrixXd::Ones(2, 1), 0).Value,
    Eigen::MatrixXd::Zero(3, 1));
}

TEST(SparseLeastSquares, WorkGrowsWithTheFunctions_PropertyOracle)
{
  std::size_t entries[2];
  int functions[2];
  for (const int i : { 0, 1 })
  {
    const auto space = AlongCircle(i == 0 ? 16 : 32, 3, LRStrategy::FullSpan);
    const Matrix matrix = Extraction(*space);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(matrix.cols());
    const SparseSolution found = SolveSparseLeastSquares(matrix, matrix * ones, 0);
    EXPECT_LE((found.Value - ones).cwiseAbs().maxCoeff(), 1e-13); // rounding times a condition
    EXPECT_LE(found.Steps, 6);
    entries[i] = found.FactorEntries;
    functions[i] = space->NumFunctions;
  }
  // n log n; a band would be n^1.5, a dense factor n^2
  const double growth = 1.0 * functions[1] / functions[0];
  ASSERT_GT(growth, 2.0);
  EXPECT_LE(1.0 * entries[1] / entries[0], 1.25 * growth);
}

TEST(SparseLeastSquares, IndependentFunctionsTakeLinearTime_PropertyOracle)
{
  // Processor time of five times as many functions: 5 to 8 times as much, as caches and the
  // machine's other work have it; work beside the factor that grew with their square took 18 times
  // as much. The least of three runs is the one that was disturbed least.
  const auto seconds = [](int functions)
  {
    Matrix a(functions, functions);
    a.setIdentity();
    double least = 1e300;
    for (int run = 0; run < 3; ++run)
    {
      const std::clock_t start = std::clock();
      const SparseSolution found = SolveSparseLeastSquares(a, Eigen::VectorXd::Ones(functions), 1);
      least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
      EXPECT_TRUE(found.Value.isApproxToConstant(1.0));
    }
    return least;
  };
  const double few = seconds(400000);
  EXPECT_LE(seconds(2000000), 12.0 * few);
}

TEST(Recovery, FieldOfThousandsOfLocallyRefinedFunctions_ExactOracle)
{
  for (const auto strategy :
    { LRStrategy::FullSpan, LRStrategy::MinimumSpan, LRStrategy::StructuredMesh })
  {
    const auto space = AlongCircle(24, 3, strategy);
    ASSERT_GT(space->NumFunctions, 1500);
    Random random(2);
    const Spline<2> truth = RandomSpline<2>(random, space, 3, false);
    const auto result = RecoverField(MakeBezierForm(truth), {}, 0);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_LE(result.Residual, 64.0 * 2.3e-16 * result.Size);
    if (strategy != LRStrategy::MinimumSpan) // which may have dependent functions
    {
      EXPECT_LE((result.Value.ControlPoints - truth.ControlPoints).cwiseAbs().maxCoeff(), 1e-11);
    }
  }
}

TEST(Recovery, DependentLocallyRefinedFunctionsReproduceTheMap_ExactOracle)
{
  const Spline<2> truth = DependentSurface();
  const auto result = RecoverSpline(MakeBezierForm(truth), 0);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_LE(result.Residual, 64.0 * 2.3e-16 * result.Size);
  EXPECT_GT((result.Value.ControlPoints - truth.ControlPoints).cwiseAbs().maxCoeff(), 1e-3);
  // the least norm is one solution: what comes back comes back again
  const auto again = RecoverSpline(MakeBezierForm(result.Value), 0);
  ASSERT_TRUE(again) << again.Status.Message();
  EXPECT_LE((again.Value.ControlPoints - result.Value.ControlPoints).cwiseAbs().maxCoeff(), 1e-11);
}
