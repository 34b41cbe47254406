// SPDX-License-Identifier: BSD-3-Clause
#include "Spline.h"

#include "Numbers.h"

#include <cmath>

namespace knotwork
{
template <int Dim>
Status Spline<Dim>::Check() const
{
  if (!this->Space)
  {
    return { ErrorCode::EmptyInput, "the spline has no space" };
  }
  const Eigen::Index n = this->Space->NumFunctions;
  if (this->ControlPoints.rows() != n || this->ControlPoints.cols() < 1)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(this->ControlPoints.rows()) + " x " +
        std::to_string(this->ControlPoints.cols()) + " control points for " + std::to_string(n) +
        " functions" };
  }
  if (this->IsRational() && this->Weights.size() != n)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(this->Weights.size()) + " weights for " + std::to_string(n) + " functions" };
  }
  for (Eigen::Index i = 0; i < n; ++i)
  {
    if (!this->ControlPoints.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput, "control point " + std::to_string(i) };
    }
    if (!AllWithinLimit(this->ControlPoints.row(i)))
    {
      return { ErrorCode::TooLarge, "control point " + std::to_string(i) + ": " + BeyondLimit() };
    }
    if (this->IsRational() && !(this->Weights[i] > 0.0 && std::isfinite(this->Weights[i])))
    {
      return { ErrorCode::InvalidWeight, "weight of control point " + std::to_string(i) };
    }
  }
  return {};
}

template <int Dim>
PointMatrix Spline<Dim>::HomogeneousPoints() const
{
  if (!this->IsRational())
  {
    return this->ControlPoints;
  }
  PointMatrix points(this->ControlPoints.rows(), this->ControlPoints.cols() + 1);
  points.leftCols(this->ControlPoints.cols()) =
    this->ControlPoints.array().colwise() * this->Weights.array();
  points.rightCols(1) = this->Weights;
  return points;
}

template <int Dim>
void Spline<Dim>::SetHomogeneousPoints(const PointMatrixView& points, bool rational)
{
  if (!rational)
  {
    this->ControlPoints = points;
    this->Weights.resize(0);
    return;
  }
  this->Weights = points.rightCols(1);
  this->ControlPoints =
    points.leftCols(points.cols() - 1).array().colwise() / this->Weights.array();
}

template struct Spline<1>;
template struct Spline<2>;
template struct Spline<3>;
}
