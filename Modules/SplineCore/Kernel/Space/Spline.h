// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>

#include <variant>

namespace knotwork
{
/// A spline map: a space, control points, and weights when rational.
template <int Dim>
struct Spline
{
  SplineSpacePtr<Dim> Space;
  PointMatrix ControlPoints; ///< NumFunctions x c, Euclidean (not multiplied by weights), c >= 1
  Eigen::VectorXd Weights;   ///< NumFunctions positive values; size 0 when polynomial

  bool IsRational() const { return this->Weights.size() > 0; }
  int NumComponents() const { return static_cast<int>(this->ControlPoints.cols()); }

  /// Sizes fit, everything is finite, weights are positive; the detail names the first bad row.
  Status Check() const;
  /// NumFunctions x (c + 1) rows (w x, w) when rational, else the control points.
  PointMatrix HomogeneousPoints() const;
  /// Sets control points and weights from rows as HomogeneousPoints gives them.
  void SetHomogeneousPoints(const PointMatrixView& points, bool rational);
};

using AnySpline = std::variant<Spline<1>, Spline<2>, Spline<3>>;
}
