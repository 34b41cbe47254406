// SPDX-License-Identifier: BSD-3-Clause
#include "PlaneJacobian.h"

#include "BernsteinProducts.h"
#include <knotwork/SplineCore/Bernstein.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double UnitRoundoff = 0x1p-53;

/// A polynomial with a bound of every coefficient's size, the error included, which is zero only
/// where the coefficient is exactly zero.
struct Bounded
{
  ScaledPolynomial Value;
  ScaledPolynomial Size;  ///< of the value
  ScaledPolynomial Reach; ///< of the value and its error
  Bounded(int p, int q) : Value(p, q), Size(p, q), Reach(p, q) {}
  void Set(int i, int j, double value, double error, double scale)
  {
    this->Value.Row(j)[i] = value * scale;
    this->Size.Row(j)[i] = std::abs(value) * scale;
    this->Reach.Row(j)[i] = (std::abs(value) + error) * scale;
  }
};

/// to += sign a b.
void AddProduct(Bounded& to, double sign, const Bounded& a, const Bounded& b)
{
  AddProduct(to.Value, sign, a.Value, b.Value);
  AddProduct(to.Size, 1.0, a.Size, b.Size);
  AddProduct(to.Reach, 1.0, a.Reach, b.Reach);
}

class PieceJacobian
{
public:
  explicit PieceJacobian(const PlanePiece& piece)
    : Piece(piece), Triangle(piece.Shape == CellShape::Triangle), P(piece.Degree[0]),
      Q(Triangle ? piece.Degree[0] : piece.Degree[1])
  {
  }
  bool InLattice(int i, int j, int less) const
  {
    return !this->Triangle || i + j <= this->P - less;
  }
  double Scale(int i, int j, int p, int q) const
  {
    return this->Triangle ? Binomial(p, i) * Binomial(p - i, j) : Binomial(p, i) * Binomial(q, j);
  }
  Bounded Values(const std::vector<double>& x, double error) const
  {
    Bounded f(this->P, this->Q);
    this->ForEach(0, 0,
      [&](int i, int j)
      { f.Set(i, j, x[this->At(i, j)], error, this->Scale(i, j, this->P, this->Q)); });
    return f;
  }
  /// Differences along s (0) or t (1): derivatives over the degree.
  Bounded Slopes(const std::vector<double>& x, double error, int direction) const
  {
    const int ds = direction == 0 ? 1 : 0;
    const int dt = 1 - ds;
    // a triangle's derivatives are of a degree less in both
    const int p = this->Triangle ? this->P - 1 : this->P - ds;
    const int q = this->Triangle ? this->P - 1 : this->Q - dt;
    const std::vector<char>& same = direction == 0 ? this->Piece.SameNextS : this->Piece.SameNextT;
    Bounded f(p, q);
    this->ForEach(ds, dt,
      [&](int i, int j)
      {
        const std::size_t at = this->At(i, j);
        if (same.empty() || !same[at])
        {
          const double value = x[this->At(i + ds, j + dt)] - x[at];
          f.Set(i, j, value, 2.0 * error + UnitRoundoff * std::abs(value), this->Scale(i, j, p, q));
        }
      });
    return f;
  }

  const PlanePiece& Piece;
  bool Triangle;
  int P;
  int Q;

private:
  std::size_t At(int i, int j) const
  {
    return static_cast<std::size_t>(
      CellCoefficient(this->Piece.Shape, this->Piece.Degree, i, j, 0));
  }
  template <typename Function>
  void ForEach(int ds, int dt, const Function& function) const
  {
    for (int j = 0; j <= this->Q - dt; ++j)
    {
      for (int i = 0; i <= this->P - ds; ++i)
      {
        if (this->InLattice(i, j, ds + dt))
        {
          function(i, j);
        }
      }
    }
  }
};
}

bool HasPositiveInside(const PlanePiece& piece, double orientation)
{
  const PieceJacobian build(piece);
  const bool rational = !piece.W.empty();
  const std::vector<double>* planes[3] = { &piece.X, &piece.Y, &piece.W };
  const double errors[3] = { piece.Error, piece.Error, piece.WeightError };
  std::vector<Bounded> s;
  std::vector<Bounded> t;
  for (int c = 0; c < (rational ? 3 : 2); ++c)
  {
    s.push_back(build.Slopes(*planes[c], errors[c], 0));
    t.push_back(build.Slopes(*planes[c], errors[c], 1));
  }
  const int p = s[0].Value.P + t[0].Value.P;
  const int q = s[0].Value.Q + t[0].Value.Q;
  const auto cross = [&](std::size_t a, std::size_t b)
  {
    Bounded f(p, q);
    AddProduct(f, orientation, s[a], t[b]);
    AddProduct(f, -orientation, s[b], t[a]);
    return f;
  };
  // rational: det(X, X_s, X_t) of X = (w x, w y, w), which is W^3 times the Jacobian
  Bounded jacobian(rational ? p + build.P : p, rational ? q + build.Q : q);
  if (rational)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      AddProduct(
        jacobian, 1.0, build.Values(*planes[c], errors[c]), cross((c + 1) % 3, (c + 2) % 3));
    }
  }
  else
  {
    jacobian = cross(0, 1);
  }
  // What is proved: a sum of products, each off by at most Reach - Size in all, of no more
  // roundings than there are terms, factors and binomials.
  const double terms = 6.0 * (build.P + 1) * (build.Q + 1) + 64.0;
  bool some = false;
  for (int j = 0; j <= jacobian.Value.Q; ++j)
  {
    for (int i = 0; i <= jacobian.Value.P; ++i)
    {
      const double value = jacobian.Value.Row(j)[i];
      const double size = jacobian.Size.Row(j)[i];
      const double reach = jacobian.Reach.Row(j)[i];
      if (reach == 0.0) // zero exactly, or no coefficient of a triangle
      {
        continue;
      }
      const double bound = (reach - size + 4.0 * terms * UnitRoundoff * reach) * (1.0 + 1e-9);
      if (!(value > bound))
      {
        return false;
      }
      some = true;
    }
  }
  return some;
}
}
