// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/GeodesicMarch.h>
#include <knotwork/MeshParameterization/TriangleMesh.h>

#include <string>

namespace knotwork
{
enum class FlattenMethod
{
  Hlle,      ///< Hessian eigenmaps, normalized: isometric where the surface is developable
  Isomap,    ///< geodesic distances; wrong by nature where the flat domain is not convex
  Laplacian, ///< Laplacian eigenmaps; distorts everywhere
  Lscm,      ///< least squares conformal
  Arap,      ///< as rigid as possible
  Injective  ///< least symmetric Dirichlet energy, by steps that flip no triangle
};

enum class LaplacianWeights
{
  Cotangent,
  Graph ///< 1 an edge, masses the numbers of edges
};

struct FlattenParams
{
  FlattenMethod Method = FlattenMethod::Hlle;
  LaplacianWeights Weights = LaplacianWeights::Cotangent;
  GeodesicEstimator Geodesics = GeodesicEstimator::Unfolding; ///< of Isomap
  int Neighbours = 10;     ///< of a vertex, for the Hessian, [6, 50]
  int Landmarks = 50;      ///< of Isomap, [3, 10000]
  int MaxIterations = 100; ///< of Arap and Injective, [1, 10000]
  double MinParticipation =
    0.02;               ///< an eigenvector on a smaller part of the area is rejected, [0, 1)
  bool Fallback = true; ///< of Hlle, when it fails or folds, to Arap, Injective or Lscm
  bool LargestComponent = false; ///< see CheckMesh
  int Threads = 0;               ///< 0: all cores; the result does not depend on it
};

/// Of triangles between their own plane and UV; singular values s1 >= s2 >= 0 of the Jacobian.
struct FlattenMeasures
{
  int FlippedTriangles = 0;
  double MeanStretch = 0.0; ///< max(s1, 1 / s2), mean by area; 1 at best
  double MaxStretch = 0.0;
  double MinSingularValue = 0.0;
  double MaxSingularValue = 0.0;
  double MeanAreaDistortion = 0.0; ///< max(s1 s2, 1 / (s1 s2)), mean by area; 1 at best
  double MaxAreaDistortion = 0.0;
  /// Root mean square by area of (s1 - 1, s2 - 1): what is left after the best similarity.
  double IsometryError = 0.0;
  /// Root mean square of geodesic minus plane distance, from six far points to all points, over the
  /// largest geodesic distance; not zero on domains that are not convex.
  double DistanceError = 0.0;
  PointMatrix SingularValues; ///< a row a triangle: s1, s2; s2 is negative where it is flipped
};

/// What a method gives.
struct FlatMesh
{
  PointMatrix UV;               ///< n x 2
  int RejectedEigenvectors = 0; ///< that live on few vertices
};

struct MeshParameterization
{
  DiscMesh
    Mesh; ///< its Loops: the outer one first by area in UV, counterclockwise; holes clockwise
  PointMatrix UV; ///< n x 2, centred, at the scale of the mesh; most
                  ///< triangles counterclockwise
  FlattenMeasures Measures;
  Status Injective; ///< ok when it is proved that UV covers no point twice, else what is wrong
  FlattenMethod Used = FlattenMethod::Hlle;
  std::string FallbackReason; ///< one sentence; empty when the method asked for was used
  int RejectedEigenvectors = 0;
  double Seconds = 0.0; ///< of the wall clock, checks included, measures not
};

/// Name as options and reports have it.
const char* ToString(FlattenMethod method);

/// A mesh with a boundary (and holes) laid into the plane.
/// @return failures of CheckMesh; InvalidParameter; failures of the method when there is no
///         Fallback. A map with flipped triangles is a result: see Measures.
/// @complexity about O(n^1.5) (sparse Cholesky factorizations).
/// @source Ruiz, Mejia, Cadavid 2015 (methods for trimmed surfaces).
Result<MeshParameterization> FlattenMesh(
  const TriangleMesh& mesh, const FlattenParams& params = {});
}
