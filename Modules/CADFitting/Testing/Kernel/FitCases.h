// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshCases.h"
#include <knotwork/CADFitting/CADFit.h>
#include <knotwork/CADFitting/ImplicitTarget.h>
#include <knotwork/CADFitting/MeshTarget.h>
#include <knotwork/CADFitting/ModelTarget.h>
#include <knotwork/SplineCore/MeshTraces.h>
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SplineCore/TrimmedModel.h>

#include <cmath>
#include <map>

/// Meshes with places, and the shapes that they are fitted to.
namespace fits
{
using knotwork::CellMesh;
using knotwork::PointMatrix;

template <int Dim>
struct PlacedMesh
{
  CellMesh<Dim> Mesh;
  PointMatrix Points;
};

/// Cells whose corners are one where their places are (but for rounding).
template <int Dim>
class Placer
{
public:
  void AddCorner(const Eigen::RowVector3d& at)
  {
    std::array<long long, 3> key;
    for (int d = 0; d < 3; ++d)
    {
      key[static_cast<std::size_t>(d)] = std::llround(at[d] * 1e9);
    }
    const auto [entry, isNew] = this->Numbers.emplace(key, static_cast<int>(this->Places.size()));
    if (isNew)
    {
      this->Places.push_back(at);
    }
    this->Result.Mesh.Corners.push_back(entry->second);
  }
  PlacedMesh<Dim> Done()
  {
    this->Result.Mesh.NumPoints = static_cast<int>(this->Places.size());
    this->Result.Points.resize(this->Result.Mesh.NumPoints, 3);
    for (std::size_t i = 0; i < this->Places.size(); ++i)
    {
      this->Result.Points.row(static_cast<Eigen::Index>(i)) = this->Places[i];
    }
    return this->Result;
  }

private:
  std::map<std::array<long long, 3>, int> Numbers;
  std::vector<Eigen::RowVector3d> Places;
  PlacedMesh<Dim> Result;
};

/// A grid of n cells a direction, its points moved by a map of the unit square or cube.
template <int Dim, class Map>
void AddBlock(Placer<Dim>& placer, const std::array<int, Dim>& n, Map&& map)
{
  int cells = 1;
  for (const int count : n)
  {
    cells *= count;
  }
  for (int c = 0; c < cells; ++c)
  {
    for (int corner = 0; corner < (1 << Dim); ++corner)
    {
      double u[3] = { 0.0, 0.0, 0.0 };
      for (int d = 0, rest = c; d < Dim; rest /= n[static_cast<std::size_t>(d)], ++d)
      {
        const int count = n[static_cast<std::size_t>(d)];
        u[d] = static_cast<double>(rest % count + (corner >> d & 1)) / count;
      }
      placer.AddCorner(map(u));
    }
  }
}

/// The six sides of a unit cube without loops, as a body.
inline void AddSplineBox(knotwork::TrimmedModel& model, const Eigen::RowVector3d& lower, int body)
{
  for (int side = 0; side < 6; ++side)
  {
    knotwork::TrimmedFace& face = model.Faces.emplace_back();
    const auto knots = knotwork::KnotVector::Create(1, { 0.0, 0.0, 1.0, 1.0 }).Value;
    face.Surface.Space = knotwork::MakeTensorSpace<2>({ knots, knots }).Value;
    face.Surface.ControlPoints.resize(4, 3);
    for (int corner = 0; corner < 4; ++corner)
    {
      Eigen::RowVector3d x = Eigen::RowVector3d::Constant(side % 2);
      x[(side / 2 + 1) % 3] = corner & 1;
      x[(side / 2 + 2) % 3] = corner >> 1;
      face.Surface.ControlPoints.row(corner) = lower + x;
    }
    face.Reversed = side % 2 == 0;
    face.Body = body;
  }
}

inline double Angle(double u)
{
  return (2.0 * u - 1.0) * static_cast<double>(EIGEN_PI) / 4.0;
}

inline PlacedMesh<2> Sphere(int n)
{
  PlacedMesh<2> sphere;
  sphere.Mesh = meshes::CubeSphere(n);
  sphere.Points = meshes::CubeSpherePoints(sphere.Mesh, n);
  return sphere;
}

/// The unit disc of five blocks of n x n cells.
inline PlacedMesh<2> Disc(int n)
{
  Placer<2> placer;
  const auto inner = [](double u, double v)
  { return Eigen::RowVector3d(0.5 * std::tan(Angle(u)), 0.5 * std::tan(Angle(v)), 0.0); };
  AddBlock<2>(placer, { n, n }, [&](const double* u) { return inner(u[0], u[1]); });
  for (int side = 0; side < 4; ++side)
  {
    AddBlock<2>(placer, { n, n },
      [&](const double* u)
      {
        // seen from the middle: out along u[0], round along u[1]
        const double turn = side * static_cast<double>(EIGEN_PI) / 2.0;
        const double angle = Angle(u[1]);
        const double x = (1.0 - u[0]) * 0.5 + u[0] * std::cos(angle);
        const double y = (1.0 - u[0]) * 0.5 * std::tan(angle) + u[0] * std::sin(angle);
        return Eigen::RowVector3d(
          std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y, 0.0);
      });
  }
  return placer.Done();
}

/// The unit ball of seven blocks of n^3 cells.
inline PlacedMesh<3> Ball(int n)
{
  Placer<3> placer;
  AddBlock<3>(placer, { n, n, n },
    [&](const double* u)
    {
      return Eigen::RowVector3d(
        0.4 * std::tan(Angle(u[0])), 0.4 * std::tan(Angle(u[1])), 0.4 * std::tan(Angle(u[2])));
    });
  for (int side = 0; side < 6; ++side)
  {
    AddBlock<3>(placer, { n, n, n },
      [&](const double* u)
      {
        Eigen::RowVector3d direction;
        const int d = side / 2;
        const double sign = side % 2 == 0 ? -1.0 : 1.0;
        direction[d] = sign;
        // a right-handed frame of the two others and outward
        direction[(d + 1) % 3] = sign * std::tan(Angle(u[0]));
        direction[(d + 2) % 3] = std::tan(Angle(u[1]));
        return Eigen::RowVector3d((1.0 - u[2]) * 0.4 * direction + u[2] * direction.normalized());
      });
  }
  return placer.Done();
}

/// Two cells around the tube for one along it, radii 1 and 0.4.
inline PlacedMesh<2> Torus(int n)
{
  Placer<2> placer;
  AddBlock<2>(placer, { 2 * n, n },
    [](const double* u)
    {
      const double a = 2.0 * static_cast<double>(EIGEN_PI) * u[0];
      const double b = 2.0 * static_cast<double>(EIGEN_PI) * u[1];
      return Eigen::RowVector3d((1.0 + 0.4 * std::cos(b)) * std::cos(a),
        (1.0 + 0.4 * std::cos(b)) * std::sin(a), 0.4 * std::sin(b));
    });
  return placer.Done();
}

inline knotwork::FitTargetPtr Implicit(knotwork::ImplicitFunction function)
{
  knotwork::ImplicitTargetParams params;
  params.Lower = { -2.1, -2.1, -2.1 };
  params.Upper = { 2.1, 2.1, 2.1 };
  return knotwork::MakeImplicitTarget(std::move(function), params).Value;
}

/// x^2 / a^2 + y^2 / b^2 + z^2 / c^2 = 1.
inline knotwork::FitTargetPtr Ellipsoid(double a, double b, double c)
{
  return Implicit(
    [=](const double* x, double* gradient)
    {
      const double radii[] = { a, b, c };
      double value = -1.0;
      for (int d = 0; d < 3; ++d)
      {
        const double s = x[d] / radii[d];
        value += s * s;
        gradient[d] = 2.0 * s / radii[d];
      }
      return value;
    });
}

/// The cylinder of radius 1 around the third axis.
inline knotwork::FitTargetPtr Cylinder()
{
  return Implicit(
    [](const double* x, double* gradient)
    {
      gradient[0] = 2.0 * x[0];
      gradient[1] = 2.0 * x[1];
      gradient[2] = 0.0;
      return x[0] * x[0] + x[1] * x[1] - 1.0;
    });
}

inline knotwork::FitTargetPtr TorusTarget()
{
  return Implicit(
    [](const double* x, double* gradient)
    {
      const double round = std::hypot(x[0], x[1]);
      const double out = round - 1.0;
      gradient[0] = 2.0 * out * x[0] / round;
      gradient[1] = 2.0 * out * x[1] / round;
      gradient[2] = 2.0 * x[2];
      return out * out + x[2] * x[2] - 0.16;
    });
}

/// Points of a surface at Gauss points of its elements, with weights.
inline void GaussPoints(
  const knotwork::Spline<2>& surface, int count, PointMatrix& points, Eigen::VectorXd& weights)
{
  const auto rule = knotwork::MakeElementQuadrature<2>({ count, count });
  const int elements = surface.Space->NumElements();
  std::vector<int> numbers;
  for (int e = 0; e < elements; ++e)
  {
    numbers.insert(numbers.end(), static_cast<std::size_t>(rule.Local.rows()), e);
  }
  knotwork::EvaluationBatch batch;
  knotwork::EvaluateElements<2>(
    knotwork::MakeBezierForm(surface, 1), numbers, rule.Local.replicate(elements, 1), {}, batch);
  points = batch.Values;
  weights = rule.Weights.replicate(elements, 1) / elements;
}

/// Root mean square of a distance over the surface's parameters.
template <class Distance>
double MeanDistance(const knotwork::Spline<2>& surface, Distance&& distance)
{
  PointMatrix points;
  Eigen::VectorXd weights;
  GaussPoints(surface, 8, points, weights);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const double own = distance(Eigen::RowVector3d(points.row(i)));
    sum += weights[i] * own * own;
  }
  return std::sqrt(sum);
}

inline double FromUnitSphere(const Eigen::RowVector3d& x)
{
  return x.norm() - 1.0;
}

/// A box of n cells a direction, its boundary as triangles with sharp edges.
inline knotwork::TriangleMesh BoxTriangles(int n)
{
  knotwork::TriangleMesh triangles;
  const CellMesh<2> quads = meshes::CubeSphere(n);
  triangles.Points.resize(quads.NumPoints, 3);
  for (int c = 0; c < quads.NumCells(); ++c)
  {
    const int side = c / (n * n);
    const int* corners = quads.Cell(c);
    for (int corner = 0; corner < 4; ++corner)
    {
      const bool swap = (side % 2 == 0) == (side / 2 % 2 == 0);
      Eigen::RowVector3d x = Eigen::RowVector3d::Constant(side % 2 == 0 ? 0.0 : 1.0);
      x[side / 2 == 0 ? 1 : 0] = static_cast<double>(c % n + (corner >> (swap ? 1 : 0) & 1)) / n;
      x[side / 2 == 2 ? 1 : 2] =
        static_cast<double>(c / n % n + (corner >> (swap ? 0 : 1) & 1)) / n;
      triangles.Points.row(corners[corner]) = x;
    }
    triangles.Triangles.push_back({ corners[0], corners[1], corners[3] });
    triangles.Triangles.push_back({ corners[0], corners[3], corners[2] });
  }
  return triangles;
}
}
