// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/MeshFeatures.h>

#include <vector>

namespace knotwork
{
/// What tells how long edges are to be.
enum class EdgeSizing
{
  Constant = 0, ///< Size everywhere
  Curvature,    ///< as long as a chord may be, for Tolerance
  PerPoint      ///< Sizes, one a point
};

struct SurfaceRemeshParams
{
  EdgeSizing Sizing = EdgeSizing::Constant;
  /// Of Constant: length of edges, unit of the points, >= 0; 0: the mean of the input's edges.
  double Size = 0.0;
  /// Of PerPoint: length of edges at the points of the input, above 0. Between points it is linear.
  std::vector<double> Sizes;
  /// Of Curvature: distance of chords from the surface, share of the diagonal, ]0, 1].
  double Tolerance = 0.001;
  /// Of Curvature: bounds of the lengths, unit of the points, >= 0; 0: 0.005 and 0.1 of the
  /// diagonal.
  double SmallestSize = 0.0;
  double LargestSize = 0.0;
  MeshFeatureParams Features; ///< what sharp edges and corners are, which stay
  /// Times that edges are divided, joined and turned, and points moved, [1, 1000].
  int Iterations = 10;
  /// Farthest that the result may be from the input, and the input from the result, share of the
  /// diagonal of the input's box, ]0, 1]. Edges stay shorter than asked for where this demands it.
  double Limit = 0.01;
  int Threads = 0;
  ProgressCallback Progress;
};

struct RemeshNumbers
{
  int Points = 0; ///< that are used, equal ones being one
  int Triangles = 0;
  int Parts = 0;
  int Euler = 0; ///< points - edges + triangles
  double Area = 0.0;
  double Volume = 0.0;     ///< signed sum, of a closed surface its volume
  double LeastAngle = 0.0; ///< of all triangles, degrees
  double MeanEdge = 0.0;   ///< length
};

struct SurfaceRemesh
{
  TriangleMesh Mesh;
  std::vector<double> Sizes;    ///< length of edges that was asked for, one a point
  std::vector<int> TriangleIds; ///< of the input's triangle below the middle, one a triangle
  std::vector<int> RegionIds;   ///< between sharp edges and rims, one a triangle
  std::vector<int> PartIds;     ///< one a triangle
  std::vector<std::array<int, 2>> Lines; ///< edges on sharp edges and rims
  std::vector<int> LineChains;           ///< number of the chain of edges of the input, one a line
  std::vector<int> Corners;              ///< points that stayed
  RemeshNumbers Before;
  RemeshNumbers After;
  double FittingEdges = 0.0;      ///< share of edges within 4/5 and 4/3 of the length asked for
  int Intersections = 0;          ///< pairs of triangles that meet where they should not
  double DistanceFromInput = 0.0; ///< farthest that the result is from the input
  double DistanceToInput = 0.0;   ///< farthest that the input is from the result
  double Diagonal = 0.0;          ///< of the input's box
};

/// Triangles of lengths that are asked for on the surface of others: long edges are divided, short
/// ones joined, edges turned and points moved along the surface. Points lie on the input, those on
/// sharp edges and rims on these, corners stay. No step turns a triangle over against the input or
/// changes how the surface hangs together. Lengths that are asked for grow by half of the distance
/// at most.
/// Distances are bounds, above the largest distance by at most a tenth of the mean edge, of Limit,
/// or 2e-3 of the diagonal, but not less than 1e-4 of it.
/// @return EmptyInput; NonFiniteInput; InvalidTopology: what is no oriented manifold;
/// InvalidParameter; SizeMismatch: Sizes; TooLarge: more than 5e6 triangles; NotConverged: the
/// limit (place); Aborted.
/// @complexity O(n log n) an iteration.
/// @source Botsch, Kobbelt, A remeshing approach to multiresolution modeling, SGP 2004; Dunyach,
/// Vanderhaeghe, Barthe, Botsch, Adaptive remeshing for real-time mesh deformation, Eurographics
/// 2013 (lengths by curvature).
Result<SurfaceRemesh> RemeshSurface(
  const TriangleMesh& mesh, const SurfaceRemeshParams& params = {});
}
