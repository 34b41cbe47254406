// SPDX-License-Identifier: BSD-3-Clause
#include "EnergyError.h"
#include <knotwork/SplineAnalysis/ErrorEstimate.h>

#include <gtest/gtest.h>

namespace knotwork::testing
{
namespace
{
double Ratio(const AnalysisCase& body, GalerkinEquation equation, int degree, bool valuesAlone, double frequency = 3.0)
{
  const PlaneWaves exact(equation, body.Space.Dimension, frequency);
  const GalerkinProblem problem = exact.Problem(body.Boundary, valuesAlone);
  const auto solution = SolveGalerkin(body.Space, problem);
  EXPECT_TRUE(solution) << body.Name << solution.Status.Message();
  if (!solution) return 0.0;
  const double error =
    EnergyError(body.Space, problem, solution->Coefficients, exact.Gradient());
  const auto estimate = EstimateError(body.Space, problem, solution->Coefficients);
  EXPECT_TRUE(estimate) << estimate.Status.Message();
  std::printf("[ ratio    ] %-26s eq %d p %d N %6d: %.3f  (interior %.3f jumps %.3f loads %.3f values %.3f) error %.1e\n",
    body.Name.c_str(), static_cast<int>(equation), degree, body.Space.NumFunctions(),
    estimate->Total / error, estimate->Interior / error, estimate->Jumps / error,
    estimate->Loads / error, estimate->Values / error, error);
  return estimate->Total / error;
}

template <int Dim>
std::vector<int> Corner(int n)
{
  std::vector<int> marked;
  for (int e = 0; e < (Dim == 2 ? n * n : n * n * n); ++e)
  {
    if (e % n < n / 2 && e / n % n < n / 2 && (Dim == 2 || e / n / n < n / 2))
    {
      marked.push_back(e);
    }
  }
  return marked;
}
}

TEST(XErrorEstimate, Ratios)
{
  for (const bool alone : { true, false })
  for (const auto eq : { GalerkinEquation::Poisson, GalerkinEquation::PlaneStress })
  {
    for (const int p : { 1, 2, 3, 4, 5 })
    {
      Ratio(CaseOf<2>("tensor 8", BentBox<2>(p, 8)), eq, p, alone);
      Ratio(CaseOf<2>("tensor 32", BentBox<2>(p, 32)), eq, p, alone);
      Ratio(CaseOf<2>("THB", RefineMarkedElements(BentBox<2>(p, 8), Corner<2>(8))->Value), eq, p, alone);
      Ratio(CaseOf<2>("LR", RefineMarkedLR(BentBox<2>(p, 8), Corner<2>(8))->Value), eq, p, alone);
      if (p > 1) {
      if (p < 4 && alone) Ratio(CaseOf<2>("unstructured", BentStar<2>(5, 8, p)), eq, p, alone);
      ShapeParams ring;
      ring.Kind = ShapeKind::AnnulusSector;
      ring.Degree = p;
      ring.Elements = { 16, 16, 1 };
      Ratio(CaseOf<2>("rational", ShapePatches<2>(ring)[0]), eq, p, alone);
      ShapeParams disc;
      disc.Kind = ShapeKind::Disc;
      disc.Degree = p;
      disc.Elements = { 8, 8, 1 };
      if (alone) Ratio(MultiPatchCase<2>("multi-patch", disc), eq, p, alone);
      }
      if (alone && p <= 4) Ratio(LagrangeCase(CellShape::Triangle, p, 10), eq, p, alone);
      if (alone && p <= 4) Ratio(LagrangeCase(CellShape::Quadrilateral, p, 10), eq, p, alone);
    }
  }
  for (const auto eq : { GalerkinEquation::Poisson, GalerkinEquation::Solid })
    for (const int p : { 1, 2, 3 })
    {
      Ratio(CaseOf<3>("3D tensor", BentBox<3>(p, 6)), eq, p, true);
      Ratio(CaseOf<3>("3D tensor mixed", BentBox<3>(p, 6)), eq, p, false);
      Ratio(CaseOf<3>("3D THB", RefineMarkedElements(BentBox<3>(p, 4), Corner<3>(4))->Value), eq, p, true);
      if (p < 3) Ratio(LagrangeCase(CellShape::Tetrahedron, p, p == 1 ? 6 : 3), eq, p, true);
      if (p < 3) Ratio(LagrangeCase(CellShape::Hexahedron, p, p == 1 ? 6 : 4), eq, p, true);
    }
}
}
