// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/Composition.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace
{
using namespace knotwork;

template <int Dim>
std::vector<Spline<Dim>> Shape(ShapeKind kind, int degree, std::array<int, 3> elements)
{
  ShapeParams params;
  params.Kind = kind;
  params.Degree = degree;
  params.Elements = elements;
  params.Angle = 90.0;
  const auto shape = MakeShape(params);
  EXPECT_TRUE(shape) << shape.Status.Message();
  std::vector<Spline<Dim>> patches;
  for (const AnySpline& patch : shape.Value)
  {
    patches.push_back(std::get<Spline<Dim>>(patch));
  }
  return patches;
}

/// Any smooth map of space.
Status Wave(const PointMatrix& points, PointMatrix& values)
{
  values.resize(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const double x = points(i, 0);
    const double y = points(i, 1);
    const double z = points(i, 2);
    values.row(i) << x + 0.2 * std::sin(3.0 * y + z), y + 0.2 * std::cos(2.0 * x), z + 0.1 * x * y;
  }
  return {};
}

/// An affine map: every spline space of degree >= 1 holds its compositions.
Status Affine(const PointMatrix& points, PointMatrix& values)
{
  Eigen::Matrix3d a;
  a << 1.0, 2.0, 0.0, -1.0, 0.5, 0.25, 0.0, 1.0, 3.0;
  values = points * a;
  values.rowwise() += Eigen::RowVector3d(3.0, -1.0, 0.5);
  return {};
}

/// Points of a regular grid on one end of one direction of the domain, corners included.
template <int Dim>
PointMatrix SideParameters(const SplineSpace<Dim>& space, int direction, int end, int n)
{
  const auto domain = space.Domain();
  Eigen::Index count = 1;
  for (int d = 0; d < Dim; ++d)
  {
    count *= d == direction ? 1 : n;
  }
  PointMatrix parameters(count, Dim);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    Eigen::Index rest = i;
    for (int d = 0; d < Dim; ++d)
    {
      double t = end;
      if (d != direction)
      {
        t = double(rest % n) / (n - 1);
        rest /= n;
      }
      const auto k = std::size_t(d);
      parameters(i, d) = (1.0 - t) * domain.Lower[k] + t * domain.Upper[k];
    }
  }
  return parameters;
}

/// Largest distance between images of points that are one point of the inner splines, over all
/// pairs of sides of different patches; shared counts these pairs of points.
template <int Dim>
double Gap(
  const std::vector<Spline<Dim>>& inner, const std::vector<Spline<Dim>>& image, int& shared)
{
  struct Sample
  {
    std::size_t Patch;
    Eigen::RowVectorXd Inner;
    Eigen::RowVectorXd Image;
  };
  std::map<std::array<long, 3>, std::vector<Sample>> samples;
  for (std::size_t p = 0; p < inner.size(); ++p)
  {
    const auto innerForm = MakeBezierForm<Dim>(inner[p], 1);
    const auto imageForm = MakeBezierForm<Dim>(image[p], 1);
    for (int side = 0; side < 2 * Dim; ++side)
    {
      const PointMatrix u = SideParameters<Dim>(*inner[p].Space, side / 2, side % 2, 21);
      EvaluationBatch a;
      EvaluationBatch b;
      EXPECT_TRUE(EvaluateParameters<Dim>(innerForm, u, {}, a));
      EXPECT_TRUE(EvaluateParameters<Dim>(imageForm, u, {}, b));
      for (Eigen::Index i = 0; i < u.rows(); ++i)
      {
        std::array<long, 3> key;
        for (int d = 0; d < 3; ++d)
        {
          key[std::size_t(d)] = std::lround(a.Values(i, d) * 1e6 + 0.3);
        }
        samples[key].push_back({ p, a.Values.row(i), b.Values.row(i) });
      }
    }
  }
  double gap = 0.0;
  shared = 0;
  for (const auto& [key, list] : samples)
  {
    for (const Sample& sample : list)
    {
      if (sample.Patch != list.front().Patch && (sample.Inner - list.front().Inner).norm() < 1e-12)
      {
        gap = std::max(gap, (sample.Image - list.front().Image).norm());
        ++shared;
      }
    }
  }
  return gap;
}

/// Largest distance between the composition and the result at random parameters.
template <int Dim>
double Distance(
  const Spline<Dim>& inner, const Spline<Dim>& image, const PointMap& outer, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto domain = inner.Space->Domain();
  const PointMatrix u = PointMatrix::NullaryExpr(2000, Dim,
    [&](Eigen::Index, Eigen::Index d)
    {
      const auto k = std::size_t(d);
      return domain.Lower[k] + unit(random) * (domain.Upper[k] - domain.Lower[k]);
    });
  EvaluationBatch a;
  EvaluationBatch b;
  EXPECT_TRUE(EvaluateParameters<Dim>(MakeBezierForm<Dim>(inner, 1), u, {}, a));
  EXPECT_TRUE(EvaluateParameters<Dim>(MakeBezierForm<Dim>(image, 1), u, {}, b));
  PointMatrix exact;
  EXPECT_TRUE(outer(a.Values, exact));
  return (exact - b.Values).rowwise().norm().maxCoeff();
}
}

TEST(ComposeSplines, AffineMapOfPolynomialIsExact_ExactOracle)
{
  const auto cube = Shape<3>(ShapeKind::Cube, 2, { 2, 3, 1 });
  const auto result = ComposeSplines<3>(cube, 3, Affine);
  ASSERT_TRUE(result) << result.Status.Message();
  PointMatrix expected;
  ASSERT_TRUE(Affine(cube[0].ControlPoints, expected));
  // 64 eps x amplification (below 100 at degree 2) x size (below 10).
  const double tolerance = 64 * 2.3e-16 * 100 * 10;
  EXPECT_LE((result->Patches[0].ControlPoints - expected).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LE(result->Distances[0], tolerance);
}

TEST(ComposeSplines, ReachesTheToleranceAndReportsTheDistance_CrossOracle)
{
  CompositionParams params;
  params.Tolerance = 1e-4;
  params.MaxLevel = 6;
  const auto disc = Shape<2>(ShapeKind::Disc, 3, { 1, 1, 1 }); // rational
  const auto result = ComposeSplines<2>(disc, 3, Wave, params);
  ASSERT_TRUE(result) << result.Status.Message();
  for (std::size_t p = 0; p < disc.size(); ++p)
  {
    SCOPED_TRACE("patch " + std::to_string(p));
    EXPECT_FALSE(result->Patches[p].IsRational());
    EXPECT_LE(result->Distances[p], params.Tolerance);
    const double distance = Distance<2>(disc[p], result->Patches[p], Wave, unsigned(p + 1));
    // Samples may miss the maximum by a little.
    EXPECT_LE(distance, 1.5 * result->Distances[p]);
    EXPECT_GE(distance, 0.2 * result->Distances[p]);
    EXPECT_GT(result->Patches[p].Space->NumElements(), disc[p].Space->NumElements());
  }
  // Without refinement the distance is larger and still reported.
  params.Tolerance = 0.0;
  const auto coarse = ComposeSplines<2>(disc, 3, Wave, params);
  ASSERT_TRUE(coarse);
  EXPECT_EQ(coarse->Patches[0].Space, disc[0].Space);
  EXPECT_GT(coarse->Distances[0], 1e-4);
  // A level limit that does not allow the tolerance is no error.
  params.Tolerance = 1e-9;
  params.MaxLevel = 1;
  const auto limited = ComposeSplines<2>(disc, 3, Wave, params);
  ASSERT_TRUE(limited);
  EXPECT_GT(limited->Distances[0], 1e-9);
}

TEST(ComposeSplines, PatchesStayConnected_PropertyOracle)
{
  // A feature in one patch only: refinement must be mirrored by its neighbours.
  const PointMap bump = [](const PointMatrix& points, PointMatrix& values)
  {
    values = points;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const double r = (points.row(i).head<2>() - Eigen::RowVector2d(0.6, 0.2)).squaredNorm();
      values(i, 2) += 0.3 * std::exp(-20.0 * r);
    }
    return Status();
  };
  CompositionParams params;
  params.MaxLevel = 4;
  for (const double tolerance : { 0.0, 1e-3 })
  {
    SCOPED_TRACE("tolerance " + std::to_string(tolerance));
    params.Tolerance = tolerance;
    for (const int degree : { 2, 3 })
    {
      const auto disc = Shape<2>(ShapeKind::Disc, degree, { 2, 3, 1 });
      const auto flat = ComposeSplines<2>(disc, 3, bump, params);
      ASSERT_TRUE(flat) << flat.Status.Message();
      EXPECT_EQ(flat->NumInterfaces, 8);
      int shared = 0;
      // Equal control points; evaluation from two sides differs by rounding.
      EXPECT_LE(Gap<2>(disc, flat->Patches, shared), 1e-14);
      EXPECT_GT(shared, 100);
    }
    if (tolerance > 0.0)
    {
      params.MaxLevel = 2; // solids are larger
      params.Tolerance = 1e-2;
    }
    const auto cylinder = Shape<3>(ShapeKind::SolidCylinder, 2, { 1, 2, 1 });
    const auto solid = ComposeSplines<3>(cylinder, 3, bump, params);
    ASSERT_TRUE(solid) << solid.Status.Message();
    EXPECT_EQ(solid->NumInterfaces, 8);
    int shared = 0;
    EXPECT_LE(Gap<3>(cylinder, solid->Patches, shared), 1e-14);
    EXPECT_GT(shared, 1000);
  }
}

TEST(ComposeSplines, InterfaceControlPointsAreEqualBitForBit_PropertyOracle)
{
  // Two squares with a common edge, the second turned round, so that bits could differ.
  auto left = Shape<2>(ShapeKind::Square, 3, { 5, 3, 1 })[0];
  Spline<2> right = left;
  const int n = left.Space->Knots[0].NumFunctions();
  const int m = left.Space->Knots[1].NumFunctions();
  for (int j = 0; j < m; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      // u and v reversed: right(u, v) = left(1 - u, 1 - v) moved by the width.
      right.ControlPoints.row(i + n * j) = left.ControlPoints.row(n - 1 - i + n * (m - 1 - j));
      right.ControlPoints(i + n * j, 0) += 1.0;
    }
  }
  const auto result = ComposeSplines<2>({ left, right }, 3, Wave);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->NumInterfaces, 1);
  for (int j = 0; j < m; ++j)
  {
    const auto a = result->Patches[0].ControlPoints.row(n - 1 + n * j);
    const auto b = result->Patches[1].ControlPoints.row(n - 1 + n * (m - 1 - j));
    EXPECT_EQ(a, b) << "row " << j;
  }
}

TEST(ComposeSplines, CurvesAndBezierGrids_ExactOracle)
{
  const auto arc = Shape<1>(ShapeKind::Arc, 0, { 2, 1, 1 });
  CompositionParams params;
  params.Tolerance = 1e-6;
  const auto curve = ComposeSplines<1>(arc, 3, Affine, params);
  ASSERT_TRUE(curve) << curve.Status.Message();
  EXPECT_LE(curve->Distances[0], 1e-6);
  EXPECT_LE(Distance<1>(arc[0], curve->Patches[0], Affine, 1), 1.5e-6);
  // Ends are images of ends.
  PointMatrix end;
  ASSERT_TRUE(Affine(arc[0].ControlPoints.topRows(1), end));
  EXPECT_EQ(curve->Patches[0].ControlPoints.row(0), end.row(0));
}

TEST(ComposeSplines, ThreadsGiveTheSameBits_PropertyOracle)
{
  const auto disc = Shape<2>(ShapeKind::Disc, 2, { 2, 2, 1 });
  CompositionParams params;
  params.Tolerance = 1e-3;
  params.Threads = 1;
  const auto one = ComposeSplines<2>(disc, 3, Wave, params);
  params.Threads = 2;
  const auto two = ComposeSplines<2>(disc, 3, Wave, params);
  ASSERT_TRUE(one && two);
  for (std::size_t p = 0; p < disc.size(); ++p)
  {
    EXPECT_EQ(one->Patches[p].ControlPoints, two->Patches[p].ControlPoints);
  }
}

TEST(ComposeSplines, EveryFailureIsReachable)
{
  const auto square = Shape<2>(ShapeKind::Square, 2, { 2, 2, 1 });
  EXPECT_EQ(ComposeSplines<2>({}, 3, Wave).Status.Code, ErrorCode::EmptyInput);
  for (const auto& change :
    std::initializer_list<void (*)(CompositionParams&)>{ [](CompositionParams& p)
      { p.Tolerance = -1.0; },
      [](CompositionParams& p) { p.Tolerance = NAN; },
      [](CompositionParams& p) { p.MaxLevel = 21; }, [](CompositionParams& p) { p.Extension = -2; },
      [](CompositionParams& p) { p.Samples = 1; } })
  {
    CompositionParams params;
    change(params);
    EXPECT_EQ(ComposeSplines<2>(square, 3, Wave, params).Status.Code, ErrorCode::InvalidParameter);
  }
  auto broken = square;
  broken[0].ControlPoints(3, 1) = NAN;
  const Status status = ComposeSplines<2>(broken, 3, Wave).Status;
  EXPECT_EQ(status.Code, ErrorCode::NonFiniteInput);
  EXPECT_NE(status.Detail.find("patch 0"), std::string::npos);
  const PointMap nowhere = [](const PointMatrix&, PointMatrix&)
  { return Status(ErrorCode::OutsideDomain, "over there"); };
  const Status outside = ComposeSplines<2>(square, 3, nowhere).Status;
  EXPECT_EQ(outside.Code, ErrorCode::OutsideDomain);
  EXPECT_NE(outside.Detail.find("over there"), std::string::npos) << outside.Detail;
  CompositionParams params;
  params.Progress = [](double) { return false; };
  EXPECT_EQ(ComposeSplines<2>(square, 3, Wave, params).Status.Code, ErrorCode::Aborted);
  auto wide = square;
  wide[0].ControlPoints = PointMatrix::Zero(wide[0].ControlPoints.rows(), 5);
  const Status many = ComposeSplines<2>(wide, 3, Wave).Status;
  EXPECT_EQ(many.Code, ErrorCode::DimensionMismatch);
  EXPECT_NE(many.Detail.find("more than 4"), std::string::npos) << many.Detail;
}

TEST(MapPoints, EvaluatesClampsAndRefuses_ExactOracle)
{
  const auto form = MakeBezierForm<2>(Shape<2>(ShapeKind::AnnulusSector, 0, { 2, 2, 1 })[0], 1);
  PointMatrix points(3, 3);
  points << 0.25, 0.5, 9.0, 0.0, 0.0, 9.0, 1.0, 1.0, 9.0;
  PointMatrix values;
  ASSERT_TRUE(MapPoints<2>(form, points, false, 1, values));
  for (Eigen::Index i = 0; i < 3; ++i)
  {
    EXPECT_NEAR(values.row(i).norm(), 0.5 + 0.5 * points(i, 0), 1e-14);
  }
  points(1, 0) = -0.5;
  const Status outside = MapPoints<2>(form, points, false, 1, values);
  EXPECT_EQ(outside.Code, ErrorCode::OutsideDomain);
  EXPECT_NE(outside.Detail.find("point 1"), std::string::npos) << outside.Detail;
  ASSERT_TRUE(MapPoints<2>(form, points, true, 1, values));
  EXPECT_NEAR(values.row(1).norm(), 0.5, 1e-14);
  points(2, 1) = NAN;
  EXPECT_EQ(MapPoints<2>(form, points, true, 1, values).Code, ErrorCode::NonFiniteInput);
  EXPECT_EQ(MapPoints<2>(form, PointMatrix::Zero(2, 1), true, 1, values).Code,
    ErrorCode::DimensionMismatch);
  Spline<1> foreign{ MakeBezierSpace<1>({ { 1 } }, { 0, 1 }, 2).Value, PointMatrix::Zero(2, 2),
    {} };
  const Status domain =
    MapPoints<1>(MakeBezierForm(foreign), PointMatrix::Zero(1, 1), true, 1, values);
  EXPECT_EQ(domain.Code, ErrorCode::DimensionMismatch);
  EXPECT_NE(domain.Detail.find("no parameter domain"), std::string::npos) << domain.Detail;
}
