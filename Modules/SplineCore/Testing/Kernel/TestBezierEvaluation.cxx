// SPDX-License-Identifier: BSD-3-Clause
#include "DerivativeOracle.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/Shapes.h>

#include <gtest/gtest.h>

#include <complex>
#include <cstring>

namespace knotwork
{
namespace
{
using oracle::Epsilon;

EvaluationParams Order(int derivatives, int threads = 0)
{
  EvaluationParams params;
  params.Derivatives = derivatives;
  params.Threads = threads;
  return params;
}

bool SameBits(const PointMatrix& a, const PointMatrix& b)
{
  return a.rows() == b.rows() && a.cols() == b.cols() &&
    std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

/// Term k of point i: value, first derivatives, second derivatives.
Eigen::RowVectorXd Term(const EvaluationBatch& batch, int dim, Eigen::Index i, Eigen::Index k)
{
  const Eigen::Index c = batch.Values.cols();
  if (k == 0)
  {
    return batch.Values.row(i);
  }
  return k <= dim ? batch.First.block(i, (k - 1) * c, 1, c).eval()
                  : batch.Second.block(i, (k - 1 - dim) * c, 1, c).eval();
}

template <int Dim>
void CompareWithDefinition(
  const IntArray<Dim>& degree, int components, bool rational, unsigned seed)
{
  SCOPED_TRACE("Dim " + std::to_string(Dim) + " degree " + std::to_string(degree[0]) +
    " components " + std::to_string(components) + " seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  IntArray<Dim> elements;
  elements.fill(Dim == 1 ? 4 : 2);
  const Spline<Dim> spline =
    RandomTensorSpline<Dim>(random, degree, elements, components, rational);
  const BezierForm<Dim> form = MakeBezierForm(spline);
  const PointMatrix u = RandomParameters<Dim>(random, *spline.Space, 2);
  for (int order = 0; order <= 2; ++order)
  {
    EvaluationBatch batch;
    const Status status = EvaluateParameters(form, u, Order(order), batch);
    ASSERT_TRUE(status) << status.Message();
    EXPECT_EQ(batch.First.rows(), order >= 1 ? u.rows() : 0);
    EXPECT_EQ(batch.Second.rows(), order >= 2 ? u.rows() : 0);
    for (Eigen::Index i = 0; i < u.rows(); ++i)
    {
      const Eigen::MatrixXd expected = OracleEvaluate<Dim>(spline, u.row(i).data(), order);
      for (Eigen::Index k = 0; k < expected.rows(); ++k)
      {
        // control points and weights are of size 1; weights of at least 1/2 cost a factor 2^order;
        // the recursion of degree p loses p roundings a direction
        const int q = k == 0 ? 0 : (k <= Dim ? 1 : 2);
        const double tol = 2e3 * Epsilon * DerivativeSize<Dim>(*spline.Space, q) *
          (rational ? std::pow(4.0, q) : 1.0);
        EXPECT_LE((Term(batch, Dim, i, k) - expected.row(k)).cwiseAbs().maxCoeff(), tol)
          << "point " << u.row(i) << " term " << k;
      }
    }
  }
}

TEST(BezierEvaluation, CurvesOfAllDegreesAndComponents_CrossOracle)
{
  for (int p = 1; p <= 9; ++p)
  {
    for (int c = 1; c <= 6; ++c)
    {
      CompareWithDefinition<1>({ p }, c, false, static_cast<unsigned>(10 * p + c));
      CompareWithDefinition<1>({ p }, c, true, static_cast<unsigned>(10 * p + c));
    }
  }
}

TEST(BezierEvaluation, SurfacesOfAllDegreesAndComponents_CrossOracle)
{
  for (int p = 1; p <= 6; ++p)
  {
    for (int c = 1; c <= 6; ++c)
    {
      CompareWithDefinition<2>({ p, p }, c, false, static_cast<unsigned>(10 * p + c));
      CompareWithDefinition<2>({ p, p }, c, true, static_cast<unsigned>(10 * p + c));
    }
  }
  CompareWithDefinition<2>({ 9, 9 }, 3, false, 1);
  CompareWithDefinition<2>({ 7, 8 }, 3, true, 2);
  CompareWithDefinition<2>({ 3, 1 }, 3, true, 3);
  CompareWithDefinition<2>({ 1, 4 }, 2, false, 4);
}

TEST(BezierEvaluation, VolumesOfAllDegreesAndComponents_CrossOracle)
{
  for (int c = 1; c <= 5; ++c)
  {
    CompareWithDefinition<3>({ 1, 1, 1 }, c, c % 2 == 0, static_cast<unsigned>(c));
    CompareWithDefinition<3>({ 2, 2, 2 }, c, c % 2 == 1, static_cast<unsigned>(c));
  }
  for (bool rational : { false, true })
  {
    CompareWithDefinition<3>({ 3, 3, 3 }, 3, rational, 21);
    CompareWithDefinition<3>({ 4, 4, 4 }, 1, rational, 22);
    CompareWithDefinition<3>({ 5, 5, 5 }, 1, rational, 23);
    CompareWithDefinition<3>({ 1, 2, 3 }, 3, rational, 24);
    CompareWithDefinition<3>({ 6, 1, 2 }, 2, rational, 25);
  }
}

/// B-spline coefficient of the monomial u^k: mean of the products of k inner knots (blossom).
double MonomialCoefficient(const KnotVector& knots, int function, int k)
{
  std::vector<double> symmetric(static_cast<std::size_t>(k) + 1, 0.0);
  symmetric[0] = 1.0;
  for (int i = 1; i <= knots.Degree(); ++i)
  {
    for (int j = k; j > 0; --j)
    {
      const auto s = static_cast<std::size_t>(j);
      symmetric[s] += symmetric[s - 1] * knots.Knots()[static_cast<std::size_t>(function + i)];
    }
  }
  return symmetric.back() / Binomial(knots.Degree(), k);
}

TEST(BezierEvaluation, PolynomialMapWithItsDerivatives_ExactOracle)
{
  std::mt19937_64 random(17);
  Spline<3> spline = RandomTensorSpline<3>(random, { 3, 3, 3 }, { 5, 3, 4 }, 2, false);
  const SplineSpace<3>& space = *spline.Space;
  // x = u^3 v w^2, y = u - 2 v^2 w
  for (int i = 0; i < space.NumFunctions; ++i)
  {
    const int n0 = space.Knots[0].NumFunctions();
    const int n1 = space.Knots[1].NumFunctions();
    const auto m = [&](int a, int b, int c)
    {
      return MonomialCoefficient(space.Knots[0], i % n0, a) *
        MonomialCoefficient(space.Knots[1], i / n0 % n1, b) *
        MonomialCoefficient(space.Knots[2], i / n0 / n1, c);
    };
    spline.ControlPoints.row(i) << m(3, 1, 2), m(1, 0, 0) - 2.0 * m(0, 2, 1);
  }
  const PointMatrix parameters = RandomParameters<3>(random, space, 500);
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(spline), parameters, Order(2), batch));
  for (Eigen::Index i = 0; i < parameters.rows(); ++i)
  {
    const double u = parameters(i, 0);
    const double v = parameters(i, 1);
    const double w = parameters(i, 2);
    const double expected[10][2] = { { u * u * u * v * w * w, u - 2 * v * v * w },
      { 3 * u * u * v * w * w, 1 }, { u * u * u * w * w, -4 * v * w },
      { 2 * u * u * u * v * w, -2 * v * v }, { 6 * u * v * w * w, 0 }, { 3 * u * u * w * w, 0 },
      { 6 * u * u * v * w, 0 }, { 0, -4 * w }, { 2 * u * u * u * w, -4 * v },
      { 2 * u * u * u * v, 0 } };
    for (int k = 0; k < 10; ++k)
    {
      // values reach 3^6; differences of rounded coefficients over short elements
      const int q = k == 0 ? 0 : (k <= 3 ? 1 : 2);
      const double tol = 32 * Epsilon * 729.0 * DerivativeSize<3>(space, q);
      EXPECT_NEAR(Term(batch, 3, i, k)[0], expected[k][0], tol) << "term " << k;
      EXPECT_NEAR(Term(batch, 3, i, k)[1], expected[k][1], tol) << "term " << k;
    }
  }
}

TEST(BezierEvaluation, QuarterCircleWithItsDerivatives_ExactOracle)
{
  Spline<1> arc;
  arc.Space = MakeTensorSpace<1>({ KnotVector::Uniform(2, 1) }).Value;
  arc.ControlPoints.resize(3, 2);
  arc.ControlPoints << 1, 0, 1, 1, 0, 1;
  arc.Weights.resize(3);
  arc.Weights << 1, std::sqrt(0.5), 1;
  PointMatrix u(101, 1);
  for (int i = 0; i <= 100; ++i)
  {
    u(i, 0) = i / 100.0;
  }
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(arc), u, Order(2), batch));
  for (int i = 0; i <= 100; ++i)
  {
    // x + i y = (s^2 + sqrt(2) s t (1 + i) + t^2 i) / w; derivatives by quotient rule on paper
    using Complex = std::complex<double>;
    const Complex j(0.0, 1.0);
    const double t = u(i, 0);
    const double s = 1.0 - t;
    const double r = std::sqrt(2.0);
    const double w = s * s + r * s * t + t * t;
    const double w1 = -2 * s + r * (s - t) + 2 * t;
    const double w2 = 4 - 2 * r;
    const Complex a = s * s + r * s * t * (1.0 + j) + t * t * j;
    const Complex a1 = -2 * s + r * (s - t) * (1.0 + j) + 2 * t * j;
    const Complex a2 = 2.0 - 2 * r * (1.0 + j) + 2.0 * j;
    const Complex z = a / w;
    const Complex z1 = (a1 * w - a * w1) / (w * w);
    const Complex z2 =
      a2 / w - 2.0 * a1 * w1 / (w * w) - a * w2 / (w * w) + 2.0 * a * w1 * w1 / (w * w * w);
    EXPECT_NEAR(std::abs(z), 1.0, 8 * Epsilon);
    EXPECT_LE(std::abs(Complex(batch.Values(i, 0), batch.Values(i, 1)) - z), 16 * Epsilon);
    EXPECT_LE(std::abs(Complex(batch.First(i, 0), batch.First(i, 1)) - z1), 64 * Epsilon);
    EXPECT_LE(std::abs(Complex(batch.Second(i, 0), batch.Second(i, 1)) - z2), 256 * Epsilon);
  }
}

/// On |x| = R: x.x = R^2, x.x_a = 0, x_a.x_b + x.x_ab = 0; on a cylinder for the first two
/// coordinates alone.
void ExpectRoundSurface(const Spline<2>& spline, double radius, int coordinates)
{
  std::mt19937_64 random(9);
  const PointMatrix u = RandomParameters<2>(random, *spline.Space, 300);
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(spline), u, Order(2), batch));
  const double size = DerivativeSize<2>(*spline.Space, 1) * 8.0; // ratio of weights
  double largest = 0.0;
  for (Eigen::Index i = 0; i < u.rows(); ++i)
  {
    const auto term = [&](int k) { return Term(batch, 2, i, k).head(coordinates).eval(); };
    const double r2 = radius * radius;
    EXPECT_NEAR(term(0).squaredNorm(), r2, 32 * Epsilon * r2);
    const int pair[3][2] = { { 1, 1 }, { 1, 2 }, { 2, 2 } };
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_NEAR(term(0).dot(term(1 + k % 2)), 0.0, 64 * Epsilon * r2 * size);
      EXPECT_NEAR(term(pair[k][0]).dot(term(pair[k][1])) + term(0).dot(term(3 + k)), 0.0,
        256 * Epsilon * r2 * size * size);
    }
    largest = std::max(largest, term(1).norm());
  }
  EXPECT_GT(largest, radius); // the derivatives are not all zero
}

TEST(BezierEvaluation, SpheresAndCylindersAreRound_ExactOracle)
{
  ShapeParams params;
  params.OuterRadius = 2.0;
  params.Elements = { 3, 2, 1 };
  params.Kind = ShapeKind::SphereSurface;
  const auto sphere = MakeShape(params);
  ASSERT_TRUE(sphere) << sphere.Status.Message();
  for (const AnySpline& patch : sphere.Value)
  {
    ExpectRoundSurface(std::get<Spline<2>>(patch), 2.0, 3);
  }
  params.Kind = ShapeKind::CylinderSurface;
  params.Angle = 360.0;
  const auto cylinder = MakeShape(params);
  ASSERT_TRUE(cylinder) << cylinder.Status.Message();
  ExpectRoundSurface(std::get<Spline<2>>(cylinder.Value.front()), 2.0, 2);
}

TEST(BezierEvaluation, MixedDegreesOfBezierCells_CrossOracle)
{
  const std::vector<IntArray<2>> degrees{ { 3, 3 }, { 2, 1 }, { 1, 1 }, { 6, 2 }, { 3, 3 },
    { 5, 5 } };
  std::vector<int> ids;
  for (const auto& degree : degrees)
  {
    for (int k = NumTensorFunctions<2>(degree); k > 0; --k)
    {
      ids.push_back(static_cast<int>(ids.size()));
    }
  }
  Spline<2> spline;
  spline.Space = MakeBezierSpace<2>(degrees, ids, static_cast<int>(ids.size())).Value;
  std::mt19937_64 random(2);
  spline.ControlPoints = RandomMatrix(random, static_cast<int>(ids.size()), 3);
  const BezierForm<2> form = MakeBezierForm(spline);
  const int n = 2000;
  std::vector<int> elements;
  PointMatrix local(n, 2);
  for (int i = 0; i < n; ++i)
  {
    elements.push_back(static_cast<int>(random() % degrees.size()));
    local.row(i) << RandomNumber(random), RandomNumber(random);
  }
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateElements(form, elements, local, Order(2), batch));
  EXPECT_EQ(batch.Elements, elements);
  for (int i = 0; i < n; ++i)
  {
    const auto e = static_cast<std::size_t>(elements[static_cast<std::size_t>(i)]);
    const IntArray<2> degree = degrees[e];
    const int size = NumTensorFunctions<2>(degree);
    for (int c = 0; c < 3; ++c)
    {
      const double* block = form.Block(static_cast<int>(e)) + c * size;
      const std::vector<double> q(block, block + size);
      const double* t = local.row(i).data();
      EXPECT_NEAR(batch.Values(i, c), BernsteinEvaluate<2>(degree, q.data(), t), 64 * Epsilon);
      for (int d = 0; d < 2; ++d)
      {
        IntArray<2> lower = degree;
        --lower[static_cast<std::size_t>(d)];
        const auto first = BernsteinDerivative<2>(degree, q, d);
        EXPECT_NEAR(
          batch.First(i, 3 * d + c), BernsteinEvaluate<2>(lower, first.data(), t), 512 * Epsilon);
        if (d == 0)
        {
          --lower[1];
          const auto mixed = BernsteinDerivative<2>({ degree[0] - 1, degree[1] }, first, 1);
          EXPECT_NEAR(
            batch.Second(i, 3 + c), BernsteinEvaluate<2>(lower, mixed.data(), t), 1e4 * Epsilon);
        }
      }
    }
  }
}

TEST(BezierEvaluation, RefinedHierarchicallyTheMapStays_CrossOracle)
{
  for (bool rational : { false, true })
  {
    std::mt19937_64 random(13);
    const auto coarse = RandomTensorSpline<2>(random, { 3, 2 }, { 5, 4 }, 3, rational);
    HierarchyBox<2> inner;
    inner.Level = 1;
    inner.Lower = { 2, 0 };
    inner.Upper = { 10, 6 };
    HierarchyBox<2> corner;
    corner.Level = 2;
    corner.Lower = { 4, 0 };
    corner.Upper = { 12, 8 };
    const auto space = MakeHierarchicalSpace<2>(coarse.Space->Knots, { inner, corner });
    ASSERT_TRUE(space) << space.Status.Message();
    const auto fine = TransferToRefined<2>(coarse, space.Value);
    ASSERT_TRUE(fine) << fine.Status.Message();
    const PointMatrix u = RandomParameters<2>(random, *coarse.Space, 1000);
    EvaluationBatch a;
    EvaluationBatch b;
    ASSERT_TRUE(EvaluateParameters(MakeBezierForm(coarse), u, Order(2), a));
    ASSERT_TRUE(EvaluateParameters(MakeBezierForm(fine.Value), u, Order(2), b));
    // a knot at which the map is not smooth enough stays a knot: derivatives agree everywhere
    const double size = 4.0 * DerivativeSize<2>(*coarse.Space, 1) * (rational ? 4.0 : 1.0);
    const auto difference = [](const PointMatrix& x, const PointMatrix& y)
    { return (x - y).cwiseAbs().maxCoeff(); };
    EXPECT_LE(difference(a.Values, b.Values), 1e3 * Epsilon);
    EXPECT_LE(difference(a.First, b.First), 1e3 * Epsilon * size);
    EXPECT_LE(difference(a.Second, b.Second), 1e3 * Epsilon * size * size);
    EXPECT_GT(space.Value->NumElements(), coarse.Space->NumElements());
  }
}

TEST(BezierEvaluation, BreaksBelongToTheRightAndEndsInterpolate_ExactOracle)
{
  Spline<1> spline;
  // quadratic with a double knot at 2: a kink with the control point on the curve
  spline.Space =
    MakeTensorSpace<1>({ KnotVector::Create(2, { 0, 0, 0, 1, 2, 2, 4, 4, 4 }).Value }).Value;
  spline.ControlPoints.resize(6, 1);
  spline.ControlPoints << 0.3, 1, -1, 0.7, 0, 0.1;
  PointMatrix u(4, 1);
  u << 0, 2, 4, 1;
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(spline), u, Order(1), batch));
  EXPECT_EQ(batch.Elements, (std::vector<int>{ 0, 2, 2, 1 }));
  EXPECT_EQ(batch.Values(0, 0), 0.3);
  EXPECT_EQ(batch.Values(1, 0), 0.7);
  EXPECT_EQ(batch.Values(2, 0), 0.1);
  EXPECT_NEAR(batch.Values(3, 0), 0.5 * 1 + 0.5 * -1, 4 * Epsilon);
  EXPECT_NEAR(batch.First(1, 0), 2 * (0 - 0.7) / 2.0, 8 * Epsilon); // from the right
  EXPECT_NEAR(batch.First(2, 0), 2 * (0.1 - 0) / 2.0, 8 * Epsilon);
}

TEST(BezierEvaluation, ElementsAndParametersAgreeBitByBit_PropertyOracle)
{
  std::mt19937_64 random(23);
  const auto spline = RandomTensorSpline<2>(random, { 3, 3 }, { 7, 5 }, 3, true);
  const BezierForm<2> form = MakeBezierForm(spline);
  const PointMatrix u = RandomParameters<2>(random, *spline.Space, 700);
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(form, u, Order(2), batch));
  PointMatrix local(u.rows(), 2);
  for (Eigen::Index i = 0; i < u.rows(); ++i)
  {
    EXPECT_EQ(spline.Space->Locate(u.row(i).data(), local.row(i).data()),
      batch.Elements[static_cast<std::size_t>(i)]);
  }
  EvaluationBatch again;
  ASSERT_TRUE(EvaluateElements(form, batch.Elements, local, Order(2), again));
  EXPECT_TRUE(SameBits(batch.Values, again.Values));
  EXPECT_TRUE(SameBits(batch.First, again.First));
  EXPECT_TRUE(SameBits(batch.Second, again.Second));
}

TEST(BezierEvaluation, SameBitsForAnyThreadsAndOrder_PropertyOracle)
{
  std::mt19937_64 random(29);
  const auto spline = RandomTensorSpline<3>(random, { 3, 3, 3 }, { 4, 3, 5 }, 3, false);
  const BezierForm<3> form = MakeBezierForm(spline);
  const PointMatrix u = RandomParameters<3>(random, *spline.Space, 4321);
  EvaluationBatch one;
  EvaluationBatch two;
  ASSERT_TRUE(EvaluateParameters(form, u, Order(2, 1), one));
  for (int threads : { 0, 2 })
  {
    ASSERT_TRUE(EvaluateParameters(form, u, Order(2, threads), two));
    EXPECT_TRUE(SameBits(one.Values, two.Values));
    EXPECT_TRUE(SameBits(one.First, two.First));
    EXPECT_TRUE(SameBits(one.Second, two.Second));
    EXPECT_EQ(one.Elements, two.Elements);
  }
  const PointMatrix reversed = u.colwise().reverse();
  ASSERT_TRUE(EvaluateParameters(form, reversed, Order(2), two));
  EXPECT_TRUE(SameBits(one.Second, two.Second.colwise().reverse()));
}

TEST(BezierEvaluation, PointsOutsideAreMarkedAndNamed_ExactOracle)
{
  std::mt19937_64 random(31);
  for (int p : { 3, 6 })
  {
    const auto spline = RandomTensorSpline<2>(random, { p, p }, { 4, 4 }, 3, true);
    const BezierForm<2> form = MakeBezierForm(spline);
    const auto box = spline.Space->Domain();
    PointMatrix u = RandomParameters<2>(random, *spline.Space, 1500);
    EvaluationBatch inside;
    ASSERT_TRUE(EvaluateParameters(form, u, Order(2), inside));
    u(700, 1) = box.Upper[1] + 0.01;
    u(900, 0) = std::nan("");
    u(1200, 0) = -std::numeric_limits<double>::infinity();
    EvaluationBatch batch;
    const Status status = EvaluateParameters(form, u, Order(2), batch);
    EXPECT_EQ(status.Code, ErrorCode::OutsideDomain);
    EXPECT_EQ(status.Detail.substr(0, 11), "point 700 (") << status.Detail;
    for (Eigen::Index i = 0; i < u.rows(); ++i)
    {
      const bool bad = i == 700 || i == 900 || i == 1200;
      EXPECT_EQ(batch.Elements[static_cast<std::size_t>(i)] == -1, bad);
      for (Eigen::Index k = 0; k < 6; ++k)
      {
        const auto row = Term(batch, 2, i, k);
        EXPECT_TRUE(bad ? row.array().isNaN().all() : row == Term(inside, 2, i, k)) << i;
      }
    }
  }
}

TEST(BezierEvaluation, BadElementsAreMarkedAndNamed_ExactOracle)
{
  std::mt19937_64 random(37);
  const auto spline = RandomTensorSpline<1>(random, { 2 }, { 4 }, 2, false);
  const BezierForm<1> form = MakeBezierForm(spline);
  PointMatrix local = PointMatrix::Constant(4, 1, 0.5);
  local(3, 0) = std::nan("");
  EvaluationBatch batch;
  const Status status = EvaluateElements(form, { 0, 1000000, -7, 1 }, local, {}, batch);
  EXPECT_EQ(status.Code, ErrorCode::OutsideDomain);
  EXPECT_EQ(status.Detail.substr(0, 7), "point 1") << status.Detail;
  EXPECT_EQ(batch.Elements, (std::vector<int>{ 0, -1, -1, -1 }));
  EXPECT_TRUE(batch.Values.row(0).array().isFinite().all());
  EXPECT_TRUE(batch.Values.bottomRows(3).array().isNaN().all());
}

TEST(BezierEvaluation, EmptyBatchAndReusedMemory_ExactOracle)
{
  std::mt19937_64 random(41);
  const auto spline = RandomTensorSpline<2>(random, { 2, 2 }, { 4, 4 }, 3, false);
  const BezierForm<2> form = MakeBezierForm(spline);
  const PointMatrix u = RandomParameters<2>(random, *spline.Space, 50);
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(form, u, Order(2), batch));
  const double* memory = batch.Second.data();
  ASSERT_TRUE(EvaluateParameters(form, u, Order(2), batch));
  EXPECT_EQ(batch.Second.data(), memory);
  ASSERT_TRUE(EvaluateParameters(form, PointMatrix(0, 2), Order(1), batch));
  EXPECT_EQ(batch.Values.rows(), 0);
  EXPECT_EQ(batch.Values.cols(), 3);
  EXPECT_EQ(batch.First.cols(), 6);
  EXPECT_TRUE(batch.Elements.empty());
  ASSERT_TRUE(EvaluateElements(form, {}, PointMatrix(0, 2), Order(1), batch));
}

TEST(BezierEvaluation, ColumnsOfAWiderMatrix_CrossOracle)
{
  std::mt19937_64 random(43);
  const auto spline = RandomTensorSpline<2>(random, { 3, 2 }, { 4, 4 }, 3, false);
  const BezierForm<2> form = MakeBezierForm(spline);
  const PointMatrix u = RandomParameters<2>(random, *spline.Space, 600);
  PointMatrix wide = PointMatrix::Constant(u.rows(), 5, std::nan(""));
  wide.middleCols(1, 2) = u;
  EvaluationBatch a;
  EvaluationBatch b;
  ASSERT_TRUE(EvaluateParameters(form, u, Order(0), a));
  ASSERT_TRUE(EvaluateParameters(form, wide.middleCols(1, 2), Order(0), b));
  EXPECT_TRUE(SameBits(a.Values, b.Values));
}

TEST(BezierEvaluation, EveryFailureIsReachable)
{
  std::mt19937_64 random(47);
  const auto spline = RandomTensorSpline<2>(random, { 2, 2 }, { 2, 2 }, 3, false);
  const BezierForm<2> form = MakeBezierForm(spline);
  const PointMatrix u = PointMatrix::Constant(3, 2, 1.0);
  EvaluationBatch batch;
  const auto code =
    [&](const BezierForm<2>& f, const PointMatrix& points, const EvaluationParams& params)
  { return EvaluateParameters(f, points, params, batch).Code; };
  EXPECT_EQ(code({}, u, {}), ErrorCode::EmptyInput);
  EXPECT_EQ(code(form, PointMatrix::Zero(3, 3), {}), ErrorCode::SizeMismatch);
  EXPECT_EQ(code(form, u, Order(3)), ErrorCode::InvalidParameter);
  EXPECT_EQ(code(form, u, Order(-1)), ErrorCode::InvalidParameter);
  EXPECT_EQ(code(form, u, Order(0, -1)), ErrorCode::InvalidParameter);
  EXPECT_EQ(EvaluateElements(form, { 0, 1 }, u, {}, batch).Code, ErrorCode::SizeMismatch);
  Spline<2> cell;
  cell.Space = MakeBezierSpace<2>({ { 1, 1 } }, { 0, 1, 2, 3 }, 4).Value;
  cell.ControlPoints = PointMatrix::Zero(4, 3);
  EXPECT_EQ(code(MakeBezierForm(cell), u, {}), ErrorCode::DimensionMismatch);
}
}
}
