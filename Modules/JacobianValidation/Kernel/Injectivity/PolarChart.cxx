// SPDX-License-Identifier: BSD-3-Clause
#include "PolarChart.h"

#include <knotwork/SplineCore/Bernstein.h>

#include <Eigen/Geometry>

namespace knotwork
{
namespace
{
using Vector = Eigen::Vector3d;
}

PieceHalf MakeHalf(const PieceMeasures& measures, const CellLattice& lattice,
  const BoundaryPiece& node, int apex, int along)
{
  const std::size_t ud = (apex ^ along) == 1 ? 0 : 1;
  const std::size_t vd = 1 - ud;
  const int p = lattice.Degree[ud];
  const int q = lattice.Degree[vd];
  PieceHalf half;
  half.Lattice = CellLattice(CellShape::Quadrilateral, { q, p + q, 0 });
  half.Piece.Piece.Data.resize(static_cast<std::size_t>(measures.NumPlanes() * half.Lattice.Size));
  double largest = 0.0;
  for (int plane = 0; plane < measures.NumPlanes(); ++plane)
  {
    const double* from = node.Piece.Data.data() + plane * lattice.Size;
    double* to = half.Piece.Piece.Data.data() + plane * half.Lattice.Size;
    const auto value = [&](int i, int j)
    {
      std::array<int, 2> at{};
      at[ud] = (apex >> ud & 1) == 0 ? i : p - i;
      at[vd] = (apex >> vd & 1) == 0 ? j : q - j;
      return from[CellCoefficient(lattice.Shape, lattice.Degree, at[0], at[1], 0)];
    };
    for (int n = 0; n <= p + q; ++n)
    {
      for (int a = 0; a <= q; ++a)
      {
        double sum = 0.0;
        for (int m = std::max(0, n - p); m <= std::min(n, q); ++m)
        {
          const double outer = Binomial(p, n - m) * Binomial(q, m) / Binomial(p + q, n);
          for (int j = std::max(0, a + m - q); j <= std::min(a, m); ++j)
          {
            const double inner = Binomial(m, j) * Binomial(q - m, a - j) / Binomial(q, a);
            sum += outer * inner * value(n - m, j);
          }
        }
        to[CellCoefficient(CellShape::Quadrilateral, half.Lattice.Degree, a, n, 0)] = sum;
      }
    }
    for (int i = 0; i < lattice.Size; ++i)
    {
      largest = std::max(largest, std::abs(from[i]));
    }
  }
  // a mean of at most (p + 1) (q + 1) values, its factors of six roundings each
  const double terms = (p + 1) * (q + 1) + 8;
  half.Piece.Piece.Error = 1.01 *
    (node.Piece.Error +
      terms * (UnitRoundoff * (largest + node.Piece.Error) + std::numeric_limits<double>::min()));
  measures.Complete(half.Lattice, half.Piece);
  return half;
}

bool HavePolarChart(const PieceMeasures& measures, const std::vector<PolarPiece>& pieces)
{
  const bool rational = measures.Input.Rational;
  const int components = measures.Input.NumComponents;
  struct Blown
  {
    int P = 0;             ///< degree along s
    int Q = 0;             ///< of R along t
    std::vector<Vector> R; ///< homogeneous, s fastest
    double Error = 0.0;
  };
  std::vector<Blown> blown;
  Vector alpha = Vector::Zero();
  Vector turn = Vector::Zero();
  for (std::size_t k = 0; k < pieces.size(); ++k)
  {
    const PolarPiece& piece = pieces[k];
    const CellLattice& lattice = *piece.Lattice;
    const double* data = piece.Piece->Piece.Data.data();
    const int n = lattice.Size;
    const int pole = lattice.Corners[static_cast<std::size_t>(piece.From)];
    const Vector apex = measures.PointOf(*piece.Piece, pole);
    // lattice steps along s and t
    const auto cornerIndex = [&](int corner, int d)
    { return ((corner >> d) & 1) * lattice.Degree[static_cast<std::size_t>(d)]; };
    const int sd = cornerIndex(piece.From, 0) != cornerIndex(piece.To, 0) ? 0 : 1;
    const int td = 1 - sd;
    Blown b;
    b.P = lattice.Degree[static_cast<std::size_t>(sd)];
    const int q = lattice.Degree[static_cast<std::size_t>(td)];
    b.Q = q - 1;
    double largest = 0.0;
    for (int j = 1; j <= q; ++j)
    {
      for (int i = 0; i <= b.P; ++i)
      {
        int at[2];
        at[sd] = cornerIndex(piece.From, sd) == 0 ? i : b.P - i;
        at[td] = cornerIndex(piece.From, td) == 0 ? j : q - j;
        const int c = CellCoefficient(lattice.Shape, lattice.Degree, at[0], at[1], 0);
        const double w = rational ? data[components * n + c] : 1.0;
        Vector x = Vector::Zero();
        for (int d = 0; d < components; ++d)
        {
          x[d] = (data[d * n + c] - apex[d] * w) * q / j;
          largest = std::max(largest, std::abs(data[d * n + c]) + std::abs(apex[d] * w));
        }
        b.R.push_back(x);
      }
    }
    // the collapsed edge is the point P up to the tolerance it was found with
    b.Error = q *
      (2.0 * piece.Piece->Piece.Error * (1.0 + piece.Piece->Largest) +
        2.0 * piece.Piece->Hull.Error + 8.0 * UnitRoundoff * largest);
    Vector mean = Vector::Zero();
    Vector slope = Vector::Zero();
    for (int j = 0; j <= b.Q; ++j)
    {
      for (int i = 0; i <= b.P; ++i)
      {
        mean += b.R[static_cast<std::size_t>(j * (b.P + 1) + i)];
      }
      slope += b.R[static_cast<std::size_t>(j * (b.P + 1) + b.P)] -
        b.R[static_cast<std::size_t>(j * (b.P + 1))];
    }
    alpha += mean / mean.norm();
    turn += (k == 0 ? 1.0 : -1.0) * slope / slope.norm();
    blown.push_back(std::move(b));
  }
  if (!alpha.allFinite() || !turn.allFinite() || !(alpha.norm() > 0.0))
  {
    return false;
  }
  alpha.normalize();
  const Vector beta0 = (turn - turn.dot(alpha) * alpha).normalized();
  if (!beta0.allFinite())
  {
    return false;
  }
  // the ratio at the middle is made zero
  Vector middle = Vector::Zero();
  for (const Blown& b : blown)
  {
    for (const Vector& x : b.R)
    {
      middle += x / static_cast<double>(b.R.size());
    }
  }
  const Vector beta = beta0 - beta0.dot(middle) / alpha.dot(middle) * alpha;

  double ss = std::numeric_limits<double>::infinity();
  double tt = ss;
  double st = 0.0;
  double ts = 0.0;
  for (std::size_t k = 0; k < pieces.size(); ++k)
  {
    const PolarPiece& piece = pieces[k];
    const Blown& b = blown[k];
    const CellLattice& lattice = *piece.Lattice;
    const double sign = k == 0 ? 1.0 : -1.0;
    const auto value = [&](const Vector& f, int i, int j)
    { return f.dot(b.R[static_cast<std::size_t>(j * (b.P + 1) + i)]); };
    const double ea = OneNorm(alpha) * b.Error;
    const double eb = OneNorm(beta) * b.Error;
    FunctionalRange ar;
    double largest = 0.0;
    for (int j = 0; j <= b.Q; ++j)
    {
      for (int i = 0; i <= b.P; ++i)
      {
        ar.Add(value(alpha, i, j));
        largest = std::max({ largest, std::abs(value(alpha, i, j)), std::abs(value(beta, i, j)) });
      }
    }
    ar.Widen(ea + 4.0 * UnitRoundoff * largest);
    if (!(ar.Low > 0.0))
    {
      return false;
    }
    // (b/a)' = (a b' - b a') / a^2: a convex combination of the products of all coefficients,
    // with the degrees as factors
    const double error = 8.0 * (largest + ea + eb) * (ea + eb + 8.0 * UnitRoundoff * largest);
    FunctionalRange crossS;
    FunctionalRange crossT;
    crossT.Add(0.0);
    const auto addProducts = [&](FunctionalRange& range, int i, int j, int di, int dj)
    {
      const double da = value(alpha, i + di, j + dj) - value(alpha, i, j);
      const double db = value(beta, i + di, j + dj) - value(beta, i, j);
      for (int l = 0; l <= b.Q; ++l)
      {
        for (int m = 0; m <= b.P; ++m)
        {
          range.Add(value(alpha, m, l) * db - value(beta, m, l) * da);
        }
      }
    };
    for (int j = 0; j <= b.Q; ++j)
    {
      for (int i = 0; i <= b.P; ++i)
      {
        if (i < b.P)
        {
          addProducts(crossS, i, j, 1, 0);
        }
        if (j < b.Q)
        {
          addProducts(crossT, i, j, 0, 1);
        }
      }
    }
    const double low = ((sign > 0.0 ? crossS.Low : -crossS.High) - error) * b.P;
    if (!(low > 0.0))
    {
      return false;
    }
    ss = std::min(ss, low / (ar.High * ar.High) * (1.0 - 1e-9));
    st = std::max(st, (crossT.Size() + error) * b.Q / (ar.Low * ar.Low) * (1.0 + 1e-9));
    // alpha (S - P) itself
    const int acrossS = piece.To;
    const int acrossT = 3 - acrossS; // of the edge's first corner, over to t = 1
    const PieceSlopes slopesS = measures.MakeSlopes(lattice, *piece.Piece, piece.From, piece.To);
    const PieceSlopes slopesT = measures.MakeSlopes(lattice, *piece.Piece, piece.From, acrossT);
    double lowWeight = 1.0;
    double highWeight = 1.0;
    if (rational)
    {
      const double* w = piece.Piece->Piece.Data.data() + components * lattice.Size;
      const auto [least, most] = std::minmax_element(w, w + lattice.Size);
      lowWeight = *least - piece.Piece->Piece.Error;
      highWeight = *most + piece.Piece->Piece.Error;
    }
    const FunctionalRange tRange = measures.RangeOf(alpha, slopesT);
    if (!(tRange.Low > 0.0) || !(lowWeight > 0.0))
    {
      return false;
    }
    tt = std::min(tt, tRange.Low * (b.Q + 1) / highWeight);
    ts = std::max(ts, measures.RangeOf(alpha, slopesS).Size() * b.P / lowWeight);
  }
  return ss * tt > st * ts * (1.0 + 1e-9);
}
}
