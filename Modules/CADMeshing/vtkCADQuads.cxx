// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCADQuads.h"

#include <knotwork/CADMeshing/CADQuads.h>
#include <knotwork/CADMeshing/ContactWarnings.h>
#include <knotwork/CADModel/CADComposite.h>
#include <knotwork/CADModel/CADTopology.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>

using namespace knotwork;

vtkStandardNewMacro(vtkCADQuads);

namespace
{
int SecondOf(const std::vector<int>& ids)
{
  return ids.size() > 1 ? ids[1] : -1;
}

void EncodeMesh(const CADTopology& model, const CADQuads& made, vtkPolyData* output)
{
  const CADMesh& mesh = made.Mesh;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Eigen::Vector3d& point : mesh.Points)
  {
    points->InsertNextPoint(point.data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& quad : mesh.Quads)
  {
    cells->InsertNextCell({ quad[0], quad[1], quad[2], quad[3] });
  }
  output->SetPoints(points);
  output->SetPolys(cells);
  const auto faceOf = [&](int face) -> const CADTopologyFace&
  { return model.Faces[static_cast<std::size_t>(face)]; };
  vtkCellData* ofCells = output->GetCellData();
  ofCells->AddArray(ArrayOf<vtkIntArray>(
    "CADFaceId", mesh.QuadFace, [&](int face) { return faceOf(face).Ids.front(); }));
  const auto solids = NamedArray<vtkIntArray>("SolidId");
  const auto others = NamedArray<vtkIntArray>("SecondSolidId");
  for (std::size_t q = 0; q < mesh.Quads.size(); ++q)
  {
    const auto& bodies = faceOf(mesh.QuadFace[q]).Bodies;
    const bool isSecond = made.BodyOfFace[q] == 1;
    solids->InsertNextValue(isSecond ? bodies[1] : bodies[0]);
    others->InsertNextValue(isSecond ? bodies[0] : SecondOf(bodies));
  }
  ofCells->AddArray(solids);
  ofCells->AddArray(others);
  std::vector<std::string> names;
  for (const CADTopologyFace& face : model.Faces)
  {
    names.push_back(face.Name);
  }
  const std::vector<int> composites = CompositeIds(names);
  if (std::any_of(composites.begin(), composites.end(), [](int id) { return id >= 0; }))
  {
    ofCells->AddArray(ArrayOf<vtkIntArray>("CompositeId", mesh.QuadFace,
      [&](int face) { return composites[static_cast<std::size_t>(face)]; }));
  }
  ofCells->AddArray(ArrayOf<vtkDoubleArray>(
    "ScaledJacobian", made.ScaledJacobians, [](double value) { return value; }));
  ofCells->SetActiveScalars("CADFaceId"); // drawn first
  vtkPointData* ofPoints = output->GetPointData();
  ofPoints->AddArray(ArrayOf<vtkIntArray>(
    "CADEntityDimension", mesh.PointDimension, [](int dimension) { return dimension; }));
  const auto entities = NamedArray<vtkIntArray>("CADEntityId");
  for (std::size_t i = 0; i < mesh.PointEntity.size(); ++i)
  {
    const int entity = mesh.PointEntity[i];
    entities->InsertNextValue(mesh.PointDimension[i] == 2 ? faceOf(entity).Ids.front() : entity);
  }
  ofPoints->AddArray(entities);
}

void EncodeNumbers(const CADTopology& model, const CADQuads& made, vtkTable* table)
{
  const auto mapped = static_cast<int>(std::count_if(
    made.Faces.begin(), made.Faces.end(), [](const CADFaceQuads& face) { return face.Mapped; }));
  const auto faces = static_cast<int>(made.Faces.size());
  AddColumn(table, "Quads", static_cast<int>(made.Mesh.Quads.size()));
  AddColumn(table, "Points", static_cast<int>(made.Mesh.Points.size()));
  AddColumn(table, "Faces", faces);
  AddColumn(table, "MappedFaces", mapped);
  AddColumn(table, "UnstructuredFaces", faces - mapped);
  AddColumn(table, "Edges", static_cast<int>(model.Edges.size()));
  AddColumn(table, "Solids",
    static_cast<int>(std::count_if(model.Bodies.begin(), model.Bodies.end(),
      [](const CADTopologyBody& body) { return body.IsSolid; })));
  AddColumn(table, "LeastScaledJacobian", made.LeastScaledJacobian);
  AddColumn(table, "ExtraordinaryPoints", made.ExtraordinaryPoints);
  AddColumn(table, "EulerNumber", made.EulerNumber);
  AddColumn(table, "Closed", made.Closed ? 1 : 0);
  AddColumn(table, "Distance", made.Distance);
  AddColumn(table, "Diagonal", model.Diagonal);
}

void EncodeFaces(const CADTopology& model, const CADQuads& made, vtkTable* table)
{
  using Row = const CADFaceQuads&;
  const auto faceOf = [&](Row row) -> const CADTopologyFace&
  { return model.Faces[static_cast<std::size_t>(row.Face)]; };
  const auto add = [&](const char* name, const auto& value)
  { table->AddColumn(ArrayOf<vtkIntArray>(name, made.Faces, value)); };
  add("FaceId", [&](Row row) { return faceOf(row).Ids.front(); });
  add("SecondFaceId", [&](Row row) { return SecondOf(faceOf(row).Ids); });
  add("SolidId", [&](Row row) { return faceOf(row).Bodies.front(); });
  add("SecondSolidId", [&](Row row) { return SecondOf(faceOf(row).Bodies); });
  table->AddColumn(
    ArrayOf<vtkStringArray>("Name", made.Faces, [&](Row row) { return faceOf(row).Name; }));
  table->AddColumn(ArrayOf<vtkStringArray>(
    "Composite", made.Faces, [&](Row row) { return ParseCompositeName(faceOf(row).Name).Group; }));
  add("JoinedFaces", [&](Row row) { return static_cast<int>(faceOf(row).Joined.size()); });
  add("Mapped", [](Row row) { return row.Mapped ? 1 : 0; });
  add("Quads", [](Row row) { return row.Quads; });
  add("ExtraordinaryPoints", [](Row row) { return row.ExtraordinaryPoints; });
  table->AddColumn(ArrayOf<vtkDoubleArray>(
    "LeastScaledJacobian", made.Faces, [](Row row) { return row.LeastScaledJacobian; }));
  table->AddColumn(
    ArrayOf<vtkDoubleArray>("Distance", made.Faces, [](Row row) { return row.Distance; }));
}
}

vtkCADQuads::vtkCADQuads()
{
  this->SetNumberOfInputPorts(0);
  this->SetOutputTypes({ "vtkPolyData", "vtkTable", "vtkTable" });
}

vtkCADQuads::~vtkCADQuads()
{
  this->SetFileName(nullptr);
}

Status vtkCADQuads::Compute(vtkInformationVector**, vtkInformationVector* outputs)
{
  if (!this->FileName || this->FileName[0] == '\0')
  {
    return { ErrorCode::EmptyInput, "there is no file name" };
  }
  auto model = CADTopology::Read(this->FileName, static_cast<LengthUnit>(this->Unit));
  if (!model)
  {
    return model.Status;
  }
  std::vector<std::string> warnings = JoinComposites(model.Value);
  CADQuadsParams params;
  params.Method = static_cast<CADQuadMethod>(this->Method);
  params.EdgeLength = this->EdgeLength;
  params.Curvature = this->Curvature;
  params.MinDivisions = this->MinimumDivisions;
  params.MaxQuads = this->MaximumQuads;
  params.SolidsApart = this->SolidsApart;
  params.Progress = this->Progress();
  const auto made = MeshQuads(model.Value, params);
  if (!made)
  {
    return made.Status;
  }
  EncodeMesh(model.Value, made.Value, vtkPolyData::GetData(outputs, 0));
  EncodeNumbers(model.Value, made.Value, vtkTable::GetData(outputs, 1));
  EncodeFaces(model.Value, made.Value, vtkTable::GetData(outputs, 2));
  const auto contacts = ContactWarnings(model.Value);
  warnings.insert(warnings.end(), contacts.begin(), contacts.end());
  this->ReportWarnings(warnings);
  return {};
}
