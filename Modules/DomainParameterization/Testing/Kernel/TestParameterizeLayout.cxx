// SPDX-License-Identifier: BSD-3-Clause
#include "LayoutCases.h"
#include <knotwork/DomainParameterization/ParameterizeLayout.h>
#include <knotwork/SplineCore/BezierForm.h>

#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
/// Proved valid and injective; the boundary bit for bit as it was made compatible; interfaces the
/// same bits on both sides.
template <int Dim>
void ExpectGood(const LayoutParameterization<Dim>& result)
{
  EXPECT_EQ(result.Certificate.Verdict, Verdict::Valid)
    << (result.Messages.empty() ? "" : result.Messages.front());
  EXPECT_EQ(result.Injectivity.Verdict, InjectivityVerdict::Injective)
    << ToString(result.Injectivity.Reason);
  EXPECT_TRUE(result.Messages.empty());
  EXPECT_GT(result.MinDetLower, 0.0);
  EXPECT_LE(result.MinDetLower, result.Metrics.MinDet);
  EXPECT_GE(result.MaxDetUpper, result.Metrics.MaxDet);
  const GluedMap<Dim>& map = result.Map;
  std::vector<int> seen(map.Fixed.size(), 0);
  PointMatrix points(map.NumFunctions(), Dim);
  Eigen::VectorXd weights(map.NumFunctions());
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    const Spline<Dim>& before = result.Layout.Map.Patches[p];
    for (std::size_t i = 0; i < map.Functions[p].size(); ++i)
    {
      const Eigen::Index row = static_cast<Eigen::Index>(i);
      const int number = map.Functions[p][i];
      const double weight = map.IsRational() ? map.Patches[p].Weights[row] : 1.0;
      if (seen[static_cast<std::size_t>(number)]++ > 0)
      {
        EXPECT_TRUE(points.row(number) == map.Patches[p].ControlPoints.row(row));
        EXPECT_EQ(weights[number], weight);
      }
      points.row(number) = map.Patches[p].ControlPoints.row(row);
      weights[number] = weight;
      const std::size_t at = static_cast<std::size_t>(number);
      if (result.Refinements == 0 && map.Fixed[at] && result.Layout.Given[at])
      {
        EXPECT_TRUE(before.ControlPoints.row(row) == map.Patches[p].ControlPoints.row(row));
      }
    }
  }
  const CertificateCheck check = VerifyCertificate(
    [&]
    {
      BernsteinCells cells; // patch after patch
      for (const Spline<Dim>& patch : map.Patches)
      {
        const BernsteinCells own = MakeBernsteinCells<Dim>(MakeBezierForm<Dim>(patch));
        cells.NumComponents = own.NumComponents;
        cells.Rational = own.Rational;
        for (int e = 0; e < own.NumCells(); ++e)
        {
          const std::size_t at = static_cast<std::size_t>(e);
          const int cell = cells.Add(own.Shapes[at], own.Degrees[at]);
          std::copy(own.Block(e), own.Block(e) + (own.Offsets[at + 1] - own.Offsets[at]),
            cells.Block(cell));
        }
      }
      return cells;
    }(),
    result.Certificate);
  EXPECT_EQ(check.Refuted, 0) << check.FirstRefuted;
  EXPECT_GT(check.Confirmed, 0);
}

/// Of the last row of a stage.
double LastEnergy(const DomainReport& report, DomainStage stage)
{
  double energy = 0.0;
  for (const DomainIteration& row : report.History)
  {
    energy = row.Stage == stage ? row.Energy : energy;
  }
  return energy;
}

TEST(ParameterizeLayout, SquaresStaySquares_ExactOracle)
{
  PatchLayout<2> layout = cases::LetterL();
  layout.Vertices.row(4) << 1.0, 1.0;
  const auto result = ParameterizeLayout<2>(layout);
  ASSERT_TRUE(result) << result.Status.Message();
  ExpectGood<2>(result.Value);
  EXPECT_NEAR(result->Metrics.Area, 3.0, 1e-14);
  EXPECT_NEAR(result->Metrics.MinDetOverArea, 1.0, 1e-6);
  EXPECT_NEAR(result->Metrics.MaxDetOverArea, 1.0, 1e-6);
  // |J|^2 / det J = 2 a patch
  EXPECT_NEAR(LastEnergy(result.Value, DomainStage::Quality), 6.0, 1e-9);
}

TEST(ParameterizeLayout, InnerVertexFindsItsPlace_ExactOracle)
{
  // four squares whose common vertex starts far off: the optimum is the uniform grid
  PatchLayout<2> layout;
  std::vector<std::array<double, 2>> points;
  for (int i = 0; i < 9; ++i)
  {
    points.push_back({ double(i % 3), double(i / 3) });
  }
  points[4] = { 1.6, 0.3 };
  layout.Vertices = cases::Points(points);
  layout.Patches = { { 0, 1, 3, 4 }, { 1, 2, 4, 5 }, { 3, 4, 6, 7 }, { 4, 5, 7, 8 } };
  for (const auto& [a, b] : std::vector<std::array<int, 2>>{
         { 0, 1 }, { 1, 2 }, { 2, 5 }, { 5, 8 }, { 8, 7 }, { 7, 6 }, { 6, 3 }, { 3, 0 } })
  {
    layout.Sides.push_back(cases::Segment(layout, a, b));
  }
  const auto result = ParameterizeLayout<2>(layout);
  ASSERT_TRUE(result) << result.Status.Message();
  ExpectGood<2>(result.Value);
  const Spline<2>& first = result->Map.Patches.front();
  const auto corner = first.ControlPoints.row(first.Space->NumFunctions - 1);
  EXPECT_NEAR(corner[0], 1.0, 1e-3); // where the energy is flat to 1e-7
  EXPECT_NEAR(corner[1], 1.0, 1e-3);
  EXPECT_NEAR(LastEnergy(result.Value, DomainStage::Quality), 8.0, 1e-5);
}

TEST(ParameterizeLayout, OnePatchIsTheDomain_CrossOracle)
{
  for (const DomainBoundary<2>& boundary : { cases::BumpedSector(0.5, 0.5, 6, 3), cases::Square() })
  {
    const auto domain = ParameterizeDomain<2>(boundary);
    ASSERT_TRUE(domain) << domain.Status.Message();
    const Spline<2>& map = domain->Map;
    PatchLayout<2> layout;
    layout.Vertices.resize(4, 2);
    layout.Patches = { { 0, 1, 2, 3 } };
    for (int c = 0; c < 4; ++c)
    {
      const std::array<int, 2> counts{ map.Space->Knots[0].NumFunctions(),
        map.Space->Knots[1].NumFunctions() };
      layout.Vertices.row(c) =
        map.ControlPoints.row((c & 1) * (counts[0] - 1) + (c >> 1) * (counts[1] - 1) * counts[0]);
    }
    layout.Sides = boundary.Sides;
    LayoutParams params;
    params.MinDegree = params.MinElements = 1;
    const auto result = ParameterizeLayout<2>(layout, params);
    ASSERT_TRUE(result) << result.Status.Message();
    ExpectGood<2>(result.Value);
    const PointMatrix& points = result->Map.Patches[0].ControlPoints;
    ASSERT_EQ(points.rows(), map.ControlPoints.rows());
    // the same iteration from the same start, but for the rounding of reversed sides
    EXPECT_LE((points - map.ControlPoints).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_EQ(result->Iterations, domain->Iterations);
  }
}

TEST(ParameterizeLayout, DiscOfFivePatches_PropertyOracle)
{
  for (InitialMapMethod method :
    { InitialMapMethod::Automatic, InitialMapMethod::Spring, InitialMapMethod::Harmonic })
  {
    for (DomainOptimizer optimizer : { DomainOptimizer::Lbfgs, DomainOptimizer::Newton })
    {
      DomainParams params;
      params.InitialMap = method;
      params.Optimizer = optimizer;
      const auto result = ParameterizeLayout<2>(cases::Disc(0.4, 0.2), {}, params);
      ASSERT_TRUE(result) << result.Status.Message();
      ExpectGood<2>(result.Value);
      EXPECT_NEAR(result->Metrics.Area, cases::Pi, 1e-14);
      EXPECT_EQ(result->Injectivity.NumBoundaryComponents, 1);
      // what the start was does not matter
      EXPECT_NEAR(LastEnergy(result.Value, DomainStage::Quality), 11.74556, 1e-4);
      EXPECT_GT(result->Metrics.MinDetOverArea, 0.13);
      for (std::size_t p = 1; p < 5; ++p) // the rim is the circle
      {
        PointMatrix at(11, 2);
        for (int i = 0; i <= 10; ++i)
        {
          at.row(i) << 0.1 * i, 1.0;
        }
        EvaluationBatch batch;
        ASSERT_TRUE(
          EvaluateParameters<2>(MakeBezierForm<2>(result->Map.Patches[p], 1), at, {}, batch));
        for (int i = 0; i <= 10; ++i)
        {
          EXPECT_NEAR(batch.Values.row(i).norm(), 1.0, 4e-15);
        }
      }
    }
  }
}

TEST(ParameterizeLayout, InterfacesThatMoveAreBetter_PropertyOracle)
{
  LayoutParams fixed;
  fixed.MoveInterfaces = false;
  for (const PatchLayout<2>& layout : { cases::Disc(0.4, 0.2), cases::Disc(0.7) })
  {
    const auto moved = ParameterizeLayout<2>(layout);
    const auto kept = ParameterizeLayout<2>(layout, fixed);
    ASSERT_TRUE(moved) << moved.Status.Message();
    ASSERT_TRUE(kept) << kept.Status.Message();
    ExpectGood<2>(moved.Value);
    EXPECT_EQ(kept->Certificate.Verdict, Verdict::Valid);
    EXPECT_LT(LastEnergy(moved.Value, DomainStage::Quality),
      LastEnergy(kept.Value, DomainStage::Quality) - 0.1);
    EXPECT_LT(moved->Metrics.MeanConditionNumber, kept->Metrics.MeanConditionNumber);
    // kept: the sides of the square are straight
    const Spline<2>& square = kept->Map.Patches.front();
    for (int f : SideFunctions<2>(*square.Space, 0))
    {
      EXPECT_NEAR(square.ControlPoints(f, 0) - square.ControlPoints(0, 0), 0.0,
        1e-14 + std::abs(layout.Vertices(4, 0) - layout.Vertices(7, 0)));
    }
  }
}

TEST(ParameterizeLayout, RingHasTwoBoundaries_PropertyOracle)
{
  const auto result = ParameterizeLayout<2>(cases::Ring());
  ASSERT_TRUE(result) << result.Status.Message();
  ExpectGood<2>(result.Value);
  EXPECT_EQ(result->Injectivity.NumBoundaryComponents, 2);
  EXPECT_NEAR(result->Metrics.Area, 3 * cases::Pi, 1e-13);
  // a straight radial interface is the best by symmetry
  const Spline<2>& patch = result->Map.Patches[0];
  for (int f : SideFunctions<2>(*patch.Space, 2))
  {
    EXPECT_NEAR(patch.ControlPoints(f, 1), 0.0, 1e-3);
  }
}

TEST(ParameterizeLayout, StraightInterfaceThatFoldsIsMoved_PropertyOracle)
{
  const PatchLayout<2> layout = cases::Wedge();
  for (FoldoverRemoval removal :
    { FoldoverRemoval::Automatic, FoldoverRemoval::Penalty, FoldoverRemoval::Relu })
  {
    DomainParams params;
    params.Foldover = removal;
    const auto result = ParameterizeLayout<2>(layout, {}, params);
    ASSERT_TRUE(result) << result.Status.Message();
    ASSERT_LT(result->History.front().MinDet, 0.0); // the first map folds
    ExpectGood<2>(result.Value);
  }
  // what cannot move cannot be mended, and the place is named
  LayoutParams fixed;
  fixed.MoveInterfaces = false;
  const auto kept = ParameterizeLayout<2>(layout, fixed);
  ASSERT_TRUE(kept) << kept.Status.Message();
  EXPECT_NE(kept->Certificate.Verdict, Verdict::Valid);
  EXPECT_TRUE(kept->IsImpossible());
  ASSERT_FALSE(kept->Messages.empty());
  EXPECT_NE(kept->Messages.front().find("patch 0: the boundary folds at the corner (u = 1, v = 0)"),
    std::string::npos)
    << kept->Messages.front();
}

TEST(ParameterizeLayout, GivenInterfaceIsKeptOrIsTheStart_PropertyOracle)
{
  PatchLayout<2> layout = cases::Ring();
  const Spline<1> bent =
    cases::Curve(KnotVector::Uniform(2, 1), { { 1, 0 }, { 1.5, 0.4 }, { 2, 0 } });
  layout.Sides.push_back(bent);
  LayoutParams fixed;
  fixed.MoveInterfaces = false;
  const auto kept = ParameterizeLayout<2>(layout, fixed);
  ASSERT_TRUE(kept) << kept.Status.Message();
  ExpectGood<2>(kept.Value);
  PointMatrix at(1, 2);
  at << 0.5, 0.0;
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters<2>(MakeBezierForm<2>(kept->Map.Patches[0], 1), at, {}, batch));
  EXPECT_NEAR(batch.Values(0, 0), 1.5, 1e-14);
  EXPECT_NEAR(batch.Values(0, 1), 0.2, 1e-14);
  const auto moved = ParameterizeLayout<2>(layout);
  ASSERT_TRUE(moved) << moved.Status.Message();
  ExpectGood<2>(moved.Value);
  ASSERT_TRUE(
    EvaluateParameters<2>(MakeBezierForm<2>(moved->InitialMap.Patches[0], 1), at, {}, batch));
  EXPECT_NEAR(batch.Values(0, 1), 0.2, 1e-14);
  ASSERT_TRUE(EvaluateParameters<2>(MakeBezierForm<2>(moved->Map.Patches[0], 1), at, {}, batch));
  EXPECT_NEAR(batch.Values(0, 1), 0.0, 1e-3);
}

TEST(ParameterizeLayout, WeightsMoveTogether_PropertyOracle)
{
  DomainParams params;
  params.Weights = WeightMode::Optimized;
  const auto with = ParameterizeLayout<2>(cases::Disc(0.4, 0.2), {}, params);
  const auto without = ParameterizeLayout<2>(cases::Disc(0.4, 0.2));
  ASSERT_TRUE(with) << with.Status.Message();
  ExpectGood<2>(with.Value);
  EXPECT_TRUE(with->WeightsOptimized);
  EXPECT_LT(
    LastEnergy(with.Value, DomainStage::Quality), LastEnergy(without.Value, DomainStage::Quality));
}

TEST(ParameterizeLayout, RefinementKeepsPatchesTogether_PropertyOracle)
{
  // a disc bitten out of the lower of two patches: too poor a space
  const double height = 8.0;
  const DomainBoundary<2> bite = cases::Bite(0.495, 0.5, height, 1);
  PatchLayout<2> layout;
  layout.Vertices = cases::Points(
    { { 0, 0 }, { 1, 0 }, { 0, height }, { 1, height }, { 0, height + 0.5 }, { 1, height + 0.5 } });
  layout.Patches = { { 0, 1, 2, 3 }, { 2, 3, 4, 5 } };
  layout.Sides = { bite.Sides[0], bite.Sides[1], bite.Sides[2], cases::Segment(layout, 2, 4),
    cases::Segment(layout, 3, 5), cases::Segment(layout, 4, 5) };
  LayoutParams poor;
  poor.MinElements = 1;
  DomainParams params;
  params.Weights = WeightMode::Fixed;
  params.MaxRefinements = 0;
  const auto without = ParameterizeLayout<2>(layout, poor, params);
  ASSERT_TRUE(without) << without.Status.Message();
  ASSERT_NE(without->Certificate.Verdict, Verdict::Valid);
  ASSERT_FALSE(without->IsImpossible());
  params.MaxRefinements = 3;
  const auto with = ParameterizeLayout<2>(layout, poor, params);
  ASSERT_TRUE(with) << with.Status.Message();
  EXPECT_GE(with->Refinements, 1);
  ExpectGood<2>(with.Value);
}

TEST(ParameterizeLayout, ResultDoesNotDependOnThreads_PropertyOracle)
{
  DomainParams params;
  params.Threads = 1;
  const auto one = ParameterizeLayout<2>(cases::Wedge(), {}, params);
  params.Threads = 3;
  const auto three = ParameterizeLayout<2>(cases::Wedge(), {}, params);
  ASSERT_TRUE(one && three);
  for (std::size_t p = 0; p < 2; ++p)
  {
    EXPECT_TRUE(one->Map.Patches[p].ControlPoints == three->Map.Patches[p].ControlPoints);
  }
  EXPECT_EQ(one->MinDetLower, three->MinDetLower);
}

/// A quarter turn of a patch's corners about its last direction; in space also the directions in
/// turn.
void Turn(std::array<int, 4>& c)
{
  c = { c[1], c[3], c[0], c[2] };
}
void Turn(std::array<int, 8>& c)
{
  const std::array<int, 8> about{ c[1], c[3], c[0], c[2], c[5], c[7], c[4], c[6] };
  for (std::size_t i = 0; i < 8; ++i)
  {
    c[i] = about[(i << 1 & 7) | i >> 2];
  }
}

template <int Dim>
void ExpectTurnsDoNotMatter(PatchLayout<Dim> layout, const LayoutParams& params, unsigned seed)
{
  const auto straight = ParameterizeLayout<Dim>(layout, params);
  ASSERT_TRUE(straight) << straight.Status.Message();
  oracle::Random random(seed);
  for (int round = 0; round < 3; ++round)
  {
    for (auto& corners : layout.Patches)
    {
      for (int turns = random.Int(0, 3); turns > 0; --turns)
      {
        Turn(corners);
      }
    }
    const auto turned = ParameterizeLayout<Dim>(layout, params);
    ASSERT_TRUE(turned) << turned.Status.Message();
    ExpectGood<Dim>(turned.Value);
    EXPECT_EQ(turned->Map.NumFunctions(), straight->Map.NumFunctions());
    const double energy = LastEnergy(straight.Value, DomainStage::Quality);
    // three iterations that gain less than 1e-7 each end the minimization
    EXPECT_NEAR(LastEnergy(turned.Value, DomainStage::Quality), energy, 1e-5 * energy);
  }
}

TEST(ParameterizeLayout, CornersMayBeListedFromAnyOne_PropertyOracle)
{
  ExpectTurnsDoNotMatter<2>(cases::Disc(0.4, 0.2), {}, 1);
  PatchLayout<2> uneven = cases::Wedge();
  uneven.Sides[0] = InsertKnots<1>(uneven.Sides[0], 0, { 0.1, 0.6, 0.6 }).Value;
  uneven.Sides[2] = InsertKnots<1>(uneven.Sides[2], 0, { 0.15, 0.2 }).Value;
  ExpectTurnsDoNotMatter<2>(uneven, {}, 2);
  ExpectTurnsDoNotMatter<2>(cases::Ring(), {}, 3);
  LayoutParams coarse;
  coarse.MinElements = 2;
  const PatchLayout<2> plane = cases::LetterL();
  const auto flat = ParameterizeLayout<2>(plane, coarse);
  ASSERT_TRUE(flat);
  PatchLayout<3> layout = cases::Swept(plane, flat->InitialMap.Patches, 1.0);
  layout.Vertices(12, 1) -= 1e-12; // within the tolerance
  ExpectTurnsDoNotMatter<3>(layout, coarse, 4);
}

TEST(ParameterizeLayout, AbortAndBadOptionsAreErrors_PropertyOracle)
{
  EXPECT_EQ(ParameterizeLayout<2>(cases::Wedge(), {}, {}, [](double) { return false; }).Status.Code,
    ErrorCode::Aborted);
  DomainParams params;
  params.MaxIterations = 0;
  EXPECT_EQ(
    ParameterizeLayout<2>(cases::Wedge(), {}, params).Status.Code, ErrorCode::InvalidParameter);
}

TEST(ParameterizeLayout, CylinderOfFiveBlocks_PropertyOracle)
{
  const PatchLayout<2> disc = cases::Disc(0.45);
  LayoutParams coarse;
  coarse.MinElements = 2;
  const auto plane = ParameterizeLayout<2>(disc, coarse);
  ASSERT_TRUE(plane) << plane.Status.Message();
  PatchLayout<3> layout = cases::Swept(disc, plane->Map.Patches, 1.5);
  std::reverse(layout.Sides.begin(), layout.Sides.end());
  const auto result = ParameterizeLayout<3>(layout, coarse);
  ASSERT_TRUE(result) << result.Status.Message();
  ExpectGood<3>(result.Value);
  EXPECT_NEAR(result->Metrics.Area, 1.5 * cases::Pi, 1e-13);
  EXPECT_EQ(result->Layout.Shared.size(), 8u);
  // a gap between faces is one between their corners and vertices
  layout.Sides[3].ControlPoints.row(0).array() += 0.01;
  const auto open = ParameterizeLayout<3>(layout, coarse);
  EXPECT_EQ(open.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(open.Status.Detail.find("side 3"), std::string::npos) << open.Status.Detail;
}

TEST(ParameterizeLayout, BlocksInSpaceStayBlocks_ExactOracle)
{
  const PatchLayout<2> plane = cases::LetterL();
  const auto flat = ParameterizeLayout<2>(plane);
  ASSERT_TRUE(flat);
  PatchLayout<3> layout = cases::Swept(plane, flat->InitialMap.Patches, 1.0);
  for (auto& corners : layout.Patches) // left-handed throughout: mirrored
  {
    std::swap_ranges(corners.begin(), corners.begin() + 4, corners.begin() + 4);
  }
  LayoutParams coarse;
  coarse.MinElements = 2;
  const auto result = ParameterizeLayout<3>(layout, coarse);
  ASSERT_TRUE(result) << result.Status.Message();
  ExpectGood<3>(result.Value);
  EXPECT_NEAR(result->Metrics.MinDetOverArea, 1.0, 1e-6);
  EXPECT_NEAR(result->Metrics.MaxDetOverArea, 1.0, 1e-6);
  EXPECT_NEAR(result->Metrics.Area, 3.0, 1e-13);
}
}
}
