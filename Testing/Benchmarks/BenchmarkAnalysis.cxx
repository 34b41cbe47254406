// SPDX-License-Identifier: BSD-3-Clause
// Assembly of the stiffness matrix, pattern and scatter included, on bent boxes of all families.
// The counters are elements a second and the time an element.
#include "AnalysisCases.h"
#include "BenchmarkTools.h"
#include "StiffnessMatrix.h"

#include <cmath>

namespace knotwork
{
namespace
{
using testing::BentBox;

GalerkinSpace Hexahedra(int family)
{
  Spline<3> spline = BentBox<3>(2, 20);
  switch (family)
  {
    case 1: // knots of which no two spans are alike
    {
      std::array<KnotVector, 3> knots;
      for (std::size_t d = 0; d < 3; ++d)
      {
        std::vector<double> values = KnotVector::Uniform(2, 20).Knots();
        for (std::size_t i = 3; i + 3 < values.size(); ++i)
        {
          values[i] = std::pow(values[i], 1.1 + 0.1 * static_cast<double>(d));
        }
        knots[d] = KnotVector::Create(2, values).Value;
      }
      spline.Space = MakeTensorSpace<3>(knots).Value;
      spline.ControlPoints = GrevillePoints(*spline.Space);
      break;
    }
    case 2:
      spline = RefineMarkedElements(BentBox<3>(2, 10), { 0, 1, 11, 111, 222 })->Value;
      break;
    case 3: // weights that ask for no more points than polynomials have
      spline.Weights = Eigen::VectorXd::Constant(spline.Space->NumFunctions, 0.7);
      break;
    default:
      break;
  }
  return MakeGalerkinSpace(spline).Value;
}

void Assemble(benchmark::State& state, int threads)
{
  GalerkinProblem problem;
  GalerkinParams params;
  params.Threads = threads;
  GalerkinSpace space;
  const bool solid = state.range(0) < 10;
  switch (state.range(0) % 10)
  {
    case 0:
    case 1:
    case 2:
    case 3:
      space = Hexahedra(static_cast<int>(state.range(0) % 10));
      break;
    case 4:
      space = MakeGalerkinSpace(testing::BentStar<3>(5, 10, 2)).Value;
      break;
    case 5:
      space = testing::LagrangeCase(CellShape::Hexahedron, 2, 10).Space;
      break;
    case 6:
      space = testing::LagrangeCase(CellShape::Tetrahedron, 2, 8).Space;
      break;
    default:
      space = MakeGalerkinSpace(BentBox<3>(3, 8)).Value;
      break;
  }
  constexpr const char* Names[] = { "tensor", "tensor, knots irregular", "THB", "rational",
    "unstructured", "Lagrange hexahedra", "Lagrange tetrahedra", "tensor, degree 3" };
  state.SetLabel(std::string(solid ? "elasticity, " : "Poisson, ") + Names[state.range(0) % 10]);
  problem.Equation = solid ? GalerkinEquation::Solid : GalerkinEquation::Poisson;
  for (auto _ : state)
  {
    if (!AssembleStiffness(space, problem, params, {}))
    {
      state.SkipWithError("assembly failed");
      return;
    }
  }
  state.counters["elements"] =
    benchmark::Counter(space.NumElements(), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["cell"] = benchmark::Counter(space.NumElements(),
    benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void AnalysisAssembly(benchmark::State& state)
{
  Assemble(state, 1);
}
BENCHMARK(AnalysisAssembly)->Apply(Repeat)->ArgName("case")->DenseRange(0, 7)->DenseRange(10, 17);
void AnalysisAssemblyAllThreads(benchmark::State& state)
{
  Assemble(state, 0);
}
BENCHMARK(AnalysisAssemblyAllThreads)
  ->Apply(Repeat)
  ->MeasureProcessCPUTime()
  ->UseRealTime()
  ->ArgName("case")
  ->DenseRange(0, 7)
  ->DenseRange(10, 17);
}

/// Poisson's equation on a bent cube of degree 2 with (elements + 2)^3 functions, or on a prism of
/// five sectors about an extraordinary point with about as many, all threads: the whole solution,
/// and its parts as counters in seconds.
void AnalysisLargeSystem(benchmark::State& state)
{
  const auto elements = static_cast<int>(state.range(0));
  const bool isUnstructured = state.range(1) == 2;
  GalerkinSpace space;
  if (isUnstructured)
  {
    const auto along = static_cast<int>(std::lround(elements / std::sqrt(5.0)));
    space = MakeGalerkinSpace(testing::BentStar<3>(5, along, 2, elements)).Value;
  }
  else
  {
    space = MakeGalerkinSpace(BentBox<3>(2, elements)).Value;
  }
  const bool isTensor = state.range(1) == 0;
  state.SetLabel(isTensor ? "fast diagonalization"
      : isUnstructured    ? "unstructured"
                          : "Gauss-Seidel and constants of cells");
  if (!isTensor)
  {
    space.Knots = {};
  }
  GalerkinProblem problem;
  problem.Source = [](const double* x, double* f) { f[0] = x[0] + 1.0; };
  problem.Prescribed.push_back({ BoundaryFacets(space).Value, -1, {} });
  GalerkinParams params;
  params.DirectLimit = 0;
  params.Tolerance = 1e-10;
  GalerkinSolution solution;
  for (auto _ : state)
  {
    auto solved = SolveGalerkin(space, problem, params);
    if (!solved)
    {
      state.SkipWithError(solved.Status.Message().c_str());
      return;
    }
    solution = std::move(solved.Value);
  }
  state.counters["functions"] = space.NumFunctions();
  state.counters["iterations"] = solution.Iterations;
  state.counters["certificate"] = solution.SecondsCertificate;
  state.counters["assembly"] = solution.SecondsAssembly;
  state.counters["solution"] = solution.SecondsSolve;
}
BENCHMARK(AnalysisLargeSystem)
  ->MeasureProcessCPUTime()
  ->UseRealTime()
  ->Iterations(1)
  ->Unit(benchmark::kSecond)
  ->ArgNames({ "elements", "way" })
  ->Args({ 38, 0 })
  ->Args({ 38, 1 })
  ->Args({ 98, 0 })
  ->Args({ 98, 1 })
  ->Args({ 98, 2 });
}
