// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitDivision.h"
#include "FitPoints.h"
#include "FitSpaces.h"

namespace knotwork
{
/// Features of every element of the state's space. @pre points.Distance is measured.
/// @param height  the component that surface features are about.
/// @complexity O(elements + points).
FitFeatures ElementFeatures(const FitState& state, const FitPoints& points, Eigen::Index height,
  const FitDivision& division, int threads);

/// The same of size x size equal cells of the domain, first parameter fastest. @pre size > 0.
FitFeatures GridFeatures(
  const FitState& state, const FitPoints& points, Eigen::Index height, int size, int threads);
}
