// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SurfaceTrimming/TrimmedMesh.h>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace knotwork
{
/// The outputs of vtkCADReader.
/// @param meshing  null: no triangles.
/// @return failures of EncodeTrimmedModel and TriangulateFaces.
Status EncodeCAD(const TrimmedModel& model, const TrimmedMeshParams* meshing,
  vtkUnstructuredGrid* surfaces, vtkUnstructuredGrid* curves, vtkPolyData* triangles);
}
