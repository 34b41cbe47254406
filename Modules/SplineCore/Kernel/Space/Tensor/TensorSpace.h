// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Tensor-product B-spline space; functions and elements numbered first direction fastest.
/// @complexity O(elements * prod(p + 1)). Never fails on valid knot vectors; TooLarge when a count
/// exceeds 2^31 - 1.
template <int Dim>
Result<SplineSpacePtr<Dim>> MakeTensorSpace(const std::array<KnotVector, Dim>& knots);

/// Control points of a tensor-product spline after inserting knots; the map does not change.
/// @param knots  any values inside the domain, repeated for multiplicity; total multiplicity of an
///               interior knot at most p + 1 (InvalidKnots otherwise).
/// @return DimensionMismatch unless the space is of kind Tensor; OutsideDomain for a knot outside.
/// @source  Boehm, Computer-Aided Design 12 (1980) 199-201.
template <int Dim>
Result<Spline<Dim>> InsertKnots(
  const Spline<Dim>& spline, int direction, const std::vector<double>& knots);

/// Raises the degree in one direction by times >= 0 (result at most 9); every knot's multiplicity
/// grows by times, so the continuity and the map do not change; of outer knots of unclamped ends
/// only those stay that the new degree needs.
template <int Dim>
Result<Spline<Dim>> ElevateDegree(const Spline<Dim>& spline, int direction, int times);

/// Greville abscissae of all functions of a Tensor space, NumFunctions x Dim.
template <int Dim>
PointMatrix GrevillePoints(const SplineSpace<Dim>& space);

/// The family's entry in the table.
template <int Dim>
const SpaceFamily<Dim>& TensorFamily();
}
