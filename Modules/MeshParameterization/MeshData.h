// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshParameterization.h"
#include "vtkKnotworkMeshParameterizationModule.h" // for export macro

class vtkPointSet;
class vtkPolyData;
class vtkTable;

namespace knotwork
{
/// A mesh and where its triangles come from.
struct DecodedMesh
{
  TriangleMesh Mesh;
  std::vector<int> Cells; ///< of the data set, one a triangle
};

/// Triangles of a data set; vertices and lines are not looked at.
/// @return InvalidTopology: other cells of two or three dimensions (ids).
VTKKNOTWORKMESHPARAMETERIZATION_EXPORT Result<DecodedMesh> DecodeMesh(vtkPointSet* data);

/// The flattened triangles with the point and cell data of their origin, the point array `UV` (also
/// the texture coordinates) and the cell arrays `SingularValues` and `Flipped`.
/// @param flat  points are (u, v, 0) instead of those of the input.
void EncodeMesh(const DecodedMesh& decoded, const MeshParameterization& map, vtkPointSet* input,
  bool flat, vtkPolyData* output);

/// One closed polyline a loop, the outer one first, with `UV`, the input's ids of points, and the
/// cell arrays `Loop` and `Length`.
void EncodeLoops(const MeshParameterization& map, bool flat, vtkPolyData* output);

/// One row with all numbers of the report.
void EncodeSummary(const MeshParameterization& map, FlattenMethod asked, vtkTable* output);
}
