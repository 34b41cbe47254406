// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceLayer.h"

#include <Eigen/Geometry>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}
}

std::vector<int> EdgesOfTwoFaces(const SurfaceMesh& surface, const MeshClassification& parts)
{
  std::vector<int> edges;
  for (std::size_t e = 0; e < surface.Edges.size(); ++e)
  {
    const auto [a, b] = surface.QuadsOf[e];
    if (parts.CurveOf[e] < 0 && b >= 0 && surface.Facets[At(a)].Side >= 0 &&
      surface.Facets[At(a)].Cell == surface.Facets[At(b)].Cell)
    {
      edges.push_back(static_cast<int>(e));
    }
  }
  return edges;
}

LayeredMesh AddLayer(
  const CellMesh<3>& mesh, const SurfaceMesh& surface, const PointMatrix& points, double share)
{
  LayeredMesh layered;
  std::vector<int> below(At(mesh.NumPoints), -1);
  layered.Mesh.NumPoints = mesh.NumPoints;
  for (const int point : surface.Points)
  {
    below[At(point)] = layered.Mesh.NumPoints++;
  }
  PointMatrix normals = PointMatrix::Zero(mesh.NumPoints, 3);
  // outward where the cells are right-handed; else inward
  double volume = 0.0;
  const Eigen::RowVector3d middle = points.colwise().mean();
  for (const auto& quad : surface.Quads)
  {
    const Eigen::RowVector3d a = points.row(quad[2]) - points.row(quad[0]);
    const Eigen::RowVector3d b = points.row(quad[3]) - points.row(quad[1]);
    const Eigen::RowVector3d normal = a.cross(b);
    volume += normal.dot(points.row(quad[0]) - middle);
    for (const int point : quad)
    {
      normals.row(point) += normal;
    }
  }
  const std::vector<double> lengths = EdgeLengthsAt(surface, points);
  layered.Points.resize(layered.Mesh.NumPoints, 3);
  layered.Points.topRows(points.rows()) = points;
  for (const int point : surface.Points)
  {
    const Eigen::RowVector3d inward = (volume > 0.0 ? -1.0 : 1.0) * normals.row(point).normalized();
    layered.Points.row(below[At(point)]) = points.row(point) + share * lengths[At(point)] * inward;
  }
  layered.Mesh.Corners = mesh.Corners;
  for (int& corner : layered.Mesh.Corners)
  {
    corner = below[At(corner)] >= 0 ? below[At(corner)] : corner;
  }
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    layered.CellOf.push_back(c);
  }
  for (std::size_t q = 0; q < surface.Quads.size(); ++q)
  {
    const auto& quad = surface.Quads[q];
    const std::array<int, 4> outer{ quad[0], quad[1], quad[3], quad[2] };
    for (const int point : outer)
    {
      layered.Mesh.Corners.push_back(below[At(point)]);
    }
    layered.Mesh.Corners.insert(layered.Mesh.Corners.end(), outer.begin(), outer.end());
    layered.CellOf.push_back(surface.Facets[q].Cell);
  }
  return layered;
}
}
