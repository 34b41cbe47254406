// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DomainParameterization.h"

/// What a boundary alone makes impossible, whatever the interior.
namespace knotwork
{
/// Places where the sides alone make det J < 0, beyond what rounding of their coordinates can be:
/// corners in 2D; corners and edges (64 points an element, ends included) in 3D, at most one entry
/// a corner or edge, the worst point of it; plane faces that turn over. A tangent of length zero is
/// no fold.
/// @param given  sides that are fixed; places where others take part are not looked at.
template <int Dim>
std::vector<BoundaryFold> FindBoundaryFolds(
  const CompatibleBoundary<Dim>& boundary, const std::array<bool, 2 * Dim>& given);

/// A place where the boundary crosses itself, proved; none when there is none or none was found.
/// In the plane: ProveSimpleCurves. In space: faces are searched along sampled lines of theirs, and
/// a crossing is proved by Brouwer's theorem.
/// @return Aborted is not among the failures: milliseconds.
template <int Dim>
Result<std::vector<BoundaryCrossing>> FindBoundaryCrossings(
  const CompatibleBoundary<Dim>& boundary, int threads);

/// The sentence of a crossing. @param sides  of the map.
template <int Dim>
std::string CrossingText(
  const CompatibleBoundary<Dim>& boundary, const std::array<int, 2>& sides, const double* position);
}
