// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/CellMesh.h>
#include <knotwork/SplineCore/PointSlide.h>

namespace knotwork
{
struct UntanglingParams
{
  /// Cells that are given a better shape though they are not folded: what is made of them is.
  std::vector<int> Poor;
  /// Cells around these and folded ones, ring by ring, whose points may move. >= 0.
  int Rings = 2;
  /// Edges of the surface between normals that differ by more degrees stay edges; where chains of
  /// edges turn by more than 30 degrees corners stay. In [0, 180]; 180: only rims are edges.
  double FeatureAngle = 45.0;
  /// Edges of quadrilaterals that stay edges at any angle.
  std::vector<CellSide> Features;
  /// Where points may move; null: the surface that the mesh was, its edges and rims. With one edges
  /// do not give way, and the angle and marked edges have no say.
  const PointSlide* Slide = nullptr;
  /// Passes over the points that may move, of each attempt; it ends when no point moves by more
  /// than a thousandth of its edges. >= 1.
  int MaxSweeps = 100;
  ProgressCallback Progress;
};

struct UntangledMesh
{
  PointMatrix Points;
  std::vector<int> FoldedBefore; ///< cells
  std::vector<int> Folded;       ///< those that still are
  int NumMoved = 0;              ///< points
  double LargestMove = 0.0;
};

/// Cells with det J <= 0 somewhere: hexahedra at one of 27 points of a grid, against the sign that
/// most have; quadrilaterals, in the plane against the sign that most have, at a corner, in space
/// seen along the cross product of their own diagonals.
/// @param points  NumPoints x 2 (quadrilaterals) or 3.
/// @return SizeMismatch, NonFiniteInput. @complexity O(cells).
template <int Dim>
Result<std::vector<int>> FoldedCells(const CellMesh<Dim>& mesh, const PointMatrixView& points);

/// Moves points around folded cells until none is folded, and then until the cells have good
/// shapes; everything else stays to the last bit. Points inside move freely; those of surfaces
/// slide on the surface that the mesh was, those of its sharp edges and its rim along them, and
/// corners stay. The shape that cells are drawn to has the mean lengths that edges had along
/// each sheet. Where cells stay folded there are two attempts more, with a ring more each, and
/// sharp edges that have not been marked give way, in the last one all.
/// @return SizeMismatch, NonFiniteInput with the point, InvalidParameter, Aborted. Cells that stay
/// folded are in the result.
/// @complexity O(folded cells * cells of a ring) a sweep.
/// @source  Escobar, Rodriguez, Montenegro, Montero, Gonzalez-Yuste, CMAME 192 (2003) 2775-2787
/// (the shape that is minimized, and that it has no pole where cells are folded).
template <int Dim>
Result<UntangledMesh> UntangleMesh(const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology,
  const PointMatrixView& points, const UntanglingParams& params = {});
}
