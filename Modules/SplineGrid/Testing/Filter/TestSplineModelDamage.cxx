// SPDX-License-Identifier: BSD-3-Clause
// Damage is found and named, never read as something else.
#include "RandomModels.h"

#include <knotwork/SplineCore/BezierForm.h>

#include "vtkAppendFilter.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkExtractCells.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkThreshold.h"
#include "vtkUnsignedCharArray.h"

#include <functional>
#include <limits>
#include <random>

using namespace knotwork;

namespace
{
using Grid = vtkUnstructuredGrid;
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

struct Damage
{
  std::string Name;
  std::function<void(Grid*)> Do;
  ErrorCode Code;
  std::vector<std::string> Words; ///< all of them in the detail of the error
};

// Biquadratic and rational, patches 3, 5 and 7; cell 0 belongs to patch 3.
SplineModel DamagedModel()
{
  return RandomModel({ 2, SpaceKind::Tensor, true, 3, 1 });
}

void SetCellPoint(Grid* grid, vtkIdType cell, vtkIdType position, vtkIdType point)
{
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    grid->GetCellPoints(c, ids);
    if (c == cell)
    {
      ids->SetId(position, point);
    }
    cells->InsertNextCell(ids);
  }
  vtkNew<vtkUnsignedCharArray> types;
  types->DeepCopy(grid->GetCellTypesArray());
  grid->SetCells(types, cells);
}

void KeepCells(Grid* grid, const std::function<bool(vtkIdType)>& keep)
{
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    if (keep(c))
    {
      ids->InsertNextId(c);
    }
  }
  vtkNew<vtkExtractCells> extract;
  extract->SetInputData(grid);
  extract->SetCellList(ids);
  extract->Update();
  vtkNew<vtkFieldData> fieldData;
  fieldData->ShallowCopy(grid->GetFieldData());
  grid->ShallowCopy(extract->GetOutput());
  grid->SetFieldData(fieldData);
}

void SetAll(Grid* grid, const char* arrayName, vtkIdType cell, int component, double value)
{
  if (vtkDataArray* array = grid->GetCellData()->GetArray(arrayName))
  {
    array->SetComponent(cell, component, value);
  }
}

std::vector<Damage> AllDamages()
{
  const auto degrees = [](Grid* grid, double value)
  {
    SetAll(grid, "HigherOrderDegrees", 0, 0, value);
    SetAll(grid, "BezierDegrees", 0, 0, value);
  };
  const auto weights = [](Grid* grid, double value)
  { grid->GetPointData()->GetRationalWeights()->SetComponent(0, 0, value); };
  return {
    { "MissingCell", [](Grid* grid) { KeepCells(grid, [](vtkIdType c) { return c != 1; }); },
      ErrorCode::InvalidTopology, { "patch 3", "missing: 1" } },
    { "ExtraElement", [](Grid* grid) { SetAll(grid, "ElementId", 0, 0, 1000); },
      ErrorCode::InvalidTopology, { "patch 3", "cell 0", "1000" } },
    { "NegativeElement", [](Grid* grid) { SetAll(grid, "ElementId", 0, 0, -1); },
      ErrorCode::InvalidTopology, { "patch 3", "cell 0", "-1" } },
    { "ElementTwice",
      [](Grid* grid)
      {
        vtkNew<vtkIdList> ids;
        grid->GetCellPoints(1, ids);
        const vtkIdType cell = grid->InsertNextCell(grid->GetCellType(1), ids);
        vtkCellData* data = grid->GetCellData();
        for (int a = 0; a < data->GetNumberOfArrays(); ++a)
        {
          data->GetArray(a)->InsertTuple(cell, 1, data->GetArray(a));
        }
      },
      ErrorCode::InvalidTopology, { "patch 3", "element 1 occurs 2 times", "cell 1" } },
    { "SwappedElements",
      [](Grid* grid)
      {
        SetAll(grid, "ElementId", 0, 0, 1);
        SetAll(grid, "ElementId", 1, 0, 0);
      },
      ErrorCode::InvalidTopology, { "patch 3", "ParametricBounds" } },
    { "NoElementIds", [](Grid* grid) { grid->GetCellData()->RemoveArray("ElementId"); },
      ErrorCode::InvalidTopology, { "patch 3", "ElementId is missing" } },
    { "FractionalPatch",
      [](Grid* grid)
      {
        vtkNew<vtkDoubleArray> ids;
        ids->SetName("PatchId");
        ids->SetNumberOfTuples(grid->GetNumberOfCells());
        ids->Fill(2.5);
        grid->GetCellData()->AddArray(ids);
      },
      ErrorCode::InvalidTopology, { "PatchId", "2.5", "cell 0" } },
    { "PatchOfThreeNumbers",
      [](Grid* grid)
      {
        vtkNew<vtkIntArray> ids;
        ids->SetName("PatchId");
        ids->SetNumberOfComponents(3);
        ids->SetNumberOfTuples(grid->GetNumberOfCells());
        ids->Fill(0);
        grid->GetCellData()->AddArray(ids);
      },
      ErrorCode::InvalidTopology, { "PatchId is not one number a cell" } },
    { "RepeatedPoint",
      [](Grid* grid)
      {
        vtkNew<vtkIdList> ids;
        grid->GetCellPoints(1, ids);
        SetCellPoint(grid, 1, 0, ids->GetId(2));
      },
      ErrorCode::InvalidTopology, { "patch 3", "cell 1", "twice" } },
    { "PointOutOfRange", [](Grid* grid) { SetCellPoint(grid, 1, 0, grid->GetNumberOfPoints()); },
      ErrorCode::InvalidTopology, { "patch 3", "cell 1", "uses point" } },
    { "FractionalDegree", [=](Grid* grid) { degrees(grid, 2.5); }, ErrorCode::InvalidDegree,
      { "patch 3", "cell 0", "2.5" } },
    { "NegativeDegree", [=](Grid* grid) { degrees(grid, -2); }, ErrorCode::InvalidDegree,
      { "patch 3", "cell 0", "-2" } },
    { "DegreeThatDoesNotFit", [=](Grid* grid) { degrees(grid, 7); }, ErrorCode::InvalidDegree,
      { "patch 3", "cell 0", "(7" } },
    { "NaNDegree", [=](Grid* grid) { degrees(grid, NaN); }, ErrorCode::InvalidDegree,
      { "patch 3", "cell 0" } },
    { "NaNPoint",
      [](Grid* grid)
      {
        vtkNew<vtkIdList> ids;
        grid->GetCellPoints(2, ids);
        double x[3] = { 0, NaN, 0 };
        grid->GetPoints()->SetPoint(ids->GetId(ids->GetNumberOfIds() - 1), x);
      },
      ErrorCode::NonFiniteInput, { "patch 3", "cell ", "coordinate" } },
    { "NaNWeight", [=](Grid* grid) { weights(grid, NaN); }, ErrorCode::InvalidWeight,
      { "patch 3", "cell 0", "point 0" } },
    { "ZeroWeight", [=](Grid* grid) { weights(grid, 0); }, ErrorCode::InvalidWeight,
      { "patch 3", "cell 0", "point 0" } },
    { "LostWeights",
      [](Grid* grid)
      {
        grid->GetPointData()->RemoveArray("RationalWeights");
        grid->GetPointData()->RemoveArray("BezierWeights");
      },
      ErrorCode::InvalidWeight, { "patch 3", "RationalWeights" } },
    { "NaNField",
      [](Grid* grid) { grid->GetPointData()->GetArray("Velocity")->SetComponent(0, 1, NaN); },
      ErrorCode::NonFiniteInput, { "patch 3", "Velocity" } },
    { "LinearCell",
      [](Grid* grid)
      {
        const vtkIdType ids[4] = { 0, 1, 2, 3 };
        grid->InsertNextCell(VTK_QUAD, 4, ids);
        vtkCellData* data = grid->GetCellData();
        for (int a = 0; a < data->GetNumberOfArrays(); ++a)
        {
          data->GetArray(a)->InsertNextTuple(0, data->GetArray(a));
        }
      },
      ErrorCode::InvalidTopology, { "vtkQuad", "type 9" } },
    { "CellOfAnotherDimension",
      [](Grid* grid)
      {
        const vtkIdType ids[3] = { 0, 1, 2 };
        grid->InsertNextCell(VTK_BEZIER_CURVE, 3, ids);
        vtkCellData* data = grid->GetCellData();
        for (int a = 0; a < data->GetNumberOfArrays(); ++a)
        {
          data->GetArray(a)->InsertNextTuple(0, data->GetArray(a));
        }
      },
      ErrorCode::InvalidTopology, { "patch 3", "different dimensions", "cell 0" } },
    { "NewerSchema",
      [](Grid* grid)
      { grid->GetFieldData()->GetArray("KnotworkSchemaVersion")->SetComponent(0, 0, 99); },
      ErrorCode::InvalidTopology, { "version 99", "versions 1 to 2" } },
    { "LostKnots", [](Grid* grid) { grid->GetFieldData()->RemoveArray("KnotworkKnots"); },
      ErrorCode::InvalidTopology, { "KnotworkKnots", "patch 3" } },
    { "EditedKnots",
      [](Grid* grid)
      {
        vtkDataArray* knots = grid->GetFieldData()->GetArray("KnotworkKnots");
        knots->SetComponent(0, 0, knots->GetComponent(0, 0) - 1.0);
      },
      ErrorCode::InvalidTopology, { "patch 3", "basis" } },
    { "PatchTableOfAnotherWidth",
      [](Grid* grid)
      {
        vtkDataArray* table = grid->GetFieldData()->GetArray("KnotworkPatches");
        table->SetNumberOfComponents(3);
        table->SetNumberOfTuples(15);
      },
      ErrorCode::InvalidTopology, { "KnotworkPatches" } },
    { "HugeCounts",
      [](Grid* grid)
      { grid->GetFieldData()->GetArray("KnotworkPatches")->SetComponent(0, 9, 2.0e9); },
      ErrorCode::InvalidTopology, { "KnotworkKnots", "patch 3" } },
  };
}

class SplineModelDamage : public ::testing::TestWithParam<Damage>
{
};

TEST_P(SplineModelDamage, IsNamed)
{
  const auto grid = Encode(DamagedModel());
  GetParam().Do(grid);
  const Result<SplineModel> model = DecodeSplineModel(grid, 0);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.Status.Code, GetParam().Code) << model.Status.Message();
  for (const std::string& word : GetParam().Words)
  {
    EXPECT_NE(model.Status.Detail.find(word), std::string::npos)
      << "no '" << word << "' in: " << model.Status.Detail;
  }
  EXPECT_EQ(model.Status.Message().find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(All, SplineModelDamage, ::testing::ValuesIn(AllDamages()),
  [](const auto& test) { return test.param.Name; });

TEST(SplineModelDamageOfData, WrongDatasetsAreNamed)
{
  const Result<SplineModel> poly = DecodeSplineModel(vtkNew<vtkPolyData>(), 0);
  EXPECT_EQ(poly.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(poly.Status.Detail.find("vtkPolyData"), std::string::npos);
  EXPECT_FALSE(DecodeSplineModel(nullptr, 0));
  const Status status = EncodeSplineModel(DamagedModel(), nullptr, vtkNew<vtkPolyData>());
  EXPECT_EQ(status.Code, ErrorCode::InvalidParameter);
}

TEST(SplineModelDamageOfData, OtherPatchesDoNotHideAMissingElement)
{
  for (const ModelCase& modelCase : AllModelCases())
  {
    SCOPED_TRACE(::testing::PrintToString(modelCase));
    const auto grid = Encode(RandomModel(modelCase));
    const vtkIdType last = grid->GetNumberOfCells() - 1;
    const int patch =
      static_cast<int>(grid->GetCellData()->GetArray("PatchId")->GetComponent(last, 0));
    if (last == 0)
    {
      continue;
    }
    KeepCells(grid, [&](vtkIdType c) { return c != last; });
    const Result<SplineModel> model = DecodeSplineModel(grid, 0);
    ASSERT_FALSE(model);
    EXPECT_NE(
      model.Status.Detail.find("patch " + std::to_string(patch) + ": 1 of"), std::string::npos)
      << model.Status.Detail;
  }
}

TEST(SplineModelDamageOfData, ModelsThatCannotBeWrittenAreNamed)
{
  const SplineModel good = DamagedModel();
  const auto expect = [&](const std::function<void(SplinePatch&)>& spoil, ErrorCode code)
  {
    SplineModel model = good;
    spoil(model.Patches[1]);
    vtkNew<vtkUnstructuredGrid> grid;
    const Status status = EncodeSplineGrid(model, grid);
    EXPECT_EQ(status.Code, code) << status.Message();
    EXPECT_NE(status.Detail.find("patch 5"), std::string::npos) << status.Detail;
    EXPECT_EQ(grid->GetNumberOfCells(), 0);
  };
  const auto spline = [](SplinePatch& patch) -> Spline<2>&
  { return std::get<Spline<2>>(patch.Geometry); };
  expect([&](SplinePatch& patch) { spline(patch).ControlPoints(0, 0) = NaN; },
    ErrorCode::NonFiniteInput);
  expect([&](SplinePatch& patch) { spline(patch).ControlPoints.conservativeResize(2, 3); },
    ErrorCode::SizeMismatch);
  expect(
    [&](SplinePatch& patch)
    {
      auto& points = spline(patch).ControlPoints;
      points.conservativeResize(points.rows(), 2);
    },
    ErrorCode::DimensionMismatch);
  expect([&](SplinePatch& patch) { spline(patch).Space.reset(); }, ErrorCode::EmptyInput);
  expect([&](SplinePatch& patch) { patch.Fields[0].Coefficients(0, 0) = NaN; },
    ErrorCode::NonFiniteInput);
  expect([&](SplinePatch& patch) { patch.Fields[0].Coefficients.resize(1, 1); },
    ErrorCode::SizeMismatch);
  expect([&](SplinePatch& patch) { patch.Fields[0].Name = "Velocity"; }, ErrorCode::SizeMismatch);
  expect([&](SplinePatch& patch) { patch.Fields.push_back(patch.Fields[1]); },
    ErrorCode::InvalidParameter);
  expect([&](SplinePatch& patch) { patch.Fields[0].Name = "RationalWeights"; },
    ErrorCode::InvalidParameter);
  expect([&](SplinePatch& patch) { patch.Fields[1].Name = "Stress"; }, ErrorCode::SizeMismatch);
}

// Whatever happens to the field data: an error, or splines whose points are those of the grid
// unless a warning says that they are a projection.
TEST(SplineModelDamageOfData, RandomFieldDataIsNeverMisread_PropertyOracle)
{
  int errors = 0;
  int recovered = 0;
  for (unsigned seed = 1; seed <= 300; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto cases = AllModelCases();
    const auto grid = Encode(RandomModel(cases[random() % cases.size()]));
    vtkFieldData* fieldData = grid->GetFieldData();
    const int victim = static_cast<int>(random() % fieldData->GetNumberOfArrays());
    vtkDataArray* array = fieldData->GetArray(victim);
    const auto value = array
      ? static_cast<vtkIdType>(random() % static_cast<unsigned>(array->GetNumberOfValues()))
      : 0;
    const auto set = [&](double x)
    {
      const int columns = array->GetNumberOfComponents();
      array->SetComponent(value / columns, static_cast<int>(value % columns), x);
    };
    switch (array ? random() % 5 : 0)
    {
      case 0:
        fieldData->RemoveArray(fieldData->GetArrayName(victim));
        break;
      case 1:
        array->SetNumberOfTuples(array->GetNumberOfTuples() / 2);
        break;
      case 2:
        set(static_cast<double>(random() % 50));
        break;
      case 3:
        set(-1.0);
        break;
      default:
        if (array->GetDataType() == VTK_DOUBLE)
        {
          set(NaN);
        }
        else
        {
          set(2.0e9);
        }
    }
    const Result<SplineModel> model = DecodeSplineModel(grid, 0);
    if (!model)
    {
      ++errors;
      EXPECT_FALSE(model.Status.Detail.empty());
      continue;
    }
    for (const SplinePatch& patch : model.Value.Patches)
    {
      recovered += patch.Recovered ? 1 : 0;
      SplineModel one;
      one.Patches.push_back(patch);
      const auto again = Encode(one);
      // Corners of cells in the order of the elements.
      vtkNew<vtkIdList> a, b;
      double worst = 0.0;
      for (std::size_t e = 0; e < patch.Cells.size(); ++e)
      {
        grid->GetCellPoints(patch.Cells[e], a);
        again->GetCellPoints(static_cast<vtkIdType>(e), b);
        ASSERT_EQ(a->GetNumberOfIds(), b->GetNumberOfIds());
        for (vtkIdType i = 0; i < a->GetNumberOfIds(); ++i)
        {
          double x[3], y[3];
          grid->GetPoint(a->GetId(i), x);
          again->GetPoint(b->GetId(i), y);
          for (int c = 0; c < 3; ++c)
          {
            worst = std::max(worst, std::abs(x[c] - y[c]));
          }
        }
      }
      const double tolerance = 64 * std::numeric_limits<double>::epsilon() * patch.Amplification *
        (SizeOf(ControlPoints(patch)) + 1.0);
      EXPECT_LE(worst, tolerance) << "patch " << patch.Id << " of "
                                  << fieldData->GetArrayName(victim);
    }
  }
  EXPECT_GT(errors, 30);
  EXPECT_GT(recovered, 10);
}
}
