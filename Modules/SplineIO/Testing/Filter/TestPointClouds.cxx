// SPDX-License-Identifier: BSD-3-Clause
// Point clouds and boundary curves through readers and writers.
#include "FilterCases.h"
#include "OutputFile.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkXMLPolyDataWriter.h"
#include <knotwork/SplineIO/vtkGoToolsG2Reader.h>
#include <knotwork/SplineIO/vtkGoToolsG2Writer.h>
#include <knotwork/SplineIO/vtkPointCloudReader.h>
#include <knotwork/SplineIO/vtkPointCloudWriter.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

using namespace knotwork;
namespace fs = std::filesystem;

namespace
{
std::string TextOf(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  return { std::istreambuf_iterator<char>(stream), {} };
}

std::string WithText(const std::string& name, const std::string& text)
{
  std::ofstream(OutputFile(name), std::ios::binary) << text;
  return OutputFile(name);
}

vtkSmartPointer<vtkPolyData> Read(const std::string& file)
{
  vtkNew<vtkPointCloudReader> reader;
  reader->SetFileName(file.c_str());
  EXPECT_EQ(reader->CanReadFile(file.c_str()), 1) << file;
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0U) << file;
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->ShallowCopy(reader->GetOutputDataObject(0));
  return data;
}

void Write(vtkDataObject* data, const std::string& file)
{
  vtkNew<vtkPointCloudWriter> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  EXPECT_EQ(writer->Write(), 1) << file;
  EXPECT_EQ(writer->GetErrorCode(), 0U) << file;
}

/// Points with a vector and a scalar, seeded.
vtkSmartPointer<vtkPolyData> MakeCloud(int n)
{
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1e5);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> velocity;
  velocity->SetName("Velocity");
  velocity->SetNumberOfComponents(3);
  vtkNew<vtkDoubleArray> heat;
  heat->SetName("Heat");
  for (int i = 0; i < n; ++i)
  {
    points->InsertNextPoint(normal(random), normal(random), normal(random));
    velocity->InsertNextTuple3(normal(random), normal(random), normal(random));
    heat->InsertNextValue(normal(random));
  }
  auto cloud = vtkSmartPointer<vtkPolyData>::New();
  cloud->SetPoints(points);
  cloud->GetPointData()->AddArray(velocity);
  cloud->GetPointData()->AddArray(heat);
  return cloud;
}

::testing::AssertionResult SameArray(vtkDataArray* a, vtkDataArray* b)
{
  if (!a || !b || a->GetNumberOfTuples() != b->GetNumberOfTuples() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents())
  {
    return ::testing::AssertionFailure() << "an array is missing or has another size";
  }
  for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < a->GetNumberOfComponents(); ++c)
    {
      if (a->GetComponent(i, c) != b->GetComponent(i, c))
      {
        return ::testing::AssertionFailure() << "row " << i << " differs";
      }
    }
  }
  return ::testing::AssertionSuccess();
}
}

TEST(PointClouds, ComeBackBitForBit_PropertyOracle)
{
  const auto cloud = MakeCloud(300);
  for (const char* name : { "a.xyz", "a.txt", "a.csv", "A.CSV" })
  {
    SCOPED_TRACE(name);
    Write(cloud, OutputFile(name));
    const auto again = Read(OutputFile(name));
    EXPECT_TRUE(SameArray(again->GetPoints()->GetData(), cloud->GetPoints()->GetData()));
    for (const char* array : { "Velocity", "Heat" })
    {
      EXPECT_TRUE(
        SameArray(again->GetPointData()->GetArray(array), cloud->GetPointData()->GetArray(array)));
    }
    EXPECT_EQ(again->GetNumberOfVerts(), 300);
  }
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(OutputFile("a.vtp").c_str());
  writer->SetInputData(cloud);
  writer->Write();
  const auto again = Read(OutputFile("a.vtp"));
  EXPECT_TRUE(SameArray(again->GetPoints()->GetData(), cloud->GetPoints()->GetData()));
}

TEST(PointClouds, GroupsOfG2KeepTheirColours_GoldenOracle)
{
  const std::string text = "400 1 0 0\n2\n0 0 0\n0.1 0.2 0.3\n\n"
                           "400 1 0 4 255 0 128 255\n1\n1 2 3\n\n";
  const auto cloud = Read(WithText("groups.g2", text));
  ASSERT_EQ(cloud->GetNumberOfPoints(), 3);
  EXPECT_EQ(cloud->GetPointData()->GetArray("CloudId")->GetComponent(2, 0), 1);
  EXPECT_EQ(cloud->GetPointData()->GetArray("Color")->GetComponent(2, 2), 128);
  Write(cloud, OutputFile("again.g2"));
  EXPECT_EQ(TextOf(OutputFile("again.g2")), text);
  vtkNew<vtkGoToolsG2Reader> splines; // which are none
  EXPECT_EQ(splines->CanReadFile(OutputFile("groups.g2").c_str()), 0);
}

TEST(PointClouds, PolygonsOfPlyAreCells_GoldenOracle)
{
  const auto mesh = Read(KNOTWORK_DATA_DIR "/SplineIO/by_hand_points.ply");
  EXPECT_EQ(mesh->GetNumberOfPolys(), 1);
  EXPECT_EQ(mesh->GetNumberOfVerts(), 0);
  EXPECT_EQ(mesh->GetPointData()->GetArray("red")->GetComponent(0, 0), 255);
  EXPECT_EQ(mesh->GetPoints()->GetDataType(), VTK_DOUBLE);
}

TEST(PointClouds, MeshesHaveFacesLinesAndTexture_GoldenOracle)
{
  const auto mesh = Read(WithText("mesh.obj",
    "v 0 0 0\nv 1 0 0\nv 0 1 0.1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nl 1 2\nl 2 3 1\n"));
  EXPECT_EQ(mesh->GetNumberOfPolys(), 1);
  EXPECT_EQ(mesh->GetNumberOfLines(), 2);
  EXPECT_EQ(mesh->GetNumberOfVerts(), 0);
  ASSERT_NE(mesh->GetPointData()->GetTCoords(), nullptr);
  EXPECT_EQ(mesh->GetPointData()->GetTCoords()->GetComponent(2, 1), 1.0);
  EXPECT_EQ(mesh->GetPoint(2)[2], 0.1); // a double, not the nearest float
  const auto off = Read(WithText("mesh.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 2 1 0\n"));
  EXPECT_EQ(off->GetNumberOfPolys(), 1);
  EXPECT_EQ(off->GetCellType(0), VTK_TRIANGLE);
  EXPECT_EQ(Read(WithText("only.obj", "v 0 0 0\nv 1 0 0\n"))->GetNumberOfVerts(), 2);
}

TEST(PointClouds, WhatIsLeftOutIsToldUntilTheNextUpdate_ExactOracle)
{
  vtkNew<vtkPointCloudReader> reader;
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(reader);
  reader->SetFileName(WithText("tags.obj", "v 0 0 0\nt crease 1\n").c_str());
  reader->Update();
  ASSERT_EQ(reader->GetNumberOfPartsLeftOut(), 1);
  EXPECT_EQ(reader->GetPartLeftOut(0).rfind("line 2: 1 curves, surfaces or tags", 0), 0U);
  EXPECT_EQ(reader->GetPartLeftOut(1), "");
  EXPECT_EQ(reader->GetPartLeftOut(-1), "");
  EXPECT_EQ(recorder->Warnings.size(), 1U);
  reader->SetFileName(WithText("none.obj", "v 0 0 0\n").c_str());
  reader->Update();
  EXPECT_EQ(reader->GetNumberOfPartsLeftOut(), 0);
}

TEST(PointClouds, EveryFailureIsOneErrorWithTheFile_ExactOracle)
{
  const struct
  {
    std::string File;
    ErrorCode Code;
    const char* Words;
  } cases[] = {
    { "", ErrorCode::EmptyInput, "no file name" },
    { OutputFile("missing.xyz"), ErrorCode::FileError, "missing.xyz" },
    { WithText("short.xyz", "1 2 3\n4 5\n"), ErrorCode::InvalidFormat, "short.xyz': line 2" },
    { WithText("nan.csv", "1,2,3\n4,5,nan\n"), ErrorCode::NonFiniteInput, "nan.csv': line 2" },
    { WithText("cut.g2", "400 1 0 0\n5\n1 2 3\n"), ErrorCode::InvalidFormat, "cut.g2" },
    { WithText("cut.ply", "ply\n"), ErrorCode::InvalidFormat, "cut.ply" },
    { WithText("bad.off", "OFF\n1 0 0\n0 0 1e999\n"), ErrorCode::InvalidFormat,
      "bad.off': line 3" },
    { WithText("bad.obj", "v 0 0 nan\n"), ErrorCode::NonFiniteInput, "bad.obj': line 1" },
    { WithText("bad.stl", "solid\n"), ErrorCode::InvalidFormat, "bad.stl': line 2" },
    { WithText("other.abc", "1 2 3\n"), ErrorCode::InvalidParameter, ".abc" },
    { WithText("empty.vtp", ""), ErrorCode::EmptyInput, "empty.vtp" },
  };
  for (const auto& test : cases)
  {
    SCOPED_TRACE(test.File);
    vtkNew<vtkPointCloudReader> reader;
    vtkNew<MessageRecorder> recorder;
    recorder->Watch(reader);
    reader->SetFileName(test.File.c_str());
    reader->Update();
    EXPECT_EQ(
      reader->GetErrorCode(), vtkErrorCode::UserError + static_cast<unsigned long>(test.Code));
    ASSERT_FALSE(recorder->Errors.empty());
    const bool said = std::any_of(recorder->Errors.begin(), recorder->Errors.end(),
      [&](const std::string& text) { return text.find(test.Words) != std::string::npos; });
    EXPECT_TRUE(said) << recorder->Errors.front();
  }
  vtkNew<vtkPointCloudWriter> writer;
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(writer);
  writer->SetInputData(MakeCloud(3));
  for (const std::string& file :
    { std::string(), OutputFile("a.abc"), OutputFile("no/such/a.xyz") })
  {
    recorder->Errors.clear();
    writer->SetFileName(file.c_str());
    writer->Write();
    EXPECT_EQ(recorder->Errors.size(), 1U) << file;
  }
  recorder->Errors.clear();
  writer->SetInputData(vtkSmartPointer<vtkPolyData>::New());
  writer->SetFileName(OutputFile("none.g2").c_str());
  writer->Write();
  EXPECT_EQ(recorder->Errors.size(), 1U);
  EXPECT_FALSE(fs::exists(OutputFile("none.g2")));
  // text says what was looked for, and that nothing was found
  recorder->Errors.clear();
  writer->SetFileName(OutputFile("none.xyz").c_str());
  writer->Write();
  EXPECT_TRUE(recorder->Errors.empty());
  EXPECT_EQ(TextOf(OutputFile("none.xyz")), "# x y z\n");
}

TEST(PointClouds, BoundaryCurvesOfSurfacesComeBack_PropertyOracle)
{
  const std::string body = "3 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0\n2 0 0\n0 1 0\n2 1 0.5\n";
  const std::string edge = "2 0\n2 2\n0 0 1 1\n0.2 0.2\n0.8 0.2\n";
  const std::string inSpace = "3 0\n2 2\n0 0 1 1\n0.4 0.2 0\n1.6 0.2 0.25\n";
  const std::string text = "200 1 0 0\n" + body + "\n210 1 0 0\n200\n" + body +
    "2\n1 1e-06\n1 100 0\n" + edge + "2 0.5\n0 100 100\n" + edge + inSpace + "0 0 100\n" + inSpace +
    "\n";
  vtkNew<vtkGoToolsG2Reader> reader;
  reader->SetFileName(WithText("bounded.g2", text).c_str());
  reader->Update();
  ASSERT_EQ(reader->GetErrorCode(), 0U);
  auto* curves = vtkUnstructuredGrid::SafeDownCast(reader->GetOutputDataObject(1));
  ASSERT_EQ(curves->GetNumberOfCells(), 4);
  EXPECT_EQ(curves->GetCellData()->GetArray("FaceId")->GetComponent(0, 0), 1);
  EXPECT_EQ(curves->GetCellData()->GetArray("LoopTolerance")->GetComponent(1, 0), 0.5);
  vtkNew<vtkGoToolsG2Writer> writer;
  writer->SetInputConnection(0, reader->GetOutputPort(0));
  writer->SetCurvesConnection(reader->GetOutputPort(1));
  writer->SetFileName(OutputFile("bounded_again.g2").c_str());
  writer->Write();
  EXPECT_EQ(TextOf(OutputFile("bounded_again.g2")), text);
  // without curves, whole surfaces
  writer->SetInputConnection(1, nullptr);
  writer->Write();
  EXPECT_EQ(
    TextOf(OutputFile("bounded_again.g2")), "200 1 0 0\n" + body + "\n200 1 0 0\n" + body + "\n");
  // curves that are not numbered without gaps
  vtkNew<vtkUnstructuredGrid> broken;
  broken->DeepCopy(curves);
  broken->GetCellData()->GetArray("LoopId")->SetTuple1(0, 7);
  writer->SetCurvesData(broken);
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(writer);
  writer->Write();
  ASSERT_EQ(recorder->Errors.size(), 1U);
  EXPECT_NE(recorder->Errors[0].find("without gaps"), std::string::npos);
  broken->GetCellData()->RemoveArray("CurveId");
  broken->Modified();
  writer->Write();
  EXPECT_NE(recorder->Errors.back().find("'CurveId' is missing"), std::string::npos);
}
