// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BackMap.h"

namespace knotwork
{
/// BackMapMethod::Rbf and Hybrid. @pre the chart and the parameters are checked.
///
/// Thin-plate radial basis functions through the chart's points, and a spline that follows them:
/// its values at the Greville points of the net (Rbf) or its control points (Hybrid) are those of
/// the radial surface. A net by need is halved everywhere until the spline is within the tolerance
/// of the mesh, or follows the radial surface to a tenth of what that is off.
Result<BackMap> FitRadial(const ChartMesh& chart, const BackMapParams& params);
}
