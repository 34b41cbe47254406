// SPDX-License-Identifier: BSD-3-Clause
// Spaces on meshes of quadrilaterals and hexahedra: what building them costs in time and memory,
// and what evaluation costs beside a tensor-product surface of as many elements.
#include "BenchmarkTools.h"
#include "MeshCases.h"
#include <knotwork/SplineCore/UnstructuredSpace.h>

#include <malloc.h>

#include <ctime>
#include <fstream>
#include <unistd.h>

namespace knotwork
{
namespace
{
/// Repetitions whose median is the figure to quote, in processor time.
void RepeatFive(benchmark::internal::Benchmark* b)
{
  b->Iterations(1)->Repetitions(5)->ReportAggregatesOnly(true)->Unit(benchmark::kMillisecond);
}

std::size_t ResidentBytes()
{
  malloc_trim(0); // what was freed before is not taken for free
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  file >> pages >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// Seconds of the process for `rounds` batches of points.
double EvaluationTime(const BezierForm<2>& form, const std::vector<int>& elements,
  const PointMatrix& local, const EvaluationParams& params, EvaluationBatch& batch)
{
  const std::clock_t start = std::clock();
  for (int round = 0; round < 10; ++round)
  {
    benchmark::DoNotOptimize(EvaluateElements<2>(form, elements, local, params, batch).Code);
  }
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / 10.0;
}

/// The same random elements and local parameters on a sphere of 6 x 26 x 26 cells and on a
/// tensor-product surface of 78 x 52, in turns.
void EvaluationOverTensor(benchmark::State& state)
{
  const auto degree = static_cast<int>(state.range(0));
  UnstructuredParams sphere;
  sphere.Degree = degree;
  const auto mesh = meshes::CubeSphere(26);
  const auto own =
    MakeBezierForm(RandomSpline<2>(MakeUnstructuredSpace<2>(mesh, sphere).Value.Space, 3), 1);
  const auto other = MakeBezierForm(
    RandomSpline<2>(
      MakeTensorSpace<2>({ KnotVector::Uniform(degree, 78), KnotVector::Uniform(degree, 52) })
        .Value,
      3),
    1);
  const PointMatrix local = RandomPoints(NumBenchmarkPoints / 4, 2);
  std::vector<int> elements;
  const PointMatrix chosen = RandomPoints(static_cast<int>(local.rows()), 1, 43);
  for (Eigen::Index i = 0; i < chosen.rows(); ++i)
  {
    elements.push_back(static_cast<int>(chosen(i, 0) * mesh.NumCells()));
  }
  EvaluationParams params;
  params.Derivatives = static_cast<int>(state.range(1));
  params.Threads = 1;
  EvaluationBatch batch;
  EvaluationTime(own, elements, local, params, batch);
  for (auto _ : state)
  {
    const double time = EvaluationTime(own, elements, local, params, batch);
    const double tensor = EvaluationTime(other, elements, local, params, batch);
    state.counters["unstructured"] = 1e9 * time / static_cast<double>(local.rows());
    state.counters["tensor"] = 1e9 * tensor / static_cast<double>(local.rows());
    state.counters["ratio"] = time / tensor;
  }
}
BENCHMARK(EvaluationOverTensor)
  ->Apply(RepeatFive)
  ->ArgNames({ "degree", "derivatives" })
  ->ArgsProduct({ { 2, 3 }, { 0, 1 } });

template <int Dim>
void Build(benchmark::State& state, const CellMesh<Dim>& mesh, int degree)
{
  if (mesh.NumCells() == 0)
  {
    state.SkipWithError("KNOTWORK_UNSTRUCTURED_MESHES names no folder of meshes");
    return;
  }
  UnstructuredParams params;
  params.Degree = degree;
  params.Policy = CreasePolicy::Full;
  for (auto _ : state)
  {
    const std::size_t before = ResidentBytes();
    const std::clock_t start = std::clock();
    const auto made = MakeUnstructuredSpace<Dim>(mesh, params);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    const Spline<Dim> spline = RandomSpline<Dim>(made.Value.Space, 3);
    state.counters["bytes"] =
      (static_cast<double>(ResidentBytes()) - static_cast<double>(before)) / mesh.NumCells();
    state.counters["milliseconds"] = 1e3 * seconds;
    state.counters["cell"] = seconds / mesh.NumCells();
  }
}

/// A sphere of 6 n^2 cells, as generated or with cells and points in another order.
void BuildQuads(benchmark::State& state)
{
  const auto mesh = meshes::CubeSphere(static_cast<int>(state.range(0)));
  meshes::Random random(5);
  Build<2>(state, state.range(1) != 0 ? meshes::Shuffled(random, mesh, false) : mesh, 3);
}
BENCHMARK(BuildQuads)
  ->Apply(RepeatFive)
  ->ArgNames({ "n", "shuffled" })
  ->ArgsProduct({ { 41, 409 }, { 0, 1 } });

/// Layers of a sphere.
void BuildHexes(benchmark::State& state)
{
  Build<3>(state, meshes::Sweep(meshes::CubeSphere(29), 20), 2);
}
BENCHMARK(BuildHexes)->Apply(RepeatFive);

void BuildNeonSide(benchmark::State& state)
{
  Build<2>(state, meshes::ReadMesh<2>("gs_neon_side.off"), 3);
}
BENCHMARK(BuildNeonSide)->Apply(RepeatFive);
}
}
