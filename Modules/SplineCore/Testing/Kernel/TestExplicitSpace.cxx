// SPDX-License-Identifier: BSD-3-Clause
#include "FamilyCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/ClosestPoint.h>
#include <knotwork/SplineCore/ExplicitSpace.h>
#include <knotwork/SplineCore/Recovery.h>
#include <knotwork/SplineCore/SpaceFamily.h>
#include <knotwork/SplineCore/TensorForm.h>

#include <gtest/gtest.h>

#include <limits>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
/// Quadratic B-splines on the knots 0 0 0 1 2 2 2: worked by hand.
ExtractionTable<1> TwoParabolas()
{
  ExtractionTable<1> table;
  table.Functions = { 0, 1, 2, 1, 2, 3 };
  table.Vectors = { 0, 1, 2, 3, 4, 5 };
  for (const double value :
    { 1.0, 0.0, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 1.0 })
  {
    table.Coefficients.push_back(value);
    if (table.Coefficients.size() % 3 == 0)
    {
      table.EndVector();
    }
  }
  for (const std::size_t end : { 3, 6 })
  {
    table.Degrees.push_back({ 2 });
    table.FirstFunction.push_back(end);
  }
  return table;
}

Status Made(const ExtractionTable<1>& table, int numFunctions = 4)
{
  return MakeExplicitSpace<1>(table, numFunctions, 1).Status;
}

void ExpectRefused(const Status& status, ErrorCode code, const std::string& words)
{
  EXPECT_EQ(status.Code, code) << status.Message();
  EXPECT_NE(status.Detail.find(words), std::string::npos) << status.Message();
}

/// The spline by the operators of its elements alone.
template <int Dim>
Spline<Dim> ByOperators(const Spline<Dim>& spline)
{
  auto space = MakeExplicitSpace<Dim>(ExtractionOf(*spline.Space), spline.Space->NumFunctions);
  EXPECT_TRUE(space) << FamilyOf(*spline.Space).Name() << ": " << space.Status.Message();
  return { space.Value, spline.ControlPoints, spline.Weights };
}

template <int Dim>
double LargestDifference(const Spline<Dim>& a, const Spline<Dim>& b, Random& random)
{
  std::vector<int> elements;
  PointMatrix local(300, Dim);
  for (Eigen::Index i = 0; i < local.rows(); ++i)
  {
    elements.push_back(random.Int(0, a.Space->NumElements() - 1));
    for (int d = 0; d < Dim; ++d)
    {
      local(i, d) = random.Unit();
    }
  }
  EvaluationBatch x, y;
  EXPECT_TRUE(EvaluateElements<Dim>(MakeBezierForm(a), elements, local, {}, x));
  EXPECT_TRUE(EvaluateElements<Dim>(MakeBezierForm(b), elements, local, {}, y));
  return (x.Values - y.Values).cwiseAbs().maxCoeff();
}

template <int Dim>
void CheckFamilies(unsigned seed)
{
  Random random(seed);
  for (const SplineSpacePtr<Dim>& space : SpacesOfAllFamilies<Dim>(random))
  {
    SCOPED_TRACE(FamilyOf(*space).Name());
    const Spline<Dim> spline = RandomSpline<Dim>(random, space, 3, random.Int(0, 1) > 0);
    const Spline<Dim> other = ByOperators(spline);
    ASSERT_TRUE(other.Space);
    EXPECT_EQ(other.Space->Kind, SpaceKind::Explicit);
    EXPECT_EQ(other.Space->NumElements(), space->NumElements());
    // sums of at most some hundred products of numbers below 10, quotients by weights above 0.5
    EXPECT_LE(LargestDifference(spline, other, random), 1e-13 * 10.0 * 2.0);

    // stored and built again it is the same space
    const SpaceFamily<Dim>& family = FamilyOf(*other.Space);
    const SpaceDefinition definition = family.Describe(*other.Space);
    for (std::size_t t = 1; t < family.Tables().size(); ++t)
    {
      const DefinitionTable& table = definition.Tables[t];
      EXPECT_EQ(family.NumRows(definition, 0, t) * family.Tables()[t].Columns.size(),
        table.Whole.size() + table.Real.size());
    }
    const auto again = family.Build(definition, 1);
    ASSERT_TRUE(again) << again.Status.Message();
    EXPECT_TRUE(*again.Value->Extraction == *other.Space->Extraction);
    EXPECT_EQ(again.Value->NumFunctions, space->NumFunctions);
    EXPECT_EQ(again.Value->LocalFunctionIds, other.Space->LocalFunctionIds);
    EXPECT_TRUE(ExtractionOf(*other.Space) == *other.Space->Extraction);

    // 64 eps of the size 10 times what the worst of these bases amplifies, some hundred
    const RecoveryResult<Dim> recovered = RecoverSpline(MakeBezierForm(other), 1);
    ASSERT_TRUE(recovered) << recovered.Status.Message();
    EXPECT_LE(recovered.Residual, 1e-12);
  }
}
}

TEST(ExplicitSpace, OperatorsOfEveryFamilyMakeItsSpline_CrossOracle)
{
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    CheckFamilies<1>(seed);
    CheckFamilies<2>(seed);
    CheckFamilies<3>(seed);
  }
}

TEST(ExplicitSpace, ParabolasAreThoseOfTheKnots_GoldenOracle)
{
  const auto space = MakeExplicitSpace<1>(TwoParabolas(), 4);
  ASSERT_TRUE(space) << space.Status.Message();
  Spline<1> spline;
  spline.Space = space.Value;
  spline.ControlPoints.resize(4, 1);
  spline.ControlPoints << 0.0, 0.5, 1.5, 2.0; // Greville abscissae: the identity on [0, 2]
  PointMatrix local(3, 1);
  local << 0.25, 0.5, 1.0;
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateElements<1>(MakeBezierForm(spline), { 0, 1, 1 }, local, {}, batch));
  EXPECT_DOUBLE_EQ(batch.Values(0, 0), 0.25);
  EXPECT_DOUBLE_EQ(batch.Values(1, 0), 1.5);
  EXPECT_DOUBLE_EQ(batch.Values(2, 0), 2.0);
  // vectors 0 1 0.5 and 0.5 1 0 differ, so do 0 0 0.5 and 0.5 0 0: each is kept
  EXPECT_EQ(space.Value->Extraction->NumVectors(), 6U);
  // the elements meet in one point
  EXPECT_EQ(FamilyOf<1>(SpaceKind::Explicit).NumberPoints(*space.Value).Count, 5);
  EXPECT_EQ(space.Value->LocalFunctions(0)[2], space.Value->LocalFunctions(1)[0]);
}

/// A tensor-product space says from its knots which points its elements share.
TEST(ExplicitSpace, PointsAreSharedAsThoseOfTensorProducts_CrossOracle)
{
  for (unsigned seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto tensor = RandomTensorSpace<2>(random, 4, 5);
    const auto made = MakeExplicitSpace<2>(ExtractionOf(*tensor), tensor->NumFunctions);
    ASSERT_TRUE(made) << made.Status.Message();
    const ElementPoints expected = FamilyOf(*tensor).NumberPoints(*tensor);
    const ElementPoints found = FamilyOf(*made.Value).NumberPoints(*made.Value);
    EXPECT_EQ(found.Count, expected.Count);
    std::vector<std::int64_t> image(static_cast<std::size_t>(found.Count), -1);
    for (std::size_t i = 0; i < found.Ids.size(); ++i)
    {
      std::int64_t& of = image[static_cast<std::size_t>(found.Ids[i])];
      EXPECT_TRUE(of < 0 || of == expected.Ids[i]);
      of = expected.Ids[i];
    }
  }
}

/// Knot spans that differ by a factor of a million are no reason to refuse.
TEST(ExplicitSpace, VeryShortElementsAreTaken_Property)
{
  for (int p = 1; p <= 9; ++p)
  {
    for (const double h : { 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6 })
    {
      std::vector<double> knots(static_cast<std::size_t>(p), 0.0);
      for (const double t : { 0.0, 1.0, 1.0 + h, 2.0, 2.0 + h, 2.0 + 2.0 * h, 3.0 })
      {
        knots.push_back(t);
      }
      knots.insert(knots.end(), static_cast<std::size_t>(p), 3.0);
      const auto tensor = MakeTensorSpace<2>(
        { KnotVector::Create(p, knots).Value, KnotVector::Uniform(2, 2, 0.0, 1.0) });
      ASSERT_TRUE(tensor);
      const auto made =
        MakeExplicitSpace<2>(ExtractionOf(*tensor.Value), tensor.Value->NumFunctions);
      EXPECT_TRUE(made) << "degree " << p << ", " << h << ": " << made.Status.Message();
    }
  }
}

/// Two functions of an element that become their mean: still positive, still with the sum 1.
TEST(ExplicitSpace, DependentFunctionsAreRefused_Property)
{
  for (unsigned seed = 1; seed <= 100; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto tensor = RandomTensorSpace<2>(random, 4, 4);
    ExtractionTable<2> table = ExtractionOf(*tensor);
    const int e = random.Int(0, tensor->NumElements() - 1);
    const std::size_t first = table.FirstFunction[static_cast<std::size_t>(e)];
    const int n = NumTensorFunctions<2>(table.Degrees[static_cast<std::size_t>(e)]);
    const int a = random.Int(0, n - 2);
    const int b = random.Int(a + 1, n - 1);
    std::vector<double> mean(static_cast<std::size_t>(n), 0.0);
    for (const int k : { a, b })
    {
      int& vector = table.Vectors[first + static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < mean.size(); ++i)
      {
        mean[i] +=
          0.5 * table.Coefficients[table.FirstCoefficient[static_cast<std::size_t>(vector)] + i];
      }
      vector = static_cast<int>(table.NumVectors());
    }
    table.Coefficients.insert(table.Coefficients.end(), mean.begin(), mean.end());
    table.EndVector();
    ExpectRefused(MakeExplicitSpace<2>(table, tensor->NumFunctions).Status, ErrorCode::NotInSpace,
      "element " + std::to_string(e) + ": its " + std::to_string(n) +
        " functions do not span the polynomials of its degrees, but " + std::to_string(n - 1));
  }
}

TEST(ExplicitSpace, EveryChangedCoefficientIsRefusedByItsElement_ExactOracle)
{
  const ExtractionTable<1> good = TwoParabolas();
  for (std::size_t i = 0; i < good.Coefficients.size(); ++i)
  {
    for (const double change : { 1e-3, -1e-3, 1e-9, 1e-11 })
    {
      ExtractionTable<1> bad = good;
      bad.Coefficients[i] += change;
      ExpectRefused(Made(bad), ErrorCode::NotInSpace, i < 9 ? "element 1" : "element 2");
    }
  }
}

TEST(ExplicitSpace, EveryFailureIsReachable)
{
  const ExtractionTable<1> good = TwoParabolas();
  EXPECT_TRUE(Made(good));
  EXPECT_TRUE(Made(good, 12));
  ExpectRefused(Made({}), ErrorCode::EmptyInput, "no element");
  ExpectRefused(Made(good, 14), ErrorCode::InvalidTopology, "remove the others");
  ExpectRefused(Made(good, 3), ErrorCode::InvalidTopology, "element 2 has control point 4");
  ExtractionTable<1> bad = good;
  bad.Functions[1] = -1;
  ExpectRefused(Made(bad), ErrorCode::InvalidTopology, "element 1 has control point 0");
  bad.Functions[1] = 0;
  ExpectRefused(Made(bad), ErrorCode::InvalidTopology, "element 1 has control point 1 twice");
  bad = good;
  bad.Vectors[5] = 6;
  ExpectRefused(Made(bad), ErrorCode::InvalidTopology, "element 2 has coefficient vector 7");
  bad = good;
  bad.Degrees[1][0] = 3;
  ExpectRefused(Made(bad), ErrorCode::SizeMismatch, "element 2 has 4 Bernstein polynomials");
  bad.Degrees[1][0] = 10;
  ExpectRefused(Made(bad), ErrorCode::InvalidDegree, "element 2 has degree 10");
  bad = good;
  bad.Vectors.pop_back();
  ExpectRefused(Made(bad), ErrorCode::SizeMismatch, "do not fit");
  bad = good;
  bad.Coefficients[4] = std::numeric_limits<double>::quiet_NaN();
  ExpectRefused(Made(bad), ErrorCode::NonFiniteInput, "element 1: coefficient 2 of vector 2");
  bad = good;
  bad.Coefficients[3] = -0.25; // 0 1 0.5 and 0 0 0.5: the sum at the first point stays
  bad.Coefficients[6] = 0.25;
  ExpectRefused(Made(bad), ErrorCode::NotInSpace, "coefficient 1 of vector 2 is -0.25");
  bad = good;
  bad.Coefficients[10] = 0.5; // the first two functions of the second element are one
  bad.Coefficients[13] = 0.5;
  bad.Coefficients[9] = 0.5;
  bad.Coefficients[12] = 0.5;
  ExpectRefused(Made(bad), ErrorCode::NotInSpace,
    "element 2: its 3 functions do not span the polynomials of its degrees, but 2 of 3");
  bad = good;
  bad.Functions = { 0, 1, 2, 1, 2 };
  bad.Vectors = { 0, 1, 2, 3, 4 };
  bad.FirstFunction = { 0, 3, 5 };
  bad.Coefficients[14] = 1.0;
  ExpectRefused(Made(bad), ErrorCode::NotInSpace, "its 2 functions do not span");

  const Spline<1> spline{ MakeExplicitSpace<1>(good, 4).Value, PointMatrix::Zero(4, 3), {} };
  ExpectRefused(RefineAllElements(spline).Status, ErrorCode::DimensionMismatch, "no mesh");
  ExpectRefused(
    RefineMarkedElements(spline, { 0 }).Status, ErrorCode::DimensionMismatch, "no mesh");
  ExpectRefused(ElevateAllDegrees(spline, 1).Status, ErrorCode::DimensionMismatch, "no mesh");
  ExpectRefused(ToTensor(spline, 1).Status, ErrorCode::DimensionMismatch, ".bext");
}

/// What a stored definition may say wrongly.
TEST(ExplicitSpace, DamagedDefinitionsAreRefused_ExactOracle)
{
  const SpaceFamily<1>& family = FamilyOf<1>(SpaceKind::Explicit);
  const SpaceDefinition good = family.Describe(*MakeExplicitSpace<1>(TwoParabolas(), 5).Value);
  const auto built = family.Build(good, 1);
  ASSERT_TRUE(built);
  EXPECT_EQ(built.Value->NumFunctions, 5);
  SpaceDefinition bad = good;
  for (const std::int64_t count : { std::int64_t{ -1 }, std::int64_t{ 1 } << 40 })
  {
    bad.Tables[0].Whole[3] = count;
    EXPECT_GT(family.NumRows(bad, 4, 1), std::size_t{ 1 } << 60);
  }
  for (const std::size_t place : { std::size_t{ 0 }, std::size_t{ 1 }, std::size_t{ 12 } })
  {
    for (const std::int64_t value : { std::int64_t{ -2 }, std::int64_t{ 1 } << 40 })
    {
      bad = good;
      bad.Tables[1].Whole[place] = value;
      EXPECT_FALSE(family.Build(bad, 1)) << place;
    }
  }
}
