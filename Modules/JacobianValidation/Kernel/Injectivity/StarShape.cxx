// SPDX-License-Identifier: BSD-3-Clause
#include "StarShape.h"
#include "BernsteinProducts.h"
#include "PatchForm.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace knotwork
{
namespace
{
constexpr double UnitRoundoff = 0x1p-53;
constexpr int MaxPieces = 64;
constexpr int MaxCornerSides = 4;
/// A better point than the mean of the control points is looked for where few sides are in it, by
/// tangent planes of pieces of this depth and of those that the last point did not see.
constexpr std::size_t MaxSearchedSides = 64;
constexpr int FirstDepth = 4;
constexpr int MaxSearches = 8;

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
  const double errorS = 2.0 * errorX + UnitRoundoff * largestS;
  const double errorT = 2.0 * errorX + UnitRoundoff * largestT;
  const double terms = 5.0 * (p + 1) * (q + 1) + 64.0;
  const double bound = 6.0 * 1.01 *
    (terms * UnitRoundoff * largestX * largestS * largestT +
      (largestX + errorX) * (largestS + errorS) * (largestT + errorT) -
      largestX * largestS * largestT + 4.0 * UnitRoundoff * largestX * largestS * largestT);
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

/// Points y with Normal (y - o) < Offset are inside of a tangent plane, as o then is.
struct TangentPlane
{
  Eigen::Vector3d Normal; ///< of length one
  double Offset = 0.0;
};

/// The tangent planes at the corners of a piece. Rounding is of no importance: what is found with
/// them is proved.
void AddTangentPlanes(const Piece& piece, double orientation, std::vector<TangentPlane>& planes)
{
  const PatchForm& form = piece.Form;
  const int p = form.Degree[0];
  const int q = form.Degree[1];
  const int n = form.Size();
  const auto point = [&](int i, int j)
  {
    const double* data = form.Data.data() + j * (p + 1) + i;
    return Eigen::Vector3d(Eigen::Vector3d(data[0], data[n], data[2 * n]) / data[3 * n]);
  };
  for (int j = 0; j <= q; j += q)
  {
    for (int i = 0; i <= (piece.HasPole ? 0 : p); i += p)
    {
      const Eigen::Vector3d x = point(i, j);
      const Eigen::Vector3d s = i == 0 ? (point(1, j) - x).eval() : (x - point(p - 1, j)).eval();
      const Eigen::Vector3d t = j == 0 ? (point(i, 1) - x).eval() : (x - point(i, q - 1)).eval();
      const Eigen::Vector3d normal = orientation * s.cross(t);
      const double length = normal.norm();
      if (length > 0.0 && std::isfinite(length))
      {
        planes.push_back({ normal / length, normal.dot(x) / length });
      }
    }
  }
}

/// The point that is deepest inside of all planes, as far as it is in doubt: the largest least
/// distance r, by Newton steps on its barrier t r + sum log(distance - r).
/// @return false when no point is inside of all.
bool FindDeepest(const std::vector<TangentPlane>& planes, Eigen::Vector3d& best)
{
  Eigen::Vector4d x = Eigen::Vector4d::Zero(); // the point and r
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const TangentPlane& plane : planes)
  {
    least = std::min(least, plane.Offset);
    most = std::max(most, std::abs(plane.Offset));
  }
  if (!(most > 0.0) || !std::isfinite(most))
  {
    return false;
  }
  x[3] = least - most;
  const double count = static_cast<double>(planes.size());
  for (double weight = 1.0; weight <= 1e3; weight *= 10.0)
  {
    for (int step = 0; step < 12; ++step)
    {
      Eigen::Vector4d gradient(0.0, 0.0, 0.0, weight * count / most);
      Eigen::Matrix4d curvature = Eigen::Matrix4d::Zero();
      for (const TangentPlane& plane : planes)
      {
        Eigen::Vector4d a;
        a << plane.Normal, 1.0;
        a /= plane.Offset - a.dot(x);
        gradient -= a;
        curvature += a * a.transpose();
      }
      const Eigen::Vector4d change = curvature.ldlt().solve(gradient);
      const double decrease = gradient.dot(change);
      if (!change.allFinite() || !(decrease > 1e-3))
      {
        break;
      }
      // as far as the planes allow, and as the barrier rises
      double reach = 1.0;
      for (const TangentPlane& plane : planes)
      {
        const double toward = plane.Normal.dot(change.head<3>()) + change[3];
        const double room = plane.Offset - plane.Normal.dot(x.head<3>()) - x[3];
        reach = reach * toward > 0.9 * room ? 0.9 * room / toward : reach;
      }
      const auto rise = [&](double length)
      {
        double sum = length * weight * count / most * change[3];
        for (const TangentPlane& plane : planes)
        {
          const double toward = plane.Normal.dot(change.head<3>()) + change[3];
          const double room = plane.Offset - plane.Normal.dot(x.head<3>()) - x[3];
          sum += std::log1p(-length * toward / room);
        }
        return sum;
      };
      while (reach > 1e-6 && !(rise(reach) > 0.0))
      {
        reach *= 0.5;
      }
      x += reach * change;
    }
  }
  best = x.head<3>();
  return x[3] > 0.0 && best.allFinite();
}

Piece WholeSide(const BernsteinCells& sides, int side, const std::array<double, 3>& point)
{
  const std::size_t at = static_cast<std::size_t>(side);
  std::vector<int> all(
    static_cast<std::size_t>(NumCellCoefficients(sides.Shapes[at], sides.Degrees[at])));
  std::iota(all.begin(), all.end(), 0);
  Piece whole;
  whole.Form = MakePatchForm(sides, side, sides.Shapes[at], sides.Degrees[at], all, point);
  whole.HasPole = sides.Shapes[at] == CellShape::Triangle;
  return whole;
}

/// Halves a piece, which keeps the second one.
Piece CutOff(Piece& piece)
{
  const int direction = piece.Depth % 2;
  ++piece.Depth;
  Piece first;
  first.Depth = piece.Depth;
  first.HasPole = piece.HasPole && direction != 0;
  first.Form = CutOffHalf(piece.Form, direction);
  return first;
}

/// Whether the point sees all of a side from inside.
/// @param planes  not null: tangent planes of what it does not see are added, relative to it.
bool SeesSide(const BernsteinCells& sides, int side, double orientation,
  const std::array<double, 3>& point, std::vector<TangentPlane>* planes)
{
  const std::size_t at = static_cast<std::size_t>(side);
  Piece whole = WholeSide(sides, side, point);
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
      (4.0 + 2.0 * degrees) * UnitRoundoff * (reach + 2.0 * far));
  reach = reach * (1.0 + 1e-9) + error;
  std::vector<Piece> open;
  open.push_back(std::move(whole));
  for (int pieces = 1; !open.empty();)
  {
    Piece piece = std::move(open.back());
    open.pop_back();
    BalanceWeights(piece.Form);
    const double rounding = error + piece.Depth * degrees * UnitRoundoff * reach;
    const Sign sign = FindSign(piece, orientation, rounding, reach);
    if (sign == Sign::Positive)
    {
      continue;
    }
    pieces += 2;
    if (sign == Sign::NotPositive || pieces > MaxPieces)
    {
      if (planes)
      {
        AddTangentPlanes(piece, orientation, *planes);
      }
      return false;
    }
    open.push_back(CutOff(piece));
    open.push_back(std::move(piece));
  }
  return true;
}

/// Whether the point, or another one, sees all of the given sides from inside.
bool AreSeen(const BernsteinCells& sides, const std::vector<int>& members,
  const std::vector<double>& orientations, const std::array<double, 3>& mean)
{
  const auto seesAll = [&](const std::array<double, 3>& point, std::vector<TangentPlane>* planes)
  {
    bool all = true;
    for (std::size_t i = 0; i < members.size() && (all || planes); ++i)
    {
      all = SeesSide(sides, members[i], orientations[i], point, planes) && all;
    }
    return all;
  };
  if (seesAll(mean, nullptr))
  {
    return true;
  }
  if (members.size() > MaxSearchedSides)
  {
    return false;
  }
  std::vector<TangentPlane> planes; // relative to the mean
  for (std::size_t i = 0; i < members.size(); ++i)
  {
    std::vector<Piece> open;
    open.push_back(WholeSide(sides, members[i], mean));
    while (!open.empty())
    {
      Piece piece = std::move(open.back());
      open.pop_back();
      BalanceWeights(piece.Form);
      if (piece.Depth == FirstDepth)
      {
        AddTangentPlanes(piece, orientations[i], planes);
        continue;
      }
      open.push_back(CutOff(piece));
      open.push_back(std::move(piece));
    }
  }
  for (int search = 0; search < MaxSearches; ++search)
  {
    Eigen::Vector3d shift;
    if (!FindDeepest(planes, shift))
    {
      return false;
    }
    const std::array<double, 3> point{ mean[0] + shift[0], mean[1] + shift[1], mean[2] + shift[2] };
    const std::size_t known = planes.size();
    if (seesAll(point, &planes))
    {
      return true;
    }
    for (std::size_t i = known; i < planes.size(); ++i)
    {
      planes[i].Offset += planes[i].Normal.dot(shift);
    }
  }
  return false;
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
      good = good && corners[side.Places[static_cast<std::size_t>(k)]] <= MaxCornerSides;
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
        std::vector<double> orientations;
        for (const int i : members[c])
        {
          const int cell = boundary[static_cast<std::size_t>(i)].Cell;
          orientations.push_back(signs[static_cast<std::size_t>(cell)]);
        }
        is[c] = AreSeen(sides, members[c], orientations, means[c]);
      }
    });
  return is;
}
}
