// SPDX-License-Identifier: BSD-3-Clause
#include "RadialKernel.h"

#include <algorithm>
#include <cstdint>

namespace knotwork
{
namespace
{
/// Centres that are summed side by side: as many sums, whatever the vectors are.
constexpr std::size_t Block = 4;
/// Below this squared distance phi is 0 in double precision.
constexpr double LeastSquare = 1e-280;

template <int Width>
struct Words
{
  typedef std::uint64_t Type __attribute__((vector_size(Width * sizeof(std::uint64_t)), may_alias));
};
template <int Width>
inline void Fill(Doubles<Width>& all, double value)
{
  all = Doubles<Width>{} + value;
}

/// ln x of normal numbers: x = 2^k m with m in [sqrt(1/2), sqrt(2)), ln m = 2 artanh((m - 1) / (m +
/// 1)) by its series, whose last term is below half a unit roundoff.
template <int Width>
inline void Logarithm(Doubles<Width>& x)
{
  using Integers = typename Words<Width>::Type;
  constexpr std::uint64_t rootOfHalf = 0x3fe6a09e667f3bcd; // bits of sqrt(1/2)
  constexpr std::uint64_t mantissa = 52;
  constexpr double whole = 0x1.8p52; // plus k: the last bits are k
  Integers bits;
  __builtin_memcpy(&bits, &x, sizeof(bits));
  // of numbers without a sign: there is no arithmetic shift of 64 bits before AVX-512
  const Integers shifted = bits - rootOfHalf + (std::uint64_t(1024) << mantissa);
  const Integers exponent = (shifted >> mantissa) - 1024;
  const Integers rest = bits - (exponent << mantissa);
  Integers wholeBits;
  Doubles<Width> wholes;
  Fill<Width>(wholes, whole);
  __builtin_memcpy(&wholeBits, &wholes, sizeof(wholeBits));
  wholeBits += exponent;
  Doubles<Width> k;
  Doubles<Width> m;
  __builtin_memcpy(&k, &wholeBits, sizeof(k));
  __builtin_memcpy(&m, &rest, sizeof(m));
  k -= whole;
  const Doubles<Width> s = (m - 1.0) / (m + 1.0);
  const Doubles<Width> z = s * s;
  Doubles<Width> sum;
  Fill<Width>(sum, 1.0 / 23.0);
  sum = sum * z + 1.0 / 21.0;
  sum = sum * z + 1.0 / 19.0;
  sum = sum * z + 1.0 / 17.0;
  sum = sum * z + 1.0 / 15.0;
  sum = sum * z + 1.0 / 13.0;
  sum = sum * z + 1.0 / 11.0;
  sum = sum * z + 1.0 / 9.0;
  sum = sum * z + 1.0 / 7.0;
  sum = sum * z + 1.0 / 5.0;
  sum = sum * z + 1.0 / 3.0;
  sum = 2.0 * s + 2.0 * s * (z * sum);
  x = k * 0x1.62e42fefa39efp-1 + (sum + k * 0x1.abc9e3b39803fp-56); // ln 2 in two parts
}

/// r^2 ln r by halves: r^2 ln(r^2) / 2.
template <int Width>
inline void Phi(const double* x, const double* y, double u, double v, Doubles<Width>& value)
{
  using Vector = typename DoublesInMemory<Width>::Type;
  const Doubles<Width> dx = *reinterpret_cast<const Vector*>(x) - u;
  const Doubles<Width> dy = *reinterpret_cast<const Vector*>(y) - v;
  const Doubles<Width> square = dx * dx + dy * dy;
  Doubles<Width> least;
  Fill<Width>(least, LeastSquare);
  value = square > least ? square : least;
  Logarithm<Width>(value);
  value *= 0.5 * square;
}
}

RadialKernel::RadialKernel(const Eigen::Ref<const Eigen::MatrixXd>& centres,
  const Eigen::Ref<const Eigen::MatrixXd>& coefficients)
  : Count(static_cast<std::size_t>(centres.rows())),
    Components(static_cast<int>(coefficients.cols()))
{
  const std::size_t padded = (this->Count + Block - 1) / Block * Block;
  this->X.assign(padded, 0.0);
  this->Y.assign(padded, 0.0);
  this->Coefficients.assign(padded * static_cast<std::size_t>(this->Components), 0.0);
  std::copy_n(centres.col(0).data(), this->Count, this->X.data());
  std::copy_n(centres.col(1).data(), this->Count, this->Y.data());
  for (int c = 0; c < this->Components; ++c)
  {
    std::copy_n(coefficients.col(c).data(), this->Count,
      this->Coefficients.data() + static_cast<std::size_t>(c) * padded);
  }
}

void RadialKernel::Values(double u, double v, double* values) const
{
  WithWidestVectors(
    [this, u, v, values](auto vector)
    {
      constexpr int Width = decltype(vector)::value;
      for (std::size_t i = 0; i < this->Count; i += Width)
      {
        Doubles<Width> value;
        Phi<Width>(this->X.data() + i, this->Y.data() + i, u, v, value);
        for (std::size_t l = 0; l < std::min<std::size_t>(Width, this->Count - i); ++l)
        {
          values[i + l] = value[static_cast<int>(l)];
        }
      }
    });
}

void RadialKernel::Sums(double u, double v, double* sums) const
{
  WithWidestVectors(
    [this, u, v, sums](auto vector)
    {
      constexpr int Width = decltype(vector)::value;
      constexpr int Vectors = static_cast<int>(Block) / Width;
      using Vector = typename DoublesInMemory<Width>::Type;
      Doubles<Width> all[MaxComponents][Vectors] = {};
      const std::size_t padded = this->X.size();
      for (std::size_t i = 0; i < padded; i += Block)
      {
        for (int k = 0; k < Vectors; ++k)
        {
          const std::size_t at = i + static_cast<std::size_t>(k * Width);
          Doubles<Width> value;
          Phi<Width>(this->X.data() + at, this->Y.data() + at, u, v, value);
          for (int c = 0; c < this->Components; ++c)
          {
            const Doubles<Width> factor = *reinterpret_cast<const Vector*>(
              this->Coefficients.data() + static_cast<std::size_t>(c) * padded + at);
            all[c][k] += value * factor;
          }
        }
      }
      for (int c = 0; c < this->Components; ++c)
      {
        double lanes[Block];
        for (int l = 0; l < static_cast<int>(Block); ++l)
        {
          lanes[l] = all[c][l / Width][l % Width];
        }
        sums[c] = (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
      }
    });
}
}
