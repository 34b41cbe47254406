// SPDX-License-Identifier: BSD-3-Clause
#include "CurveInterpolation.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/TensorSpace.h>

namespace knotwork
{
Status CurveInterpolation::Prepare(const SplineSpace<1>& space)
{
  this->At = GrevillePoints<1>(space);
  auto matrix = CollocationMatrix<1>(space, this->At, 1);
  if (!matrix)
  {
    return matrix.Status;
  }
  this->Values = matrix.Value;
  this->Inverse.compute(this->Values);
  return this->Inverse.info() == Eigen::Success
    ? Status()
    : Status(ErrorCode::SingularSystem, "interpolation of a curve");
}

PointMatrix CurveInterpolation::Solve(const PointMatrix& values) const
{
  const Eigen::MatrixXd right = values;
  const Eigen::MatrixXd points = this->Inverse.solve(right);
  return points;
}

PointMatrix CurvePoints(const Spline<1>& curve, const PointMatrix& parameters)
{
  EvaluationParams params;
  params.Threads = 1;
  EvaluationBatch batch;
  EvaluateParameters<1>(MakeBezierForm<1>(curve, 1), parameters, params, batch);
  return batch.Values;
}

PointMatrix ParametersInSpans(const KnotVector& knots, int perSpan)
{
  PointMatrix at(knots.NumElements() * perSpan, 1);
  for (Eigen::Index i = 0; i < at.rows(); ++i)
  {
    const auto e = static_cast<std::size_t>(i / perSpan);
    const double s = (static_cast<double>(i % perSpan) + 0.5) / perSpan;
    at(i, 0) = (1.0 - s) * knots.Breaks()[e] + s * knots.Breaks()[e + 1];
  }
  return at;
}
}
