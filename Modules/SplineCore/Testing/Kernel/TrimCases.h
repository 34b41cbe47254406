// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SplineOracle.h"
#include <knotwork/SplineCore/TrimmedModel.h>

#include <cmath>
#include <functional>

/// Loops and surfaces whose shape is known.
namespace knotwork::testing
{
using Polygon = std::vector<RealArray<2>>;

/// A curve of a loop from its pcurve; the curve in space is (u, v, 0).
inline TrimmingCurve MakeTrimmingCurve(
  const KnotVector& knots, const Polygon& points, const std::vector<double>& weights = {})
{
  TrimmingCurve curve;
  curve.Curve.Space = MakeTensorSpace<1>({ knots }).Value;
  const auto n = static_cast<Eigen::Index>(points.size());
  curve.UV.resize(n, 2);
  curve.Curve.ControlPoints = PointMatrix::Zero(n, 3);
  curve.Curve.Weights.resize(static_cast<Eigen::Index>(weights.size()));
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const std::size_t k = static_cast<std::size_t>(i);
    curve.UV.row(i) << points[k][0], points[k][1];
    curve.Curve.ControlPoints.row(i).head<2>() = curve.UV.row(i);
    if (!weights.empty())
    {
      curve.Curve.Weights[i] = weights[k];
    }
  }
  return curve;
}

/// A closed polygon as one curve of degree 1.
inline TrimmedLoop PolygonLoop(Polygon corners)
{
  corners.push_back(corners.front());
  const int n = static_cast<int>(corners.size()) - 1;
  return { { MakeTrimmingCurve(KnotVector::Uniform(1, n), corners) } };
}

inline TrimmedLoop RectangleLoop(double u0, double u1, double v0, double v1)
{
  return PolygonLoop({ { u0, v0 }, { u1, v0 }, { u1, v1 }, { u0, v1 } });
}

/// The exact circle: four rational arcs of degree 2.
inline TrimmedLoop CircleLoop(double u, double v, double radius, bool counterclockwise = true)
{
  const double x[] = { 1, 1, 0, -1, -1, -1, 0, 1, 1 };
  const double y[] = { 0, 1, 1, 1, 0, -1, -1, -1, 0 };
  Polygon points;
  std::vector<double> weights;
  for (int i = 0; i < 9; ++i)
  {
    points.push_back({ u + radius * x[i], v + (counterclockwise ? radius : -radius) * y[i] });
    weights.push_back(i % 2 == 0 ? 1.0 : std::sqrt(0.5));
  }
  return { { MakeTrimmingCurve(KnotVector::Uniform(2, 4, 0.0, 1.0, 2), points, weights) } };
}

/// Corners of a star-shaped polygon around a point, counterclockwise, radii in [least, most].
inline Polygon StarPolygon(
  oracle::Random& random, int corners, double u, double v, double least, double most)
{
  Polygon points;
  for (int k = 0; k < corners; ++k)
  {
    const double angle = 2.0 * M_PI * (k + random.In(0.0, 0.9)) / corners;
    const double radius = random.In(least, most);
    points.push_back({ u + radius * std::cos(angle), v + radius * std::sin(angle) });
  }
  return points;
}

/// Crossings of a ray with a polygon: the textbook's test.
inline bool IsInside(const Polygon& polygon, const RealArray<2>& point)
{
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const RealArray<2>& a = polygon[i];
    const RealArray<2>& b = polygon[(i + 1) % polygon.size()];
    if ((a[1] > point[1]) != (b[1] > point[1]) &&
      point[0] < a[0] + (b[0] - a[0]) * (point[1] - a[1]) / (b[1] - a[1]))
    {
      inside = !inside;
    }
  }
  return inside;
}

inline double DistanceTo(const Polygon& polygon, const RealArray<2>& point)
{
  double least = 1e300;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const RealArray<2>& a = polygon[i];
    const RealArray<2>& b = polygon[(i + 1) % polygon.size()];
    const double x = b[0] - a[0];
    const double y = b[1] - a[1];
    const double t =
      std::clamp(((point[0] - a[0]) * x + (point[1] - a[1]) * y) / (x * x + y * y), 0.0, 1.0);
    least = std::min(least, std::hypot(a[0] + t * x - point[0], a[1] + t * y - point[1]));
  }
  return least;
}

/// The surface (x, y, z)(u, v), each coordinate a sum of c[i][j] u^i v^j with i, j <= degree, over
/// a rectangle cut into n x n elements: control points by blossoms.
using Monomials = std::vector<std::vector<double>>;
inline Spline<2> PolynomialSurface(int degree, const std::array<Monomials, 3>& coordinates,
  const RealArray<2>& lower, const RealArray<2>& upper, int n)
{
  const KnotVector knots[2] = { KnotVector::Uniform(degree, n, lower[0], upper[0]),
    KnotVector::Uniform(degree, n, lower[1], upper[1]) };
  Spline<2> surface;
  surface.Space = MakeTensorSpace<2>({ knots[0], knots[1] }).Value;
  surface.ControlPoints = PointMatrix::Zero(surface.Space->NumFunctions, 3);
  // blossom of u^k at the function's inner knots: mean of all products of k of them
  const auto blossom = [&](const KnotVector& knot, int function, int k)
  {
    std::vector<double> sums(static_cast<std::size_t>(degree) + 1, 0.0);
    sums[0] = 1.0;
    for (int i = 1; i <= degree; ++i)
    {
      for (int m = i; m >= 1; --m)
      {
        sums[static_cast<std::size_t>(m)] += sums[static_cast<std::size_t>(m - 1)] *
          knot.Knots()[static_cast<std::size_t>(function + i)];
      }
    }
    double binomial = 1.0;
    for (int i = 1; i <= k; ++i)
    {
      binomial = binomial * (degree - k + i) / i;
    }
    return sums[static_cast<std::size_t>(k)] / binomial;
  };
  for (int j = 0; j < knots[1].NumFunctions(); ++j)
  {
    for (int i = 0; i < knots[0].NumFunctions(); ++i)
    {
      for (std::size_t c = 0; c < 3; ++c)
      {
        double sum = 0.0;
        for (std::size_t a = 0; a < coordinates[c].size(); ++a)
        {
          for (std::size_t b = 0; b < coordinates[c][a].size(); ++b)
          {
            sum += coordinates[c][a][b] * blossom(knots[0], i, static_cast<int>(a)) *
              blossom(knots[1], j, static_cast<int>(b));
          }
        }
        surface.ControlPoints(i + j * knots[0].NumFunctions(), static_cast<Eigen::Index>(c)) = sum;
      }
    }
  }
  return surface;
}

/// (u, v, u^2 + v^2): |S_u x S_v| = sqrt(1 + 4 u^2 + 4 v^2).
inline Spline<2> Paraboloid(
  const RealArray<2>& lower, const RealArray<2>& upper, int n, int degree = 2)
{
  return PolynomialSurface(degree,
    { Monomials{ {}, { 1.0 } }, Monomials{ { 0.0, 1.0 } },
      Monomials{ { 0.0, 0.0, 1.0 }, {}, { 1.0 } } },
    lower, upper, n);
}

/// A quarter of a cylinder of radius 2 around the z axis, z = 3 v: u in [0, 1] rational of degree
/// 2, v in [0, 1].
inline Spline<2> QuarterCylinder()
{
  Spline<2> surface;
  surface.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 1), KnotVector::Uniform(1, 1) }).Value;
  surface.ControlPoints.resize(6, 3);
  surface.ControlPoints << 2, 0, 0, 2, 2, 0, 0, 2, 0, 2, 0, 3, 2, 2, 3, 0, 2, 3;
  surface.Weights.resize(6);
  surface.Weights << 1, std::sqrt(0.5), 1, 1, std::sqrt(0.5), 1;
  return surface;
}
}
