// SPDX-License-Identifier: BSD-3-Clause
// Triangles of solids of revolution.
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

#include <Eigen/Geometry>

#include <cmath>
#include <random>

namespace knotwork
{
inline constexpr double TwoPi = 2.0 * 3.14159265358979323846;

/// A corner of a profile (radius, height) or an arc to it.
struct ProfilePiece
{
  Eigen::Vector2d End;
  Eigen::Vector2d Centre = Eigen::Vector2d::Zero();
  int Steps = 1; ///< more than one: an arc about Centre
};

/// A closed profile beside the axis, or one that begins and ends on it, turned about z, then moved.
inline TriangleMesh Turned(const Eigen::Vector2d& begin, const std::vector<ProfilePiece>& pieces,
  int sides, double noise = 0.0)
{
  std::vector<Eigen::Vector2d> profile = { begin };
  for (const ProfilePiece& piece : pieces)
  {
    const Eigen::Vector2d from = profile.back() - piece.Centre;
    const Eigen::Vector2d to = piece.End - piece.Centre;
    const double turn = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
    for (int i = 1; i <= piece.Steps; ++i)
    {
      profile.push_back(i == piece.Steps
          ? piece.End
          : Eigen::Vector2d(piece.Centre + Eigen::Rotation2Dd(turn * i / piece.Steps) * from));
    }
  }
  std::mt19937 random(7);
  std::normal_distribution<double> shift(0.0, 1.0);
  const Eigen::AngleAxisd tilt(0.7, Eigen::Vector3d(1, 2, -1).normalized());
  TriangleMesh mesh;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> rings;
  for (const Eigen::Vector2d& p : profile)
  {
    std::vector<int>& ring = rings.emplace_back();
    for (int i = 0; i < sides; ++i)
    {
      const double angle = TwoPi * i / sides;
      if (i == 0 || p.x() > 0.0)
      {
        points.emplace_back(
          tilt * Eigen::Vector3d(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y()) +
          Eigen::Vector3d(3, 1, 2));
        for (int d = 0; d < 3; ++d)
        {
          points.back()[d] += noise > 0.0 ? noise * shift(random) : 0.0;
        }
      }
      ring.push_back(static_cast<int>(points.size()) - 1);
    }
  }
  if ((profile.front() - profile.back()).norm() == 0.0)
  {
    rings.back() = rings.front();
    points.resize(points.size() - static_cast<std::size_t>(sides));
  }
  for (std::size_t r = 0; r + 1 < rings.size(); ++r)
  {
    for (int i = 0; i < sides; ++i)
    {
      const auto a = static_cast<std::size_t>(i);
      const auto b = static_cast<std::size_t>((i + 1) % sides);
      const std::array<int, 3> first = { rings[r][a], rings[r][b], rings[r + 1][b] };
      const std::array<int, 3> second = { rings[r][a], rings[r + 1][b], rings[r + 1][a] };
      for (const auto& t : { first, second })
      {
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
        {
          mesh.Triangles.push_back(t);
        }
      }
    }
  }
  mesh.Points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mesh.Points.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  }
  return mesh;
}
}
