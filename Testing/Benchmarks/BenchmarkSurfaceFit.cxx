// SPDX-License-Identifier: BSD-3-Clause
// Fits of point clouds to their tolerance: peaks (1e5 and 1e6 points), a terrain with a cliff (5e5
// points), peaks with noise and outliers. A name is cloud/space/method/strategy, /all with all
// threads.
#include "BenchmarkTools.h"
#include "CloudCases.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>

namespace knotwork
{
namespace
{
struct Case
{
  PointCloud Cloud;
  FitParams Params;
};

Case MakeCase(const std::string& name)
{
  Case made;
  made.Params.Tolerance = 0.002;
  if (name == "peaks")
  {
    made.Cloud = clouds::PeaksCloud();
  }
  else if (name == "peaks6")
  {
    made.Cloud = clouds::LargePeaksCloud();
  }
  else if (name == "terrain")
  {
    made.Cloud = clouds::TerrainCloud();
    made.Params.Tolerance = 0.01;
  }
  else if (name == "outliers")
  {
    std::vector<std::uint8_t> labels;
    made.Cloud = clouds::NoisyPeaksCloud(labels);
    made.Params.Tolerance = 0.01;
    made.Params.FindOutliers = true;
  }
  else // the points and options of the hierarchical fit that is compared
  {
    made.Cloud = clouds::HeightField(100000, 42, clouds::Peaks);
    made.Params.Tolerance = 0.001;
    made.Params.Degree = { 3, 3 };
    made.Params.NumInitialElements = { 8, 8 };
  }
  return made;
}

/// Clouds are made once, when they are first asked for.
const Case& FindCase(const std::string& name)
{
  static std::map<std::string, Case> cases;
  const auto found = cases.find(name);
  return found != cases.end() ? found->second : cases.emplace(name, MakeCase(name)).first->second;
}

void Run(benchmark::State& state, const std::string& name, FitParams params)
{
  const Case& which = FindCase(name);
  params.Tolerance = which.Params.Tolerance;
  params.Degree = which.Params.Degree;
  params.NumInitialElements = which.Params.NumInitialElements;
  params.FindOutliers = which.Params.FindOutliers;
  Result<SurfaceFit> fit;
  for (auto _ : state)
  {
    fit = FitSurface(which.Cloud, params);
    if (!fit || !fit.Value.WithinTolerance)
    {
      state.SkipWithError("the tolerance is not met");
      return;
    }
  }
  state.counters["functions"] = fit.Value.Final.NumFunctions;
  state.counters["error"] = fit.Value.Final.MaxError / params.Tolerance;
  state.counters["rms"] = fit.Value.Final.RmsError;
  state.counters["outliers"] = static_cast<double>(fit.Value.Final.NumOutliers);
  state.counters["steps"] = fit.Value.Final.Iteration;
}

void Register(const std::string& cloud, const std::string& variant, const FitParams& params)
{
  const auto configure = [](benchmark::internal::Benchmark* b)
  {
    TakeFastest(b->MinTime(0.01), 3);
    return b;
  };
  for (const int threads : { 1, 0 })
  {
    FitParams own = params;
    own.Threads = threads;
    const std::string name = cloud + "/" + variant + (threads == 1 ? "" : "/all");
    auto* made = configure(benchmark::RegisterBenchmark(
      name.c_str(), [cloud, own](benchmark::State& state) { Run(state, cloud, own); }));
    if (threads != 1)
    {
      made->UseRealTime();
    }
  }
}

const int Registered = []
{
  for (const char* cloud : { "peaks", "peaks6", "terrain", "outliers", "bicubic" })
  {
    FitParams params;
    Register(cloud, "lr", params);
    params.Space = FitSpace::Hierarchical;
    Register(cloud, "thb", params);
  }
  for (const char* cloud : { "peaks", "peaks6", "terrain" })
  {
    FitParams params;
    params.Method = FitMethod::MultilevelApproximation;
    Register(cloud, "mba", params);
    params.Method = FitMethod::Combined;
    Register(cloud, "combined", params);
    params = {};
    params.Threshold = FitThreshold::All;
    Register(cloud, "every", params);
    params = {};
    params.Directions = FitDirections::Both;
    Register(cloud, "both", params);
    params = {};
    params.Strategy = LRStrategy::MinimumSpan;
    Register(cloud, "minimum", params);
    params.Strategy = LRStrategy::StructuredMesh;
    Register(cloud, "structured", params);
    params.Strategy = LRStrategy::RestrictedMesh;
    Register(cloud, "restricted", params);
  }
  return 0;
}();
}
}
