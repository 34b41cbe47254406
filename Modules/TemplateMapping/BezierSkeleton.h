// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/TemplateMapping/Skeleton.h>

#include <string>
#include <vector>

class vtkUnstructuredGrid;

namespace knotwork
{
class SkeletonCells;

/// Patches of a grid of Bezier cells: spline grids and grids of foreign origin, sampled
/// (SkeletonSampling.h). Curves become patches of the plane, quadrilaterals and triangles patches
/// in space; patches with triangles are taken cell by cell.
/// @param cells     of the grid, Bezier cells of dimension Dim - 1.
/// @param name      "template" or "target", for messages.
/// @param samples   points a patch, [2, 10^7]; 0: the kernel's default.
/// @param warnings  receives what the decoder of spline grids found worth knowing; may be null.
template <int Dim>
Result<Skeleton<Dim>> DecodeBezierSkeleton(vtkUnstructuredGrid* grid, const SkeletonCells& cells,
  const std::string& name, int samples, std::vector<std::string>* warnings);
}
