// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/MfemMesh.h>

class vtkUnstructuredGrid;

namespace knotwork
{
/// Linear or Bezier cells with the cell arrays Attribute and, Bezier cells, MeshVertices.
/// @pre mesh is no spline.
void EncodeMfemCells(const MfemMesh& mesh, vtkUnstructuredGrid* grid);

/// The attribute of the patch of every cell as cell array. @pre grid was encoded of the splines.
void AddPatchAttributes(const MfemMesh& mesh, vtkUnstructuredGrid* grid);
}
