// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// The tensor-product spline that Bezier elements make up: what a spline is whose knots are lost,
/// as the same map with knots of multiplicity degree between all elements.
/// @param elements  a spline of Bezier elements of one degree.
/// @param boxes     of the parameter domain, one an element; they fill a box like a chess board.
/// @return SizeMismatch; InvalidDegree for elements of several degrees; InvalidTopology for boxes
/// that leave gaps or lie over each other; NotInSpace for elements that do not join (1e-9 of the
/// size); InvalidKnots.
template <int Dim>
Result<Spline<Dim>> JoinElements(
  const Spline<Dim>& elements, const std::vector<ParametricBox<Dim>>& boxes);
}
