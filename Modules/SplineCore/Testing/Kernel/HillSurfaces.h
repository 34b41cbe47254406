// SPDX-License-Identifier: BSD-3-Clause
// Surfaces and points large enough for several chunks of everything that runs in parallel.
#pragma once
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/LRRefinement.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <cmath>

namespace knotwork::testing
{
/// z = sin 5x cos 4y at the Greville points, x from `left` on.
inline Spline<2> Hills(SpaceKind kind, double left = 0.0)
{
  constexpr int elements = 40;
  const auto tensor = MakeTensorSpace<2>(
    { KnotVector::Uniform(2, elements, left, left + 1), KnotVector::Uniform(2, elements, 0, 1) });
  Spline<2> surface;
  surface.Space = tensor.Value;
  const PointMatrix at = GrevillePoints(*surface.Space);
  surface.ControlPoints.resize(at.rows(), 3);
  for (Eigen::Index i = 0; i < at.rows(); ++i)
  {
    surface.ControlPoints.row(i) << at(i, 0), at(i, 1),
      std::sin(5.0 * at(i, 0)) * std::cos(4.0 * at(i, 1));
  }
  if (kind == SpaceKind::LocallyRefined)
  {
    return InsertSegments(surface, { { 0, left + 0.51, 0, 0.5, 1 } }, 1).Value;
  }
  if (kind == SpaceKind::Hierarchical)
  {
    const auto finer =
      MakeHierarchicalSpace<2>(surface.Space->Knots, { { 1, { 0, 0 }, { elements, elements } } });
    return TransferToRefined<2>(surface, finer.Value).Value;
  }
  return surface;
}

inline PointMatrix GridPoints(int n, int columns)
{
  PointMatrix points = PointMatrix::Zero(n * n, columns);
  for (int i = 0; i < n * n; ++i)
  {
    points(i, 0) = (i % n + 0.5) / n;
    points(i, 1) = (i / n + 0.5) / n;
  }
  return points;
}
}
