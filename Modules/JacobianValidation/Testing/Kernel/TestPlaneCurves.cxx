// SPDX-License-Identifier: BSD-3-Clause
#include "TestCells.h"
#include <knotwork/JacobianValidation/PlaneCurves.h>

#include <random>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
using Point = std::array<double, 3>;

/// Plane curves that interpolate functions of one parameter.
struct Curves
{
  BernsteinCells Cells;
  std::vector<std::array<int, 2>> Ends;

  Curves() { this->Cells.NumComponents = 2; }
  void Add(int degree, int begin, int end, const std::function<Point(double)>& function)
  {
    AddInterpolant(this->Cells, CellShape::Curve, UniformDegree(CellShape::Curve, degree),
      [&](const Point& u) { return function(u[0]); });
    this->Cells.Errors.push_back(1e-14); // of the interpolation
    this->Ends.push_back({ begin, end });
  }
  SimpleCurvesProof Prove(int threads = 0) const
  {
    SimpleCurvesParams params;
    params.Threads = threads;
    const auto proof = ProveSimpleCurves(this->Cells, this->Ends, params);
    EXPECT_TRUE(proof) << proof.Status.Message();
    return proof.Value;
  }
  std::vector<CurveStep> Loop(bool reversed = false) const
  {
    std::vector<CurveStep> loop;
    for (int c = 0; c < this->Cells.NumCells(); ++c)
    {
      loop.push_back({ reversed ? this->Cells.NumCells() - 1 - c : c, reversed });
    }
    return loop;
  }
};

/// Rational circle in quarters.
Curves Circle(double x, double y, double r)
{
  Curves curves;
  curves.Cells.Rational = true;
  const double c[] = { 1, 1, 0, -1, -1, -1, 0, 1, 1 };
  const double s[] = { 0, 1, 1, 1, 0, -1, -1, -1, 0 };
  for (int q = 0; q < 4; ++q)
  {
    double* block = curves.Cells.Block(curves.Cells.Add(CellShape::Curve, { 2, 0, 0 }));
    for (int i = 0; i < 3; ++i)
    {
      const double w = i == 1 ? std::sqrt(0.5) : 1.0;
      block[i] = w * (x + r * c[2 * q + i]);
      block[3 + i] = w * (y + r * s[2 * q + i]);
      block[6 + i] = w;
    }
    curves.Cells.Errors.push_back(1e-15 * (std::abs(x) + std::abs(y) + r));
    curves.Ends.push_back({ q, (q + 1) % 4 });
  }
  return curves;
}
}

// (t^2 - 1, t^3 - t) meets itself at t = -1 and 1, within one curve or where two others meet.
TEST(PlaneCurves, NodalCubic_ExactOracle)
{
  const auto node = [](double t) { return Point{ t * t - 1.0, t * t * t - t, 0.0 }; };
  for (const double reach : { 1.5, 1.1, 0.99, 0.5 })
  {
    SCOPED_TRACE(reach);
    const auto expected = reach > 1.0 ? CurvesVerdict::Crossing : CurvesVerdict::Simple;
    Curves whole;
    whole.Add(3, 0, 1, [&](double s) { return node(reach * (2.0 * s - 1.0)); });
    const auto proof = whole.Prove();
    EXPECT_EQ(proof.Verdict, expected);
    if (reach > 1.0)
    {
      EXPECT_NEAR(std::abs(proof.Parameters[0] - proof.Parameters[1]), 1.0 / reach, 1e-6);
      EXPECT_NEAR(std::hypot(proof.Position[0], proof.Position[1]), 0.0, 1e-6);
    }
    // cut in t = 0, and so that the crossing is a common end of two curves
    for (const double cut : { 0.0, 1.0, -1.0 })
    {
      if (std::abs(cut) >= reach)
      {
        continue;
      }
      Curves two;
      two.Add(3, 0, 1, [&](double s) { return node(-reach + s * (cut + reach)); });
      two.Add(3, 1, 2, [&](double s) { return node(cut + s * (reach - cut)); });
      EXPECT_EQ(two.Prove().Verdict, expected) << cut;
    }
  }
}

// Two parabolas y = x^2 and y = a - x^2 over [-1, 1]: they meet when a >= 0, and touch when a = 0.
TEST(PlaneCurves, ParabolasMeetTouchOrNot_ExactOracle)
{
  for (const double a : { 0.5, 1e-3, 1e-8, 0.0, -1e-8, -1e-3, -0.5 })
  {
    SCOPED_TRACE(a);
    Curves curves;
    curves.Add(2, 0, 1,
      [](double s)
      {
        const double x = 2.0 * s - 1.0;
        return Point{ x, x * x, 0.0 };
      });
    curves.Add(3, 2, 3,
      [a](double s)
      {
        const double x = 1.0 - 2.0 * s;
        return Point{ x, a - x * x, 0.0 };
      });
    EXPECT_EQ(curves.Prove().Verdict,
      a > 0.0     ? CurvesVerdict::Crossing
        : a < 0.0 ? CurvesVerdict::Simple
                  : CurvesVerdict::Undecided);
  }
}

// Chords of random chains against exact arithmetic of integers.
TEST(PlaneCurves, RandomPolylines_CrossOracle)
{
  int crossing = 0;
  int simple = 0;
  for (unsigned seed = 1; seed <= 200; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> pick(0, 40);
    long p[7][2];
    for (auto& x : p)
    {
      x[0] = pick(random);
      x[1] = pick(random);
    }
    const auto side = [&](int a, int b, int c)
    {
      const long d =
        (p[b][0] - p[a][0]) * (p[c][1] - p[a][1]) - (p[b][1] - p[a][1]) * (p[c][0] - p[a][0]);
      return d > 0 ? 1 : d < 0 ? -1 : 0;
    };
    bool degenerate = false;
    bool crosses = false;
    for (int i = 0; i < 6; ++i)
    {
      for (int j = 0; j < 7; ++j)
      {
        degenerate = degenerate || (j != i && j != i + 1 && side(i, i + 1, j) == 0);
      }
      for (int j = i + 2; j < 6; ++j)
      {
        crosses = crosses ||
          (side(i, i + 1, j) != side(i, i + 1, j + 1) &&
            side(j, j + 1, i) != side(j, j + 1, i + 1));
      }
    }
    if (degenerate)
    {
      continue;
    }
    Curves curves;
    for (int i = 0; i < 6; ++i)
    {
      curves.Add(1 + i % 3, i, i + 1,
        [&](double s)
        {
          return Point{ p[i][0] + s * static_cast<double>(p[i + 1][0] - p[i][0]),
            p[i][1] + s * static_cast<double>(p[i + 1][1] - p[i][1]), 0.0 };
        });
    }
    const auto proof = curves.Prove();
    EXPECT_EQ(proof.Verdict, crosses ? CurvesVerdict::Crossing : CurvesVerdict::Simple);
    const auto one = curves.Prove(1);
    EXPECT_EQ(one.Curves, proof.Curves);
    EXPECT_EQ(one.Boxes, proof.Boxes);
    (crosses ? crossing : simple) += 1;
  }
  EXPECT_GE(crossing, 20);
  EXPECT_GE(simple, 20);
}

TEST(PlaneCurves, LimitOfBoxesLeavesUndecided_ExactOracle)
{
  const Curves circle = Circle(0, 0, 1);
  SimpleCurvesParams params;
  params.MaxBoxes = 1;
  Curves node;
  node.Add(3, 0, 1, [](double s) { return Point{ s * (1 - s), s * s * (1 - s) - 0.3 * s, 0.0 }; });
  EXPECT_EQ(
    ProveSimpleCurves(node.Cells, node.Ends, params).Value.Verdict, CurvesVerdict::Undecided);
  EXPECT_EQ(node.Prove().Verdict, CurvesVerdict::Simple);
  EXPECT_EQ(circle.Prove().Verdict, CurvesVerdict::Simple);
}

TEST(PlaneCurves, WindingsAndOrientationOfCircles_ExactOracle)
{
  const Curves circle = Circle(3.0, -2.0, 1.5);
  for (const bool reversed : { false, true })
  {
    const int sign = reversed ? -1 : 1;
    const auto loop = circle.Loop(reversed);
    EXPECT_EQ(FindOrientation(circle.Cells, loop), sign);
    EXPECT_EQ(CountWindings(circle.Cells, loop, { 3.0, -2.0 }), sign);
    EXPECT_EQ(CountWindings(circle.Cells, loop, { 3.0, -2.0 + 1.5 * (1 - 1e-7) }), sign);
    EXPECT_EQ(CountWindings(circle.Cells, loop, { 3.0, -2.0 + 1.5 * (1 + 1e-7) }), 0);
    EXPECT_EQ(CountWindings(circle.Cells, loop, { -30.0, 20.0 }), 0);
    EXPECT_EQ(CountWindings(circle.Cells, loop, { 4.5, -2.0 }), std::nullopt);
  }
  auto twice = circle.Loop();
  twice.insert(twice.end(), twice.begin(), twice.begin() + 4);
  EXPECT_EQ(CountWindings(circle.Cells, twice, { 3.5, -2.5 }), 2);
}

TEST(PlaneCurves, OrientationNeedsAnArea_ExactOracle)
{
  for (const double height : { 1.0, 1e-3, 1e-6, -1e-6 })
  {
    Curves sliver;
    sliver.Add(2, 0, 1, [&](double s) { return Point{ s, height * s * (s - 1.0), 0.0 }; });
    sliver.Add(3, 1, 0, [](double s) { return Point{ 1.0 - s, 0.0, 0.0 }; });
    EXPECT_EQ(FindOrientation(sliver.Cells, sliver.Loop()), height > 0.0 ? 1 : -1) << height;
  }
  // there and back again
  Curves line;
  line.Add(2, 0, 1, [](double s) { return Point{ s, s * s, 0.0 }; });
  EXPECT_EQ(FindOrientation(line.Cells, { { 0, false }, { 0, true } }), std::nullopt);
  EXPECT_EQ(FindOrientation(line.Cells, {}), std::nullopt);
}

TEST(PlaneCurves, EveryFailureIsReachable)
{
  Curves curves = Circle(0, 0, 1);
  const auto code = [&](const SimpleCurvesParams& params)
  { return ProveSimpleCurves(curves.Cells, curves.Ends, params).Status.Code; };
  SimpleCurvesParams params;
  params.MaxBoxes = 0;
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
  params = {};
  params.Threads = -1;
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
  params = {};
  curves.Ends[0][0] = -1;
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
  curves.Ends.pop_back();
  EXPECT_EQ(code(params), ErrorCode::SizeMismatch);
  curves = Circle(0, 0, 1);
  curves.Cells.Data[0] = NAN;
  EXPECT_EQ(code(params), ErrorCode::NonFiniteInput);
  curves = Curves();
  curves.Cells.Add(CellShape::Quadrilateral, { 1, 1, 0 });
  curves.Ends.push_back({ 0, 1 });
  EXPECT_EQ(code(params), ErrorCode::DimensionMismatch);
}
