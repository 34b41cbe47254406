// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTemplateMapping.h"

#include "MapData.h"
#include "SkeletonData.h"

#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

using knotwork::Result;
using knotwork::Status;
using knotwork::TemplateMapParams;

vtkStandardNewMacro(vtkTemplateMapping);

vtkTemplateMapping::vtkTemplateMapping()
{
  this->SetInputTypes({ Meshes(), Meshes(), Optional(Splines()) });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkPolyData", "vtkTable" });
}

template <int Dim>
Result<TemplateMapParams<Dim>> vtkTemplateMapping::Parameters(vtkDataObject* initialMap)
{
  TemplateMapParams<Dim> params;
  params.Method = static_cast<knotwork::TemplateMapMethod>(this->Method);
  params.Iterations = this->Iterations;
  params.Degree = this->Degree;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const int knots = this->InnerKnotsPerDirection[d];
    params.InnerKnots[d] = knots == -1 ? this->InnerKnots : knots;
  }
  params.TemplateSamples = this->TemplateSamples;
  params.NewtonSteps = this->NewtonSteps;
  params.PdmWeight = this->PdmWeight;
  params.TdmWeight = this->TdmWeight;
  params.TikhonovWeight = this->TikhonovWeight;
  params.UniformityWeight = this->UniformityWeight;
  params.LengthWeight = this->LengthWeight;
  params.OrthogonalityWeight = this->OrthogonalityWeight;
  params.SkewnessWeight = this->SkewnessWeight;
  params.EccentricityWeight = this->EccentricityWeight;
  params.AreaWeight = this->AreaWeight;
  params.SelfIntersectionWeight = this->SelfIntersectionWeight;
  params.Guard = this->Guard;
  params.Accuracy = this->Accuracy;
  params.MaxIrregularShare = this->MaxIrregularShare;
  params.Refinement = static_cast<knotwork::TemplateRefinement>(this->Refinement);
  params.RefineEvery = this->RefineEvery;
  params.StagnationRatio = this->StagnationRatio;
  params.RefineThreshold = this->RefineThreshold;
  params.RefineShare = this->RefineShare;
  params.Extension = this->Extension;
  params.MaxLevel = this->MaxLevel;
  params.MaxFunctions = this->MaxFunctions;
  params.Start = static_cast<knotwork::TemplateInitialMap>(this->InitialMap);
  params.InitialUniformityWeight = this->InitialUniformityWeight;
  params.Injectivity = this->Injectivity;
  if (this->UseDomain)
  {
    params.Domain.emplace();
    for (std::size_t d = 0; d < Dim; ++d)
    {
      params.Domain->Lower[d] = this->Domain[2 * d];
      params.Domain->Upper[d] = this->Domain[2 * d + 1];
    }
  }
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  if (initialMap)
  {
    std::vector<std::string> warnings;
    auto map = knotwork::DecodeInitialMap<Dim>(initialMap, params.Threads, warnings);
    this->ReportWarnings(warnings);
    if (!map)
    {
      return map.Status;
    }
    params.InitialMap = std::move(map.Value);
  }
  return params;
}

template <int Dim>
Status vtkTemplateMapping::MapSkeleton(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  std::vector<std::string> warnings;
  const auto skeleton = knotwork::DecodeSkeleton<Dim>(
    vtkDataSet::GetData(inputs[0]), "template", this->TemplateSamples, &warnings);
  const auto target =
    knotwork::DecodeSkeleton<Dim>(vtkDataSet::GetData(inputs[1]), "target", 0, &warnings);
  this->ReportWarnings(warnings);
  const auto params = this->Parameters<Dim>(vtkDataObject::GetData(inputs[2]));
  for (const Status& status : { skeleton.Status, target.Status, params.Status })
  {
    if (!status)
    {
      return status;
    }
  }
  const auto result = MapTemplate(skeleton.Value, target.Value, params.Value);
  if (!result)
  {
    return result.Status;
  }
  knotwork::EncodeMappedSkeleton(result->Skeleton, vtkPolyData::GetData(outputs, 1));
  knotwork::EncodeConvergence(result->History, vtkTable::GetData(outputs, 2));
  return EncodeMap(result.Value, this->Injectivity, vtkUnstructuredGrid::GetData(outputs, 0));
}

Status vtkTemplateMapping::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataSet* templateData = vtkDataSet::GetData(inputs[0]);
  vtkDataSet* targetData = vtkDataSet::GetData(inputs[1]);
  if (templateData->GetNumberOfPoints() == 0 && targetData->GetNumberOfPoints() == 0)
  {
    return {};
  }
  const Result<int> dimension = knotwork::SkeletonDimension(templateData, targetData);
  if (!dimension)
  {
    return dimension.Status;
  }
  return dimension.Value == 3 ? this->MapSkeleton<3>(inputs, outputs)
                              : this->MapSkeleton<2>(inputs, outputs);
}
