// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/Spline.h>
#include <knotwork/SplineCore/Status.h>

/// Private to FitChain: cubic splines against polylines over the same parameters, piece by piece.
namespace knotwork::chains
{
inline constexpr int Degree = 3;
inline constexpr int MaxDepth = 40;
/// Spans of a length that rounding does not spoil.
inline constexpr double LeastSpan = 1e-9;

/// A cubic in Bernstein form, a coefficient a row.
using Cubic = Eigen::Matrix<double, Degree + 1, Eigen::Dynamic, Eigen::RowMajor>;
using PlaneCubic = Eigen::Matrix<double, Degree + 1, 2, Eigen::RowMajor>;

template <typename Matrix>
std::array<Matrix, 2> Halve(const Matrix& whole)
{
  std::array<Matrix, 2> halves{ whole, whole };
  const int columns = static_cast<int>(whole.cols());
  for (int c = 0; c < columns; ++c)
  {
    HalveBernstein(Degree, halves[1].data() + c, halves[0].data() + c, columns);
  }
  return halves;
}

/// A part of a knot span without a corner of the boundary inside.
struct CurvePiece
{
  int Segment = 0;
  int Span = 0;
  double Begin = 0.0;
  double End = 0.0;
  Cubic Curve;
};

std::vector<CurvePiece> CutAtCorners(const Spline<1>& curve, const std::vector<double>& corners);

Eigen::RowVectorXd PointAt(
  const std::vector<double>& parameters, const PointMatrix& points, int segment, double t);

/// Curve minus polyline on a piece.
Cubic Difference(
  const CurvePiece& piece, const std::vector<double>& parameters, const PointMatrix& points);

/// @param knots  inner ones, ascending.
Result<SplineSpacePtr<1>> MakeSpace(const std::vector<double>& knots);

/// Values at Gauss points of parts of the spans, and their weights.
struct Samples
{
  PointMatrix Parameters; ///< n x 1
  Eigen::VectorXd Weights;
  PointMatrix Values;
};

/// Least squares control points, the first and last one given.
Result<PointMatrix> ProjectOnto(const SplineSpace<1>& space, const Samples& samples,
  const Eigen::RowVectorXd& first, const Eigen::RowVectorXd& last);

void AppendGauss(double begin, double end, std::vector<double>& t, std::vector<double>& weights);
}
