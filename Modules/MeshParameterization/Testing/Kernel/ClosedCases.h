// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

#include <cmath>
#include <functional>
#include <map>

namespace knotwork
{
/// The same mesh without the triangles whose centre is in a part of space, and without the points
/// that no triangle uses then.
inline TriangleMesh Without(
  const TriangleMesh& mesh, const std::function<bool(const Eigen::Vector3d&)>& inside)
{
  TriangleMesh result;
  std::map<int, int> number;
  for (auto corners : mesh.Triangles)
  {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int c : corners)
    {
      centre += mesh.Points.row(c).transpose() / 3.0;
    }
    if (inside(centre))
    {
      continue;
    }
    for (int& c : corners)
    {
      c = number.emplace(c, static_cast<int>(number.size())).first->second;
    }
    result.Triangles.push_back(corners);
  }
  result.Points.resize(static_cast<Eigen::Index>(number.size()), 3);
  for (const auto& [from, to] : number)
  {
    result.Points.row(to) = mesh.Points.row(from);
  }
  return result;
}

/// Closed surface of revolution about x: a profile (x, r) from pole to pole in `rings` steps of its
/// parameter, [0, 1]; r is 0 at its ends.
inline TriangleMesh Revolution(
  int rings, int sectors, const std::function<Eigen::Vector2d(double)>& profile)
{
  const double pi = std::acos(-1.0);
  TriangleMesh mesh;
  mesh.Points.resize(2 + (rings - 1) * sectors, 3);
  mesh.Points.row(0) << profile(0.0)[0], 0.0, 0.0;
  mesh.Points.row(1) << profile(1.0)[0], 0.0, 0.0;
  const auto point = [&](int ring, int sector)
  {
    const int last = ring == 0 ? 0 : 1;
    return ring % rings == 0 ? last : 2 + (ring - 1) * sectors + sector % sectors;
  };
  for (int i = 1; i < rings; ++i)
  {
    const Eigen::Vector2d p = profile(static_cast<double>(i) / rings);
    for (int j = 0; j < sectors; ++j)
    {
      const double angle = 2.0 * pi * (j + 0.5 * (i % 2)) / sectors;
      mesh.Points.row(point(i, j)) << p[0], p[1] * std::cos(angle), p[1] * std::sin(angle);
    }
  }
  for (int i = 0; i < rings; ++i)
  {
    for (int j = 0; j < sectors; ++j)
    {
      const int shift = i % 2; // of the ring that begins half a sector later
      if (i > 0)
      {
        mesh.Triangles.push_back({ point(i, j), point(i, j + 1), point(i + 1, j + shift) });
      }
      if (i + 1 < rings)
      {
        mesh.Triangles.push_back({ point(i + 1, j), point(i, j + 1 - shift), point(i + 1, j + 1) });
      }
    }
  }
  return mesh;
}

inline TriangleMesh Sphere(int rings)
{
  const double pi = std::acos(-1.0);
  return Revolution(rings, 2 * rings,
    [pi](double t) { return Eigen::Vector2d(-std::cos(pi * t), std::sin(pi * t)); });
}

/// A tube of radius 1 from x = 0 to x = length, closed by half spheres, with square windows on the
/// sides y > 0 and y < 0.
inline TriangleMesh Fuselage(double length, int windows)
{
  const double pi = std::acos(-1.0);
  const double whole = length + pi;
  const TriangleMesh tube = Revolution(static_cast<int>(whole / 0.15), 42,
    [=](double t)
    {
      const double s = t * whole;
      const double front = s - length - 0.5 * pi;
      return s < 0.5 * pi ? Eigen::Vector2d(-std::cos(s), std::sin(s))
        : front > 0.0     ? Eigen::Vector2d(length + std::sin(front), std::cos(front))
                          : Eigen::Vector2d(s - 0.5 * pi, 1.0);
    });
  const double step = length / windows;
  return Without(tube,
    [=](const Eigen::Vector3d& p)
    {
      const double place = p[0] / step - std::floor(p[0] / step);
      return p[0] > 0.0 && p[0] < length && std::abs(p[2]) < 0.35 &&
        std::abs(place - 0.5) * step < 0.35;
    });
}

/// Torus about z, radii 1 and 0.4.
inline TriangleMesh Torus(int n)
{
  const double pi = std::acos(-1.0);
  const int m = 2 * n;
  TriangleMesh mesh;
  mesh.Points.resize(n * m, 3);
  const auto point = [=](int i, int j) { return (i % m) * n + j % n; };
  for (int i = 0; i < m; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      const double a = 2.0 * pi * i / m;
      const double b = 2.0 * pi * j / n;
      const double r = 1.0 + 0.4 * std::cos(b);
      mesh.Points.row(point(i, j)) << r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b);
      mesh.Triangles.push_back({ point(i, j), point(i + 1, j), point(i + 1, j + 1) });
      mesh.Triangles.push_back({ point(i, j), point(i + 1, j + 1), point(i, j + 1) });
    }
  }
  return mesh;
}

/// The cube [0, n]^3 with n^2 squares a side; points are integers.
inline TriangleMesh Cube(int n)
{
  std::map<std::array<int, 3>, int> number;
  TriangleMesh mesh;
  const auto point = [&](const std::array<int, 3>& p)
  { return number.emplace(p, static_cast<int>(number.size())).first->second; };
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    for (int high = 0; high < 2; ++high)
    {
      for (int i = 0; i < n; ++i)
      {
        for (int j = 0; j < n; ++j)
        {
          const auto corner = [&](int a, int b)
          {
            std::array<int, 3> p{};
            p[axis] = high * n;
            p[(axis + 1) % 3] = i + a;
            p[(axis + 2) % 3] = j + b;
            return point(p);
          };
          const int a = corner(0, 0);
          const int b = high ? corner(1, 0) : corner(0, 1);
          const int c = corner(1, 1);
          const int d = high ? corner(0, 1) : corner(1, 0);
          mesh.Triangles.push_back({ a, b, c });
          mesh.Triangles.push_back({ a, c, d });
        }
      }
    }
  }
  mesh.Points.resize(static_cast<Eigen::Index>(number.size()), 3);
  for (const auto& [place, id] : number)
  {
    mesh.Points.row(id) << place[0], place[1], place[2];
  }
  return mesh;
}
}
