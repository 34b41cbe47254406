// SPDX-License-Identifier: BSD-3-Clause
// LR B-splines: random cells of levels 0 to 3 of a mesh of 29 x 29 elements are halved by segments
// five or seven cells long; and a biquadratic height field refined around two peaks.
#include "BenchmarkTools.h"
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SplineCore/LRStrategies.h>

#include <cmath>

namespace knotwork
{
namespace
{
constexpr int BaseElements = 29;

/// What is refined.
enum Variant
{
  Bicubic,
  CubicQuadratic, // bidegree (3, 2)
  DoubleLines,    // bicubic, segments of multiplicity 2
  Rational        // bicubic, three coordinates and weights
};

SplineSpacePtr<2> BaseSpace(int variant = Bicubic)
{
  return InsertSegments(
    MakeTensorSpace<2>({ KnotVector::Uniform(3, BaseElements),
                         KnotVector::Uniform(variant == CubicQuadratic ? 2 : 3, BaseElements) })
      .Value,
    {}, 0)
    .Value;
}

/// Segments that are legal in their order and change the mesh.
std::vector<LRSegment> LegalSegments(
  const SplineSpacePtr<2>& space, std::size_t count, int multiplicity = 1)
{
  std::mt19937 generator(1);
  const auto below = [&](int n)
  { return static_cast<int>(generator() % static_cast<unsigned>(n)); };
  LRRefinement refinement(*space, PointMatrix(space->NumFunctions, 0));
  std::vector<LRSegment> segments;
  while (segments.size() < count)
  {
    const int cells = BaseElements << below(4);
    const int half = 2 + below(2);
    LRSegment segment;
    segment.Direction = below(2);
    segment.Value = (below(cells) + 0.5) / cells;
    const int middle = below(cells);
    segment.Start = 1.0 * std::max(middle - half, 0) / cells;
    segment.End = 1.0 * std::min(middle + half + 1, cells) / cells;
    segment.Multiplicity = multiplicity;
    const int before = refinement.NumFunctions();
    if (refinement.Insert(segment) && refinement.NumFunctions() > before)
    {
      segments.push_back(segment);
    }
  }
  return segments;
}

/// Insertion with three coordinates carried along, without the space at the end.
void LRInsert(benchmark::State& state)
{
  const auto space = BaseSpace();
  const auto segments = LegalSegments(space, static_cast<std::size_t>(state.range(0)));
  const PointMatrix points = RandomPoints(space->NumFunctions, 3);
  for (auto _ : state)
  {
    LRRefinement refinement(*space, points);
    for (const LRSegment& segment : segments)
    {
      if (!refinement.Insert(segment))
      {
        state.SkipWithError("a segment is not legal");
        return;
      }
    }
    state.counters["functions"] = refinement.NumFunctions();
  }
}
BENCHMARK(LRInsert)->Apply(Repeat)->ArgName("segments")->Arg(1000)->Arg(4000)->Arg(8000);

/// Insertion and the space at the end.
void Replay(benchmark::State& state, int threads)
{
  const auto variant = static_cast<int>(state.range(0));
  const auto space = BaseSpace(variant);
  const auto segments =
    LegalSegments(space, static_cast<std::size_t>(state.range(1)), variant == DoubleLines ? 2 : 1);
  const PointMatrix points = RandomPoints(space->NumFunctions, variant == Rational ? 4 : 3);
  for (auto _ : state)
  {
    LRRefinement refinement(*space, points);
    bool legal = true;
    for (const LRSegment& segment : segments)
    {
      legal = legal && refinement.Insert(segment);
    }
    PointMatrix rows;
    const auto refined = refinement.Finish(&rows, threads);
    if (!legal || !refined)
    {
      state.SkipWithError("a segment is not legal");
      return;
    }
    state.counters["functions"] = refined.Value->NumFunctions;
  }
}
void LRReplay(benchmark::State& state)
{
  Replay(state, 1);
}
void LRReplayAllThreads(benchmark::State& state)
{
  Replay(state, 0);
}
void ReplaySizes(benchmark::internal::Benchmark* b)
{
  Repeat(b);
  b->ArgNames({ "variant", "segments" });
  b->Args({ Bicubic, 8000 });
  for (const int variant : { Bicubic, CubicQuadratic, DoubleLines, Rational })
  {
    b->Args({ variant, 1000 });
  }
}
BENCHMARK(LRReplay)->Apply(ReplaySizes);
BENCHMARK(LRReplayAllThreads)->Apply(ReplaySizes)->UseRealTime();

void LRMakeSpace(benchmark::State& state)
{
  const auto space = BaseSpace();
  const auto refined = InsertSegments(space, LegalSegments(space, 1000), 0).Value;
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(MakeLRSpace(refined->LocallyRefined->Basis, 0));
  }
}
BENCHMARK(LRMakeSpace)->Apply(Repeat);

void LRDecideDependence(benchmark::State& state)
{
  const auto space = BaseSpace();
  const auto refined = InsertSegments(space, LegalSegments(space, 1000), 0).Value;
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(DecideDependence(*refined));
  }
}
BENCHMARK(LRDecideDependence)->Apply(Repeat);

void LREvaluate(benchmark::State& state)
{
  const auto space = BaseSpace();
  const auto refined = InsertSegments(space, LegalSegments(space, 1000), 0).Value;
  const auto form = MakeBezierForm(RandomSpline<2>(refined, 3));
  RunEvaluation(
    state, form, RandomPoints(NumBenchmarkPoints, 2), static_cast<int>(state.range(0)), 1);
}
BENCHMARK(LREvaluate)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 2);

/// A height field that needs small elements around two peaks: about 500 biquadratic functions.
Spline<2> TwoPeaks()
{
  const KnotVector knots = KnotVector::Uniform(2, 8);
  auto space = InsertSegments(MakeTensorSpace<2>({ knots, knots }).Value, {}, 0).Value;
  const double peaks[2][2] = { { 0.3, 0.35 }, { 0.7, 0.6 } };
  for (const double radius : { 0.2, 0.14, 0.07 })
  {
    std::vector<int> near;
    for (int e = 0; e < space->NumElements(); ++e)
    {
      const ParametricBox<2>& box = space->Elements[static_cast<std::size_t>(e)].Box;
      const double u = 0.5 * (box.Lower[0] + box.Upper[0]);
      const double v = 0.5 * (box.Lower[1] + box.Upper[1]);
      if (std::any_of(std::begin(peaks), std::end(peaks),
            [&](const double* peak) { return std::hypot(u - peak[0], v - peak[1]) < radius; }))
      {
        near.push_back(e);
      }
    }
    space = InsertSegments(space, SegmentsForElements(*space, near).Value, 0).Value;
  }
  return RandomSpline<2>(space, 1);
}

void LRPeaks(benchmark::State& state)
{
  const Spline<2> spline = TwoPeaks();
  state.counters["functions"] = spline.Space->NumFunctions;
  RunEvaluation(state, MakeBezierForm(spline), RandomPoints(NumBenchmarkPoints, 2),
    static_cast<int>(state.range(0)), 1);
}
BENCHMARK(LRPeaks)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 1);

/// 1000 x 1000 points, row by row.
PointMatrix GridPoints()
{
  constexpr int n = 1000;
  PointMatrix points(n * n, 2);
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      points.row(j * n + i) << i / (n - 1.0), j / (n - 1.0);
    }
  }
  return points;
}

void LRPeaksGrid(benchmark::State& state)
{
  const Spline<2> spline = TwoPeaks();
  RunEvaluation(state, MakeBezierForm(spline), GridPoints(), static_cast<int>(state.range(0)), 1);
}
BENCHMARK(LRPeaksGrid)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 1);
}
}
