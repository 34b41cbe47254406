// SPDX-License-Identifier: BSD-3-Clause
// Domains whose maps are valid though det J is zero at a corner, along an edge or on a side,
// exactly: after the points are turned and the boundary is refined, only rounding is left there.
#pragma once
#include "HeldOutDomains.h"
#include <knotwork/SplineCore/Refinement.h>

#include <Eigen/LU>

namespace knotwork::cases
{
/// A strip along a broken line, quadratic: the plane section of SharpBar.
inline HeldOut<2> SharpStrip(Dice& dice)
{
  const Spline<3> bar =
    SharpBar(dice.Between(0.3, 0.7), 1.0 + dice.Between(0.0, 1.0), dice.Whole(0, 1) == 1).Known;
  HeldOut<2> out;
  out.Kind = "sharp turns";
  out.Known.Space = MakeTensorSpace<2>({ bar.Space->Knots[0], bar.Space->Knots[1] }).Value;
  out.Known.ControlPoints = bar.ControlPoints.topRows(out.Known.Space->NumFunctions).leftCols<2>();
  return out;
}

/// Sides that are tangent to each other in a corner: det J is zero there.
inline HeldOut<2> TangentCorner(Dice& dice)
{
  HeldOut<2> out;
  out.Kind = "tangent corner";
  const int elements = dice.Whole(1, 3);
  const double bulge = dice.Between(0.2, 0.5);
  out.Known = GrevilleMap<2>({ KnotVector::Uniform(2, elements), KnotVector::Uniform(2, elements) },
    [](const std::array<double, 2>& u) { return u; });
  // the quadratic x = u - b v (1 - u)^2.., exact in the space: a corner opened to a straight angle
  const int n = elements + 2;
  out.Known.ControlPoints.row(0) << bulge / elements, bulge / elements;
  out.Known.ControlPoints.row(1)[1] = 0.0;
  const double step = 0.5 / elements;
  out.Known.ControlPoints.row(1) << 2 * step, 0.0;
  out.Known.ControlPoints.row(n) << 0.0, 2 * step;
  out.Known.ControlPoints.row(0) << step, step;
  return out;
}

/// A quarter disc with one corner, in homogeneous control points: its edges collapse to the centre.
inline HeldOut<2> Sector(Dice& dice)
{
  HeldOut<2> out;
  out.Kind = "sector from its centre";
  const double angle = dice.Between(0.5, 2.5);
  const int degree = dice.Whole(1, 3);
  Spline<2>& map = out.Known;
  map.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(degree, 1), KnotVector::Uniform(2, 1) }).Value;
  map.ControlPoints.resize(map.Space->NumFunctions, 2);
  map.Weights.resize(map.Space->NumFunctions);
  for (int j = 0; j < 3; ++j)
  {
    const double a = 0.5 * j * angle;
    const double r = j == 1 ? 1.0 / std::cos(0.5 * angle) : 1.0;
    for (int i = 0; i <= degree; ++i)
    {
      map.ControlPoints.row(i + (degree + 1) * j) << i * r * std::cos(a) / degree,
        i * r * std::sin(a) / degree;
      map.Weights[i + (degree + 1) * j] = j == 1 ? std::cos(0.5 * angle) : 1.0;
    }
  }
  return out;
}

/// The unit disc between four arcs, det J is zero at the corners; one element.
inline HeldOut<2> OneDisc()
{
  HeldOut<2> out;
  out.Kind = "disc";
  out.Known.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 1), KnotVector::Uniform(2, 1) }).Value;
  out.Known.ControlPoints.resize(9, 2);
  out.Known.Weights.resize(9);
  const double h = std::sqrt(0.5);
  const double x[3] = { -1.0, 0.0, 1.0 };
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      const bool corner = i != 1 && j != 1;
      const double r = corner ? h : 1.0 / h;
      out.Known.ControlPoints.row(i + 3 * j) << r * x[i], r * x[j];
      out.Known.Weights[i + 3 * j] = (i == 1) != (j == 1) ? h : 1.0;
    }
  }
  return out;
}

inline HeldOut<2> DegeneratePlane(unsigned seed)
{
  Dice dice(seed);
  HeldOut<2> out;
  switch (seed % 4)
  {
    case 0:
      out = SharpStrip(dice);
      break;
    case 1:
      out = TangentCorner(dice);
      break;
    case 2:
      out = Sector(dice);
      break;
    default:
      out = OneDisc();
  }
  return out;
}

/// A plane map, lifted; the lid is smaller than the bottom.
inline HeldOut<3> Lifted(const HeldOut<2>& plane, Dice& dice)
{
  HeldOut<3> out;
  out.Kind = "lifted " + plane.Kind;
  const int degree = dice.Whole(1, 2);
  const double size = dice.Between(0.4, 1.0);
  const Spline<2>& base = plane.Known;
  out.Known.Space = MakeTensorSpace<3>(
    { base.Space->Knots[0], base.Space->Knots[1], KnotVector::Uniform(degree, 1) })
                      .Value;
  const Eigen::Index n = base.ControlPoints.rows();
  out.Known.ControlPoints.resize(n * (degree + 1), 3);
  out.Known.Weights.resize(base.IsRational() ? n * (degree + 1) : 0);
  for (Eigen::Index k = 0; k <= degree; ++k)
  {
    const double t = static_cast<double>(k) / degree;
    for (Eigen::Index i = 0; i < n; ++i)
    {
      out.Known.ControlPoints.row(i + n * k) << (1 + t * (size - 1)) * base.ControlPoints.row(i), t;
      if (base.IsRational())
      {
        out.Known.Weights[i + n * k] = base.Weights[i];
      }
    }
  }
  return out;
}

/// (u, u^a v, u^b w) in Bernstein form: a wedge or a pyramid, one side of which is an edge or a
/// point.
inline HeldOut<3> Collapsed(Dice& dice)
{
  const bool pyramid = dice.Whole(0, 1) == 1;
  HeldOut<3> out;
  out.Kind = pyramid ? "pyramid" : "wedge";
  const int n = dice.Whole(1, 3);
  out.Known = GrevilleMap<3>(
    { KnotVector::Uniform(2, n), KnotVector::Uniform(2, 1), KnotVector::Uniform(1, 1) },
    [&](const std::array<double, 3>& u) {
      return std::array<double, 3>{ u[0], pyramid ? u[0] * u[1] : u[1], u[0] * u[2] };
    });
  return out;
}

inline HeldOut<3> DegenerateSolid(unsigned seed)
{
  Dice dice(seed);
  switch (seed % 4)
  {
    case 0:
      return SharpBar(dice.Between(0.3, 0.7), 1.0 + dice.Between(0.0, 1.0), dice.Whole(0, 1) == 1);
    case 1:
      return Lifted(Sector(dice), dice);
    case 2:
      return Lifted(SharpStrip(dice), dice);
    default:
      return Collapsed(dice);
  }
}

/// The same points turned, scaled and moved, refined: knots inserted in every direction,
/// elements halved, a degree raised.
template <int Dim>
Spline<Dim> Roughened(const Spline<Dim>& map, unsigned seed, int refinements)
{
  Dice dice(seed + 77 * static_cast<unsigned>(refinements));
  Eigen::Matrix<double, Dim, Dim> turn = Eigen::Matrix<double, Dim, Dim>::Identity();
  Eigen::Matrix<double, 1, Dim> shift;
  for (int r = 0; r < Dim; ++r)
  {
    shift[r] = dice.Between(-1.0, 1.0);
    const double angle = dice.Between(0.0, 2 * Pi);
    Eigen::Matrix<double, Dim, Dim> plane = Eigen::Matrix<double, Dim, Dim>::Identity();
    const int c = (r + 1) % Dim;
    plane(r, r) = plane(c, c) = std::cos(angle);
    plane(r, c) = std::sin(angle);
    plane(c, r) = -plane(r, c);
    turn = (turn * plane).eval();
  }
  turn *= dice.Between(0.1, 10.0);
  Spline<Dim> out = map;
  const double far = dice.Whole(0, 3) == 0 ? 1000.0 : 1.0;
  out.ControlPoints = ((map.ControlPoints * turn).rowwise() + far * shift).eval();
  for (int k = 0; k < refinements; ++k)
  {
    const int way = dice.Whole(0, 2);
    if (way == 0)
    {
      out = RefineAllElements<Dim>(out)->Value;
    }
    else if (way == 1 && out.Space->Knots[0].Degree() < 4)
    {
      out = ElevateAllDegrees<Dim>(out, 1).Value;
    }
    else
    {
      for (int d = 0; d < Dim; ++d)
      {
        out =
          InsertKnots<Dim>(out, d, { dice.Between(0.05, 0.95), dice.Between(0.05, 0.95) }).Value;
      }
    }
  }
  return out;
}
}
