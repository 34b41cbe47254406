// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChainFit.h"
#include "CubicPieces.h"

/// Private to FitChain: curves in space.
namespace knotwork::chains
{
/// The curve in space over the space of its pcurves, refined.
class SpaceFit
{
public:
  SpaceFit(const std::vector<const SurfaceBounds*>& surfaces, const ChainFitParams& params)
    : Surfaces(surfaces), Params(params)
  {
  }

  /// Both curves side by side: x, y, z, then UV.
  Result<Spline<1>> Run(const Spline<1>& pcurves);

  /// Bound of |C - S(lambda)| over all uses.
  Result<double> BoundGap(const Spline<1>& curve) const;

private:
  struct SpanPart
  {
    int Span = 0;
    double Begin = 0.0;
    double End = 0.0;
  };
  /// Spans in equal parts, about one an element of a surface on the way.
  std::vector<SpanPart> CutSpans(const Spline<1>& pcurves) const;
  /// Points of a surface at parameters that rounding may have moved out of the domain.
  static Status Evaluate(const SurfaceBounds& surface, PointMatrix uv, PointMatrix& values);
  /// What the curve in space follows: the mean of the surfaces, led to the vertices.
  Status Target(const Spline<1>& pcurves, const PointMatrix& t, PointMatrix& values) const;
  Result<Spline<1>> Fit(const Spline<1>& pcurves) const;
  /// Middles of spans in which the curve is too far from its target.
  Status FindFar(
    const Spline<1>& curve, const Spline<1>& pcurves, std::vector<double>& knots) const;
  /// A part of the curve: x, y, z, u, v, with the gap at its ends.
  struct GapPiece
  {
    Cubic Curve;
    std::array<double, 2> Ends{};
    int Depth = 0;
  };
  /// Linear interpolation of E = C - S(lambda) is off by at most |E''| / 8 on a piece, and where
  /// derivatives of S jump by |E'| / 2.
  static bool BoundPiece(const SurfaceBounds& surface, const GapPiece& piece, double& bound);
  /// Gaps at the end of each piece.
  static Status MeasureEnds(
    const SurfaceBounds& surface, const std::vector<GapPiece>& pieces, std::vector<double>& gaps);
  Result<double> BoundGap(const Spline<1>& curve, std::size_t use) const;

  const std::vector<const SurfaceBounds*>& Surfaces;
  const ChainFitParams& Params;
};
}
