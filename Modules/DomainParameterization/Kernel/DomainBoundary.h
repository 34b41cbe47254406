// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/MultiPatch.h>
#include <knotwork/SplineCore/SizeLimit.h>
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// The boundary of a domain: 4 curves in the plane or 6 faces in space, in any order, each running
/// in any directions, of kind Tensor, each with its own degrees, knots and weights. A planar curve
/// may have three components when the third is one and the same number everywhere.
template <int Dim>
struct DomainBoundary
{
  std::vector<Spline<Dim - 1>> Sides;
};

struct BoundaryParams
{
  /// Ends of sides that are at most this part of the boundary's size apart are one corner, in
  /// [0, 0.1]; the size is the diagonal of the control points' bounding box.
  double GapTolerance = 1e-9;
  /// Functions of the map at most, >= 1.
  int MaxFunctions = DefaultMaxFunctions;
};

/// Which given side a side of the map is, and how it lies there.
struct SideOrigin : SideOrientation
{
  int Input = -1;
};

/// The sides of a map on [0, 1]^Dim, made compatible.
template <int Dim>
struct CompatibleBoundary
{
  std::array<KnotVector, Dim> Knots;          ///< of the map, clamped on [0, 1]
  std::array<Spline<Dim - 1>, 2 * Dim> Sides; ///< Dim components, rational all or none
  std::array<SideOrigin, 2 * Dim> Origins;
  /// That was closed at a corner or edge, or between neighbouring control points that agree within
  /// rounding; unit of the points.
  double LargestGap = 0.0;
  double Size = 0.0; ///< diagonal of the control points' bounding box

  bool IsRational() const { return this->Sides[0].IsRational(); }
};

/// Finds how the sides meet, and brings opposite sides to common degrees and knots. Side 0 stays
/// side 0 and keeps its directions, except that the last direction is reversed when the map would
/// be left-handed (negative area or volume). Exact up to rounding: degrees are elevated, knots
/// inserted (knots closer than 1e-12 of the domain are one), domains mapped to [0, 1] by an affine
/// change. Weights of sides that meet are matched by a constant factor a side; where no constants
/// fit (planar only) a side is multiplied, numerator and denominator, by one linear function, which
/// raises its degree by one and changes neither its points nor its parameters. Neighbouring control
/// points that agree within the rounding of their coordinates, and within the gap tolerance, become
/// one: derivatives that were zero before a refinement are zero again.
/// @return EmptyInput; SizeMismatch (not 4 / 6 sides); what Spline::Check finds, with the side;
/// DimensionMismatch (components, kind, third components that differ); InvalidKnots (not clamped);
/// InvalidTopology: the sides leave a gap at a corner or along an edge (named, with the distance),
/// or enclose nothing; InvalidWeight (weights along an edge of faces that are not proportional);
/// InvalidDegree (elevation beyond 9); TooLarge.
template <int Dim>
Result<CompatibleBoundary<Dim>> MakeCompatible(
  const DomainBoundary<Dim>& boundary, const BoundaryParams& params = {});

/// Number of a side in words: "west (u = 0)", "face w = 1".
template <int Dim>
std::string SideName(int side);
}
