// SPDX-License-Identifier: BSD-3-Clause
// A mesh that is laid onto its target, private to the kernel.
#pragma once
#include "CADFit.h"
#include "MeshClassification.h"

#include <set>

namespace knotwork
{
/// What differs between attempts to lay a mesh onto its target.
struct PlacementChoice
{
  std::set<int> LeftOut; ///< curves of the target
  std::set<int> LeftOutCorners;
  bool Layer = false; ///< whether one is put under the surface, where it is needed and allowed
};

/// A mesh, its surface, and where that belongs on the target.
template <int Dim>
struct FittedMesh
{
  const PointMatrix* Given = nullptr; ///< points as given, not copied
  FitTargetPtr Target;                ///< or the mesh itself; null: neither
  PlacementChoice Choice;             ///< with the curves that were given up
  bool IsFitted = true;               ///< whether there is a target but the mesh
  bool IsPart = false;                ///< whether some of the cells are fitted
  bool HasSurfaces = false;           ///< whether faces are fitted
  bool IsPlaced = false;              ///< whether points were moved
  bool IsLayerNeeded = false;
  CellMesh<Dim> Mesh;      ///< with a layer, or as given
  PointMatrix Points;      ///< of the mesh, on the target
  std::vector<int> CellOf; ///< as CADFit
  int LayerCells = 0;
  int FoldedCells = 0;     ///< of the mesh as given
  std::vector<int> Folded; ///< cells as they are now
  MeshTopology<Dim> Topology;
  SurfaceMesh Surface;            ///< of the cells that are fitted
  std::vector<char> PointsBeside; ///< of the surface that is not fitted
  MeshClassification Parts;

  /// Classifies the surface of a mesh on its target and moves its points there. Curves that fold
  /// cells are given up; a layer is put under the surface if that is chosen.
  /// @param points  NumPoints x 3, finite; must outlive this. @param target  null: the mesh.
  /// @return InvalidParameter for a mesh far from its target and FittedCells without a facet;
  /// InvalidTopology, also for hexahedra and a target with a rim; the target's errors; Aborted.
  Status Place(const CellMesh<Dim>& mesh, const PointMatrix& points, const FitTargetPtr& target,
    const PlacementChoice& choice, const CADFitParams& params);
  /// Moves points onto what they are classified as, from where they are.
  /// @param poor  cells that get a better shape though they are not folded.
  /// @return the errors of MoveOntoTarget.
  Status MovePoints(const std::vector<int>& poor, const CADFitParams& params);
  /// Curves of the target that are matched, at points of some cells.
  std::set<int> CurvesAt(const std::vector<int>& cells) const;
  /// Corners of the target that are points of some cells.
  std::set<int> CornersAt(const std::vector<int>& cells) const;
};
}
