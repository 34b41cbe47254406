// SPDX-License-Identifier: BSD-3-Clause
// Domain parameterization, certificate included, metrics apart. Domains from formulas, and those of
// the folder that the environment variable KNOTWORK_DOMAIN_CASES names.
#include "BenchmarkTools.h"
#include "DomainCases.h"
#include "DomainFiles.h"
#include "DomainParameterization.h"

namespace knotwork
{
namespace
{
template <int Dim>
void Run(benchmark::State& state, const DomainBoundary<Dim>& boundary, DomainOptimizer optimizer)
{
  DomainParams params;
  params.Optimizer = optimizer;
  params.Threads = 1;
  params.MetricSamples = 2;
  Result<DomainParameterization<Dim>> result;
  for (auto _ : state)
  {
    result = ParameterizeDomain<Dim>(boundary, params);
    if (!result)
    {
      state.SkipWithError(result.Status.Message().c_str());
      return;
    }
  }
  state.counters["verdict"] = static_cast<double>(result->Certificate.Verdict);
  state.counters["evaluations"] = result->Evaluations;
  state.counters["functions"] = result->Map.Space->NumFunctions;
  params.MetricSamples = 0;
  const auto measured = ParameterizeDomain<Dim>(boundary, params);
  state.counters["min_det"] = measured ? measured->Metrics.MinDetOverArea : NAN;
  state.counters["max_det"] = measured ? measured->Metrics.MaxDetOverArea : NAN;
}

template <int Dim>
void Register(const std::string& name, const DomainBoundary<Dim>& boundary, bool newton)
{
  Repeat(benchmark::RegisterBenchmark((name + "/Lbfgs").c_str(),
    [boundary](benchmark::State& state) { Run<Dim>(state, boundary, DomainOptimizer::Lbfgs); }));
  if (newton)
  {
    Repeat(benchmark::RegisterBenchmark((name + "/Newton").c_str(),
      [boundary](benchmark::State& state) { Run<Dim>(state, boundary, DomainOptimizer::Newton); }));
  }
}

const bool registered = []
{
  Register<2>("Bite", cases::Bite(0.4, 0.5, 1.0, 3), true);
  Register<2>("BumpedSector", cases::BumpedSector(0.9, 0.35, 12, 3), true);
  Register<3>("LetterG", cases::LetterG(20, 2, 2, 0.6, 0.05), true);
  for (const char* name : { "male", "rotor", "puzzle4", "duck", "tudflame_p2" })
  {
    const auto json = cases::ReadJson(name);
    if (!json.is_null())
    {
      Register<2>(name, cases::ReadBoundary<2>(json), true);
    }
  }
  const auto json = cases::ReadJson("duck3d");
  if (!json.is_null())
  {
    Register<3>("duck3d", cases::ReadBoundary<3>(json), false);
  }
  return true;
}();
}
}
