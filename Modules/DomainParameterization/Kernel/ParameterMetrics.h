// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DomainParameterization.h"

namespace knotwork
{
/// Measures of a map's patches at samples^Dim equally spaced parameters each, ends included.
/// @param area  S (a patch), for the ratios.
/// @complexity tensor-product spaces: sums factorized direction by direction.
template <int Dim>
DomainMetrics MeasureMaps(const std::vector<Spline<Dim>>& patches, double area, int samples);

/// Places where the sides alone make det J <= 0: corners in 2D; corners and edges (64 points an
/// element, ends included) in 3D, at most one entry a corner or edge, the worst point of it.
/// @param given  sides that are fixed; places where others take part are not looked at.
template <int Dim>
std::vector<BoundaryFold> FindBoundaryFolds(
  const CompatibleBoundary<Dim>& boundary, const std::array<bool, 2 * Dim>& given);
}
