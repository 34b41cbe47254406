// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/DomainParameterization/vtkDomainParameterization.h>
#include <knotwork/SplineIO/vtkDomainBoundaryReader.h>

#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

namespace
{
class Messages : public vtkCommand
{
public:
  static Messages* New() { return new Messages; }
  void Execute(vtkObject*, unsigned long event, void* text) override
  {
    (event == vtkCommand::ErrorEvent ? this->Errors : this->Warnings)
      .emplace_back(static_cast<const char*>(text));
  }
  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;
};

std::string Line(double x0, double y0, double x1, double y1)
{
  return "{\"degree\": 1, \"knots\": [0, 0, 1, 1], \"control_points\": [[" + std::to_string(x0) +
    ", " + std::to_string(y0) + "], [" + std::to_string(x1) + ", " + std::to_string(y1) + "]]}";
}

/// A quarter circle about the origin from (r, 0) to (0, r).
std::string Arc(double r)
{
  const std::string s = std::to_string(r);
  return "{\"degree\": 2, \"knots\": [0, 0, 0, 1, 1, 1], \"weights\": [1, "
         "0.70710678118654757, 1], \"control_points\": [[" +
    s + ", 0], [" + s + ", " + s + "], [0, " + s + "]]}";
}

/// Face of the unit cube where coordinate axis is end.
std::string Face(int axis, int end)
{
  std::string points;
  for (int k = 0; k < 4; ++k)
  {
    int x[3];
    x[axis] = end;
    x[axis == 0 ? 1 : 0] = k & 1;
    x[axis == 2 ? 1 : 2] = k >> 1;
    points += (k > 0 ? ", [" : "[") + std::to_string(x[0]) + ", " + std::to_string(x[1]) + ", " +
      std::to_string(x[2]) + "]";
  }
  return "{\"degrees\": [1, 1], \"knots\": [[0, 0, 1, 1], [0, 0, 1, 1]], \"control_points\": [" +
    points + "]}";
}

std::string Sides(const char* key, const std::vector<std::string>& sides)
{
  std::string list;
  for (const std::string& side : sides)
  {
    list += (list.empty() ? "" : ", ") + side;
  }
  return std::string("{\"") + key + "\": [" + list + "]}";
}

/// The filter fed with a boundary by its JSON text.
class Pipeline
{
public:
  explicit Pipeline(
    const std::string& json, int maximumRefinements = 3, vtkUnstructuredGrid* layout = nullptr)
  {
    const std::string file = std::string(KNOTWORK_OUTPUT_DIR) + "/domain_boundary_" +
      testing::UnitTest::GetInstance()->current_test_info()->name() + ".json";
    std::ofstream(file) << json;
    this->Reader->SetFileName(file.c_str());
    this->Filter->SetInputConnection(this->Reader->GetOutputPort());
    if (layout)
    {
      this->Filter->SetInputDataObject(1, layout);
    }
    this->Filter->SetMaximumRefinements(maximumRefinements);
    this->Filter->AddObserver(vtkCommand::ErrorEvent, this->Said);
    this->Filter->AddObserver(vtkCommand::WarningEvent, this->Said);
    this->Filter->Update();
  }
  vtkUnstructuredGrid* Map(int port = 0)
  {
    return vtkUnstructuredGrid::SafeDownCast(this->Filter->GetOutputDataObject(port));
  }
  double Number(const char* name)
  {
    return this->Map()->GetFieldData()->GetArray(name)->GetTuple1(0);
  }

  vtkNew<vtkDomainBoundaryReader> Reader;
  vtkNew<vtkDomainParameterization> Filter;
  vtkNew<Messages> Said;
};
}

TEST(DomainParameterization, UnitSquare_ExactOracle)
{
  Pipeline run(
    Sides("curves", { Line(0, 0, 1, 0), Line(0, 1, 1, 1), Line(0, 0, 0, 1), Line(1, 0, 1, 1) }));
  ASSERT_EQ(run.Filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
  EXPECT_EQ(run.Filter->GetVerdict(), 1);
  EXPECT_EQ(run.Map()->GetNumberOfCells(), 1);
  EXPECT_NEAR(run.Number("Area"), 1.0, 1e-14);
  EXPECT_NEAR(run.Number("MinDetOverArea"), 1.0, 1e-12);
  EXPECT_NEAR(run.Number("MaxDetOverArea"), 1.0, 1e-12);
  EXPECT_NEAR(run.Number("JacobianMinLower"), 1.0, 1e-12);
  EXPECT_NEAR(run.Number("MeanConditionNumber"), 2.0, 1e-12); // |J|_F |J^-1|_F of the identity
  auto* verdict =
    vtkStringArray::SafeDownCast(run.Map()->GetFieldData()->GetAbstractArray("Verdict"));
  ASSERT_TRUE(verdict);
  EXPECT_EQ(verdict->GetValue(0), "valid");
}

TEST(DomainParameterization, QuarterAnnulus_ExactOracle)
{
  Pipeline run(Sides("curves", { Arc(0.5), Arc(1.0), Line(0.5, 0, 1, 0), Line(0, 0.5, 0, 1) }));
  ASSERT_EQ(run.Filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
  EXPECT_EQ(run.Filter->GetVerdict(), 1);
  EXPECT_TRUE(run.Said->Warnings.empty());
  EXPECT_NEAR(run.Number("Area"), 0.25 * std::acos(-1.0) * 0.75, 1e-12);
  auto* table = vtkTable::SafeDownCast(run.Filter->GetOutputDataObject(2));
  EXPECT_GE(table->GetNumberOfRows(), 1);
  EXPECT_EQ(table->GetValueByName(0, "Stage").ToString(), "initial");
  EXPECT_EQ(run.Map(1)->GetNumberOfCells(), run.Map()->GetNumberOfCells());
}

TEST(DomainParameterization, UnitCube_ExactOracle)
{
  Pipeline run(
    Sides("faces", { Face(2, 1), Face(0, 0), Face(1, 1), Face(0, 1), Face(1, 0), Face(2, 0) }));
  ASSERT_EQ(run.Filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
  EXPECT_EQ(run.Filter->GetVerdict(), 1);
  EXPECT_NEAR(run.Number("Area"), 1.0, 1e-14);
  EXPECT_NEAR(run.Number("MinDetOverArea"), 1.0, 1e-12);
}

// A square and a sector: each block a domain.
TEST(DomainParameterization, BlocksAreDomains_ExactOracle)
{
  Pipeline square(
    Sides("curves", { Line(0, 0, 2, 0), Line(2, 0, 2, 2), Line(0, 2, 2, 2), Line(0, 0, 0, 2) }));
  Pipeline sector(Sides("curves", { Arc(1.0), Arc(2.0), Line(1, 0, 2, 0), Line(0, 1, 0, 2) }));
  vtkNew<vtkPartitionedDataSetCollection> domains;
  for (Pipeline* one : { &square, &sector })
  {
    one->Reader->Update();
    domains->SetPartition(one == &square ? 0 : 2, 0, one->Reader->GetOutput());
  }
  EXPECT_TRUE(vtkDomainParameterization::HoldsDomains(domains));
  vtkNew<vtkDomainParameterization> filter;
  filter->SetInputDataObject(domains);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  auto* const map = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  const auto number = [&](const char* name)
  { return map->GetFieldData()->GetArray(name)->GetComponent(0, 0); };
  const double pi = 4.0 * std::atan(1.0);
  EXPECT_NEAR(number("Area"), 4.0 + 0.75 * pi, 1e-12);
  EXPECT_EQ(number("Patches"), 2.0);
  EXPECT_STREQ(vtkStringArray::SafeDownCast(map->GetFieldData()->GetAbstractArray("Verdict"))
                 ->GetValue(0)
                 .c_str(),
    "valid");
  double range[2];
  map->GetCellData()->GetArray("PatchId")->GetRange(range);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_EQ(range[1], 2.0); // the block's number
  auto* const table = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  EXPECT_EQ(table->GetValueByName(0, "Domain").ToInt(), 0);
  EXPECT_EQ(table->GetValueByName(table->GetNumberOfRows() - 1, "Domain").ToInt(), 2);

  // curves that do not meet in the second one
  Pipeline open(
    Sides("curves", { Line(0, 0, 2, 0), Line(2, 0, 2, 2), Line(0, 2, 2, 2), Line(0, 5, 0, 7) }));
  open.Reader->Update();
  domains->SetPartition(2, 0, open.Reader->GetOutput());
  domains->Modified();
  vtkNew<Messages> messages;
  filter->AddObserver(vtkCommand::ErrorEvent, messages);
  filter->Update();
  ASSERT_EQ(messages->Errors.size(), 1U);
  EXPECT_NE(messages->Errors[0].find("block 2: "), std::string::npos) << messages->Errors[0];
  EXPECT_EQ(map->GetNumberOfCells(), 0);
}

namespace
{
/// Three unit squares in the form of an L, as quadrilaterals at z = 7, with a line that is no
/// patch. The boundary is made of straight curves.
vtkSmartPointer<vtkUnstructuredGrid> LetterL()
{
  const double points[8][2] = { { 0, 0 }, { 1, 0 }, { 2, 0 }, { 0, 1 }, { 1, 1 }, { 2, 1 },
    { 0, 2 }, { 1, 2 } };
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> vertices;
  for (const double* p : points)
  {
    vertices->InsertNextPoint(p[0], p[1], 7.0);
  }
  grid->SetPoints(vertices);
  const vtkIdType line[2] = { 0, 1 };
  const vtkIdType quads[3][4] = { { 0, 1, 4, 3 }, { 1, 2, 5, 4 }, { 3, 4, 7, 6 } };
  grid->InsertNextCell(VTK_LINE, 2, line);
  for (const vtkIdType* quad : quads)
  {
    grid->InsertNextCell(VTK_QUAD, 4, quad);
  }
  return grid;
}

std::string BoundaryOfL()
{
  return Sides("curves",
    { Line(0, 0, 1, 0), Line(1, 0, 2, 0), Line(2, 0, 2, 1), Line(2, 1, 1, 1), Line(1, 1, 1, 2),
      Line(1, 2, 0, 2), Line(0, 2, 0, 1), Line(0, 1, 0, 0) });
}
}

TEST(DomainParameterization, LayoutOfThreePatches_ExactOracle)
{
  Pipeline run(BoundaryOfL(), 3, LetterL());
  ASSERT_EQ(run.Filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError))
    << run.Said->Errors.front();
  EXPECT_EQ(run.Filter->GetVerdict(), 1);
  EXPECT_TRUE(run.Said->Warnings.empty());
  EXPECT_EQ(run.Map()->GetNumberOfCells(), 3 * 4 * 4);
  double range[2];
  run.Map()->GetCellData()->GetArray("PatchId")->GetRange(range);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_EQ(range[1], 2.0);
  EXPECT_EQ(run.Map()->GetBounds()[5], 0.0); // the plane of the curves
  EXPECT_NEAR(run.Number("Area"), 3.0, 1e-13);
  EXPECT_NEAR(run.Number("MinDetOverArea"), 1.0, 1e-6);
  EXPECT_EQ(run.Number("Patches"), 3.0);
  // 6 functions a direction, shared along two sides
  EXPECT_EQ(run.Number("Functions"), 3 * 36 - 2 * 6);
  auto* injective =
    vtkStringArray::SafeDownCast(run.Map()->GetFieldData()->GetAbstractArray("Injective"));
  ASSERT_TRUE(injective);
  EXPECT_EQ(injective->GetValue(0), "injective");
  // fewer elements, higher degree
  run.Filter->SetMinimumElements(1);
  run.Filter->SetMinimumDegree(3);
  run.Filter->Update();
  EXPECT_EQ(run.Map()->GetNumberOfCells(), 3);
  EXPECT_EQ(run.Number("Functions"), 3 * 16 - 2 * 4);
}

TEST(DomainParameterization, LayoutErrorsNameThePlace_PropertyOracle)
{
  const auto fails = [](Pipeline& run, const char* part)
  {
    EXPECT_NE(run.Filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
    ASSERT_EQ(run.Said->Errors.size(), 1u);
    EXPECT_NE(run.Said->Errors[0].find(part), std::string::npos) << run.Said->Errors[0];
    EXPECT_EQ(run.Map()->GetNumberOfCells(), 0);
  };
  auto layout = LetterL();
  const vtkIdType triangle[3] = { 1, 2, 5 };
  layout->InsertNextCell(VTK_TRIANGLE, 3, triangle);
  Pipeline other(BoundaryOfL(), 3, layout);
  fails(other, "cell 4 of the layout is no quadrilateral");
  layout = LetterL();
  layout->GetPoints()->SetPoint(5, 2.0, 1.25, 0.0);
  Pipeline gap(BoundaryOfL(), 3, layout);
  fails(gap, "gap of 0.25");
  Pipeline missing(Sides("curves", { Line(0, 0, 1, 0) }), 3, LetterL());
  fails(missing, "has no curve");
  vtkNew<vtkUnstructuredGrid> empty;
  Pipeline none(BoundaryOfL(), 3, empty);
  fails(none, "no quadrilaterals");
}

TEST(DomainParameterization, CornerThatFoldsIsNamed_PropertyOracle)
{
  // at (1, 0) the boundary turns by more than 180 degrees
  Pipeline run(
    Sides("curves",
      { "{\"degree\": 2, \"knots\": [0, 0, 0, 1, 1, 1], \"control_points\": [[0, 0], [0.5, "
        "0], [1, 0]]}",
        Line(0, 1, 1, 1), Line(0, 0, 0, 1),
        "{\"degree\": 2, \"knots\": [0, 0, 0, 1, 1, 1], \"control_points\": [[1, 0], [0.8, "
        "-0.5], [1, 1]]}" }),
    0);
  EXPECT_EQ(run.Filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
  EXPECT_EQ(run.Filter->GetVerdict(), -1);
  ASSERT_FALSE(run.Said->Warnings.empty());
  EXPECT_NE(run.Said->Warnings[0].find("corner"), std::string::npos) << run.Said->Warnings[0];
  EXPECT_EQ(run.Map()->GetNumberOfCells(), 1);
}

TEST(DomainParameterization, OptionsReachTheKernel_PropertyOracle)
{
  // a deep bite under a low roof: the Coons map folds
  Pipeline run(Sides("curves",
    { "{\"degree\": 3, \"knots\": [0, 0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1, 1], "
      "\"control_points\": [[0, 0], [0.7, 0.1], [0.1, 0.7], [0.5, 1.1], [0.9, 0.7], [0.3, 0.1], "
      "[1, 0]]}",
      Line(0, 1.2, 1, 1.2), Line(0, 0, 0, 1.2), Line(1, 0, 1, 1.2) }));
  run.Filter->SetInitialMap(vtkDomainParameterization::COONS);
  run.Filter->Update();
  ASSERT_EQ(run.Filter->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
  EXPECT_EQ(run.Filter->GetVerdict(), 1);
  const auto lastOfFoldover = [&]
  {
    run.Filter->Update();
    auto* table = vtkTable::SafeDownCast(run.Filter->GetOutputDataObject(2));
    double energy = -1.0;
    for (vtkIdType i = 0; i < table->GetNumberOfRows(); ++i)
    {
      if (table->GetValueByName(i, "Stage").ToString() == "foldover")
      {
        energy = table->GetValueByName(i, "Energy").ToDouble();
      }
    }
    return energy;
  };
  run.Filter->SetFoldover(vtkDomainParameterization::RELU);
  const double relu = lastOfFoldover();
  EXPECT_EQ(run.Filter->GetVerdict(), 1);
  run.Filter->SetFoldover(vtkDomainParameterization::PENALTY);
  const double penalty = lastOfFoldover();
  EXPECT_EQ(run.Filter->GetVerdict(), 1);
  // int max(0, delta - det J) with delta = 0.05 at most, where no point is folded any more
  EXPECT_GE(relu, 0.0);
  EXPECT_LT(relu, 0.05);
  EXPECT_GT(penalty, 1.0); // the quality functional, at least 2 in the plane
  run.Filter->SetFoldover(vtkDomainParameterization::FOLDOVER_AUTOMATIC);

  run.Filter->Update();
  const double iterations = run.Number("Iterations");
  run.Filter->SetEnergyTolerance(0.1);
  run.Filter->Update();
  EXPECT_LT(run.Number("Iterations"), iterations);
  run.Filter->SetEnergyTolerance(1e-7);

  run.Filter->Update();
  const double coarse = run.Number("JacobianMinUpper") - run.Number("JacobianMinLower");
  const double lower = run.Number("JacobianMinLower");
  run.Filter->SetCertificateGap(1e-9);
  run.Filter->Update();
  EXPECT_EQ(run.Filter->GetVerdict(), 1);
  EXPECT_GE(run.Number("JacobianMinLower"), lower);
  EXPECT_LE(run.Number("JacobianMinUpper") - run.Number("JacobianMinLower"),
    1e-9 * run.Number("JacobianMinUpper"));
  EXPECT_GT(coarse, 1e-9 * run.Number("JacobianMinUpper"));

  const double sampled = run.Number("MinDetOverArea");
  run.Filter->SetMetricSamples(2); // the corners alone
  run.Filter->Update();
  EXPECT_GT(run.Number("MinDetOverArea"), sampled);
}

TEST(DomainParameterization, BadBoundariesAreOneError_PropertyOracle)
{
  const auto expect = [](const std::string& json, const std::string& words)
  {
    SCOPED_TRACE(words);
    Pipeline run(json);
    ASSERT_FALSE(run.Said->Errors.empty());
    EXPECT_NE(run.Said->Errors[0].find(words), std::string::npos) << run.Said->Errors[0];
    EXPECT_EQ(run.Map()->GetNumberOfCells(), 0);
    EXPECT_EQ(run.Map(1)->GetNumberOfCells(), 0);
  };
  const std::string south = Line(0, 0, 1, 0);
  const std::string north = Line(0, 1, 1, 1);
  const std::string west = Line(0, 0, 0, 1);
  expect(Sides("curves", { south, north, west }), "3");
  expect(Sides("curves", { south, north, west, Line(1, 0, 1.25, 1) }), "0.25");
  expect(Sides("faces", { Face(0, 0), Face(0, 1) }), "2");
}
