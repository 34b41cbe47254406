// SPDX-License-Identifier: BSD-3-Clause
#include "FaceCases.h"
#include "TrimCases.h"
#include <knotwork/SurfaceTrimming/FaceIntersections.h>

#include <limits>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
TrimmedFace Whole(const Spline<2>& surface)
{
  TrimmedFace face;
  face.Surface = surface;
  return face;
}

/// A parallelogram from a corner along two sides.
TrimmedFace Parallelogram(
  const Eigen::RowVector3d& corner, const Eigen::RowVector3d& u, const Eigen::RowVector3d& v)
{
  Spline<2> plane = Plane();
  plane.ControlPoints.row(0) = corner;
  plane.ControlPoints.row(1) = corner + u;
  plane.ControlPoints.row(2) = corner + v;
  plane.ControlPoints.row(3) = corner + u + v;
  return Whole(plane);
}

/// The six faces of a box.
void AddBox(TrimmedModel& model, const Eigen::RowVector3d& corner, const Eigen::RowVector3d& size)
{
  const Eigen::RowVector3d x(size[0], 0, 0);
  const Eigen::RowVector3d y(0, size[1], 0);
  const Eigen::RowVector3d z(0, 0, size[2]);
  model.Faces.push_back(Parallelogram(corner, y, x));
  model.Faces.push_back(Parallelogram(corner + z, x, y));
  model.Faces.push_back(Parallelogram(corner, x, z));
  model.Faces.push_back(Parallelogram(corner + y, z, x));
  model.Faces.push_back(Parallelogram(corner, z, y));
  model.Faces.push_back(Parallelogram(corner + x, y, z));
}

/// A cubic curve in the plane, moved along z.
TrimmedFace Swept(const std::vector<std::array<double, 2>>& points, int spans)
{
  Spline<2> surface;
  surface.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(3, spans), KnotVector::Uniform(1, 1) }).Value;
  const auto n = static_cast<Eigen::Index>(points.size());
  surface.ControlPoints.resize(2 * n, 3);
  for (Eigen::Index i = 0; i < 2 * n; ++i)
  {
    const auto& p = points[static_cast<std::size_t>(i % n)];
    surface.ControlPoints.row(i) << p[0], p[1], i < n ? 0.0 : 2.0;
  }
  return Whole(surface);
}

Eigen::RowVector3d PointOf(const TrimmedFace& face, const RealArray<2>& at)
{
  PointMatrix uv(1, 2);
  uv << at[0], at[1];
  return Evaluate(face.Surface, uv).row(0);
}
}

// Two plates that cross along y = z = 0.5: the witness is a point of both, on that line.
TEST(FaceIntersections, CrossingPlates_Exact)
{
  TrimmedModel model;
  model.Faces = { Whole(Plane()), Parallelogram({ 0.0, 0.5, -0.5 }, { 1, 0, 0 }, { 0, 0, 1 }) };
  const auto result = FindFaceIntersections(model);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Verdict, IntersectionVerdict::Found);
  ASSERT_EQ(result->Meetings.size(), 1u);
  const FaceMeeting& meeting = result->Meetings[0];
  EXPECT_EQ(meeting.Faces, (std::array<int, 2>{ 0, 1 }));
  EXPECT_NEAR(meeting.Position[1], 0.5, 1e-9);
  EXPECT_NEAR(meeting.Position[2], 0.0, 1e-9);
  for (std::size_t k = 0; k < 2; ++k)
  {
    const Eigen::RowVector3d point = PointOf(model.Faces[k], meeting.Parameters[k]);
    EXPECT_NEAR((point - Eigen::RowVector3d(meeting.Position.data())).norm(), 0.0, 1e-9);
  }
}

// The same plates, the first with a hole where the second passes.
TEST(FaceIntersections, WhatIsTrimmedAwayMeetsNothing_Exact)
{
  for (const bool isNarrow : { false, true })
  {
    TrimmedModel model;
    TrimmedFace plate = Whole(Plane());
    AddPolygon(model, plate, { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
    const double v = isNarrow ? 0.49 : 0.45;
    AddPolygon(model, plate, { { 0.2, v }, { 0.2, 0.55 }, { 0.8, 0.55 }, { 0.8, v } });
    model.Faces = { plate, Parallelogram({ 0.3, 0.5, -0.5 }, { 0.4, 0, 0 }, { 0, 0, 1 }) };
    const auto result = FindFaceIntersections(model);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_EQ(result->Verdict, IntersectionVerdict::Absent);
    // wider than the hole it passes through the plate
    model.Faces[1] = Parallelogram({ 0.1, 0.5, -0.5 }, { 0.4, 0, 0 }, { 0, 0, 1 });
    const auto wide = FindFaceIntersections(model);
    ASSERT_TRUE(wide) << wide.Status.Message();
    ASSERT_EQ(wide->Verdict, IntersectionVerdict::Found);
    EXPECT_LT(wide->Meetings[0].Position[0], 0.2);
  }
}

// A box is proved; a second one that enters it is found, one that stands 0.01 beside it is not.
TEST(FaceIntersections, Boxes_Exact)
{
  TrimmedModel model;
  AddBox(model, { 0, 0, 0 }, { 1, 1, 1 });
  auto result = FindFaceIntersections(model);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Verdict, IntersectionVerdict::Absent);
  EXPECT_EQ(result->PairsOfFaces, 18); // 6 alone, 12 edges
  AddBox(model, { 1.01, 0.2, 0.2 }, { 1, 0.5, 0.5 });
  result = FindFaceIntersections(model);
  EXPECT_EQ(result->Verdict, IntersectionVerdict::Absent);
  model.Faces.resize(6);
  AddBox(model, { 0.9, 0.2, 0.2 }, { 1, 0.5, 0.5 });
  result = FindFaceIntersections(model);
  EXPECT_EQ(result->Verdict, IntersectionVerdict::Found);
  ASSERT_EQ(result->Meetings.size(), 4u); // the four long sides pass through x = 1
  for (const FaceMeeting& meeting : result->Meetings)
  {
    EXPECT_EQ(meeting.Verdict, IntersectionVerdict::Found);
    EXPECT_EQ(meeting.Faces[0], 5);
    EXPECT_NEAR(meeting.Position[0], 1.0, 1e-9);
  }
}

// A loop of a cubic crosses itself, and not when it is pulled apart.
TEST(FaceIntersections, ASweptLoopMeetsItself_Exact)
{
  TrimmedModel model;
  model.Faces = { Swept({ { 0, 0 }, { 3, 2 }, { -2, 2 }, { 1, 0 } }, 1) };
  auto result = FindFaceIntersections(model);
  ASSERT_TRUE(result) << result.Status.Message();
  ASSERT_EQ(result->Verdict, IntersectionVerdict::Found);
  const FaceMeeting& meeting = result->Meetings[0];
  EXPECT_GT(std::abs(meeting.Parameters[0][0] - meeting.Parameters[1][0]), 0.1);
  EXPECT_NEAR(meeting.Position[0], 0.5, 1e-8); // by symmetry
  model.Faces = { Swept({ { 0, 0 }, { 0.3, 2 }, { 0.7, 2 }, { 1, 0 } }, 1) };
  result = FindFaceIntersections(model);
  EXPECT_EQ(result->Verdict, IntersectionVerdict::Absent);
  // a hairpin that comes back 0.02 beside itself
  model.Faces = { Swept(
    { { 0, 0 }, { 1, 0 }, { 2, 0 }, { 3, 0.01 }, { 2, 0.02 }, { 1, 0.02 }, { 0, 0.02 } }, 4) };
  result = FindFaceIntersections(model);
  EXPECT_EQ(result->Verdict, IntersectionVerdict::Absent);
}

// Rational and closed: six patches, and one with a seam and two poles, which are edges.
TEST(FaceIntersections, ClosedShapes_Exact)
{
  ShapeParams params;
  params.Kind = ShapeKind::SphereSurface;
  const auto patches = MakeShape(params);
  ASSERT_TRUE(patches) << patches.Status.Message();
  TrimmedModel six;
  for (const auto& part : patches.Value)
  {
    six.Faces.push_back(Whole(std::get<Spline<2>>(part)));
  }
  TrimmedModel one;
  params.Kind = ShapeKind::PolarSphereSurface;
  params.Angle = 360.0;
  one.Faces = { Whole(Shape(params)) };
  for (TrimmedModel* model : { &six, &one })
  {
    auto result = FindFaceIntersections(*model);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_EQ(result->Verdict, IntersectionVerdict::Absent) << result->Pairs;
    // a plate through it
    model->Faces.push_back(Parallelogram({ -5, -5, 0.1 }, { 10, 0, 0 }, { 0, 10, 0 }));
    result = FindFaceIntersections(*model);
    EXPECT_EQ(result->Verdict, IntersectionVerdict::Found);
    for (const FaceMeeting& meeting : result->Meetings)
    {
      const Eigen::Vector3d at(meeting.Position.data());
      EXPECT_NEAR(at.norm(), 1.0, 1e-9);
      EXPECT_NEAR(at[2], 0.1, 1e-9);
    }
  }
}

// Random hills above and below each other: the verdict is that of the heights at 200 x 200 points.
TEST(FaceIntersections, RandomHills_Sampling)
{
  int found = 0;
  int absent = 0;
  for (unsigned seed = 0; seed < 40; ++seed)
  {
    TrimmedModel model;
    model.Faces = { Whole(Hills(2 * seed, 0.2)), Whole(Hills(2 * seed + 1, 0.2)) };
    model.Faces[1].Surface.ControlPoints.col(2).array() += 0.01 * seed;
    const int n = 200;
    PointMatrix uv(n * n, 2);
    for (int i = 0; i < n * n; ++i)
    {
      uv.row(i) << (i % n + 0.5) / n, (i / n + 0.5) / n;
    }
    const Eigen::VectorXd gaps =
      Evaluate(model.Faces[1].Surface, uv).col(2) - Evaluate(model.Faces[0].Surface, uv).col(2);
    const auto result = FindFaceIntersections(model);
    ASSERT_TRUE(result) << result.Status.Message();
    if (gaps.minCoeff() < -1e-3 && gaps.maxCoeff() > 1e-3)
    {
      EXPECT_EQ(result->Verdict, IntersectionVerdict::Found) << seed;
      ++found;
    }
    else if (gaps.minCoeff() > 0.01)
    {
      EXPECT_EQ(result->Verdict, IntersectionVerdict::Absent) << seed;
      ++absent;
    }
  }
  EXPECT_GT(found, 10);
  EXPECT_GT(absent, 3);
}

TEST(FaceIntersections, TheSameForAnyNumberOfThreads)
{
  TrimmedModel model;
  AddBox(model, { 0, 0, 0 }, { 1, 1, 1 });
  AddBox(model, { 0.9, 0.2, 0.2 }, { 1, 0.5, 0.5 });
  FaceIntersectionParams params;
  params.Threads = 1;
  const auto one = FindFaceIntersections(model, params);
  params.Threads = 4;
  const auto four = FindFaceIntersections(model, params);
  EXPECT_EQ(one->Pairs, four->Pairs);
  ASSERT_EQ(one->Meetings.size(), four->Meetings.size());
  for (std::size_t k = 0; k < one->Meetings.size(); ++k)
  {
    EXPECT_EQ(one->Meetings[k].Position, four->Meetings[k].Position);
  }
}

// What a limit leaves open is said, and is not "absent".
TEST(FaceIntersections, TheLimitLeavesItOpen)
{
  TrimmedModel model;
  model.Faces = { Whole(Hills(3, 0.1)), Whole(Hills(3, 0.1)) };
  model.Faces[1].Surface.ControlPoints.col(2).array() += 1e-9;
  FaceIntersectionParams params;
  params.MaxPairs = 1000;
  const auto result = FindFaceIntersections(model, params);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Verdict, IntersectionVerdict::Undecided);
  ASSERT_EQ(result->Meetings.size(), 1u);
  EXPECT_GT(result->Meetings[0].OpenPlaces, 0);
}

TEST(FaceIntersections, Errors)
{
  EXPECT_EQ(FindFaceIntersections({}).Status.Code, ErrorCode::EmptyInput);
  TrimmedModel model;
  model.Faces = { Whole(Plane()) };
  FaceIntersectionParams params;
  params.Tolerance = -1.0;
  EXPECT_EQ(FindFaceIntersections(model, params).Status.Code, ErrorCode::InvalidParameter);
  params.Tolerance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(FindFaceIntersections(model, params).Status.Code, ErrorCode::InvalidParameter);
  params = {};
  params.MaxPairs = 0;
  EXPECT_EQ(FindFaceIntersections(model, params).Status.Code, ErrorCode::InvalidParameter);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(FindFaceIntersections(model, params).Status.Code, ErrorCode::Aborted);
  model.Faces[0].Surface.ControlPoints(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(FindFaceIntersections(model).Status.Code, ErrorCode::NonFiniteInput);
  model.Faces = { Whole(Plane()) };
  model.Faces[0].Surface.ControlPoints.conservativeResize(4, 2);
  EXPECT_EQ(FindFaceIntersections(model).Status.Code, ErrorCode::DimensionMismatch);
}
