// SPDX-License-Identifier: BSD-3-Clause
// Files that other libraries read in a process of its own: the same data, and one error whatever
// happens to that process.
#include "CADCases.h"
#include "DataText.h"
#include "FilterCases.h"
#include "OutputFile.h"
#include "RandomModels.h"
#include <knotwork/SplineIO/ForeignFile.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include "vtkCellArray.h"
#include "vtkCompositeDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLDataObjectWriter.h"
#include "vtkXMLPartitionedDataSetCollectionWriter.h"
#include "vtkXMLWriter.h"
#include <knotwork/SplineIO/vtkCADReader.h>
#include <knotwork/SplineIO/vtkPointCloudReader.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

using namespace knotwork;
using namespace knotwork::testing;
namespace fs = std::filesystem;

namespace
{
void WriteXML(vtkDataObject* data, const std::string& file)
{
  const auto writer = vtkSmartPointer<vtkXMLWriter>::Take(
    vtkXMLDataObjectWriter::NewWriter(data->GetDataObjectType()));
  writer->SetInputDataObject(data);
  writer->SetFileName(file.c_str());
  ASSERT_EQ(writer->Write(), 1);
}

/// Programs that take the place of the readers while it lives.
class OtherWorkers
{
public:
  explicit OtherWorkers(const std::string& commands) : Folder(OutputFile("workers"))
  {
    fs::create_directories(this->Folder);
    for (const char* name : { "knotwork-read-vtk", "knotwork-read-cad" })
    {
      const fs::path program = this->Folder / name;
      std::ofstream(program) << "#!/bin/sh\n" << commands << "\n";
      fs::permissions(program, fs::perms::owner_all);
    }
    setenv("KNOTWORK_WORKERS", this->Folder.c_str(), 1);
  }
  ~OtherWorkers()
  {
    unsetenv("KNOTWORK_WORKERS");
    fs::remove_all(this->Folder);
  }
  OtherWorkers(const OtherWorkers&) = delete;
  OtherWorkers& operator=(const OtherWorkers&) = delete;

private:
  fs::path Folder;
};
}

TEST(ReaderProcess, GridsComeBackBitForBit)
{
  for (const ModelCase& model : AllModelCases())
  {
    SCOPED_TRACE(model);
    const vtkSmartPointer<vtkUnstructuredGrid> grid = Encode(RandomModel(model));
    const std::string file = OutputFile("grid.vtu");
    WriteXML(grid, file);
    const auto read = ReadVTKFile(file);
    ASSERT_TRUE(read) << read.Status.Message();
    EXPECT_EQ(TextOf(read.Value), TextOf(grid));
  }
}

TEST(ReaderProcess, PolydataComesBackWithAllItsArrays)
{
  vtkNew<vtkPolyData> data;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->InsertNextPoint(1.0 / 3.0, -0.0, 5e-324);
  points->InsertNextPoint(1e300, 2.0, 3.0);
  data->SetPoints(points);
  vtkNew<vtkCellArray> lines;
  const vtkIdType ends[] = { 1, 0 };
  lines->InsertNextCell(2, ends);
  data->SetLines(lines);
  vtkNew<vtkDoubleArray> values;
  values->SetName("Größe");
  values->InsertNextValue(std::numeric_limits<double>::quiet_NaN());
  values->InsertNextValue(std::numeric_limits<double>::infinity());
  data->GetPointData()->SetScalars(values);
  vtkNew<vtkStringArray> names;
  names->SetName("Names");
  names->InsertNextValue("<&>\"'");
  names->InsertNextValue("");
  data->GetFieldData()->AddArray(names);
  const std::string file = OutputFile("lines.vtp");
  WriteXML(data, file);
  const auto read = ReadVTKFile(file);
  ASSERT_TRUE(read) << read.Status.Message();
  EXPECT_EQ(TextOf(read.Value), TextOf(data));
  EXPECT_STREQ(
    vtkPolyData::SafeDownCast(read.Value)->GetPointData()->GetScalars()->GetName(), "Größe");

  vtkNew<vtkPointCloudReader> cloud; // goes the same way
  cloud->SetFileName(file.c_str());
  cloud->Update();
  EXPECT_EQ(TextOf(cloud->GetOutputDataObject(0)), TextOf(data));
}

TEST(ReaderProcess, CollectionsComeBackWithTheirHoles)
{
  const vtkSmartPointer<vtkUnstructuredGrid> grid = Encode(RandomModel({}));
  vtkNew<vtkPartitionedDataSetCollection> data;
  data->SetNumberOfPartitionedDataSets(3);
  data->SetPartition(0, 0, grid);
  data->SetPartition(2, 0, grid);
  data->SetPartition(2, 1, grid);
  const std::string file = OutputFile("collection.vtpc");
  vtkNew<vtkXMLPartitionedDataSetCollectionWriter> writer;
  writer->SetInputDataObject(data);
  writer->SetFileName(file.c_str());
  ASSERT_EQ(writer->Write(), 1);
  const auto read = ReadVTKFile(file);
  ASSERT_TRUE(read) << read.Status.Message();
  auto* found = vtkPartitionedDataSetCollection::SafeDownCast(read.Value);
  ASSERT_NE(found, nullptr);
  ASSERT_EQ(found->GetNumberOfPartitionedDataSets(), 3U);
  EXPECT_EQ(found->GetNumberOfPartitions(0), 1U);
  EXPECT_EQ(found->GetNumberOfPartitions(1), 0U);
  ASSERT_EQ(found->GetNumberOfPartitions(2), 2U);
  EXPECT_EQ(TextOf(found->GetPartition(0, 0)), TextOf(grid));
  EXPECT_EQ(TextOf(found->GetPartition(2, 1)), TextOf(grid));
}

// The reader itself in this process is the oracle.
TEST(ReaderProcess, FacesAreThoseOfTheReader)
{
  TrimmedModel sheet = SheetWithHoles(4, 0.2, 2, 16);
  sheet.Faces[0].Name = "Blech & \"Loch\"";
  sheet.Faces[0].HasColor = true;
  sheet.Faces[0].Color = { 1.0, 0.4, 0.0 };
  ShapeParams torus;
  torus.Kind = ShapeKind::TorusSurface;
  for (const TrimmedModel& model : { sheet, NaturalFaces(torus) })
  {
    for (const char* ending : { "faces.step", "faces.igs" })
    {
      SCOPED_TRACE(ending);
      const std::string file = OutputFile(ending);
      ASSERT_TRUE(WriteCAD(model, file));
      vtkNew<vtkCADReader> apart;
      vtkNew<vtkCADReader> here;
      here->SeparateProcessOff();
      for (vtkCADReader* reader : { apart.Get(), here.Get() })
      {
        reader->SetUnit(vtkCADReader::Metre);
        reader->SetTolerance(1e-7);
        reader->SetFileName(file.c_str());
        reader->Update();
      }
      for (int port = 0; port < 3; ++port)
      {
        EXPECT_EQ(
          TextOf(apart->GetOutputDataObject(port)), TextOf(here->GetOutputDataObject(port)));
      }
    }
  }
}

TEST(ReaderProcess, AnyEndOfItIsOneError)
{
  const struct
  {
    const char* Commands;
    ErrorCode Code;
    const char* Words;
  } cases[] = {
    { "kill -SEGV $$", ErrorCode::InvalidFormat, "its reader crashed" },
    { "kill -ABRT $$", ErrorCode::InvalidFormat, "its reader crashed" },
    { "exit 0", ErrorCode::InvalidFormat, "its reader crashed" },
    { "exit 3", ErrorCode::TooLarge, "asked for more than 1024 MB" },
    { "kill -XCPU $$", ErrorCode::InvalidFormat, "did not end within 20 s" },
    { "echo neither lengths nor bytes >&3", ErrorCode::InvalidFormat, "its reader crashed" },
    { "printf '\\001\\0\\0\\0\\0\\0\\0\\0001\\377' >&3", ErrorCode::InvalidFormat,
      "its reader crashed" },
    // parts are a length of eight bytes and so many bytes; eight of 0xff end them
    { "printf '\\001\\0\\0\\0\\0\\0\\0\\0009\\003\\0\\0\\0\\0\\0\\0\\000abc' >&3\n"
      "printf '\\377\\377\\377\\377\\377\\377\\377\\377' >&3",
      static_cast<ErrorCode>(9), "abc" },
    // no error, and a grid that is none
    { "printf '\\001\\0\\0\\0\\0\\0\\0\\0000\\0\\0\\0\\0\\0\\0\\0\\0' >&3\n"
      "printf '\\001\\0\\0\\0\\0\\0\\0\\0004\\001\\0\\0\\0\\0\\0\\0\\000x' >&3\n"
      "printf '\\377\\377\\377\\377\\377\\377\\377\\377' >&3",
      ErrorCode::InvalidFormat, "cannot be handed over" },
  };
  const std::string file = OutputFile("any.vtu");
  std::ofstream(file) << "anything";
  for (const auto& c : cases)
  {
    SCOPED_TRACE(c.Commands);
    const OtherWorkers workers(c.Commands);
    const auto data = ReadVTKFile(file);
    EXPECT_EQ(data.Status.Code, c.Code) << data.Status.Message();
    EXPECT_NE(data.Status.Detail.find(c.Words), std::string::npos) << data.Status.Detail;
    EXPECT_EQ(ReadCADInProcess(file).Status.Code, c.Code);
  }
}

TEST(ReaderProcess, WithoutItsProgramNothingIsRead)
{
  setenv("KNOTWORK_WORKERS", KNOTWORK_OUTPUT_DIR "/no_such_folder", 1);
  const auto data = ReadVTKFile(OutputFile("any.vtu"));
  unsetenv("KNOTWORK_WORKERS");
  EXPECT_EQ(data.Status.Code, ErrorCode::LibraryError);
  EXPECT_NE(data.Status.Detail.find("knotwork-read-vtk is missing"), std::string::npos);
}

TEST(ReaderProcess, HostileFilesAreRefused)
{
  const std::string folder = KNOTWORK_DATA_DIR "/Hostile/";
  for (const char* name : { "negative_index.vtpc", "huge_index.vtpc", "offset_is_no_count.vtu",
         "huge_compression_header.vtp", "huge_field.vtk" })
  {
    const auto data = ReadVTKFile(folder + name);
    EXPECT_FALSE(data) << name;
    EXPECT_NE(data.Status.Detail.find(name), std::string::npos) << data.Status.Detail;
  }
  vtkNew<MessageRecorder> messages;
  vtkNew<vtkCADReader> reader; // OpenCASCADE crashes
  messages->Watch(reader);
  const std::string file = folder + "crashes_opencascade.iges";
  reader->SetFileName(file.c_str());
  reader->Update();
  ASSERT_FALSE(messages->Errors.empty());
  EXPECT_NE(messages->Errors[0].find("its reader crashed"), std::string::npos)
    << messages->Errors[0];
}
