// SPDX-License-Identifier: BSD-3-Clause
// Meshes of quadrilaterals and hexahedra from datasets.
#pragma once
#include <knotwork/SplineCore/CellMesh.h>
#include <knotwork/SplineGrid/SplineModel.h>

#include <string>
#include <variant>
#include <vector>

class vtkDataArray;
class vtkPointSet;

namespace knotwork
{
/// A mesh with what stands at its points: points and cells have the numbers of the dataset, unless
/// polygons were split or Bezier cells tell their vertices (MeshVertices.h).
struct DecodedMeshCells
{
  std::variant<CellMesh<2>, CellMesh<3>> Mesh;
  PointMatrix Points;              ///< coordinates, then the fields
  std::vector<SplineField> Fields; ///< names and numbers of columns
  std::vector<vtkIdType> Cells;    ///< of the dataset
  int NumSplit = 0;                ///< polygons of other than four corners
  /// Point of the dataset at every vertex that Bezier cells tell; empty: points are those of the
  /// dataset.
  std::vector<vtkIdType> Vertices;
};

/// @param split  polygons into quadrilaterals at their middles.
/// @return EmptyInput without cells; InvalidTopology naming the first cell that is neither a linear
/// quadrilateral nor a linear hexahedron, or not what the first one is, and the vertex that Bezier
/// cells have at two places; InvalidParameter for splines without vertices and for a volume that is
/// to be split; NonFiniteInput; TooLarge.
VTKKNOTWORKSPLINEGRID_EXPORT Result<DecodedMeshCells> DecodeMeshCells(
  vtkPointSet* data, bool split);

/// How the cells hang together. @return failures of CheckConforming and MeshTopology::Make.
template <int Dim>
VTKKNOTWORKSPLINEGRID_EXPORT Result<MeshTopology<Dim>> MakeConforming(
  const CellMesh<Dim>& mesh, const DecodedMeshCells& decoded);

/// Values of a cell array at the cells of a mesh.
/// @return InvalidParameter for an array that is not there or has several components.
VTKKNOTWORKSPLINEGRID_EXPORT Result<std::vector<double>> CellLabels(
  vtkPointSet* data, const std::string& name, const DecodedMeshCells& mesh);

/// Facets where quadrilaterals meet at more than an angle, and between cells of different values.
/// @param angle  in degrees; 180: none. @param array  of cells; empty or "None": none.
/// @return InvalidParameter for an angle of hexahedra, a cell array that is not there or has
/// several components.
template <int Dim>
VTKKNOTWORKSPLINEGRID_EXPORT Result<std::vector<CellSide>> FindFeatures(vtkPointSet* data,
  const DecodedMeshCells& decoded, const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology,
  double angle, const std::string& array);
}
