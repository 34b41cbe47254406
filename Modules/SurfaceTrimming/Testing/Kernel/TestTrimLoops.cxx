// SPDX-License-Identifier: BSD-3-Clause
#include "ChartCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SurfaceTrimming/TrimLoops.h>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr double Eps = 2.220446049250313e-16;

TrimmedModel MakeModel(const std::vector<Spline<2>>& surfaces, const TrimLoops& loops)
{
  TrimmedModel model;
  for (std::size_t c = 0; c < surfaces.size(); ++c)
  {
    TrimmedFace face;
    face.Surface = surfaces[c];
    face.Loops = loops.Loops[c];
    model.Faces.push_back(std::move(face));
  }
  model.NumEdges = loops.NumEdges;
  model.NumVertices = loops.NumVertices;
  return model;
}

LoopParams WithTolerance(double tolerance)
{
  LoopParams params;
  params.Tolerance = tolerance;
  return params;
}

PointMatrix Evaluate(const Spline<1>& curve, const PointMatrix& t)
{
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters<1>(MakeBezierForm(curve), t, {}, batch));
  return batch.Values;
}
PointMatrix Evaluate(const Spline<2>& surface, const PointMatrix& uv)
{
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters<2>(MakeBezierForm(surface), uv, {}, batch));
  return batch.Values;
}

PointMatrix UniformParameters(int n)
{
  PointMatrix t(n + 1, 1);
  for (int i = 0; i <= n; ++i)
  {
    t(i, 0) = static_cast<double>(i) / n;
  }
  return t;
}

/// Distance of a point to a closed polygon.
double PolygonDistance(const Eigen::RowVector2d& x, const PointMatrix& polygon)
{
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < polygon.rows(); ++i)
  {
    const Eigen::RowVector2d a = polygon.row(i);
    const Eigen::RowVector2d b = polygon.row((i + 1) % polygon.rows());
    const double s = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    least = std::min(least, (x - a - s * (b - a)).norm());
  }
  return least;
}

/// A loop of one closed curve around a centre: a rational circle of four quadratic arcs.
TrimmedLoop Circle(double x, double y, double r, bool clockwise, int number = 0)
{
  TrimmingCurve use;
  const auto knots =
    KnotVector::Create(2, { 0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1 }).Value;
  use.Curve.Space = MakeTensorSpace<1>({ knots }).Value;
  use.UV.resize(9, 2);
  use.Curve.Weights.resize(9);
  const int sx[] = { 1, 1, 0, -1, -1, -1, 0, 1, 1 };
  const int sy[] = { 0, 1, 1, 1, 0, -1, -1, -1, 0 };
  for (int i = 0; i < 9; ++i)
  {
    use.UV.row(i) << x + r * sx[i], y + r * sy[i];
    use.Curve.Weights[i] = i % 2 == 0 ? 1.0 : std::sqrt(0.5);
  }
  use.Curve.ControlPoints = PointMatrix::Zero(9, 3);
  use.Curve.ControlPoints.leftCols(2) = use.UV;
  use.Edge = number;
  use.Vertices = { number, number };
  use.Reversed = clockwise;
  return { { use } };
}

/// A closed polynomial curve through a polygon's control points, not smooth at its begin.
TrimmedLoop ClosedCurve(int degree, const PointMatrix& points)
{
  TrimmingCurve use;
  const int n = static_cast<int>(points.rows()) + 1;
  use.Curve.Space = MakeTensorSpace<1>({ KnotVector::Uniform(degree, n - degree) }).Value;
  use.UV.resize(n, 2);
  use.UV << points, points.row(0);
  use.Curve.ControlPoints = PointMatrix::Zero(n, 3);
  use.Curve.ControlPoints.leftCols(2) = use.UV;
  return { { use } };
}

LoopVerdict Prove(const std::vector<TrimmedLoop>& loops)
{
  TrimmedFace face;
  face.Loops = loops;
  const auto verdict = ProveLoops(face);
  EXPECT_TRUE(verdict) << verdict.Status.Message();
  EXPECT_EQ(ProveLoops(face, 1).Value, verdict.Value);
  return verdict.Value;
}

/// What must hold for every result: a model that fits together, proved loops, and bounds that hold
/// at samples and are not far above them.
void CheckFit(const std::vector<ChartMesh>& charts, const std::vector<Spline<2>>& surfaces,
  const LoopParams& params, const TrimLoops& loops)
{
  const TrimmedModel model = MakeModel(surfaces, loops);
  const Status status = model.Check();
  ASSERT_TRUE(status) << status.Message();
  EXPECT_LE(loops.MaxTrimDistance, params.Tolerance);
  const PointMatrix t = UniformParameters(2000);
  double gap = 0.0;
  std::vector<const TrimmingCurve*> first(static_cast<std::size_t>(loops.NumEdges), nullptr);
  std::vector<int> uses(static_cast<std::size_t>(loops.NumEdges), 0);
  std::vector<Eigen::RowVector3d> vertices(
    static_cast<std::size_t>(loops.NumVertices), Eigen::RowVector3d::Constant(NAN));
  for (std::size_t c = 0; c < charts.size(); ++c)
  {
    EXPECT_EQ(loops.Verdicts[c], LoopVerdict::SimpleNested);
    for (const TrimmedLoop& loop : loops.Loops[c])
    {
      for (std::size_t k = 0; k < loop.Curves.size(); ++k)
      {
        const TrimmingCurve& use = loop.Curves[k];
        const TrimmingCurve& next = loop.Curves[(k + 1) % loop.Curves.size()];
        const Eigen::Index last = use.UV.rows() - 1;
        EXPECT_EQ(
          use.UV.row(use.Reversed ? 0 : last), next.UV.row(next.Reversed ? next.UV.rows() - 1 : 0));
        const PointMatrix uv = Evaluate(use.ParameterCurve(), t);
        const PointMatrix x = Evaluate(use.Curve, t);
        gap = std::max(gap, (x - Evaluate(surfaces[c], uv)).rowwise().norm().maxCoeff());
        // one curve for all uses, vertices where edges end
        const std::size_t edge = static_cast<std::size_t>(use.Edge);
        ++uses[edge];
        if (!first[edge])
        {
          first[edge] = &use;
          EXPECT_FALSE(use.Reversed);
        }
        else
        {
          EXPECT_TRUE(use.Reversed);
          EXPECT_EQ(use.Curve.ControlPoints, first[edge]->Curve.ControlPoints);
          EXPECT_EQ(use.Vertices, first[edge]->Vertices);
          EXPECT_TRUE(use.Curve.Space->Knots[0] == first[edge]->Curve.Space->Knots[0]);
        }
        for (std::size_t e = 0; e < 2; ++e)
        {
          auto& vertex = vertices[static_cast<std::size_t>(use.Vertices[e])];
          const Eigen::RowVector3d end = use.Curve.ControlPoints.row(e == 0 ? 0 : last);
          if (vertex.hasNaN())
          {
            vertex = end;
          }
          EXPECT_EQ(vertex, end);
        }
      }
    }
  }
  for (const int n : uses)
  {
    EXPECT_TRUE(n == 1 || n == 2);
  }
  const double rounding = 64.0 * Eps * 10.0; // evaluation of points of size 10 at most
  EXPECT_LE(gap, loops.MaxEdgeGap + rounding);
  EXPECT_LE(loops.MaxEdgeGap, 1.1 * gap + 5e-3 * params.Tolerance);
}
}

TEST(TrimLoops, SquareWithSquareHole_ExactOracle)
{
  const ChartMesh chart = SquareWithSquareHole(12, Flat);
  const std::vector<Spline<2>> surfaces{ InterpolatingSurface(Flat, 1, 1, BoxOf(chart, 0.0)) };
  const LoopParams params = WithTolerance(1e-3);
  const auto loops = FitLoops({ chart }, surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit({ chart }, surfaces, params, loops.Value);
  EXPECT_EQ(loops->NumEdges, 8);
  EXPECT_EQ(loops->NumVertices, 8);
  EXPECT_EQ(loops->NumBoundaryLoops, 2);
  ASSERT_EQ(loops->Loops[0].size(), 2u);
  const double tolerance = 64.0 * Eps; // sums of numbers up to 1
  EXPECT_LE(loops->MaxBoundaryDistance, tolerance);
  EXPECT_LE(loops->MaxTrimDistance, tolerance);
  EXPECT_LE(loops->MaxEdgeGap, tolerance);
  // straight lines without inner knots, corners in order
  const double corner[2][4][2] = { { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } },
    { { 1 / 3.0, 1 / 3.0 }, { 1 / 3.0, 2 / 3.0 }, { 2 / 3.0, 2 / 3.0 }, { 2 / 3.0, 1 / 3.0 } } };
  for (std::size_t l = 0; l < 2; ++l)
  {
    const auto& curves = loops->Loops[0][l].Curves;
    ASSERT_EQ(curves.size(), 4u);
    std::size_t shift = 0;
    while (shift < 4 &&
      std::hypot(curves[0].UV(0, 0) - corner[l][shift][0],
        curves[0].UV(0, 1) - corner[l][shift][1]) > tolerance)
    {
      ++shift;
    }
    ASSERT_LT(shift, 4u);
    for (std::size_t k = 0; k < 4; ++k)
    {
      ASSERT_EQ(curves[k].UV.rows(), 4);
      const Eigen::RowVector2d a(corner[l][(k + shift) % 4][0], corner[l][(k + shift) % 4][1]);
      const Eigen::RowVector2d b(
        corner[l][(k + shift + 1) % 4][0], corner[l][(k + shift + 1) % 4][1]);
      for (int i = 0; i < 4; ++i)
      {
        EXPECT_LE((curves[k].UV.row(i) - (a + (b - a) * i / 3.0)).norm(), tolerance);
      }
    }
  }
}

TEST(TrimLoops, AnnulusHasTwoClosedEdges_CrossOracle)
{
  const ChartMesh chart = Annulus(240, 20, 0.4, 1.0, Saddle);
  const std::vector<Spline<2>> surfaces{ InterpolatingSurface(Saddle, 2, 3, BoxOf(chart)) };
  for (const double tolerance : { 1e-2, 1e-3, 1e-4, 1e-6 })
  {
    SCOPED_TRACE(tolerance);
    const LoopParams params = WithTolerance(tolerance);
    const auto loops = FitLoops({ chart }, surfaces, params);
    ASSERT_TRUE(loops) << loops.Status.Message();
    CheckFit({ chart }, surfaces, params, loops.Value);
    EXPECT_EQ(loops->NumEdges, 2);
    EXPECT_EQ(loops->NumVertices, 2);
    EXPECT_EQ(loops->NumBoundaryLoops, 2);
    for (std::size_t l = 0; l < 2; ++l)
    {
      ASSERT_EQ(loops->Loops[0][l].Curves.size(), 1u);
      const TrimmingCurve& use = loops->Loops[0][l].Curves[0];
      const double r = l == 0 ? 1.0 : 0.4;
      PointMatrix circle(240, 2);
      for (int i = 0; i < 240; ++i)
      {
        const double angle = 2.0 * std::acos(-1.0) * i / 240;
        circle.row(i) << r * std::cos(angle), r * std::sin(angle);
      }
      const PointMatrix uv = Evaluate(use.ParameterCurve(), UniformParameters(5000));
      double most = 0.0;
      for (Eigen::Index i = 0; i < uv.rows(); ++i)
      {
        most = std::max(most, PolygonDistance(uv.row(i), circle));
      }
      EXPECT_LE(most, tolerance); // the graph only stretches
      if (tolerance >= 1e-3)
      {
        EXPECT_LE(use.UV.rows(), 80);
      }
    }
  }
}

TEST(TrimLoops, ReportedBoundaryDistanceHolds_CrossOracle)
{
  const ChartMesh chart = SquareWithSquareHole(9, Saddle);
  const std::vector<Spline<2>> surfaces{ InterpolatingSurface(Saddle, 2, 1, BoxOf(chart)) };
  const LoopParams params = WithTolerance(1e-3);
  const auto loops = FitLoops({ chart }, surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit({ chart }, surfaces, params, loops.Value);
  // the chords of the mesh below the parabola along v: 0.4 h^2 / 4
  const double chord = 0.4 / (4.0 * 81.0);
  EXPECT_GE(loops->MaxBoundaryDistance, 0.99 * chord);
  EXPECT_LE(loops->MaxBoundaryDistance, 2.0 * chord);
  EXPECT_LE(loops->MaxTrimDistance, 64.0 * Eps * 2.0);
  EXPECT_LE(loops->MaxEdgeGap, 0.042 * params.Tolerance);
}

TEST(TrimLoops, CoarsePolygonsConverge_PropertyOracle)
{
  for (const int n : { 16, 20, 40 })
  {
    SCOPED_TRACE(n);
    const ChartMesh chart = Annulus(n, 3, 0.5, 1.0, Saddle);
    const std::vector<Spline<2>> surfaces{ InterpolatingSurface(Saddle, 2, 3, BoxOf(chart)) };
    for (const double tolerance : { 1e-2, 3e-4, 1e-5 })
    {
      SCOPED_TRACE(tolerance);
      LoopParams params = WithTolerance(tolerance);
      params.CornerAngle = 40.0; // no corner at 16 sides
      const auto loops = FitLoops({ chart }, surfaces, params);
      ASSERT_TRUE(loops) << loops.Status.Message();
      CheckFit({ chart }, surfaces, params, loops.Value);
      EXPECT_EQ(loops->NumEdges, 2);
      for (const TrimmedLoop& loop : loops->Loops[0])
      {
        const KnotVector& knots = loop.Curves[0].Curve.Space->Knots[0];
        EXPECT_LE(knots.NumFunctions(), 6 * n + 20); // five knots a corner
        for (int b = 1; b < knots.NumElements(); ++b)
        {
          EXPECT_EQ(knots.Multiplicity(b), 1);
        }
      }
    }
  }
}

TEST(TrimLoops, CornersAreRoundedWhenNoneAreAllowed_PropertyOracle)
{
  const ChartMesh chart = SquareWithSquareHole(6, Flat);
  const std::vector<Spline<2>> surfaces{ InterpolatingSurface(Flat, 1, 1, BoxOf(chart, 0.0)) };
  LoopParams params = WithTolerance(1e-3);
  params.CornerAngle = 180.0;
  const auto loops = FitLoops({ chart }, surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit({ chart }, surfaces, params, loops.Value);
  EXPECT_EQ(loops->NumEdges, 2);
  EXPECT_GT(loops->MaxTrimDistance, 0.0);
}

// Bilinear elements: the curves on the surface have a corner at every line between elements.
TEST(TrimLoops, SurfaceWithCreases_CrossOracle)
{
  const ChartMesh chart = Annulus(60, 6, 0.4, 1.0, Saddle);
  const std::vector<Spline<2>> surfaces{ InterpolatingSurface(Saddle, 1, 7, BoxOf(chart)) };
  const LoopParams params = WithTolerance(1e-2);
  const auto loops = FitLoops({ chart }, surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit({ chart }, surfaces, params, loops.Value);
  EXPECT_LE(loops->MaxEdgeGap, 0.05 * params.Tolerance);
}

// A tolerance that only corners of the curve reach, and one below rounding.
TEST(TrimLoops, StubbornCornersBecomeMultipleKnots_ExactOracle)
{
  const ChartMesh chart = SquareWithSquareHole(6, Flat);
  const std::vector<Spline<2>> surfaces{ InterpolatingSurface(Flat, 1, 1, BoxOf(chart, 0.0)) };
  LoopParams params = WithTolerance(1e-11);
  params.CornerAngle = 180.0;
  const auto loops = FitLoops({ chart }, surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit({ chart }, surfaces, params, loops.Value);
  EXPECT_EQ(loops->NumEdges, 2);
  EXPECT_LE(loops->MaxTrimDistance, 64.0 * Eps);
  const KnotVector& knots = loops->Loops[0][0].Curves[0].Curve.Space->Knots[0];
  int corners = 0;
  for (int b = 1; b < knots.NumElements(); ++b)
  {
    corners += knots.Multiplicity(b) == 3 ? 1 : 0;
  }
  EXPECT_GE(corners, 3); // the fourth is the closed edge's vertex
  params.Tolerance = 1e-40;
  const ChartMesh ring = Annulus(40, 3, 0.4, 1.0, Saddle);
  EXPECT_EQ(
    FitLoops({ ring }, { InterpolatingSurface(Saddle, 2, 2, BoxOf(ring)) }, params).Status.Code,
    ErrorCode::NotConverged);
}

TEST(TrimLoops, JaggedBoundariesOfRandomMeshes_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> jitter(-0.2, 0.2);
    std::vector<Eigen::RowVector2d> places;
    GridChart grid;
    grid.Columns = grid.Rows = 12;
    for (int i = 0; i < 13 * 13; ++i)
    {
      places.emplace_back(jitter(random), jitter(random));
    }
    grid.Plane = [&](int i, int j) -> Eigen::RowVector2d
    { return (Eigen::RowVector2d(i, j) + places[static_cast<std::size_t>(13 * j + i)]) / 12.0; };
    grid.Lift = Saddle;
    grid.Keep = [&](int i, int j)
    { return std::hypot(i - 6.0, j - 5.0) > 2.0 && std::hypot(i - 5.5, j - 5.5) < 7.0; };
    const ChartMesh chart = grid.Make();
    const std::vector<Spline<2>> surfaces{ InterpolatingSurface(Saddle, 2, 2, BoxOf(chart)) };
    for (const double tolerance : { 0.3, 1e-3 })
    {
      LoopParams params = WithTolerance(tolerance);
      params.CornerAngle = 20.0 * seed;
      const auto loops = FitLoops({ chart }, surfaces, params);
      ASSERT_TRUE(loops) << loops.Status.Message();
      CheckFit({ chart }, surfaces, params, loops.Value);
      EXPECT_EQ(loops->NumBoundaryLoops, 2);
    }
  }
}

// The tolerance would let the wavy borders of a narrow band cross.
TEST(TrimLoops, NarrowBandIsFittedMoreClosely_PropertyOracle)
{
  GridChart grid;
  grid.Columns = 240;
  grid.Rows = 1;
  grid.Periodic = true;
  grid.Plane = [](int i, int j)
  {
    const double angle = -2.0 * std::acos(-1.0) * i / 240;
    const double r = 1.0 + 0.1 * std::cos(12.0 * angle) + 0.01 * j;
    return Eigen::RowVector2d(r * std::cos(angle), r * std::sin(angle));
  };
  grid.Lift = Flat;
  const ChartMesh chart = grid.Make();
  const std::vector<Spline<2>> surfaces{ InterpolatingSurface(Flat, 2, 1, BoxOf(chart)) };
  const LoopParams params = WithTolerance(0.2);
  const auto loops = FitLoops({ chart }, surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit({ chart }, surfaces, params, loops.Value);
  EXPECT_LT(loops->MaxTrimDistance, 0.1);
}

namespace
{
/// [0, 2] x [0, 1] in two charts that meet in u = 1, the second one moved in its plane.
struct TwoCharts
{
  std::vector<ChartMesh> Charts;
  std::vector<Spline<2>> Surfaces;

  explicit TwoCharts(const Place3& lift)
  {
    GridChart grid;
    grid.Columns = 16;
    grid.Rows = 8;
    grid.Plane = [](int i, int j) { return Eigen::RowVector2d(i / 8.0, j / 8.0); };
    grid.Lift = lift;
    grid.Keep = [](int i, int) { return i < 8; };
    this->Charts.push_back(grid.Make());
    grid.Keep = [](int i, int) { return i >= 8; };
    this->Charts.push_back(grid.Make());
    Motion motion;
    motion.Angle = 0.7;
    motion.Shift = { 3.0, -1.0 };
    ChartMesh& second = this->Charts[1];
    for (Eigen::Index i = 0; i < second.UV.rows(); ++i)
    {
      second.UV.row(i) = motion.Apply(second.UV.row(i));
    }
    this->Surfaces.push_back(InterpolatingSurface(lift, 2, 2, BoxOf(this->Charts[0])));
    this->Surfaces.push_back(InterpolatingSurface(motion.Undo(lift), 2, 2, BoxOf(second)));
  }
};
}

TEST(TrimLoops, TwoChartsShareOneEdge_ExactOracle)
{
  const TwoCharts two(Saddle);
  const LoopParams params = WithTolerance(1e-3);
  const auto loops = FitLoops(two.Charts, two.Surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit(two.Charts, two.Surfaces, params, loops.Value);
  // corners end edges, and so do the interface's ends: 2 x 4 sides, one of them common
  EXPECT_EQ(loops->NumEdges, 7);
  EXPECT_EQ(loops->NumVertices, 6);
  EXPECT_EQ(loops->NumBoundaryLoops, 1);
  EXPECT_LE(loops->MaxEdgeGap, 0.05 * params.Tolerance);
  std::multiset<int> edges;
  for (const auto& chart : loops->Loops)
  {
    ASSERT_EQ(chart.size(), 1u);
    for (const TrimmingCurve& use : chart[0].Curves)
    {
      edges.insert(use.Edge);
    }
  }
  int shared = 0;
  for (int e = 0; e < 7; ++e)
  {
    shared += edges.count(e) == 2 ? 1 : 0;
  }
  EXPECT_EQ(shared, 1);
  EXPECT_EQ(edges.size(), 8u);
}

TEST(TrimLoops, ChartsWithoutIdsShareNothing_ExactOracle)
{
  TwoCharts two(Saddle);
  two.Charts[1].PointIds.clear();
  const LoopParams params = WithTolerance(1e-3);
  const auto loops = FitLoops(two.Charts, two.Surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit(two.Charts, two.Surfaces, params, loops.Value);
  EXPECT_EQ(loops->NumEdges, 8);
  EXPECT_EQ(loops->NumVertices, 8);
  EXPECT_EQ(loops->NumBoundaryLoops, 2);
}

// Surfaces that disagree along the interface: the curve lies between them.
TEST(TrimLoops, CurveLiesBetweenSurfacesThatDisagree_ExactOracle)
{
  TwoCharts two(Saddle);
  two.Surfaces[1].ControlPoints.col(2).array() += 1e-3;
  const LoopParams params = WithTolerance(1e-3);
  const auto loops = FitLoops(two.Charts, two.Surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit(two.Charts, two.Surfaces, params, loops.Value);
  // half of the way; where an edge of one chart ends in a common vertex too
  EXPECT_GE(loops->MaxEdgeGap, 0.5e-3);
  EXPECT_LE(loops->MaxEdgeGap, 1.06 * 0.5e-3);
}

namespace
{
void ReverseNumbers(ChartMesh& chart)
{
  chart.Points = chart.Points.colwise().reverse().eval();
  chart.UV = chart.UV.colwise().reverse().eval();
  std::reverse(chart.PointIds.begin(), chart.PointIds.end());
  const int last = static_cast<int>(chart.PointIds.size()) - 1;
  for (auto& corners : chart.Triangles)
  {
    for (int& corner : corners)
    {
      corner = last - corner;
    }
  }
}
}

TEST(TrimLoops, ClosedInterface_ExactOracle)
{
  // an annulus around another one: they share a circle
  GridChart grid;
  grid.Columns = 60;
  grid.Rows = 8;
  grid.Periodic = true;
  grid.Plane = [](int i, int j)
  {
    const double angle = -2.0 * std::acos(-1.0) * i / 60;
    const double r = 0.3 + 0.7 * j / 8;
    return Eigen::RowVector2d(r * std::cos(angle), r * std::sin(angle));
  };
  grid.Lift = Saddle;
  std::vector<ChartMesh> charts;
  grid.Keep = [](int, int j) { return j >= 4; };
  charts.push_back(grid.Make());
  grid.Keep = [](int, int j) { return j < 4; };
  charts.push_back(grid.Make());
  const std::vector<Spline<2>> surfaces{ InterpolatingSurface(Saddle, 2, 3, BoxOf(charts[0])),
    InterpolatingSurface(Saddle, 2, 2, BoxOf(charts[1])) };
  const LoopParams params = WithTolerance(1e-4);
  // whichever comes first, and wherever its numbers begin
  for (int variant = 0; variant < 4; ++variant)
  {
    SCOPED_TRACE(variant);
    std::swap(charts[0], charts[1]);
    if (variant == 2)
    {
      ReverseNumbers(charts[0]);
    }
    const auto loops = FitLoops(charts, { surfaces[0], surfaces[0] }, params);
    ASSERT_TRUE(loops) << loops.Status.Message();
    CheckFit(charts, { surfaces[0], surfaces[0] }, params, loops.Value);
    EXPECT_EQ(loops->NumEdges, 3);
    EXPECT_EQ(loops->NumVertices, 3);
    EXPECT_EQ(loops->NumBoundaryLoops, 2);
    // one surface, so both sides agree
    EXPECT_LE(loops->MaxEdgeGap, 0.05 * params.Tolerance);
    EXPECT_LE(loops->MaxBoundaryDistance, 5e-3); // chords of 60 points
  }
}

// One chart below two others: they meet in one inner point of a side.
TEST(TrimLoops, ThreeChartsMeetInJunctions_ExactOracle)
{
  GridChart grid;
  grid.Columns = grid.Rows = 8;
  grid.Plane = [](int i, int j) { return Eigen::RowVector2d(i / 8.0, j / 8.0); };
  grid.Lift = Saddle;
  std::vector<ChartMesh> charts;
  grid.Keep = [](int, int j) { return j < 4; };
  charts.push_back(grid.Make());
  grid.Keep = [](int i, int j) { return j >= 4 && i < 3; };
  charts.push_back(grid.Make());
  grid.Keep = [](int i, int j) { return j >= 4 && i >= 3; };
  charts.push_back(grid.Make());
  const std::vector<Spline<2>> surfaces(
    3, InterpolatingSurface(Saddle, 2, 2, { -0.1, 1.1, -0.1, 1.1 }));
  LoopParams params = WithTolerance(1e-3);
  auto loops = FitLoops(charts, surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit(charts, surfaces, params, loops.Value);
  // 3 faces, V - E + F = 1; vertices: 4 corners, 3 on the outer boundary, 1 inside
  EXPECT_EQ(loops->NumVertices, 8);
  EXPECT_EQ(loops->NumEdges, 10);
  EXPECT_EQ(loops->NumBoundaryLoops, 1);
  // without corners only junctions are left
  params.CornerAngle = 180.0;
  loops = FitLoops(charts, surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit(charts, surfaces, params, loops.Value);
  EXPECT_EQ(loops->NumVertices, 4);
  EXPECT_EQ(loops->NumEdges, 6);
}

// A cylinder cut open: the chart is its own neighbour.
TEST(TrimLoops, ChartThatBordersItself_ExactOracle)
{
  const double pi = std::acos(-1.0);
  const auto cylinder = [pi](double u, double v)
  { return Eigen::RowVector3d(std::cos(2.0 * pi * u), std::sin(2.0 * pi * u), v); };
  GridChart grid;
  grid.Columns = 48;
  grid.Rows = 6;
  grid.Plane = [](int i, int j) { return Eigen::RowVector2d(i / 48.0, j / 6.0); };
  grid.Lift = cylinder;
  ChartMesh chart = grid.Make();
  for (Eigen::Index i = 0; i < chart.UV.rows(); ++i)
  {
    if (chart.UV(i, 0) == 1.0)
    {
      for (Eigen::Index j = 0; j < chart.UV.rows(); ++j)
      {
        if (chart.UV(j, 0) == 0.0 && chart.UV(j, 1) == chart.UV(i, 1))
        {
          chart.PointIds[static_cast<std::size_t>(i)] = chart.PointIds[static_cast<std::size_t>(j)];
          chart.Points.row(i) = chart.Points.row(j);
        }
      }
    }
  }
  const std::vector<Spline<2>> surfaces{ InterpolatingSurface(cylinder, 3, 24, BoxOf(chart)) };
  const LoopParams params = WithTolerance(1e-3);
  const auto loops = FitLoops({ chart }, surfaces, params);
  ASSERT_TRUE(loops) << loops.Status.Message();
  CheckFit({ chart }, surfaces, params, loops.Value);
  EXPECT_EQ(loops->NumEdges, 3);
  EXPECT_EQ(loops->NumVertices, 2);
  EXPECT_EQ(loops->NumBoundaryLoops, 2);
  EXPECT_EQ(loops->Loops[0][0].Curves.size(), 4u);
}

TEST(TrimLoops, SameForAnyNumberOfThreads_PropertyOracle)
{
  const TwoCharts two(Saddle);
  LoopParams params = WithTolerance(1e-4);
  params.Threads = 1;
  const auto one = FitLoops(two.Charts, two.Surfaces, params);
  params.Threads = 4;
  const auto four = FitLoops(two.Charts, two.Surfaces, params);
  ASSERT_TRUE(one && four);
  for (std::size_t c = 0; c < 2; ++c)
  {
    for (std::size_t k = 0; k < one->Loops[c][0].Curves.size(); ++k)
    {
      const TrimmingCurve& a = one->Loops[c][0].Curves[k];
      const TrimmingCurve& b = four->Loops[c][0].Curves[k];
      EXPECT_EQ(a.UV, b.UV);
      EXPECT_EQ(a.Curve.ControlPoints, b.Curve.ControlPoints);
    }
  }
  EXPECT_EQ(one->MaxEdgeGap, four->MaxEdgeGap);
  EXPECT_EQ(one->MaxBoundaryDistance, four->MaxBoundaryDistance);
}

TEST(TrimLoops, EveryFailureIsReachable)
{
  const TwoCharts two(Saddle);
  const LoopParams params = WithTolerance(1e-3);
  const auto code = [&](const std::vector<ChartMesh>& charts,
                      const std::vector<Spline<2>>& surfaces, const LoopParams& p)
  { return FitLoops(charts, surfaces, p).Status.Code; };
  EXPECT_EQ(code({}, {}, params), ErrorCode::EmptyInput);
  EXPECT_EQ(code(two.Charts, { two.Surfaces[0] }, params), ErrorCode::SizeMismatch);
  for (const double bad : { 0.0, -1.0, double(NAN), double(INFINITY) })
  {
    EXPECT_EQ(code(two.Charts, two.Surfaces, WithTolerance(bad)), ErrorCode::InvalidParameter);
  }
  for (const double bad : { 0.0, 181.0, double(NAN) })
  {
    LoopParams p = params;
    p.CornerAngle = bad;
    EXPECT_EQ(code(two.Charts, two.Surfaces, p), ErrorCode::InvalidParameter);
  }
  LoopParams p = params;
  p.Threads = -1;
  EXPECT_EQ(code(two.Charts, two.Surfaces, p), ErrorCode::InvalidParameter);
  p = params;
  p.Progress = [](double) { return false; };
  EXPECT_EQ(code(two.Charts, two.Surfaces, p), ErrorCode::Aborted);

  const auto changed = [&](const std::function<void(TwoCharts&)>& change)
  {
    TwoCharts copy = two;
    change(copy);
    return code(copy.Charts, copy.Surfaces, params);
  };
  EXPECT_EQ(
    changed([](TwoCharts& t) { t.Charts[0].Points(3, 1) = NAN; }), ErrorCode::NonFiniteInput);
  EXPECT_EQ(changed([](TwoCharts& t) { t.Charts[0].Triangles.clear(); }), ErrorCode::EmptyInput);
  EXPECT_EQ(changed([](TwoCharts& t) { t.Surfaces[0].ControlPoints(0, 0) = NAN; }),
    ErrorCode::NonFiniteInput);
  EXPECT_EQ(
    changed([](TwoCharts& t)
      { t.Surfaces[0].ControlPoints = PointMatrix(t.Surfaces[0].ControlPoints.leftCols(2)); }),
    ErrorCode::DimensionMismatch);
  EXPECT_EQ(
    changed([](TwoCharts& t)
      { t.Surfaces[0].Weights = Eigen::VectorXd::Ones(t.Surfaces[0].ControlPoints.rows()); }),
    ErrorCode::DimensionMismatch);
  EXPECT_EQ(
    changed([](TwoCharts& t) { t.Charts[0].UV.array() += 10.0; }), ErrorCode::OutsideDomain);
  // topology
  EXPECT_EQ(changed([](TwoCharts& t) { t.Charts[0].Points.array() += 1.0; }),
    ErrorCode::InvalidTopology); // common points apart
  EXPECT_EQ(
    changed([](TwoCharts& t) { t.Charts[0].Triangles.push_back(t.Charts[0].Triangles[0]); }),
    ErrorCode::InvalidTopology); // two triangles on one side
  EXPECT_EQ(changed(
              [](TwoCharts& t)
              {
                t.Charts[1] = t.Charts[0];
                t.Surfaces[1] = t.Surfaces[0];
              }),
    ErrorCode::InvalidTopology); // charts on one side of an edge
  EXPECT_EQ(changed(
              [](TwoCharts& t)
              {
                t.Charts.push_back(t.Charts[1]);
                t.Surfaces.push_back(t.Surfaces[1]);
              }),
    ErrorCode::InvalidTopology); // three charts
  // a hole's edge inside another chart
  const ChartMesh whole = SquareWithSquareHole(6, Flat);
  ChartMesh part = whole;
  part.Triangles = { whole.Triangles[0], whole.Triangles[1] };
  const Spline<2> plane = InterpolatingSurface(Flat, 1, 1, BoxOf(whole));
  EXPECT_EQ(code({ whole, part }, { plane, plane }, params), ErrorCode::InvalidTopology);
  // triangles that touch in a point, and two discs
  GridChart grid;
  grid.Columns = grid.Rows = 3;
  grid.Plane = [](int i, int j) { return Eigen::RowVector2d(i, j); };
  grid.Lift = Flat;
  const auto kept = [&](const std::function<bool(int, int)>& keep)
  {
    grid.Keep = keep;
    const ChartMesh chart = grid.Make();
    return FitLoops({ chart }, { InterpolatingSurface(Flat, 1, 1, BoxOf(chart)) }, params);
  };
  const auto touching = kept([](int i, int j) { return i + j != 1 || i > 1; });
  EXPECT_EQ(touching.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(touching.Status.Detail.find("touch"), std::string::npos);
  const auto discs = kept([](int i, int) { return i != 1; });
  EXPECT_EQ(discs.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(discs.Status.Detail.find("more than one"), std::string::npos);
  EXPECT_TRUE(kept([](int i, int j) { return i != 1 || j != 1; }));
  // a strip that runs around a circle more than once
  grid.Columns = 30;
  grid.Keep = [](int, int) { return true; };
  const auto wound = [&](double turns)
  {
    grid.Plane = [=](int i, int j)
    {
      const double angle = -2.0 * std::acos(-1.0) * turns * i / 30.0;
      const double radius = 3.0 + 0.5 * j;
      return Eigen::RowVector2d(radius * std::cos(angle), radius * std::sin(angle));
    };
    const ChartMesh chart = grid.Make();
    return FitLoops({ chart }, { InterpolatingSurface(Flat, 1, 1, BoxOf(chart)) }, params).Status;
  };
  EXPECT_TRUE(wound(0.9));
  EXPECT_EQ(wound(1.1).Code, ErrorCode::InvalidTopology);
  EXPECT_NE(wound(1.1).Detail.find("lies over itself"), std::string::npos);
}

// ---- proofs ----------------------------------------------------------------------------------

TEST(ProveLoops, FaceWithoutLoopsIsWhole_ExactOracle)
{
  EXPECT_EQ(Prove({}), LoopVerdict::SimpleNested);
}

TEST(ProveLoops, CirclesNestedOrNot_ExactOracle)
{
  const TrimmedLoop outer = Circle(0, 0, 2, false);
  EXPECT_EQ(Prove({ outer }), LoopVerdict::SimpleNested);
  EXPECT_EQ(Prove({ outer, Circle(0.5, 0, 1, true) }), LoopVerdict::SimpleNested);
  EXPECT_EQ(Prove({ outer, Circle(-1, 0, 0.5, true), Circle(1, 0.2, 0.5, true) }),
    LoopVerdict::SimpleNested);
  // orientation
  EXPECT_EQ(Prove({ Circle(0, 0, 2, true) }), LoopVerdict::Crossing);
  EXPECT_EQ(Prove({ outer, Circle(0.5, 0, 1, false) }), LoopVerdict::Crossing);
  // outside, around, inside each other
  EXPECT_EQ(Prove({ outer, Circle(5, 0, 1, true) }), LoopVerdict::Crossing);
  EXPECT_EQ(Prove({ outer, Circle(0, 0, 3, true) }), LoopVerdict::Crossing);
  EXPECT_EQ(
    Prove({ outer, Circle(0, 0, 1, true), Circle(0, 0, 0.5, true) }), LoopVerdict::Crossing);
  // crossing, in a point of the arcs or where they meet
  EXPECT_EQ(Prove({ outer, Circle(1.5, 0.3, 1, true) }), LoopVerdict::Crossing);
  EXPECT_EQ(Prove({ outer, Circle(2, 0, 1, true) }), LoopVerdict::Crossing);
  EXPECT_EQ(Prove({ outer, Circle(1, 2, 1, true) }), LoopVerdict::Crossing);
  EXPECT_EQ(Prove({ outer, Circle(-1, 0, 0.5, true), Circle(-0.5, 0.4, 0.5, true) }),
    LoopVerdict::Crossing);
}

TEST(ProveLoops, NearlyTouchingLoopsAreDecided_ExactOracle)
{
  const TrimmedLoop outer = Circle(0, 0, 2, false);
  for (const double gap : { 1e-2, 1e-6, 1e-10 })
  {
    SCOPED_TRACE(gap);
    EXPECT_EQ(Prove({ outer, Circle(1 - gap, 0, 1, true) }), LoopVerdict::SimpleNested);
    EXPECT_EQ(Prove({ outer, Circle(1 + gap, 0, 1, true) }), LoopVerdict::Crossing);
  }
  EXPECT_EQ(Prove({ outer, Circle(1, 0, 1, true) }), LoopVerdict::Undecided);
}

TEST(ProveLoops, FigureEightIsRefuted_ExactOracle)
{
  PointMatrix points(7, 2);
  points << 0, 0, 2, -1, 3, 0.5, 2, 2, 0.2, 0.3, -2, -2, -3, 0;
  EXPECT_EQ(Prove({ ClosedCurve(3, points) }), LoopVerdict::Crossing);
  // crossing again and again at random, against a fine polygon
  int crossing = 0;
  int simple = 0;
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> jitter(-0.8, 0.8);
    PointMatrix star(9, 2);
    for (int i = 0; i < 9; ++i)
    {
      const double angle = 2.0 * std::acos(-1.0) * (i + jitter(random)) / 9;
      const double r = 1.0 + 0.4 * jitter(random);
      star.row(i) << r * std::cos(angle), r * std::sin(angle);
    }
    const TrimmedLoop loop = ClosedCurve(3, star);
    const PointMatrix p = Evaluate(loop.Curves[0].ParameterCurve(), UniformParameters(600));
    bool crosses = false;
    double area = 0.0;
    const auto side = [&](Eigen::Index a, Eigen::Index b, Eigen::Index x)
    {
      const Eigen::RowVector2d d = p.row(b) - p.row(a);
      const Eigen::RowVector2d e = p.row(x) - p.row(a);
      return d[0] * e[1] - d[1] * e[0];
    };
    for (Eigen::Index i = 0; i < 600; ++i)
    {
      area += p(i, 0) * p(i + 1, 1) - p(i, 1) * p(i + 1, 0);
      for (Eigen::Index j = i + 2; j < (i == 0 ? 599 : 600); ++j)
      {
        crosses = crosses ||
          (side(i, i + 1, j) * side(i, i + 1, j + 1) < 0.0 &&
            side(j, j + 1, i) * side(j, j + 1, i + 1) < 0.0);
      }
    }
    const LoopVerdict verdict = Prove({ loop });
    EXPECT_EQ(verdict, crosses || area < 0.0 ? LoopVerdict::Crossing : LoopVerdict::SimpleNested);
    (crosses ? crossing : simple) += 1;
  }
  EXPECT_GE(crossing, 5);
  EXPECT_GE(simple, 5);
}

TEST(ProveLoops, OpenLoopsAreUndecided_ExactOracle)
{
  TrimmedLoop open = Circle(0, 0, 1, false);
  open.Curves[0].UV(8, 0) += 1e-6;
  EXPECT_EQ(Prove({ open }), LoopVerdict::Undecided);
  open.Curves[0].UV(8, 0) = 1.0 + 2.0 * Eps;
  EXPECT_EQ(Prove({ open }), LoopVerdict::SimpleNested);
}

TEST(ProveLoops, EveryFailureIsReachable)
{
  TrimmedFace face;
  face.Loops.resize(1);
  EXPECT_EQ(ProveLoops(face).Status.Code, ErrorCode::EmptyInput);
  face.Loops[0] = Circle(0, 0, 1, false);
  face.Loops[0].Curves[0].UV(0, 0) = NAN;
  EXPECT_EQ(ProveLoops(face).Status.Code, ErrorCode::NonFiniteInput);
  face.Loops[0] = Circle(0, 0, 1, false);
  face.Loops[0].Curves[0].Curve.Weights[0] = -1.0;
  EXPECT_EQ(ProveLoops(face).Status.Code, ErrorCode::InvalidWeight);
  face.Loops[0] = Circle(0, 0, 1, false);
  face.Loops[0].Curves[0].UV.conservativeResize(8, 2);
  EXPECT_EQ(ProveLoops(face).Status.Code, ErrorCode::SizeMismatch);
  face.Loops[0].Curves[0].UV = PointMatrix::Zero(9, 3);
  EXPECT_EQ(ProveLoops(face).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_STREQ(ToString(LoopVerdict::SimpleNested), "simple_nested");
  EXPECT_STREQ(ToString(LoopVerdict::Crossing), "crossing");
  EXPECT_STREQ(ToString(LoopVerdict::Undecided), "undecided");
}
