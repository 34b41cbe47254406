// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/FlattenCharts.h>
#include <knotwork/SurfaceTrimming/SurfaceRecognition.h>
#include <knotwork/SurfaceTrimming/TrimSurface.h>

namespace knotwork
{
struct RegionModelParams
{
  double CornerAngle = 20.0; ///< of rims: a turn by more degrees is a vertex, (0, 180]
  /// Whether ModelMesh makes spline faces of what is of free form, as long as surfaces of other
  /// types cover LeastAnalytic of the mesh's area; else that is refused.
  bool FreeForm = true;
  double LeastAnalytic = 0.1; ///< [0, 1]
  /// Of spline faces; Effort and TimeLimit are for all parts of a mesh together. Tolerance,
  /// CornerAngle, Vertices, Triangulation, Threads and Progress are set from the others.
  TrimParams Trim;
  FlattenParams Flatten;
  ChartParams Charts;
  int Threads = 0; ///< 0: all cores
  ProgressCallback Progress;
};

/// Faces, edges and vertices of analytic surfaces. Distances in the unit of the points.
struct RegionModel
{
  TrimmedModel Model; ///< a face a region; TrimmedFace::Type says what the surface is
  std::vector<LoopVerdict> Verdicts;         ///< of the faces' loops
  std::vector<FaceCertificate> Certificates; ///< of the faces; MinNormal is 0 of those with a pole
  std::array<int, NumSurfaceTypes> NumOfType{};
  int NumRims = 0; ///< closed curves of edges of one face
  int NumPoleFaces =
    0;                ///< faces with a pole, which are regular by their type, but for a cone's tip
  int NumEdges = 0;   ///< without seams and poles
  int NumLines = 0;   ///< of them
  int NumCircles = 0; ///< of them
  /// Of them: where the normals of both faces differ, along half of the edge, by 5 degrees or more,
  /// or by 25 beside a face of free form.
  int NumSharpEdges = 0;
  int NumVertices = 0;
  /// Of the mesh's points from the surfaces of their regions, and of those on its boundary from the
  /// edges there.
  double MaxPointDistance = 0.0;
  /// Bound of the distance of all points of triangles from the surface of their region, and of
  /// edges between regions from both surfaces: with the sag of the triangles. What lies between
  /// such an edge and its curve is as near to both surfaces as these two are, so that with
  /// MaxEdgeGap it bounds the distance of mesh and model.
  double MaxDistance = 0.0;
  /// Of curves from the mesh's edges that they stand for, a bound both ways. Where surfaces touch,
  /// the mesh may change from one to the other anywhere, and this says how far from the curve.
  double MaxEdgeDistance = 0.0;
  double MaxEdgeGap = 0.0; ///< of curves from the images of their pcurves, at samples
  /// Bound of the distance of faces of free form and the mesh, both ways, but for the sag of chords
  /// beside curved faces, which is in MaxDistance; 0 without such.
  double FreeDeviation = 0.0;
  /// Degrees, at samples, between faces of free form along edges where the mesh is smooth.
  double MaxNormalAngle = 0.0;
  double MaxVertexDistance = 0.0; ///< of vertices from their points of the mesh
  double Tolerance = 0.0;         ///< of the recognition
  SnappedValues Snapped;
  double Work = 0.0; ///< for faces of free form, in the unit of TrimParams::Effort
};

/// Makes trimmed faces of a mesh whose regions are all planes, cylinders, spheres, cones or tori.
/// Vertices are where surfaces meet, next to where regions do; edges are the curves in which
/// surfaces meet, as lines and circles where they are; neighbours share them. Closed faces get a
/// seam from vertex to vertex, spheres and cones degenerate edges at the poles that they contain.
/// @param surface  of CheckSurface. @param recognition  of RecognizeSurfaces of it.
/// @return InvalidParameter; SizeMismatch; NotInSpace: a region of free form, or one whose loops
/// are none of the kinds above (naming it); failures of TrimmedModel::Check; Aborted.
/// @complexity O(n log n), and the fit of some 50 points an edge.
Result<RegionModel> ModelRegions(const DiscMesh& surface, const SurfaceRecognition& recognition,
  const RegionModelParams& params = {});

/// Recognizes the surfaces of triangles as they are given, of several parts too, and makes faces of
/// them, in one body. Beside regions of free form, regions are analytic only whose points lie on
/// their surface as exact or noisy ones do; the others become charts with spline surfaces, which
/// share their edges with the analytic faces.
/// @param recognition  MaxRegions 0: a thousand of a part.
/// @return failures of RecognizeSurfaces, FlattenCharts, TrimSurface and ModelRegions; NotInSpace
/// also where there are more than a hundred faces of fewer than six triangles each on average:
/// facets of a free shape, not faces.
Result<RegionModel> ModelMesh(const TriangleMesh& mesh, const RecognitionParams& recognition,
  const RegionModelParams& params = {});
}
