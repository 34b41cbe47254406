// SPDX-License-Identifier: BSD-3-Clause
#include "FileFormats.h"

#include "DataFile.h"
#include "ForeignFile.h"
#include "PieceFiles.h"
#include "PolygonText.h"
#include "VTKText.h"
#include "vtkBEXTReader.h"
#include "vtkBEXTWriter.h"
#include "vtkCADReader.h"
#include "vtkCADWriter.h"
#include "vtkDomainBoundaryReader.h"
#include "vtkGeoPackageWriter.h"
#include "vtkGeoTIFFWriter.h"
#include "vtkGismoXMLReader.h"
#include "vtkGismoXMLWriter.h"
#include "vtkGoToolsG2Reader.h"
#include "vtkGoToolsG2Writer.h"
#include "vtkMFEMReader.h"
#include "vtkPointCloudReader.h"
#include "vtkPointCloudWriter.h"
#include "vtkSolverMeshReader.h"
#include "vtkSolverMeshWriter.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>
#include <knotwork/SplineIO/NearestName.h>

#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <functional>

namespace knotwork
{
namespace
{
template <typename Reader>
Status Update(Reader* reader, const std::string& file, DataFile& found)
{
  reader->SetFileName(file.c_str());
  reader->Update();
  found.Data = reader->GetOutputDataObject(0);
  if (auto* own = vtkSplineAlgorithm::SafeDownCast(reader))
  {
    for (int i = 0; i < own->GetNumberOfPartsLeftOut(); ++i)
    {
      found.LeftOut.push_back(own->GetPartLeftOut(i));
    }
  }
  return { CodeOfFilter(reader), "" };
}

template <typename Reader>
Status ReadWith(const std::string& file, DataFile& found)
{
  vtkNew<Reader> reader;
  return Update(reader.Get(), file, found);
}

Status ReadG2(const std::string& file, DataFile& found)
{
  vtkNew<vtkPointCloudReader> points;
  if (points->CanReadFile(file.c_str()) != 0)
  {
    return Update(points.Get(), file, found);
  }
  vtkNew<vtkGoToolsG2Reader> reader;
  Status status = Update(reader.Get(), file, found);
  vtkDataObject* curves = reader->GetOutputDataObject(1);
  found.Curves = curves->GetNumberOfElements(vtkDataObject::POINT) > 0 ? curves : nullptr;
  return status;
}

Status ReadJson(const std::string& file, DataFile& found)
{
  vtkNew<vtkBEXTReader> operators;
  return operators->CanReadFile(file.c_str()) != 0 ? Update(operators.Get(), file, found)
                                                   : ReadWith<vtkDomainBoundaryReader>(file, found);
}

Status ReadFaces(const std::string& file, DataFile& found)
{
  vtkNew<vtkCADReader> reader;
  reader->TriangulationOff();
  Status status = Update(reader.Get(), file, found);
  found.Curves = reader->GetOutputDataObject(1);
  return status;
}

/// A writer of ours tells why it has failed as an error of VTK.
Status Outcome(vtkWriter* writer)
{
  return writer->Write() == 1 ? Status() : Status(CodeOfFilter(writer), "");
}

template <typename Writer>
Status WriteWith(vtkDataObject* data, const std::string& file, const DataFileParams&)
{
  vtkNew<Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  return Outcome(writer);
}

Status WriteFaces(vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  vtkNew<vtkCADWriter> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  if (params.Curves)
  {
    writer->SetInputDataObject(1, params.Curves);
  }
  return Outcome(writer);
}

Status WriteG2(vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  if (vtkPolyData::SafeDownCast(data))
  {
    return WriteWith<vtkPointCloudWriter>(data, file, params);
  }
  vtkNew<vtkGoToolsG2Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  if (params.Curves)
  {
    writer->SetCurvesData(params.Curves);
  }
  return Outcome(writer);
}

Status WritePointText(vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  return vtkTable::SafeDownCast(data) ? PutText(TextOfTable(data), file)
                                      : WriteWith<vtkPointCloudWriter>(data, file, params);
}

/// The cells of polygons as a grid, with their arrays.
vtkSmartPointer<vtkUnstructuredGrid> GridOfPolygons(vtkPolyData* polygons)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(polygons->GetPoints());
  grid->Allocate(polygons->GetNumberOfCells());
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < polygons->GetNumberOfCells(); ++cell)
  {
    polygons->GetCellPoints(cell, points);
    grid->InsertNextCell(polygons->GetCellType(cell), points);
  }
  grid->GetPointData()->ShallowCopy(polygons->GetPointData());
  grid->GetCellData()->ShallowCopy(polygons->GetCellData());
  return grid;
}

Status WriteMesh(vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  auto* polygons = vtkPolyData::SafeDownCast(data);
  const vtkSmartPointer<vtkDataObject> cells = polygons ? GridOfPolygons(polygons).Get() : data;
  vtkNew<vtkSolverMeshWriter> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(cells);
  writer->SetBinary(params.Encoding != "ascii");
  return Outcome(writer);
}

Status WritePolygons(vtkDataObject* data, const std::string& file, const DataFileParams&)
{
  const auto text = PolygonText(data, LowerEnding(file));
  return text ? PutText(text.Value, file) : text.Status;
}

/// In a process of its own, which damaged files may crash.
Status ReadOfVTK(const std::string& file, DataFile& found)
{
  auto read = ReadVTKFile(file);
  found.Data = read.Value;
  return read.Status;
}

Status WriteOfVTK(vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  return WriteVTKFile(data, file, params.Encoding, params.Threads);
}

Status ReadInPieces(const std::string& file, DataFile& found)
{
  auto read = ReadPieces(file);
  found.Data = read.Value;
  return read.Status;
}

Status WriteInPieces(vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  std::vector<vtkSmartPointer<vtkDataSet>> pieces;
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  if (grid && params.Pieces > 1)
  {
    for (const auto& part : DivideGrid(grid, params.Pieces))
    {
      pieces.emplace_back(part);
    }
  }
  else
  {
    pieces.emplace_back(vtkDataSet::SafeDownCast(data));
  }
  std::vector<std::size_t> numbers;
  for (const auto& piece : pieces)
  {
    numbers.push_back(numbers.size());
    if (Status status = WritePiece(piece, numbers.back(), file, params.Encoding, params.Threads);
        !status)
    {
      return status;
    }
  }
  return WritePieceIndex(pieces.front(), numbers, file);
}

constexpr unsigned Splines = SplineGridContent | SplineCollectionContent;
constexpr unsigned SplinesAndCurves = Splines | SplineCurveContent;
constexpr unsigned Elements = SplinesAndCurves | SplineElementContent;
constexpr unsigned Faces = Splines | TrimmedFaceContent;
constexpr unsigned Polygons = PolygonContent | PolygonCollectionContent;
constexpr unsigned PointsAndValues = PointContent | PointValueContent;
constexpr unsigned Lines = PointsAndValues | PolylineContent | PolygonContent;
constexpr unsigned Collections = SplineCollectionContent | PolygonCollectionContent | CellContent;
constexpr unsigned Cells = SplineGridContent | CellContent | GridContent;
constexpr unsigned MeshCells = GridContent | PolygonContent | PolylineContent;

std::vector<std::string> EndingsWhere(const std::function<bool(const FileFormat&)>& isMeant)
{
  std::vector<std::string> endings;
  for (const FileFormat& format : FileFormats())
  {
    if (isMeant(format))
    {
      endings.insert(endings.end(), format.Endings.begin(), format.Endings.end());
    }
  }
  return endings;
}
}

const std::vector<FileFormat>& FileFormats()
{
  constexpr auto readPoints =
    ReadWith<vtkPointCloudReader>; // takes PointContent of all that is read
  constexpr auto readGismo = ReadWith<vtkGismoXMLReader>;
  constexpr auto writeGismo = WriteWith<vtkGismoXMLWriter>;
  constexpr auto readOperators = ReadWith<vtkBEXTReader>;
  constexpr auto writeOperators = WriteWith<vtkBEXTWriter>;
  constexpr auto readMesh = ReadWith<vtkMFEMReader>;
  constexpr auto readElements = ReadWith<vtkSolverMeshReader>;
  // name, endings, what is read, what is written, whether VTK serves it, reader, writer
  static const std::vector<FileFormat> formats = {
    { "VTK polygons", { ".vtp" }, Lines, Lines | CellContent, true, ReadOfVTK, WriteOfVTK },
    { "VTK grid", { ".vtu" }, SplineCurveContent | Cells,
      SplineCurveContent | TrimmedFaceContent | Cells, true, ReadOfVTK, WriteOfVTK },
    { "VTK grid in pieces", { ".pvtu" }, Cells, Cells, true, ReadInPieces, WriteInPieces },
    { "VTK polygons in pieces", { ".pvtp" }, Lines, Lines, true, ReadInPieces, WriteInPieces },
    { "VTK collection", { ".vtpc" }, Collections, Collections, true, ReadOfVTK, WriteOfVTK },
    { "VTK legacy grid", { ".vtk" }, Cells, 0, true, ReadOfVTK, nullptr },
    { "VTK image", { ".vti" }, ImageContent, ImageContent, true, ReadOfVTK, WriteOfVTK },
    { "G+Smo XML", { ".xml" }, SplinesAndCurves, SplinesAndCurves, false, readGismo, writeGismo },
    { "point text", { ".xyz", ".txt" }, PointsAndValues, PointsAndValues, false, readPoints,
      WritePointText },
    { "comma-separated values", { ".csv" }, PointsAndValues, PointsAndValues | TableContent, false,
      readPoints, WritePointText },
    { "GoTools", { ".g2" }, SplinesAndCurves | PointContent, SplinesAndCurves | PointContent, false,
      ReadG2, WriteG2 },
    { "STEP", { ".step", ".stp" }, Faces, Faces, false, ReadFaces, WriteFaces },
    { "IGES", { ".iges", ".igs" }, Faces, Faces, false, ReadFaces, WriteFaces },
    { "BREP", { ".brep" }, Faces, 0, false, ReadFaces, nullptr },
    { "STL", { ".stl" }, PointContent | PolygonContent, Polygons, false, readPoints,
      WritePolygons },
    { "Wavefront OBJ", { ".obj" }, PointContent | PolygonContent, Polygons, false, readPoints,
      WritePolygons },
    { "PLY", { ".ply" }, PointsAndValues | PolygonContent, Polygons, false, readPoints,
      WritePolygons },
    { "LAS", { ".las", ".laz" }, PointsAndValues, 0, false, readPoints, nullptr },
    { "GeoTIFF", { ".tif", ".tiff" }, PointContent, HeightRasterContent, false, readPoints,
      WriteWith<vtkGeoTIFFWriter> },
    { "GeoPackage", { ".gpkg" }, 0, PolylineContent, false, nullptr,
      WriteWith<vtkGeoPackageWriter> },
    { "OFF", { ".off" }, PointContent | PolygonContent, 0, false, readPoints, nullptr },
    { "SVG", { ".svg" }, PointContent | PolylineContent, 0, false, readPoints, nullptr },
    { "BEXT", { ".bext" }, Elements, Elements, false, readOperators, writeOperators },
    { "JSON of BEXT or of the boundary of a domain", { ".json" }, Elements | BoundaryContent,
      Elements, false, ReadJson, writeOperators },
    { "MFEM mesh", { ".mesh" }, SplineCurveContent | Cells, MeshCells, false, readMesh, WriteMesh },
    { "Gmsh mesh", { ".msh" }, CellContent | GridContent, MeshCells, false, readElements,
      WriteMesh },
    { "Abaqus input", { ".inp" }, CellContent | GridContent, 0, false, readElements, nullptr },
  };
  return formats;
}

const FileFormat* FormatOfEnding(const std::string& ending)
{
  for (const FileFormat& format : FileFormats())
  {
    if (std::find(format.Endings.begin(), format.Endings.end(), ending) != format.Endings.end())
    {
      return &format;
    }
  }
  return nullptr;
}

std::vector<std::string> EndingsThatRead(unsigned contents)
{
  return EndingsWhere([contents](const FileFormat& one) { return (one.Reads & contents) != 0; });
}

std::vector<std::string> EndingsThatWrite(unsigned contents)
{
  return EndingsWhere([contents](const FileFormat& one) { return (one.Writes & contents) != 0; });
}

std::string JoinEndings(const std::vector<std::string>& endings, const std::string& between)
{
  std::string text;
  for (const std::string& ending : endings)
  {
    text += (text.empty() ? "" : between) + ending;
  }
  return text;
}

std::string SuggestEnding(const std::string& ending, const std::vector<std::string>& known)
{
  const std::string nearest = FormatOfEnding(ending) ? "" : NearestName(ending, known);
  return nearest.empty() ? "" : " (did you mean '" + nearest + "'?)";
}
}
