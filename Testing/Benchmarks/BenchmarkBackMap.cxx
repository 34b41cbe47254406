// SPDX-License-Identifier: BSD-3-Clause
// Back-maps of charts: a sum of waves at many points, and the meshes of the folder that the
// environment variable KNOTWORK_MESHES names, by all methods over all charts.
#include "BenchmarkTools.h"
#include "RadialSurface.h"
#include "SurfaceFairness.h"
#include <knotwork/MeshParameterization/MeshParameterization.h>
#include <knotwork/SurfaceTrimming/BackMap.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

namespace knotwork
{
namespace
{
/// n x n points of the unit square, lifted by waves.
ChartMesh Waves(int n)
{
  ChartMesh chart;
  chart.UV.resize(static_cast<Eigen::Index>(n) * n, 2);
  chart.Points.resize(chart.UV.rows(), 3);
  for (int i = 0; i < n * n; ++i)
  {
    const double u = static_cast<double>(i % n) / (n - 1);
    const double v = static_cast<double>(i / n) / (n - 1);
    chart.UV.row(i) << u, v;
    chart.Points.row(i) << u, v, 0.05 * std::sin(9.0 * u + 2.0 * v) * std::cos(7.0 * v);
  }
  for (int j = 0; j + 1 < n; ++j)
  {
    for (int i = 0; i + 1 < n; ++i)
    {
      const int a = j * n + i;
      chart.Triangles.push_back({ a, a + 1, a + n + 1 });
      chart.Triangles.push_back({ a, a + n + 1, a + n });
    }
  }
  return chart;
}

void RunPenalized(benchmark::State& state, int elements, int threads)
{
  const ChartMesh chart = Waves(317); // a hundred thousand points
  BackMapParams params;
  params.Tolerance = 1e-3;
  params.Elements = elements;
  params.Margin = 0.0;
  params.Threads = threads;
  for (auto _ : state)
  {
    const auto map = FitBackMap(chart, params);
    if (!map)
    {
      state.SkipWithError(map.Status.Message().c_str());
      return;
    }
    state.counters["rms"] = map->RmsResidual;
  }
}

void RunRadial(benchmark::State& state, int centres)
{
  const PointMatrix flat = RandomPoints(centres, 2);
  const PointMatrix points = RandomPoints(centres, 3, 43);
  for (auto _ : state)
  {
    const auto surface = RadialSurface::Interpolate(flat, points, 1);
    if (!surface)
    {
      state.SkipWithError(surface.Status.Message().c_str());
      return;
    }
    benchmark::DoNotOptimize(surface.Value);
  }
}

/// Triangles of an OFF file; empty when there is no such file.
TriangleMesh ReadOff(const std::string& path)
{
  TriangleMesh mesh;
  std::ifstream file(path);
  std::string word;
  int points = 0;
  int triangles = 0;
  int edges = 0;
  if (!(file >> word >> points >> triangles >> edges) || word != "OFF")
  {
    return mesh;
  }
  mesh.Points.resize(points, 3);
  for (Eigen::Index i = 0; i < mesh.Points.size(); ++i)
  {
    file >> mesh.Points.data()[i];
  }
  mesh.Triangles.resize(static_cast<std::size_t>(triangles));
  for (auto& [a, b, c] : mesh.Triangles)
  {
    int corners = 0;
    file >> corners >> a >> b >> c;
  }
  return file ? mesh : TriangleMesh();
}

struct Case
{
  ChartMesh Chart;
  double Diagonal = 0.0;
  int Flips = 0;
};

/// A mesh in one chart of a method; without points where that fails.
Case ReadCase(const std::string& path, FlattenMethod method)
{
  FlattenParams params;
  params.Method = method;
  params.Fallback = false;
  const auto flat = FlattenMesh(ReadOff(path), params);
  Case result;
  if (flat)
  {
    const PointMatrix& points = flat->Mesh.Points;
    result.Diagonal = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    result.Chart = { points, flat->UV, flat->Mesh.Triangles, {} };
    result.Flips = flat->Measures.FlippedTriangles;
  }
  return result;
}

/// Triangles that the chart flips.
void CountFlips(benchmark::State& state, const Case& data)
{
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(data.Flips);
  }
  state.counters["flips"] = data.Flips;
}

/// A chart's surface to a thousandth of the mesh's diagonal; largest deviation by the tolerance,
/// and what the surface is like outside of the mesh.
void RunMethod(benchmark::State& state, const Case& data, BackMapMethod method)
{
  BackMapParams params;
  params.Method = method;
  params.Tolerance = 1e-3 * data.Diagonal;
  params.Threads = 1;
  Result<BackMap> map;
  for (auto _ : state)
  {
    map = FitBackMap(data.Chart, params);
    if (!map)
    {
      state.SkipWithError(map.Status.Message().c_str());
      return;
    }
  }
  const SurfaceFairness fairness = MeasureFairness(data.Chart, map->Surface);
  state.counters["deviation"] = map->MaxResidual / params.Tolerance;
  state.counters["elements"] = map->Surface.Space->NumElements();
  state.counters["folded"] = 100.0 * fairness.FoldedShare;
  state.counters["dot"] = fairness.MinDot;
  state.counters["area"] = fairness.AreaFactor;
}

/// As Repeat, of what takes seconds.
void RepeatFew(benchmark::internal::Benchmark* b)
{
  TakeFastest(b->Iterations(1), 2);
}

const bool registered = []
{
  for (int elements : { 100, 200 })
  {
    const std::string name = "Penalized/" + std::to_string(elements);
    Repeat(benchmark::RegisterBenchmark(
      name.c_str(), [elements](benchmark::State& state) { RunPenalized(state, elements, 1); }));
    auto* all = benchmark::RegisterBenchmark((name + "/all").c_str(),
      [elements](benchmark::State& state) { RunPenalized(state, elements, 0); });
    all->UseRealTime();
    RepeatFew(all);
  }
  for (int centres : { 2000, 5000 })
  {
    RepeatFew(benchmark::RegisterBenchmark(("Radial/" + std::to_string(centres)).c_str(),
      [centres](benchmark::State& state) { RunRadial(state, centres); }));
  }
  const char* folder = std::getenv("KNOTWORK_MESHES");
  for (const char* name : { "scone_2k", "beetle", "maskgen_3k", "half_glove_a" })
  {
    for (const FlattenMethod chart :
      { FlattenMethod::Isomap, FlattenMethod::Laplacian, FlattenMethod::Hlle })
    {
      const Case data =
        folder ? ReadCase(std::string(folder) + "/" + name + ".off", chart) : Case();
      const std::string prefix = std::string(name) + "/" + ToString(chart);
      if (data.Chart.Points.rows() == 0)
      {
        continue;
      }
      RepeatFew(benchmark::RegisterBenchmark(
        prefix.c_str(), [data](benchmark::State& state) { CountFlips(state, data); }));
      for (BackMapMethod method : { BackMapMethod::Nurbs, BackMapMethod::ContinuedLines,
             BackMapMethod::Rbf, BackMapMethod::Hybrid, BackMapMethod::Penalized })
      {
        if (data.Flips == 0)
        {
          RepeatFew(benchmark::RegisterBenchmark((prefix + "/" + ToString(method)).c_str(),
            [data, method](benchmark::State& state) { RunMethod(state, data, method); }));
        }
      }
    }
  }
  return true;
}();
}
}
