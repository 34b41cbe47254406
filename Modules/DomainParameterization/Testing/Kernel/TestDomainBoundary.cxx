// SPDX-License-Identifier: BSD-3-Clause
#include "DomainCases.h"
#include "DomainMeasure.h"
#include "RandomSplines.h"
#include <knotwork/SplineCore/BezierForm.h>

#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
using oracle::Random;

/// Parameters of the given side at parameters of the map's side.
template <int Dim>
std::array<double, Dim - 1> GivenParameters(
  const SideOrigin& origin, const Spline<Dim - 1>& given, const std::array<double, Dim - 1>& u)
{
  std::array<double, Dim - 1> result{};
  for (int k = 0; k < Dim - 1; ++k)
  {
    const KnotVector& knots = given.Space->Knots[origin.Axis[k]];
    const double t = origin.Reversed[k] ? 1.0 - u[k] : u[k];
    result[origin.Axis[k]] = knots.Begin() + t * (knots.End() - knots.Begin());
  }
  return result;
}

/// Largest distance between the given sides and the compatible ones at random parameters.
template <int Dim>
double LargestChange(
  Random& random, const DomainBoundary<Dim>& given, const CompatibleBoundary<Dim>& compatible)
{
  double largest = 0.0;
  for (std::size_t s = 0; s < 2 * Dim; ++s)
  {
    const SideOrigin& origin = compatible.Origins[s];
    const Spline<Dim - 1>& side = given.Sides[static_cast<std::size_t>(origin.Input)];
    for (int i = 0; i < 40; ++i)
    {
      std::array<double, Dim - 1> u{};
      for (double& t : u)
      {
        t = random.Unit();
      }
      const auto a = oracle::Evaluate<Dim - 1>(side, GivenParameters<Dim>(origin, side, u));
      const auto b = oracle::Evaluate<Dim - 1>(compatible.Sides[s], u);
      for (std::size_t c = 0; c < Dim; ++c)
      {
        largest = std::max(largest, std::abs(a[c] - b[c]));
      }
    }
  }
  return largest;
}

/// Every side of a random map over its own random knots in between: elevated and refined at random.
Spline<1> Disguised(Random& random, Spline<1> side)
{
  side = ElevateDegree<1>(side, 0, random.Int(0, 2)).Value;
  std::vector<double> knots;
  for (int i = random.Int(0, 3); i > 0; --i)
  {
    knots.push_back(random.In(0.05, 0.95));
  }
  side = InsertKnots<1>(side, 0, knots).Value;
  const double begin = random.In(-3.0, 3.0);
  const double length = random.In(0.5, 4.0);
  std::vector<double> moved = side.Space->Knots[0].Knots();
  for (double& t : moved)
  {
    t = begin + length * t;
  }
  side.Space =
    MakeTensorSpace<1>({ KnotVector::Create(side.Space->Knots[0].Degree(), moved).Value }).Value;
  return random.Unit() < 0.5 ? cases::Backwards(side) : side;
}

/// Unit-square map with random bumps, rational or not.
Spline<2> RandomMap(Random& random, bool rational)
{
  const std::array<KnotVector, 2> knots{ KnotVector::Uniform(random.Int(1, 4), random.Int(1, 3)),
    KnotVector::Uniform(random.Int(1, 4), random.Int(1, 3)) };
  Spline<2> map = cases::GrevilleMap<2>(knots,
    [&](const std::array<double, 2>& u) {
      return std::array<double, 2>{ u[0] + random.In(-0.1, 0.1), u[1] + random.In(-0.1, 0.1) };
    });
  if (rational)
  {
    map.Weights.resize(map.Space->NumFunctions);
    for (double& w : map.Weights)
    {
      w = random.In(0.5, 2.0);
    }
  }
  return map;
}

TEST(DomainBoundary, CurvesInAnyOrderAndDirectionKeepTheirGeometry_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Spline<2> map = RandomMap(random, seed % 2 == 0);
    DomainBoundary<2> boundary = cases::SidesOf<2>(map);
    for (Spline<1>& side : boundary.Sides)
    {
      side = Disguised(random, side);
    }
    for (std::size_t i = 3; i > 0; --i)
    {
      std::swap(boundary.Sides[i], boundary.Sides[static_cast<std::size_t>(random.Int(0, int(i)))]);
    }
    const auto compatible = MakeCompatible<2>(boundary);
    ASSERT_TRUE(compatible) << compatible.Status.Message();
    // rounding of the knots' affine change times the curves' speed, weights in [1/2, 2]
    EXPECT_LE(LargestChange<2>(random, boundary, compatible.Value), 1e-13);
    EXPECT_GT(SignedMeasure<2>(compatible->Sides), 0.0);
    EXPECT_EQ(compatible->Origins[0].Input, 0);
    for (std::size_t d = 0; d < 2; ++d)
    {
      const KnotVector& knots = compatible->Knots[d];
      EXPECT_EQ(knots.Begin(), 0.0);
      EXPECT_EQ(knots.End(), 1.0);
      EXPECT_TRUE(compatible->Sides[2 - 2 * d].Space->Knots[0] == knots);
      EXPECT_TRUE(compatible->Sides[3 - 2 * d].Space->Knots[0] == knots);
    }
    // shared corners are the same bits
    const auto& sides = compatible->Sides;
    for (int corner = 0; corner < 4; ++corner)
    {
      const Spline<1>& a = sides[static_cast<std::size_t>(corner & 1)];
      const Spline<1>& b = sides[static_cast<std::size_t>(2 + (corner >> 1))];
      const Eigen::Index i = corner >> 1 ? a.ControlPoints.rows() - 1 : 0;
      const Eigen::Index j = corner & 1 ? b.ControlPoints.rows() - 1 : 0;
      EXPECT_TRUE(a.ControlPoints.row(i) == b.ControlPoints.row(j));
      if (a.IsRational())
      {
        EXPECT_EQ(a.Weights[i], b.Weights[j]);
      }
    }
  }
}

TEST(DomainBoundary, FacesInAnyOrderAndDirectionKeepTheirGeometry_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const std::array<KnotVector, 3> knots{ KnotVector::Uniform(random.Int(1, 3), random.Int(1, 2)),
      KnotVector::Uniform(random.Int(1, 3), random.Int(1, 2)),
      KnotVector::Uniform(random.Int(1, 3), random.Int(1, 2)) };
    const Spline<3> map = cases::GrevilleMap<3>(knots,
      [&](const std::array<double, 3>& u)
      {
        return std::array<double, 3>{ u[0] + random.In(-0.1, 0.1), u[1] + random.In(-0.1, 0.1),
          u[2] + random.In(-0.1, 0.1) };
      });
    DomainBoundary<3> boundary = cases::SidesOf<3>(map);
    for (std::size_t s = 0; s < 6; ++s) // opposite faces get knots of their own
    {
      boundary.Sides[s] =
        InsertKnots<2>(boundary.Sides[s], random.Int(0, 1), { random.In(0.1, 0.9) }).Value;
      if (random.Unit() < 0.5) // the directions exchanged
      {
        const Spline<2> side = boundary.Sides[s];
        Spline<2> turned = side;
        turned.Space = MakeTensorSpace<2>({ side.Space->Knots[1], side.Space->Knots[0] }).Value;
        const int n = side.Space->Knots[0].NumFunctions();
        const int m = side.Space->Knots[1].NumFunctions();
        for (int i = 0; i < n; ++i)
        {
          for (int j = 0; j < m; ++j)
          {
            turned.ControlPoints.row(j + m * i) = side.ControlPoints.row(i + n * j);
          }
        }
        boundary.Sides[s] = turned;
      }
    }
    for (std::size_t i = 5; i > 0; --i)
    {
      std::swap(boundary.Sides[i], boundary.Sides[static_cast<std::size_t>(random.Int(0, int(i)))]);
    }
    const auto compatible = MakeCompatible<3>(boundary);
    ASSERT_TRUE(compatible) << compatible.Status.Message();
    EXPECT_LE(LargestChange<3>(random, boundary, compatible.Value), 1e-13);
    EXPECT_GT(SignedMeasure<3>(compatible->Sides), 0.0);
  }
}

TEST(DomainBoundary, AreaOfAnnulusSectorAndVolumeOfBox_ExactOracle)
{
  const auto sector = MakeCompatible<2>(cases::AnnulusSector());
  ASSERT_TRUE(sector) << sector.Status.Message();
  EXPECT_TRUE(sector->IsRational());
  // 2p + 1 + 12 Gauss points on one rational quadratic element
  EXPECT_NEAR(SignedMeasure<2>(sector->Sides), cases::Pi * (4 - 1) / 4, 1e-13);
  const Spline<3> box = cases::GrevilleMap<3>(
    { KnotVector::Uniform(1, 1), KnotVector::Uniform(2, 2), KnotVector::Uniform(1, 1) },
    [](const std::array<double, 3>& u) {
      return std::array<double, 3>{ 2 * u[0] + 5, 3 * u[1], 4 * u[2] + u[0] };
    });
  const auto compatible = MakeCompatible<3>(cases::SidesOf<3>(box));
  ASSERT_TRUE(compatible) << compatible.Status.Message();
  EXPECT_NEAR(SignedMeasure<3>(compatible->Sides), 24.0, 1e-12);
}

TEST(DomainBoundary, SidesInTheMapsOwnOrderStayAsTheyAre_ExactOracle)
{
  const auto compatible = MakeCompatible<2>(cases::Square());
  ASSERT_TRUE(compatible) << compatible.Status.Message();
  for (int s = 0; s < 4; ++s)
  {
    EXPECT_EQ(compatible->Origins[static_cast<std::size_t>(s)].Input, s);
    EXPECT_FALSE(compatible->Origins[static_cast<std::size_t>(s)].Reversed[0]);
  }
  // a left-handed order: the last direction is reversed
  DomainBoundary<2> mirrored = cases::Square();
  std::swap(mirrored.Sides[0], mirrored.Sides[1]);
  const auto right = MakeCompatible<2>(mirrored);
  ASSERT_TRUE(right) << right.Status.Message();
  EXPECT_EQ(right->Origins[0].Input, 0);
  EXPECT_TRUE(right->Origins[0].Reversed[0]);
  EXPECT_GT(SignedMeasure<2>(right->Sides), 0.0);
}

TEST(DomainBoundary, UnequalCornerWeightsAreMatchedByALinearFunction_ExactOracle)
{
  DomainBoundary<2> boundary = cases::AnnulusSector();
  // the same segment with weights 1 and 3 at its ends is another parameterization; with the arcs'
  // own end weights no constants fit
  boundary.Sides[3].Weights = Eigen::Vector2d(1.0, 3.0);
  Random random(1);
  const auto compatible = MakeCompatible<2>(boundary);
  ASSERT_TRUE(compatible) << compatible.Status.Message();
  EXPECT_LE(LargestChange<2>(random, boundary, compatible.Value), 1e-13);
  EXPECT_EQ(compatible->Knots[1].Degree(), 3); // one more than the arcs'
}

TEST(DomainBoundary, ConstantWeightsArePolynomial_ExactOracle)
{
  DomainBoundary<2> boundary = cases::Square();
  for (Spline<1>& side : boundary.Sides)
  {
    side.Weights = Eigen::Vector2d(0.7, 0.7);
  }
  const auto compatible = MakeCompatible<2>(boundary);
  ASSERT_TRUE(compatible) << compatible.Status.Message();
  EXPECT_FALSE(compatible->IsRational());
}

TEST(DomainBoundary, UnclampedCurvesAreClamped_PropertyOracle)
{
  Random random(5);
  Spline<1> curve;
  curve.Space = MakeTensorSpace<1>({ KnotVector::Create(2, { -2, -1, 0, 1, 2, 3, 4, 5 }).Value })
                  .Value; // domain [0, 3]
  curve.ControlPoints.resize(5, 2);
  curve.ControlPoints << 0, -0.2, 0.3, 0.1, 0.5, -0.1, 0.8, 0.2, 1.1, 0.0;
  const auto begin = oracle::Evaluate<1>(curve, { 0.0 });
  const auto end = oracle::Evaluate<1>(curve, { 3.0 });
  DomainBoundary<2> boundary = cases::Square();
  boundary.Sides[2] = curve;
  boundary.Sides[0] = cases::Segment({ begin[0], begin[1] }, { 0, 1 });
  boundary.Sides[1] = cases::Segment({ end[0], end[1] }, { 1, 1 });
  const auto compatible = MakeCompatible<2>(boundary);
  ASSERT_TRUE(compatible) << compatible.Status.Message();
  EXPECT_LE(LargestChange<2>(random, boundary, compatible.Value), 1e-13);
}

TEST(DomainBoundary, GapNamesCornerSidesAndDistance_GoldenOracle)
{
  DomainBoundary<2> boundary = cases::Square();
  boundary.Sides[3].ControlPoints(1, 1) = 1.25; // the north curve's end
  const auto compatible = MakeCompatible<2>(boundary);
  EXPECT_EQ(compatible.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(compatible.Status.Detail.find("gap of 0.25"), std::string::npos)
    << compatible.Status.Detail;
  EXPECT_NE(
    compatible.Status.Detail.find("(u = 1, v = 1) between side 1 and side 3"), std::string::npos)
    << compatible.Status.Detail;
  BoundaryParams loose;
  loose.GapTolerance = 0.1;
  boundary.Sides[3].ControlPoints(1, 1) = 1.001;
  const auto closed = MakeCompatible<2>(boundary, loose);
  ASSERT_TRUE(closed) << closed.Status.Message();
  EXPECT_NEAR(closed->LargestGap, 0.001, 1e-12);
}

TEST(DomainBoundary, EveryFailureIsReachable)
{
  const auto code = [](const DomainBoundary<2>& boundary)
  { return MakeCompatible<2>(boundary).Status.Code; };
  EXPECT_EQ(code({}), ErrorCode::EmptyInput);
  DomainBoundary<2> boundary = cases::Square();
  boundary.Sides.pop_back();
  EXPECT_EQ(code(boundary), ErrorCode::SizeMismatch);
  boundary = cases::Square();
  boundary.Sides[1].ControlPoints(0, 0) = std::nan("");
  EXPECT_EQ(code(boundary), ErrorCode::NonFiniteInput);
  EXPECT_EQ(MakeCompatible<2>(boundary).Status.Detail.rfind("side 1: ", 0), 0u);
  boundary = cases::Square();
  boundary.Sides[1].ControlPoints = PointMatrix::Zero(2, 1);
  EXPECT_EQ(code(boundary), ErrorCode::DimensionMismatch);
  boundary = cases::Square();
  for (std::size_t s = 0; s < 4; ++s)
  {
    boundary.Sides[s].ControlPoints.conservativeResize(2, 3);
    boundary.Sides[s].ControlPoints.col(2).setConstant(2.0);
  }
  EXPECT_EQ(code(boundary), ErrorCode::Ok); // one plane of constant z
  boundary.Sides[1].ControlPoints(1, 2) = 2.5;
  EXPECT_EQ(code(boundary), ErrorCode::DimensionMismatch);
  boundary = cases::Square();
  for (Spline<1>& side : boundary.Sides)
  {
    side.ControlPoints.col(1).setZero();
  }
  EXPECT_EQ(code(boundary), ErrorCode::InvalidTopology); // encloses nothing
  BoundaryParams params;
  params.GapTolerance = -1.0;
  EXPECT_EQ(MakeCompatible<2>(cases::Square(), params).Status.Code, ErrorCode::InvalidParameter);

  // faces whose common edge runs differently, and faces whose weights do not fit
  const Spline<3> box = cases::GrevilleMap<3>(
    { KnotVector::Uniform(2, 1), KnotVector::Uniform(2, 1), KnotVector::Uniform(2, 1) },
    [](const std::array<double, 3>& u) { return u; });
  DomainBoundary<3> faces = cases::SidesOf<3>(box);
  faces.Sides[0].ControlPoints(1, 1) += 0.1; // middle of an edge
  const auto gap = MakeCompatible<3>(faces);
  EXPECT_EQ(gap.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(gap.Status.Detail.find("gap of 0.1"), std::string::npos) << gap.Status.Detail;
  faces = cases::SidesOf<3>(box);
  faces.Sides[0].Weights = Eigen::VectorXd::Ones(9);
  faces.Sides[0].Weights[1] = 2.0;
  EXPECT_EQ(MakeCompatible<3>(faces).Status.Code, ErrorCode::InvalidWeight);
}
}
}
