// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FaceQuads.h"
#include "LogicalShape.h"

namespace knotwork
{
/// A grid between four sides (transfinite interpolation in the chart).
/// @param corners  first points of the sides, ascending; opposite sides have as many points.
/// @source  Gordon, Hall, Int. J. Numer. Meth. Eng. 7 (1973) 461.
FaceQuads MapRectangle(
  const FaceChart& chart, const ChartLoop& loop, const std::vector<int>& corners);

struct GridSizes
{
  double Length = 0.0; ///< of sides that run across a ring
  int LeastAcross = 1; ///< quadrilaterals across a ring
  int MaxQuads = 0;
};

/// Grids in a face of any shape but Other: one in a rectangle and around a ring; in a polygon one
/// at each corner, and all meet inside; in a disc one in the middle and four around it (an O-grid),
/// in a segment one at its shorter side and three around that. Where several grids meet, inner
/// points are the mean of their neighbours in the chart.
/// @return InvalidTopology: the sides' numbers of segments, all even, allow none; TooLarge, before
/// memory is taken.
/// @source  polygons: Li, McKeag, Armstrong, Comput. Methods Appl. Mech. Eng. 127 (1995) 157
/// (midpoint subdivision); inner points: Tutte, Proc. London Math. Soc. 13 (1963) 743.
Result<FaceQuads> MapShape(const FaceChart& chart, const std::vector<ChartLoop>& loops,
  const LogicalShape& shape, const GridSizes& sizes);
}
