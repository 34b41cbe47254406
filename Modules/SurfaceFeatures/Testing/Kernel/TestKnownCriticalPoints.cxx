// SPDX-License-Identifier: BSD-3-Clause
// Functions whose critical points are known.
#include "CriticalCases.h"

namespace knotwork::testing
{
namespace
{
bool InCluster(const CriticalPoints& found, double u, double v)
{
  for (const CriticalBox& box : found.Boxes)
  {
    if (box.Box.Lower[0] <= u && u <= box.Box.Upper[0] && box.Box.Lower[1] <= v &&
      v <= box.Box.Upper[1])
    {
      return true;
    }
  }
  return false;
}

/// a(u) + b(v), each given by its coefficients.
Spline<2> SumOf(const std::array<KnotVector, 2>& knots, const std::vector<double>& a,
  const std::vector<double>& b)
{
  Spline<2> f;
  f.Space = MakeTensorSpace<2>(knots).Value;
  f.ControlPoints.resize(f.Space->NumFunctions, 1);
  for (std::size_t i = 0; i < a.size() * b.size(); ++i)
  {
    f.ControlPoints(static_cast<Eigen::Index>(i), 0) = a[i % a.size()] + b[i / a.size()];
  }
  return f;
}
}

TEST(CriticalPoints, DoubleWell_ExactOracle)
{
  // f = u^4 / 4 - u^2 / 2 + v^2 / 2; with four elements a direction its points lie on corners
  for (const int elements : { 1, 2, 3, 4, 7 })
  {
    SCOPED_TRACE(elements);
    const CriticalPoints found =
      Find(PolynomialOn(-2.0, 2.0, 4, elements, { { 0.25, 4, 0 }, { -0.5, 2, 0 }, { 0.5, 0, 2 } }));
    const CriticalPlace well = elements == 4 ? CriticalPlace::Edge
      : elements % 2 == 0                    ? CriticalPlace::Edge
                                             : CriticalPlace::Interior;
    EXPECT_TRUE(found.Proved) << Summary(found);
    EXPECT_EQ(found.Points.size(), 3u + 4u + 2u + 6u) << Summary(found);
    ExpectPoint(found, -1.0, 0.0, CriticalKind::Minimum, well, 1);
    ExpectPoint(found, 1.0, 0.0, CriticalKind::Minimum, well, 1);
    ExpectPoint(found, 0.0, 0.0, CriticalKind::Saddle, well, -1);
    for (const double u : { -2.0, 2.0 })
    {
      ExpectPoint(found, u, 0.0, CriticalKind::Saddle, CriticalPlace::Boundary, 0);
      ExpectPoint(found, u, -2.0, CriticalKind::Maximum, CriticalPlace::Corner, 0, 0.0);
      ExpectPoint(found, -1.0, u, CriticalKind::Saddle, CriticalPlace::Boundary, 0);
      ExpectPoint(found, 0.0, u, CriticalKind::Maximum, CriticalPlace::Boundary, 0);
    }
    const CriticalPoint* minimum = At(found, 1.0, 0.0, 1e-12);
    ASSERT_NE(minimum, nullptr);
    EXPECT_NEAR(minimum->Value, -0.25, 1e-13);
    EXPECT_NEAR(minimum->Eigenvalues[0], 1.0, 1e-10);
    EXPECT_NEAR(minimum->Eigenvalues[1], 2.0, 1e-10);
    const CriticalPoint* side = At(found, 2.0, 0.0, 1e-12);
    ASSERT_NE(side, nullptr);
    EXPECT_EQ(side->InwardSign, -1);
  }
}

TEST(CriticalPoints, ACubicOfTwoNearPoints_ExactOracle)
{
  // f = u^3 / 3 - e^2 u + v^2 / 2: a minimum at e and a saddle at -e in one element
  for (const double e : { 1e-1, 1e-3, 1e-5 })
  {
    SCOPED_TRACE(e);
    CriticalPointParams params;
    params.Boundary = false;
    const CriticalPoints found =
      Find(PolynomialOn(-1.0, 1.5, 3, 1, { { 1.0 / 3.0, 3, 0 }, { -e * e, 1, 0 }, { 0.5, 0, 2 } }),
        params);
    EXPECT_TRUE(found.Proved) << Summary(found);
    ASSERT_EQ(found.Points.size(), 2u);
    // the error of the slope, some 1e-13, over the curvature 2 e
    const double tolerance = 1e-12 / e;
    ExpectPoint(found, e, 0.0, CriticalKind::Minimum, CriticalPlace::Interior, 1, tolerance);
    ExpectPoint(found, -e, 0.0, CriticalKind::Saddle, CriticalPlace::Interior, -1, tolerance);
  }
}

TEST(CriticalPoints, CurvatureMayJumpAtAnEdge_ExactOracle)
{
  const KnotVector knots = BreakKnots(2, { -1.0, 0.0, 1.0 });
  // u^2 before and 3 u^2 behind the knot
  const CriticalPoints bowl = Find(SumOf({ knots, knots }, { 1, 0, 0, 3 }, { 1, 0, 0, 2 }));
  EXPECT_TRUE(bowl.Proved) << Summary(bowl);
  ExpectPoint(bowl, 0.0, 0.0, CriticalKind::Minimum, CriticalPlace::Edge, 1);
  const CriticalPoints saddle = Find(SumOf({ knots, knots }, { 1, 0, 0, 3 }, { -1, 0, 0, -2 }));
  EXPECT_TRUE(saddle.Proved) << Summary(saddle);
  ExpectPoint(saddle, 0.0, 0.0, CriticalKind::Saddle, CriticalPlace::Edge, -1);
  // u |u| + v^2: the index is 0, neither kind
  const CriticalPoints neither = Find(SumOf({ knots, knots }, { -1, 0, 0, 1 }, { 1, 0, 0, 1 }));
  EXPECT_FALSE(neither.Proved);
  EXPECT_TRUE(InCluster(neither, 0.0, 0.0));
  EXPECT_EQ(At(neither, 0.0, 0.0, 1e-3), nullptr);
}

TEST(CriticalPoints, CreasesAreClassifiedByTheirSides_ExactOracle)
{
  const KnotVector sharp = BreakKnots(2, { -1.0, 0.0, 1.0 }, 2);
  const KnotVector smooth = BreakKnots(2, { -1.0, 0.3, 1.0 });
  const std::vector<double> kink{ 1, 0.5, 0, 0.5, 1 };     // |u|
  const std::vector<double> roof{ -1, -0.5, 0, -0.5, -1 }; // -|u|
  const std::vector<double> skew{ -1, -0.5, 0, 1, 2 };     // u + ..., no sign change
  const std::vector<double> bowl{ 1, -0.3, -0.3, 1 };      // some quadratic, smooth at 0.3
  const auto at = [&](const std::vector<double>& b, const KnotVector& v)
  {
    CriticalPointParams params;
    params.Boundary = false;
    const CriticalPoints found = Find(SumOf({ sharp, v }, kink, b), params);
    return found;
  };
  // bowl's minimum on the knot or off it is one point on the crease
  const CriticalPoints valley = at(bowl, smooth);
  EXPECT_TRUE(valley.Proved) << Summary(valley);
  ASSERT_EQ(valley.Points.size(), 1u);
  EXPECT_EQ(valley.Points[0].Kind, CriticalKind::Minimum);
  EXPECT_EQ(valley.Points[0].Place, CriticalPlace::Crease);
  EXPECT_EQ(valley.Points[0].Parameters[0], 0.0);
  CriticalPointParams params;
  params.Boundary = false;
  const CriticalPoints ridge = Find(SumOf({ sharp, smooth }, roof, bowl), params);
  ASSERT_EQ(ridge.Points.size(), 1u) << Summary(ridge);
  EXPECT_EQ(ridge.Points[0].Kind, CriticalKind::Saddle);
  EXPECT_EQ(ridge.Points[0].Index, -1);
  const CriticalPoints passing = Find(SumOf({ sharp, smooth }, skew, bowl), params);
  EXPECT_EQ(passing.Points.size(), 0u) << Summary(passing);
  EXPECT_TRUE(passing.Proved) << Summary(passing);
  // where two creases cross
  const CriticalPoints cone = at(kink, sharp);
  EXPECT_TRUE(cone.Proved) << Summary(cone);
  ASSERT_EQ(cone.Points.size(), 1u);
  ExpectPoint(cone, 0.0, 0.0, CriticalKind::Minimum, CriticalPlace::Crease, 1, 0.0);
  const CriticalPoints cross = at(roof, sharp);
  ASSERT_EQ(cross.Points.size(), 1u) << Summary(cross);
  ExpectPoint(cross, 0.0, 0.0, CriticalKind::Saddle, CriticalPlace::Crease, -1, 0.0);
  const CriticalPoints peak = Find(SumOf({ sharp, sharp }, roof, roof), params);
  ASSERT_EQ(peak.Points.size(), 1u) << Summary(peak);
  ExpectPoint(peak, 0.0, 0.0, CriticalKind::Maximum, CriticalPlace::Crease, 1, 0.0);
  const CriticalPoints none = at(skew, sharp);
  EXPECT_EQ(none.Points.size(), 0u) << Summary(none);
  EXPECT_TRUE(none.Proved) << Summary(none);
}

TEST(CriticalPoints, ACreasePointOnASmoothKnot_ExactOracle)
{
  const KnotVector sharp = BreakKnots(2, { -1.0, 0.0, 1.0 }, 2);
  const KnotVector smooth = BreakKnots(2, { -1.0, 0.0, 1.0 });
  CriticalPointParams params;
  params.Boundary = false;
  const CriticalPoints found =
    Find(SumOf({ sharp, smooth }, { 1, 0.5, 0, 0.5, 1 }, { 1, 0, 0, 2 }), params);
  EXPECT_TRUE(found.Proved) << Summary(found);
  ASSERT_EQ(found.Points.size(), 1u);
  ExpectPoint(found, 0.0, 0.0, CriticalKind::Minimum, CriticalPlace::Crease, 1);
}

TEST(CriticalPoints, AMonkeySaddleIsACluster_ExactOracle)
{
  for (const int elements : { 1, 2, 3 })
  {
    SCOPED_TRACE(elements);
    const CriticalPoints found =
      Find(PolynomialOn(-1.0, 1.0, 3, elements, { { 1.0, 3, 0 }, { -2.0, 1, 2 } }));
    ASSERT_EQ(found.Clusters.size(), 1u) << Summary(found);
    EXPECT_TRUE(InCluster(found, 0.0, 0.0));
    for (const CriticalBox& box : found.Boxes)
    {
      for (std::size_t d = 0; d < 2; ++d)
      {
        // where the gradient, about 3 r^2, is larger than its error, some 1e-13
        EXPECT_LT(std::abs(box.Box.Lower[d]), 1e-5);
        EXPECT_LT(std::abs(box.Box.Upper[d]), 1e-5);
      }
    }
    EXPECT_FALSE(found.Proved);
    EXPECT_EQ(found.IndexSum, found.EulerCharacteristic + 2);
    EXPECT_LE(found.Clusters[0].ValueBounds[0], 0.0);
    EXPECT_GE(found.Clusters[0].ValueBounds[1], 0.0);
  }
}

TEST(CriticalPoints, AValleyLineIsCoveredByBoxes_ExactOracle)
{
  const Spline<2> f = PolynomialOn(-1.0, 1.3, 3, 3, { { 1.0, 2, 0 } });
  const CriticalPoints found = Find(f);
  EXPECT_FALSE(found.Proved);
  EXPECT_GE(found.Clusters.size(), 1u);
  for (int i = 0; i <= 1000; ++i)
  {
    const double t = std::min(-1.0 + 2.3e-3 * i, 1.3);
    EXPECT_TRUE(InCluster(found, 0.0, t)) << t;
    EXPECT_TRUE(InCluster(found, -1.0, t)) << t; // constant along these sides
    EXPECT_TRUE(InCluster(found, 1.3, t)) << t;
  }
  double area = 0.0;
  for (const CriticalBox& box : found.Boxes)
  {
    area += (box.Box.Upper[0] - box.Box.Lower[0]) * (box.Box.Upper[1] - box.Box.Lower[1]);
  }
  EXPECT_LT(area, 0.2);
  EXPECT_LE(found.Boxes.size(), 2000u);
}

TEST(CriticalPoints, APlateauIsOneCluster_ExactOracle)
{
  const CriticalPoints found = Find(PolynomialOn(0.0, 1.0, 2, 4, { { 0.1, 0, 0 } }));
  ASSERT_EQ(found.Clusters.size(), 1u) << Summary(found);
  EXPECT_EQ(found.Points.size(), 0u);
  EXPECT_LE(found.Clusters[0].ValueBounds[0], 0.1);
  EXPECT_GE(found.Clusters[0].ValueBounds[1], 0.1);
  EXPECT_LT(found.NumTested, 100);
  for (const double t : { 0.0, 0.3, 1.0 })
  {
    EXPECT_TRUE(InCluster(found, t, 1.0 - t));
  }
}
}
