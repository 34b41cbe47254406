// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/ClosestPoint.h>
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{
using namespace knotwork;

template <int Dim>
std::vector<BezierForm<Dim>> Forms(ShapeKind kind, double angle = 360.0)
{
  ShapeParams params;
  params.Kind = kind;
  params.Angle = angle;
  const auto shape = MakeShape(params);
  EXPECT_TRUE(shape) << shape.Status.Message();
  std::vector<BezierForm<Dim>> forms;
  for (const AnySpline& patch : shape.Value)
  {
    forms.push_back(MakeBezierForm<Dim>(std::get<Spline<Dim>>(patch), 1));
  }
  return forms;
}

PointMatrix Random(int rows, int columns, unsigned seed, double size)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> real(-size, size);
  return PointMatrix::NullaryExpr(
    rows, columns, [&](Eigen::Index, Eigen::Index) { return real(random); });
}

template <int Dim>
ClosestPoints Find(
  const std::vector<BezierForm<Dim>>& forms, const PointMatrix& queries, int samples = 0)
{
  ClosestPointParams params;
  params.Samples = samples;
  const auto search = ClosestPointSearch<Dim>::Create(forms, params);
  EXPECT_TRUE(search) << search.Status.Message();
  ClosestPoints found;
  const Status status = search.Value.Find(queries, found);
  EXPECT_TRUE(status) << status.Message();
  return found;
}

/// The reported point is the map at the reported place, and the distance is to it.
template <int Dim>
void ExpectConsistent(
  const std::vector<BezierForm<Dim>>& forms, const PointMatrix& queries, const ClosestPoints& found)
{
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    const auto k = std::size_t(i);
    EvaluationBatch batch;
    ASSERT_TRUE(EvaluateElements<Dim>(
      forms[std::size_t(found.Patches[k])], { found.Elements[k] }, found.Local.row(i), {}, batch));
    EXPECT_LE((batch.Values.row(0) - found.Points.row(i)).norm(), 1e-14);
    EXPECT_NEAR((queries.row(i) - found.Points.row(i)).norm(), found.Distances[i], 1e-14);
  }
}
// Newton stops when the squared distance no longer falls in double precision; then the distance is
// exact to about 1e-15 and, away from distance 0, the place to about the square root of that.
constexpr double DistanceTolerance = 1e-12;
}

TEST(ClosestPoint, CircleSphereAndTorus_ExactOracle)
{
  const PointMatrix queries = Random(300, 3, 1, 2.0);
  const auto circle = Forms<1>(ShapeKind::Arc);
  const auto sphere = Forms<2>(ShapeKind::SphereSurface);
  const auto torus = Forms<2>(ShapeKind::TorusSurface); // radii 1 and 0.5
  const ClosestPoints onCircle = Find<1>(circle, queries);
  const ClosestPoints onSphere = Find<2>(sphere, queries);
  const ClosestPoints onTorus = Find<2>(torus, queries);
  ExpectConsistent<1>(circle, queries, onCircle);
  ExpectConsistent<2>(sphere, queries, onSphere);
  ExpectConsistent<2>(torus, queries, onTorus);
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    const double x = queries(i, 0);
    const double y = queries(i, 1);
    const double z = queries(i, 2);
    const double ring = std::hypot(std::hypot(x, y) - 1.0, z);
    EXPECT_NEAR(onCircle.Distances[i], ring, DistanceTolerance);
    EXPECT_NEAR(onSphere.Distances[i], std::abs(queries.row(i).norm() - 1.0), DistanceTolerance);
    EXPECT_NEAR(onTorus.Distances[i], std::abs(ring - 0.5), DistanceTolerance);
  }
}

TEST(ClosestPoint, InvertsPlanarAndSolidMaps_ExactOracle)
{
  // Planar: two components, so that the map is R^2 -> R^2.
  for (BezierForm<2>& form : Forms<2>(ShapeKind::Disc))
  {
    BezierForm<2> planar = form;
    planar.NumComponents = 2;
    planar.Data.clear();
    planar.Offsets.assign(1, 0);
    for (int e = 0; e < form.Space->NumElements(); ++e)
    {
      const auto n = (form.Offsets[std::size_t(e) + 1] - form.Offsets[std::size_t(e)]) /
        std::size_t(form.NumPlanes());
      const double* block = form.Block(e);
      planar.Data.insert(planar.Data.end(), block, block + 2 * n);
      if (form.Rational)
      {
        planar.Data.insert(planar.Data.end(), block + 3 * n, block + 4 * n);
      }
      planar.Offsets.push_back(planar.Data.size());
    }
    const PointMatrix local = (Random(50, 2, 5, 0.5).array() + 0.5).matrix();
    EvaluationBatch batch;
    ASSERT_TRUE(EvaluateElements<2>(planar, std::vector<int>(50, 0), local, {}, batch));
    const ClosestPoints found = Find<2>({ planar }, batch.Values);
    EXPECT_LE(found.Distances.maxCoeff(), 1e-15);
    EXPECT_LE((found.Local - local).cwiseAbs().maxCoeff(), 1e-13);
  }
  const auto bar = Forms<3>(ShapeKind::TwistedBar);
  const PointMatrix local = (Random(50, 3, 7, 0.5).array() + 0.5).matrix();
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateElements<3>(bar[0], std::vector<int>(50, 0), local, {}, batch));
  const ClosestPoints found = Find<3>(bar, batch.Values);
  EXPECT_LE(found.Distances.maxCoeff(), 1e-15);
  EXPECT_LE((found.Local - local).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(ClosestPoint, NeverWorseThanDenseSamples_CrossOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Spline<2> spline;
    spline.Space =
      MakeTensorSpace<2>({ KnotVector::Uniform(3, 3), KnotVector::Uniform(2, 4) }).Value;
    spline.ControlPoints = Random(spline.Space->NumFunctions, 3, seed, 1.0);
    const BezierForm<2> form = MakeBezierForm<2>(spline, 1);
    const PointMatrix queries = Random(20, 3, 100 + seed, 1.5);
    // Random control points: elements with several local minima need samples between them.
    const ClosestPoints found = Find<2>({ form }, queries, 10);
    ExpectConsistent<2>({ form }, queries, found);
    const int n = 200;
    PointMatrix dense((n + 1) * (n + 1), 2);
    for (int i = 0; i <= n; ++i)
    {
      for (int j = 0; j <= n; ++j)
      {
        dense.row(i * (n + 1) + j) << double(i) / n, double(j) / n;
      }
    }
    EvaluationBatch batch;
    ASSERT_TRUE(EvaluateParameters<2>(form, dense, {}, batch));
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
    {
      const double best =
        std::sqrt((batch.Values.rowwise() - queries.row(i)).rowwise().squaredNorm().minCoeff());
      EXPECT_LE(found.Distances[i], best + 1e-14);
    }
  }
}

TEST(ClosestPoint, ThreadsGiveTheSameBits_PropertyOracle)
{
  const auto torus = Forms<2>(ShapeKind::TorusSurface);
  const PointMatrix queries = Random(500, 3, 3, 2.0);
  std::array<ClosestPoints, 2> found;
  for (int threads = 1; threads <= 2; ++threads)
  {
    ClosestPointParams params;
    params.Threads = threads;
    const auto search = ClosestPointSearch<2>::Create(torus, params);
    ASSERT_TRUE(search);
    ASSERT_TRUE(search.Value.Find(queries, found[std::size_t(threads - 1)]));
  }
  EXPECT_EQ(found[0].Local, found[1].Local);
  EXPECT_EQ(found[0].Elements, found[1].Elements);
  EXPECT_EQ(found[0].Distances, found[1].Distances);
}

TEST(ClosestPoint, EveryFailureIsReachable)
{
  const auto disc = Forms<2>(ShapeKind::Disc);
  EXPECT_EQ(ClosestPointSearch<2>::Create({}).Status.Code, ErrorCode::EmptyInput);
  ClosestPointParams params;
  params.Samples = 1;
  EXPECT_EQ(ClosestPointSearch<2>::Create(disc, params).Status.Code, ErrorCode::InvalidParameter);
  params.Samples = 0;
  params.MaxIterations = -1;
  EXPECT_EQ(ClosestPointSearch<2>::Create(disc, params).Status.Code, ErrorCode::InvalidParameter);
  auto broken = disc;
  broken[0].Data[0] = NAN;
  EXPECT_EQ(ClosestPointSearch<2>::Create(broken).Status.Code, ErrorCode::NonFiniteInput);
  broken = disc;
  broken[1].NumComponents = 5;
  EXPECT_EQ(ClosestPointSearch<2>::Create(broken).Status.Code, ErrorCode::SizeMismatch);

  const auto search = ClosestPointSearch<2>::Create(disc);
  ASSERT_TRUE(search);
  ClosestPoints found;
  EXPECT_EQ(search.Value.Find(PointMatrix::Zero(3, 2), found).Code, ErrorCode::SizeMismatch);
  PointMatrix queries = PointMatrix::Zero(3, 3);
  queries(2, 1) = INFINITY;
  const Status status = search.Value.Find(queries, found);
  EXPECT_EQ(status.Code, ErrorCode::NonFiniteInput);
  EXPECT_NE(status.Detail.find("2"), std::string::npos);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(
    ClosestPointSearch<2>::Create(disc, params).Value.Find(PointMatrix::Zero(3, 3), found).Code,
    ErrorCode::Aborted);
}
