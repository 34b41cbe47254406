// SPDX-License-Identifier: BSD-3-Clause
// Seeded random domains: boundaries of maps that are proved valid before they are given away, and
// boundaries that no valid map has.
#pragma once
#include "DomainCases.h"
#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/SplineCore/BezierForm.h>

#include <random>
#include <string>

namespace knotwork::cases
{
template <int Dim>
struct HeldOut
{
  std::string Kind;
  DomainBoundary<Dim> Boundary;
  Spline<Dim> Known; ///< a valid map with this boundary; no space when there is none
  bool Possible() const { return this->Known.Space != nullptr; }
};

/// Numbers from the engine alone: distributions differ between libraries.
class Dice
{
public:
  explicit Dice(unsigned seed) : Engine(seed * 2654435761u + 12345u) {}
  double Between(double a, double b)
  {
    return a + (b - a) * (static_cast<double>(this->Engine()) / 4294967296.0);
  }
  int Whole(int a, int b) { return a + static_cast<int>(this->Engine() % unsigned(b - a + 1)); }

private:
  std::mt19937 Engine;
};

template <int Dim>
bool IsProvedValid(const Spline<Dim>& map)
{
  const auto certificate =
    ValidateJacobian(MakeBernsteinCells<Dim>(MakeBezierForm<Dim>(map)), JacobianParams{});
  return certificate && certificate->Verdict == Verdict::Valid;
}

template <int Dim>
using Formula = std::function<std::array<double, Dim>(const std::array<double, Dim>&, double)>;

/// The map with control points f(Greville abscissae, strength), of the largest strength 1, 0.8,
/// 0.64, ... for which it is valid.
template <int Dim>
HeldOut<Dim> LargestValid(
  const char* kind, const std::array<KnotVector, Dim>& knots, const Formula<Dim>& f)
{
  HeldOut<Dim> out;
  out.Kind = kind;
  for (double strength = 1.0; strength > 0.01; strength *= 0.8)
  {
    Spline<Dim> map =
      GrevilleMap<Dim>(knots, [&](const std::array<double, Dim>& u) { return f(u, strength); });
    if (IsProvedValid<Dim>(map))
    {
      out.Boundary = SidesOf<Dim>(map);
      out.Known = std::move(map);
      return out;
    }
  }
  return out;
}

/// A strip of width `width` along a curve: x(t), heading(t) at t in [0, 1].
inline HeldOut<2> Strip(const char* kind, int degree, int along, int across, double width,
  const std::function<std::array<double, 3>(double)>& axis)
{
  return LargestValid<2>(kind,
    { KnotVector::Uniform(degree, along), KnotVector::Uniform(2, across) },
    [=](const std::array<double, 2>& u, double strength)
    {
      const auto a = axis(u[0]);
      const double side = strength * width * (u[1] - 0.5);
      return std::array<double, 2>{ a[0] - side * std::sin(a[2]), a[1] + side * std::cos(a[2]) };
    });
}

/// A path of straight runs and turns: { length, angle } in turn, at parameter t of its length.
inline std::array<double, 3> Along(const std::vector<std::array<double, 2>>& path, double t)
{
  double total = 0.0;
  for (const auto& piece : path)
  {
    total += piece[0];
  }
  double rest = t * total;
  std::array<double, 3> at{ 0.0, 0.0, 0.0 };
  for (const auto& piece : path)
  {
    const double s = std::min(rest, piece[0]);
    const double k = piece[1] / piece[0]; // curvature
    const double turned = at[2] + k * s;
    if (k != 0.0)
    {
      at[0] += (std::sin(turned) - std::sin(at[2])) / k;
      at[1] -= (std::cos(turned) - std::cos(at[2])) / k;
    }
    else
    {
      at[0] += s * std::cos(at[2]);
      at[1] += s * std::sin(at[2]);
    }
    at[2] = turned;
    rest -= s;
  }
  return at;
}

inline std::array<double, 3> OnSpiral(double turns, double gap, double t)
{
  const double b = gap / (2 * Pi);
  const double angle = 2 * Pi * turns * t;
  const double r = gap * 0.8 + b * angle;
  return { r * std::cos(angle), r * std::sin(angle), angle + std::atan2(r, b) };
}

inline double Bump(double x, double y, double width)
{
  return std::exp(-(x * x + y * y) / (width * width));
}

/// A bar along a broken line, quadratic. At every turn two control points of the outer and of the
/// inner sides coincide: there the derivative along the bar is zero, and the map's edges
/// degenerate.
inline HeldOut<3> SharpBar(double width, double length, bool mirrored)
{
  const double h = 0.5 * width;
  // centre line: points and the offset to the left side there
  struct Place
  {
    double X, Y, LeftX, LeftY, Ahead;
  };
  const double shift = 0.1 * length;
  const std::vector<Place> places{ { 0, 0, 0, h, 0 }, { 0.5 * length, 0, 0, h, 0 },
    { length, 0, -h, h, -shift }, { length, 0, -h, h, shift }, { length, 0.5 * length, -h, 0, 0 },
    { length, length, -h, -h, -shift }, { length, length, -h, -h, shift },
    { 0.6 * length, length, 0, -h, 0 }, { 0.2 * length, length, 0, -h, 0 } };
  const int n = static_cast<int>(places.size());
  HeldOut<3> out;
  out.Kind = "sharp turns";
  Spline<3> map;
  map.Space = MakeTensorSpace<3>(
    { KnotVector::Uniform(2, n - 2), KnotVector::Uniform(2, 1), KnotVector::Uniform(2, 1) })
                .Value;
  map.ControlPoints.resize(map.Space->NumFunctions, 3);
  for (int k = 0; k < 3; ++k)
  {
    for (int j = 0; j < 3; ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        const Place& place = places[static_cast<std::size_t>(i)];
        const double side = j - 1.0;
        // the middle row goes round the turn
        const double ahead = j == 1 ? place.Ahead : 0.0;
        const double turn = place.X == length && place.Y == 0 ? 1.0 : -1.0;
        const double along[2] = { ahead < 0 ? ahead : 0.0, ahead > 0 ? ahead : 0.0 };
        double x = place.X + side * place.LeftX;
        double y = place.Y + side * place.LeftY;
        x += turn > 0 ? along[0] : -along[1];
        y += turn > 0 ? along[1] : along[0];
        map.ControlPoints.row(i + n * (j + 3 * k)) << x, mirrored ? -y : y, 0.5 * k * width;
      }
    }
  }
  if (mirrored) // right-handed again: the second direction runs backwards
  {
    PointMatrix points = map.ControlPoints;
    for (int row = 0; row < points.rows(); ++row)
    {
      const int i = row % n;
      const int j = row / n % 3;
      const int k = row / (3 * n);
      points.row(row) = map.ControlPoints.row(i + n * (2 - j + 3 * k));
    }
    map.ControlPoints = points;
  }
  if (IsProvedValid<3>(map))
  {
    out.Boundary = SidesOf<3>(map);
    out.Known = std::move(map);
  }
  return out;
}

inline HeldOut<2> RandomPlane(unsigned seed)
{
  Dice dice(seed);
  const int degree = dice.Whole(2, 3);
  switch (seed % 10)
  {
    case 0: // a control net shaken as far as the map stays valid
    {
      const std::array<KnotVector, 2> knots{ KnotVector::Uniform(degree, dice.Whole(2, 7)),
        KnotVector::Uniform(degree, dice.Whole(2, 7)) };
      const int columns = knots[0].NumFunctions();
      std::vector<double> shift;
      for (int i = 0; i < 2 * columns * knots[1].NumFunctions(); ++i)
      {
        shift.push_back(dice.Between(-1.0, 1.0) * 0.6 / columns);
      }
      int next = 0;
      HeldOut<2> out = LargestValid<2>("shaken net", knots,
        [&](const std::array<double, 2>& u, double strength)
        {
          next = u[0] == 0.0 && u[1] == 0.0 ? 0 : next + 2;
          const std::size_t at = static_cast<std::size_t>(next);
          return std::array<double, 2>{ u[0] + strength * shift[at],
            u[1] + strength * shift[at + 1] };
        });
      return out;
    }
    case 1: // one side pushed in by an offset bump
    {
      const double depth = dice.Between(0.5, 0.95);
      const double at = dice.Between(0.25, 0.75);
      const double width = dice.Between(0.12, 0.3);
      return LargestValid<2>("dent",
        { KnotVector::Uniform(degree, dice.Whole(6, 12)),
          KnotVector::Uniform(2, dice.Whole(2, 5)) },
        [=](const std::array<double, 2>& u, double strength)
        {
          const double end = 4.0 * u[0] * (1.0 - u[0]);
          const double h = 1.0 - strength * depth * std::min(1.0, end) * Bump(u[0] - at, 0, width);
          return std::array<double, 2>{ u[0], h * u[1] };
        });
    }
    case 2: // spirals
    {
      const double turns = dice.Between(0.8, 4.0);
      const double width = dice.Between(0.3, 0.8);
      return Strip("spiral", 3, static_cast<int>(8 * turns) + 4, dice.Whole(1, 3), width,
        [=](double t) { return OnSpiral(turns, 1.0, t); });
    }
    case 3: // letters: C, S, U, J, Z
    {
      const double r = dice.Between(0.8, 1.2);
      const std::vector<std::vector<std::array<double, 2>>> letters{ { { r * 4.5, 4.5 } },
        { { r * 3.6, 3.6 }, { r * 3.6, -3.6 } }, { { 1.5, 0 }, { r * Pi, Pi }, { 1.5, 0 } },
        { { 2.0, 0 }, { r * 2.8, 2.8 } },
        { { 1.5, 0 }, { 0.8 * 2.3, 2.3 }, { 1.5, 0 }, { 0.8 * 2.3, -2.3 }, { 1.5, 0 } } };
      const auto letter = letters[static_cast<std::size_t>(dice.Whole(0, 4))];
      return Strip("letter", degree, dice.Whole(10, 24), dice.Whole(1, 4), dice.Between(0.4, 1.3),
        [=](double t) { return Along(letter, t); });
    }
    case 4: // turned about the middle, the more the nearer
    {
      const double angle = dice.Between(0.6, 2.4);
      const double reach = dice.Between(0.3, 0.8);
      return LargestValid<2>("swirl",
        { KnotVector::Uniform(degree, dice.Whole(5, 10)),
          KnotVector::Uniform(degree, dice.Whole(5, 10)) },
        [=](const std::array<double, 2>& u, double strength)
        {
          const double x = u[0] - 0.45;
          const double y = u[1] - 0.55;
          const double a = strength * angle * Bump(x, y, reach);
          return std::array<double, 2>{ std::cos(a) * x - std::sin(a) * y,
            std::sin(a) * x + std::cos(a) * y };
        });
    }
    case 5: // waves on all sides, parameters at uneven speed
    {
      const double amplitude = dice.Between(0.1, 0.3);
      const int waves = dice.Whole(1, 3);
      const double speed = dice.Between(0.0, 0.5);
      return LargestValid<2>("waves",
        { KnotVector::Uniform(degree, dice.Whole(6, 14)),
          KnotVector::Uniform(degree, dice.Whole(6, 14)) },
        [=](const std::array<double, 2>& u, double s)
        {
          const double x = u[0] + s * speed * u[0] * (1 - u[0]);
          const double y = u[1] - s * speed * u[1] * (1 - u[1]);
          return std::array<double, 2>{ x + s * amplitude * std::sin(waves * Pi * y + 1.0),
            y + s * amplitude * std::sin(waves * Pi * x + 2.0) };
        });
    }
    case 6: // dents in all four sides
    {
      double depth[4], at[4];
      for (int k = 0; k < 4; ++k)
      {
        depth[k] = dice.Between(0.1, 0.45);
        at[k] = dice.Between(0.3, 0.7);
      }
      const double width = dice.Between(0.1, 0.25);
      return LargestValid<2>("four dents",
        { KnotVector::Uniform(degree, dice.Whole(6, 12)),
          KnotVector::Uniform(degree, dice.Whole(6, 12)) },
        [=](const std::array<double, 2>& u, double s)
        {
          const auto dent = [&](int k, double t)
          { return s * depth[k] * std::min(1.0, 8 * t * (1 - t)) * Bump(t - at[k], 0, width); };
          const double west = dent(0, u[1]);
          const double east = 1 - dent(1, u[1]);
          const double south = dent(2, u[0]);
          const double north = 1 - dent(3, u[0]);
          return std::array<double, 2>{ west + (east - west) * u[0],
            south + (north - south) * u[1] };
        });
    }
    case 7: // bent, then turned about a point, then waved
    {
      const double bend = dice.Between(0.5, 4.5);
      const double angle = dice.Between(-1.5, 1.5);
      const double wave = dice.Between(0.0, 0.25);
      return LargestValid<2>("composed",
        { KnotVector::Uniform(degree, dice.Whole(6, 14)),
          KnotVector::Uniform(degree, dice.Whole(4, 10)) },
        [=](const std::array<double, 2>& u, double s)
        {
          const double r = 1.3 - s * u[1];
          double x = r * std::sin(bend * u[0]);
          double y = -r * std::cos(bend * u[0]);
          const double a = s * angle * Bump(x - 0.5, y, 0.8);
          const double turned = std::cos(a) * x - std::sin(a) * y;
          y = std::sin(a) * x + std::cos(a) * y;
          x = turned + s * wave * std::sin(3 * y);
          return std::array<double, 2>{ x, y + s * wave * std::sin(2 * x) };
        });
    }
    case 8: // sharp turns
    {
      const HeldOut<3> bar =
        SharpBar(dice.Between(0.3, 0.7), 1.0 + dice.Between(0.0, 1.0), dice.Whole(0, 1) == 1);
      HeldOut<2> out;
      out.Kind = "sharp turns";
      if (bar.Possible())
      {
        out.Known.Space =
          MakeTensorSpace<2>({ bar.Known.Space->Knots[0], bar.Known.Space->Knots[1] }).Value;
        out.Known.ControlPoints =
          bar.Known.ControlPoints.topLeftCorner(out.Known.Space->NumFunctions, 2);
        out.Boundary = SidesOf<2>(out.Known);
      }
      return out;
    }
    default: // an L
    {
      const double width = dice.Between(0.3, 1.2);
      const double turn = dice.Between(1.2, 2.2);
      return Strip("L", degree, dice.Whole(8, 16), dice.Whole(2, 4), width,
        [=](double t) {
          return Along({ { 1.6, 0.0 }, { 0.4 * turn, turn }, { 1.6, 0.0 } }, t);
        });
    }
  }
}

inline HeldOut<3> RandomSolid(unsigned seed)
{
  Dice dice(seed);
  const auto knots = [](int degree, int a, int b, int c)
  {
    return std::array<KnotVector, 3>{ KnotVector::Uniform(degree, a),
      KnotVector::Uniform(degree, b), KnotVector::Uniform(degree, c) };
  };
  switch (seed % 9)
  {
    case 0: // dented cube, the bump off the middle
    {
      const double depth = dice.Between(0.7, 0.95);
      const double x = dice.Between(0.3, 0.7);
      const double y = dice.Between(0.3, 0.7);
      const double width = dice.Between(0.15, 0.35);
      return LargestValid<3>("dented cube",
        knots(2, dice.Whole(4, 8), dice.Whole(4, 8), dice.Whole(1, 2)),
        [=](const std::array<double, 3>& u, double)
        {
          const double end = 16.0 * u[0] * (1.0 - u[0]) * u[1] * (1.0 - u[1]);
          const double h = 1.0 - depth * std::min(1.0, 2.0 * end) * Bump(u[0] - x, u[1] - y, width);
          return std::array<double, 3>{ u[0], u[1], h * u[2] };
        });
    }
    case 1: // bar twisted about its axis
    {
      const double angle = dice.Between(0.8, 3.5);
      return LargestValid<3>("twisted bar", knots(2, dice.Whole(1, 3), 2, dice.Whole(4, 10)),
        [=](const std::array<double, 3>& u, double strength)
        {
          const double a = strength * angle * u[2];
          const double x = u[0] - 0.5;
          const double y = u[1] - 0.4;
          return std::array<double, 3>{ std::cos(a) * x - std::sin(a) * y,
            std::sin(a) * x + std::cos(a) * y, 3.0 * u[2] };
        });
    }
    case 2: // bent bar, its ends beside each other
    {
      const double angle = dice.Between(2.0, 5.6);
      const double width = dice.Between(0.4, 1.4);
      return LargestValid<3>("bent bar", knots(2, dice.Whole(6, 14), 2, dice.Whole(1, 2)),
        [=](const std::array<double, 3>& u, double strength)
        {
          const double r = 1.0 + strength * width * (0.5 - u[1]);
          return std::array<double, 3>{ r * std::sin(angle * u[0]), -r * std::cos(angle * u[0]),
            0.8 * u[2] };
        });
    }
    case 3: // L, thicker at one end
    {
      const double width = dice.Between(0.4, 1.2);
      const double turn = dice.Between(1.2, 2.4);
      const double taper = dice.Between(-0.3, 0.3);
      return LargestValid<3>("L bar", knots(2, dice.Whole(8, 14), 2, 1),
        [=](const std::array<double, 3>& u, double strength)
        {
          const auto a = Along({ { 1.4, 0.0 }, { 0.4 * turn, turn }, { 1.4, 0.0 } }, u[0]);
          const double side = strength * width * (1.0 + taper * u[0]) * (u[1] - 0.5);
          return std::array<double, 3>{ a[0] - side * std::sin(a[2]), a[1] + side * std::cos(a[2]),
            u[2] * (1.0 - taper * u[0]) };
        });
    }
    case 4: // shaken net
    {
      const auto space = knots(2, dice.Whole(1, 4), dice.Whole(1, 4), dice.Whole(1, 4));
      const int n = space[0].NumFunctions() * space[1].NumFunctions() * space[2].NumFunctions();
      std::vector<double> shift;
      for (int i = 0; i < 3 * n; ++i)
      {
        shift.push_back(dice.Between(-1.0, 1.0) * 0.14);
      }
      int next = 0;
      return LargestValid<3>("shaken net", space,
        [&](const std::array<double, 3>& u, double strength)
        {
          next = u[0] == 0.0 && u[1] == 0.0 && u[2] == 0.0 ? 0 : next + 3;
          const double* s = shift.data() + next;
          return std::array<double, 3>{ u[0] + strength * s[0], u[1] + strength * s[1],
            u[2] + strength * s[2] };
        });
    }
    case 5: // sharp turns: control points that coincide, so that edges of the map stand still
    {
      const double width = dice.Between(0.3, 0.7);
      const bool mirrored = dice.Whole(0, 1) == 1;
      return SharpBar(width, 1.0 + dice.Between(0.0, 1.0), mirrored);
    }
    case 6: // two dents, from opposite sides
    {
      const double depth[2] = { dice.Between(0.3, 0.5), dice.Between(0.3, 0.48) };
      const double x[2] = { dice.Between(0.3, 0.7), dice.Between(0.3, 0.7) };
      const double y[2] = { dice.Between(0.3, 0.7), dice.Between(0.3, 0.7) };
      const double width = dice.Between(0.15, 0.35);
      return LargestValid<3>("two dents", knots(2, dice.Whole(4, 7), dice.Whole(4, 7), 2),
        [=](const std::array<double, 3>& u, double)
        {
          const double end = std::min(1.0, 32.0 * u[0] * (1.0 - u[0]) * u[1] * (1.0 - u[1]));
          const double top = 1.0 - depth[0] * end * Bump(u[0] - x[0], u[1] - y[0], width);
          const double bottom = depth[1] * end * Bump(u[0] - x[1], u[1] - y[1], width);
          return std::array<double, 3>{ u[0], u[1], bottom + (top - bottom) * u[2] };
        });
    }
    case 7: // bent, twisted and waved together
    {
      const double bend = dice.Between(1.0, 4.0);
      const double twist = dice.Between(-2.0, 2.0);
      const double wave = dice.Between(0.0, 0.15);
      return LargestValid<3>("bent and twisted", knots(2, dice.Whole(5, 10), 3, 3),
        [=](const std::array<double, 3>& u, double s)
        {
          const double a = s * twist * u[0];
          const double v = u[1] - 0.5 + s * wave * std::sin(2 * Pi * u[0]);
          const double w = u[2] - 0.5 + s * wave * std::sin(Pi * u[1]);
          const double y = std::cos(a) * v - std::sin(a) * w;
          const double z = std::sin(a) * v + std::cos(a) * w;
          const double r = 1.2 - s * y;
          return std::array<double, 3>{ r * std::sin(bend * u[0]), -r * std::cos(bend * u[0]), z };
        });
    }
    default: // a helix of a square section
    {
      const double turns = dice.Between(0.5, 1.4);
      const double width = dice.Between(0.3, 0.8);
      return LargestValid<3>("helix", knots(2, 8 + static_cast<int>(8 * turns), 1, 1),
        [=](const std::array<double, 3>& u, double strength)
        {
          const double a = 2 * Pi * turns * u[0];
          const double r = 1.0 + strength * width * (0.5 - u[1]);
          return std::array<double, 3>{ r * std::sin(a), -r * std::cos(a),
            turns * 1.2 * u[0] + strength * width * u[2] };
        });
    }
  }
}

/// What a message must name.
template <int Dim>
struct Impossible
{
  std::string Kind;
  DomainBoundary<Dim> Boundary;
  bool Crosses = false; ///< itself; else it folds at a corner, an edge or in a face
};

inline Impossible<2> ImpossiblePlane(unsigned seed)
{
  Dice dice(seed);
  Impossible<2> out;
  const KnotVector knots = KnotVector::Uniform(dice.Whole(2, 3), dice.Whole(5, 12));
  Spline<2> map = GrevilleMap<2>(
    { knots, KnotVector::Uniform(2, 3) }, [](const std::array<double, 2>& u) { return u; });
  out.Boundary = SidesOf<2>(map);
  PointMatrix& north = out.Boundary.Sides[3].ControlPoints;
  const Eigen::Index n = north.rows();
  switch (seed % 3)
  {
    case 0: // the north side dips below the south side
    {
      out.Kind = "dent through the other side";
      out.Crosses = true;
      const double at = dice.Between(0.3, 0.7);
      const double depth = dice.Between(1.6, 3.0);
      for (Eigen::Index i = 1; i + 1 < n; ++i)
      {
        north(i, 1) -= depth * Bump(north(i, 0) - at, 0, 0.25);
      }
      break;
    }
    case 1: // a loop in one side
    {
      out.Kind = "loop";
      out.Crosses = true;
      const Eigen::Index i = dice.Whole(2, static_cast<int>(n) - 4);
      const double size = dice.Between(0.3, 0.6);
      north.row(i) << north(i, 0) + size, 1.0 + size;
      north.row(i + 1) << north(i + 1, 0) - size, 1.0 + size;
      break;
    }
    default: // the north side leaves its corner to the outside of the west side
    {
      out.Kind = "folded corner";
      const double turn = dice.Between(0.1, 0.8);
      north.row(1) << -0.1 * std::cos(turn), 1.0 - 0.1 * std::sin(turn);
      break;
    }
  }
  return out;
}

inline Impossible<3> ImpossibleSolid(unsigned seed)
{
  Dice dice(seed);
  Impossible<3> out;
  const int elements = dice.Whole(4, 7);
  const KnotVector knots = KnotVector::Uniform(2, elements);
  const Spline<3> map = GrevilleMap<3>(
    { knots, knots, KnotVector::Uniform(2, 2) }, [](const std::array<double, 3>& u) { return u; });
  out.Boundary = SidesOf<3>(map);
  PointMatrix& top = out.Boundary.Sides[5].ControlPoints;
  const int n = knots.NumFunctions();
  const auto inner = [&](Eigen::Index i)
  { return i % n > 0 && i % n < n - 1 && i / n > 0 && i / n < n - 1; };
  switch (seed % 3)
  {
    case 0: // the top dips below the bottom
    {
      out.Kind = "top below bottom";
      out.Crosses = true;
      const double depth = dice.Between(1.6, 2.5);
      for (Eigen::Index i = 0; i < top.rows(); ++i)
      {
        top(i, 2) -= inner(i) ? depth * Bump(top(i, 0) - 0.5, top(i, 1) - 0.5, 0.3) : 0.0;
      }
      break;
    }
    case 1: // the top folds over in its plane
    {
      out.Kind = "folded face";
      const double push = dice.Between(0.5, 0.9);
      for (Eigen::Index i = 0; i < top.rows(); ++i)
      {
        top(i, 0) += inner(i) && i % n <= n / 2 ? push : 0.0;
      }
      break;
    }
    default: // the top leaves an edge downwards, outside of the wall
    {
      out.Kind = "folded edge";
      const double out1 = dice.Between(0.05, 0.2);
      for (Eigen::Index i = 0; i < top.rows(); ++i)
      {
        if (i % n == 1 && i / n > 0 && i / n < n - 1)
        {
          top.row(i) << -out1, top(i, 1), 0.9;
        }
      }
      break;
    }
  }
  return out;
}
}
