// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/FitDistances.h>
#include <knotwork/JacobianValidation/JacobianCertificate.h>

#include <string>

namespace knotwork
{
/// Straight elements by their corners: triangles and quadrilaterals in space, or tetrahedra, wedges
/// and hexahedra.
struct StraightElements
{
  PointMatrix Points; ///< n x 3, all of them corners
  std::vector<CellShape> Shapes;
  std::vector<int> Corners;            ///< in the order of CornerParameters, element by element
  std::vector<std::size_t> Begin{ 0 }; ///< of every element in Corners, and the end

  /// By which messages name elements and points; empty: as they stand here.
  std::vector<int> ElementNumbers;
  std::vector<int> PointNumbers;

  int NumElements() const { return static_cast<int>(this->Shapes.size()); }
  void Add(CellShape shape, const std::vector<int>& corners);
  std::string ElementName(int element) const; ///< "element 12"
  std::string PointName(int point) const;     ///< "point 12"
};

struct CurvedElementsParams
{
  int Order = 2; ///< in [1, 4]; of order 1 nothing moves
  /// Points are control points in Bernstein form, else those that the elements pass through.
  bool Bezier = false;
  /// Facets that belong on the target, by their corners in a row around them; triangles end with
  /// -1. Empty: facets of one element or between Regions, or all elements of surfaces.
  std::vector<std::array<int, 4>> Facets;
  std::vector<int> Regions; ///< one an element of a volume; empty: all are one
  /// Mean distance of the straight facets from the target, as share of the diagonal of their
  /// closest points, from which on they are taken for two different shapes, > 0.
  double FarShare = 0.25;
  /// Whether elements are known to meet in common points, as those of a mesher: what lies on an
  /// edge is then a corner of a flat element, not one that hangs there.
  bool IsConforming = false;
  int Threads = 0; ///< 0 = all cores; the result does not depend on it
  ProgressCallback Progress;
};

/// Numbers of points that belong on the target.
struct PlacedPoints
{
  int OnVertices = 0;
  int OnCurves = 0;
  int OnFaces = 0;
  int Left = 0; ///< that stay where they are, for the target is too far
};

struct CurvedElements
{
  PointMatrix Points;            ///< corners, then those of edges, faces and insides
  std::vector<CellShape> Shapes; ///< of the elements, as given
  std::vector<int> Nodes;        ///< points, in the order of the coefficients (CellCoefficient)
  std::vector<std::size_t> Begin{ 0 }; ///< of every element in Nodes, and the end
  JacobianCertificate Certificate;     ///< of every element
  std::vector<char> Relaxed;           ///< one an element: a point of it is not where it was placed
  std::vector<double> Distance; ///< of every element's facets from the target, sampled; 0 inside
  int Turned = 0;               ///< elements that were reversed, and whose corners were mirrored
  int NumFacets = 0;            ///< that belong on the target
  int BoundaryElements = 0;     ///< with such a facet
  PlacedPoints Placed;
  int Following = 0;                ///< points inside that follow those on the target, around folds
  int UnmatchedCurves = 0;          ///< of the target, that no edge lies on
  DistanceSummary StraightToTarget; ///< of the facets, weighted by area
  DistanceSummary CurvedToTarget;
  double Area = 0.0;   ///< of the facets
  double Volume = 0.0; ///< of elements that have one
};

/// Elements of higher order on a target. Corners go to the target's corners, curves and faces, and
/// so do points of edges and facets; an edge between facets on different faces, or with an angle
/// between them, that lies along a curve belongs on it. Points inside of facets and elements follow
/// from those around them (transfinite interpolation). A point that would move farther than half of
/// its edge stays. Every element is certified. Around those that are not valid, and such of volumes
/// whose least det J is below a twentieth of the straight element's, points inside follow those on
/// the target harmonically, and those of volumes then move to where elements have the best shapes
/// (UntangleInside), if that leaves fewer; then the points of one that is left go back towards the
/// straight element by 1/32 of their way, twice as far each time, corners last, until it and its
/// neighbours are not.
/// @param target  null: nothing is curved.
/// @return EmptyInput; InvalidParameter for options out of range and elements far from the target;
/// InvalidTopology for elements of surfaces beside such of volumes, corners twice in an element,
/// facets of more than two elements, points on edges of others; SizeMismatch; NonFiniteInput;
/// NotConverged for a straight element that is not valid; the target's errors; Aborted.
/// @complexity O(n log n), the closest points and the certificates.
/// @source  Szabo, Babuska, Finite Element Analysis (1991), section 6.2 (blending on triangles);
/// Gordon, Hall, Numerische Mathematik 21 (1973) 109-129 (on quadrilaterals and hexahedra);
/// Johnen, Remacle, Geuzaine, JCP 233 (2013) 359-372 (certificates).
Result<CurvedElements> CurveElements(const StraightElements& elements, const FitTarget* target,
  const CurvedElementsParams& params = {});
}
