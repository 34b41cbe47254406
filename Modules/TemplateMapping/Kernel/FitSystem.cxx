// SPDX-License-Identifier: BSD-3-Clause
#include "FitSystem.h"

#include "DirectFit.h"
#include "GradientFit.h"

#include <string>

namespace knotwork
{
double QualityWeight(const FitWeights& weights, QualityKind kind)
{
  switch (kind)
  {
    case QualityKind::Uniformity:
      return weights.Uniformity;
    case QualityKind::Length:
      return weights.Length;
    case QualityKind::Orthogonality:
      return weights.Orthogonality;
    case QualityKind::Skewness:
      return weights.Skewness;
    case QualityKind::Eccentricity:
      return weights.Eccentricity;
    case QualityKind::Area:
      return weights.Area;
    case QualityKind::SelfIntersection:
      return weights.SelfIntersection;
  }
  return 0.0;
}

bool HasMeasures(const FitWeights& weights)
{
  bool any = false;
  for (int k = 0; k < NumQualityKinds; ++k)
  {
    const QualityKind kind = static_cast<QualityKind>(k);
    any = any || (!IsQuadratic(kind) && QualityWeight(weights, kind) > 0.0);
  }
  return any;
}

Status UndeterminedControlPoints()
{
  return { ErrorCode::SingularSystem,
    "some control points are determined by no sample; use a positive Tikhonov weight" };
}

template <int Dim>
FitSystem<Dim>::FitSystem(SplineSpacePtr<Dim> space, bool coupled, FitSolver solver, int threads)
  : Space(std::move(space))
{
  const bool isDirect = solver == FitSolver::Direct || (solver == FitSolver::Automatic && Dim == 2);
  this->Equations = isDirect ? MakeDirectFit<Dim>(this->Space, coupled, threads)
                             : MakeGradientFit<Dim>(this->Space, threads);
}

template <int Dim>
Result<PointMatrix> FitSystem<Dim>::Step(const FitSamples<Dim>& samples, const FitWeights& weights,
  const PointMatrix& present, const PointMatrix* guess)
{
  const Eigen::Index n = samples.Parameters.rows();
  const auto isFit = [](const PointMatrix& matrix, Eigen::Index rows)
  { return matrix.rows() == rows && (rows == 0 || matrix.cols() == Dim); };
  if (!isFit(samples.Parameters, n) || !isFit(samples.Residuals, n) ||
    (weights.Normal > 0.0 && !isFit(samples.Normals, n)))
  {
    return { ErrorCode::SizeMismatch, "parameters, residuals and normals of a fit" };
  }
  if (!isFit(present, this->Space->NumFunctions) ||
    (guess && !isFit(*guess, this->Space->NumFunctions)))
  {
    return { ErrorCode::SizeMismatch,
      "control points of a fit: the space has " + std::to_string(this->Space->NumFunctions) +
        " functions" };
  }
  if (!weights.Stiffness.empty() &&
    weights.Stiffness.size() != static_cast<std::size_t>(this->Space->NumElements()))
  {
    return { ErrorCode::SizeMismatch,
      "stiffness of a fit: the space has " + std::to_string(this->Space->NumElements()) +
        " elements" };
  }
  Result<PointMatrix> step = this->Equations->Step(samples, weights, present, guess);
  if (step && !step.Value.allFinite())
  {
    return { ErrorCode::SingularSystem, "the step is not finite" };
  }
  return step;
}

template class FitSystem<2>;
template class FitSystem<3>;
}
