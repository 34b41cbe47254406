// SPDX-License-Identifier: BSD-3-Clause
// LR B-splines: random cells of levels 0 to 3 of a bicubic mesh of 29 x 29 elements are halved by
// segments five or seven cells long.
#include "BenchmarkTools.h"
#include "LRDependence.h"

namespace knotwork
{
namespace
{
constexpr int BaseElements = 29;

SplineSpacePtr<2> BaseSpace()
{
  const KnotVector knots = KnotVector::Uniform(3, BaseElements);
  return InsertSegments(MakeTensorSpace<2>({ knots, knots }).Value, {}).Value;
}

/// Segments that are legal in their order and change the mesh.
std::vector<LRSegment> LegalSegments(const SplineSpacePtr<2>& space, std::size_t count)
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

void LRMakeSpace(benchmark::State& state)
{
  const auto space = BaseSpace();
  const auto refined = InsertSegments(space, LegalSegments(space, 1000)).Value;
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(MakeLRSpace(refined->LocallyRefined->Basis));
  }
}
BENCHMARK(LRMakeSpace)->Apply(Repeat);

void LRDecideDependence(benchmark::State& state)
{
  const auto space = BaseSpace();
  const auto refined = InsertSegments(space, LegalSegments(space, 1000)).Value;
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(DecideDependence(*refined));
  }
}
BENCHMARK(LRDecideDependence)->Apply(Repeat);

void LREvaluate(benchmark::State& state)
{
  const auto space = BaseSpace();
  const auto refined = InsertSegments(space, LegalSegments(space, 1000)).Value;
  const auto form = MakeBezierForm(RandomSpline<2>(refined, 3));
  RunEvaluation(
    state, form, RandomPoints(NumBenchmarkPoints, 2), static_cast<int>(state.range(0)), 1);
}
BENCHMARK(LREvaluate)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 2);
}
}
