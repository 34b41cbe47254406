// SPDX-License-Identifier: BSD-3-Clause
// Beams, bars and discs of every family against formulas, and what is refused.
#include "FilterCases.h"
#include <knotwork/SplineAnalysis/vtkSplineAnalysis.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <array>
#include <cmath>
#include <string>

using namespace knotwork;

namespace
{
double Number(vtkSplineAnalysis* filter, const char* name, int component = 0)
{
  auto* const table = vtkTable::SafeDownCast(filter->GetOutputDataObject(3));
  auto* const column = vtkDataArray::SafeDownCast(table->GetColumnByName(name));
  EXPECT_TRUE(column) << name;
  return column ? column->GetComponent(0, component) : 0.0;
}

vtkUnstructuredGrid* Body(vtkSplineAnalysis* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

/// A box from 0 to (10, 1, 1) of hexahedra or of six tetrahedra each, n along the short sides, with
/// points between their corners of order 2 in VTK's order of quadratic tetrahedra.
vtkSmartPointer<vtkUnstructuredGrid> BeamMesh(bool tetrahedra, int n)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const int m[] = { 20 * n + 1, 2 * n + 1, 2 * n + 1 };
  for (int k = 0; k < m[2]; ++k)
  {
    for (int j = 0; j < m[1]; ++j)
    {
      for (int i = 0; i < m[0]; ++i)
      {
        points->InsertNextPoint(0.5 * i / n, 0.5 * j / n, 0.5 * k / n);
      }
    }
  }
  grid->SetPoints(points);
  const auto number = [&](const std::array<int, 3>& i) -> vtkIdType
  { return i[0] + m[0] * (i[1] + m[1] * i[2]); };
  const auto middle = [](const std::array<int, 3>& a, const std::array<int, 3>& b) {
    return std::array<int, 3>{ (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2 };
  };
  std::vector<std::array<int, 3>> corners;
  for (int box = 0; box < 10 * n * n * n; ++box)
  {
    const std::array<int, 3> at{ 2 * (box % (10 * n)), 2 * (box / (10 * n) % n),
      2 * (box / (10 * n) / n) };
    const auto corner = [&](int c)
    {
      return std::array<int, 3>{ at[0] + 2 * (c & 1), at[1] + 2 * (c >> 1 & 1),
        at[2] + 2 * (c >> 2 & 1) };
    };
    if (!tetrahedra)
    {
      vtkIdType ids[8];
      const int order[] = { 0, 1, 3, 2, 4, 5, 7, 6 };
      for (int c = 0; c < 8; ++c)
      {
        ids[c] = number(corner(order[c]));
      }
      grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
      continue;
    }
    const int pieces[6][4] = { { 0, 1, 3, 7 }, { 0, 3, 2, 7 }, { 0, 2, 6, 7 }, { 0, 6, 4, 7 },
      { 0, 4, 5, 7 }, { 0, 5, 1, 7 } };
    for (const auto& piece : pieces)
    {
      const int edges[6][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };
      vtkIdType ids[10];
      for (int c = 0; c < 4; ++c)
      {
        ids[c] = number(corner(piece[c]));
      }
      for (int c = 0; c < 6; ++c)
      {
        ids[4 + c] = number(middle(corner(piece[edges[c][0]]), corner(piece[edges[c][1]])));
      }
      grid->InsertNextCell(VTK_QUADRATIC_TETRA, 10, ids);
    }
  }
  return grid;
}

/// Held at x = 0, drawn down at x = 10 with the force 1.
constexpr const char* Cantilever = R"({
  "material": { "youngs_modulus": 1000, "poissons_ratio": 0 },
  "conditions": [
    { "on": { "box": [0, 0, 0, 1, 0, 1] }, "displacement": [0, 0, 0] },
    { "on": { "box": [10, 10, 0, 1, 0, 1] }, "traction": [0, 0, -1] } ] })";

/// Timoshenko: F l^3 / (3 E I) + F l / (5/6 G A).
constexpr double TipDeflection = 1000.0 / (3.0 * 1000.0 / 12.0) + 10.0 / (5.0 / 6.0 * 500.0);

vtkSmartPointer<vtkUnstructuredGrid> BeamSpline(int degree)
{
  auto grid = ShapeGrid(vtkSplineSource::CUBE, degree, { 20, 2, 2 });
  double bounds[6];
  grid->GetBounds(bounds);
  SplineModel model = DecodePatches(grid);
  auto& spline = std::get<Spline<3>>(model.Patches[0].Geometry);
  for (Eigen::Index i = 0; i < spline.ControlPoints.rows(); ++i)
  {
    for (int d = 0; d < 3; ++d)
    {
      const double share =
        (spline.ControlPoints(i, d) - bounds[2 * d]) / (bounds[2 * d + 1] - bounds[2 * d]);
      spline.ControlPoints(i, d) = share * (d == 0 ? 10.0 : 1.0);
    }
  }
  auto beam = vtkSmartPointer<vtkUnstructuredGrid>::New();
  EXPECT_TRUE(EncodeSplineGrid(model, beam));
  return beam;
}

void ExpectBeam(vtkUnstructuredGrid* beam, const std::string& name)
{
  vtkNew<vtkSplineAnalysis> filter;
  filter->SetInputDataObject(beam);
  filter->SetEquation(vtkSplineAnalysis::ELASTICITY);
  filter->SetProblem(Cantilever);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError) << name;
  EXPECT_NEAR(Number(filter, "LargestValue"), TipDeflection, 0.01 * TipDeflection) << name;
  EXPECT_NEAR(Number(filter, "TotalLoad", 2), -1.0, 1e-10) << name;
  EXPECT_LE(Number(filter, "Imbalance"), 1e-10) << name;
  // the moment at the middle is 5: stress 5 * 0.5 / I at the top, energy F w / 2
  EXPECT_NEAR(Number(filter, "Energy"), 0.5 * TipDeflection, 0.005 * TipDeflection) << name;
  double nearest = 1e300;
  double stress = 0.0;
  auto* const gauss = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  for (vtkIdType i = 0; i < gauss->GetNumberOfPoints(); ++i)
  {
    double x[3];
    gauss->GetPoint(i, x);
    // by the formula, at the point itself
    const double distance = std::abs(x[0] - 5.0) + std::abs(x[2] - 1.0);
    if (distance < nearest)
    {
      nearest = distance;
      const double theory = (10.0 - x[0]) * (x[2] - 0.5) * 12.0;
      stress = gauss->GetPointData()->GetArray("Stress")->GetComponent(i, 0) / theory;
    }
  }
  EXPECT_NEAR(stress, 1.0, 0.01) << name;
  auto* const conditions = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  ASSERT_EQ(conditions->GetNumberOfRows(), 2);
  EXPECT_NEAR(conditions->GetValueByName(0, "Measure").ToDouble(), 1.0, 1e-9);
  auto* const reactions = vtkDataArray::SafeDownCast(conditions->GetColumnByName("Reaction"));
  EXPECT_NEAR(reactions->GetComponent(0, 2), 1.0, 1e-9) << name;
}
}

TEST(vtkSplineAnalysis, BeamsOfEveryFamily_ExactOracle)
{
  ExpectBeam(BeamSpline(2), "quadratic spline");
  ExpectBeam(BeamSpline(3), "cubic spline");
  ExpectBeam(BeamMesh(true, 3), "quadratic tetrahedra");
}

TEST(vtkSplineAnalysis, LinearHexahedraInTension_ExactOracle)
{
  vtkNew<vtkSplineAnalysis> filter;
  filter->SetInputDataObject(BeamMesh(false, 1));
  filter->SetEquation(vtkSplineAnalysis::ELASTICITY);
  filter->SetYoungsModulus(100.0);
  filter->SetPoissonsRatio(0.25);
  filter->SetProblem(R"({ "conditions": [
    { "on": { "box": [0, 0, 0, 1, 0, 1] }, "displacement": [0, null, null] },
    { "at": [0, 0, 0], "displacement": [0, 0, 0] },
    { "at": [0, 1, 0], "displacement": [null, null, 0] },
    { "on": { "where": "x > 9.99" }, "pressure": -2 } ] })");
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  // strain 2 / 100
  vtkDataArray* const moved = Body(filter)->GetPointData()->GetArray("Displacement");
  for (const vtkIdType cell : { 0, 9 })
  {
    vtkNew<vtkIdList> ids;
    Body(filter)->GetCellPoints(cell, ids);
    for (const vtkIdType point : *ids)
    {
      double x[3];
      Body(filter)->GetPoint(point, x);
      EXPECT_NEAR(moved->GetComponent(point, 0), 0.02 * x[0], 1e-11);
      EXPECT_NEAR(moved->GetComponent(point, 1), -0.005 * x[1], 1e-11);
    }
  }
  EXPECT_NEAR(
    Body(filter)->GetCellData()->GetArray("LargestVonMises")->GetComponent(3, 0), 2.0, 1e-10);
}

TEST(vtkSplineAnalysis, PoissonOnADisc_ExactOracle)
{
  // -div grad u = 4, u = 0 on the boundary: u = r^2 - |x|^2
  vtkNew<vtkSplineAnalysis> filter;
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::DISC, 3, { 4, 4, 1 }));
  filter->SetProblem(R"({ "source": 4, "conditions": [ { "on": "boundary", "value": 0 } ] })");
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  double bounds[6];
  Body(filter)->GetBounds(bounds);
  const SplineModel model = DecodePatches(Body(filter));
  for (const SplinePatch& patch : model.Patches)
  {
    ASSERT_EQ(patch.Fields.size(), 2U);
    EXPECT_EQ(patch.Fields[0].Name, "Solution");
    EXPECT_EQ(patch.Fields[1].Name, "Flux");
  }
  const double radius = 0.5 * (bounds[1] - bounds[0]);
  // at the Gauss points next to the middle
  EXPECT_NEAR(Number(filter, "LargestValue"), radius * radius, 0.01 * radius * radius);
  const double pi = 4.0 * std::atan(1.0);
  EXPECT_NEAR(Number(filter, "Energy"), pi * std::pow(radius, 4), 1e-4 * std::pow(radius, 4));
  EXPECT_NEAR(Number(filter, "TotalReaction"), -4.0 * pi * radius * radius, 1e-6);
}

TEST(vtkSplineAnalysis, GroupsAndMaterialsOfAMesh_ExactOracle)
{
  // two squares beside each other, conductivities 1 and 3, a flux of 1.5 from right to left
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 6; ++i)
  {
    points->InsertNextPoint(i % 3, i / 3, 0.0);
  }
  grid->SetPoints(points);
  const vtkIdType squares[2][4] = { { 0, 1, 4, 3 }, { 1, 2, 5, 4 } };
  const vtkIdType ends[2][2] = { { 0, 3 }, { 2, 5 } };
  grid->InsertNextCell(VTK_LINE, 2, ends[0]);
  grid->InsertNextCell(VTK_QUAD, 4, squares[0]);
  grid->InsertNextCell(VTK_QUAD, 4, squares[1]);
  grid->InsertNextCell(VTK_LINE, 2, ends[1]);
  vtkNew<vtkIntArray> group;
  group->SetName("PhysicalGroup");
  for (const int value : { 7, 1, 2, 8 })
  {
    group->InsertNextValue(value);
  }
  grid->GetCellData()->AddArray(group);
  vtkNew<vtkSplineAnalysis> filter;
  filter->SetInputDataObject(grid);
  filter->SetProblem(R"({ "material_array": "PhysicalGroup",
    "materials": [ { "number": 1, "conductivity": 1 }, { "number": 2, "conductivity": 3 } ],
    "conditions": [ { "on": { "group": 7 }, "value": 0 }, { "on": { "group": 8 }, "flux": 1.5 } ] })");
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  vtkDataArray* const u = Body(filter)->GetPointData()->GetArray("Solution");
  EXPECT_NEAR(u->GetComponent(4, 0), 1.5, 1e-12);
  EXPECT_NEAR(u->GetComponent(5, 0), 2.0, 1e-12);
  EXPECT_EQ(Body(filter)->GetNumberOfCells(), 4);
  filter->SetProblem(R"({ "conditions": [ { "on": { "group": 9 }, "value": 0 } ] })");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "there are 7 8");
  filter->SetProblem(R"({ "material_array": "PhysicalGroup", "materials": [ { "number": 1 } ],
    "conditions": [ { "on": { "group": 7 }, "value": 0 } ] })");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "cell 2 has material 2");
}

TEST(vtkSplineAnalysis, BadInputIsOneError_PropertyOracle)
{
  vtkNew<vtkSplineAnalysis> filter;
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::ANNULUS_SECTOR, 2, { 2, 2, 1 }));
  ExpectFailure(filter, ErrorCode::SingularSystem, "the constant");
  filter->SetEquation(vtkSplineAnalysis::ELASTICITY);
  ExpectFailure(filter, ErrorCode::SingularSystem, "rotation in the plane");
  filter->SetProblem(
    "{\"conditions\": [{\"on\": {\"side\": 0}, \"displacement\": [0, \"sin(\"]}]}");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "\"sin(\" is no expression");
  filter->SetProblem(
    "{\"conditions\": [{\"on\": {\"side\": 0}, \"displacement\": [0, \"sqrt(-x)\"]}]}");
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "is no number");
  filter->SetProblem("nonsense");
  ExpectFailure(filter, ErrorCode::InvalidFormat, "is not JSON");
  filter->SetProblemFile("no/such/file.json");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "both given");
  filter->SetProblem(nullptr);
  ExpectFailure(filter, ErrorCode::FileError, "no/such/file.json");
  filter->SetProblemFile(nullptr);

  filter->SetProblem("{\"conditions\": [{\"on\": {\"side\": 0}, \"displacement\": [0, 0]}]}");
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::POLAR_SPHERE_SURFACE));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "plane z = 0");
  // a folded quadrilateral is named by its cell
  vtkNew<vtkUnstructuredGrid> folded;
  vtkNew<vtkPoints> points;
  for (const auto& [x, y] : { std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1) })
  {
    points->InsertNextPoint(x, y, 0.0);
  }
  folded->SetPoints(points);
  const vtkIdType line[] = { 0, 1 };
  const vtkIdType crossed[] = { 0, 1, 2, 3 };
  folded->InsertNextCell(VTK_LINE, 2, line);
  folded->InsertNextCell(VTK_QUAD, 4, crossed);
  filter->SetInputDataObject(folded);
  filter->SetProblem("{\"conditions\": [{\"on\": \"boundary\", \"displacement\": [0, 0]}]}");
  ExpectFailure(filter, ErrorCode::InvalidTopology, "element 1 is folded");
  points->SetPoint(2, std::nan(""), 0.0, 0.0);
  points->Modified();
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "");

  vtkNew<vtkUnstructuredGrid> pyramid;
  vtkNew<vtkPoints> corners;
  for (const auto& [x, y, z] : { std::array{ 0, 0, 0 }, std::array{ 1, 0, 0 },
         std::array{ 1, 1, 0 }, std::array{ 0, 1, 0 }, std::array{ 0, 0, 1 } })
  {
    corners->InsertNextPoint(x, y, z);
  }
  pyramid->SetPoints(corners);
  const vtkIdType all[] = { 0, 1, 2, 3, 4 };
  pyramid->InsertNextCell(VTK_PYRAMID, 5, all);
  filter->SetInputDataObject(pyramid);
  ExpectFailure(
    filter, ErrorCode::InvalidTopology, "cell 0: pyramids are not analysed; divide them");

  vtkNew<vtkUnstructuredGrid> empty;
  filter->SetInputDataObject(empty);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
}

TEST(vtkSplineAnalysis, ProgressAndAbort_PropertyOracle)
{
  vtkNew<vtkSplineAnalysis> filter;
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::ANNULUS_SECTOR, 2, { 24, 24, 1 }));
  filter->SetProblem("{\"source\": 1, \"conditions\": [{\"on\": \"boundary\", \"value\": 0}]}");
  ExpectProgressAndAbort(filter, 3);
}

TEST(vtkSplineAnalysis, PatchesOfACollectionAreOneBody_ExactOracle)
{
  // a bar of two blocks: u = x under a flux of 1 at its end
  const auto left = ShapeGrid(vtkSplineSource::SQUARE, 2, { 2, 2, 1 });
  double bounds[6];
  left->GetBounds(bounds);
  vtkNew<vtkSplineSource> source;
  source->SetShape(vtkSplineSource::SQUARE);
  source->SetDegree(2);
  source->SetElements(2, 2, 1);
  source->SetCenter(
    0.5 * (bounds[0] + bounds[1]) + bounds[1] - bounds[0], 0.5 * (bounds[2] + bounds[3]), 0.0);
  source->Update();
  auto right = vtkSmartPointer<vtkUnstructuredGrid>::New();
  right->DeepCopy(source->GetOutputDataObject(0));
  vtkNew<vtkSplineAnalysis> filter;
  filter->SetInputDataObject(Collect({ left, right }));
  filter->SetProblem(R"({ "conditions": [ { "on": { "patch": 0, "side": 0 }, "value": 0 },
    { "on": { "patch": 1, "side": 1 }, "flux": 1 } ] })");
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_NEAR(Number(filter, "LargestValue"), 2.0 * (bounds[1] - bounds[0]), 1e-10);
  EXPECT_EQ(filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), 8);
}

TEST(vtkSplineAnalysis, RefinementIsAdaptive_PropertyOracle)
{
  vtkNew<vtkSplineAnalysis> filter;
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::SQUARE, 2, { 6, 6, 1 }));
  filter->SetProblem(R"json({ "source": "exp(-300 * (x^2 + y^2))",
    "conditions": [ { "on": "boundary", "value": 0 } ] })json");
  filter->Update();
  const double error = Number(filter, "EstimatedError");
  filter->SetMaxSteps(6);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  auto* const history = vtkTable::SafeDownCast(filter->GetOutputDataObject(4));
  ASSERT_EQ(history->GetNumberOfRows(), 6);
  EXPECT_EQ(history->GetValueByName(0, "EstimatedError").ToDouble(), error);
  EXPECT_LT(Number(filter, "EstimatedError"), 0.5 * error);
  EXPECT_EQ(Body(filter)->GetNumberOfCells(), Number(filter, "Elements"));
  EXPECT_TRUE(Body(filter)->GetCellData()->GetArray("EstimatedError"));
  // the sum of squares over the cells is the whole
  double sum = 0.0;
  for (vtkIdType cell = 0; cell < Body(filter)->GetNumberOfCells(); ++cell)
  {
    sum +=
      std::pow(Body(filter)->GetCellData()->GetArray("EstimatedError")->GetComponent(cell, 0), 2);
  }
  EXPECT_NEAR(std::sqrt(sum), Number(filter, "EstimatedError"), 1e-9 * error);
  filter->SetInputDataObject(BeamMesh(false, 1));
  ExpectFailure(filter, ErrorCode::InvalidParameter, "is for splines");
}

// A disc of five patches under a load that is small in the middle of one of them.
TEST(vtkSplineAnalysis, RefinementOfSeveralPatches_PropertyOracle)
{
  vtkNew<vtkSplineAnalysis> filter;
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::DISC, 2, { 4, 4, 1 }));
  filter->SetProblem(R"json({ "source": "exp(-300 * ((x - 0.5)^2 + y^2))",
    "conditions": [ { "on": "boundary", "value": 0 } ] })json");
  filter->Update();
  const double error = Number(filter, "EstimatedError");
  filter->SetMaxSteps(6);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_LT(Number(filter, "EstimatedError"), 0.3 * error);
  EXPECT_LE(Number(filter, "Imbalance"), 1e-10);
  // the output is five patches that are one body again
  const SplineModel model = DecodePatches(Body(filter));
  ASSERT_EQ(model.Patches.size(), 5U);
  EXPECT_EQ(model.Topology.Interfaces.size(), 8U);
  vtkNew<vtkSplineAnalysis> again;
  again->SetInputDataObject(Body(filter));
  again->SetProblem(filter->GetProblem());
  again->Update();
  ASSERT_EQ(again->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(Number(again, "Functions"), Number(filter, "Functions"));
  EXPECT_NEAR(Number(again, "Energy"), Number(filter, "Energy"), 1e-10 * Number(filter, "Energy"));
}

// A flux of 1 through two layers, whose elements keep their material and arrays when they are
// split.
TEST(vtkSplineAnalysis, RefinementOfSeveralMaterials_ExactOracle)
{
  const auto body = ShapeGrid(vtkSplineSource::SQUARE, 2, { 6, 6, 1 });
  double box[6];
  body->GetBounds(box);
  const double middle = 0.5 * (box[0] + box[1]);
  const auto isRight = [&](vtkUnstructuredGrid* grid, vtkIdType cell)
  {
    double bounds[6];
    grid->GetCellBounds(cell, bounds);
    return 0.5 * (bounds[0] + bounds[1]) > middle;
  };
  vtkNew<vtkIntArray> material;
  material->SetName("Layer");
  for (vtkIdType cell = 0; cell < body->GetNumberOfCells(); ++cell)
  {
    material->InsertNextValue(isRight(body, cell) ? 20 : 10);
  }
  body->GetCellData()->AddArray(material);
  vtkNew<vtkSplineAnalysis> filter;
  filter->SetInputDataObject(body);
  filter->SetProblem(R"({ "material_array": "Layer",
    "materials": [ { "number": 10, "conductivity": 1 }, { "number": 20, "conductivity": 10 } ],
    "conditions": [ { "on": { "side": 0 }, "value": 0 }, { "on": { "side": 1 }, "flux": 1 } ] })");
  filter->Update();
  // the integral of the squared flux over the conductivity, halved
  const double energy = 0.5 * (box[3] - box[2]) * 0.5 * (box[1] - box[0]) * 1.1;
  const double lost = energy - Number(filter, "Energy");
  EXPECT_GT(lost, 1e-4 * energy);
  filter->SetMaxSteps(6);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  // elements at the interface were halved five times, the error is there alone and of order 1/2
  EXPECT_NEAR(energy - Number(filter, "Energy"), lost / 32.0, 0.1 * lost / 32.0);
  auto* const layers = Body(filter)->GetCellData()->GetArray("Layer");
  ASSERT_TRUE(layers);
  for (vtkIdType cell = 0; cell < Body(filter)->GetNumberOfCells(); ++cell)
  {
    EXPECT_EQ(layers->GetComponent(cell, 0), isRight(Body(filter), cell) ? 20.0 : 10.0);
  }
  vtkNew<vtkSplineAnalysis> again;
  again->SetInputDataObject(Body(filter));
  again->SetProblem(filter->GetProblem());
  again->Update();
  ASSERT_EQ(again->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_NEAR(Number(again, "Energy"), Number(filter, "Energy"), 1e-10 * energy);
}

// Lines of a mesh in space are edges that loads act along.
TEST(vtkSplineAnalysis, LoadsAlongLinesOfAMesh_ExactOracle)
{
  const auto body = BeamMesh(false, 1);
  vtkNew<vtkIntArray> group;
  group->SetName("PhysicalGroup");
  for (vtkIdType cell = 0; cell < body->GetNumberOfCells(); ++cell)
  {
    group->InsertNextValue(1);
  }
  // corners of the end at the top: (10, 0, 1) and (10, 1, 1) are points of a lattice of 21 x 3 x 3
  const vtkIdType line[] = { 20 + 21 * (0 + 3 * 2), 20 + 21 * (2 + 3 * 2) };
  body->InsertNextCell(VTK_LINE, 2, line);
  group->InsertNextValue(7);
  body->GetCellData()->AddArray(group);
  vtkNew<vtkSplineAnalysis> filter;
  filter->SetInputDataObject(body);
  filter->SetEquation(vtkSplineAnalysis::ELASTICITY);
  filter->SetProblem(R"({ "conditions": [
    { "on": { "where": "x < 1e-9" }, "displacement": [0, 0, 0] },
    { "along": { "group": 7 }, "force": [0, 0, -3] } ] })");
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_NEAR(Number(filter, "TotalLoad", 2), -3.0, 1e-10); // 3 for each length, 1 long
  EXPECT_LE(Number(filter, "Imbalance"), 1e-10);
  auto* const conditions = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  EXPECT_NEAR(conditions->GetValueByName(1, "Measure").ToDouble(), 1.0, 1e-12);
  EXPECT_EQ(conditions->GetValueByName(1, "Functions").ToInt(), 2);
  filter->SetProblem(R"({ "conditions": [
    { "on": { "where": "x < 1e-9" }, "displacement": [0, 0, 0] },
    { "along": { "group": 8 }, "force": [0, 0, -3] } ] })");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "no groups of facets");
}
