// SPDX-License-Identifier: BSD-3-Clause
// Splines of planes, cylinders, ...; oracle: the surfaces' equations.
#include <knotwork/SplineCore/AnalyticPatch.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/CurveInterpolation.h>
#include <knotwork/SplineCore/FitCircle.h>
#include <knotwork/SplineCore/SurfaceProfile.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace knotwork;

namespace
{
constexpr double Pi = 3.14159265358979323846;

class Draw
{
public:
  explicit Draw(unsigned seed) : Random(seed) {}
  double operator()(double lower, double upper)
  {
    return lower + (upper - lower) * static_cast<double>(this->Random()) / 4294967296.0;
  }
  Eigen::Vector3d Direction()
  {
    return Eigen::Vector3d((*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)).normalized();
  }

private:
  std::mt19937 Random;
};

/// A surface of a type somewhere, and a range of its parameters.
AnalyticPatch RandomPatch(SurfaceType type, Draw& draw)
{
  AnalyticSurface surface;
  surface.Type = type;
  surface.Point = 3.0 * draw.Direction();
  surface.Axis = draw.Direction();
  surface.Radius = draw(1.0, 2.0);
  surface.MinorRadius = draw(0.2, 0.8);
  surface.Angle = draw(0.2, 1.0);
  if (HasProfile(type)) // a wave over [-3, 3], or beside the axis over [-1, 1]
  {
    const bool turns = type == SurfaceType::Revolution;
    const double half = turns ? 1.0 : 3.0;
    Spline<1> wave;
    wave.Space = MakeTensorSpace<1>({ KnotVector::Uniform(3, 4, -half, half) }).Value;
    wave.ControlPoints.resize(7, 2);
    for (Eigen::Index i = 0; i < 7; ++i)
    {
      const double place = wave.Space->Knots[0].Greville(static_cast<int>(i));
      const double height = draw(0.0, 0.3);
      wave.ControlPoints.row(i) << (turns ? 1.5 + height : place), (turns ? place : height);
    }
    surface.Profile =
      std::make_shared<const SurfaceProfile>(wave, surface.Axis.unitOrthogonal().eval());
  }
  AnalyticPatch patch(surface, draw.Direction());
  const bool isExtrusion = type == SurfaceType::Extrusion;
  const Eigen::Vector2d lower(isExtrusion ? draw(-3.0, 0.0) : draw(-3.0, 3.0), draw(-1.0, 0.0));
  patch.SetRange(
    lower, lower + Eigen::Vector2d(draw(0.3, isExtrusion ? 3.0 : 2.0 * Pi), draw(0.5, 1.0)));
  return patch;
}

constexpr std::array<SurfaceType, 7> Types{ SurfaceType::Plane, SurfaceType::Cylinder,
  SurfaceType::Sphere, SurfaceType::Cone, SurfaceType::Torus, SurfaceType::Extrusion,
  SurfaceType::Revolution };
}

/// Sizes are below 10: some roundings.
TEST(AnalyticPatch, SplineIsTheSurface_Exact)
{
  constexpr double Rounding = 1e-13;
  Draw draw(7);
  for (const SurfaceType type : Types)
  {
    for (int trial = 0; trial < 20; ++trial)
    {
      const AnalyticPatch patch = RandomPatch(type, draw);
      const Spline<2> spline = patch.MakeSpline();
      ASSERT_TRUE(spline.Check()) << ToString(type);
      const BezierForm<2> form = MakeBezierForm<2>(spline, 1);
      for (int i = 0; i < 20; ++i)
      {
        Eigen::Vector2d place;
        for (int d = 0; d < 2; ++d)
        {
          place[d] = draw(patch.Lower()[d], patch.Upper()[d]);
        }
        const Eigen::Vector3d point = patch.Point(place);
        EXPECT_NEAR(patch.Surface().Distance(point), 0.0, Rounding) << ToString(type);
        EXPECT_NEAR((patch.ParametersNear(point, place) - place).norm(), 0.0, 1e-11);
        const Eigen::Vector2d at = patch.SplineParameters(place);
        EXPECT_NEAR((patch.SurfaceParameters(at) - place).norm(), 0.0, Rounding);
        EXPECT_LT((at - place).norm(), 2.0 * Pi / 180.0); // a degree in each parameter
        EvaluationParams params;
        params.Derivatives = 1;
        EvaluationBatch batch;
        const PointMatrix row = at.transpose();
        ASSERT_TRUE(EvaluateParameters<2>(form, row, params, batch));
        EXPECT_NEAR((batch.Values.row(0).transpose() - point).norm(), 0.0, Rounding);
        const Eigen::Vector3d u = batch.First.row(0).head(3).transpose();
        const Eigen::Vector3d v = batch.First.row(0).tail(3).transpose();
        EXPECT_NEAR(u.cross(v).normalized().dot(patch.Surface().Normal(point)), 1.0, 1e-10)
          << ToString(type);
      }
    }
  }
}

TEST(AnalyticPatch, PolesArePoints_Exact)
{
  Draw draw(3);
  for (const SurfaceType type : { SurfaceType::Sphere, SurfaceType::Cone })
  {
    AnalyticPatch patch = RandomPatch(type, draw);
    const double pole = patch.Poles()[0];
    patch.SetRange({ 0.0, pole }, { 2.0 * Pi, pole + 0.5 });
    const Spline<2> spline = patch.MakeSpline();
    const Eigen::Index count = spline.Space->Knots[0].NumFunctions();
    for (Eigen::Index i = 1; i < count; ++i)
    {
      EXPECT_EQ(spline.ControlPoints.row(i), spline.ControlPoints.row(0)) << ToString(type);
    }
  }
}

TEST(FitCircle, ArcsInSpace_Exact)
{
  Draw draw(11);
  for (int trial = 0; trial < 40; ++trial)
  {
    CircularArc arc;
    arc.Centre = 5.0 * draw.Direction();
    const double radius = draw(0.5, 3.0);
    arc.X = radius * draw.Direction();
    arc.Y = radius * arc.X.cross(draw.Direction()).normalized();
    arc.Begin = draw(-3.0, 3.0);
    arc.Sweep = (trial % 2 == 0 ? 1.0 : -1.0) * draw(0.3, 6.0);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i <= 12; ++i)
    {
      points.push_back(arc.Point(i / 12.0));
    }
    CircularArc found;
    ASSERT_TRUE(FitCircle(points, found));
    EXPECT_NEAR(found.Radius(), radius, 1e-10);
    EXPECT_NEAR((found.Centre - arc.Centre).norm(), 0.0, 1e-10);
    EXPECT_NEAR(std::abs(found.Sweep), std::abs(arc.Sweep), 1e-10);
    EXPECT_NEAR((found.Point(0.3) - arc.Point(0.3)).norm(), 0.0, 1e-10);
    EXPECT_NEAR(found.Distance(arc.Centre), radius, 1e-10);
    points.push_back(points.front()); // closed
    points.erase(points.begin() + 10, points.end() - 1);
    if (std::abs(arc.Sweep) > 4.5)
    {
      ASSERT_TRUE(FitCircle(points, found));
      EXPECT_NEAR(std::abs(found.Sweep), 2.0 * Pi, 1e-14);
    }
  }
}

TEST(FitCircle, RefusesLines)
{
  CircularArc found;
  EXPECT_FALSE(FitCircle({}, found));
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  EXPECT_FALSE(FitCircle({ x, 2.0 * x }, found));
  EXPECT_FALSE(FitCircle({ x, 2.0 * x, 3.5 * x, 4.0 * x }, found));
}

TEST(CurveInterpolation, CurvesOfTheSpaceComeBack_Exact)
{
  Spline<1> curve;
  curve.Space =
    MakeTensorSpace<1>({ KnotVector::Create(3, { 0, 0, 0, 0, 0.3, 0.3, 0.7, 1, 1, 1, 1 }).Value })
      .Value;
  curve.ControlPoints.resize(curve.Space->NumFunctions, 2);
  Draw draw(5);
  for (Eigen::Index i = 0; i < curve.ControlPoints.rows(); ++i)
  {
    curve.ControlPoints.row(i) << draw(-1, 1), draw(-1, 1);
  }
  CurveInterpolation interpolation;
  ASSERT_TRUE(interpolation.Prepare(*curve.Space));
  const PointMatrix found = interpolation.Solve(CurvePoints(curve, interpolation.Points()));
  EXPECT_NEAR((found - curve.ControlPoints).cwiseAbs().maxCoeff(), 0.0, 1e-13);
  const PointMatrix at = ParametersInSpans(curve.Space->Knots[0], 2);
  ASSERT_EQ(at.rows(), 6);
  EXPECT_NEAR(at(0, 0), 0.075, 1e-15);
  EXPECT_NEAR(at(5, 0), 0.925, 1e-15);
}
