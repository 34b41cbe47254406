// SPDX-License-Identifier: BSD-3-Clause
#include "ElementMoments.h"

#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/BernsteinBasis.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <type_traits>

namespace knotwork
{
namespace
{
constexpr std::size_t ElementChunk = 16;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Sums over the points of a range. Degrees are constants of the compiler or ints.
template <typename DegreeU, typename DegreeV>
void AddPoints(const DegreeU p, const DegreeV q, const ParametricBox<2>& box,
  const FitPoints& points, const FitPoints::Range& range, int components, double* block)
{
  const double scale0 = 1.0 / (box.Upper[0] - box.Lower[0]);
  const double scale1 = 1.0 / (box.Upper[1] - box.Lower[1]);
  double* right = block + (2 * p + 1) * (2 * q + 1);
  for (std::size_t i = range.Begin; i < range.End; ++i)
  {
    const double weight = points.Base[i] * points.Boost[i];
    if (weight == 0.0)
    {
      continue;
    }
    const double s = (points.U[i] - box.Lower[0]) * scale0;
    const double t = (points.V[i] - box.Lower[1]) * scale1;
    double u[2 * MaxDegree + 1];
    double v[2 * MaxDegree + 1];
    const auto basis = [](const auto degree, double x, double* values)
    { BernsteinBasis<0>(degree, x, 1.0, values, 0); };
    if constexpr (std::is_same_v<DegreeU, int>)
    {
      basis(2 * p, s, u);
      basis(2 * q, t, v);
    }
    else
    {
      basis(std::integral_constant<int, 2 * DegreeU::value>{}, s, u);
      basis(std::integral_constant<int, 2 * DegreeV::value>{}, t, v);
    }
    for (int k = 0; k <= 2 * q; ++k)
    {
      const double wv = weight * v[k];
      for (int j = 0; j <= 2 * p; ++j)
      {
        block[k * (2 * p + 1) + j] += wv * u[j];
      }
    }
    basis(p, s, u);
    basis(q, t, v);
    for (int c = 0; c < components; ++c)
    {
      const double wz = weight * points.Values[At(c)][i];
      double* out = right + c * (p + 1) * (q + 1);
      for (int k = 0; k <= q; ++k)
      {
        const double wzv = wz * v[k];
        for (int j = 0; j <= p; ++j)
        {
          out[k * (p + 1) + j] += wzv * u[j];
        }
      }
    }
  }
}
}

ElementMoments::ElementMoments(
  const IntArray<2>& degree, int numComponents, const FitDivision& division)
  : Degree(degree), Components(numComponents), Division(division)
{
  for (std::size_t d = 0; d < 2; ++d)
  {
    const int p = degree[d];
    for (int i = 0; i <= p; ++i)
    {
      for (int k = 0; k <= p; ++k)
      {
        this->Factors[d].push_back(Binomial(p, i) * Binomial(p, k) / Binomial(2 * p, i + k));
      }
    }
  }
}

void ElementMoments::Accumulate(
  const SplineSpace<2>& space, int e, const FitPoints& points, double* block) const
{
  std::fill_n(block, this->Stride(), 0.0);
  const ParametricBox<2>& box = space.Elements[At(e)].Box;
  const FitPoints::Range& range = points.Ranges[At(e)];
  const auto add = [&](const auto p, const auto q)
  { AddPoints(p, q, box, points, range, this->Components, block); };
  if (this->Degree == IntArray<2>{ 2, 2 })
  {
    add(std::integral_constant<int, 2>{}, std::integral_constant<int, 2>{});
  }
  else if (this->Degree == IntArray<2>{ 3, 3 })
  {
    add(std::integral_constant<int, 3>{}, std::integral_constant<int, 3>{});
  }
  else
  {
    add(this->Degree[0], this->Degree[1]);
  }
}

void ElementMoments::Update(const SplineSpace<2>& space, const std::vector<int>& parents,
  const std::vector<bool>& isSplit, const FitPoints& points, int threads)
{
  const std::size_t stride = At(this->Stride());
  UntouchedVector<double> old(At(space.NumElements()) * stride);
  old.swap(this->Data);
  ParallelFor(At(space.NumElements()), ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        double* block = this->Data.data() + e * stride;
        if (!parents.empty() && !isSplit[At(parents[e])])
        {
          std::copy_n(old.data() + At(parents[e]) * stride, stride, block);
        }
        else
        {
          this->Accumulate(space, static_cast<int>(e), points, block);
        }
      }
    });
  std::vector<int> made;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    if (parents.empty() || isSplit[At(parents[At(e)])])
    {
      made.push_back(e);
    }
  }
  this->Share(made);
}

void ElementMoments::Share(const std::vector<int>& elements)
{
  const std::size_t stride = At(this->Stride());
  this->Division.Share(elements,
    [&](std::size_t k) { return std::pair(this->Data.data() + At(elements[k]) * stride, stride); });
}

void ElementMoments::Recompute(const SplineSpace<2>& space, const std::vector<int>& elements,
  const FitPoints& points, int threads)
{
  ParallelFor(elements.size(), ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t k = begin; k < end; ++k)
      {
        this->Accumulate(
          space, elements[k], points, this->Data.data() + At(elements[k]) * At(this->Stride()));
      }
    });
  this->Share(elements);
}

double ElementMoments::Weight(int e) const
{
  const double* block = this->Block(e);
  double sum = 0.0;
  for (int i = 0; i < this->NumMoments(); ++i)
  {
    sum += block[i];
  }
  return sum;
}

void ElementMoments::Gram(int e, double* matrix) const
{
  const int n0 = this->Degree[0] + 1;
  const int n1 = this->Degree[1] + 1;
  const int m0 = 2 * this->Degree[0] + 1;
  const double* block = this->Block(e);
  for (int j = 0; j < n1; ++j)
  {
    for (int i = 0; i < n0; ++i)
    {
      double* row = matrix + (j * n0 + i) * n0 * n1;
      for (int l = 0; l < n1; ++l)
      {
        const double fv = this->Factors[1][At(j * n1 + l)];
        const double* moments = block + (j + l) * m0 + i;
        for (int k = 0; k < n0; ++k)
        {
          row[l * n0 + k] = fv * this->Factors[0][At(i * n0 + k)] * moments[k];
        }
      }
    }
  }
}

std::vector<double> ThinPlateMatrix(const IntArray<2>& degree)
{
  // Gram matrices of the order-th derivatives of the Bernstein polynomials of a direction
  const auto gram = [](int p, int order)
  {
    std::vector<double> result(At((p + 1) * (p + 1)), 0.0);
    if (order > p)
    {
      return result;
    }
    const int r = p - order;
    double scale = 1.0;
    for (int k = 0; k < order; ++k)
    {
      scale *= p - k;
    }
    std::vector<double> difference(At((p + 1) * (r + 1)), 0.0);
    for (int i = 0; i <= r; ++i)
    {
      for (int k = 0; k <= order; ++k)
      {
        const double sign = (order - k) % 2 == 0 ? 1.0 : -1.0;
        difference[At((i + k) * (r + 1) + i)] = sign * Binomial(order, k) * scale;
      }
    }
    for (int i = 0; i <= p; ++i)
    {
      for (int j = 0; j <= p; ++j)
      {
        for (int a = 0; a <= r; ++a)
        {
          for (int b = 0; b <= r; ++b)
          {
            result[At(i * (p + 1) + j)] += difference[At(i * (r + 1) + a)] *
              difference[At(j * (r + 1) + b)] * Binomial(r, a) * Binomial(r, b) /
              ((2 * r + 1) * Binomial(2 * r, a + b));
          }
        }
      }
    }
    return result;
  };
  const int n0 = degree[0] + 1;
  const int n1 = degree[1] + 1;
  std::vector<double> energy(At(n0 * n1 * n0 * n1), 0.0);
  const double factors[3] = { 1.0, 2.0, 1.0 };
  for (int order = 0; order <= 2; ++order)
  {
    const std::vector<double> u = gram(degree[0], order);
    const std::vector<double> v = gram(degree[1], 2 - order);
    for (int a = 0; a < n0 * n1; ++a)
    {
      for (int b = 0; b < n0 * n1; ++b)
      {
        energy[At(a * n0 * n1 + b)] +=
          factors[order] * u[At((a % n0) * n0 + b % n0)] * v[At((a / n0) * n1 + b / n0)];
      }
    }
  }
  return energy;
}
}
