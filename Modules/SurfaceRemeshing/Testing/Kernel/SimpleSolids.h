// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

#include <cmath>

namespace knotwork
{
/// The surface of a box, outward.
inline TriangleMesh Box(
  const Eigen::Vector3d& corner = { 0, 0, 0 }, const Eigen::Vector3d& size = { 1, 1, 1 })
{
  TriangleMesh mesh;
  mesh.Points.resize(8, 3);
  for (int i = 0; i < 8; ++i)
  {
    mesh.Points.row(i) << corner[0] + (i % 2) * size[0], corner[1] + (i / 2 % 2) * size[1],
      corner[2] + (i / 4) * size[2];
  }
  const int quads[6][4] = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 },
    { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };
  for (const auto& q : quads)
  {
    mesh.Triangles.push_back({ q[0], q[1], q[2] });
    mesh.Triangles.push_back({ q[0], q[2], q[3] });
  }
  return mesh;
}

/// A ball of radius 1, of rings of points.
inline TriangleMesh Ball(int rings = 12)
{
  TriangleMesh mesh;
  const int sides = 2 * rings;
  mesh.Points.resize(2 + (rings - 1) * sides, 3);
  mesh.Points.row(0) << 0, 0, -1;
  mesh.Points.row(1) << 0, 0, 1;
  const auto at = [&](int ring, int i) { return 2 + (ring - 1) * sides + i % sides; };
  for (int ring = 1; ring < rings; ++ring)
  {
    for (int i = 0; i < sides; ++i)
    {
      const double v = M_PI * ring / rings;
      const double u = 2 * M_PI * i / sides;
      mesh.Points.row(at(ring, i)) << std::sin(v) * std::cos(u), std::sin(v) * std::sin(u),
        -std::cos(v);
    }
  }
  for (int i = 0; i < sides; ++i)
  {
    mesh.Triangles.push_back({ 0, at(1, i + 1), at(1, i) });
    mesh.Triangles.push_back({ 1, at(rings - 1, i), at(rings - 1, i + 1) });
    for (int ring = 1; ring + 1 < rings; ++ring)
    {
      mesh.Triangles.push_back({ at(ring, i), at(ring, i + 1), at(ring + 1, i + 1) });
      mesh.Triangles.push_back({ at(ring, i), at(ring + 1, i + 1), at(ring + 1, i) });
    }
  }
  return mesh;
}
}
