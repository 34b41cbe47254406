// SPDX-License-Identifier: BSD-3-Clause
#include "ElementFacets.h"
#include "ElementSolution.h"
#include "EnergyError.h"
#include <knotwork/SplineAnalysis/ErrorEstimate.h>

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace knotwork::testing
{
namespace
{
/// The lower quarter (eighth) of a grid of n elements a direction.
std::vector<int> LowerCorner(int dimension, int n)
{
  std::vector<int> marked;
  for (int e = 0; e < (dimension == 2 ? n * n : n * n * n); ++e)
  {
    if (e % n < n / 2 && e / n % n < n / 2 && e / n / n < n / 2)
    {
      marked.push_back(e);
    }
  }
  return marked;
}

template <int Dim>
AnalysisCase RefinedCase(int degree, int n)
{
  return CaseOf<Dim>(
    "THB", RefineMarkedElements(BentBox<Dim>(degree, n), LowerCorner(Dim, n))->Value);
}

AnalysisCase LRCase(int degree, int n)
{
  return CaseOf<2>("LR", RefineMarkedLR(BentBox<2>(degree, n), LowerCorner(2, n))->Value);
}

AnalysisCase RingCase(int degree, int n)
{
  ShapeParams ring;
  ring.Kind = ShapeKind::AnnulusSector;
  ring.Degree = degree;
  ring.Elements = { n, n, 1 };
  return CaseOf<2>("rational", ShapePatches<2>(ring)[0]);
}

AnalysisCase DiscCase(int degree, int n)
{
  ShapeParams disc;
  disc.Kind = ShapeKind::Disc;
  disc.Degree = degree;
  disc.Elements = { n, n, 1 };
  return MultiPatchCase<2>("multi-patch", disc);
}

/// One of every family, coarse.
std::vector<AnalysisCase> AllCases()
{
  return { CaseOf<2>("tensor", BentBox<2>(3, 3)), RefinedCase<2>(2, 4), LRCase(2, 4),
    RingCase(3, 2), DiscCase(2, 2), CaseOf<2>("unstructured", BentStar<2>(5, 3, 2)),
    LagrangeCase(CellShape::Triangle, 1, 2), LagrangeCase(CellShape::Triangle, 3, 2),
    LagrangeCase(CellShape::Quadrilateral, 2, 2), CaseOf<3>("tensor 3", BentBox<3>(2, 2)),
    RefinedCase<3>(2, 4), LagrangeCase(CellShape::Tetrahedron, 2, 2),
    LagrangeCase(CellShape::Hexahedron, 2, 2) };
}

/// The Hessian of any coefficients against differences of the gradient along each parameter.
template <int Dim>
void ExpectHessians(const AnalysisCase& body)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  PointMatrix coefficients(body.Space.NumFunctions(), Dim);
  for (Eigen::Index i = 0; i < coefficients.size(); ++i)
  {
    coefficients.data()[i] = uniform(random);
  }
  for (int e = 0; e < body.Space.NumElements(); ++e)
  {
    const auto index = static_cast<std::size_t>(e);
    const std::array<double, 3> u{ 0.21, 0.34, 0.27 };
    const PointMatrix basis =
      BasisDerivatives(body.Space.Shapes[index], body.Space.Degrees[index], u.data(), 2);
    // the map as its own solution: x has the gradient 1 and no curvature
    const auto same = ElementSolution<Dim>(body.Space, body.Space.Points, e).At(basis, 2);
    const double scale = same.Inverse.norm();
    EXPECT_LE((same.Gradient - Eigen::MatrixXd::Identity(Dim, Dim)).norm(), 1e-12) << body.Name;
    const auto point = ElementSolution<Dim>(body.Space, coefficients, e).At(basis, 2);
    constexpr double step = 1e-4; // the error of differences is of its square
    for (std::size_t i = 0; i < Dim; ++i)
    {
      EXPECT_LE(same.Hessian[i].norm(), 1e-11 * scale) << body.Name;
      for (int d = 0; d < Dim; ++d)
      {
        std::array<Eigen::VectorXd, 2> gradients;
        for (const std::size_t end : { 0, 1 })
        {
          std::array<double, 3> moved = u;
          moved[static_cast<std::size_t>(d)] += end == 0 ? -step : step;
          gradients[end] = EvaluateSolution(body.Space, {}, coefficients, e, moved.data())
                             .Gradient.row(static_cast<Eigen::Index>(i))
                             .transpose();
        }
        const Eigen::VectorXd difference = (gradients[1] - gradients[0]) / (2.0 * step);
        const Eigen::VectorXd exact = point.Hessian[i] * point.Jacobian.col(d);
        EXPECT_LE((difference - exact).norm(), 2e-6 * (exact.norm() + scale)) << body.Name;
      }
    }
  }
}

/// Estimate over true error of plane waves.
double Ratio(const AnalysisCase& body, const PlaneWaves& waves, int degree, bool valuesAlone)
{
  const GalerkinProblem problem = waves.Problem(body.Boundary, valuesAlone);
  const auto solution = SolveGalerkin(body.Space, problem);
  EXPECT_TRUE(solution) << body.Name << ": " << solution.Status.Message();
  const auto estimate = EstimateError(body.Space, problem, solution->Coefficients);
  EXPECT_TRUE(estimate) << body.Name << ": " << estimate.Status.Message();
  const double error = EnergyError(body.Space, problem, solution->Coefficients, waves.Gradient());
  std::printf(
    "[ ratio    ] %-26s equation %d p %d %5d functions: %.3f (inside %.2f jumps %.2f loads "
    "%.2f values %.2f), error %.1e\n",
    body.Name.c_str(), static_cast<int>(waves.Equation), degree, body.Space.NumFunctions(),
    estimate->Total / error, estimate->Interior / error, estimate->Jumps / error,
    estimate->Loads / error, estimate->Values / error, error);
  return estimate->Total / error;
}

void ExpectRatio(const AnalysisCase& body, GalerkinEquation equation, int degree, bool valuesAlone)
{
  const PlaneWaves waves(equation, body.Space.Dimension, 3.0);
  const double ratio = Ratio(body, waves, degree, valuesAlone);
  EXPECT_GT(ratio, 0.5) << body.Name << " of degree " << degree;
  EXPECT_LT(ratio, 4.0) << body.Name << " of degree " << degree;
}

/// Squares side by side, n along x, with one bilinear element each.
GalerkinSpace SquaresInARow(int n)
{
  LagrangeMesh mesh;
  mesh.Nodes.resize(2 * (n + 1), 2);
  for (int i = 0; i <= n; ++i)
  {
    mesh.Nodes.row(2 * i) << i, 0.0;
    mesh.Nodes.row(2 * i + 1) << i, 1.0;
  }
  for (int i = 0; i < n; ++i)
  {
    mesh.Shapes.push_back(CellShape::Quadrilateral);
    mesh.Orders.push_back(1);
    mesh.NodeIds.insert(mesh.NodeIds.end(), { 2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 3 });
  }
  return MakeGalerkinSpace(mesh).Value;
}
}

TEST(ErrorEstimate, SecondDerivativesThroughCurvedMaps_CrossOracle)
{
  for (const AnalysisCase& body : AllCases())
  {
    body.Space.Dimension == 2 ? ExpectHessians<2>(body) : ExpectHessians<3>(body);
  }
}

// The area vectors of all facets of an element have the sum 0, and both elements of a facet have it
// at the same place.
TEST(ErrorEstimate, FacetsCloseElements_ExactOracle)
{
  for (const AnalysisCase& body : AllCases())
  {
    const auto facets = FindFacets(body.Space);
    ASSERT_TRUE(facets) << facets.Status.Message();
    EXPECT_EQ(facets->Boundary.size(), body.Boundary.size());
    PointMatrix sums = PointMatrix::Zero(body.Space.NumElements(), body.Space.Dimension);
    const auto add = [&](const CellSide& side, const FacetFrame& frame, double sign, int of)
    {
      const CellShape shape = body.Space.Shapes[static_cast<std::size_t>(side.Cell)];
      const CellShape facet = body.Space.Dimension == 2 ? CellShape::Curve
        : shape == CellShape::Tetrahedron               ? CellShape::Triangle
                                                        : CellShape::Quadrilateral;
      const CellRule rule = MakeCellRule(facet, 12);
      PointValues values;
      for (std::size_t q = 0; q < rule.Points.size(); ++q)
      {
        const auto u = frame.Point({ rule.Points[q][0], rule.Points[q][1] });
        EvaluateFunctions(body.Space, side.Cell, u.data(), values);
        sums.row(of) += sign * rule.Weights[q] * AreaVector(frame, values).transpose();
      }
    };
    for (const CellSide& side : facets->Boundary)
    {
      const CellShape shape = body.Space.Shapes[static_cast<std::size_t>(side.Cell)];
      add(side, MakeFacetFrame(shape, side.Side), 1.0, side.Cell);
    }
    for (const InnerFacet& facet : facets->Inner)
    {
      add(facet.Sides[0], facet.Frames[0], 1.0, facet.Sides[0].Cell);
      add(facet.Sides[0], facet.Frames[0], -1.0, facet.Sides[1].Cell);
      std::array<PointValues, 2> values;
      for (std::size_t s = 0; s < 2; ++s)
      {
        EvaluateFunctions(
          body.Space, facet.Sides[s].Cell, facet.Frames[s].Point({ 0.15, 0.6 }).data(), values[s]);
      }
      EXPECT_LE((values[0].Position - values[1].Position).norm(), 1e-12) << body.Name;
    }
    EXPECT_LE(sums.cwiseAbs().maxCoeff(), 1e-10) << body.Name;
  }
}

// The quadratic displacements (x^2, x y) on an affine box, with their tractions and force.
TEST(ErrorEstimate, ExactSolutionsLeaveNothing_ExactOracle)
{
  Spline<2> box = BentBox<2>(2, 4, 0.0);
  box = RefineMarkedElements(box, LowerCorner(2, 4))->Value;
  const AnalysisCase body = CaseOf<2>("box", box);
  GalerkinProblem problem;
  problem.Equation = GalerkinEquation::PlaneStrain;
  const LameConstants lame = MakeLameConstants(problem.Equation, problem.Materials[0]);
  problem.Source = [&](const double*, double* f)
  {
    // d/dx (l 3x + 4 m x) + d/dy (m y), d/dx (m y) + d/dy (l 3x + 2 m x)
    f[0] = -(3.0 * lame.First + 5.0 * lame.Shear);
    f[1] = 0.0;
  };
  const auto exact = [](const double* x, double* u)
  {
    u[0] = x[0] * x[0];
    u[1] = x[0] * x[1];
  };
  problem.Prescribed.resize(1);
  problem.Prescribed[0].Values = exact;
  FacetLoad load;
  load.Values = [&](const double* x, const double* n, double* t)
  {
    const double trace = 3.0 * lame.First * x[0];
    t[0] = (trace + 4.0 * lame.Shear * x[0]) * n[0] + lame.Shear * x[1] * n[1];
    t[1] = lame.Shear * x[1] * n[0] + (trace + 2.0 * lame.Shear * x[0]) * n[1];
  };
  for (const CellSide& facet : body.Boundary)
  {
    (facet.Side < 2 ? problem.Prescribed[0].Facets : load.Facets).push_back(facet);
  }
  problem.Loads.push_back(load);
  const auto solution = SolveGalerkin(body.Space, problem);
  ASSERT_TRUE(solution) << solution.Status.Message();
  const auto estimate = EstimateError(body.Space, problem, solution->Coefficients);
  ASSERT_TRUE(estimate) << estimate.Status.Message();
  EXPECT_LE(estimate->Total, 1e-12 * std::sqrt(2.0 * solution->Energy));
  problem.Source = {}; // and something is left of a wrong problem
  EXPECT_GT(EstimateError(body.Space, problem, solution->Coefficients)->Total, 0.1);
}

// Two unit squares of conductivity 2 and 6, u_h = 0 at x = 0, 1 at x = 1, 4 at x = 2, source 5.
// Flux 2 and 18: the jump 16 on a side of length 1; constants 1 / (4 pi^2), 0.1 and 1.
TEST(ErrorEstimate, PartsByHand_ExactOracle)
{
  const GalerkinSpace space = SquaresInARow(2);
  PointMatrix coefficients(6, 1);
  coefficients << 0, 0, 1, 1, 4, 4;
  GalerkinProblem problem;
  problem.Materials = { { 2.0, 1.0, 0.3 }, { 6.0, 1.0, 0.3 } };
  problem.MaterialIds = { 0, 1 };
  problem.Source = [](const double*, double* f) { f[0] = 5.0; };
  problem.Prescribed.push_back({ { { 0, 0 } }, -1, [](const double*, double* u) { u[0] = 0.5; } });
  problem.Loads.push_back(
    { { { 1, 1 } }, [](const double*, const double* n, double* g) { g[0] = 11.0 * n[0]; } });
  const auto estimate = EstimateError(space, problem, coefficients);
  ASSERT_TRUE(estimate) << estimate.Status.Message();
  const double pi = 4.0 * std::atan(1.0);
  const std::array<double, 2> interior{ 25.0 / 2.0 / (4 * pi * pi), 25.0 / 6.0 / (4 * pi * pi) };
  const double jump = 0.1 * 256.0 / 8.0; // of each element, over the sum of conductivities
  const double values = 2.0 * 0.25;      // conductivity times 0.5^2
  const double load = 0.1 * 49.0 / 6.0;  // 11 - 18
  EXPECT_NEAR(estimate->Interior, std::sqrt(interior[0] + interior[1]), 1e-13);
  EXPECT_NEAR(estimate->Jumps, std::sqrt(2.0 * jump), 1e-13);
  EXPECT_NEAR(estimate->Values, std::sqrt(values), 1e-13);
  EXPECT_NEAR(estimate->Loads, std::sqrt(load), 1e-13);
  EXPECT_NEAR(estimate->Elements[0], std::sqrt(interior[0] + jump + values), 1e-13);
  EXPECT_NEAR(estimate->Elements[1], std::sqrt(interior[1] + jump + load), 1e-13);
  // a source on the inner side that takes the jump: nothing is left there
  problem.Loads.push_back(
    { { { 0, 1 } }, [](const double*, const double*, double* g) { g[0] = -16.0; } });
  EXPECT_NEAR(EstimateError(space, problem, coefficients)->Jumps, 0.0, 1e-13);
}

TEST(ErrorEstimate, RatioToTrueError_ExactOracle)
{
  for (const GalerkinEquation equation :
    { GalerkinEquation::Poisson, GalerkinEquation::PlaneStress })
  {
    for (const int p : { 1, 2, 3, 4, 5 })
    {
      ExpectRatio(CaseOf<2>("tensor, values", BentBox<2>(p, 12)), equation, p, true);
      ExpectRatio(CaseOf<2>("tensor, loads", BentBox<2>(p, 12)), equation, p, false);
      ExpectRatio(RefinedCase<2>(p, 8), equation, p, false);
      ExpectRatio(LRCase(p, 8), equation, p, false);
      if (p > 1)
      {
        ExpectRatio(RingCase(p, 8), equation, p, false);
        ExpectRatio(DiscCase(p, 6), equation, p, true);
      }
      if (p == 2 || p == 3)
      {
        ExpectRatio(CaseOf<2>("unstructured", BentStar<2>(5, 6, p)), equation, p, true);
      }
      if (p < 5)
      {
        ExpectRatio(LagrangeCase(CellShape::Triangle, p, 6), equation, p, true);
        ExpectRatio(LagrangeCase(CellShape::Quadrilateral, p, 6), equation, p, true);
      }
    }
  }
  for (const GalerkinEquation equation : { GalerkinEquation::Poisson, GalerkinEquation::Solid })
  {
    for (const int p : { 1, 2, 3 })
    {
      ExpectRatio(CaseOf<3>("tensor 3", BentBox<3>(p, 4)), equation, p, false);
      ExpectRatio(RefinedCase<3>(p, p < 3 ? 4 : 2), equation, p, true);
    }
    for (const int p : { 1, 2 })
    {
      ExpectRatio(LagrangeCase(CellShape::Tetrahedron, p, 3), equation, p, true);
      ExpectRatio(LagrangeCase(CellShape::Hexahedron, p, 3), equation, p, true);
    }
  }
}

// What makes estimates worse: thin elements, and bodies that hardly change their volume, in motions
// that do and that do not.
TEST(ErrorEstimate, RatioOfHardCases_ExactOracle)
{
  for (const int p : { 1, 2, 3 })
  {
    for (const int stretch : { 4, 16 })
    {
      Spline<2> thin = BentBox<2>(p, 12, 0.0);
      thin.ControlPoints.col(1) /= stretch;
      const PlaneWaves waves(GalerkinEquation::Poisson, 2, 3.0);
      const double ratio =
        Ratio(CaseOf<2>("thin by " + std::to_string(stretch), thin), waves, p, false);
      EXPECT_GT(ratio, 0.2);
      EXPECT_LT(ratio, 5.0);
    }
    for (const double nu : { 0.3, 0.45, 0.49 })
    {
      for (const bool shear : { false, true })
      {
        PlaneWaves waves(GalerkinEquation::PlaneStrain, 2, 3.0);
        waves.Material.PoissonsRatio = nu;
        if (shear)
        {
          waves.Directions << 0.0, 3.0, 2.0, 0.0;
        }
        const std::string name = std::to_string(nu) + (shear ? " shear" : "");
        const double ratio = Ratio(CaseOf<2>(name, BentBox<2>(p, 12)), waves, p, false);
        EXPECT_GT(ratio, 0.2);
        EXPECT_LT(ratio, 5.0);
      }
    }
  }
}

TEST(ErrorEstimate, FluxJumpsBetweenMaterials_ExactOracle)
{
  // A flux of 1 through two layers: the gradient jumps where functions are C^1, which costs an
  // error of order 1/2, all of it at the layers' interface.
  for (const double conductivity : { 3.0, 100.0 })
  {
    for (AnalysisCase body :
      { CaseOf<2>("tensor", BentBox<2>(2, 8, 0.0)),
        CaseOf<2>("THB", RefineMarkedElements(BentBox<2>(2, 8, 0.0), LowerCorner(2, 8))->Value),
        CaseOf<2>("cubic", BentBox<2>(3, 8, 0.0)), CaseOf<3>("tensor 3", BentBox<3>(2, 4, 0.0)) })
    {
      SCOPED_TRACE(body.Name);
      GalerkinProblem problem;
      problem.Materials = { GalerkinMaterial{}, GalerkinMaterial{ conductivity } };
      for (int e = 0; e < body.Space.NumElements(); ++e)
      {
        const double middle[] = { 0.5, 0.5, 0.5 };
        PointValues values;
        EvaluateFunctions(body.Space, e, middle, values);
        problem.MaterialIds.push_back(values.Position[0] < 0.5 ? 0 : 1);
      }
      problem.Prescribed.push_back({ {}, -1, {} });
      FacetLoad load;
      for (const CellSide& facet : body.Boundary)
      {
        if (facet.Side == 0)
        {
          problem.Prescribed[0].Facets.push_back(facet);
        }
        if (facet.Side == 1)
        {
          load.Facets.push_back(facet);
        }
      }
      load.Values = [](const double*, const double*, double* flux) { flux[0] = 1.0; };
      problem.Loads.push_back(load);
      const auto solution = SolveGalerkin(body.Space, problem);
      ASSERT_TRUE(solution) << solution.Status.Message();
      const double error = EnergyError(body.Space, problem, solution->Coefficients,
        [&](const double* x, double* g)
        {
          std::fill_n(g, body.Space.Dimension, 0.0);
          g[0] = x[0] < 0.5 ? 1.0 : 1.0 / conductivity;
        });
      const auto estimate = EstimateError(body.Space, problem, solution->Coefficients);
      ASSERT_TRUE(estimate);
      std::printf("[ estimate ] %-10s layers 1 : %-3g: %.2f of the error\n", body.Name.c_str(),
        conductivity, estimate->Total / error);
      EXPECT_GT(estimate->Total, 0.2 * error);
      EXPECT_LT(estimate->Total, 5.0 * error);
    }
  }
}

TEST(ErrorEstimate, BitsDoNotDependOnThreads_PropertyOracle)
{
  const AnalysisCase body = RefinedCase<3>(2, 6);
  const PlaneWaves waves(GalerkinEquation::Solid, 3, 2.0);
  const GalerkinProblem problem = waves.Problem(body.Boundary, false);
  const auto solution = SolveGalerkin(body.Space, problem);
  ASSERT_TRUE(solution) << solution.Status.Message();
  const auto one = EstimateError(body.Space, problem, solution->Coefficients, 1);
  for (const int threads : { 2, 4 })
  {
    const auto more = EstimateError(body.Space, problem, solution->Coefficients, threads);
    ASSERT_EQ(one->Elements.size(), more->Elements.size());
    EXPECT_EQ(std::memcmp(
                one->Elements.data(), more->Elements.data(), one->Elements.size() * sizeof(double)),
      0);
    EXPECT_EQ(one->Total, more->Total);
  }
}

TEST(ErrorEstimate, EveryFailureIsReachable)
{
  const GalerkinSpace space = SquaresInARow(2);
  GalerkinProblem good;
  good.Prescribed.push_back({ { { 0, 0 } }, -1, {} });
  const PointMatrix zero = PointMatrix::Zero(6, 1);
  const auto expect = [&](const GalerkinProblem& problem, const PointMatrix& coefficients,
                        ErrorCode code, const std::string& words)
  {
    const auto estimate = EstimateError(space, problem, coefficients);
    EXPECT_EQ(estimate.Status.Code, code) << estimate.Status.Message();
    EXPECT_NE(estimate.Status.Detail.find(words), std::string::npos) << estimate.Status.Message();
  };
  EXPECT_TRUE(EstimateError(space, good, zero));
  expect(
    good, PointMatrix::Zero(5, 1), ErrorCode::SizeMismatch, "a row of coefficients a function");
  expect(good, PointMatrix::Zero(6, 2), ErrorCode::SizeMismatch, "a column a component");
  expect(good, PointMatrix::Constant(6, 1, std::nan("")), ErrorCode::NonFiniteInput, "coefficient");
  GalerkinProblem problem = good;
  problem.Source = [](const double*, double* f) { f[0] = std::nan(""); };
  expect(problem, zero, ErrorCode::NonFiniteInput, "a source, load or prescribed value");
  problem = good;
  problem.Materials.clear();
  expect(problem, zero, ErrorCode::EmptyInput, "no material");
  EXPECT_EQ(EstimateError({}, good, zero).Status.Code, ErrorCode::EmptyInput);
  for (const double limit : { 0.4, 0.9 })
  {
    const auto aborted =
      EstimateError(space, good, zero, 1, [limit](double done) { return done < limit; });
    EXPECT_EQ(aborted.Status.Code, ErrorCode::Aborted);
  }
  // three squares on one side
  LagrangeMesh mesh;
  mesh.Nodes.resize(8, 2);
  mesh.Nodes << 0, 0, 0, 1, 1, 0, 1, 1, -1, 0, -1, 1, 1, 0.5, 1, 1.5;
  mesh.Shapes.assign(3, CellShape::Quadrilateral);
  mesh.Orders.assign(3, 1);
  mesh.NodeIds = { 0, 2, 1, 3, 0, 4, 1, 5, 0, 6, 1, 7 };
  const auto estimate =
    EstimateError(MakeGalerkinSpace(mesh).Value, GalerkinProblem{}, PointMatrix::Zero(8, 1));
  EXPECT_EQ(estimate.Status.Code, ErrorCode::InvalidTopology) << estimate.Status.Message();
}
}
