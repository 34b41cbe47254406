// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineGrid/vtkSplineEvaluate.h>

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <cmath>

using namespace knotwork;

namespace
{
vtkSmartPointer<vtkPolyData> Points(const std::vector<std::array<double, 3>>& coordinates)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  for (const auto& x : coordinates)
  {
    const vtkIdType id = points->InsertNextPoint(x.data());
    vertices->InsertNextCell(1, &id);
  }
  data->SetPoints(points);
  data->SetVerts(vertices);
  return data;
}

double Get(vtkDataObject* data, const char* array, vtkIdType point, int component = 0)
{
  vtkDataArray* values = vtkPointSet::SafeDownCast(data)->GetPointData()->GetArray(array);
  EXPECT_TRUE(values) << array;
  return values ? values->GetComponent(point, component) : NAN;
}
}

TEST(SplineEvaluate, ParametersOfTheAnnulus_ExactOracle)
{
  // S(u, v) = (1/2 + u / 2) (cos, sin) of an angle; |S|, and |S_u| = 1/2, S_uu = 0.
  vtkNew<vtkSplineEvaluate> filter;
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::ANNULUS_SECTOR, 0, { 2, 3, 1 }));
  auto points = Points({ { 0.25, 0.5, 0.0 }, { 1.0, 1.0, 0.0 }, { 0.0, 0.0, 0.0 } });
  filter->SetPointsData(points);
  filter->SetDerivatives(2);
  filter->Update();
  auto* output = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  EXPECT_EQ(output->GetNumberOfVerts(), 3);
  for (vtkIdType i = 0; i < 3; ++i)
  {
    const double* x = output->GetPoint(i);
    const double radius = 0.5 + 0.5 * points->GetPoint(i)[0];
    EXPECT_NEAR(std::hypot(x[0], x[1]), radius, 1e-14);
    for (int d = 0; d < 3; ++d)
    {
      EXPECT_NEAR(Get(output, "Derivative_u", i, d), 0.5 * x[d] / radius, 1e-13);
      EXPECT_NEAR(Get(output, "Derivative_uu", i, d), 0.0, 1e-12);
      EXPECT_NEAR(Get(output, "Derivative_uv", i, d),
        0.5 * Get(output, "Derivative_v", i, d) / radius, 1e-12);
    }
    // The angular derivative is a tangent of the circle.
    EXPECT_NEAR(x[0] * Get(output, "Derivative_v", i, 0) + x[1] * Get(output, "Derivative_v", i, 1),
      0.0, 1e-13);
  }
  EXPECT_EQ(Get(output, "ElementId", 0), 2.0); // second third of the angle
  EXPECT_NEAR(Get(output, "LocalParameters", 0, 0), 0.5, 1e-14);
  EXPECT_NEAR(Get(output, "LocalParameters", 0, 1), 0.5, 1e-14);
}

TEST(SplineEvaluate, ArraysChooseParametersAndPatch_PropertyOracle)
{
  vtkNew<vtkSplineEvaluate> filter;
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::SPHERE_SURFACE));
  auto points = Points({ { 9.0, 9.0, 9.0 }, { 9.0, 9.0, 9.0 }, { 9.0, 9.0, 9.0 } });
  vtkNew<vtkDoubleArray> parameters;
  parameters->SetName("UV");
  parameters->SetNumberOfComponents(2);
  vtkNew<vtkIntArray> patch;
  patch->SetName("PatchId");
  for (int i = 0; i < 3; ++i)
  {
    parameters->InsertNextTuple2(0.5, 0.5);
    patch->InsertNextValue(2 * i);
  }
  points->GetPointData()->AddArray(parameters);
  points->GetPointData()->AddArray(patch);
  filter->SetPointsData(points);
  filter->SetParameterArray("UV");
  filter->Update();
  auto* output = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  // Middles of three of the six faces: unit vectors of different axes or signs.
  for (vtkIdType i = 0; i < 3; ++i)
  {
    const double* x = output->GetPoint(i);
    EXPECT_NEAR(std::max({ std::abs(x[0]), std::abs(x[1]), std::abs(x[2]) }), 1.0, 1e-14);
    EXPECT_EQ(Get(output, "PatchId", i), 2.0 * double(i));
  }
  EXPECT_GT(std::hypot(output->GetPoint(0)[0] - output->GetPoint(1)[0],
              output->GetPoint(0)[1] - output->GetPoint(1)[1],
              output->GetPoint(0)[2] - output->GetPoint(1)[2]),
    1.0);
}

TEST(SplineEvaluate, ProbeFindsTheNearestPointAndFields_ExactOracle)
{
  auto grid = ShapeGrid(vtkSplineSource::SPHERE_SURFACE);
  vtkNew<vtkDoubleArray> field;
  field->SetName("Height");
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    field->InsertNextValue(grid->GetPoint(i)[2]);
  }
  grid->GetPointData()->AddArray(field);
  vtkNew<vtkSplineEvaluate> filter;
  filter->SetInputDataObject(grid);
  filter->SetMode(vtkSplineEvaluate::PROBE);
  filter->SetDerivatives(1);
  filter->SetPointsData(Points({ { 2.0, 1.0, -0.5 }, { 0.1, 0.2, 0.3 }, { 0.0, -3.0, 0.0 } }));
  filter->Update();
  auto* output = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  const double norms[3] = { std::sqrt(5.25), std::sqrt(0.14), 3.0 };
  for (vtkIdType i = 0; i < 3; ++i)
  {
    EXPECT_NEAR(Get(output, "Distance", i), std::abs(norms[i] - 1.0), 1e-12);
    EXPECT_NEAR(std::hypot(output->GetPoint(i)[0], output->GetPoint(i)[1], output->GetPoint(i)[2]),
      1.0, 1e-14);
    EXPECT_NEAR(Get(output, "Height", i), output->GetPoint(i)[2], 1e-14);
    EXPECT_NEAR(Get(output, "Height_u", i), Get(output, "Derivative_u", i, 2), 1e-12);
  }
}

TEST(SplineEvaluate, ProbeInvertsTheEvaluation_CrossOracle)
{
  auto bar = ShapeGrid(vtkSplineSource::TWISTED_BAR, 2, { 2, 1, 3 });
  auto parameters = Points({ { 0.1, 0.2, 0.3 }, { 0.9, 0.5, 0.01 }, { 0.6, 0.99, 0.7 } });
  vtkNew<vtkSplineEvaluate> there;
  there->SetInputDataObject(bar);
  there->SetPointsData(parameters);
  vtkNew<vtkSplineEvaluate> back;
  back->SetInputDataObject(bar);
  back->SetMode(vtkSplineEvaluate::PROBE);
  back->SetPointsConnection(there->GetOutputPort());
  back->Update();
  for (vtkIdType i = 0; i < 3; ++i)
  {
    EXPECT_LE(Get(back->GetOutputDataObject(0), "Distance", i), 1e-15);
    EXPECT_EQ(Get(back->GetOutputDataObject(0), "ElementId", i),
      Get(there->GetOutputDataObject(0), "ElementId", i));
    for (int d = 0; d < 3; ++d)
    {
      EXPECT_NEAR(Get(back->GetOutputDataObject(0), "LocalParameters", i, d),
        Get(there->GetOutputDataObject(0), "LocalParameters", i, d), 1e-12);
    }
  }
}

TEST(SplineEvaluate, DerivativesFromBelowKnots_ExactOracle)
{
  // a unit square of two elements, its points moved: z = |2 u - 1|
  vtkNew<vtkSplineSource> source;
  source->SetShape(vtkSplineSource::SQUARE);
  source->SetDegree(1);
  source->SetElements(2, 1, 1);
  source->Update();
  auto* square = vtkUnstructuredGrid::SafeDownCast(source->GetOutputDataObject(0));
  const double middle = square->GetCenter()[0];
  for (vtkIdType i = 0; i < square->GetNumberOfPoints(); ++i)
  {
    double x[3];
    square->GetPoint(i, x);
    square->GetPoints()->SetPoint(i, x[0], x[1], std::fabs(2.0 * (x[0] - middle)));
  }
  vtkNew<vtkPoints> at;
  at->InsertNextPoint(0.5, 0.25, 0.0);
  vtkNew<vtkPolyData> points;
  points->SetPoints(at);
  for (const bool fromBelow : { false, true })
  {
    vtkNew<vtkSplineEvaluate> evaluate;
    evaluate->SetInputData(square);
    evaluate->SetPointsData(points);
    evaluate->SetDerivatives(1);
    evaluate->SetFromBelow(fromBelow ? 1 : 0, 0, 0);
    evaluate->Update();
    vtkPointData* data =
      vtkPolyData::SafeDownCast(evaluate->GetOutputDataObject(0))->GetPointData();
    EXPECT_EQ(data->GetArray("Derivative_u")->GetComponent(0, 2), fromBelow ? -2.0 : 2.0);
    EXPECT_EQ(data->GetArray("LocalParameters")->GetComponent(0, 0), fromBelow ? 1.0 : 0.0);
    EXPECT_EQ(data->GetArray("ElementId")->GetComponent(0, 0), fromBelow ? 0.0 : 1.0);
  }
}

TEST(SplineEvaluate, EveryFailureIsReachable)
{
  vtkNew<vtkSplineEvaluate> filter;
  auto annulus = ShapeGrid(vtkSplineSource::ANNULUS_SECTOR);
  filter->SetInputDataObject(annulus);
  filter->SetPointsData(Points({ { 0.5, 0.5, 0.0 }, { 2.0, 0.5, 0.0 } }));
  ExpectFailure(filter, ErrorCode::OutsideDomain, "point 1");
  filter->SetPointsData(Points({ { NAN, 0.5, 0.0 } }));
  ExpectFailure(filter, ErrorCode::OutsideDomain, "point 0");
  filter->SetMode(vtkSplineEvaluate::PROBE);
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "0");
  filter->SetMode(vtkSplineEvaluate::PARAMETERS);
  filter->SetPointsData(Points({ { 0.5, 0.5, 0.0 } }));
  filter->SetParameterArray("Missing");
  ExpectFailure(filter, ErrorCode::EmptyInput, "Missing");
  filter->SetParameterArray("");
  filter->SetPatchId(3);
  ExpectFailure(filter, ErrorCode::InvalidTopology, "PatchId 3");
  filter->SetPatchId(-1);
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::DISC));
  ExpectFailure(filter, ErrorCode::InvalidParameter, "5");
  filter->SetInputDataObject(vtkNew<vtkUnstructuredGrid>());
  ExpectFailure(filter, ErrorCode::EmptyInput, "no spline");
  annulus->GetPoints()->SetPoint(0, NAN, 0.0, 0.0);
  filter->SetInputDataObject(annulus);
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "");
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::ANNULUS_SECTOR));
  // No points: no output, no word.
  filter->SetPointsData(Points({}));
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->SetPointsData(vtkNew<vtkImageData>());
  filter->Update();
  EXPECT_FALSE(recorder->Errors.empty()) << "an image is no point set";
}
