// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DomainParameterization.h"

namespace knotwork
{
/// Measures of a map at samples^Dim equally spaced parameters of its domain, ends included.
/// @param area  S, for the ratios.
/// @complexity tensor-product spaces: sums factorized direction by direction.
template <int Dim>
DomainMetrics MeasureMap(const Spline<Dim>& map, double area, int samples);

/// Places where the sides alone make det J <= 0: corners in 2D; corners and edges (64 points an
/// element, ends included) in 3D, at most one entry a corner or edge, the worst point of it.
template <int Dim>
std::vector<BoundaryFold> FindBoundaryFolds(const CompatibleBoundary<Dim>& boundary);
}
