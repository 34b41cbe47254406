// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkTemplateMappingModule.h" // for export macro
#include <knotwork/TemplateMapping/TemplateMap.h>

#include <string>
#include <vector>

class vtkDataSet;
class vtkPolyData;
class vtkTable;

/// Between datasets and the kernel of template mapping. Internal to the module.
namespace knotwork
{
/// Dimension of the space that the skeletons of two datasets lie in: 2 when their cells are curves,
/// 3 when they are faces, 0 when both are empty; an empty one goes with the other.
/// @return InvalidTopology: mixed or unfit cells, of one dataset or of both.
VTKKNOTWORKTEMPLATEMAPPING_EXPORT Result<int> SkeletonDimension(
  vtkDataSet* templateData, vtkDataSet* target);

/// Cells with the cell array PatchId to patches, in the order of each id's first cell. Data is a
/// vtkPolyData or a vtkUnstructuredGrid; without cells it gives no patches.
///
/// Dim 2: a patch's polylines are joined in their order; coordinates z must be 0 to 1e-9 of the
/// data's size. Dim 3: triangles, strips, and polygons that are flat and convex, which become fans;
/// a patch has copies of its points in the order of their ids. Point arrays Normals (3 components)
/// and Parameter (Dim - 1) are taken when they are there. Bezier curves, quadrilaterals and
/// triangles: BezierSkeleton.h; their normals and parameters are computed.
/// @param name  "template" or "target", for messages.
/// @param samples  points a patch of Bezier cells at least, [2, 10^7]; 0: SkeletonSampling.h.
/// @param warnings  receives what is worth knowing; may be null.
/// @return InvalidTopology (other cells, no PatchId, cells that do not join, polygons that are not
/// flat and convex), DimensionMismatch (z), NonFiniteInput, SizeMismatch (arrays of the wrong
/// components), InvalidParameter (samples).
template <int Dim>
VTKKNOTWORKTEMPLATEMAPPING_EXPORT Result<Skeleton<Dim>> DecodeSkeleton(vtkDataSet* data,
  const char* name, int samples = 0, std::vector<std::string>* warnings = nullptr);

/// Polylines (with the point array Parameter) or triangles, with cell array PatchId and point
/// arrays PatchId, Distance.
VTKKNOTWORKTEMPLATEMAPPING_EXPORT void EncodeMappedSkeleton(
  const std::vector<MappedSkeletonPatch>& patches, vtkPolyData* output);

/// One row an iteration.
void EncodeConvergence(const std::vector<TemplateMapIteration>& history, vtkTable* table);
}
