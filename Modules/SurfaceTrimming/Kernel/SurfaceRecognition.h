// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>
#include <knotwork/SplineCore/AnalyticSurface.h>

#include <vector>

namespace knotwork
{
struct RecognitionParams
{
  /// Largest distance of points from their region's surface, unit of the points; 0: a thousandth of
  /// the diagonal of the points' box.
  double Tolerance = 0.0;
  /// Largest distance of edges and triangles from the surface that their corners lie on, in
  /// tolerances, [0, 1000].
  double MaximumSag = 5.0;
  /// Of a part at most: more are a failure, and so is a part whose first 200 regions cover less
  /// than half of it, or that is on no surface at 64 places, which is no machined one. 0: any
  /// number of any size.
  int MaxRegions = 0;
  /// Largest distance by which surfaces move at the points of their regions for directions,
  /// positions and sizes that are nearly equal to become so, unit of the points, up to Tolerance;
  /// 0: none do.
  double SnapDistance = 0.0;
  ProgressCallback Progress;
};

struct RecognizedRegion
{
  AnalyticSurface Surface;
  std::vector<int> Triangles; ///< ascending
  bool Reversed = false;      ///< the triangles' normals are opposite to the surface's
  double MaxDistance = 0.0;   ///< of points
  double MaxSag = 0.0;        ///< of the middles of edges and triangles
  int Direction = -1;         ///< number of the direction that its axis or normal shares; -1: none
  int Position = -1;          ///< the same of a plane, or of an axis' line
  int Size = -1;              ///< the same of a radius, of tori the minor one, or of a cone's angle
  double Turn = 0.0;          ///< of the axis or normal, to share it, degrees
};

/// Values that surfaces share since SnapDistance allows it.
struct SnappedValues
{
  int NumSurfaces = 0; ///< that were changed
  int NumDirections = 0;
  int NumPositions = 0;
  int NumSizes = 0;
  double MaxTurn = 0.0; ///< degrees
};

struct SurfaceRecognition
{
  std::vector<RecognizedRegion> Regions; ///< part by part, the largest area first
  std::vector<int> RegionOfTriangle;
  std::array<int, NumSurfaceTypes> NumOfType{};
  double Tolerance = 0.0; ///< that was asked for
  /// Largest distance of points from surfaces with which regions were grown; those of joined pieces
  /// may be farther, up to Tolerance.
  double Noise = 0.0;
  SnappedValues Snapped;
};

/// Divides a mesh into regions of one surface each: plane, cylinder, sphere, cone, torus, the
/// simplest one on which a region's points lie; what is none is of free form.
///
/// Surfaces are guessed from few neighbouring facets, grown over edges as far as points lie on them
/// and facets do not lean away from them, and fitted to what they cover; the largest is taken.
/// That is done with several tolerances up to the stated one, and the smallest one is kept
/// that does not take many more regions than others. Where points have noise, pieces that one
/// surface is next to within the tolerance become one region. Values are made common last, over all
/// parts.
/// @param surface  of CheckSurface.
/// @return InvalidParameter; TooLarge: more than MaxRegions; NotInSpace: a free shape; Aborted.
/// @complexity about O(n) where regions are large; O(n) guesses of free form.
/// @source Schnabel, Wahl, Klein, Computer Graphics Forum 26 (2007) 214 (guess and score).
Result<SurfaceRecognition> RecognizeSurfaces(
  const DiscMesh& surface, const RecognitionParams& params = {});

/// The same of triangles as they are given, of several parts too: points that are equal are one.
/// RegionOfTriangle is -1 of triangles of two equal corners.
/// @return also EmptyInput and the failures of CheckComponent.
Result<SurfaceRecognition> RecognizeSurfaces(
  const TriangleMesh& mesh, const RecognitionParams& params = {});
}
