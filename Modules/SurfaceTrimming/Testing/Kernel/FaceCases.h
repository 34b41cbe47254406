// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SurfaceTrimming/TrimmedMesh.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>

/// Trimmed faces made in code, and what is true of any triangulation.
namespace knotwork::testing
{
inline constexpr double Pi = 3.14159265358979323846;
using Path = std::function<std::array<double, 2>(double)>; ///< of [0, 1] into a parameter plane

inline Spline<2> Shape(const ShapeParams& params)
{
  return std::get<Spline<2>>(MakeShape(params).Value.front());
}

/// (u, v, 0) on [0, width] x [0, height].
inline Spline<2> Plane(double width = 1.0, double height = 1.0)
{
  Spline<2> plane;
  plane.Space = MakeTensorSpace<2>(
    { KnotVector::Uniform(1, 1, 0.0, width), KnotVector::Uniform(1, 1, 0.0, height) })
                  .Value;
  plane.ControlPoints.resize(4, 3);
  plane.ControlPoints << 0, 0, 0, width, 0, 0, 0, height, 0, width, height, 0;
  return plane;
}

/// A cubic surface with hills of a height over [0, 1]^2, x = u, y = v.
inline Spline<2> Hills(unsigned seed, double height, int spans = 4)
{
  const KnotVector knots = KnotVector::Uniform(3, spans);
  Spline<2> surface;
  surface.Space = MakeTensorSpace<2>({ knots, knots }).Value;
  surface.ControlPoints.resize(surface.Space->NumFunctions, 3);
  surface.ControlPoints.leftCols(2) = GrevillePoints<2>(*surface.Space);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> in(-height, height);
  for (Eigen::Index i = 0; i < surface.ControlPoints.rows(); ++i)
  {
    surface.ControlPoints(i, 2) = in(random);
  }
  return surface;
}

inline PointMatrix Evaluate(const Spline<2>& surface, const PointMatrix& uv)
{
  EvaluationBatch batch;
  EvaluateParameters<2>(MakeBezierForm(surface), uv, { 0, 1 }, batch);
  return batch.Values;
}

/// Control points of the spline over knots that has given values at the Greville points.
inline PointMatrix Interpolate(const KnotVector& knots, const PointMatrix& values)
{
  const int n = knots.NumFunctions();
  const int p = knots.Degree();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  std::vector<double> row(static_cast<std::size_t>(p + 1));
  for (int i = 0; i < n; ++i)
  {
    const double u = knots.Greville(i);
    const int e = knots.FindElement(u);
    knots.EvaluateFunctions(e, u, 0, row.data());
    for (int k = 0; k <= p; ++k)
    {
      matrix(i, knots.Span(e) - p + k) = row[static_cast<std::size_t>(k)];
    }
  }
  return matrix.partialPivLu().solve(values);
}

/// An edge along a path: the spline over knots that goes through the path and through the surface
/// above it at the Greville points (the path itself when the splines have it).
inline TrimmingCurve Along(const Spline<2>& surface, const Path& path, const KnotVector& knots,
  int edge, std::array<int, 2> vertices, bool reversed = false)
{
  PointMatrix uv(knots.NumFunctions(), 2);
  for (int i = 0; i < knots.NumFunctions(); ++i)
  {
    const auto p = path(knots.Greville(i));
    uv.row(i) << p[0], p[1];
  }
  TrimmingCurve curve;
  curve.Curve.Space = MakeTensorSpace<1>({ knots }).Value;
  curve.Curve.ControlPoints = Interpolate(knots, Evaluate(surface, uv));
  curve.UV = Interpolate(knots, uv);
  curve.Edge = edge;
  curve.Vertices = vertices;
  curve.Reversed = reversed;
  return curve;
}

inline Path Straight(std::array<double, 2> a, std::array<double, 2> b)
{
  return [a, b](double t) -> std::array<double, 2> {
    return { (1.0 - t) * a[0] + t * b[0], (1.0 - t) * a[1] + t * b[1] };
  };
}

/// Adds a loop of straight edges with vertices of its own.
inline void AddPolygon(TrimmedModel& model, TrimmedFace& face,
  const std::vector<std::array<double, 2>>& corners, const KnotVector& knots = {})
{
  TrimmedLoop loop;
  const int n = static_cast<int>(corners.size());
  for (int i = 0; i < n; ++i)
  {
    const int next = (i + 1) % n;
    loop.Curves.push_back(Along(face.Surface,
      Straight(corners[static_cast<std::size_t>(i)], corners[static_cast<std::size_t>(next)]),
      knots, model.NumEdges + i, { model.NumVertices + i, model.NumVertices + next }));
  }
  model.NumEdges += n;
  model.NumVertices += n;
  face.Loops.push_back(std::move(loop));
}

/// Adds a loop that is one closed edge.
inline void AddClosed(
  TrimmedModel& model, TrimmedFace& face, const Path& path, const KnotVector& knots)
{
  TrimmedLoop loop;
  loop.Curves.push_back(
    Along(face.Surface, path, knots, model.NumEdges, { model.NumVertices, model.NumVertices }));
  ++model.NumEdges;
  ++model.NumVertices;
  face.Loops.push_back(std::move(loop));
}

/// What the triangles' ids say of the surface they make up.
struct MeshTopology
{
  int Euler = 0;
  int BoundaryLoops = 0;
  bool Manifold = true; ///< every edge has one or two triangles, and two of opposite direction
};

inline MeshTopology TopologyOf(const TrimmedMesh& mesh)
{
  std::map<std::array<int, 2>, int> directed;
  std::set<int> points;
  MeshTopology topology;
  for (const auto& corners : mesh.Triangles)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      topology.Manifold =
        ++directed[{ corners[i], corners[(i + 1) % 3] }] == 1 && topology.Manifold;
      points.insert(corners[i]);
    }
  }
  std::map<int, int> next;
  int edges = 0;
  for (const auto& entry : directed)
  {
    const auto [a, b] = entry.first;
    const bool inner = directed.count({ b, a }) > 0;
    edges += !inner || a < b ? 1 : 0;
    if (!inner)
    {
      topology.Manifold = next.emplace(a, b).second && topology.Manifold;
    }
  }
  while (!next.empty())
  {
    ++topology.BoundaryLoops;
    for (auto at = next.begin(); at != next.end();)
    {
      const int b = at->second;
      next.erase(at);
      at = next.find(b);
    }
  }
  topology.Euler =
    static_cast<int>(points.size()) - edges + static_cast<int>(mesh.Triangles.size());
  EXPECT_EQ(static_cast<Eigen::Index>(points.size()), mesh.Points.rows()); // all points are used
  return topology;
}

inline double Area(const TrimmedMesh& mesh)
{
  double area = 0.0;
  for (const auto& t : mesh.Triangles)
  {
    const Eigen::Vector3d a = mesh.Points.row(t[0]);
    const Eigen::Vector3d b = mesh.Points.row(t[1]);
    const Eigen::Vector3d c = mesh.Points.row(t[2]);
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}

/// Largest distance between random points of triangles and the surface at the same parameters.
inline double SampledDeviation(
  const TrimmedModel& model, const TrimmedMesh& mesh, int perTriangle = 8)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> in(0.0, 1.0);
  double largest = 0.0;
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    std::vector<std::array<double, 2>> uv;
    std::vector<Eigen::RowVector3d> points;
    for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
    {
      for (int k = 0; k < perTriangle && mesh.TriangleFace[t] == static_cast<int>(f); ++k)
      {
        double a = in(random);
        double b = in(random);
        if (a + b > 1.0)
        {
          a = 1.0 - a;
          b = 1.0 - b;
        }
        const std::array<double, 3> share{ 1.0 - a - b, a, b };
        std::array<double, 2> at{};
        Eigen::RowVector3d point = Eigen::RowVector3d::Zero();
        for (std::size_t i = 0; i < 3; ++i)
        {
          point += share[i] * mesh.Points.row(mesh.Triangles[t][i]);
          at[0] += share[i] * mesh.TriangleUV[t][i][0];
          at[1] += share[i] * mesh.TriangleUV[t][i][1];
        }
        uv.push_back(at);
        points.push_back(point);
      }
    }
    PointMatrix parameters(static_cast<Eigen::Index>(uv.size()), 2);
    for (std::size_t i = 0; i < uv.size(); ++i)
    {
      parameters.row(static_cast<Eigen::Index>(i)) << uv[i][0], uv[i][1];
    }
    const PointMatrix values = Evaluate(model.Faces[f].Surface, parameters);
    for (std::size_t i = 0; i < uv.size(); ++i)
    {
      largest = std::max(largest, (values.row(static_cast<Eigen::Index>(i)) - points[i]).norm());
    }
  }
  return largest;
}

/// Smallest cosine between the normals of triangles and of their corners.
inline double WorstNormal(const TrimmedMesh& mesh)
{
  double worst = 1.0;
  for (const auto& t : mesh.Triangles)
  {
    const Eigen::Vector3d a = mesh.Points.row(t[0]);
    const Eigen::Vector3d b = mesh.Points.row(t[1]);
    const Eigen::Vector3d c = mesh.Points.row(t[2]);
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    for (int corner : t)
    {
      worst = std::min(worst, normal.dot(Eigen::Vector3d(mesh.Normals.row(corner))));
    }
  }
  return worst;
}
}
