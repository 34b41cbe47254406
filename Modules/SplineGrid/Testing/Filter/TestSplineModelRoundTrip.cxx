// SPDX-License-Identifier: BSD-3-Clause
// What is written is read back bit for bit: in memory, through files, renumbered, in blocks.
#include "RandomModels.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataAssembly.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSphereSource.h"
#include "vtkThreshold.h"
#include "vtkXMLPartitionedDataSetCollectionReader.h"
#include "vtkXMLPartitionedDataSetCollectionWriter.h"
#include "vtkXMLUnstructuredGridReader.h"
#include "vtkXMLUnstructuredGridWriter.h"

#include <random>

using namespace knotwork;

namespace
{
class SplineModelRoundTrip : public ::testing::TestWithParam<ModelCase>
{
protected:
  SplineModel Model = RandomModel(GetParam());
  std::string File(const std::string& ending) const
  {
    std::ostringstream text;
    text << KNOTWORK_OUTPUT_DIR << "/SplineModel" << GetParam() << ending;
    return text.str();
  }
};

void CheckClean(const SplineModel& model)
{
  for (const SplinePatch& patch : model.Patches)
  {
    EXPECT_FALSE(patch.Recovered) << "patch " << patch.Id;
  }
  EXPECT_EQ(model.Warnings, std::vector<std::string>());
}

TEST_P(SplineModelRoundTrip, InMemory_ExactOracle)
{
  const auto grid = Encode(this->Model);
  const SplineModel back = Decode(grid);
  EXPECT_TRUE(Identical(this->Model, back));
  CheckClean(back);
  // and the same grid again
  const auto again = Encode(back);
  EXPECT_EQ(again->GetNumberOfPoints(), grid->GetNumberOfPoints());
  EXPECT_TRUE(Identical(this->Model, Decode(again)));
}

TEST_P(SplineModelRoundTrip, CellsLeadBackToElements_ExactOracle)
{
  const auto grid = Encode(this->Model);
  const SplineModel back = Decode(grid);
  std::vector<int> seen(static_cast<std::size_t>(grid->GetNumberOfCells()), 0);
  for (const SplinePatch& patch : back.Patches)
  {
    ASSERT_EQ(static_cast<int>(patch.Cells.size()), NumElements(patch));
    for (std::size_t e = 0; e < patch.Cells.size(); ++e)
    {
      ++seen[static_cast<std::size_t>(patch.Cells[e])];
      EXPECT_EQ(grid->GetCellData()->GetArray("ElementId")->GetComponent(patch.Cells[e], 0),
        static_cast<double>(e));
      EXPECT_EQ(
        grid->GetCellData()->GetArray("PatchId")->GetComponent(patch.Cells[e], 0), patch.Id);
    }
  }
  EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
}

TEST_P(SplineModelRoundTrip, VtuFiles_ExactOracle)
{
  const auto grid = Encode(this->Model);
  for (int mode : { vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended })
  {
    SCOPED_TRACE("data mode " + std::to_string(mode));
    const std::string file = this->File("Mode" + std::to_string(mode) + ".vtu");
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetFileName(file.c_str());
    writer->SetDataMode(mode);
    writer->SetInputData(grid);
    ASSERT_EQ(writer->Write(), 1);
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    const SplineModel back = Decode(reader->GetOutput());
    EXPECT_TRUE(Identical(this->Model, back));
    CheckClean(back);
  }
}

TEST_P(SplineModelRoundTrip, VtpcFiles_ExactOracle)
{
  for (std::size_t i = 0; i < this->Model.Patches.size(); ++i)
  {
    this->Model.Patches[i].Block = static_cast<int>(i);
    this->Model.Patches[i].Id = 4; // numbers count within a block
  }
  vtkNew<vtkPartitionedDataSetCollection> collection;
  const Status status = EncodeSplineModel(this->Model, nullptr, collection);
  ASSERT_TRUE(status) << status.Message();
  EXPECT_TRUE(Identical(this->Model, Decode(collection)));
  for (int mode : { vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended })
  {
    SCOPED_TRACE("data mode " + std::to_string(mode));
    const std::string file = this->File("Mode" + std::to_string(mode) + ".vtpc");
    vtkNew<vtkXMLPartitionedDataSetCollectionWriter> writer;
    writer->SetFileName(file.c_str());
    writer->SetDataMode(mode);
    writer->SetInputData(collection);
    ASSERT_EQ(writer->Write(), 1);
    vtkNew<vtkXMLPartitionedDataSetCollectionReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    const SplineModel back = Decode(reader->GetOutputDataObject(0));
    EXPECT_TRUE(Identical(this->Model, back));
    CheckClean(back);
  }
}

// The same grid with its points and cells in random order.
vtkSmartPointer<vtkUnstructuredGrid> Shuffled(vtkUnstructuredGrid* grid, unsigned seed)
{
  std::mt19937 random(seed);
  const auto permutation = [&](vtkIdType n)
  {
    std::vector<vtkIdType> order(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      order[i] = static_cast<vtkIdType>(i);
      std::swap(order[i], order[random() % (i + 1)]);
    }
    return order;
  };
  const std::vector<vtkIdType> oldPoint = permutation(grid->GetNumberOfPoints());
  const std::vector<vtkIdType> oldCell = permutation(grid->GetNumberOfCells());
  std::vector<vtkIdType> newPoint(oldPoint.size());
  auto made = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  made->GetPointData()->CopyAllOn();
  made->GetPointData()->CopyAllocate(grid->GetPointData());
  for (std::size_t i = 0; i < oldPoint.size(); ++i)
  {
    newPoint[static_cast<std::size_t>(oldPoint[i])] = static_cast<vtkIdType>(i);
    points->InsertNextPoint(grid->GetPoint(oldPoint[i]));
    made->GetPointData()->CopyData(grid->GetPointData(), oldPoint[i], static_cast<vtkIdType>(i));
  }
  made->SetPoints(points);
  made->Allocate(grid->GetNumberOfCells());
  made->GetCellData()->CopyAllOn();
  made->GetCellData()->CopyAllocate(grid->GetCellData());
  for (std::size_t i = 0; i < oldCell.size(); ++i)
  {
    vtkNew<vtkIdList> ids;
    grid->GetCellPoints(oldCell[i], ids);
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
    {
      ids->SetId(k, newPoint[static_cast<std::size_t>(ids->GetId(k))]);
    }
    made->InsertNextCell(grid->GetCellType(oldCell[i]), ids);
    made->GetCellData()->CopyData(grid->GetCellData(), oldCell[i], static_cast<vtkIdType>(i));
  }
  made->GetFieldData()->PassData(grid->GetFieldData());
  return made;
}

TEST_P(SplineModelRoundTrip, RenumberedPointsAndCells_ExactOracle)
{
  const auto grid = Encode(this->Model);
  for (unsigned seed = 1; seed <= 3; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SplineModel back = Decode(Shuffled(grid, seed));
    EXPECT_TRUE(Identical(this->Model, back));
    CheckClean(back);
  }
}

TEST_P(SplineModelRoundTrip, ThresholdByPatchKeepsTheOthers_ExactOracle)
{
  for (const SplinePatch& patch : this->Model.Patches)
  {
    vtkNew<vtkThreshold> threshold;
    threshold->SetInputData(Encode(this->Model));
    threshold->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "PatchId");
    threshold->SetThresholdFunction(vtkThreshold::THRESHOLD_BETWEEN);
    threshold->SetLowerThreshold(patch.Id);
    threshold->SetUpperThreshold(patch.Id);
    threshold->Update();
    const SplineModel back = Decode(threshold->GetOutput());
    SplineModel expected;
    expected.Patches.push_back(patch);
    EXPECT_TRUE(Identical(expected, back));
    EXPECT_EQ(back.Warnings, std::vector<std::string>());
  }
}

INSTANTIATE_TEST_SUITE_P(All, SplineModelRoundTrip, ::testing::ValuesIn(AllModelCases()), NameOf);

TEST(SplineModelCollection, BlocksNamesAndOtherPiecesAreKept_ExactOracle)
{
  vtkNew<vtkPartitionedDataSetCollection> input;
  input->SetNumberOfPartitionedDataSets(4);
  SplineModel first = RandomModel({ 2, SpaceKind::Tensor, true, 3, 5 });
  SplineModel second = RandomModel({ 3, SpaceKind::Hierarchical, false, 1, 6 });
  vtkNew<vtkSphereSource> sphere;
  sphere->Update();
  input->SetPartition(0, 0, Encode(first));
  input->SetPartition(1, 0, sphere->GetOutput());
  input->SetPartition(2, 0, vtkNew<vtkUnstructuredGrid>());
  input->SetPartition(3, 0, nullptr);
  input->SetPartition(3, 1, Encode(second));
  const char* const names[] = { "tubes", "ball", "nothing", "brick" };
  for (unsigned int b = 0; b < 4; ++b)
  {
    input->GetMetaData(b)->Set(vtkCompositeDataSet::NAME(), names[b]);
  }
  vtkNew<vtkDataAssembly> assembly;
  assembly->AddDataSetIndex(assembly->AddNode("parts"), 3);
  input->SetDataAssembly(assembly);

  const SplineModel model = Decode(input);
  ASSERT_EQ(model.Patches.size(), 4U);
  ASSERT_EQ(model.Warnings.size(), 1U);
  EXPECT_NE(model.Warnings[0].find("block 1 has a vtkPolyData"), std::string::npos);
  vtkNew<vtkPartitionedDataSetCollection> output;
  const Status status = EncodeSplineModel(model, input, output);
  ASSERT_TRUE(status) << status.Message();
  ASSERT_EQ(output->GetNumberOfPartitionedDataSets(), 4U);
  for (unsigned int b = 0; b < 4; ++b)
  {
    EXPECT_STREQ(output->GetMetaData(b)->Get(vtkCompositeDataSet::NAME()), names[b]);
  }
  EXPECT_TRUE(vtkPolyData::SafeDownCast(output->GetPartition(1, 0)));
  EXPECT_TRUE(vtkUnstructuredGrid::SafeDownCast(output->GetPartition(2, 0)));
  ASSERT_TRUE(output->GetDataAssembly());
  EXPECT_EQ(output->GetDataAssembly()->GetDataSetIndices(
              output->GetDataAssembly()->FindFirstNodeWithName("parts")),
    std::vector<unsigned int>{ 3 });
  EXPECT_TRUE(Identical(model, Decode(output)));
  // As one grid, every patch keeps its geometry; numbers that occur twice are changed.
  const SplineModel merged = Decode(Encode(model));
  ASSERT_EQ(merged.Patches.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i)
  {
    EXPECT_EQ(ControlPoints(merged.Patches[i]), ControlPoints(model.Patches[i]));
  }
}

TEST(SplineModelCollection, EmptyInputsGiveEmptyModels_ExactOracle)
{
  EXPECT_TRUE(Decode(vtkNew<vtkUnstructuredGrid>()).Patches.empty());
  EXPECT_TRUE(Decode(vtkNew<vtkPartitionedDataSetCollection>()).Patches.empty());
  const auto grid = Encode({});
  EXPECT_EQ(grid->GetNumberOfCells(), 0);
  EXPECT_TRUE(Decode(grid).Patches.empty());
}
}
