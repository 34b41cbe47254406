// SPDX-License-Identifier: BSD-3-Clause
// Certificates of maps whose own coefficients decide (no subdivision), proof included; and what
// rational cells with weights over two decades cost: regularity, one-to-one-ness and measures. The
// counter is the time a cell.
#include "BenchmarkTools.h"
#include <knotwork/JacobianValidation/BoundaryInjectivity.h>
#include <knotwork/JacobianValidation/CellMeasures.h>
#include <knotwork/JacobianValidation/JacobianCertificate.h>

namespace knotwork
{
namespace
{
/// The unit cell in Greville points, each moved by up to a share of its distance to the next.
BernsteinCells NearlyRegular(CellShape shape, const CellDegree& degree, bool rational, int count)
{
  std::mt19937_64 generator(5);
  const auto random = [&] { return static_cast<double>(generator() >> 11) * 0x1p-52 - 1.0; };
  const int n = NumParameters(shape);
  BernsteinCells cells;
  cells.NumComponents = n;
  cells.Rational = rational;
  const bool triangle = shape == CellShape::Triangle || shape == CellShape::Wedge;
  const bool tetrahedron = shape == CellShape::Tetrahedron;
  for (int c = 0; c < count; ++c)
  {
    double* block = cells.Block(cells.Add(shape, degree));
    const int size = NumCellCoefficients(shape, degree);
    for (int k = 0; k <= degree[2]; ++k)
    {
      for (int j = 0; j <= degree[1]; ++j)
      {
        for (int i = 0; i <= degree[0]; ++i)
        {
          if ((triangle && i + j > degree[0]) || (tetrahedron && i + j + k > degree[0]))
          {
            continue;
          }
          const int index[3] = { i, j, k };
          const int at = CellCoefficient(shape, degree, i, j, k);
          const double w = rational ? 1.0 + 0.1 * random() : 1.0;
          for (int d = 0; d < n; ++d)
          {
            const double p = degree[static_cast<std::size_t>(d)];
            block[d * size + at] = w * (index[d] + 0.1 * random()) / p;
          }
          if (rational)
          {
            block[n * size + at] = w;
          }
        }
      }
    }
  }
  return cells;
}

void Validate(benchmark::State& state, CellShape shape, const CellDegree& degree, bool rational,
  int count, int threads)
{
  const BernsteinCells cells = NearlyRegular(shape, degree, rational, count);
  JacobianParams params;
  params.Threads = threads;
  for (auto _ : state)
  {
    const auto result = ValidateJacobian(cells, params);
    if (!result || result.Value.Verdict != Verdict::Valid || result.Value.Boxes > 0)
    {
      state.SkipWithError("not decided by the coefficients alone");
      return;
    }
  }
  state.counters["cell"] = benchmark::Counter(
    count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void Cases(benchmark::State& state, int threads)
{
  switch (state.range(0))
  {
    case 0:
      state.SetLabel("linear hexahedra");
      return Validate(state, CellShape::Hexahedron, { 1, 1, 1 }, false, 20000, threads);
    case 1:
      state.SetLabel("bicubic quadrilaterals");
      return Validate(state, CellShape::Quadrilateral, { 3, 3, 0 }, false, 20000, threads);
    case 2:
      state.SetLabel("biquadratic rational quadrilaterals");
      return Validate(state, CellShape::Quadrilateral, { 2, 2, 0 }, true, 20000, threads);
    case 3:
      state.SetLabel("tricubic hexahedra");
      return Validate(state, CellShape::Hexahedron, { 3, 3, 3 }, false, 2000, threads);
    case 4:
      state.SetLabel("quadratic tetrahedra");
      return Validate(state, CellShape::Tetrahedron, { 2, 2, 2 }, false, 20000, threads);
    case 5:
      state.SetLabel("quadratic wedges");
      return Validate(state, CellShape::Wedge, { 2, 2, 2 }, false, 10000, threads);
    case 6:
      state.SetLabel("biquadratic quadrilaterals");
      return Validate(state, CellShape::Quadrilateral, { 2, 2, 0 }, false, 20000, threads);
    case 7:
      state.SetLabel("triquadratic hexahedra");
      return Validate(state, CellShape::Hexahedron, { 2, 2, 2 }, false, 10000, threads);
    default:
      state.SetLabel("bicubic rational quadrilaterals");
      return Validate(state, CellShape::Quadrilateral, { 3, 3, 0 }, true, 20000, threads);
  }
}

void JacobianCells(benchmark::State& state)
{
  Cases(state, 1);
}
BENCHMARK(JacobianCells)->Apply(Repeat)->ArgName("case")->DenseRange(0, 8);
void JacobianCellsAllThreads(benchmark::State& state)
{
  Cases(state, 0);
}
BENCHMARK(JacobianCellsAllThreads)
  ->Apply(Repeat)
  ->MeasureProcessCPUTime() // of all threads together: what dividing the work costs
  ->UseRealTime()
  ->ArgName("case")
  ->DenseRange(0, 8);

/// 60 hexahedra or quadratic tetrahedra apart from each other, of random weights from 0.1 to 10.
BernsteinCells WeightedCells(bool hexahedra)
{
  std::mt19937_64 generator(7);
  const auto random = [&] { return static_cast<double>(generator() >> 11) * 0x1p-52 - 1.0; };
  const CellDegree degree = hexahedra ? CellDegree{ 1, 1, 1 } : CellDegree{ 2, 2, 2 };
  BernsteinCells cells;
  cells.NumComponents = 3;
  cells.Rational = true;
  for (int c = 0; c < 60; ++c)
  {
    const CellShape shape = hexahedra ? CellShape::Hexahedron : CellShape::Tetrahedron;
    double* block = cells.Block(cells.Add(shape, degree));
    const int size = NumCellCoefficients(shape, degree);
    for (int k = 0; k <= degree[2]; ++k)
    {
      for (int j = 0; j <= degree[1]; ++j)
      {
        for (int i = 0; i <= degree[0]; ++i)
        {
          if (!hexahedra && i + j + k > degree[0])
          {
            continue;
          }
          const int index[3] = { i, j, k };
          const int at = CellCoefficient(shape, degree, i, j, k);
          const double w = std::pow(10.0, random());
          for (int d = 0; d < 3; ++d)
          {
            const double p = degree[static_cast<std::size_t>(d)];
            block[d * size + at] = w * (index[d] / p + 0.1 * random() + 3.0 * c);
          }
          block[3 * size + at] = w;
        }
      }
    }
  }
  return cells;
}

void WeightedValidation(benchmark::State& state, int threads)
{
  const BernsteinCells cells = WeightedCells(state.range(0) == 0);
  const std::int64_t what = state.range(1);
  JacobianParams params;
  params.Threads = threads;
  InjectivityParams injectivityParams;
  injectivityParams.Threads = threads;
  CellMeasuresParams measuresParams;
  measuresParams.BoundBoxes = 0;
  measuresParams.Threads = threads;
  const auto certificate = ValidateJacobian(cells, params);
  for (auto _ : state)
  {
    const bool done = what == 0 ? ValidateJacobian(cells, params).Value.Verdict == Verdict::Valid
      : what == 1
      ? ProveInjectivity(cells, {}, certificate.Value, injectivityParams).Value.Verdict ==
        InjectivityVerdict::Injective
      : MeasureCells(cells, measuresParams).Value.Total.MeasureError < 1e-9;
    if (!done)
    {
      state.SkipWithError("not decided, or not measured");
      return;
    }
  }
  state.counters["cell"] = benchmark::Counter(
    cells.NumCells(), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void WeightedCellsOneThread(benchmark::State& state)
{
  WeightedValidation(state, 1);
}
BENCHMARK(WeightedCellsOneThread)
  ->Apply(Repeat)
  ->ArgNames({ "shape", "what" })
  ->ArgsProduct({ { 0, 1 }, { 0, 1, 2 } });
void WeightedCellsAllThreads(benchmark::State& state)
{
  WeightedValidation(state, 0);
}
BENCHMARK(WeightedCellsAllThreads)
  ->Apply(Repeat)
  ->MeasureProcessCPUTime()
  ->UseRealTime()
  ->ArgNames({ "shape", "what" })
  ->ArgsProduct({ { 0, 1 }, { 0, 1, 2 } });
}
}
