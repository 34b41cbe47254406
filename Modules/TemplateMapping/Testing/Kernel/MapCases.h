// SPDX-License-Identifier: BSD-3-Clause
// Maps of a box into space of as many dimensions.
#pragma once
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/LU>

#include <random>

namespace knotwork::cases
{
/// The identity over the unit square or cube: `elements` of degree p a direction.
template <int Dim>
Spline<Dim> IdentityMap(int degree, int elements)
{
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(degree, elements));
  Spline<Dim> map;
  map.Space = MakeTensorSpace<Dim>(knots).Value;
  map.ControlPoints = GrevillePoints(*map.Space);
  return map;
}

/// Control points moved by up to `size` a coordinate; those on the domain's boundary stay unless
/// they are asked for.
template <int Dim>
void Shake(Spline<Dim>& map, double size, unsigned seed, bool boundary)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> real(-size, size);
  const PointMatrix places = GrevillePoints(*map.Space);
  const ParametricBox<Dim> domain = map.Space->Domain();
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    bool isInner = true;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const double x = places(i, static_cast<Eigen::Index>(d));
      isInner = isInner && x > domain.Lower[d] && x < domain.Upper[d];
    }
    for (Eigen::Index d = 0; d < Dim && (isInner || boundary); ++d)
    {
      map.ControlPoints(i, d) += real(random);
    }
  }
}

/// det J at parameters, with respect to the domain's parameters.
template <int Dim>
Eigen::VectorXd Determinants(const BezierForm<Dim>& form, const PointMatrix& parameters)
{
  EvaluationBatch batch;
  if (!EvaluateParameters(form, parameters, { 1, 0 }, batch))
  {
    return {};
  }
  Eigen::VectorXd values(parameters.rows());
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    Eigen::Matrix<double, Dim, Dim> jacobian;
    for (Eigen::Index k = 0; k < Dim * Dim; ++k)
    {
      jacobian(k / Dim, k % Dim) = batch.First(i, k);
    }
    values(i) = jacobian.determinant();
  }
  return values;
}

/// All points of a regular grid over the unit box, first direction fastest.
template <int Dim>
PointMatrix GridOver(int points)
{
  Eigen::Index count = 1;
  for (int d = 0; d < Dim; ++d)
  {
    count *= points;
  }
  PointMatrix grid(count, Dim);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    Eigen::Index rest = i;
    for (Eigen::Index d = 0; d < Dim; ++d)
    {
      grid(i, d) = double(rest % points) / (points - 1);
      rest /= points;
    }
  }
  return grid;
}
}
