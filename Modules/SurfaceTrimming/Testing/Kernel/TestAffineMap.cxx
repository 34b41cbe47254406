// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SurfaceTrimming/AffineMap.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace knotwork;

namespace
{
PointMatrix RandomPoints(std::mt19937& random, int rows, int cols)
{
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  return PointMatrix::NullaryExpr(rows, cols, [&] { return value(random); });
}
}

TEST(AffineMap, AffineImagesAreMet_ExactOracle)
{
  std::mt19937 random(1);
  for (int dimension = 0; dimension <= 3; ++dimension) // of the set of points
  {
    for (int seed = 0; seed < 20; ++seed)
    {
      SCOPED_TRACE(std::to_string(dimension) + ", " + std::to_string(seed));
      const PointMatrix linear = RandomPoints(random, 3, 3);
      const PointMatrix shift = 5.0 * RandomPoints(random, 1, 3);
      const PointMatrix frame = RandomPoints(random, dimension, 3);
      const PointMatrix origin = RandomPoints(random, 1, 3);
      const auto points = [&](int rows) -> PointMatrix
      { return (RandomPoints(random, rows, dimension) * frame).rowwise() + origin.row(0); };
      const PointMatrix from = points(30);
      const PointMatrix others = points(10);
      const auto image = [&](const PointMatrix& x) -> PointMatrix
      { return (x * linear).rowwise() + shift.row(0); };
      const auto map = FitAffineMap(from, image(from));
      ASSERT_TRUE(map) << map.Status.Message();
      // coordinates below 10, frames of random vectors are seldom worse conditioned than 1e4
      const double tolerance = 1e4 * 64 * 10 * std::numeric_limits<double>::epsilon();
      EXPECT_LE(map->MaxResidual, tolerance);
      EXPECT_LE((map->Apply(others) - image(others)).cwiseAbs().maxCoeff(), tolerance);
    }
  }
}

TEST(AffineMap, WhatIsNotAffineIsMeasured_ExactOracle)
{
  // the corners of a square, one lifted by 1: the best plane misses each by 1/4
  PointMatrix from(4, 3);
  from << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0;
  PointMatrix to = from;
  to(3, 2) = 1.0;
  const auto map = FitAffineMap(from, to);
  ASSERT_TRUE(map);
  EXPECT_NEAR(map->MaxResidual, 0.25, 64 * std::numeric_limits<double>::epsilon());
}

TEST(AffineMap, EveryFailureIsReachable)
{
  const PointMatrix three = PointMatrix::Ones(2, 3);
  EXPECT_EQ(FitAffineMap(three, PointMatrix::Ones(3, 3)).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(FitAffineMap(PointMatrix::Ones(2, 2), three).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(FitAffineMap(PointMatrix(0, 3), PointMatrix(0, 3)).Status.Code, ErrorCode::EmptyInput);
  const PointMatrix bad = PointMatrix::Constant(2, 3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(FitAffineMap(three, bad).Status.Code, ErrorCode::NonFiniteInput);
}
