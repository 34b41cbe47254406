// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshParameterization.h"

#include "MeshData.h"

#include "vtkDataObject.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>

vtkStandardNewMacro(vtkMeshParameterization);

namespace
{
std::vector<std::string> Warnings(const knotwork::ChartedMesh& charted)
{
  std::vector<std::string> warnings;
  const std::string used = knotwork::DescribeMethods(charted);
  if (const std::string reason = knotwork::DescribeFallbacks(charted); !reason.empty())
  {
    warnings.push_back(charted.Charts.size() == 1 ? reason + ": " + used + " was used instead"
                                                  : reason + "; methods used: " + used);
  }
  int flips = 0;
  for (const knotwork::MeshParameterization& chart : charted.Charts)
  {
    flips += chart.Measures.FlippedTriangles;
  }
  if (flips > 0)
  {
    warnings.push_back(
      std::to_string(flips) + " triangles are flipped in the plane (" + used + ")");
  }
  const auto overlapping = std::find_if(charted.Charts.begin(), charted.Charts.end(),
    [](const knotwork::MeshParameterization& chart) { return !chart.Injective; });
  if (charted.WithinLimit && flips == 0 && overlapping != charted.Charts.end())
  {
    warnings.push_back(overlapping->Injective.Detail + " (" + used +
      "); MaximumStretch cuts the mesh into charts that do not");
  }
  if (!charted.WithinLimit)
  {
    warnings.push_back(std::to_string(charted.Charts.size()) +
      " charts are too few: some are stretched more than allowed or lie over themselves");
  }
  return warnings;
}
}

vtkMeshParameterization::vtkMeshParameterization()
{
  this->SetInputTypes({ Meshes() });
  this->SetOutputTypes({ "vtkPolyData", "vtkPolyData", "vtkTable" });
}

knotwork::Status vtkMeshParameterization::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  const auto decoded = knotwork::DecodeMesh(input);
  if (!decoded)
  {
    return decoded.Status;
  }
  knotwork::FlattenParams params;
  params.Method = static_cast<knotwork::FlattenMethod>(this->Method);
  params.Weights = static_cast<knotwork::LaplacianWeights>(this->LaplacianWeights);
  params.Geodesics = static_cast<knotwork::GeodesicEstimator>(this->Geodesics);
  params.Neighbours = this->Neighbours;
  params.Landmarks = this->Landmarks;
  params.MaxIterations = this->MaximumIterations;
  params.MinParticipation = this->MinimumParticipation;
  params.Fallback = this->Fallback;
  params.LargestComponent = this->LargestComponent;
  params.Threads = this->KernelThreads();
  const auto charted = this->Flatten(decoded.Value.Mesh, params);
  if (!charted)
  {
    return charted.Status;
  }
  this->Seconds = charted->Seconds;
  this->ReportWarnings(Warnings(charted.Value));
  knotwork::EncodeMesh(
    decoded.Value, charted.Value, input, this->FlatOutput, vtkPolyData::GetData(outputs, 0));
  knotwork::EncodeLoops(charted.Value, this->FlatOutput, vtkPolyData::GetData(outputs, 1));
  knotwork::EncodeSummary(
    decoded.Value, charted.Value, params.Method, vtkTable::GetData(outputs, 2));
  return {};
}

knotwork::Result<knotwork::ChartedMesh> vtkMeshParameterization::Flatten(
  const knotwork::TriangleMesh& mesh, const knotwork::FlattenParams& params) const
{
  if (this->MaximumStretch > 0.0)
  {
    return knotwork::FlattenCharts(
      mesh, params, { this->MaximumStretch, this->MaximumCharts, this->CreaseAngle });
  }
  auto map = knotwork::FlattenMesh(mesh, params);
  return map ? knotwork::OneChart(std::move(map.Value))
             : knotwork::Result<knotwork::ChartedMesh>(map.Status);
}
