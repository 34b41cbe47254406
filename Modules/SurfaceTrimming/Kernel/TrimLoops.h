// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>
#include <knotwork/SurfaceTrimming/ChartMesh.h>

#include <optional>

namespace knotwork
{
enum class LoopVerdict : std::int8_t
{
  Crossing = -1, ///< proved: loops cross themselves or each other, or are not nested and oriented
  Undecided = 0,
  SimpleNested = 1 ///< proved: simple closed curves, holes inside the outer one and outside others
};
/// "simple_nested", "crossing", "undecided".
const char* ToString(LoopVerdict verdict);

/// Proves that the loops of a face are simple, disjoint, closed, nested and oriented (outer one
/// counterclockwise, holes clockwise), in the parameter plane. A face without loops is. Ends of
/// curves that meet may differ by 1e-12 of their coordinates; loops with larger gaps are undecided.
/// @return SizeMismatch, NonFiniteInput, InvalidWeight (as Spline::Check), DimensionMismatch,
/// EmptyInput for a loop without curves.
/// @source see ProveSimpleCurves; windings by angles, orientation by area.
Result<LoopVerdict> ProveLoops(const TrimmedFace& face, int threads = 0);

/// A point of the mesh's boundary at which edges end.
struct LoopVertex
{
  std::int64_t PointId = 0;             ///< as ChartMesh::PointIds
  std::optional<Eigen::Vector3d> Point; ///< of the vertex; none: the mean of the surfaces' points
};

struct LoopParams
{
  /// Largest distance in space, measured on the surface, between the mesh's boundary and the pcurve
  /// that replaces it, > 0. (How far the surface is from the mesh comes on top in space.)
  double Tolerance = 0.0;
  /// A boundary that turns by more than so many degrees at a point has a corner there: edges end.
  /// (0, 180].
  double CornerAngle = 20.0;
  std::vector<LoopVertex> Vertices; ///< beside corners and places where charts change
  int Threads = 0;
  ProgressCallback Progress;
};

struct TrimLoops
{
  std::vector<std::vector<TrimmedLoop>> Loops; ///< of each chart, as TrimmedFace::Loops
  std::vector<LoopVerdict> Verdicts;           ///< of each chart
  int NumEdges = 0;
  int NumVertices = 0;
  int NumBoundaryLoops = 0; ///< of the whole surface: loops of edges that only one chart uses
  /// Bounds over all edges and their parameters, proved up to rounding:
  double MaxBoundaryDistance = 0.0; ///< |curve(t) - boundary(t)| in space
  double MaxTrimDistance = 0.0;     ///< |S(pcurve(t)) - S(UV boundary(t))| over all uses
  double MaxEdgeGap = 0.0;          ///< |curve(t) - S(pcurve(t))| over all uses
};

/// Boundary loops of charts as trimming curves: chains of boundary edges between corners, and
/// between points where other charts begin, become one edge each, which all charts along it use.
/// Pcurves are least squares splines with as many knots as the tolerance asks; where loops cross,
/// the tolerance is halved until they do not, up to seven times: then the verdict says so. Edge
/// curves follow S(pcurve) (the mean of both surfaces) to a 25th of the tolerance beyond what
/// the surfaces disagree. All curves are cubic; between corners of the mesh's boundary that are
/// duller than CornerAngle they have two continuous derivatives unless only a multiple knot reaches
/// the tolerance.
/// @param surfaces  of the charts: polynomial tensor products over domains that hold all UV.
/// @return EmptyInput; SizeMismatch; InvalidParameter; failures of both Check; DimensionMismatch;
/// OutsideDomain; InvalidTopology: an edge of three charts or triangles, triangles that lie on one
/// side of an edge or touch in a point only, common points that lie apart, a chart that is not one
/// disc with holes; NotConverged; Aborted. Details name chart, edge and points.
/// @complexity O(n log n) for n triangles, plus that of the fits.
Result<TrimLoops> FitLoops(const std::vector<ChartMesh>& charts,
  const std::vector<Spline<2>>& surfaces, const LoopParams& params);
}
