// SPDX-License-Identifier: BSD-3-Clause
// Critical points of patches as VTK data; private to vtkSplineExtrema.
#pragma once
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SurfaceFeatures/CriticalPoints.h>

class vtkPolyData;
class vtkTable;

namespace knotwork
{
/// The function on a surface patch: a field by its name, or the geometry when the name is empty.
/// @param component  out: 0 for fields of one component.
/// @return InvalidParameter naming field, component and patch; DimensionMismatch.
Result<Spline<2>> FunctionOf(const SplinePatch& patch, const std::string& field, int& component);

struct PatchPoints
{
  const SplinePatch* Patch = nullptr;
  CriticalPoints Found;
};

struct ExtremaChoice
{
  std::array<bool, 3> Kinds{ true, true, true };
  bool OnSurface = true;
  int Threads = 0;
};

/// Fills the outputs of vtkSplineExtrema.
Status EncodeExtrema(const std::vector<PatchPoints>& patches, const ExtremaChoice& choice,
  vtkPolyData* points, vtkPolyData* boxes);
void EncodeCounts(const std::vector<PatchPoints>& patches, vtkTable* table);

/// Makes the outputs of processes pieces of one: points and clusters are counted on, the numbers
/// are of all, in the first process.
/// @pre all processes call it.
void MergeExtrema(vtkPolyData* points, vtkPolyData* boxes, vtkTable* table);
}
