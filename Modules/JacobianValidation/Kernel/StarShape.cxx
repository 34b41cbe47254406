// SPDX-License-Identifier: BSD-3-Clause
#include "StarShape.h"
#include "Bernstein.h"
#include "BernsteinProducts.h"
#include "Parallel.h"
#include "PatchForm.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace knotwork
{
namespace
{
constexpr double unitRoundoff = 0x1p-53;
constexpr int maxPieces = 64;
constexpr int maxCornerSides = 4;

/// A piece of a side, seen from the point.
struct Piece
{
  PatchForm Form;
  int Depth = 0;
  bool HasPole = false; ///< a triangle's collapsed edge, s = 1
};

enum class Sign
{
  Positive,
  NotPositive,
  Unknown
};

/// Sign of det(x, x_s, x_t).
/// @param error  every coefficient is off by at most so many times its weight.
/// @param reach  no control point is farther from the point, by a coordinate.
Sign FindSign(const Piece& piece, double orientation, double error, double reach)
{
  const PatchForm& form = piece.Form;
  const int p = form.Degree[0];
  const int q = form.Degree[1];
  const int n = form.Size();
  const double largestWeight =
    *std::max_element(form.Data.begin() + 3 * n, form.Data.begin() + 4 * n);
  std::vector<ScaledPolynomial> x(3, ScaledPolynomial(p, q));
  std::vector<ScaledPolynomial> s(3, ScaledPolynomial(p - 1, q));
  std::vector<ScaledPolynomial> t(3, ScaledPolynomial(p, q - 1));
  double largestS = 0.0;
  double largestT = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
  {
    const double* data = form.Data.data() + static_cast<int>(c) * n;
    for (int j = 0; j <= q; ++j)
    {
      for (int i = 0; i <= p; ++i)
      {
        const double here = data[j * (p + 1) + i];
        x[c].Row(j)[i] = here * Binomial(p, i) * Binomial(q, j);
        if (i < p)
        {
          const double slope = data[j * (p + 1) + i + 1] - here;
          largestS = std::max(largestS, std::abs(slope));
          s[c].Row(j)[i] = slope * Binomial(p - 1, i) * Binomial(q, j);
        }
        if (j < q)
        {
          const double slope = data[(j + 1) * (p + 1) + i] - here;
          largestT = std::max(largestT, std::abs(slope));
          t[c].Row(j)[i] = slope * Binomial(p, i) * Binomial(q - 1, j);
        }
      }
    }
  }
  ScaledPolynomial det(3 * p - 1, 3 * q - 1);
  for (std::size_t c = 0; c < 3; ++c)
  {
    ScaledPolynomial normal(2 * p - 1, 2 * q - 1);
    AddProduct(normal, 1.0, s[(c + 1) % 3], t[(c + 2) % 3]);
    AddProduct(normal, -1.0, s[(c + 2) % 3], t[(c + 1) % 3]);
    AddProduct(det, orientation, x[c], normal);
  }
  // Each coefficient is six weighted means of products, of no more terms and roundings than these.
  const double largestX = largestWeight * reach;
  const double errorX = error * largestWeight;
  const double errorS = 2.0 * errorX + unitRoundoff * largestS;
  const double errorT = 2.0 * errorX + unitRoundoff * largestT;
  const double terms = 5.0 * (p + 1) * (q + 1) + 64.0;
  const double bound = 6.0 * 1.01 *
    (terms * unitRoundoff * largestX * largestS * largestT +
      (largestX + errorX) * (largestS + errorS) * (largestT + errorT) -
      largestX * largestS * largestT + 4.0 * unitRoundoff * largestX * largestS * largestT);
  bool positive = true;
  const int last = piece.HasPole ? det.P - 1 : det.P; // at the pole it is exactly zero
  for (int j = 0; j <= det.Q; ++j)
  {
    for (int i = 0; i <= last; ++i)
    {
      const double value = det.Row(j)[i] / (Binomial(det.P, i) * Binomial(det.Q, j));
      positive = positive && value > bound;
      const bool isCorner = (i == 0 || i == det.P) && (j == 0 || j == det.Q);
      if (isCorner && value <= 0.0)
      {
        return Sign::NotPositive;
      }
    }
  }
  return positive ? Sign::Positive : Sign::Unknown;
}

/// Whether the point sees all of a side from inside.
bool SeesSide(
  const BernsteinCells& sides, int side, double orientation, const std::array<double, 3>& point)
{
  const std::size_t at = static_cast<std::size_t>(side);
  std::vector<int> all(
    static_cast<std::size_t>(NumCellCoefficients(sides.Shapes[at], sides.Degrees[at])));
  std::iota(all.begin(), all.end(), 0);
  Piece whole;
  whole.Form = MakePatchForm(sides, side, sides.Shapes[at], sides.Degrees[at], all, point);
  whole.HasPole = sides.Shapes[at] == CellShape::Triangle;
  const int n = whole.Form.Size();
  const double* data = whole.Form.Data.data();
  double reach = 0.0;
  double leastWeight = data[3 * n];
  for (int i = 0; i < n; ++i)
  {
    leastWeight = std::min(leastWeight, data[3 * n + i]);
    for (int c = 0; c < 3; ++c)
    {
      reach = std::max(reach, std::abs(data[c * n + i]) / data[3 * n + i]);
    }
  }
  const double far = std::max({ std::abs(point[0]), std::abs(point[1]), std::abs(point[2]) });
  const double stored = sides.Errors.empty() ? 0.0 : sides.Errors[at];
  const double degrees = whole.Form.Degree[0] + whole.Form.Degree[1];
  if (!(leastWeight > stored))
  {
    return false;
  }
  // of x w - o w, and of a triangle's means
  double error = 1.01 *
    (stored * (1.0 + far) / leastWeight +
      (4.0 + 2.0 * degrees) * unitRoundoff * (reach + 2.0 * far));
  reach = reach * (1.0 + 1e-9) + error;
  std::vector<Piece> open;
  open.push_back(std::move(whole));
  for (int pieces = 1; !open.empty();)
  {
    Piece piece = std::move(open.back());
    open.pop_back();
    BalanceWeights(piece.Form);
    const double rounding = error + piece.Depth * degrees * unitRoundoff * reach;
    const Sign sign = FindSign(piece, orientation, rounding, reach);
    if (sign == Sign::Positive)
    {
      continue;
    }
    pieces += 2;
    if (sign == Sign::NotPositive || pieces > maxPieces)
    {
      return false;
    }
    const int direction = piece.Depth % 2;
    ++piece.Depth;
    Piece first = piece;
    first.Form = CutOffHalf(piece.Form, direction);
    first.HasPole = piece.HasPole && direction != 0;
    open.push_back(std::move(first));
    open.push_back(std::move(piece));
  }
  return true;
}

/// Whether each edge has two sides that run along it in opposite directions, and each corner few
/// sides: false a component where not.
std::vector<char> FindManifolds(
  const std::vector<BoundarySide>& boundary, int numComponents, const std::vector<int>& signs)
{
  std::vector<char> is(static_cast<std::size_t>(numComponents), true);
  std::map<int, int> corners;
  std::map<std::tuple<int, int, int>, int> edges; // id, from, to
  const auto ends = [&](const BoundarySide& side, int edge)
  {
    // around a side: 0 1 3 2, or 0 1 2
    const auto pair = SideEdge(side.Frame.Shape, edge);
    const int count = side.Frame.NumCorners;
    const auto place = [&](int corner) { return count == 4 ? corner ^ (corner >> 1) : corner; };
    const bool along = (place(pair[0]) + 1) % count == place(pair[1]);
    const bool forward = along == (signs[static_cast<std::size_t>(side.Cell)] > 0);
    const int a = side.Places[static_cast<std::size_t>(pair[forward ? 0 : 1])];
    const int b = side.Places[static_cast<std::size_t>(pair[forward ? 1 : 0])];
    return std::array<int, 2>{ a, b };
  };
  for (const BoundarySide& side : boundary)
  {
    for (int k = 0; k < side.Frame.NumCorners; ++k)
    {
      ++corners[side.Places[static_cast<std::size_t>(k)]];
    }
    for (int e = 0; e < NumSideEdges(side.Frame.Shape); ++e)
    {
      const auto [a, b] = ends(side, e);
      ++edges[{ side.Edges[static_cast<std::size_t>(e)], a, b }];
    }
  }
  for (const BoundarySide& side : boundary)
  {
    bool good = true;
    for (int k = 0; k < side.Frame.NumCorners; ++k)
    {
      good = good && corners[side.Places[static_cast<std::size_t>(k)]] <= maxCornerSides;
    }
    for (int e = 0; e < NumSideEdges(side.Frame.Shape) && good; ++e)
    {
      const auto [a, b] = ends(side, e);
      const int id = side.Edges[static_cast<std::size_t>(e)];
      const auto back = edges.find({ id, b, a });
      good = a != b && edges[{ id, a, b }] == 1 && back != edges.end() && back->second == 1;
    }
    if (!good)
    {
      is[static_cast<std::size_t>(side.Component)] = false;
    }
  }
  return is;
}
}

std::vector<char> FindStarShaped(const std::vector<BoundarySide>& boundary, int numComponents,
  const BernsteinCells& sides, const std::vector<int>& signs, int threads)
{
  if (sides.NumComponents != 3)
  {
    return std::vector<char>(static_cast<std::size_t>(numComponents), false);
  }
  std::vector<char> is = FindManifolds(boundary, numComponents, signs);
  std::vector<std::array<double, 3>> means(is.size());
  std::vector<double> counts(is.size(), 0.0);
  for (std::size_t i = 0; i < boundary.size(); ++i)
  {
    const std::size_t component = static_cast<std::size_t>(boundary[i].Component);
    const int n = NumCellCoefficients(sides.Shapes[i], sides.Degrees[i]);
    const double* data = sides.Block(static_cast<int>(i));
    for (int k = 0; k < n; ++k)
    {
      counts[component] += 1.0;
      for (int c = 0; c < 3; ++c)
      {
        const double w = sides.Rational ? data[3 * n + k] : 1.0;
        double& mean = means[component][static_cast<std::size_t>(c)];
        mean += (data[c * n + k] / w - mean) / counts[component];
      }
    }
  }
  std::vector<std::vector<int>> members(is.size());
  for (std::size_t i = 0; i < boundary.size(); ++i)
  {
    members[static_cast<std::size_t>(boundary[i].Component)].push_back(static_cast<int>(i));
  }
  ParallelFor(is.size(), 4, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t c = begin; c < end; ++c)
      {
        if (!is[c])
        {
          continue;
        }
        is[c] = std::all_of(members[c].begin(), members[c].end(),
          [&](int i)
          {
            const int cell = boundary[static_cast<std::size_t>(i)].Cell;
            return SeesSide(sides, i, signs[static_cast<std::size_t>(cell)], means[c]);
          });
      }
    });
  return is;
}
}
