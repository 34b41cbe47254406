// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include "RandomModels.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SplineGrid/vtkSplineRefine.h>

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkSphere.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <limits>
#include <random>
#include <set>

using namespace knotwork;

namespace
{
vtkUnstructuredGrid* GridOf(vtkSplineRefine* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

void AddCellArray(vtkUnstructuredGrid* grid, const char* name, const std::vector<double>& values)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  for (const double value : values)
  {
    array->InsertNextValue(value);
  }
  grid->GetCellData()->AddArray(array);
}

void RefineByArray(vtkSplineRefine* filter, const char* name)
{
  filter->SetMode(vtkSplineRefine::CELL_ARRAY);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, name);
}

double CellValue(vtkUnstructuredGrid* grid, const char* name, vtkIdType cell, int component = 0)
{
  return grid->GetCellData()->GetArray(name)->GetComponent(cell, component);
}

/// The element's box lies in that of the cell.
bool IsInside(
  vtkUnstructuredGrid* fine, vtkIdType child, vtkUnstructuredGrid* coarse, vtkIdType cell)
{
  bool inside = CellValue(fine, "PatchId", child) == CellValue(coarse, "PatchId", cell);
  for (int d = 0; d < 3; ++d)
  {
    inside = inside &&
      CellValue(fine, "ParametricBounds", child, 2 * d) >=
        CellValue(coarse, "ParametricBounds", cell, 2 * d) &&
      CellValue(fine, "ParametricBounds", child, 2 * d + 1) <=
        CellValue(coarse, "ParametricBounds", cell, 2 * d + 1);
  }
  return inside;
}

/// Values of the map and of all fields at random parameters.
PointMatrix Sample(const SplinePatch& patch)
{
  return std::visit(
    [&](const auto& geometry)
    {
      using Space = std::decay_t<decltype(*geometry.Space)>;
      constexpr int Dim = std::tuple_size<decltype(typename Space::Element{}.Degree)>::value;
      std::mt19937 random(5);
      std::uniform_real_distribution<double> uniform(0.0, 1.0);
      const auto domain = geometry.Space->Domain();
      PointMatrix parameters(300, Dim);
      for (Eigen::Index i = 0; i < parameters.rows(); ++i)
      {
        for (int d = 0; d < Dim; ++d)
        {
          const auto k = static_cast<std::size_t>(d);
          parameters(i, d) =
            domain.Lower[k] + (domain.Upper[k] - domain.Lower[k]) * uniform(random);
        }
      }
      Eigen::Index columns = 0;
      PointMatrix values(parameters.rows(), 100);
      const auto evaluate = [&](const PointMatrix& coefficients)
      {
        Spline<Dim> spline = geometry;
        spline.ControlPoints = coefficients;
        EvaluationBatch batch;
        EXPECT_TRUE(EvaluateParameters(MakeBezierForm(spline), parameters, {}, batch));
        values.middleCols(columns, coefficients.cols()) = batch.Values;
        columns += coefficients.cols();
      };
      evaluate(geometry.ControlPoints);
      for (const SplineField& field : patch.Fields)
      {
        evaluate(field.Coefficients);
      }
      return PointMatrix(values.leftCols(columns));
    },
    patch.Geometry);
}

double WorstDifference(vtkDataObject* coarse, vtkDataObject* fine)
{
  const SplineModel a = DecodePatches(coarse);
  const SplineModel b = DecodePatches(fine);
  EXPECT_EQ(a.Patches.size(), b.Patches.size());
  double worst = 0.0;
  for (std::size_t p = 0; p < a.Patches.size() && p < b.Patches.size(); ++p)
  {
    EXPECT_EQ(a.Patches[p].Id, b.Patches[p].Id);
    EXPECT_EQ(a.Patches[p].Fields.size(), b.Patches[p].Fields.size());
    const PointMatrix x = Sample(a.Patches[p]);
    const PointMatrix y = Sample(b.Patches[p]);
    EXPECT_EQ(x.cols(), y.cols());
    if (x.cols() == y.cols())
    {
      worst = std::max(worst, (x - y).cwiseAbs().maxCoeff() / x.cwiseAbs().maxCoeff());
    }
  }
  return worst;
}

vtkSmartPointer<vtkSelection> SelectCells(const std::vector<vtkIdType>& cells)
{
  vtkNew<vtkIdTypeArray> ids;
  for (const vtkIdType cell : cells)
  {
    ids->InsertNextValue(cell);
  }
  vtkNew<vtkSelectionNode> node;
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetFieldType(vtkSelectionNode::CELL);
  node->SetSelectionList(ids);
  auto selection = vtkSmartPointer<vtkSelection>::New();
  selection->AddNode(node);
  return selection;
}

/// Biquadratic functions with one relation among 82: five lines on a tensor-product mesh (Patrizi,
/// Dokken, CAGD 77 (2020)).
Spline<2> DependentSurface()
{
  const auto u = KnotVector::Create(2, { 0, 0, 0, 1, 2, 3, 6, 8, 9, 10, 10, 10 }).Value;
  const auto v = KnotVector::Create(2, { 0, 0, 0, 1, 2, 4, 6, 7, 8, 8, 8 }).Value;
  Spline<2> surface;
  surface.Space = MakeTensorSpace<2>({ u, v }).Value;
  surface.ControlPoints = PointMatrix::Random(surface.Space->NumFunctions, 3);
  const auto refined = InsertSegments(
    surface, { { 1, 3, 3, 9 }, { 0, 7, 2, 6 }, { 0, 5, 2, 7 }, { 1, 5, 1, 7 }, { 0, 4, 1, 5 } }, 0);
  EXPECT_TRUE(refined) << refined.Status.Message();
  return refined.Value;
}

SplineModel LRModelOf(const Spline<2>& surface)
{
  SplineModel model;
  model.Patches.resize(1);
  model.Patches[0].Geometry = surface;
  return model;
}

class RefineModels : public ::testing::TestWithParam<ModelCase>
{
};
}

TEST_P(RefineModels, MapWeightsAndFieldsStay_PropertyOracle)
{
  const auto grid = Encode(RandomModel(GetParam()));
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  refine->Update();
  // weights up to 2 and several levels of knot insertion: some thousand rounding errors at most
  EXPECT_LE(WorstDifference(grid, GridOf(refine)), 1e-12);
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(),
    grid->GetNumberOfCells() << DecodePatches(grid).Patches[0].Geometry.index() << 1);

  std::vector<double> marks(static_cast<std::size_t>(grid->GetNumberOfCells()), 0.0);
  marks.front() = marks.back() = 1.0;
  AddCellArray(grid, "Mark", marks);
  RefineByArray(refine, "Mark");
  refine->SetLowerThreshold(1.0);
  refine->SetNumberOfRefinements(2);
  refine->Update();
  EXPECT_GT(GridOf(refine)->GetNumberOfCells(), grid->GetNumberOfCells());
  EXPECT_LE(WorstDifference(grid, GridOf(refine)), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(
  vtkSplineRefine, RefineModels, ::testing::ValuesIn(AllModelCases()), NameOf);

TEST(vtkSplineRefine, DegreeElevationKeepsTheMap_PropertyOracle)
{
  const auto grid = ShapeGrid(vtkSplineSource::BALL_SECTOR, 0, { 1, 2, 1 });
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  refine->SetNumberOfRefinements(0);
  refine->SetDegreeElevation(2);
  refine->Update();
  EXPECT_LE(WorstDifference(grid, GridOf(refine)), 1e-14);
  EXPECT_EQ(CellValue(GridOf(refine), "BezierDegrees", 0, 0), 3.0);
  EXPECT_EQ(CellValue(GridOf(refine), "BezierDegrees", 0, 1), 4.0);
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), grid->GetNumberOfCells());
}

TEST(vtkSplineRefine, ThresholdMarksExactlyItsCells_GoldenOracle)
{
  const auto grid = ShapeGrid(vtkSplineSource::SQUARE, 2, { 4, 4, 1 });
  std::vector<double> values(16, 0.0);
  values[5] = 1.0; // lowest value: in
  values[6] = 2.0; // highest value: in
  values[9] = 2.5; // above
  values[10] = std::numeric_limits<double>::quiet_NaN();
  AddCellArray(grid, "Error", values);
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  RefineByArray(refine, "Error");
  refine->SetLowerThreshold(1.0);
  refine->SetUpperThreshold(2.0);
  refine->SetExtension(0);
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 14 + 2 * 4);
  std::set<vtkIdType> split;
  for (vtkIdType child = 0; child < GridOf(refine)->GetNumberOfCells(); ++child)
  {
    for (vtkIdType cell = 0; cell < 16; ++cell)
    {
      if (IsInside(GridOf(refine), child, grid, cell))
      {
        const double value = CellValue(GridOf(refine), "Error", child);
        EXPECT_TRUE(value == values[static_cast<std::size_t>(cell)] ||
          (std::isnan(value) && cell == 10)); // the array passes to the children
        if (CellValue(GridOf(refine), "Level", child) == 1.0)
        {
          split.insert(cell);
        }
      }
    }
  }
  EXPECT_EQ(split, (std::set<vtkIdType>{ 5, 6 }));

  // children of marked elements are marked: the level follows the number of refinements
  refine->SetNumberOfRefinements(3);
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 14 + 2 * 64);
  // ... up to the highest level
  refine->SetMaxLevel(2);
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 14 + 2 * 16);
}

TEST(vtkSplineRefine, AutomaticExtensionBringsNewFunctions_GoldenOracle)
{
  for (int degree = 1; degree <= 5; ++degree)
  {
    const auto grid = ShapeGrid(vtkSplineSource::SQUARE, degree, { 16, 16, 1 });
    std::vector<double> values(256, 0.0);
    values[8 * 16 + 8] = 1.0;
    AddCellArray(grid, "Error", values);
    const auto highestLevel = [&](int extension)
    {
      vtkNew<vtkSplineRefine> refine;
      refine->SetInputData(grid);
      RefineByArray(refine, "Error");
      refine->SetLowerThreshold(0.5);
      refine->SetExtension(extension);
      refine->Update();
      const SplineModel model = DecodePatches(GridOf(refine));
      int level = 0;
      for (const auto& info :
        DescribeFunctions(*std::get<Spline<2>>(model.Patches[0].Geometry).Space))
      {
        level = std::max(level, info.Level);
      }
      return level;
    };
    EXPECT_EQ(highestLevel(-1), 1) << "degree " << degree;
    if (degree >= 4) // 2 rings grow to whole cells: 6 new ones a side; 1 and 0 rings to 4 and 2
    {
      EXPECT_EQ(highestLevel(0), 0) << "degree " << degree;
    }
  }
}

TEST(vtkSplineRefine, GlobalRefinementStaysTensorProduct_PropertyOracle)
{
  auto grid = ShapeGrid(vtkSplineSource::DISC, 3, { 2, 2, 1 });
  std::vector<double> values(static_cast<std::size_t>(grid->GetNumberOfCells()), 0.0);
  values[0] = 1.0; // patch 0 only
  AddCellArray(grid, "Error", values);
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  RefineByArray(refine, "Error");
  refine->SetLowerThreshold(0.5);
  refine->GlobalRefinementOn();
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), grid->GetNumberOfCells() + 3 * 4);
  for (const SplinePatch& patch : DecodePatches(GridOf(refine)).Patches)
  {
    EXPECT_EQ(std::get<Spline<2>>(patch.Geometry).Space->Kind, SpaceKind::Tensor);
  }
  EXPECT_LE(WorstDifference(grid, GridOf(refine)), 1e-14);
}

TEST(vtkSplineRefine, ImplicitFunctionMarksCrossedAndInside_CrossOracle)
{
  const auto grid = ShapeGrid(vtkSplineSource::SQUARE, 1, { 8, 8, 1 }); // cells of side 1/8
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(0.05, 0.0, 0.0); // in the fifth column, negative on the left
  plane->SetNormal(1.0, 0.0, 0.0);
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  refine->SetMode(vtkSplineRefine::IMPLICIT_FUNCTION);
  refine->SetImplicitFunction(plane);
  refine->SetExtension(0);
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 24 + 4 * 40);
  refine->SetImplicitRegion(vtkSplineRefine::CROSSED);
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 56 + 4 * 8);
  // the function is a part of the filter
  plane->SetOrigin(100.0, 0.0, 0.0);
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 64);
  // new elements are sampled again: only the crossed half of the column is split once more
  plane->SetOrigin(0.05, 0.0, 0.0);
  refine->SetNumberOfRefinements(2);
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 56 + 16 + 16 * 4);
}

TEST(vtkSplineRefine, SelectedCellsAreRefined_GoldenOracle)
{
  const auto grid = ShapeGrid(vtkSplineSource::SQUARE, 2, { 4, 4, 1 });
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  refine->SetMode(vtkSplineRefine::SELECTION);
  refine->SetSelectionData(SelectCells({ 0, 15, 7 }));
  refine->SetExtension(0);
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 13 + 3 * 4);
  for (const vtkIdType cell : { 0, 15, 7 })
  {
    int children = 0;
    for (vtkIdType child = 0; child < GridOf(refine)->GetNumberOfCells(); ++child)
    {
      children += IsInside(GridOf(refine), child, grid, cell) ? 1 : 0;
    }
    EXPECT_EQ(children, 4);
  }
  EXPECT_FALSE(GridOf(refine)->GetCellData()->HasArray("vtkInsidedness"));
  // ids that are not there select nothing
  refine->SetSelectionData(SelectCells({ -3, 1000 }));
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 16);
  vtkNew<vtkSelection> nothing;
  refine->SetSelectionData(nothing);
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 16);
}

TEST(vtkSplineRefine, AdmissibleClassGradesLevels_PropertyOracle)
{
  const auto cells = [](int admissible)
  {
    const auto grid = ShapeGrid(vtkSplineSource::SQUARE, 2, { 8, 8, 1 });
    std::vector<double> values(64, 0.0);
    values[27] = 1.0;
    AddCellArray(grid, "Error", values);
    vtkNew<vtkSplineRefine> refine;
    refine->SetInputData(grid);
    RefineByArray(refine, "Error");
    refine->SetLowerThreshold(0.5);
    refine->SetNumberOfRefinements(4);
    refine->SetAdmissibleClass(admissible);
    refine->Update();
    return GridOf(refine)->GetNumberOfCells();
  };
  EXPECT_GT(cells(2), cells(3));
  EXPECT_GE(cells(3), cells(0));
}

TEST(vtkSplineRefine, CollectionsKeepTheirBlocks_GoldenOracle)
{
  auto first = ShapeGrid(vtkSplineSource::SQUARE, 1, { 2, 2, 1 });
  auto second = ShapeGrid(vtkSplineSource::DISC, 2);
  AddCellArray(first, "Tag", { 1.0, 2.0, 3.0, 4.0 });
  const auto input = Collect({ first, second });
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputDataObject(input);
  refine->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(refine->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  ASSERT_EQ(output->GetNumberOfPartitionedDataSets(), 2u);
  auto* square = vtkUnstructuredGrid::SafeDownCast(output->GetPartition(0, 0));
  auto* disc = vtkUnstructuredGrid::SafeDownCast(output->GetPartition(1, 0));
  ASSERT_TRUE(square && disc);
  EXPECT_EQ(square->GetNumberOfCells(), 16);
  EXPECT_EQ(disc->GetNumberOfCells(), 20);
  std::array<int, 5> tags{};
  for (vtkIdType cell = 0; cell < 16; ++cell)
  {
    ++tags[static_cast<std::size_t>(CellValue(square, "Tag", cell))];
  }
  EXPECT_EQ(tags, (std::array<int, 5>{ 0, 4, 4, 4, 4 }));
  // the array marks cells of its own block
  RefineByArray(refine, "Tag");
  refine->SetLowerThreshold(4.0);
  refine->SetExtension(0);
  refine->Update();
  EXPECT_EQ(output->GetPartition(0, 0)->GetNumberOfCells(), 7);
  EXPECT_EQ(output->GetPartition(1, 0)->GetNumberOfCells(), 5);
}

TEST(vtkSplineRefine, BezierGridsAreSubdividedGlobally_GoldenOracle)
{
  auto grid = ShapeGrid(vtkSplineSource::DISC, 2, { 2, 2, 1 });
  const vtkIdType cells = grid->GetNumberOfCells();
  grid->GetFieldData()->Initialize();
  for (const char* name : { "ElementId", "Level", "ParametricBounds", "PatchBasis" })
  {
    grid->GetCellData()->RemoveArray(name);
  }
  std::vector<double> values(static_cast<std::size_t>(cells), 1.0);
  AddCellArray(grid, "Error", values);
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 4 * cells);
  // each patch had 5 x 5 points, glued they become 9 x 9
  EXPECT_EQ(grid->GetNumberOfPoints(), 5 * 25);
  EXPECT_EQ(GridOf(refine)->GetNumberOfPoints(), 5 * 81);
  RefineByArray(refine, "Error");
  ExpectFailure(refine, ErrorCode::DimensionMismatch, "all together");
  refine->GlobalRefinementOn();
  refine->Update();
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 4 * cells);
}

TEST(vtkSplineRefine, EveryFailureIsReachable)
{
  auto grid = ShapeGrid(vtkSplineSource::SQUARE, 2, { 2, 2, 1 });
  AddCellArray(grid, "Error", { 1.0, 0.0, 0.0, 0.0 });
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  RefineByArray(refine, "NoSuchArray");
  ExpectFailure(refine, ErrorCode::InvalidParameter, "no such cell array");
  RefineByArray(refine, "BezierDegrees");
  ExpectFailure(refine, ErrorCode::InvalidParameter, "one value a cell");
  refine->SetMode(vtkSplineRefine::IMPLICIT_FUNCTION);
  ExpectFailure(refine, ErrorCode::InvalidParameter, "implicit function");
  refine->SetMode(vtkSplineRefine::SELECTION);
  ExpectFailure(refine, ErrorCode::InvalidParameter, "set the selection");
  auto points = SelectCells({ 0 });
  points->GetNode(0u)->SetFieldType(vtkSelectionNode::POINT);
  refine->SetSelectionData(points);
  ExpectFailure(refine, ErrorCode::InvalidParameter, "must select cells");
  auto query = SelectCells({ 0 });
  query->GetNode(0u)->SetContentType(vtkSelectionNode::QUERY);
  refine->SetSelectionData(query);
  ExpectFailure(refine, ErrorCode::InvalidParameter, "freeze the selection");
  refine->SetMode(vtkSplineRefine::UNIFORM);
  refine->SetDegreeElevation(8);
  ExpectFailure(refine, ErrorCode::InvalidDegree, "patch 0");
  refine->SetDegreeElevation(0);
  refine->SetAdmissibleClass(1);
  ExpectFailure(refine, ErrorCode::InvalidParameter, "admissible class");
  refine->SetAdmissibleClass(0);
  RefineByArray(refine, "Error");
  refine->SetLowerThreshold(0.5);
  refine->Update();
  vtkNew<vtkSplineRefine> second;
  second->SetInputDataObject(GridOf(refine));
  second->SetDegreeElevation(1);
  ExpectFailure(second, ErrorCode::DimensionMismatch, "hierarchical");
}

TEST(vtkSplineRefine, AbortLeavesAnEmptyOutput_PropertyOracle)
{
  class Stop : public vtkCommand
  {
  public:
    static Stop* New() { return new Stop; }
    void Execute(vtkObject* caller, unsigned long, void*) override
    {
      static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
    }
  };
  vtkNew<vtkSplineRefine> refine;
  vtkNew<Stop> stop;
  refine->AddObserver(vtkCommand::ProgressEvent, stop);
  refine->SetInputData(ShapeGrid(vtkSplineSource::DISC));
  refine->Update();
  EXPECT_EQ(refine->GetErrorCode(), vtkErrorCode::UserError + static_cast<int>(ErrorCode::Aborted));
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 0);
}

TEST(vtkSplineRefine, BadInputIsRefused)
{
  vtkNew<vtkSplineRefine> filter;
  ExpectBadInputIsRefused(filter);
}

namespace
{
/// Cells and functions of a biquadratic square of 8 x 8 elements after its cell (3, 3) is refined.
std::array<int, 2> CountsOfLR(vtkSplineRefine* refine)
{
  const auto grid = ShapeGrid(vtkSplineSource::SQUARE, 2, { 8, 8, 1 });
  std::vector<double> values(64, 0.0);
  values[27] = 1.0;
  AddCellArray(grid, "Error", values);
  refine->SetInputData(grid);
  RefineByArray(refine, "Error");
  refine->SetLowerThreshold(0.5);
  refine->SetLocalSpace(vtkSplineRefine::LOCALLY_REFINED);
  refine->Update();
  EXPECT_LE(WorstDifference(grid, GridOf(refine)), 1e-13);
  const SplineModel model = DecodePatches(GridOf(refine));
  const auto& space = *std::get<Spline<2>>(model.Patches[0].Geometry).Space;
  EXPECT_EQ(space.Kind, SpaceKind::LocallyRefined);
  return { static_cast<int>(GridOf(refine)->GetNumberOfCells()), space.NumFunctions };
}
}

TEST(vtkSplineRefine, VolumesBecomeLRAndStayTheMap_CrossOracle)
{
  const auto grid = ShapeGrid(vtkSplineSource::CUBE, 2, { 4, 4, 4 });
  std::vector<double> values(64, 0.0);
  values[21] = 1.0; // the cell (1, 1, 1)
  AddCellArray(grid, "Error", values);
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  RefineByArray(refine, "Error");
  refine->SetLowerThreshold(0.5);
  refine->SetLocalSpace(vtkSplineRefine::LOCALLY_REFINED);
  refine->Update();
  // three rectangles across 4 x 4 elements of the 4 x 4 x 4, crossing
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 125);
  EXPECT_LE(WorstDifference(grid, GridOf(refine)), 1e-13);
  refine->SetLRStrategy(vtkSplineRefine::MINIMUM_SPAN);
  refine->Update();
  // the smallest support is the corner's 2 x 2 x 2 elements: 1 becomes 8, 3 become 4, 3 become 2
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), 64 - 7 + 8 + 3 * 4 + 3 * 2);
  const SplineModel model = DecodePatches(GridOf(refine));
  const auto& volume = std::get<Spline<3>>(model.Patches[0].Geometry);
  EXPECT_EQ(volume.Space->Kind, SpaceKind::LocallyRefined);
  EXPECT_LE(WorstDifference(grid, GridOf(refine)), 1e-13);
  // it stays LR, also when it is refined everywhere
  vtkNew<vtkSplineRefine> again;
  again->SetInputData(GridOf(refine));
  again->Update();
  const SplineModel finer = DecodePatches(GridOf(again));
  EXPECT_EQ(std::get<Spline<3>>(finer.Patches[0].Geometry).Space->Kind, SpaceKind::LocallyRefined);
  EXPECT_GE(GridOf(again)->GetNumberOfCells(), 8 * GridOf(refine)->GetNumberOfCells());
  EXPECT_LE(WorstDifference(grid, GridOf(again)), 1e-13);
}

TEST(vtkSplineRefine, LinesOfLRPatchesFollowTheOptions_GoldenOracle)
{
  using Pair = std::array<int, 2>;
  vtkNew<vtkSplineRefine> refine;
  EXPECT_EQ(CountsOfLR(refine)[0], 64 + 11); // two lines across 5 elements, crossing
  refine->SetLRStrategy(vtkSplineRefine::MINIMUM_SPAN);
  EXPECT_EQ(CountsOfLR(refine)[0], 64 + 7);
  refine->SetLRStrategy(vtkSplineRefine::RESTRICTED_MESH);
  EXPECT_EQ(CountsOfLR(refine)[0], 64 + 7); // of the function's 3 x 3 spans those of the element
  refine->SetLRStrategy(vtkSplineRefine::STRUCTURED_MESH);
  refine->SetLRTarget(vtkSplineRefine::FUNCTIONS);
  EXPECT_EQ(CountsOfLR(refine)[0], 64 + 27); // 3 x 3 elements into quarters
  refine->SetLRStrategy(vtkSplineRefine::FULL_SPAN);
  refine->SetLRTarget(vtkSplineRefine::ELEMENTS);
  for (const int directions :
    { vtkSplineRefine::ALTERNATING, vtkSplineRefine::FIRST, vtkSplineRefine::SECOND })
  {
    refine->SetLRDirections(directions);
    EXPECT_EQ(CountsOfLR(refine), (Pair{ 64 + 5, 100 + 3 }));
  }
  // the line of the second refinement goes the other way, or halves the two halves again
  refine->SetNumberOfRefinements(2);
  refine->SetLRDirections(vtkSplineRefine::ALTERNATING);
  refine->SetLRStrategy(vtkSplineRefine::MINIMUM_SPAN);
  refine->KeepIndependentOn();
  const Pair alternating = CountsOfLR(refine);
  refine->SetLRDirections(vtkSplineRefine::SECOND);
  const Pair one = CountsOfLR(refine);
  EXPECT_NE(alternating, one);
  EXPECT_GT(alternating[1], 101);
  EXPECT_GT(one[1], 101);
}

TEST(vtkSplineRefine, LRPatchesStayLR_PropertyOracle)
{
  const auto grid = Encode(LRModelOf(DependentSurface()));
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  for (const bool global : { false, true })
  {
    refine->SetGlobalRefinement(global);
    for (const int strategy : { vtkSplineRefine::FULL_SPAN, vtkSplineRefine::STRUCTURED_MESH })
    {
      refine->SetLRStrategy(strategy);
      refine->Update();
      EXPECT_GT(GridOf(refine)->GetNumberOfCells(), 2 * grid->GetNumberOfCells());
      EXPECT_LE(WorstDifference(grid, GridOf(refine)), 1e-12);
    }
  }
}

namespace
{
template <typename Array, typename Value>
void AddColumn(vtkTable* table, const char* name, const std::vector<Value>& values)
{
  vtkNew<Array> column;
  column->SetName(name);
  for (const Value& value : values)
  {
    column->InsertNextValue(value);
  }
  table->AddColumn(column);
}

/// Lines in the plane of the parameters, from and to (u, v).
vtkSmartPointer<vtkPolyData> Lines(const std::vector<std::array<double, 4>>& ends)
{
  auto lines = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  lines->SetPoints(points);
  lines->AllocateEstimate(2, 2);
  for (const auto& end : ends)
  {
    const vtkIdType ids[2] = { points->InsertNextPoint(end[0], end[1], 0.0),
      points->InsertNextPoint(end[2], end[3], 0.0) };
    lines->InsertNextCell(VTK_LINE, 2, ids);
  }
  return lines;
}

/// u = 1/8 from v = 0 to 3/4, twice the line v = 1/2 from 0 to 1/2.
vtkSmartPointer<vtkTable> TwoSegments()
{
  auto table = vtkSmartPointer<vtkTable>::New();
  AddColumn<vtkIntArray>(table, "direction", std::vector<int>{ 1, 0 });
  AddColumn<vtkDoubleArray>(table, "Value", std::vector<double>{ 0.5, 0.125 });
  AddColumn<vtkStringArray>(table, "START", std::vector<vtkStdString>{ "0", "0" });
  AddColumn<vtkDoubleArray>(table, "End", std::vector<double>{ 0.75, 0.75 });
  AddColumn<vtkIntArray>(table, "Multiplicity", std::vector<int>{ 2, 1 });
  return table;
}
}

/// The functions are those of the kernel for the same segments; positions and fields stay.
TEST(vtkSplineRefine, SegmentsBecomeMeshLines_CrossOracle)
{
  auto grid = ShapeGrid(vtkSplineSource::SQUARE, 2, { 4, 4, 1 });
  const auto decoded = DecodeSplineModel(grid, 0);
  const auto& square = std::get<Spline<2>>(decoded->Patches[0].Geometry);
  const auto expected =
    InsertSegments(square, { { 0, 0.125, 0.0, 0.75, 1 }, { 1, 0.5, 0.0, 0.75, 2 } }, 0);
  ASSERT_TRUE(expected) << expected.Status.Message();
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  refine->SetMode(vtkSplineRefine::SEGMENTS);
  auto lines = Lines({ { 0.125, 0.75, 0.125, 0.0 }, { 0.0, 0.5, 0.75, 0.5 } });
  vtkNew<vtkIntArray> multiplicity;
  multiplicity->SetName("Multiplicity");
  multiplicity->InsertNextValue(1);
  multiplicity->InsertNextValue(2);
  lines->GetCellData()->AddArray(multiplicity);
  const std::vector<vtkSmartPointer<vtkDataObject>> inputs{ TwoSegments(), lines };
  for (const auto& segments : inputs)
  {
    refine->SetSegmentsData(segments);
    refine->Update();
    const auto model = DecodeSplineModel(GridOf(refine), 0);
    ASSERT_EQ(model->Patches.size(), 1u);
    const auto& refined = std::get<Spline<2>>(model->Patches[0].Geometry);
    EXPECT_TRUE(refined.Space->LocallyRefined->Basis == expected->Space->LocallyRefined->Basis);
    EXPECT_LE((refined.ControlPoints.leftCols(2) - expected->ControlPoints.leftCols(2))
                .cwiseAbs()
                .maxCoeff(),
      1e-14);
  }
}

/// Five patches: only the one that is named changes, and it must be named.
TEST(vtkSplineRefine, SegmentsNameTheirPatch_GoldenOracle)
{
  auto grid = ShapeGrid(vtkSplineSource::DISC, 2, { 4, 4, 1 });
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  refine->SetMode(vtkSplineRefine::SEGMENTS);
  auto table = TwoSegments();
  refine->SetSegmentsData(table);
  ExpectFailure(refine, ErrorCode::InvalidParameter, "has 5 patches; say of which");
  const int named = DecodeSplineModel(grid, 0)->Patches[1].Id;
  AddColumn<vtkIntArray>(table, "PatchId", std::vector<int>{ named, named });
  table->Modified();
  refine->Update();
  const auto model = DecodeSplineModel(GridOf(refine), 0);
  ASSERT_EQ(model->Patches.size(), 5u);
  EXPECT_EQ(std::get<Spline<2>>(model->Patches[0].Geometry).Space->Kind, SpaceKind::Tensor);
  EXPECT_EQ(std::get<Spline<2>>(model->Patches[1].Geometry).Space->Kind, SpaceKind::LocallyRefined);
  table->SetValueByName(0, "PatchId", 77);
  table->Modified();
  ExpectFailure(refine, ErrorCode::InvalidParameter, "no patch 77");
}

TEST(vtkSplineRefine, EveryFailureOfSegmentsIsReachable)
{
  auto grid = ShapeGrid(vtkSplineSource::SQUARE, 2, { 4, 4, 1 });
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  refine->SetMode(vtkSplineRefine::SEGMENTS);
  ExpectFailure(refine, ErrorCode::InvalidParameter, "set a table or lines");
  const auto fail = [&](vtkDataObject* segments, ErrorCode code, const char* words)
  {
    refine->SetSegmentsData(segments);
    ExpectFailure(refine, code, words);
  };
  fail(Lines({}), ErrorCode::EmptyInput, "holds none");
  fail(Lines({ { 0.1, 0.0, 0.2, 1.0 } }), ErrorCode::InvalidParameter, "neither parameter");
  fail(Lines({ { 0.1, 0.5, 0.1, 0.5 } }), ErrorCode::InvalidParameter, "no length");
  fail(Lines({ { 0.1, 0.0, 0.1, 0.3 } }), ErrorCode::InvalidTopology, "no mesh line for it to end");
  fail(Lines({ { 1.1, 0.0, 1.1, 1.0 } }), ErrorCode::OutsideDomain, "outside the domain");
  auto table = TwoSegments();
  table->RemoveColumnByName("End");
  fail(table, ErrorCode::InvalidParameter, "no column End");
  table = TwoSegments();
  table->SetValueByName(1, "START", "far");
  fail(table, ErrorCode::InvalidParameter, "row 1: Start is no number");
  table = TwoSegments();
  table->RemoveColumnByName("direction");
  AddColumn<vtkDoubleArray>(table, "Direction", std::vector<double>{ 0.5, 0.0 });
  fail(table, ErrorCode::InvalidParameter, "row 0: Direction is no whole number");
  refine->SetMaximumFunctions(36);
  fail(TwoSegments(), ErrorCode::TooLarge, "more than 36 functions");
  refine->SetInputData(ShapeGrid(vtkSplineSource::CUBE, 2, { 2, 2, 2 }));
  fail(TwoSegments(), ErrorCode::DimensionMismatch, "only surfaces");
}

TEST(vtkSplineRefine, DependenceIsResolvedWithoutRefinement_CrossOracle)
{
  const auto grid = Encode(LRModelOf(DependentSurface()));
  const auto verdict = [](vtkUnstructuredGrid* data)
  {
    const SplineModel model = DecodePatches(data);
    return DecideDependence(*std::get<Spline<2>>(model.Patches[0].Geometry).Space)->Verdict;
  };
  EXPECT_EQ(verdict(grid), LRVerdict::Dependent);
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  refine->SetNumberOfRefinements(0);
  refine->Update();
  EXPECT_EQ(verdict(GridOf(refine)), LRVerdict::Dependent);
  EXPECT_EQ(GridOf(refine)->GetNumberOfCells(), grid->GetNumberOfCells());
  refine->KeepIndependentOn();
  refine->Update();
  EXPECT_EQ(verdict(GridOf(refine)), LRVerdict::Independent);
  EXPECT_LE(WorstDifference(grid, GridOf(refine)), 1e-13);
}
