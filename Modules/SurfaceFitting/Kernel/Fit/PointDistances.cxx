// SPDX-License-Identifier: BSD-3-Clause
#include "PointDistances.h"

#include "PointLanes.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/WideVectors.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace knotwork
{
namespace
{
constexpr std::size_t ElementChunk = 16;
constexpr int Slices = 8; // of an element, for the choice of directions

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Squares of the distances at up to eight points from first on; with one component the differences
/// value - surface themselves.
template <typename DegreeU, typename DegreeV>
inline void Differences(const DegreeU p, const DegreeV q, const ParametricBox<2>& box,
  const FitPoints& points, std::size_t first, int count, int components, const double* local,
  double* out)
{
  Eight u[MaxDegree + 1];
  Eight v[MaxDegree + 1];
  BasisAtPoints(p, q, box, points, first, count, u, v);
  std::fill_n(out, Lanes, 0.0);
  for (int c = 0; c < components; ++c)
  {
    const double* coefficients = local + c * (p + 1) * (q + 1);
    Eight sum{};
    for (int k = 0; k <= q; ++k)
    {
      Eight line{};
      for (int j = 0; j <= p; ++j)
      {
        line += coefficients[k * (p + 1) + j] * u[j];
      }
      sum += v[k] * line;
    }
    for (int i = 0; i < count; ++i)
    {
      const double difference = points.Values[At(c)][first + At(i)] - sum[i];
      out[i] = components == 1 ? difference : out[i] + difference * difference;
    }
  }
}

template <typename DegreeU, typename DegreeV>
ElementErrors MeasureElement(const DegreeU p, const DegreeV q, const ParametricBox<2>& box,
  const double* local, int measured, const FitPoints::Range& range, FitPoints& points)
{
  ElementErrors errors;
  for (std::size_t first = range.Begin; first < range.End; first += Lanes)
  {
    const int count = static_cast<int>(std::min<std::size_t>(Lanes, range.End - first));
    double distance[Lanes];
    Differences(p, q, box, points, first, count, measured, local, distance);
    for (int i = 0; i < count; ++i)
    {
      const std::size_t k = first + At(i);
      const double size = measured == 1 ? std::fabs(distance[i]) : std::sqrt(distance[i]);
      points.Distance[k] = measured == 1 ? distance[i] : size;
      if (points.Base[k] == 0.0)
      {
        continue;
      }
      errors.Max = std::max(errors.Max, size);
      const double limit = points.Limit(k);
      errors.Ratio = std::max(errors.Ratio, size / limit);
      errors.Sum += size;
      errors.Squares += size * size;
      errors.NumOutside += size > limit ? 1 : 0;
      ++errors.Count;
    }
  }
  return errors;
}
}

std::vector<ElementErrors> MeasureDistances(const SplineSpace<2>& space,
  const ElementFunctions& functions, const PointMatrix& coefficients, int numMeasured,
  const FitDivision& division, FitPoints& points, int threads)
{
  std::vector<ElementErrors> errors(At(space.NumElements()));
  ParallelFor(errors.size(), ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<double> local(
        At(functions.PerElement) * static_cast<std::size_t>(coefficients.cols()));
      for (std::size_t e = begin; e < end; ++e)
      {
        if (points.Ranges[e].Count() == 0)
        {
          continue;
        }
        functions.LocalCoefficients(static_cast<int>(e), coefficients, local.data());
        const SplineSpace<2>::Element& element = space.Elements[e];
        const auto measure = [&](const auto p, const auto q)
        {
          WithWidestVectors(
            [&](auto)
            {
              errors[e] = MeasureElement(
                p, q, element.Box, local.data(), numMeasured, points.Ranges[e], points);
            });
        };
        if (element.Degree == IntArray<2>{ 2, 2 })
        {
          measure(std::integral_constant<int, 2>{}, std::integral_constant<int, 2>{});
        }
        else if (element.Degree == IntArray<2>{ 3, 3 })
        {
          measure(std::integral_constant<int, 3>{}, std::integral_constant<int, 3>{});
        }
        else
        {
          measure(element.Degree[0], element.Degree[1]);
        }
      }
    });
  division.ShareAll([&](std::size_t e) { return std::pair(&errors[e], std::size_t{ 1 }); });
  return errors;
}

RealArray<2> SplitGains(const SplineSpace<2>& space, const ElementFunctions& functions,
  const PointMatrix& coefficients, int numMeasured, const FitPoints& points, int e)
{
  const SplineSpace<2>::Element& element = space.Elements[At(e)];
  const FitPoints::Range& range = points.Ranges[At(e)];
  const ParametricBox<2>& box = element.Box;
  std::vector<double> local;
  if (numMeasured > 1)
  {
    local.resize(At(functions.PerElement) * static_cast<std::size_t>(coefficients.cols()));
    functions.LocalCoefficients(e, coefficients, local.data());
  }
  RealArray<2> gains{};
  for (int c = 0; c < numMeasured; ++c)
  {
    double sums[2][Slices] = {};
    double weights[2][Slices] = {};
    for (std::size_t i = range.Begin; i < range.End; ++i)
    {
      const double x[2] = { (points.U[i] - box.Lower[0]) / (box.Upper[0] - box.Lower[0]),
        (points.V[i] - box.Lower[1]) / (box.Upper[1] - box.Lower[1]) };
      const double distance = numMeasured == 1 ? points.Distance[i]
                                               : points.Values[At(c)][i] -
          BernsteinEvaluate<2>(element.Degree, local.data() + c * functions.PerElement, x);
      for (int d = 0; d < 2; ++d)
      {
        const int k = std::clamp(static_cast<int>(x[d] * Slices), 0, Slices - 1);
        sums[d][k] += points.Base[i] * distance;
        weights[d][k] += points.Base[i];
      }
    }
    for (int d = 0; d < 2; ++d)
    {
      for (int k = 0; k < Slices; ++k)
      {
        gains[At(d)] += weights[d][k] > 0.0 ? sums[d][k] * sums[d][k] / weights[d][k] : 0.0;
      }
    }
  }
  return gains;
}
}
