// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

#include <array>

/// Inner control points of boxes of control points from those on their boundary.
namespace knotwork
{
/// Abscissae of the control points of a box in [0, 1], one list a direction: its Greville
/// abscissae, so that what is linear in a direction stays so. At least 2 each, from 0 to 1.
template <int Dim>
using BoxAbscissae = std::array<Eigen::VectorXd, Dim>;

/// Abscissae of a clamped tensor-product space, scaled to [0, 1].
/// @pre space.Kind == SpaceKind::Tensor.
template <int Dim>
BoxAbscissae<Dim> GrevilleAbscissae(const SplineSpace<Dim>& space);

/// Sets the inner control points by the Boolean sum of the linear interpolations between opposite
/// sides: reproduces multilinear maps, and is of the boundary's values alone.
/// @param points  rows by number, first direction fastest; product of the numbers of abscissae.
/// @return SizeMismatch.
/// @source  Farin, Hansford, CAGD 16 (1999) 691-702 (discrete Coons patches).
template <int Dim>
Status FillInside(const BoxAbscissae<Dim>& abscissae, PointMatrix& points);

enum class BoundaryShape
{
  General,
  Multilinear, ///< that of the multilinear map between its corners
  Affine       ///< that of an affine map
};
template <int Dim>
struct BoundaryShapeResult
{
  BoundaryShape Shape = BoundaryShape::General;
  /// Control points of that map, inside as well; none when General.
  PointMatrix Points;
  double Distance = 0.0; ///< largest one of a control point on the boundary from Points
};
/// What the boundary of a box is: Affine when all its control points are within the tolerance of
/// those of an affine map (whose directions are the means of the box's edges), Multilinear when
/// they are of the map between the corners.
/// @param tolerance  distance in the points' unit, >= 0. @param points  as FillInside.
/// @return SizeMismatch, InvalidParameter.
template <int Dim>
Result<BoundaryShapeResult<Dim>> ShapeOfBoundary(
  const BoxAbscissae<Dim>& abscissae, const PointMatrixView& points, double tolerance);

/// Control points of the multilinear map between corners (2^Dim rows, first direction fastest).
template <int Dim>
PointMatrix MultilinearPoints(const BoxAbscissae<Dim>& abscissae, const PointMatrixView& corners);

struct CoonsParams
{
  /// Volumes: the faces of every patch from its edges first.
  bool FacesFromEdges = false;
};
/// The spline with the control points inside of every patch (FindSpacePatches of its space) by
/// FillInside from those on the patch's boundary; of rational ones in homogeneous coordinates.
/// @return EmptyInput; DimensionMismatch unless the space is of kind Unstructured; Spline::Check's
/// codes; NotInSpace, with patch and cell, for patches that are smooth across their sides or next
/// to T-joints (policies Minimal, Motorcycle); InvalidWeight where the weights inside would not be
/// positive.
/// @complexity O(control points).
template <int Dim>
Result<Spline<Dim>> CoonsMap(const Spline<Dim>& spline, const CoonsParams& params = {});
}
