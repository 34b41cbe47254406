// SPDX-License-Identifier: BSD-3-Clause
#include "DerivativeOracle.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierSpace.h>

#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
using oracle::Epsilon;

TEST(BezierForm, PlanesOfTwoSpans_GoldenOracle)
{
  // quadratic, knots 0 0 0 1 2 2 2: the function values at the break are 1/2 P1 + 1/2 P2
  Spline<1> spline;
  spline.Space = MakeTensorSpace<1>({ KnotVector::Uniform(2, 2, 0.0, 2.0) }).Value;
  spline.ControlPoints.resize(4, 2);
  spline.ControlPoints << 0, 10, 2, 20, 4, 40, 6, 60;
  const BezierForm<1> form = MakeBezierForm(spline);
  EXPECT_EQ(form.NumComponents, 2);
  EXPECT_FALSE(form.Rational);
  EXPECT_EQ(form.Offsets, (std::vector<std::size_t>{ 0, 6, 12 }));
  const std::vector<double> expected{ 0, 2, 3, 10, 20, 30, 3, 4, 6, 30, 40, 60 };
  ASSERT_EQ(form.Data.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    EXPECT_NEAR(form.Data[i], expected[i], 8 * Epsilon * expected[i]) << i;
  }
}

TEST(BezierForm, HomogeneousWithWeightsLast_GoldenOracle)
{
  Spline<2> spline;
  spline.Space = MakeTensorSpace<2>({ KnotVector::Uniform(1, 1), KnotVector::Uniform(1, 1) }).Value;
  spline.ControlPoints.resize(4, 1);
  spline.ControlPoints << 1, 2, 3, 4;
  spline.Weights.resize(4);
  spline.Weights << 1, 2, 0.5, 4;
  const BezierForm<2> form = MakeBezierForm(spline);
  EXPECT_TRUE(form.Rational);
  EXPECT_EQ(form.NumPlanes(), 2);
  EXPECT_EQ(form.Data, (std::vector<double>{ 1, 4, 1.5, 16, 1, 2, 0.5, 4 }));
}

template <int Dim>
void CompareWithDefinition(const IntArray<Dim>& degree, bool rational, unsigned seed)
{
  SCOPED_TRACE("Dim " + std::to_string(Dim) + " seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  IntArray<Dim> elements;
  elements.fill(Dim == 3 ? 2 : 4);
  const Spline<Dim> spline = RandomTensorSpline<Dim>(random, degree, elements, 2, rational);
  const BezierForm<Dim> form = MakeBezierForm(spline);
  ASSERT_EQ(form.Offsets.back(), form.Data.size());
  Spline<Dim> planes; // the homogeneous points as a polynomial spline
  planes.Space = spline.Space;
  planes.ControlPoints = spline.HomogeneousPoints();
  const int n = NumTensorFunctions<Dim>(degree);
  for (int e = 0; e < spline.Space->NumElements(); ++e)
  {
    const auto& box = spline.Space->Elements[static_cast<std::size_t>(e)].Box;
    double local[Dim];
    double u[Dim];
    for (std::size_t d = 0; d < Dim; ++d)
    {
      local[d] = RandomNumber(random, 0.01, 0.99);
      u[d] = box.Lower[d] + local[d] * (box.Upper[d] - box.Lower[d]);
    }
    const Eigen::MatrixXd expected = OracleEvaluate<Dim>(planes, u, 0);
    for (int c = 0; c < form.NumPlanes(); ++c)
    {
      // coefficients are at most 1.5; extraction by blossoming and de Casteljau: p steps each
      EXPECT_NEAR(BernsteinEvaluate<Dim>(degree, form.Block(e) + c * n, local), expected(0, c),
        1e3 * Dim * Epsilon)
        << "element " << e;
    }
  }
}

TEST(BezierForm, EveryElementFollowsTheDefinition_CrossOracle)
{
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    for (int p = 1; p <= 9; ++p)
    {
      CompareWithDefinition<1>({ p }, seed % 2 == 0, seed);
    }
    const int p = 1 + static_cast<int>(seed) % 4;
    CompareWithDefinition<2>({ p, p + 1 }, seed % 2 == 0, seed);
    CompareWithDefinition<3>({ p, 2, 1 }, seed % 2 == 0, seed);
  }
}

TEST(BezierForm, BezierSpaceKeepsItsPoints_ExactOracle)
{
  const auto space =
    MakeBezierSpace<2>({ { 1, 1 }, { 2, 1 } }, { 0, 1, 2, 3, 1, 4, 5, 3, 6, 7 }, 8);
  ASSERT_TRUE(space) << space.Status.Message();
  Spline<2> spline;
  spline.Space = space.Value;
  spline.ControlPoints = PointMatrix::Zero(8, 1);
  for (int i = 0; i < 8; ++i)
  {
    spline.ControlPoints(i, 0) = i;
  }
  EXPECT_EQ(MakeBezierForm(spline).Data, (std::vector<double>{ 0, 1, 2, 3, 1, 4, 5, 3, 6, 7 }));
}

TEST(BezierForm, SameBitsForAnyThreads_PropertyOracle)
{
  std::mt19937_64 random(5);
  const Spline<2> spline = RandomTensorSpline<2>(random, { 3, 2 }, { 40, 30 }, 3, true);
  const BezierForm<2> one = MakeBezierForm(spline, 1);
  EXPECT_EQ(one.Data, MakeBezierForm(spline, 2).Data);
  EXPECT_EQ(one.Data, MakeBezierForm(spline, 0).Data);
}
}
}
