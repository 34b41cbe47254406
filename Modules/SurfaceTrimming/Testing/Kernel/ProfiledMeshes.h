// SPDX-License-Identifier: BSD-3-Clause
// Triangles of solids with a wave as profile.
#pragma once
#include "TurnedMeshes.h"

namespace knotwork
{
/// Height of a wave over [0, 6].
inline double WaveAt(double x)
{
  return 1.0 + 0.3 * std::sin(1.5 * x);
}

/// The integrals of a wave and of its square over [0, 6].
inline double WaveArea()
{
  return 6.0 + 0.2 * (1.0 - std::cos(9.0));
}

inline double WaveSquares()
{
  return 6.0 + 0.4 * (1.0 - std::cos(9.0)) + 0.09 * (3.0 - std::sin(18.0) / 6.0);
}

/// A bar of a width whose top is a wave, the other sides flat, tilted.
inline TriangleMesh WavyBar(int strips, double width)
{
  const Eigen::AngleAxisd tilt(0.7, Eigen::Vector3d(1, 2, -1).normalized());
  TriangleMesh mesh;
  mesh.Points.resize(4 * (strips + 1), 3);
  for (int i = 0; i <= strips; ++i)
  {
    const double x = 6.0 * i / strips;
    const std::array<Eigen::Vector2d, 4> corners{ Eigen::Vector2d(0.0, 0.0),
      Eigen::Vector2d(width, 0.0), Eigen::Vector2d(width, WaveAt(x)),
      Eigen::Vector2d(0.0, WaveAt(x)) }; // around the bar
    for (int k = 0; k < 4; ++k)
    {
      const Eigen::Vector2d& at = corners[static_cast<std::size_t>(k)];
      mesh.Points.row(4 * i + k) = (tilt * Eigen::Vector3d(x, at[0], at[1])).transpose();
    }
  }
  const auto quad = [&](int a, int b, int c, int d)
  {
    mesh.Triangles.push_back({ a, b, c });
    mesh.Triangles.push_back({ a, c, d });
  };
  for (int i = 0; i < strips; ++i)
  {
    for (int k = 0; k < 4; ++k)
    {
      const int next = (k + 1) % 4;
      quad(4 * i + k, 4 * i + next, 4 * i + 4 + next, 4 * i + 4 + k);
    }
  }
  quad(3, 2, 1, 0);
  const int last = 4 * strips;
  quad(last, last + 1, last + 2, last + 3);
  return mesh;
}

/// A vase without a hollow: the wave turned about its axis, flat ends.
inline TriangleMesh Vase(int steps, int sides)
{
  std::vector<ProfilePiece> pieces;
  for (int i = 0; i <= steps; ++i)
  {
    const double x = 6.0 * i / steps;
    pieces.push_back({ { WaveAt(x), x } });
  }
  pieces.push_back({ { 0.0, 6.0 } });
  return Turned({ 0, 0 }, pieces, sides);
}
}
