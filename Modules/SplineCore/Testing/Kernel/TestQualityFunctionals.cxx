// SPDX-License-Identifier: BSD-3-Clause
#include "MapSpaces.h"
#include "RandomSplines.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/QualityFunctionals.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include <cmath>

using namespace knotwork;

namespace
{
template <typename T>
class QualityFunctionalsTest : public ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(QualityFunctionalsTest, Dimensions);

/// Control points of a map that lies in the space, from its values.
template <int Dim, typename Function>
PointMatrix Interpolate(const SplineSpace<Dim>& space, const Function& function)
{
  oracle::Random random(1);
  const ParametricBox<Dim> box = space.Domain();
  PointMatrix parameters = cases::RandomPoints(random, 30 * space.NumFunctions, Dim, 0.0, 1.0);
  PointMatrix values(parameters.rows(), Dim);
  for (Eigen::Index i = 0; i < parameters.rows(); ++i)
  {
    for (int d = 0; d < Dim; ++d)
    {
      parameters(i, d) = box.Lower[d] + parameters(i, d) * (box.Upper[d] - box.Lower[d]);
    }
    values.row(i) = function(parameters.row(i));
  }
  const Eigen::MatrixXd dense = CollocationMatrix(space, parameters, 0).Value;
  const Eigen::MatrixXd points = dense.householderQr().solve(Eigen::MatrixXd(values));
  return points;
}

const QualityKind AllKinds[] = { QualityKind::Uniformity, QualityKind::Length,
  QualityKind::Orthogonality, QualityKind::Skewness, QualityKind::Eccentricity, QualityKind::Area,
  QualityKind::SelfIntersection };

template <int Dim>
QualityJet<Dim> RandomJet(oracle::Random& random)
{
  return QualityJet<Dim>::NullaryExpr([&] { return random.In(-1.0, 1.0); });
}
}

TYPED_TEST(QualityFunctionalsTest, ValuesOfAffineMapsAreKnown_ExactOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(4);
  for (const SplineSpacePtr<Dim>& space :
    { cases::FitSpace<Dim>(), cases::HierarchicalFitSpace<Dim>() })
  {
    const Eigen::MatrixXd a = cases::RandomPoints(random, Dim, Dim, -2.0, 2.0); // row k: g_k
    const PointMatrix points = cases::IdentityPoints(*space) * a;
    const double volume = Dim == 2 ? 2.0 : 3.0; // of the domain
    double length = 0.0, orthogonality = 0.0, skewness = 0.0, intersection = 0.0;
    for (int k = 0; k < Dim; ++k)
    {
      length += a.row(k).squaredNorm();
      intersection += 1.0 / std::pow(a.row(k).squaredNorm() + 1e-7, 2);
      for (int l = k + 1; l < Dim; ++l)
      {
        const double dot = a.row(k).dot(a.row(l));
        orthogonality += dot * dot;
        skewness += std::pow(dot / (a.row(k).norm() * a.row(l).norm()), 4);
      }
    }
    const double det = Eigen::MatrixXd(a).determinant();
    const double expected[] = { 0.0, length, orthogonality, skewness, 0.0, det * det,
      intersection };
    for (int k = 0; k < NumQualityKinds; ++k)
    {
      // Second derivatives cancel to the rounding of points (size 10) over the square of elements.
      const double value = QualityValue<Dim>(space, points, AllKinds[k]);
      EXPECT_NEAR(value, volume * expected[k], 1e-12 * (1.0 + volume * expected[k])) << k;
    }
  }
}

// Polynomials whose integrals are easy, in degree 3 x 2 (x 2) on [0, 1] x [-1, 1] (x [0, 1.5]).
TEST(QualityFunctionals, ValuesOfAPlanarPolynomialAreKnown_ExactOracle)
{
  // g = (u^2 + u v, v^2 + 3 v): g_u = (2 u + v, 0), g_v = (u, 2 v + 3)
  const auto g = [](const Eigen::RowVectorXd& u)
  { return Eigen::RowVector2d(u(0) * u(0) + u(0) * u(1), u(1) * u(1) + 3.0 * u(1)); };
  for (const SplineSpacePtr<2>& space : { cases::FitSpace<2>(), cases::HierarchicalFitSpace<2>() })
  {
    const PointMatrix points = Interpolate<2>(*space, g);
    const auto value = [&](QualityKind kind) { return QualityValue<2>(space, points, kind); };
    // |g_uu|^2 + 2 |g_uv|^2 + |g_vv|^2 = 4 + 2 + 4, on an area of 2
    EXPECT_NEAR(value(QualityKind::Uniformity), 20.0, 1e-10);
    // int (2 u + v)^2 = 8/3 + 2/3, int u^2 = 2/3, int (2 v + 3)^2 = 8/3 + 18
    EXPECT_NEAR(value(QualityKind::Length), 10.0 / 3.0 + 2.0 / 3.0 + 62.0 / 3.0, 1e-11);
    // int (2 u^2 + u v)^2 = int 4 u^4 + u^2 v^2 (odd powers of v vanish)
    EXPECT_NEAR(value(QualityKind::Orthogonality), 8.0 / 5.0 + 2.0 / 9.0, 1e-11);
    // int ((2 u + v)(2 v + 3))^2 = int 4 u^2 (4 v^2 + 9) + 48 u v^2 + v^2 (4 v^2 + 9)
    EXPECT_NEAR(
      value(QualityKind::Area), 4.0 / 3.0 * (8.0 / 3.0 + 18.0) + 16.0 + 8.0 / 5.0 + 6.0, 1e-10);
  }
}

TEST(QualityFunctionals, ValuesOfASpatialPolynomialAreKnown_ExactOracle)
{
  // g = (u^2 + v w, v^2 + u w, w^2 + u v): |g_kk|^2 = 4, |g_kl|^2 = 1
  const auto g = [](const Eigen::RowVectorXd& u)
  {
    return Eigen::RowVector3d(
      u(0) * u(0) + u(1) * u(2), u(1) * u(1) + u(0) * u(2), u(2) * u(2) + u(0) * u(1));
  };
  for (const SplineSpacePtr<3>& space : { cases::FitSpace<3>(), cases::HierarchicalFitSpace<3>() })
  {
    const PointMatrix points = Interpolate<3>(*space, g);
    EXPECT_NEAR(QualityValue<3>(space, points, QualityKind::Uniformity), 3.0 * (12.0 + 6.0), 1e-9);
    // sum_k |g_k|^2 = 6 (u^2 + v^2 + w^2); int u^2 = 1, int v^2 = 1, int w^2 = 2 * 1.125
    EXPECT_NEAR(QualityValue<3>(space, points, QualityKind::Length), 6.0 * 4.25, 1e-10);
  }
}

TYPED_TEST(QualityFunctionalsTest, MatrixGivesTheQuadraticFunctionals_CrossOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(7);
  for (int k = 0; k < 6; ++k)
  {
    const SplineSpacePtr<Dim> space = k % 2 == 0
      ? knotwork::testing::RandomTensorSpace<Dim>(random, 4, 3)
      : knotwork::testing::RandomHierarchicalSpace<Dim>(random, 3, 3, 2);
    const Spline<Dim> map = knotwork::testing::RandomSpline<Dim>(random, space, Dim, false);
    const BezierForm<Dim> form = MakeBezierForm(map);
    const PointMatrix local = space->LocalCoefficients(map.ControlPoints);
    const double weights[2] = { random.In(0.1, 1.0), random.In(0.1, 1.0) };
    const Eigen::SparseMatrix<double, Eigen::RowMajor> matrix =
      QuadraticMatrix<Dim>(*space, weights[0], weights[1], 2);
    const double value = local.cwiseProduct(PointMatrix(matrix * local)).sum();
    const double expected = weights[0] * QualityValue(form, QualityKind::Uniformity) +
      weights[1] * QualityValue(form, QualityKind::Length);
    EXPECT_NEAR(value, expected, 1e-12 * expected);
    const Eigen::MatrixXd dense = matrix;
    EXPECT_LE((dense - dense.transpose()).norm(), 1e-15 * dense.norm());
  }
}

TYPED_TEST(QualityFunctionalsTest, ResidualsAreTheFormulas_CrossOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(11);
  for (int k = 0; k < 20; ++k)
  {
    const QualityJet<Dim> jet = RandomJet<Dim>(random);
    const auto sumOf = [&](QualityKind kind)
    {
      QualityResidual<Dim> residuals[3];
      const int count = QualityResiduals<Dim>(kind, jet, residuals);
      double sum = 0.0;
      for (int r = 0; r < count; ++r)
      {
        sum += residuals[r].Value * residuals[r].Value;
      }
      return sum;
    };
    double orthogonality = 0.0, skewness = 0.0, eccentricity = 0.0, intersection = 0.0;
    for (int a = 0; a < Dim; ++a)
    {
      const double square = jet.row(a).squaredNorm();
      eccentricity += std::pow(jet.row(a).dot(jet.row(Dim + a)) / square, 2);
      intersection += std::pow(square + 1e-7, -2);
      for (int b = 0; b < a; ++b)
      {
        const double dot = jet.row(a).dot(jet.row(b));
        orthogonality += dot * dot;
        skewness += std::pow(dot * dot / (square * jet.row(b).squaredNorm()), 2);
      }
    }
    const double det = Eigen::MatrixXd(jet.template topRows<Dim>()).determinant();
    const auto expect = [&](QualityKind kind, double value)
    { EXPECT_NEAR(sumOf(kind), value, 1e-13 * (1.0 + value)); };
    expect(QualityKind::Orthogonality, orthogonality);
    expect(QualityKind::Skewness, skewness);
    expect(QualityKind::Eccentricity, eccentricity);
    expect(QualityKind::Area, det * det);
    expect(QualityKind::SelfIntersection, intersection);
  }
}

TYPED_TEST(QualityFunctionalsTest, GradientsOfResidualsAreDifferences_CrossOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(5);
  for (QualityKind kind : AllKinds)
  {
    for (int k = 0; k < 10; ++k)
    {
      const QualityJet<Dim> jet = RandomJet<Dim>(random);
      QualityResidual<Dim> at[3], up[3], down[3];
      const int count = QualityResiduals<Dim>(kind, jet, at);
      EXPECT_EQ(count > 0, !IsQuadratic(kind));
      for (Eigen::Index i = 0; i < jet.size(); ++i)
      {
        // Central difference: error h^2 / 6 times the third derivative, and rounding / h; both
        // are relative to residuals and to lengths that get as small as 0.1.
        const double h = 1e-6;
        QualityJet<Dim> moved = jet;
        moved.data()[i] += h;
        QualityResiduals<Dim>(kind, moved, up);
        moved.data()[i] -= 2.0 * h;
        QualityResiduals<Dim>(kind, moved, down);
        for (int r = 0; r < count; ++r)
        {
          const double slope = (up[r].Value - down[r].Value) / (2.0 * h);
          EXPECT_NEAR(at[r].Gradient.data()[i], slope,
            1e-7 * (1.0 + std::abs(at[r].Value) + at[r].Gradient.norm()));
        }
      }
    }
  }
}

TYPED_TEST(QualityFunctionalsTest, ThreadsDoNotChangeABit_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(2);
  const SplineSpacePtr<Dim> space =
    knotwork::testing::RandomHierarchicalSpace<Dim>(random, 3, 5, 3);
  const Spline<Dim> map = knotwork::testing::RandomSpline<Dim>(random, space, Dim, false);
  for (QualityKind kind : AllKinds)
  {
    const double value = QualityValue<Dim>(space, map.ControlPoints, kind, 1);
    EXPECT_TRUE(std::isfinite(value));
    EXPECT_EQ(QualityValue<Dim>(space, map.ControlPoints, kind, 2), value);
  }
  const Eigen::MatrixXd one = QuadraticMatrix<Dim>(*space, 0.3, 0.7, 1);
  const Eigen::MatrixXd two = QuadraticMatrix<Dim>(*space, 0.3, 0.7, 2);
  EXPECT_EQ(one, two);
}

TYPED_TEST(QualityFunctionalsTest, CollapsedMapsAreInfinitelyBad_ExactOracle)
{
  constexpr int Dim = TypeParam::value;
  const SplineSpacePtr<Dim> space = cases::FitSpace<Dim>();
  const PointMatrix points = PointMatrix::Zero(space->NumFunctions, Dim);
  for (QualityKind kind : AllKinds)
  {
    const double value = QualityValue<Dim>(space, points, kind);
    const bool divides = kind == QualityKind::Skewness || kind == QualityKind::Eccentricity;
    EXPECT_EQ(std::isfinite(value), !divides);
    EXPECT_FALSE(std::isnan(value));
  }
}
