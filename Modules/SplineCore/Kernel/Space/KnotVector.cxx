// SPDX-License-Identifier: BSD-3-Clause
#include "KnotVector.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
std::string At(std::size_t index)
{
  return "knot " + std::to_string(index);
}
}

KnotVector::KnotVector() : T{ 0.0, 0.0, 1.0, 1.0 }
{
  this->Prepare();
}

Result<KnotVector> KnotVector::Create(int degree, std::vector<double> knots)
{
  if (degree < 1 || degree > MaxDegree)
  {
    return { ErrorCode::InvalidDegree, "degree " + std::to_string(degree) };
  }
  const std::size_t p = static_cast<std::size_t>(degree);
  if (knots.size() < 2 * (p + 1))
  {
    return { ErrorCode::InvalidKnots,
      std::to_string(knots.size()) + " knots, degree " + std::to_string(degree) +
        " needs at least " + std::to_string(2 * (p + 1)) };
  }
  if (knots.size() > (std::size_t(1) << 30))
  {
    return { ErrorCode::TooLarge, std::to_string(knots.size()) + " knots, at most 2^30" };
  }
  for (std::size_t i = 0; i < knots.size(); ++i)
  {
    if (!std::isfinite(knots[i]))
    {
      return { ErrorCode::NonFiniteInput, At(i) };
    }
    if (i > 0 && knots[i] < knots[i - 1])
    {
      return { ErrorCode::InvalidKnots, At(i) + " is smaller than its predecessor" };
    }
    if (i > p && knots[i] == knots[i - p - 1])
    {
      return { ErrorCode::InvalidKnots,
        At(i) + " has a multiplicity above degree + 1 = " + std::to_string(degree + 1) };
    }
  }
  if (!(knots[p] < knots[knots.size() - 1 - p]))
  {
    return { ErrorCode::InvalidKnots, "the domain [t_p, t_n] has no length" };
  }
  if (!std::isfinite(knots.back() - knots.front()))
  {
    return { ErrorCode::InvalidKnots, "the length of the domain overflows" };
  }
  KnotVector result;
  result.P = degree;
  result.T = std::move(knots);
  result.Prepare();
  return result;
}

KnotVector KnotVector::Uniform(int degree, int elements, double begin, double end, int multiplicity)
{
  std::vector<double> knots(static_cast<std::size_t>(degree + 1), begin);
  for (int i = 1; i < elements; ++i)
  {
    knots.insert(
      knots.end(), static_cast<std::size_t>(multiplicity), begin + (end - begin) * i / elements);
  }
  knots.insert(knots.end(), static_cast<std::size_t>(degree + 1), end);
  KnotVector result;
  result.P = degree;
  result.T = std::move(knots);
  result.Prepare();
  return result;
}

void KnotVector::Prepare()
{
  const int n = this->NumFunctions();
  this->B.assign(1, this->T[static_cast<std::size_t>(this->P)]);
  this->S.clear();
  for (int k = this->P; k < n; ++k)
  {
    const double lower = this->T[static_cast<std::size_t>(k)];
    const double upper = this->T[static_cast<std::size_t>(k) + 1];
    if (lower < upper)
    {
      this->S.push_back(k);
      this->B.push_back(upper);
    }
  }
  // bucket b holds the last element that begins at or before the bucket's lower end, so a search
  // goes forward only and, with four buckets an element, rarely more than a step
  const std::size_t elements = this->S.size();
  const std::size_t buckets = 4 * elements;
  this->BucketScale = static_cast<double>(buckets) / (this->End() - this->Begin());
  this->Bucket.clear();
  if (!std::isfinite(this->BucketScale))
  {
    this->BucketScale = 0.0; // a domain of denormal length: one bucket, linear search
    this->Bucket.assign(1, 0);
    return;
  }
  this->Bucket.resize(buckets);
  std::size_t e = 0;
  for (std::size_t b = 0; b < buckets; ++b)
  {
    // one bucket earlier than needed, so that rounding of (u - begin) * scale cannot overshoot
    const double share = static_cast<double>(b) / static_cast<double>(buckets) - 1e-9;
    const double lower = this->Begin() + (this->End() - this->Begin()) * share;
    while (e + 1 < elements && this->B[e + 1] <= lower)
    {
      ++e;
    }
    this->Bucket[b] = static_cast<int>(e);
  }
}

int KnotVector::Multiplicity(int b) const
{
  const auto range =
    std::equal_range(this->T.begin(), this->T.end(), this->B[static_cast<std::size_t>(b)]);
  return static_cast<int>(range.second - range.first);
}

std::array<int, 2> KnotVector::Support(int function) const
{
  const double lower = this->T[static_cast<std::size_t>(function)];
  const double upper = this->T[static_cast<std::size_t>(function + this->P + 1)];
  // breaks at or before lower, breaks before upper
  const auto first = std::upper_bound(this->B.begin(), this->B.end(), lower) - this->B.begin() - 1;
  const auto last = std::lower_bound(this->B.begin(), this->B.end(), upper) - this->B.begin() - 1;
  return { static_cast<int>(std::max<std::ptrdiff_t>(first, 0)),
    static_cast<int>(std::min<std::ptrdiff_t>(last, this->NumElements() - 1)) };
}

void KnotVector::FindElements(const double* u, std::size_t n, int* elements) const
{
  const double begin = this->B.front();
  const double scale = this->BucketScale;
  const double last = static_cast<double>(this->Bucket.size() - 1);
  for (std::size_t i = 0; i < n; ++i)
  {
    const double position = (u[i] - begin) * scale;
    // a NaN compares false and goes to the first element
    elements[i] = static_cast<int>(position > 0.0 ? std::min(position, last) : 0.0);
  }
  const int end = this->NumElements() - 1;
  const double* upper = this->B.data() + 1;
  for (std::size_t i = 0; i < n; ++i)
  {
    int e = this->Bucket[static_cast<std::size_t>(elements[i])];
    // the usual one step is taken without a branch, which could not be predicted
    e = std::min(e + static_cast<int>(u[i] >= upper[e]), end);
    while (e < end && u[i] >= upper[e])
    {
      ++e;
    }
    elements[i] = e;
  }
}

double KnotVector::Greville(int function) const
{
  double sum = 0.0;
  for (int i = 1; i <= this->P; ++i)
  {
    sum += this->T[static_cast<std::size_t>(function + i)];
  }
  return sum / this->P;
}

void KnotVector::EvaluateFunctions(int element, double u, int order, double* values) const
{
  const int p = this->P;
  const double* t = this->T.data() + this->Span(element);
  // triangle of The NURBS Book A2.3: upper part basis values, lower part knot differences
  double table[MaxDegree + 1][MaxDegree + 1];
  double left[MaxDegree + 1];
  double right[MaxDegree + 1];
  table[0][0] = 1.0;
  for (int j = 1; j <= p; ++j)
  {
    left[j] = u - t[1 - j];
    right[j] = t[j] - u;
    double saved = 0.0;
    for (int r = 0; r < j; ++r)
    {
      table[j][r] = right[r + 1] + left[j - r];
      const double ratio = table[r][j - 1] / table[j][r];
      table[r][j] = saved + right[r + 1] * ratio;
      saved = left[j - r] * ratio;
    }
    table[j][j] = saved;
  }
  for (int i = 0; i <= p; ++i)
  {
    values[i] = table[i][p];
  }
  for (int i = 0; i <= p && order > 0; ++i)
  {
    double a[2][MaxDegree + 1];
    int now = 0;
    int next = 1;
    a[0][0] = 1.0;
    double factor = p;
    for (int k = 1; k <= order; ++k)
    {
      double d = 0.0;
      if (k <= p)
      {
        const int rk = i - k;
        const int pk = p - k;
        if (i >= k)
        {
          a[next][0] = a[now][0] / table[pk + 1][rk];
          d = a[next][0] * table[rk][pk];
        }
        const int first = rk >= -1 ? 1 : -rk;
        const int last = i - 1 <= pk ? k - 1 : p - i;
        for (int j = first; j <= last; ++j)
        {
          a[next][j] = (a[now][j] - a[now][j - 1]) / table[pk + 1][rk + j];
          d += a[next][j] * table[rk + j][pk];
        }
        if (i <= pk)
        {
          a[next][k] = -a[now][k - 1] / table[pk + 1][i];
          d += a[next][k] * table[i][pk];
        }
        std::swap(now, next);
      }
      values[k * (p + 1) + i] = d * factor;
      factor *= p - k;
    }
  }
}

void KnotVector::Extraction(int element, double* matrix) const
{
  ExtractionFromLocalKnots(this->P, this->T.data() + this->Span(element) - this->P + 1, matrix);
}

void ExtractionFromLocalKnots(int degree, const double* localKnots, double* matrix)
{
  // Bernstein coefficient k of a spline on [a, b] is its blossom at (a^{p-k}, b^k); the blossom of
  // the function with unit coefficient i follows by de Boor steps on unit coefficient vectors.
  const int p = degree;
  const double a = localKnots[p - 1];
  const double b = localKnots[p];
  double d[MaxDegree + 1][MaxDegree + 1]; // d[j][i]: weight of coefficient i in point j
  for (int k = 0; k <= p; ++k)
  {
    for (int j = 0; j <= p; ++j)
    {
      std::fill(d[j], d[j] + p + 1, 0.0);
      d[j][j] = 1.0;
    }
    for (int r = 1; r <= p; ++r)
    {
      const double u = r <= p - k ? a : b;
      for (int j = p; j >= r; --j)
      {
        // coefficient j runs over the knots localKnots[j - 1] ... localKnots[j + p - r]
        const double lower = localKnots[j - 1];
        const double upper = localKnots[j + p - r];
        const double alpha = (u - lower) / (upper - lower);
        for (int i = 0; i <= p; ++i)
        {
          d[j][i] = (1.0 - alpha) * d[j - 1][i] + alpha * d[j][i];
        }
      }
    }
    for (int i = 0; i <= p; ++i)
    {
      matrix[i * (p + 1) + k] = d[p][i];
    }
  }
}

KnotVector KnotVector::Dyadic() const
{
  KnotVector result;
  result.P = this->P;
  result.T.clear();
  result.T.reserve(this->T.size() + this->S.size());
  std::size_t e = 0;
  for (std::size_t k = 0; k < this->T.size(); ++k)
  {
    result.T.push_back(this->T[k]);
    if (e < this->S.size() && static_cast<int>(k) == this->S[e])
    {
      result.T.push_back(this->B[e] + 0.5 * (this->B[e + 1] - this->B[e]));
      ++e;
    }
  }
  result.Prepare();
  return result;
}
}
