// SPDX-License-Identifier: BSD-3-Clause
#include "LayoutCases.h"
#include <knotwork/DomainParameterization/DomainEnergy.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <gtest/gtest.h>

#include <limits>

namespace knotwork
{
namespace
{
std::string ErrorOf(const PatchLayout<2>& layout, ErrorCode code, const LayoutParams& params = {})
{
  const auto result = MakeCompatible<2>(layout, params);
  EXPECT_FALSE(result);
  EXPECT_EQ(result.Status.Code, code) << result.Status.Message();
  return result.Status.Detail;
}

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

/// The point of a curve at u.
Eigen::RowVector2d At(const Spline<1>& curve, double u)
{
  EvaluationBatch batch;
  PointMatrix at(1, 1);
  at << u;
  EvaluateParameters<1>(MakeBezierForm<1>(curve, 1), at, {}, batch);
  return batch.Values.row(0);
}

TEST(PatchLayout, NeighboursShareKnotsAndNumbers_PropertyOracle)
{
  PatchLayout<2> layout = cases::LetterL();
  layout.Sides[0] = ElevateDegree<1>(layout.Sides[0], 0, 3).Value; // patch 0 south, degree 4
  layout.Sides[3] = InsertKnots<1>(layout.Sides[3], 0, { 0.3, 0.55 }).Value; // patch 1 north
  const auto result = MakeCompatible<2>(layout);
  ASSERT_TRUE(result) << result.Status.Message();
  const GluedMap<2>& map = result->Map;
  // patches 0 and 2 are one column, patches 0 and 1 one row
  EXPECT_EQ(map.Patches[0].Space->Knots[0].Degree(), 4);
  EXPECT_TRUE(map.Patches[0].Space->Knots[0] == map.Patches[2].Space->Knots[0]);
  EXPECT_TRUE(map.Patches[0].Space->Knots[1] == map.Patches[1].Space->Knots[1]);
  EXPECT_EQ(map.Patches[1].Space->Knots[0].Degree(), 2);
  // three elements, cut in two each to reach four
  const std::vector<double> breaks{ 0.0, 0.15, 0.3, 0.425, 0.55, 0.775, 1.0 };
  ASSERT_EQ(map.Patches[1].Space->Knots[0].Breaks().size(), breaks.size());
  for (std::size_t i = 0; i < breaks.size(); ++i)
  {
    EXPECT_NEAR(map.Patches[1].Space->Knots[0].Breaks()[i], breaks[i], 1e-15);
  }
  int sum = 0;
  for (const Spline<2>& patch : map.Patches)
  {
    sum += patch.Space->NumFunctions;
  }
  const int shared =
    map.Patches[0].Space->Knots[0].NumFunctions() + map.Patches[0].Space->Knots[1].NumFunctions();
  EXPECT_EQ(map.NumFunctions(), sum - shared);
  EXPECT_DOUBLE_EQ(result->Area, 3.0);
  EXPECT_EQ(result->Shared.size(), 2u);
  // fixed are the given ones and nothing else
  EXPECT_TRUE(map.Fixed == result->Given);
}

TEST(PatchLayout, GivenCurvesLieExactly_ExactOracle)
{
  // curves in any order and direction, with patches listed clockwise as well
  for (int variant = 0; variant < 4; ++variant)
  {
    SCOPED_TRACE("variant " + std::to_string(variant));
    PatchLayout<2> layout = cases::Ring();
    if (variant & 1)
    {
      for (auto& corners : layout.Patches)
      {
        std::swap(corners[1], corners[2]);
      }
    }
    if (variant & 2)
    {
      std::reverse(layout.Sides.begin(), layout.Sides.end());
      for (std::size_t i = 0; i < layout.Sides.size(); i += 2)
      {
        layout.Sides[i] = cases::Backwards(layout.Sides[i]);
      }
    }
    const auto result = MakeCompatible<2>(layout);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_NEAR(result->Area, 3 * cases::Pi, 1e-13);
    for (std::size_t p = 0; p < 4; ++p)
    {
      const Spline<2>& patch = result->Map.Patches[p];
      int found = 0;
      for (int s = 0; s < 4; ++s)
      {
        const int input = result->Inputs[p][static_cast<std::size_t>(s)];
        if (input < 0)
        {
          continue;
        }
        ++found;
        Spline<1> side;
        side.Space =
          MakeTensorSpace<1>({ patch.Space->Knots[static_cast<std::size_t>(1 - s / 2)] }).Value;
        const std::vector<int> along = SideFunctions<2>(*patch.Space, s);
        side.ControlPoints.resize(static_cast<Eigen::Index>(along.size()), 2);
        side.Weights.resize(side.ControlPoints.rows());
        for (std::size_t i = 0; i < along.size(); ++i)
        {
          side.ControlPoints.row(static_cast<Eigen::Index>(i)) = patch.ControlPoints.row(along[i]);
          side.Weights[static_cast<Eigen::Index>(i)] = patch.Weights[along[i]];
        }
        const Spline<1>& given = layout.Sides[static_cast<std::size_t>(input)];
        // the same curve at the same parameters, or all of it backwards
        const bool backwards = (At(given, 0.0) - At(side, 0.0)).norm() > 0.1;
        for (double u : { 0.0, 0.1, 0.35, 0.7, 1.0 })
        {
          EXPECT_LE((At(given, backwards ? 1 - u : u) - At(side, u)).norm(), 4e-15);
        }
      }
      EXPECT_EQ(found, 2);
    }
  }
}

TEST(PatchLayout, WeightsAreMatchedAroundTheBoundary_ExactOracle)
{
  // the same arcs with other weights: all times a constant, and times c^i, which moves points along
  // the curve
  PatchLayout<2> layout = cases::Disc(0.5);
  for (std::size_t k = 0; k < 4; ++k)
  {
    Eigen::VectorXd& weights = layout.Sides[k].Weights;
    const double c = k == 1 ? 1.4 : 1.0;
    weights = weights.cwiseProduct(Eigen::Vector3d(1.0, c, c * c)) * double(k + 1);
  }
  const auto result = MakeCompatible<2>(layout);
  ASSERT_TRUE(result) << result.Status.Message();
  for (std::size_t p = 0; p < 5; ++p)
  {
    const Spline<2>& patch = result->Map.Patches[p];
    EXPECT_GT(patch.Weights.minCoeff(), 0.0);
    for (std::size_t s = 0; s < 4; ++s)
    {
      if (result->Inputs[p][s] < 0)
      {
        continue;
      }
      // north: points of the rim
      PointMatrix at(3, 2);
      at << 0.2, 1.0, 0.5, 1.0, 0.9, 1.0;
      EXPECT_EQ(s, 3u);
      EvaluationBatch batch;
      ASSERT_TRUE(EvaluateParameters<2>(MakeBezierForm<2>(patch, 1), at, {}, batch));
      for (Eigen::Index i = 0; i < 3; ++i)
      {
        EXPECT_NEAR(batch.Values.row(i).norm(), 1.0, 1e-14);
      }
    }
  }
}

TEST(PatchLayout, ErrorsNameThePlace_PropertyOracle)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  {
    PatchLayout<2> layout = cases::LetterL();
    layout.Patches.clear();
    ErrorOf(layout, ErrorCode::EmptyInput);
    layout = cases::LetterL();
    layout.Sides.clear();
    ErrorOf(layout, ErrorCode::EmptyInput);
  }
  {
    PatchLayout<2> layout = cases::LetterL();
    layout.Patches[1][2] = 99;
    EXPECT_SAYS(ErrorOf(layout, ErrorCode::InvalidTopology), "patch 1 has the vertex 99");
    layout.Patches[1][2] = 1;
    EXPECT_SAYS(ErrorOf(layout, ErrorCode::InvalidTopology), "patch 1 has the vertex 1 twice");
  }
  {
    PatchLayout<2> layout = cases::LetterL();
    layout.Vertices(4, 1) = nan;
    EXPECT_SAYS(ErrorOf(layout, ErrorCode::NonFiniteInput), "vertex 4");
    layout = cases::LetterL();
    layout.Sides[3].ControlPoints(1, 0) = nan;
    EXPECT_SAYS(ErrorOf(layout, ErrorCode::NonFiniteInput), "side 3");
  }
  {
    PatchLayout<2> layout = cases::LetterL(); // three patches at one side
    layout.Vertices.conservativeResize(9, 2);
    layout.Vertices.row(8) << 1.5, -0.5;
    layout.Patches.push_back({ 1, 8, 4, 5 });
    EXPECT_SAYS(ErrorOf(layout, ErrorCode::InvalidTopology), "more than two patches");
  }
  {
    PatchLayout<2> layout; // two squares that touch at a corner
    layout.Vertices =
      cases::Points({ { 0, 0 }, { 1, 0 }, { 0, 1 }, { 1, 1 }, { 2, 1 }, { 1, 2 }, { 2, 2 } });
    layout.Patches = { { 0, 1, 2, 3 }, { 3, 4, 5, 6 } };
    for (const auto& [a, b] : std::vector<std::array<int, 2>>{
           { 0, 1 }, { 1, 3 }, { 3, 2 }, { 2, 0 }, { 3, 4 }, { 4, 6 }, { 6, 5 }, { 5, 3 } })
    {
      layout.Sides.push_back(cases::Segment(layout, a, b));
    }
    EXPECT_SAYS(ErrorOf(layout, ErrorCode::InvalidTopology), "meet at the vertex 3");
  }
  {
    PatchLayout<2> layout = cases::LetterL();
    std::swap(layout.Patches[1][1], layout.Patches[1][2]);
    EXPECT_SAYS(ErrorOf(layout, ErrorCode::InvalidTopology),
      "patches 0 and 1 are oriented differently at their side between vertex 1 at (1, 0)");
  }
  {
    PatchLayout<2> layout = cases::LetterL();
    layout.Sides.erase(layout.Sides.begin() + 2);
    EXPECT_SAYS(ErrorOf(layout, ErrorCode::InvalidTopology),
      "the side of patch 1 between vertex 2 at (2, 0) and vertex 5 at (2, 1) is on the boundary "
      "and has no curve");
    layout = cases::LetterL();
    layout.Sides.push_back(layout.Sides[2]);
    EXPECT_SAYS(ErrorOf(layout, ErrorCode::InvalidTopology), "side 2 and side 8 both join");
    layout.Sides.back() = cases::Segment(layout, 0, 7);
    EXPECT_SAYS(ErrorOf(layout, ErrorCode::InvalidTopology), "which is no side of a patch");
  }
  {
    PatchLayout<2> layout = cases::LetterL();
    layout.Sides[2].ControlPoints(0, 1) += 1e-3;
    EXPECT_SAYS(ErrorOf(layout, ErrorCode::InvalidTopology), "gap of 0.001 (allowed");
    LayoutParams params;
    params.GapTolerance = 1e-3; // of the diagonal 2 sqrt(2)
    const auto closed = MakeCompatible<2>(layout, params);
    ASSERT_TRUE(closed) << closed.Status.Message();
    EXPECT_NEAR(closed->LargestGap, 1e-3, 1e-12);
  }
  {
    LayoutParams params;
    params.MinDegree = 10;
    ErrorOf(cases::LetterL(), ErrorCode::InvalidParameter, params);
    params = {};
    params.MinElements = 0;
    ErrorOf(cases::LetterL(), ErrorCode::InvalidParameter, params);
    params = {};
    params.GapTolerance = nan;
    ErrorOf(cases::LetterL(), ErrorCode::InvalidParameter, params);
  }
}

TEST(PatchLayout, EnergyOfGluedPatchesIsTheSum_ExactOracle)
{
  const auto layout = MakeCompatible<2>(cases::LetterL());
  ASSERT_TRUE(layout);
  const GluedMap<2>& map = layout->Map;
  oracle::Random random(7);
  const std::size_t n = map.Fixed.size();
  std::vector<double> points(2 * n);
  for (double& x : points)
  {
    x = random.In(-1.0, 1.0);
  }
  const auto fieldOf = [](const Spline<2>& patch)
  {
    std::array<LinePoints, 2> lines;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const KnotVector& knots = patch.Space->Knots[d];
      lines[d] =
        GaussLine(knots, std::vector<int>(static_cast<std::size_t>(knots.NumElements()), 3));
    }
    return MakeTensorField<2>(patch.Space->Knots, lines);
  };
  Density density;
  density.Kind = DensityKind::Penalty;
  density.Delta = 0.3;
  std::vector<std::unique_ptr<JacobianField<2>>> fields;
  double sum = 0.0;
  std::vector<double> expected(2 * n, 0.0);
  for (std::size_t p = 0; p < 3; ++p)
  {
    const std::vector<int>& numbers = map.Functions[p];
    const std::size_t m = numbers.size();
    std::vector<double> own(2 * m), gradient(2 * m);
    for (std::size_t i = 0; i < 2 * m; ++i)
    {
      own[i] = points[i / m * n + static_cast<std::size_t>(numbers[i % m])];
    }
    DomainEnergy<2> energy(fieldOf(map.Patches[p]), static_cast<int>(m));
    sum += energy.Evaluate(density, own.data(), nullptr, gradient.data(), nullptr).Energy;
    for (std::size_t i = 0; i < 2 * m; ++i)
    {
      expected[i / m * n + static_cast<std::size_t>(numbers[i % m])] += gradient[i];
    }
    fields.push_back(fieldOf(map.Patches[p]));
  }
  DomainEnergy<2> glued(
    MakeGluedField<2>(std::move(fields), map.Functions, map.NumFunctions()), map.NumFunctions());
  std::vector<double> gradient(2 * n);
  const double energy =
    glued.Evaluate(density, points.data(), nullptr, gradient.data(), nullptr).Energy;
  EXPECT_NEAR(energy, sum, 1e-13 * sum); // sums in another order
  for (std::size_t i = 0; i < 2 * n; ++i)
  {
    EXPECT_NEAR(gradient[i], expected[i], 1e-12 * sum);
  }
}
}
}
