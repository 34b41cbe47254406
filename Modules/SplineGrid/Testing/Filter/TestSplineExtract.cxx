// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include "RandomModels.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/LRRefinement.h>
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SplineGrid/vtkSplineExtract.h>

#include <cmath>

using namespace knotwork;

namespace
{
/// A surface over [0, 2] x [0, 1] with a field, tensor-product or with two local lines.
SplineModel Model(bool locallyRefined, bool rational)
{
  const auto space =
    MakeTensorSpace<2>({ KnotVector::Uniform(3, 4, 0.0, 2.0), KnotVector::Uniform(2, 4) }).Value;
  Spline<2> all;
  all.Space = space;
  all.ControlPoints = PointMatrix::Random(space->NumFunctions, 5);
  if (rational)
  {
    all.Weights = Eigen::VectorXd::LinSpaced(space->NumFunctions, 0.5, 2.0);
  }
  if (locallyRefined)
  {
    const auto refined = InsertSegments(all, { { 0, 0.75, 0.0, 0.75 }, { 1, 0.375, 0.0, 2.0 } }, 0);
    EXPECT_TRUE(refined) << refined.Status.Message();
    all = refined.Value;
  }
  SplineModel model;
  model.Patches.resize(1);
  model.Patches[0].Id = 7;
  model.Patches[0].Fields.push_back({ "Heat", all.ControlPoints.rightCols(2) });
  all.ControlPoints = all.ControlPoints.leftCols(3).eval();
  model.Patches[0].Geometry = all;
  return model;
}

/// Values of the map and the field at a parameter.
template <int Dim>
std::array<double, 5> ValuesAt(const SplinePatch& patch, const std::array<double, Dim>& at)
{
  auto spline = std::get<Spline<Dim>>(patch.Geometry);
  PointMatrix parameters(1, Dim);
  std::copy(at.begin(), at.end(), parameters.data());
  std::array<double, 5> values{};
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(spline), parameters, {}, batch));
  std::copy_n(batch.Values.data(), 3, values.begin());
  spline.ControlPoints = patch.Fields[0].Coefficients;
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(spline), parameters, {}, batch));
  std::copy_n(batch.Values.data(), 2, values.begin() + 3);
  return values;
}

double Distance(const std::array<double, 5>& a, const std::array<double, 5>& b)
{
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    worst = std::max(worst, std::fabs(a[i] - b[i]));
  }
  return worst;
}

SplinePatch Extracted(vtkSplineExtract* filter)
{
  filter->Update();
  const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
  EXPECT_EQ(model.Patches.size(), 1u);
  return model.Patches.empty() ? SplinePatch() : model.Patches[0];
}
}

TEST(vtkSplineExtract, PartsCurvesAndParametrizations_PropertyOracle)
{
  for (const int kind : { 0, 1, 2, 3 })
  {
    const SplineModel model = Model(kind % 2 == 1, kind > 1);
    const SplinePatch& patch = model.Patches[0];
    vtkNew<vtkSplineExtract> filter;
    filter->SetInputData(Encode(model));
    filter->RestrictToBoxOn();
    filter->SetBox(0.3, 1.9, 0.1, 0.7);
    filter->SwapParametersOn();
    filter->ReverseSecondOn(); // the first one of the input
    const SplinePatch part = Extracted(filter);
    EXPECT_EQ(part.Id, 7);
    const auto& space = *std::get<Spline<2>>(part.Geometry).Space;
    EXPECT_EQ(space.Kind, kind % 2 == 1 ? SpaceKind::LocallyRefined : SpaceKind::Tensor);
    EXPECT_EQ(space.Domain().Lower, (RealArray<2>{ 0.1, 0.3 }));
    EXPECT_EQ(space.Domain().Upper, (RealArray<2>{ 0.7, 1.9 }));
    // control points of size 1, knots inserted in both directions
    EXPECT_LE(Distance(ValuesAt<2>(part, { 0.35, 0.8 }), ValuesAt<2>(patch, { 1.4, 0.35 })), 1e-13);

    filter->ReverseSecondOff();
    filter->ReverseFirstOn(); // the second one of the input
    const SplinePatch other = Extracted(filter);
    EXPECT_LE(
      Distance(ValuesAt<2>(other, { 0.35, 0.8 }), ValuesAt<2>(patch, { 0.8, 0.45 })), 1e-13);
    filter->ReverseFirstOff();
    filter->ReverseSecondOn();
    filter->MoveDomainOn();
    filter->SetDomain(2.0, 2.6, -8.0, 8.0); // v goes from 0.3 to 1.9 otherwise
    const SplinePatch moved = Extracted(filter);
    EXPECT_EQ(
      std::get<Spline<2>>(moved.Geometry).Space->Domain().Lower, (RealArray<2>{ 2.0, -8.0 }));
    EXPECT_LE(
      Distance(ValuesAt<2>(moved, { 2.25, -3.0 }), ValuesAt<2>(patch, { 1.4, 0.35 })), 1e-13);
    filter->MoveDomainOff();

    filter->ExpandToTensorOn();
    const SplinePatch tensor = Extracted(filter);
    EXPECT_EQ(std::get<Spline<2>>(tensor.Geometry).Space->Kind, SpaceKind::Tensor);
    EXPECT_LE(
      Distance(ValuesAt<2>(tensor, { 0.35, 0.8 }), ValuesAt<2>(patch, { 1.4, 0.35 })), 1e-13);

    filter->SetIsoCurve(vtkSplineExtract::SECOND);
    filter->SetIsoValue(0.8);
    const SplinePatch curve = Extracted(filter);
    EXPECT_LE(Distance(ValuesAt<1>(curve, { 0.35 }), ValuesAt<2>(patch, { 1.4, 0.35 })), 1e-13);
  }
}

TEST(vtkSplineExtract, NothingToDoChangesNothing_ExactOracle)
{
  for (const int kind : { 0, 1, 2, 3 })
  {
    const SplineModel model = Model(kind % 2 == 1, kind > 1);
    vtkNew<vtkSplineExtract> filter;
    filter->SetInputData(Encode(model));
    const SplinePatch same = Extracted(filter);
    const auto& before = std::get<Spline<2>>(model.Patches[0].Geometry);
    const auto& after = std::get<Spline<2>>(same.Geometry);
    EXPECT_EQ(after.ControlPoints, before.ControlPoints);
    EXPECT_EQ(after.Weights, before.Weights);
    EXPECT_EQ(same.Fields[0].Coefficients, model.Patches[0].Fields[0].Coefficients);
  }
}

TEST(vtkSplineExtract, CollectionsKeepTheirBlocks_GoldenOracle)
{
  const auto input = Collect(
    { ShapeGrid(vtkSplineSource::SQUARE, 1, { 2, 2, 1 }), ShapeGrid(vtkSplineSource::DISC, 2) });
  vtkNew<vtkSplineExtract> filter;
  filter->SetInputDataObject(input);
  filter->SetIsoCurve(vtkSplineExtract::FIRST);
  filter->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  ASSERT_EQ(output->GetNumberOfPartitionedDataSets(), 2u);
  EXPECT_EQ(output->GetPartition(0, 0)->GetNumberOfCells(), 2);
  EXPECT_EQ(output->GetPartition(1, 0)->GetNumberOfCells(), 5);
}

TEST(vtkSplineExtract, BadInputIsRefused_ExactOracle)
{
  vtkNew<vtkSplineExtract> filter;
  ExpectBadInputIsRefused(filter);
  filter->SetInputData(ShapeGrid(vtkSplineSource::CUBE));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "patch 0");
  filter->SetInputData(ShapeGrid(vtkSplineSource::SQUARE));
  filter->RestrictToBoxOn();
  filter->SetBox(0.0, 2.0, 0.0, 1.0);
  ExpectFailure(filter, ErrorCode::OutsideDomain, "direction 0");
  filter->RestrictToBoxOff();
  filter->MoveDomainOn();
  filter->SetDomain(0.0, 1.0, 2.0, 2.0);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "direction 1");
  filter->MoveDomainOff();
  filter->SetIsoCurve(vtkSplineExtract::SECOND);
  filter->SetIsoValue(-1.0);
  ExpectFailure(filter, ErrorCode::OutsideDomain, "patch 0");
}
