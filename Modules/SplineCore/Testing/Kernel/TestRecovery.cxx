// SPDX-License-Identifier: BSD-3-Clause
#include "MixedRowSpace.h"
#include "RandomSplines.h"
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/Recovery.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr double Eps = std::numeric_limits<double>::epsilon();

/// Contract of RecoverSpline inside the space; the ratio of the weights is what dividing the
/// homogeneous coordinates by them costs.
template <int Dim>
double Tolerance(const RecoveryResult<Dim>& result, double eps)
{
  const Eigen::VectorXd& w = result.Value.Weights;
  const double ratio = w.size() > 0 ? w.maxCoeff() / w.minCoeff() : 1.0;
  return 64.0 * eps * result.Amplification * result.Size * ratio;
}

template <int Dim>
int BlockSize(const BezierForm<Dim>& form, int e)
{
  return NumTensorFunctions<Dim>(form.Space->Elements[static_cast<std::size_t>(e)].Degree);
}

template <int Dim>
Eigen::Map<PointMatrix> Planes(BezierForm<Dim>& form, int e)
{
  return { form.Block(e), form.NumPlanes(), BlockSize(form, e) };
}

/// Control points and weights come back; the weights up to rounding and the common factor `scale`.
template <int Dim>
void ExpectRecovered(
  const RecoveryResult<Dim>& result, const Spline<Dim>& truth, double scale = 1.0)
{
  ASSERT_TRUE(result) << result.Status.Message();
  ASSERT_TRUE(result.Value.Check());
  const double tolerance = Tolerance(result, Eps);
  EXPECT_LE((result.Value.ControlPoints - truth.ControlPoints).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LE(result.Residual, tolerance);
  EXPECT_GE(result.Amplification, 1.0);
  // not vacuous: one wrong coordinate of 1 % is seen
  EXPECT_LT(tolerance, 0.01 * result.Size);
  ASSERT_EQ(result.Value.Weights.size(), truth.Weights.size());
  if (truth.IsRational())
  {
    const double largest = truth.Weights.maxCoeff() * scale;
    const double rounding = 64.0 * Eps * result.Amplification;
    EXPECT_LE((result.Value.Weights - scale * truth.Weights).cwiseAbs().maxCoeff(),
      4.0 * rounding * largest);
    EXPECT_LE(result.WeightResidual, 4.0 * rounding);
  }
}

template <int Dim>
void MultiplyCells(BezierForm<Dim>& form, const std::vector<double>& factors)
{
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    Planes(form, e) *= factors[static_cast<std::size_t>(e)];
  }
}

/// Factors in [1e-2, 1e2], evenly on the logarithmic scale.
std::vector<double> RandomFactors(Random& random, int count)
{
  std::vector<double> factors(static_cast<std::size_t>(count));
  for (double& f : factors)
  {
    f = std::pow(10.0, random.In(-2.0, 2.0));
  }
  return factors;
}
}

template <typename T>
class RecoveryTest : public ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 2>,
  std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RecoveryTest, Dimensions);

TYPED_TEST(RecoveryTest, TensorSplinesComeBack_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = RandomTensorSpace<Dim>(random, Dim == 3 ? 4 : 5, Dim == 3 ? 3 : 6);
    const int components = random.Int(1, 4);
    const Spline<Dim> truth = RandomSpline<Dim>(random, space, components, seed % 2);
    const BezierForm<Dim> form = MakeBezierForm(truth);
    ExpectRecovered(RecoverSpline(form, 0), truth);
  }
}

TYPED_TEST(RecoveryTest, AnyKnotsStayWithinTheStatedAmplification_PropertyOracle)
{
  // degrees to 9, spans that differ by 100, any multiplicity, ends clamped or not
  constexpr int Dim = TypeParam::value;
  for (unsigned seed = 1; seed <= (Dim == 3 ? 5 : 40); ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::array<KnotVector, Dim> knots;
    for (KnotVector& k : knots)
    {
      k = Dim == 3 ? random.Knots(2, random.Int(1, 4)) : random.Knots(5);
    }
    const Spline<Dim> truth = random.Spline<Dim>(knots, 2, false);
    const RecoveryResult<Dim> result = RecoverSpline(MakeBezierForm(truth), 0);
    ASSERT_TRUE(result) << result.Status.Message();
    const double tolerance = Tolerance(result, Eps);
    EXPECT_LE((result.Value.ControlPoints - truth.ControlPoints).cwiseAbs().maxCoeff(), tolerance);
    EXPECT_LE(result.Residual, tolerance);
  }
}

TYPED_TEST(RecoveryTest, HierarchicalSplinesComeBack_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = RandomHierarchicalSpace<Dim>(random, Dim == 3 ? 2 : 4, 4, Dim == 3 ? 2 : 4);
    const Spline<Dim> truth = RandomSpline<Dim>(random, space, 3, seed % 2);
    const BezierForm<Dim> form = MakeBezierForm(truth);
    ExpectRecovered(RecoverSpline(form, 0), truth);
  }
}

TYPED_TEST(RecoveryTest, CellFactorsAreUndone_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  for (unsigned seed = 1; seed <= 16; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = seed % 2
      ? RandomTensorSpace<Dim>(random, 3, Dim == 3 ? 3 : 6)
      : RandomHierarchicalSpace<Dim>(random, Dim == 3 ? 2 : 3, 4, Dim == 3 ? 2 : 3);
    const Spline<Dim> truth = RandomSpline<Dim>(random, space, 3, true);
    BezierForm<Dim> form = MakeBezierForm(truth);
    const std::vector<double> factors = RandomFactors(random, space->NumElements());
    MultiplyCells(form, factors);
    ExpectRecovered(RecoverSpline(form, 0), truth, factors.front());
  }
}

TYPED_TEST(RecoveryTest, FieldsComeBack_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = RandomTensorSpace<Dim>(random, 3, 4);
    const Spline<Dim> truth = RandomSpline<Dim>(random, space, 2, seed % 2);
    BezierForm<Dim> field = MakeBezierForm(truth);
    if (field.Rational)
    {
      BezierForm<Dim> plain;
      plain.Space = space;
      plain.NumComponents = field.NumComponents;
      plain.Offsets.push_back(0);
      for (int e = 0; e < space->NumElements(); ++e)
      {
        const PointMatrix planes = Planes(field, e);
        const PointMatrix values = planes.topRows(2).array().rowwise() / planes.row(2).array();
        plain.Data.insert(plain.Data.end(), values.data(), values.data() + values.size());
        plain.Offsets.push_back(plain.Data.size());
      }
      field = plain;
    }
    const RecoveryResult<Dim> result = RecoverField(field, truth.Weights, 0);
    ExpectRecovered(result, truth);
    EXPECT_EQ(result.Value.Weights, truth.Weights);
  }
}

TYPED_TEST(RecoveryTest, PointsOutsideTheSpaceLeaveTheirDistance_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  Random random(7);
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(2, 3));
  const auto space = MakeTensorSpace<Dim>(knots).Value;
  const Spline<Dim> truth = RandomSpline<Dim>(random, space, 3, Dim == 2);
  BezierForm<Dim> form = MakeBezierForm(truth);
  // a Bezier point of the middle element leaves its continuity conditions, by a length of 0.01
  const int middle = space->NumElements() / 2;
  auto planes = Planes(form, middle);
  const double w = form.Rational ? planes(3, 0) : 1.0;
  planes(0, 0) += 0.006 * w;
  planes(1, 0) += 0.008 * w;
  const RecoveryResult<Dim> result = RecoverSpline(form, 0);
  ASSERT_TRUE(result) << result.Status.Message();
  // The point is shared by 2^Dim elements: whatever coefficients are chosen, one of them is at
  // least half of the length away. And no coefficient moves by more than the amplification.
  EXPECT_GE(result.Residual, 0.005);
  EXPECT_LE(result.Residual, 0.01 * (1.0 + 4.0 * result.Amplification));
}

TYPED_TEST(RecoveryTest, SinglePrecisionPointsStayInTheirRounding_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  constexpr double epsSingle = std::numeric_limits<float>::epsilon();
  double largest = 0.0;
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = RandomTensorSpace<Dim>(random, 3, 5);
    const Spline<Dim> truth = RandomSpline<Dim>(random, space, 3, seed % 2);
    BezierForm<Dim> form = MakeBezierForm(truth);
    for (int e = 0; e < space->NumElements(); ++e)
    {
      auto planes = Planes(form, e);
      for (Eigen::Index k = 0; k < planes.cols(); ++k)
      {
        const double w = form.Rational ? static_cast<float>(planes(3, k)) : 1.0;
        for (int c = 0; c < 3; ++c)
        {
          const double old = form.Rational ? planes(3, k) : 1.0;
          planes(c, k) = static_cast<double>(static_cast<float>(planes(c, k) / old)) * w;
        }
        if (form.Rational)
        {
          planes(3, k) = w;
        }
      }
    }
    const RecoveryResult<Dim> result = RecoverSpline(form, 0);
    ASSERT_TRUE(result) << result.Status.Message();
    const double tolerance = Tolerance(result, epsSingle);
    EXPECT_LE((result.Value.ControlPoints - truth.ControlPoints).cwiseAbs().maxCoeff(), tolerance);
    EXPECT_LE(result.Residual, tolerance);
    largest = std::max(largest, result.Residual);
  }
  EXPECT_GT(largest, epsSingle); // the points were rounded
}

TEST(Recovery, LongRowOfCellFactorsIsUndone_PropertyOracle)
{
  // Factors spread over 400 faces; each face costs a rounding or two of the weights.
  Random random(3);
  const auto space = MakeTensorSpace<1>({ MildKnots(random, 3, 400, 1) }).Value;
  const Spline<1> truth = RandomSpline<1>(random, space, 2, true);
  BezierForm<1> form = MakeBezierForm(truth);
  const std::vector<double> factors = RandomFactors(random, space->NumElements());
  MultiplyCells(form, factors);
  const RecoveryResult<1> result = RecoverSpline(form, 0);
  ExpectRecovered(result, truth, factors.front());
}

TEST(Recovery, DiscontinuousPiecesKeepTheirOwnScale_ExactOracle)
{
  // Degree 1, a knot of multiplicity 2 at 1: the weights on its sides have nothing in common, while
  // the last element must follow the one before it.
  const auto space =
    MakeTensorSpace<1>({ KnotVector::Create(1, { 0, 0, 1, 1, 2, 3, 3 }).Value }).Value;
  Spline<1> truth{ space, PointMatrix(5, 1), Eigen::VectorXd(5) };
  truth.ControlPoints << 1, 2, 5, 7, 4;
  truth.Weights << 1, 2, 40, 10, 5;
  BezierForm<1> form = MakeBezierForm(truth);
  MultiplyCells(form, { 1.0, 1.0, 4.0 }); // exact in binary arithmetic
  const RecoveryResult<1> result = RecoverSpline(form, 0);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result.Value.ControlPoints, truth.ControlPoints);
  EXPECT_EQ(result.Value.Weights, truth.Weights);
  EXPECT_EQ(result.Residual, 0.0);
}

TEST(Recovery, GluedBezierCellsComeBackExactly_ExactOracle)
{
  // A quadratic and a cubic curve that share a point: Bezier points are coefficients.
  const auto space = MakeBezierSpace<1>({ { 2 }, { 3 } }, { 0, 1, 2, 2, 3, 4, 5 }, 6).Value;
  Random random(11);
  const Spline<1> truth = RandomSpline<1>(random, space, 3, false);
  const RecoveryResult<1> result = RecoverSpline(MakeBezierForm(truth), 0);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result.Value.ControlPoints, truth.ControlPoints);
  EXPECT_EQ(result.Amplification, 1.0);
}

TEST(Recovery, FactorsOfGluedBezierCellsAreUndone_ExactOracle)
{
  const auto space = MakeBezierSpace<1>({ { 2 }, { 3 } }, { 0, 1, 2, 2, 3, 4, 5 }, 6).Value;
  Random random(12);
  const Spline<1> truth = RandomSpline<1>(random, space, 3, true);
  BezierForm<1> form = MakeBezierForm(truth);
  MultiplyCells(form, { 0.03, 70.0 });
  ExpectRecovered(RecoverSpline(form, 0), truth, 0.03);
}

TEST(Recovery, CellsWithoutSharedPointsKeepTheirWeights_ExactOracle)
{
  const auto space = MakeBezierSpace<1>({ { 1 }, { 1 } }, { 0, 1, 2, 3 }, 4).Value;
  Random random(13);
  const Spline<1> truth = RandomSpline<1>(random, space, 3, true);
  const RecoveryResult<1> result = RecoverSpline(MakeBezierForm(truth), 0);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result.Value.Weights, truth.Weights);
}

TEST(Recovery, LeastAmplificationIsTaken_GoldenOracle)
{
  // Quadratic, knots 0 0 0 1 2 2 2, function 1: its coefficient on [0, 1] is Bezier point 1 (rows
  // 0, 1 and 2 of the extraction are 1 0 0, 0 1 1/2, 0 0 1/2), by symmetry also on [1, 2]
  // function 2 is point 1 there; functions 0 and 3 are end points. So nothing is amplified,
  // though on [0, 1] function 2 = 2 Q_2 - Q_1, with row sum 3.
  const auto space = MakeTensorSpace<1>({ KnotVector::Uniform(2, 2, 0.0, 2.0) }).Value;
  Random random(1);
  const auto result = RecoverSpline(MakeBezierForm(RandomSpline<1>(random, space, 1, false)), 0);
  EXPECT_EQ(result.Amplification, 1.0);
  // One more element between: function 2 of knots 0 0 0 1 2 3 3 3 lives on all three; on [1, 2] the
  // extraction is 1/2 0 0, 1/2 1 1/2, 0 0 1/2: its middle row is point 1. Unclamped, knots 0 ... 5
  // and the single element [2, 3]: function 0 = 2 Q_0 - Q_1, row sum 3.
  const auto open = MakeTensorSpace<1>({ KnotVector::Create(2, { 0, 1, 2, 3, 4, 5 }).Value }).Value;
  const auto amplified = RecoverSpline(MakeBezierForm(RandomSpline<1>(random, open, 1, false)), 0);
  EXPECT_NEAR(amplified.Amplification, 3.0, 64.0 * Eps);
}

TEST(Recovery, MixedRowsAreSolvedByLeastSquares_ExactOracle)
{
  // Two quadratic elements; functions 1 and 2 have no Bezier point of their own.
  Eigen::MatrixXd map(5, 4);
  map << 1, 0, 0, 0,    //
    0.5, 0.5, 0, 0,     //
    0, 0.75, 0.25, 0,   //
    0, 0.25, 0.5, 0.25, //
    0, 0, 0, 1;
  const auto space = MixedRowSpace(map, 2, 2);
  for (const bool rational : { false, true })
  {
    Random random(5);
    const Spline<1> truth = RandomSpline<1>(random, space, 2, rational);
    ExpectRecovered(RecoverSpline(MakeBezierForm(truth), 0), truth);
  }
}

TEST(Recovery, RowsOfOneFunctionAreNotItsCoefficientUnlessOne_ExactOracle)
{
  Eigen::MatrixXd map(3, 3);
  map << 1, 0, 0, //
    0, 0.5, 0,    //
    0, 0, 1;
  Random random(6);
  const Spline<1> truth = RandomSpline<1>(random, MixedRowSpace(map, 1, 2), 2, false);
  ExpectRecovered(RecoverSpline(MakeBezierForm(truth), 0), truth);
}

TEST(Recovery, EquationsWeighByTheirAmplification_GoldenOracle)
{
  // Two functions of half the middle row: each is its value. The first element sees the value 10 as
  // its Bezier point 2 with weight 1, the second 2 Q_0 - Q_1 = 19 by a functional of row sum 3 with
  // weight 1/9: the mean is (10 + 19 / 9) / (1 + 1 / 9) = 10.9.
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(5, 6);
  map(0, 0) = map(1, 1) = map(3, 4) = map(4, 5) = 1.0;
  map(2, 2) = map(2, 3) = 0.5;
  auto space = std::make_shared<SplineSpace<1>>(*MixedRowSpace(map, 2, 2));
  space->FactorData = { 0.5, 0, 0, 0.5, 1, 0, 0, 0, 1 };
  space->Elements[1].Factor = { 0 };
  const BezierForm<1> form{ space, 1, false, { 0, 3, 6 }, { 1, 2, 10, 12.5, 6, 3 } };
  const auto result = RecoverSpline(form, 0);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_NEAR(result.Value.ControlPoints(2, 0), 10.9, 64.0 * Eps * 3.0 * 12.5);
  EXPECT_NEAR(result.Value.ControlPoints(3, 0), 10.9, 64.0 * Eps * 3.0 * 12.5);
  EXPECT_EQ(result.Value.ControlPoints(4, 0), 6.0);
  EXPECT_NEAR(result.Amplification, 3.0, 64.0 * Eps);
}

TEST(Recovery, LeastSquaresMinimizesTheDistance_CrossOracle)
{
  // All functions are unknown, the points arbitrary: the residual of the normal equations vanishes.
  Eigen::MatrixXd map(5, 3);
  map << 0.9, 0.1, 0, //
    0.5, 0.5, 0,      //
    0.2, 0.6, 0.2,    //
    0, 0.5, 0.5,      //
    0, 0.1, 0.9;
  const auto space = MixedRowSpace(map, 2, 2);
  BezierForm<1> form = MakeBezierForm(Spline<1>{ space, PointMatrix::Zero(3, 1), {} });
  const Eigen::Matrix<double, 5, 1> values(3.0, -1.0, 2.0, 5.0, -4.0);
  for (int k = 0; k < 3; ++k)
  {
    form.Block(0)[k] = values[k];
    form.Block(1)[k] = values[k + 2];
  }
  const auto result = RecoverSpline(form, 0);
  ASSERT_TRUE(result) << result.Status.Message();
  const Eigen::Matrix<double, 5, 1> weights(1.0, 1.0, 2.0, 1.0, 1.0); // point 2 is seen twice
  const Eigen::VectorXd gradient =
    map.transpose() * weights.asDiagonal() * (map * result.Value.ControlPoints - values);
  EXPECT_LE(gradient.cwiseAbs().maxCoeff(), 64.0 * Eps * 5.0 * 5.0);
  EXPECT_GT(result.Residual, 0.1);
}

TEST(Recovery, DependentFunctionsGetTheSolutionOfMinimumNorm_ExactOracle)
{
  // Functions 1 and 2 are alike, and function 4 is alive nowhere: half of the sum each, and zero.
  Eigen::MatrixXd map(3, 5);
  map << 1, 0, 0, 0, 0, //
    0, 0.5, 0.5, 0, 0,  //
    0, 0, 0, 1, 0;
  const auto space = MixedRowSpace(map, 1, 2);
  Spline<1> truth{ space, PointMatrix(5, 1), {} };
  truth.ControlPoints << 3, 1, 7, 5, 9;
  const auto result = RecoverSpline(MakeBezierForm(truth), 0);
  ASSERT_TRUE(result) << result.Status.Message();
  PointMatrix expected(5, 1);
  expected << 3, 4, 4, 5, 0;
  EXPECT_LE((result.Value.ControlPoints - expected).cwiseAbs().maxCoeff(), 64.0 * Eps * 5.0);
  EXPECT_LE(result.Residual, 64.0 * Eps * 5.0);
  // weights of dependent functions stay positive
  truth.Weights = Eigen::VectorXd::Constant(5, 3.0);
  truth.Weights[1] = 1.0;
  const auto rational = RecoverSpline(MakeBezierForm(truth), 0);
  ASSERT_TRUE(rational) << rational.Status.Message();
  EXPECT_TRUE(rational.Value.Check());
  EXPECT_LE(rational.Residual, 64.0 * Eps * 5.0);
}

TEST(Recovery, EveryFailureIsReachable)
{
  Random random(1);
  const auto space = MakeTensorSpace<1>({ KnotVector::Uniform(2, 3) }).Value;
  const BezierForm<1> good = MakeBezierForm(RandomSpline<1>(random, space, 2, true));
  ASSERT_TRUE(RecoverSpline(good, 0));
  const auto expect = [&](ErrorCode code, const std::string& words, auto change)
  {
    BezierForm<1> bad = good;
    change(bad);
    const auto result = RecoverSpline(bad, 0);
    EXPECT_EQ(result.Status.Code, code) << result.Status.Message();
    EXPECT_NE(result.Status.Detail.find(words), std::string::npos) << result.Status.Message();
    EXPECT_FALSE(result);
  };
  using Form = BezierForm<1>;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect(ErrorCode::EmptyInput, "no space", [](Form& f) { f.Space = nullptr; });
  expect(ErrorCode::SizeMismatch, "component", [](Form& f) { f.NumComponents = 0; });
  expect(ErrorCode::SizeMismatch, "offsets", [](Form& f) { f.Offsets.pop_back(); });
  expect(ErrorCode::SizeMismatch, "element 0", [](Form& f) { f.NumComponents = 3; });
  expect(ErrorCode::SizeMismatch, "element 2", [](Form& f) { f.Data.pop_back(); });
  expect(ErrorCode::NonFiniteInput, "element 1", [&](Form& f) { f.Block(1)[0] = nan; });
  expect(ErrorCode::InvalidWeight, "element 2", [](Form& f) { f.Block(2)[6] = 0.0; });
  expect(ErrorCode::InvalidWeight, "element 0", [](Form& f) { f.Block(0)[8] = -1.0; });
  // positive cell weights whose control weights (here 2 Q_0 - Q_1 of an open knot vector) are not
  const auto open = MakeTensorSpace<1>({ KnotVector::Create(2, { 0, 1, 2, 3, 4, 5 }).Value }).Value;
  BezierForm<1> negative = MakeBezierForm(RandomSpline<1>(random, open, 2, true));
  Planes(negative, 0).row(2) << 1.0, 5.0, 1.0;
  EXPECT_EQ(RecoverSpline(negative, 0).Status.Code, ErrorCode::InvalidWeight);

  const BezierForm<1> field = MakeBezierForm(RandomSpline<1>(random, space, 2, false));
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(space->NumFunctions);
  EXPECT_TRUE(RecoverField(field, ones, 0));
  EXPECT_EQ(RecoverField(good, ones, 0).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(RecoverField(field, Eigen::VectorXd::Ones(2), 0).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(RecoverField(field, Eigen::VectorXd(-ones), 0).Status.Code, ErrorCode::InvalidWeight);
}
