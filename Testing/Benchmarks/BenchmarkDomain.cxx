// SPDX-License-Identifier: BSD-3-Clause
// Domain parameterization, certificate included, metrics apart. Domains and layouts from formulas,
// and the domains of the folder that the environment variable KNOTWORK_DOMAIN_CASES names.
#include "BenchmarkTools.h"
#include "DomainCases.h"
#include "DomainFiles.h"
#include "DomainMeasure.h"
#include "HarmonicMaps.h"
#include "InitialMaps.h"
#include "LayoutCases.h"
#include "ParameterMetrics.h"
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

/// A first map of the boundary, and what the optimization makes of it.
void RunFirst(
  benchmark::State& state, const DomainBoundary<2>& boundary, const InitialMapMethod method)
{
  const auto compatible = MakeCompatible<2>(boundary);
  Spline<2> map;
  Status status = compatible.Status;
  for (auto _ : state)
  {
    map = MapOfBoundary<2>(compatible.Value);
    FillWeights<2>(map);
    switch (method)
    {
      case InitialMapMethod::Automatic:
      case InitialMapMethod::Coons:
        FillCoons<2>(map);
        break;
      case InitialMapMethod::Spring:
        status = FillSpring<2>(map);
        break;
      case InitialMapMethod::Harmonic:
        status = FillHarmonic<2>(map);
        break;
      case InitialMapMethod::VariationalHarmonic:
        status = FillVariationalHarmonic<2>(map);
        break;
    }
  }
  DomainParams params;
  params.InitialMap = method;
  params.Threads = 1;
  params.MaxRefinements = 0;
  const auto result = ParameterizeDomain<2>(boundary, params);
  if (!status || !result)
  {
    state.SkipWithError((status ? result.Status : status).Message().c_str());
    return;
  }
  const int samples = 501;
  const DomainMetrics first =
    MeasureMaps<2>({ map }, SignedMeasure<2>(compatible->Sides), samples, [] { return true; });
  state.counters["min_det"] = first.MinDetOverArea;
  state.counters["max_det"] = first.MaxDetOverArea;
  state.counters["folded"] = 100.0 * first.NonPositive / (samples * samples);
  state.counters["scaled"] = first.MeanScaledJacobian;
  state.counters["evaluations"] = result->Evaluations;
  state.counters["best"] = result->Metrics.MinDetOverArea;
}

void RegisterFirst(const std::string& name, const DomainBoundary<2>& boundary)
{
  const std::pair<const char*, InitialMapMethod> methods[] = { { "Coons", InitialMapMethod::Coons },
    { "Spring", InitialMapMethod::Spring }, { "Harmonic", InitialMapMethod::Harmonic },
    { "VariationalHarmonic", InitialMapMethod::VariationalHarmonic } };
  for (const auto& [word, method] : methods)
  {
    Repeat(benchmark::RegisterBenchmark(("First/" + name + "/" + word).c_str(),
      [boundary, way = method](benchmark::State& state) { RunFirst(state, boundary, way); }));
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
  RegisterFirst("Bite", cases::Bite(0.4, 0.5, 1.0, 3));
  RegisterFirst("TallBite", cases::Bite(0.46, 0.5, 3.0, 3));
  RegisterFirst("BumpedSector", cases::BumpedSector(0.9, 0.35, 12, 3));
  Register<2>("Bite", cases::Bite(0.4, 0.5, 1.0, 3), true);
  Register<2>("BumpedSector", cases::BumpedSector(0.9, 0.35, 12, 3), true);
  Register<3>("LetterG", cases::LetterG(20, 2, 2, 0.6, 0.05), true);
  for (const char* name : { "male", "rotor", "puzzle4", "duck", "tudflame_p2" })
  {
    const auto json = cases::ReadJson(name);
    if (!json.is_null())
    {
      Register<2>(name, cases::ReadBoundary<2>(json), true);
      RegisterFirst(name, cases::ReadBoundary<2>(json));
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
