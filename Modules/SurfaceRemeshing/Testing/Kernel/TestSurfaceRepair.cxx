// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceRepair.h"

#include "SimpleSolids.h"
#include "SolidOracle.h"
#include "SoupTopology.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace knotwork;

namespace
{
TriangleMesh Both(const TriangleMesh& a, const TriangleMesh& b)
{
  TriangleMesh both = a;
  const auto first = static_cast<int>(a.Points.rows());
  both.Points.conservativeResize(first + b.Points.rows(), Eigen::NoChange);
  both.Points.bottomRows(b.Points.rows()) = b.Points;
  for (const auto& t : b.Triangles)
  {
    both.Triangles.push_back({ t[0] + first, t[1] + first, t[2] + first });
  }
  return both;
}

/// What a mesher asks for, by CGAL's functions on polygon meshes.
void ExpectSolid(const TriangleMesh& mesh)
{
  EXPECT_EQ(WhyNoSolid(mesh), "");
  EXPECT_GT(SignedVolume(mesh.Points, mesh.Triangles), 0.0);
}
}

TEST(RepairSurface, SoundSurfaceStaysToTheBit_Exact)
{
  const TriangleMesh ball = Ball();
  const auto repaired = RepairSurface(ball);
  ASSERT_TRUE(repaired) << repaired.Status.Message();
  EXPECT_FALSE(repaired->Changed);
  EXPECT_EQ(repaired->Mesh.Points, ball.Points);
  EXPECT_EQ(repaired->Mesh.Triangles, ball.Triangles);
  EXPECT_EQ(repaired->Before.Euler, 2);
}

TEST(RepairSurface, TurnsTrianglesAlike_Exact)
{
  TriangleMesh box = Box();
  std::swap(box.Triangles[3][0], box.Triangles[3][1]);
  std::swap(box.Triangles[8][0], box.Triangles[8][1]);
  const auto repaired = RepairSurface(box);
  ASSERT_TRUE(repaired) << repaired.Status.Message();
  EXPECT_EQ(repaired->Count(RepairKind::TurnedFace), 2);
  EXPECT_EQ(repaired->Mesh.Points, box.Points);
  EXPECT_DOUBLE_EQ(repaired->After.Volume, 1.0);
  EXPECT_EQ(repaired->DistanceFromInput, 0.0);
  ExpectSolid(repaired->Mesh);
}

TEST(RepairSurface, DropsDuplicatesAndDegenerateTriangles_Exact)
{
  TriangleMesh box = Box();
  box.Triangles.push_back(box.Triangles[2]);
  box.Triangles.push_back({ box.Triangles[5][1], box.Triangles[5][0], box.Triangles[5][2] });
  box.Triangles.push_back({ 0, 0, 1 });
  const auto repaired = RepairSurface(box);
  ASSERT_TRUE(repaired) << repaired.Status.Message();
  EXPECT_EQ(repaired->Count(RepairKind::DuplicateFace), 2);
  EXPECT_EQ(repaired->Count(RepairKind::DegenerateFace), 1);
  EXPECT_EQ(repaired->Mesh.Triangles, Box().Triangles);
}

TEST(RepairSurface, EdgeThatEndsOnAnotherIsJoined_Exact)
{
  // one side of an edge has a point in its middle that the other one does not have
  TriangleMesh box = Box();
  box.Points.conservativeResize(9, Eigen::NoChange);
  const auto [a, b, c] = box.Triangles[0];
  box.Points.row(8) = 0.5 * (box.Points.row(a) + box.Points.row(b));
  box.Triangles[0] = { a, 8, c };
  box.Triangles.push_back({ 8, b, c });
  const auto repaired = RepairSurface(box);
  ASSERT_TRUE(repaired) << repaired.Status.Message();
  EXPECT_EQ(repaired->After.Points, 9);
  EXPECT_EQ(repaired->After.Triangles, 14);
  EXPECT_GT(repaired->Count(RepairKind::Junction), 0);
  EXPECT_NEAR(repaired->After.Volume, 1.0, 1e-15);
  ExpectSolid(repaired->Mesh);
}

TEST(RepairSurface, ClosesHolesWhenAsked_Exact)
{
  TriangleMesh ball = Ball();
  ball.Triangles.erase(ball.Triangles.begin() + 40);
  SurfaceRepairParams params;
  const auto refused = RepairSurface(ball, params);
  EXPECT_EQ(refused.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(refused.Status.Detail.find("1 hole stays, at ("), std::string::npos);
  params.LargestHole = 0.2;
  const auto repaired = RepairSurface(ball, params);
  ASSERT_TRUE(repaired) << repaired.Status.Message();
  EXPECT_EQ(repaired->Count(RepairKind::Hole), 1);
  EXPECT_EQ(repaired->After.Triangles, repaired->Before.Triangles + 1);
  EXPECT_EQ(repaired->TriangleIds.back(), -1);
  EXPECT_EQ(repaired->After.Euler, 2);
  ExpectSolid(repaired->Mesh);
  params.LargestHole = 0.0;
  params.AllowOpen = true;
  const auto open = RepairSurface(ball, params);
  ASSERT_TRUE(open) << open.Status.Message();
  EXPECT_FALSE(open->Changed);
  EXPECT_FALSE(open->Closed);
}

TEST(RepairSurface, OverlappingBoxesBecomeASolidWithAnInnerWall_Exact)
{
  const auto repaired = RepairSurface(Both(Box(), Box({ 0.5, 0.25, 0.25 }, { 1, 0.5, 0.5 })));
  ASSERT_TRUE(repaired) << repaired.Status.Message();
  EXPECT_EQ(repaired->Count(RepairKind::InnerWall), 1);
  EXPECT_EQ(repaired->After.Parts, 2);
  // union 1.125 less the common part 0.125, whose wall moved inward by 1e-4 of the diagonal
  EXPECT_NEAR(repaired->After.Volume, 1.0, 1e-3);
  EXPECT_LT(repaired->DistanceFromInput, 3e-4 * repaired->Diagonal);
  EXPECT_LT(repaired->DistanceToInput, 3e-4 * repaired->Diagonal);
  ExpectSolid(repaired->Mesh);
}

TEST(RepairSurface, ShallowOverlapIsGone_Exact)
{
  // what the boxes have in common is a thin bar along their edges
  SurfaceRepairParams params;
  params.OverlapDepth = 0.01;
  const auto repaired =
    RepairSurface(Both(Box(), Box({ 0.99, 0.99, 0.25 }, { 1, 1, 0.5 })), params);
  ASSERT_TRUE(repaired) << repaired.Status.Message();
  EXPECT_EQ(repaired->Count(RepairKind::Overlap), 1);
  EXPECT_EQ(repaired->Count(RepairKind::InnerWall), 0);
  EXPECT_EQ(repaired->After.Parts, 1);
  EXPECT_NEAR(repaired->After.Volume, 1.0 + 0.5 - 0.01 * 0.01 * 0.5, 1e-12);
  EXPECT_LE(repaired->DistanceToInput, 0.0101);
  ExpectSolid(repaired->Mesh);
}

TEST(RepairSurface, BoxesThatTouchAtAnEdgeAreDivided_Property)
{
  const auto repaired = RepairSurface(Both(Box(), Box({ 1, 1, 0 })));
  ASSERT_TRUE(repaired) << repaired.Status.Message();
  EXPECT_EQ(repaired->Count(RepairKind::DividedEdge), 1);
  EXPECT_NEAR(repaired->After.Volume, 2.0, 1e-2);
  ExpectSolid(repaired->Mesh);
}

namespace
{
/// A ball with damages of one kind, at places by chance.
TriangleMesh DamagedBall(unsigned seed)
{
  std::mt19937 random(seed);
  TriangleMesh ball = Ball();
  const auto any = [&](std::size_t count) { return random() % count; };
  for (Eigen::Index i = 0; i < ball.Points.rows(); ++i) // nothing is in a plane by design
  {
    ball.Points.row(i) *= 1.0 + 1e-5 * static_cast<double>(any(1000));
  }
  for (int i = 0; i < 3; ++i)
  {
    const std::size_t t = any(ball.Triangles.size());
    const auto point = static_cast<Eigen::Index>(any(static_cast<std::size_t>(ball.Points.rows())));
    switch (seed % 6)
    {
      case 0: // a hole
        ball.Triangles.erase(ball.Triangles.begin() + static_cast<std::ptrdiff_t>(t));
        break;
      case 1: // flipped
        std::swap(ball.Triangles[t][0], ball.Triangles[t][1]);
        break;
      case 2: // duplicated, the second time turned over
        ball.Triangles.push_back(ball.Triangles[t]);
        if (i == 1)
        {
          std::swap(ball.Triangles.back()[0], ball.Triangles.back()[1]);
        }
        break;
      case 3: // a tip that passes through the other side
        ball.Points.row(point) = 1.1 * ball.Points.row(static_cast<Eigen::Index>(any(200)));
        break;
      case 4: // a neighbour's fan is folded over
      {
        const MeshTriangle corners = ball.Triangles[t];
        ball.Points.row(corners[0]) =
          0.5 * (ball.Points.row(corners[1]) + ball.Points.row(corners[2])) +
          0.6 * (ball.Points.row(corners[1]) - ball.Points.row(corners[0]));
        break;
      }
      default: // slivers: an edge is divided on one side only, and a triangle on a line fills the
               // gap
      {
        const MeshTriangle corners = ball.Triangles[t];
        const auto middle = static_cast<int>(ball.Points.rows());
        ball.Points.conservativeResize(middle + 1, Eigen::NoChange);
        ball.Points.row(middle) = 0.5 * (ball.Points.row(corners[0]) + ball.Points.row(corners[1]));
        ball.Triangles[t] = { corners[0], middle, corners[2] };
        ball.Triangles.push_back({ middle, corners[1], corners[2] });
        if (i != 1)
        {
          ball.Triangles.push_back({ corners[0], corners[1], middle });
        }
        break;
      }
    }
  }
  return ball;
}
}

class DamagedBalls : public testing::TestWithParam<unsigned>
{
};

TEST_P(DamagedBalls, AreRepaired_Property)
{
  for (unsigned seed = GetParam(); seed < 54; seed += 6)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const TriangleMesh ball = DamagedBall(seed);
    SurfaceRepairParams params;
    params.LargestHole = 0.2;
    const auto repaired = RepairSurface(ball, params);
    ASSERT_TRUE(repaired) << repaired.Status.Message();
    EXPECT_TRUE(repaired->Changed);
    ExpectSolid(repaired->Mesh);
    constexpr double Bound = 1e-3;
    EXPECT_LE(repaired->DistanceFromInput, Bound * repaired->Diagonal);
    EXPECT_LE(repaired->DistanceToInput, Bound * repaired->Diagonal);
    EXPECT_LE(SampledDistance(ball, repaired->Mesh), repaired->DistanceToInput + 1e-12);
    if (repaired->Count(RepairKind::Hole) == 0)
    {
      EXPECT_LE(SampledDistance(repaired->Mesh, ball), repaired->DistanceFromInput + 1e-12);
    }
    params.LargestHole = 0.0;
    const auto again = RepairSurface(repaired->Mesh, params);
    ASSERT_TRUE(again) << again.Status.Message();
    EXPECT_FALSE(again->Changed);
  }
}
INSTANTIATE_TEST_SUITE_P(RepairSurface, DamagedBalls, testing::Range(0U, 6U));

TEST(RepairSurface, CrumpledPlacesArePatched_Property)
{
  // points of a cap are moved by some edges each: where sheets do not come apart, it is made anew
  int patched = 0;
  for (const unsigned seed : { 1U, 4U, 5U })
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1.0, 1.0);
    TriangleMesh ball = Ball(32);
    for (Eigen::Index i = 0; i < ball.Points.rows(); ++i)
    {
      if (ball.Points(i, 0) > 0.92)
      {
        ball.Points.row(i) += 0.25 * Eigen::RowVector3d(real(random), real(random), real(random));
      }
    }
    SurfaceRepairParams params;
    params.Limit = 0.2; // what is moved goes
    const auto repaired = RepairSurface(ball, params);
    ASSERT_TRUE(repaired) << repaired.Status.Message();
    ExpectSolid(repaired->Mesh);
    EXPECT_NEAR(repaired->After.Volume, 4.18, 0.1); // of the cap some 0.1
    EXPECT_LE(SampledDistance(ball, repaired->Mesh), repaired->DistanceToInput + 1e-12);
    EXPECT_LE(SampledDistance(repaired->Mesh, ball), repaired->DistanceFromInput + 1e-12);
    if (repaired->Count(RepairKind::Patch) > 0)
    {
      ++patched;
      EXPECT_EQ(repaired->Count(RepairKind::InnerWall), 0);
      params.Limit = 0.01;
      const auto refused = RepairSurface(ball, params);
      EXPECT_EQ(refused.Status.Code, ErrorCode::NotConverged);
      EXPECT_NE(refused.Status.Detail.find("raise Limit"), std::string::npos);
    }
  }
  EXPECT_GT(patched, 0);
}

TEST(RepairSurface, OneThreadAndManyGiveTheSame_Exact)
{
  const TriangleMesh boxes = Both(Box(), Box({ 0.5, 0.25, 0.25 }, { 1, 0.5, 0.5 }));
  SurfaceRepairParams params;
  params.Threads = 1;
  const auto one = RepairSurface(boxes, params);
  params.Threads = 4;
  const auto many = RepairSurface(boxes, params);
  ASSERT_TRUE(one);
  EXPECT_EQ(one->Mesh.Points, many->Mesh.Points);
  EXPECT_EQ(one->Mesh.Triangles, many->Mesh.Triangles);
}

TEST(RepairSurface, WhatIsNoMeshIsRefused)
{
  EXPECT_EQ(RepairSurface({}).Status.Code, ErrorCode::EmptyInput);
  TriangleMesh box = Box();
  box.Triangles[1][2] = 8;
  EXPECT_EQ(RepairSurface(box).Status.Code, ErrorCode::InvalidTopology);
  box = Box();
  box.Points(3, 1) = std::numeric_limits<double>::quiet_NaN();
  const auto refused = RepairSurface(box);
  EXPECT_EQ(refused.Status.Code, ErrorCode::NonFiniteInput);
  EXPECT_NE(refused.Status.Detail.find("point 3"), std::string::npos);
  SurfaceRepairParams params;
  params.Limit = 2.0;
  EXPECT_EQ(RepairSurface(Box(), params).Status.Code, ErrorCode::InvalidParameter);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(RepairSurface(Box(), params).Status.Code, ErrorCode::Aborted);
}

TEST(RepairSurface, WhatHasOneSideIsNamed)
{
  TriangleMesh strip;
  constexpr int Count = 12;
  strip.Points.resize(2 * Count, 3);
  for (int i = 0; i < Count; ++i)
  {
    const double u = 2 * M_PI * i / Count;
    for (int side = 0; side < 2; ++side)
    {
      const double r = 2.0 + (side - 0.5) * std::cos(0.5 * u);
      strip.Points.row(2 * i + side) << r * std::cos(u), r * std::sin(u),
        (side - 0.5) * std::sin(0.5 * u);
    }
  }
  for (int i = 0; i < Count; ++i)
  {
    const int turn = i + 1 == Count ? 1 : 0;
    const int next = 2 * ((i + 1) % Count);
    strip.Triangles.push_back({ 2 * i, next + turn, 2 * i + 1 });
    strip.Triangles.push_back({ 2 * i + 1, next + turn, next + 1 - turn });
  }
  SurfaceRepairParams params;
  params.AllowOpen = true;
  const auto refused = RepairSurface(strip, params);
  EXPECT_EQ(refused.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(refused.Status.Detail.find("one side"), std::string::npos) << refused.Status.Detail;
}

TEST(SurfaceRepair, WrapsWhatCannotBeRepaired_PropertyOracle)
{
  TriangleMesh open = Box();
  open.Triangles.resize(10); // without a side
  SurfaceRepairParams params;
  EXPECT_FALSE(RepairSurface(open, params));
  params.AlphaWrap = true;
  params.WrapAlpha = 0.1;
  params.WrapOffset = 0.01;
  const auto wrap = RepairSurface(open, params);
  ASSERT_TRUE(wrap) << wrap.Status.Message();
  EXPECT_TRUE(wrap->Wrapped);
  EXPECT_NE(wrap->WrapReason.find("1 hole stays"), std::string::npos) << wrap->WrapReason;
  EXPECT_EQ(WhyNoSolid(wrap->Mesh), "");
  EXPECT_TRUE(wrap->Actions.empty());
  EXPECT_EQ(wrap->After.Euler, 2);
  // the ball does not reach into corners
  EXPECT_LE(wrap->DistanceFromInput, 0.1 * wrap->Diagonal);
  EXPECT_LE(wrap->DistanceToInput, 2.0 * 0.01 * wrap->Diagonal);
  EXPECT_GE(wrap->DistanceFromInput, SampledDistance(wrap->Mesh, open));
  // what can be repaired is
  const auto repaired = RepairSurface(Box(), params);
  ASSERT_TRUE(repaired);
  EXPECT_FALSE(repaired->Wrapped);
  EXPECT_FALSE(repaired->Changed);
  params.WrapOffset = 0.0;
  EXPECT_EQ(RepairSurface(Box(), params).Status.Code, ErrorCode::InvalidParameter);
}
