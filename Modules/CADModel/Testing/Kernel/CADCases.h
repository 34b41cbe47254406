// SPDX-License-Identifier: BSD-3-Clause
// Trimmed models whose area, volume and topology are known.
#pragma once
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SplineCore/TrimmedModel.h>
#include <knotwork/SurfaceTrimming/TrimmedMesh.h>

#include <Eigen/Geometry>
#include <Eigen/SparseLU>
#include <cmath>
#include <functional>

namespace knotwork::testing
{
inline constexpr double Pi = 3.14159265358979323846;

/// z = height * sin(pi x) * sin(pi y) at the Greville points of n x n elements on [0, 1]^2.
inline Spline<2> WavySheet(int elements, double height, double size = 1.0)
{
  const KnotVector knots = KnotVector::Uniform(3, elements, 0.0, size);
  Spline<2> sheet;
  sheet.Space = MakeTensorSpace<2>({ knots, knots }).Value;
  const PointMatrix uv = GrevillePoints<2>(*sheet.Space);
  sheet.ControlPoints.resize(uv.rows(), 3);
  sheet.ControlPoints.leftCols(2) = uv;
  for (Eigen::Index i = 0; i < uv.rows(); ++i)
  {
    sheet.ControlPoints(i, 2) =
      height * std::sin(Pi * uv(i, 0) / size) * std::sin(Pi * uv(i, 1) / size);
  }
  return sheet;
}

/// The spline of a space that has given values at the Greville points.
inline PointMatrix Interpolate(
  const SplineSpace<1>& space, const std::function<Eigen::VectorXd(double)>& function)
{
  const PointMatrix at = GrevillePoints<1>(space);
  PointMatrix values(at.rows(), function(at(0, 0)).size());
  for (Eigen::Index i = 0; i < at.rows(); ++i)
  {
    values.row(i) = function(at(i, 0)).transpose();
  }
  const Eigen::SparseMatrix<double> matrix = CollocationMatrix<1>(space, at, 0).Value;
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::MatrixXd right = values;
  const Eigen::MatrixXd points = solver.solve(right);
  return points;
}

/// A trimming curve along a path in the parameter plane, cubic; the curve in space interpolates the
/// path's image. Ends of closed paths meet.
inline TrimmingCurve CurveOnSurface(const Spline<2>& surface,
  const std::function<Eigen::Vector2d(double)>& path, int elements, int edge, int begin, int end)
{
  TrimmingCurve curve;
  curve.Curve.Space = MakeTensorSpace<1>({ KnotVector::Uniform(3, elements) }).Value;
  curve.UV = Interpolate(*curve.Curve.Space, path);
  const BezierForm<2> form = MakeBezierForm<2>(surface);
  const Spline<1> pcurve{ curve.Curve.Space, curve.UV, {} };
  const BezierForm<1> parameters = MakeBezierForm<1>(pcurve);
  curve.Curve.ControlPoints = Interpolate(*curve.Curve.Space,
    [&](double t) -> Eigen::VectorXd
    {
      EvaluationBatch uv;
      EvaluationBatch point;
      EvaluateParameters<1>(parameters, PointMatrix::Constant(1, 1, t), {}, uv);
      EvaluateParameters<2>(form, uv.Values, {}, point);
      return point.Values.row(0).transpose();
    });
  curve.Edge = edge;
  curve.Vertices = { begin, end };
  return curve;
}

inline std::function<Eigen::Vector2d(double)> Segment(Eigen::Vector2d from, Eigen::Vector2d to)
{
  return [=](double t) -> Eigen::Vector2d { return (1.0 - t) * from + t * to; };
}

/// A circle from +u; clockwise when the radius is negative.
inline std::function<Eigen::Vector2d(double)> Circle(Eigen::Vector2d centre, double radius)
{
  return [=](double t) -> Eigen::Vector2d
  {
    const double angle = 2.0 * Pi * (t == 1.0 ? 0.0 : t);
    return centre + Eigen::Vector2d(std::abs(radius) * std::cos(angle), radius * std::sin(angle));
  };
}

/// The sheet over [0, size]^2 with its four sides as loop and round holes of radius 0.1 size.
inline TrimmedModel SheetWithHoles(
  int elements, double height, int holes, int curveElements, double size = 1.0)
{
  TrimmedModel model;
  TrimmedFace face;
  face.Surface = WavySheet(elements, height, size);
  const Eigen::Vector2d corners[4] = { { 0, 0 }, { size, 0 }, { size, size }, { 0, size } };
  TrimmedLoop outer;
  for (int s = 0; s < 4; ++s)
  {
    outer.Curves.push_back(CurveOnSurface(
      face.Surface, Segment(corners[s], corners[(s + 1) % 4]), curveElements, s, s, (s + 1) % 4));
  }
  face.Loops.push_back(outer);
  for (int h = 0; h < holes; ++h)
  {
    const Eigen::Vector2d centre((h + 0.5) * size / holes, 0.5 * size);
    TrimmedLoop hole;
    hole.Curves.push_back(CurveOnSurface(
      face.Surface, Circle(centre, -0.3 * size / (holes + 2)), curveElements, 4 + h, 4 + h, 4 + h));
    face.Loops.push_back(hole);
  }
  model.NumEdges = 4 + holes;
  model.NumVertices = 4 + holes;
  model.Faces.push_back(face);
  return model;
}

/// Faces without loops of the surfaces of a shape.
inline TrimmedModel NaturalFaces(const ShapeParams& params)
{
  TrimmedModel model;
  for (const AnySpline& patch : MakeShape(params).Value)
  {
    TrimmedFace face;
    face.Surface = std::get<Spline<2>>(patch);
    model.Faces.push_back(face);
  }
  return model;
}

inline double AreaOf(const TrimmedMesh& mesh)
{
  double area = 0.0;
  for (const std::array<int, 3>& triangle : mesh.Triangles)
  {
    const Eigen::RowVector3d a = mesh.Points.row(triangle[0]);
    const Eigen::RowVector3d ab = mesh.Points.row(triangle[1]) - a;
    const Eigen::RowVector3d ac = mesh.Points.row(triangle[2]) - a;
    area += 0.5 * ab.cross(ac).norm();
  }
  return area;
}
}
