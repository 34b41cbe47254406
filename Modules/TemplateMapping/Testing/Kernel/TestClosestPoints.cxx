// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceCases.h"
#include "TemplateCases.h"
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/TemplateMapping/ClosestPoints.h>

#include <gtest/gtest.h>

#include <random>

using namespace knotwork;

namespace
{
template <int Dim = 2>
Spline<Dim> Identity(int elements)
{
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(3, elements));
  Spline<Dim> map;
  map.Space = MakeTensorSpace<Dim>(knots).Value;
  map.ControlPoints = GrevillePoints(*map.Space);
  return map;
}

template <int Dim = 2>
Spline<Dim> Wavy(unsigned seed)
{
  Spline<Dim> map = Identity<Dim>(6);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> real(-0.04, 0.04);
  map.ControlPoints +=
    PointMatrix::NullaryExpr(map.ControlPoints.rows(), Dim, [&] { return real(random); });
  return map;
}

PointMatrix Queries(int n, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> real(0.0, 1.0);
  return PointMatrix::NullaryExpr(n, 3, [&] { return real(random); });
}

MappedPatch<2> Patch(const PointMatrix& points, int samples, const SplineSpace<2>& space)
{
  return { { 0, points, {}, {}, {} }, samples, space };
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
    EXPECT_NEAR(found.Places(i), turns(i), 1.0 / n) << i;
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
    const PatchFeet again = patch.At(form, queries, found.Places, 2);
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
  EXPECT_EQ(found.Places(0), 0.0);
  EXPECT_EQ(found.Places(1), 1.0);
  EXPECT_NEAR(found.Places(2), (0.613 - 0.25) / 0.5, 1e-14); // one exact Newton step
}

TEST(TargetIndex, AgreesWithTryingAllSegments_CrossOracle)
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
    const TargetIndex<2> index({ 0, points, {}, {}, {} });
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

TEST(ClosestPointsOfSurfaces, UnderTheIdentityTheyAreThoseOfTheMesh_CrossOracle)
{
  // Coarse meshes of twelve or eight triangles with sharp edges: most samples are corners.
  const Spline<3> map = Identity<3>(4);
  const BezierForm<3> form = MakeBezierForm(map);
  for (const SkeletonPatch<3>& mesh : { cases::Cube(), cases::Sphere(0), cases::Plate(1) })
  {
    for (const int samples : { 0, 60 })
    {
      SCOPED_TRACE(std::to_string(mesh.Points.rows()) + " points, " + std::to_string(samples));
      MappedPatch<3> patch(mesh, samples, *map.Space);
      patch.Update(form, 2);
      const PointMatrix queries = Queries(500, 3);
      const TriangleIndex<3> index(mesh.Points, mesh.Simplices);
      const PatchFeet found = patch.Project(form, queries, PointMatrix(0, 3), 2, 2);
      for (int i = 0; i < queries.rows(); ++i)
      {
        EXPECT_NEAR(
          found.SquaredDistances(i), index.Nearest(queries.row(i).data()).SquaredDistance, 1e-14);
      }
    }
  }
}

TEST(ClosestPointsOfSurfaces, OnASphereTheyAreRadial_ExactOracle)
{
  // The map carries the sphere to an ellipsoid only through its control points: identity here.
  const Spline<3> map = Identity<3>(4);
  const BezierForm<3> form = MakeBezierForm(map);
  const SkeletonPatch<3> sphere = cases::Sphere(5);
  MappedPatch<3> patch(sphere, 0, *map.Space);
  patch.Update(form, 2);
  const PointMatrix queries = Queries(300, 4);
  const PatchFeet found = patch.Project(form, queries, PointMatrix(0, 3), 3, 2);
  for (int i = 0; i < queries.rows(); ++i)
  {
    const double radius = (queries.row(i) - Eigen::RowVector3d(0.5, 0.5, 0.5)).norm();
    // Chords of edges of at most 0.25 * 1.42 / 16 stay within edge^2 / (6 * 0.25) of the sphere.
    EXPECT_NEAR(std::sqrt(found.SquaredDistances(i)), std::abs(radius - 0.25), 4e-4) << i;
  }
}

TEST(ClosestPointsOfSurfaces, AreNoFartherThanAnyDenseSample_CrossOracle)
{
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Spline<3> map = Wavy<3>(seed);
    const BezierForm<3> form = MakeBezierForm(map);
    const SkeletonPatch<3> mesh = seed % 2 ? cases::Sphere(2) : cases::Cube();
    MappedPatch<3> patch(mesh, 100, *map.Space);
    patch.Update(form, 2);
    MappedPatch<3> fine(mesh, 60000, *map.Space);
    fine.Update(form, 2);
    const PointMatrix queries = Queries(60, seed);
    PointMatrix known(60, 3);
    for (int i = 0; i < 60; ++i)
    {
      known.row(i) << double(i % static_cast<int>(mesh.Simplices.size())), 0.3, 0.3;
    }
    Eigen::VectorXd before = patch.At(form, queries, known, 1).SquaredDistances;
    for (int steps = 0; steps <= 8; ++steps)
    {
      const PatchFeet found = patch.Project(form, queries, known, steps, 2);
      const PatchFeet again = patch.At(form, queries, found.Places, 2);
      for (int i = 0; i < 60; ++i)
      {
        const double nearest =
          (patch.MappedSamples().rowwise() - queries.row(i)).rowwise().squaredNorm().minCoeff();
        EXPECT_LE(found.SquaredDistances(i), nearest + 1e-15);
        EXPECT_LE(found.SquaredDistances(i), before(i)); // never worse
        EXPECT_NEAR(found.SquaredDistances(i), again.SquaredDistances(i), 1e-15);
        if (steps == 8)
        {
          // 60000 samples are at most 0.01 apart; the nearest is at most that off. From 100
          // samples, one of several local minima at the kinks of the mesh is found, not always the
          // smallest.
          const double dense =
            (fine.MappedSamples().rowwise() - queries.row(i)).rowwise().squaredNorm().minCoeff();
          EXPECT_LE(found.SquaredDistances(i), dense + 1e-4);
          EXPECT_GE(std::sqrt(found.SquaredDistances(i)), std::sqrt(dense) - 0.01);
        }
      }
      before = found.SquaredDistances;
    }
  }
}

TEST(ClosestPointsOfSurfaces, StepsEndAtRoundingOnAPlate_PropertyOracle)
{
  // A bent plate: the residual of a closest inner point is normal to the surface. The two triangles
  // meet without a kink, so nothing may end at their common edge only because it is one. The only
  // samples are the corners: steps are long.
  const Spline<3> map = Wavy<3>(7);
  const BezierForm<3> form = MakeBezierForm(map);
  MappedPatch<3> patch(cases::Plate(1), 0, *map.Space);
  patch.Update(form, 1);
  PointMatrix queries = Queries(400, 8);
  queries.col(2).array() = 0.5 + 0.02 * (queries.col(2).array() - 0.5);
  const PatchFeet found = patch.Project(form, queries, PointMatrix(0, 3), 60, 1);
  const PointMatrix at = patch.DomainPoints(found.Places);
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(form, at, { 1, 1 }, batch));
  int inner = 0;
  for (int i = 0; i < queries.rows(); ++i)
  {
    if (at.row(i).head<2>().minCoeff() > 0.2 + 1e-6 && at.row(i).head<2>().maxCoeff() < 0.8 - 1e-6)
    {
      ++inner;
      const Eigen::RowVector3d residual = queries.row(i) - found.Feet.row(i);
      // The plate's directions are x and y.
      EXPECT_LE(std::abs(residual.dot(batch.First.row(i).head(3))), 1e-8) << i;
      EXPECT_LE(std::abs(residual.dot(batch.First.row(i).segment(3, 3))), 1e-8) << i;
    }
  }
  EXPECT_GT(inner, 100);
}

TEST(ClosestPointsOfSurfaces, TwoStepsAreEnoughNearTheSurface_PropertyOracle)
{
  // Queries as in a fit: within 0.02 of a mesh of 2048 triangles. Two steps end where many do, over
  // the edges of triangles too.
  const Spline<3> map = Wavy<3>(11);
  const BezierForm<3> form = MakeBezierForm(map);
  MappedPatch<3> patch(cases::Sphere(4), 0, *map.Space);
  patch.Update(form, 2);
  const int n = 4000;
  PointMatrix queries = Queries(n, 12);
  queries = (queries.rowwise() - Eigen::RowVector3d(0.5, 0.5, 0.5)).rowwise().normalized() * 0.25;
  queries.rowwise() += Eigen::RowVector3d(0.5, 0.5, 0.5);
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(form, queries, { 0, 2 }, batch));
  queries = batch.Values + 0.02 * (Queries(n, 13) - PointMatrix::Constant(n, 3, 0.5));
  const PatchFeet two = patch.Project(form, queries, PointMatrix(0, 3), 2, 2);
  const PatchFeet many = patch.Project(form, queries, PointMatrix(0, 3), 20, 2);
  const Eigen::ArrayXd excess =
    two.SquaredDistances.cwiseSqrt() - many.SquaredDistances.cwiseSqrt();
  EXPECT_GE(excess.minCoeff(), 0.0);
  EXPECT_LE(excess.maxCoeff(), 1e-9);
}

TEST(ClosestPointsOfSurfaces, AreTheSameForAnyNumberOfThreads_PropertyOracle)
{
  const Spline<3> map = Wavy<3>(9);
  const BezierForm<3> form = MakeBezierForm(map);
  const PointMatrix queries = Queries(2000, 10);
  const auto run = [&](int threads)
  {
    MappedPatch<3> patch(cases::Sphere(3), 3000, *map.Space);
    patch.Update(form, threads);
    return patch.Project(form, queries, PointMatrix(0, 3), 3, threads);
  };
  const PatchFeet one = run(1);
  const PatchFeet four = run(4);
  EXPECT_EQ(one.Places, four.Places);
  EXPECT_EQ(one.Feet, four.Feet);
  EXPECT_EQ(one.SquaredDistances, four.SquaredDistances);
  const TargetIndex<3> index(cases::Sphere(3));
  EXPECT_EQ(index.SquaredDistances(queries, 1), index.SquaredDistances(queries, 4));
  EXPECT_EQ(index.LargestSquaredDistance(queries, 1), index.LargestSquaredDistance(queries, 4));
}

TEST(ClosestPoints, AnotherSpaceFindsTheSamplesAgain_ExactOracle)
{
  const Spline<3> coarse = Identity<3>(2);
  const Spline<3> fine = Identity<3>(7);
  MappedPatch<3> patch(cases::Sphere(2), 0, *coarse.Space);
  patch.Update(MakeBezierForm(coarse), 1);
  const PointMatrix before = patch.MappedSamples();
  patch.SetSpace(*fine.Space);
  EXPECT_EQ(patch.MappedSamples(), before);
  patch.Update(MakeBezierForm(fine), 1);
  EXPECT_LE((patch.MappedSamples() - before).cwiseAbs().maxCoeff(), 1e-15);
  const PointMatrix points = patch.DomainPoints(patch.SamplePlaces());
  EXPECT_LE((points - before).cwiseAbs().maxCoeff(), 1e-15);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    double local[3];
    EXPECT_EQ(patch.SampleElements()[static_cast<std::size_t>(i)],
      fine.Space->Locate(points.row(i).data(), local));
  }
}

TEST(TargetIndex, AgreesWithTryingAllTriangles_CrossOracle)
{
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(0.0, 1.0);
    SkeletonPatch<3> mesh = seed % 2 ? cases::Sphere(2) : cases::Plate(6);
    mesh.Points +=
      PointMatrix::NullaryExpr(mesh.Points.rows(), 3, [&] { return 0.05 * (real(random) - 0.5); });
    mesh.Points.row(3) = mesh.Points.row(4); // triangles without area
    const TargetIndex<3> index(mesh);
    const PointMatrix queries = Queries(1500, seed);
    const Eigen::VectorXd distances = index.SquaredDistances(queries, 2);
    for (int q = 0; q < queries.rows(); q += 7)
    {
      double nearest = std::numeric_limits<double>::infinity();
      for (const MeshTriangle& t : mesh.Simplices)
      {
        nearest = std::min(nearest,
          ClosestOnTriangle<3>(mesh.Points.row(t[0]).data(), mesh.Points.row(t[1]).data(),
            mesh.Points.row(t[2]).data(), queries.row(q).data())
            .SquaredDistance);
      }
      EXPECT_EQ(distances(q), nearest);
      EXPECT_EQ(index.Nearest(queries.row(q).data()).SquaredDistance, nearest);
    }
    EXPECT_EQ(index.LargestSquaredDistance(queries, 2), distances.maxCoeff());
    EXPECT_EQ(index.LargestSquaredDistance(queries, 1), distances.maxCoeff());
  }
}
