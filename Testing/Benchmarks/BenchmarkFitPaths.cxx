// SPDX-License-Identifier: BSD-3-Clause
// A whole fit by every path, nothing mended or measured: the mesh is its own target.
#include "FitCases.h"

#include <benchmark/benchmark.h>

namespace knotwork
{
namespace
{
template <int Dim>
void Fit(benchmark::State& state, const fits::PlacedMesh<Dim>& mesh)
{
  CADFitParams params;
  params.Space.Degree = 2;
  params.Space.Policy = CreasePolicy::Full;
  params.Path = static_cast<FitPath>(state.range(0));
  params.Smoothing = FitSmoothing::Off;
  params.TargetSamples = 0;
  params.Threads = static_cast<int>(state.range(1));
  Result<CADFit<Dim>> fit;
  for (auto _ : state)
  {
    fit = FitToTarget<Dim>(mesh.Mesh, mesh.Points, nullptr, params);
  }
  state.SetLabel(fit ? ToString(fit->Path) : fit.Status.Message());
  state.counters["elements"] = mesh.Mesh.NumCells();
}

void FitQuads(benchmark::State& state)
{
  Fit<2>(state, fits::Sphere(130));
}
void FitHexes(benchmark::State& state)
{
  fits::Placer<3> placer;
  fits::AddBlock<3>(placer, { 47, 47, 47 },
    [](const double* u) { return Eigen::RowVector3d(u[0], u[1] + 0.1 * u[0] * u[2], u[2]); });
  Fit<3>(state, placer.Done());
}
const std::vector<std::int64_t> Paths{ static_cast<int>(FitPath::Unstructured),
  static_cast<int>(FitPath::Composite), static_cast<int>(FitPath::Coons),
  static_cast<int>(FitPath::Multilinear) };
BENCHMARK(FitQuads)
  ->ArgNames({ "path", "threads" })
  ->ArgsProduct({ Paths, { 1, 0 } })
  ->Unit(benchmark::kMillisecond);
BENCHMARK(FitHexes)
  ->ArgNames({ "path", "threads" })
  ->ArgsProduct({ Paths, { 1, 0 } })
  ->Unit(benchmark::kMillisecond);
}
}
