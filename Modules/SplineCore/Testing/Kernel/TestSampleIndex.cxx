// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/SampleIndex.h>

#include <gtest/gtest.h>

#include <random>

using namespace knotwork;

namespace
{
PointMatrix RandomPoints(int n, int d, std::mt19937& random)
{
  std::uniform_real_distribution<double> real(-1.0, 1.0);
  return PointMatrix::NullaryExpr(n, d, [&] { return real(random); });
}

NearestItem NearestByTrying(const PointMatrix& points, const double* p)
{
  NearestItem best;
  for (int i = 0; i < points.rows(); ++i)
  {
    double sum = 0.0;
    for (int d = 0; d < points.cols(); ++d)
    {
      sum += (points(i, d) - p[d]) * (points(i, d) - p[d]);
    }
    if (sum < best.SquaredDistance)
    {
      best = { i, sum };
    }
  }
  return best;
}

void ExpectAgreement(const SampleIndex& index, std::mt19937& random)
{
  const int d = static_cast<int>(index.Samples().cols());
  const PointMatrix queries = 1.5 * RandomPoints(50, d, random);
  for (int q = 0; q < queries.rows(); ++q)
  {
    const NearestItem found = index.Nearest(queries.row(q).data());
    const NearestItem expected = NearestByTrying(index.Samples(), queries.row(q).data());
    EXPECT_EQ(found.Item, expected.Item);
    EXPECT_EQ(found.SquaredDistance, expected.SquaredDistance);
  }
}
}

TEST(SampleIndex, AgreesWithTryingAllSamples_CrossOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (int d = 1; d <= 4; ++d)
    {
      for (int n : { 1, 2, 6, 7, 13, 100, 777 })
      {
        ExpectAgreement(SampleIndex(RandomPoints(n, d, random)), random);
      }
    }
  }
}

TEST(SampleIndex, AgreesAfterSamplesMoved_CrossOracle)
{
  std::mt19937 random(7);
  SampleIndex index(RandomPoints(500, 2, random));
  for (int move = 0; move < 5; ++move)
  {
    index.Move(index.Samples() + 0.3 * RandomPoints(500, 2, random));
    ExpectAgreement(index, random);
  }
  index.Move(RandomPoints(500, 2, random)); // nothing left of the old order
  ExpectAgreement(index, random);
}

TEST(SampleIndex, OfEquallyNearSamplesTheFirst_ExactOracle)
{
  PointMatrix points = PointMatrix::Zero(100, 2);
  points.col(0) = Eigen::VectorXd::NullaryExpr(100, [](auto i) { return double(i % 10); });
  const SampleIndex index(points);
  const double between[2] = { 4.5, 0.0 };
  EXPECT_EQ(index.Nearest(between).Item, 4);
  EXPECT_EQ(index.Nearest(between).SquaredDistance, 0.25);
}

TEST(SampleIndex, FindsNothingBeyondTheBoundOrWithoutSamples_ExactOracle)
{
  const double p[2] = { 0.0, 0.0 };
  EXPECT_EQ(SampleIndex(PointMatrix(0, 2)).Nearest(p).Item, -1);
  EXPECT_EQ(SampleIndex().Nearest(p).Item, -1);
  PointMatrix one(1, 2);
  one << 3.0, 4.0;
  const SampleIndex index(one);
  EXPECT_EQ(index.Nearest(p, 24.9).Item, -1);
  EXPECT_EQ(index.Nearest(p, 25.0).Item, 0);
}
