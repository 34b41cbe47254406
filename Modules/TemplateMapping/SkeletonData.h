// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TemplateMap.h"

class vtkPolyData;
class vtkTable;

/// Between datasets and the kernel of template mapping. Internal to the module.
namespace knotwork
{
/// Polylines with the cell array PatchId to patches, in the order of each id's first cell; a
/// patch's cells are joined in their order. Point arrays Parameter and Normals are taken when they
/// are there. Coordinates z must be 0 to 1e-9 of the data's size.
/// @param name  "template" or "target", for messages.
/// @return InvalidTopology (other cells, no PatchId, cells that do not join), DimensionMismatch
/// (z), NonFiniteInput, SizeMismatch (arrays of the wrong components).
Result<Skeleton<2>> DecodeSkeleton(vtkPolyData* data, const char* name);

/// Polylines with cell array PatchId and point arrays PatchId, Parameter, Distance.
void EncodeMappedSkeleton(const std::vector<MappedSkeletonPatch>& patches, vtkPolyData* output);

/// One row an iteration.
void EncodeConvergence(const std::vector<TemplateMapIteration>& history, vtkTable* table);
}
