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
/// Whether a projection of points folds cannot be decided without a surface between them. What is
/// looked for are layers: the plane is divided into cells of some 16 points, and in a cell whose
/// points deviate from their own plane by more than the cell's side (RMS) they do not lie over it.
/// @param points  n x 3, n >= 3.
/// @return EmptyInput below three points; NonFiniteInput naming the point; SingularSystem for
/// points on a line; NotInSpace: points lie in layers in more than a twentieth of the cells.
/// @complexity O(n log n).
Result<PointMatrix> PlaneParameters(const PointMatrix& points);
}
