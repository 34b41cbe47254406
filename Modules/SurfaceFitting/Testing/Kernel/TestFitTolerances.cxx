// SPDX-License-Identifier: BSD-3-Clause
#include "CloudFits.h"

namespace knotwork
{
TEST(SurfaceFit, EveryPointHasItsTolerance_PropertyOracle)
{
  const PointCloud cloud = clouds::HeightField(20000, 6, clouds::Peaks);
  FitParams params = WithTolerance(0.02);
  const int loose = Fit(cloud, params).Surface.Space->NumFunctions;

  params.ToleranceBoxes = { { { { 0.5, 0.5 }, { 0.7, 0.7 } }, 0.002 },
    { { { 0.55, 0.55 }, { 0.6, 0.6 } }, 0.001 } };
  const SurfaceFit boxes = Fit(cloud, params);
  ExpectWithin(cloud, boxes);
  EXPECT_GT(boxes.Surface.Space->NumFunctions, loose);
  for (Eigen::Index i = 0; i < cloud.Parameters.rows(); ++i)
  {
    const double x = cloud.Parameters(i, 0);
    const double y = cloud.Parameters(i, 1);
    const bool outer = x >= 0.5 && x <= 0.7 && y >= 0.5 && y <= 0.7;
    const bool inner = x >= 0.55 && x <= 0.6 && y >= 0.55 && y <= 0.6;
    ASSERT_EQ(
      boxes.Tolerances[static_cast<std::size_t>(i)], inner ? 0.001 : (outer ? 0.002 : 0.02));
  }

  params.ToleranceBoxes.clear();
  params.Tolerance = 0.001;
  params.Distance = FitDistance::Point;
  params.DistanceSlope = 0.05;
  params.DistanceCentre = { 0.3, 0.8 };
  const SurfaceFit distance = Fit(cloud, params);
  ExpectWithin(cloud, distance);
  EXPECT_NEAR(distance.Tolerances[7],
    0.001 + 0.05 * std::hypot(cloud.Parameters(7, 0) - 0.3, cloud.Parameters(7, 1) - 0.8), 1e-15);

  params.Distance = FitDistance::Value;
  const SurfaceFit value = Fit(cloud, params);
  ExpectWithin(cloud, value);
  EXPECT_NEAR(value.Tolerances[7], 0.001 + 0.05 * std::fabs(cloud.Values(7, 0)), 1e-15);

  PointCloud own = cloud;
  own.Tolerances.setConstant(cloud.Values.rows(), 0.05);
  own.Tolerances[12] = 0.0005;
  const SurfaceFit points = Fit(own, WithTolerance(1.0));
  ExpectWithin(own, points);
  EXPECT_EQ(points.Tolerances[12], 0.0005);
  EXPECT_EQ(points.Tolerances[13], 0.05);
}

TEST(SurfaceFit, OneSidedSurfacesStayOnTheirSide_PropertyOracle)
{
  const PointCloud cloud = clouds::HeightField(20000, 8, clouds::Peaks);
  for (const FitSide side : { FitSide::Above, FitSide::Below })
  {
    const double sign = side == FitSide::Above ? 1.0 : -1.0;
    FitParams params = WithTolerance(0.005);
    params.Side = side;
    const SurfaceFit fit = Fit(cloud, params);
    ExpectWithin(cloud, fit);
    for (const double d : Measure(cloud, fit.Surface, 1))
    {
      ASSERT_LE(sign * d, 1e-14);
    }
    params.MaxIterations = 1; // far from the tolerance
    const SurfaceFit coarse = Fit(cloud, params);
    EXPECT_FALSE(coarse.WithinTolerance);
    for (const double d : Measure(cloud, coarse.Surface, 1))
    {
      ASSERT_LE(sign * d, -1e-15); // other evaluators round differently
    }
  }
}

TEST(SurfaceFit, OneSidedSurfacesWithTolerancesAtRandom_PropertyOracle)
{
  PointCloud cloud = clouds::HeightField(4000, 62, Wave);
  clouds::Random random(63);
  cloud.Tolerances.resize(cloud.Values.rows());
  for (double& tolerance : cloud.Tolerances)
  {
    tolerance = std::pow(10.0, -1.0 - 3.0 * random.Uniform()); // 1e-4 to 0.1
  }
  for (const FitSide side : { FitSide::Above, FitSide::Below })
  {
    FitParams params;
    params.Side = side;
    const SurfaceFit fit = Fit(cloud, params);
    ExpectWithin(cloud, fit);
    EXPECT_LT(fit.Final.NumFunctions, 4000);
    for (const double d : Measure(cloud, fit.Surface, 1))
    {
      ASSERT_LE(side == FitSide::Above ? d : -d, 0.0);
    }
  }
}

TEST(SurfaceFit, PointsAboveAndBelowHaveTolerancesOfTheirOwn_CrossOracle)
{
  clouds::Random random(61);
  PointCloud cloud = clouds::HeightField(20000, 62, clouds::Peaks);
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    // spikes upwards: within the tolerance above, not within the other one
    cloud.Values(i, 0) += random.Uniform() < 0.05 ? 0.015 * random.Uniform() : 0.0;
  }
  for (const bool isUp : { true, false })
  {
    for (const FitMethod method : { FitMethod::LeastSquares, FitMethod::MultilevelApproximation })
    {
      FitParams params = WithTolerance(0.01);
      params.Method = method;
      params.ToleranceFactorAbove = isUp ? 2.0 : 0.5;
      params.ToleranceFactorBelow = isUp ? 0.5 : 2.0;
      PointCloud own = cloud;
      own.Values *= isUp ? 1.0 : -1.0;
      const SurfaceFit fit = Fit(own, params);
      EXPECT_TRUE(fit.WithinTolerance);
      double high = 0.0;
      double low = 0.0;
      for (const double d : Measure(own, fit.Surface, 1))
      {
        high = std::max(high, isUp ? d : -d);
        low = std::max(low, isUp ? -d : d);
      }
      EXPECT_LE(high, 0.02 + 1e-13);
      EXPECT_LE(low, 0.005 + 1e-13);
      EXPECT_GT(high, 0.01); // what is allowed is used
      // each side within the smaller tolerance takes more functions
      FitParams narrow = WithTolerance(0.005);
      narrow.Method = method;
      EXPECT_GT(Fit(own, narrow).Final.NumFunctions, 2 * fit.Final.NumFunctions);
    }
  }
}

TEST(SurfaceFit, FactorsDecideWhatContradicts_ExactOracle)
{
  // two points in one place, 2.5 tolerances apart: a surface 1.5 to 2 tolerances below the one and
  // 0.5 to 1 above the other meets both
  PointCloud cloud = clouds::HeightField(1000, 63, [](double, double) { return 0.0; });
  cloud.Parameters.row(1) = cloud.Parameters.row(0);
  cloud.Values(1, 0) = 0.025;
  FitParams params = WithTolerance(0.01);
  EXPECT_EQ(Fit(cloud, params).End, FitEnd::Contradiction);
  params.ToleranceFactorAbove = 2.0;
  ExpectWithin(cloud, Fit(cloud, params));
  params.ToleranceFactorAbove = 1.4;
  EXPECT_EQ(Fit(cloud, params).End, FitEnd::Contradiction);
}

TEST(SurfaceFit, SignificantPointsHaveTheirOwnReport_CrossOracle)
{
  PointCloud cloud = clouds::HeightField(5000, 64, clouds::Peaks);
  cloud.Significant.assign(5000, 0);
  for (std::size_t i = 3; i < 5000; i += 7)
  {
    cloud.Significant[i] = 5;
  }
  for (const bool find : { false, true })
  {
    FitParams params = WithTolerance(0.001);
    params.MaxIterations = 2;
    params.FindOutliers = find;
    const SurfaceFit fit = Fit(cloud, params);
    const std::vector<double> distances = Measure(cloud, fit.Surface, 1);
    std::size_t count = 0;
    std::size_t outside = 0;
    double sum = 0.0;
    double most = 0.0;
    for (std::size_t i = 3; i < 5000; i += 7)
    {
      if (!find || fit.Outliers[i] == 0)
      {
        const double size = std::fabs(distances[i]);
        ++count;
        outside += size > 0.001 ? 1 : 0;
        sum += size;
        most = std::max(most, size);
      }
    }
    EXPECT_EQ(fit.Final.NumSignificant, count);
    EXPECT_EQ(fit.Final.NumSignificantOutside, outside);
    EXPECT_GT(outside, 0U);
    EXPECT_LT(outside, fit.Final.NumOutside);
    EXPECT_NEAR(fit.Final.MaxSignificantError, most, 1e-13);
    EXPECT_NEAR(fit.Final.MeanSignificantError, sum / static_cast<double>(count), 1e-13);
  }
}

TEST(SurfaceFit, SignificantPointsAreMetBetter_PropertyOracle)
{
  PointCloud cloud = clouds::HeightField(5000, 9, Wave);
  clouds::Random noise(10);
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    cloud.Values(i, 0) += 0.01 * noise.Normal();
  }
  FitParams params = WithTolerance(1e-6);
  params.MaxIterations = 0;
  params.SignificantWeight = 100.0;
  const auto sum = [&](const SurfaceFit& fit)
  {
    double squares = 0.0;
    for (std::size_t i = 0; i < 50; ++i)
    {
      squares += fit.Distances[i] * fit.Distances[i];
    }
    return squares;
  };
  const double before = sum(Fit(cloud, params));
  cloud.Significant.assign(5000, 0);
  std::fill_n(cloud.Significant.begin(), 50, std::uint8_t{ 1 });
  EXPECT_LT(sum(Fit(cloud, params)), 0.8 * before);
}

TEST(SurfaceFit, PointsApartAreAllMet_CrossOracle)
{
  // heights at random: functions of degree 2 cannot do with as many as there are points
  for (const int n : { 2, 6, 10, 500 })
  {
    PointCloud cloud = clouds::HeightField(n, 60, Wave);
    clouds::Random heights(61);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      cloud.Values(i, 0) = heights.Normal();
    }
    for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
    {
      SCOPED_TRACE(n);
      FitParams params = WithTolerance(0.001);
      params.Space = space;
      const SurfaceFit fit = Fit(cloud, params);
      ExpectWithin(cloud, fit);
      EXPECT_EQ(fit.End, FitEnd::Tolerance);
    }
  }
}

TEST(SurfaceFit, TolerancesFarApartAreMet_CrossOracle)
{
  // with a constant threshold, 30 iterations leave the cliff to the loose points for good
  const PointCloud all = clouds::TerrainCloud();
  PointCloud cloud;
  cloud.Parameters = all.Parameters.topRows(10000);
  cloud.Values = all.Values.topRows(10000);
  cloud.Tolerances.setConstant(10000, 0.1);
  for (Eigen::Index i = 0; i < 10000; i += 100)
  {
    cloud.Tolerances[i] = 1e-6;
  }
  const SurfaceFit fit = Fit(cloud, {});
  ExpectWithin(cloud, fit);
}

TEST(SurfaceFit, PointsThatContradictEachOtherAreLeft_CrossOracle)
{
  // ten pairs in the same place, 0.1 apart: no surface is nearer than 0.05 to both of a pair
  const PointCloud all = clouds::HeightField(20000, 38, Wave);
  PointCloud cloud = all;
  for (Eigen::Index i = 0; i < 10; ++i)
  {
    cloud.Parameters.row(i) = cloud.Parameters.row(10000 + i);
    cloud.Values(i, 0) = cloud.Values(10000 + i, 0) + 0.1;
  }
  const SurfaceFit fit = Fit(cloud, WithTolerance(0.001));
  EXPECT_FALSE(fit.WithinTolerance);
  EXPECT_EQ(fit.End, FitEnd::Contradiction);
  EXPECT_LT(fit.Iterations.size(), 20U);
  for (std::size_t i = 0; i < fit.Distances.size(); ++i)
  {
    if (i % 10000 >= 10)
    {
      ASSERT_LE(std::fabs(fit.Distances[i]), fit.Tolerances[i]) << "point " << i;
    }
  }
  EXPECT_GE(fit.Final.NumOutside, 10U);
  EXPECT_LE(fit.Final.NumOutside, 20U);
}

TEST(SurfaceFit, ElementsOfTheLeastSizeAreNoContradiction_ExactOracle)
{
  // heights at random, places mostly farther apart than the elements are large
  PointCloud cloud = clouds::HeightField(200, 64, Wave);
  clouds::Random heights(65);
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    cloud.Values(i, 0) = heights.Normal();
  }
  FitParams params = WithTolerance(0.001);
  params.MinElementSize = 0.1;
  const SurfaceFit fit = Fit(cloud, params);
  EXPECT_FALSE(fit.WithinTolerance);
  EXPECT_EQ(fit.End, FitEnd::Resolution);
}

TEST(SurfaceFit, OnlyPointsInOnePlaceContradict_ExactOracle)
{
  // two points 1e-4 apart with heights 0.1 apart, and no others nearby: smaller elements part them,
  // and all are met
  PointCloud pair = clouds::HeightField(20000, 66, Wave);
  for (Eigen::Index i = 0; i < pair.Values.rows(); ++i)
  {
    const double x = pair.Parameters(i, 0);
    const double y = pair.Parameters(i, 1);
    if (i < 2)
    {
      pair.Parameters.row(i) << 0.3 + 1e-4 * static_cast<double>(i), 0.3;
      pair.Values(i, 0) = Wave(0.3, 0.3) + 0.1 * static_cast<double>(i);
    }
    else if (std::hypot(x - 0.3, y - 0.3) < 0.03)
    {
      pair.Parameters.row(i) << 1.0 - x, 1.0 - y;
      pair.Values(i, 0) = Wave(1.0 - x, 1.0 - y);
    }
  }
  for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
  {
    FitParams params = WithTolerance(0.001);
    params.Space = space;
    params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
    params.MinElementSize = 1e-3; // both in one element of 1/512
    const SurfaceFit coarse = Fit(pair, params);
    EXPECT_FALSE(coarse.WithinTolerance);
    EXPECT_EQ(coarse.End, FitEnd::Resolution);
    params.MinElementSize = 1e-7;
    ExpectWithin(pair, Fit(pair, params));
  }
  // forty heights in each of two places: more points than are compared before a split
  PointCloud crowd = clouds::HeightField(2000, 67, Wave);
  for (Eigen::Index i = 0; i < 80; ++i)
  {
    crowd.Parameters.row(i) << (i < 40 ? 0.3 : 0.7), 0.4;
    crowd.Values(i, 0) = 0.1 * static_cast<double>(i % 40);
  }
  const SurfaceFit fit = Fit(crowd, WithTolerance(0.001));
  EXPECT_FALSE(fit.WithinTolerance);
  EXPECT_EQ(fit.End, FitEnd::Contradiction);
}

/// Every k-th point again, or all of them with the weight of as many copies.
PointCloud Repeated(const PointCloud& once, Eigen::Index every, bool isWeighted)
{
  const Eigen::Index n = once.Values.rows();
  PointCloud cloud = once;
  if (isWeighted)
  {
    cloud.Significant.assign(static_cast<std::size_t>(n), 0);
    for (Eigen::Index i = 0; i < n; i += every)
    {
      cloud.Significant[static_cast<std::size_t>(i)] = 1;
    }
    return cloud;
  }
  const Eigen::Index copies = (n + every - 1) / every;
  cloud.Parameters.conservativeResize(n + copies, Eigen::NoChange);
  cloud.Values.conservativeResize(n + copies, Eigen::NoChange);
  for (Eigen::Index i = 0; i < copies; ++i)
  {
    cloud.Parameters.row(n + i) = once.Parameters.row(i * every);
    cloud.Values.row(n + i) = once.Values.row(i * every);
  }
  return cloud;
}

TEST(SurfaceFit, PointsGivenTwiceEndAsPointsThatCountTwice_PropertyOracle)
{
  const auto cliff = [](double x, double y) { return Wave(x, y) + (x > 0.5 ? 1.0 : 0.0); };
  for (std::uint64_t seed = 81; seed < 84; ++seed)
  {
    PointCloud apart = clouds::HeightField(10000, seed, cliff);
    for (Eigen::Index i = 0; i < 100; ++i)
    {
      apart.Parameters(i, 0) = 0.5; // on the edge of the cliff
      apart.Values(i, 0) = cliff(0.5, apart.Parameters(i, 1));
    }
    PointCloud contradicting = apart;
    for (Eigen::Index i = 0; i < 10; ++i)
    {
      contradicting.Parameters.row(i) = apart.Parameters.row(1000 + i);
      contradicting.Values(i, 0) = apart.Values(1000 + i, 0) + 0.1;
    }
    struct Case
    {
      const PointCloud& Cloud;
      double MinElementSize;
      FitEnd End;
    };
    for (const Case& own :
      { Case{ apart, 1e-7, FitEnd::Tolerance }, Case{ apart, 0.01, FitEnd::Resolution },
        Case{ contradicting, 1e-7, FitEnd::Contradiction } })
    {
      for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
      {
        for (const bool isWeighted : { false, true })
        {
          SCOPED_TRACE("seed " + std::to_string(seed) + ", end " +
            std::to_string(static_cast<int>(own.End)) + ", weighted " + std::to_string(isWeighted));
          FitParams params = WithTolerance(0.0005);
          params.Space = space;
          params.SignificantWeight = 2.0;
          params.MinElementSize = own.MinElementSize;
          const SurfaceFit fit = Fit(Repeated(own.Cloud, 10, isWeighted), params);
          EXPECT_EQ(fit.WithinTolerance, own.End == FitEnd::Tolerance);
          EXPECT_EQ(fit.End, own.End) << fit.Final.NumOutside << " outside";
        }
      }
    }
  }
}

/// A million points of a smooth height field with a step of 400,000 tolerances, every hundredth of
/// them on its edge, and a tenth of all again, bit for bit.
TEST(SurfaceFit, StepsOfManyTolerancesAreMet_PropertyOracle)
{
  constexpr Eigen::Index Number = 1000000;
  for (const std::uint64_t seed : { 1, 3 })
  {
    clouds::Random random(seed);
    PointCloud cloud;
    cloud.Parameters.resize(Number + Number / 10, 2);
    cloud.Values.resize(Number + Number / 10, 1);
    for (Eigen::Index i = 0; i < Number; ++i)
    {
      double x = random.Uniform();
      const double y = random.Uniform();
      x = i % 100 == 0 ? 0.5 : x;
      cloud.Parameters.row(i) << x, y;
      cloud.Values(i, 0) = std::sin(6.0 * x) * std::cos(5.0 * y) + (x > 0.5 ? 200.0 : 0.0);
    }
    for (Eigen::Index i = Number; i < cloud.Values.rows(); ++i)
    {
      const auto again = static_cast<Eigen::Index>(random.Uniform() * static_cast<double>(Number));
      cloud.Parameters.row(i) = cloud.Parameters.row(again);
      cloud.Values.row(i) = cloud.Values.row(again);
    }
    FitParams params = WithTolerance(0.0005);
    params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
    const SurfaceFit fit = Fit(cloud, params);
    EXPECT_EQ(fit.End, FitEnd::Tolerance) << "seed " << seed;
    EXPECT_EQ(fit.Final.NumOutside, 0U) << "seed " << seed;
    ExpectWithin(cloud, fit);
  }
}

TEST(SurfaceFit, PointsGivenSeveralTimesAreMet_PropertyOracle)
{
  // a cliff, and a tenth of the points again: bit for bit, or as near as rounding of a file leaves
  // them, with equal heights
  for (std::uint64_t seed = 71; seed < 74; ++seed)
  {
    for (const auto& [n, tolerance] : { std::pair{ 5000, 0.005 }, std::pair{ 50000, 0.0005 } })
    {
      const double steps = seed == 71 ? 0.2 : 2.0;
      const PointCloud once = clouds::HeightField(static_cast<std::size_t>(n), seed,
        [&](double x, double y) { return Wave(x, y) + (x < 0.5 ? 0.0 : steps); });
      for (const int copies : { 1, 2 })
      {
        for (const double apart : { 0.0, 1e-12 })
        {
          SCOPED_TRACE("seed " + std::to_string(seed) + ", points " + std::to_string(n) +
            ", copies " + std::to_string(copies) + ", apart " + std::to_string(apart > 0.0));
          PointCloud cloud;
          cloud.Parameters.resize(n + copies * (n / 10), 2);
          cloud.Values.resize(cloud.Parameters.rows(), 1);
          clouds::Random random(seed);
          for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
          {
            const Eigen::Index from = i < n ? i : (i - n) % (n / 10) * 10;
            cloud.Parameters.row(i) = once.Parameters.row(from);
            cloud.Values.row(i) = once.Values.row(from);
            if (i >= n)
            {
              cloud.Parameters(i, 0) += apart * (random.Uniform() - 0.5);
              cloud.Parameters(i, 1) += apart * (random.Uniform() - 0.5);
            }
          }
          const SurfaceFit fit = Fit(cloud, WithTolerance(tolerance));
          ExpectWithin(cloud, fit);
        }
      }
    }
  }
}
}
