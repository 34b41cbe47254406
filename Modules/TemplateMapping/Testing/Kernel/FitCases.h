// SPDX-License-Identifier: BSD-3-Clause
// Maps and samples for tests of fits.
#pragma once
#include "MapSpaces.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/TemplateMapping/FitSystem.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include <cmath>

namespace knotwork::cases
{
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
