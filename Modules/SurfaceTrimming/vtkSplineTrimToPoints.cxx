// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineTrimToPoints.h"

#include "TrimData.h"
#include "TrimmedGrids.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/HeightField.h>
#include <knotwork/SplineGrid/InputChecks.h>
#include <knotwork/SplineGrid/ReferenceSystem.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/TableRow.h>
#include <knotwork/SurfaceTrimming/TrimToPoints.h>

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

using knotwork::ErrorCode;
using knotwork::Status;

vtkStandardNewMacro(vtkSplineTrimToPoints);

namespace
{
/// x and y of points over a height field, else their array UV.
knotwork::Result<knotwork::PointMatrix> ParametersOf(vtkPointSet* points, bool isHeightField)
{
  vtkDataArray* given = points->GetPointData()->GetArray("UV");
  if (!isHeightField && (!given || given->GetNumberOfComponents() != 2))
  {
    return { ErrorCode::InvalidParameter,
      "the surface is no height field and the points have no array UV of two components; give the "
      "points that the fit has put out" };
  }
  knotwork::PointMatrix parameters(points->GetNumberOfPoints(), 2);
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double x[3];
    isHeightField ? points->GetPoint(i, x) : given->GetTuple(i, x);
    parameters.row(i) << x[0], x[1];
  }
  return parameters;
}

std::vector<std::string> Shortcomings(const knotwork::TrimmedToPoints& trimmed)
{
  std::vector<std::string> texts;
  for (std::size_t f = 0; f < trimmed.Loops.size(); ++f)
  {
    if (trimmed.Loops[f] != knotwork::LoopVerdict::SimpleNested)
    {
      texts.push_back("trimming loops of face " + std::to_string(f) + ": " +
        ToString(trimmed.Loops[f]) + "; choose larger cells");
    }
    if (trimmed.Certificates[f].Verdict != knotwork::Verdict::Valid)
    {
      texts.push_back("regularity of face " + std::to_string(f) + ": " +
        ToString(trimmed.Certificates[f].Verdict));
    }
  }
  return texts;
}

void EncodeNumbers(const knotwork::TrimmedToPoints& trimmed, vtkTable* table)
{
  const bool proved = std::all_of(trimmed.Loops.begin(), trimmed.Loops.end(),
    [](knotwork::LoopVerdict v) { return v == knotwork::LoopVerdict::SimpleNested; });
  const bool regular = std::all_of(trimmed.Certificates.begin(), trimmed.Certificates.end(),
    [](const knotwork::FaceCertificate& c) { return c.Verdict == knotwork::Verdict::Valid; });
  knotwork::AddColumn(table, "Faces", static_cast<int>(trimmed.Model.Faces.size()));
  knotwork::AddColumn(table, "Loops", trimmed.NumLoops);
  knotwork::AddColumn(table, "Edges", trimmed.Model.NumEdges);
  int controlPoints = 0;
  for (const knotwork::TrimmedFace& face : trimmed.Model.Faces)
  {
    controlPoints += static_cast<int>(face.Surface.ControlPoints.rows());
  }
  knotwork::AddColumn(table, "ControlPoints", controlPoints);
  knotwork::AddColumn(table, "CellSize", trimmed.CellSize);
  knotwork::AddColumn(table, "MaximumGap", trimmed.MaxGap);
  knotwork::AddColumn(table, "Tolerance", trimmed.Tolerance);
  knotwork::AddColumn(table, "MaxTrimDistance", trimmed.MaxTrimDistance);
  knotwork::AddColumn(table, "PointsOutside", static_cast<int>(trimmed.NumPointsOutside));
  knotwork::AddColumn(table, "LoopsProved", proved ? 1 : 0);
  knotwork::AddColumn(table, "FacesRegular", regular ? 1 : 0);
}
}

vtkSplineTrimToPoints::vtkSplineTrimToPoints()
{
  this->SetInputTypes({ Splines(), { { "vtkPointSet" } } });
  this->SetOutputTypes({ "vtkPolyData", "vtkUnstructuredGrid", "vtkUnstructuredGrid", "vtkTable" });
  knotwork::KeepReferenceSystem(this);
}

void vtkSplineTrimToPoints::SetPointsConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkSplineTrimToPoints::SetPointsData(vtkDataObject* points)
{
  this->SetInputDataObject(1, points);
}

Status vtkSplineTrimToPoints::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  auto decoded = this->DecodeInput(vtkDataObject::GetData(inputs[0], 0));
  if (!decoded)
  {
    return decoded.Status;
  }
  if (decoded->Patches.empty())
  {
    return {};
  }
  const auto* surface = std::get_if<knotwork::Spline<2>>(&decoded->Patches.front().Geometry);
  if (decoded->Patches.size() > 1 || !surface)
  {
    return { ErrorCode::DimensionMismatch,
      "the first input must be one surface; select a patch of it" };
  }
  auto* points = vtkPointSet::GetData(inputs[1], 0);
  if (Status sampled = knotwork::CheckSampledPoints(points, "the second input"); !sampled)
  {
    return sampled;
  }
  const auto parameters =
    ParametersOf(points, IsHeightField(knotwork::MakeBezierForm(*surface, this->KernelThreads())));
  if (!parameters)
  {
    return parameters.Status;
  }

  knotwork::TrimToPointsParams params;
  params.Outline.CellSize = this->CellSize;
  params.Outline.MaxGap = this->MaximumGap;
  params.Outline.MinCells = this->MinimumCells;
  params.Tolerance = this->Tolerance;
  params.MaxFunctions = this->MaximumFunctions;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  const auto trimmed = knotwork::TrimToPoints(*surface, parameters.Value, params);
  if (!trimmed)
  {
    return trimmed.Status;
  }

  this->ReportWarnings(Shortcomings(trimmed.Value));
  if (this->Triangulation)
  {
    knotwork::TrimmedMeshParams mesh;
    mesh.Tolerance =
      this->ChordalTolerance > 0.0 ? this->ChordalTolerance : 0.25 * trimmed->Tolerance;
    mesh.Threads = params.Threads;
    mesh.Progress = params.Progress;
    const auto triangles = knotwork::TriangulateFaces(trimmed->Model, mesh);
    if (!triangles)
    {
      return triangles.Status;
    }
    knotwork::EncodeTriangles(triangles.Value, vtkPolyData::GetData(outputs, 0));
  }
  EncodeNumbers(trimmed.Value, vtkTable::GetData(outputs, 3));
  return knotwork::EncodeTrimmedModel(trimmed->Model, vtkUnstructuredGrid::GetData(outputs, 1),
    vtkUnstructuredGrid::GetData(outputs, 2));
}
