// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <cstdint>

namespace knotwork
{
/// Arithmetic modulo an odd prime below 2^31. Numbers are residues in [0, prime).
class PrimeField
{
public:
  using Number = std::uint32_t;
  static constexpr Number LargestPrime = 2147483647U; // 2^31 - 1

  explicit PrimeField(Number prime = LargestPrime) : P(prime) {}

  Number Prime() const { return this->P; }
  Number Add(Number a, Number b) const
  {
    const Number sum = a + b; // below 2^32
    return sum >= this->P ? sum - this->P : sum;
  }
  Number Subtract(Number a, Number b) const { return a >= b ? a - b : a + this->P - b; }
  Number Multiply(Number a, Number b) const
  {
    return static_cast<Number>(std::uint64_t{ a } * b % this->P);
  }
  Number Power(Number a, std::uint64_t exponent) const
  {
    Number result = 1;
    for (; exponent > 0; exponent >>= 1)
    {
      result = exponent & 1 ? this->Multiply(result, a) : result;
      a = this->Multiply(a, a);
    }
    return result;
  }
  /// @pre a != 0.
  Number Inverse(Number a) const { return this->Power(a, this->P - 2); }

  /// Residue of a finite double, which is a whole number times a power of two.
  Number OfDouble(double value) const
  {
    int exponent = 0;
    const auto mantissa =
      static_cast<std::int64_t>(std::ldexp(std::frexp(std::fabs(value), &exponent), 53));
    exponent -= 53;
    const Number two = exponent >= 0 ? 2 : this->Inverse(2);
    const Number result =
      this->Multiply(static_cast<Number>(static_cast<std::uint64_t>(mantissa) % this->P),
        this->Power(two, static_cast<std::uint64_t>(std::abs(exponent))));
    return value < 0.0 ? this->Subtract(0, result) : result;
  }

  /// The next smaller prime; strong pseudoprimes to bases 2, 7 and 61 begin beyond 2^32.
  /// @source  Jaeschke, Math. Comp. 61 (1993) 915-926.
  static Number PrimeBelow(Number n)
  {
    do
    {
      n -= n % 2 == 0 ? 1 : 2;
    } while (!IsPrime(n));
    return n;
  }

private:
  static bool IsPrime(Number n)
  {
    const PrimeField field(n);
    Number odd = n - 1;
    int twos = 0;
    for (; odd % 2 == 0; odd /= 2)
    {
      ++twos;
    }
    for (const Number base : { 2U, 7U, 61U })
    {
      Number x = field.Power(base, odd);
      bool passes = x == 1 || x == n - 1;
      for (int i = 1; i < twos && !passes; ++i)
      {
        x = field.Multiply(x, x);
        passes = x == n - 1;
      }
      if (!passes)
      {
        return false;
      }
    }
    return true;
  }

  Number P;
};
}
