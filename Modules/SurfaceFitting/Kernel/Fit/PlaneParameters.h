// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

namespace knotwork
{
/// Parameters of points in space that lie over a plane: their coordinates in the plane of least
/// squares, from the centroid, in the unit of the points. The first axis is the direction of the
/// largest variance; signs make the largest entry of the axes positive, and the frame right-handed.
///
/// Whether the projection folds is not looked at: CheckLayers does.
/// @param points  n x 3, n >= 3.
/// @return EmptyInput below three points; NonFiniteInput naming the point; SingularSystem for
/// points on a line.
/// @complexity O(n).
Result<PointMatrix> PlaneParameters(const PointMatrix& points);
}
