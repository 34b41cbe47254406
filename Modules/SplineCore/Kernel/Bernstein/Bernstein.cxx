// SPDX-License-Identifier: BSD-3-Clause
#include "Bernstein.h"

#include "Types.h"

#include <algorithm>
#include <type_traits>

namespace knotwork
{
namespace
{
constexpr int TableSize = 57; // the last row of Pascal's triangle whose entries are all below 2^53

struct PascalTriangle
{
  double Entry[TableSize][TableSize];
  constexpr PascalTriangle() : Entry{}
  {
    for (int n = 0; n < TableSize; ++n)
    {
      this->Entry[n][0] = 1.0;
      for (int k = 1; k <= n; ++k)
      {
        this->Entry[n][k] = this->Entry[n - 1][k - 1] + (k < n ? this->Entry[n - 1][k] : 0.0);
      }
    }
  }
};
constexpr PascalTriangle Pascal;

/// Applies a linear map to every line of a tensor array along one direction.
/// @param map  map(in, out): lines of degree[direction] + 1 and newDegree + 1 values.
template <int Dim, typename Map>
std::vector<double> MapLines(const IntArray<Dim>& degree, const std::vector<double>& a,
  int direction, int newDegree, Map&& map)
{
  std::size_t stride = 1;
  for (int d = 0; d < direction; ++d)
  {
    stride *= static_cast<std::size_t>(degree[static_cast<std::size_t>(d)] + 1);
  }
  const std::size_t n = static_cast<std::size_t>(degree[static_cast<std::size_t>(direction)] + 1);
  const std::size_t m = static_cast<std::size_t>(newDegree + 1);
  const std::size_t outer = a.size() / (stride * n);
  std::vector<double> result(outer * m * stride);
  std::vector<double> in(n);
  std::vector<double> out(m);
  for (std::size_t o = 0; o < outer; ++o)
  {
    for (std::size_t s = 0; s < stride; ++s)
    {
      for (std::size_t i = 0; i < n; ++i)
      {
        in[i] = a[(o * n + i) * stride + s];
      }
      map(in.data(), out.data());
      for (std::size_t k = 0; k < m; ++k)
      {
        result[(o * m + k) * stride + s] = out[k];
      }
    }
  }
  return result;
}

/// Degree with three entries whatever Dim, so that loops over products are written once.
template <int Dim>
std::array<int, 3> Padded(const IntArray<Dim>& degree)
{
  std::array<int, 3> padded{};
  std::copy(degree.begin(), degree.end(), padded.begin());
  return padded;
}

/// Coefficients times the product of the binomials: those of the scaled Bernstein basis, whose
/// product is a plain convolution.
std::vector<double> Scaled(const std::array<int, 3>& p, const std::vector<double>& a)
{
  std::vector<double> scaled(a.size());
  std::size_t at = 0;
  for (int k = 0; k <= p[2]; ++k)
  {
    for (int j = 0; j <= p[1]; ++j)
    {
      const double outer = Binomial(p[2], k) * Binomial(p[1], j);
      for (int i = 0; i <= p[0]; ++i, ++at)
      {
        scaled[at] = a[at] * outer * Binomial(p[0], i);
      }
    }
  }
  return scaled;
}
}

double Binomial(int n, int k)
{
  if (k < 0 || k > n)
  {
    return 0.0;
  }
  if (n < TableSize)
  {
    return Pascal.Entry[n][k];
  }
  double result = 1.0;
  for (int i = 1; i <= std::min(k, n - k); ++i)
  {
    result = result * (n + 1 - i) / i;
  }
  return result;
}

void BernsteinValues(int degree, double t, double* values)
{
  const double s = 1.0 - t;
  values[0] = 1.0;
  for (int q = 1; q <= degree; ++q)
  {
    values[q] = t * values[q - 1];
    for (int i = q - 1; i > 0; --i)
    {
      values[i] = s * values[i] + t * values[i - 1];
    }
    values[0] *= s;
  }
}

void BernsteinDerivatives(int degree, double t, int order, double* values)
{
  BernsteinValues(degree, t, values);
  for (int k = 1; k <= order; ++k)
  {
    double* row = values + k * (degree + 1);
    if (k > degree)
    {
      std::fill(row, row + degree + 1, 0.0);
      continue;
    }
    // (B_i^q)' = q (B_{i-1}^{q-1} - B_i^{q-1}), applied k times to the values of degree p - k
    BernsteinValues(degree - k, t, row);
    for (int q = degree - k + 1; q <= degree; ++q)
    {
      row[q] = q * row[q - 1];
      for (int i = q - 1; i > 0; --i)
      {
        row[i] = q * (row[i - 1] - row[i]);
      }
      row[0] *= -q;
    }
  }
}

template <int Dim>
double BernsteinEvaluate(const IntArray<Dim>& degree, const double* coefficients, const double* t)
{
  std::size_t size = static_cast<std::size_t>(NumTensorFunctions<Dim>(degree));
  std::vector<double> b(coefficients, coefficients + size);
  for (std::size_t d = Dim; d-- > 0;)
  {
    const std::size_t n = static_cast<std::size_t>(degree[d] + 1);
    size /= n; // values of one slice across this direction
    for (std::size_t last = n - 1; last > 0; --last)
    {
      for (std::size_t i = 0; i < last * size; ++i)
      {
        b[i] = (1.0 - t[d]) * b[i] + t[d] * b[i + size];
      }
    }
  }
  return b[0];
}

template <int Dim>
std::vector<double> BernsteinProduct(const IntArray<Dim>& degreeA, const std::vector<double>& a,
  const IntArray<Dim>& degreeB, const std::vector<double>& b)
{
  const auto p = Padded<Dim>(degreeA);
  const auto q = Padded<Dim>(degreeB);
  const std::vector<double> scaledA = Scaled(p, a);
  const std::vector<double> scaledB = Scaled(q, b);
  const std::array<int, 3> r = { p[0] + q[0], p[1] + q[1], p[2] + q[2] };
  std::vector<double> result(static_cast<std::size_t>(NumTensorFunctions<3>(r)));
  const auto at = [](const std::array<int, 3>& degree, int i, int j, int k)
  { return static_cast<std::size_t>(i + (degree[0] + 1) * (j + (degree[1] + 1) * k)); };
  for (int ka = 0; ka <= p[2]; ++ka)
  {
    for (int ja = 0; ja <= p[1]; ++ja)
    {
      for (int kb = 0; kb <= q[2]; ++kb)
      {
        for (int jb = 0; jb <= q[1]; ++jb)
        {
          const double* lineA = scaledA.data() + at(p, 0, ja, ka);
          const double* lineB = scaledB.data() + at(q, 0, jb, kb);
          double* line = result.data() + at(r, 0, ja + jb, ka + kb);
          for (int ia = 0; ia <= p[0]; ++ia)
          {
            for (int ib = 0; ib <= q[0]; ++ib)
            {
              line[ia + ib] += lineA[ia] * lineB[ib];
            }
          }
        }
      }
    }
  }
  std::size_t entry = 0;
  for (int k = 0; k <= r[2]; ++k)
  {
    for (int j = 0; j <= r[1]; ++j)
    {
      const double outer = Binomial(r[2], k) * Binomial(r[1], j);
      for (int i = 0; i <= r[0]; ++i, ++entry)
      {
        result[entry] /= outer * Binomial(r[0], i);
      }
    }
  }
  return result;
}

template <int Dim>
std::vector<double> BernsteinDerivative(
  const IntArray<Dim>& degree, const std::vector<double>& a, int direction)
{
  const int p = degree[static_cast<std::size_t>(direction)];
  return MapLines<Dim>(degree, a, direction, p - 1,
    [p](const double* in, double* out)
    {
      for (int i = 0; i < p; ++i)
      {
        out[i] = p * (in[i + 1] - in[i]);
      }
    });
}

template <int Dim>
std::vector<double> BernsteinElevate(
  const IntArray<Dim>& degree, const std::vector<double>& a, const IntArray<Dim>& target)
{
  std::vector<double> result = a;
  IntArray<Dim> current = degree;
  for (int d = 0; d < Dim; ++d)
  {
    const int p = degree[static_cast<std::size_t>(d)];
    const int q = target[static_cast<std::size_t>(d)];
    if (p == q)
    {
      continue;
    }
    result = MapLines<Dim>(current, result, d, q,
      [p, q](const double* in, double* out)
      {
        for (int k = 0; k <= q; ++k)
        {
          double sum = 0.0;
          for (int i = std::max(0, k - (q - p)); i <= std::min(p, k); ++i)
          {
            sum += Binomial(p, i) * Binomial(q - p, k - i) * in[i];
          }
          out[k] = sum / Binomial(q, k);
        }
      });
    current[static_cast<std::size_t>(d)] = q;
  }
  return result;
}

template <int Dim>
std::vector<double> BernsteinRestrict(const IntArray<Dim>& degree, const std::vector<double>& a,
  int direction, double lower, double upper)
{
  const int p = degree[static_cast<std::size_t>(direction)];
  std::vector<double> left(static_cast<std::size_t>(p + 1));
  std::vector<double> right(left.size());
  return MapLines<Dim>(degree, a, direction, p,
    [&](const double* in, double* out)
    {
      // coefficient k is the blossom at (lower^{p-k}, upper^k): steps at lower are shared
      std::copy(in, in + p + 1, left.begin());
      for (int k = p; k >= 0; --k)
      {
        std::copy(left.begin(), left.begin() + k + 1, right.begin());
        for (std::size_t last = static_cast<std::size_t>(k); last > 0; --last)
        {
          for (std::size_t i = 0; i < last; ++i)
          {
            right[i] = (1.0 - upper) * right[i] + upper * right[i + 1];
          }
        }
        out[k] = right[0];
        for (std::size_t i = 0; i < static_cast<std::size_t>(k); ++i)
        {
          left[i] = (1.0 - lower) * left[i] + lower * left[i + 1];
        }
      }
    });
}

void BernsteinRestriction(int degree, double lower, double upper, double* matrix)
{
  const int n = degree + 1;
  double first[TableSize];
  double second[TableSize];
  for (int k = 0; k <= degree; ++k)
  {
    // of the i factors t of B_i^p, j take an argument at upper and i - j one at lower
    BernsteinValues(k, upper, first);
    BernsteinValues(degree - k, lower, second);
    for (int i = 0; i <= degree; ++i)
    {
      double sum = 0.0;
      for (int j = std::max(0, i - (degree - k)); j <= std::min(i, k); ++j)
      {
        sum += first[j] * second[i - j];
      }
      matrix[i * n + k] = sum;
    }
  }
}

std::vector<double> BernsteinGramInverse(int degree)
{
  const int n = degree;
  std::vector<double> inverse(static_cast<std::size_t>((n + 1) * (n + 1)));
  for (int j = 0; j <= n; ++j)
  {
    for (int k = 0; k <= n; ++k)
    {
      double sum = 0.0; // of positive integers: no cancellation
      for (int i = 0; i <= std::min(j, k); ++i)
      {
        sum += (2 * i + 1) * Binomial(n + i + 1, n - j) * Binomial(n - i, n - j) *
          Binomial(n + i + 1, n - k) * Binomial(n - i, n - k);
      }
      const double sign = (j + k) % 2 == 0 ? 1.0 : -1.0;
      inverse[static_cast<std::size_t>(j * (n + 1) + k)] =
        sign * sum / (Binomial(n, j) * Binomial(n, k));
    }
  }
  return inverse;
}

namespace
{
/// One direction of ApplyFactors: lines of n values, stride apart.
/// @param n  int, or std::integral_constant to compile the loops for the usual lengths.
template <typename Length>
void ApplyFactorOf(const Length n, int stride, int size, const double* factor, double* values)
{
  for (int start = 0; start < size; start += n * stride)
  {
    for (double* first = values + start; first != values + start + stride; ++first)
    {
      double line[MaxDegree + 2] = {};
      for (int i = 0; i < n; ++i)
      {
        const double value = first[i * stride];
        for (int k = 0; k < n; ++k)
        {
          line[k] += value * factor[i * n + k];
        }
      }
      for (int k = 0; k < n; ++k)
      {
        first[k * stride] = line[k];
      }
    }
  }
}

void ApplyFactor(int n, int stride, int size, const double* factor, double* values)
{
  switch (n)
  {
    case 2:
      return ApplyFactorOf(std::integral_constant<int, 2>(), stride, size, factor, values);
    case 3:
      return ApplyFactorOf(std::integral_constant<int, 3>(), stride, size, factor, values);
    case 4:
      return ApplyFactorOf(std::integral_constant<int, 4>(), stride, size, factor, values);
    case 5:
      return ApplyFactorOf(std::integral_constant<int, 5>(), stride, size, factor, values);
    case 6:
      return ApplyFactorOf(std::integral_constant<int, 6>(), stride, size, factor, values);
    default:
      return ApplyFactorOf(n, stride, size, factor, values);
  }
}
}

template <int Dim>
void ApplyFactors(const IntArray<Dim>& degree, const std::array<const double*, Dim>& factors,
  const double* in, double* out)
{
  const int size = NumTensorFunctions<Dim>(degree);
  if (in != out)
  {
    std::copy(in, in + size, out);
  }
  int stride = 1;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const int n = degree[d] + 1;
    if (factors[d])
    {
      ApplyFactor(n, stride, size, factors[d], out);
    }
    stride *= n;
  }
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template double BernsteinEvaluate<Dim>(const IntArray<Dim>&, const double*, const double*);      \
  template std::vector<double> BernsteinProduct<Dim>(const IntArray<Dim>&,                         \
    const std::vector<double>&, const IntArray<Dim>&, const std::vector<double>&);                 \
  template std::vector<double> BernsteinDerivative<Dim>(                                           \
    const IntArray<Dim>&, const std::vector<double>&, int);                                        \
  template std::vector<double> BernsteinElevate<Dim>(                                              \
    const IntArray<Dim>&, const std::vector<double>&, const IntArray<Dim>&);                       \
  template std::vector<double> BernsteinRestrict<Dim>(                                             \
    const IntArray<Dim>&, const std::vector<double>&, int, double, double);                        \
  template void ApplyFactors<Dim>(                                                                 \
    const IntArray<Dim>&, const std::array<const double*, Dim>&, const double*, double*);

KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
