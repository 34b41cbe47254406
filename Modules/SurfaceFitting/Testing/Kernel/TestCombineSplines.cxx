// SPDX-License-Identifier: BSD-3-Clause
#include "LRCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/FunctionGraph.h>
#include <knotwork/SplineCore/HeightField.h>
#include <knotwork/SplineCore/LROperations.h>
#include <knotwork/SplineCore/LocallyRefinedForm.h>
#include <knotwork/SurfaceFitting/CombineSplines.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
const ParametricBox<2> Box{ { -1, 2 }, { 2, 3.5 } };

/// Random splines on one domain: 0 tensor, 1 hierarchical, 2 LR.
Spline<2> RandomOn(Random& random, const ParametricBox<2>& box, const IntArray<2>& degree, int kind)
{
  std::array<KnotVector, 2> knots;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const int elements = random.Int(1, 4);
    std::vector<double> t(degree[d] + 1, box.Lower[d]);
    for (int e = 1; e < elements; ++e)
    {
      t.insert(t.end(), random.Int(1, degree[d]),
        box.Lower[d] + (e + random.In(-0.3, 0.3)) / elements * (box.Upper[d] - box.Lower[d]));
    }
    t.insert(t.end(), degree[d] + 1, box.Upper[d]);
    knots[d] = KnotVector::Create(degree[d], t).Value;
  }
  SplineSpacePtr<2> space = MakeTensorSpace<2>(knots).Value;
  if (kind == 1)
  {
    for (int step = 0; step < 3; ++step)
    {
      RefinementParams params;
      params.Extension = 1;
      space = RefineElements<2>(space, { random.Int(0, space->NumElements() - 1) }, params).Value;
    }
  }
  if (kind == 2)
  {
    space = InsertSegments(space, RandomSegments(random, space, 12), 0).Value;
  }
  return RandomSpline<2>(random, space, 2, false);
}

PointMatrix ValuesAt(const Spline<2>& spline, const PointMatrix& at)
{
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(spline), at, {}, batch));
  return batch.Values;
}

PointMatrix PointsOf(Random& random, const ParametricBox<2>& box)
{
  PointMatrix at(100, 2);
  for (Eigen::Index i = 0; i < at.rows(); ++i)
  {
    at.row(i) << random.In(box.Lower[0], box.Upper[0]), random.In(box.Lower[1], box.Upper[1]);
  }
  return at;
}
}

TEST(CombineSplines, AllKindsWithAll_CrossOracle)
{
  for (unsigned seed = 1; seed <= 36; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const IntArray<2> degree{ random.Int(1, 4), random.Int(1, 4) };
    const int kindA = static_cast<int>(seed % 3);
    const int kindB = static_cast<int>(seed / 3 % 3);
    const Spline<2> a = RandomOn(random, Box, degree, kindA);
    const Spline<2> b = RandomOn(random, Box, degree, kindB);
    const double wa = random.In(-2, 2);
    const double wb = random.In(-2, 2);
    CombineParams params;
    params.NumKept = static_cast<int>(seed % 2);
    const auto result = CombineSplines(a, b, wa, wb, params);
    ASSERT_TRUE(result) << result.Status.Message();
    const PointMatrix at = PointsOf(random, Box);
    const PointMatrix values = ValuesAt(result->Value, at);
    PointMatrix expected = wa * ValuesAt(a, at) + wb * ValuesAt(b, at);
    expected.leftCols(params.NumKept) = ValuesAt(a, at).leftCols(params.NumKept);
    EXPECT_LE((values - expected).cwiseAbs().maxCoeff(), 1e-11); // coefficients up to 40
    for (int c = 0; c < 2; ++c)
    {
      EXPECT_LE(result->Lower[c], values.col(c).minCoeff() + 1e-12);
      EXPECT_GE(result->Upper[c], values.col(c).maxCoeff() - 1e-12);
    }
    if (kindA == 0 && kindB == 0)
    {
      EXPECT_EQ(result->Value.Space->Kind, SpaceKind::Tensor);
    }
  }
}

TEST(CombineSplines, DifferenceFromARefinementOfItselfIsZero_ExactOracle)
{
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Spline<2> a = RandomOn(random, Box, { 2, 3 }, 2);
    const Spline<2> finer = InsertSegments(a, RandomSegments(random, a.Space, 10), 0).Value;
    const auto result = CombineSplines(a, finer, 1.0, -1.0);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_LE(result->Value.ControlPoints.cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(result->Value.Space->NumFunctions, finer.Space->NumFunctions);
  }
}

TEST(CombineSplines, HierarchiesStayHierarchical_PropertyOracle)
{
  Random random(2);
  const auto root =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 6), KnotVector::Uniform(2, 5) }).Value;
  const auto left = RandomSpline<2>(random, RefineElements<2>(root, { 7, 8 }).Value, 1, false);
  const auto right = RandomSpline<2>(random, RefineElements<2>(root, { 20 }).Value, 1, false);
  const auto result = CombineSplines(left, right, 0.5, 0.5);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Value.Space->Kind, SpaceKind::Hierarchical);
}

TEST(CombineSplines, DegreesOfTensorProductsAreRaised_CrossOracle)
{
  Random random(3);
  const Spline<2> a = RandomOn(random, Box, { 2, 4 }, 0);
  const Spline<2> b = RandomOn(random, Box, { 3, 2 }, 0);
  const auto result = CombineSplines(a, b, 1.0, -1.0);
  ASSERT_TRUE(result) << result.Status.Message();
  const PointMatrix at = PointsOf(random, Box);
  EXPECT_LE(
    (ValuesAt(result->Value, at) - ValuesAt(a, at) + ValuesAt(b, at)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(CombineSplines, CommonDomain_CrossOracle)
{
  Random random(4);
  const Spline<2> a = RandomOn(random, Box, { 2, 2 }, 2);
  const Spline<2> b = RandomOn(random, { { 0, 1 }, { 3, 3 } }, { 2, 2 }, 1);
  EXPECT_EQ(CombineSplines(a, b, 1, -1).Status.Code, ErrorCode::InvalidTopology);
  CombineParams params;
  params.CommonDomain = true;
  const auto result = CombineSplines(a, b, 1, -1, params);
  ASSERT_TRUE(result) << result.Status.Message();
  const ParametricBox<2> common{ { 0, 2 }, { 2, 3 } };
  EXPECT_EQ(result->Value.Space->Domain().Lower, common.Lower);
  EXPECT_EQ(result->Value.Space->Domain().Upper, common.Upper);
  const PointMatrix at = PointsOf(random, common);
  EXPECT_LE(
    (ValuesAt(result->Value, at) - ValuesAt(a, at) + ValuesAt(b, at)).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(CombineSplines, TensorProductsStayOnACommonDomain_CrossOracle)
{
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const IntArray<2> degree{ random.Int(1, 4), random.Int(1, 4) };
    const Spline<2> a = RandomOn(random, Box, degree, 0);
    const Spline<2> b = RandomOn(random, { { 0, 1 }, { 3, 3 } }, { 2, 3 }, 0);
    CombineParams params;
    params.CommonDomain = true;
    const auto result = CombineSplines(a, b, 1, -1, params);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_EQ(result->Value.Space->Kind, SpaceKind::Tensor);
    const ParametricBox<2> common{ { 0, 2 }, { 2, 3 } };
    EXPECT_EQ(result->Value.Space->Domain().Lower, common.Lower);
    EXPECT_EQ(result->Value.Space->Domain().Upper, common.Upper);
    const PointMatrix at = PointsOf(random, common);
    EXPECT_LE(
      (ValuesAt(result->Value, at) - ValuesAt(a, at) + ValuesAt(b, at)).cwiseAbs().maxCoeff(),
      1e-11); // as above
  }
}

TEST(CombineSplines, EndsThatDifferByRoundingAreOne_CrossOracle)
{
  const auto scaled = [](double t) { return t * (1.0 + 2.0 * oracle::Epsilon); };
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    for (const int kind : { 0, 1, 2 })
    {
      SCOPED_TRACE("seed " + std::to_string(seed) + " kind " + std::to_string(kind));
      Random random(seed);
      const IntArray<2> degree{ random.Int(1, 3), random.Int(1, 3) };
      const ParametricBox<2> near{ { scaled(Box.Lower[0]), scaled(Box.Lower[1]) },
        { scaled(Box.Upper[0]), scaled(Box.Upper[1]) } };
      Random again = random;
      const Spline<2> a = RandomOn(random, Box, degree, kind);
      // hierarchical ones with the same level-0 knots up to rounding
      const Spline<2> b = RandomOn(kind == 1 ? again : random, near, degree, kind);
      const auto result = CombineSplines(a, b, 1, -1);
      ASSERT_TRUE(result) << result.Status.Message();
      EXPECT_EQ(result->Value.Space->Kind, a.Space->Kind);
      PointMatrix at = PointsOf(random, Box);
      const PointMatrix expected = ValuesAt(a, at) - ValuesAt(b, at);
      EXPECT_LE((ValuesAt(result->Value, at) - expected).cwiseAbs().maxCoeff(), 1e-11);
    }
  }
}

TEST(CombineSurfaces, HeightFieldsKeepTheirPlace_CrossOracle)
{
  Random random(6);
  const auto heights = [&](int kind)
  {
    const auto space = RandomOn(random, Box, { 2, 2 }, kind).Space;
    return GraphOfFunction(RandomSpline<2>(random, space, 1, false), 0).Value;
  };
  const std::array<std::array<double, 2>, 3> weights{ { { 1, -1 }, { 0.5, 0.5 }, { 0.3, 2 } } };
  for (const int mode : { 0, 1, 2 })
  {
    const Spline<2> a = heights(mode);
    const Spline<2> b = heights(2);
    SurfaceCombination combination;
    combination.Mode = static_cast<CombineMode>(mode);
    combination.Weights = weights[2];
    const auto result = CombineSurfaces(a, b, combination);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_FALSE(result->HasDifference);
    EXPECT_TRUE(IsHeightField(MakeBezierForm(result->Value)));
    const PointMatrix at = PointsOf(random, Box);
    const Eigen::VectorXd z =
      weights[mode][0] * ValuesAt(a, at).col(2) + weights[mode][1] * ValuesAt(b, at).col(2);
    EXPECT_LE((ValuesAt(result->Value, at).col(2) - z).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LE(result->Lower, z.minCoeff());
    EXPECT_GE(result->Upper, z.maxCoeff());
  }
}

TEST(CombineSurfaces, TheDifferenceOfOthersIsBesideThem_CrossOracle)
{
  Random random(7);
  const auto surface = [&](int kind) {
    return RandomSpline<2>(random, RandomOn(random, Box, { 2, 2 }, kind).Space, 4, false);
  };
  const Spline<2> a = surface(0);
  const Spline<2> b = surface(2);
  const auto result = CombineSurfaces(a, b, {});
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_TRUE(result->HasDifference);
  ASSERT_EQ(result->Value.NumComponents(), 7);
  const PointMatrix at = PointsOf(random, Box);
  const PointMatrix difference = ValuesAt(a, at) - ValuesAt(b, at);
  PointMatrix expected(at.rows(), 7);
  expected << ValuesAt(a, at).leftCols(3), difference;
  EXPECT_LE((ValuesAt(result->Value, at) - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LE(result->Lower, difference.leftCols(3).minCoeff());
  EXPECT_GE(result->Upper, difference.leftCols(3).maxCoeff());
  // of a sum points are what counts
  SurfaceCombination average;
  average.Mode = CombineMode::Average;
  const auto mean = CombineSurfaces(a, b, average);
  ASSERT_TRUE(mean) << mean.Status.Message();
  EXPECT_FALSE(mean->HasDifference);
  EXPECT_EQ(mean->Value.NumComponents(), 4);

  Spline<2> flat = a;
  flat.ControlPoints = a.ControlPoints.leftCols(2).eval();
  EXPECT_EQ(CombineSurfaces(flat, flat, {}).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(CombineSurfaces(a, flat, {}).Status.Code, ErrorCode::SizeMismatch);
}

TEST(CombineSplines, EveryFailureIsReachable_ExactOracle)
{
  Random random(5);
  const Spline<2> a = RandomOn(random, Box, { 2, 2 }, 2);
  const auto code = [&](const Spline<2>& b, const CombineParams& params = {}, double weight = 1.0)
  { return CombineSplines(a, b, weight, -1.0, params).Status.Code; };
  EXPECT_EQ(code(a), ErrorCode::Ok);
  EXPECT_EQ(code(RandomOn(random, Box, { 1, 2 }, 2)), ErrorCode::InvalidDegree);
  Spline<2> bad = a;
  bad.ControlPoints(0, 0) = std::nan("");
  EXPECT_EQ(code(bad), ErrorCode::NonFiniteInput);
  bad = a;
  bad.Weights = Eigen::VectorXd::Ones(a.ControlPoints.rows());
  EXPECT_EQ(code(bad), ErrorCode::InvalidWeight);
  bad = a;
  bad.ControlPoints = a.ControlPoints.leftCols(1).eval();
  EXPECT_EQ(code(bad), ErrorCode::SizeMismatch);
  CombineParams params;
  params.NumKept = 3;
  EXPECT_EQ(code(a, params), ErrorCode::InvalidParameter);
  EXPECT_EQ(code(a, {}, HUGE_VAL), ErrorCode::InvalidParameter);
  params = {};
  params.CommonDomain = true;
  EXPECT_EQ(code(RandomOn(random, { { 5, 5 }, { 6, 6 } }, { 2, 2 }, 0), params),
    ErrorCode::InvalidTopology);
  bad.Space = MakeBezierSpace<2>({ { 2, 2 } }, { 0, 1, 2, 3, 4, 5, 6, 7, 8 }, 9).Value;
  bad.ControlPoints = PointMatrix::Zero(9, a.ControlPoints.cols());
  EXPECT_EQ(code(bad), ErrorCode::DimensionMismatch);
  EXPECT_EQ(MakeLocallyRefined(bad, 0).Status.Code, ErrorCode::DimensionMismatch);
  // two lines of one spline where the other has one, and no room to tell which it is
  std::array<Spline<2>, 2> near;
  for (std::size_t k = 0; k < 2; ++k)
  {
    std::vector<double> t{ 0, 0, 0, 0.3, 1, 1, 1 };
    t.insert(t.begin() + 4, k, 0.3 + 1e-13);
    const auto knots = KnotVector::Create(2, std::move(t)).Value;
    const auto space = MakeTensorSpace<2>({ KnotVector::Uniform(2, 2, 0, 1), knots }).Value;
    near[k] = RandomSpline<2>(random, space, 1, false);
  }
  EXPECT_EQ(CombineSplines(near[0], near[1], 1.0, -1.0).Status.Code, ErrorCode::NotInSpace);
}
