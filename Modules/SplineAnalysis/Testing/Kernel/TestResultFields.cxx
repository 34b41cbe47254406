// SPDX-License-Identifier: BSD-3-Clause
// Stresses of states of constant stress, which every space has.
#include "AnalysisCases.h"
#include <knotwork/SplineAnalysis/ResultFields.h>

#include <gtest/gtest.h>

namespace knotwork::testing
{
namespace
{
/// u = (x, 0, 0) / 10 on all of the boundary.
void ExpectUniaxialStrain(const AnalysisCase& body, GalerkinEquation equation)
{
  GalerkinProblem problem;
  problem.Equation = equation;
  problem.Materials[0] = { 1.0, 130.0, 0.3 };
  const int n = body.Space.Dimension;
  problem.Prescribed.push_back({ body.Boundary, -1,
    [n](const double* x, double* u)
    {
      std::fill_n(u, n, 0.0);
      u[0] = 0.1 * x[0];
    } });
  const auto solution = SolveGalerkin(body.Space, problem);
  ASSERT_TRUE(solution) << solution.Status.Message();
  const auto fields =
    MakeResultFields(body.Space, problem, body.Boundary, solution->Coefficients, true, {});
  ASSERT_TRUE(fields) << fields.Status.Message();
  // shear modulus 50, Lame's first constant 75 (plate: 2 mu nu / (1 - nu))
  const double first = equation == GalerkinEquation::PlaneStress ? 30.0 / 0.7 : 75.0;
  const double along = 0.1 * (100.0 + first);
  const double across = 0.1 * first;
  const double third = equation == GalerkinEquation::PlaneStress ? 0.0 : across;
  const double mises = std::sqrt(0.5 *
    ((along - across) * (along - across) + (across - third) * (across - third) +
      (third - along) * (third - along)));
  Eigen::RowVectorXd row(10);
  row << along, across, third, 0.0, 0.0, 0.0, mises, along, across, third;
  const double rounding = 1e-10 * along;
  EXPECT_LE((fields->GaussValues.rowwise() - row).cwiseAbs().maxCoeff(), rounding) << body.Name;
  EXPECT_LE((fields->Projected.rowwise() - row).cwiseAbs().maxCoeff(), 100 * rounding) << body.Name;
  EXPECT_NEAR(fields->Energy.sum(), solution->Energy, 1e-10 * solution->Energy) << body.Name;
  const double largest = 0.1 * body.Space.Points.col(0).cwiseAbs().maxCoeff();
  EXPECT_LE(fields->LargestValue, largest * (1 + 1e-12));
  EXPECT_GE(fields->LargestValue, 0.9 * largest);
}
}

TEST(ResultFields, ConstantStress_ExactOracle)
{
  for (const auto equation : { GalerkinEquation::PlaneStress, GalerkinEquation::PlaneStrain })
  {
    ExpectUniaxialStrain(CaseOf<2>("tensor", BentBox<2>(2, 4)), equation);
    ExpectUniaxialStrain(CaseOf<2>("unstructured", BentStar<2>(5, 3, 2)), equation);
    ExpectUniaxialStrain(LagrangeCase(CellShape::Triangle, 2, 3), equation);
  }
  ExpectUniaxialStrain(CaseOf<3>("solid", BentBox<3>(2, 2)), GalerkinEquation::Solid);
  ExpectUniaxialStrain(LagrangeCase(CellShape::Tetrahedron, 2, 2), GalerkinEquation::Solid);
}

TEST(ResultFields, FluxOfALinearSolution_ExactOracle)
{
  const AnalysisCase body = CaseOf<2>("tensor", BentBox<2>(3, 3));
  GalerkinProblem problem;
  problem.Materials[0].Conductivity = 4.0;
  problem.Prescribed.push_back(
    { body.Boundary, -1, [](const double* x, double* u) { u[0] = 2.0 * x[0] - x[1]; } });
  const auto solution = SolveGalerkin(body.Space, problem);
  ASSERT_TRUE(solution);
  const auto fields =
    MakeResultFields(body.Space, problem, body.Boundary, solution->Coefficients, true, {});
  ASSERT_TRUE(fields);
  const Eigen::RowVector3d flux(8.0, -4.0, 0.0);
  EXPECT_LE((fields->Projected.rowwise() - flux).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(fields->LargestVonMises.size(), 0);
  EXPECT_EQ(MakeResultFields(body.Space, problem, body.Boundary, solution->Coefficients, true, {},
              [](double) { return false; })
              .Status.Code,
    ErrorCode::Aborted);
}

// Stresses are projected alike whatever the preconditioner and the number of threads.
TEST(ResultFields, BitsDoNotDependOnThreads_PropertyOracle)
{
  ShapeParams tube;
  tube.Kind = ShapeKind::SolidTube;
  tube.Elements = { 4, 6, 5 };
  tube.Degree = 2;
  for (AnalysisCase body :
    { CaseOf<3>("bent", BentBox<3>(2, 6)), CaseOf<3>("rational", ShapePatches<3>(tube)[0]),
      CaseOf<3>("THB", RefineMarkedElements(BentBox<3>(2, 4), { 0, 1 })->Value) })
  {
    SCOPED_TRACE(body.Name);
    GalerkinProblem problem;
    problem.Equation = GalerkinEquation::Solid;
    const PointMatrix coefficients = body.Space.Points.array().sin().matrix();
    GalerkinParams params;
    params.Threads = 1;
    const auto one =
      MakeResultFields(body.Space, problem, body.Boundary, coefficients, false, params);
    ASSERT_TRUE(one) << one.Status.Message();
    params.Threads = 3;
    const auto more =
      MakeResultFields(body.Space, problem, body.Boundary, coefficients, false, params);
    EXPECT_TRUE(one->Projected == more->Projected);
    EXPECT_TRUE(one->Energy == more->Energy);
    // without knots Gauss-Seidel is the preconditioner
    body.Space.Knots.clear();
    const auto other =
      MakeResultFields(body.Space, problem, body.Boundary, coefficients, false, params);
    ASSERT_TRUE(other) << other.Status.Message();
    EXPECT_LE((one->Projected - other->Projected).cwiseAbs().maxCoeff(),
      1e-10 * one->Projected.cwiseAbs().maxCoeff());
  }
}

TEST(ResultFields, FacetsAreMeasured_ExactOracle)
{
  ShapeParams ring;
  ring.Kind = ShapeKind::AnnulusSector;
  ring.Degree = 2;
  ring.Elements = { 2, 3, 1 };
  const AnalysisCase body = CaseOf<2>("ring", ShapePatches<2>(ring)[0]);
  double radii[2] = { 1e300, 0.0 };
  for (Eigen::Index i = 0; i < body.Space.Points.rows(); ++i)
  {
    // ends of the sector lie on the axes
    if (std::abs(body.Space.Points(i, 1)) < 1e-12)
    {
      radii[0] = std::min(radii[0], body.Space.Points(i, 0));
      radii[1] = std::max(radii[1], body.Space.Points(i, 0));
    }
  }
  const double quarter = 2.0 * std::atan(1.0);
  EXPECT_NEAR(FacetMeasure(body.Space, body.Boundary),
    quarter * (radii[0] + radii[1]) + 2.0 * (radii[1] - radii[0]), 1e-8);
}
}
