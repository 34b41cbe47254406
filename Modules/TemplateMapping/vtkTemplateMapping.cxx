// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTemplateMapping.h"

#include "SkeletonData.h"
#include "SplineModel.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

using knotwork::Status;

vtkStandardNewMacro(vtkTemplateMapping);

namespace
{
constexpr const char* OutputTypes[] = { "vtkUnstructuredGrid", "vtkPolyData", "vtkTable" };

/// The map as a grid of one patch with the cell array MaxError.
Status EncodeMap(const knotwork::TemplateMapResult<2>& result, vtkUnstructuredGrid* grid)
{
  knotwork::Spline<2> map = result.Map;
  map.ControlPoints.conservativeResize(Eigen::NoChange, 3);
  map.ControlPoints.col(2).setZero();
  knotwork::SplineModel model;
  model.Patches.emplace_back();
  model.Patches.back().Geometry = std::move(map);
  if (Status status = EncodeSplineGrid(model, grid); !status)
  {
    return status;
  }
  vtkDataArray* elements = grid->GetCellData()->GetArray("ElementId");
  vtkNew<vtkDoubleArray> errors;
  errors->SetName("MaxError");
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    const auto element = static_cast<std::size_t>(elements->GetComponent(cell, 0));
    errors->InsertNextValue(result.ElementErrors[element]);
  }
  grid->GetCellData()->AddArray(errors);
  return {};
}
}

vtkTemplateMapping::vtkTemplateMapping()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
}

void vtkTemplateMapping::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Iterations: " << this->Iterations << "\n";
  os << indent << "Degree: " << this->Degree << "\n";
  os << indent << "InnerKnots: " << this->InnerKnots << "\n";
  os << indent << "TemplateSamples: " << this->TemplateSamples << "\n";
  os << indent << "NewtonSteps: " << this->NewtonSteps << "\n";
  os << indent << "TikhonovWeight: " << this->TikhonovWeight << "\n";
}

int vtkTemplateMapping::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

int vtkTemplateMapping::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), OutputTypes[port]);
  return 1;
}

int vtkTemplateMapping::RequestDataObject(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  const auto make = [&](int port, auto* kind)
  {
    using Type = std::remove_pointer_t<decltype(kind)>;
    if (!Type::GetData(outputs, port))
    {
      vtkNew<Type> output;
      outputs->GetInformationObject(port)->Set(vtkDataObject::DATA_OBJECT(), output);
    }
  };
  make(0, static_cast<vtkUnstructuredGrid*>(nullptr));
  make(1, static_cast<vtkPolyData*>(nullptr));
  make(2, static_cast<vtkTable*>(nullptr));
  return 1;
}

Status vtkTemplateMapping::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* templateData = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* targetData = vtkPolyData::GetData(inputs[1]);
  if (templateData->GetNumberOfPoints() == 0 && targetData->GetNumberOfPoints() == 0)
  {
    return {};
  }
  const auto skeleton = knotwork::DecodeSkeleton<2>(templateData, "template");
  const auto target = knotwork::DecodeSkeleton<2>(targetData, "target");
  for (const Status& status : { skeleton.Status, target.Status })
  {
    if (!status)
    {
      return status;
    }
  }
  knotwork::TemplateMapParams<2> params;
  params.Method = static_cast<knotwork::TemplateMapMethod>(this->Method);
  params.Iterations = this->Iterations;
  params.Degree = this->Degree;
  params.InnerKnots.fill(this->InnerKnots);
  params.TemplateSamples = this->TemplateSamples;
  params.NewtonSteps = this->NewtonSteps;
  params.TikhonovWeight = this->TikhonovWeight;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  const auto result = MapTemplate(skeleton.Value, target.Value, params);
  if (!result)
  {
    return result.Status;
  }
  knotwork::EncodeMappedSkeleton(result->Skeleton, vtkPolyData::GetData(outputs, 1));
  knotwork::EncodeConvergence(result->History, vtkTable::GetData(outputs, 2));
  return EncodeMap(result.Value, vtkUnstructuredGrid::GetData(outputs, 0));
}
