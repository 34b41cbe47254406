// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadRemesher.h"

#include "QuadriFlowProcess.h"
#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <string>

using namespace knotwork;

vtkStandardNewMacro(vtkQuadRemesher);

namespace
{
static_assert(vtkQuadRemesher::AUTOMATIC == static_cast<int>(QuadWay::Automatic) &&
    vtkQuadRemesher::PROGRAM == static_cast<int>(QuadWay::Program) &&
    vtkQuadRemesher::TRIANGLES == static_cast<int>(QuadWay::Triangles),
  "the numbers of the class are those of the kernel");

void EncodeQuads(const QuadRemesh& made, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < made.Points.rows(); ++i)
  {
    points->InsertNextPoint(made.Points.row(i).data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& quad : made.Quads)
  {
    cells->InsertNextCell({ quad[0], quad[1], quad[2], quad[3] });
  }
  output->SetPoints(points);
  output->SetPolys(cells);
  vtkCellData* data = output->GetCellData();
  data->AddArray(ArrayOf<vtkIntArray>("PartId", made.PartIds, [](int part) { return part; }));
  data->AddArray(ArrayOf<vtkDoubleArray>(
    "ScaledJacobian", made.ScaledJacobians, [](double value) { return value; }));
  data->SetActiveScalars("ScaledJacobian"); // drawn first
}

void EncodeTries(const std::vector<QuadTry>& tries, vtkTable* table)
{
  table->AddColumn(
    ArrayOf<vtkIntArray>("Part", tries, [](const QuadTry& tried) { return tried.Part; }));
  table->AddColumn(
    ArrayOf<vtkIntArray>("Faces", tries, [](const QuadTry& tried) { return tried.Request.Faces; }));
  table->AddColumn(ArrayOf<vtkIntArray>(
    "Sharp", tries, [](const QuadTry& tried) { return tried.Request.KeepSharp ? 1 : 0; }));
  table->AddColumn(ArrayOf<vtkIntArray>(
    "OfTriangles", tries, [](const QuadTry& tried) { return tried.OfTriangles ? 1 : 0; }));
  table->AddColumn(ArrayOf<vtkIntArray>(
    "Taken", tries, [](const QuadTry& tried) { return tried.Refusal.empty() ? 1 : 0; }));
  table->AddColumn(
    ArrayOf<vtkStringArray>("Refusal", tries, [](const QuadTry& tried) { return tried.Refusal; }));
}

void EncodeNumbers(const QuadRemesh& made, vtkTable* table)
{
  AddColumn(table, "Quads", static_cast<int>(made.Quads.size()));
  AddColumn(table, "Points", static_cast<int>(made.Points.rows()));
  AddColumn(table, "Parts", made.Parts);
  AddColumn(table, "DividedParts", made.DividedParts);
  AddColumn(table, "LooseParts", made.LooseParts);
  AddColumn(table, "EulerNumber", made.EulerNumber);
  AddColumn(table, "ExtraordinaryPoints", made.ExtraordinaryPoints);
  AddColumn(table, "Tries", static_cast<int>(made.Tries.size()));
  AddColumn(table, "LeastScaledJacobian", made.LeastScaledJacobian);
  AddColumn(table, "LeastScaledJacobianBefore", made.LeastScaledJacobianBefore);
  AddColumn(table, "DistanceFromInput", made.DistanceFromInput);
  AddColumn(table, "DistanceToInput", made.DistanceToInput);
  AddColumn(table, "Diagonal", made.Diagonal);
  AddColumn(table, "Volume", made.Volume);
  AddColumn(table, "InputVolume", made.InputVolume);
}
}

vtkQuadRemesher::vtkQuadRemesher()
{
  this->SetInputTypes({ Meshes() });
  this->SetOutputTypes({ "vtkPolyData", "vtkTable", "vtkTable" });
}

Status vtkQuadRemesher::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  if (input->GetNumberOfPoints() == 0)
  {
    return {};
  }
  const auto decoded = DecodeMesh(input);
  if (!decoded)
  {
    return decoded.Status;
  }
  QuadRemeshParams params;
  params.Faces = this->Faces;
  params.KeepSharp = this->KeepSharp;
  params.Limit = this->Limit;
  params.Smoothing = this->Smoothing;
  params.Way = static_cast<QuadWay>(this->Way);
  double shown = 0.0;
  const ProgressCallback progress = this->Progress();
  params.Progress = [&](double done)
  {
    shown = done;
    return !progress || progress(done);
  };
  WorkerLimits limits;
  limits.Memory = static_cast<std::uint64_t>(this->MemoryLimit) << 20U;
  limits.Seconds = this->TimeLimit;
  limits.CpuSeconds = this->TimeLimit;
  const auto maker = [&](const TriangleMesh& mesh, const QuadRequest& request)
  {
    return RunQuadriFlow(
      mesh, request, this->KernelThreads(), limits, [&] { return params.Progress(shown); });
  };
  const auto made = RemeshToQuads(decoded->Mesh, maker, params);
  if (!made)
  {
    return made.Status;
  }
  EncodeQuads(made.Value, vtkPolyData::GetData(outputs, 0));
  EncodeTries(made->Tries, vtkTable::GetData(outputs, 1));
  EncodeNumbers(made.Value, vtkTable::GetData(outputs, 2));
  return {};
}
