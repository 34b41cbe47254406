// SPDX-License-Identifier: BSD-3-Clause
#include "MeshWeights.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace knotwork
{
Eigen::VectorXd VertexAreas(const DiscMesh& mesh)
{
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.NumPoints());
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const double area = 0.5 * LayTriangle(mesh, t).determinant();
    for (int c : mesh.Triangles[t])
    {
      areas[c] += area / 3.0;
    }
  }
  return areas;
}

Eigen::Matrix2d LayTriangle(const DiscMesh& mesh, std::size_t t)
{
  const auto& corners = mesh.Triangles[t];
  const Eigen::Vector3d a = mesh.Point(corners[0]);
  const Eigen::Vector3d ab = mesh.Point(corners[1]) - a;
  const Eigen::Vector3d ac = mesh.Point(corners[2]) - a;
  const double length = ab.norm();
  Eigen::Matrix2d sides;
  sides << length, ab.dot(ac) / length, 0.0, ab.cross(ac).norm() / length;
  return sides;
}

Eigen::Vector3d HalfCotangents(const DiscMesh& mesh, std::size_t t)
{
  const auto& corners = mesh.Triangles[t];
  Eigen::Vector3d cotangents;
  for (int k = 0; k < 3; ++k)
  {
    const Eigen::Vector3d at = mesh.Point(corners[static_cast<std::size_t>(k)]);
    const Eigen::Vector3d p = mesh.Point(corners[static_cast<std::size_t>((k + 1) % 3)]) - at;
    const Eigen::Vector3d q = mesh.Point(corners[static_cast<std::size_t>((k + 2) % 3)]) - at;
    cotangents[k] = 0.5 * p.dot(q) / p.cross(q).norm();
  }
  return cotangents;
}

Eigen::SparseMatrix<double> CotangentLaplacian(const DiscMesh& mesh)
{
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(9 * mesh.Triangles.size());
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const Eigen::Vector3d weights = HalfCotangents(mesh, t);
    for (int k = 0; k < 3; ++k)
    {
      const int a = mesh.Triangles[t][static_cast<std::size_t>((k + 1) % 3)];
      const int b = mesh.Triangles[t][static_cast<std::size_t>((k + 2) % 3)];
      entries.emplace_back(a, a, weights[k]);
      entries.emplace_back(b, b, weights[k]);
      entries.emplace_back(std::max(a, b), std::min(a, b), -weights[k]);
    }
  }
  Eigen::SparseMatrix<double> laplacian(mesh.NumPoints(), mesh.NumPoints());
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

Eigen::SparseMatrix<double> GraphLaplacian(const DiscMesh& mesh)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < mesh.NumPoints(); ++v)
  {
    const int begin = mesh.FanStart[static_cast<std::size_t>(v)];
    const int end = mesh.FanStart[static_cast<std::size_t>(v) + 1];
    entries.emplace_back(v, v, static_cast<double>(end - begin));
    for (int j = begin; j < end; ++j)
    {
      if (mesh.Fan[static_cast<std::size_t>(j)] < v)
      {
        entries.emplace_back(v, mesh.Fan[static_cast<std::size_t>(j)], -1.0);
      }
    }
  }
  Eigen::SparseMatrix<double> laplacian(mesh.NumPoints(), mesh.NumPoints());
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}
}
