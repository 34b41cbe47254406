// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTetGenMesher.h"

#include "BoundaryData.h"
#include "ImageMeshProcess.h"
#include "SizeData.h"
#include "TetGenParts.h"
#include "TetGenProcess.h"
#include <knotwork/CADFitting/FitTargetData.h>
#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineGrid/HigherOrderCells.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkImageData.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <map>

using namespace knotwork;

vtkStandardNewMacro(vtkTetGenMesher);

namespace
{
vtkSmartPointer<vtkPoints> MakePoints(const PointMatrix& points, Eigen::Index count)
{
  auto result = vtkSmartPointer<vtkPoints>::New();
  result->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < count; ++i)
  {
    result->InsertNextPoint(points.row(i).data());
  }
  return result;
}

int CellTypeOf(int order)
{
  return order == 1 ? VTK_TETRA : order == 2 ? VTK_QUADRATIC_TETRA : VTK_LAGRANGE_TETRAHEDRON;
}

void EncodeCells(const SolidMesh& mesh, int order, vtkUnstructuredGrid* grid)
{
  grid->SetPoints(MakePoints(mesh.Points, mesh.Points.rows()));
  vtkNew<vtkCellArray> cells;
  const std::vector<int> pointOrder = HigherOrderPointOrder(CellShape::Tetrahedron, order);
  std::vector<vtkIdType> ids;
  for (const std::vector<int>& nodes : mesh.Cells)
  {
    ids.clear();
    for (const int coefficient : pointOrder)
    {
      ids.push_back(nodes[static_cast<std::size_t>(coefficient)]);
    }
    cells->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
  }
  grid->SetCells(CellTypeOf(order), cells);
  vtkCellData* data = grid->GetCellData();
  data->AddArray(ArrayOf<vtkIntArray>("Region", mesh.Regions, [](int region) { return region; }));
  data->AddArray(ArrayOf<vtkIntArray>("Verdict", mesh.Certificate.Cells,
    [](const CellCertificate& cell) { return static_cast<int>(cell.Verdict); }));
  data->AddArray(ArrayOf<vtkDoubleArray>("MinJacobianLower", mesh.Certificate.Cells,
    [](const CellCertificate& cell) { return cell.MinLower; }));
  if (!mesh.Labels.empty())
  {
    data->AddArray(ArrayOf<vtkIntArray>("Label", mesh.Labels, [](int label) { return label; }));
  }
}

/// Numbers of faces of patches, unless patches have faces of the same number: 6 patch + face.
std::vector<int> NumbersOfFaces(const std::vector<int>& patches, const std::vector<int>& faces)
{
  std::map<int, int> patchOf;
  bool isShared = false;
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    isShared = isShared || patchOf.try_emplace(faces[i], patches[i]).first->second != patches[i];
  }
  std::vector<int> numbers = faces;
  for (std::size_t i = 0; isShared && i < faces.size(); ++i)
  {
    numbers[i] += 6 * patches[i];
  }
  return numbers;
}

std::vector<int> WholeNumbers(vtkDataSet* surface, const char* name)
{
  vtkDataArray* array = surface->GetCellData()->GetArray(name);
  std::vector<int> numbers;
  for (vtkIdType c = 0;
       array && array->GetNumberOfComponents() == 1 && c < array->GetNumberOfTuples(); ++c)
  {
    numbers.push_back(static_cast<int>(array->GetTuple1(c)));
  }
  return numbers;
}

/// Parts of a surface by its cells; empty: nothing tells them.
std::vector<int> PartsOfCells(vtkDataSet* surface)
{
  const std::vector<int> faces = WholeNumbers(surface, "FaceId");
  const std::vector<int> patches = WholeNumbers(surface, "PatchId");
  return faces.empty()               ? WholeNumbers(surface, "RegionId")
    : patches.size() == faces.size() ? NumbersOfFaces(patches, faces)
                                     : faces;
}

int TriangleTypeOf(int order)
{
  return order == 1 ? VTK_TRIANGLE : order == 2 ? VTK_QUADRATIC_TRIANGLE : VTK_LAGRANGE_TRIANGLE;
}

/// Triangles of the boundary behind the tetrahedra, whose values they get.
void AppendBoundary(
  const SolidMesh& mesh, int order, const std::vector<int>& parts, vtkUnstructuredGrid* grid)
{
  vtkCellData* values = grid->GetCellData();
  const auto ids = NamedArray<vtkIntArray>("BoundaryId");
  for (std::size_t cell = 0; cell < mesh.Cells.size(); ++cell)
  {
    ids->InsertNextValue(-1);
  }
  const std::vector<int> pointOrder = HigherOrderPointOrder(CellShape::Triangle, order);
  const std::vector<SolidMeshFacet> facets = BoundaryFacets(mesh, order);
  std::vector<vtkIdType> points;
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    points.clear();
    for (const int coefficient : pointOrder)
    {
      points.push_back(facets[f].Nodes[static_cast<std::size_t>(coefficient)]);
    }
    grid->InsertNextCell(
      TriangleTypeOf(order), static_cast<vtkIdType>(points.size()), points.data());
    for (int i = 0; i < values->GetNumberOfArrays(); ++i)
    {
      values->GetArray(i)->InsertNextTuple(facets[f].Cell, values->GetArray(i));
    }
    ids->InsertNextValue(parts[f]);
  }
  values->AddArray(ids);
}

void EncodeBoundary(const SolidMesh& mesh, const std::vector<int>& cellsOfTriangles,
  vtkIdType numCorners, vtkPolyData* output)
{
  output->SetPoints(MakePoints(mesh.Points, numCorners));
  vtkNew<vtkCellArray> cells;
  for (const auto& corners : mesh.Boundary)
  {
    cells->InsertNextCell({ corners[0], corners[1], corners[2] });
  }
  output->SetPolys(cells);
  output->GetCellData()->AddArray(ArrayOf<vtkIdTypeArray>("CellIds", mesh.BoundarySources,
    [&](int source)
    {
      const auto triangle = static_cast<std::size_t>(source);
      return source < 0 || cellsOfTriangles.empty() ? -1 : cellsOfTriangles[triangle];
    }));
}

void EncodeNumbers(const SolidMesh& mesh, vtkTable* table)
{
  const SolidMeshNumbers& numbers = mesh.Numbers;
  AddColumn(table, "Points", static_cast<int>(mesh.Points.rows()));
  AddColumn(table, "Tetrahedra", static_cast<int>(mesh.Cells.size()));
  AddColumn(table, "Regions", mesh.NumRegions);
  AddColumn(table, "BoundaryTriangles", static_cast<int>(mesh.Boundary.size()));
  AddColumn(table, "SmallestDihedralAngle", numbers.MinDihedral);
  AddColumn(table, "LargestDihedralAngle", numbers.MaxDihedral);
  AddColumn(table, "WorstRadiusEdgeRatio", numbers.WorstRadiusEdgeRatio);
  AddColumn(table, "Volume", numbers.Volume);
  AddColumn(table, "SurfaceVolume", numbers.SurfaceVolume);
  AddColumn(table, "Repaired", numbers.Repaired ? 1 : 0);
  AddColumn(table, "DistanceToSurface", numbers.DistanceToSurface);
  AddColumn(table, "DistanceFromSurface", numbers.DistanceFromSurface);
  AddColumn(table, "Verdict", std::string(ToString(mesh.Certificate.Verdict)));
  AddColumn(table, "MinJacobianLower", mesh.Certificate.MinLower);
  AddColumn(table, "BoundaryElements", numbers.BoundaryElements);
  AddColumn(table, "RelaxedElements", numbers.RelaxedElements);
  AddColumn(table, "StraightToTarget", numbers.StraightToTarget);
  AddColumn(table, "CurvedToTarget", numbers.CurvedToTarget);
  AddColumn(table, "Diagonal", numbers.Diagonal);
  AddColumn(table, "OversizedElements", numbers.Oversized);
}
}

vtkTetGenMesher::vtkTetGenMesher()
{
  InputType input = Meshes();
  input.Classes.emplace_back("vtkImageData");
  this->SetInputTypes({ input, Optional(Meshes()), Optional({ { "vtkDataSet" } }) });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkPolyData", "vtkTable" });
}

vtkTetGenMesher::~vtkTetGenMesher()
{
  this->SetSizeArray(nullptr);
  this->SetImageArray(nullptr);
}

void vtkTetGenMesher::SetTargetConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkTetGenMesher::SetTargetData(vtkDataObject* target)
{
  this->SetInputDataObject(1, target);
}

void vtkTetGenMesher::SetSizeConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(2, output);
}

void vtkTetGenMesher::SetSizeData(vtkDataObject* sizes)
{
  this->SetInputDataObject(2, sizes);
}

Result<DecodedMesh> vtkTetGenMesher::BoundaryOf(vtkDataObject* spline, std::vector<int>& parts)
{
  const auto model = this->DecodeInput(spline);
  if (!model)
  {
    return model.Status;
  }
  BoundaryOptions options;
  options.Tolerance = this->ChordalTolerance;
  options.Threads = this->KernelThreads();
  options.Progress = this->Progress();
  auto boundary = TriangulateBoundary(spline, model.Value, options);
  if (!boundary)
  {
    return boundary.Status;
  }
  parts = NumbersOfFaces(boundary->Patches, boundary->Faces);
  DecodedMesh mesh;
  mesh.Mesh = std::move(boundary->Mesh);
  mesh.Cells = std::move(boundary->Patches);
  return mesh;
}

WorkerLimits vtkTetGenMesher::Limits() const
{
  WorkerLimits limits;
  limits.Memory = static_cast<std::uint64_t>(this->MemoryLimit) << 20U;
  limits.Seconds = this->TimeLimit;
  limits.CpuSeconds = this->TimeLimit;
  return limits;
}

Result<ImageTetrahedra> vtkTetGenMesher::MeshImage(
  vtkDataObject* input, const TetrahedraParams& asked)
{
  const std::string name = this->ImageArray ? this->ImageArray : "";
  const auto image = DecodeImage(vtkImageData::SafeDownCast(input), name, this->Solid == LABELS);
  if (!image)
  {
    return image.Status;
  }
  ImageMeshParams params;
  params.Solid = this->Solid == BELOW ? ImageSolid::Below
    : this->Solid == ABOVE            ? ImageSolid::Above
                                      : ImageSolid::Labels;
  params.Level = this->Level;
  params.Distance = this->ChordalTolerance * image->Diagonal();
  params.Tetrahedra = asked;
  const auto progress = this->Progress();
  return RunImageMesher(
    image.Value, params, this->Limits(), [&] { return !progress || progress(0.2); });
}

void vtkTetGenMesher::WarnOfUnused(bool isImage)
{
  std::string unused;
  const auto add = [&](bool isSet, const char* name)
  {
    if (isSet)
    {
      unused += (unused.empty() ? "" : ", ") + std::string(name);
    }
  };
  add(isImage && this->Inner != VOIDS, "Inner");
  add(isImage && this->Repair, "Repair");
  add(!isImage && this->Solid != BELOW, "Solid");
  add(!isImage && this->Level != 0.0, "Level");
  add(!isImage && this->ImageArray && *this->ImageArray != '\0', "ImageArray");
  if (!unused.empty())
  {
    this->ReportWarnings({ unused +
      (isImage ? " did not count: the input is an image"
               : " did not count: the input is no image") });
  }
}

Status vtkTetGenMesher::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataSet* input = vtkDataSet::GetData(inputs[0], 0);
  if (input->GetNumberOfPoints() == 0)
  {
    return {};
  }
  const bool isImage = vtkImageData::SafeDownCast(input) != nullptr;
  const bool isSpline = !isImage && HasSplineCells(input);
  this->WarnOfUnused(isImage);
  SolidMeshParams params;
  params.Tetrahedra.RadiusEdgeRatio = this->RadiusEdgeRatio;
  params.Tetrahedra.MinDihedralAngle = this->MinDihedralAngle;
  params.Tetrahedra.MaxVolume = VolumeOfEdge(this->EdgeLength);
  params.Tetrahedra.MaxSteinerPoints = this->MaxSteinerPoints;
  params.Tetrahedra.KeepBoundary = this->KeepBoundary;
  if (vtkDataSet* sizes = vtkDataSet::GetData(inputs[2], 0))
  {
    const std::string name = this->SizeArray ? this->SizeArray : "";
    if (Status status = DecodeSizes(sizes, name, params.Tetrahedra); !status)
    {
      return status;
    }
  }
  params.Inner =
    isImage || this->Inner == REGIONS ? knotwork::InnerParts::Regions : knotwork::InnerParts::Voids;
  params.Repair = this->Repair && !isImage;
  params.Order = this->Order;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  Result<ImageTetrahedra> ofImage;
  Result<DecodedMesh> decoded;
  std::vector<int> parts; // of the surface's triangles
  if (isImage)
  {
    ofImage = this->MeshImage(input, params.Tetrahedra);
    decoded.Value.Mesh = ofImage->Surface;
    decoded.Status = ofImage.Status;
  }
  else
  {
    decoded =
      isSpline ? this->BoundaryOf(input, parts) : DecodeMesh(vtkPointSet::SafeDownCast(input));
  }
  if (!decoded)
  {
    return decoded.Status;
  }
  Result<FitTargetPtr> target;
  vtkDataObject* shape = vtkDataObject::GetData(inputs[1], 0);
  if (!shape && isSpline && this->Order > 1) // it stands for itself
  {
    shape = input;
  }
  if (shape)
  {
    FitTargetOptions options;
    options.SharpAngle = this->SharpAngle;
    target = DecodeFitTarget(shape, options, this->KernelThreads());
  }
  if (!target)
  {
    return target.Status;
  }
  const auto maker = [&](const TriangleMesh& surface, const TetrahedraParams& asked)
  {
    return isImage ? Result<Tetrahedra>(std::move(ofImage->Solid))
                   : RunTetGen(surface, asked, this->Limits(),
                       [&] { return !params.Progress || params.Progress(0.2); });
  };
  const auto mesh = MeshSolid(decoded->Mesh, target.Value.get(), maker, params);
  if (!mesh)
  {
    return mesh.Status;
  }
  EncodeCells(mesh.Value, this->Order, vtkUnstructuredGrid::GetData(outputs, 0));
  if (this->BoundaryCells)
  {
    const std::vector<int> ofCells = isSpline ? std::vector<int>() : PartsOfCells(input);
    for (std::size_t t = 0; !ofCells.empty() && t < decoded->Cells.size(); ++t)
    {
      parts.push_back(ofCells[static_cast<std::size_t>(decoded->Cells[t])]);
    }
    std::vector<int> ofBoundary;
    for (const int source : mesh->BoundarySources)
    {
      ofBoundary.push_back(isImage ? 0
          : source < 0             ? -1
          : parts.empty()          ? 0
                                   : parts[static_cast<std::size_t>(source)]);
    }
    AppendBoundary(mesh.Value, this->Order, ofBoundary, vtkUnstructuredGrid::GetData(outputs, 0));
  }
  EncodeBoundary(mesh.Value, decoded->Cells, mesh->NumCorners, vtkPolyData::GetData(outputs, 1));
  EncodeNumbers(mesh.Value, vtkTable::GetData(outputs, 2));
  if (mesh->Numbers.Oversized > 0)
  {
    this->ReportWarnings({ std::to_string(mesh->Numbers.Oversized) + " of " +
      std::to_string(mesh->Cells.size()) +
      " tetrahedra are larger than was asked for: allow more points (MaxSteinerPoints), points on "
      "the boundary (KeepBoundary off), or sizes that change less from place to place" });
  }
  return {};
}
