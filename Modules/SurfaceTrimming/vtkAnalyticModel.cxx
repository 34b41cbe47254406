// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAnalyticModel.h"

#include "TrimData.h"
#include "TrimmedGrids.h"
#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineGrid/TableRow.h>
#include <knotwork/SurfaceTrimming/RegionModel.h>

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkAnalyticModel);

namespace
{
using namespace knotwork;

double AreaOf(const PointMatrix& points, const std::vector<std::array<int, 3>>& triangles)
{
  double area = 0.0;
  for (const std::array<int, 3>& triangle : triangles)
  {
    area += TriangleArea(points, triangle);
  }
  return area;
}

/// Of the mesh's points from the faces, and of the faces' edges from their surfaces.
double DeviationOf(const RegionModel& model)
{
  return std::max(model.MaxPointDistance, model.MaxEdgeGap);
}

void EncodeNumbers(
  const RegionModel& model, const TriangleMesh& mesh, const TrimmedMesh& triangles, vtkTable* table)
{
  const auto count = [&](SurfaceType type)
  { return model.NumOfType[static_cast<std::size_t>(type)]; };
  AddColumn(table, "Faces", static_cast<int>(model.Model.Faces.size()));
  AddColumn(table, "Planes", count(SurfaceType::Plane));
  AddColumn(table, "Cylinders", count(SurfaceType::Cylinder));
  AddColumn(table, "Spheres", count(SurfaceType::Sphere));
  AddColumn(table, "Cones", count(SurfaceType::Cone));
  AddColumn(table, "Tori", count(SurfaceType::Torus));
  AddColumn(table, "Edges", model.NumEdges);
  AddColumn(table, "Lines", model.NumLines);
  AddColumn(table, "Circles", model.NumCircles);
  AddColumn(table, "Vertices", model.NumVertices);
  AddColumn(table, "Loops", model.NumRims);
  AddColumn(table, "Tolerance", model.Tolerance);
  AddColumn(table, "WithinTolerance", DeviationOf(model) <= model.Tolerance ? 1 : 0);
  AddColumn(table, "MaxDeviation", DeviationOf(model));
  AddColumn(table, "MaxSag", model.MaxDistance);
  AddColumn(table, "MaxEdgeDistance", model.MaxEdgeDistance);
  AddColumn(table, "MaxEdgeGap", model.MaxEdgeGap);
  double normal = HUGE_VAL; // of faces without poles
  for (const FaceCertificate& certificate : model.Certificates)
  {
    normal = certificate.NumPieces > 0 ? std::min(normal, certificate.MinNormal) : normal;
  }
  AddColumn(table, "PoleFaces", model.NumPoleFaces);
  AddColumn(table, "MinNormalBound", normal);
  AddColumn(table, "Verdict", std::string(ToString(WorstVerdict(model.Certificates))));
  const LoopVerdict loops = WorstLoops(model.Verdicts);
  AddColumn(table, "LoopsProved", loops == LoopVerdict::SimpleNested ? 1 : 0);
  AddColumn(table, "LoopVerdict", std::string(ToString(loops)));
  int controlPoints = 0;
  for (const TrimmedFace& face : model.Model.Faces)
  {
    controlPoints += static_cast<int>(face.Surface.ControlPoints.rows());
  }
  AddColumn(table, "ControlPoints", controlPoints);
  AddColumn(table, "Area", AreaOf(triangles.Points, triangles.Triangles));
  AddColumn(table, "MeshArea", AreaOf(mesh.Points, mesh.Triangles));
}

std::vector<std::string> Shortcomings(const RegionModel& model)
{
  std::vector<std::string> texts =
    ShortcomingsOfFaces(WorstVerdict(model.Certificates), WorstLoops(model.Verdicts));
  if (DeviationOf(model) > model.Tolerance)
  {
    texts.push_back("the deviation is up to " + Digits(DeviationOf(model)) +
      ", above the tolerance " + Digits(model.Tolerance));
  }
  return texts;
}
}

vtkAnalyticModel::vtkAnalyticModel()
{
  this->SetOutputTypes({ "vtkPolyData", "vtkUnstructuredGrid", "vtkUnstructuredGrid", "vtkTable" });
}

int vtkAnalyticModel::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

knotwork::Status vtkAnalyticModel::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const auto decoded = DecodeMesh(vtkPointSet::GetData(inputs[0], 0));
  if (!decoded)
  {
    return decoded.Status;
  }
  RecognitionParams recognition;
  recognition.Tolerance = this->Tolerance;
  recognition.MaximumSag = this->MaximumSag;
  recognition.Progress = this->Progress();
  RegionModelParams params;
  params.CornerAngle = this->CornerAngle;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  const auto model = ModelMesh(decoded->Mesh, recognition, params);
  if (!model)
  {
    return model.Status;
  }
  TrimmedMeshParams fineness;
  fineness.Tolerance =
    this->ChordalTolerance > 0.0 ? this->ChordalTolerance : 0.25 * model->Tolerance;
  fineness.Threads = this->KernelThreads();
  const auto triangles = TriangulateFaces(model->Model, fineness);
  if (!triangles)
  {
    return triangles.Status;
  }
  this->ReportWarnings(Shortcomings(model.Value));
  EncodeTriangles(triangles.Value, vtkPolyData::GetData(outputs, 0));
  EncodeNumbers(model.Value, decoded->Mesh, triangles.Value, vtkTable::GetData(outputs, 3));
  return EncodeTrimmedModel(model->Model, vtkUnstructuredGrid::GetData(outputs, 1),
    vtkUnstructuredGrid::GetData(outputs, 2));
}
