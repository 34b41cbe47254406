// SPDX-License-Identifier: BSD-3-Clause
#include "AnalysisCases.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace knotwork::testing
{
namespace
{
template <int Dim>
std::vector<AnalysisCase> SplineCases()
{
  std::vector<AnalysisCase> cases;
  cases.push_back(CaseOf<Dim>("tensor 2", BentBox<Dim>(2, 3)));
  cases.push_back(CaseOf<Dim>("tensor 3", BentBox<Dim>(3, 3)));
  cases.push_back(
    CaseOf<Dim>("THB 2", RefineMarkedElements(BentBox<Dim>(2, 4), { 0, 1, 5 })->Value));
  ShapeParams ring;
  ring.Kind = Dim == 2 ? ShapeKind::AnnulusSector : ShapeKind::SolidTube;
  ring.Elements = { 2, 4, 2 };
  ring.Degree = 2;
  const Spline<Dim> rational = ShapePatches<Dim>(ring)[0];
  cases.push_back(CaseOf<Dim>("rational", rational));
  cases.push_back(CaseOf<Dim>("rational THB", RefineMarkedElements(rational, { 0, 1 })->Value));
  ShapeParams disc;
  disc.Kind = Dim == 2 ? ShapeKind::Disc : ShapeKind::SolidCylinder;
  disc.Elements = { 2, 2, 1 };
  disc.Degree = 2;
  cases.push_back(MultiPatchCase<Dim>("multi-patch, rational", disc));
  cases.push_back(CaseOf<Dim>("unstructured 2", BentStar<Dim>(5, 3, 2)));
  cases.push_back(CaseOf<Dim>("unstructured 3", BentStar<Dim>(3, 3, Dim == 2 ? 3 : 2)));
  if constexpr (Dim == 2)
  {
    cases.push_back(CaseOf<2>("LR", RefineMarkedLR(BentBox<2>(2, 5), { 6, 12 })->Value));
    cases.push_back(CaseOf<2>("rational LR", RefineMarkedLR(rational, { 1 })->Value));
  }
  return cases;
}

std::vector<AnalysisCase> LagrangeCases(int dimension)
{
  std::vector<AnalysisCase> cases;
  for (int order = 1; order <= 3; ++order)
  {
    for (const CellShape shape : { dimension == 2 ? CellShape::Triangle : CellShape::Tetrahedron,
           dimension == 2 ? CellShape::Quadrilateral : CellShape::Hexahedron })
    {
      cases.push_back(LagrangeCase(shape, order, 2));
    }
  }
  return cases;
}

/// Displacements of constant gradient, prescribed on facets whose middle is on the left; the
/// tractions of their constant stress elsewhere.
void ExpectConstantStress(const AnalysisCase& body, GalerkinEquation equation)
{
  SCOPED_TRACE(body.Name);
  ASSERT_GT(body.Space.NumElements(), 0);
  ASSERT_FALSE(body.Boundary.empty());
  const int n = body.Space.Dimension;
  GalerkinProblem problem;
  problem.Equation = equation;
  problem.Materials[0] = { 1.7, 2.5, 0.3 };
  const int components = equation == GalerkinEquation::Poisson ? 1 : n;
  Eigen::MatrixXd slope(components, n);
  for (int i = 0; i < components; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      slope(i, j) = 0.3 * (i + 1) - 0.2 * j * (i == 1 ? -1.0 : 1.0);
    }
  }
  const auto displacement = [&](const double* x, double* u)
  {
    Eigen::Map<Eigen::VectorXd>(u, components) = slope * Eigen::Map<const Eigen::VectorXd>(x, n);
    u[0] += 0.7;
  };
  // Hooke's law, written apart from the code that is tested
  const double young = 2.5;
  const double nu = 0.3;
  Eigen::MatrixXd stress = Eigen::MatrixXd::Zero(components, n);
  if (equation == GalerkinEquation::Poisson)
  {
    stress = 1.7 * slope;
  }
  else
  {
    const Eigen::MatrixXd strain = 0.5 * (slope + slope.transpose());
    const double factor =
      equation == GalerkinEquation::PlaneStress ? nu / (1.0 - nu) : nu / (1.0 - 2.0 * nu);
    stress =
      young / (1.0 + nu) * (strain + factor * strain.trace() * Eigen::MatrixXd::Identity(n, n));
  }
  PrescribedValues held;
  held.Values = displacement;
  FacetLoad load;
  load.Values = [&](const double*, const double* normal, double* traction)
  {
    Eigen::Map<Eigen::VectorXd>(traction, components) =
      stress * Eigen::Map<const Eigen::VectorXd>(normal, n);
  };
  for (std::size_t i = 0; i < body.Boundary.size(); ++i)
  {
    (i < body.Boundary.size() / 3 ? held.Facets : load.Facets).push_back(body.Boundary[i]);
  }
  problem.Prescribed.push_back(held);
  problem.Loads.push_back(load);
  const auto solution = SolveGalerkin(body.Space, problem);
  ASSERT_TRUE(solution) << solution.Status.Message();
  double valueError = 0.0;
  double stressError = 0.0;
  for (int e = 0; e < body.Space.NumElements(); ++e)
  {
    for (const double t : { 0.05, 0.3 })
    {
      const std::array<double, 3> u{ t, 0.2, 0.4 };
      const GalerkinPoint point =
        EvaluateSolution(body.Space, problem, solution.Value.Coefficients, e, u.data());
      Eigen::VectorXd exact(components);
      displacement(point.Position.data(), exact.data());
      valueError = std::max(valueError, (point.Value - exact).norm());
      stressError = std::max(stressError,
        equation == GalerkinEquation::Poisson ? (1.7 * point.Gradient - stress).norm()
                                              : (point.Stress.topLeftCorner(n, n) - stress).norm());
    }
  }
  EXPECT_LE(valueError, 1e-11);
  EXPECT_LE(stressError, 1e-11);
  EXPECT_LE((solution.Value.TotalLoad + solution.Value.TotalReaction).norm(), 1e-10);
  std::printf(
    "[ patch    ] %-28s u %.1e stress %.1e\n", body.Name.c_str(), valueError, stressError);
}
}

namespace
{
/// Of a spline with a domain the boundary's facets are those of all sides of the domain.
template <int Dim>
void ExpectFacetsOfAllSides(const Spline<Dim>& spline)
{
  std::vector<std::array<int, 2>> expected;
  for (int side = 0; side < 2 * Dim; ++side)
  {
    for (const CellSide& facet : FacetsOfSide(*spline.Space, side).Value)
    {
      expected.push_back({ facet.Cell, facet.Side });
    }
  }
  std::sort(expected.begin(), expected.end());
  std::vector<std::array<int, 2>> found;
  for (const CellSide& facet : BoundaryFacets(MakeGalerkinSpace(spline).Value).Value)
  {
    found.push_back({ facet.Cell, facet.Side });
  }
  EXPECT_EQ(found, expected);
}
}

TEST(GalerkinSpace, SidesBetweenLevelsAreNoBoundary_CrossOracle)
{
  ExpectFacetsOfAllSides(BentBox<2>(2, 3));
  ExpectFacetsOfAllSides(RefineMarkedElements(BentBox<2>(2, 4), { 0, 1, 5 })->Value);
  ExpectFacetsOfAllSides(RefineMarkedElements(BentBox<3>(2, 3), { 13 })->Value);
  ExpectFacetsOfAllSides(RefineMarkedLR(BentBox<2>(2, 5), { 6, 12 })->Value);
}

TEST(PatchTests, SplinesInThePlane_ExactOracle)
{
  for (const AnalysisCase& body : SplineCases<2>())
  {
    ExpectConstantStress(body, GalerkinEquation::PlaneStress);
    ExpectConstantStress(body, GalerkinEquation::PlaneStrain);
    ExpectConstantStress(body, GalerkinEquation::Poisson);
  }
}

TEST(PatchTests, SplinesInSpace_ExactOracle)
{
  for (const AnalysisCase& body : SplineCases<3>())
  {
    ExpectConstantStress(body, GalerkinEquation::Solid);
    ExpectConstantStress(body, GalerkinEquation::Poisson);
  }
}

TEST(PatchTests, LagrangeElements_ExactOracle)
{
  for (const AnalysisCase& body : LagrangeCases(2))
  {
    ExpectConstantStress(body, GalerkinEquation::PlaneStress);
    ExpectConstantStress(body, GalerkinEquation::Poisson);
  }
  for (const AnalysisCase& body : LagrangeCases(3))
  {
    ExpectConstantStress(body, GalerkinEquation::Solid);
    ExpectConstantStress(body, GalerkinEquation::Poisson);
  }
}
}
