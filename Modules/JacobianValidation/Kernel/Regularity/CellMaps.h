// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/JacobianValidation/BoundaryInjectivity.h>

#include <array>
#include <cstdint>
#include <vector>

namespace knotwork
{
/// What the cells of a dataset in space are maps of; every cell is in one of the lists, by its
/// number, in ascending order.
struct CellMaps
{
  /// Quadrilaterals and triangles that are maps of a plane z = const, plane by plane, by ascending
  /// z.
  std::vector<std::vector<int>> Planes;
  std::vector<int> Volumes;
  std::vector<int> Others; ///< surfaces and curves in space
  bool HasMaps() const { return !this->Planes.empty() || !this->Volumes.empty(); }
};

/// Quadrilaterals and triangles that have an edge in common (ends that agree within 1e-6 of its
/// length), or belong to one patch, are parts of one surface. A surface whose control points all
/// have the same z (within 2^-48 of it) is a map of that plane, and turned or folded where it is
/// turned or folded there; every other is a surface in space, which has no right way round. Other
/// cells, and surfaces that this one has no edge in common with, do not matter.
/// @param patches  one a cell, or empty: no patches.
/// @pre cells.NumComponents is 3 and cells.Check() is Ok.   @complexity O(n log n) of mixed
/// surfaces
CellMaps FindCellMaps(const BernsteinCells& cells, const std::vector<int>& patches);

/// A quadrilateral or triangle, as far as FindCellMaps looks at it: for datasets of which several
/// processes have parts, whose lists are joined.
struct SurfaceCell
{
  std::int64_t Patch = -1; ///< -1: none
  bool IsFlat = false;     ///< all of its control points have the same z
  double Height = 0.0;     ///< z of the first one
};

/// An edge of one.
struct SurfaceEdge
{
  int Surface = 0; ///< into the list of surface cells
  std::array<std::array<double, 3>, 2> Ends{};
};

/// The quadrilaterals and triangles of cells, in their order.
/// @param patches  one a cell, or empty.
std::vector<SurfaceCell> SurfaceCellsOf(
  const BernsteinCells& cells, const std::vector<std::int64_t>& patches);
std::vector<SurfaceEdge> SurfaceEdgesOf(const BernsteinCells& cells);

/// Whether FindPlanes needs the edges: not when none is flat, or when all are in one plane.
bool NeedsEdges(const std::vector<SurfaceCell>& cells);

/// Whether surface cells belong to surfaces that are maps of planes.
/// @param edges  all of them; empty where NeedsEdges says so.
std::vector<bool> FindPlanes(
  const std::vector<SurfaceCell>& cells, const std::vector<SurfaceEdge>& edges);

/// The maps when it is known of the surface cells, in their order, which are maps of planes.
CellMaps MakeCellMaps(const BernsteinCells& cells, const std::vector<bool>& isOfPlane);

/// Some of the cells, of the first components alone; rational when one of them has weights that
/// differ.
BernsteinCells SelectCells(
  const BernsteinCells& cells, const std::vector<int>& which, int numComponents);

/// ValidateJacobian of every cell as what it is a map of, and as polynomial or rational as it is by
/// itself: a cell's certificate is the same whatever stands beside it, as long as there are boxes
/// enough (JacobianParams::MaxBoxes is for all cells of a kind).
Result<JacobianCertificate> ValidateMaps(const BernsteinCells& cells, const CellMaps& maps,
  const JacobianParams& params = {}, const ProgressCallback& progress = {});

/// ProveInjectivity of every plane's map and of the volumes; surfaces and curves in space have no
/// part in it. The verdict is the least of all, with its reason and place; numbers are sums.
/// @pre maps.HasMaps().
Result<InjectivityCertificate> ProveMapsInjective(const BernsteinCells& cells, const CellMaps& maps,
  const CellComplex& complex, const JacobianCertificate& certificate,
  const InjectivityParams& params = {}, const ProgressCallback& progress = {});
}
