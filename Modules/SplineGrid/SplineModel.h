// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineCore/MultiPatch.h>

#include "vtkType.h"

#include <string>
#include <vector>

class vtkDataObject;
class vtkDataSet;
class vtkUnstructuredGrid;

/// The bridge between VTK datasets and the kernels: every filter decodes with it, calls a kernel,
/// and encodes with it. The schema and the rules of decoding are on the module's page.
namespace knotwork
{
/// A floating-point point array of a spline grid: coefficients in the geometry's own space, with
/// the geometry's weights.
struct SplineField
{
  std::string Name;
  PointMatrix Coefficients; ///< NumFunctions x components
};

/// One patch of a spline grid.
struct SplinePatch
{
  int Id = 0;         ///< PatchId
  int Block = 0;      ///< partitioned dataset of the collection the patch came from; 0 for one grid
  AnySpline Geometry; ///< 1, 2 or 3 parameters; ControlPoints always NumFunctions x 3
  std::vector<SplineField> Fields;
  /// Cell of the decoded grid (of its block) of every element; empty for new patches.
  std::vector<vtkIdType> Cells;
  bool Recovered =
    false; ///< control points were recovered from the points, not taken from the cache
  double Residual = 0.0;      ///< of the recovery, unit of the points
  double Amplification = 1.0; ///< of the recovery
};

/// All patches of a dataset, with what a user should know about the decoding.
struct SplineModel
{
  std::vector<SplinePatch> Patches;
  /// What is stated of their sides, by index into Patches: whoever exchanges patches clears it.
  PatchTopology Topology;
  std::vector<std::string> Warnings;
};

/// Decodes a vtkUnstructuredGrid or a vtkPartitionedDataSetCollection of such grids. An empty grid
/// gives a model without patches. Bezier cells without our field data become patches of kind Bezier
/// (by PatchId when there is one, else one patch per parametric dimension).
/// @param threads  0 = all cores; the model is the same for any number.
/// @return InvalidTopology, NonFiniteInput, InvalidWeight, ... with patch and cell: damage is never
/// mis-decoded.
VTKKNOTWORKSPLINEGRID_EXPORT Result<SplineModel> DecodeSplineModel(
  vtkDataObject* data, int threads);

/// Encodes the patches (of all blocks) as one grid: Bezier cells, shared points, attributes, cell
/// arrays PatchId, ElementId, Level, ParametricBounds, the field-data schema with control-point
/// cache and the topology.
VTKKNOTWORKSPLINEGRID_EXPORT Status EncodeSplineGrid(
  const SplineModel& model, vtkUnstructuredGrid* grid);

/// Encodes into output, which is a vtkUnstructuredGrid or, keeping the blocks of like (names, empty
/// pieces and patches of other kinds), a vtkPartitionedDataSetCollection; a block has the
/// interfaces between its own patches.
VTKKNOTWORKSPLINEGRID_EXPORT Status EncodeSplineModel(
  const SplineModel& model, vtkDataObject* like, vtkDataObject* output);

/// Copies cell arrays (other than ours) of input to output: sourceCells[i] is the input cell of
/// output cell i, -1 for none.
VTKKNOTWORKSPLINEGRID_EXPORT void PassCellData(
  vtkDataSet* input, const std::vector<vtkIdType>& sourceCells, vtkDataSet* output);

/// Index of a Bernstein coefficient (first direction fastest) for every VTK point of a Bezier
/// curve, quadrilateral or hexahedron: result[vtkPoint] = i + (p + 1) (j + (q + 1) k).
template <int Dim>
std::vector<int> VtkPointOrder(const IntArray<Dim>& degree);
}
