// SPDX-License-Identifier: BSD-3-Clause
#include "WitnessGrid.h"

#include "vtkJacobianValidator.h"
#include <knotwork/SplineGrid/NamedArray.h>

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

namespace knotwork
{
namespace
{
/// VTK's linear cell of a shape; its corners in the order of CornerParameters are those of VTK but
/// for quadrilaterals and hexahedra, where VTK goes around.
int LinearCellType(CellShape shape)
{
  constexpr int types[NumCellShapes] = { VTK_LINE, VTK_QUAD, VTK_HEXAHEDRON, VTK_TRIANGLE,
    VTK_TETRA, VTK_WEDGE };
  return types[static_cast<int>(shape)];
}
std::size_t CornerOfVtk(CellShape shape, std::size_t corner)
{
  const bool around = shape == CellShape::Quadrilateral || shape == CellShape::Hexahedron;
  return around ? corner ^ (corner >> 1 & 1) : corner;
}

class WitnessGrid
{
public:
  WitnessGrid(const BernsteinCells& cells, const CellNames& names, vtkUnstructuredGrid* output)
    : Cells(cells), NameOf(names), Output(output)
  {
    if (!output->GetPoints())
    {
      vtkNew<vtkPoints> points;
      points->SetDataTypeToDouble();
      output->SetPoints(points);
      output->Allocate();
      output->GetPointData()->AddArray(NamedArray<vtkDoubleArray>("LocalParameters", 3));
      output->GetCellData()->AddArray(NamedArray<vtkIntArray>("Kind"));
      output->GetCellData()->AddArray(NamedArray<vtkIdTypeArray>("CellId"));
      output->GetCellData()->AddArray(NamedArray<vtkIntArray>("Block"));
      output->GetCellData()->AddArray(NamedArray<vtkIntArray>("PatchId"));
      output->GetCellData()->AddArray(NamedArray<vtkDoubleArray>("JacobianUpper"));
    }
  }

  void AddPoint(int kind, int cell, double upper, const std::array<double, 3>& at)
  {
    const vtkIdType vertex = this->InsertPoint(cell, at);
    this->AddCell(kind, cell, upper, VTK_VERTEX, 1, &vertex);
  }

  void AddBox(const JacobianWitness& witness)
  {
    const CellShape shape = this->Cells.Shapes[static_cast<std::size_t>(witness.Cell)];
    std::array<vtkIdType, 8> corners{};
    for (std::size_t c = 0; c < static_cast<std::size_t>(witness.NumCorners); ++c)
    {
      corners[c] = this->InsertPoint(witness.Cell, witness.Corners[CornerOfVtk(shape, c)]);
    }
    this->AddCell(vtkJacobianValidator::FOLDED_BOX, witness.Cell, witness.Upper,
      LinearCellType(shape), witness.NumCorners, corners.data());
  }

private:
  vtkIdType InsertPoint(int cell, const std::array<double, 3>& at)
  {
    double x[3] = {};
    EvaluateCell(this->Cells, cell, at, x);
    this->Output->GetPointData()->GetArray("LocalParameters")->InsertNextTuple(at.data());
    return this->Output->GetPoints()->InsertNextPoint(x);
  }

  void AddCell(int kind, int cell, double upper, int type, vtkIdType count, const vtkIdType* ids)
  {
    const CellName name = this->NameOf(cell);
    const vtkIdType number = this->Output->InsertNextCell(type, count, ids);
    vtkCellData* data = this->Output->GetCellData();
    const auto add = [&](const char* array, double value)
    { data->GetArray(array)->InsertTuple1(number, value); };
    add("Kind", kind);
    add("CellId", static_cast<double>(name.Number));
    add("Block", name.Block);
    add("PatchId", name.Patch);
    add("JacobianUpper", upper);
    if (name.Element >= 0 || data->HasArray("ElementNumber") != 0) // in the file, where cells know
    {
      if (data->HasArray("ElementNumber") == 0)
      {
        const auto elements = NamedArray<vtkIdTypeArray>("ElementNumber", 1, number);
        elements->FillValue(-1);
        data->AddArray(elements);
      }
      add("ElementNumber", static_cast<double>(name.Element));
    }
  }

  const BernsteinCells& Cells;
  const CellNames& NameOf;
  vtkUnstructuredGrid* Output;
};
}

void ShowFolds(const BernsteinCells& cells, const CellNames& names,
  const std::vector<JacobianWitness>& witnesses, vtkUnstructuredGrid* output)
{
  WitnessGrid grid(cells, names, output);
  for (const JacobianWitness& witness : witnesses)
  {
    grid.AddPoint(
      vtkJacobianValidator::FOLDED_POINT, witness.Cell, witness.Upper, witness.Parameters);
    if (witness.NumCorners > 0)
    {
      grid.AddBox(witness);
    }
  }
}

void ShowOverlap(const BernsteinCells& cells, const CellNames& names,
  const std::vector<CellCertificate>& certificates, const InjectivityCertificate& injectivity,
  vtkUnstructuredGrid* output)
{
  WitnessGrid grid(cells, names, output);
  if (injectivity.Verdict == InjectivityVerdict::NotInjective &&
    injectivity.Reason == InjectivityReason::Overlap && injectivity.HasWitness)
  {
    for (const auto& place : injectivity.Witness.Places)
    {
      grid.AddPoint(vtkJacobianValidator::OVERLAP, place.Cell,
        certificates[static_cast<std::size_t>(place.Cell)].MaxUpper, place.Parameters);
    }
  }
}
}
