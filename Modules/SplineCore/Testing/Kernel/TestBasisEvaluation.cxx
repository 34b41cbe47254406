// SPDX-License-Identifier: BSD-3-Clause
#include "DerivativeOracle.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>

#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
using oracle::Epsilon;

template <int Dim>
void CompareWithDefinition(unsigned seed)
{
  SCOPED_TRACE("Dim " + std::to_string(Dim) + " seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  IntArray<Dim> degree;
  for (int& p : degree)
  {
    p = 1 + static_cast<int>(random() % (Dim == 1 ? 9 : 4));
  }
  IntArray<Dim> elements;
  elements.fill(Dim == 3 ? 2 : 4);
  const Spline<Dim> spline = RandomTensorSpline<Dim>(random, degree, elements, 1, false);
  const SplineSpace<Dim>& space = *spline.Space;
  const PointMatrix u = RandomParameters<Dim>(random, space, 5);
  const auto terms = OracleTerms<Dim>(2);
  FunctionValues values;
  for (Eigen::Index i = 0; i < u.rows(); ++i)
  {
    double local[Dim];
    const int e = space.Locate(u.row(i).data(), local);
    ASSERT_GE(e, 0);
    EvaluateFunctions<Dim>(space, e, local, 2, nullptr, values);
    ASSERT_EQ(values.Functions, space.AliveFunctions(e));
    for (std::size_t f = 0; f < values.Functions.size(); ++f)
    {
      for (std::size_t k = 0; k < terms.size(); ++k)
      {
        int order = 0;
        for (int q : terms[k])
        {
          order += q;
        }
        EXPECT_NEAR(values.Values(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k)),
          OracleFunction<Dim>(space, values.Functions[f], u.row(i).data(), terms[k]),
          1e3 * Epsilon * DerivativeSize<Dim>(space, order));
      }
    }
  }
}

TEST(BasisEvaluation, FollowsTheDefinition_CrossOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    CompareWithDefinition<1>(seed);
    CompareWithDefinition<2>(seed);
    if (seed <= 5)
    {
      CompareWithDefinition<3>(seed);
    }
  }
}

/// Functions times control points against the batch evaluation, and sums of the functions.
template <int Dim>
void CompareWithEvaluation(const Spline<Dim>& spline, std::mt19937_64& random, double scale)
{
  const SplineSpace<Dim>& space = *spline.Space;
  const BezierForm<Dim> form = MakeBezierForm(spline);
  const int n = 40;
  std::vector<int> elements(n);
  PointMatrix local(n, Dim);
  for (int i = 0; i < n; ++i)
  {
    elements[static_cast<std::size_t>(i)] =
      static_cast<int>(random() % static_cast<unsigned>(space.NumElements()));
    for (int d = 0; d < Dim; ++d)
    {
      local(i, d) = i < 4 ? i % 2 : RandomNumber(random);
    }
  }
  EvaluationParams params;
  params.Derivatives = 2;
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateElements(form, elements, local, params, batch));
  const int c = spline.NumComponents();
  FunctionValues values;
  for (int i = 0; i < n; ++i)
  {
    const int e = elements[static_cast<std::size_t>(i)];
    EvaluateFunctions<Dim>(
      space, e, local.row(i).data(), 2, spline.IsRational() ? &spline.Weights : nullptr, values);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(values.Values.cols(), c);
    ASSERT_TRUE(std::is_sorted(values.Functions.begin(), values.Functions.end()));
    for (std::size_t f = 0; f < values.Functions.size(); ++f)
    {
      sum += values.Values.row(static_cast<Eigen::Index>(f)).transpose() *
        spline.ControlPoints.row(values.Functions[f]);
    }
    const Eigen::RowVectorXd total = values.Values.colwise().sum();
    for (Eigen::Index k = 0; k < sum.rows(); ++k)
    {
      const int order = k == 0 ? 0 : (k <= Dim ? 1 : 2);
      const double tol = 1e4 * Epsilon * std::pow(scale, order);
      EXPECT_NEAR(total[k], k == 0 ? 1.0 : 0.0, tol) << "term " << k;
      for (int j = 0; j < c; ++j)
      {
        const double expected = k == 0
          ? batch.Values(i, j)
          : (k <= Dim ? batch.First(i, (k - 1) * c + j) : batch.Second(i, (k - 1 - Dim) * c + j));
        EXPECT_NEAR(sum(k, j), expected, tol) << "point " << i << " term " << k;
      }
    }
  }
}

TEST(BasisEvaluation, TensorFunctionsTimesPointsIsTheMap_CrossOracle)
{
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const bool rational = seed % 2 == 0;
    const int p = 1 + static_cast<int>(seed) % 5;
    const auto curve = RandomTensorSpline<1>(random, { p + 3 }, { 4 }, 2, rational);
    CompareWithEvaluation<1>(curve, random, DerivativeSize<1>(*curve.Space, 1));
    const auto surface = RandomTensorSpline<2>(random, { p, 3 }, { 4, 3 }, 3, rational);
    CompareWithEvaluation<2>(surface, random, DerivativeSize<2>(*surface.Space, 1));
    const auto volume = RandomTensorSpline<3>(random, { p, 2, 1 }, { 2, 3, 2 }, 3, rational);
    CompareWithEvaluation<3>(volume, random, DerivativeSize<3>(*volume.Space, 1));
  }
}

template <int Dim>
SplineSpacePtr<Dim> RandomHierarchy(std::mt19937_64& random, int degree)
{
  std::array<KnotVector, Dim> knots;
  for (KnotVector& k : knots)
  {
    k = KnotVector::Uniform(degree, 5);
  }
  std::vector<HierarchyBox<Dim>> boxes;
  for (int level = 1; level <= 3; ++level)
  {
    HierarchyBox<Dim> box; // one that shrinks to a random corner cell of the coarse grid
    box.Level = level;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const int n = 5 << (level - 1);
      const int first = static_cast<int>(random() % static_cast<unsigned>(n - 3));
      box.Lower[d] = 2 * first;
      box.Upper[d] = 2 * (first + 4 - level / 3);
    }
    boxes.push_back(box);
  }
  return MakeHierarchicalSpace<Dim>(knots, boxes).Value;
}

TEST(BasisEvaluation, HierarchicalFunctionsTimesPointsIsTheMap_CrossOracle)
{
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const auto run = [&](auto space, double scale)
    {
      constexpr int dim = std::tuple_size_v<decltype(space->Knots)>;
      ASSERT_TRUE(space);
      ASSERT_FALSE(space->IsIdentityMap());
      Spline<dim> spline;
      spline.Space = space;
      spline.ControlPoints = RandomMatrix(random, space->NumFunctions, 3);
      if (seed % 2 == 0)
      {
        spline.Weights =
          (RandomMatrix(random, space->NumFunctions, 1).array() * 0.5 + 1.0).matrix();
      }
      CompareWithEvaluation<dim>(spline, random, scale);
    };
    // elements of level 3 are 1/40 long; derivatives of degree p reach (2 p 40)^order
    const int p = 1 + static_cast<int>(seed) % 4;
    run(RandomHierarchy<1>(random, p), 80.0 * p);
    run(RandomHierarchy<2>(random, p), 80.0 * p);
    run(RandomHierarchy<3>(random, 2), 160.0);
  }
}

TEST(BasisEvaluation, HierarchicalCollocationTimesPointsIsTheMap_CrossOracle)
{
  std::mt19937_64 random(19);
  Spline<2> spline;
  spline.Space = RandomHierarchy<2>(random, 3);
  spline.ControlPoints = RandomMatrix(random, spline.Space->NumFunctions, 2);
  const PointMatrix u = RandomParameters<2>(random, *spline.Space, 2000);
  const auto matrix = CollocationMatrix<2>(*spline.Space, u, 0);
  ASSERT_TRUE(matrix) << matrix.Status.Message();
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(spline), u, {}, batch));
  const PointMatrix values = matrix.Value * spline.ControlPoints;
  EXPECT_LE((values - batch.Values).cwiseAbs().maxCoeff(), 1e3 * Epsilon);
}

TEST(BasisEvaluation, BezierCellsThatShareAPoint_CrossOracle)
{
  // the second cell has a collapsed edge: one id twice
  const auto space =
    MakeBezierSpace<2>({ { 1, 1 }, { 2, 1 } }, { 0, 1, 2, 3, 1, 4, 5, 3, 3, 3 }, 6);
  ASSERT_TRUE(space) << space.Status.Message();
  std::mt19937_64 random(3);
  for (bool rational : { false, true })
  {
    Spline<2> spline;
    spline.Space = space.Value;
    spline.ControlPoints = RandomMatrix(random, 6, 2);
    if (rational)
    {
      spline.Weights = (RandomMatrix(random, 6, 1).array() * 0.5 + 1.0).matrix();
    }
    CompareWithEvaluation<2>(spline, random, 4.0);
  }
}

TEST(BasisEvaluation, CollocationTimesPointsIsTheMap_CrossOracle)
{
  std::mt19937_64 random(11);
  const auto spline = RandomTensorSpline<2>(random, { 2, 4 }, { 5, 6 }, 3, false);
  const PointMatrix u = RandomParameters<2>(random, *spline.Space, 3000);
  const auto matrix = CollocationMatrix<2>(*spline.Space, u, 0);
  ASSERT_TRUE(matrix) << matrix.Status.Message();
  ASSERT_EQ(matrix.Value.rows(), u.rows());
  ASSERT_EQ(matrix.Value.cols(), spline.Space->NumFunctions);
  EXPECT_EQ(matrix.Value.nonZeros(), u.rows() * 15);
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(spline), u, {}, batch));
  const PointMatrix values = matrix.Value * spline.ControlPoints;
  EXPECT_LE((values - batch.Values).cwiseAbs().maxCoeff(), 1e3 * Epsilon);
}

TEST(BasisEvaluation, CollocationFailures)
{
  const auto space = MakeTensorSpace<1>({ KnotVector::Uniform(2, 3) }).Value;
  EXPECT_EQ(
    CollocationMatrix<1>(*space, PointMatrix::Zero(2, 2), 0).Status.Code, ErrorCode::SizeMismatch);
  PointMatrix u = PointMatrix::Constant(2000, 1, 0.5);
  u(1500, 0) = 1.5;
  u(1700, 0) = std::nan("");
  const auto outside = CollocationMatrix<1>(*space, u, 0);
  EXPECT_EQ(outside.Status.Code, ErrorCode::OutsideDomain);
  EXPECT_NE(outside.Status.Detail.find("1500"), std::string::npos) << outside.Status.Detail;
  const auto bezier = MakeBezierSpace<1>({ { 1 } }, { 0, 1 }, 2).Value;
  EXPECT_EQ(CollocationMatrix<1>(*bezier, u, 0).Status.Code, ErrorCode::DimensionMismatch);
  const auto empty = CollocationMatrix<1>(*space, PointMatrix(0, 1), 0);
  ASSERT_TRUE(empty);
  EXPECT_EQ(empty.Value.rows(), 0);
  EXPECT_EQ(empty.Value.cols(), 5);
}
}
}
