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

/// Coefficients of one plane and of its first and second derivatives. A derivative that vanishes
/// (degree too low) is empty.
template <int K>
struct Jet
{
  std::vector<double> Value;
  std::array<std::vector<double>, static_cast<std::size_t>(K)> First;
  std::array<std::vector<double>, static_cast<std::size_t>(K* K)> Second; // e >= d
};

template <int K>
Jet<K> MakeJet(const IntArray<K>& degree, std::vector<double> plane)
{
  Jet<K> jet;
  for (int d = 0; d < K; ++d)
  {
    jet.First[At(d)] = BernsteinDerivative<K>(degree, plane, d);
    IntArray<K> lower = degree;
    --lower[At(d)];
    for (int e = d; e < K; ++e)
    {
      if (lower[At(e)] > 0)
      {
        jet.Second[At(d * K + e)] = BernsteinDerivative<K>(lower, jet.First[At(d)], e);
      }
    }
  }
  jet.Value = std::move(plane);
  return jet;
}

/// Largest norm over the coefficients of vectors whose components are given plane by plane.
template <typename Select>
double LargestNorm(int numComponents, const Select& select)
{
  double largest = 0.0;
  const std::size_t n = select(0).size();
  for (std::size_t i = 0; i < n; ++i)
  {
    double sum = 0.0;
    for (int c = 0; c < numComponents; ++c)
    {
      const double x = select(c)[i];
      sum += x * x;
    }
    largest = std::max(largest, sum);
  }
  return std::sqrt(largest);
}

template <int K>
SecondDerivativeBound<K> PolynomialBound(
  const IntArray<K>& degree, int numComponents, const double* net)
{
  const std::size_t n = At(NumTensorFunctions<K>(degree));
  std::vector<Jet<K>> jets;
  for (int c = 0; c < numComponents; ++c)
  {
    jets.push_back(MakeJet<K>(degree, { net + At(c) * n, net + At(c + 1) * n }));
  }
  SecondDerivativeBound<K> bound{};
  for (int d = 0; d < K; ++d)
  {
    for (int e = d; e < K; ++e)
    {
      bound[At(d * K + e)] = bound[At(e * K + d)] = LargestNorm(numComponents,
        [&](int c) -> const std::vector<double>& { return jets[At(c)].Second[At(d * K + e)]; });
    }
  }
  return bound;
}

/// The rational bound on the element given by homogeneous planes.
template <int K>
SecondDerivativeBound<K> RationalBound(
  const IntArray<K>& degree, int numComponents, const std::vector<std::vector<double>>& planes)
{
  const std::vector<double>& w = planes[At(numComponents)];
  const std::size_t n = w.size();
  const double smallest = *std::min_element(w.begin(), w.end());
  // Centre of the control points' box, so that translations do not loosen the bound.
  std::vector<Jet<K>> jets;
  std::vector<double> square(n, 0.0);
  for (int c = 0; c < numComponents; ++c)
  {
    std::vector<double> plane = planes[At(c)];
    double lower = plane[0] / w[0];
    double upper = lower;
    for (std::size_t i = 1; i < n; ++i)
    {
      lower = std::min(lower, plane[i] / w[i]);
      upper = std::max(upper, plane[i] / w[i]);
    }
    const double centre = 0.5 * (lower + upper);
    for (std::size_t i = 0; i < n; ++i)
    {
      plane[i] -= centre * w[i];
      square[i] += plane[i] / w[i] * (plane[i] / w[i]);
    }
    jets.push_back(MakeJet<K>(degree, std::move(plane)));
  }
  const double radius = std::sqrt(*std::max_element(square.begin(), square.end()));
  const Jet<K> weight = MakeJet<K>(degree, w);
  const auto scalar = [](const std::vector<double>& values)
  {
    double largest = 0.0;
    for (double x : values)
    {
      largest = std::max(largest, std::abs(x));
    }
    return largest;
  };
  std::array<double, static_cast<std::size_t>(K)> weightFirst{};
  std::array<double, static_cast<std::size_t>(K)> first{};
  for (int d = 0; d < K; ++d)
  {
    weightFirst[At(d)] = scalar(weight.First[At(d)]);
    const double numerator = LargestNorm(
      numComponents, [&](int c) -> const std::vector<double>& { return jets[At(c)].First[At(d)]; });
    first[At(d)] = (numerator + radius * weightFirst[At(d)]) / smallest;
  }
  SecondDerivativeBound<K> bound{};
  for (int d = 0; d < K; ++d)
  {
    for (int e = d; e < K; ++e)
    {
      const double numerator = LargestNorm(numComponents,
        [&](int c) -> const std::vector<double>& { return jets[At(c)].Second[At(d * K + e)]; });
      bound[At(d * K + e)] = bound[At(e * K + d)] =
        (numerator + first[At(d)] * weightFirst[At(e)] + first[At(e)] * weightFirst[At(d)] +
          radius * scalar(weight.Second[At(d * K + e)])) /
        smallest;
    }
  }
  return bound;
}
}

template <int K>
SecondDerivativeBound<K> BoundSecondDerivatives(
  const IntArray<K>& degree, int numComponents, bool rational, const double* net)
{
  if (!rational)
  {
    return PolynomialBound<K>(degree, numComponents, net);
  }
  const std::size_t n = At(NumTensorFunctions<K>(degree));
  SecondDerivativeBound<K> bound{};
  for (int part = 0; part < (1 << K); ++part)
  {
    std::vector<std::vector<double>> planes;
    for (int c = 0; c <= numComponents; ++c)
    {
      std::vector<double> plane(net + At(c) * n, net + At(c + 1) * n);
      for (int d = 0; d < K; ++d)
      {
        const bool upper = ((part >> d) & 1) != 0;
        plane = BernsteinRestrict<K>(degree, plane, d, upper ? 0.5 : 0.0, upper ? 1.0 : 0.5);
      }
      planes.push_back(std::move(plane));
    }
    // The derivatives are with respect to a parameter that runs twice as fast: 2 * 2.
    const SecondDerivativeBound<K> half = RationalBound<K>(degree, numComponents, planes);
    for (std::size_t i = 0; i < bound.size(); ++i)
    {
      bound[i] = std::max(bound[i], 4.0 * half[i]);
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
