// SPDX-License-Identifier: BSD-3-Clause
// Projection onto unstructured spaces cell by cell and patch by patch, without what the function
// itself takes.
#include "MeshCases.h"
#include <knotwork/SplineCore/CompositeProjection.h>
#include <knotwork/SplineCore/UnstructuredSpace.h>

#include <benchmark/benchmark.h>

#include <chrono>
#include <functional>

namespace knotwork
{
namespace
{
bool Fill(int element, const PointMatrix&, const PointMatrix&, PointMatrix& values)
{
  values.setConstant(element & 7);
  return true;
}

double Milliseconds(const std::function<void()>& run)
{
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
    .count();
}

template <int Dim>
void Compare(benchmark::State& state, const CellMesh<Dim>& mesh)
{
  UnstructuredParams params;
  params.Degree = static_cast<int>(state.range(0));
  params.Policy = CreasePolicy::Full;
  const auto space = MakeUnstructuredSpace<Dim>(mesh, params).Value.Space;
  ProjectionParams projection;
  projection.Threads = static_cast<int>(state.range(1));
  const ElementFunction function = Fill;
  constexpr double Longest = 1e9;
  double made = Longest;
  double cells = Longest;
  double patches = Longest;
  double values = Longest;
  for (auto _ : state)
  {
    CompositeProjection<Dim> composite;
    made =
      std::min(made, Milliseconds([&] { composite = MakeCompositeProjection<Dim>(space).Value; }));
    for (int round = 0; round < 5; ++round)
    {
      cells = std::min(cells,
        Milliseconds(
          [&] {
            benchmark::DoNotOptimize(ProjectOntoSpace<Dim>(space, 3, function, projection).Status);
          }));
      patches = std::min(patches,
        Milliseconds(
          [&] {
            benchmark::DoNotOptimize(
              ProjectByPatches<Dim>(composite, 3, function, projection).Status);
          }));
      values = std::min(values,
        Milliseconds(
          [&]
          {
            int points = 1;
            for (int d = 0; d < Dim; ++d)
            {
              points *= params.Degree + 2;
            }
            const PointMatrix local(points, Dim);
            PointMatrix filled(points, 3);
            for (int e = 0; e < space->NumElements(); ++e)
            {
              benchmark::DoNotOptimize(function(e, local, local, filled));
            }
          }));
    }
  }
  const double own = projection.Threads == 1 ? values : 0.0;
  state.counters["cells"] = cells - own;
  state.counters["patches"] = patches - own;
  state.counters["ratio"] = (cells - own) / (patches - own);
  state.counters["function"] = values;
  state.counters["made"] = made;
}

void CompositeQuads(benchmark::State& state)
{
  Compare<2>(state, meshes::CubeSphere(130));
}
void CompositeHexes(benchmark::State& state)
{
  Compare<3>(state, meshes::Sweep(meshes::CubeSphere(29), 20));
}
BENCHMARK(CompositeQuads)
  ->ArgNames({ "degree", "threads" })
  ->ArgsProduct({ { 2, 3 }, { 1, 0 } })
  ->Iterations(1)
  ->Repetitions(3)
  ->ReportAggregatesOnly(true)
  ->Unit(benchmark::kMillisecond);
BENCHMARK(CompositeHexes)
  ->ArgNames({ "degree", "threads" })
  ->ArgsProduct({ { 2, 3 }, { 1, 0 } })
  ->Iterations(1)
  ->Repetitions(3)
  ->ReportAggregatesOnly(true)
  ->Unit(benchmark::kMillisecond);
}
}
