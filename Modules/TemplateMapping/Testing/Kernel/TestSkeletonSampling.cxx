// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/TemplateMapping/SkeletonSampling.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace knotwork;

namespace
{
template <int Dim>
std::vector<Spline<Dim>> Shape(const ShapeParams& params)
{
  std::vector<Spline<Dim>> splines;
  for (const AnySpline& patch : MakeShape(params).Value)
  {
    splines.push_back(std::get<Spline<Dim>>(patch));
  }
  return splines;
}

ShapeParams OfKind(ShapeKind kind)
{
  ShapeParams params;
  params.Kind = kind;
  return params;
}

/// Graph of z = 1 + x + 2 y + x^2 - 3 x y + y^2 / 2 over the unit triangle as a Bezier triangle.
BernsteinCells Graph()
{
  BernsteinCells cells;
  cells.NumComponents = 3;
  double* block = cells.Block(cells.Add(CellShape::Triangle, { 2, 2, 0 }));
  // (0,0) (1,0) (2,0) (0,1) (1,1) (0,2); z are values of the blossom.
  const double x[6] = { 0, 0.5, 1, 0, 0.5, 0 };
  const double y[6] = { 0, 0, 0, 0.5, 0.5, 1 };
  const double z[6] = { 1, 1.5, 3, 2, 1 + 0.5 + 1 - 1.5, 3.5 };
  std::copy(x, x + 6, block);
  std::copy(y, y + 6, block + 6);
  std::copy(z, z + 6, block + 12);
  return cells;
}
}

TEST(SkeletonSampling, AnArcIsACircleWithRadialNormals_ExactOracle)
{
  ShapeParams params = OfKind(ShapeKind::Arc);
  params.Angle = 360.0;
  params.OuterRadius = 2.0;
  params.Elements = { 3, 1, 1 }; // 12 elements: knots at multiples of 1/12
  const Spline<1> curve = Shape<1>(params)[0];
  for (const int samples : { 0, 2, 100 })
  {
    SCOPED_TRACE(samples);
    const auto patch = SampleCurve(7, curve, samples);
    ASSERT_TRUE(patch) << patch.Status.Message();
    EXPECT_EQ(patch.Value.Id, 7);
    const Eigen::Index n = patch.Value.Points.rows();
    EXPECT_EQ(n, samples == 0 ? 2005 : samples == 2 ? 13 : 109);
    EXPECT_TRUE(patch.Value.Simplices.empty());
    const PointMatrix unit = patch.Value.Points / 2.0;
    EXPECT_LE((unit.rowwise().norm().array() - 1.0).abs().maxCoeff(), 1e-14);
    EXPECT_LE((patch.Value.Normals - unit).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_EQ(CheckSkeletons<2>({ patch.Value }, { patch.Value }).Message(), "ok");
    for (const auto& element : curve.Space->Elements) // every knot is a parameter
    {
      EXPECT_TRUE((patch.Value.Parameters.array() == element.Box.Upper[0]).any());
    }
  }
  EXPECT_EQ(SampleCurve(0, curve, 1).Status.Code, ErrorCode::InvalidParameter);
  Spline<1> lifted = curve;
  lifted.ControlPoints(3, 2) = 0.25;
  const Status status = SampleCurve(0, lifted).Status;
  EXPECT_EQ(status.Code, ErrorCode::DimensionMismatch);
  EXPECT_NE(status.Detail.find("control point 3 has z = 0.25"), std::string::npos);
}

TEST(SkeletonSampling, ElementsWithoutADomainAreAChain_ExactOracle)
{
  // y = x^2 on [0, 1], then a line to (2, 3); the second element does or does not share its point.
  for (const bool open : { false, true })
  {
    Spline<1> curve;
    curve.Space = MakeBezierSpace<1>({ { 2 }, { 1 } }, { 0, 1, 2, 3, 4 }, 5).Value;
    curve.ControlPoints.resize(5, 3);
    curve.ControlPoints << 0, 0, 0, 0.5, 0, 0, 1, 1, 0, 1, 1, 0, 2, 3, 0;
    curve.ControlPoints(3, 0) += open ? 0.01 : 0.0;
    const auto patch = SampleCurve(3, curve, 20);
    if (open)
    {
      EXPECT_EQ(patch.Status.Code, ErrorCode::InvalidTopology);
      EXPECT_NE(patch.Status.Detail.find("element 1 does not begin where element 0 ends"),
        std::string::npos);
      continue;
    }
    ASSERT_TRUE(patch) << patch.Status.Message();
    ASSERT_EQ(patch.Value.Points.rows(), 21);
    for (int i = 0; i <= 20; ++i)
    {
      const double t = i / 10.0;
      EXPECT_NEAR(patch.Value.Parameters(i, 0), t, 1e-15);
      EXPECT_NEAR(patch.Value.Points(i, 0), t, 1e-15);
      EXPECT_NEAR(patch.Value.Points(i, 1), t <= 1 ? t * t : 2 * t - 1, 1e-15);
      Eigen::RowVector2d normal(t <= 1 ? 2 * t : 2.0, -1.0);
      EXPECT_LE((patch.Value.Normals.row(i) - normal.normalized()).norm(), 1e-14);
    }
  }
}

TEST(SkeletonSampling, ASphereHasRadialNormals_ExactOracle)
{
  for (const ShapeKind kind : { ShapeKind::SphereSurface, ShapeKind::PolarSphereSurface })
  {
    ShapeParams params = OfKind(kind);
    params.Angle = 360.0;
    params.OuterRadius = 0.5;
    params.Elements = { 2, 3, 1 };
    Skeleton<3> skeleton;
    for (const Spline<2>& surface : Shape<2>(params))
    {
      const auto patch = SampleSurface(static_cast<int>(skeleton.size()), surface, 300);
      ASSERT_TRUE(patch) << patch.Status.Message();
      EXPECT_GE(patch.Value.Points.rows(), 300);
      EXPECT_LE(patch.Value.Points.rows(), 900);
      const PointMatrix unit = 2.0 * patch.Value.Points;
      EXPECT_LE((unit.rowwise().norm().array() - 1.0).abs().maxCoeff(), 1e-13);
      // At the poles of the second kind, those of the mesh: the means around.
      for (Eigen::Index i = 0; i < unit.rows(); ++i)
      {
        const bool pole =
          kind == ShapeKind::PolarSphereSurface && std::abs(unit(i, 2)) > 1.0 - 1e-9;
        EXPECT_NEAR(
          std::abs(patch.Value.Normals.row(i).dot(unit.row(i))), 1.0, pole ? 1e-3 : 1e-12);
      }
      skeleton.push_back(patch.Value);
    }
    EXPECT_EQ(skeleton.size(), kind == ShapeKind::SphereSurface ? 6U : 1U);
    EXPECT_EQ(CheckSkeletons<3>(skeleton, skeleton).Message(), "ok");
  }
}

TEST(SkeletonSampling, CellsFollowTheirPolynomials_ExactOracle)
{
  const BernsteinCells cells = Graph();
  const auto patch = SampleCells(2, cells, 40);
  ASSERT_TRUE(patch);
  ASSERT_EQ(patch.Value.Points.rows(), 45); // 8 cuts
  EXPECT_EQ(patch.Value.Simplices.size(), 64U);
  for (Eigen::Index i = 0; i < 45; ++i)
  {
    const double x = patch.Value.Parameters(i, 0);
    const double y = patch.Value.Parameters(i, 1);
    const Eigen::RowVector3d point(x, y, 1 + x + 2 * y + x * x - 3 * x * y + y * y / 2);
    EXPECT_LE((patch.Value.Points.row(i) - point).norm(), 1e-14);
    const Eigen::RowVector3d normal(-(1 + 2 * x - 3 * y), -(2 - 3 * x + y), 1);
    EXPECT_LE((patch.Value.Normals.row(i) - normal.normalized()).norm(), 1e-14);
  }
  EXPECT_EQ(CheckSkeletons<3>({ patch.Value }, { patch.Value }).Message(), "ok");

  // Rational: the same under a projective map X -> X / (1 + x + 3 y), linear in the homogeneous
  // coefficients. Tangents of the image are images of tangents.
  BernsteinCells rational = cells;
  rational.Rational = true;
  rational.Data.resize(24);
  for (std::size_t k = 0; k < 6; ++k)
  {
    rational.Data[18 + k] = 1.0 + cells.Data[k] + 3.0 * cells.Data[6 + k];
  }
  rational.Offsets = { 0, 24 };
  ASSERT_TRUE(rational.Check());
  const auto image = SampleCells(2, rational, 40);
  ASSERT_TRUE(image);
  for (Eigen::Index i = 0; i < 45; ++i)
  {
    const double x = patch.Value.Parameters(i, 0);
    const double y = patch.Value.Parameters(i, 1);
    const double w = 1 + x + 3 * y;
    const Eigen::RowVector3d point = patch.Value.Points.row(i);
    EXPECT_LE((image.Value.Points.row(i) - point / w).norm(), 1e-14);
    const Eigen::RowVector3d alongX =
      Eigen::RowVector3d(1, 0, 1 + 2 * x - 3 * y) / w - point / (w * w);
    const Eigen::RowVector3d alongY =
      Eigen::RowVector3d(0, 1, 2 - 3 * x + y) / w - 3 * point / (w * w);
    EXPECT_NEAR(image.Value.Normals.row(i).dot(alongX.normalized()), 0.0, 1e-13);
    EXPECT_NEAR(image.Value.Normals.row(i).dot(alongY.normalized()), 0.0, 1e-13);
  }
}

TEST(SkeletonSampling, CellsShareThePointsOfTheirSides_PropertyOracle)
{
  // Two quadrilaterals of a tensor-product surface taken apart and a triangle at one of them.
  Spline<2> surface;
  surface.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(3, 2), KnotVector::Uniform(2, 1) }).Value;
  const PointMatrix places = GrevillePoints(*surface.Space);
  surface.ControlPoints.resize(places.rows(), 3);
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    surface.ControlPoints.row(i) << places(i, 0), places(i, 1) * places(i, 0),
      std::sin(5 * places(i, 0)) / 7 + places(i, 1) / 3;
  }
  BernsteinCells cells = MakeBernsteinCells(MakeBezierForm(surface));
  // The second cell runs the other way along the common side: other roundings.
  double* second = cells.Block(1);
  for (int plane = 0; plane < 3; ++plane)
  {
    std::swap_ranges(second + 12 * plane, second + 12 * plane + 4, second + 12 * plane + 8);
  }
  double* triangle = cells.Block(cells.Add(CellShape::Triangle, { 1, 1, 0 }));
  const double corners[9] = { 5, 6, 5, 5, 5, 6, 0, 0, 0 };
  std::copy(corners, corners + 9, triangle);
  const auto patch = SampleCells(0, cells, 150);
  ASSERT_TRUE(patch);
  EXPECT_EQ(patch.Value.Parameters.rows(), 0);
  EXPECT_EQ(CheckSkeletons<3>({ patch.Value }, { patch.Value }).Message(), "ok");
  const Eigen::Index n = patch.Value.Points.rows();
  ASSERT_EQ(n, 8 * 8 * 2 + 36);
  for (int j = 0; j < 8; ++j) // right side of the first cell, left side of the second
  {
    EXPECT_EQ(patch.Value.Points.row(8 * j + 7), patch.Value.Points.row(64 + 8 * (7 - j)));
  }
  EXPECT_EQ(SampleCells(0, cells, -1).Status.Code, ErrorCode::InvalidParameter);
}
