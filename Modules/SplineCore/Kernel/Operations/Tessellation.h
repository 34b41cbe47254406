// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace knotwork
{
/// What becomes of a patch with three parameters.
enum class TessellationOutput
{
  Surface, ///< the outer boundary, as polygons
  Volume   ///< hexahedra
};

inline constexpr int DefaultMaxTessellationCells = 20000000;

struct TessellationParams
{
  double Tolerance = 1e-3;    ///< largest chordal deviation, unit of the points, > 0
  int MaximumSubdivision = 8; ///< halvings of an element per direction, [0, 10]
  TessellationOutput Output = TessellationOutput::Surface; ///< three parameters only
  bool Normals = true; ///< of polygons, when the points have 2 or 3 components
  /// False: points are shared wherever the model is connected; where elements disagree about the
  /// normal (creases) it is the mean of theirs. True: points are repeated, bit for bit, between
  /// patches and at creases, each copy with the exact normal of its side.
  bool Splitting = false;
  /// Polygons or hexahedra at most, >= 1.
  int MaxCells = DefaultMaxTessellationCells;
  /// Of Parts parts of about as many cells this one alone is made, in [0, Parts); all parts, one
  /// after the other, are what one part is, bit for bit. Each costs the work on borders of all.
  int Part = 0;
  int Parts = 1;
  /// Where all parts are made at once, by processes that tell each other: what the parts give, one
  /// after the other, to each of them. Each calls it once at most (curves do not), not at all where
  /// it has failed before; fewer values than theirs end the others. Without it each part finds the
  /// bounds of all elements itself.
  std::function<std::vector<double>(const std::vector<double>&)> Exchange;
  int Threads = 0;
  ProgressCallback Progress;
};

enum class TessellationShape : unsigned char
{
  Line,
  Triangle,
  Quadrilateral,
  Hexahedron
};

/// Linear cells with their origin. Every point is the exact value at PointPatch, PointElement,
/// PointLocal (rounding apart), evaluated once. Of a part the points that it shares with parts
/// before it come last.
struct TessellationMesh
{
  PointMatrix Points;            ///< n x c
  PointMatrix Normals;           ///< n x 3 unit vectors, or empty
  bool HasNormals = false;       ///< whether points, if there are any, have normals
  std::vector<int> PointPatch;   ///< index into the patches
  std::vector<int> PointElement; ///< element of the patch
  PointMatrix PointLocal;        ///< n x Dim in [0, 1]
  std::vector<TessellationShape> Shapes;
  std::vector<std::int64_t> Offsets; ///< cells + 1, into Connectivity
  std::vector<std::int64_t> Connectivity;
  std::vector<int> CellPatch;
  std::vector<int> CellElement;
  /// Of the surface of solids the side of the element, 2 direction + end; else empty.
  std::vector<int> CellSide;
  std::int64_t FirstPoint = 0;            ///< number of the first point among those of all parts
  std::vector<std::int64_t> SharedPoints; ///< numbers of the points of parts before, ascending
  std::int64_t NumPointsOfAll = 0;        ///< of all parts together
  /// Proven upper bound of the chordal deviation; above the tolerance only where
  /// MaximumSubdivision stopped the halving.
  double Bound = 0.0;
};

/// Replaces patches by linear cells that deviate from them by at most the tolerance, in the sense
/// of ChordalBound.h: |cell(lambda) - S(x)| <= Tolerance where x is the same convex combination of
/// the corners' parameters. In particular both one-sided distances are at most the tolerance.
///
/// Each element is halved by its own bound, an edge by the largest need of the elements at it,
/// T-junctions between levels included: vertices are keyed by integer positions on the dyadic grid
/// of their patch and evaluated once, so the mesh is conforming by topology, never by closeness.
/// Polygon cells with further vertices on their sides are split into triangles around a middle
/// point. Hexahedra are cut on one uniform grid a patch (its finest element decides).
///
/// Sides of elements on the rim of patches are the same side when their homogeneous control points
/// agree in either orientation but for rounding (PointClusters.h); a side whose control points
/// coincide is one vertex. Patches whose elements do not match side by side are not connected there
/// (the gap is at most twice the tolerance). Faces of solids that match are interior and do not
/// appear on the surface.
/// @param patches  Bezier forms with the same number of components.
/// @return EmptyInput without elements; InvalidParameter; NonFiniteInput, InvalidWeight with patch
/// and element; SizeMismatch; TooLarge above MaxCells; Aborted.
/// @complexity linear in the output, sorting of the elements' rims apart.
template <int Dim>
Result<TessellationMesh> Tessellate(
  const std::vector<BezierForm<Dim>>& patches, const TessellationParams& params = {});
}
