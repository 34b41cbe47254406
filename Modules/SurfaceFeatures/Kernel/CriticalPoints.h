// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
enum class CriticalKind : std::uint8_t
{
  Minimum,
  Maximum,
  Saddle
};

/// Where a critical point lies.
enum class CriticalPlace : std::uint8_t
{
  Interior, ///< inside an element
  Edge,     ///< on an edge or corner of elements (or too near to tell) across which f is smooth
  Crease,   ///< on a line where the gradient jumps; the point is a kink of f or a corner of kinks
  Boundary, ///< on the boundary of the domain (or where f itself jumps)
  Corner    ///< at a corner of the boundary
};

/// A critical point and the proof that it is one.
///
/// Inside: the gradient is zero. On a crease: zero lies in the convex hull of the gradients of both
/// sides (of all sides at a corner of creases). On the boundary: the derivative along it is zero;
/// at a corner of the boundary: a minimum or maximum (or several of them meet: a saddle).
struct CriticalPoint
{
  CriticalKind Kind = CriticalKind::Minimum;
  CriticalPlace Place = CriticalPlace::Interior;
  int Element = -1;
  RealArray<2> Parameters{}; ///< of the domain, or in [0, 1]^2 of the element without a domain
  double Value = 0.0;
  /// Holds this critical point and no other one. In a domain it may reach over several elements;
  /// on the boundary and on creases it holds a part of the line.
  ParametricBox<2> Box;
  ParametricBox<2> Enclosure; ///< proved to hold the point, a few units of rounding wide
  RealArray<2> ValueBounds{}; ///< lower, upper
  /// Of the Hessian with respect to the parameters, ascending; on a crease or the boundary the
  /// second derivative along the line, twice; 0 at corners.
  RealArray<2> Eigenvalues{};
  /// What the point adds to the Euler characteristic when the sublevel sets grow past it: minimum
  /// 1; saddle -1; maximum 1 inside, 0 on the boundary; boundary saddle -1 where f grows inward,
  /// otherwise 0.
  int Index = 0;
  /// Boundary: sign of the derivative into the domain; otherwise 0.
  int InwardSign = 0;
};

/// Boxes that touch each other and in which critical points could not be told apart: a degenerate
/// point, a curve or an area of critical points.
struct CriticalCluster
{
  std::size_t FirstBox = 0; ///< into CriticalPoints::Boxes
  std::size_t NumBoxes = 0;
  RealArray<2> ValueBounds{}; ///< of f on the boxes
};

/// A box of a cluster, on its boundary a segment or a point.
struct CriticalBox
{
  int Element = -1;
  ParametricBox<2> Box;
};

struct CriticalPointParams
{
  int Component = 0;    ///< of the spline, in [0, components)
  bool Boundary = true; ///< also critical points of the restriction to the boundary
  /// Halvings of an element, in [1, 50]; what is undecided then is a cluster.
  int MaxDepth = 32;
  /// Undecided boxes of an element at a time, in [4, 4096]: where a level of the subdivision leaves
  /// more (a curve or an area of critical points) they are a cluster.
  int MaxBoxes = 64;
  int Threads = 0;
  ProgressCallback Progress;
};

struct CriticalPoints
{
  std::vector<CriticalPoint> Points; ///< ascending by element, then by the parameters
  std::vector<CriticalCluster> Clusters;
  std::vector<CriticalBox> Boxes; ///< of the clusters
  /// Every critical point lies in exactly one uniqueness box: there are no clusters.
  bool Proved = false;
  int NumMinima = 0;
  int NumMaxima = 0;
  int NumSaddles = 0;
  int NumOnBoundary = 0; ///< of these, on the boundary and at its corners
  int IndexSum = 0;      ///< of the points
  /// Of the domain; without clusters and with the boundary it equals IndexSum.
  int EulerCharacteristic = 0;
  std::int64_t NumTested = 0; ///< boxes whose gradient was bounded
};

/// All critical points of a component of a spline surface's map, as a function of its parameters.
///
/// What is proved: every critical point (see CriticalPoint; without Boundary: of the interior)
/// lies in a uniqueness box or in a box of a cluster, and every uniqueness box holds exactly one,
/// of the kind reported. Rounding is accounted for: it is proved for every function whose Bernstein
/// coefficients differ from the computed ones by no more than the rounding of their computation
/// (64 (p + q + 2) units of the size of the control points around) and which is smooth at edges
/// where the one-sided gradients agree within that bound.
///
/// Boxes are excluded where a derivative's Bernstein coefficients have one sign; the rest is
/// halved. A uniqueness box is proved by Krawczyk's operator with the Hessian bounded over all
/// elements that the box meets (for a gradient that is Lipschitz across edges the hull of the
/// pieces' Hessians holds its generalised Jacobian). On creases and the boundary the same in one
/// dimension, with the signs of the normal derivatives; at their corners by signs alone.
///
/// Bezier elements without a domain are laid out as unit squares side by side.
/// @return the spline's Check(); InvalidParameter; InvalidTopology when Bezier elements cannot be
/// laid out in a plane; Aborted.
/// @complexity O(elements (p + 1)^2) and, a critical point, some (p + 1)^3 boxes.
/// @source  Krawczyk, Computing 4 (1969) 187-201; Neumaier, Interval Methods for Systems of
/// Equations (1990), 5.1; Farouki & Rajan, CAGD 5 (1988) 1-26 (bounds by coefficients); Clarke,
/// Optimization and Nonsmooth Analysis (1983), 2.6 (generalised Jacobian).
Result<CriticalPoints> FindCriticalPoints(
  const Spline<2>& spline, const CriticalPointParams& params = {});
}
