// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include <array>
#include <vector>

namespace knotwork
{
struct CloudOutlineParams
{
  /// Side of the cells that tell where points are, unit of the parameters; 0: 2.5 times the mean
  /// spacing of the points.
  double CellSize = 0.0;
  /// Holes and bays up to this width are closed, unit of the parameters, in whole cells that fit
  /// into it; 0: two cells.
  double MaxGap = 0.0;
  /// Separate parts with fewer cells are left out, >= 1.
  int MinCells = 4;
};

/// One connected part of the plane where points are: triangles of occupied cells, counterclockwise.
struct OutlinePart
{
  PointMatrix Points; ///< n x 2
  std::vector<std::array<int, 3>> Triangles;
};

struct CloudOutline
{
  std::vector<OutlinePart> Parts; ///< the largest one first; discs with holes
  double CellSize = 0.0;
  double MaxGap = 0.0;
};

/// The region of the plane that points cover: cells of a grid over their box that hold points,
/// and all that are in no square of empty cells wider than the gap (morphological closing), without
/// places where cells touch in a corner only. Steps of its boundary are smoothed (weights 1/4, 1/2,
/// 1/4, twice, less where a triangle would turn over); points on the box stay.
/// @param points  n x 2. @return EmptyInput for fewer than three points or too few cells,
/// NonFiniteInput naming the point, InvalidParameter, SingularSystem for points on a line, TooLarge
/// above 1e7 cells.
/// @complexity O(points + cells), whatever the gap.
Result<CloudOutline> FindCloudOutline(
  const PointMatrixView& points, const CloudOutlineParams& params = {});
}
