// SPDX-License-Identifier: BSD-3-Clause
// Spaces, maps and samples for tests of fits and of their functionals.
#pragma once
#include "BasisEvaluation.h"
#include "BezierForm.h"
#include "FitSystem.h"
#include "HierarchicalSpace.h"
#include "Quadrature.h"
#include "SplineOracle.h"
#include "TensorSpace.h"

#include <Eigen/LU>
#include <Eigen/QR>

#include <cmath>

namespace knotwork::cases
{
/// Degrees 3, 2 (, 2), unequal knots, a domain that is not the unit one.
template <int Dim>
SplineSpacePtr<Dim> FitSpace()
{
  std::array<KnotVector, Dim> knots;
  knots[0] = KnotVector::Create(3, { 0.0, 0.0, 0.0, 0.0, 0.3, 0.5, 1.0, 1.0, 1.0, 1.0 }).Value;
  knots[1] = KnotVector::Uniform(2, 3, -1.0, 1.0);
  if constexpr (Dim == 3)
  {
    knots[2] = KnotVector::Uniform(2, 2, 0.0, 1.5);
  }
  return MakeTensorSpace<Dim>(knots).Value;
}

/// The same with a refined corner: two levels, truncated functions.
template <int Dim>
SplineSpacePtr<Dim> HierarchicalFitSpace()
{
  RefinementParams params;
  params.Extension = 2;
  return RefineElements<Dim>(FitSpace<Dim>(), { 0 }, params).Value;
}

/// Control points of the identity: Greville abscissae.
template <int Dim>
PointMatrix IdentityPoints(const SplineSpace<Dim>& space)
{
  const auto functions = DescribeFunctions(space);
  PointMatrix points(space.NumFunctions, Dim);
  for (Eigen::Index f = 0; f < points.rows(); ++f)
  {
    points.row(f) = Eigen::Map<const Eigen::RowVectorXd>(
      functions[static_cast<std::size_t>(f)].Greville.data(), Dim);
  }
  return points;
}

inline PointMatrix RandomPoints(
  oracle::Random& random, Eigen::Index rows, Eigen::Index columns, double lower, double upper)
{
  return PointMatrix::NullaryExpr(rows, columns, [&] { return random.In(lower, upper); });
}

/// The identity, bent, that random samples are to pull elsewhere.
template <int Dim>
struct FitCase
{
  Spline<Dim> Map;
  PointMatrix Points;
  FitSamples<Dim> Samples;

  explicit FitCase(const SplineSpacePtr<Dim>& space, unsigned seed, int samples)
  {
    oracle::Random random(seed);
    this->Map.Space = space;
    this->Map.ControlPoints =
      IdentityPoints(*space) + RandomPoints(random, space->NumFunctions, Dim, -0.05, 0.05);
    const ParametricBox<Dim> box = space->Domain();
    this->Samples.Parameters = RandomPoints(random, samples, Dim, 0.0, 1.0);
    for (Eigen::Index d = 0; d < Dim; ++d)
    {
      const double lower = box.Lower[static_cast<std::size_t>(d)];
      const double upper = box.Upper[static_cast<std::size_t>(d)];
      this->Samples.Parameters.col(d) =
        (this->Samples.Parameters.col(d).array() * (upper - lower) + lower).matrix();
    }
    this->Points = this->Samples.Parameters + RandomPoints(random, samples, Dim, 0.0, 0.1);
    this->Samples.Normals = RandomPoints(random, samples, Dim, -1.0, 1.0);
    this->Samples.Normals.rowwise().normalize();
    this->Samples.Residuals = this->Points - this->Values(this->Map.ControlPoints);
  }

  PointMatrix Values(const PointMatrix& controlPoints) const
  {
    Spline<Dim> map = this->Map;
    map.ControlPoints = controlPoints;
    EvaluationBatch batch;
    EvaluateParameters(MakeBezierForm(map), this->Samples.Parameters, {}, batch);
    return batch.Values;
  }
};
}
