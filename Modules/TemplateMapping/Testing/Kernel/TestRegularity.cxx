// SPDX-License-Identifier: BSD-3-Clause
#include "MapCases.h"
#include <knotwork/TemplateMapping/Regularity.h>

#include <gtest/gtest.h>

#include <limits>

using namespace knotwork;

namespace
{
constexpr std::int64_t Boxes = 1000000;

template <typename T>
class RegularityOf : public testing::Test
{
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RegularityOf, Dimensions);
}

TYPED_TEST(RegularityOf, AffineMapsAreKnown_ExactOracle)
{
  constexpr int dim = TypeParam::value;
  // A domain that is no unit box: bounds are per area of it.
  std::array<KnotVector, dim> knots;
  knots.fill(KnotVector::Uniform(2, 3, -1.0, 5.0));
  Spline<dim> map;
  map.Space = MakeTensorSpace<dim>(knots).Value;
  Eigen::MatrixXd matrix = 0.3 * Eigen::MatrixXd::Identity(dim, dim);
  matrix(0, 1) = 0.7;
  matrix(1, 0) = -0.2;
  map.ControlPoints = GrevillePoints(*map.Space) * matrix.transpose();
  const auto regularity = MeasureRegularity(MakeBezierForm(map), 0.1, Boxes, 0);
  ASSERT_TRUE(regularity);
  EXPECT_TRUE(regularity->IsRegular());
  const double exact = matrix.determinant();
  for (std::size_t e = 0; e < map.Space->Elements.size(); ++e)
  {
    EXPECT_LE(regularity->MinLower[e], exact * (1 + 1e-14)); // of the determinant here
    EXPECT_GE(regularity->MaxUpper[e], exact * (1 - 1e-14));
    EXPECT_NEAR(regularity->MinLower[e], exact, 1e-12); // rounding of the bounds
    EXPECT_NEAR(regularity->MaxUpper[e], exact, 1e-12);
  }
  EXPECT_LE(regularity->Bound(), regularity->MinLower.back());

  map.ControlPoints.col(0) *= -1.0;
  const auto mirrored = MeasureRegularity(MakeBezierForm(map), 0.1, Boxes, 0);
  EXPECT_FALSE(mirrored->IsRegular());
  EXPECT_NEAR(mirrored->Bound(), -exact, 1e-12);
}

TYPED_TEST(RegularityOf, BoundsHoldSampledDeterminants_PropertyOracle)
{
  constexpr int dim = TypeParam::value;
  int folded = 0;
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Spline<dim> map = cases::IdentityMap<dim>(2, 3);
    cases::Shake(map, 0.05 * seed, seed, true);
    const BezierForm<dim> form = MakeBezierForm(map);
    const auto regularity = MeasureRegularity(form, 0.01, Boxes, 0);
    ASSERT_TRUE(regularity);
    const PointMatrix grid = cases::GridOver<dim>(dim == 2 ? 91 : 25);
    const Eigen::VectorXd values = cases::Determinants(form, grid);
    for (Eigen::Index i = 0; i < grid.rows(); ++i)
    {
      double local[dim];
      const auto e = static_cast<std::size_t>(map.Space->Locate(grid.row(i).data(), local));
      EXPECT_LE(regularity->MinLower[e], values(i) + 1e-13); // of the determinant here
      EXPECT_GE(regularity->MaxUpper[e], values(i) - 1e-13);
    }
    // Corners are among the samples, and the bounds are within 1 % of the extremes.
    EXPECT_GE(regularity->Bound(), values.minCoeff() - 0.1 * values.cwiseAbs().maxCoeff());
    EXPECT_EQ(regularity->IsRegular(), values.minCoeff() > 0.0);
    folded += !regularity->IsRegular();
    const auto one = MeasureRegularity(form, 0.01, Boxes, 1);
    EXPECT_EQ(one->MinLower, regularity->MinLower);
    EXPECT_EQ(one->MaxUpper, regularity->MaxUpper);
  }
  EXPECT_GT(folded, 0);
  EXPECT_LT(folded, 4);
}

TYPED_TEST(RegularityOf, TheIdentityIsInjective_ExactOracle)
{
  constexpr int dim = TypeParam::value;
  Spline<dim> map = cases::IdentityMap<dim>(3, 3);
  cases::Shake(map, 0.01, 5, true);
  const BezierForm<dim> form = MakeBezierForm(map);
  const auto regularity = MeasureRegularity(form, 0.1, Boxes, 0);
  const auto proof = ProveMapInjectivity(form, regularity->Certificate, Boxes, 0);
  ASSERT_TRUE(proof);
  EXPECT_EQ(proof->Verdict, InjectivityVerdict::Injective);
}

// Regular everywhere, and yet its ends lie on each other: a ring of one and a quarter turns.
TEST(Regularity, MoreThanOneTurnIsRegularButNotInjective_ExactOracle)
{
  for (const double turns : { 0.75, 1.25 })
  {
    Spline<2> map = cases::IdentityMap<2>(3, 24);
    const PointMatrix places = map.ControlPoints;
    for (Eigen::Index i = 0; i < places.rows(); ++i)
    {
      const double angle = 2 * 3.14159265358979323846 * turns * places(i, 0);
      const double radius = 2.0 - places(i, 1);
      map.ControlPoints.row(i) << radius * std::cos(angle), radius * std::sin(angle);
    }
    const BezierForm<2> form = MakeBezierForm(map);
    const auto regularity = MeasureRegularity(form, 0.1, Boxes, 0);
    EXPECT_TRUE(regularity->IsRegular());
    const auto proof = ProveMapInjectivity(form, regularity->Certificate, Boxes, 0);
    ASSERT_TRUE(proof);
    EXPECT_EQ(
      proof->Verdict, turns < 1 ? InjectivityVerdict::Injective : InjectivityVerdict::NotInjective);
  }
}
