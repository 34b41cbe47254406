// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeInterpolation.h"

#include <Eigen/LU>

#include <limits>

namespace knotwork
{
namespace
{
long double Power(long double x, int n)
{
  long double result = 1.0L;
  for (int i = 0; i < n; ++i)
  {
    result *= x;
  }
  return result;
}

long double Factorial(int n)
{
  long double result = 1.0L;
  for (int i = 2; i <= n; ++i)
  {
    result *= i;
  }
  return result;
}

/// Exponents of the Bernstein polynomials of a simplex with `parameters` parameters, in the order
/// of BernsteinCells; the last is that of 1 - sum.
std::vector<std::array<int, 4>> Exponents(int parameters, int p)
{
  std::vector<std::array<int, 4>> all;
  for (int k = 0; k <= (parameters > 2 ? p : 0); ++k)
  {
    for (int j = 0; j <= (parameters > 1 ? p - k : 0); ++j)
    {
      for (int i = 0; i <= p - j - k; ++i)
      {
        all.push_back({ i, j, k, p - i - j - k });
      }
    }
  }
  return all;
}

/// Values of a simplex' Bernstein polynomials (columns) at the nodes exponents / p (rows).
LongMatrix MakeCollocation(int parameters, int p)
{
  const auto exponents = Exponents(parameters, p);
  const auto n = static_cast<Eigen::Index>(exponents.size());
  LongMatrix values(n, n);
  for (Eigen::Index r = 0; r < n; ++r)
  {
    const auto& node = exponents[static_cast<std::size_t>(r)];
    for (Eigen::Index c = 0; c < n; ++c)
    {
      long double value = Factorial(p);
      for (std::size_t d = 0; d < 4; ++d)
      {
        const int e = exponents[static_cast<std::size_t>(c)][d];
        value *= Power(static_cast<long double>(node[d]) / p, e) / Factorial(e);
      }
      values(r, c) = value;
    }
  }
  return values;
}

/// The simplices whose product the cell is: parameters and degree of each, the fastest first.
std::vector<std::array<int, 2>> SimplicesOf(CellShape shape, const CellDegree& degree)
{
  switch (shape)
  {
    case CellShape::Triangle:
      return { { 2, degree[0] } };
    case CellShape::Tetrahedron:
      return { { 3, degree[0] } };
    case CellShape::Wedge:
      return { { 2, degree[0] }, { 1, degree[2] } };
    default:
    {
      std::vector<std::array<int, 2>> lines;
      for (int d = 0; d < NumParameters(shape); ++d)
      {
        lines.push_back({ 1, degree[static_cast<std::size_t>(d)] });
      }
      return lines;
    }
  }
}

/// Kronecker product of the factors (the first fastest) times x.
LongMatrix ApplyFactors(const std::vector<LongMatrix>& factors, LongMatrix x)
{
  Eigen::Index inner = 1;
  for (const LongMatrix& factor : factors)
  {
    const Eigen::Index n = factor.rows();
    LongMatrix y = LongMatrix::Zero(x.rows(), x.cols());
    for (Eigen::Index row = 0; row < x.rows(); ++row)
    {
      const Eigen::Index i = row / inner % n;
      for (Eigen::Index j = 0; j < n; ++j)
      {
        y.row(row) += factor(i, j) * x.row(row + (j - i) * inner);
      }
    }
    x = std::move(y);
    inner *= n;
  }
  return x;
}

std::vector<LongMatrix> Absolute(std::vector<LongMatrix> factors)
{
  for (LongMatrix& factor : factors)
  {
    factor = factor.cwiseAbs().eval();
  }
  return factors;
}
}

std::vector<std::array<double, 3>> LatticeParameters(CellShape shape, const CellDegree& degree)
{
  const auto simplices = SimplicesOf(shape, degree);
  std::vector<std::array<double, 3>> all;
  for (int row = 0; row < NumCellCoefficients(shape, degree); ++row)
  {
    std::array<double, 3> at{};
    std::size_t rest = static_cast<std::size_t>(row);
    std::size_t d = 0;
    for (const auto& [parameters, p] : simplices)
    {
      const auto exponents = Exponents(parameters, p);
      for (int k = 0; k < parameters; ++k, ++d)
      {
        const int exponent = exponents[rest % exponents.size()][static_cast<std::size_t>(k)];
        at[d] = static_cast<double>(exponent) / p;
      }
      rest /= exponents.size();
    }
    all.push_back(at);
  }
  return all;
}

LatticeInterpolation::LatticeInterpolation(CellShape shape, const CellDegree& degree)
{
  for (const auto& [parameters, p] : SimplicesOf(shape, degree))
  {
    this->Collocation.push_back(MakeCollocation(parameters, p));
    this->Inverse.push_back(this->Collocation.back().fullPivLu().inverse());
  }
}

LongMatrix LatticeInterpolation::Coefficients(const LongMatrix& values) const
{
  return ApplyFactors(this->Inverse, values);
}

Eigen::MatrixXd LatticeInterpolation::Bound(
  const LongMatrix& values, const LongMatrix& exactly, long double rounding) const
{
  // M - exact = B^-1 (B M - W) for the matrix M that is used; the residual in long double is off by
  // less than 64 of its roundings times |B| |M|. Then one rounding a product and one a sum.
  constexpr long double longRounding = std::numeric_limits<long double>::epsilon();
  const LongMatrix residual = (ApplyFactors(this->Collocation, exactly) - values).cwiseAbs() +
    64.0L * longRounding * ApplyFactors(Absolute(this->Collocation), exactly.cwiseAbs());
  const long double sums = static_cast<long double>(exactly.cols() + 2) * rounding;
  return (1.0625L * (ApplyFactors(Absolute(this->Inverse), residual) + sums * exactly.cwiseAbs()))
    .cast<double>();
}
}
