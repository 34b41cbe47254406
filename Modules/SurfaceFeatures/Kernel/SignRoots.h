// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vector>

/// Private to the contours: sign changes of polynomials in Bernstein form on [0, 1].
namespace knotwork
{
/// A value of 0 counts as positive.
inline bool IsPositive(double value)
{
  return value >= 0.0;
}

/// Value and, where wanted, derivative. @param degree  at most MaxDegree.
double EvaluateBernstein(int degree, const double* coefficients, double t, double* derivative);

/// Gives the ends of the polynomial the wanted signs where they are within rounding of zero.
void SetEndSigns(int degree, double* coefficients, bool positiveBegin, bool positiveEnd);

/// Appends the places where the polynomial changes its sign, ascending; as many as the signs of the
/// end coefficients want, modulo 2. Pairs nearer than 2^-50 may be missing.
/// @source  variation diminishing and bisection: Lane & Riesenfeld, BIT 21 (1981) 112-117.
void FindSignChanges(int degree, const double* coefficients, std::vector<double>& roots);

/// The sign change between two places whose values have different signs, by Newton's iteration
/// inside a bracket.
/// @param t      first guess.
/// @param enough  a step so short, relative to t, is the last one (the error is about its square).
double FindSignChange(
  int degree, const double* coefficients, double low, double high, double t, double enough);
}
