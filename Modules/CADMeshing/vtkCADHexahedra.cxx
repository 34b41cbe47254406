// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCADHexahedra.h"

#include "HexahedronData.h"
#include <knotwork/CADMeshing/CADHexes.h>
#include <knotwork/CADMeshing/ContactWarnings.h>
#include <knotwork/CADMeshing/HexahedronQuality.h>
#include <knotwork/CADMeshing/SweepCuts.h>
#include <knotwork/CADModel/CADOperationText.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

using namespace knotwork;

vtkStandardNewMacro(vtkCADHexahedra);

namespace
{
void EncodeMesh(const CADTopology& model, const CADHexes& made, vtkUnstructuredGrid* output)
{
  EncodeHexahedra(made.Mesh, made.Points, made.Quality, output);
  const auto same = [](int value) { return value; };
  output->GetCellData()->AddArray(ArrayOf<vtkIntArray>("SolidId", made.HexBody, same));
  output->GetCellData()->AddArray(ArrayOf<vtkIntArray>("Layer", made.HexLayer, same));
  output->GetPointData()->AddArray(
    ArrayOf<vtkIntArray>("CADEntityDimension", made.PointDimension, same));
  const auto entities = NamedArray<vtkIntArray>("CADEntityId");
  for (std::size_t i = 0; i < made.PointEntity.size(); ++i)
  {
    const auto entity = static_cast<std::size_t>(made.PointEntity[i]);
    entities->InsertNextValue(
      made.PointDimension[i] == 2 ? model.Faces[entity].Ids.front() : made.PointEntity[i]);
  }
  output->GetPointData()->AddArray(entities);
}

/// Quadrilaterals on the faces behind the hexahedra, whose values they get.
void EncodeBoundary(const CADTopology& model, const CADHexes& made, vtkUnstructuredGrid* output)
{
  vtkCellData* values = output->GetCellData();
  const auto faceIds = NamedArray<vtkIntArray>("CADFaceId");
  for (int cell = 0; cell < made.Mesh.NumCells(); ++cell)
  {
    faceIds->InsertNextValue(-1);
  }
  for (const CADHexFacet& facet : made.OnFaces)
  {
    const int* corners = made.Mesh.Cell(facet.Cell);
    const std::array<int, 4> at = CornersOfHexSide(facet.Side);
    const vtkIdType ids[4] = { corners[at[0]], corners[at[1]], corners[at[3]], corners[at[2]] };
    output->InsertNextCell(VTK_QUAD, 4, ids);
    for (int i = 0; i < values->GetNumberOfArrays(); ++i)
    {
      values->GetArray(i)->InsertNextTuple(facet.Cell, values->GetArray(i));
    }
    const std::vector<int>& ofFace = model.Faces[static_cast<std::size_t>(facet.Face)].Ids;
    faceIds->InsertNextValue(*std::min_element(ofFace.begin(), ofFace.end()));
  }
  values->AddArray(faceIds);
}

void EncodeNumbers(const SweepCuts& cut, const CADHexes& made, vtkTable* table)
{
  AddColumn(table, "Hexahedra", made.Mesh.NumCells());
  AddColumn(table, "Points", made.Mesh.NumPoints);
  AddColumn(table, "Solids", static_cast<int>(made.Solids.size()));
  AddColumn(table, "PaddedHexahedra", made.PaddedHexes);
  AddHexahedronColumns(made.Quality, table);
  AddColumn(table, "Diagonal", cut.Model.Diagonal);
  std::string cuts;
  for (const CADOperation& one : cut.Cuts)
  {
    cuts += (cuts.empty() ? "" : "\n") + TextOf(one);
  }
  AddColumn(table, "Cuts", cuts);
}

void EncodeSolids(const CADTopology& model, const CADHexes& made, vtkTable* table)
{
  using Row = const CADSolidHexes&;
  const auto add = [&](const char* name, const auto& value)
  { table->AddColumn(ArrayOf<vtkIntArray>(name, made.Solids, value)); };
  const auto addFaces = [&](const char* name, std::vector<int> CADSolidHexes::*faces)
  {
    table->AddColumn(ArrayOf<vtkStringArray>(name, made.Solids,
      [&](Row row)
      {
        std::string ids;
        for (const int face : row.*faces)
        {
          ids += (ids.empty() ? "" : " ") +
            std::to_string(model.Faces[static_cast<std::size_t>(face)].Ids.front());
        }
        return ids;
      }));
  };
  add("SolidId", [](Row row) { return row.Body; });
  addFaces("SourceFaces", &CADSolidHexes::Source);
  addFaces("TargetFaces", &CADSolidHexes::Target);
  addFaces("LinkingFaces", &CADSolidHexes::Linking);
  add("Layers", [](Row row) { return row.Layers; });
  add("Hexahedra", [](Row row) { return row.Hexahedra; });
  table->AddColumn(ArrayOf<vtkDoubleArray>(
    "LeastScaledJacobian", made.Solids, [](Row row) { return row.LeastScaledJacobian; }));
}
}

vtkCADHexahedra::vtkCADHexahedra()
{
  this->SetNumberOfInputPorts(0);
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkTable", "vtkTable" });
}

vtkCADHexahedra::~vtkCADHexahedra()
{
  this->SetFileName(nullptr);
}

Status vtkCADHexahedra::Compute(vtkInformationVector**, vtkInformationVector* outputs)
{
  if (!this->FileName || this->FileName[0] == '\0')
  {
    return { ErrorCode::EmptyInput, "there is no file name" };
  }
  const auto pieces = CADPieces::Read(this->FileName, static_cast<LengthUnit>(this->Unit));
  if (!pieces)
  {
    return pieces.Status;
  }
  CADHexesParams params;
  params.Faces.EdgeLength = this->EdgeLength;
  params.Faces.Curvature = this->Curvature;
  params.Faces.MinDivisions = this->MinimumDivisions;
  params.Faces.MaxQuads = this->MaximumHexahedra;
  params.MaxHexahedra = this->MaximumHexahedra;
  params.Threads = this->KernelThreads();
  SweepCutsParams search;
  search.MaxCuts = this->MaximumCuts;
  constexpr double OfSearch = 0.3; ///< of the progress
  const ProgressCallback progress = this->Progress();
  search.Progress = [&](double done) { return progress(OfSearch * done); };
  params.Faces.Progress = [&](double done) { return progress(OfSearch + (1.0 - OfSearch) * done); };
  Result<CADHexes> made;
  const auto cut = FindSweepCuts(
    pieces.Value,
    [&](const CADTopology& model) -> Result<double>
    {
      made = MeshHexes(model, params);
      if (!made)
      {
        return made.Status;
      }
      return ShareNotValid(made->Quality.Certificate);
    },
    search);
  if (!cut)
  {
    return cut.Status;
  }
  EncodeMesh(cut->Model, made.Value, vtkUnstructuredGrid::GetData(outputs, 0));
  if (this->BoundaryCells)
  {
    EncodeBoundary(cut->Model, made.Value, vtkUnstructuredGrid::GetData(outputs, 0));
  }
  EncodeNumbers(cut.Value, made.Value, vtkTable::GetData(outputs, 1));
  EncodeSolids(cut->Model, made.Value, vtkTable::GetData(outputs, 2));
  std::vector<std::string> warnings = cut->Notes;
  for (const auto& more : { ContactWarnings(cut->Model),
         HexahedronWarnings(
           made->Quality, "lower EdgeLength or Curvature, or cut the solid (cadmodify)") })
  {
    warnings.insert(warnings.end(), more.begin(), more.end());
  }
  this->ReportWarnings(warnings);
  return {};
}
