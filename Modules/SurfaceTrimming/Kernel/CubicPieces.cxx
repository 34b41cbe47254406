// SPDX-License-Identifier: BSD-3-Clause
#include "CubicPieces.h"

#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/SparseCholesky>

#include <algorithm>

namespace knotwork::chains
{
std::vector<CurvePiece> CutAtCorners(const Spline<1>& curve, const std::vector<double>& corners)
{
  const BezierForm<1> form = MakeBezierForm(curve, 1);
  std::vector<CurvePiece> pieces;
  int segment = 0;
  const int columns = curve.NumComponents();
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    const auto& box = form.Space->Elements[static_cast<std::size_t>(e)].Box;
    const double begin = box.Lower[0];
    const double end = box.Upper[0];
    double at = begin;
    while (at < end)
    {
      while (corners[static_cast<std::size_t>(segment) + 1] <= at)
      {
        ++segment;
      }
      CurvePiece piece;
      piece.Segment = segment;
      piece.Span = e;
      piece.Begin = at;
      piece.End = std::min(end, corners[static_cast<std::size_t>(segment) + 1]);
      piece.Curve.resize(Degree + 1, columns);
      for (int c = 0; c < columns; ++c)
      {
        const double* block = form.Block(e) + c * (Degree + 1);
        const auto part =
          BernsteinRestrict<1>({ Degree }, std::vector<double>(block, block + Degree + 1), 0,
            (piece.Begin - begin) / (end - begin), (piece.End - begin) / (end - begin));
        for (int i = 0; i <= Degree; ++i)
        {
          piece.Curve(i, c) = part[static_cast<std::size_t>(i)];
        }
      }
      at = piece.End;
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

Eigen::RowVectorXd PointAt(
  const std::vector<double>& parameters, const PointMatrix& points, int segment, double t)
{
  const double a = parameters[static_cast<std::size_t>(segment)];
  const double b = parameters[static_cast<std::size_t>(segment) + 1];
  const double s = (t - a) / (b - a);
  return (1.0 - s) * points.row(segment) + s * points.row(segment + 1);
}

Cubic Difference(
  const CurvePiece& piece, const std::vector<double>& parameters, const PointMatrix& points)
{
  Cubic difference = piece.Curve;
  const Eigen::RowVectorXd begin = PointAt(parameters, points, piece.Segment, piece.Begin);
  const Eigen::RowVectorXd end = PointAt(parameters, points, piece.Segment, piece.End);
  for (int i = 0; i <= Degree; ++i)
  {
    const double s = static_cast<double>(i) / Degree;
    difference.row(i) -= (1.0 - s) * begin + s * end;
  }
  return difference;
}

Result<SplineSpacePtr<1>> MakeSpace(const std::vector<double>& knots)
{
  std::vector<double> all(Degree + 1, 0.0);
  all.insert(all.end(), knots.begin(), knots.end());
  all.insert(all.end(), Degree + 1, 1.0);
  auto vector = KnotVector::Create(Degree, std::move(all));
  if (!vector)
  {
    return vector.Status;
  }
  return MakeTensorSpace<1>({ std::move(vector.Value) });
}

Result<PointMatrix> ProjectOnto(const SplineSpace<1>& space, const Samples& samples,
  const Eigen::RowVectorXd& first, const Eigen::RowVectorXd& last)
{
  auto basis = CollocationMatrix<1>(space, samples.Parameters, 1);
  if (!basis)
  {
    return basis.Status;
  }
  const Eigen::Index n = space.NumFunctions;
  PointMatrix points(n, samples.Values.cols());
  points.row(0) = first;
  points.row(n - 1) = last;
  const Eigen::SparseMatrix<double> columns = basis.Value;
  const Eigen::SparseMatrix<double> inner = columns.middleCols(1, n - 2);
  const PointMatrix rest = samples.Values - columns.col(0) * first - columns.col(n - 1) * last;
  const Eigen::SparseMatrix<double> weighted = inner.transpose() * samples.Weights.asDiagonal();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower,
    Eigen::NaturalOrdering<int>>
    solver(weighted * inner);
  if (solver.info() != Eigen::Success)
  {
    return { ErrorCode::SingularSystem, "least squares of a boundary curve" };
  }
  const Eigen::MatrixXd right = weighted * rest;
  points.middleRows(1, n - 2) = solver.solve(right);
  return points;
}

void AppendGauss(double begin, double end, std::vector<double>& t, std::vector<double>& weights)
{
  static const QuadratureRule rule = GaussLegendre(Degree + 1);
  for (std::size_t q = 0; q < rule.Nodes.size(); ++q)
  {
    t.push_back(begin + (end - begin) * rule.Nodes[q]);
    weights.push_back((end - begin) * rule.Weights[q]);
  }
}
}
