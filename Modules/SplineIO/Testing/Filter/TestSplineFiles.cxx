// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include "OutputFile.h"
#include "RandomModels.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/LRRefinement.h>
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SplineIO/GoToolsG2.h>
#include <knotwork/SplineIO/vtkPointCloudWriter.h>

#include "vtkDataArray.h"
#include "vtkDummyCommunicator.h"
#include "vtkDummyController.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkXMLUnstructuredGridReader.h"
#include "vtkXMLUnstructuredGridWriter.h"
#include <knotwork/SplineGrid/vtkSplineRefine.h>
#include <knotwork/SplineIO/vtkCADWriter.h>
#include <knotwork/SplineIO/vtkGismoXMLReader.h>
#include <knotwork/SplineIO/vtkGismoXMLWriter.h>
#include <knotwork/SplineIO/vtkGoToolsG2Reader.h>
#include <knotwork/SplineIO/vtkGoToolsG2Writer.h>
#include <knotwork/SplineIO/vtkPointCloudReader.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

using namespace knotwork;
namespace fs = std::filesystem;

namespace
{
std::string DataFile(const std::string& name)
{
  return KNOTWORK_DATA_DIR "/SplineIO/" + name;
}

std::string TextOf(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  return { std::istreambuf_iterator<char>(stream), {} };
}

void WriteText(const std::string& file, const std::string& text)
{
  std::ofstream(file, std::ios::binary) << text;
}

template <typename Writer>
void WriteGrid(vtkDataObject* grid, const std::string& file)
{
  vtkNew<Writer> writer;
  vtkNew<MessageRecorder> messages;
  messages->Watch(writer);
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(grid);
  EXPECT_EQ(writer->Write(), 1);
  EXPECT_TRUE(messages->Errors.empty()) << messages->Errors.front();
}

template <typename Reader>
vtkSmartPointer<vtkUnstructuredGrid> ReadGrid(const std::string& file)
{
  vtkNew<Reader> reader;
  vtkNew<MessageRecorder> messages;
  messages->Watch(reader);
  reader->SetFileName(file.c_str());
  EXPECT_EQ(reader->CanReadFile(file.c_str()), 1);
  reader->Update();
  EXPECT_TRUE(messages->Errors.empty()) << messages->Errors.front();
  return vtkUnstructuredGrid::SafeDownCast(reader->GetOutputDataObject(0));
}

template <typename Reader>
void ExpectRefused(const std::string& file, ErrorCode code, const std::string& word)
{
  SCOPED_TRACE(file);
  vtkNew<Reader> reader;
  vtkNew<MessageRecorder> messages;
  messages->Watch(reader);
  reader->SetFileName(file.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), vtkErrorCode::UserError + static_cast<unsigned long>(code));
  ASSERT_FALSE(messages->Errors.empty());
  EXPECT_NE(messages->Errors[0].find(word), std::string::npos) << messages->Errors[0];
  EXPECT_EQ(
    vtkUnstructuredGrid::SafeDownCast(reader->GetOutputDataObject(0))->GetNumberOfCells(), 0);
}

/// Between the values of a patch and those of a tensor-product one, at random parameters.
double LargestDifference(const SplinePatch& patch, const SplinePatch& tensor)
{
  std::mt19937 random(3);
  return std::visit(
    [&](const auto& spline)
    {
      using Map = std::decay_t<decltype(spline)>;
      const auto& other = std::get<Map>(tensor.Geometry);
      EXPECT_EQ(other.Space->Kind, SpaceKind::Tensor);
      const auto domain = spline.Space->Domain();
      PointMatrix at(200, static_cast<Eigen::Index>(domain.Lower.size()));
      for (Eigen::Index i = 0; i < at.rows(); ++i)
      {
        for (Eigen::Index d = 0; d < at.cols(); ++d)
        {
          const auto k = static_cast<std::size_t>(d);
          at(i, d) =
            std::uniform_real_distribution<double>(domain.Lower[k], domain.Upper[k])(random);
        }
      }
      EvaluationBatch expected;
      EvaluationBatch found;
      EXPECT_TRUE(EvaluateParameters(MakeBezierForm(spline), at, {}, expected));
      EXPECT_TRUE(EvaluateParameters(MakeBezierForm(other), at, {}, found));
      return (expected.Values - found.Values).cwiseAbs().maxCoeff();
    },
    patch.Geometry);
}

class SplineFiles : public ::testing::TestWithParam<ModelCase>
{
};
}

TEST_P(SplineFiles, GridsComeBackFromGismoXml_PropertyOracle)
{
  SplineModel model = RandomModel(GetParam());
  const std::string file = OutputFile(NameOf({ GetParam(), 0 }) + ".xml");
  const auto grid = Encode(model);
  WriteGrid<vtkGismoXMLWriter>(grid, file);
  const SplineModel again = Decode(ReadGrid<vtkGismoXMLReader>(file));
  for (SplinePatch& patch : model.Patches)
  {
    patch.Fields.clear(); // which the format does not have
  }
  EXPECT_TRUE(Identical(model, again));
}

TEST_P(SplineFiles, GridsComeBackFromG2_PropertyOracle)
{
  SplineModel model = RandomModel(GetParam());
  const std::string file = OutputFile(NameOf({ GetParam(), 0 }) + ".g2");
  WriteGrid<vtkGoToolsG2Writer>(Encode(model), file);
  const SplineModel again = Decode(ReadGrid<vtkGoToolsG2Reader>(file));
  if (GetParam().Kind != SpaceKind::Tensor) // which the format does not have: the same map
  {
    ASSERT_EQ(again.Patches.size(), model.Patches.size());
    for (std::size_t i = 0; i < model.Patches.size(); ++i)
    {
      EXPECT_LE(LargestDifference(model.Patches[i], again.Patches[i]), 1e-11); // values about 1
    }
    return;
  }
  for (std::size_t i = 0; i < model.Patches.size(); ++i)
  {
    model.Patches[i].Fields.clear();
    model.Patches[i].Id = static_cast<int>(i); // the format has no ids
  }
  EXPECT_TRUE(Identical(model, again));
}

INSTANTIATE_TEST_SUITE_P(All, SplineFiles, ::testing::ValuesIn(AllModelCases()), NameOf);

TEST(SplineFile, HandWrittenXml_GoldenOracle)
{
  const auto grid = ReadGrid<vtkGismoXMLReader>(DataFile("by_hand.xml"));
  const SplineModel model = Decode(grid);
  ASSERT_EQ(model.Patches.size(), 4u);
  EXPECT_EQ(ControlPoints(PatchOf(model, 7)).row(1), Eigen::RowVector3d(2, 0, 0)); // z is 0
  EXPECT_EQ(Weights(PatchOf(model, 0))[2], 2.0);
  EXPECT_EQ(KindOf(PatchOf(model, 9)), SpaceKind::Hierarchical);
  vtkDataArray* interfaces = grid->GetFieldData()->GetArray("KnotworkInterfaces");
  vtkDataArray* boundary = grid->GetFieldData()->GetArray("KnotworkBoundary");
  ASSERT_TRUE(interfaces && boundary);
  ASSERT_EQ(interfaces->GetNumberOfTuples(), 1);
  const double expected[] = { 4, 1, 7, 0, 0, 0 };
  for (int c = 0; c < 6; ++c)
  {
    EXPECT_EQ(interfaces->GetComponent(0, c), expected[c]) << c;
  }
  EXPECT_EQ(boundary->GetNumberOfTuples(), 6);
}

namespace
{
std::string XmlOf(vtkDataObject* grid)
{
  const std::string file = OutputFile("topology.xml");
  WriteGrid<vtkGismoXMLWriter>(grid, file);
  std::string text = TextOf(file);
  fs::remove(file);
  return text;
}

vtkSmartPointer<vtkUnstructuredGrid> StoredGrid(const std::string& name)
{
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(DataFile(name).c_str());
  reader->Update();
  return reader->GetOutput();
}
}

TEST(SplineFile, GridsOfBothSchemaVersions_GoldenOracle)
{
  // stored by the program when it wrote version 1, and when it wrote version 2
  const std::string text = XmlOf(ReadGrid<vtkGismoXMLReader>(DataFile("turned.xml")));
  EXPECT_NE(text.find("<interfaces>\n3 2 5 3 1 0 1 0\n</interfaces>"), std::string::npos);
  EXPECT_NE(text.find("<interfaces>\n8 6 9 3 2 0 1 1 0 1\n</interfaces>"), std::string::npos);
  for (const int version : { 1, 2 })
  {
    SCOPED_TRACE("version " + std::to_string(version));
    const auto grid = StoredGrid("turned_schema_" + std::to_string(version) + ".vtu");
    EXPECT_EQ(grid->GetFieldData()->GetArray("KnotworkSchemaVersion")->GetComponent(0, 0), version);
    EXPECT_EQ(XmlOf(grid), text);
    const SplineModel model = Decode(grid);
    EXPECT_TRUE(model.Warnings.empty());
    const auto& interfaces = model.Topology.Interfaces;
    ASSERT_EQ(interfaces.size(), 2u);
    EXPECT_EQ(model.Topology.Boundary.size(), 16u);
    // the stated sides are those that are found
    const std::vector<PatchInterface> squares =
      FindInterfaces<2>({ std::get<Spline<2>>(model.Patches[0].Geometry),
        std::get<Spline<2>>(model.Patches[1].Geometry) });
    const std::vector<PatchInterface> cubes =
      FindInterfaces<3>({ std::get<Spline<3>>(model.Patches[2].Geometry),
        std::get<Spline<3>>(model.Patches[3].Geometry) });
    ASSERT_EQ(squares.size(), 1u);
    ASSERT_EQ(cubes.size(), 1u);
    for (const std::size_t i : { 0, 1 })
    {
      const PatchInterface& found = i == 0 ? squares.front() : cubes.front();
      const int first = i == 0 ? 0 : 2;
      EXPECT_EQ(interfaces[i].Sides[0], (PatchSide{ first, found.Sides[0].Side }));
      EXPECT_EQ(interfaces[i].Sides[1], (PatchSide{ first + 1, found.Sides[1].Side }));
      EXPECT_EQ(interfaces[i].Orientation, found.Orientation);
    }
  }
}

TEST(SplineFile, WhatIsStatedOfSidesTravels_ExactOracle)
{
  const auto grid = ReadGrid<vtkGismoXMLReader>(DataFile("turned.xml"));
  const std::string text = XmlOf(grid);
  const auto topology = [](const std::string& xml) { return xml.substr(xml.find("<MultiPatch")); };
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  refine->Update();
  EXPECT_EQ(topology(XmlOf(refine->GetOutputDataObject(0))), topology(text));
  // in part, and in a collection
  SplineModel model = Decode(grid);
  PatchInterface& first = model.Topology.Interfaces[0];
  first.Partial = true;
  first.Parts = { ParametricBox<2>{ { 0.25, 0.0 }, { 0.5, 0.0 } },
    ParametricBox<2>{ { 0.5, 0.0 }, { 0.75, 0.0 } } };
  vtkNew<vtkUnstructuredGrid> partial;
  ASSERT_TRUE(EncodeSplineGrid(model, partial));
  SplineModel again = Decode(Collect({ partial, grid }));
  ASSERT_EQ(again.Topology.Interfaces.size(), 4u);
  const PatchInterface& back = again.Topology.Interfaces[0];
  EXPECT_TRUE(back.Partial);
  for (std::size_t i = 0; i < 2; ++i)
  {
    EXPECT_EQ(back.Parts[i].Lower, first.Parts[i].Lower);
    EXPECT_EQ(back.Parts[i].Upper, first.Parts[i].Upper);
  }
  EXPECT_EQ(again.Topology.Interfaces[3].Sides[1], (PatchSide{ 7, 2 })); // of the second block
  // patches that are numbered anew in one grid keep theirs
  vtkNew<vtkUnstructuredGrid> all;
  ASSERT_TRUE(EncodeSplineGrid(again, all));
  again = Decode(all);
  ASSERT_EQ(again.Topology.Interfaces.size(), 4u);
  EXPECT_EQ(again.Topology.Interfaces[3].Sides[1], (PatchSide{ 7, 2 }));
}

TEST(SplineFile, RowsAboutWhatIsNotThereAreLeftOut_PropertyOracle)
{
  const auto damaged = [](int row, int column, double value)
  {
    const auto grid = ReadGrid<vtkGismoXMLReader>(DataFile("turned.xml"));
    grid->GetFieldData()->GetArray("KnotworkInterfaces")->SetComponent(row, column, value);
    return Decode(grid);
  };
  const int columns[] = { 0, 1, 2, 3, 4, 5 };
  const double values[] = { 77, 4, 8, -1, 2,
    1 }; // another dimension in the third, no parts in the last
  for (const int c : columns)
  {
    const SplineModel model = damaged(0, c, values[c]);
    EXPECT_EQ(model.Topology.Interfaces.size(), 1u) << c;
    ASSERT_EQ(model.Warnings.size(), 1u) << c;
    EXPECT_EQ(model.Warnings[0].substr(0, 13), "1 interfaces ") << c;
  }
  SplineModel model = Decode(ReadGrid<vtkGismoXMLReader>(DataFile("turned.xml")));
  model.Topology.Boundary.push_back({ 4, 0 });
  vtkNew<vtkUnstructuredGrid> grid;
  EXPECT_EQ(EncodeSplineGrid(model, grid).Code, ErrorCode::InvalidTopology);
}

TEST(SplineFile, TopologyComesBack_PropertyOracle)
{
  const std::string first = OutputFile("first.xml");
  const std::string second = OutputFile("second.xml");
  WriteGrid<vtkGismoXMLWriter>(ReadGrid<vtkGismoXMLReader>(DataFile("by_hand.xml")), first);
  WriteGrid<vtkGismoXMLWriter>(ReadGrid<vtkGismoXMLReader>(first), second);
  EXPECT_EQ(TextOf(first), TextOf(second));
  EXPECT_NE(TextOf(first).find("<interfaces>\n4 2 7 1 0 1 1 1\n</interfaces>"), std::string::npos);
}

TEST(SplineFile, HeightsOfLocallyRefinedFunctionsAreGraphs_ExactOracle)
{
  // local lines, so that the parameters' coefficients are not the means of local knots
  const auto tensor = MakeTensorSpace<2>(
    { KnotVector::Uniform(3, 6, 0.0, 3.0), KnotVector::Uniform(2, 5, -1.0, 1.0) })
                        .Value;
  const auto space = InsertSegments(tensor,
    { { 0, 1.25, -0.6, 0.6 }, { 1, 0.1, 0.5, 2.5 }, { 0, 1.375, -0.6, 0.6 },
      { 1, -0.1, 0.5, 2.5 } },
    0);
  ASSERT_TRUE(space) << space.Status.Message();
  std::vector<AnySpline> written;
  Spline<2> heights{ space.Value, PointMatrix::Random(space.Value->NumFunctions, 1), {} };
  written.emplace_back(heights);
  const auto text = WriteG2(written);
  ASSERT_TRUE(text) << text.Status.Message();
  const std::string file = OutputFile("heights.g2");
  WriteText(file, text.Value);
  const SplineModel model = Decode(ReadGrid<vtkGoToolsG2Reader>(file));
  ASSERT_EQ(model.Patches.size(), 1u);
  const auto& graph = std::get<Spline<2>>(model.Patches[0].Geometry);
  PointMatrix parameters = PointMatrix::Random(200, 2);
  parameters.col(0) = 1.5 * (parameters.col(0).array() + 1.0).matrix();
  EvaluationBatch points, values;
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(graph), parameters, {}, points));
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(heights), parameters, {}, values));
  // a few roundings of numbers up to 3
  EXPECT_LE((points.Values.leftCols(2) - parameters).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LE((points.Values.col(2) - values.Values.col(0)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(SplineFile, Coordinates_ExactOracle)
{
  const auto square = ShapeGrid(vtkSplineSource::SQUARE);
  const auto cube = ShapeGrid(vtkSplineSource::CUBE);
  const std::string file = OutputFile("coordinates.xml");
  const auto written = [&](vtkUnstructuredGrid* grid, int coordinates)
  {
    vtkNew<vtkGismoXMLWriter> writer;
    vtkNew<MessageRecorder> messages;
    messages->Watch(writer);
    writer->SetFileName(file.c_str());
    writer->SetCoordinates(coordinates);
    writer->SetInputDataObject(grid);
    writer->Write();
    const std::string text = TextOf(file);
    fs::remove(file);
    const std::size_t at = text.find("geoDim=\"");
    return at == std::string::npos ? '-' : text[at + 8];
  };
  EXPECT_EQ(written(square, 0), '2');
  EXPECT_EQ(written(square, 3), '3');
  EXPECT_EQ(written(square, 1), '-'); // y is not 0
  EXPECT_EQ(written(cube, 0), '3');
  EXPECT_EQ(written(cube, 2), '-');
}

TEST(SplineFile, CollectionsAreWritten_CrossOracle)
{
  const auto collection =
    Collect({ ShapeGrid(vtkSplineSource::SQUARE), ShapeGrid(vtkSplineSource::ANNULUS_SECTOR) });
  const std::string file = OutputFile("collection.xml");
  WriteGrid<vtkGismoXMLWriter>(collection, file);
  EXPECT_EQ(Decode(ReadGrid<vtkGismoXMLReader>(file)).Patches.size(), 2u);
}

TEST(SplineFile, BadFilesAreErrors_ExactOracle)
{
  ExpectRefused<vtkGismoXMLReader>(OutputFile("missing.xml"), ErrorCode::FileError, "missing.xml");
  ExpectRefused<vtkGismoXMLReader>(KNOTWORK_OUTPUT_DIR, ErrorCode::FileError, "cannot be read");
  ExpectRefused<vtkGismoXMLReader>("", ErrorCode::EmptyInput, "no file name");
  const std::string xml = TextOf(DataFile("by_hand.xml"));
  WriteText(OutputFile("truncated.xml"), xml.substr(0, xml.size() / 2));
  ExpectRefused<vtkGismoXMLReader>(
    OutputFile("truncated.xml"), ErrorCode::InvalidFormat, "truncated.xml");
  const std::string g2 = TextOf(DataFile("by_hand.g2"));
  WriteText(OutputFile("truncated.g2"), g2.substr(0, g2.size() / 3));
  ExpectRefused<vtkGoToolsG2Reader>(
    OutputFile("truncated.g2"), ErrorCode::InvalidFormat, "truncated.g2");
  WriteText(OutputFile("four.g2"), "100 1 0 0\n4 0\n2 2\n0 0 1 1\n1 2 3 4\n5 6 7 8\n");
  ExpectRefused<vtkGoToolsG2Reader>(
    OutputFile("four.g2"), ErrorCode::DimensionMismatch, "4 coordinates");
}

TEST(SplineFile, FormatsAreKnownByContent_ExactOracle)
{
  vtkNew<vtkGismoXMLReader> xml;
  vtkNew<vtkGoToolsG2Reader> g2;
  EXPECT_EQ(xml->CanReadFile(DataFile("by_hand.xml").c_str()), 1);
  EXPECT_EQ(g2->CanReadFile(DataFile("by_hand.xml").c_str()), 0);
  EXPECT_EQ(xml->CanReadFile(DataFile("by_hand.g2").c_str()), 0);
  EXPECT_EQ(g2->CanReadFile(DataFile("by_hand.g2").c_str()), 1);
  EXPECT_EQ(xml->CanReadFile(OutputFile("nothing").c_str()), 0);
  EXPECT_EQ(g2->CanReadFile(nullptr), 0);
  const std::string grid = OutputFile("grid.xml"); // VTK's own XML under this ending
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetFileName(grid.c_str());
  writer->SetInputDataObject(ShapeGrid(vtkSplineSource::SQUARE));
  writer->Write();
  EXPECT_EQ(xml->CanReadFile(grid.c_str()), 0);
  ExpectRefused<vtkGismoXMLReader>(grid, ErrorCode::InvalidFormat, "<VTKFile>");
}

TEST(SplineFile, EveryClassOfG2IsKnownByItsHeader_ExactOracle)
{
  vtkNew<vtkGoToolsG2Reader> splines;
  vtkNew<vtkPointCloudReader> points;
  const std::string file = OutputFile("class.g2");
  for (int id : { 100, 200, 210, 293, 400, 700 })
  {
    SCOPED_TRACE(id);
    WriteText(file, std::to_string(id) + " 1 0 0\n200\n3 0\n");
    EXPECT_EQ(splines->CanReadFile(file.c_str()), id == 400 ? 0 : 1);
    EXPECT_EQ(points->CanReadFile(file.c_str()), id == 400 ? 1 : 0);
  }
  for (const char* other : { "101 1 0 0\n", "0 1 0 0\n", "210 1.5 0 0\n", "210 1 0\n" })
  {
    WriteText(file, other);
    EXPECT_EQ(splines->CanReadFile(file.c_str()), 0) << other;
  }
}

TEST(SplineFile, WriterErrorsKeepWhatWasThere_ExactOracle)
{
  auto grid = ShapeGrid(vtkSplineSource::SQUARE);
  grid->GetFieldData()->Initialize(); // kind Bezier now: no knots
  const std::string file = OutputFile("kept.xml");
  WriteText(file, "kept as it is");
  vtkNew<vtkGismoXMLWriter> writer;
  vtkNew<MessageRecorder> messages;
  messages->Watch(writer);
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(grid);
  EXPECT_EQ(writer->Write(), 0);
  ASSERT_EQ(messages->Errors.size(), 1u);
  EXPECT_NE(messages->Errors[0].find("without knots"), std::string::npos) << messages->Errors[0];
  EXPECT_EQ(TextOf(file), "kept as it is");
  writer->SetFileName((KNOTWORK_OUTPUT_DIR "/no/such/folder/a.xml"));
  writer->SetInputDataObject(ShapeGrid(vtkSplineSource::SQUARE));
  EXPECT_EQ(writer->Write(), 0);
  EXPECT_EQ(messages->Errors.size(), 2u);
}

namespace
{
/// This process is one of two.
class TwoProcesses : public vtkDummyCommunicator
{
public:
  static TwoProcesses* New();
  vtkTypeMacro(TwoProcesses, vtkDummyCommunicator);
  void BecomeProcess(int number) { this->LocalProcessId = number; }
  int AllGatherVoidArray(const void*, void*, vtkIdType, int) override
  {
    ADD_FAILURE() << "writers wait for each other";
    return 0;
  }

protected:
  TwoProcesses() { this->MaximumNumberOfProcesses = this->NumberOfProcesses = 2; }
};
vtkStandardNewMacro(TwoProcesses);

template <typename Writer>
void ExpectNoFileOfTwoProcesses(vtkDataObject* data, vtkDataObject* none, const std::string& name)
{
  const std::string file = OutputFile(name);
  fs::remove(file);
  vtkMultiProcessController* before = vtkMultiProcessController::GetGlobalController();
  vtkNew<TwoProcesses> communicator;
  vtkNew<vtkDummyController> controller;
  controller->SetCommunicator(communicator);
  for (const int process : { 0, 1 })
  {
    for (vtkDataObject* input : { data, none })
    {
      communicator->BecomeProcess(process);
      vtkMultiProcessController::SetGlobalController(controller);
      vtkNew<Writer> writer;
      vtkNew<MessageRecorder> messages;
      messages->Watch(writer);
      writer->SetInputDataObject(input);
      writer->SetFileName(file.c_str());
      writer->Write();
      vtkMultiProcessController::SetGlobalController(before);
      EXPECT_FALSE(fs::exists(file)) << name;
      EXPECT_EQ(writer->GetErrorCode(),
        input == none
          ? static_cast<unsigned long>(vtkErrorCode::NoError)
          : vtkErrorCode::UserError + static_cast<unsigned long>(ErrorCode::InvalidTopology));
      ASSERT_EQ(messages->Errors.size(), input == none ? 0U : 1U) << name;
      if (input != none)
      {
        EXPECT_NE(messages->Errors[0].find("one of 2 processes"), std::string::npos);
        EXPECT_NE(messages->Errors[0].find("without mpirun"), std::string::npos);
      }
    }
  }
}
}

TEST(SplineFiles, OneOfSeveralProcessesWritesNothing_ExactOracle)
{
  const auto grid = Encode(RandomModel({ 2, SpaceKind::Tensor, false, 1, 1 }));
  const vtkNew<vtkUnstructuredGrid> none;
  ExpectNoFileOfTwoProcesses<vtkGismoXMLWriter>(grid, none, "two_processes.xml");
  ExpectNoFileOfTwoProcesses<vtkGoToolsG2Writer>(grid, none, "two_processes.g2");
  ExpectNoFileOfTwoProcesses<vtkCADWriter>(grid, none, "two_processes.step");
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0.0, 0.0, 0.0);
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  const vtkNew<vtkPolyData> empty;
  ExpectNoFileOfTwoProcesses<vtkPointCloudWriter>(cloud, empty, "two_processes.txt");
}
