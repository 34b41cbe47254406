// SPDX-License-Identifier: BSD-3-Clause
// Clouds whose surface is known.
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <knotwork/SurfaceFitting/vtkSplineSurfaceFit.h>

#include "FilterCases.h"
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SurfaceFitting/SurfaceFit.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"
#include <knotwork/SplineGrid/vtkSplineEvaluate.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <tuple>

using namespace knotwork;

namespace
{
using Shape = std::function<std::array<double, 3>(double u, double v)>;

/// Points of a shape over [0, 2] x [0, 1], seeded, with the arrays Uv and TwoU = (2 u, v - u).
template <typename Data>
vtkSmartPointer<Data> MakeCloud(const Shape& shape, int n = 2000, unsigned seed = 1)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> uv;
  uv->SetName("Uv");
  uv->SetNumberOfComponents(2);
  vtkNew<vtkDoubleArray> field;
  field->SetName("TwoU");
  field->SetNumberOfComponents(2);
  for (int i = 0; i < n; ++i)
  {
    const double u = 2.0 * unit(random);
    const double v = unit(random);
    points->InsertNextPoint(shape(u, v).data());
    uv->InsertNextTuple2(u, v);
    field->InsertNextTuple2(2.0 * u, v - u);
  }
  auto data = vtkSmartPointer<Data>::New();
  data->SetPoints(points);
  data->GetPointData()->AddArray(uv);
  data->GetPointData()->AddArray(field);
  return data;
}

std::array<double, 3> Saddle(double u, double v)
{
  return { u, v, 1.0 + u * v - 0.5 * u * u };
}

std::array<double, 3> Wave(double u, double v)
{
  return { u, v, std::sin(4.0 * u) * std::cos(3.0 * v) };
}

double Number(vtkSplineSurfaceFit* filter, const char* name)
{
  auto* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  return table->GetValueByName(table->GetNumberOfRows() - 1, name).ToDouble();
}

vtkPointSet* PointsOf(vtkSplineSurfaceFit* filter)
{
  return vtkPointSet::SafeDownCast(filter->GetOutputDataObject(1));
}

/// Values of the surface and of a field at parameters, by the filter of evaluation.
vtkSmartPointer<vtkPolyData> Evaluate(vtkSplineSurfaceFit* filter, vtkDataArray* uv)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < uv->GetNumberOfTuples(); ++i)
  {
    points->InsertNextPoint(uv->GetComponent(i, 0), uv->GetComponent(i, 1), 0.0);
  }
  vtkNew<vtkPolyData> at;
  at->SetPoints(points);
  vtkNew<vtkSplineEvaluate> evaluate;
  evaluate->SetInputConnection(0, filter->GetOutputPort(0));
  evaluate->SetInputData(1, at);
  evaluate->Update();
  return vtkPolyData::SafeDownCast(evaluate->GetOutputDataObject(0));
}

TEST(SplineSurfaceFit, ReproducesASplineOfItsSpace_ExactOracle)
{
  for (int space : { vtkSplineSurfaceFit::LR, vtkSplineSurfaceFit::THB })
  {
    const auto cloud = MakeCloud<vtkPolyData>(Saddle);
    vtkNew<vtkSplineSurfaceFit> filter;
    filter->SetInputData(cloud);
    filter->SetSpace(space);
    filter->SetSmoothing(0.0);
    filter->SetTolerance(1e-9);
    filter->AddFieldArray("TwoU");
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), 0U);
    // a biquadratic function; equations are solved to some 1e-11 of the values
    EXPECT_LT(Number(filter, "MaxError"), 1e-10);
    EXPECT_EQ(Number(filter, "PointsOutside"), 0);
    const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
    ASSERT_EQ(model.Patches.size(), 1U);
    const auto& surface = std::get<Spline<2>>(model.Patches[0].Geometry);
    EXPECT_EQ(surface.Space->Kind == SpaceKind::LocallyRefined, space == vtkSplineSurfaceFit::LR);
    ASSERT_EQ(model.Patches[0].Fields.size(), 1U);
    EXPECT_EQ(model.Patches[0].Fields[0].Name, "TwoU");
    const auto values = Evaluate(filter, cloud->GetPointData()->GetArray("Uv"));
    vtkDataArray* field = values->GetPointData()->GetArray("TwoU");
    ASSERT_TRUE(field);
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_NEAR(values->GetPoint(i)[c], cloud->GetPoint(i)[c], 1e-10);
      }
      for (int c = 0; c < 2; ++c)
      {
        EXPECT_NEAR(field->GetComponent(i, c),
          cloud->GetPointData()->GetArray("TwoU")->GetComponent(i, c), 1e-10);
      }
    }
  }
}

TEST(SplineSurfaceFit, DistancesAreThoseOfTheOutput_CrossOracle)
{
  const Shape roll = [](double u, double v) {
    return std::array<double, 3>{ std::cos(u), std::sin(u), v + 0.1 * u * u * u };
  };
  const auto cloud = MakeCloud<vtkPolyData>(roll);
  for (bool given : { false, true })
  {
    // the array by name, or UV as other filters leave it
    const auto data = vtkSmartPointer<vtkPolyData>::New();
    data->ShallowCopy(cloud);
    vtkNew<vtkDoubleArray> uv;
    uv->DeepCopy(cloud->GetPointData()->GetArray("Uv"));
    uv->SetName("UV");
    vtkNew<vtkSplineSurfaceFit> filter;
    filter->SetParameterization(vtkSplineSurfaceFit::GIVEN);
    given ? filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Uv")
          : void(data->GetPointData()->AddArray(uv));
    filter->SetInputData(data);
    filter->SetTolerance(1e-3);
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), 0U);
    const auto values = Evaluate(filter, cloud->GetPointData()->GetArray("Uv"));
    vtkDataArray* distance = PointsOf(filter)->GetPointData()->GetArray("Distance");
    double largest = 0.0;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      double p[3];
      double q[3];
      values->GetPoint(i, p);
      cloud->GetPoint(i, q);
      const double d = std::sqrt(vtkMath::Distance2BetweenPoints(p, q));
      EXPECT_NEAR(distance->GetComponent(i, 0), d, 1e-14);
      largest = std::max(largest, d);
    }
    EXPECT_LE(largest, 1e-3);
    EXPECT_NEAR(largest, Number(filter, "MaxError"), 1e-14);
    EXPECT_EQ(PointsOf(filter)->GetPointData()->GetArray("UV")->GetNumberOfComponents(), 2);
  }
}

TEST(SplineSurfaceFit, TrianglesGiveParameters_PropertyOracle)
{
  // a rolled sheet cannot be projected on a plane, but it can be laid into one
  constexpr int n = 24;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> triangles;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= 2 * n; ++i)
    {
      const double angle = 4.5 * i / (2.0 * n);
      points->InsertNextPoint(std::cos(angle), std::sin(angle), 1.0 * j / n);
    }
  }
  for (vtkIdType j = 0; j < n; ++j)
  {
    for (vtkIdType i = 0; i < 2 * n; ++i)
    {
      const vtkIdType a = i + j * (2 * n + 1);
      const vtkIdType b = a + 2 * n + 1;
      triangles->InsertNextCell({ a, a + 1, b + 1 });
      triangles->InsertNextCell({ a, b + 1, b });
    }
  }
  vtkNew<vtkPolyData> sheet;
  sheet->SetPoints(points);
  sheet->SetPolys(triangles);
  vtkNew<vtkSplineSurfaceFit> filter;
  filter->SetInputData(sheet);
  filter->SetParameterization(vtkSplineSurfaceFit::COMPUTED);
  filter->SetTolerance(1e-3);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), 0U);
  EXPECT_LE(Number(filter, "MaxError"), 1e-3);
  EXPECT_EQ(Number(filter, "PointsOutside"), 0);
}

TEST(SplineSurfaceFit, OutputsFollowTheInput_PropertyOracle)
{
  const auto cloud = MakeCloud<vtkUnstructuredGrid>(Wave);
  vtkNew<vtkSplineSurfaceFit> filter;
  filter->SetInputData(cloud);
  filter->SetTolerance(0.01);
  filter->SetFeatureGridSize(8);
  filter->AllFieldsOn();
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), 0U);
  EXPECT_TRUE(vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(1)));
  EXPECT_EQ(PointsOf(filter)->GetNumberOfPoints(), cloud->GetNumberOfPoints());
  EXPECT_EQ(cloud->GetPointData()->GetArray("Distance"), nullptr); // the input is left alone
  const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
  EXPECT_EQ(model.Patches[0].Fields.size(), 2U);
  auto* image = vtkImageData::SafeDownCast(filter->GetOutputDataObject(3));
  EXPECT_EQ(image->GetNumberOfCells(), 64);
  const double* bounds = image->GetBounds();
  const double* box = cloud->GetBounds();
  for (int side = 0; side < 4; ++side)
  {
    EXPECT_NEAR(bounds[side], box[side], 1e-14);
  }
  double points = 0.0;
  for (vtkIdType c = 0; c < 64; ++c)
  {
    points += image->GetCellData()->GetArray("NumPoints")->GetComponent(c, 0);
  }
  EXPECT_EQ(points, cloud->GetNumberOfPoints());
  filter->SetFeatureGridSize(0);
  filter->Update();
  EXPECT_EQ(image->GetNumberOfCells(), 0);
  // another kind of input
  filter->SetInputData(MakeCloud<vtkPolyData>(Wave));
  filter->Update();
  EXPECT_TRUE(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1)));
}

// Each property of the filter gives what the kernel gives for its parameter, and another surface
// than without it.
TEST(SplineSurfaceFit, EveryPropertyReachesTheKernel_CrossOracle)
{
  using F = vtkSplineSurfaceFit;
  struct Change
  {
    const char* Name;
    std::function<void(F*)> Set;
    std::function<void(FitParams&)> Expect;
  };
  // In groups: the first of each is what the others of it change.
  const std::vector<std::vector<Change>> groups = {
    {
      { "nothing", [](F*) {}, [](FitParams&) {} },
      { "Space", [](F* f) { f->SetSpace(F::THB); },
        [](FitParams& p) { p.Space = FitSpace::Hierarchical; } },
      { "Degree", [](F* f) { f->SetDegree(3); },
        [](FitParams& p) {
          p.Degree = { 3, 3 };
        } },
      { "SecondDegree", [](F* f) { f->SetSecondDegree(4); },
        [](FitParams& p) {
          p.Degree = { 2, 4 };
        } },
      { "InitialElementsU", [](F* f) { f->SetInitialElementsU(3); },
        [](FitParams& p) {
          p.NumInitialElements = { 3, 0 };
        } },
      { "InitialElementsV", [](F* f) { f->SetInitialElementsV(7); },
        [](FitParams& p) {
          p.NumInitialElements = { 0, 7 };
        } },
      { "Domain", [](F* f) { f->SetDomain(-0.5, 2.5, -0.25, 1.5); },
        [](FitParams& p) {
          p.Domain = { { -0.5, -0.25 }, { 2.5, 1.5 } };
        } },
      { "Method", [](F* f) { f->SetMethod(F::MBA); },
        [](FitParams& p) { p.Method = FitMethod::MultilevelApproximation; } },
      { "Smoothing", [](F* f) { f->SetSmoothing(1e-3); },
        [](FitParams& p) { p.Smoothing = 1e-3; } },
      { "Tolerance", [](F* f) { f->SetTolerance(0.05); },
        [](FitParams& p) { p.Tolerance = 0.05; } },
      { "ToleranceBox", [](F* f) { f->AddToleranceBox(0.0, 1.0, 0.25, 0.75, 1e-4); },
        [](FitParams& p) {
          p.ToleranceBoxes = { { { { 0.0, 0.25 }, { 1.0, 0.75 } }, 1e-4 } };
        } },
      { "DistanceMode",
        [](F* f)
        {
          f->SetDistanceMode(F::VALUE_DISTANCE);
          f->SetDistanceSlope(0.1);
        },
        [](FitParams& p)
        {
          p.Distance = FitDistance::Value;
          p.DistanceSlope = 0.1;
        } },
      { "ToleranceFactorAbove", [](F* f) { f->SetToleranceFactorAbove(3.0); },
        [](FitParams& p) { p.ToleranceFactorAbove = 3.0; } },
      { "ToleranceFactorBelow", [](F* f) { f->SetToleranceFactorBelow(0.25); },
        [](FitParams& p) { p.ToleranceFactorBelow = 0.25; } },
      { "Side above", [](F* f) { f->SetSide(F::ABOVE); },
        [](FitParams& p) { p.Side = FitSide::Above; } },
      { "Side below", [](F* f) { f->SetSide(F::BELOW); },
        [](FitParams& p) { p.Side = FitSide::Below; } },
      { "MaximumIterations", [](F* f) { f->SetMaximumIterations(1); },
        [](FitParams& p) { p.MaxIterations = 1; } },
      { "MaximumFunctions", [](F* f) { f->SetMaximumFunctions(60); },
        [](FitParams& p) { p.MaxFunctions = 60; } },
      { "MaximumSeconds", [](F* f) { f->SetMaximumSeconds(1e-9); },
        [](FitParams& p) { p.MaxSeconds = 1e-9; } },
      { "Threshold all", [](F* f) { f->SetThreshold(F::ALL_ELEMENTS); },
        [](FitParams& p) { p.Threshold = FitThreshold::All; } },
      { "Threshold most points", [](F* f) { f->SetThreshold(F::MOST_POINTS); },
        [](FitParams& p) { p.Threshold = FitThreshold::MostPoints; } },
      { "ThresholdShare", [](F* f) { f->SetThresholdShare(0.7); },
        [](FitParams& p) { p.ThresholdShare = 0.7; } },
      { "Directions both", [](F* f) { f->SetDirections(F::BOTH_DIRECTIONS); },
        [](FitParams& p) { p.Directions = FitDirections::Both; } },
      { "Directions alternating", [](F* f) { f->SetDirections(F::ALTERNATING); },
        [](FitParams& p) { p.Directions = FitDirections::Alternating; } },
      { "Strategy minimum span", [](F* f) { f->SetStrategy(F::MINIMUM_SPAN); },
        [](FitParams& p) { p.Strategy = LRStrategy::MinimumSpan; } },
      { "Strategy restricted mesh", [](F* f) { f->SetStrategy(F::RESTRICTED_MESH); },
        [](FitParams& p) { p.Strategy = LRStrategy::RestrictedMesh; } },
      { "LaterStrategy",
        [](F* f)
        {
          f->SetStrategySwitch(1);
          f->SetLaterStrategy(F::STRUCTURED_MESH);
        },
        [](FitParams& p)
        {
          p.StrategySwitch = 1;
          p.LaterStrategy = LRStrategy::StructuredMesh;
        } },
      { "StrategySwitch",
        [](F* f)
        {
          f->SetStrategySwitch(2);
          f->SetLaterStrategy(F::STRUCTURED_MESH);
        },
        [](FitParams& p)
        {
          p.StrategySwitch = 2;
          p.LaterStrategy = LRStrategy::StructuredMesh;
        } },
      { "Strategy structured mesh", [](F* f) { f->SetStrategy(F::STRUCTURED_MESH); },
        [](FitParams& p) { p.Strategy = LRStrategy::StructuredMesh; } },
      { "MinimumElementSize", [](F* f) { f->SetMinimumElementSize(0.2); },
        [](FitParams& p) { p.MinElementSize = 0.2; } },
      { "significant points",
        [](F* f)
        { f->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Near"); },
        [](FitParams&) {} },
    },
    {
      { "significant points",
        [](F* f)
        { f->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Near"); },
        [](FitParams&) {} },
      { "SignificantWeight",
        [](F* f)
        {
          f->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Near");
          f->SetSignificantWeight(500.0);
        },
        [](FitParams& p) { p.SignificantWeight = 500.0; } },
    },
    {
      { "distance of points",
        [](F* f)
        {
          f->SetDistanceMode(F::POINT_DISTANCE);
          f->SetDistanceSlope(0.05);
        },
        [](FitParams& p)
        {
          p.Distance = FitDistance::Point;
          p.DistanceSlope = 0.05;
        } },
      { "DistanceSlope",
        [](F* f)
        {
          f->SetDistanceMode(F::POINT_DISTANCE);
          f->SetDistanceSlope(0.2);
        },
        [](FitParams& p)
        {
          p.Distance = FitDistance::Point;
          p.DistanceSlope = 0.2;
        } },
      { "DistanceCentre",
        [](F* f)
        {
          f->SetDistanceMode(F::POINT_DISTANCE);
          f->SetDistanceSlope(0.05);
          f->SetDistanceCentre(2.0, 1.0);
        },
        [](FitParams& p)
        {
          p.Distance = FitDistance::Point;
          p.DistanceSlope = 0.05;
          p.DistanceCentre = { 2.0, 1.0 };
        } },
    },
    {
      { "combined", [](F* f) { f->SetMethod(F::COMBINED); },
        [](FitParams& p) { p.Method = FitMethod::Combined; } },
      { "SwitchIteration",
        [](F* f)
        {
          f->SetMethod(F::COMBINED);
          f->SetSwitchIteration(1);
        },
        [](FitParams& p)
        {
          p.Method = FitMethod::Combined;
          p.SwitchIteration = 1;
        } },
    },
    {
      { "outliers", [](F* f) { f->FindOutliersOn(); },
        [](FitParams& p) { p.FindOutliers = true; } },
      { "FindOutliers", [](F*) {}, [](FitParams&) {} },
      { "OutlierScale",
        [](F* f)
        {
          f->FindOutliersOn();
          f->SetOutlierScale(1000.0);
        },
        [](FitParams& p)
        {
          p.FindOutliers = true;
          p.OutlierScale = 1000.0;
        } },
      { "OutlierDeviation",
        [](F* f)
        {
          f->FindOutliersOn();
          f->SetOutlierDeviation(F::STANDARD);
        },
        [](FitParams& p)
        {
          p.FindOutliers = true;
          p.OutlierDeviation = FitDeviation::Standard;
        } },
      { "Criterion AIC",
        [](F* f)
        {
          f->SetTolerance(1e-5);
          f->SetCriterion(F::AIC);
        },
        [](FitParams& p)
        {
          p.Tolerance = 1e-5;
          p.Criterion = FitCriterion::AIC;
        } },
      { "Criterion BIC",
        [](F* f)
        {
          f->SetTolerance(1e-5);
          f->SetCriterion(F::BIC);
        },
        [](FitParams& p)
        {
          p.Tolerance = 1e-5;
          p.Criterion = FitCriterion::BIC;
        } },
    },
  };
  // a wave with a ridge and a few points far above it
  const Shape ridge = [](double u, double v) {
    return std::array<double, 3>{ u, v, Wave(u, v)[2] + std::exp(-90.0 * std::fabs(u - v)) };
  };
  const auto data = MakeCloud<vtkPolyData>(ridge, 3000);
  PointCloud cloud;
  cloud.Parameters.resize(data->GetNumberOfPoints(), 2);
  cloud.Values.resize(data->GetNumberOfPoints(), 1);
  vtkNew<vtkDoubleArray> near;
  near->SetName("Near");
  std::vector<std::uint8_t> significant;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    double x[3];
    data->GetPoint(i, x);
    x[2] += i % 300 == 7 ? 3.0 : 0.0;
    data->GetPoints()->SetPoint(i, x);
    cloud.Parameters.row(i) << x[0], x[1];
    cloud.Values(i, 0) = x[2];
    near->InsertNextValue(x[0] < 0.5 ? 1.0 : 0.0);
    significant.push_back(x[0] < 0.5);
  }
  data->GetPointData()->AddArray(near);
  for (const auto& group : groups)
  {
    PointMatrix base;
    for (const Change& change : group)
    {
      SCOPED_TRACE(change.Name);
      vtkNew<F> filter;
      vtkNew<MessageRecorder> recorder; // of warnings about points outside
      recorder->Watch(filter);
      filter->SetInputData(data);
      filter->SetTolerance(0.01);
      filter->SetMaximumIterations(5);
      change.Set(filter);
      filter->Update();
      ASSERT_EQ(filter->GetErrorCode(), 0U);
      FitParams params;
      params.Tolerance = 0.01;
      params.MaxIterations = 5;
      change.Expect(params);
      vtkInformation* array = filter->GetInputArrayInformation(2);
      const char* name = array->Get(vtkDataObject::FIELD_NAME());
      cloud.Significant =
        name && std::string(name) == "Near" ? significant : std::vector<std::uint8_t>{};
      const auto kernel = FitSurface(cloud, params);
      ASSERT_TRUE(kernel) << kernel.Status.Message();
      const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
      const PointMatrix found = std::get<Spline<2>>(model.Patches[0].Geometry).ControlPoints.col(2);
      EXPECT_EQ(found, PointMatrix(kernel->Surface.ControlPoints));
      const bool isSame = found.rows() == base.rows() && found == base;
      EXPECT_FALSE(isSame) << "the property changes nothing";
      if (base.size() == 0)
      {
        base = found;
      }
    }
  }
}

// Cliffs across the elements: short lines cross near one another, and in one cloud in four or so
// functions become dependent.
TEST(SplineSurfaceFit, IndependentReachesTheKernel_CrossOracle)
{
  const auto verdict = [](std::uint64_t seed, bool independent)
  {
    std::mt19937_64 random(seed);
    const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (int i = 0; i < 3000; ++i)
    {
      const double x = unit();
      const double y = unit();
      points->InsertNextPoint(
        x, y, std::tanh((x - y) / 0.01) + std::tanh((x * x + y * y - 0.5) / 0.01));
    }
    vtkNew<vtkPolyData> cloud;
    cloud->SetPoints(points);
    vtkNew<vtkSplineSurfaceFit> filter;
    filter->SetInputData(cloud);
    filter->SetTolerance(0.05);
    filter->SetDegree(3);
    filter->SetDirections(vtkSplineSurfaceFit::BOTH_DIRECTIONS);
    filter->SetStrategy(vtkSplineSurfaceFit::MINIMUM_SPAN);
    filter->SetIndependent(independent);
    filter->Update();
    const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
    const auto decided = DecideDependence(*std::get<Spline<2>>(model.Patches[0].Geometry).Space);
    EXPECT_TRUE(decided) << decided.Status.Message();
    return decided.Value.Verdict;
  };
  std::uint64_t seed = 3;
  while (seed < 100 && verdict(seed, false) != LRVerdict::Dependent)
  {
    ++seed;
  }
  ASSERT_LT(seed, 100U) << "no cloud makes functions dependent";
  EXPECT_EQ(verdict(seed, true), LRVerdict::Independent);
}

TEST(SplineSurfaceFit, FloatPointsAreTakenAsTheyAre_CrossOracle)
{
  const auto doubles = MakeCloud<vtkPolyData>(Wave);
  const auto floats = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> single;
  single->SetDataTypeToFloat();
  vtkNew<vtkPoints> rounded;
  rounded->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < doubles->GetNumberOfPoints(); ++i)
  {
    single->InsertNextPoint(doubles->GetPoint(i));
    rounded->InsertNextPoint(single->GetPoint(i));
  }
  floats->SetPoints(single);
  doubles->SetPoints(rounded);
  vtkNew<vtkSplineSurfaceFit> filter;
  filter->SetTolerance(0.01);
  filter->SetInputData(floats);
  filter->Update();
  const SplineModel first = DecodePatches(filter->GetOutputDataObject(0));
  filter->SetInputData(doubles);
  filter->Update();
  const SplineModel second = DecodePatches(filter->GetOutputDataObject(0));
  EXPECT_EQ(std::get<Spline<2>>(first.Patches[0].Geometry).ControlPoints,
    std::get<Spline<2>>(second.Patches[0].Geometry).ControlPoints);
}

TEST(SplineSurfaceFit, LimitsAreAWarning_PropertyOracle)
{
  vtkNew<vtkSplineSurfaceFit> filter;
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->SetInputData(MakeCloud<vtkPolyData>(Wave));
  filter->SetTolerance(1e-6);
  filter->SetMaximumIterations(1);
  filter->Update();
  EXPECT_TRUE(recorder->Errors.empty());
  ASSERT_EQ(recorder->Warnings.size(), 1U);
  EXPECT_NE(recorder->Warnings[0].find("farther away than their tolerance"), std::string::npos);
  EXPECT_GT(Number(filter, "PointsOutside"), 0);
  EXPECT_GT(filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), 0);
}

// Every end of a fit outside its tolerance, each from points and options that leave no other one.
TEST(SplineSurfaceFit, EveryEndIsSaidInAWarning_ExactOracle)
{
  const auto noise = [](double u, double v) -> std::array<double, 3>
  {
    const double large = 43758.5453 * std::sin(127.1 * u + 311.7 * v);
    return { u, v, large - std::floor(large) };
  };
  const auto wave = MakeCloud<vtkPolyData>(Wave);
  const auto rough = MakeCloud<vtkPolyData>(noise, 20000);
  const auto contradicting = MakeCloud<vtkPolyData>(Wave);
  double* first = static_cast<double*>(contradicting->GetPoints()->GetVoidPointer(0));
  std::copy_n(first, 2, first + 3); // another point in the first one's place
  first[5] = first[2] + 0.1;
  using Setter = std::function<void(vtkSplineSurfaceFit*)>;
  const std::tuple<const char*, vtkPolyData*, double, Setter> ends[] = {
    { "the limit of iterations is reached", wave, 1e-6,
      [](vtkSplineSurfaceFit* f) { f->SetMaximumIterations(1); } },
    { "the limit of functions is reached", wave, 1e-6,
      [](vtkSplineSurfaceFit* f) { f->SetMaximumFunctions(100); } },
    { "the limit of time is reached", wave, 1e-6,
      [](vtkSplineSurfaceFit* f) { f->SetMaximumSeconds(1e-9); } },
    { "the information criterion has ended the fit", rough, 0.01,
      [](vtkSplineSurfaceFit* f) { f->SetCriterion(vtkSplineSurfaceFit::BIC); } },
    { "elements are not split any smaller", rough, 0.01,
      [](vtkSplineSurfaceFit* f) { f->SetMinimumElementSize(0.1); } },
    { "they contradict points in the same place", contradicting, 1e-3,
      [](vtkSplineSurfaceFit*) {} },
  };
  for (const auto& [text, cloud, tolerance, set] : ends)
  {
    SCOPED_TRACE(text);
    vtkNew<vtkSplineSurfaceFit> filter;
    vtkNew<MessageRecorder> recorder;
    recorder->Watch(filter);
    filter->SetInputData(cloud);
    filter->SetTolerance(tolerance);
    set(filter);
    filter->Update();
    EXPECT_TRUE(recorder->Errors.empty());
    ASSERT_EQ(recorder->Warnings.size(), 1U);
    EXPECT_NE(recorder->Warnings[0].find(text), std::string::npos) << recorder->Warnings[0];
    EXPECT_GT(Number(filter, "PointsOutside"), 0);
  }
}

TEST(SplineSurfaceFit, UpdatesASurfaceOnlyWhereThePointsAre_ExactOracle)
{
  const double corner = 0.2;
  const auto shifted = [=](double u, double v) -> std::array<double, 3>
  {
    std::array<double, 3> point = Wave(corner * u, corner * v);
    point[2] += 0.05 * u * (2.0 - u) * v * (1.0 - v);
    return point;
  };
  for (const int space : { vtkSplineSurfaceFit::LR, vtkSplineSurfaceFit::THB })
  {
    vtkNew<vtkSplineSurfaceFit> first;
    first->SetInputData(MakeCloud<vtkPolyData>(Wave, 20000));
    first->SetSpace(space);
    first->SetTolerance(2e-3);
    first->SetDomain(0.0, 2.0, 0.0, 1.0);
    first->AddFieldArray("TwoU");
    first->Update();
    vtkNew<vtkSplineSurfaceFit> update;
    update->SetInputData(MakeCloud<vtkPolyData>(shifted, 2000, 7));
    update->SetStartConnection(first->GetOutputPort(0));
    update->SetTolerance(1e-3);
    update->SetHoldEdges(vtkSplineSurfaceFit::VALUES);
    update->SetHeldSides(1, 0, 1, 0);
    update->Update();
    ASSERT_EQ(update->GetErrorCode(), 0U);
    EXPECT_EQ(Number(update, "PointsOutside"), 0);
    // the field, which the new points do not have, is carried along; beyond the supports of the
    // functions with points nothing has changed, nor have two edges
    vtkNew<vtkDoubleArray> uv;
    uv->SetNumberOfComponents(2);
    for (int i = 0; i < 400; ++i)
    {
      uv->InsertNextTuple2(1.0 + (i % 20) / 20.0, 0.6 + 0.4 * (i / 20) / 20.0);
      uv->InsertNextTuple2(0.0, i / 400.0);
      uv->InsertNextTuple2(2.0 * i / 400.0, 0.0);
    }
    const auto before = Evaluate(first, uv);
    const auto after = Evaluate(update, uv);
    vtkDataArray* field = after->GetPointData()->GetArray("TwoU");
    ASSERT_TRUE(field);
    for (vtkIdType i = 0; i < before->GetNumberOfPoints(); ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_NEAR(before->GetPoint(i)[c], after->GetPoint(i)[c], 1e-14);
      }
      EXPECT_NEAR(field->GetComponent(i, 0), 2.0 * uv->GetComponent(i, 0), 5e-3);
      EXPECT_NEAR(field->GetComponent(i, 0),
        before->GetPointData()->GetArray("TwoU")->GetComponent(i, 0), 1e-13);
    }
  }
}

TEST(SplineSurfaceFit, ParametersAreThoseOfTheStartsClosestPoints_CrossOracle)
{
  // a quarter of a cylinder, and points 0.01 outside of a part of it: no plane gives parameters
  const auto cylinder = [](double radius)
  {
    return [=](double u, double v) -> std::array<double, 3> {
      return { radius * std::cos(1.5 * u), radius * std::sin(1.5 * u), v };
    };
  };
  vtkNew<vtkSplineSurfaceFit> first;
  first->SetInputData(MakeCloud<vtkPolyData>(cylinder(1.0), 5000));
  first->SetParameterization(vtkSplineSurfaceFit::GIVEN);
  first->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Uv");
  first->SetTolerance(1e-4);
  first->Update();
  ASSERT_EQ(Number(first, "PointsOutside"), 0);
  const auto cloud = MakeCloud<vtkPolyData>(cylinder(1.01), 2000, 5);
  vtkNew<vtkSplineSurfaceFit> update;
  update->SetInputData(cloud);
  update->SetStartConnection(first->GetOutputPort(0));
  update->SetParameterization(vtkSplineSurfaceFit::COMPUTED);
  update->SetTolerance(1e-3);
  update->Update();
  ASSERT_EQ(update->GetErrorCode(), 0U);
  EXPECT_EQ(Number(update, "PointsOutside"), 0);
  vtkDataArray* found = PointsOf(update)->GetPointData()->GetArray("UV");
  vtkDataArray* given = cloud->GetPointData()->GetArray("Uv");
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    // the start is within 1e-4 of the cylinder, its tangents within some 1e-2
    EXPECT_NEAR(found->GetComponent(i, 0), given->GetComponent(i, 0), 1e-3);
    EXPECT_NEAR(found->GetComponent(i, 1), given->GetComponent(i, 1), 1e-3);
  }
}

TEST(SplineSurfaceFit, ElementsHaveFeatures_CrossOracle)
{
  vtkNew<vtkSplineSurfaceFit> fit;
  fit->SetInputData(MakeCloud<vtkPolyData>(Wave));
  fit->SetTolerance(1e-3);
  fit->SetFeatureGridSize(4);
  fit->Update();
  auto* elements = vtkPolyData::SafeDownCast(fit->GetOutputDataObject(4));
  ASSERT_TRUE(elements);
  EXPECT_EQ(elements->GetNumberOfCells(), 0);
  fit->ElementFeaturesOn();
  fit->Update();
  auto* surface = vtkUnstructuredGrid::SafeDownCast(fit->GetOutputDataObject(0));
  elements = vtkPolyData::SafeDownCast(fit->GetOutputDataObject(4));
  EXPECT_EQ(elements->GetNumberOfCells(), surface->GetNumberOfCells());
  vtkCellData* own = surface->GetCellData();
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    // the cell's own box: z of its points lies about the feature, and its corners are the element's
    const double* bounds = surface->GetCell(c)->GetBounds();
    const double* box = elements->GetCell(c)->GetBounds();
    for (int side = 0; side < 4; ++side)
    {
      EXPECT_NEAR(bounds[side], box[side], 1e-14);
    }
    EXPECT_EQ(own->GetArray("ElementId")->GetComponent(c, 0),
      elements->GetCellData()->GetArray("ElementId")->GetComponent(c, 0));
    EXPECT_GE(own->GetArray("Height")->GetComponent(c, 0), bounds[4] - 1e-14);
    EXPECT_LE(own->GetArray("Height")->GetComponent(c, 0), bounds[5] + 1e-14);
  }
  for (const char* name : FitFeatureNames)
  {
    vtkDataArray* of = own->GetArray(name);
    vtkDataArray* same = elements->GetCellData()->GetArray(name);
    ASSERT_TRUE(of && same) << name;
    EXPECT_EQ(of->GetDataType(), std::string(name).rfind("Num", 0) == 0 ? VTK_INT : VTK_DOUBLE);
    for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
    {
      EXPECT_EQ(of->GetComponent(c, 0), same->GetComponent(c, 0));
    }
    EXPECT_TRUE(
      vtkImageData::SafeDownCast(fit->GetOutputDataObject(3))->GetCellData()->HasArray(name));
  }
  // a layer and a set of elements an iteration
  fit->FeatureIterationsOn();
  fit->Update();
  auto* table = vtkTable::SafeDownCast(fit->GetOutputDataObject(2));
  auto* image = vtkImageData::SafeDownCast(fit->GetOutputDataObject(3));
  elements = vtkPolyData::SafeDownCast(fit->GetOutputDataObject(4));
  const vtkIdType rows = table->GetNumberOfRows();
  ASSERT_GT(rows, 2);
  EXPECT_EQ(image->GetNumberOfCells(), 16 * rows);
  vtkIdType cell = 0;
  for (vtkIdType r = 0; r < rows; ++r)
  {
    double outside = 0.0;
    for (vtkIdType c = 0; c < 16; ++c)
    {
      outside += image->GetCellData()->GetArray("NumOutside")->GetComponent(16 * r + c, 0);
    }
    EXPECT_EQ(outside, table->GetValueByName(r, "PointsOutside").ToDouble());
    for (int e = 0; e < table->GetValueByName(r, "Elements").ToInt(); ++e, ++cell)
    {
      EXPECT_EQ(elements->GetCellData()->GetArray("Iteration")->GetComponent(cell, 0), r);
      EXPECT_EQ(elements->GetCellData()->GetArray("ElementId")->GetComponent(cell, 0), e);
    }
  }
  EXPECT_EQ(cell, elements->GetNumberOfCells());
}

TEST(SplineSurfaceFit, ParametersAreCorrected_CrossOracle)
{
  // a quarter of a cylinder with parameters that run at another pace and wave
  const auto cloud = MakeCloud<vtkPolyData>(
    [](double u, double v) -> std::array<double, 3>
    {
      const double angle = 0.7 * u + 0.02 * std::sin(40.0 * v);
      return { std::cos(angle), std::sin(angle), v };
    });
  for (const bool isCorrected : { false, true })
  {
    vtkNew<vtkSplineSurfaceFit> fit;
    fit->SetInputData(cloud);
    fit->SetParameterization(vtkSplineSurfaceFit::GIVEN);
    fit->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Uv");
    fit->SetTolerance(2e-3);
    fit->SetCorrectParameters(isCorrected);
    fit->Update();
    EXPECT_EQ(Number(fit, "PointsOutside"), 0);
    // the array says the parameters that count
    vtkDataArray* uv = PointsOf(fit)->GetPointData()->GetArray("UV");
    vtkDataArray* distance = PointsOf(fit)->GetPointData()->GetArray("Distance");
    const auto on = Evaluate(fit, uv);
    double moved = 0.0;
    for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
    {
      EXPECT_NEAR(std::sqrt(vtkMath::Distance2BetweenPoints(on->GetPoint(i), cloud->GetPoint(i))),
        distance->GetComponent(i, 0), 1e-13);
      moved = std::max(moved,
        std::fabs(
          uv->GetComponent(i, 0) - cloud->GetPointData()->GetArray("Uv")->GetComponent(i, 0)));
    }
    EXPECT_EQ(moved > 1e-3, isCorrected);
    EXPECT_EQ(Number(fit, "Functions") < 200, isCorrected) << Number(fit, "Functions");
  }
}

TEST(SplineSurfaceFit, StartsThatCannotBeTakenAreErrors_ExactOracle)
{
  using F = vtkSplineSurfaceFit;
  const auto fitted = [](const Shape& shape, int parameterization)
  {
    vtkNew<F> fit;
    fit->SetInputData(MakeCloud<vtkPolyData>(shape));
    fit->SetTolerance(1.0);
    fit->SetParameterization(parameterization);
    fit->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Uv");
    fit->Update();
    return vtkSmartPointer<vtkDataObject>(fit->GetOutputDataObject(0));
  };
  const auto source = [](int shape)
  {
    vtkNew<vtkSplineSource> made;
    made->SetShape(shape);
    made->Update();
    return vtkSmartPointer<vtkDataObject>(made->GetOutputDataObject(0));
  };
  const auto twisted = fitted(
    [](double u, double v) -> std::array<double, 3> {
      return { v, u, u * v };
    },
    F::GIVEN);
  struct Case
  {
    const char* Name;
    vtkSmartPointer<vtkDataObject> Start;
    std::function<void(F*)> Set;
    ErrorCode Code;
    const char* Words;
  };
  const Case cases[] = {
    { "empty", vtkSmartPointer<vtkUnstructuredGrid>::New(), [](F*) {}, ErrorCode::EmptyInput,
      "0 patches" },
    { "curve", source(vtkSplineSource::LINE), [](F*) {}, ErrorCode::DimensionMismatch,
      "not a surface" },
    { "rational", source(vtkSplineSource::ANNULUS_SECTOR), [](F*) {}, ErrorCode::InvalidWeight,
      "rational" },
    { "no height field", twisted, [](F*) {}, ErrorCode::InvalidParameter, "height field" },
    { "no field", fitted(Wave, F::HEIGHT_FIELD), [](F* f) { f->AddFieldArray("TwoU"); },
      ErrorCode::InvalidParameter, "'TwoU'" },
    { "side", fitted(Wave, F::HEIGHT_FIELD),
      [](F* f)
      {
        f->SetHoldEdges(F::VALUES);
        f->SetSide(F::ABOVE);
      },
      ErrorCode::InvalidParameter, "one side" },
    { "outside",
      fitted(
        [](double u, double v) -> std::array<double, 3> {
          return { 0.5 * u, v, u };
        },
        F::HEIGHT_FIELD),
      [](F*) {}, ErrorCode::OutsideDomain, "domain of the start" },
    { "no start", nullptr, [](F* f) { f->SetHoldEdges(F::VALUES); }, ErrorCode::InvalidParameter,
      "start surface" },
  };
  for (const Case& test : cases)
  {
    SCOPED_TRACE(test.Name);
    vtkNew<F> filter;
    vtkNew<MessageRecorder> recorder;
    recorder->Watch(filter);
    filter->SetInputData(MakeCloud<vtkPolyData>(Wave, 200));
    if (test.Start)
    {
      filter->SetStartData(test.Start);
    }
    test.Set(filter);
    filter->Update();
    EXPECT_EQ(
      filter->GetErrorCode(), vtkErrorCode::UserError + static_cast<unsigned long>(test.Code));
    ASSERT_FALSE(recorder->Errors.empty());
    EXPECT_NE(recorder->Errors[0].find(test.Words), std::string::npos) << recorder->Errors[0];
    for (int port = 0; port < 4; ++port)
    {
      EXPECT_EQ(filter->GetOutputDataObject(port)->GetNumberOfElements(vtkDataObject::POINT), 0);
    }
  }
}

TEST(SplineSurfaceFit, PointsOnHeldEdgesAreSaidInAWarning_ExactOracle)
{
  vtkNew<vtkSplineSurfaceFit> first;
  first->SetInputData(MakeCloud<vtkPolyData>(Wave));
  first->SetTolerance(1e-2);
  first->SetDomain(0.0, 2.0, 0.0, 1.0);
  first->Update();
  const auto cloud = MakeCloud<vtkPolyData>(Wave);
  cloud->GetPoints()->SetPoint(17, 0.0, 0.5, 3.0);
  vtkNew<vtkSplineSurfaceFit> update;
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(update);
  update->SetInputData(cloud);
  update->SetStartConnection(first->GetOutputPort(0));
  update->SetTolerance(1e-2);
  update->SetHoldEdges(vtkSplineSurfaceFit::DERIVATIVES);
  update->Update();
  ASSERT_EQ(recorder->Warnings.size(), 1U);
  EXPECT_NE(
    recorder->Warnings[0].find("edges of the start surface that are held"), std::string::npos);
  EXPECT_EQ(Number(update, "PointsOutside"), 1);
}

TEST(SplineSurfaceFit, ControlPointsOfASplineAreNotFitted_ExactOracle)
{
  vtkNew<vtkSplineSource> source;
  source->Update();
  vtkNew<vtkSplineSurfaceFit> filter;
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->SetInputDataObject(source->GetOutputDataObject(0));
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(),
    vtkErrorCode::UserError + static_cast<unsigned long>(ErrorCode::InvalidParameter));
  ASSERT_FALSE(recorder->Errors.empty());
  EXPECT_NE(recorder->Errors[0].find("control points"), std::string::npos);
}

/// A sphere over [0, 2] x [0, 1]: longitude and latitude from parameters, x and y as another array.
TEST(SplineSurfaceFit, LayersAreRefusedInEveryParameterization_ExactOracle)
{
  const double pi = std::acos(-1.0);
  const auto sphere = MakeCloud<vtkPolyData>(
    [pi](double u, double v) -> std::array<double, 3>
    {
      const double z = 2.0 * v - 1.0;
      const double r = std::sqrt(1.0 - z * z);
      return { r * std::cos(pi * u), r * std::sin(pi * u), z };
    });
  vtkNew<vtkDoubleArray> projected;
  projected->SetName("XY");
  projected->SetNumberOfComponents(2);
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    projected->InsertNextTuple2(sphere->GetPoint(i)[0], sphere->GetPoint(i)[1]);
  }
  sphere->GetPointData()->AddArray(projected);
  const auto run = [&](int parameterization, const char* parameters, int side)
  {
    vtkNew<vtkSplineSurfaceFit> filter;
    filter->SetInputData(sphere);
    filter->SetParameterization(parameterization);
    filter->SetSide(side);
    filter->SetTolerance(0.1);
    filter->SetMaximumIterations(1);
    filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, parameters);
    vtkNew<MessageRecorder> recorder;
    recorder->Watch(filter);
    filter->Update();
    return recorder->Errors.empty() ? std::string() : recorder->Errors[0];
  };
  using Fit = vtkSplineSurfaceFit;
  for (const int parameterization : { Fit::HEIGHT_FIELD, Fit::GIVEN, Fit::COMPUTED })
  {
    const std::string message = run(parameterization, "XY", Fit::BOTH_SIDES);
    EXPECT_NE(message.find("layers"), std::string::npos) << message;
    EXPECT_NE(message.find("`trim`"), std::string::npos) << message;
  }
  EXPECT_EQ(run(Fit::GIVEN, "Uv", Fit::BOTH_SIDES), "");
  EXPECT_EQ(run(Fit::HEIGHT_FIELD, "XY", Fit::ABOVE), ""); // an envelope
}

TEST(SplineSurfaceFit, EveryFailureIsOneErrorWithItsPlace_ExactOracle)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case
  {
    const char* Name;
    std::function<void(vtkSplineSurfaceFit*, vtkPolyData*)> Spoil;
    ErrorCode Code;
    const char* Words;
  };
  const auto array = [](int index, const char* name)
  {
    return [=](vtkSplineSurfaceFit* filter, vtkPolyData*)
    { filter->SetInputArrayToProcess(index, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name); };
  };
  const auto add = [](vtkPolyData* data, const char* name, double value)
  {
    vtkNew<vtkDoubleArray> values;
    values->SetName(name);
    values->SetNumberOfTuples(data->GetNumberOfPoints());
    values->Fill(0.1);
    values->SetValue(17, value);
    data->GetPointData()->AddArray(values);
  };
  const std::vector<Case> cases = {
    { "empty", [](auto*, auto* data) { data->Initialize(); }, ErrorCode::EmptyInput, "no points" },
    { "nan", [=](auto*, auto* data) { data->GetPoints()->SetPoint(17, 0.0, nan, 0.0); },
      ErrorCode::NonFiniteInput, "17" },
    { "huge", [](auto*, auto* data) { data->GetPoints()->SetPoint(17, 0.0, 0.0, 1e61); },
      ErrorCode::TooLarge, "point 17" },
    { "tolerance name", array(1, "none"), ErrorCode::InvalidParameter, "'none'" },
    { "significant name", array(2, "none"), ErrorCode::InvalidParameter, "'none'" },
    { "tolerance zero",
      [=](auto* filter, auto* data)
      {
        add(data, "Limit", 0.0);
        array(1, "Limit")(filter, data);
      },
      ErrorCode::InvalidParameter, "17" },
    { "field name", [](auto* filter, auto*) { filter->AddFieldArray("none"); },
      ErrorCode::InvalidParameter, "'none'" },
    { "field nan",
      [=](auto* filter, auto* data)
      {
        add(data, "Heat", nan);
        filter->AddFieldArray("Heat");
      },
      ErrorCode::NonFiniteInput, "17" },
    { "no parameters",
      [](auto* filter, auto*) { filter->SetParameterization(vtkSplineSurfaceFit::GIVEN); },
      ErrorCode::InvalidParameter, "parameters" },
    { "one component",
      [=](auto* filter, auto* data)
      {
        add(data, "One", 0.0);
        filter->SetParameterization(vtkSplineSurfaceFit::GIVEN);
        array(0, "One")(filter, data);
      },
      ErrorCode::SizeMismatch, "'One'" },
    { "domain", [](auto* filter, auto*) { filter->SetDomain(0.5, 0.6, 0.5, 0.6); },
      ErrorCode::OutsideDomain, "point" },
    { "domain nan", [=](auto* filter, auto*) { filter->SetDomain(0.5, nan, 0.5, 0.6); },
      ErrorCode::InvalidParameter, "Domain" },
    { "box", [](auto* filter, auto*) { filter->AddToleranceBox(0.0, 1.0, 0.0, 1.0, 0.0); },
      ErrorCode::InvalidParameter, "box" },
    { "line",
      [](auto* filter, auto* data)
      {
        for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
        {
          data->GetPoints()->SetPoint(i, i, 2.0 * i, 3.0 * i);
        }
        filter->SetParameterization(vtkSplineSurfaceFit::COMPUTED);
      },
      ErrorCode::SingularSystem, "line" },
    { "two triangles",
      [](auto* filter, auto* data)
      {
        vtkNew<vtkCellArray> triangles;
        triangles->InsertNextCell({ 0, 1, 2 });
        triangles->InsertNextCell({ 3, 4, 5 });
        data->SetPolys(triangles);
        filter->SetParameterization(vtkSplineSurfaceFit::COMPUTED);
      },
      ErrorCode::InvalidTopology, "disc" },
  };
  for (const Case& test : cases)
  {
    SCOPED_TRACE(test.Name);
    const auto cloud = MakeCloud<vtkPolyData>(Wave, 200);
    vtkNew<vtkSplineSurfaceFit> filter;
    vtkNew<MessageRecorder> recorder;
    recorder->Watch(filter);
    filter->SetInputData(cloud);
    test.Spoil(filter, cloud);
    filter->Update();
    EXPECT_EQ(
      filter->GetErrorCode(), vtkErrorCode::UserError + static_cast<unsigned long>(test.Code));
    ASSERT_FALSE(recorder->Errors.empty());
    EXPECT_NE(recorder->Errors[0].find(test.Words), std::string::npos) << recorder->Errors[0];
    for (int port = 0; port < 4; ++port)
    {
      EXPECT_EQ(filter->GetOutputDataObject(port)->GetNumberOfElements(vtkDataObject::POINT), 0);
    }
  }
}

TEST(SplineSurfaceFit, ThreadsDoNotChangeABit_PropertyOracle)
{
  const auto cloud = MakeCloud<vtkPolyData>(Wave, 20000);
  std::vector<PointMatrix> found;
  for (int threads : { 1, 2 })
  {
    vtkNew<vtkSplineSurfaceFit> filter;
    filter->SetInputData(cloud);
    filter->SetTolerance(1e-3);
    filter->SetThreads(threads);
    filter->Update();
    const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
    found.push_back(std::get<Spline<2>>(model.Patches[0].Geometry).ControlPoints);
  }
  EXPECT_EQ(found[0], found[1]);
}

TEST(SplineSurfaceFit, ReportsProgressAndAborts_PropertyOracle)
{
  vtkNew<vtkSplineSurfaceFit> filter;
  filter->SetInputData(MakeCloud<vtkPolyData>(Wave));
  filter->SetTolerance(1e-4);
  ExpectProgressAndAbort(filter, 2);
}
}
