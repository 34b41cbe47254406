// SPDX-License-Identifier: BSD-3-Clause
// STEP and IGES files between filters.
#include "CADCases.h"
#include "FilterCases.h"
#include "OutputFile.h"
#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkMassProperties.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTransform.h"
#include "vtkTransformPolyDataFilter.h"
#include "vtkTriangleFilter.h"
#include "vtkUnsignedCharArray.h"
#include <knotwork/SplineIO/vtkCADReader.h>
#include <knotwork/SplineIO/vtkCADWriter.h>
#include <knotwork/SurfaceTrimming/vtkAnalyticModel.h>

#include <cstdio>
#include <fstream>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
struct Grids
{
  vtkNew<vtkUnstructuredGrid> Surfaces;
  vtkNew<vtkUnstructuredGrid> Curves;
};

void Encode(const TrimmedModel& model, Grids& grids)
{
  const Status status = EncodeTrimmedModel(model, grids.Surfaces, grids.Curves);
  EXPECT_TRUE(status) << status.Message();
}

void Read(vtkCADReader* reader, const std::string& file)
{
  vtkNew<MessageRecorder> messages;
  messages->Watch(reader);
  reader->SetFileName(file.c_str());
  EXPECT_EQ(reader->CanReadFile(file.c_str()), 1);
  reader->Update();
  EXPECT_TRUE(messages->Errors.empty()) << messages->Errors.front();
}

vtkPolyData* Triangles(vtkCADReader* reader)
{
  return vtkPolyData::SafeDownCast(reader->GetOutputDataObject(2));
}

double AreaOf(vtkPolyData* triangles)
{
  vtkNew<vtkMassProperties> properties;
  properties->SetInputData(triangles);
  return properties->GetSurfaceArea();
}
}

TEST(CADFilters, TrimmedFacesGoThroughAFile_ExactOracle)
{
  TrimmedModel model = SheetWithHoles(4, 0.2, 2, 16);
  model.Faces[0].Name = "sheet";
  model.Faces[0].HasColor = true;
  model.Faces[0].Color = { 1.0, 0.4, 0.0 };
  Grids grids;
  Encode(model, grids);
  for (const char* ending : { ".step", ".igs" })
  {
    const std::string file = OutputFile(std::string("sheet") + ending);
    vtkNew<vtkCADWriter> writer;
    writer->SetInputDataObject(0, grids.Surfaces);
    writer->SetInputDataObject(1, grids.Curves);
    writer->SetFileName(file.c_str());
    ASSERT_EQ(writer->Write(), 1);
    const auto summary = CheckCAD(file);
    EXPECT_TRUE(summary->Valid);
    EXPECT_EQ(summary->NumFreeLoops, 3);

    vtkNew<vtkCADReader> reader;
    Read(reader, file);
    const auto back =
      DecodeTrimmedModel(reader->GetOutputDataObject(0), reader->GetOutputDataObject(1));
    ASSERT_TRUE(back) << back.Status.Message();
    ASSERT_EQ(back->Faces.size(), 1u);
    EXPECT_EQ(back->Faces[0].Loops.size(), 3u);
    EXPECT_EQ(back->Faces[0].Surface.ControlPoints, model.Faces[0].Surface.ControlPoints);
    EXPECT_EQ(back->Faces[0].Name, "sheet");

    vtkPolyData* triangles = Triangles(reader);
    ASSERT_GT(triangles->GetNumberOfCells(), 10);
    // chords of a thousandth of the size on a sheet with slopes up to 0.6
    EXPECT_NEAR(AreaOf(triangles), summary->Area, 5e-3);
    auto* colors = vtkUnsignedCharArray::SafeDownCast(triangles->GetCellData()->GetArray("Color"));
    auto* names = vtkStringArray::SafeDownCast(triangles->GetCellData()->GetAbstractArray("Name"));
    ASSERT_TRUE(colors && names && triangles->GetCellData()->GetArray("FaceId"));
    EXPECT_EQ(colors->GetNumberOfComponents(), 3);
    EXPECT_EQ(colors->GetTypedComponent(0, 1), 102);
    EXPECT_EQ(names->GetValue(0), "sheet");

    // a tolerance of lengths, far above and far below a thousandth of the size (about 1)
    reader->RelativeToleranceOff();
    reader->SetChordalTolerance(0.1);
    Read(reader, file);
    const vtkIdType coarse = Triangles(reader)->GetNumberOfCells();
    reader->SetChordalTolerance(1e-4);
    Read(reader, file);
    const vtkIdType fine = Triangles(reader)->GetNumberOfCells();
    EXPECT_LT(2 * coarse, fine);
    EXPECT_NEAR(AreaOf(Triangles(reader)), summary->Area, 5e-4);
    reader->TriangulationOff();
    Read(reader, file);
    EXPECT_EQ(Triangles(reader)->GetNumberOfCells(), 0);
    EXPECT_GT(reader->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), 0);
  }
}

TEST(CADFilters, ShapesBecomeFacesAndSolids_ExactOracle)
{
  struct Case
  {
    int Shape;
    int Faces, Solids;
    double Area;
  };
  // outer radius 1, inner radius 0.5, height 1, size 1
  for (const Case& c : { Case{ static_cast<int>(ShapeKind::Disc), 5, 0, Pi },
         Case{ static_cast<int>(ShapeKind::SphereSurface), 6, 1, 4 * Pi },
         Case{ static_cast<int>(ShapeKind::Cube), 6, 1, 6.0 },
         Case{ static_cast<int>(ShapeKind::SolidCylinder), 14, 1, 4 * Pi } })
  {
    vtkNew<vtkSplineSource> source;
    source->SetShape(c.Shape);
    const std::string file = OutputFile("shape.stp");
    vtkNew<vtkCADWriter> writer;
    writer->SetInputConnection(source->GetOutputPort());
    writer->SetFileName(file.c_str());
    writer->SetSchema(1);
    writer->SetUnit(vtkCADReader::Metre);
    writer->SetProductName("shape");
    ASSERT_EQ(writer->Write(), 1) << c.Shape;
    const auto summary = CheckCAD(file, LengthUnit::Metre);
    EXPECT_TRUE(summary->Valid);
    EXPECT_EQ(summary->NumFaces, c.Faces);
    EXPECT_EQ(summary->NumSolids, c.Solids);
    EXPECT_NEAR(summary->Area, c.Area, 1e-6);
    vtkNew<vtkCADReader> reader;
    reader->SetUnit(vtkCADReader::Metre);
    reader->SetChordalTolerance(3e-4);
    Read(reader, file);
    EXPECT_NEAR(AreaOf(Triangles(reader)), c.Area, 2e-3 * c.Area);
    auto* names =
      vtkStringArray::SafeDownCast(Triangles(reader)->GetCellData()->GetAbstractArray("Name"));
    EXPECT_EQ(names->GetValue(0), "shape"); // faces without a name have their product's
  }
}

/// What is shown is written: the triangles of a filter that has the faces, too.
TEST(CADFilters, FacesBesideTrianglesAreWritten_CrossOracle)
{
  vtkNew<vtkCubeSource> cube;
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(cube->GetOutputPort());
  vtkNew<vtkAnalyticModel> model;
  model->SetInputConnection(triangles->GetOutputPort());
  for (const int port : { 0, 1 })
  {
    const std::string file = OutputFile("cube" + std::to_string(port) + ".step");
    vtkNew<vtkCADWriter> writer;
    writer->SetInputConnection(model->GetOutputPort(port));
    writer->SetFileName(file.c_str());
    ASSERT_EQ(writer->Write(), 1);
    const auto summary = CheckCAD(file);
    EXPECT_TRUE(summary->Valid);
    EXPECT_EQ(summary->NumFaces, 6);
    EXPECT_EQ(summary->NumSolids, 1);
    EXPECT_NEAR(summary->Volume, 1.0, 1e-12);
  }
  // elsewhere than the faces
  vtkNew<vtkTransform> move;
  move->Translate(1.0, 0.0, 0.0);
  vtkNew<vtkTransformPolyDataFilter> moved;
  moved->SetTransform(move);
  moved->SetInputConnection(model->GetOutputPort());
  const std::string file = OutputFile("moved.step");
  std::remove(file.c_str());
  vtkNew<vtkCADWriter> writer;
  vtkNew<MessageRecorder> messages;
  messages->Watch(writer);
  writer->SetInputConnection(moved->GetOutputPort());
  writer->SetFileName(file.c_str());
  writer->Write();
  ASSERT_EQ(messages->Errors.size(), 1u);
  EXPECT_NE(messages->Errors.front().find("Analytic Model"), std::string::npos);
  EXPECT_FALSE(std::ifstream(file).good());
}

TEST(CADFilters, FailuresAreErrorsOfTheFilter_PropertyOracle)
{
  Grids grids;
  Encode(SheetWithHoles(2, 0.1, 1, 8), grids);
  const auto refused =
    [](vtkCADWriter* writer, vtkDataObject* grid, const std::string& file, ErrorCode code)
  {
    vtkNew<MessageRecorder> messages;
    messages->Watch(writer);
    writer->SetInputDataObject(0, grid);
    writer->SetFileName(file.c_str());
    writer->Write();
    EXPECT_EQ(messages->Errors.size(), 1u) << file;
    EXPECT_EQ(writer->GetErrorCode(), vtkErrorCode::UserError + static_cast<unsigned long>(code));
  };
  vtkNew<vtkCADWriter> writer;
  refused(writer, grids.Surfaces, OutputFile("wrong.obj"), ErrorCode::InvalidParameter);
  refused(writer, grids.Surfaces, OutputFile("no/folder.step"), ErrorCode::FileError);
  vtkNew<vtkSplineSource> line;
  line->SetShape(static_cast<int>(ShapeKind::Line));
  line->Update();
  refused(
    writer, line->GetOutputDataObject(0), OutputFile("line.step"), ErrorCode::DimensionMismatch);

  vtkNew<vtkCADReader> reader;
  vtkNew<MessageRecorder> messages;
  messages->Watch(reader);
  EXPECT_EQ(reader->CanReadFile(OutputFile("missing.step").c_str()), 0);
  reader->SetFileName(OutputFile("missing.step").c_str());
  reader->Update();
  ASSERT_FALSE(messages->Errors.empty());
  EXPECT_NE(messages->Errors[0].find("missing.step"), std::string::npos);
  EXPECT_EQ(reader->GetErrorCode(),
    vtkErrorCode::UserError + static_cast<unsigned long>(ErrorCode::FileError));
  EXPECT_EQ(reader->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), 0);
}

TEST(CADFilters, EdgesOfShellsAreInterfaces_CrossOracle)
{
  for (const int shape : { vtkSplineSource::CUBE, vtkSplineSource::TWISTED_BAR })
  {
    SCOPED_TRACE(shape);
    const std::string file = OutputFile("shell.step");
    vtkNew<vtkCADWriter> writer;
    writer->SetInputDataObject(0, ShapeGrid(shape));
    writer->SetFileName(file.c_str());
    ASSERT_EQ(writer->Write(), 1);
    vtkNew<vtkCADReader> reader;
    Read(reader, file);
    const Result<SplineModel> model = DecodeSplineModel(reader->GetOutputDataObject(0), 1);
    ASSERT_TRUE(model) << model.Status.Message();
    std::vector<Spline<2>> faces;
    for (const SplinePatch& patch : model->Patches)
    {
      faces.push_back(std::get<Spline<2>>(patch.Geometry));
    }
    const auto sides = SampleSides<2>(faces, 9, 1);
    ASSERT_TRUE(sides);
    // sizes are about 1; what a STEP file keeps of its curves is far better
    std::vector<PatchInterface> expected = FindInterfaces(sides.Value, 1e-6);
    std::vector<PatchInterface> stated = model->Topology.Interfaces;
    ASSERT_EQ(expected.size(), 12u);
    ASSERT_EQ(stated.size(), 12u);
    for (std::vector<PatchInterface>* list : { &expected, &stated })
    {
      for (PatchInterface& interface : *list)
      {
        std::sort(interface.Sides.begin(), interface.Sides.end());
      }
      std::sort(list->begin(), list->end(),
        [](const PatchInterface& a, const PatchInterface& b) { return a.Sides < b.Sides; });
    }
    for (std::size_t i = 0; i < stated.size(); ++i)
    {
      EXPECT_EQ(stated[i].Sides, expected[i].Sides);
      EXPECT_EQ(stated[i].Orientation, expected[i].Orientation);
    }
  }
}
