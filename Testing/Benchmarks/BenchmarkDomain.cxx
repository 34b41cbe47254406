// SPDX-License-Identifier: BSD-3-Clause
// Domain parameterization, certificate included, metrics apart. Domains and layouts from formulas,
// and the domains of the folder that the environment variable KNOTWORK_DOMAIN_CASES names.
#include "BenchmarkTools.h"
#include "DomainCases.h"
#include "DomainFiles.h"
#include "LayoutCases.h"
#include <knotwork/DomainParameterization/DomainParameterization.h>
#include <knotwork/DomainParameterization/ParameterizeLayout.h>

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

template <int Dim>
void RunLayout(benchmark::State& state, const PatchLayout<Dim>& layout, const LayoutParams& space)
{
  DomainParams params;
  params.Threads = 1;
  params.MetricSamples = 2;
  Result<LayoutParameterization<Dim>> result;
  for (auto _ : state)
  {
    result = ParameterizeLayout<Dim>(layout, space, params);
    if (!result || result->Certificate.Verdict != Verdict::Valid ||
      result->Injectivity.Verdict != InjectivityVerdict::Injective)
    {
      state.SkipWithError(result ? "not proved" : result.Status.Message().c_str());
      return;
    }
  }
  state.counters["evaluations"] = result->Evaluations;
  state.counters["functions"] = result->Map.NumFunctions();
  state.counters["functional"] = result->History.back().Energy;
  params.MetricSamples = 0;
  const auto measured = ParameterizeLayout<Dim>(layout, space, params);
  state.counters["min_det"] = measured ? measured->Metrics.MinDetOverArea : NAN;
  state.counters["max_det"] = measured ? measured->Metrics.MaxDetOverArea : NAN;
  state.counters["condition"] = measured ? measured->Metrics.MeanConditionNumber : NAN;
}

template <int Dim>
void RegisterLayout(
  const std::string& name, const PatchLayout<Dim>& layout, const LayoutParams& space = {})
{
  Repeat(benchmark::RegisterBenchmark(("Layout/" + name).c_str(),
    [layout, space](benchmark::State& state) { RunLayout<Dim>(state, layout, space); }));
}

void RegisterLayouts()
{
  RegisterLayout<2>("LetterL", cases::LetterL());
  const PatchLayout<2> disc = cases::Disc(0.4, 0.2);
  RegisterLayout<2>("Disc", disc);
  LayoutParams space;
  space.MoveInterfaces = false;
  RegisterLayout<2>("DiscKept", disc, space);
  space = {};
  space.MinElements = 32;
  RegisterLayout<2>("DiscFine", disc, space);
  RegisterLayout<2>("Ring", cases::Ring());
  RegisterLayout<2>("Wedge", cases::Wedge());
  space = {};
  space.MinElements = 2;
  const PatchLayout<2> base = cases::Disc(0.45);
  if (const auto plane = ParameterizeLayout<2>(base, space))
  {
    RegisterLayout<3>("Cylinder", cases::Swept(base, plane->Map.Patches, 1.5), space);
  }
}

const bool registered = []
{
  RegisterLayouts();
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
