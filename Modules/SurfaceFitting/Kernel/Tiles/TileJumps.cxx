// SPDX-License-Identifier: BSD-3-Clause
#include "TileJumps.h"

#include <knotwork/SplineCore/Bernstein.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr int MaxHalvings = 20;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Coefficients of a vector-valued polynomial, one row each.
using Rows = PointMatrix;

/// A side of a tile on one element: the curve and the derivative across it, inwards.
struct Piece
{
  double Low = 0.0; ///< along the first tile's side
  double High = 0.0;
  Rows Value;
  Rows Slope;
};

Rows Restricted(const Rows& rows, double low, double high)
{
  const int p = static_cast<int>(rows.rows()) - 1;
  std::vector<double> matrix(At((p + 1) * (p + 1)));
  BernsteinRestriction(p, low, high, matrix.data());
  return Eigen::Map<const PointMatrix>(matrix.data(), p + 1, p + 1).transpose() * rows;
}

std::vector<Piece> Pieces(
  const BezierForm<2>& form, const TileEdge& edge, std::size_t i, int components)
{
  const int side = edge.Sides[i].Side;
  const std::size_t across = AcrossSide(side);
  const std::size_t along = AlongSide(side);
  const bool isUpper = side % 2 == 1;
  const double value = SideValue(form.Space->Domain(), side);
  std::vector<Piece> pieces;
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    const auto& element = form.Space->Elements[At(e)];
    const ParametricBox<2>& box = element.Box;
    const double low = std::max(box.Lower[along], edge.Low(i));
    const double high = std::min(box.Upper[along], edge.High(i));
    if ((isUpper ? box.Upper : box.Lower)[across] != value || !(low < high))
    {
      continue;
    }
    const int p = element.Degree[across];
    const int q = element.Degree[along];
    const auto n = At(NumTensorFunctions<2>(element.Degree));
    const int step = across == 0 ? 1 : element.Degree[0] + 1;
    const int stride = across == 0 ? element.Degree[0] + 1 : 1;
    const int first = isUpper ? p * step : 0;
    const int second = isUpper ? (p - 1) * step : step;
    const double factor = p / (box.Upper[across] - box.Lower[across]);
    Piece piece;
    piece.Value.resize(q + 1, components);
    piece.Slope.resize(q + 1, components);
    for (int c = 0; c < components; ++c)
    {
      const double* block = form.Block(e) + At(c) * n;
      for (int k = 0; k <= q; ++k)
      {
        piece.Value(k, c) = block[first + k * stride];
        piece.Slope(k, c) = factor * (block[second + k * stride] - block[first + k * stride]);
      }
    }
    const double length = box.Upper[along] - box.Lower[along];
    const double a = (low - box.Lower[along]) / length;
    const double b = (high - box.Lower[along]) / length;
    piece.Value = Restricted(piece.Value, a, b);
    piece.Slope = Restricted(piece.Slope, a, b);
    piece.Low = i == 0 ? low : edge.Map(1, low);
    piece.High = i == 0 ? high : edge.Map(1, high);
    if (i == 1)
    {
      piece.Slope *= edge.Ratio();
      if (edge.IsReversed())
      {
        std::swap(piece.Low, piece.High);
        piece.Value = piece.Value.colwise().reverse().eval();
        piece.Slope = piece.Slope.colwise().reverse().eval();
      }
    }
    pieces.push_back(std::move(piece));
  }
  std::sort(
    pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.Low < b.Low; });
  return pieces;
}

/// Raises `bound` to an upper bound of the length of a polynomial; `reached` is a length that is
/// reached somewhere.
void Bound(const Rows& rows, int halvings, double& reached, double& bound)
{
  reached = std::max({ reached, rows.row(0).norm(), rows.row(rows.rows() - 1).norm() });
  const double upper = rows.rowwise().norm().maxCoeff(); // convex hull
  if (halvings == 0 || upper <= std::max(bound, 1.001 * reached) ||
    upper <= std::numeric_limits<double>::min())
  {
    bound = std::max(bound, upper);
    return;
  }
  Bound(Restricted(rows, 0.0, 0.5), halvings - 1, reached, bound);
  Bound(Restricted(rows, 0.5, 1.0), halvings - 1, reached, bound);
}

/// What the rounding of the coefficients can add: they are sums over the functions alive,
/// restricted.
double Rounding(const Rows& a, const Rows& b)
{
  const double size = a.rowwise().norm().maxCoeff() + b.rowwise().norm().maxCoeff();
  return 16.0 * static_cast<double>(a.rows()) * std::numeric_limits<double>::epsilon() * size;
}
}

EdgeJump MeasureJump(const std::vector<BezierForm<2>>& forms, const TileEdge& edge, int components)
{
  const std::array<std::vector<Piece>, 2> pieces{ Pieces(forms[At(edge.Sides[0].Patch)], edge, 0,
                                                    components),
    Pieces(forms[At(edge.Sides[1].Patch)], edge, 1, components) };
  EdgeJump reached;
  EdgeJump bound;
  EdgeJump rounding;
  std::size_t j = 0;
  for (const Piece& a : pieces[0])
  {
    while (j > 0 && pieces[1][j].Low > a.Low)
    {
      --j;
    }
    for (; j < pieces[1].size(); ++j)
    {
      const Piece& b = pieces[1][j];
      const double low = std::max(a.Low, b.Low);
      const double high = std::min(a.High, b.High);
      if (high - low > SameKnot * (edge.High(0) - edge.Low(0)))
      {
        const auto on = [low, high](const Piece& piece, const Rows& rows)
        {
          const double length = piece.High - piece.Low;
          return Restricted(rows, (low - piece.Low) / length, (high - piece.Low) / length);
        };
        const Rows valueA = on(a, a.Value);
        const Rows valueB = on(b, b.Value);
        const Rows slopeA = on(a, a.Slope);
        const Rows slopeB = on(b, b.Slope);
        Bound(valueA - valueB, MaxHalvings, reached.Value, bound.Value);
        Bound(slopeA + slopeB, MaxHalvings, reached.Slope, bound.Slope); // both point inwards
        rounding.Value = std::max(rounding.Value, Rounding(valueA, valueB));
        // differences of coefficients, over the spans
        rounding.Slope = std::max(rounding.Slope, Rounding(slopeA, slopeB));
      }
      if (b.High >= a.High)
      {
        break;
      }
    }
  }
  bound.Value += rounding.Value;
  bound.Slope += rounding.Slope;
  return bound;
}
}
