// SPDX-License-Identifier: BSD-3-Clause
// Bezier grids that other programs wrote.
#include "RandomModels.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierSpace.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"

#include <cmath>
#include <random>

using namespace knotwork;

namespace
{
// Two biquadratic cells side by side in VTK's order of points: corners, edges, face. Their points
// are the lattice (i, j), i = 0..4, j = 0..2, numbered i + 5 j.
vtkSmartPointer<vtkUnstructuredGrid> TwoQuadrilaterals()
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 5; ++i)
    {
      points->InsertNextPoint(i, j, 0.25 * i * j);
    }
  }
  grid->SetPoints(points); // float, as many writers do
  const vtkIdType first[9] = { 0, 2, 12, 10, 1, 7, 11, 5, 6 };
  vtkIdType second[9];
  std::transform(first, first + 9, second, [](vtkIdType id) { return id + 2; });
  grid->InsertNextCell(VTK_BEZIER_QUADRILATERAL, 9, first);
  grid->InsertNextCell(VTK_BEZIER_QUADRILATERAL, 9, second);
  return grid;
}

TEST(SplineModelForeign, CellsAreGluedByTheirPoints_GoldenOracle)
{
  const auto grid = TwoQuadrilaterals();
  const SplineModel model = Decode(grid);
  EXPECT_EQ(model.Warnings, std::vector<std::string>());
  ASSERT_EQ(model.Patches.size(), 1U);
  const SplinePatch& patch = model.Patches[0];
  EXPECT_EQ(patch.Id, 0);
  EXPECT_EQ(KindOf(patch), SpaceKind::Bezier);
  EXPECT_EQ(patch.Cells, (std::vector<vtkIdType>{ 0, 1 }));
  ASSERT_EQ(NumFunctions(patch), 15);
  const auto& space = *std::get<Spline<2>>(patch.Geometry).Space;
  EXPECT_EQ(space.Elements[0].Degree, (IntArray<2>{ 2, 2 }));
  // Function ids are point ids; first direction fastest within an element.
  EXPECT_EQ(space.LocalFunctionIds,
    (std::vector<int>{ 0, 1, 2, 5, 6, 7, 10, 11, 12, 2, 3, 4, 7, 8, 9, 12, 13, 14 }));
  EXPECT_EQ(ControlPoints(patch)(13, 2), 0.25 * 3 * 2);
  EXPECT_FALSE(IsRational(patch));
}

TEST(SplineModelForeign, RoundTripOfBezierPatches_ExactOracle)
{
  const SplineModel model = Decode(TwoQuadrilaterals());
  const auto grid = Encode(model);
  EXPECT_EQ(grid->GetNumberOfPoints(), 15);
  EXPECT_FALSE(grid->GetCellData()->HasArray("ParametricBounds"));
  const SplineModel back = Decode(grid);
  EXPECT_TRUE(Identical(model, back));
  EXPECT_EQ(back.Warnings, std::vector<std::string>());
}

void AddDegrees(
  vtkUnstructuredGrid* grid, double p, double q, const char* arrayName, bool attribute)
{
  vtkNew<vtkDoubleArray> degrees;
  degrees->SetName(arrayName);
  degrees->SetNumberOfComponents(3);
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    degrees->InsertNextTuple3(p, q, 1); // the third number means nothing
  }
  if (attribute)
  {
    grid->GetCellData()->SetHigherOrderDegrees(degrees);
  }
  else
  {
    grid->GetCellData()->AddArray(degrees);
  }
}

TEST(SplineModelForeign, DegreesFromAttributeOrArrayOfThatName_GoldenOracle)
{
  // One cell of degree (3, 1) and its eight points.
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  vtkIdType ids[8];
  for (int i = 0; i < 8; ++i)
  {
    ids[i] = points->InsertNextPoint(i, i * i, 0);
  }
  grid->SetPoints(points);
  grid->InsertNextCell(VTK_BEZIER_QUADRILATERAL, 8, ids);
  const Result<SplineModel> unknown = DecodeSplineModel(grid, 0);
  EXPECT_EQ(unknown.Status.Code, ErrorCode::InvalidDegree);
  EXPECT_NE(unknown.Status.Detail.find("no array HigherOrderDegrees"), std::string::npos);
  for (bool attribute : { false, true })
  {
    grid->GetCellData()->Initialize();
    AddDegrees(grid, 3, 1, attribute ? "Orders" : "HigherOrderDegrees", attribute);
    const SplineModel model = Decode(grid);
    ASSERT_EQ(model.Patches.size(), 1U);
    EXPECT_EQ(std::get<Spline<2>>(model.Patches[0].Geometry).Space->Elements[0].Degree,
      (IntArray<2>{ 3, 1 }));
  }
  // The attribute comes first, unless it cannot be right.
  grid->GetCellData()->Initialize();
  AddDegrees(grid, 2.9, 1, "Orders", true);
  AddDegrees(grid, 1, 3, "HigherOrderDegrees", false);
  EXPECT_EQ(std::get<Spline<2>>(Decode(grid).Patches[0].Geometry).Space->Elements[0].Degree,
    (IntArray<2>{ 1, 3 }));
}

TEST(SplineModelForeign, QuarterCircleFromWeightsOfThatName_ExactOracle)
{
  for (bool attribute : { false, true })
  {
    vtkNew<vtkUnstructuredGrid> grid;
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->InsertNextPoint(1, 0, 0);
    points->InsertNextPoint(0, 1, 0);
    points->InsertNextPoint(1, 1, 0);
    grid->SetPoints(points);
    const vtkIdType ids[3] = { 0, 1, 2 };
    grid->InsertNextCell(VTK_BEZIER_CURVE, 3, ids);
    vtkNew<vtkDoubleArray> weights;
    weights->SetName("RationalWeights");
    weights->InsertNextValue(1);
    weights->InsertNextValue(1);
    weights->InsertNextValue(std::sqrt(0.5));
    if (attribute)
    {
      grid->GetPointData()->SetRationalWeights(weights);
    }
    else
    {
      grid->GetPointData()->AddArray(weights);
    }
    const SplineModel model = Decode(grid);
    ASSERT_EQ(model.Patches.size(), 1U);
    const auto form = MakeBezierForm(std::get<Spline<1>>(model.Patches[0].Geometry));
    PointMatrix local(5, 1);
    local << 0, 0.2, 0.5, 0.9, 1;
    EvaluationBatch batch;
    ASSERT_TRUE(EvaluateElements(form, std::vector<int>(5, 0), local, {}, batch));
    for (int i = 0; i < 5; ++i) // rounding of three terms
    {
      EXPECT_NEAR(batch.Values.row(i).norm(), 1.0, 8 * std::numeric_limits<double>::epsilon());
    }
  }
}

TEST(SplineModelForeign, OnePatchADimensionOrAPatchId_GoldenOracle)
{
  auto grid = TwoQuadrilaterals();
  const vtkIdType edge[3] = { 0, 2, 1 };
  grid->InsertNextCell(VTK_BEZIER_CURVE, 3, edge);
  SplineModel model = Decode(grid);
  ASSERT_EQ(model.Patches.size(), 2U);
  EXPECT_EQ(model.Patches[0].Geometry.index(), 0U);
  EXPECT_EQ(model.Patches[0].Cells, std::vector<vtkIdType>{ 2 });
  EXPECT_EQ(model.Patches[1].Geometry.index(), 1U);
  EXPECT_EQ(model.Patches[1].Id, 1);

  vtkNew<vtkFloatArray> ids; // whole numbers, whatever the type
  ids->SetName("PatchId");
  for (float id : { 8.0F, 4.0F, 9.0F })
  {
    ids->InsertNextValue(id);
  }
  grid->GetCellData()->AddArray(ids);
  model = Decode(grid);
  ASSERT_EQ(model.Patches.size(), 3U);
  EXPECT_EQ(NumFunctions(PatchOf(model, 8)), 9);
  EXPECT_EQ(NumFunctions(PatchOf(model, 4)), 9);
  EXPECT_EQ(NumFunctions(PatchOf(model, 9)), 3);
}

TEST(SplineModelForeign, FloatsAreFieldsOthersAreDroppedWithAWarning_GoldenOracle)
{
  const auto grid = TwoQuadrilaterals();
  vtkNew<vtkFloatArray> field;
  field->SetName("Pressure");
  vtkNew<vtkIntArray> numbers;
  numbers->SetName("Numbers");
  vtkNew<vtkStringArray> names;
  names->SetName("Names");
  for (int i = 0; i < 15; ++i)
  {
    field->InsertNextValue(0.5F * static_cast<float>(i));
    numbers->InsertNextValue(i);
    names->InsertNextValue("point");
  }
  grid->GetPointData()->AddArray(field);
  grid->GetPointData()->AddArray(numbers);
  grid->GetPointData()->AddArray(names);
  const SplineModel model = Decode(grid);
  ASSERT_EQ(model.Patches[0].Fields.size(), 1U);
  EXPECT_EQ(model.Patches[0].Fields[0].Name, "Pressure");
  EXPECT_EQ(model.Patches[0].Fields[0].Coefficients(7, 0), 3.5);
  ASSERT_EQ(model.Warnings.size(), 2U);
  EXPECT_NE(model.Warnings[0].find("'Numbers'"), std::string::npos);
  EXPECT_NE(model.Warnings[1].find("'Names'"), std::string::npos);
}

TEST(SplineModelForeign, CellsMayBeRemoved_ExactOracle)
{
  // A Bezier patch is its cells: what is left of it is a spline, too.
  const auto grid = Encode(Decode(TwoQuadrilaterals()));
  vtkNew<vtkIdTypeArray> offsets, connectivity;
  vtkNew<vtkUnstructuredGrid> half;
  half->SetPoints(grid->GetPoints());
  half->InsertNextCell(VTK_BEZIER_QUADRILATERAL, grid->GetCell(1)->GetPointIds());
  half->GetCellData()->CopyAllOn();
  half->GetCellData()->CopyAllocate(grid->GetCellData());
  half->GetCellData()->CopyData(grid->GetCellData(), 1, 0);
  half->GetFieldData()->PassData(grid->GetFieldData());
  const SplineModel model = Decode(half);
  ASSERT_EQ(model.Patches.size(), 1U);
  EXPECT_EQ(NumFunctions(model.Patches[0]), 9);
}

// Our own grids without anything that only we write are grids of foreign origin.
class ForeignGrids : public ::testing::TestWithParam<ModelCase>
{
};

TEST_P(ForeignGrids, StrippedGridsKeepTheirPoints_ExactOracle)
{
  const auto grid = Encode(RandomModel(GetParam()));
  vtkNew<vtkUnstructuredGrid> plain;
  plain->SetPoints(grid->GetPoints());
  plain->SetCells(grid->GetCellTypesArray(), grid->GetCells());
  plain->GetCellData()->SetHigherOrderDegrees(grid->GetCellData()->GetHigherOrderDegrees());
  plain->GetPointData()->SetRationalWeights(grid->GetPointData()->GetRationalWeights());
  const SplineModel model = Decode(plain);
  EXPECT_EQ(model.Warnings, std::vector<std::string>());
  ASSERT_EQ(model.Patches.size(), 1U);
  const PointMatrix& points = ControlPoints(model.Patches[0]);
  ASSERT_EQ(points.rows(), grid->GetNumberOfPoints());
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const double* x = grid->GetPoint(i);
    EXPECT_EQ(points.row(i), Eigen::RowVector3d(x[0], x[1], x[2]));
  }
  const auto again = Encode(model);
  EXPECT_EQ(again->GetNumberOfPoints(), grid->GetNumberOfPoints());
  EXPECT_TRUE(Identical(model, Decode(again)));
}

INSTANTIATE_TEST_SUITE_P(All, ForeignGrids, ::testing::ValuesIn(AllModelCases()), NameOf);
}
