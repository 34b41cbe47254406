// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceBounds.h"

/// Private to FitLoops: one chain of boundary edges as splines over one cubic space.
namespace knotwork
{
/// A chain as polylines over t in [0, 1]: its length in the plane, the mean of all uses, which is
/// about that in space. (Straight parts stay straight whatever the stretch, and points of the mesh
/// that coincide in space do not harm.)
struct ChainPolyline
{
  std::vector<double> Parameters; ///< n, increasing from 0 to 1
  PointMatrix Points;             ///< n x 3
  PointMatrix UV;                 ///< n x 2 m, of the m uses side by side
};

/// @param uv  of the uses.
ChainPolyline MakeChainPolyline(const PointMatrix& points, const std::vector<PointMatrix>& uv);

struct ChainFitParams
{
  /// Of the distance |S(lambda(t)) - S(pi(t))| between the images of pcurve and boundary.
  double Tolerance = 0.0;
  /// Of |C(t) - mean of S(lambda(t))|, apart from the way from the surfaces to the vertices.
  double CurveTolerance = 0.0;
  std::array<Eigen::RowVector3d, 2> Ends; ///< vertices
};

struct FittedChain
{
  Spline<1> Curve; ///< n x 3
  PointMatrix UV;  ///< n x 2 m control points over the same space
  /// Bounds, proved up to rounding: of |C(t) - boundary(t)|, |S(lambda(t)) - S(pi(t))|, and
  /// |C(t) - S(lambda(t))|.
  double BoundaryDistance = 0.0;
  double TrimDistance = 0.0;
  double EdgeGap = 0.0;
};

/// Pcurves of all uses by least squares over common knots, which are inserted until the tolerance
/// holds: halfway where many boundary points are near, closely around a single one that turns. Ends
/// are exact. The curve in space by least squares over the same space, refined.
/// @param surfaces  of the uses.
/// @return OutsideDomain; NotConverged.
Result<FittedChain> FitChain(const ChainPolyline& chain,
  const std::vector<const SurfaceBounds*>& surfaces, const ChainFitParams& params);
}
