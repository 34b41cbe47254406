// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineGrid/vtkSplineDefinition.h>

#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

using namespace knotwork;

namespace
{
vtkSmartPointer<vtkDoubleArray> Array(const std::vector<double>& values, int components = 1)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

ErrorCode CodeOf(vtkSplineDefinition* definition)
{
  return static_cast<ErrorCode>(definition->GetErrorCode() - vtkErrorCode::UserError);
}
}

TEST(vtkSplineDefinition, ShapesTakenApartAndPutTogetherAreTheSame_PropertyOracle)
{
  for (int shape = 0; shape < NumShapeKinds; ++shape)
  {
    vtkNew<vtkSplineSource> source;
    source->SetShape(shape);
    source->SetInnerRadius(0.3);
    source->Update();
    SCOPED_TRACE(source->GetShapeName());
    vtkNew<vtkSplineDefinition> found;
    ASSERT_TRUE(found->Decode(source->GetOutputDataObject(0))) << found->GetErrorText();
    vtkNew<vtkSplineDefinition> made;
    for (int p = 0; p < found->GetNumberOfPatches(); ++p)
    {
      EXPECT_EQ(found->GetFamily(p), "tensor-product");
      const int dimension = found->GetDimension(p);
      vtkNew<vtkDoubleArray> degrees, points, weights;
      std::array<vtkSmartPointer<vtkDoubleArray>, 3> knots;
      for (int d = 0; d < dimension; ++d)
      {
        degrees->InsertNextValue(found->GetDegree(p, d));
        knots[static_cast<std::size_t>(d)] = vtkSmartPointer<vtkDoubleArray>::New();
        found->GetKnots(p, d, knots[static_cast<std::size_t>(d)]);
      }
      found->GetControlPoints(p, points);
      found->GetWeights(p, weights);
      ASSERT_TRUE(made->AddTensorPatch(dimension, degrees, knots[0], knots[1], knots[2], points,
        weights->GetNumberOfTuples() > 0 ? weights.Get() : nullptr))
        << made->GetErrorText();
    }
    vtkNew<vtkUnstructuredGrid> grid;
    ASSERT_TRUE(made->MakeGrid(grid)) << made->GetErrorText();
    const SplineModel before = DecodePatches(source->GetOutputDataObject(0));
    const SplineModel after = DecodePatches(grid);
    ASSERT_EQ(after.Patches.size(), before.Patches.size());
    for (std::size_t p = 0; p < before.Patches.size(); ++p)
    {
      EXPECT_EQ(after.Patches[p].Id, before.Patches[p].Id);
      std::visit(
        [&](const auto& expected)
        {
          const auto& spline =
            std::get<std::decay_t<decltype(expected)>>(after.Patches[p].Geometry);
          EXPECT_EQ(spline.ControlPoints, expected.ControlPoints);
          EXPECT_EQ(spline.Weights, expected.Weights);
          for (std::size_t d = 0; d < expected.Space->Knots.size(); ++d)
          {
            EXPECT_TRUE(spline.Space->Knots[d] == expected.Space->Knots[d]);
          }
        },
        before.Patches[p].Geometry);
    }
  }
}

TEST(vtkSplineDefinition, WhatDoesNotFitIsRefusedAndNothingIsLost_PropertyOracle)
{
  vtkNew<vtkSplineDefinition> made;
  const auto degree = Array({ 1 });
  const auto knots = Array({ 0, 0, 1, 1 });
  const auto points = Array({ 0, 0, 0, 1, 0, 0 }, 3);
  ASSERT_TRUE(made->AddTensorPatch(1, degree, knots, nullptr, nullptr, points, nullptr));
  const auto refused = [&](ErrorCode code, const char* words)
  {
    EXPECT_EQ(CodeOf(made), code) << made->GetErrorText();
    EXPECT_NE(made->GetErrorText().find(words), std::string::npos) << made->GetErrorText();
    EXPECT_EQ(made->GetNumberOfPatches(), 1);
  };
  EXPECT_FALSE(made->AddTensorPatch(4, degree, knots, knots, knots, points, nullptr));
  refused(ErrorCode::DimensionMismatch, "1 to 3 parameters, not 4");
  EXPECT_FALSE(made->AddTensorPatch(2, degree, knots, knots, nullptr, points, nullptr));
  refused(ErrorCode::SizeMismatch, "degree");
  EXPECT_FALSE(made->AddTensorPatch(1, degree, nullptr, nullptr, nullptr, points, nullptr));
  refused(ErrorCode::EmptyInput, "first direction");
  EXPECT_FALSE(
    made->AddTensorPatch(1, degree, Array({ 0, 1, 0, 1 }), nullptr, nullptr, points, nullptr));
  refused(ErrorCode::InvalidKnots, "first direction");
  EXPECT_FALSE(made->AddTensorPatch(1, degree, knots, nullptr, nullptr, Array({ 0, 1 }), nullptr));
  refused(ErrorCode::SizeMismatch, "2 or 3 coordinates");
  EXPECT_FALSE(
    made->AddTensorPatch(1, degree, knots, nullptr, nullptr, Array({ 0, 0, 0 }, 3), nullptr));
  refused(ErrorCode::SizeMismatch, "");
  EXPECT_FALSE(made->AddTensorPatch(1, degree, knots, nullptr, nullptr, points, Array({ 1, -1 })));
  refused(ErrorCode::InvalidWeight, "1");
  vtkNew<vtkPolyData> triangles;
  EXPECT_FALSE(made->Decode(triangles));
  refused(ErrorCode::InvalidTopology, "");
}

TEST(vtkSplineDefinition, NumbersThatNoPatchHasGiveNothing_PropertyOracle)
{
  vtkNew<vtkSplineDefinition> made;
  vtkNew<vtkDoubleArray> values;
  for (const int patch : { -1, 0, 7 })
  {
    values->InsertNextValue(1.0);
    made->GetKnots(patch, 0, values);
    EXPECT_EQ(values->GetNumberOfTuples(), 0);
    made->GetControlPoints(patch, values);
    EXPECT_EQ(values->GetNumberOfTuples(), 0);
    made->GetWeights(patch, values);
    EXPECT_EQ(values->GetNumberOfTuples(), 0);
    EXPECT_EQ(made->GetPatchId(patch), -1);
    EXPECT_EQ(made->GetDimension(patch), 0);
    EXPECT_EQ(made->GetFamily(patch), "");
    EXPECT_EQ(made->GetDegree(patch, 0), 0);
  }
}
