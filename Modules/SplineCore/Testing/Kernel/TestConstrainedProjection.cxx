// SPDX-License-Identifier: BSD-3-Clause
#include "RandomSplines.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierProjection.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
template <int Dim>
SplineSpacePtr<Dim> UniformSpace(int degree, int elements)
{
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(degree, elements));
  return MakeTensorSpace<Dim>(knots).Value;
}

/// Values of a spline of one element at its Gauss points.
template <int Dim>
PointMatrix At(const SplineSpacePtr<Dim>& space, const PointMatrix& coefficients,
  const ElementQuadrature<Dim>& rule)
{
  const BezierForm<Dim> form = MakeBezierForm(Spline<Dim>{ space, coefficients, {} });
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateElements<Dim>(
    form, std::vector<int>(static_cast<std::size_t>(rule.Local.rows()), 0), rule.Local, {}, batch));
  return batch.Values;
}

/// Values of a spline as a function to project.
template <int Dim>
ElementFunction Values(const Spline<Dim>& spline)
{
  return [form = MakeBezierForm(spline)](
           int element, const PointMatrix& local, const PointMatrix&, PointMatrix& values)
  {
    EvaluationBatch batch;
    const std::vector<int> elements(static_cast<std::size_t>(local.rows()), element);
    const bool good = static_cast<bool>(EvaluateElements<Dim>(form, elements, local, {}, batch));
    values = batch.Values;
    return good;
  };
}

/// Rounding of coefficients up to 40 through projections of degrees up to 3.
constexpr double Rounding = 1e-9;
}

template <typename T>
class ConstrainedProjectionTest : public ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 2>,
  std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ConstrainedProjectionTest, Dimensions);

/// On one element the change is orthogonal to all functions that are free: products by Gauss
/// points.
TYPED_TEST(ConstrainedProjectionTest, ChangeIsOrthogonalToFreeFunctions_ExactOracle)
{
  constexpr int Dim = TypeParam::value;
  for (int degree = 1; degree <= 3; ++degree)
  {
    Random random(static_cast<unsigned>(degree));
    const auto space = UniformSpace<Dim>(degree, 1);
    const Spline<Dim> spline = RandomSpline<Dim>(random, space, 2, false);
    std::vector<int> given; // of the side where the first parameter is 0, and one more
    std::vector<char> isGiven(static_cast<std::size_t>(space->NumFunctions), 0);
    for (int f = 0; f < space->NumFunctions; ++f)
    {
      if (f % (degree + 1) == 0 || f == space->NumFunctions - 1)
      {
        given.push_back(f);
        isGiven[static_cast<std::size_t>(f)] = 1;
      }
    }
    const PointMatrix values = PointMatrix::Random(static_cast<Eigen::Index>(given.size()), 2);
    const auto made = ProjectWithCoefficients<Dim>(space, Values(spline), given, values);
    ASSERT_TRUE(made) << made.Status.Message();
    EXPECT_TRUE(made->ControlPoints(given, Eigen::all) == values);
    IntArray<Dim> points;
    points.fill(degree + 1);
    const auto rule = MakeElementQuadrature<Dim>(points);
    const PointMatrix change = At<Dim>(space, made->ControlPoints - spline.ControlPoints, rule);
    EXPECT_GT(change.cwiseAbs().maxCoeff(), 0.1);
    for (int f = 0; f < space->NumFunctions; ++f)
    {
      PointMatrix one = PointMatrix::Zero(space->NumFunctions, 1);
      one(f, 0) = 1.0;
      const Eigen::RowVectorXd product =
        (At<Dim>(space, one, rule).col(0).cwiseProduct(rule.Weights)).transpose() * change;
      if (isGiven[static_cast<std::size_t>(f)] == 0)
      {
        // rounding of sums of 64 terms below 100, by a matrix of condition below 1e5
        EXPECT_LE(product.cwiseAbs().maxCoeff(), 1e-10) << f;
      }
    }
  }
}

TYPED_TEST(ConstrainedProjectionTest, WhatASplineHasChangesNothing_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    Random random(seed);
    const auto space = RandomHierarchicalSpace<Dim>(random, 2, 4, 2);
    const Spline<Dim> spline = RandomSpline<Dim>(random, space, 3, false);
    const std::vector<int> given{ 0, space->NumFunctions / 2, space->NumFunctions - 1 };
    PointMatrix values = spline.ControlPoints(given, Eigen::all);
    const auto same = ProjectWithCoefficients<Dim>(space, Values(spline), given, values);
    ASSERT_TRUE(same) << same.Status.Message();
    EXPECT_LE((same->ControlPoints - spline.ControlPoints).cwiseAbs().maxCoeff(), Rounding);
  }
}

/// Elements without the function have what they had; those next to them have not.
TYPED_TEST(ConstrainedProjectionTest, ChangesStayNearTheFunctions_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  const auto space = UniformSpace<Dim>(2, 6);
  Random random(3);
  const Spline<Dim> spline = RandomSpline<Dim>(random, space, 1, false);
  const auto made =
    ProjectWithCoefficients<Dim>(space, Values(spline), { 0 }, PointMatrix::Constant(1, 1, 40.0));
  ASSERT_TRUE(made) << made.Status.Message();
  const PointMatrix change = made->ControlPoints - spline.ControlPoints;
  // functions 0, 1, 2 are on the first of 6 elements a direction
  for (int f = 0; f < space->NumFunctions; ++f)
  {
    bool isNear = true;
    for (int rest = f, d = 0; d < Dim; ++d, rest /= 8)
    {
      isNear = isNear && rest % 8 < 3;
    }
    EXPECT_EQ(std::abs(change(f, 0)) > Rounding, isNear) << f;
  }
}

TEST(ConstrainedProjection, EveryFailureIsReachable)
{
  const auto space = UniformSpace<2>(2, 2);
  const Spline<2> spline{ space, PointMatrix::Zero(space->NumFunctions, 3), {} };
  const auto code = [&](const std::vector<int>& functions, Eigen::Index rows, Eigen::Index columns)
  {
    return ProjectWithCoefficients<2>(
      space, Values(spline), functions, PointMatrix::Zero(rows, columns))
      .Status.Code;
  };
  EXPECT_EQ(code({ 0 }, 1, 3), ErrorCode::Ok);
  EXPECT_EQ(code({ 0 }, 2, 3), ErrorCode::SizeMismatch);
  EXPECT_EQ(code({ 0 }, 1, 2), ErrorCode::SizeMismatch);
  EXPECT_EQ(code({ 0 }, 1, 0), ErrorCode::InvalidParameter);
  EXPECT_EQ(code({ -1 }, 1, 3), ErrorCode::InvalidParameter);
  EXPECT_EQ(code({ space->NumFunctions }, 1, 3), ErrorCode::InvalidParameter);
}
