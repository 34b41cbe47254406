// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SplineOracle.h"
#include <knotwork/JacobianValidation/JacobianCertificate.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

/// Cells whose verdict is known by construction. The kernel of each is the map
///     x = integral of g du,  y = v + h(w),  z = w        (curves and surfaces: see there)
/// whose Jacobian determinant is the polynomial g, of a known sign: a sum of squares plus a number,
/// or a product of parameters. It is disguised by what changes no sign: a linear map of positive
/// determinant, a projective map (det J is divided by a positive power), weights r^i (a change of
/// parameter), and degree elevation. Control points are rounded once, by at most 2^-53 relative, so
/// det J is off by less than 1e-13 of its size; where the number is smaller than that, the control
/// points are whole numbers and nothing is rounded.
namespace knotwork::corpus
{
using Real = long double;

/// Polynomial in (u, v, w) by exponents.
using Power = std::array<int, 3>;
using Polynomial = std::map<Power, Real>;

inline Polynomial Constant(Real c)
{
  return { { { 0, 0, 0 }, c } };
}
inline Polynomial Parameter(int d)
{
  Power e{};
  e[static_cast<std::size_t>(d)] = 1;
  return { { e, 1 } };
}
inline Polynomial operator+(const Polynomial& a, const Polynomial& b)
{
  Polynomial sum = a;
  for (const auto& [e, c] : b)
  {
    sum[e] += c;
  }
  return sum;
}
inline Polynomial operator*(const Polynomial& a, const Polynomial& b)
{
  Polynomial product;
  for (const auto& [e, c] : a)
  {
    for (const auto& [f, d] : b)
    {
      product[{ e[0] + f[0], e[1] + f[1], e[2] + f[2] }] += c * d;
    }
  }
  return product;
}
inline Polynomial operator*(Real s, const Polynomial& a)
{
  return Constant(s) * a;
}
inline Polynomial Integral(const Polynomial& g)
{
  Polynomial x;
  for (const auto& [e, c] : g)
  {
    x[{ e[0] + 1, e[1], e[2] }] += c / (e[0] + 1);
  }
  return x;
}
inline Real Evaluate(const Polynomial& a, const std::array<double, 3>& u)
{
  Real sum = 0;
  for (const auto& [e, c] : a)
  {
    sum += c * std::pow(static_cast<Real>(u[0]), e[0]) * std::pow(static_cast<Real>(u[1]), e[1]) *
      std::pow(static_cast<Real>(u[2]), e[2]);
  }
  return sum;
}

inline Real Choose(int n, int k)
{
  Real c = 1;
  for (int i = 1; i <= k; ++i)
  {
    c = c * (n - k + i) / i;
  }
  return k < 0 || k > n ? 0 : c;
}

/// Whether a shape's cells have a coefficient with these indices.
inline bool HasCoefficient(CellShape shape, const CellDegree& degree, int i, int j, int k)
{
  const bool triangle = shape == CellShape::Triangle || shape == CellShape::Wedge;
  const bool tetrahedron = shape == CellShape::Tetrahedron;
  return !(triangle && i + j > degree[0]) && !(tetrahedron && i + j + k > degree[0]);
}

/// Bernstein coefficients: u^i is sum_a C(a, i) / C(p, i) B_a^p, and alike on simplices with
/// multinomials.
inline std::vector<Real> Coefficients(
  CellShape shape, const CellDegree& degree, const Polynomial& polynomial)
{
  std::vector<Real> result(static_cast<std::size_t>(NumCellCoefficients(shape, degree)));
  const bool triangle = shape == CellShape::Triangle || shape == CellShape::Wedge;
  const bool tetrahedron = shape == CellShape::Tetrahedron;
  const int p = degree[0];
  for (int k = 0; k <= degree[2]; ++k)
  {
    for (int j = 0; j <= degree[1]; ++j)
    {
      for (int i = 0; i <= degree[0]; ++i)
      {
        if (!HasCoefficient(shape, degree, i, j, k))
        {
          continue;
        }
        Real sum = 0;
        for (const auto& [e, c] : polynomial)
        {
          Real factor = Choose(i, e[0]) * Choose(j, e[1]) * Choose(k, e[2]) / Choose(p, e[0]);
          factor /= Choose(triangle || tetrahedron ? p - e[0] : degree[1], e[1]);
          factor /= Choose(tetrahedron ? p - e[0] - e[1] : degree[2], e[2]);
          sum += factor == 0 || c == 0 ? 0 : c * factor;
        }
        result[static_cast<std::size_t>(CellCoefficient(shape, degree, i, j, k))] = sum;
      }
    }
  }
  return result;
}

/// Linear map of the components, of positive determinant with entries of whole numbers: unimodular
/// shears.
inline std::array<std::array<Real, 3>, 3> Shears(oracle::Random& random, int n)
{
  std::array<std::array<Real, 3>, 3> m{};
  for (std::size_t d = 0; d < 3; ++d)
  {
    m[d][d] = 1;
  }
  for (int k = 0; k < 3; ++k)
  {
    const int a = random.Int(0, n - 1);
    const int b = (a + random.Int(1, n - 1)) % n;
    const Real s = random.Int(-1, 1);
    for (std::size_t d = 0; d < 3; ++d)
    {
      m[static_cast<std::size_t>(a)][d] += s * m[static_cast<std::size_t>(b)][d];
    }
  }
  return m;
}

struct Disguise
{
  bool Linear = true;
  Real Projective = 0;              ///< size of the projective part of the weights, in (-1, 1)
  std::array<int, 3> Log2Weights{}; ///< weights 2^(i l0 + j l1 + k l2): a change of parameters that
                                    ///< maps the cell's domain onto itself, simplices too
  bool Reverse = false;             ///< swap the sign of a component
  bool Rational = false;
  Real Offset = 0;
};

/// Appends a cell of the map (components).
inline void AddCell(BernsteinCells& cells, CellShape shape, const CellDegree& degree,
  std::vector<Polynomial> map, const Disguise& disguise, oracle::Random& random)
{
  const std::size_t n = map.size();
  cells.NumComponents = static_cast<int>(n);
  cells.Rational = disguise.Rational;
  std::vector<std::vector<Real>> planes;
  for (const Polynomial& p : map)
  {
    planes.push_back(Coefficients(shape, degree, p));
  }
  if (disguise.Linear && n > 1)
  {
    const auto m = Shears(random, static_cast<int>(n));
    auto mixed = planes;
    for (std::size_t r = 0; r < n; ++r)
    {
      for (std::size_t i = 0; i < planes[0].size(); ++i)
      {
        mixed[r][i] = 0;
        for (std::size_t c = 0; c < n; ++c)
        {
          mixed[r][i] += m[r][c] * planes[c][i];
        }
      }
    }
    planes = mixed;
  }
  Real largest = 0;
  for (auto& plane : planes)
  {
    for (Real& x : plane)
    {
      largest = std::max(largest, std::abs(x));
      x += disguise.Offset;
    }
  }
  if (disguise.Reverse)
  {
    for (Real& x : planes[0])
    {
      x = -x;
    }
  }
  if (disguise.Rational)
  {
    // weight 1 + a . (x - offset): positive, and the projective map has a positive determinant: the
    // map (x, y) -> (x, y) / (1 + a . x) has det = 1 / (1 + a . x)^(n + 1)
    std::vector<Real> weights(planes[0].size(), 1);
    for (std::size_t c = 0; c < n; ++c)
    {
      const Real a = disguise.Projective / (largest * static_cast<Real>(n));
      for (std::size_t i = 0; i < weights.size(); ++i)
      {
        weights[i] += a * (planes[c][i] - disguise.Offset) * (disguise.Reverse && c == 0 ? -1 : 1);
      }
      if (disguise.Offset != 0)
      {
        // homogeneous points of offset + x / weight
        for (std::size_t i = 0; i < weights.size(); ++i)
        {
          planes[c][i] -= disguise.Offset;
        }
      }
    }
    if (disguise.Offset != 0)
    {
      for (std::size_t c = 0; c < n; ++c)
      {
        for (std::size_t i = 0; i < weights.size(); ++i)
        {
          planes[c][i] += disguise.Offset * weights[i];
        }
      }
    }
    planes.push_back(weights);
    for (int k = 0; k <= degree[2]; ++k)
    {
      for (int j = 0; j <= degree[1]; ++j)
      {
        for (int i = 0; i <= degree[0]; ++i)
        {
          if (!HasCoefficient(shape, degree, i, j, k))
          {
            continue;
          }
          const Real r = std::ldexp(Real(1),
            i * disguise.Log2Weights[0] + j * disguise.Log2Weights[1] +
              k * disguise.Log2Weights[2]);
          for (auto& plane : planes)
          {
            plane[static_cast<std::size_t>(CellCoefficient(shape, degree, i, j, k))] *= r;
          }
        }
      }
    }
  }
  const int cell = cells.Add(shape, degree);
  double* block = cells.Block(cell);
  for (const auto& plane : planes)
  {
    for (Real x : plane)
    {
      *block++ = static_cast<double>(x);
    }
  }
}

/// The map whose determinant is g.
inline std::vector<Polynomial> MapOf(const Polynomial& g, int n, oracle::Random& random)
{
  std::vector<Polynomial> map{ Integral(g), Parameter(1) };
  if (n == 3)
  {
    const Real s = random.Int(-1, 1);
    map[1] = map[1] + s * (Parameter(2) * Parameter(2));
    map.push_back(Parameter(2));
  }
  return map;
}

/// (u - a)^2 + (v - b)^2 (+ (w - c)^2) + number.
inline Polynomial Bowl(const std::array<double, 3>& at, int n, Real number)
{
  Polynomial g = Constant(number);
  for (int d = 0; d < n; ++d)
  {
    const Polynomial t =
      Parameter(d) + Constant(-static_cast<Real>(at[static_cast<std::size_t>(d)]));
    g = g + t * t;
  }
  return g;
}

/// A point well inside a cell of a shape.
inline std::array<double, 3> InnerPoint(oracle::Random& random, CellShape shape)
{
  std::array<double, 3> at{};
  const bool simplex = shape != CellShape::Quadrilateral && shape != CellShape::Hexahedron &&
    shape != CellShape::Curve;
  for (int d = 0; d < NumParameters(shape); ++d)
  {
    at[static_cast<std::size_t>(d)] = simplex ? random.In(0.1, 0.28) : random.In(0.1, 0.9);
  }
  return at;
}

inline CellDegree DegreeOf(CellShape shape, int p, int q, int r)
{
  switch (shape)
  {
    case CellShape::Curve:
      return { p, 0, 0 };
    case CellShape::Quadrilateral:
      return { p, q, 0 };
    case CellShape::Hexahedron:
      return { p, q, r };
    case CellShape::Triangle:
      return { p, p, 0 };
    case CellShape::Tetrahedron:
      return { p, p, p };
    default:
      return { p, p, r };
  }
}
}
