// SPDX-License-Identifier: BSD-3-Clause
// Hierarchical splines: a bicubic surface refined along the diagonal to level 6 (8551 functions)
// and a tricubic volume refined around a sphere to level 3 (40,295 functions).
#include "BenchmarkTools.h"
#include <knotwork/SplineCore/HierarchicalSpace.h>

#include <cmath>

namespace knotwork
{
namespace
{
constexpr int DiagonalElements = 16;
constexpr int DiagonalLevels = 6;
constexpr int DiagonalFunctions = 8551;
constexpr int SphereElements = 8;
constexpr int SphereLevels = 3;
constexpr int SphereFunctions = 40295;

template <int Dim>
std::array<KnotVector, Dim> UniformKnots(int elements)
{
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(3, elements));
  return knots;
}

/// Cell of level l grown by one cell of its level to every side, in cells of level l + 1.
template <int Dim>
HierarchyBox<Dim> GrownChildren(int level, int elements, const std::array<std::int64_t, Dim>& cell)
{
  HierarchyBox<Dim> box;
  box.Level = level + 1;
  const std::int64_t end = static_cast<std::int64_t>(elements) << (level + 1);
  for (std::size_t d = 0; d < Dim; ++d)
  {
    box.Lower[d] = std::max<std::int64_t>(2 * (cell[d] - 1), 0);
    box.Upper[d] = std::min(2 * (cell[d] + 2), end);
  }
  return box;
}

/// The boxes of one level of the diagonal: level-l cells (i, i), grown.
std::vector<HierarchyBox<2>> DiagonalBoxes(int level)
{
  std::vector<HierarchyBox<2>> boxes;
  for (std::int64_t i = 0; i < (DiagonalElements << level); ++i)
  {
    boxes.push_back(GrownChildren<2>(level, DiagonalElements, { i, i }));
  }
  return boxes;
}
std::vector<HierarchyBox<2>> AllDiagonalBoxes()
{
  std::vector<HierarchyBox<2>> boxes;
  for (int level = 0; level < DiagonalLevels; ++level)
  {
    const auto more = DiagonalBoxes(level);
    boxes.insert(boxes.end(), more.begin(), more.end());
  }
  return boxes;
}

/// Level-l cells that the sphere of radius 0.35 about the centre crosses, grown; all levels.
std::vector<HierarchyBox<3>> AllSphereBoxes()
{
  std::vector<HierarchyBox<3>> boxes;
  for (int level = 0; level < SphereLevels; ++level)
  {
    const std::int64_t n = SphereElements << level;
    for (std::int64_t k = 0; k < n; ++k)
    {
      for (std::int64_t j = 0; j < n; ++j)
      {
        for (std::int64_t i = 0; i < n; ++i)
        {
          const std::array<std::int64_t, 3> cell{ i, j, k };
          double nearest = 0.0;
          double farthest = 0.0;
          for (std::int64_t index : cell)
          {
            const double lower = static_cast<double>(index) / static_cast<double>(n) - 0.5;
            const double upper = static_cast<double>(index + 1) / static_cast<double>(n) - 0.5;
            const double low = std::max({ lower, -upper, 0.0 });
            const double high = std::max(-lower, upper);
            nearest += low * low;
            farthest += high * high;
          }
          if (nearest <= 0.35 * 0.35 && farthest >= 0.35 * 0.35)
          {
            boxes.push_back(GrownChildren<3>(level, SphereElements, cell));
          }
        }
      }
    }
  }
  return boxes;
}

template <int Dim>
bool HasFunctions(benchmark::State& state, const Result<SplineSpacePtr<Dim>>& space, int expected)
{
  if (!space || space.Value->NumFunctions != expected)
  {
    state.SkipWithError("not the space of the table");
    return false;
  }
  return true;
}

template <int Dim>
void Build(benchmark::State& state, int elements, const std::vector<HierarchyBox<Dim>>& boxes,
  int numFunctions)
{
  for (auto _ : state)
  {
    const auto space = MakeHierarchicalSpace<Dim>(UniformKnots<Dim>(elements), boxes);
    if (!HasFunctions<Dim>(state, space, numFunctions))
    {
      return;
    }
  }
}

template <int Dim>
void MakeForm(benchmark::State& state, int elements, const std::vector<HierarchyBox<Dim>>& boxes)
{
  const auto space = MakeHierarchicalSpace<Dim>(UniformKnots<Dim>(elements), boxes);
  const Spline<Dim> spline = RandomSpline<Dim>(space.Value, 3);
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(MakeBezierForm(spline, 1));
  }
}

template <int Dim>
void Evaluate(benchmark::State& state, int elements, const std::vector<HierarchyBox<Dim>>& boxes,
  const PointMatrix& points, int threads)
{
  const auto space = MakeHierarchicalSpace<Dim>(UniformKnots<Dim>(elements), boxes);
  const auto form = MakeBezierForm(RandomSpline<Dim>(space.Value, 3));
  RunEvaluation(state, form, points, static_cast<int>(state.range(0)), threads);
}

void DiagonalBuild(benchmark::State& state)
{
  Build<2>(state, DiagonalElements, AllDiagonalBoxes(), DiagonalFunctions);
}
BENCHMARK(DiagonalBuild)->Apply(Repeat);

void DiagonalMakeBezierForm(benchmark::State& state)
{
  MakeForm<2>(state, DiagonalElements, AllDiagonalBoxes());
}
BENCHMARK(DiagonalMakeBezierForm)->Apply(Repeat);

/// A geometry refined level by level, its control points carried along.
void DiagonalRefineGeometry(benchmark::State& state)
{
  const auto coarse = MakeHierarchicalSpace<2>(UniformKnots<2>(DiagonalElements), {});
  const Spline<2> start = RandomSpline<2>(coarse.Value, 3);
  for (auto _ : state)
  {
    Spline<2> spline = start;
    for (int level = 0; level < DiagonalLevels; ++level)
    {
      const auto space = RefineBoxes<2>(spline.Space, DiagonalBoxes(level));
      spline = TransferToRefined<2>(spline, space.Value).Value;
    }
    if (!HasFunctions<2>(state, { spline.Space }, DiagonalFunctions))
    {
      return;
    }
  }
}
BENCHMARK(DiagonalRefineGeometry)->Apply(Repeat);

void DiagonalEvaluate(benchmark::State& state)
{
  Evaluate<2>(state, DiagonalElements, AllDiagonalBoxes(), RandomPoints(NumBenchmarkPoints, 2), 1);
}
BENCHMARK(DiagonalEvaluate)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 1);

/// Points within 1/128 of the diagonal: nearly all on the finest levels.
void DiagonalEvaluateNear(benchmark::State& state)
{
  PointMatrix points = RandomPoints(NumBenchmarkPoints, 2);
  points.col(1) =
    (points.col(0).array() + (points.col(1).array() - 0.5) / 64.0).max(0.0).min(1.0).matrix();
  Evaluate<2>(state, DiagonalElements, AllDiagonalBoxes(), points, 1);
}
BENCHMARK(DiagonalEvaluateNear)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 1);

void DiagonalEvaluateAllThreads(benchmark::State& state)
{
  Evaluate<2>(state, DiagonalElements, AllDiagonalBoxes(), RandomPoints(NumBenchmarkPoints, 2), 0);
}
BENCHMARK(DiagonalEvaluateAllThreads)
  ->Apply(Repeat)
  ->UseRealTime()
  ->ArgName("derivatives")
  ->DenseRange(0, 1);

void SphereBuild(benchmark::State& state)
{
  Build<3>(state, SphereElements, AllSphereBoxes(), SphereFunctions);
}
BENCHMARK(SphereBuild)->Apply(Repeat);

void SphereMakeBezierForm(benchmark::State& state)
{
  MakeForm<3>(state, SphereElements, AllSphereBoxes());
}
BENCHMARK(SphereMakeBezierForm)->Apply(Repeat);

void SphereEvaluate(benchmark::State& state)
{
  Evaluate<3>(state, SphereElements, AllSphereBoxes(), RandomPoints(NumBenchmarkPoints, 3), 1);
}
BENCHMARK(SphereEvaluate)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 1);

void SphereEvaluateAllThreads(benchmark::State& state)
{
  Evaluate<3>(state, SphereElements, AllSphereBoxes(), RandomPoints(NumBenchmarkPoints, 3), 0);
}
BENCHMARK(SphereEvaluateAllThreads)
  ->Apply(Repeat)
  ->UseRealTime()
  ->ArgName("derivatives")
  ->DenseRange(0, 1);
}
}
