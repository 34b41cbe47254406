// SPDX-License-Identifier: BSD-3-Clause
// Control points that slide along a target, and move inside of it, until elements are valid,
// private to the kernel.
#pragma once
#include "FitTarget.h"

#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
struct UnfoldingParams
{
  int Rings = 2;   ///< of elements around those that are unfolded, whose control points may move
  int Threads = 0; ///< 0: all cores; the result does not depend on it
  ProgressCallback Progress;
};

/// What control points may do, one each.
struct ControlPointPlaces
{
  std::vector<char> IsHeld;      ///< it stays
  std::vector<char> IsOnSurface; ///< else it slides, where this is set, and else goes anywhere
  std::vector<TargetPart> Parts; ///< of the target, that it slides on
};

/// Minimizes, in rings of elements around some, the sum over samples of |J|^2 / c^(2 / Dim) + (d^2
/// + 1) / c by moves of the control points: J the derivatives of the map, in sizes of the element,
/// d = det J, of surfaces n . (S_u x S_v) seen along the target's normals n around the sample,
/// c = (d + sqrt(e^2 + d^2)) / 2, for smaller and smaller e. Each element of a surface has normals
/// of its own, so that it does not matter how much the surface bends. Control points on the surface
/// keep their offsets from the target. A patch of elements that has not fewer bad ones then stays
/// as it was.
/// @param elements  without a certificate. @param isReversed  of volumes: most elements are.
/// @return how many elements changed; Aborted, the target's errors.
/// @complexity some hundred evaluations of the patches.
/// @source  Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov, Foldover-free maps in 50 lines
/// of code, ACM TOG 40 (2021) 102 (the functional).
template <int Dim>
Result<int> Unfold(Spline<Dim>& spline, const std::vector<int>& elements, bool isReversed,
  const ControlPointPlaces& places, const FitTarget& target, const UnfoldingParams& params);
/// Moves control points by as much as their closest points on the target do, in their offsets from
/// these.
/// @param before  where they were. @param moved  rows of both. @param parts  of the target, one a
/// moved one. @return the target's errors.
Status KeepOffsets(const FitTarget& target, const PointMatrix& before,
  const std::vector<Eigen::Index>& moved, const std::vector<TargetPart>& parts, PointMatrix& now);
}
