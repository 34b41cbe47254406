// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <vector>

/// Arithmetic in Bernstein form on [0, 1]^Dim. A polynomial of degree (p_0, ...) is its
/// prod(p_d + 1) coefficients, first parameter fastest. Everything here is exact up to rounding.
/// @source  Farouki & Rajan, CAGD 5 (1988) 1-26; Farin, Curves and Surfaces for CAGD.
namespace knotwork
{
/// Binomial coefficient, exact for n <= 56.
double Binomial(int n, int k);

/// values[i] = B_i^p(t), i = 0..p.
void BernsteinValues(int degree, double t, double* values);

/// Row k (k = 0..order) = k-th derivatives of the p + 1 Bernstein polynomials with respect to t.
void BernsteinDerivatives(int degree, double t, int order, double* values);

/// Value of a polynomial by de Casteljau's algorithm (the slow, robust evaluation used as an
/// oracle).
template <int Dim>
double BernsteinEvaluate(const IntArray<Dim>& degree, const double* coefficients, const double* t);

/// Coefficients of the product, degree p + q.
template <int Dim>
std::vector<double> BernsteinProduct(const IntArray<Dim>& degreeA, const std::vector<double>& a,
  const IntArray<Dim>& degreeB, const std::vector<double>& b);

/// Coefficients of the derivative along a direction; that direction's degree falls by one (it must
/// be at least 1).
template <int Dim>
std::vector<double> BernsteinDerivative(
  const IntArray<Dim>& degree, const std::vector<double>& a, int direction);

/// The same polynomial with higher degrees; target[d] >= degree[d].
template <int Dim>
std::vector<double> BernsteinElevate(
  const IntArray<Dim>& degree, const std::vector<double>& a, const IntArray<Dim>& target);

/// The polynomial restricted to [lower, upper] in one direction and mapped back to [0, 1]
/// (blossom).
template <int Dim>
std::vector<double> BernsteinRestrict(const IntArray<Dim>& degree, const std::vector<double>& a,
  int direction, double lower, double upper);

/// The same as a factor for ApplyFactors, for many polynomials and without allocation: entry (i, k)
/// is the blossom of B_i^p at (lower^{p-k}, upper^k). Exact for halves; no entry is negative when
/// 0 <= lower <= upper <= 1. (A constant keeps its value only up to rounding.)
/// @param degree  at most 56. @param matrix  (p+1) x (p+1) row-major.
void BernsteinRestriction(int degree, double lower, double upper, double* matrix);

/// De Casteljau's algorithm at 1/2: `upper` becomes the coefficients of the upper half, `lower`
/// gets those of the lower one.
/// @param degree  index of the last coefficient. @param step  between coefficients, of both.
template <typename Number>
void HalveBernstein(int degree, Number* upper, Number* lower, int step = 1)
{
  for (int r = 0; r <= degree; ++r)
  {
    lower[r * step] = upper[0];
    for (int i = 0; i < degree - r; ++i)
    {
      upper[i * step] = 0.5 * (upper[i * step] + upper[(i + 1) * step]);
    }
  }
}

/// Inverse of the Gram matrix of the Bernstein polynomials of degree p on [0, 1], (p+1) x (p+1)
/// row-major. @source  Juettler, Adv. Comput. Math. 8 (1998) 345-352.
std::vector<double> BernsteinGramInverse(int degree);

/// y = (F_0^T (x) ... )^T applied direction by direction: multiplies a tensor array by one square
/// matrix a direction: out[k_0,..] = sum_i in[i_0,..] prod_d factor_d[i_d][k_d]. A null factor is
/// the identity. in and out are prod(p_d + 1) values each and may be the same array.
/// @param degree  each at most MaxDegree + 1.
template <int Dim>
void ApplyFactors(const IntArray<Dim>& degree, const std::array<const double*, Dim>& factors,
  const double* in, double* out);
}
