// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>

namespace knotwork
{
constexpr double Pi = 3.14159265358979323846;

/// Faces of n x m divided squares, whose equal points are one.
inline TriangleMesh Faces(
  int faces, int n, int m, const std::function<Eigen::Vector3d(int, double, double)>& point)
{
  TriangleMesh mesh;
  std::map<std::array<long, 3>, int> numbers;
  std::vector<Eigen::Vector3d> points;
  const auto number = [&](int face, int i, int j)
  {
    const Eigen::Vector3d p = point(face, static_cast<double>(i) / n, static_cast<double>(j) / m);
    const std::array<long, 3> key = { std::lround(1e7 * p[0]), std::lround(1e7 * p[1]),
      std::lround(1e7 * p[2]) };
    const auto [found, isNew] = numbers.emplace(key, static_cast<int>(points.size()));
    if (isNew)
    {
      points.push_back(p);
    }
    return found->second;
  };
  const auto add = [&](int a, int b, int c)
  {
    if (a != b && b != c && c != a)
    {
      mesh.Triangles.push_back({ a, b, c });
    }
  };
  for (int face = 0; face < faces; ++face)
  {
    for (int i = 0; i < n; ++i)
    {
      for (int j = 0; j < m; ++j)
      {
        const int a = number(face, i, j);
        const int b = number(face, i + 1, j);
        const int c = number(face, i + 1, j + 1);
        const int d = number(face, i, j + 1);
        add(a, b, c);
        add(a, c, d);
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

/// The unit cube, its faces divided n times.
inline TriangleMesh DividedCube(int n)
{
  return Faces(6, n, n,
    [](int face, double u, double v)
    {
      const bool isUpper = face % 2 == 1;
      Eigen::Vector3d p;
      p[face / 2] = isUpper ? 1.0 : 0.0;
      p[(face / 2 + 1) % 3] = isUpper ? u : v;
      p[(face / 2 + 2) % 3] = isUpper ? v : u;
      return p;
    });
}

/// A profile, points (radius, z), turned about the z axis.
inline TriangleMesh Turned(const std::vector<std::array<double, 2>>& profile, int sides)
{
  return Faces(static_cast<int>(profile.size()) - 1, sides, 1,
    [&](int face, double u, double v)
    {
      const auto& a = profile[static_cast<std::size_t>(face)];
      const auto& b = profile[static_cast<std::size_t>(face) + 1];
      const double radius = (1.0 - v) * a[0] + v * b[0];
      const double angle = 2.0 * Pi * u;
      return Eigen::Vector3d(
        radius * std::cos(angle), radius * std::sin(angle), (1.0 - v) * a[1] + v * b[1]);
    });
}

/// Moves every coordinate by normally distributed noise.
inline void AddNoise(double deviation, unsigned seed, TriangleMesh& mesh)
{
  std::mt19937 random(seed);
  const auto uniform = [&]() { return (static_cast<double>(random()) + 1.0) / 4294967297.0; };
  for (Eigen::Index i = 0; i < mesh.Points.size(); ++i)
  {
    // Box, Muller: the same on every system
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    mesh.Points.data()[i] += deviation * radius * std::cos(2.0 * Pi * uniform());
  }
}
}
