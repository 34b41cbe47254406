// SPDX-License-Identifier: BSD-3-Clause
// Spaces and random points for tests of fits and of their functionals.
#pragma once
#include "SplineOracle.h"
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/TensorSpace.h>

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
}
