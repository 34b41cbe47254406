// SPDX-License-Identifier: BSD-3-Clause
// Temperature of a square that is held at 0 and heated evenly.
#include <knotwork/SplineAnalysis/GalerkinProblem.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <cmath>

int main()
{
  const auto knots = knotwork::KnotVector::Uniform(2, 8);
  knotwork::Spline<2> square;
  square.Space = knotwork::MakeTensorSpace<2>({ knots, knots }).Value;
  square.ControlPoints = knotwork::GrevillePoints(*square.Space);
  const auto space = knotwork::MakeGalerkinSpace(square);
  knotwork::GalerkinProblem problem;
  problem.Source = [](const double*, double* f) { f[0] = 1.0; };
  problem.Prescribed.push_back({ knotwork::BoundaryFacets(space.Value).Value, -1, {} });
  const auto solution = knotwork::SolveGalerkin(space.Value, problem);
  // twice the energy is the integral of the solution: 0.0351443 (torsion of a square bar)
  return solution && std::abs(2 * solution->Energy - 0.0351443) < 1e-5 ? 0 : 1;
}
