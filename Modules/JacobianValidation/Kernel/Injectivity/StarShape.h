// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CellGluing.h"

/// Private to the injectivity proof: closed surfaces that all of can be seen from one point.
namespace knotwork
{
/// Which components of the boundary of volumes are proved to be simple because a point sees all of
/// them from inside.
///
/// When det(x - o, x_s, x_t) > 0 on all sides, directions from o are a local homeomorphism of the
/// surface to the sphere inside the sides and across their edges. At a corner every side spans less
/// than a straight angle, and all of them a multiple of a full one: with four sides at most, once.
/// So the surface covers the sphere without branches, and such a covering of what is simply
/// connected is one-to-one.
///
/// Asked for: every edge has one side on either side of it, in opposite directions, and every
/// corner at most four sides. o is the mean of the control points or, of at most 64 sides, the
/// point deepest inside of tangent planes, to which those of places that it did not see are added a
/// few times. The determinants' Bernstein coefficients are computed with a bound of their rounding;
/// sides are halved, with balanced weights, up to 64 pieces each.
/// @param sides  the boundary as cells, in its order.
/// @param signs  of det J, one a cell.
/// @return one a component, 0 or 1.
std::vector<char> FindStarShaped(const std::vector<BoundarySide>& boundary, int numComponents,
  const BernsteinCells& sides, const std::vector<int>& signs, int threads);
}
