// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/MeshParameterization.h>

#include <Eigen/SVD>

#include <cmath>
#include <functional>
#include <random>

namespace knotwork
{
/// A mesh that is a picture of a flat one, triangle by triangle.
struct MeshCase
{
  TriangleMesh Mesh;
  PointMatrix Flat; ///< n x 2
};

/// Triangles of a jittered grid (seeded) whose centres lie in a domain; points that are not used
/// are left out. Triangles are counterclockwise.
inline MeshCase FlatCase(double x0, double x1, double y0, double y1, double edge,
  const std::function<bool(double, double)>& inside)
{
  const int nx = static_cast<int>(std::lround((x1 - x0) / edge));
  const int ny = static_cast<int>(std::lround((y1 - y0) / edge));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.2 * edge, 0.2 * edge);
  PointMatrix grid((nx + 1) * (ny + 1), 2);
  for (int j = 0; j <= ny; ++j)
  {
    for (int i = 0; i <= nx; ++i)
    {
      const double x = x0 + (x1 - x0) * i / nx;
      const double y = y0 + (y1 - y0) * j / ny;
      grid.row(j * (nx + 1) + i) << x + jitter(random), y + jitter(random);
    }
  }
  MeshCase result;
  std::vector<int> number(static_cast<std::size_t>(grid.rows()), -1);
  std::vector<int> used;
  const auto add = [&](std::array<int, 3> corners)
  {
    const Eigen::RowVector2d centre =
      (grid.row(corners[0]) + grid.row(corners[1]) + grid.row(corners[2])) / 3.0;
    if (!inside(centre[0], centre[1]))
    {
      return;
    }
    for (int& c : corners)
    {
      int& id = number[static_cast<std::size_t>(c)];
      if (id < 0)
      {
        id = static_cast<int>(used.size());
        used.push_back(c);
      }
      c = id;
    }
    result.Mesh.Triangles.push_back(corners);
  };
  for (int j = 0; j < ny; ++j)
  {
    for (int i = 0; i < nx; ++i)
    {
      const int a = j * (nx + 1) + i;
      const int b = a + nx + 1;
      add({ a, a + 1, b + 1 });
      add({ a, b + 1, b });
    }
  }
  result.Flat.resize(static_cast<Eigen::Index>(used.size()), 2);
  for (std::size_t k = 0; k < used.size(); ++k)
  {
    result.Flat.row(static_cast<Eigen::Index>(k)) = grid.row(used[k]);
  }
  result.Mesh.Points = PointMatrix::Zero(result.Flat.rows(), 3);
  result.Mesh.Points.leftCols(2) = result.Flat;
  return result;
}

/// Places the flat points in space.
inline void Lift(MeshCase& flat, const std::function<Eigen::RowVector3d(double, double)>& place)
{
  for (Eigen::Index i = 0; i < flat.Flat.rows(); ++i)
  {
    flat.Mesh.Points.row(i) = place(flat.Flat(i, 0), flat.Flat(i, 1));
  }
}

/// Rectangle with two holes in the plane z = 0.
inline MeshCase PlateWithHoles(double edge)
{
  return FlatCase(0.0, 2.0, 0.0, 1.0, edge,
    [](double x, double y)
    { return std::hypot(x - 0.5, y - 0.5) > 0.2 && std::hypot(x - 1.4, y - 0.4) > 0.25; });
}

/// The same rolled onto a cylinder of radius 0.5: more than half of a turn.
inline MeshCase CylinderWithHoles(double edge)
{
  MeshCase result = PlateWithHoles(edge);
  Lift(result,
    [](double x, double y)
    { return Eigen::RowVector3d(0.5 * std::cos(2.0 * x), 0.5 * std::sin(2.0 * x), y); });
  return result;
}

/// A stroke in the shape of an S (two arcs of three quarters), isometrically on a cone.
inline MeshCase SOnCone(double edge)
{
  const auto arc = [](double x, double y, double cx, double cy, double from)
  {
    const double pi = std::acos(-1.0);
    double angle = std::atan2(y - cy, x - cx) - from;
    angle -= 2.0 * pi * std::floor(angle / (2.0 * pi));
    return angle < 1.5 * pi && std::abs(std::hypot(x - cx, y - cy) - 1.0) < 0.3;
  };
  MeshCase result = FlatCase(1.5, 4.5, -2.5, 2.5, edge,
    [arc](double x, double y)
    { return arc(x, y, 3.0, 1.0, 0.0) || arc(x, y, 3.0, -1.0, std::acos(-1.0)); });
  Lift(result,
    [](double x, double y)
    {
      const double slope = 0.5; // sine of half the opening angle
      const double r = std::hypot(x, y);
      const double turn = std::atan2(y, x) / slope;
      return Eigen::RowVector3d(r * slope * std::cos(turn), r * slope * std::sin(turn),
        -r * std::sqrt(1.0 - slope * slope));
    });
  return result;
}

/// A hill: not developable.
inline MeshCase Hill(double edge, double height)
{
  MeshCase result = PlateWithHoles(edge);
  Lift(result,
    [height](double x, double y)
    {
      return Eigen::RowVector3d(
        x, y, height * std::exp(-6.0 * ((x - 1.0) * (x - 1.0) + (y - 0.5) * (y - 0.5))));
    });
  return result;
}

/// Root mean square distance of two plane point sets after the best rotation, reflection and
/// translation, over the diagonal of the second one's box.
inline double RigidError(const PointMatrix& points, const PointMatrix& truth)
{
  const Eigen::RowVector2d centre = points.colwise().mean();
  const Eigen::RowVector2d trueCentre = truth.colwise().mean();
  const PointMatrix a = points.rowwise() - centre;
  const PointMatrix b = truth.rowwise() - trueCentre;
  const Eigen::Matrix2d cross = a.transpose() * b;
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double square = (a * svd.matrixU() * svd.matrixV().transpose() - b).squaredNorm();
  const double diameter = (truth.colwise().maxCoeff() - truth.colwise().minCoeff()).norm();
  return std::sqrt(square / static_cast<double>(points.rows())) / diameter;
}
}
