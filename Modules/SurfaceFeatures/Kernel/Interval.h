// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>

/// Private to the search of critical points: intervals whose ends are rounded outward.
namespace knotwork
{
/// Below the exact result of the operation whose rounded result is x, and above it.
inline double RoundDown(double x)
{
  return x - (std::abs(x) * 0x1p-52 + 0x1p-1000);
}
inline double RoundUp(double x)
{
  return x + (std::abs(x) * 0x1p-52 + 0x1p-1000);
}

struct Interval
{
  double Lo = 0.0;
  double Hi = 0.0;

  Interval() = default;
  explicit Interval(double x) : Lo(x), Hi(x) {}
  Interval(double lo, double hi) : Lo(lo), Hi(hi) {}

  /// 1 or -1 when all of it is, otherwise 0.
  int Sign() const { return this->Lo > 0.0 ? 1 : this->Hi < 0.0 ? -1 : 0; }
  double Middle() const { return this->Lo + 0.5 * (this->Hi - this->Lo); }
  double Width() const { return this->Hi - this->Lo; }
  double Magnitude() const { return std::max(std::abs(this->Lo), std::abs(this->Hi)); }
  /// Smallest interval around both.
  void Merge(const Interval& other)
  {
    this->Lo = std::min(this->Lo, other.Lo);
    this->Hi = std::max(this->Hi, other.Hi);
  }
  bool Holds(const Interval& other) const { return this->Lo <= other.Lo && other.Hi <= this->Hi; }
  bool HoldsInside(const Interval& other) const
  {
    return this->Lo < other.Lo && other.Hi < this->Hi;
  }
  bool Meets(const Interval& other) const { return this->Lo <= other.Hi && other.Lo <= this->Hi; }
};

inline Interval operator+(const Interval& a, const Interval& b)
{
  return { RoundDown(a.Lo + b.Lo), RoundUp(a.Hi + b.Hi) };
}
inline Interval operator-(const Interval& a, const Interval& b)
{
  return { RoundDown(a.Lo - b.Hi), RoundUp(a.Hi - b.Lo) };
}
inline Interval operator*(const Interval& a, const Interval& b)
{
  const double p = a.Lo * b.Lo;
  const double q = a.Lo * b.Hi;
  const double r = a.Hi * b.Lo;
  const double s = a.Hi * b.Hi;
  return { RoundDown(std::min(std::min(p, q), std::min(r, s))),
    RoundUp(std::max(std::max(p, q), std::max(r, s))) };
}
/// @pre b does not hold zero.
inline Interval operator/(const Interval& a, const Interval& b)
{
  return a * Interval(RoundDown(1.0 / b.Hi), RoundUp(1.0 / b.Lo));
}
}
