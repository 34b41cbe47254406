// SPDX-License-Identifier: BSD-3-Clause
// The base class: types of outputs, errors, exceptions, abort.
#include "RandomModels.h"
#include "vtkSplineAlgorithm.h"

#include "vtkCallbackCommand.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <stdexcept>

using namespace knotwork;

namespace
{
/// Decodes and encodes; on demand it throws or asks whether to go on.
class Copy : public vtkSplineAlgorithm
{
public:
  static Copy* New();
  vtkTypeMacro(Copy, vtkSplineAlgorithm);
  bool Throws = false;

protected:
  Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override
  {
    vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
    vtkDataObject* output = vtkDataObject::GetData(outputs);
    Result<SplineModel> model = DecodeSplineModel(input, 0);
    if (!model)
    {
      return model.Status;
    }
    this->ReportWarnings(model->Warnings);
    const Status status = EncodeSplineModel(model.Value, input, output);
    if (this->Throws)
    {
      throw std::runtime_error("out of patience");
    }
    if (!this->Progress()(0.5))
    {
      return { ErrorCode::Aborted, "half way" };
    }
    return status;
  }
};
vtkStandardNewMacro(Copy);

/// Declares a grid, points as the input's and a table.
class Three : public vtkSplineAlgorithm
{
public:
  static Three* New();
  vtkTypeMacro(Three, vtkSplineAlgorithm);

protected:
  Three() { this->SetNumberOfOutputPorts(3); }
  int FillOutputPortInformation(int port, vtkInformation* info) override
  {
    constexpr const char* types[] = { "vtkUnstructuredGrid", "vtkPointSet", "vtkTable" };
    info->Set(vtkDataObject::DATA_TYPE_NAME(), types[port]);
    return 1;
  }
  int FillInputPortInformation(int, vtkInformation* info) override
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
    return 1;
  }
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override
  {
    MakeOutputLike(outputs, 1, vtkDataObject::GetData(inputs[0]));
    return this->MakeDeclaredOutputs(outputs);
  }
  Status Compute(vtkInformationVector**, vtkInformationVector*) override { return {}; }
};
vtkStandardNewMacro(Three);

struct Messages
{
  std::vector<std::string> Errors;
  explicit Messages(vtkObject* object)
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback([](vtkObject*, unsigned long, void* self, void* text)
      { static_cast<Messages*>(self)->Errors.emplace_back(static_cast<const char*>(text)); });
    object->AddObserver(vtkCommand::ErrorEvent, this->Command);
  }
  vtkNew<vtkCallbackCommand> Command;
};

TEST(SplineAlgorithm, OutputHasTheTypeOfTheInput_ExactOracle)
{
  const SplineModel model = RandomModel({ 2, SpaceKind::Tensor, true, 3, 1 });
  vtkNew<Copy> filter;
  filter->SetInputDataObject(Encode(model));
  filter->Update();
  EXPECT_TRUE(Identical(model, Decode(filter->GetOutputDataObject(0))));
  EXPECT_TRUE(vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0)));
  vtkNew<vtkPartitionedDataSetCollection> collection;
  collection->SetPartition(1, 0, Encode(model));
  filter->SetInputDataObject(collection);
  filter->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  EXPECT_EQ(output->GetNumberOfPartitionedDataSets(), 2U);
  EXPECT_TRUE(Identical(Decode(collection), Decode(output)));
  filter->SetInputDataObject(vtkNew<vtkUnstructuredGrid>());
  filter->Update();
  EXPECT_TRUE(vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0)));
}

TEST(SplineAlgorithm, OutputsAreOfTheDeclaredTypesAndStay_ExactOracle)
{
  vtkNew<Three> filter;
  filter->SetInputDataObject(vtkNew<vtkPolyData>());
  filter->Update();
  EXPECT_TRUE(vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0)));
  EXPECT_TRUE(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1)));
  vtkDataObject* table = filter->GetOutputDataObject(2);
  EXPECT_TRUE(vtkTable::SafeDownCast(table));
  filter->SetInputDataObject(vtkNew<vtkUnstructuredGrid>());
  filter->Update();
  EXPECT_TRUE(vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(1)));
  EXPECT_EQ(filter->GetOutputDataObject(2), table);
}

TEST(SplineAlgorithm, ErrorIsReportedOnceAndTheOutputIsEmpty)
{
  const auto grid = Encode(RandomModel({ 2, SpaceKind::Tensor, false, 1, 1 }));
  vtkNew<Copy> filter;
  Messages messages(filter);
  filter->SetInputDataObject(grid);
  filter->Update();
  EXPECT_GT(
    vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfCells(), 0);
  const double bad[3] = { std::nan(""), 0, 0 };
  grid->GetPoints()->SetPoint(0, bad);
  grid->Modified();
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1U);
  EXPECT_NE(messages.Errors[0].find("patch 3, cell 0"), std::string::npos) << messages.Errors[0];
  EXPECT_EQ(filter->GetErrorCode(),
    vtkErrorCode::UserError + static_cast<unsigned long>(ErrorCode::NonFiniteInput));
  EXPECT_EQ(
    vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfCells(), 0);
}

TEST(SplineAlgorithm, ExceptionsBecomeErrors)
{
  vtkNew<Copy> filter;
  Messages messages(filter);
  filter->Throws = true;
  filter->SetInputDataObject(Encode(RandomModel({ 1, SpaceKind::Tensor, false, 1, 1 })));
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1U);
  EXPECT_NE(messages.Errors[0].find("out of patience"), std::string::npos);
  EXPECT_EQ(
    vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfCells(), 0);
}

TEST(SplineAlgorithm, AbortLeavesNothingAndIsNoError)
{
  vtkNew<Copy> filter;
  Messages messages(filter);
  filter->SetInputDataObject(Encode(RandomModel({ 1, SpaceKind::Tensor, false, 1, 1 })));
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { static_cast<vtkAlgorithm*>(caller)->AbortExecuteOn(); });
  filter->AddObserver(vtkCommand::ProgressEvent, abort);
  filter->Update();
  EXPECT_TRUE(messages.Errors.empty());
  EXPECT_EQ(
    vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfCells(), 0);
}
}
