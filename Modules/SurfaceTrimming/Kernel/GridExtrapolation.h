// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BackMap.h"

namespace knotwork
{
/// BackMapMethod::Nurbs. @pre the chart and the parameters are checked.
///
/// Greville points of the net that lie in the chart get its points by linear interpolation in the
/// triangles. From there the known part grows, layer by layer: a grid point beside known ones takes
/// the polynomial through the last known ones of its row or column, the mean over the directions
/// from which it can. The spline interpolates the grid. A net by need is halved everywhere until
/// the tolerance is kept. Polynomials that are continued far fold the surface outside of the
/// chart: that is in the method.
/// @source  Ruiz, Mejia, Cadavid, Triangular mesh parameterization with trimmed surfaces, 2015.
/// @return SingularSystem when no grid point lies in the chart, or when values overflow.
Result<BackMap> FitExtrapolated(const ChartMesh& chart, const BackMapParams& params);
}
