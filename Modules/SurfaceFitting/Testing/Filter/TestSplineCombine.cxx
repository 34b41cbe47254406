// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SurfaceFitting/vtkSplineCombine.h>

#include "FilterCases.h"
#include "HeightTiles.h"
#include <knotwork/SplineCore/BezierForm.h>

#include "vtkPoints.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <cmath>

using namespace knotwork;

namespace
{
const ParametricBox<2> Box{ { 0, 0 }, { 2, 1 } };

SplinePatch Wave(int elements, double phase)
{
  return HeightTile(
    3, Box, elements, [phase](double u, double v) { return std::sin(2 * u + phase) * v; });
}

PointMatrix ValuesAt(const Spline<2>& spline, const PointMatrix& at)
{
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(spline), at, {}, batch));
  return batch.Values;
}

PointMatrix Lattice()
{
  PointMatrix at(100, 2);
  for (int i = 0; i < 100; ++i)
  {
    at.row(i) << 0.21 * (i % 10), 0.11 * (i / 10);
  }
  return at;
}
}

TEST(SplineCombineFilter, HeightFields_CrossOracle)
{
  const SplinePatch a = Wave(6, 0.0);
  const SplinePatch b = Wave(9, 0.5);
  const double weights[3][2] = { { 1.0, -1.0 }, { 0.5, 0.5 }, { 0.25, 2.0 } };
  for (int mode = vtkSplineCombine::DIFFERENCE; mode <= vtkSplineCombine::WEIGHTED; ++mode)
  {
    vtkNew<vtkSplineCombine> filter;
    filter->SetMode(mode);
    filter->SetFirstWeight(0.25);
    filter->SetSecondWeight(2.0);
    filter->SetInputDataObject(GridOfPatches({ a }));
    filter->SetSecondData(GridOfPatches({ b }));
    filter->Update();
    const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
    ASSERT_EQ(model.Patches.size(), 1u);
    const auto& result = std::get<Spline<2>>(model.Patches[0].Geometry);
    const PointMatrix at = Lattice();
    const PointMatrix values = ValuesAt(result, at);
    const PointMatrix x = ValuesAt(std::get<Spline<2>>(a.Geometry), at);
    const PointMatrix y = ValuesAt(std::get<Spline<2>>(b.Geometry), at);
    const Eigen::VectorXd z = weights[mode][0] * x.col(2) + weights[mode][1] * y.col(2);
    EXPECT_LE((values.leftCols(2) - at).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LE((values.col(2) - z).cwiseAbs().maxCoeff(), 1e-13);
    Spline<2> field = result;
    ASSERT_EQ(model.Patches[0].Fields.size(), 1u);
    field.ControlPoints = model.Patches[0].Fields[0].Coefficients;
    Spline<2> fieldA = std::get<Spline<2>>(a.Geometry);
    fieldA.ControlPoints = a.Fields[0].Coefficients;
    Spline<2> fieldB = std::get<Spline<2>>(b.Geometry);
    fieldB.ControlPoints = b.Fields[0].Coefficients;
    const PointMatrix f =
      weights[mode][0] * ValuesAt(fieldA, at) + weights[mode][1] * ValuesAt(fieldB, at);
    EXPECT_LE((ValuesAt(field, at) - f).cwiseAbs().maxCoeff(), 1e-13);
    auto* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(1));
    EXPECT_LE(table->GetValueByName(0, "MinBound").ToDouble(), z.minCoeff() + 1e-13);
    EXPECT_GE(table->GetValueByName(0, "MaxBound").ToDouble(), z.maxCoeff() - 1e-13);
    EXPECT_EQ(table->GetValueByName(0, "PatchId").ToInt(), 3);
  }
}

TEST(SplineCombineFilter, SurfacesInSpace_ExactOracle)
{
  // a square and the same square moved by (1, 2, 3)
  auto square = ShapeGrid(vtkSplineSource::SQUARE, 2, { 3, 2, 1 });
  auto moved = ShapeGrid(vtkSplineSource::SQUARE, 2, { 4, 2, 1 });
  for (vtkIdType i = 0; i < moved->GetNumberOfPoints(); ++i)
  {
    double x[3];
    moved->GetPoint(i, x);
    moved->GetPoints()->SetPoint(i, x[0] + 1.0, x[1] + 2.0, x[2] + 3.0);
  }
  vtkNew<vtkSplineCombine> filter;
  filter->SetInputDataObject(square);
  filter->SetSecondData(moved);
  filter->Update();
  SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
  ASSERT_EQ(model.Patches.size(), 1u);
  ASSERT_EQ(model.Patches[0].Fields.size(), 1u);
  EXPECT_EQ(model.Patches[0].Fields[0].Name, "Difference");
  const PointMatrix& difference = model.Patches[0].Fields[0].Coefficients;
  EXPECT_LE((difference.rowwise() + Eigen::RowVector3d(1, 2, 3)).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(std::get<Spline<2>>(model.Patches[0].Geometry).Space->Kind, SpaceKind::Tensor);
  filter->SetMode(vtkSplineCombine::AVERAGE);
  filter->Update();
  model = DecodePatches(filter->GetOutputDataObject(0));
  const auto& middle = std::get<Spline<2>>(model.Patches[0].Geometry);
  EXPECT_NEAR(middle.ControlPoints.col(2).minCoeff(), 1.5, 1e-14);
}

TEST(SplineCombineFilter, FieldsOfOneInputDoNotPass_ExactOracle)
{
  SplinePatch b = Wave(5, 0.1);
  b.Fields[0].Name = "Other";
  vtkNew<MessageRecorder> recorder;
  vtkNew<vtkSplineCombine> filter;
  recorder->Watch(filter);
  filter->SetInputDataObject(GridOfPatches({ Wave(5, 0.0) }));
  filter->SetSecondData(GridOfPatches({ b }));
  filter->Update();
  EXPECT_EQ(recorder->Warnings.size(), 2u);
  EXPECT_TRUE(DecodePatches(filter->GetOutputDataObject(0)).Patches[0].Fields.empty());
}

TEST(SplineCombineFilter, BadInput_ExactOracle)
{
  vtkNew<vtkSplineCombine> filter;
  filter->SetInputDataObject(GridOfPatches({ Wave(5, 0.0) }));
  filter->SetSecondData(ShapeGrid(vtkSplineSource::CUBE));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "second surface");
  filter->SetSecondData(GridOfPatches(FourTiles(0.0)));
  ExpectFailure(filter, ErrorCode::SizeMismatch, "4");
  filter->SetSecondData(GridOfPatches(
    { HeightTile(0, { { 1, 0 }, { 3, 1 } }, 4, [](double, double) { return 0.0; }) }));
  ExpectFailure(filter, ErrorCode::InvalidTopology, "common domain");
  filter->CommonDomainOn();
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  filter->SetSecondData(ShapeGrid(vtkSplineSource::ANNULUS_SECTOR));
  ExpectFailure(filter, ErrorCode::InvalidWeight, "rational");
  filter->SetSecondData(GridOfPatches({ Wave(5, 0.0) }));
  filter->SetMode(vtkSplineCombine::WEIGHTED);
  filter->SetFirstWeight(HUGE_VAL);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "finite");
}

TEST(SplineCombineFilter, ReportsProgressAndAborts_PropertyOracle)
{
  vtkNew<vtkSplineCombine> filter;
  filter->SetInputDataObject(GridOfPatches(FourTiles(0.0)));
  filter->SetSecondData(GridOfPatches(FourTiles(0.1)));
  ExpectProgressAndAbort(filter, 3);
}
