// SPDX-License-Identifier: BSD-3-Clause
// Triangle meshes for template mapping in space: plates, spheres, cubes.
#pragma once
#include <knotwork/TemplateMapping/Skeleton.h>

#include <cmath>
#include <map>
#include <random>

namespace knotwork::cases
{
using Triangles = std::vector<std::array<int, 3>>;

/// Patch of id 0 over the unit square: (n + 1)^2 points place(u, v), parameters (u, v), two
/// triangles a cell.
template <typename Place>
SkeletonPatch<3> GridPatch(int n, const Place& place)
{
  SkeletonPatch<3> patch;
  patch.Points.resize((n + 1) * (n + 1), 3);
  patch.Parameters.resize((n + 1) * (n + 1), 2);
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      const int k = j * (n + 1) + i;
      patch.Parameters.row(k) << double(i) / n, double(j) / n;
      patch.Points.row(k) = place(double(i) / n, double(j) / n);
      if (i < n && j < n)
      {
        patch.Simplices.push_back({ k, k + 1, k + n + 2 });
        patch.Simplices.push_back({ k, k + n + 2, k + n + 1 });
      }
    }
  }
  return patch;
}

/// Plate [0.2, 0.8]^2 at z = 0.5.
inline SkeletonPatch<3> Plate(int n)
{
  return GridPatch(
    n, [](double u, double v) { return Eigen::RowVector3d(0.2 + 0.6 * u, 0.2 + 0.6 * v, 0.5); });
}

/// Closed surface of the cube [0.25, 0.75]^3: 8 points, 12 triangles turned outward.
inline SkeletonPatch<3> Cube()
{
  SkeletonPatch<3> cube;
  cube.Points.resize(8, 3);
  for (int k = 0; k < 8; ++k)
  {
    cube.Points.row(k) << (k & 1 ? 0.75 : 0.25), (k & 2 ? 0.75 : 0.25), (k & 4 ? 0.75 : 0.25);
  }
  for (const std::array<int, 4>& q : { std::array<int, 4>{ 0, 2, 3, 1 }, { 4, 5, 7, 6 },
         { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } })
  {
    cube.Simplices.push_back({ q[0], q[1], q[2] });
    cube.Simplices.push_back({ q[0], q[2], q[3] });
  }
  return cube;
}

/// Closed sphere of radius 0.25 about (0.5, 0.5, 0.5), turned outward: an octahedron cut `levels`
/// times, points carried to the sphere.
inline SkeletonPatch<3> Sphere(int levels)
{
  std::vector<Eigen::RowVector3d> points{ { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 },
    { 0, 0, 1 }, { 0, 0, -1 } };
  Triangles triangles{ { 0, 2, 4 }, { 2, 1, 4 }, { 1, 3, 4 }, { 3, 0, 4 }, { 2, 0, 5 }, { 1, 2, 5 },
    { 3, 1, 5 }, { 0, 3, 5 } };
  for (int level = 0; level < levels; ++level)
  {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b)
    {
      const auto [place, isNew] =
        middles.try_emplace({ std::min(a, b), std::max(a, b) }, static_cast<int>(points.size()));
      if (isNew)
      {
        points.push_back(
          (points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)]).normalized());
      }
      return place->second;
    };
    Triangles finer;
    for (const auto& t : triangles)
    {
      const int a = middle(t[0], t[1]);
      const int b = middle(t[1], t[2]);
      const int c = middle(t[2], t[0]);
      for (const std::array<int, 3>& child :
        { std::array<int, 3>{ t[0], a, c }, { a, t[1], b }, { c, b, t[2] }, { a, b, c } })
      {
        finer.push_back(child);
      }
    }
    triangles = std::move(finer);
  }
  SkeletonPatch<3> sphere;
  sphere.Points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    sphere.Points.row(static_cast<Eigen::Index>(i)) =
      Eigen::RowVector3d(0.5, 0.5, 0.5) + 0.25 * points[i];
  }
  sphere.Simplices = std::move(triangles);
  return sphere;
}

/// The points of a sphere of Sphere(): three to five lobes around the axis through its middle,
/// twisted along it, leaning; many ask tangent distances for folds.
inline Skeleton<3> TwistedLobes(const Skeleton<3>& sphere, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> real(-1.0, 1.0);
  const double amplitude = 0.3 + 0.1 * real(random);
  const double twist = 3.0 * (0.8 + 0.4 * real(random));
  const int lobes = 3 + static_cast<int>(random() % 3u);
  const double lean = 0.1 * real(random);
  const double phase = 3.0 * real(random);
  Skeleton<3> target = sphere;
  for (SkeletonPatch<3>& patch : target)
  {
    for (Eigen::Index i = 0; i < patch.Points.rows(); ++i)
    {
      const Eigen::RowVector3d out = (patch.Points.row(i).array() - 0.5) / 0.25;
      const double reach = std::pow(std::hypot(out(0), out(1)), 3);
      const double angle = lobes * std::atan2(out(1), out(0)) + twist * out(2) + phase;
      const double factor = 1.0 + amplitude * reach * std::cos(angle) + lean * out(2);
      patch.Points.row(i) = 0.25 * factor * out.array() + 0.5;
    }
  }
  return target;
}
}
