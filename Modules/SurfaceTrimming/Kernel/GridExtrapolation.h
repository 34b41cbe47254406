// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BackMap.h"

namespace knotwork
{
/// BackMapMethod::Nurbs and ContinuedLines. @pre the chart and the parameters are checked.
///
/// A net by need is halved everywhere until the tolerance is kept; the best net is the result.
/// @return failures of ContinueSurface and ContinueLines.
Result<BackMap> FitExtrapolated(const ChartMesh& chart, const BackMapParams& params);
}
