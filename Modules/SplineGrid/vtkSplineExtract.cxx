// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineExtract.h"

#include "PatchFields.h"
#include "SplineModel.h"
#include <knotwork/SplineCore/MeshTraces.h>
#include <knotwork/SplineCore/SurfaceExtraction.h>

#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

using knotwork::ErrorCode;
using knotwork::Status;

vtkStandardNewMacro(vtkSplineExtract);

vtkSplineExtract::vtkSplineExtract() = default;

namespace
{
/// The boundary of a volume on a mesh instead of it.
Status TakeBoundary(knotwork::SplinePatch& patch)
{
  const auto* volume = std::get_if<knotwork::Spline<3>>(&patch.Geometry);
  if (!volume || volume->Space->Kind != knotwork::SpaceKind::Unstructured)
  {
    return { ErrorCode::DimensionMismatch,
      "only volumes on unstructured meshes have their boundary taken" };
  }
  const auto topology = knotwork::MeshTopology<3>::Make(MeshOf(*volume->Space));
  const auto trace = TraceOnFacets(*volume->Space, BoundaryFacets(topology.Value));
  if (!trace)
  {
    return trace.Status;
  }
  SeparateFields(knotwork::TraceOf<2>(JoinFields(*volume, patch.Fields), trace.Value), patch);
  patch.Cells.clear();
  return {};
}
}

Status vtkSplineExtract::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0], 0);
  auto model = this->DecodeInput(input);
  if (!model)
  {
    return model.Status;
  }
  knotwork::ExtractionParams params;
  params.Restrict = this->RestrictToBox;
  params.Box.Lower = { this->Box[0], this->Box[2] };
  params.Box.Upper = { this->Box[1], this->Box[3] };
  params.Swap = this->SwapParameters;
  params.Reverse = { this->ReverseFirst, this->ReverseSecond };
  params.MoveDomain = this->MoveDomain;
  params.Domain.Lower = { this->Domain[0], this->Domain[2] };
  params.Domain.Upper = { this->Domain[1], this->Domain[3] };
  params.ExpandToTensor = this->ExpandToTensor;
  params.IsoDirection = this->IsoCurve - FIRST;
  params.IsoValue = this->IsoValue;
  params.MaxFunctions = this->MaximumFunctions;
  params.Threads = this->KernelThreads();

  const bool isBoundaryAll = this->Boundary && !params.Restrict && !params.Swap &&
    !params.Reverse[0] && !params.Reverse[1] && !params.MoveDomain && !params.ExpandToTensor &&
    params.IsoDirection < 0;
  const knotwork::ProgressCallback progress = this->Progress();
  const std::size_t count = model->Patches.size();
  for (std::size_t p = 0; p < count; ++p)
  {
    if (!progress(static_cast<double>(p) / static_cast<double>(count)))
    {
      return { ErrorCode::Aborted, "" };
    }
    knotwork::SplinePatch& patch = model->Patches[p];
    const std::string where = "patch " + std::to_string(patch.Id) + ": ";
    if (this->Boundary)
    {
      if (const Status status = TakeBoundary(patch); !status)
      {
        return { status.Code, where + status.Detail };
      }
      if (isBoundaryAll)
      {
        continue;
      }
    }
    const auto* surface = std::get_if<knotwork::Spline<2>>(&patch.Geometry);
    if (!surface)
    {
      return { ErrorCode::DimensionMismatch,
        where + "it has " + std::to_string(patch.Geometry.index() + 1) +
          " parameter(s), only surfaces have parts and iso-curves here" };
    }
    const auto extracted = ExtractFromSurface(JoinFields(*surface, patch.Fields), params);
    if (!extracted)
    {
      return { extracted.Status.Code, where + extracted.Status.Detail };
    }
    std::visit([&patch](const auto& all) { SeparateFields(all, patch); }, extracted.Value);
    patch.Cells.clear();
  }
  model->Topology = {}; // of the whole surfaces
  return EncodeSplineModel(model.Value, input, vtkDataObject::GetData(outputs));
}
