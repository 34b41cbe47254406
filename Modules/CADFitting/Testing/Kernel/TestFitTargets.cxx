// SPDX-License-Identifier: BSD-3-Clause
// Closest points on targets against formulas and the least of many samples.
#include "FitCases.h"
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace fits;

namespace
{
PointMatrix RandomPoints(int count, double size)
{
  meshes::Random random(3);
  PointMatrix points(count, 3);
  for (Eigen::Index i = 0; i < points.size(); ++i)
  {
    points.data()[i] = random.In(-size, size);
  }
  return points;
}
}

TEST(FitTarget, ImplicitSphere)
{
  const FitTargetPtr sphere = Ellipsoid(1.0, 1.0, 1.0);
  const PointMatrix queries = RandomPoints(200, 1.5);
  TargetPoints feet;
  ASSERT_TRUE(sphere->Find({}, queries, feet));
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    const Eigen::RowVector3d expected = queries.row(i).normalized();
    EXPECT_LE((feet.Points.row(i) - expected).norm(), 1e-11);
    EXPECT_LE((feet.Normals.row(i) - expected).norm(), 1e-9);
  }
  const TargetSamples samples = sphere->Samples(5000);
  EXPECT_GE(samples.Points.rows(), 5000);
  // area by lines through the surface: the rule's error falls with their number
  EXPECT_NEAR(samples.Areas.sum(), 4.0 * EIGEN_PI, 0.02 * 4.0 * EIGEN_PI);
}

TEST(FitTarget, ImplicitWithoutAClosestPoint)
{
  TargetPoints feet;
  const Status status = Ellipsoid(1.0, 1.0, 1.0)->Find({}, PointMatrix::Zero(1, 3), feet);
  EXPECT_EQ(status.Code, ErrorCode::NotConverged);
  EXPECT_EQ(MakeImplicitTarget({}).Status.Code, ErrorCode::EmptyInput);
}

/// Queries near a box: the closest point of every face, curve and corner is a clamp.
TEST(FitTarget, BoxOfTriangles)
{
  const auto target = MakeMeshTarget(BoxTriangles(5));
  ASSERT_TRUE(target);
  EXPECT_TRUE(target.Value->IsClosed());
  EXPECT_EQ(target.Value->Vertices().rows(), 8);
  const PointMatrix queries = RandomPoints(100, 2.0);
  TargetPoints feet;
  for (int face = 0; face < 6; ++face)
  {
    // a sample tells which side the face is
    PointMatrix on;
    for (const TargetSamples samples = target.Value->Samples(1000); on.rows() == 0;)
    {
      const auto row = std::find(samples.Faces.begin(), samples.Faces.end(), face);
      on = samples.Points.row(row - samples.Faces.begin());
    }
    Eigen::RowVector3d low = Eigen::RowVector3d::Zero();
    Eigen::RowVector3d high = Eigen::RowVector3d::Ones();
    for (int d = 0; d < 3; ++d)
    {
      if (on(0, d) == 0.0 || on(0, d) == 1.0)
      {
        low[d] = high[d] = on(0, d);
      }
    }
    ASSERT_TRUE(target.Value->Find({ TargetEntity::Face, face }, queries, feet));
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
    {
      const Eigen::RowVector3d expected = queries.row(i).cwiseMax(low).cwiseMin(high);
      EXPECT_LE((feet.Points.row(i) - expected).norm(), 1e-14);
      EXPECT_EQ(feet.Faces[static_cast<std::size_t>(i)], face);
    }
  }
  const TargetSamples samples = target.Value->Samples(1000);
  EXPECT_NEAR(samples.Areas.sum(), 6.0, 1e-12);
  EXPECT_GE(samples.Points.rows(), 1000);
}

/// Curves of a box from its six spline faces: twelve edges, and a face group takes four away.
TEST(FitTarget, SixSplineFaces)
{
  TrimmedModel model;
  AddSplineBox(model, Eigen::RowVector3d::Zero(), 0);
  const auto target = MakeModelTarget(model);
  ASSERT_TRUE(target) << target.Status.Message();
  EXPECT_EQ(target.Value->NumFaces(), 6);
  EXPECT_EQ(target.Value->Curves().size(), 12u);
  EXPECT_EQ(target.Value->Vertices().rows(), 8);
  EXPECT_TRUE(target.Value->IsClosed());
  const PointMatrix queries = RandomPoints(100, 2.0);
  TargetPoints feet;
  ASSERT_TRUE(target.Value->Find({}, queries, feet));
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    Eigen::RowVector3d expected = queries.row(i).cwiseMax(0.0).cwiseMin(1.0);
    if ((expected - queries.row(i)).norm() == 0.0)
    {
      continue; // inside: several faces may be as near
    }
    EXPECT_LE((feet.Points.row(i) - expected).norm(), 1e-12);
  }
  ModelTargetParams params;
  params.Groups = { 0, -1, 0, -1, -1, -1 }; // two sides that meet along one edge
  const auto grouped = MakeModelTarget(model, params);
  EXPECT_EQ(grouped.Value->NumFaces(), 5);
  EXPECT_EQ(grouped.Value->Curves().size(), 11u);
  params.Groups.pop_back();
  EXPECT_EQ(MakeModelTarget(model, params).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(MakeModelTarget({}).Status.Code, ErrorCode::EmptyInput);
}

TEST(FitTarget, PartsThatTouchInAPoint)
{
  TriangleMesh boxes = BoxTriangles(2);
  const TriangleMesh one = boxes;
  const auto count = one.Points.rows();
  boxes.Points.conservativeResize(2 * count, Eigen::NoChange);
  boxes.Points.bottomRows(count) = one.Points.rowwise() + Eigen::RowVector3d::Ones();
  for (auto corners : one.Triangles)
  {
    for (int& corner : corners)
    {
      corner += static_cast<int>(count);
    }
    boxes.Triangles.push_back(corners);
  }
  const auto target = MakeMeshTarget(boxes);
  ASSERT_TRUE(target) << target.Status.Message();
  EXPECT_EQ(target.Value->NumFaces(), 12);
}

TEST(FitTarget, BadTriangles)
{
  EXPECT_EQ(MakeMeshTarget({}).Status.Code, ErrorCode::EmptyInput);
  TriangleMesh triangles = BoxTriangles(1);
  triangles.Points(2, 0) = std::nan("");
  EXPECT_EQ(MakeMeshTarget(triangles).Status.Code, ErrorCode::NonFiniteInput);
  EXPECT_EQ(MakeCurveTarget({}).Status.Code, ErrorCode::EmptyInput);
}
