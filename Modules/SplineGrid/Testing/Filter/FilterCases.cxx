// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkExtractCells.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <limits>

namespace knotwork
{
void ExpectBadInputIsRefused(vtkSplineAlgorithm* filter)
{
  const auto annulus = [] { return ShapeGrid(vtkSplineSource::ANNULUS_SECTOR, 2, { 2, 2, 1 }); };
  {
    SCOPED_TRACE("empty grid: empty output without a word");
    vtkNew<MessageRecorder> recorder;
    recorder->Watch(filter);
    vtkNew<vtkUnstructuredGrid> empty;
    filter->SetInputDataObject(empty);
    filter->Update();
    EXPECT_TRUE(recorder->Errors.empty() && recorder->Warnings.empty());
    EXPECT_EQ(filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), 0);
    vtkNew<vtkPartitionedDataSetCollection> nothing;
    filter->SetInputDataObject(nothing);
    filter->Update();
    EXPECT_TRUE(recorder->Errors.empty() && recorder->Warnings.empty());
    filter->RemoveObserver(recorder);
    filter->GetExecutive()->RemoveObserver(recorder);
  }
  {
    SCOPED_TRACE("NaN in a point");
    auto grid = annulus();
    grid->GetPoints()->SetPoint(4, std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
    filter->SetInputDataObject(grid);
    ExpectFailure(filter, ErrorCode::NonFiniteInput, "");
  }
  {
    SCOPED_TRACE("truncated: one element of the patch is missing");
    vtkNew<vtkExtractCells> extract;
    vtkNew<vtkIdList> kept;
    for (vtkIdType cell = 0; cell < 3; ++cell)
    {
      kept->InsertNextId(cell);
    }
    extract->SetInputData(annulus());
    extract->SetCellList(kept);
    extract->Update();
    filter->SetInputDataObject(extract->GetOutput());
    ExpectFailure(filter, ErrorCode::InvalidTopology, "");
  }
  {
    SCOPED_TRACE("damaged: degrees that do not fit the cells");
    auto grid = annulus();
    for (const char* name : { "HigherOrderDegrees", "BezierDegrees" })
    {
      grid->GetCellData()->GetArray(name)->SetComponent(1, 0, 2.5);
    }
    filter->SetInputDataObject(grid);
    ExpectFailure(filter, ErrorCode::InvalidDegree, "");
  }
  {
    SCOPED_TRACE("mismatched: cells that are no Bezier cells");
    vtkNew<vtkUnstructuredGrid> tetrahedron;
    vtkNew<vtkPoints> points;
    for (int i = 0; i < 4; ++i)
    {
      points->InsertNextPoint(i == 1, i == 2, i == 3);
    }
    tetrahedron->SetPoints(points);
    const vtkIdType ids[4] = { 0, 1, 2, 3 };
    tetrahedron->InsertNextCell(VTK_TETRA, 4, ids);
    filter->SetInputDataObject(tetrahedron);
    ExpectFailure(filter, ErrorCode::InvalidTopology, "");
  }
  {
    SCOPED_TRACE("wrong type");
    vtkNew<MessageRecorder> recorder;
    recorder->Watch(filter);
    vtkNew<vtkImageData> image;
    filter->SetInputDataObject(image);
    filter->Update();
    EXPECT_FALSE(recorder->Errors.empty());
    filter->RemoveObserver(recorder);
    filter->GetExecutive()->RemoveObserver(recorder);
  }
  filter->SetInputDataObject(annulus());
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError) << "the filter works again";
  vtkIdType cells = 0; // in any output
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    cells += filter->GetOutputDataObject(port)->GetNumberOfElements(vtkDataObject::CELL);
  }
  EXPECT_GT(cells, 0);
}
}
