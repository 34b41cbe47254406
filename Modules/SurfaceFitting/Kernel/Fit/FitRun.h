// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitDivision.h"

namespace knotwork
{
/// A fit with arguments that are right, in this process or in those of a division.
/// @param cloud  this process's part; without points it still has its columns.
/// @throws FitStop when another process fails.
Result<SurfaceFit> RunFit(const PointCloud& cloud, const FitParams& params, FitDivision& division);
}
