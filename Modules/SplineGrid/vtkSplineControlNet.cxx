// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineControlNet.h"

#include "NamedArray.h"
#include "ReferenceSystem.h"
#include "SplineBlocks.h"
#include "SplineModel.h"
#include <knotwork/SplineCore/ControlNet.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

using knotwork::Status;

vtkStandardNewMacro(vtkSplineControlNet);

namespace
{
/// Control points and lines of one block.
class Net
{
public:
  Net(const std::vector<const knotwork::SplinePatch*>& patches, bool vertices, bool lines)
    : WithVertices(vertices), WithLines(lines)
  {
    this->Points->SetDataTypeToDouble();
    for (const knotwork::SplinePatch* patch : patches)
    {
      this->DeclareFields(*patch);
    }
    for (const knotwork::SplinePatch* patch : patches)
    {
      std::visit([&](const auto& spline) { this->Add(*patch, spline); }, patch->Geometry);
    }
  }

  void Fill(vtkPolyData* output) const
  {
    output->SetPoints(this->Points);
    output->SetVerts(this->Verts);
    output->SetLines(this->Edges);
    for (vtkDataArray* array : std::initializer_list<vtkDataArray*>{
           this->Weight, this->FunctionId, this->Level, this->PatchId, this->Greville })
    {
      output->GetPointData()->AddArray(array);
    }
    for (const auto& field : this->Fields)
    {
      output->GetPointData()->AddArray(field);
    }
    // vertices come before lines in polydata
    for (const char* name : { "PatchId", "Level", "Direction" })
    {
      auto all = knotwork::NamedArray<vtkIntArray>(name);
      const int which = name[0] == 'P' ? 0 : name[0] == 'L' ? 1 : 2;
      for (const auto& cells : { &this->VertexCells, &this->LineCells })
      {
        for (const std::array<int, 3>& cell : *cells)
        {
          all->InsertNextValue(cell[static_cast<std::size_t>(which)]);
        }
      }
      output->GetCellData()->AddArray(all);
    }
  }

private:
  void DeclareFields(const knotwork::SplinePatch& patch)
  {
    for (const knotwork::SplineField& field : patch.Fields)
    {
      const auto same = [&](const auto& array) { return field.Name == array->GetName(); };
      if (std::none_of(this->Fields.begin(), this->Fields.end(), same) && field.Name != "Weight" &&
        field.Name != "FunctionId" && field.Name != "Level" && field.Name != "PatchId" &&
        field.Name != "Greville")
      {
        this->Fields.push_back(knotwork::NamedArray<vtkDoubleArray>(
          field.Name.c_str(), static_cast<int>(field.Coefficients.cols())));
      }
    }
  }

  template <int Dim>
  void Add(const knotwork::SplinePatch& patch, const knotwork::Spline<Dim>& spline)
  {
    const knotwork::SplineSpace<Dim>& space = *spline.Space;
    const vtkIdType first = this->Points->GetNumberOfPoints();
    std::vector<knotwork::FunctionInfo<Dim>> infos = DescribeFunctions(space);
    infos.resize(static_cast<std::size_t>(space.NumFunctions)); // also where there is none
    for (int i = 0; i < space.NumFunctions; ++i)
    {
      const auto& info = infos[static_cast<std::size_t>(i)];
      this->Points->InsertNextPoint(spline.ControlPoints.row(i).data());
      this->Weight->InsertNextValue(spline.IsRational() ? spline.Weights[i] : 1.0);
      this->FunctionId->InsertNextValue(i);
      this->Level->InsertNextValue(info.Level);
      this->PatchId->InsertNextValue(patch.Id);
      double greville[3] = { 0.0, 0.0, 0.0 };
      std::copy(info.Greville.begin(), info.Greville.end(), greville);
      this->Greville->InsertNextTuple(greville);
      if (this->WithVertices)
      {
        const vtkIdType id = first + i;
        this->Verts->InsertNextCell(1, &id);
        this->VertexCells.push_back({ patch.Id, info.Level, -1 });
      }
    }
    for (const auto& array : this->Fields)
    {
      const auto named = [&](const knotwork::SplineField& field)
      {
        return field.Name == array->GetName() &&
          field.Coefficients.cols() == array->GetNumberOfComponents();
      };
      const auto field = std::find_if(patch.Fields.begin(), patch.Fields.end(), named);
      const std::vector<double> zeros(
        static_cast<std::size_t>(array->GetNumberOfComponents()), 0.0);
      for (int i = 0; i < space.NumFunctions; ++i)
      {
        array->InsertNextTuple(
          field == patch.Fields.end() ? zeros.data() : field->Coefficients.row(i).data());
      }
    }
    if (this->WithLines)
    {
      for (const knotwork::NetEdge& edge : ControlNetEdges(space))
      {
        const vtkIdType ids[2] = { first + edge.Begin, first + edge.End };
        this->Edges->InsertNextCell(2, ids);
        this->LineCells.push_back(
          { patch.Id, infos[static_cast<std::size_t>(edge.Begin)].Level, edge.Direction });
      }
    }
  }

  bool WithVertices;
  bool WithLines;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Verts;
  vtkNew<vtkCellArray> Edges;
  vtkSmartPointer<vtkDoubleArray> Weight = knotwork::NamedArray<vtkDoubleArray>("Weight");
  vtkSmartPointer<vtkIntArray> FunctionId = knotwork::NamedArray<vtkIntArray>("FunctionId");
  vtkSmartPointer<vtkIntArray> Level = knotwork::NamedArray<vtkIntArray>("Level");
  vtkSmartPointer<vtkIntArray> PatchId = knotwork::NamedArray<vtkIntArray>("PatchId");
  vtkSmartPointer<vtkDoubleArray> Greville = knotwork::NamedArray<vtkDoubleArray>("Greville", 3);
  std::vector<vtkSmartPointer<vtkDoubleArray>> Fields;
  std::vector<std::array<int, 3>> VertexCells; ///< patch, level, direction
  std::vector<std::array<int, 3>> LineCells;
};
}

vtkSplineControlNet::vtkSplineControlNet()
{
  knotwork::KeepReferenceSystem(this);
}

int vtkSplineControlNet::RequestDataObject(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (vtkPartitionedDataSetCollection::GetData(inputs[0], 0))
  {
    return this->Superclass::RequestDataObject(request, inputs, outputs);
  }
  MakeOutput(outputs, 0, "vtkPolyData");
  return 1;
}

Status vtkSplineControlNet::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0], 0);
  auto model = this->DecodeInput(input);
  if (!model)
  {
    return model.Status;
  }
  return knotwork::MakeByBlock(model.Value, input, vtkDataObject::GetData(outputs), VTK_POLY_DATA,
    [this](const std::vector<const knotwork::SplinePatch*>& patches, vtkUnstructuredGrid*,
      vtkDataSet* dataSet)
    {
      Net(patches, this->Vertices, this->Lines).Fill(vtkPolyData::SafeDownCast(dataSet));
      return Status();
    });
}
