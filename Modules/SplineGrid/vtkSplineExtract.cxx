// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineExtract.h"

#include "PatchFields.h"
#include "ReferenceSystem.h"
#include "SplineModel.h"
#include <knotwork/SplineCore/MeshTraces.h>
#include <knotwork/SplineCore/SurfaceExtraction.h>

#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

#include <algorithm>
#include <type_traits>

using knotwork::ErrorCode;
using knotwork::Status;

vtkStandardNewMacro(vtkSplineExtract);

vtkSplineExtract::vtkSplineExtract()
{
  knotwork::KeepReferenceSystem(this);
}

namespace
{
template <int Dim>
Status TakeBoundary(const knotwork::Spline<Dim>& whole, const knotwork::SplinePatch& patch,
  std::vector<knotwork::SplinePatch>& taken)
{
  const auto topology = knotwork::MeshTopology<Dim>::Make(MeshOf(*whole.Space));
  const auto traces = TraceOnFacets(*whole.Space, BoundaryFacets(topology.Value));
  if (!traces)
  {
    return traces.Status;
  }
  const auto take = [&](const knotwork::MeshTrace<Dim - 1>& trace)
  {
    taken.push_back(patch);
    taken.back().Cells.clear();
    SeparateFields(
      knotwork::TraceOf<Dim - 1>(JoinFields(whole, patch.Fields), trace), taken.back());
  };
  if constexpr (Dim == 3)
  {
    take(traces.Value);
  }
  else
  {
    std::for_each(traces->begin(), traces->end(), take);
  }
  return {};
}

/// The boundaries of patches on meshes instead of them: one surface of a volume, curves of a
/// surface, of which the first keeps the patch's number.
Status TakeBoundaries(std::vector<knotwork::SplinePatch>& patches)
{
  int next = 0;
  for (const knotwork::SplinePatch& patch : patches)
  {
    next = std::max(next, patch.Id + 1);
  }
  std::vector<knotwork::SplinePatch> all;
  for (const knotwork::SplinePatch& patch : patches)
  {
    const Status status = std::visit(
      [&](const auto& whole)
      {
        using Whole = std::decay_t<decltype(whole)>;
        if constexpr (!std::is_same_v<Whole, knotwork::Spline<1>>)
        {
          if (whole.Space->Kind == knotwork::SpaceKind::Unstructured)
          {
            const std::size_t first = all.size();
            const Status taken = TakeBoundary(whole, patch, all);
            for (std::size_t i = first + 1; i < all.size(); ++i)
            {
              all[i].Id = next++;
            }
            return taken;
          }
        }
        return Status{ ErrorCode::DimensionMismatch,
          "only surfaces and volumes on unstructured meshes have their boundary taken" };
      },
      patch.Geometry);
    if (!status)
    {
      return { status.Code, "patch " + std::to_string(patch.Id) + ": " + status.Detail };
    }
  }
  patches = std::move(all);
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

  if (this->Boundary)
  {
    if (Status status = TakeBoundaries(model->Patches); !status)
    {
      return status;
    }
  }
  const bool isBoundaryAll = this->Boundary && !params.Restrict && !params.Swap &&
    !params.Reverse[0] && !params.Reverse[1] && !params.MoveDomain && !params.ExpandToTensor &&
    params.IsoDirection < 0;
  const knotwork::ProgressCallback progress = this->Progress();
  const std::size_t count = isBoundaryAll ? 0 : model->Patches.size();
  for (std::size_t p = 0; p < count; ++p)
  {
    if (!progress(static_cast<double>(p) / static_cast<double>(count)))
    {
      return { ErrorCode::Aborted, "" };
    }
    knotwork::SplinePatch& patch = model->Patches[p];
    const std::string where = "patch " + std::to_string(patch.Id) + ": ";
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
