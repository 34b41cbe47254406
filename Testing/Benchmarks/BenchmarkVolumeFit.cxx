// SPDX-License-Identifier: BSD-3-Clause
// Values at a million points of the unit cube to a tolerance: LR and THB volumes, and uniform ones
// of more and more elements.
#include "BenchmarkTools.h"
#include <knotwork/SurfaceFitting/VolumeFit.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace knotwork
{
namespace
{
constexpr double Tolerance = 0.003;

/// A gentle wave with two peaks of a width of 0.04.
double Field(const double* at)
{
  const auto peak = [at](double x, double y, double z)
  {
    const double dx = at[0] - x;
    const double dy = at[1] - y;
    const double dz = at[2] - z;
    return std::exp(-(dx * dx + dy * dy + dz * dz) / (2.0 * 0.04 * 0.04));
  };
  return 0.1 * std::sin(3.0 * at[0] + 2.0 * at[1] + at[2]) + peak(0.3, 0.35, 0.6) +
    0.7 * peak(0.7, 0.6, 0.4);
}

const VolumeCloud& Cloud()
{
  static const VolumeCloud cloud = []
  {
    VolumeCloud made;
    made.Points.resize(1000000, 3);
    made.Values.resize(1000000, 1);
    std::mt19937_64 random(7);
    for (Eigen::Index i = 0; i < made.Points.rows(); ++i)
    {
      for (Eigen::Index d = 0; d < 3; ++d)
      {
        made.Points(i, d) = static_cast<double>(random() >> 11) * 0x1p-53;
      }
      made.Values(i, 0) = Field(made.Points.row(i).data());
    }
    return made;
  }();
  return cloud;
}

void Run(benchmark::State& state, VolumeFitParams params)
{
  params.Domain = { { 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 } };
  params.Tolerance = Tolerance;
  params.MaxFunctions = 1000000;
  Result<VolumeFit> fit;
  for (auto _ : state)
  {
    fit = FitVolume(Cloud(), params);
    if (!fit)
    {
      state.SkipWithError(fit.Status.Message().c_str());
      return;
    }
  }
  state.counters["functions"] = fit->Volume.Space->NumFunctions;
  state.counters["error"] = fit->Iterations.back().MaxError / Tolerance;
}

void Register(const std::string& name, const VolumeFitParams& params)
{
  for (const int threads : { 1, 0 })
  {
    VolumeFitParams own = params;
    own.Threads = threads;
    auto* made =
      benchmark::RegisterBenchmark(("volume/" + name + (threads == 1 ? "" : "/all")).c_str(),
        [own](benchmark::State& state) { Run(state, own); });
    TakeFastest(made->Iterations(1), 2);
    if (threads != 1)
    {
      made->UseRealTime();
    }
  }
}

const bool Registered = []
{
  VolumeFitParams params;
  Register("lr", params);
  params.Method = FitMethod::MultilevelApproximation;
  Register("mba", params);
  params = {};
  params.Space = FitSpace::Hierarchical;
  Register("thb", params);
  for (const int n : { 16, 32, 48 })
  {
    VolumeFitParams uniform;
    uniform.NumInitialElements = { n, n, n };
    uniform.MaxIterations = 0;
    Register("uniform" + std::to_string(n), uniform);
  }
  return true;
}();
}
}
