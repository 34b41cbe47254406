// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

/// How far a Bezier element may lie from its linear interpolation.
///
/// Let x be a point of a parameter box with sides h_d, written as a convex combination
/// x = sum_i lambda_i v_i of points v_i of the box (the corners of a triangle, of a bilinear
/// quadrilateral, of a hexahedron, ...). Taylor's formula at x with integral remainder gives
///     | sum_i lambda_i S(v_i) - S(x) | <= 1/2 sum_i lambda_i sum_de M_de |v_i - x|_d |v_i - x|_e,
/// with M_de >= sup |S_de| over the box: the linear terms cancel because sum_i lambda_i (v_i - x)
/// = 0. In one direction sum_i lambda_i (v_i - x)_d^2 is the variance of numbers in an interval of
/// length h_d, at most h_d^2 / 4 (Popoviciu), and Cauchy-Schwarz gives h_d h_e / 4 for mixed terms.
/// So every linear cell with corners on the map is nearer than
///     1/8 sum_de M_de h_d h_e.
/// For polynomials M_de is the largest second difference of the control points (convex hull of the
/// derivative's Bernstein form). For rational maps S = A / w
///     S_d = n_d / w^2,  n_d = A_d w - A w_d,     S_de = (n_d,e w - 2 n_d w_e) / w^3,
/// the numerators are multiplied out in Bernstein form, and M_de is the largest norm of their
/// coefficients over the cube of the smallest weight, on the halves of the element in every
/// direction in which the weight varies.
/// @source  Filip, Magedson, Markot, CAGD 3 (1986) 295-311 for the triangle; the extension to any
/// convex combination is the derivation above.
namespace knotwork
{
/// Upper bounds of the norms of second derivatives on an element with respect to its local
/// parameters, row-major symmetric K x K.
template <int K>
using SecondDerivativeBound = std::array<double, static_cast<std::size_t>(K* K)>;

/// @param net       planes of prod(p_d + 1) values as a block of a BezierForm.
/// @param rational  then the last of numComponents + 1 planes is the weight (positive).
/// @complexity  O(prod(p_d + 1)) a component; when rational O(prod(p_d + 1)^2), up to 2^K times.
template <int K>
SecondDerivativeBound<K> BoundSecondDerivatives(
  const IntArray<K>& degree, int numComponents, bool rational, const double* net);

/// 1/8 sum_de M_de 2^-(s_d + s_e): the chordal bound after halving s_d times in direction d.
template <int K>
double ChordalBound(const SecondDerivativeBound<K>& bound, const IntArray<K>& halvings);

/// Fewest halvings, chosen greedily one direction at a time, that bring the chordal bound to the
/// tolerance; at most `limit` in each direction (then the bound may stay above).
template <int K>
IntArray<K> HalvingsForTolerance(
  const SecondDerivativeBound<K>& bound, double tolerance, int limit);
}
