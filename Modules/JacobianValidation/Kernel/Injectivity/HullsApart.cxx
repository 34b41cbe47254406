// SPDX-License-Identifier: BSD-3-Clause
#include "HullsApart.h"

#include <Eigen/Geometry>
#include <Eigen/QR>

namespace knotwork
{
namespace
{
using Vector = Eigen::Vector3d;

/// The point of the hull of at most four points that is nearest to the origin; keeps only the
/// points it is a combination of.
Vector NearestInSimplex(std::vector<Vector>& simplex)
{
  const std::size_t n = simplex.size();
  std::vector<Vector> best;
  Vector nearest = Vector::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (unsigned subset = 1; subset < (1u << n); ++subset)
  {
    std::vector<Vector> chosen;
    for (std::size_t i = 0; i < n; ++i)
    {
      if (subset & (1u << i))
      {
        chosen.push_back(simplex[i]);
      }
    }
    const int m = static_cast<int>(chosen.size());
    // p0 + E t, t >= 0, sum t <= 1
    Vector point = chosen[0];
    bool inside = true;
    if (m > 1)
    {
      Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> edges(3, m - 1);
      for (int i = 1; i < m; ++i)
      {
        edges.col(i - 1) = chosen[static_cast<std::size_t>(i)] - chosen[0];
      }
      const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> t =
        edges.colPivHouseholderQr().solve(-chosen[0]);
      inside = t.allFinite() && t.minCoeff() >= 0.0 && t.sum() <= 1.0;
      point += edges * t;
    }
    if (inside && point.squaredNorm() < least)
    {
      least = point.squaredNorm();
      nearest = point;
      best = std::move(chosen);
    }
  }
  simplex = std::move(best);
  return nearest;
}

/// A direction in which all of a convex hull lies, if it does not hold the origin: the nearest
/// point of simplices that grow towards the origin. What it finds is checked by the callers.
/// @source  Gilbert, Johnson, Keerthi, IEEE J. Robotics and Automation 4 (1988) 193-203.
template <typename Support>
bool FindDirection(const Vector& start, Support&& support, Vector& direction)
{
  Vector v = start;
  std::vector<Vector> simplex;
  for (int step = 0; step < 24; ++step)
  {
    const Vector w = support(v);
    if (v.dot(w) > 0.0)
    {
      direction = v;
      // a few more steps widen the margin
      if (step > 3 || v.dot(w) > 0.5 * v.squaredNorm())
      {
        return true;
      }
    }
    if (simplex.size() == 4 || std::find(simplex.begin(), simplex.end(), w) != simplex.end())
    {
      return v.dot(w) > 0.0;
    }
    simplex.push_back(w);
    v = NearestInSimplex(simplex);
    if (simplex.empty() || !(v.squaredNorm() > 0.0))
    {
      return false;
    }
  }
  return false;
}
}

bool HullsApart(const PieceMeasures& measures, const PieceCone& first, const PieceCone& second)
{
  const BoundaryPiece& a = *first.Piece;
  const BoundaryPiece& b = *second.Piece;
  const int na = first.Lattice->Size;
  const int nb = second.Lattice->Size;
  const double largest = std::max(a.Largest, b.Largest);
  const auto apart = [&](const Vector& d)
  {
    double high = -std::numeric_limits<double>::infinity();
    double low = std::numeric_limits<double>::infinity();
    for (int i = 0; i < na; ++i)
    {
      high = std::max(high, d.dot(measures.PointOf(a, i)));
    }
    for (int i = 0; i < nb; ++i)
    {
      low = std::min(low, d.dot(measures.PointOf(b, i)));
    }
    const double margin = OneNorm(d) * (a.Hull.Error + b.Hull.Error + 8.0 * UnitRoundoff * largest);
    return low - high > margin * (1.0 + 1e-9);
  };
  // across flat pieces first, then whatever the search finds
  for (const BoundaryPiece* node : { &a, &b })
  {
    const CellLattice& lattice = *(node == &a ? first : second).Lattice;
    const auto corner = [&](std::size_t c) { return measures.PointOf(*node, lattice.Corners[c]); };
    const Vector x = corner(1) - corner(0);
    const Vector normal = lattice.Corners.size() == 2 ? Vector(-x[1], x[0], 0.0)
      : lattice.Corners.size() == 3                   ? Vector(x.cross(corner(2) - corner(0)))
                                    : Vector((corner(3) - corner(0)).cross(corner(2) - corner(1)));
    if (apart(normal) || apart(-normal))
    {
      return true;
    }
  }
  Vector start = Vector::Zero();
  for (std::size_t d = 0; d < static_cast<std::size_t>(measures.Input.NumComponents); ++d)
  {
    start[static_cast<Eigen::Index>(d)] =
      0.5 * (b.Hull.Lower[d] + b.Hull.Upper[d] - a.Hull.Lower[d] - a.Hull.Upper[d]);
  }
  Vector direction = Vector::Zero();
  const bool found = FindDirection(
    start,
    [&](const Vector& v)
    {
      Vector best[2];
      double low[2] = { std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::infinity() };
      for (int k = 0; k < 2; ++k)
      {
        const BoundaryPiece& node = k == 0 ? a : b;
        for (int i = 0; i < (k == 0 ? na : nb); ++i)
        {
          const Vector x = measures.PointOf(node, i);
          const double at = k == 0 ? -v.dot(x) : v.dot(x);
          if (at < low[k])
          {
            low[k] = at;
            best[k] = x;
          }
        }
      }
      return Vector(best[1] - best[0]);
    },
    direction);
  return found && apart(direction);
}

bool ConesApart(const PieceMeasures& measures, const std::array<PieceCone, 2>& cones)
{
  const BoundaryPiece& a = *cones[0].Piece;
  const BoundaryPiece& b = *cones[1].Piece;
  const double largest = std::max(a.Largest, b.Largest);
  const double error = 2.0 * std::max(a.Hull.Error, b.Hull.Error) + 4.0 * UnitRoundoff * largest;
  std::vector<Vector> vectors;
  for (std::size_t k = 0; k < 2; ++k)
  {
    const BoundaryPiece& node = *cones[k].Piece;
    const CellLattice& lattice = *cones[k].Lattice;
    const int at = lattice.Corners[static_cast<std::size_t>(cones[k].Corner)];
    const Vector corner = measures.PointOf(node, at);
    for (int i = 0; i < lattice.Size; ++i)
    {
      const Vector x = measures.PointOf(node, i) - corner;
      // points of a collapsed edge are the corner itself
      const bool collapsed = i == at ||
        (measures.Input.CollapseTolerance > 0.0 &&
          x.cwiseAbs().maxCoeff() <=
            std::min(node.Size * 1e-6, measures.CollapseDistance(largest)));
      if (!collapsed)
      {
        vectors.push_back(k == 0 ? Vector(-x) : x);
      }
    }
  }
  if (vectors.empty())
  {
    return false;
  }
  Vector start = Vector::Zero();
  std::vector<Vector> units;
  for (const Vector& x : vectors)
  {
    const double length = x.norm();
    if (!(length > 0.0))
    {
      return false;
    }
    units.push_back(x / length);
    start += units.back() / static_cast<double>(vectors.size());
  }
  Vector direction = Vector::Zero();
  const bool found = FindDirection(
    start,
    [&](const Vector& v)
    {
      const Vector* best = nullptr;
      double low = std::numeric_limits<double>::infinity();
      for (const Vector& x : units)
      {
        const double at = v.dot(x);
        if (at < low)
        {
          low = at;
          best = &x;
        }
      }
      return *best;
    },
    direction);
  if (!found)
  {
    return false;
  }
  const double margin = OneNorm(direction) * error * (1.0 + 1e-9);
  return std::all_of(
    vectors.begin(), vectors.end(), [&](const Vector& x) { return direction.dot(x) > margin; });
}
}
