// SPDX-License-Identifier: BSD-3-Clause
#include "ClosestPoints.h"
#include "TemplateCases.h"
#include "TensorSpace.h"

#include <gtest/gtest.h>

#include <random>

using namespace knotwork;

namespace
{
Spline<2> Identity(int elements)
{
  const KnotVector knots = KnotVector::Uniform(3, elements);
  Spline<2> map;
  map.Space = MakeTensorSpace<2>({ knots, knots }).Value;
  map.ControlPoints = GrevillePoints(*map.Space);
  return map;
}

Spline<2> Wavy(unsigned seed)
{
  Spline<2> map = Identity(6);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> real(-0.04, 0.04);
  map.ControlPoints +=
    PointMatrix::NullaryExpr(map.ControlPoints.rows(), 2, [&] { return real(random); });
  return map;
}

MappedPatch<2> Patch(const PointMatrix& points, int samples, const SplineSpace<2>& space)
{
  const PatchCurve curve(points, Eigen::VectorXd::LinSpaced(points.rows(), 0.0, 1.0));
  return { curve, curve.SampleParameters(samples), space };
}

PointMatrix Circle(int n)
{
  return cases::CircleTemplate(n)[4].Points;
}
}

TEST(ClosestPoints, OnACircleTheyAreRadial_ExactOracle)
{
  const Spline<2> map = Identity(4);
  const BezierForm<2> form = MakeBezierForm(map);
  const int n = 100001;
  MappedPatch<2> patch = Patch(Circle(n), 51, *map.Space);
  patch.Update(form, 1);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> real(0.0, 1.0);
  PointMatrix queries(200, 2);
  Eigen::VectorXd turns(200);
  Eigen::VectorXd radii(200);
  for (int i = 0; i < 200; ++i)
  {
    turns(i) = real(random);
    radii(i) = 0.15 + 0.2 * real(random);
    queries.row(i) << 0.5 + radii(i) * std::cos(2 * cases::Pi * turns(i)),
      0.5 + radii(i) * std::sin(2 * cases::Pi * turns(i));
  }
  const PatchFeet found = patch.Project(form, queries, Eigen::VectorXd::Constant(200, 0.5), 15, 1);
  // The polygon's chords stay within 0.25 (1 - cos(pi / n)) of the circle; its nearest points lie
  // within half a chord of the radial one. Without the curvature in the step the error falls by
  // |r - 0.25| / 0.25 <= 0.4 a step: 15 steps from a seed within 1/100 turn are enough.
  for (int i = 0; i < 200; ++i)
  {
    EXPECT_NEAR(found.Parameters(i), turns(i), 1.0 / n) << i;
    EXPECT_NEAR(std::sqrt(found.SquaredDistances(i)), std::abs(radii(i) - 0.25), 1e-9) << i;
  }
}

TEST(ClosestPoints, AreNoFartherThanAnyDenseSample_CrossOracle)
{
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Spline<2> map = Wavy(seed);
    const BezierForm<2> form = MakeBezierForm(map);
    MappedPatch<2> patch = Patch(Circle(20001), 0, *map.Space);
    patch.Update(form, 2);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(0.0, 1.0);
    const PointMatrix queries = PointMatrix::NullaryExpr(40, 2, [&] { return real(random); });
    const Eigen::VectorXd known = Eigen::VectorXd::NullaryExpr(40, [&] { return real(random); });
    const PatchFeet seeds = patch.Project(form, queries, known, 0, 2);
    const PatchFeet found = patch.Project(form, queries, known, 4, 2);
    const PatchFeet again = patch.At(form, queries, found.Parameters, 2);
    for (int i = 0; i < 40; ++i)
    {
      const double nearest =
        (patch.MappedSamples().rowwise() - queries.row(i)).rowwise().squaredNorm().minCoeff();
      EXPECT_LE(seeds.SquaredDistances(i), nearest + 1e-15);
      EXPECT_LE(found.SquaredDistances(i), seeds.SquaredDistances(i));
      // Where the nearest point is interior and the map smooth, Newton reaches it: no sample of a
      // spacing of 1e-4 may undercut the seed by more than the square of that spacing.
      EXPECT_NEAR(found.SquaredDistances(i), nearest, 1e-6);
      EXPECT_NEAR(found.SquaredDistances(i), again.SquaredDistances(i), 1e-15);
      EXPECT_LE((found.Feet.row(i) - again.Feet.row(i)).norm(), 1e-15);
    }
  }
}

TEST(ClosestPoints, StayOnThePatch_PropertyOracle)
{
  const Spline<2> map = Identity(4);
  const BezierForm<2> form = MakeBezierForm(map);
  PointMatrix line(2, 2);
  line << 0.25, 0.5, 0.75, 0.5;
  MappedPatch<2> patch = Patch(line, 11, *map.Space);
  patch.Update(form, 1);
  PointMatrix queries(3, 2);
  queries << -3.0, 0.5, 9.0, 7.0, 0.613, 0.9;
  const PatchFeet found = patch.Project(form, queries, Eigen::Vector3d(0.4, 0.4, 0.4), 2, 1);
  EXPECT_EQ(found.Parameters(0), 0.0);
  EXPECT_EQ(found.Parameters(1), 1.0);
  EXPECT_NEAR(found.Parameters(2), (0.613 - 0.25) / 0.5, 1e-14); // one exact Newton step
}

TEST(PolylineIndex, AgreesWithTryingAllSegments_CrossOracle)
{
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(0.0, 1.0);
    const int n = 2 + static_cast<int>(seed * 17);
    PointMatrix points = PointMatrix::NullaryExpr(n, 2, [&] { return real(random); });
    if (seed % 2)
    {
      points.row(n / 2) = points.row(n / 2 - 1); // a segment of no length
    }
    const PolylineIndex<2> index(points);
    const PointMatrix queries = PointMatrix::NullaryExpr(3000, 2, [&] { return real(random); });
    const Eigen::VectorXd distances = index.SquaredDistances(queries, 2);
    for (int q = 0; q < queries.rows(); q += 7)
    {
      double nearest = 1e300;
      for (int s = 0; s + 1 < n; ++s)
      {
        const Eigen::RowVector2d a = points.row(s);
        const Eigen::RowVector2d d = points.row(s + 1) - points.row(s);
        const double t = d.squaredNorm() > 0
          ? std::min(std::max((queries.row(q) - a).dot(d) / d.squaredNorm(), 0.0), 1.0)
          : 0.0;
        nearest = std::min(nearest, (queries.row(q) - a - t * d).squaredNorm());
      }
      EXPECT_NEAR(distances(q), nearest, 1e-15); // rounding at unit size
    }
    EXPECT_EQ(index.LargestSquaredDistance(queries, 2), distances.maxCoeff());
    EXPECT_EQ(index.LargestSquaredDistance(queries, 1), distances.maxCoeff());
  }
}
