// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChainFit.h"
#include "CubicPieces.h"

#include <set>

/// Private to FitChain: curves in the parameter planes.
namespace knotwork::chains
{
/// Pcurves of all uses over common knots.
class ParameterFit
{
public:
  ParameterFit(
    const ChainPolyline& chain, const std::vector<const SurfaceBounds*>& surfaces, double tolerance)
    : Chain(chain), Surfaces(surfaces), Tolerance(tolerance)
  {
  }

  Result<Spline<1>> Run();

  double Distance = 0.0;

private:
  int NumUses() const { return static_cast<int>(this->Surfaces.size()); }
  Result<Spline<1>> Fit() const;
  /// Of |S(lambda) - S(pi)|: the surface's derivatives on the way times the way.
  double Bound(const CurvePiece& piece) const;
  double Bound(const SurfaceBounds& surface, const PlaneCubic& curve, const PlaneCubic& difference,
    int depth) const;
  /// Change of a polyline's velocity at a vertex, in space.
  double Jump(std::size_t vertex) const;
  std::size_t MaxKnots() const { return 24 * this->Chain.Parameters.size() + 200; }
  /// A corner of the curve at every corner of the boundary, and nothing else. @return false when
  /// that has been tried.
  bool FollowExactly();
  /// Inner corners of the boundary from a to b become corners of the curve.
  void Multiply(std::vector<double>::const_iterator a, std::vector<double>::const_iterator b);
  void Refine(double begin, double end, bool multiply);
  /// A knot at the corner that is next to the middle of the span, if any is near.
  void InsertBetween(double begin, double end, std::vector<double>::const_iterator first,
    std::vector<double>::const_iterator last);
  /// Knots around a corner, once. A cubic spline over knots with distance h rounds a corner off by
  /// h / 6 of the jump of the velocity there, within 2 h.
  bool Surround(std::size_t vertex);

  const ChainPolyline& Chain;
  const std::vector<const SurfaceBounds*>& Surfaces;
  double Tolerance;
  std::vector<double> Knots;
  std::set<std::size_t> Surrounded;
  bool IsExact = false;
};
}
