// SPDX-License-Identifier: BSD-3-Clause
#include "CubicComposition.h"

#include <knotwork/SplineCore/Bernstein.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Calls body(k, coefficient k) for all Bernstein coefficients.
template <typename Body>
void ForEachCoefficient(const ScaledPolynomial& a, Body&& body)
{
  const std::size_t n = a.size() - 1;
  double binomial = 1.0;
  for (std::size_t k = 0; k <= n; ++k)
  {
    body(a[k] / binomial);
    binomial *= static_cast<double>(n - k) / static_cast<double>(k + 1);
  }
}
}

ScaledPolynomial Multiply(const ScaledPolynomial& a, const ScaledPolynomial& b)
{
  ScaledPolynomial product(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      product[i + j] += a[i] * b[j];
    }
  }
  return product;
}

ScaledPolynomial ScaledCubic(const std::array<double, 4>& coefficients)
{
  return { coefficients[0], 3.0 * coefficients[1], 3.0 * coefficients[2], coefficients[3] };
}

double LargestCoefficient(const ScaledPolynomial& a)
{
  double largest = 0.0;
  ForEachCoefficient(a, [&](double c) { largest = std::max(largest, std::abs(c)); });
  return largest;
}

double SmallestCoefficient(const ScaledPolynomial& a)
{
  double smallest = HUGE_VAL;
  ForEachCoefficient(a, [&](double c) { smallest = std::min(smallest, c); });
  return smallest;
}

CubicComposition::CubicComposition(const IntArray<2>& degree, const PlaneCubic& curve)
  : Degree(degree)
{
  for (std::size_t d = 0; d < 2; ++d)
  {
    std::array<double, 4> x;
    std::array<double, 4> rest;
    for (std::size_t k = 0; k < 4; ++k)
    {
      x[k] = curve[k][d];
      rest[k] = 1.0 - x[k];
    }
    const std::size_t p = static_cast<std::size_t>(degree[d]);
    std::vector<ScaledPolynomial> up(p + 1, ScaledPolynomial{ 1.0 });
    std::vector<ScaledPolynomial> down = up;
    for (std::size_t i = 1; i <= p; ++i)
    {
      up[i] = Multiply(up[i - 1], ScaledCubic(x));
      down[i] = Multiply(down[i - 1], ScaledCubic(rest));
    }
    for (std::size_t i = 0; i <= p; ++i)
    {
      this->Basis[d].push_back(Multiply(up[i], down[p - i]));
      const double binomial = Binomial(degree[d], static_cast<int>(i));
      for (double& value : this->Basis[d].back())
      {
        value *= binomial;
      }
    }
  }
}

ScaledPolynomial CubicComposition::Of(const double* coefficients) const
{
  const std::size_t width = static_cast<std::size_t>(this->Degree[0] + 1);
  ScaledPolynomial sum(3 * static_cast<std::size_t>(this->Degree[0] + this->Degree[1]) + 1, 0.0);
  for (std::size_t j = 0; j < this->Basis[1].size(); ++j)
  {
    ScaledPolynomial row(this->Basis[0][0].size(), 0.0);
    for (std::size_t i = 0; i < width; ++i)
    {
      for (std::size_t k = 0; k < row.size(); ++k)
      {
        row[k] += coefficients[j * width + i] * this->Basis[0][i][k];
      }
    }
    const ScaledPolynomial product = Multiply(row, this->Basis[1][j]);
    for (std::size_t k = 0; k < sum.size(); ++k)
    {
      sum[k] += product[k];
    }
  }
  return sum;
}
}
