// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineParametricMesh.h"

#include "SplineBlocks.h"
#include "SplineModel.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <map>

using knotwork::Status;

vtkStandardNewMacro(vtkSplineParametricMesh);

namespace
{
constexpr int cellTypes[4] = { VTK_VERTEX, VTK_LINE, VTK_QUAD, VTK_HEXAHEDRON };

/// Elements of Bezier patches stand in rows of so many.
template <int Dim>
int RowLength(const knotwork::SplineSpace<Dim>& space)
{
  return Dim == 1
    ? space.NumElements()
    : static_cast<int>(std::ceil(std::sqrt(static_cast<double>(space.NumElements()))));
}

/// First parameter's range that a patch takes.
std::array<double, 2> RangeOf(const knotwork::SplinePatch& patch)
{
  return std::visit(
    [](const auto& spline) -> std::array<double, 2>
    {
      if (!spline.Space->HasDomain())
      {
        return { 0.0, static_cast<double>(RowLength(*spline.Space)) };
      }
      const auto domain = spline.Space->Domain();
      return { domain.Lower[0], domain.Upper[0] };
    },
    patch.Geometry);
}

/// Elements of one block.
class Mesh
{
public:
  Mesh()
  {
    this->Points->SetDataTypeToDouble();
    this->Parameters->SetName("Parameters");
    this->Parameters->SetNumberOfComponents(3);
    this->PatchId->SetName("PatchId");
    this->ElementId->SetName("ElementId");
    this->Level->SetName("Level");
  }

  /// shift is added to the first parameter.
  template <int Dim>
  void Add(
    const knotwork::SplinePatch& patch, const knotwork::SplineSpace<Dim>& space, double shift)
  {
    std::map<std::array<double, 3>, vtkIdType> ids;
    const int row = RowLength(space);
    for (int e = 0; e < space.NumElements(); ++e)
    {
      const auto& element = space.Elements[static_cast<std::size_t>(e)];
      const std::array<double, 3> place = space.HasDomain()
        ? std::array<double, 3>{}
        : std::array<double, 3>{ static_cast<double>(e % row), static_cast<double>(e / row), 0.0 };
      if (!space.HasDomain()) // neighbours in the row need not be neighbours
      {
        ids.clear();
      }
      vtkIdType corners[8];
      for (std::size_t c = 0; c < (std::size_t{ 1 } << Dim); ++c)
      {
        std::array<double, 3> u{};
        for (std::size_t d = 0; d < Dim; ++d)
        {
          // VTK goes around quadrilaterals: corners 2 and 3 change places
          const std::size_t bits = c ^ (c >> 1 & 1);
          u[d] = (bits >> d & 1) != 0 ? element.Box.Upper[d] : element.Box.Lower[d];
        }
        const std::array<double, 3> at{ place[0] + u[0], place[1] + u[1], place[2] + u[2] };
        const auto [position, isNew] = ids.emplace(at, this->Points->GetNumberOfPoints());
        if (isNew)
        {
          this->Points->InsertNextPoint(at[0] + shift, at[1], at[2]);
          this->Parameters->InsertNextTuple(u.data());
        }
        corners[c] = position->second;
      }
      this->Cells->InsertNextCell(1 << Dim, corners);
      this->Types.push_back(cellTypes[Dim]);
      this->PatchId->InsertNextValue(patch.Id);
      this->ElementId->InsertNextValue(e);
      this->Level->InsertNextValue(element.Level);
    }
    this->Sources.insert(this->Sources.end(), patch.Cells.begin(), patch.Cells.end());
  }

  void Fill(vtkUnstructuredGrid* source, vtkUnstructuredGrid* output)
  {
    output->SetPoints(this->Points);
    output->SetCells(this->Types.data(), this->Cells);
    output->GetPointData()->AddArray(this->Parameters);
    output->GetCellData()->AddArray(this->PatchId);
    output->GetCellData()->AddArray(this->ElementId);
    output->GetCellData()->AddArray(this->Level);
    if (source)
    {
      knotwork::PassCellData(source, this->Sources, output);
    }
  }

private:
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Cells;
  std::vector<int> Types;
  vtkNew<vtkDoubleArray> Parameters;
  vtkNew<vtkIntArray> PatchId;
  vtkNew<vtkIntArray> ElementId;
  vtkNew<vtkIntArray> Level;
  std::vector<vtkIdType> Sources;
};
}

vtkSplineParametricMesh::vtkSplineParametricMesh() = default;

Status vtkSplineParametricMesh::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0], 0);
  auto model = this->DecodeInput(input);
  if (!model)
  {
    return model.Status;
  }

  std::map<const knotwork::SplinePatch*, double> shifts;
  double widest = 0.0;
  for (const knotwork::SplinePatch& patch : model->Patches)
  {
    const auto [begin, end] = RangeOf(patch);
    widest = std::max(widest, end - begin);
  }
  double next = 0.0;
  for (const knotwork::SplinePatch& patch : model->Patches)
  {
    const auto [begin, end] = RangeOf(patch);
    shifts[&patch] = this->SideBySide ? next - begin : 0.0;
    next += end - begin + this->Gap * widest;
  }
  return knotwork::MakeByBlock(model.Value, input, vtkDataObject::GetData(outputs),
    VTK_UNSTRUCTURED_GRID,
    [&shifts](const std::vector<const knotwork::SplinePatch*>& patches, vtkUnstructuredGrid* source,
      vtkDataSet* dataSet)
    {
      Mesh mesh;
      for (const knotwork::SplinePatch* patch : patches)
      {
        std::visit([&](const auto& spline) { mesh.Add(*patch, *spline.Space, shifts[patch]); },
          patch->Geometry);
      }
      mesh.Fill(source, vtkUnstructuredGrid::SafeDownCast(dataSet));
      return Status();
    });
}
