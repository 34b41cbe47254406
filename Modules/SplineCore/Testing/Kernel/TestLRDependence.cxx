// SPDX-License-Identifier: BSD-3-Clause
#include "LRCases.h"
#include "PrimeField.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/LRDependence.h>

#include <gtest/gtest.h>

#include <Eigen/SVD>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
/// Number of functions minus the rank of their Bernstein coefficients, by singular values.
int DefectBySingularValues(const SplineSpace<2>& space)
{
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(space.NumLocalFunctions, space.NumFunctions);
  for (int row = 0; row < space.NumLocalFunctions; ++row)
  {
    for (std::size_t k = space.RowStart[row]; k < space.RowStart[row + 1]; ++k)
    {
      matrix(row, space.RowFunction[k]) = space.RowCoefficient[k];
    }
  }
  const Eigen::VectorXd values =
    Eigen::BDCSVD<Eigen::MatrixXd>(matrix.transpose() * matrix).singularValues();
  int defect = 0;
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    defect += values[i] < 1e-13 * values[0];
  }
  return defect;
}

/// Largest value of the relation's sum at random points, by the plain definition.
double RelationError(const SplineSpace<2>& space, const LRDependenceResult& result)
{
  Random random(4);
  const PointMatrix points = RandomParameters(random, space, 100);
  double worst = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const auto values = LRFunctions(space.LocallyRefined->Basis, points(i, 0), points(i, 1));
    Real sum = 0;
    for (std::size_t k = 0; k < result.Functions.size(); ++k)
    {
      sum += result.Coefficients[k] * values[result.Functions[k]];
    }
    worst = std::max(worst, std::fabs(static_cast<double>(sum)));
  }
  return worst;
}
}

TEST(LRDependence, PrimesAndResidues_ExactOracle)
{
  using Field = PrimeField;
  EXPECT_EQ(Field::PrimeBelow(Field::LargestPrime), 2147483629U); // the two largest below 2^31
  EXPECT_EQ(Field::PrimeBelow(2147483629U), 2147483587U);
  EXPECT_EQ(Field::PrimeBelow(100), 97U);
  const Field field(97);
  EXPECT_EQ(field.OfDouble(0.0), 0U);
  EXPECT_EQ(field.OfDouble(100.0), 3U);
  EXPECT_EQ(field.OfDouble(-1.0), 96U);
  EXPECT_EQ(field.Multiply(field.OfDouble(0.375), 8), 3U);
  for (Field::Number a = 1; a < 97; ++a)
  {
    EXPECT_EQ(field.Multiply(a, field.Inverse(a)), 1U);
  }
}

TEST(LRDependence, KnownRelationIsFound_GoldenOracle)
{
  const Spline<2> surface = DependentSurface();
  EXPECT_EQ(DefectBySingularValues(*surface.Space), 1);
  const auto result = DecideDependence(*surface.Space);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Verdict, LRVerdict::Dependent);
  EXPECT_EQ(result->Defect, 1);
  EXPECT_EQ(result->Functions.size(), 8u); // Patrizi and Dokken: no relation has fewer
  EXPECT_EQ(result->Functions, result->Unpeeled);
  EXPECT_EQ(result->Integers.size(), 8u);
  EXPECT_LE(RelationError(*surface.Space, result.Value), 1e-15);
  LRDependenceResult wrong = result.Value;
  wrong.Coefficients[3] *= 1.0 + 1e-12;
  EXPECT_GT(RelationError(*surface.Space, wrong), 1e-14);
}

TEST(LRDependence, UnevenKnotsAreDecidedExactly_CrossOracle)
{
  // knots without a common unit: the relation is there but not in small numbers
  const Spline<2> surface = DependentSurface();
  LRBasis basis = surface.Space->LocallyRefined->Basis;
  Random random(11);
  for (auto& knots : basis.Knots)
  {
    for (double& knot : knots)
    {
      knot += random.In(-0.3, 0.3);
    }
  }
  // scaling factors depend on the knots: the same segments on the moved mesh
  const auto moved = [&](double value, int d)
  { return basis.Knots[d][static_cast<std::size_t>(value)]; };
  const auto vector = [&](const std::vector<double>& values, int d)
  {
    std::vector<double> t;
    for (const double v : values)
    {
      t.push_back(moved(v, d));
    }
    t.insert(t.begin(), 2, t.front());
    t.insert(t.end(), 2, t.back());
    return KnotVector::Create(2, t).Value;
  };
  std::vector<LRSegment> segments = KnownSegments();
  for (LRSegment& s : segments)
  {
    s.Value = moved(s.Value, s.Direction);
    s.Start = moved(s.Start, 1 - s.Direction);
    s.End = moved(s.End, 1 - s.Direction);
  }
  const auto tensor = MakeTensorSpace<2>(
    { vector({ 0, 1, 2, 3, 6, 8, 9, 10 }, 0), vector({ 0, 1, 2, 4, 6, 7, 8 }, 1) });
  const auto space = InsertSegments(tensor.Value, segments, 0);
  ASSERT_TRUE(space) << space.Status.Message();
  EXPECT_EQ(DefectBySingularValues(*space.Value), 1);
  const auto result = DecideDependence(*space.Value);
  EXPECT_EQ(result->Verdict, LRVerdict::Dependent);
  EXPECT_EQ(result->Functions.size(), 8u);
  EXPECT_TRUE(result->Integers.empty());
  EXPECT_LE(RelationError(*space.Value, result.Value), 1e-13);
}

TEST(LRDependence, VerdictsMatchSingularValues_CrossOracle)
{
  int dependent = 0;
  for (unsigned seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::array<KnotVector, 2> knots;
    for (KnotVector& k : knots)
    {
      k = KnotVector::Uniform(2, random.Int(5, 7));
    }
    SplineSpacePtr<2> space = InsertSegments(MakeTensorSpace<2>(knots).Value, {}, 0).Value;
    for (int i = 0; i < 40; ++i)
    {
      LRSegment segment = RandomSegment(random, *space);
      segment.Multiplicity = 1;
      const auto refined = InsertSegments(space, { segment }, 0);
      space = refined ? refined.Value : space;
    }
    const auto result = DecideDependence(*space);
    ASSERT_TRUE(result) << result.Status.Message();
    const int defect = DefectBySingularValues(*space);
    EXPECT_EQ(result->Defect, defect);
    EXPECT_EQ(result->Verdict, defect > 0 ? LRVerdict::Dependent : LRVerdict::Independent);
    dependent += defect > 0;
    if (defect > 0)
    {
      EXPECT_LE(RelationError(*space, result.Value), 1e-12);
    }
  }
  EXPECT_GT(dependent, 0);
}

TEST(LRDependence, ResolutionKeepsTheMap_CrossOracle)
{
  for (const bool rational : { false, true })
  {
    const Spline<2> surface = DependentSurface(rational);
    const auto resolved = ResolveDependence(surface, MaxResolvingSegments, 0);
    ASSERT_TRUE(resolved) << resolved.Status.Message();
    EXPECT_GE(resolved->Segments.size(), 1u);
    EXPECT_EQ(DecideDependence(*resolved->Value.Space)->Verdict, LRVerdict::Independent);
    EXPECT_EQ(DefectBySingularValues(*resolved->Value.Space), 0);
    Random random(1);
    const PointMatrix points = RandomParameters(random, *surface.Space, 100);
    EvaluationBatch a, b;
    ASSERT_TRUE(EvaluateParameters(MakeBezierForm(surface), points, {}, a));
    ASSERT_TRUE(EvaluateParameters(MakeBezierForm(resolved->Value), points, {}, b));
    EXPECT_LE((a.Values - b.Values).cwiseAbs().maxCoeff(), 1e-13 * 10);
    EXPECT_EQ(ResolveDependence(surface, 0, 0).Status.Code, ErrorCode::NotConverged);
  }
}

TEST(LRDependence, IndependentSplinesStay_ExactOracle)
{
  Random random(2);
  const auto tensor = RandomSpline(random,
    MakeTensorSpace<2>({ KnotVector::Uniform(3, 4), KnotVector::Uniform(2, 5) }).Value, 2, false);
  EXPECT_EQ(DecideDependence(*tensor.Space).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_EQ(
    ResolveDependence(tensor, MaxResolvingSegments, 0).Status.Code, ErrorCode::DimensionMismatch);
  const auto lr = InsertSegments(tensor, {}, 0);
  const auto result = DecideDependence(*lr->Space);
  EXPECT_EQ(result->Verdict, LRVerdict::Independent);
  EXPECT_TRUE(result->Unpeeled.empty());
  const auto resolved = ResolveDependence(lr.Value, MaxResolvingSegments, 0);
  ASSERT_TRUE(resolved) << resolved.Status.Message();
  EXPECT_TRUE(resolved->Segments.empty());
  EXPECT_EQ(resolved->Value.Space, lr->Space);
}
