// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryFaults.h"
#include "HeldOutDomains.h"
#include <knotwork/SplineCore/Refinement.h>

#include <algorithm>
#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
template <int Dim>
std::vector<BoundaryFold> FoldsOf(const DomainBoundary<Dim>& boundary)
{
  std::array<bool, 2 * Dim> all;
  all.fill(true);
  return FindBoundaryFolds<Dim>(MakeCompatible<Dim>(boundary).Value, all);
}

/// The unit cube, quadratic, with the top's middle control point at height z.
DomainBoundary<3> CubeWithTop(double z)
{
  const KnotVector knots = KnotVector::Uniform(2, 1);
  DomainBoundary<3> cube = cases::SidesOf<3>(cases::GrevilleMap<3>(
    { knots, knots, knots }, [](const std::array<double, 3>& u) { return u; }));
  cube.Sides[5].ControlPoints(4, 2) = z;
  return cube;
}

TEST(BoundaryFaults, CrossingCurvesAreFoundWhereTheyCross_ExactOracle)
{
  // y = 8 t (1 - t) meets y = 1 at t = (1 -+ sqrt(1/2)) / 2, x = t
  DomainBoundary<2> boundary = cases::Square();
  boundary.Sides[2] = cases::Curve(KnotVector::Uniform(2, 1), { { 0, 0 }, { 0.5, 4 }, { 1, 0 } });
  const auto crossings = FindBoundaryCrossings<2>(MakeCompatible<2>(boundary).Value, 1);
  ASSERT_TRUE(crossings) << crossings.Status.Message();
  ASSERT_EQ(crossings->size(), 1u);
  const BoundaryCrossing& crossing = crossings->front();
  const double t = crossing.Position[0] < 0.5 ? crossing.Position[0] : 1.0 - crossing.Position[0];
  EXPECT_NEAR(t, 0.5 * (1.0 - std::sqrt(0.5)), 1e-3); // the proof's box, about
  EXPECT_NEAR(crossing.Position[1], 1.0, 1e-3);
  EXPECT_EQ(std::min(crossing.Sides[0], crossing.Sides[1]), 2);
  EXPECT_EQ(std::max(crossing.Sides[0], crossing.Sides[1]), 3);
  for (const char* part : { "the boundary crosses itself", "side 2", "side 3", " meet at (0." })
  {
    EXPECT_NE(crossing.Message.find(part), std::string::npos) << crossing.Message;
  }
}

TEST(BoundaryFaults, CurvesThatOnlyTouchDoNotCross_PropertyOracle)
{
  // a full ring: its ends are one segment; and a curve that touches the opposite side
  DomainBoundary<2> touching = cases::Square();
  touching.Sides[2] = cases::Curve(KnotVector::Uniform(2, 1), { { 0, 0 }, { 0.5, 2 }, { 1, 0 } });
  for (const DomainBoundary<2>& boundary : { cases::Square(), touching, cases::AnnulusSector() })
  {
    const auto crossings = FindBoundaryCrossings<2>(MakeCompatible<2>(boundary).Value, 1);
    ASSERT_TRUE(crossings) << crossings.Status.Message();
    EXPECT_TRUE(crossings->empty());
  }
}

TEST(BoundaryFaults, CrossingFacesAreFoundWhereTheyCross_ExactOracle)
{
  for (const double z : { -3.5, -6.0, -20.0 })
  {
    SCOPED_TRACE("height " + std::to_string(z));
    const auto crossings = FindBoundaryCrossings<3>(MakeCompatible<3>(CubeWithTop(z)).Value, 1);
    ASSERT_TRUE(crossings) << crossings.Status.Message();
    ASSERT_EQ(crossings->size(), 1u);
    const BoundaryCrossing& crossing = crossings->front();
    // top and bottom meet where 1 + (z - 1) 4 x (1 - x) y (1 - y) = 0
    const double x = crossing.Position[0];
    const double y = crossing.Position[1];
    EXPECT_NEAR(crossing.Position[2], 0.0, 1e-6);
    EXPECT_NEAR(1.0 + (z - 1.0) * 4.0 * x * (1.0 - x) * y * (1.0 - y), 0.0, 1e-6);
    EXPECT_EQ(std::min(crossing.Sides[0], crossing.Sides[1]), 4);
    EXPECT_EQ(std::max(crossing.Sides[0], crossing.Sides[1]), 5);
  }
  // above the bottom by 1 / 1000: no crossing
  const auto none = FindBoundaryCrossings<3>(MakeCompatible<3>(CubeWithTop(-2.996)).Value, 1);
  ASSERT_TRUE(none) << none.Status.Message();
  EXPECT_TRUE(none->empty());
}

TEST(BoundaryFaults, RationalFacesThatCrossAreFound_PropertyOracle)
{
  DomainBoundary<3> cube = CubeWithTop(-1.2);
  cube.Sides[5].Weights = Eigen::VectorXd::Ones(9);
  cube.Sides[5].Weights[4] = 3.0; // the weight pulls the face through the bottom
  const auto crossings = FindBoundaryCrossings<3>(MakeCompatible<3>(cube).Value, 1);
  ASSERT_TRUE(crossings) << crossings.Status.Message();
  ASSERT_EQ(crossings->size(), 1u);
  const double b = crossings->front().Position[0] * (1.0 - crossings->front().Position[0]) * 4.0 *
    crossings->front().Position[1] * (1.0 - crossings->front().Position[1]);
  EXPECT_GT(b, 0.0); // inside
  EXPECT_NEAR(crossings->front().Position[2], 0.0, 1e-6);
  cube.Sides[5].Weights[4] = 1.0;
  EXPECT_TRUE(FindBoundaryCrossings<3>(MakeCompatible<3>(cube).Value, 1)->empty());
}

TEST(BoundaryFaults, APlaneFaceThatTurnsOverIsNamed_PropertyOracle)
{
  DomainBoundary<3> cube = CubeWithTop(1.0);
  EXPECT_TRUE(FoldsOf<3>(cube).empty());
  // x = u + 4 d u (1 - u) v (1 - v) with d = 2.5: its derivative by u is 1 + 4 d (1 - 2 u) v (1 -
  // v), least at u = 1, v = 1/2, where it is 1 - d; the edge there has no share in it
  cube.Sides[5].ControlPoints(4, 0) = 3.0;
  const auto folds = FoldsOf<3>(cube);
  const auto named = std::find_if(folds.begin(), folds.end(),
    [](const BoundaryFold& fold)
    { return fold.Message.find("side 5 is a plane face") != std::string::npos; });
  ASSERT_NE(named, folds.end());
  EXPECT_EQ(named->Parameters, (std::array<double, 3>{ 1.0, 0.5, 1.0 }));
  EXPECT_NEAR(named->Det, 1.0 - 2.5, 1e-12);
  // turned in space it is the same face
  Eigen::Matrix3d turn;
  turn << 0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6;
  for (Spline<2>& side : cube.Sides)
  {
    side.ControlPoints = (side.ControlPoints * turn.transpose()).eval();
  }
  EXPECT_EQ(FoldsOf<3>(cube).size(), folds.size());
}

TEST(BoundaryFaults, ATangentOfLengthZeroIsNoFold_PropertyOracle)
{
  // control points that coincide, refined: rounding turns the zero tangents into any direction
  for (unsigned seed = 5; seed < 100; seed += 9)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const cases::HeldOut<3> domain = cases::RandomSolid(seed);
    ASSERT_EQ(domain.Kind, "sharp turns");
    ASSERT_TRUE(domain.Possible());
    Spline<3> map = domain.Known;
    for (int round = 0; round < 3; ++round)
    {
      EXPECT_TRUE(FoldsOf<3>(cases::SidesOf<3>(map)).empty()) << "refined " << round << " times";
      map = RefineAllElements<3>(map)->Value;
    }
    // far away from the origin coordinates have less digits
    map = domain.Known;
    map.ControlPoints.array() += 1000.1;
    map = RefineAllElements<3>(map)->Value;
    EXPECT_TRUE(FoldsOf<3>(cases::SidesOf<3>(map)).empty()) << "shifted";
  }
}
}
}
