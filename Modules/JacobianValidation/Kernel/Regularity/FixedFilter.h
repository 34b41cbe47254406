// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CoefficientBounds.h"

#include <limits>

/// The coefficient filter compiled for a degree: the same forms and the same error analysis as
/// JacobianForms, with every loop of known length and sums kept in registers, a row of the result
/// at a time.
namespace knotwork::fixed
{
constexpr double Choose(int n, int k)
{
  double c = 1.0;
  for (int i = 1; i <= k; ++i)
  {
    c = c * (n - k + i) / i; // whole numbers at every step
  }
  return c;
}

/// The binomials of a degree, worked out by the compiler.
template <int N>
struct BinomialTable
{
  double Of[N + 1]{};
  constexpr BinomialTable()
  {
    for (int i = 0; i <= N; ++i)
    {
      this->Of[i] = Choose(N, i);
    }
  }
};
template <int N>
inline constexpr BinomialTable<N> Binomials{};

template <typename Pack>
using Blocks = BlocksOf<Pack>;

template <typename Pack>
inline Pack Gather(const Blocks<Pack>& blocks, int i)
{
  Pack x;
  for (int l = 0; l < LanesOf<Pack>; ++l)
  {
    x[l] = blocks[static_cast<std::size_t>(l)][i];
  }
  return x;
}

/// Differences along direction D of a plane of degrees P, Q, R, times the binomials of the
/// derivative; `largest` is raised to the largest unscaled one. Two roundings each.
template <int D, int P, int Q, int R, typename Pack>
inline void Differences(const Pack* plane, Pack* out, Pack& largest)
{
  constexpr int A = D == 0 ? P - 1 : P;
  constexpr int B = D == 1 ? Q - 1 : Q;
  constexpr int C = D == 2 ? R - 1 : R;
  constexpr int Stride = D == 0 ? 1 : D == 1 ? P + 1 : (P + 1) * (Q + 1);
  for (int k = 0; k <= C; ++k)
  {
    for (int j = 0; j <= B; ++j)
    {
      for (int i = 0; i <= A; ++i)
      {
        const int at = i + (P + 1) * (j + (Q + 1) * k);
        const Pack difference = plane[at + Stride] - plane[at];
        largest = Larger(largest, Magnitude(difference));
        out[i + (A + 1) * (j + (B + 1) * k)] =
          difference * (Binomials<A>.Of[i] * Binomials<B>.Of[j] * Binomials<C>.Of[k]);
      }
    }
  }
}

/// sum += or -= the product of two rows of N and M coefficients.
template <int N, int M, bool Subtract, typename Pack>
inline void AddRows(const Pack* a, const Pack* b, Pack* sum)
{
#pragma GCC unroll 8
  for (int i = 0; i < N; ++i)
  {
#pragma GCC unroll 8
    for (int m = 0; m < M; ++m)
    {
      if constexpr (Subtract)
      {
        sum[i + m] -= a[i] * b[m];
      }
      else
      {
        sum[i + m] += a[i] * b[m];
      }
    }
  }
}

/// Takes the finished rows of Factor times a result of degrees N, L, K.
template <typename Pack, int N, int L, int K, int Factor>
struct Extremes
{
  CoefficientBounds<Pack>& Bounds;
  /// Factor over the binomials, row by row.
  struct Table
  {
    double Of[(N + 1) * (L + 1) * (K + 1)]{};
    constexpr Table()
    {
      for (int k = 0; k <= K; ++k)
      {
        for (int l = 0; l <= L; ++l)
        {
          for (int i = 0; i <= N; ++i)
          {
            this->Of[i + (N + 1) * (l + (L + 1) * k)] =
              Factor / (Choose(N, i) * Choose(L, l) * Choose(K, k));
          }
        }
      }
    }
  };
  static constexpr Table Scale{};

  void Start()
  {
    this->Bounds.Smallest = Pack{} + std::numeric_limits<double>::infinity();
    this->Bounds.Largest = -this->Bounds.Smallest;
    this->Bounds.SmallestCorner = this->Bounds.Smallest;
    this->Bounds.LargestCorner = this->Bounds.Largest;
    this->Bounds.SmallestWeight = this->Bounds.LargestWeight = Pack{} + 1.0;
  }
  void Row(int l, int k, const Pack* row, Pack* corners)
  {
    const double* scale = Scale.Of + (N + 1) * (l + (L + 1) * k);
    for (int i = 0; i <= N; ++i)
    {
      // two roundings: of the quotient of constants, and of the product
      const Pack value = row[i] * scale[i];
      this->Bounds.Smallest = Smaller(this->Bounds.Smallest, value);
      this->Bounds.Largest = Larger(this->Bounds.Largest, value);
      if ((i == 0 || i == N) && (l == 0 || l == L) && (k == 0 || k == K))
      {
        corners[(i == 0 ? 0 : 1) + (l == 0 ? 0 : 2) + (k == 0 ? 0 : 4)] = value;
      }
    }
  }
  void Corner(const Pack& value)
  {
    this->Bounds.SmallestCorner = Smaller(this->Bounds.SmallestCorner, value);
    this->Bounds.LargestCorner = Larger(this->Bounds.LargestCorner, value);
  }
};

template <typename Pack, int P, int Q>
void PolynomialQuadrilateral(const Blocks<Pack>& blocks, CoefficientBounds<Pack>& bounds)
{
  constexpr int Size = (P + 1) * (Q + 1);
  Pack du[2][P * (Q + 1)];
  Pack dv[2][(P + 1) * Q];
  Pack mu[2] = {};
  Pack mv[2] = {};
  Pack notFinite = {};
  for (int c = 0; c < 2; ++c)
  {
    Pack plane[Size];
    for (int i = 0; i < Size; ++i)
    {
      plane[i] = Gather<Pack>(blocks, c * Size + i);
      notFinite += 0.0 * plane[i];
    }
    Differences<0, P, Q, 0>(plane, du[c], mu[c]);
    Differences<1, P, Q, 0>(plane, dv[c], mv[c]);
  }
  bounds.NotFinite = notFinite;
  bounds.Magnitude = Larger(Larger(mu[0], mu[1]), Larger(mv[0], mv[1]));
  Extremes<Pack, 2 * P - 1, 2 * Q - 1, 0, P * Q> extremes{ bounds };
  extremes.Start();
  Pack corners[4];
  for (int l = 0; l < 2 * Q; ++l)
  {
    Pack row[2 * P] = {};
    for (int j = l < Q ? 0 : l - Q + 1; j <= (l < Q ? l : Q); ++j)
    {
      AddRows<P, P + 1, false>(du[0] + j * P, dv[1] + (l - j) * (P + 1), row);
      AddRows<P, P + 1, true>(du[1] + j * P, dv[0] + (l - j) * (P + 1), row);
    }
    extremes.Row(l, 0, row, corners);
  }
  for (const Pack& corner : corners)
  {
    extremes.Corner(corner);
  }
  constexpr int Terms = 2 * (P < Q ? P * (Q + 1) : (P + 1) * Q);
  bounds.Error =
    RoundingFactor(2 + 2 + 1 + Terms + 2) * (P * Q) * (mu[0] * mv[1] + mu[1] * mv[0]) + 0x1p-700;
}

template <typename Pack, int P, int Q, int R>
void PolynomialHexahedron(const Blocks<Pack>& blocks, CoefficientBounds<Pack>& bounds)
{
  constexpr int Size = (P + 1) * (Q + 1) * (R + 1);
  Pack du[3][P * (Q + 1) * (R + 1)];
  Pack dv[3][(P + 1) * Q * (R + 1)];
  Pack dw[3][(P + 1) * (Q + 1) * R];
  Pack mu[3] = {};
  Pack mv[3] = {};
  Pack mw[3] = {};
  Pack notFinite = {};
  for (int c = 0; c < 3; ++c)
  {
    Pack plane[Size];
    for (int i = 0; i < Size; ++i)
    {
      plane[i] = Gather<Pack>(blocks, c * Size + i);
      notFinite += 0.0 * plane[i];
    }
    Differences<0, P, Q, R>(plane, du[c], mu[c]);
    Differences<1, P, Q, R>(plane, dv[c], mv[c]);
    Differences<2, P, Q, R>(plane, dw[c], mw[c]);
  }
  bounds.NotFinite = notFinite;
  bounds.Magnitude = Larger(Larger(Larger(mu[0], mu[1]), Larger(mu[2], mv[0])),
    Larger(Larger(Larger(mv[1], mv[2]), Larger(mw[0], mw[1])), mw[2]));

  // cross product of the first two derivatives: degrees (2P - 1, 2Q - 1, 2R)
  constexpr int Rows = 2 * Q * (2 * R + 1);
  Pack cross[3][2 * P * Rows];
  for (int c = 0; c < 3; ++c)
  {
    const int a = (c + 1) % 3;
    const int b = (c + 2) % 3;
    for (int k = 0; k <= 2 * R; ++k)
    {
      for (int l = 0; l < 2 * Q; ++l)
      {
        Pack row[2 * P] = {};
        for (int n = k < R ? 0 : k - R; n <= (k < R ? k : R); ++n)
        {
          for (int j = l < Q ? 0 : l - Q + 1; j <= (l < Q ? l : Q); ++j)
          {
            const int u = P * (j + (Q + 1) * n);
            const int v = (P + 1) * (l - j + Q * (k - n));
            AddRows<P, P + 1, false>(du[a] + u, dv[b] + v, row);
            AddRows<P, P + 1, true>(du[b] + u, dv[a] + v, row);
          }
        }
        for (int i = 0; i < 2 * P; ++i)
        {
          cross[c][2 * P * (l + 2 * Q * k) + i] = row[i];
        }
      }
    }
  }

  Extremes<Pack, 3 * P - 1, 3 * Q - 1, 3 * R - 1, P * Q * R> extremes{ bounds };
  extremes.Start();
  Pack corners[8];
  for (int k = 0; k < 3 * R; ++k)
  {
    for (int l = 0; l < 3 * Q; ++l)
    {
      Pack row[3 * P] = {};
      for (int n = k > 2 * R ? k - 2 * R : 0; n <= (k < R ? k : R - 1); ++n)
      {
        for (int j = l > 2 * Q - 1 ? l - 2 * Q + 1 : 0; j <= (l < Q ? l : Q); ++j)
        {
          const int w = (P + 1) * (j + (Q + 1) * n);
          const int x = 2 * P * (l - j + 2 * Q * (k - n));
          for (int c = 0; c < 3; ++c)
          {
            AddRows<2 * P, P + 1, false>(cross[c] + x, dw[c] + w, row);
          }
        }
      }
      extremes.Row(l, k, row, corners);
    }
  }
  for (const Pack& corner : corners)
  {
    extremes.Corner(corner);
  }
  constexpr int SizeU = P * (Q + 1) * (R + 1);
  constexpr int SizeV = (P + 1) * Q * (R + 1);
  constexpr int SizeW = (P + 1) * (Q + 1) * R;
  constexpr int CrossRoundings = 2 + 2 + 1 + 2 * (SizeU < SizeV ? SizeU : SizeV);
  bounds.Error = RoundingFactor(CrossRoundings + 2 + 1 + 3 * SizeW + 2) * (P * Q * R) *
      (mw[0] * (mu[1] * mv[2] + mu[2] * mv[1]) + mw[1] * (mu[2] * mv[0] + mu[0] * mv[2]) +
        mw[2] * (mu[0] * mv[1] + mu[1] * mv[0])) +
    0x1p-700;
}

/// Trilinear cells: the same with all loops unrolled; binomials are 1 but in the result.
template <typename Pack>
void LinearHexahedron(const Blocks<Pack>& blocks, CoefficientBounds<Pack>& bounds)
{
  Pack du[3][4]; // index v + 2 w
  Pack dv[3][4]; // u + 2 w
  Pack dw[3][4]; // u + 2 v
  Pack mu[3] = {};
  Pack mv[3] = {};
  Pack mw[3] = {};
  Pack notFinite = {};
#pragma GCC unroll 3
  for (int c = 0; c < 3; ++c)
  {
    Pack x[8];
#pragma GCC unroll 8
    for (int i = 0; i < 8; ++i)
    {
      x[i] = Gather<Pack>(blocks, 8 * c + i);
      notFinite += 0.0 * x[i];
    }
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i)
    {
      du[c][i] = x[2 * i + 1] - x[2 * i];
      dv[c][i] = x[(i & 1) + 4 * (i >> 1) + 2] - x[(i & 1) + 4 * (i >> 1)];
      dw[c][i] = x[i + 4] - x[i];
      mu[c] = Larger(mu[c], Magnitude(du[c][i]));
      mv[c] = Larger(mv[c], Magnitude(dv[c][i]));
      mw[c] = Larger(mw[c], Magnitude(dw[c][i]));
    }
  }
  bounds.NotFinite = notFinite;
  bounds.Magnitude = Larger(Larger(Larger(mu[0], mu[1]), Larger(mu[2], mv[0])),
    Larger(Larger(Larger(mv[1], mv[2]), Larger(mw[0], mw[1])), mw[2]));
  Extremes<Pack, 2, 2, 2, 1> extremes{ bounds };
  extremes.Start();
  Pack corners[8];
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k)
  {
    Pack layer[3][3] = {};
#pragma GCC unroll 2
    for (int l = 0; l < 2; ++l)
    {
#pragma GCC unroll 2
      for (int i = 0; i < 2; ++i)
      {
#pragma GCC unroll 3
        for (int c = 0; c < 3; ++c)
        {
          const int a = (c + 1) % 3;
          const int b = (c + 2) % 3;
          Pack cross = {};
#pragma GCC unroll 2
          for (int n = 0; n < 2; ++n)
          {
            const int m = k - n;
            if (m == 0 || m == 1)
            {
              cross += du[a][l + 2 * n] * dv[b][i + 2 * m];
              cross -= du[b][l + 2 * n] * dv[a][i + 2 * m];
            }
          }
          layer[l][i] += cross * dw[c][0];
          layer[l][i + 1] += cross * dw[c][1];
          layer[l + 1][i] += cross * dw[c][2];
          layer[l + 1][i + 1] += cross * dw[c][3];
        }
      }
    }
#pragma GCC unroll 3
    for (int l = 0; l < 3; ++l)
    {
      extremes.Row(l, k, layer[l], corners);
    }
  }
#pragma GCC unroll 8
  for (const Pack& corner : corners)
  {
    extremes.Corner(corner);
  }
  // differences 1 + 1, cross 1 + 4, product 1 + 1, sums of 12, constants 2
  bounds.Error = RoundingFactor(2 + 5 + 2 + 12 + 2) *
      (mw[0] * (mu[1] * mv[2] + mu[2] * mv[1]) + mw[1] * (mu[2] * mv[0] + mu[0] * mv[2]) +
        mw[2] * (mu[0] * mv[1] + mu[1] * mv[0])) +
    0x1p-700;
}

/// See JacobianForms::PlanarMinor for the form.
template <typename Pack, int P, int Q>
void RationalQuadrilateral(const Blocks<Pack>& blocks, CoefficientBounds<Pack>& bounds)
{
  constexpr int Size = (P + 1) * (Q + 1);
  Pack planes[3][Size];
  Pack notFinite = {};
  for (int c = 0; c < 3; ++c)
  {
    for (int i = 0; i < Size; ++i)
    {
      planes[c][i] = Gather<Pack>(blocks, c * Size + i);
      notFinite += 0.0 * planes[c][i];
    }
  }
  Pack size[3] = {};
  Pack shift[2];
  const Pack* w = planes[2];
  Pack smallestWeight = w[0];
  size[2] = w[0];
  for (int i = 1; i < Size; ++i)
  {
    smallestWeight = Smaller(smallestWeight, w[i]);
    size[2] = Larger(size[2], w[i]);
  }
  for (int c = 0; c < 2; ++c)
  {
    // to the cell's middle: two roundings a coefficient
    Pack* p = planes[c];
    const Pack centre = 0.5 * (p[0] / w[0] + p[Size - 1] / w[Size - 1]);
    for (int i = 0; i < Size; ++i)
    {
      p[i] = p[i] - centre * w[i];
      size[c] = Larger(size[c], Magnitude(p[i]));
    }
    shift[c] = 2.0 * UnitRoundoff * (Magnitude(centre) * size[2] + size[c]);
  }

  // nets of one degree less in both directions, and in the first alone
  constexpr int Both = P * Q;
  constexpr int First = P * (Q + 1);
  Pack net[3][4][Both]; // corner (0,0), (1,0), (0,1), (1,1)
  Pack side[3][2][First];
  for (int c = 0; c < 3; ++c)
  {
    for (int j = 0; j <= Q; ++j)
    {
      for (int i = 0; i < P; ++i)
      {
        const Pack* p = planes[c] + i + (P + 1) * j;
        const double first = Binomials<P - 1>.Of[i] * Binomials<Q>.Of[j];
        side[c][0][i + P * j] = p[0] * first;
        side[c][1][i + P * j] = p[1] * first;
        if (j < Q)
        {
          const double both = Binomials<P - 1>.Of[i] * Binomials<Q - 1>.Of[j];
          net[c][0][i + P * j] = p[0] * both;
          net[c][1][i + P * j] = p[1] * both;
          net[c][2][i + P * j] = p[P + 1] * both;
          net[c][3][i + P * j] = p[P + 2] * both;
        }
      }
    }
  }

  // A x C and B x E: degrees (2P - 2, 2Q - 2)
  constexpr int Wide = 2 * P - 1;
  Pack cross[2][3][Wide * (2 * Q - 1)];
  for (int s = 0; s < 2; ++s)
  {
    for (int c = 0; c < 3; ++c)
    {
      const int a = (c + 1) % 3;
      const int b = (c + 2) % 3;
      for (int l = 0; l < 2 * Q - 1; ++l)
      {
        Pack row[Wide] = {};
        for (int j = l < Q ? 0 : l - Q + 1; j <= (l < Q ? l : Q - 1); ++j)
        {
          AddRows<P, P, false>(net[a][s] + P * j, net[b][s + 2] + P * (l - j), row);
          AddRows<P, P, true>(net[b][s] + P * j, net[a][s + 2] + P * (l - j), row);
        }
        for (int i = 0; i < Wide; ++i)
        {
          cross[s][c][Wide * l + i] = row[i];
        }
      }
    }
  }

  Extremes<Pack, 3 * P - 2, 3 * Q - 2, 0, P * Q> extremes{ bounds };
  extremes.Start();
  bounds.NotFinite = notFinite;
  bounds.SmallestWeight = smallestWeight;
  bounds.LargestWeight = size[2];
  bounds.Magnitude = Larger(Larger(size[0], size[1]), size[2]);
  Pack corners[4];
  for (int l = 0; l < 3 * Q - 1; ++l)
  {
    Pack row[3 * P - 1] = {};
    for (int j = l > 2 * Q - 2 ? l - 2 * Q + 2 : 0; j <= (l < Q ? l : Q); ++j)
    {
      for (int c = 0; c < 3; ++c)
      {
        AddRows<Wide, P, false>(cross[1][c] + Wide * (l - j), side[c][0] + P * j, row + 1);
        AddRows<Wide, P, true>(cross[0][c] + Wide * (l - j), side[c][1] + P * j, row);
      }
    }
    extremes.Row(l, 0, row, corners);
  }
  const int places[4] = { 0, P, (P + 1) * Q, Size - 1 };
  for (int c = 0; c < 4; ++c)
  {
    const Pack& weight = w[places[c]];
    extremes.Corner(corners[c] / (weight * weight * weight));
  }
  constexpr int CrossRoundings = 1 + 1 + 1 + 2 * Both;
  bounds.Error = RoundingFactor(CrossRoundings + 1 + 1 + 6 * First + 2) * (12 * P * Q) *
      (size[0] * size[1] * size[2]) +
    (1.0 + 0x1p-30) * (12 * P * Q) *
      (size[2] * (size[0] * shift[1] + size[1] * shift[0] + shift[0] * shift[1])) +
    0x1p-700;
}
}
