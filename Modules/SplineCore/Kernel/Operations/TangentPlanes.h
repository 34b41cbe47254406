// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/UnstructuredSpace.h>

namespace knotwork
{
struct TangentPlaneResult
{
  Spline<2> Value;
  int NumVertices = 0; ///< at which the tangent plane is one now
  /// Extraordinary points that stay as they are: on features, where a facet is smoother than C^0,
  /// of degree 1, where cells would lie over each other in the plane, or where none was found.
  int NumLeftOut = 0;
  double LargestMove = 0.0; ///< of a control point
};

/// Makes the tangent plane of a surface one at every extraordinary point: the control points next
/// to it go into a plane, those around it so that the surface changes as little as can be in the
/// mean square; control points that two points have in common (degree 2) in turns. The space and
/// the order of approximation stay.
/// @param features  facets whose ends are left as they are, each seen from either cell.
/// @param vertices  that the surface was made to follow (SplineThroughVertices), coordinates first:
/// with degree 2 it comes nearer to their interpolation before. No rows: it does not.
/// @return EmptyInput, DimensionMismatch for a space without a mesh; SizeMismatch for fewer than 3
/// columns (the first three are coordinates, others stay), rational surfaces and vertices of other
/// numbers; NonFiniteInput; Spline::Check's codes.
Result<TangentPlaneResult> MakeTangentPlanes(const Spline<2>& surface,
  const std::vector<CellSide>& features = {}, const PointMatrix& vertices = {});
}
