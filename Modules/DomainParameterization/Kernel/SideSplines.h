// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DomainBoundary.h"

#include <string>

/// Private to this module: sides of maps (curves of plane domains, faces of solid ones) as they are
/// given, and what makes them fit together.
namespace knotwork
{
/// "side 3".
std::string GivenSide(int input);
/// A status that names the given side.
Status NamedSide(const Status& status, int input);

template <int Dim>
struct SideList
{
  std::vector<Spline<Dim - 1>> Sides;
  double Size = 0.0; ///< diagonal of the control points' bounding box
};
/// Given sides, checked, with Dim components, clamped on [0, 1]^(Dim - 1), without weights that do
/// nothing. Curves of three components lie in one plane of constant z.
template <int Dim>
Result<SideList<Dim>> PreparedSides(const std::vector<Spline<Dim - 1>>& given);
/// The same side with other directions, which lies so on the given one (knots t become 1 - t where
/// a direction is reversed).
template <int D>
Spline<D> Reoriented(const Spline<D>& spline, const SideOrientation& orientation);
/// As above for one knot vector on [0, 1].
KnotVector ReversedKnots(const KnotVector& knots);

/// A direction of a side that shares its knots with others.
template <int D>
struct SideDirection
{
  Spline<D>* Side = nullptr;
  int Direction = 0;
  int Input = 0; ///< for messages
};
/// Brings prepared sides to one degree, at least minDegree, and the same knots in one direction
/// each; elements are cut in equal parts until there are at least minElements. Exact up to
/// rounding; knots closer than 1e-12 are one. @return the common knots. @pre users is not empty.
template <int D>
Result<KnotVector> UniteKnots(
  const std::vector<SideDirection<D>>& users, int minDegree, int minElements);

/// Weights that agree to 1e-10.
bool SameWeight(double a, double b);
/// Weights of one where there are none.
template <int D>
void MakeRational(Spline<D>& side);
/// Numerator and denominator of a curve on [0, 1] times the linear function from 1 to ratio: the
/// same points at the same parameters, one degree more.
Result<Spline<1>> TimesLinear(const Spline<1>& curve, double ratio);
}
