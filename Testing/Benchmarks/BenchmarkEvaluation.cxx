// SPDX-License-Identifier: BSD-3-Clause
// Evaluation of tensor-product splines at random points: bicubic surface with 64 x 64 elements and
// tricubic volume with 16^3 elements, three components; the same by plain loops.
#include "BenchmarkTools.h"

namespace knotwork
{
namespace
{
template <int Dim>
SplineSpacePtr<Dim> UniformSpace(int degree, int elements)
{
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(degree, elements));
  return MakeTensorSpace<Dim>(knots).Value;
}

/// Interior knots are sorted random numbers: neighbouring elements differ by orders of magnitude.
template <int Dim>
SplineSpacePtr<Dim> RandomKnotSpace(int degree, int elements)
{
  std::array<KnotVector, Dim> knots;
  for (int d = 0; d < Dim; ++d)
  {
    const PointMatrix r = RandomPoints(elements - 1, 1, 100 + static_cast<unsigned>(d));
    std::vector<double> t(r.data(), r.data() + r.size());
    std::sort(t.begin(), t.end());
    t.insert(t.begin(), static_cast<std::size_t>(degree + 1), 0.0);
    t.insert(t.end(), static_cast<std::size_t>(degree + 1), 1.0);
    knots[static_cast<std::size_t>(d)] = KnotVector::Create(degree, t).Value;
  }
  return MakeTensorSpace<Dim>(knots).Value;
}

void Surface(benchmark::State& state)
{
  const auto form = MakeBezierForm(RandomSpline<2>(UniformSpace<2>(3, 64), 3));
  RunEvaluation(
    state, form, RandomPoints(NumBenchmarkPoints, 2), static_cast<int>(state.range(0)), 1);
}
BENCHMARK(Surface)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 2);

void SurfaceAllThreads(benchmark::State& state)
{
  const auto form = MakeBezierForm(RandomSpline<2>(UniformSpace<2>(3, 64), 3));
  RunEvaluation(
    state, form, RandomPoints(NumBenchmarkPoints, 2), static_cast<int>(state.range(0)), 0);
}
BENCHMARK(SurfaceAllThreads)
  ->Apply(Repeat)
  ->UseRealTime()
  ->ArgName("derivatives")
  ->DenseRange(0, 1);

void SurfaceRandomKnots(benchmark::State& state)
{
  const auto form = MakeBezierForm(RandomSpline<2>(RandomKnotSpace<2>(3, 64), 3));
  RunEvaluation(
    state, form, RandomPoints(NumBenchmarkPoints, 2), static_cast<int>(state.range(0)), 1);
}
BENCHMARK(SurfaceRandomKnots)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 1);

void SurfaceRational(benchmark::State& state)
{
  const auto form = MakeBezierForm(RandomSpline<2>(UniformSpace<2>(3, 64), 3, true));
  RunEvaluation(
    state, form, RandomPoints(NumBenchmarkPoints, 2), static_cast<int>(state.range(0)), 1);
}
BENCHMARK(SurfaceRational)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 1);

void SurfaceOfDegree(benchmark::State& state)
{
  const auto form =
    MakeBezierForm(RandomSpline<2>(UniformSpace<2>(static_cast<int>(state.range(0)), 64), 3));
  RunEvaluation(state, form, RandomPoints(NumBenchmarkPoints, 2), 0, 1);
}
BENCHMARK(SurfaceOfDegree)->Apply(Repeat)->ArgName("degree")->DenseRange(1, 9);

void Volume(benchmark::State& state)
{
  const auto form = MakeBezierForm(RandomSpline<3>(UniformSpace<3>(3, 16), 3));
  RunEvaluation(
    state, form, RandomPoints(NumBenchmarkPoints, 3), static_cast<int>(state.range(0)), 1);
}
BENCHMARK(Volume)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 2);

void VolumeAllThreads(benchmark::State& state)
{
  const auto form = MakeBezierForm(RandomSpline<3>(UniformSpace<3>(3, 16), 3));
  RunEvaluation(
    state, form, RandomPoints(NumBenchmarkPoints, 3), static_cast<int>(state.range(0)), 0);
}
BENCHMARK(VolumeAllThreads)->Apply(Repeat)->UseRealTime()->ArgName("derivatives")->DenseRange(0, 1);

void VolumeRandomKnots(benchmark::State& state)
{
  const auto form = MakeBezierForm(RandomSpline<3>(RandomKnotSpace<3>(3, 16), 3));
  RunEvaluation(
    state, form, RandomPoints(NumBenchmarkPoints, 3), static_cast<int>(state.range(0)), 1);
}
BENCHMARK(VolumeRandomKnots)->Apply(Repeat)->ArgName("derivatives")->DenseRange(0, 1);

template <int Dim>
void MakeSpace(benchmark::State& state, int elements)
{
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(UniformSpace<Dim>(3, elements));
  }
}
void SurfaceMakeSpace(benchmark::State& state)
{
  MakeSpace<2>(state, 64);
}
BENCHMARK(SurfaceMakeSpace)->Apply(Repeat);
void VolumeMakeSpace(benchmark::State& state)
{
  MakeSpace<3>(state, 16);
}
BENCHMARK(VolumeMakeSpace)->Apply(Repeat);

template <int Dim>
void MakeForm(benchmark::State& state, int elements)
{
  const Spline<Dim> spline = RandomSpline<Dim>(UniformSpace<Dim>(3, elements), 3);
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(MakeBezierForm(spline, 1));
  }
}
void SurfaceMakeBezierForm(benchmark::State& state)
{
  MakeForm<2>(state, 64);
}
BENCHMARK(SurfaceMakeBezierForm)->Apply(Repeat);
void VolumeMakeBezierForm(benchmark::State& state)
{
  MakeForm<3>(state, 16);
}
BENCHMARK(VolumeMakeBezierForm)->Apply(Repeat);

// ---- the same by plain loops: what to compare with -----------------------------------------

/// Span by bisection and basis functions (The NURBS Book, algorithms A2.1, A2.2), then the sum over
/// the control points.
template <int Dim>
void CoxDeBoor(benchmark::State& state, int elements)
{
  const Spline<Dim> spline = RandomSpline<Dim>(UniformSpace<Dim>(3, elements), 3);
  const std::vector<double>& t = spline.Space->Knots[0].Knots();
  const int p = 3;
  const int n = spline.Space->Knots[0].NumFunctions();
  const PointMatrix points = RandomPoints(NumBenchmarkPoints, Dim);
  PointMatrix values(points.rows(), 3);
  for (auto _ : state)
  {
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      int first[3] = { 0, 0, 0 };
      double basis[3][4] = { { 1.0 }, { 1.0 }, { 1.0 } };
      for (int d = 0; d < Dim; ++d)
      {
        const double u = points(i, d);
        const int span =
          static_cast<int>(std::upper_bound(t.begin() + p, t.begin() + n, u) - t.begin()) - 1;
        first[d] = span - p;
        double left[4];
        double right[4];
        for (int j = 1; j <= p; ++j)
        {
          left[j] = u - t[static_cast<std::size_t>(span + 1 - j)];
          right[j] = t[static_cast<std::size_t>(span + j)] - u;
          double saved = 0.0;
          for (int r = 0; r < j; ++r)
          {
            const double ratio = basis[d][r] / (right[r + 1] + left[j - r]);
            basis[d][r] = saved + right[r + 1] * ratio;
            saved = left[j - r] * ratio;
          }
          basis[d][j] = saved;
        }
      }
      double sum[3] = { 0.0, 0.0, 0.0 };
      for (int c = 0; c <= (Dim > 2 ? p : 0); ++c)
      {
        for (int b = 0; b <= (Dim > 1 ? p : 0); ++b)
        {
          const double w = basis[1][b] * basis[2][c];
          const int row = ((first[2] + c) * n + first[1] + b) * n + first[0];
          for (int a = 0; a <= p; ++a)
          {
            for (int k = 0; k < 3; ++k)
            {
              sum[k] += w * basis[0][a] * spline.ControlPoints(row + a, k);
            }
          }
        }
      }
      values.row(i) << sum[0], sum[1], sum[2];
    }
    benchmark::DoNotOptimize(values.data());
  }
  CountPoints(state, NumBenchmarkPoints);
}
void PlainCoxDeBoorSurface(benchmark::State& state)
{
  CoxDeBoor<2>(state, 64);
}
BENCHMARK(PlainCoxDeBoorSurface)->Apply(Repeat);
void PlainCoxDeBoorVolume(benchmark::State& state)
{
  CoxDeBoor<3>(state, 16);
}
BENCHMARK(PlainCoxDeBoorVolume)->Apply(Repeat);

/// Uniform cell by multiplication, cubic Bernstein polynomials, one sum a component.
template <int Dim>
void BezierLoop(benchmark::State& state, int elements)
{
  const auto form = MakeBezierForm(RandomSpline<Dim>(UniformSpace<Dim>(3, elements), 3));
  const PointMatrix points = RandomPoints(NumBenchmarkPoints, Dim);
  PointMatrix values(points.rows(), 3);
  for (auto _ : state)
  {
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      int e = 0;
      double basis[3][4] = { { 1.0 }, { 1.0 }, { 1.0 } };
      for (int d = Dim - 1; d >= 0; --d)
      {
        const double x = points(i, d) * elements;
        const int cell = std::min(static_cast<int>(x), elements - 1);
        e = e * elements + cell;
        const double r = x - cell;
        const double s = 1.0 - r;
        basis[d][0] = s * s * s;
        basis[d][1] = 3.0 * s * s * r;
        basis[d][2] = 3.0 * s * r * r;
        basis[d][3] = r * r * r;
      }
      const double* q = form.Block(e);
      for (int k = 0; k < 3; ++k)
      {
        double sum = 0.0;
        for (int c = 0; c <= (Dim > 2 ? 3 : 0); ++c)
        {
          for (int b = 0; b <= (Dim > 1 ? 3 : 0); ++b, q += 4)
          {
            sum += basis[1][b] * basis[2][c] *
              (basis[0][0] * q[0] + basis[0][1] * q[1] + basis[0][2] * q[2] + basis[0][3] * q[3]);
          }
        }
        values(i, k) = sum;
      }
    }
    benchmark::DoNotOptimize(values.data());
  }
  CountPoints(state, NumBenchmarkPoints);
}
void PlainBezierSurface(benchmark::State& state)
{
  BezierLoop<2>(state, 64);
}
BENCHMARK(PlainBezierSurface)->Apply(Repeat);
void PlainBezierVolume(benchmark::State& state)
{
  BezierLoop<3>(state, 16);
}
BENCHMARK(PlainBezierVolume)->Apply(Repeat);
}
}
