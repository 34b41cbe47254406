// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/SizeLimit.h>

#include <functional>
#include <vector>

namespace knotwork
{
/// A map of points, row by row: n x c in, n x c' out. Every row must depend on its own row only; it
/// may be called from several threads. OutsideDomain with the row of a point where it is undefined.
using PointMap = std::function<Status(const PointMatrix& points, PointMatrix& values)>;

/// Sends points through a spline map: their first Dim coordinates are its parameters.
/// @param points  n x c with c >= Dim, finite in the first Dim columns.
/// @param clamp   points outside the domain are moved to the nearest parameters inside, else they
///                are an error.
/// @param values  n x components.
/// @return DimensionMismatch (no domain, too few coordinates), NonFiniteInput, OutsideDomain; the
/// detail names the first such row with its coordinates and the domain.
template <int Dim>
Status MapPoints(const BezierForm<Dim>& map, const PointMatrixView& points, bool clamp, int threads,
  PointMatrix& values);

struct CompositionParams
{
  double Tolerance = 0.0; ///< wanted distance, unit of the mapped points; 0: no refinement
  int MaxLevel = 5;       ///< hierarchy levels that may be added above level 0, [0, 20]
  int Extension = -1;     ///< cells added around marked ones, [0, 10]; -1: half the largest degree
  int Samples = 0;        ///< a direction and element, for the distance, [2, 64]; 0: degree + 3
  int MaxFunctions = DefaultMaxFunctions; ///< of a patch, >= 1
  int Threads = 0;
  ProgressCallback Progress;
};

template <int Dim>
struct CompositionResult
{
  std::vector<Spline<Dim>> Patches; ///< polynomial, in the order of the input
  /// Per patch the largest distance between the composition and its projection at the samples of
  /// all elements (a regular grid with the element's borders), at equal parameters.
  std::vector<double> Distances;
  int NumInterfaces = 0; ///< sides of patches that were projected once for all patches there
};

/// Composition outer o inner as polynomial splines: every patch by Bezier projection onto its own
/// space, which is refined (THB) where the distance exceeds the tolerance.
///
/// Continuity: sides, edges and corners of patches are projected by themselves, from the trace of
/// the inner spline alone, and overwrite the coefficients there. Sides of two patches whose traces
/// agree but for rounding (control points and weights as PointClusters.h says; knots up to an
/// affine change and 1e-9; any orientation) are projected once for both, and their refinement is
/// mirrored, so shared interfaces have control points that are equal bit for bit. This needs knot
/// vectors with p + 1 equal end knots; other sides and patches without a parameter domain are
/// projected as a whole and never refined or matched.
/// @param inner  1 to 4 components each.
/// @return EmptyInput; InvalidParameter; what the inner splines' Check or the outer map return,
/// with the patch; TooLarge when a refinement would have more than MaxFunctions; Aborted. A
/// tolerance that MaxLevel does not allow is no error: read Distances.
/// @complexity per round: (p + 2)^Dim evaluations of both maps an element.
/// @source  Thomas et al., CMAME 284 (2015) 55-105 (projection, and on boundaries first).
template <int Dim>
Result<CompositionResult<Dim>> ComposeSplines(const std::vector<Spline<Dim>>& inner,
  int numComponents, const PointMap& outer, const CompositionParams& params = {});
}
