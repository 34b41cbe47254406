// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <knotwork/SplineGrid/vtkSplineWarp.h>

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFeatureEdges.h"
#include "vtkImageData.h"
#include "vtkPlaneSource.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <cmath>

using namespace knotwork;

namespace
{
/// The unit square to a quarter annulus: u is the radius from 1/2 to 1.
vtkSmartPointer<vtkUnstructuredGrid> AnnulusMap()
{
  return ShapeGrid(vtkSplineSource::ANNULUS_SECTOR, 0, { 2, 2, 1 });
}

/// A disc inside the unit square: what is sent through the map.
vtkSmartPointer<vtkUnstructuredGrid> SmallDisc(int degree)
{
  vtkNew<vtkSplineSource> source;
  source->SetShape(vtkSplineSource::DISC);
  source->SetOuterRadius(0.45);
  source->SetInnerRadius(0.2);
  source->SetCenter(0.5, 0.5, 0.0);
  source->SetDegree(degree);
  source->Update();
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->DeepCopy(source->GetOutputDataObject(0));
  return grid;
}
}

TEST(SplineWarp, PointsKeepCellsAndArrays_ExactOracle)
{
  vtkNew<vtkPlaneSource> plane; // the unit square moved to [0, 1]^2
  plane->SetOrigin(0.0, 0.0, 0.0);
  plane->SetPoint1(1.0, 0.0, 0.0);
  plane->SetPoint2(0.0, 1.0, 0.0);
  plane->SetResolution(5, 4);
  plane->Update();
  vtkNew<vtkSplineWarp> warp;
  warp->SetInputConnection(plane->GetOutputPort());
  warp->SetMapData(AnnulusMap());
  warp->Update();
  auto* output = vtkPolyData::SafeDownCast(warp->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  EXPECT_EQ(output->GetNumberOfPolys(), 20);
  EXPECT_TRUE(output->GetPointData()->GetArray("TextureCoordinates"));
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    const double* u = plane->GetOutput()->GetPoint(i);
    const double* x = output->GetPoint(i);
    // The source's points are float.
    EXPECT_NEAR(std::hypot(x[0], x[1]), 0.5 + 0.5 * u[0], 1e-14);
  }
}

TEST(SplineWarp, SplinesAreComposedToTheTolerance_CrossOracle)
{
  for (const double tolerance : { 1e-2, 1e-4 })
  {
    auto disc = SmallDisc(3);
    // A field that must not change: the parameters x of the disc's points.
    vtkNew<vtkDoubleArray> field;
    field->SetName("Old");
    for (vtkIdType i = 0; i < disc->GetNumberOfPoints(); ++i)
    {
      field->InsertNextValue(disc->GetPoint(i)[0]);
    }
    disc->GetPointData()->AddArray(field);
    vtkNew<vtkSplineWarp> warp;
    warp->SetInputDataObject(disc);
    warp->SetMapData(AnnulusMap());
    warp->SetTolerance(tolerance);
    warp->Update();
    auto* output = vtkUnstructuredGrid::SafeDownCast(warp->GetOutputDataObject(0));
    ASSERT_TRUE(output);
    vtkDataArray* distance = output->GetCellData()->GetArray("Distance");
    ASSERT_TRUE(distance);
    EXPECT_LE(distance->GetRange()[1], tolerance);
    EXPECT_GT(distance->GetRange()[0], 0.0);
    const SplineModel before = DecodePatches(disc);
    const SplineModel after = DecodePatches(output);
    ASSERT_EQ(after.Patches.size(), 5u);
    const auto map = std::get<Spline<2>>(DecodePatches(AnnulusMap()).Patches[0].Geometry);
    for (std::size_t p = 0; p < 5; ++p)
    {
      const auto& inner = std::get<Spline<2>>(before.Patches[p].Geometry);
      const auto& image = std::get<Spline<2>>(after.Patches[p].Geometry);
      EXPECT_FALSE(image.IsRational());
      PointMatrix u(121, 2);
      for (int i = 0; i < 121; ++i)
      {
        u.row(i) << (i % 11) / 10.0, (i / 11) / 10.0;
      }
      EvaluationBatch a;
      EvaluationBatch b;
      EvaluationBatch c;
      ASSERT_TRUE(EvaluateParameters<2>(MakeBezierForm(inner, 1), u, {}, a));
      ASSERT_TRUE(EvaluateParameters<2>(MakeBezierForm(image, 1), u, {}, b));
      ASSERT_TRUE(EvaluateParameters<2>(MakeBezierForm(map, 1), a.Values.leftCols(2), {}, c));
      EXPECT_LE((b.Values - c.Values).rowwise().norm().maxCoeff(), 1.5 * tolerance);
      Spline<2> old = image;
      ASSERT_EQ(after.Patches[p].Fields.size(), 1u);
      old.ControlPoints = after.Patches[p].Fields[0].Coefficients;
      ASSERT_TRUE(EvaluateParameters<2>(MakeBezierForm(old, 1), u, {}, b));
      EXPECT_LE((b.Values - a.Values.leftCols(1)).cwiseAbs().maxCoeff(), 5.0 * tolerance);
    }
  }
}

TEST(SplineWarp, ImagesStayConnected_PropertyOracle)
{
  vtkNew<vtkSplineWarp> warp;
  warp->SetInputDataObject(SmallDisc(2));
  warp->SetMapData(AnnulusMap());
  warp->SetTolerance(1e-4);
  vtkNew<vtkSplineTessellate> mesh;
  mesh->SetInputConnection(warp->GetOutputPort());
  mesh->SetChordalTolerance(1e-2);
  vtkNew<vtkFeatureEdges> rim;
  rim->SetInputConnection(mesh->GetOutputPort());
  rim->BoundaryEdgesOn();
  rim->FeatureEdgesOff();
  rim->NonManifoldEdgesOn();
  rim->ManifoldEdgesOff();
  rim->Update();
  // The only open edges are the disc's rim: one closed loop, as many points as edges.
  EXPECT_GT(rim->GetOutput()->GetNumberOfCells(), 8);
  EXPECT_EQ(rim->GetOutput()->GetNumberOfCells(), rim->GetOutput()->GetNumberOfPoints());
  const SplineModel model = DecodePatches(warp->GetOutputDataObject(0));
  for (vtkIdType i = 0; i < rim->GetOutput()->GetNumberOfPoints(); ++i)
  {
    // Back to the parameters: radius and angle.
    const double* x = rim->GetOutput()->GetPoint(i);
    const double u = 2.0 * (std::hypot(x[0], x[1]) - 0.5);
    EXPECT_GT(std::hypot(u - 0.5, 0.45), 0.44);
  }
}

TEST(SplineWarp, ToleranceOutOfReachIsReported_PropertyOracle)
{
  vtkNew<vtkSplineWarp> warp;
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(warp);
  warp->SetInputDataObject(SmallDisc(2));
  warp->SetMapData(AnnulusMap());
  warp->SetTolerance(1e-6);
  warp->SetMaxLevel(1);
  warp->Update();
  EXPECT_EQ(warp->GetErrorCode(), vtkErrorCode::NoError);
  ASSERT_EQ(recorder->Warnings.size(), 1u);
  EXPECT_NE(recorder->Warnings[0].find("MaxLevel"), std::string::npos);
  auto* grid = vtkUnstructuredGrid::SafeDownCast(warp->GetOutputDataObject(0));
  EXPECT_GT(grid->GetCellData()->GetArray("Distance")->GetRange()[1], 1e-6);
  warp->SetTolerance(0.1);
  warp->Update();
  warp->SetTolerance(0.0); // no wish, no word
  warp->Update();
  EXPECT_EQ(recorder->Warnings.size(), 1u);
}

TEST(SplineWarp, CollectionsAndOutsideAndClamp_PropertyOracle)
{
  vtkNew<vtkSplineWarp> warp;
  warp->SetInputDataObject(Collect({ SmallDisc(2), SmallDisc(3) }));
  warp->SetMapData(AnnulusMap());
  warp->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(warp->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  EXPECT_EQ(output->GetNumberOfPartitionedDataSets(), 2u);
  EXPECT_EQ(DecodePatches(output).Patches.size(), 10u);

  vtkNew<vtkPlaneSource> plane; // from -0.5 to 0.5: outside
  plane->Update();
  warp->SetInputDataObject(plane->GetOutput());
  ExpectFailure(warp, ErrorCode::OutsideDomain, "point 0");
  warp->ClampOn();
  warp->Update();
  EXPECT_EQ(warp->GetErrorCode(), vtkErrorCode::NoError);
  const double* x = vtkPolyData::SafeDownCast(warp->GetOutputDataObject(0))->GetPoint(0);
  EXPECT_NEAR(std::hypot(x[0], x[1]), 0.5, 1e-14);
  warp->ClampOff();
  warp->SetInputDataObject(ShapeGrid(vtkSplineSource::DISC)); // around 0
  ExpectFailure(warp, ErrorCode::OutsideDomain, "domain");
}

TEST(SplineWarp, BadInputIsRefused)
{
  vtkNew<vtkSplineWarp> warp;
  warp->SetMapData(AnnulusMap());
  auto disc = SmallDisc(2);
  disc->GetPoints()->SetPoint(3, NAN, 0.0, 0.0);
  warp->SetInputDataObject(disc);
  ExpectFailure(warp, ErrorCode::NonFiniteInput, "");
  vtkNew<vtkPolyData> nanPoint;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0.5, 0.5, 0.0);
  points->InsertNextPoint(0.5, NAN, 0.0);
  nanPoint->SetPoints(points);
  warp->SetInputDataObject(nanPoint);
  ExpectFailure(warp, ErrorCode::NonFiniteInput, "point 1");

  // The map: empty, several patches, no such patch, not a spline, damaged.
  warp->SetInputDataObject(SmallDisc(2));
  warp->SetMapData(vtkNew<vtkUnstructuredGrid>());
  ExpectFailure(warp, ErrorCode::EmptyInput, "map");
  warp->SetMapData(ShapeGrid(vtkSplineSource::DISC));
  ExpectFailure(warp, ErrorCode::InvalidParameter, "5 patches");
  warp->SetMapPatchId(17);
  ExpectFailure(warp, ErrorCode::InvalidParameter, "17");
  warp->SetMapPatchId(-1);
  auto damaged = AnnulusMap();
  damaged->GetPoints()->SetPoint(1, INFINITY, 0.0, 0.0);
  warp->SetMapData(damaged);
  ExpectFailure(warp, ErrorCode::NonFiniteInput, "map");
  warp->SetMapData(AnnulusMap());
  // Nothing to send: nothing comes, without a word.
  warp->SetInputDataObject(vtkNew<vtkUnstructuredGrid>());
  warp->Update();
  EXPECT_EQ(warp->GetErrorCode(), vtkErrorCode::NoError);
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(warp);
  warp->SetInputDataObject(vtkNew<vtkImageData>());
  warp->Update();
  EXPECT_FALSE(recorder->Errors.empty()) << "an image is no point set";
}
