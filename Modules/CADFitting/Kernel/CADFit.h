// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/DeviationBound.h>
#include <knotwork/CADFitting/FitDistances.h>
#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/SplineCore/CompositeProjection.h>
#include <knotwork/SplineCore/UnstructuredSpace.h>

#include <string>

namespace knotwork
{
/// Which elements are mended after the fit.
enum class FitSmoothing : std::uint8_t
{
  Off,
  Net,        ///< those whose control nets are inverted: quick, and no proof
  Certificate ///< those that are not proved valid
};

/// How the spline is made. One that does not apply gives way to Unstructured, and why is said.
enum class FitPath : std::uint8_t
{
  /// The first of Affine, Multilinear and Composite whose result is that of Unstructured but for
  /// rounding, else Unstructured: Composite with policy Full alone.
  Automatic,
  Unstructured, ///< element by element
  Composite,    ///< by the tensor-product patches of the space, direction by direction
             /// Boundaries of the patches, whose insides are their Boolean sums (policy Full; not
             /// of a surface that lies on its target).
  Coons,
  /// Without a target: from the corners of the patches, whose points lie on multilinear maps.
  Multilinear,
  Affine ///< the same of elements that are all images of one lattice
};
/// As --path has them.
const char* ToString(FitPath path);

/// Knot intervals of the sheets of parallel edges.
enum class FitLengths
{
  Uniform,  ///< those of the space's options: all 1 unless they are given
  Mean,     ///< as the mean lengths of their edges
  Automatic ///< uniform; where elements have no certificate mean, if that is better
};

struct CADFitParams
{
  UnstructuredParams Space; ///< degree, policy, features, lengths
  FitLengths Lengths = FitLengths::Automatic;
  FitPath Path = FitPath::Automatic;
  RestrictionKind CompositeWeights = RestrictionKind::Weighted; ///< Composite: of its patches
  /// Cells, and of hexahedra their faces on the mesh's surface, that are fitted to the target, one
  /// a cell; others stay where the mesh has them. Empty: all. Without a target it does not count.
  std::vector<char> FittedCells;
  bool Surfaces = true;    ///< whether faces are fitted
  bool Curves = true;      ///< whether sharp edges and rims are fitted
  bool Points = true;      ///< whether corners are
  bool Untangle = true;    ///< whether cells that fold, before or on the target, are untangled
  int UntanglingRings = 2; ///< >= 0
  FitSmoothing Smoothing = FitSmoothing::Certificate;
  int SmoothingRings = 2; ///< elements around those that are mended, ring by ring, >= 0
  /// A layer of hexahedra is put under the whole surface where a hexahedron has two faces on one
  /// face of the target: no map is valid along their common edge.
  bool Layer = true;
  /// Whether what comes before is fitted anew with the coefficients that faces, curves and corners
  /// have, instead of keeping all others.
  bool Constrain = false;
  /// Times that the surface is projected onto the target, from the second on from where it was
  /// fitted to before, [1, 100].
  int Projections = 1;
  int ExtraPoints = 1;       ///< Gauss points a direction: p + 1 and so many more, in [0, 16]
  int TargetSamples = 20000; ///< at which distances from the target are measured; 0: they are not
  /// Elements of the surface up to which bounds of its distances from a target of triangles are
  /// proved, >= 0; 0: they are not.
  int BoundedElements = 100000;
  /// Mean distance of the mesh's surface from the target, as share of the target's diagonal, from
  /// which on they are taken for two different shapes, > 0.
  double FarShare = 0.1;
  int Threads = 0; ///< 0 = all cores; the result does not depend on it
  ProgressCallback Progress;
};

template <int Dim>
struct CADFit
{
  Spline<Dim> Value;
  CreasePolicy Policy = CreasePolicy::Full; ///< that was taken
  bool HasMeanLengths = false;              ///< of knot intervals
  CellMesh<Dim> Mesh;                       ///< that the space is on: with a layer, or as given
  PointMatrix Points;                       ///< of the mesh, on the target
  /// Cell of the given mesh that every element comes from: itself, or the one below the layer.
  std::vector<int> CellOf;
  int LayerCells = 0;
  FitDistances Distances; ///< with FittedCells of these alone, and not from the target
  /// From a target of triangles; OfElements as Distances.OfElements. Not with FittedCells.
  DeviationBound Bound;
  /// Element of the surface by cell and side (side -1: the quadrilateral itself), as
  /// Distances.OfElements.
  std::vector<CellSide> SurfaceElements;
  JacobianCertificate Certificate; ///< of every element
  int FoldedCells = 0;             ///< of the mesh as given
  int StillFolded = 0;             ///< of the mesh on the target
  int InvalidBefore = 0;           ///< elements without a certificate before they were mended
  int Smoothed = 0;                ///< elements whose control points were moved to mend some
  std::vector<int> Uncertified;    ///< elements that stay so
  double Area = 0.0;               ///< of the surface
  double Volume = 0.0;             ///< of hexahedra, or enclosed by a surface without a rim; else 0
  FitPath Path = FitPath::Unstructured; ///< how the spline was made
  /// The one that was asked for where that gave way; else Automatic.
  FitPath PathTried = FitPath::Automatic;
  std::string PathNote; ///< why it gave way; empty: none did
  struct Unmatched
  {
    TargetPart Part;
    std::array<double, 3> Place{};
  };
  std::vector<Unmatched> UnmatchedFeatures; ///< curves and corners that the mesh has no edges for
  std::vector<std::string> Warnings;
};

/// One smooth spline on a mesh of quadrilaterals or hexahedra that lies on a target.
///
/// The surface of the mesh is classified on the target, its points are moved there (points inside
/// follow, folded cells are untangled), edges on the target's sharp edges become features; then the
/// polynomials through the points around every cell are projected onto the space, the closest
/// points of those on the target's faces, curves and corners after them. Elements that are not
/// valid are mended.
/// @param points  NumPoints x 3. @param target  null: the mesh itself, through whose points the
/// spline goes.
/// @return the errors of MakeUnstructuredSpace and the target; SizeMismatch, NonFiniteInput;
/// InvalidParameter for options out of range, a mesh far from its target and FittedCells without a
/// facet; NotInSpace with the side of FittedCells of hexahedra where their faces end though the
/// spline goes on smoothly; InvalidTopology for hexahedra and a target with a rim, unless
/// FittedCells are meant; Aborted. What could not be mended is in the result.
/// @complexity O(elements (p + 1)^Dim) and the closest points.
/// @source  Thomas, Scott, Evans, Tew, Evans, CMAME 284 (2015) 55-105.
template <int Dim>
Result<CADFit<Dim>> FitToTarget(const CellMesh<Dim>& mesh, const PointMatrix& points,
  const FitTargetPtr& target, const CADFitParams& params = {});
}
