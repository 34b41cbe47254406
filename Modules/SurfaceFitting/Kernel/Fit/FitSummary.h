// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "PointDistances.h"

namespace knotwork
{
/// What the distances of the points of all processes are like: the errors, counts, likelihood and
/// information criteria of a row of the table. @param errors  of all elements.
FitIteration SummarizeFit(const SplineSpace<2>& space, const PointCloud& cloud,
  const FitPoints& points, const std::vector<ElementErrors>& errors, const FitDivision& division,
  int threads);
}
