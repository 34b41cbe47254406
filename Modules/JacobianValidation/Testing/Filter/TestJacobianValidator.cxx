// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/JacobianValidation/vtkJacobianValidator.h>
#include <knotwork/SplineGrid/vtkSplineRefine.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>

#include "vtkCellData.h"
#include "vtkCellSizeFilter.h"
#include "vtkCellType.h"
#include "vtkCellValidator.h"
#include "vtkCommand.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkIdList.h"
#include "vtkIntArray.h"
#include "vtkMeshQuality.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkSphere.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace
{
using Points = std::vector<std::array<double, 3>>;

vtkSmartPointer<vtkUnstructuredGrid> OneCell(int type, const Points& coordinates)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIdList> ids;
  for (const auto& x : coordinates)
  {
    ids->InsertNextId(points->InsertNextPoint(x.data()));
  }
  grid->SetPoints(points);
  grid->Allocate(1);
  grid->InsertNextCell(type, ids);
  return grid;
}

vtkUnstructuredGrid* Grid(vtkAlgorithm* filter, int port = 0)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(port));
}

double CellValue(vtkAlgorithm* filter, const char* array, vtkIdType cell = 0)
{
  vtkDataArray* values = Grid(filter)->GetCellData()->GetArray(array);
  EXPECT_TRUE(values) << array;
  return values ? values->GetComponent(cell, 0) : NAN;
}

vtkVariant AllCells(vtkAlgorithm* filter, const char* column)
{
  auto* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  return table->GetValueByName(table->GetNumberOfRows() - 1, column);
}

/// A biquadratic Bezier quadrilateral in VTK's order: the unit square with its middle at (x, y).
vtkSmartPointer<vtkUnstructuredGrid> BiquadraticSquare(double x, double y)
{
  return OneCell(VTK_BEZIER_QUADRILATERAL,
    { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0.5, 0, 0 }, { 1, 0.5, 0 },
      { 0.5, 1, 0 }, { 0, 0.5, 0 }, { x, y, 0 } });
}

class Errors : public vtkCommand
{
public:
  static Errors* New() { return new Errors; }
  void Execute(vtkObject*, unsigned long, void* text) override
  {
    this->Lines.emplace_back(static_cast<const char*>(text));
  }
  std::vector<std::string> Lines;
};
}

TEST(JacobianValidator, FoldedQuadThatVtkCallsValid_ExactOracle)
{
  const auto folded = BiquadraticSquare(2.5, 0.5);
  vtkNew<vtkCellValidator> vtksOwn; // what this filter is there for
  vtksOwn->SetInputData(folded);
  vtksOwn->Update();
  EXPECT_EQ(
    vtksOwn->GetUnstructuredGridOutput()->GetCellData()->GetArray("ValidityState")->GetTuple1(0),
    0.0);

  vtkNew<vtkJacobianValidator> filter;
  filter->SetInputData(folded);
  filter->Update();
  EXPECT_EQ(CellValue(filter, "JacobianVerdict"), -1.0);
  EXPECT_EQ(filter->GetVerdict(), -1);
  EXPECT_EQ(AllCells(filter, "Verdict").ToString(), "invalid");
  EXPECT_EQ(AllCells(filter, "InvalidCells").ToInt(), 1);
  // by hand: x = u + 2 b(u) b(v), y = v with b = 2 t (1 - t), so det J = 1 + 4 (1 - 2 u) b(v),
  // smallest at u = 1, v = 1/2: -1
  EXPECT_LE(CellValue(filter, "JacobianMinLower"), -1.0);
  vtkUnstructuredGrid* witnesses = Grid(filter, 1);
  ASSERT_EQ(witnesses->GetNumberOfCells(), 2);
  EXPECT_EQ(witnesses->GetCellType(0), VTK_VERTEX);
  EXPECT_EQ(witnesses->GetCellType(1), VTK_QUAD);
  const double* t = witnesses->GetPointData()->GetArray("LocalParameters")->GetTuple3(0);
  const auto b = [](double s) { return 2 * s * (1 - s); };
  EXPECT_LE(1 + 4 * (1 - 2 * t[0]) * b(t[1]), 0.0);
  EXPECT_NEAR(witnesses->GetPoint(0)[0], t[0] + 2 * b(t[0]) * b(t[1]), 1e-14);
  EXPECT_NEAR(witnesses->GetPoint(0)[1], t[1], 1e-14);
}

TEST(JacobianValidator, BoundsReachTheirGap_ExactOracle)
{
  // as above with the middle at 3/4: det J = 1 + (1 - 2 u) b(v) / 2, between 3/4 and 5/4
  vtkNew<vtkJacobianValidator> filter;
  filter->SetInputData(BiquadraticSquare(0.75, 0.5));
  filter->SetRelativeGap(1e-9);
  filter->BoundMaximumOn();
  filter->Update();
  EXPECT_EQ(CellValue(filter, "JacobianVerdict"), 1.0);
  EXPECT_LE(CellValue(filter, "JacobianMinLower"), 0.75);
  EXPECT_GE(CellValue(filter, "JacobianMinUpper"), 0.75);
  EXPECT_NEAR(CellValue(filter, "JacobianMinLower"), 0.75, 1e-9);
  EXPECT_NEAR(CellValue(filter, "JacobianMinUpper"), 0.75, 1e-9);
  EXPECT_NEAR(CellValue(filter, "JacobianMaxLower"), 1.25, 2e-9);
  EXPECT_NEAR(CellValue(filter, "JacobianMaxUpper"), 1.25, 2e-9);
}

TEST(JacobianValidator, EveryKindOfCell_ExactOracle)
{
  // det J by hand: of the unit cells 1
  struct Case
  {
    int Type;
    Points Coordinates;
  };
  const Points square{ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  const Points triangle{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
  const Points tetrahedron{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  Points cube = square;
  for (const auto& x : square)
  {
    cube.push_back({ x[0], x[1], 1.0 });
  }
  Points wedge = triangle;
  for (const auto& x : triangle)
  {
    wedge.push_back({ x[0], x[1], 1.0 });
  }
  for (const Case& c : { Case{ VTK_QUAD, square }, Case{ VTK_TRIANGLE, triangle },
         Case{ VTK_TETRA, tetrahedron }, Case{ VTK_HEXAHEDRON, cube }, Case{ VTK_WEDGE, wedge },
         Case{ VTK_BEZIER_TRIANGLE, triangle }, Case{ VTK_LAGRANGE_HEXAHEDRON, cube },
         Case{ VTK_LAGRANGE_WEDGE, wedge }, Case{ VTK_BEZIER_TETRAHEDRON, tetrahedron } })
  {
    SCOPED_TRACE(c.Type);
    vtkNew<vtkJacobianValidator> filter;
    filter->SetInputData(OneCell(c.Type, c.Coordinates));
    filter->Update();
    EXPECT_EQ(CellValue(filter, "JacobianVerdict"), 1.0);
    EXPECT_LE(CellValue(filter, "JacobianMinLower"), 1.0);
    EXPECT_GE(CellValue(filter, "JacobianMaxUpper"), 1.0);
    EXPECT_NEAR(CellValue(filter, "JacobianMinLower"), 1.0, 1e-13);
    EXPECT_EQ(Grid(filter, 1)->GetNumberOfCells(), 0);

    Points mirrored = c.Coordinates;
    for (auto& x : mirrored)
    {
      x[0] = -x[0];
    }
    filter->SetInputData(OneCell(c.Type, mirrored));
    filter->Update();
    EXPECT_EQ(CellValue(filter, "JacobianVerdict"), -1.0);
    EXPECT_EQ(CellValue(filter, "JacobianReversed"), 1.0);
    EXPECT_EQ(AllCells(filter, "Verdict").ToString(), "reversed");
  }
}

TEST(JacobianValidator, SurfaceInSpace_ExactOracle)
{
  vtkNew<vtkJacobianValidator> filter; // a saddle: |S_u x S_v|^2 = 1 + u^2 + v^2
  filter->SetInputData(OneCell(VTK_QUAD, { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 1 }, { 0, 1, 0 } }));
  filter->SetRelativeGap(1e-6);
  filter->BoundMaximumOn();
  filter->Update();
  EXPECT_EQ(CellValue(filter, "JacobianVerdict"), 1.0);
  EXPECT_NEAR(CellValue(filter, "JacobianMinLower"), 1.0, 1e-6);
  EXPECT_NEAR(CellValue(filter, "JacobianMaxUpper"), std::sqrt(3.0), 1e-5);
}

void Append(vtkUnstructuredGrid* grid, int type, const Points& coordinates)
{
  vtkNew<vtkIdList> ids;
  for (const auto& x : coordinates)
  {
    ids->InsertNextId(grid->GetPoints()->InsertNextPoint(x.data()));
  }
  grid->InsertNextCell(type, ids);
}

TEST(JacobianValidator, PlanarCellsBesideOthersAreWhatTheyAreAlone_ExactOracle)
{
  // a clockwise square, a cube, a square turned up at a corner; then a square over half of the
  // cube's place, which is another map
  const auto grid = OneCell(VTK_QUAD, { { 5, 5, 0 }, { 5, 6, 0 }, { 6, 6, 0 }, { 6, 5, 0 } });
  Append(grid, VTK_HEXAHEDRON,
    { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 },
      { 0, 1, 1 } });
  Append(grid, VTK_QUAD, { { 3, 0, 0 }, { 3, 1, 0 }, { 4, 1, 0 }, { 4, 0, 1 } });
  Append(grid, VTK_QUAD, { { 0, 0, 0.5 }, { 2, 0, 0.5 }, { 2, 1, 0.5 }, { 0, 1, 0.5 } });
  vtkNew<vtkJacobianValidator> filter;
  filter->SetInputData(grid);
  filter->Update();
  const double verdicts[] = { -1, 1, 1, 1 };
  const double measures[] = { -1, 1, 0, 2 };
  for (vtkIdType cell = 0; cell < 4; ++cell)
  {
    SCOPED_TRACE(cell);
    EXPECT_EQ(CellValue(filter, "JacobianVerdict", cell), verdicts[cell]);
    EXPECT_EQ(CellValue(filter, "JacobianReversed", cell), cell == 0 ? 1.0 : 0.0);
    if (cell != 2)
    {
      EXPECT_NEAR(CellValue(filter, "CellMeasure", cell), measures[cell], 1e-14);
    }
  }
  EXPECT_EQ(AllCells(filter, "Verdict").ToString(), "invalid"); // of both orientations
  EXPECT_EQ(AllCells(filter, "Injective").ToString(), "injective");
  Append(grid, VTK_QUAD, { { 1, 0, 0.5 }, { 3, 0, 0.5 }, { 3, 1, 0.5 }, { 1, 1, 0.5 } });
  filter->SetInputData(grid);
  filter->Modified();
  filter->Update();
  EXPECT_EQ(AllCells(filter, "Injective").ToString(), "not_injective");
}

TEST(JacobianValidator, ShapesOfTheSource_PropertyOracle)
{
  // Every shape is valid; the poles and axes of some are degenerate and nothing else.
  vtkNew<vtkSplineSource> source;
  for (int shape = source->GetShapeMinValue(); shape <= source->GetShapeMaxValue(); ++shape)
  {
    source->SetShape(shape);
    source->SetSize(2.0, 2.0, 2.0); // plates are larger than their hole
    SCOPED_TRACE(source->GetShape());
    vtkNew<vtkSplineRefine> refine;
    refine->SetInputConnection(source->GetOutputPort());
    vtkNew<vtkJacobianValidator> filter;
    filter->SetInputConnection(refine->GetOutputPort());
    filter->Update();
    EXPECT_EQ(AllCells(filter, "Verdict").ToString(), "valid");
    EXPECT_EQ(AllCells(filter, "UndecidedCells").ToInt(), 0);
    EXPECT_GT(AllCells(filter, "JacobianMaxLower").ToDouble(), 0.0);
  }
}

TEST(JacobianValidator, GlobalInjectivity_ExactOracle)
{
  // two unit squares, each a patch: side by side, apart, and one over the other
  const auto two = [](double shift)
  {
    auto grid = OneCell(VTK_QUAD, { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } });
    vtkNew<vtkIdList> ids;
    for (const auto& x :
      Points{ { shift, 0, 0 }, { shift + 1, 0, 0 }, { shift + 1, 1, 0 }, { shift, 1, 0 } })
    {
      ids->InsertNextId(grid->GetPoints()->InsertNextPoint(x.data()));
    }
    grid->InsertNextCell(VTK_QUAD, ids);
    vtkNew<vtkIntArray> patches;
    patches->SetName("PatchId");
    patches->InsertNextValue(3);
    patches->InsertNextValue(7);
    grid->GetCellData()->AddArray(patches);
    return grid;
  };
  vtkNew<vtkJacobianValidator> filter;
  const auto verdict = [&](double shift)
  {
    filter->SetInputData(two(shift));
    filter->Update();
    EXPECT_EQ(filter->GetVerdict(), 1); // each cell is valid
    return AllCells(filter, "Injective").ToString();
  };
  EXPECT_EQ(verdict(1.0), "injective");
  EXPECT_EQ(AllCells(filter, "Interfaces").ToInt(), 1);
  EXPECT_EQ(verdict(1.5), "injective");
  EXPECT_EQ(AllCells(filter, "Interfaces").ToInt(), 0);
  EXPECT_EQ(verdict(1.0 + 1e-9), "undecided");
  EXPECT_EQ(AllCells(filter, "InterfaceGaps").ToInt(), 1);
  EXPECT_NEAR(AllCells(filter, "LargestGap").ToDouble(), 1e-9, 1e-12);
  EXPECT_EQ(verdict(0.5), "not_injective");
  vtkUnstructuredGrid* witnesses = Grid(filter, 1);
  ASSERT_EQ(witnesses->GetNumberOfCells(), 2);
  for (vtkIdType i = 0; i < 2; ++i)
  {
    EXPECT_EQ(witnesses->GetCellData()->GetArray("Kind")->GetTuple1(i),
      static_cast<double>(vtkJacobianValidator::OVERLAP));
  }
  for (int d = 0; d < 3; ++d)
  {
    EXPECT_NEAR(witnesses->GetPoint(0)[d], witnesses->GetPoint(1)[d], 1e-9);
  }
  EXPECT_NE(witnesses->GetCellData()->GetArray("PatchId")->GetTuple1(0),
    witnesses->GetCellData()->GetArray("PatchId")->GetTuple1(1));
}

TEST(JacobianValidator, InjectivityOfSourcesAndHierarchies_PropertyOracle)
{
  vtkNew<vtkSplineSource> source;
  source->SetShapeName("AnnulusSector");
  source->SetElements(4, 4, 1);
  vtkNew<vtkSphere> ball;
  ball->SetCenter(1.0, 0.0, 0.0);
  ball->SetRadius(0.2);
  vtkNew<vtkSplineRefine> refine; // hanging nodes
  refine->SetInputConnection(source->GetOutputPort());
  refine->SetMode(vtkSplineRefine::IMPLICIT_FUNCTION);
  refine->SetImplicitFunction(ball);
  refine->SetNumberOfRefinements(2);
  vtkNew<vtkJacobianValidator> filter;
  filter->SetInputConnection(refine->GetOutputPort());
  filter->Update();
  EXPECT_GT(AllCells(filter, "Cells").ToInt(), 16);
  EXPECT_EQ(AllCells(filter, "Injective").ToString(), "injective");
  source->SetAngle(360.0);
  filter->Update();
  EXPECT_EQ(AllCells(filter, "Injective").ToString(), "injective_up_to_seam");
  source->SetShapeName("CylinderSurface");
  filter->Update();
  EXPECT_EQ(AllCells(filter, "Injective").ToString(), "not_applicable");
}

TEST(JacobianValidator, AreaAndQualityThatVtkGetsWrong_ExactOracle)
{
  const double exact = std::acos(-1.0) / 4.0 * (2.0 * 2.0 - 1.0); // a quarter annulus, 2.356
  vtkNew<vtkSplineSource> source;
  source->SetShapeName("AnnulusSector");
  source->SetInnerRadius(1.0);
  source->SetOuterRadius(2.0);
  vtkNew<vtkCellSizeFilter> vtksArea;
  vtksArea->SetInputConnection(source->GetOutputPort());
  vtksArea->Update();
  auto* sized = vtkDataSet::SafeDownCast(vtksArea->GetOutputDataObject(0));
  EXPECT_GT(std::abs(sized->GetCellData()->GetArray("Area")->GetTuple1(0) - exact), 0.1);
  vtkNew<vtkMeshQuality> vtksQuality;
  vtksQuality->SetInputConnection(source->GetOutputPort());
  vtksQuality->SetQuadQualityMeasureToScaledJacobian();
  vtksQuality->Update();
  EXPECT_EQ(vtksQuality->GetOutput()->GetCellData()->GetArray("Quality")->GetTuple1(0), 0.0);

  vtkNew<vtkJacobianValidator> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->Update();
  EXPECT_NEAR(CellValue(filter, "CellMeasure"), exact, 1e-12 * exact);
  EXPECT_GT(CellValue(filter, "CellMeasureError"), 0.0);
  EXPECT_LE(CellValue(filter, "CellMeasureError"), 2e-12 * exact);
  EXPECT_EQ(AllCells(filter, "MeasureError").ToDouble(), CellValue(filter, "CellMeasureError"));
  EXPECT_NEAR(AllCells(filter, "Measure").ToDouble(), exact, 1e-12 * exact);
  // radii and circles meet at right angles
  EXPECT_NEAR(CellValue(filter, "ScaledJacobianMin"), 1.0, 1e-12);
  EXPECT_NEAR(AllCells(filter, "ScaledJacobianMean").ToDouble(), 1.0, 1e-12);
}

TEST(JacobianValidator, MeasuresAndSamplesAreChosen_ExactOracle)
{
  // a moved middle changes nothing at the corners of a square, and skews what lies between
  vtkNew<vtkJacobianValidator> filter;
  filter->SetInputData(BiquadraticSquare(0.6, 0.55));
  filter->SetSamplesPerEdge(2);
  filter->Update();
  EXPECT_NEAR(CellValue(filter, "ScaledJacobianMin"), 1.0, 1e-14);
  double before = 1.0;
  for (const int samples : { 3, 5, 9 }) // each holds the samples of the one before
  {
    filter->SetSamplesPerEdge(samples);
    filter->Update();
    EXPECT_LE(CellValue(filter, "ScaledJacobianMin"), before);
    EXPECT_LT(CellValue(filter, "ScaledJacobianMin"), 0.999);
    before = CellValue(filter, "ScaledJacobianMin");
  }
  filter->MeasuresOff();
  filter->Update();
  EXPECT_EQ(Grid(filter)->GetCellData()->GetArray("ScaledJacobianMin"), nullptr);
  EXPECT_EQ(Grid(filter)->GetCellData()->GetArray("CellMeasure"), nullptr);
  EXPECT_EQ(Grid(filter)->GetCellData()->GetArray("CellMeasureError"), nullptr);
  EXPECT_EQ(filter->GetVerdict(), 1);
}

TEST(JacobianValidator, CollectionsKeepTheirStructure_PropertyOracle)
{
  vtkNew<vtkPartitionedDataSetCollection> collection;
  for (unsigned int b = 0; b < 3; ++b)
  {
    vtkNew<vtkPartitionedDataSet> block;
    block->SetPartition(0, BiquadraticSquare(b == 1 ? 2.5 : 0.5, 0.5));
    vtkNew<vtkIntArray> ids;
    ids->SetName("PatchId");
    ids->InsertNextValue(static_cast<int>(10 + b));
    block->GetPartition(0)->GetCellData()->AddArray(ids);
    collection->SetPartitionedDataSet(b, block);
  }
  vtkNew<vtkJacobianValidator> filter;
  filter->SetInputData(collection);
  filter->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  ASSERT_EQ(output->GetNumberOfPartitionedDataSets(), 3u);
  for (unsigned int b = 0; b < 3; ++b)
  {
    vtkDataArray* verdict = output->GetPartition(b, 0)->GetCellData()->GetArray("JacobianVerdict");
    ASSERT_TRUE(verdict);
    EXPECT_EQ(verdict->GetTuple1(0), b == 1 ? -1.0 : 1.0);
    EXPECT_FALSE(collection->GetPartition(b, 0)->GetCellData()->HasArray("JacobianVerdict"));
  }
  auto* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  ASSERT_EQ(table->GetNumberOfRows(), 4);
  EXPECT_EQ(table->GetValueByName(1, "PatchId").ToInt(), 11);
  EXPECT_EQ(table->GetValueByName(1, "Verdict").ToString(), "invalid");
  EXPECT_EQ(table->GetValueByName(2, "Verdict").ToString(), "valid");
  EXPECT_EQ(table->GetValueByName(3, "PatchId").ToInt(), -1);
  EXPECT_EQ(table->GetValueByName(3, "Verdict").ToString(), "invalid");
  EXPECT_EQ(Grid(filter, 1)->GetCellData()->GetArray("Block")->GetTuple1(0), 1.0);
  EXPECT_EQ(Grid(filter, 1)->GetCellData()->GetArray("PatchId")->GetTuple1(0), 11.0);
}

TEST(JacobianValidator, VerdictIsWhatIsDrawn_ExactOracle)
{
  const auto grid = BiquadraticSquare(2.5, 0.5);
  vtkNew<vtkDoubleArray> scalars;
  scalars->SetName("Temperature");
  scalars->SetNumberOfTuples(grid->GetNumberOfPoints());
  scalars->Fill(1.0);
  grid->GetPointData()->SetScalars(scalars);
  vtkNew<vtkJacobianValidator> filter;
  filter->SetInputData(grid);
  filter->Update();
  vtkDataArray* drawn = Grid(filter)->GetCellData()->GetScalars();
  ASSERT_TRUE(drawn);
  EXPECT_STREQ(drawn->GetName(), "JacobianVerdict");
  EXPECT_FALSE(Grid(filter)->GetPointData()->GetScalars());
  EXPECT_EQ(Grid(filter)->GetPointData()->GetArray("Temperature"), scalars);
  EXPECT_EQ(grid->GetPointData()->GetScalars(), scalars); // the input is what it was
  EXPECT_EQ(grid->GetCellData()->GetNumberOfArrays(), 0);
}

TEST(JacobianValidator, BadInputIsOneError_PropertyOracle)
{
  const auto expect = [](vtkDataObject* input, const std::string& words)
  {
    vtkNew<vtkJacobianValidator> filter;
    vtkNew<Errors> errors;
    filter->AddObserver(vtkCommand::ErrorEvent, errors);
    filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, errors);
    filter->SetInputDataObject(input);
    filter->Update();
    EXPECT_GE(filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::UserError));
    ASSERT_FALSE(errors->Lines.empty());
    EXPECT_NE(errors->Lines[0].find(words), std::string::npos) << errors->Lines[0];
    EXPECT_EQ(filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), 0);
    EXPECT_EQ(filter->GetOutputDataObject(1)->GetNumberOfElements(vtkDataObject::CELL), 0);
    EXPECT_EQ(filter->GetOutputDataObject(2)->GetNumberOfElements(vtkDataObject::ROW), 0);
  };
  const Points five(5, { 0, 0, 0 });
  expect(OneCell(VTK_POLYGON, five), "vtkPolygon");
  expect(OneCell(VTK_QUAD, { { 0, 0, 0 }, { 1, 0, 0 }, { NAN, 1, 0 }, { 0, 1, 0 } }), "cell 0");
  auto weightless = BiquadraticSquare(0.5, 0.5);
  vtkNew<vtkDoubleArray> weights;
  weights->SetName("RationalWeights");
  weights->SetNumberOfTuples(9);
  weights->FillComponent(0, -1.0);
  weightless->GetPointData()->SetRationalWeights(weights);
  expect(weightless, "weight");

  vtkNew<vtkJacobianValidator> filter; // no cells: nothing to say, no error
  vtkNew<vtkUnstructuredGrid> empty;
  filter->SetInputData(empty);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
}

TEST(JacobianValidator, ThreadsDoNotMatter_PropertyOracle)
{
  vtkNew<vtkSplineSource> source;
  source->SetShape(vtkSplineSource::ANNULUS_SECTOR);
  source->SetElements(20, 20, 1);
  vtkNew<vtkJacobianValidator> one;
  one->SetInputConnection(source->GetOutputPort());
  one->SetRelativeGap(1e-3);
  one->SetThreads(1);
  one->Update();
  vtkNew<vtkJacobianValidator> all;
  all->SetInputConnection(source->GetOutputPort());
  all->SetRelativeGap(1e-3);
  all->Update();
  for (vtkIdType cell = 0; cell < Grid(one)->GetNumberOfCells(); ++cell)
  {
    for (const char* name : { "JacobianMinLower", "JacobianMinUpper", "JacobianMaxUpper" })
    {
      EXPECT_EQ(CellValue(one, name, cell), CellValue(all, name, cell));
    }
  }
}
