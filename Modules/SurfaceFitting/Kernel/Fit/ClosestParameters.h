// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Parameters of the points of a surface that are closest to given points, of all its points: what
/// parameters of points are when they are not known.
/// @param surface  with a parameter domain; of its components the first ones count, as many as the
/// points have.
/// @param points  n x c, c in [1, 4].
/// @return DimensionMismatch; failures of ClosestPointSearch; Aborted.
Result<PointMatrix> ClosestParameters(
  const Spline<2>& surface, const PointMatrixView& points, int threads, ProgressCallback progress);
}
