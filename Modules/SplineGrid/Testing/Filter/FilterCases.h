// SPDX-License-Identifier: BSD-3-Clause
// What tests of filters share: recorded errors, sources, good and bad input.
#pragma once
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace knotwork
{
/// Collects the error and warning messages of an algorithm instead of printing them.
class MessageRecorder : public vtkCommand
{
public:
  static MessageRecorder* New() { return new MessageRecorder; }
  void Execute(vtkObject*, unsigned long event, void* text) override
  {
    (event == vtkCommand::ErrorEvent ? this->Errors : this->Warnings)
      .push_back(static_cast<const char*>(text));
  }
  void Watch(vtkAlgorithm* algorithm)
  {
    for (vtkObject* source :
      std::initializer_list<vtkObject*>{ algorithm, algorithm->GetExecutive() })
    {
      source->AddObserver(vtkCommand::ErrorEvent, this);
      source->AddObserver(vtkCommand::WarningEvent, this);
    }
  }
  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;
};

/// A copy of the source's grid.
inline vtkSmartPointer<vtkUnstructuredGrid> ShapeGrid(
  int shape, int degree = 0, std::array<int, 3> elements = { 1, 1, 1 })
{
  vtkNew<vtkSplineSource> source;
  source->SetShape(shape);
  source->SetDegree(degree);
  source->SetElements(elements.data());
  source->Update();
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->DeepCopy(source->GetOutputDataObject(0));
  return grid;
}

/// Every grid a block of its own.
inline vtkSmartPointer<vtkPartitionedDataSetCollection> Collect(
  const std::vector<vtkSmartPointer<vtkUnstructuredGrid>>& grids)
{
  auto collection = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
  for (unsigned int b = 0; b < grids.size(); ++b)
  {
    vtkNew<vtkPartitionedDataSet> block;
    block->SetPartition(0, grids[b]);
    collection->SetPartitionedDataSet(b, block);
  }
  return collection;
}

/// The patches of a dataset; a failed decoding fails the test.
inline SplineModel DecodePatches(vtkDataObject* data)
{
  auto model = DecodeSplineModel(data, 0);
  EXPECT_TRUE(model) << model.Status.Message();
  return model.Value;
}

/// Runs a filter that must fail: one error line with the words, the error code, an empty output.
inline void ExpectFailure(vtkSplineAlgorithm* filter, ErrorCode code, const std::string& words)
{
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UserError + static_cast<unsigned long>(code));
  ASSERT_FALSE(recorder->Errors.empty());
  EXPECT_NE(recorder->Errors[0].find(words), std::string::npos) << recorder->Errors[0];
  vtkDataObject* output = filter->GetOutputDataObject(0);
  EXPECT_EQ(output->GetNumberOfElements(vtkDataObject::CELL), 0);
  EXPECT_EQ(output->GetNumberOfElements(vtkDataObject::POINT), 0);
  filter->RemoveObserver(recorder);
  filter->GetExecutive()->RemoveObserver(recorder);
}

/// Progress rises from 0 to 1 in more than `steps` reports; stopped at the first of them, or at the
/// first one above 0, the filter has no output and no error but Aborted; it works again afterwards.
inline void ExpectProgressAndAbort(vtkSplineAlgorithm* filter, std::size_t steps)
{
  std::vector<double> shares;
  vtkNew<vtkCallbackCommand> watch;
  watch->SetClientData(&shares);
  watch->SetCallback(
    [](vtkObject* caller, unsigned long, void* data, void*)
    {
      static_cast<std::vector<double>*>(data)->push_back(
        static_cast<vtkAlgorithm*>(caller)->GetProgress());
    });
  filter->AddObserver(vtkCommand::ProgressEvent, watch);
  filter->Update();
  EXPECT_GT(shares.size(), steps);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  ASSERT_FALSE(shares.empty());
  EXPECT_GE(shares.front(), 0.0);
  EXPECT_LE(shares.back(), 1.0);
  filter->RemoveObserver(watch);
  const auto points = [&]
  { return filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::POINT); };
  const vtkIdType complete = points();
  for (double limit : { -1.0, 0.0 })
  {
    vtkNew<vtkCallbackCommand> stop;
    stop->SetClientData(&limit);
    stop->SetCallback(
      [](vtkObject* caller, unsigned long, void* above, void*)
      {
        auto* algorithm = static_cast<vtkAlgorithm*>(caller);
        if (algorithm->GetProgress() > *static_cast<double*>(above))
        {
          algorithm->SetAbortExecute(1);
        }
      });
    filter->AddObserver(vtkCommand::ProgressEvent, stop);
    vtkNew<MessageRecorder> recorder;
    recorder->Watch(filter);
    filter->Modified();
    filter->Update();
    EXPECT_EQ(filter->GetErrorCode(),
      vtkErrorCode::UserError + static_cast<unsigned long>(ErrorCode::Aborted));
    EXPECT_TRUE(recorder->Errors.empty());
    EXPECT_EQ(points(), 0);
    filter->RemoveObserver(stop);
    filter->RemoveObserver(recorder);
    filter->GetExecutive()->RemoveObserver(recorder);
  }
  filter->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(points(), complete);
}

/// What every filter of spline grids does with empty, non-finite, foreign, truncated and damaged
/// input.
void ExpectBadInputIsRefused(vtkSplineAlgorithm* filter);
}
