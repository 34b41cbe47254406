// SPDX-License-Identifier: BSD-3-Clause
// The base class: types of outputs, errors, exceptions, abort.
#include "RandomModels.h"
#include <knotwork/SplineGrid/DistributedInput.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include "vtkCallbackCommand.h"
#include "vtkDummyCommunicator.h"
#include "vtkDummyController.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <memory>
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
  EXPECT_EQ(CodeOfFilter(filter), ErrorCode::LibraryError);
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

/// This process is one of two; of the other one it is known whether it has data.
class TwoProcesses : public vtkDummyCommunicator
{
public:
  static TwoProcesses* New();
  vtkTypeMacro(TwoProcesses, vtkDummyCommunicator);
  int OtherHasData = 0;
  int Calls = 0;
  void BecomeProcess(int number) { this->LocalProcessId = number; }

  int AllGatherVoidArray(const void* mine, void* all, vtkIdType, int) override
  {
    ++this->Calls;
    static_cast<int*>(all)[this->LocalProcessId] = *static_cast<const int*>(mine);
    static_cast<int*>(all)[1 - this->LocalProcessId] = this->OtherHasData;
    return 1;
  }

protected:
  TwoProcesses() { this->MaximumNumberOfProcesses = this->NumberOfProcesses = 2; }
};
vtkStandardNewMacro(TwoProcesses);

/// The global controller while it lives.
struct OneOfTwo
{
  vtkNew<TwoProcesses> Communicator;
  vtkNew<vtkDummyController> Controller;
  vtkMultiProcessController* Before = vtkMultiProcessController::GetGlobalController();

  OneOfTwo()
  {
    this->Controller->SetCommunicator(this->Communicator);
    vtkMultiProcessController::SetGlobalController(this->Controller);
  }
  ~OneOfTwo() { vtkMultiProcessController::SetGlobalController(this->Before); }
};

class CopyPieces : public Copy
{
public:
  static CopyPieces* New();
  vtkTypeMacro(CopyPieces, Copy);

protected:
  bool WorksOnPieces() const override { return true; }
};
vtkStandardNewMacro(CopyPieces);

vtkIdType Cells(vtkAlgorithm* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfCells();
}

TEST(SplineAlgorithm, TheWholeInputIsInOneOfTwoProcesses_ExactOracle)
{
  const auto grid = Encode(RandomModel({ 2, SpaceKind::Tensor, false, 1, 1 }));
  const auto failed =
    vtkErrorCode::UserError + static_cast<unsigned long>(ErrorCode::InvalidTopology);
  for (int process : { 0, 1 })
  {
    for (bool here : { false, true })
    {
      for (bool there : { false, true })
      {
        SCOPED_TRACE(std::to_string(process) + " " + std::to_string(here) + std::to_string(there));
        OneOfTwo processes;
        processes.Communicator->BecomeProcess(process);
        processes.Communicator->OtherHasData = there ? 1 : 0;
        vtkNew<Copy> filter;
        Messages messages(filter);
        filter->SetInputDataObject(here ? grid : vtkSmartPointer<vtkUnstructuredGrid>::New());
        const int done = filter->UpdatePiece(process, 2, 0);
        EXPECT_EQ(done, 1); // what follows runs in both processes
        EXPECT_EQ(processes.Communicator->Calls, 1);
        EXPECT_EQ(Cells(filter) > 0, here && !there);
        EXPECT_EQ(filter->GetErrorCode(), here && there ? failed : 0);
        // the first one with data speaks
        ASSERT_EQ(messages.Errors.size(), here && there && process == 0 ? 1U : 0U);
        if (!messages.Errors.empty())
        {
          EXPECT_NE(messages.Errors[0].find("spread over 2 of 2 processes"), std::string::npos);
          EXPECT_NE(messages.Errors[0].find("without mpirun"), std::string::npos);
        }
        vtkNew<CopyPieces> pieces;
        pieces->SetInputDataObject(here ? grid : vtkSmartPointer<vtkUnstructuredGrid>::New());
        pieces->UpdatePiece(process, 2, 0);
        EXPECT_EQ(Cells(pieces) > 0, here);
        EXPECT_EQ(processes.Communicator->Calls, 1);
      }
    }
  }
}

TEST(SplineAlgorithm, APieceThatMayNotBeTheWholeIsRefused)
{
  const auto grid = Encode(RandomModel({ 2, SpaceKind::Tensor, false, 1, 1 }));
  // one process that asks for a piece; one of several that asks for the whole
  for (const bool several : { false, true })
  {
    std::unique_ptr<OneOfTwo> processes(several ? new OneOfTwo : nullptr);
    const int pieces = several ? 1 : 3;
    vtkNew<Copy> filter;
    Messages messages(filter);
    filter->SetInputDataObject(grid);
    filter->UpdatePiece(0, pieces, 0);
    EXPECT_EQ(Cells(filter), 0);
    ASSERT_EQ(messages.Errors.size(), 1U);
    EXPECT_NE(messages.Errors[0].find(several ? "one of 2 processes" : "one of 3 pieces"),
      std::string::npos)
      << messages.Errors[0];
    filter->SetInputDataObject(vtkNew<vtkUnstructuredGrid>());
    filter->UpdatePiece(0, pieces, 0);
    EXPECT_EQ(messages.Errors.size(), 1U);
    if (several)
    {
      EXPECT_EQ(processes->Communicator->Calls, 0); // nobody is waited for
    }
  }
  vtkNew<Copy> filter;
  filter->SetInputDataObject(grid);
  filter->Update();
  EXPECT_GT(Cells(filter), 0);
}
}
