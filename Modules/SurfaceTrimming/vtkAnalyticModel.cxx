// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAnalyticModel.h"

#include "TrimData.h"
#include "TrimmedGrids.h"
#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/TableRow.h>
#include <knotwork/SurfaceTrimming/RegionModel.h>

#include "vtkCellData.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
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

/// The type of every triangle's face.
void EncodeTypes(const RegionModel& model, const TrimmedMesh& triangles, vtkPolyData* output)
{
  const auto types = NamedArray<vtkIntArray>("SurfaceType");
  for (const int face : triangles.TriangleFace)
  {
    types->InsertNextValue(
      static_cast<int>(model.Model.Faces[static_cast<std::size_t>(face)].Type));
  }
  output->GetCellData()->AddArray(types);
  output->GetCellData()->SetActiveScalars("SurfaceType"); // drawn first
}

/// Of the mesh's points from analytic faces, of the mesh and spline faces from each other, and of
/// the faces' edges from their surfaces.
double DeviationOf(const RegionModel& model)
{
  return std::max({ model.MaxPointDistance, model.FreeDeviation, model.MaxEdgeGap });
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
  AddColumn(table, "Extrusions", count(SurfaceType::Extrusion));
  AddColumn(table, "Revolutions", count(SurfaceType::Revolution));
  AddColumn(table, "FreeFaces", count(SurfaceType::FreeForm));
  AddColumn(table, "Edges", model.NumEdges);
  AddColumn(table, "Lines", model.NumLines);
  AddColumn(table, "Circles", model.NumCircles);
  AddColumn(table, "SharpEdges", model.NumSharpEdges);
  AddColumn(table, "Vertices", model.NumVertices);
  AddColumn(table, "Loops", model.NumRims);
  AddColumn(table, "Tolerance", model.Tolerance);
  AddColumn(table, "WithinTolerance", DeviationOf(model) <= model.Tolerance ? 1 : 0);
  AddColumn(table, "MaxDeviation", DeviationOf(model));
  AddColumn(table, "MaxNormalAngle", model.MaxNormalAngle);
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
  EncodeSnapped(model.Snapped, table);
  AddColumn(table, "Area", AreaOf(triangles.Points, triangles.Triangles));
  AddColumn(table, "MeshArea", AreaOf(mesh.Points, mesh.Triangles));
}

/// A stage of the whole, which is run for every part of the mesh: progress never goes back.
ProgressCallback Stage(const ProgressCallback& whole, double& done, double begin, double end)
{
  return [=, &done](double share)
  {
    done = std::max(done, begin + share * (end - begin));
    return whole(done);
  };
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
  this->SetInputTypes({ Meshes() });
  this->SetOutputTypes({ "vtkPolyData", "vtkUnstructuredGrid", "vtkUnstructuredGrid", "vtkTable" });
}

knotwork::Status vtkAnalyticModel::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const auto decoded = DecodeMesh(vtkPointSet::GetData(inputs[0], 0));
  if (!decoded)
  {
    return decoded.Status;
  }
  double done = 0.0;
  RecognitionParams recognition;
  recognition.Tolerance = this->Tolerance;
  recognition.MaximumSag = this->MaximumSag;
  recognition.SnapDistance = this->SnapDistance;
  recognition.Progress = Stage(this->Progress(), done, 0.0, 0.3);
  RegionModelParams params;
  params.CornerAngle = this->CornerAngle;
  params.FreeForm = this->FreeForm;
  params.LeastAnalytic = this->MinimumAnalytic;
  params.Charts.MaxStretch = this->MaximumStretch;
  params.Trim.Effort = this->Effort;
  params.Trim.TimeLimit = this->TimeLimit;
  params.Threads = this->KernelThreads();
  params.Progress = Stage(this->Progress(), done, 0.3, 0.7);
  const auto model = ModelMesh(decoded->Mesh, recognition, params);
  if (!model)
  {
    return model.Status;
  }
  TrimmedMeshParams fineness;
  fineness.Tolerance =
    this->ChordalTolerance > 0.0 ? this->ChordalTolerance : 0.25 * model->Tolerance;
  fineness.Threads = this->KernelThreads();
  fineness.Progress = Stage(this->Progress(), done, 0.7, 1.0);
  const auto triangles = TriangulateFacesFiner(model->Model, fineness);
  if (!triangles)
  {
    return triangles.Status;
  }
  this->ReportWarnings(Shortcomings(model.Value));
  EncodeTriangles(triangles.Value, vtkPolyData::GetData(outputs, 0));
  EncodeTypes(model.Value, triangles.Value, vtkPolyData::GetData(outputs, 0));
  EncodeNumbers(model.Value, decoded->Mesh, triangles.Value, vtkTable::GetData(outputs, 3));
  return EncodeTrimmedModel(model->Model, vtkUnstructuredGrid::GetData(outputs, 1),
    vtkUnstructuredGrid::GetData(outputs, 2));
}
