// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/DomainParameterization/DomainParameterization.h>
#include <knotwork/DomainParameterization/PatchLayout.h>

namespace knotwork
{
/// Ratios of Metrics, and det J of History, are over the mean area (volume) of a patch; Area is
/// that of the domain.
template <int Dim>
struct LayoutParameterization : DomainReport
{
  GluedMap<Dim> Map; ///< patches as in Layout.Corners
  GluedMap<Dim> InitialMap;
  CompatibleLayout<Dim> Layout;
};

/// Spline maps of all patches of a layout onto the domain that its sides enclose, together: what
/// ParameterizeDomain does for one patch, with control points and weights of sides between patches
/// and of inner vertices among the unknowns. The functional is the sum over the patches, S of the
/// uniformity the mean area (volume) of a patch, so that patches of one size are best. Neighbours
/// share control points bit for bit (C0); sides on the boundary are never moved.
///
/// First maps. Coons: inner vertices as the layout has them, sides between patches straight unless
/// a curve (face) is given, every patch a Boolean sum. Spring: every control point that may move is
/// the mean of its neighbours. Harmonic: the least int |grad|^2 (the Laplacian itself is not square
/// integrable across C0 sides).
///
/// Refinement, when no valid map is found, halves all elements of all patches, up to 4000
/// functions.
/// @param params  GapTolerance is not looked at, that of layoutParams is.
/// @return failures of MakeCompatible; InvalidParameter naming an option; Aborted.
template <int Dim>
Result<LayoutParameterization<Dim>> ParameterizeLayout(const PatchLayout<Dim>& layout,
  const LayoutParams& layoutParams = {}, const DomainParams& params = {},
  const ProgressCallback& progress = {});
}
