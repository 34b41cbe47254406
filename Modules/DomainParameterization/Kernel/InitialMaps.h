// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DomainBoundary.h"
#include "DomainParameterization.h"
#include <knotwork/SplineCore/TensorLaplacian.h>

namespace knotwork
{
/// The map's space, boundary control points and weights set, inner ones zero (weights one).
template <int Dim>
Spline<Dim> MapOfBoundary(const CompatibleBoundary<Dim>& boundary);

/// True for control points of the boundary of a tensor-product space.
template <int Dim>
std::vector<bool> BoundaryFunctions(const SplineSpace<Dim>& space);

/// Weights of the inner control points, from those of the boundary; nothing of polynomial maps.
template <int Dim>
void FillWeights(Spline<Dim>& map, InitialWeights kind = InitialWeights::Blended);

// First maps: inner control points from those of the boundary, which stay as they are, as do all
// weights. Map: as MapOfBoundary makes it. One more is in HarmonicMaps.h.

/// Boolean sum at the Greville abscissae, I - prod (I - L_k) with L_k the linear interpolation
/// between opposite sides. Reproduces multilinear maps. Also of curves (linear between the ends)
/// and of surfaces in space.
/// @param steepness  a direction, >= 1: L_k weighs its ends by (1 - a)^m and a^m, so that for a
///                   large m an end acts near itself only. Good for bars: 1 across, more along.
template <int Dim>
void FillCoons(Spline<Dim>& map, const std::array<int, Dim>& steepness);
template <int Dim>
void FillCoons(Spline<Dim>& map);

/// Every inner control point is the mean of its 2 Dim neighbours.
/// @return SingularSystem never in exact arithmetic.
template <int Dim>
Status FillSpring(Spline<Dim>& map);

/// Minimizes int |Laplacian of the map|^2 over the parameter domain, or int |grad|^2 when a degree
/// is 1; of rational maps with their weights. Reproduces harmonic maps of the space.
template <int Dim>
Status FillHarmonic(Spline<Dim>& map);
}
