// SPDX-License-Identifier: BSD-3-Clause
// Private to the triangulation of faces.
#pragma once
#include "SurfaceCells.h"
#include <knotwork/SplineCore/BezierForm.h>

#include <vector>

namespace knotwork
{
/// Upper bounds of the norm of a curve's second derivative, span by span.
struct CurveBounds
{
  std::vector<double> Breaks;
  std::vector<double> Second; ///< one less than Breaks

  static CurveBounds Of(const BezierForm<1>& curve);
  /// Bound of the distance of the chord from the curve between two parameters, at equal parameters;
  /// the curve has no crease between them.
  double Deviation(double begin, double end) const;
  /// Sets each span to the larger of both. @pre equal breaks.
  void Include(const CurveBounds& other);
};

/// A pcurve with bounds of its two coordinates.
struct PlaneCurve
{
  BezierForm<1> Form;
  std::array<CurveBounds, 2> Bounds;

  explicit PlaneCurve(const Spline<1>& curve);
  /// Bound in each direction of the distance of the chord from the curve.
  std::array<double, 2> Deviation(double begin, double end) const;
};

/// What a chord of a pcurve may be off in space: |S(chord) - S(curve)| as second derivatives of a
/// curve with that chordal deviation.
CurveBounds BoundInSpace(const PlaneCurve& curve, const SurfaceCells& cells);

/// n x c values of a curve. @pre parameters of its domain.
PointMatrix EvaluateCurve(const BezierForm<1>& curve, const std::vector<double>& parameters);

/// Parameters between which the chords of a curve are within a tolerance, ends of the domain and
/// creases among them, spread evenly by need.
/// @param bounds      over the spans of `knots`.
/// @param minPieces   at least so many pieces.
/// @param maxPieces   @return TooLarge when more are needed.
/// @complexity O(spans + pieces * spans of a piece).
Result<std::vector<double>> SampleCurve(const KnotVector& knots, const CurveBounds& bounds,
  double tolerance, int minPieces, std::size_t maxPieces);
}
