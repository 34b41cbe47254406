// SPDX-License-Identifier: BSD-3-Clause
// A whole fit by every path, nothing mended or measured: the mesh is its own target. A fit to a
// mesh of triangles with everything that the job does but files, and the closest points that it
// lives on.
#include "BenchmarkTools.h"
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

/// A million triangles on the unit sphere.
FitTargetPtr Triangles()
{
  const fits::PlacedMesh<2> quads = fits::Sphere(289);
  TriangleMesh mesh;
  mesh.Points = quads.Points;
  for (int q = 0; q < quads.Mesh.NumCells(); ++q)
  {
    const int* c = quads.Mesh.Cell(q);
    mesh.Triangles.push_back({ c[0], c[1], c[3] });
    mesh.Triangles.push_back({ c[0], c[3], c[2] });
  }
  return MakeMeshTarget(mesh).Value;
}

/// Points of 16 a cell, cell by cell, a thousandth of an edge off the target.
void ClosestOnTriangles(benchmark::State& state)
{
  const FitTargetPtr target = Triangles();
  const fits::PlacedMesh<2> quads = fits::Sphere(130);
  PointMatrix queries(16 * static_cast<Eigen::Index>(quads.Mesh.NumCells()), 3);
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    const int* c = quads.Mesh.Cell(static_cast<int>(i / 16));
    const double u = (0.5 + static_cast<double>(i % 4)) / 4.0;
    const double v = (0.5 + static_cast<double>(i % 16 / 4)) / 4.0;
    const Eigen::RowVector3d at =
      (1.0 - v) * ((1.0 - u) * quads.Points.row(c[0]) + u * quads.Points.row(c[1])) +
      v * ((1.0 - u) * quads.Points.row(c[2]) + u * quads.Points.row(c[3]));
    queries.row(i) = (1.0 + 5e-6) * at.normalized();
  }
  TargetPoints feet;
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(target->Find({}, queries, feet));
  }
  CountPoints(state, static_cast<double>(queries.rows()));
}
BENCHMARK(ClosestOnTriangles)
  ->Iterations(1)
  ->Apply([](benchmark::internal::Benchmark* b) { TakeFastest(b, 3); });

void FitToTriangles(benchmark::State& state)
{
  const FitTargetPtr target = Triangles();
  const fits::PlacedMesh<2> mesh = fits::Sphere(409);
  CADFitParams params;
  params.Space.Degree = 2;
  params.Threads = static_cast<int>(state.range(0));
  Result<CADFit<2>> fit;
  for (auto _ : state)
  {
    fit = FitToTarget<2>(mesh.Mesh, mesh.Points, target, params);
  }
  state.SetLabel(fit ? ToString(fit->Path) : fit.Status.Message());
  state.counters["elements"] = mesh.Mesh.NumCells();
}
BENCHMARK(FitToTriangles)
  ->ArgName("threads")
  ->Arg(1)
  ->Arg(0)
  ->Iterations(1)
  ->UseRealTime()
  ->Apply([](benchmark::internal::Benchmark* b) { TakeFastest(b, 2); });
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
