// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkMeshParameterizationModule.h" // for export macro
#include <knotwork/MeshParameterization/FlattenCharts.h>

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
  int Divided = 0;        ///< faces of more corners, which are several triangles
};

/// Triangles of a data set; quads, polygons and strips are divided into triangles between their
/// corners. Vertices and lines are not looked at.
/// @return InvalidTopology: polygons that cannot be divided, since they cross themselves or have no
/// area, other cells of two or three dimensions (ids).
VTKKNOTWORKMESHPARAMETERIZATION_EXPORT Result<DecodedMesh> DecodeMesh(vtkPointSet* data);

/// The triangles of all charts with the point and cell data of their origin (linear where a cut
/// made a point), chart by chart with points of its own; the point arrays `UV` (also the texture
/// coordinates) and `CutPointId` (equal on copies of a point), the cell arrays `ChartId`,
/// `SingularValues` and `Flipped`.
/// @param flat  points are (u, v, 0) instead of those of the input.
void EncodeMesh(const DecodedMesh& decoded, const ChartedMesh& charted, vtkPointSet* input,
  bool flat, vtkPolyData* output);

/// One closed polyline a loop, chart by chart, the outer one first, with `UV`, `PointIds` of the
/// input (-1 where a cut made a point), `CutPointId`, and the cell arrays `Chart`, `Loop` (number
/// in its chart) and `Length`.
void EncodeLoops(const ChartedMesh& charted, bool flat, vtkPolyData* output);

/// One row with all numbers of the report.
void EncodeSummary(
  const DecodedMesh& decoded, const ChartedMesh& charted, FlattenMethod asked, vtkTable* output);

/// Methods that were used, in the order of the first charts: "hlle, injective".
std::string DescribeMethods(const ChartedMesh& charted);

/// Why another method than the one asked for was used, in one sentence; empty when none was.
std::string DescribeFallbacks(const ChartedMesh& charted);
}
