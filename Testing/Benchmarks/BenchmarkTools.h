// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>

namespace knotwork
{
constexpr int NumBenchmarkPoints = 1000000;

/// n x Dim seeded random points of the unit cube.
inline PointMatrix RandomPoints(int n, int dim, unsigned seed = 42)
{
  std::mt19937_64 generator(seed);
  PointMatrix points(n, dim);
  for (Eigen::Index i = 0; i < points.size(); ++i)
  {
    points.data()[i] = static_cast<double>(generator() >> 11) * 0x1p-53;
  }
  return points;
}

/// A spline with random control points (time does not depend on their values).
template <int Dim>
Spline<Dim> RandomSpline(const SplineSpacePtr<Dim>& space, int components, bool rational = false)
{
  Spline<Dim> spline;
  spline.Space = space;
  spline.ControlPoints = RandomPoints(space->NumFunctions, components, 7);
  if (rational)
  {
    spline.Weights = (RandomPoints(space->NumFunctions, 1, 8).array() + 0.5).matrix();
  }
  return spline;
}

/// Repetitions whose minimum is the figure to quote: other programs can only add time.
inline void TakeFastest(benchmark::internal::Benchmark* b, int repetitions)
{
  b->Repetitions(repetitions)->ReportAggregatesOnly(true)->Unit(benchmark::kMillisecond);
  b->ComputeStatistics(
    "min", [](const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); });
}

/// The same of short benchmarks. With threads != 1 the wall clock counts, with one thread the
/// processor time.
inline void Repeat(benchmark::internal::Benchmark* b)
{
  TakeFastest(b->MinTime(0.02), 20);
}

/// Time a point as a counter, printed in nanoseconds.
inline void CountPoints(benchmark::State& state, double pointsPerIteration)
{
  state.counters["point"] = benchmark::Counter(pointsPerIteration,
    benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Times EvaluateParameters into a batch that is kept, so the system gives it memory only once.
template <int Dim>
void RunEvaluation(benchmark::State& state, const BezierForm<Dim>& form, const PointMatrix& points,
  int derivatives, int threads)
{
  EvaluationParams params;
  params.Derivatives = derivatives;
  params.Threads = threads;
  EvaluationBatch batch;
  const Status first = EvaluateParameters(form, points, params, batch);
  for (auto _ : state)
  {
    if (!first || !EvaluateParameters(form, points, params, batch))
    {
      state.SkipWithError("evaluation failed");
      return;
    }
    benchmark::DoNotOptimize(batch.Values.data());
  }
  CountPoints(state, static_cast<double>(points.rows()));
}
}
