// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMesh.h"

#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SurfaceRemeshing/SoupTopology.h>

#include <cmath>

namespace knotwork
{
namespace
{
void TurnOutward(BoundaryMesh& boundary)
{
  const PointMatrix centred =
    boundary.Mesh.Points.rowwise() - boundary.Mesh.Points.colwise().mean();
  const double volume = SignedVolume(centred, boundary.Mesh.Triangles);
  for (auto& corners : boundary.Mesh.Triangles)
  {
    if (volume < 0.0)
    {
      std::swap(corners[1], corners[2]);
    }
  }
  boundary.Volume = std::abs(volume);
}
}

Result<BoundaryMesh> MakeBoundaryMesh(const TessellationMesh& polygons)
{
  BoundaryMesh boundary;
  boundary.Mesh.Points = polygons.Points;
  boundary.Bound = polygons.Bound;
  for (std::size_t c = 0; c < polygons.Shapes.size(); ++c)
  {
    std::array<int, 4> q{};
    const auto begin = static_cast<std::size_t>(polygons.Offsets[c]);
    const auto n = static_cast<std::size_t>(polygons.Offsets[c + 1]) - begin;
    for (std::size_t i = 0; i < n; ++i)
    {
      q[i] = static_cast<int>(polygons.Connectivity[begin + i]);
    }
    const auto add = [&](int a, int b, int d)
    {
      boundary.Mesh.Triangles.push_back({ a, b, d });
      boundary.Patches.push_back(polygons.CellPatch[c]);
      boundary.Faces.push_back(polygons.CellSide.empty() ? 0 : polygons.CellSide[c]);
    };
    const auto distance = [&](int a, int b)
    { return (polygons.Points.row(a) - polygons.Points.row(b)).norm(); };
    if (n == 3)
    {
      add(q[0], q[1], q[2]);
    }
    else if (distance(q[0], q[2]) <= distance(q[1], q[3]))
    {
      add(q[0], q[1], q[2]);
      add(q[0], q[2], q[3]);
    }
    else
    {
      add(q[0], q[1], q[3]);
      add(q[1], q[2], q[3]);
    }
  }
  Status status = FinishBoundary(boundary);
  return status ? Result<BoundaryMesh>(std::move(boundary)) : Result<BoundaryMesh>(status);
}

Status FinishBoundary(BoundaryMesh& boundary)
{
  auto& triangles = boundary.Mesh.Triangles;
  if (triangles.empty())
  {
    return { ErrorCode::EmptyInput, "the spline has no boundary: all sides of its patches meet" };
  }
  std::vector<int> turned;
  const auto edge = OrientTriangles(triangles, turned);
  if (edge.first >= 0)
  {
    return { ErrorCode::InvalidTopology,
      "the surface has one side only, as seen at " +
        PointText(boundary.Mesh.Points.row(edge.first).data(), 3) + "; cut it there" };
  }
  boundary.Area = 0.0;
  for (const auto& corners : triangles)
  {
    boundary.Area += TriangleArea(boundary.Mesh.Points, corners);
  }
  const SoupDefects defects = FindDefects(triangles, boundary.Mesh.Points.rows());
  boundary.Closed = defects.OpenEdges.empty() && defects.TwistedEdges.empty();
  if (boundary.Closed)
  {
    TurnOutward(boundary);
  }
  return {};
}
}
