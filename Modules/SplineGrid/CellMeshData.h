// SPDX-License-Identifier: BSD-3-Clause
// Meshes of quadrilaterals and hexahedra from datasets, private to the module.
#pragma once
#include "SplineModel.h"
#include <knotwork/SplineCore/CellMesh.h>

#include <string>
#include <variant>
#include <vector>

class vtkDataArray;
class vtkPointSet;

namespace knotwork
{
/// A mesh with what stands at its points: points and cells have the numbers of the dataset, unless
/// polygons were split.
struct DecodedMeshCells
{
  std::variant<CellMesh<2>, CellMesh<3>> Mesh;
  PointMatrix Points;              ///< coordinates, then the fields
  std::vector<SplineField> Fields; ///< names and numbers of columns
  std::vector<vtkIdType> Cells;    ///< of the dataset
  int NumSplit = 0;                ///< polygons of other than four corners
};

/// @param split  polygons into quadrilaterals at their middles.
/// @return EmptyInput without cells; InvalidTopology naming the first cell that is neither a linear
/// quadrilateral nor a linear hexahedron, or not what the first one is; InvalidParameter for
/// splines and for a volume that is to be split; NonFiniteInput; TooLarge.
Result<DecodedMeshCells> DecodeMeshCells(vtkPointSet* data, bool split);

/// A value a cell of the mesh. @return InvalidParameter for a cell array that is not there or has
/// several components.
Result<std::vector<double>> CellLabels(
  vtkPointSet* data, const std::string& name, const DecodedMeshCells& mesh);
}
