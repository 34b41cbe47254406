// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/FitTarget.h>
#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/MeshParameterization/TriangleMesh.h>

namespace knotwork
{
/// How long edges of tetrahedra of one region are at most.
struct RegionSize
{
  Eigen::Vector3d Point = Eigen::Vector3d::Zero(); ///< in the region
  double Length = 0.0;                             ///< > 0
};

/// Lengths of edges at most on a background grid, linear in each of its tetrahedra; there are none
/// outside.
struct SizeField
{
  PointMatrix Points; ///< n x 3
  std::vector<std::array<int, 4>> Cells;
  std::vector<std::array<double, 4>> Lengths; ///< at the cells' corners, > 0
};

/// What a mesher is asked for.
struct TetrahedraParams
{
  /// Radius of the circumsphere over the shortest edge at most, [1, 10]; 0: no bound.
  double RadiusEdgeRatio = 2.0;
  double MinDihedralAngle = 5.0; ///< degrees, [0, 30]; 0: no bound
  double MaxVolume = 0.0;        ///< of a tetrahedron, >= 0, cube of the points' unit; 0: no bound
  std::vector<RegionSize> RegionSizes;
  SizeField Sizes;
  int MaxSteinerPoints = 1000000; ///< points that are added at most, >= 0
  bool KeepBoundary = true;       ///< triangles of the surface are not divided
};

/// Straight tetrahedra that fill all that triangles enclose, as a mesher hands them over.
struct Tetrahedra
{
  PointMatrix Points; ///< n x 3
  std::vector<std::array<int, 4>> Cells;
  std::vector<std::array<int, 3>> Triangles; ///< parts of the surface
  std::vector<int> Sources;                  ///< one a triangle: number in the surface
  std::vector<int> Labels;                   ///< one a cell, of a mesher that has such; else empty
  int Oversized = 0;                         ///< cells larger than was asked for
};

/// The mesher, which works in a process of its own. Its triangles bound solids (CheckSolid).
using TetrahedraMaker =
  std::function<Result<Tetrahedra>(const TriangleMesh& surface, const TetrahedraParams& params)>;

/// What becomes of the inside of parts that lie within a solid.
enum class InnerParts
{
  Voids,  ///< solid and void in turn, from outside
  Regions ///< all is filled
};

struct SolidMeshParams
{
  TetrahedraParams Tetrahedra;
  InnerParts Inner = InnerParts::Voids;
  bool Repair = false; ///< what bounds no solid is repaired first, with all its holes closed
  int Order = 1;       ///< of the cells, 1, 2 or 3
  int Threads = 0;     ///< 0: all cores
  ProgressCallback Progress;
};

struct SolidMeshNumbers
{
  double MinDihedral = 0.0; ///< degrees, of the straight tetrahedra
  double MaxDihedral = 0.0;
  double WorstRadiusEdgeRatio = 0.0;
  double Volume = 0.0;        ///< of the cells as they are
  double SurfaceVolume = 0.0; ///< that the given triangles enclose
  bool Repaired = false;
  /// Both with what repairing has moved at most.
  double DistanceToSurface = 0.0; ///< farthest that the straight boundary is from the surface
  double DistanceFromSurface = 0.0;
  double StraightToTarget =
    0.0; ///< largest sampled distance of the straight boundary; 0: no target
  double CurvedToTarget = 0.0;
  double Diagonal = 0.0;    ///< of the surface's box
  int BoundaryElements = 0; ///< with a face on the boundary
  int RelaxedElements = 0;  ///< with nodes that were moved back, see MeshSolid
  int Oversized = 0;        ///< straight cells that the mesher left larger than was asked for
};

struct SolidMesh
{
  PointMatrix Points; ///< corners first
  int NumCorners = 0;
  /// Points of the cells, in the order of the coefficients of a tetrahedron (CellCoefficient).
  std::vector<std::vector<int>> Cells;
  std::vector<int> Regions; ///< one a cell: pieces between the triangles of the surface, from 0
  int NumRegions = 0;
  std::vector<int> Labels;                  ///< one a cell; empty: the mesher has none
  std::vector<std::array<int, 3>> Boundary; ///< corners, outward or towards the higher region
  std::vector<int> BoundarySources;         ///< triangle of the given surface, -1: repair made it
  JacobianCertificate Certificate;
  SolidMeshNumbers Numbers;
};

/// Number of points of a cell: 4, 10, 20.
int NumTetrahedronPoints(int order);

/// A triangle of the boundary as a cell.
struct SolidMeshFacet
{
  int Cell = -1;          ///< a tetrahedron that has it, the first of two
  std::vector<int> Nodes; ///< points, in the order of the coefficients of a triangle
};

/// The boundary's triangles with all points that cells have there. @param order  of the cells.
std::vector<SolidMeshFacet> BoundaryFacets(const SolidMesh& mesh, int order);

/// Fills a closed surface with tetrahedra. Of order 2 and 3 the points of the boundary lie on the
/// target: those of faces on the face that the triangle lies on, those of edges between faces on
/// their curve, corners of the target stay corners; cells that would lie flat on a smooth boundary
/// are divided before (DivideFlatCorners). All cells are certified. Where one is not
/// valid, its points are moved back towards the straight tetrahedron, by a part of the way that
/// doubles each time, until it and its neighbours are (CurveElements).
/// @param target  null: the surface itself, nothing is curved.
/// @return the errors of CheckSolid, the maker and the target; InvalidParameter, also for a size of
/// a region whose point no tetrahedron has; SizeMismatch for a field of sizes; LibraryError for
/// tetrahedra that do not fill the surface; NotConverged for straight cells that are not valid;
/// Aborted.
/// @complexity the maker's, and O(n log n); a certificate of every cell.
Result<SolidMesh> MeshSolid(const TriangleMesh& surface, const FitTarget* target,
  const TetrahedraMaker& maker, const SolidMeshParams& params = {});
}
