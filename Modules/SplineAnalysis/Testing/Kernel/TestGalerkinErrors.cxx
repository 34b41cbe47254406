// SPDX-License-Identifier: BSD-3-Clause
#include "AnalysisCases.h"

#include <gtest/gtest.h>

namespace knotwork::testing
{
namespace
{
void ExpectRefused(const GalerkinSpace& space, const GalerkinProblem& problem, ErrorCode code,
  const std::string& words, const GalerkinParams& params = {})
{
  const auto solution = SolveGalerkin(space, problem, params);
  EXPECT_EQ(solution.Status.Code, code) << solution.Status.Message();
  EXPECT_NE(solution.Status.Detail.find(words), std::string::npos) << solution.Status.Message();
}
}

TEST(Galerkin, MotionsThatAreLeftAreNamed_ExactOracle)
{
  const AnalysisCase plane = CaseOf<2>("plane", BentBox<2>(2, 3));
  GalerkinProblem problem;
  ExpectRefused(plane.Space, problem, ErrorCode::SingularSystem, "the constant");
  problem.Equation = GalerkinEquation::PlaneStress;
  ExpectRefused(plane.Space, problem, ErrorCode::SingularSystem,
    "translation along x, translation along y, rotation in the plane");
  problem.Supports.push_back({ 0, 0, 0.0 });
  problem.Supports.push_back({ 0, 1, 0.0 });
  ExpectRefused(plane.Space, problem, ErrorCode::SingularSystem, "against rotation in the plane");
  problem.Supports.push_back({ plane.Space.NumFunctions() - 1, 1, 0.0 });
  EXPECT_TRUE(SolveGalerkin(plane.Space, problem));

  const AnalysisCase solid = CaseOf<3>("solid", BentBox<3>(2, 2, 0.0));
  problem.Equation = GalerkinEquation::Solid;
  problem.Supports.clear();
  ExpectRefused(solid.Space, problem, ErrorCode::SingularSystem, "rotation about");
  // a side that may slide: x and y free, no turn about them
  problem.Prescribed.push_back({ { solid.Boundary.end() - 4, solid.Boundary.end() }, 2, {} });
  ExpectRefused(solid.Space, problem, ErrorCode::SingularSystem,
    "against translation along x, translation along y, rotation about z;");
}

TEST(Galerkin, FoldedElementsAreRefused_ExactOracle)
{
  Spline<2> spline = BentBox<2>(2, 3);
  spline.ControlPoints.row(12) << 3.0, 3.0;
  AnalysisCase folded = CaseOf<2>("folded", spline);
  GalerkinProblem problem;
  problem.Prescribed.push_back({ folded.Boundary, -1, {} });
  ExpectRefused(folded.Space, problem, ErrorCode::InvalidTopology, "at local parameters");
}

// On a coarse facet beside fine ones more functions of a THB space live than its polynomials have
// dimensions: what is prescribed there alone does not say what they are.
TEST(Galerkin, DependentTracesAreRefused_ExactOracle)
{
  const Spline<2> spline = RefineMarkedElements(BentBox<2>(2, 4), { 0, 1, 5 })->Value;
  const AnalysisCase body = CaseOf<2>("THB", spline);
  int refused = 0;
  for (const CellSide& facet : body.Boundary)
  {
    GalerkinProblem problem;
    problem.Prescribed.push_back(
      { { facet }, -1, [](const double* x, double* u) { u[0] = x[0]; } });
    const auto solution = SolveGalerkin(body.Space, problem);
    // rows of the operator that are not 0 on the side: Bernstein polynomials 3 j + i
    constexpr int columns[4][3] = { { 0, 3, 6 }, { 2, 5, 8 }, { 0, 1, 2 }, { 6, 7, 8 } };
    int functions = 0;
    for (int a = 0; a < body.Space.NumAlive(facet.Cell); ++a)
    {
      const double* row = body.Space.Operator(facet.Cell) + 9 * a;
      functions += std::any_of(columns[facet.Side], columns[facet.Side] + 3,
        [row](int column) { return row[column] != 0.0; });
    }
    EXPECT_EQ(static_cast<bool>(solution), functions == 3) << solution.Status.Message();
    refused += solution.Status.Code == ErrorCode::SingularSystem ? 1 : 0;
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, static_cast<int>(body.Boundary.size()));
}

TEST(Galerkin, LimitsOfTheSolver_PropertyOracle)
{
  // few iterations
  const AnalysisCase body = CaseOf<2>("plane", BentBox<2>(2, 8));
  GalerkinProblem problem;
  problem.Source = [](const double*, double* f) { f[0] = 1.0; };
  problem.Prescribed.push_back({ body.Boundary, -1, {} });
  GalerkinParams params;
  params.DirectLimit = 0;
  params.MaxIterations = 2;
  ExpectRefused(body.Space, problem, ErrorCode::NotConverged, "after 2 iterations", params);
  params.MaxIterations = 0;
  ExpectRefused(body.Space, problem, ErrorCode::InvalidParameter, "at least 1", params);
  // few entries: some 8 x 8 functions of degree 2 with about 13 each in the lower triangle
  params = {};
  params.MaxEntries = 100;
  ExpectRefused(body.Space, problem, ErrorCode::TooLarge, "entries", params);
  params.MaxEntries = 2000;
  EXPECT_TRUE(SolveGalerkin(body.Space, problem, params));
}

TEST(Galerkin, EveryFailureIsReachable)
{
  const AnalysisCase body = CaseOf<2>("plane", BentBox<2>(2, 3));
  GalerkinProblem good;
  good.Prescribed.push_back({ body.Boundary, -1, {} });
  EXPECT_TRUE(SolveGalerkin(body.Space, good));

  GalerkinProblem problem = good;
  problem.Equation = GalerkinEquation::Solid;
  ExpectRefused(body.Space, problem, ErrorCode::DimensionMismatch, "solids");
  problem = good;
  problem.Prescribed[0].Facets.clear();
  ExpectRefused(body.Space, problem, ErrorCode::InvalidParameter, "selects no facets");
  problem = good;
  problem.Prescribed.push_back(good.Prescribed[0]);
  ExpectRefused(body.Space, problem, ErrorCode::InvalidParameter, "prescribed twice");
  problem = good;
  problem.Prescribed[0].Component = 1;
  ExpectRefused(body.Space, problem, ErrorCode::InvalidParameter, "no component 1");
  problem = good;
  problem.Prescribed[0].Facets[0].Side = 4;
  ExpectRefused(body.Space, problem, ErrorCode::InvalidParameter, "does not exist");
  problem = good;
  problem.Prescribed[0].Values = [](const double*, double* u) { u[0] = std::nan(""); };
  ExpectRefused(body.Space, problem, ErrorCode::NonFiniteInput, "no number");
  problem = good;
  problem.Source = [](const double*, double* f) { f[0] = std::nan(""); };
  ExpectRefused(body.Space, problem, ErrorCode::NonFiniteInput, "no number");
  problem = good;
  problem.Loads.push_back({ body.Boundary, {} });
  ExpectRefused(body.Space, problem, ErrorCode::InvalidParameter, "has no values");
  problem = good;
  problem.Materials[0].Conductivity = 0.0;
  ExpectRefused(body.Space, problem, ErrorCode::InvalidParameter, "material 0");
  problem = good;
  problem.Materials.clear();
  ExpectRefused(body.Space, problem, ErrorCode::EmptyInput, "no material");
  problem = good;
  problem.MaterialIds = { 0 };
  ExpectRefused(body.Space, problem, ErrorCode::SizeMismatch, "one material id");
  problem.MaterialIds.assign(9, 1);
  ExpectRefused(body.Space, problem, ErrorCode::InvalidParameter, "does not exist");
  problem = good;
  problem.Supports.push_back({ -1, 0, 0.0 });
  ExpectRefused(body.Space, problem, ErrorCode::InvalidParameter, "support 0");
  problem = good;
  problem.PointLoads.push_back({ 0, 1, 0.0 });
  ExpectRefused(body.Space, problem, ErrorCode::InvalidParameter, "point load 0");
  problem = good;
  problem.EdgeLoads.push_back({ { { 0, {} } }, [](const double*, double* f) { f[0] = 1.0; } });
  ExpectRefused(body.Space, problem, ErrorCode::InvalidParameter, "body in space");
  const AnalysisCase solid = CaseOf<3>("solid", BentBox<3>(2, 2));
  problem.Prescribed[0].Facets = solid.Boundary;
  problem.EdgeLoads[0].Edges[0].Cell = 8;
  ExpectRefused(solid.Space, problem, ErrorCode::InvalidParameter, "element 8 does not exist");
  ExpectRefused({}, good, ErrorCode::EmptyInput, "no elements");
  GalerkinParams params;
  params.Tolerance = 0.0;
  ExpectRefused(body.Space, good, ErrorCode::InvalidParameter, "tolerances", params);
  const auto aborted = SolveGalerkin(body.Space, good, {}, [](double) { return false; });
  EXPECT_EQ(aborted.Status.Code, ErrorCode::Aborted);

  EXPECT_EQ(MakeGalerkinSpace(LagrangeMesh{}).Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(MakeGalerkinSpace(MultiPatch<2>{}).Status.Code, ErrorCode::EmptyInput);
  LagrangeMesh mesh;
  mesh.Nodes = PointMatrix::Zero(3, 2);
  mesh.Shapes = { CellShape::Triangle };
  EXPECT_EQ(MakeGalerkinSpace(mesh).Status.Code, ErrorCode::SizeMismatch);
  mesh.Orders = { 1 };
  EXPECT_EQ(MakeGalerkinSpace(mesh).Status.Code, ErrorCode::SizeMismatch);
  mesh.NodeIds = { 0, 1, 3 };
  EXPECT_EQ(MakeGalerkinSpace(mesh).Status.Code, ErrorCode::InvalidTopology);
  mesh.Orders = { 10 };
  EXPECT_EQ(MakeGalerkinSpace(mesh).Status.Code, ErrorCode::InvalidDegree);
  mesh.Shapes = { CellShape::Wedge };
  EXPECT_EQ(MakeGalerkinSpace(mesh).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_EQ(FacetsOfSide(*BentBox<2>(2, 2).Space, 4).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(FacetsOfSide(*BentStar<2>(5, 3, 2).Space, 0).Status.Code, ErrorCode::DimensionMismatch);
}
}
