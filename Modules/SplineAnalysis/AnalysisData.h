// SPDX-License-Identifier: BSD-3-Clause
// Bodies for analysis from datasets, and results to them.
#pragma once
#include <knotwork/SplineAnalysis/GalerkinSpace.h>
#include <knotwork/SplineAnalysis/ProblemDescription.h>
#include <knotwork/SplineGrid/SplineModel.h>

class vtkDataObject;
class vtkUnstructuredGrid;

namespace knotwork
{
/// A body that splines or elements fill.
struct AnalysisBody
{
  GalerkinSpace Space;
  BoundaryGroups Boundary;
  /// The patches of splines; none of a mesh. Elements are theirs in order.
  SplineModel Model;
  std::vector<std::vector<int>> Functions; ///< of Space, a patch each, by those of the patch
  /// Of a mesh: cell of every element, point of every function.
  std::vector<vtkIdType> Cells;
  std::vector<vtkIdType> Points;
  int NumLeftOut = 0; ///< cells of fewer dimensions than others
};

/// Whether cells of the most dimensions are Bezier quadrilaterals or hexahedra.
bool IsOfSplines(vtkDataObject* data);

/// The patches with what is stated of their sides, or else with the interfaces that they have.
template <int Dim>
MultiPatch<Dim> GluedPatches(const SplineModel& model);

/// @return MakeGalerkinSpace's and BoundaryFacets' failures; DimensionMismatch for splines of
/// several dimensions, for curves, and for surfaces that leave the plane z = 0.
Result<AnalysisBody> MakeBody(SplineModel model);

/// Elements of any shape and order; of cells of several dimensions those of the most are taken, and
/// the others, where they lie on the boundary, are groups of facets by the cell array
/// PhysicalGroup.
/// @return EmptyInput; ReadGridCells' and MakeCellConversion's failures; DimensionMismatch,
/// InvalidTopology for wedges and rational cells.
Result<AnalysisBody> MakeBody(vtkUnstructuredGrid* grid);

/// A field by functions with its name.
struct AnalysisField
{
  std::string Name;
  PointMatrix Coefficients; ///< functions x components
};
struct AnalysisCellField
{
  std::string Name;
  Eigen::VectorXd Values; ///< of elements
};

/// The input with fields. @param output  of the input's class.
Status EncodeBody(AnalysisBody& body, const std::vector<AnalysisField>& fields,
  const std::vector<AnalysisCellField>& cellFields, vtkDataObject* input, vtkDataObject* output);
}
