// SPDX-License-Identifier: BSD-3-Clause
#include "Rendering.h"
#include <knotwork/JacobianValidation/vtkJacobianValidator.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

// An annulus sector of 4 x 4 cells, one corner pulled across its neighbours: the cells that fold
// stand out.
TEST(JacobianValidatorPicture, FoldedCells_ImageOracle)
{
  vtkNew<vtkSplineSource> source;
  source->SetShapeName("AnnulusSector");
  source->SetElements(4, 4, 1);
  source->Update();
  vtkNew<vtkUnstructuredGrid> grid;
  grid->DeepCopy(source->GetOutputDataObject(0));
  // cells of foreign origin: their points are what they are, in no space of smooth functions
  grid->GetFieldData()->Initialize();
  for (const char* name : { "PatchBasis", "ParametricBounds", "ElementId" })
  {
    grid->GetCellData()->RemoveArray(name);
  }
  const vtkIdType corner = grid->GetCell(5)->GetPointId(2);
  double x[3];
  grid->GetPoint(corner, x);
  grid->GetPoints()->SetPoint(corner, 1.3 * x[0], 1.3 * x[1], 0.0);
  vtkNew<vtkJacobianValidator> validator;
  validator->SetInputData(grid);
  validator->Update();
  EXPECT_EQ(validator->GetVerdict(), -1);
  vtkNew<vtkSplineTessellate> surface;
  surface->SetInputConnection(validator->GetOutputPort());
  surface->SetChordalTolerance(1e-4);
  surface->Update();
  auto* polygons = vtkPolyData::SafeDownCast(surface->GetOutputDataObject(0));
  vtkDataArray* verdicts = polygons->GetCellData()->GetArray("JacobianVerdict");
  ASSERT_TRUE(verdicts);
  vtkNew<vtkIntArray> colours;
  colours->SetName("Colour");
  for (vtkIdType i = 0; i < verdicts->GetNumberOfTuples(); ++i)
  {
    colours->InsertNextValue(static_cast<int>(verdicts->GetTuple1(i)) + 1);
  }
  polygons->GetCellData()->AddArray(colours);
  knotwork::RenderOptions options;
  options.ColorBy = "Colour";
  options.Edges = false;
  EXPECT_TRUE(knotwork::RenderAndCompare(polygons, "JacobianValidator", options));
}
