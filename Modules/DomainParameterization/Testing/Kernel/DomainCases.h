// SPDX-License-Identifier: BSD-3-Clause
// Boundaries for domain parameterization, made from formulas.
#pragma once
#include "SplineOracle.h"
#include <knotwork/DomainParameterization/DomainBoundary.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <cmath>
#include <functional>

namespace knotwork::cases
{
inline constexpr double Pi = 3.14159265358979323846;

inline Spline<1> Curve(const KnotVector& knots, const std::vector<std::array<double, 2>>& points)
{
  Spline<1> curve;
  curve.Space = MakeTensorSpace<1>({ knots }).Value;
  curve.ControlPoints.resize(static_cast<Eigen::Index>(points.size()), 2);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    curve.ControlPoints.row(static_cast<Eigen::Index>(i)) << points[i][0], points[i][1];
  }
  return curve;
}

inline Spline<1> Segment(std::array<double, 2> a, std::array<double, 2> b)
{
  return Curve(KnotVector::Uniform(1, 1), { a, b });
}

/// Circular arc about the origin, less than 180 degrees, one quadratic element.
inline Spline<1> Arc(double radius, double begin, double end)
{
  const double half = 0.5 * (end - begin);
  const double middle = 0.5 * (begin + end);
  const double w = std::cos(half);
  Spline<1> arc = Curve(KnotVector::Uniform(2, 1),
    { { radius * std::cos(begin), radius * std::sin(begin) },
      { radius / w * std::cos(middle), radius / w * std::sin(middle) },
      { radius * std::cos(end), radius * std::sin(end) } });
  arc.Weights = Eigen::Vector3d(1.0, w, 1.0);
  return arc;
}

/// West, east, south, north of the unit square.
inline DomainBoundary<2> Square()
{
  return { { Segment({ 0, 0 }, { 0, 1 }), Segment({ 1, 0 }, { 1, 1 }), Segment({ 0, 0 }, { 1, 0 }),
    Segment({ 0, 1 }, { 1, 1 }) } };
}

/// The sides of a map of the unit square (cube), as splines of their own.
template <int Dim>
DomainBoundary<Dim> SidesOf(const Spline<Dim>& map)
{
  DomainBoundary<Dim> boundary;
  for (int s = 0; s < 2 * Dim; ++s)
  {
    std::array<KnotVector, Dim - 1> knots;
    std::array<int, Dim> stride{};
    std::array<int, Dim> count{};
    int next = 1;
    int k = 0;
    for (int d = 0; d < Dim; ++d)
    {
      stride[d] = next;
      count[d] = map.Space->Knots[d].NumFunctions();
      next *= count[d];
      if (d != s / 2)
      {
        knots[k++] = map.Space->Knots[d];
      }
    }
    Spline<Dim - 1> side;
    side.Space = MakeTensorSpace<Dim - 1>(knots).Value;
    side.ControlPoints.resize(side.Space->NumFunctions, Dim);
    side.Weights.resize(map.IsRational() ? side.Space->NumFunctions : 0);
    for (int i = 0; i < side.Space->NumFunctions; ++i)
    {
      int from = s % 2 ? (count[s / 2] - 1) * stride[s / 2] : 0;
      int rest = i;
      for (int d = 0; d < Dim; ++d)
      {
        if (d != s / 2)
        {
          from += rest % count[d] * stride[d];
          rest /= count[d];
        }
      }
      side.ControlPoints.row(i) = map.ControlPoints.row(from);
      if (map.IsRational())
      {
        side.Weights[i] = map.Weights[from];
      }
    }
    boundary.Sides.push_back(side);
  }
  return boundary;
}

/// A tensor-product map whose control points are a function of the Greville abscissae.
template <int Dim>
Spline<Dim> GrevilleMap(const std::array<KnotVector, Dim>& knots,
  const std::function<std::array<double, Dim>(const std::array<double, Dim>&)>& f)
{
  Spline<Dim> map;
  map.Space = MakeTensorSpace<Dim>(knots).Value;
  const PointMatrix u = GrevillePoints<Dim>(*map.Space);
  map.ControlPoints.resize(u.rows(), Dim);
  for (Eigen::Index i = 0; i < u.rows(); ++i)
  {
    std::array<double, Dim> x{};
    for (int d = 0; d < Dim; ++d)
    {
      x[d] = u(i, d);
    }
    const auto y = f(x);
    for (int d = 0; d < Dim; ++d)
    {
      map.ControlPoints(i, d) = y[d];
    }
  }
  return map;
}

/// Two arcs of the radii 1 and 2 through 90 degrees, radial segments, in any orientation.
inline DomainBoundary<2> AnnulusSector()
{
  return { { Arc(1.0, 0.0, Pi / 2), Arc(2.0, 0.0, Pi / 2), Segment({ 1, 0 }, { 2, 0 }),
    Segment({ 0, 1 }, { 0, 2 }) } };
}

/// A curve run backwards.
inline Spline<1> Backwards(const Spline<1>& curve)
{
  Spline<1> result = curve;
  std::vector<double> knots(
    curve.Space->Knots[0].Knots().rbegin(), curve.Space->Knots[0].Knots().rend());
  const double sum = knots.front() + knots.back();
  for (double& t : knots)
  {
    t = sum - t;
  }
  result.Space =
    MakeTensorSpace<1>({ KnotVector::Create(curve.Space->Knots[0].Degree(), knots).Value }).Value;
  result.ControlPoints = curve.ControlPoints.colwise().reverse().eval();
  if (curve.IsRational())
  {
    result.Weights = curve.Weights.reverse().eval();
  }
  return result;
}

/// The unit square's width, height `height`, with a disc of the given radius about (x, 0) bitten
/// out of the south side: three arcs' worth of quadratic rational elements. West has degree
/// `degree`, so there are degree - 1 rows of inner control points: few enough that a tall domain
/// needs weights.
inline DomainBoundary<2> Bite(double radius, double x, double height, int degree)
{
  const double w = std::cos(Pi / 4);
  const double l = x - radius;
  const double r = x + radius;
  DomainBoundary<2> boundary;
  Spline<1> south =
    Curve(KnotVector::Create(2, { 0, 0, 0, .25, .25, .5, .5, .75, .75, 1, 1, 1 }).Value,
      { { 0, 0 }, { l / 2, 0 }, { l, 0 }, { l, radius }, { x, radius }, { r, radius }, { r, 0 },
        { (1 + r) / 2, 0 }, { 1, 0 } });
  south.Weights = Eigen::VectorXd::Ones(9);
  south.Weights[3] = south.Weights[5] = w;
  boundary.Sides = { ElevateDegree<1>(Segment({ 0, 0 }, { 0, height }), 0, degree - 1).Value,
    Segment({ 1, 0 }, { 1, height }), south, Segment({ 0, height }, { 1, height }) };
  return boundary;
}

/// A sector of the annulus between radii 1 and 2 whose inner arc has a bump outward at parameter
/// `at` of its `elements` elements.
inline DomainBoundary<2> BumpedSector(double bump, double at, int elements, int degree)
{
  DomainBoundary<2> boundary = AnnulusSector();
  std::vector<double> knots;
  for (int i = 1; i < elements; ++i)
  {
    knots.push_back(double(i) / elements);
  }
  Spline<1> inner = InsertKnots<1>(boundary.Sides[0], 0, knots).Value;
  for (Eigen::Index i = 1; i + 1 < inner.ControlPoints.rows(); ++i)
  {
    const double u = inner.Space->Knots[0].Greville(static_cast<int>(i)) - at;
    inner.ControlPoints.row(i) *= 1 + bump * std::exp(-40 * u * u);
  }
  boundary.Sides[0] = inner;
  boundary.Sides[2] = ElevateDegree<1>(boundary.Sides[2], 0, degree - 1).Value;
  return boundary;
}

/// The faces of a bar bent like the letter G: its axis is an arc of radius 1.2 through 295 degrees,
/// a tighter left turn and a straight end. Cross lines are skewed: on the outer face positions
/// along the axis run ahead by up to `skew` of its length.
inline DomainBoundary<3> LetterG(int elements, int across, int degree, double width, double skew)
{
  // curvature of the axis, piece by piece: length, curvature
  const std::array<std::array<double, 2>, 3> pieces{ { { 1.2 * 295 * Pi / 180, 1 / 1.2 },
    { 0.5 * 105 * Pi / 180, 1 / 0.5 }, { 0.35, 0.0 } } };
  double total = 0.0;
  for (const auto& piece : pieces)
  {
    total += piece[0];
  }
  const auto axis = [&](double t, double& heading)
  {
    std::array<double, 2> x{ 1.2 * std::cos(50 * Pi / 180), 1.2 * std::sin(50 * Pi / 180) };
    heading = 140 * Pi / 180;
    double rest = t * total;
    for (const auto& piece : pieces)
    {
      const double s = std::min(rest, piece[0]);
      const double turn = piece[1] * s;
      if (piece[1] > 0.0)
      {
        x[0] += (std::sin(heading + turn) - std::sin(heading)) / piece[1];
        x[1] -= (std::cos(heading + turn) - std::cos(heading)) / piece[1];
      }
      else
      {
        x[0] += s * std::cos(heading);
        x[1] += s * std::sin(heading);
      }
      heading += turn;
      rest -= s;
    }
    return x;
  };
  return SidesOf<3>(
    GrevilleMap<3>({ KnotVector::Uniform(degree, elements), KnotVector::Uniform(degree, across),
                     KnotVector::Uniform(degree, across) },
      [&](const std::array<double, 3>& u)
      {
        double heading = 0.0;
        const double t = u[0] + skew * u[1] * std::sin(Pi * u[0]) * std::sin(3 * Pi * u[0]);
        const auto x = axis(t, heading);
        const double side = width * (u[1] - 0.5);
        return std::array<double, 3>{ x[0] - side * std::sin(heading),
          x[1] + side * std::cos(heading), 0.6 * u[2] };
      }));
}
}
