// SPDX-License-Identifier: BSD-3-Clause
#include "ChordalBound.h"

#include "Bernstein.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

using Coefficients = std::vector<double>;

template <int K>
IntArray<K> Lowered(IntArray<K> degree, int direction)
{
  --degree[At(direction)];
  return degree;
}

/// Largest norm over the coefficients of vectors given component by component.
double LargestNorm(const std::vector<Coefficients>& components)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < components.front().size(); ++i)
  {
    double sum = 0.0;
    for (const Coefficients& component : components)
    {
      sum += component[i] * component[i];
    }
    largest = std::max(largest, sum);
  }
  return std::sqrt(largest);
}

template <int K>
SecondDerivativeBound<K> PolynomialBound(
  const IntArray<K>& degree, const std::vector<Coefficients>& components)
{
  SecondDerivativeBound<K> bound{};
  for (int d = 0; d < K; ++d)
  {
    const IntArray<K> once = Lowered<K>(degree, d);
    for (int e = d; e < K; ++e)
    {
      if (once[At(e)] == 0)
      {
        continue; // linear in this direction
      }
      std::vector<Coefficients> second;
      for (const Coefficients& component : components)
      {
        second.push_back(
          BernsteinDerivative<K>(once, BernsteinDerivative<K>(degree, component, d), e));
      }
      bound[At(d * K + e)] = bound[At(e * K + d)] = LargestNorm(second);
    }
  }
  return bound;
}

/// a - factor * b.
Coefficients Subtract(Coefficients a, double factor, const Coefficients& b)
{
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    a[i] -= factor * b[i];
  }
  return a;
}

/// The rational bound on the element given by homogeneous components and the weight.
template <int K>
SecondDerivativeBound<K> RationalBound(
  const IntArray<K>& degree, std::vector<Coefficients> components, const Coefficients& w)
{
  const double smallest = *std::min_element(w.begin(), w.end());
  for (Coefficients& a : components) // translations do not change derivatives, only rounding
  {
    a = Subtract(std::move(a), a[0] / w[0], w);
  }
  SecondDerivativeBound<K> bound{};
  for (int d = 0; d < K; ++d)
  {
    const IntArray<K> once = Lowered<K>(degree, d);
    const Coefficients wd = BernsteinDerivative<K>(degree, w, d);
    // First derivatives n / w^2.
    IntArray<K> firstDegree;
    for (int k = 0; k < K; ++k)
    {
      firstDegree[At(k)] = degree[At(k)] + once[At(k)];
    }
    std::vector<Coefficients> first;
    for (const Coefficients& a : components)
    {
      first.push_back(
        Subtract(BernsteinProduct<K>(once, BernsteinDerivative<K>(degree, a, d), degree, w), 1.0,
          BernsteinProduct<K>(degree, a, once, wd)));
    }
    for (int e = d; e < K; ++e)
    {
      const IntArray<K> lowered = Lowered<K>(degree, e);
      const Coefficients we = BernsteinDerivative<K>(degree, w, e);
      std::vector<Coefficients> second;
      for (const Coefficients& n : first)
      {
        second.push_back(Subtract(BernsteinProduct<K>(Lowered<K>(firstDegree, e),
                                    BernsteinDerivative<K>(firstDegree, n, e), degree, w),
          2.0, BernsteinProduct<K>(firstDegree, n, lowered, we)));
      }
      bound[At(d * K + e)] = bound[At(e * K + d)] =
        LargestNorm(second) / (smallest * smallest * smallest);
    }
  }
  return bound;
}

/// Whether a plane varies in a direction.
template <int K>
bool Varies(const IntArray<K>& degree, const Coefficients& plane, int direction)
{
  const Coefficients slope = BernsteinDerivative<K>(degree, plane, direction);
  return std::any_of(slope.begin(), slope.end(), [](double x) { return x != 0.0; });
}
}

template <int K>
SecondDerivativeBound<K> BoundSecondDerivatives(
  const IntArray<K>& degree, int numComponents, bool rational, const double* net)
{
  const std::size_t n = At(NumTensorFunctions<K>(degree));
  std::vector<Coefficients> components;
  for (int c = 0; c < numComponents; ++c)
  {
    components.emplace_back(net + At(c) * n, net + At(c + 1) * n);
  }
  if (!rational)
  {
    return PolynomialBound<K>(degree, components);
  }
  const Coefficients weight(net + At(numComponents) * n, net + At(numComponents + 1) * n);
  std::array<bool, static_cast<std::size_t>(K)> split{};
  for (int d = 0; d < K; ++d)
  {
    split[At(d)] = Varies<K>(degree, weight, d);
  }
  SecondDerivativeBound<K> bound{};
  for (int part = 0; part < (1 << K); ++part)
  {
    std::vector<Coefficients> planes = components;
    planes.push_back(weight);
    bool isNew = true;
    for (int d = 0; d < K; ++d)
    {
      const bool upper = ((part >> d) & 1) != 0;
      isNew = isNew && (split[At(d)] || !upper);
      for (Coefficients& plane : planes)
      {
        if (split[At(d)])
        {
          plane = BernsteinRestrict<K>(degree, plane, d, upper ? 0.5 : 0.0, upper ? 1.0 : 0.5);
        }
      }
    }
    if (!isNew)
    {
      continue;
    }
    const Coefficients w = planes.back();
    planes.pop_back();
    const SecondDerivativeBound<K> half = RationalBound<K>(degree, std::move(planes), w);
    for (int d = 0; d < K; ++d)
    {
      for (int e = 0; e < K; ++e)
      {
        // Local parameters of a half run twice as fast.
        const double scale = (split[At(d)] ? 2.0 : 1.0) * (split[At(e)] ? 2.0 : 1.0);
        bound[At(d * K + e)] = std::max(bound[At(d * K + e)], scale * half[At(d * K + e)]);
      }
    }
  }
  return bound;
}

template <int K>
double ChordalBound(const SecondDerivativeBound<K>& bound, const IntArray<K>& halvings)
{
  double sum = 0.0;
  for (int d = 0; d < K; ++d)
  {
    for (int e = 0; e < K; ++e)
    {
      sum += std::ldexp(bound[At(d * K + e)], -halvings[At(d)] - halvings[At(e)]);
    }
  }
  return sum / 8.0;
}

template <int K>
IntArray<K> HalvingsForTolerance(const SecondDerivativeBound<K>& bound, double tolerance, int limit)
{
  IntArray<K> halvings{};
  while (ChordalBound<K>(bound, halvings) > tolerance)
  {
    int best = -1;
    double largest = 0.0;
    for (int d = 0; d < K; ++d)
    {
      double share = 0.0; // what halving direction d takes away, up to a common factor
      for (int e = 0; e < K; ++e)
      {
        share += std::ldexp(bound[At(d * K + e)], -halvings[At(d)] - halvings[At(e)]) *
          (e == d ? 0.75 : 1.0);
      }
      if (halvings[At(d)] < limit && (best < 0 || share > largest))
      {
        best = d;
        largest = share;
      }
    }
    if (best < 0)
    {
      break;
    }
    ++halvings[At(best)];
  }
  return halvings;
}

template SecondDerivativeBound<1> BoundSecondDerivatives<1>(
  const IntArray<1>&, int, bool, const double*);
template SecondDerivativeBound<2> BoundSecondDerivatives<2>(
  const IntArray<2>&, int, bool, const double*);
template SecondDerivativeBound<3> BoundSecondDerivatives<3>(
  const IntArray<3>&, int, bool, const double*);
template double ChordalBound<1>(const SecondDerivativeBound<1>&, const IntArray<1>&);
template double ChordalBound<2>(const SecondDerivativeBound<2>&, const IntArray<2>&);
template double ChordalBound<3>(const SecondDerivativeBound<3>&, const IntArray<3>&);
template IntArray<1> HalvingsForTolerance<1>(const SecondDerivativeBound<1>&, double, int);
template IntArray<2> HalvingsForTolerance<2>(const SecondDerivativeBound<2>&, double, int);
template IntArray<3> HalvingsForTolerance<3>(const SecondDerivativeBound<3>&, double, int);
}
