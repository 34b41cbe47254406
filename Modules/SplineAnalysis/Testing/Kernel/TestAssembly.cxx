// SPDX-License-Identifier: BSD-3-Clause
#include "../../Kernel/ElementRule.h"
#include "../../Kernel/StiffnessMatrix.h"
#include "AnalysisCases.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <iterator>

namespace knotwork::testing
{
namespace
{
/// The matrix point by point from single values of functions, without tables or blocks.
Eigen::MatrixXd PlainStiffness(const GalerkinSpace& space, const GalerkinProblem& problem)
{
  const int n = space.Dimension;
  const int components = NumSolutionComponents(problem.Equation);
  const LameConstants lame = MakeLameConstants(problem.Equation, problem.Materials[0]);
  const Eigen::Index size = Eigen::Index{ space.NumFunctions() } * components;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  PointValues values;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const CellRule rule =
      MakeCellRule(space.Shapes[static_cast<std::size_t>(e)], NumRulePoints(space, e, 1e-15));
    for (std::size_t q = 0; q < rule.Points.size(); ++q)
    {
      EvaluateFunctions(space, e, rule.Points[q].data(), values);
      const double volume = rule.Weights[q] * std::abs(values.Determinant);
      for (int a = 0; a < space.NumAlive(e); ++a)
      {
        for (int b = 0; b < space.NumAlive(e); ++b)
        {
          const Eigen::VectorXd ga = values.Gradients.row(a);
          const Eigen::VectorXd gb = values.Gradients.row(b);
          Eigen::MatrixXd block = Eigen::MatrixXd::Constant(1, 1, ga.dot(gb));
          if (components > 1)
          {
            block = lame.First * ga * gb.transpose() + lame.Shear * gb * ga.transpose() +
              lame.Shear * ga.dot(gb) * Eigen::MatrixXd::Identity(n, n);
          }
          matrix.block(Eigen::Index{ space.Alive(e)[a] } * components,
            Eigen::Index{ space.Alive(e)[b] } * components, components, components) +=
            volume * block;
        }
      }
    }
  }
  return matrix;
}

void ExpectSameMatrix(const GalerkinSpace& space, GalerkinEquation equation)
{
  GalerkinProblem problem;
  problem.Equation = equation;
  problem.Materials[0] = { 1.0, 2.5, 0.3 };
  const auto matrix = AssembleStiffness(space, problem, {}, {});
  ASSERT_TRUE(matrix) << matrix.Status.Message();
  const Eigen::MatrixXd plain = PlainStiffness(space, problem);
  const Eigen::MatrixXd lower = matrix.Value;
  EXPECT_TRUE(matrix.Value.isCompressed());
  EXPECT_EQ(lower.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().norm(), 0.0);
  // rounding of sums of some hundred terms
  EXPECT_LE((lower - Eigen::MatrixXd(plain.triangularView<Eigen::Lower>())).cwiseAbs().maxCoeff(),
    1e-13 * plain.cwiseAbs().maxCoeff());
}

template <int Dim>
std::vector<GalerkinSpace> Spaces()
{
  ShapeParams ring;
  ring.Kind = Dim == 2 ? ShapeKind::AnnulusSector : ShapeKind::SolidTube;
  ring.Elements = { 1, 2, 1 };
  ring.Degree = 2;
  std::vector<GalerkinSpace> spaces{ MakeGalerkinSpace(BentBox<Dim>(2, 3)).Value,
    MakeGalerkinSpace(BentBox<Dim>(Dim == 2 ? 4 : 1, 2)).Value,
    MakeGalerkinSpace(RefineMarkedElements(BentBox<Dim>(2, 3), { 0 })->Value).Value,
    MakeGalerkinSpace(ShapePatches<Dim>(ring)[0]).Value,
    LagrangeCase(Dim == 2 ? CellShape::Triangle : CellShape::Tetrahedron, 2, 1).Space,
    LagrangeCase(Dim == 2 ? CellShape::Quadrilateral : CellShape::Hexahedron, 2, 2).Space };
  if constexpr (Dim == 2)
  {
    spaces.push_back(MakeGalerkinSpace(BentStar<2>(5, 3, 3)).Value);
    spaces.push_back(MakeGalerkinSpace(RefineMarkedLR(BentBox<2>(2, 4), { 5 })->Value).Value);
  }
  return spaces;
}
}

TEST(Assembly, EveryFamilyHasTheMatrixOfPlainLoops_CrossOracle)
{
  for (const GalerkinSpace& space : Spaces<2>())
  {
    SCOPED_TRACE("functions in the plane: " + std::to_string(space.NumFunctions()));
    ExpectSameMatrix(space, GalerkinEquation::Poisson);
    ExpectSameMatrix(space, GalerkinEquation::PlaneStrain);
  }
  for (const GalerkinSpace& space : Spaces<3>())
  {
    SCOPED_TRACE("functions in space: " + std::to_string(space.NumFunctions()));
    ExpectSameMatrix(space, GalerkinEquation::Poisson);
    ExpectSameMatrix(space, GalerkinEquation::Solid);
  }
}

TEST(Assembly, BitsDoNotDependOnThreads_PropertyOracle)
{
  GalerkinProblem problem;
  problem.Equation = GalerkinEquation::Solid;
  for (const GalerkinSpace& space :
    { MakeGalerkinSpace(BentBox<3>(2, 7)).Value, LagrangeCase(CellShape::Hexahedron, 2, 4).Space })
  {
    GalerkinParams params;
    params.Threads = 1;
    const auto one = AssembleStiffness(space, problem, params, {});
    for (const int threads : { 2, 3, 0 })
    {
      params.Threads = threads;
      const auto more = AssembleStiffness(space, problem, params, {});
      ASSERT_EQ(one->nonZeros(), more->nonZeros());
      EXPECT_EQ(std::memcmp(one->valuePtr(), more->valuePtr(),
                  static_cast<std::size_t>(one->nonZeros()) * sizeof(double)),
        0);
    }
  }
}

TEST(LinearSolver, ConjugateGradientsFindWhatTheFactorFinds_CrossOracle)
{
  std::vector<AnalysisCase> bodies{ CaseOf<3>("tensor", BentBox<3>(2, 8)),
    CaseOf<3>("THB", RefineMarkedElements(BentBox<3>(2, 5), { 0, 1 })->Value),
    CaseOf<3>("unstructured", BentStar<3>(5, 4, 2)), CaseOf<2>("plane", BentBox<2>(3, 20)),
    LagrangeCase(CellShape::Tetrahedron, 2, 4) };
  for (const AnalysisCase& body : bodies)
  {
    SCOPED_TRACE(body.Name);
    for (const bool elastic : { false, true })
    {
      const int n = body.Space.Dimension;
      GalerkinProblem problem;
      if (elastic)
      {
        problem.Equation = n == 2 ? GalerkinEquation::PlaneStrain : GalerkinEquation::Solid;
      }
      problem.Source = [&](const double*, double* f) { std::fill_n(f, elastic ? n : 1, 1.0); };
      // a part of the boundary: of a THB space a whole side, where its traces are independent
      std::vector<CellSide> held(body.Boundary.begin(),
        body.Boundary.begin() + static_cast<std::ptrdiff_t>(body.Boundary.size() / 3));
      if (body.Name == "THB")
      {
        held.clear();
        std::copy_if(body.Boundary.begin(), body.Boundary.end(), std::back_inserter(held),
          [](const CellSide& facet) { return facet.Side == 0; });
      }
      problem.Prescribed.push_back({ held, -1, {} });
      GalerkinParams params;
      const auto factorized = SolveGalerkin(body.Space, problem, params);
      ASSERT_TRUE(factorized) << factorized.Status.Message();
      EXPECT_EQ(factorized->Preconditioner, "");
      params.DirectLimit = 0;
      params.Threads = 1;
      const auto iterated = SolveGalerkin(body.Space, problem, params);
      ASSERT_TRUE(iterated) << iterated.Status.Message();
      EXPECT_EQ(iterated->Preconditioner,
        body.Space.Knots.empty() ? "Gauss-Seidel and constants of cells" : "fast diagonalization");
      // residual 1e-12 times the condition of the matrix
      EXPECT_LE((iterated->Coefficients - factorized->Coefficients).cwiseAbs().maxCoeff(),
        1e-8 * factorized->Coefficients.cwiseAbs().maxCoeff());
      for (const int threads : { 2, 3 })
      {
        params.Threads = threads;
        const auto more = SolveGalerkin(body.Space, problem, params);
        EXPECT_EQ(std::memcmp(iterated->Coefficients.data(), more->Coefficients.data(),
                    static_cast<std::size_t>(iterated->Coefficients.size()) * sizeof(double)),
          0);
      }
      std::printf("[ iterate  ] %-30s %s %5d unknowns, %3d iterations\n", body.Name.c_str(),
        elastic ? "elasticity" : "Poisson   ", iterated->Unknowns, iterated->Iterations);
    }
  }
}

// The spectrum of what fast diagonalization leaves depends on the map, not on the mesh: Sangalli,
// Tani, SIAM J. Sci. Comput. 38 (2016), section 4.
TEST(LinearSolver, FastDiagonalizationDoesNotDependOnTheMesh_PropertyOracle)
{
  std::vector<int> iterations;
  for (const double size : { 0.0, 0.1 })
  {
    for (const int n : { 8, 16 })
    {
      const AnalysisCase body = CaseOf<3>("box", BentBox<3>(2, n, size));
      GalerkinProblem problem;
      problem.Source = [](const double*, double* f) { f[0] = 1.0; };
      problem.Prescribed.push_back({ body.Boundary, -1, {} });
      GalerkinParams params;
      params.DirectLimit = 0;
      params.Tolerance = 1e-10;
      const auto solution = SolveGalerkin(body.Space, problem, params);
      ASSERT_TRUE(solution) << solution.Status.Message();
      EXPECT_LE(solution->Residual, 1.1e-10);
      iterations.push_back(solution->Iterations);
    }
  }
  EXPECT_EQ(iterations[0], 1); // the matrix itself
  EXPECT_EQ(iterations[1], 1);
  EXPECT_LE(std::abs(iterations[2] - iterations[3]), 2);
}
}
