// SPDX-License-Identifier: BSD-3-Clause
#include "EnergyError.h"
#include "SingularCases.h"

#include <gtest/gtest.h>

#include <set>

namespace knotwork::testing
{
namespace
{
/// A smooth solution, its gradient and source, with its values on the boundary.
struct SmoothCase
{
  const char* Name;
  PointFunction Values, Gradient, Source;

  Result<GalerkinProblem> operator()(const Spline<2>&, const GalerkinSpace& space) const
  {
    GalerkinProblem problem;
    problem.Source = this->Source;
    problem.Prescribed.push_back({ BoundaryFacets(space).Value, -1, this->Values });
    return problem;
  }
};

SmoothCase Sines()
{
  return { "sines",
    [](const double* x, double* u) { u[0] = std::sin(3 * x[0] + 1) * std::cos(2 * x[1]); },
    [](const double* x, double* g)
    {
      g[0] = 3 * std::cos(3 * x[0] + 1) * std::cos(2 * x[1]);
      g[1] = -2 * std::sin(3 * x[0] + 1) * std::sin(2 * x[1]);
    },
    [](const double* x, double* f) { f[0] = 13 * std::sin(3 * x[0] + 1) * std::cos(2 * x[1]); } };
}

/// exp(-50 |x - (0.4, 0.6)|^2)
SmoothCase Peak()
{
  const auto value = [](const double* x)
  { return std::exp(-50 * (std::pow(x[0] - 0.4, 2) + std::pow(x[1] - 0.6, 2))); };
  return { "peak", [value](const double* x, double* u) { u[0] = value(x); },
    [value](const double* x, double* g)
    {
      g[0] = -100 * (x[0] - 0.4) * value(x);
      g[1] = -100 * (x[1] - 0.6) * value(x);
    },
    [value](const double* x, double* f)
    {
      const double square = std::pow(x[0] - 0.4, 2) + std::pow(x[1] - 0.6, 2);
      f[0] = (200 - 10000 * square) * value(x);
    } };
}

/// Errors of every space of an adaptive solution, solved again one step further each time.
std::vector<std::array<double, 2>> SmoothRows(const SmoothCase& body, int degree, int maxFunctions)
{
  std::vector<std::array<double, 2>> rows;
  AdaptiveParams params;
  params.MaxFunctions = maxFunctions;
  Spline<2> spline = BentBox<2>(degree, 8);
  const ProblemMaker<2> recorded = [&](const Spline<2>& on, const GalerkinSpace& space)
  {
    const auto problem = body(on, space);
    const auto solution = SolveGalerkin(space, problem.Value);
    rows.push_back({ static_cast<double>(space.NumFunctions()),
      EnergyError(space, problem.Value, solution->Coefficients, body.Gradient) });
    return problem;
  };
  EXPECT_TRUE(SolveAdaptively<2>(spline, recorded, params));
  return rows;
}
}

TEST(AdaptiveSolution, ConstantsOfTheCorner_PublishedNumber)
{
  // a(u, u) of r^(2/3) sin(2 t / 3) on the L-shape is quoted as 1.8362264461
  EXPECT_NEAR(2.0 * CornerEnergy(), 1.8362264461, 1e-6);
}

// The order of smooth solutions, p / 2 in functions, once those at the corner are few among all. Of
// degree 3 that is late: meshes start fine there, for 24 levels to be enough.
TEST(AdaptiveSolution, CornerInOptimalOrder_ExactOracle)
{
  for (const int p : { 2, 3 })
  {
    AdaptiveParams params;
    params.MaxFunctions = p == 2 ? 25000 : 30000;
    const auto result = SolveAdaptively<2>(LShape<2>(p, p == 2 ? 8 : 32), CornerProblem<2>, params);
    ASSERT_TRUE(result) << result.Status.Message();
    const double slope = Slope(CornerRows(result->History), 4);
    std::printf("[ corner   ] p %d: order %.3f in functions\n", p, slope);
    EXPECT_NEAR(slope, 0.5 * p, 0.15);
  }
}

TEST(AdaptiveSolution, CornerAgainstUniformRefinement_ExactOracle)
{
  for (const int p : { 2, 3 })
  {
    AdaptiveParams params;
    params.MaxFunctions = 1000;
    const auto result = SolveAdaptively<2>(LShape<2>(p, 2), CornerProblem<2>, params);
    ASSERT_TRUE(result) << result.Status.Message();
    const auto rows = CornerRows(result->History);
    const auto uniform = UniformCorner<2>(p, 160 - p);
    const double needed = FunctionsAt(rows, uniform[1]);
    std::printf("[ corner   ] p %d: error %.2e of %.0f uniform functions needs %.0f\n", p,
      uniform[1], uniform[0], needed);
    EXPECT_GE(uniform[0], 5e4);
    EXPECT_LE(rows.back()[1], uniform[1]);
    EXPECT_LE(needed, 0.02 * uniform[0]);
  }
}

TEST(AdaptiveSolution, EdgeInSpace_ExactOracle)
{
  ExpectEdge(2, 2500, 16, 0.1);
}

// What refinement at a corner must not cost: where there is nothing to find, as many functions as
// uniform refinement of the same error has.
TEST(AdaptiveSolution, SmoothSolutions_ExactOracle)
{
  for (const int p : { 2, 3 })
  {
    for (const SmoothCase& body : { Sines(), Peak() })
    {
      const auto rows = SmoothRows(body, p, 2000);
      for (const int n : { 16, 32 })
      {
        const Spline<2> spline = BentBox<2>(p, n);
        const auto space = MakeGalerkinSpace(spline);
        const auto problem = body(spline, space.Value);
        const auto solution = SolveGalerkin(space.Value, problem.Value);
        const double error =
          EnergyError(space.Value, problem.Value, solution->Coefficients, body.Gradient);
        const double share = FunctionsAt(rows, error) / space->NumFunctions();
        std::printf("[ smooth   ] %s p %d: error %.2e of %d uniform functions needs %.3f of them\n",
          body.Name, p, error, space->NumFunctions(), share);
        EXPECT_LE(share, 1.15);
      }
    }
  }
}

TEST(AdaptiveSolution, ElasticCorner_ExactOracle)
{
  const OpenedCorner field;
  for (const int p : { 2, 3 })
  {
    std::vector<std::array<double, 2>> rows;
    const ProblemMaker<2> recorded = [&](const Spline<2>& spline, const GalerkinSpace& space)
    {
      const auto problem = field.Problem(spline);
      const auto solution = SolveGalerkin(space, problem.Value);
      const auto estimate = EstimateError(space, problem.Value, solution->Coefficients);
      rows.push_back({ static_cast<double>(space.NumFunctions()),
        EnergyError(space, problem.Value, solution->Coefficients, field.Gradient(), 4) });
      EXPECT_GT(estimate->Total / rows.back()[1], 0.5);
      EXPECT_LT(estimate->Total / rows.back()[1], 4.0);
      return problem;
    };
    AdaptiveParams params;
    params.MaxFunctions = p == 2 ? 6000 : 4000;
    const auto result = SolveAdaptively<2>(LShape<2>(p, 2), recorded, params);
    ASSERT_TRUE(result) << result.Status.Message();
    const double slope = Slope(rows, 4);
    std::printf("[ elastic  ] p %d: order %.3f in functions, %zu steps to %.0f functions\n", p,
      slope, rows.size(), rows.back()[0]);
    EXPECT_GE(slope, 0.5 * p - 0.15);
  }
}

TEST(AdaptiveSolution, LocallyRefinedSplines_ExactOracle)
{
  const Spline<2> spline = RefineMarkedLR(LShape<2>(2, 2), { 0 })->Value;
  ASSERT_EQ(spline.Space->Kind, SpaceKind::LocallyRefined);
  AdaptiveParams params;
  params.MaxFunctions = 1000;
  const auto result = SolveAdaptively<2>(spline, CornerProblem<2>, params);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Body.Patches[0].Space->Kind, SpaceKind::LocallyRefined);
  const auto rows = CornerRows(result->History);
  const auto uniform = UniformCorner<2>(2, 40);
  EXPECT_LE(FunctionsAt(rows, uniform[1]), 0.1 * uniform[0]);
}

namespace
{
/// The L-shape, in space times (0, 1), of three squares that meet at the corner, n elements along
/// each; their parameters are turned in different ways.
template <int Dim>
MultiPatch<Dim> LShapeOfPatches(int degree, int n)
{
  MultiPatch<Dim> body;
  for (int k = 0; k < 3; ++k)
  {
    Spline<Dim> patch = BentBox<Dim>(degree, n, 0.0);
    for (Eigen::Index i = 0; i < patch.ControlPoints.rows(); ++i)
    {
      const double a = patch.ControlPoints(i, 0);
      const double b = patch.ControlPoints(i, 1);
      const double x[] = { a, -b, -1.0 + b }; // the unit square, turned by k quarters or not
      const double y[] = { b, a, -a };
      patch.ControlPoints(i, 0) = x[k];
      patch.ControlPoints(i, 1) = y[k];
    }
    body.Patches.push_back(patch);
  }
  body.Topology.Interfaces = FindInterfaces(body.Patches);
  return body;
}

/// As CornerProblem: 0 on the re-entrant sides, its flux elsewhere.
template <int Dim>
Result<GalerkinProblem> CornerOfPatches(const MultiPatch<Dim>&, const GalerkinSpace& space)
{
  GalerkinProblem problem;
  PrescribedValues held;
  FacetLoad load;
  const auto facets = BoundaryFacets(space);
  EXPECT_TRUE(facets) << facets.Status.Message();
  for (const CellSide& facet : facets.Value)
  {
    std::array<double, 3> u{ 0.5, 0.5, 0.5 };
    u[AcrossSide(facet.Side)] = facet.Side % 2;
    const Eigen::VectorXd x = EvaluateSolution(
      space, problem, PointMatrix::Zero(space.NumFunctions(), 1), facet.Cell, u.data())
                                .Position;
    const bool isInside =
      (std::abs(x[1]) < 1e-9 && x[0] > 0.0) || (std::abs(x[0]) < 1e-9 && x[1] < 0.0);
    (isInside ? held.Facets : load.Facets).push_back(facet);
  }
  load.Values = [](const double* x, const double* normal, double* flux)
  {
    std::array<double, 3> g{};
    CornerGradient(2)(x, g.data());
    flux[0] = g[0] * normal[0] + g[1] * normal[1];
  };
  problem.Prescribed.push_back(held);
  problem.Loads.push_back(load);
  return problem;
}

/// Largest distance of the solution from itself across interfaces, of points on them.
template <int Dim>
double LargestGap(const AdaptiveSolution<Dim>& result)
{
  double gap = 0.0;
  for (const PatchInterface& interface : result.Body.Topology.Interfaces)
  {
    for (int sample = 0; sample < 50; ++sample)
    {
      std::array<double, 2> values{};
      std::array<Eigen::VectorXd, 2> places;
      const std::array<double, 2> s{ (sample + 0.5) / 50, std::fmod(0.37 * sample, 1.0) };
      for (std::size_t k = 0; k < 2; ++k)
      {
        const PatchSide& side = interface.Sides[k];
        const SplineSpace<Dim>& space =
          *result.Body.Patches[static_cast<std::size_t>(side.Patch)].Space;
        std::array<double, Dim> u{};
        u[AcrossSide(side.Side)] = side.Side % 2;
        const auto directions = SideDirections<Dim>(side.Side);
        for (std::size_t d = 0; d < directions.size(); ++d)
        {
          const auto axis = static_cast<std::size_t>(interface.Orientation.Axis[d]);
          const double value = k == 0 ? s[d] : s[axis];
          u[directions[d]] = k == 1 && interface.Orientation.Reversed[d] ? 1.0 - value : value;
        }
        std::array<double, 3> local{};
        int element = space.Locate(u.data(), local.data());
        for (int p = 0; p < side.Patch; ++p)
        {
          element += result.Body.Patches[static_cast<std::size_t>(p)].Space->NumElements();
        }
        const GalerkinPoint point = EvaluateSolution(
          result.Space, result.Problem, result.Solution.Coefficients, element, local.data());
        values[k] = point.Value[0];
        places[k] = point.Position;
      }
      EXPECT_LE((places[0] - places[1]).norm(), 1e-12);
      gap = std::max(gap, std::abs(values[0] - values[1]));
    }
  }
  return gap;
}
}

// Three patches reach the order of one (of degree 3, above it as long as elements at the corner are
// many), and stay C^0 where elements are marked on one side alone.
TEST(AdaptiveSolution, CornerOfThreePatches_ExactOracle)
{
  for (const int p : { 2, 3 })
  {
    const MultiPatch<2> body = LShapeOfPatches<2>(p, 8);
    ASSERT_EQ(body.Topology.Interfaces.size(), 2U);
    AdaptiveParams params;
    params.MaxFunctions = p == 2 ? 12000 : 6000;
    const auto result = SolveAdaptively<2>(body, CornerOfPatches<2>, params);
    ASSERT_TRUE(result) << result.Status.Message();
    const double slope = Slope(CornerRows(result->History), 4);
    const double gap = LargestGap(result.Value);
    std::printf("[ patches  ] p %d: order %.3f in functions, gap %.1e\n", p, slope, gap);
    EXPECT_GE(slope, 0.5 * p - 0.15);
    EXPECT_LE(slope, p == 2 ? 1.15 : 3.0);
    EXPECT_LE(gap, 1e-12);
    for (const Spline<2>& patch : result->Body.Patches)
    {
      EXPECT_EQ(patch.Space->Kind, SpaceKind::Hierarchical);
    }
  }
}

TEST(AdaptiveSolution, EdgeOfThreePatches_PropertyOracle)
{
  const MultiPatch<3> body = LShapeOfPatches<3>(2, 2);
  AdaptiveParams params;
  params.MaxFunctions = 2000;
  const auto result = SolveAdaptively<3>(body, CornerOfPatches<3>, params);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_GE(result->History.size(), 5U);
  EXPECT_LE(LargestGap(result.Value), 1e-12);
  for (std::size_t i = 1; i < result->History.size(); ++i)
  {
    EXPECT_LT(result->History[i].Estimate, result->History[i - 1].Estimate);
  }
}

// One element inside a tensor-product mesh is too little for a function of degree 3 of the next
// level: a margin is added, and every step has more functions.
TEST(AdaptiveSolution, EveryStepMakesFunctions_PropertyOracle)
{
  AdaptiveParams params;
  params.Theta = 1e-6;
  params.MaxSteps = 4;
  const auto result = SolveAdaptively<2>(BentBox<2>(3, 9), Peak(), params);
  ASSERT_TRUE(result) << result.Status.Message();
  ASSERT_EQ(result->History.size(), 4u);
  EXPECT_EQ(result->History[0].Marked, 1);
  for (std::size_t i = 1; i < 4; ++i)
  {
    EXPECT_GT(result->History[i].Functions, result->History[i - 1].Functions);
  }
}

TEST(AdaptiveSolution, MarksTheLargest_ExactOracle)
{
  const std::vector<double> estimates{ 1.0, 3.0, 0.0, 2.0, 1.0 }; // squares 1, 9, 0, 4, 1 of 15
  EXPECT_EQ(MarkElements(estimates, 0.5), (std::vector<int>{ 1 }));
  EXPECT_EQ(MarkElements(estimates, 0.61), (std::vector<int>{ 1, 3 }));
  EXPECT_EQ(MarkElements(estimates, 0.9), (std::vector<int>{ 0, 1, 3, 4 })); // equals together
  EXPECT_EQ(MarkElements(estimates, 1.0), (std::vector<int>{ 0, 1, 3, 4 }));
  EXPECT_TRUE(MarkElements({ 0.0, 0.0 }, 0.5).empty());
}

// The body stays an L, and the history is that of the spaces.
TEST(AdaptiveSolution, MapStaysAndHistoryFits_PropertyOracle)
{
  AdaptiveParams params;
  params.MaxSteps = 4;
  const auto result = SolveAdaptively<2>(LShape<2>(3, 2), CornerProblem<2>, params);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Stop, AdaptiveStop::MaxSteps);
  ASSERT_EQ(result->History.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i)
  {
    EXPECT_LT(result->History[i].Functions, result->History[i + 1].Functions);
    EXPECT_LE(result->History[i].Energy, result->History[i + 1].Energy); // nested spaces
    EXPECT_GT(result->History[i].Marked, 0);
  }
  EXPECT_EQ(result->History.back().Marked, 0);
  EXPECT_EQ(result->History.back().Functions, result->Space.NumFunctions());
  EXPECT_EQ(result->Estimate.Total, result->History.back().Estimate);
  EXPECT_EQ(result->Solution.Coefficients.rows(), result->Space.NumFunctions());
  // the area of the L
  double area = 0.0;
  RuleTables tables(1e-15);
  for (int e = 0; e < result->Space.NumElements(); ++e)
  {
    tables.Visit(result->Space, e,
      [&](std::size_t q, const PointValues& at)
      { area += tables.Weights[q] * std::abs(at.Determinant); });
  }
  EXPECT_NEAR(area, 3.0, 1e-12);
}

TEST(AdaptiveSolution, EveryEndIsReachable)
{
  const Spline<2> spline = LShape<2>(2, 2);
  AdaptiveParams params;
  params.Tolerance = 0.05;
  auto result = SolveAdaptively<2>(spline, CornerProblem<2>, params);
  EXPECT_EQ(result->Stop, AdaptiveStop::Tolerance);
  EXPECT_LE(result->Estimate.Total, 0.05);
  EXPECT_GT(result->History[result->History.size() - 2].Estimate, 0.05);
  params.Tolerance = 0.0;
  params.MaxFunctions = 200;
  result = SolveAdaptively<2>(spline, CornerProblem<2>, params);
  EXPECT_EQ(result->Stop, AdaptiveStop::MaxFunctions);
  EXPECT_LE(result->Space.NumFunctions(), 200);
  params.Refinement.MaxLevel = 1;
  params.MaxFunctions = 100000;
  result = SolveAdaptively<2>(spline, CornerProblem<2>, params);
  EXPECT_EQ(result->Stop, AdaptiveStop::MaxLevel);
  params.MaxSteps = 1;
  result = SolveAdaptively<2>(spline, CornerProblem<2>, params);
  EXPECT_EQ(result->Stop, AdaptiveStop::MaxSteps);
  std::set<std::string> sentences;
  for (const AdaptiveStop stop : { AdaptiveStop::Tolerance, AdaptiveStop::MaxFunctions,
         AdaptiveStop::MaxSteps, AdaptiveStop::MaxLevel })
  {
    sentences.insert(ToString(stop));
  }
  EXPECT_EQ(sentences.size(), 4u);
}

TEST(AdaptiveSolution, EveryFailureIsReachable)
{
  const Spline<2> spline = LShape<2>(2, 2);
  const ProblemMaker<2> corner = CornerProblem<2>;
  const auto expect = [&](const Spline<2>& on, const ProblemMaker<2>& make,
                        const AdaptiveParams& params, ErrorCode code, const std::string& words)
  {
    const auto result = SolveAdaptively<2>(on, make, params);
    EXPECT_EQ(result.Status.Code, code) << result.Status.Message();
    EXPECT_NE(result.Status.Detail.find(words), std::string::npos) << result.Status.Message();
  };
  AdaptiveParams params;
  params.Theta = 0.0;
  expect(spline, corner, params, ErrorCode::InvalidParameter, "in (0, 1]");
  params = {};
  params.Tolerance = std::nan("");
  expect(spline, corner, params, ErrorCode::InvalidParameter, "tolerance");
  params = {};
  params.MaxSteps = 0;
  expect(spline, corner, params, ErrorCode::InvalidParameter, "steps");
  params = {};
  params.Refinement.AdmissibleClass = 1;
  expect(spline, corner, params, ErrorCode::InvalidParameter, "admissible class");
  params = {};
  expect(spline, {}, params, ErrorCode::InvalidParameter, "there is no problem");
  expect({}, corner, params, ErrorCode::DimensionMismatch, "refined by elements");
  EXPECT_EQ(
    SolveAdaptively<2>(MultiPatch<2>(), CornerOfPatches<2>).Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(RefineMarkedElements(LShapeOfPatches<2>(2, 2), { 12 }).Status.Code,
    ErrorCode::InvalidParameter);
  // what is refined on one side alone is no body
  MultiPatch<2> torn = LShapeOfPatches<2>(2, 4);
  torn.Patches[0] = RefineMarkedElements(torn.Patches[0], { 0, 1, 4, 5 })->Value;
  const auto apart = SolveAdaptively<2>(torn, CornerOfPatches<2>);
  EXPECT_EQ(apart.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(apart.Status.Detail.find("have other functions"), std::string::npos);
  expect(BentStar<2>(5, 2, 2), corner, params, ErrorCode::DimensionMismatch, "refined by elements");
  expect(
    spline, [](const Spline<2>&, const GalerkinSpace&) { return GalerkinProblem{}; }, params,
    ErrorCode::SingularSystem, "the constant");
  expect(
    spline,
    [](const Spline<2>&, const GalerkinSpace&) -> Result<GalerkinProblem> {
      return { ErrorCode::InvalidFormat, "no such load" };
    },
    params, ErrorCode::InvalidFormat, "no such load");
  for (const int calls : { 0, 5, 40 })
  {
    int left = calls;
    params.MaxSteps = 3;
    const auto result =
      SolveAdaptively<2>(spline, corner, params, [&left](double) { return left-- > 0; });
    EXPECT_EQ(static_cast<bool>(result), calls == 40);
    EXPECT_EQ(result.Status.Code == ErrorCode::Aborted, calls < 40);
  }
}
}
