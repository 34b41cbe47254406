// SPDX-License-Identifier: BSD-3-Clause
#include "SignRoots.h"

#include <knotwork/SplineCore/Bernstein.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int DeepestBisection = 50;

int SignVariations(int degree, const double* coefficients)
{
  int variations = 0;
  for (int k = 0; k < degree; ++k)
  {
    variations += IsPositive(coefficients[k]) != IsPositive(coefficients[k + 1]) ? 1 : 0;
  }
  return variations;
}

void FindIn(int degree, const double* coefficients, double low, double length, int depth,
  std::vector<double>& roots)
{
  const int variations = SignVariations(degree, coefficients);
  if (variations == 0)
  {
    return;
  }
  const bool odd = variations % 2 == 1;
  if (variations == 1 || depth == DeepestBisection)
  {
    if (odd)
    {
      const double first = coefficients[0];
      const double last = coefficients[degree];
      const double guess = first / (first - last);
      roots.push_back(low + length * FindSignChange(degree, coefficients, 0.0, 1.0, guess, 1e-16));
    }
    return;
  }
  double lower[MaxDegree + 1];
  double upper[MaxDegree + 1];
  std::copy(coefficients, coefficients + degree + 1, upper);
  HalveBernstein(degree, upper, lower);
  FindIn(degree, lower, low, 0.5 * length, depth + 1, roots);
  FindIn(degree, upper, low + 0.5 * length, 0.5 * length, depth + 1, roots);
}
}

double EvaluateBernstein(int degree, const double* coefficients, double t, double* derivative)
{
  double b[MaxDegree + 1];
  std::copy(coefficients, coefficients + degree + 1, b);
  const double s = 1.0 - t;
  for (int n = degree; n > 1; --n)
  {
    for (int i = 0; i < n; ++i)
    {
      b[i] = s * b[i] + t * b[i + 1];
    }
  }
  if (derivative)
  {
    *derivative = degree * (b[1] - b[0]);
  }
  return s * b[0] + t * b[1];
}

void SetEndSigns(int degree, double* coefficients, bool positiveBegin, bool positiveEnd)
{
  const auto set = [](double& value, bool positive)
  {
    if (IsPositive(value) != positive)
    {
      value = positive ? 0.0 : -1e-300;
    }
  };
  set(coefficients[0], positiveBegin);
  set(coefficients[degree], positiveEnd);
}

void FindSignChanges(int degree, const double* coefficients, std::vector<double>& roots)
{
  FindIn(degree, coefficients, 0.0, 1.0, 0, roots);
}

double FindSignChange(
  int degree, const double* coefficients, double low, double high, double t, double enough)
{
  const bool positiveLow = IsPositive(EvaluateBernstein(degree, coefficients, low, nullptr));
  for (int step = 0; step < 100; ++step)
  {
    if (!(t > low && t < high))
    {
      t = 0.5 * (low + high);
    }
    double slope;
    const double value = EvaluateBernstein(degree, coefficients, t, &slope);
    (IsPositive(value) == positiveLow ? low : high) = t;
    const double next = t - value / slope;
    if (value == 0.0 || high - low <= 1e-16 * high)
    {
      break;
    }
    if (std::abs(next - t) <= enough * t)
    {
      return next > low && next < high ? next : t;
    }
    t = next;
  }
  return t;
}
}
