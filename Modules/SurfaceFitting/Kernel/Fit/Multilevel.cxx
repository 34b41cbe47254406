// SPDX-License-Identifier: BSD-3-Clause
#include "Multilevel.h"

#include "PointLanes.h"
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/WideVectors.h>

#include <algorithm>

namespace knotwork
{
namespace
{
constexpr std::size_t ElementChunk = 16;
constexpr std::size_t FunctionChunk = 1024;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

double Sum(const Eight& numbers)
{
  double sum = 0.0;
  for (int i = 0; i < Lanes; ++i)
  {
    sum += numbers[i];
  }
  return sum;
}

/// The two sums of the functions alive on an element, numerators of all components first.
class ElementSums
{
public:
  ElementSums(const ElementFunctions& functions, int components)
    : Functions(functions), Components(components), Local(At(functions.PerElement * components))
  {
  }

  /// @param sums  alive x (components + 1), zero before.
  void Add(const SplineSpace<2>::Element& element, int e, const PointMatrix& coefficients,
    const FitPoints& points, double* sums)
  {
    const int n = this->Functions.PerElement;
    const int alive = this->Functions.Alive(e);
    this->Functions.LocalCoefficients(e, coefficients, this->Local.data());
    this->Basis.resize(At(n));
    this->Values.resize(At(alive));
    this->Residuals.resize(At(this->Components));
    const FitPoints::Range range = points.Ranges[At(e)];
    for (std::size_t first = range.Begin; first < range.End; first += Lanes)
    {
      const int count = static_cast<int>(std::min<std::size_t>(Lanes, range.End - first));
      this->Evaluate(element, e, points, first, count);
      this->AddPoints(e, points, first, count, sums);
    }
  }

private:
  void Evaluate(const SplineSpace<2>::Element& element, int e, const FitPoints& points,
    std::size_t first, int count)
  {
    const int n0 = element.Degree[0] + 1;
    const int n = n0 * (element.Degree[1] + 1);
    Eight u[MaxDegree + 1];
    Eight v[MaxDegree + 1];
    BasisAtPoints(element.Degree[0], element.Degree[1], element.Box, points, first, count, u, v);
    for (int b = 0; b < n; ++b)
    {
      this->Basis[At(b)] = u[b % n0] * v[b / n0];
    }
    const auto combine = [&](const double* row, Eight& out)
    {
      Eight sum{};
      for (int b = 0; b < n; ++b)
      {
        sum += row[b] * this->Basis[At(b)];
      }
      out = sum;
    };
    for (int k = 0; k < this->Functions.Alive(e); ++k)
    {
      combine(this->Functions.Row(this->Functions.First(e) + At(k)), this->Values[At(k)]);
    }
    for (int c = 0; c < this->Components; ++c)
    {
      Eight& out = this->Residuals[At(c)];
      combine(this->Local.data() + At(c * n), out);
      for (int i = 0; i < count; ++i)
      {
        out[i] = points.Values[At(c)][first + At(i)] - out[i];
      }
    }
  }

  void AddPoints(int e, const FitPoints& points, std::size_t first, int count, double* sums) const
  {
    const int alive = this->Functions.Alive(e);
    Eight squares{};
    for (int k = 0; k < alive; ++k)
    {
      squares += this->Values[At(k)] * this->Values[At(k)];
    }
    Eight weight{};
    for (int i = 0; i < count; ++i)
    {
      weight[i] = points.Base[first + At(i)] * points.Boost[first + At(i)];
    }
    for (int k = 0; k < alive; ++k)
    {
      const Eight& w = this->Values[At(k)];
      double* out = sums + k * (this->Components + 1);
      const Eight factor = weight * w * w;
      out[this->Components] += Sum(factor);
      for (int c = 0; c < this->Components; ++c)
      {
        out[c] += Sum(factor * w / squares * this->Residuals[At(c)]);
      }
    }
  }

  const ElementFunctions& Functions;
  int Components;
  std::vector<double> Local;
  VectorArray<Eight> Basis;
  VectorArray<Eight> Values;
  VectorArray<Eight> Residuals;
};
}

void MultilevelStep(const SplineSpace<2>& space, const ElementFunctions& functions,
  const FitPoints& points, const std::vector<std::uint8_t>& fixed, const FitDivision& division,
  int threads, PointMatrix& coefficients)
{
  const auto components = static_cast<int>(coefficients.cols());
  const std::size_t stride = At(components + 1);
  std::vector<double> sums(functions.Functions.size() * stride, 0.0);
  ParallelFor(At(space.NumElements()), ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      ElementSums work(functions, components);
      WithWidestVectors(
        [&](auto)
        {
          for (std::size_t e = begin; e < end; ++e)
          {
            if (points.Ranges[e].Count() > 0)
            {
              work.Add(space.Elements[e], static_cast<int>(e), coefficients, points,
                sums.data() + functions.Start[e] * stride);
            }
          }
        });
    });
  division.ShareAll(
    [&](std::size_t e)
    {
      return std::pair(sums.data() + functions.Start[e] * stride,
        At(functions.Alive(static_cast<int>(e))) * stride);
    });
  ParallelFor(At(functions.NumFunctions), FunctionChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<double> total(stride);
      for (std::size_t f = begin; f < end; ++f)
      {
        std::fill(total.begin(), total.end(), 0.0);
        for (std::size_t use = functions.UseStart[f]; use < functions.UseStart[f + 1]; ++use)
        {
          const double* from = sums.data() + functions.Uses[use] * stride;
          for (std::size_t c = 0; c < stride; ++c)
          {
            total[c] += from[c];
          }
        }
        if (total[At(components)] > 0.0 && (fixed.empty() || fixed[f] == 0))
        {
          for (int c = 0; c < components; ++c)
          {
            coefficients(static_cast<Eigen::Index>(f), c) += total[At(c)] / total[At(components)];
          }
        }
      }
    });
}
}
