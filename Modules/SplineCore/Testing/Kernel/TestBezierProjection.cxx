// SPDX-License-Identifier: BSD-3-Clause
#include "MixedRowSpace.h"
#include "RandomSplines.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierProjection.h>
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr double Eps = std::numeric_limits<double>::epsilon();

/// The values of a spline as a function to project.
template <int Dim>
ElementFunction Values(const Spline<Dim>& spline)
{
  const auto form = std::make_shared<BezierForm<Dim>>(MakeBezierForm(spline));
  return [form](int element, const PointMatrix& local, const PointMatrix&, PointMatrix& values)
  {
    EvaluationBatch batch;
    EvaluationParams params;
    params.Threads = 1;
    const std::vector<int> elements(static_cast<std::size_t>(local.rows()), element);
    const bool good = static_cast<bool>(EvaluateElements(*form, elements, local, params, batch));
    values = batch.Values;
    return good;
  };
}

/// A smooth map of [0, 1]^Dim that is in no spline space.
ElementFunction SmoothMap()
{
  return [](int, const PointMatrix&, const PointMatrix& parameters, PointMatrix& values)
  {
    for (Eigen::Index i = 0; i < parameters.rows(); ++i)
    {
      double phase = 0.3;
      for (Eigen::Index d = 0; d < parameters.cols(); ++d)
      {
        phase += (2.0 + 0.7 * static_cast<double>(d)) * parameters(i, d);
      }
      values(i, 0) = std::sin(phase);
      values(i, 1) = std::cos(1.3 * phase) + parameters(i, 0);
    }
    return true;
  };
}

/// Largest distance from a function at Gauss points that the projection does not use.
template <int Dim>
double Distance(const Spline<Dim>& spline, const ElementFunction& function)
{
  const ElementFunction values = Values(spline);
  double distance = 0.0;
  for (int e = 0; e < spline.Space->NumElements(); ++e)
  {
    const auto& element = spline.Space->Elements[static_cast<std::size_t>(e)];
    IntArray<Dim> points = element.Degree;
    for (int& n : points)
    {
      n += 4;
    }
    const PointMatrix local = MakeElementQuadrature<Dim>(points).Local;
    PointMatrix parameters = local;
    for (int d = 0; d < Dim; ++d)
    {
      const auto k = static_cast<std::size_t>(d);
      parameters.col(d).array() =
        element.Box.Lower[k] + local.col(d).array() * (element.Box.Upper[k] - element.Box.Lower[k]);
    }
    PointMatrix reached(local.rows(), spline.NumComponents());
    PointMatrix wanted = reached;
    EXPECT_TRUE(values(e, local, parameters, reached));
    EXPECT_TRUE(function(e, local, parameters, wanted));
    distance = std::max(distance, (reached - wanted).cwiseAbs().maxCoeff());
  }
  return distance;
}

template <int Dim>
SplineSpacePtr<Dim> UniformSpace(int degree, int elements)
{
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(degree, elements));
  return MakeTensorSpace<Dim>(knots).Value;
}

/// Rounding of values up to Size through the local projections (Lebesgue constants and functionals
/// of degrees up to 4 and three directions stay below 2e4 for spans that differ by at most 4).
constexpr double ReproductionTolerance = 64.0 * Eps * 2e4 * 10.0;
}

template <typename T>
class BezierProjectionTest : public ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 2>,
  std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BezierProjectionTest, Dimensions);

TYPED_TEST(BezierProjectionTest, ReproducesTensorSplines_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = RandomTensorSpace<Dim>(random, Dim == 3 ? 3 : 4, Dim == 3 ? 3 : 6);
    const Spline<Dim> truth = RandomSpline<Dim>(random, space, 2, false);
    ProjectionParams params;
    params.ExtraPoints = static_cast<int>(seed % 3);
    const auto result = ProjectOntoSpace<Dim>(space, 2, Values(truth), params);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_LE((result.Value.ControlPoints - truth.ControlPoints).cwiseAbs().maxCoeff(),
      ReproductionTolerance);
  }
}

TYPED_TEST(BezierProjectionTest, ReproducesHierarchicalSplines_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = RandomHierarchicalSpace<Dim>(random, Dim == 3 ? 2 : 3, 4, Dim == 3 ? 2 : 4);
    const Spline<Dim> truth = RandomSpline<Dim>(random, space, 2, false);
    const auto result = ProjectOntoSpace<Dim>(space, 2, Values(truth));
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_LE((result.Value.ControlPoints - truth.ControlPoints).cwiseAbs().maxCoeff(),
      ReproductionTolerance);
  }
}

TYPED_TEST(BezierProjectionTest, ConvergesWithOrderOfTheDegreePlusOne_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  for (int degree = 1; degree <= (Dim == 3 ? 3 : 4); ++degree)
  {
    SCOPED_TRACE("degree " + std::to_string(degree));
    const int elements = Dim == 3 ? 6 : 12;
    double distances[2];
    for (int k = 0; k < 2; ++k)
    {
      const auto result =
        ProjectOntoSpace<Dim>(UniformSpace<Dim>(degree, elements << k), 2, SmoothMap());
      ASSERT_TRUE(result) << result.Status.Message();
      distances[k] = Distance(result.Value, SmoothMap());
    }
    // the rate is asymptotic: a quarter of an order is what two meshes of this size may miss
    const double rate = std::log2(distances[0] / distances[1]);
    EXPECT_GT(rate, degree + 1 - 0.25);
    EXPECT_LT(rate, degree + 1 + 0.75);
  }
}

TYPED_TEST(BezierProjectionTest, ThreadsChangeNoBit_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  const auto space = UniformSpace<Dim>(2, Dim == 1 ? 700 : (Dim == 2 ? 24 : 7));
  ASSERT_GT(space->NumElements(), 256); // more than one batch
  Spline<Dim> results[2];
  for (int k = 0; k < 2; ++k)
  {
    ProjectionParams params;
    params.Threads = k + 1;
    const auto result = ProjectOntoSpace<Dim>(space, 2, SmoothMap(), params);
    ASSERT_TRUE(result) << result.Status.Message();
    results[k] = result.Value;
  }
  EXPECT_EQ(results[0].ControlPoints, results[1].ControlPoints);
}

TEST(BezierProjection, LocalProjectionIsOrthogonal_PropertyOracle)
{
  // One element, no averages: the error is orthogonal to every polynomial of the degree.
  for (int degree = 1; degree <= MaxDegree; ++degree)
  {
    SCOPED_TRACE("degree " + std::to_string(degree));
    const auto space = UniformSpace<1>(degree, 1);
    ProjectionParams params;
    params.ExtraPoints = 12; // the function is integrated to rounding
    const auto result = ProjectOntoSpace<1>(space, 2, SmoothMap(), params);
    ASSERT_TRUE(result) << result.Status.Message();
    const QuadratureRule rule = GaussLegendre(30);
    Eigen::VectorXd moments = Eigen::VectorXd::Zero(degree + 1);
    std::vector<double> basis(static_cast<std::size_t>(degree) + 1);
    for (std::size_t q = 0; q < rule.Nodes.size(); ++q)
    {
      const PointMatrix u = PointMatrix::Constant(1, 1, rule.Nodes[q]);
      PointMatrix reached(1, 2);
      PointMatrix wanted(1, 2);
      ASSERT_TRUE(Values(result.Value)(0, u, u, reached));
      ASSERT_TRUE(SmoothMap()(0, u, u, wanted));
      BernsteinValues(degree, rule.Nodes[q], basis.data());
      for (int k = 0; k <= degree; ++k)
      {
        moments[k] +=
          rule.Weights[q] * basis[static_cast<std::size_t>(k)] * (reached(0, 0) - wanted(0, 0));
      }
    }
    EXPECT_LE(moments.cwiseAbs().maxCoeff(), 256.0 * Eps); // sums of 30 terms up to 2, through QR
  }
}

TEST(BezierProjection, MatchesTheInverseGramMatrix_CrossOracle)
{
  const int degree = 3;
  const auto result = ProjectOntoSpace<1>(UniformSpace<1>(degree, 1), 2, SmoothMap());
  ASSERT_TRUE(result) << result.Status.Message();
  const QuadratureRule rule = GaussLegendre(degree + 2);
  Eigen::VectorXd moments = Eigen::VectorXd::Zero(degree + 1);
  for (std::size_t q = 0; q < rule.Nodes.size(); ++q)
  {
    Eigen::VectorXd basis(degree + 1);
    BernsteinValues(degree, rule.Nodes[q], basis.data());
    const PointMatrix u = PointMatrix::Constant(1, 1, rule.Nodes[q]);
    PointMatrix value(1, 2);
    SmoothMap()(0, u, u, value);
    moments += rule.Weights[q] * value(0, 0) * basis;
  }
  const std::vector<double> inverse = BernsteinGramInverse(degree);
  const Eigen::VectorXd expected =
    Eigen::Map<const PointMatrix>(inverse.data(), degree + 1, degree + 1) * moments;
  // rounding of the inverse Gram matrix of degree 3, whose entries stay below 200
  EXPECT_LE((result.Value.ControlPoints.col(0) - expected).cwiseAbs().maxCoeff(), 200 * 16 * Eps);
}

TEST(BezierProjection, AveragesWeighByTheIntegralOfTheFunction_GoldenOracle)
{
  // Degree 1, elements [0, 1] and [1, 4]; the function is 0 on the first and 1 on the second, so
  // the local coefficients of the hat at 1 are 0 and 1. Its integrals are 1/2 and 3/2: 3/4.
  const auto space = MakeTensorSpace<1>({ KnotVector::Create(1, { 0, 0, 1, 4, 4 }).Value }).Value;
  const auto result = ProjectOntoSpace<1>(space, 1,
    [](int element, const PointMatrix&, const PointMatrix&, PointMatrix& values)
    {
      values.setConstant(element);
      return true;
    });
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_NEAR(result.Value.ControlPoints(0, 0), 0.0, 64.0 * Eps);
  EXPECT_NEAR(result.Value.ControlPoints(1, 0), 0.75, 64.0 * Eps);
  EXPECT_NEAR(result.Value.ControlPoints(2, 0), 1.0, 64.0 * Eps);
}

TEST(BezierProjection, BezierSpacesAreProjectedOnto_ExactOracle)
{
  const auto space = MakeBezierSpace<1>({ { 2 }, { 3 } }, { 0, 1, 2, 2, 3, 4, 5 }, 6).Value;
  Random random(2);
  const Spline<1> truth = RandomSpline<1>(random, space, 3, false);
  const auto result = ProjectOntoSpace<1>(space, 3, Values(truth));
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_LE((result.Value.ControlPoints - truth.ControlPoints).cwiseAbs().maxCoeff(),
    ReproductionTolerance);
}

TEST(BezierProjection, FunctionsWithoutARowOfTheirOwnAreFound_ExactOracle)
{
  Eigen::MatrixXd map(5, 4);
  map << 1, 0, 0, 0,    //
    0.5, 0.5, 0, 0,     //
    0, 0.75, 0.25, 0,   //
    0, 0.25, 0.5, 0.25, //
    0, 0, 0, 1;
  const auto space = MixedRowSpace(map, 2, 2);
  Random random(4);
  const Spline<1> truth = RandomSpline<1>(random, space, 2, false);
  const auto result = ProjectOntoSpace<1>(space, 2, Values(truth));
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_LE((result.Value.ControlPoints - truth.ControlPoints).cwiseAbs().maxCoeff(),
    ReproductionTolerance);
}

TEST(BezierProjection, ProgressRunsFromZeroToOneAndStops_ExactOracle)
{
  const auto space = UniformSpace<1>(2, 700);
  std::vector<double> shares;
  ProjectionParams params;
  params.Progress = [&](double share)
  {
    shares.push_back(share);
    return true;
  };
  ASSERT_TRUE(ProjectOntoSpace<1>(space, 2, SmoothMap(), params));
  ASSERT_GE(shares.size(), 3u);
  EXPECT_EQ(shares.front(), 0.0);
  EXPECT_EQ(shares.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));

  std::atomic<int> calls{ 0 };
  const auto counted = [&](int, const PointMatrix&, const PointMatrix&, PointMatrix& values)
  {
    ++calls;
    values.setZero();
    return true;
  };
  params.Progress = [](double share) { return share < 0.3; };
  EXPECT_EQ(ProjectOntoSpace<1>(space, 2, counted, params).Status.Code, ErrorCode::Aborted);
  EXPECT_GT(calls, 0);
  EXPECT_LT(calls, 700);
  params.Progress = [](double share) { return share < 1.0; };
  const Status last = ProjectOntoSpace<1>(space, 2, counted, params).Status;
  EXPECT_EQ(last.Code, ErrorCode::Aborted);
  EXPECT_NE(last.Detail.find("last element"), std::string::npos) << last.Detail;
}

TEST(BezierProjection, EveryFailureIsReachable)
{
  const auto space = UniformSpace<1>(2, 5);
  EXPECT_EQ(ProjectOntoSpace<1>(nullptr, 1, SmoothMap()).Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(ProjectOntoSpace<1>(space, 0, SmoothMap()).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(ProjectOntoSpace<1>(space, 2, nullptr).Status.Code, ErrorCode::InvalidParameter);
  for (const int extra : { -1, 17 })
  {
    ProjectionParams params;
    params.ExtraPoints = extra;
    EXPECT_EQ(
      ProjectOntoSpace<1>(space, 2, SmoothMap(), params).Status.Code, ErrorCode::InvalidParameter);
  }
  const auto failing = [&](auto change)
  {
    return ProjectOntoSpace<1>(space, 2,
      [&](int element, const PointMatrix&, const PointMatrix&, PointMatrix& values)
      {
        values.setZero();
        return element < 3 || change(values);
      })
      .Status;
  };
  const Status outside = failing([](PointMatrix&) { return false; });
  EXPECT_EQ(outside.Code, ErrorCode::OutsideDomain);
  EXPECT_NE(outside.Detail.find("element 3"), std::string::npos); // the first, whatever the threads
  EXPECT_EQ(failing(
              [](PointMatrix& values)
              {
                values(0, 0) = std::numeric_limits<double>::quiet_NaN();
                return true;
              })
              .Code,
    ErrorCode::NonFiniteInput);
  EXPECT_EQ(failing(
              [](PointMatrix& values)
              {
                values.resize(1, 2);
                return true;
              })
              .Code,
    ErrorCode::SizeMismatch);
}
