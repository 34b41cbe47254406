// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "JacobianForms.h"

#include <boost/multiprecision/cpp_int.hpp>

namespace knotwork
{
/// Integer of any size as the arithmetic of JacobianForms.
struct ExactInteger
{
  using Number = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>,
    boost::multiprecision::et_off>;
  Number V;

  ExactInteger() = default;
  ExactInteger(Number v) : V(std::move(v)) {}
  static ExactInteger Multinomial(const FormLayout& layout, int i);

  int Sign() const { return this->V.sign(); }
  ExactInteger& operator+=(const ExactInteger& b)
  {
    this->V += b.V;
    return *this;
  }
  ExactInteger& operator-=(const ExactInteger& b)
  {
    this->V -= b.V;
    return *this;
  }
  friend ExactInteger operator+(const ExactInteger& a, const ExactInteger& b)
  {
    return Number(a.V + b.V);
  }
  friend ExactInteger operator-(const ExactInteger& a, const ExactInteger& b)
  {
    return Number(a.V - b.V);
  }
  friend ExactInteger operator*(const ExactInteger& a, const ExactInteger& b)
  {
    return Number(a.V * b.V);
  }
  /// @param b  a whole number below 2^31.
  friend ExactInteger operator*(const ExactInteger& a, double b)
  {
    return Number(a.V * static_cast<int>(b));
  }
};

/// A finite double as m 2^e with an odd m (or zero).
struct DyadicNumber
{
  ExactInteger::Number M;
  int E = 0;
};
DyadicNumber Dyadic(double x);

/// A form with exact coefficients: scaled coefficient k is C[k] 2^Exponent.
struct ExactForm
{
  const FormLayout* Layout = nullptr;
  std::vector<ExactInteger> C;
  int Exponent = 0;

  /// The form on one half of its cell, cut at the middle of an edge; side 0 keeps the first slot's
  /// corner.
  ExactForm Half(int edge, int side) const;
  /// All scaled coefficients without the slot are zero.
  bool VanishesAt(int slot) const;
  /// Quotient by the slot. @pre VanishesAt(slot).
  ExactForm Quotient(int slot, LayoutCache& cache) const;
  /// Sign of the value at local parameters, exactly.
  int SignAt(const std::array<double, 3>& parameters) const;
  /// Value there, to within a relative error of 2^-45; +-huge or 0 beyond the doubles' range.
  double ValueAt(const std::array<double, 3>& parameters) const;
  /// Unscaled coefficients over 2^scale, each with a relative error of at most 8 u and of exact
  /// sign; the scale makes the largest about one.
  std::vector<double> Coefficients(int& scale) const;
  /// With a scale given; what underflows keeps its sign as the smallest normal number.
  std::vector<double> CoefficientsAt(int scale) const;

private:
  DyadicNumber At(const std::array<double, 3>& parameters) const;
};

/// A cell's geometry as integers over a common power of two.
struct ExactCell
{
  std::array<std::vector<ExactInteger>, 4> Planes;
  int Exponent = 0;
  bool Snapped = false; ///< control points on the boundary were made to coincide
  /// Bit s: all lines of control points in one direction of the side of slot s are points, so that
  /// the side is a curve or a point; but for the rounding of its weights, which it bends by.
  std::uint8_t CollapsedSides = 0;
};

/// The Euclidean coordinate of a homogeneous one, hi + lo = x w.
/// @return false when x is not a double; it is then the nearest one but for a rounding.
bool Quotient(double hi, double lo, double w, double& x);

/// @param remainders  added to the block; null: none.
/// @param tolerance  control points that follow the first or the last of a line on the boundary and
/// agree with it within the tolerance become that point: collapsed lines, and lines that stand
/// still at an end; 0: none.
ExactCell MakeExactCell(const FormLayout& layout, int numComponents, bool rational,
  const double* block, const double* remainders, double tolerance);
}
