// SPDX-License-Identifier: BSD-3-Clause
// The motion is tested in the kernel; here: what the filter takes and gives out.
#include "FilterCases.h"
#include "FitCases.h"
#include "MeshDatasets.h"
#include <knotwork/CADFitting/vtkRigidAlignment.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/vtkSplineRefine.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkTransform.h"
#include "vtkTransformFilter.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVariant.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

using namespace knotwork;

namespace
{
/// A box of 3 x 2 x 1 with a corner pulled out: nothing of it is symmetric.
vtkSmartPointer<vtkPolyData> Block()
{
  const TriangleMesh mesh = fits::BoxTriangles(4);
  PointMatrix points = mesh.Points * Eigen::Vector3d(3.0, 2.0, 1.0).asDiagonal();
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    points(i, 2) += 0.2 * points(i, 0) * points(i, 1) * points(i, 2);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(MakePoints(points));
  vtkNew<vtkCellArray> cells;
  for (const auto& triangle : mesh.Triangles)
  {
    cells->InsertNextCell({ triangle[0], triangle[1], triangle[2] });
  }
  data->SetPolys(cells);
  return data;
}

vtkSmartPointer<vtkPolyData> Moved(vtkPolyData* data)
{
  vtkNew<vtkTransform> transform;
  transform->Translate(20.0, -3.0, 8.0);
  transform->RotateWXYZ(130.0, 1.0, 2.0, -0.5);
  vtkNew<vtkTransformFilter> filter;
  filter->SetTransform(transform);
  filter->SetInputData(data);
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->Update();
  return filter->GetPolyDataOutput();
}

vtkPointSet* Scan(vtkRigidAlignment* filter)
{
  return vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
}

double Number(vtkRigidAlignment* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(1))->GetValueByName(0, name).ToDouble();
}

/// Largest distance between points of one number.
double Between(vtkPointSet* a, vtkPointSet* b)
{
  double largest = 0.0;
  for (vtkIdType i = 0; i < a->GetNumberOfPoints(); ++i)
  {
    Eigen::Vector3d x;
    Eigen::Vector3d y;
    a->GetPoint(i, x.data());
    b->GetPoint(i, y.data());
    largest = std::max(largest, (x - y).norm());
  }
  return largest;
}
}

TEST(vtkRigidAlignment, ScanAndItsArraysAreMoved_ExactOracle)
{
  const auto block = Block();
  const auto scan = Moved(block);
  // a field that stays, and normals that turn
  vtkNew<vtkDoubleArray> heat;
  heat->SetName("Heat");
  const auto normals = NamedArray<vtkDoubleArray>("Normals", 3);
  for (vtkIdType i = 0; i < scan->GetNumberOfPoints(); ++i)
  {
    heat->InsertNextValue(static_cast<double>(i));
    normals->InsertNextTuple3(0.0, 0.0, 1.0);
  }
  scan->GetPointData()->AddArray(heat);
  scan->GetPointData()->SetNormals(normals);
  vtkNew<vtkRigidAlignment> filter;
  filter->SetInputDataObject(scan);
  filter->SetTargetData(block);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  vtkPointSet* output = Scan(filter);
  EXPECT_LE(Between(output, block), 1e-9);
  EXPECT_EQ(output->GetNumberOfCells(), block->GetNumberOfCells());
  vtkPointData* arrays = output->GetPointData();
  EXPECT_EQ(arrays->GetArray("Heat")->GetTuple1(7), 7.0);
  EXPECT_EQ(arrays->GetScalars(), arrays->GetArray("Distance"));
  EXPECT_EQ(arrays->GetArray("TargetPoint")->GetNumberOfComponents(), 3);
  EXPECT_GE(arrays->GetArray("TargetFace")->GetRange()[0], 0.0);
  auto* motion = vtkDoubleArray::SafeDownCast(output->GetFieldData()->GetArray("Motion"));
  ASSERT_TRUE(motion);
  for (int d = 0; d < 3; ++d)
  {
    EXPECT_NEAR(arrays->GetNormals()->GetComponent(3, d), motion->GetValue(4 * d + 2), 1e-15);
  }
  // the matrix takes the scan to where it is
  Eigen::Vector3d from;
  Eigen::Vector3d to;
  scan->GetPoint(5, from.data());
  output->GetPoint(5, to.data());
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(
    motion->GetPointer(0));
  EXPECT_LE(((matrix * from.homogeneous()).head<3>() - to).norm(), 1e-12);
  EXPECT_EQ(Number(filter, "Converged"), 1.0);
  EXPECT_EQ(Number(filter, "Ambiguous"), 0.0);
  EXPECT_EQ(Number(filter, "EqualPoses"), 1.0);
  EXPECT_EQ(Number(filter, "Signed"), 1.0);
  EXPECT_EQ(Number(filter, "InlierFraction"), 1.0);
  EXPECT_LE(Number(filter, "Rms"), 1e-9);
  EXPECT_EQ(scan->GetPointData()->GetArray("Distance"), nullptr); // the input is as it was
}

/// The boundary of a spline volume, and a plane surface: poses that differ by half turns.
TEST(vtkRigidAlignment, VolumesAndOpenSurfacesAreTargets_ExactOracle)
{
  vtkNew<vtkSplineSource> source;
  source->SetSize(3.0, 2.0, 1.0);
  for (const bool isSolid : { true, false })
  {
    source->SetShape(isSolid ? vtkSplineSource::CUBE : vtkSplineSource::SQUARE);
    vtkNew<vtkPolyData> points;
    const PointMatrix box = fits::BoxTriangles(6).Points;
    points->SetPoints(
      MakePoints(box * Eigen::Vector3d(3.0, 2.0, isSolid ? 1.0 : 0.0).asDiagonal()));
    vtkNew<vtkRigidAlignment> filter;
    filter->SetInputDataObject(Moved(points));
    filter->SetTargetConnection(source->GetOutputPort());
    vtkNew<MessageRecorder> recorder;
    recorder->Watch(filter);
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_EQ(Number(filter, "Signed"), isSolid ? 1.0 : 0.0);
    EXPECT_EQ(Number(filter, "EqualPoses"), 4.0);
    EXPECT_LE(Number(filter, "Rms"), 1e-9);
  }
}

/// A surface that is refined in a corner is the same target as before.
TEST(vtkRigidAlignment, LocallyRefinedSurfacesAreTargets_CrossOracle)
{
  const auto plain = ShapeGrid(vtkSplineSource::SPHERE_SURFACE, 4, { 4, 4, 1 });
  vtkNew<vtkPolyData> scan; // near a part of the sphere
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 100; ++i)
  {
    const Eigen::Vector3d at(0.1 * (i % 10) - 0.4, 0.1 * (i / 10) - 0.5, 1.0);
    points->InsertNextPoint((1.01 * at.normalized()).eval().data());
  }
  scan->SetPoints(points);
  std::vector<double> rms;
  for (const int space : { -1, 0, 1 }) // none, THB, LR
  {
    vtkNew<vtkSplineRefine> refine;
    refine->SetInputDataObject(plain);
    refine->SetMode(vtkSplineRefine::CELL_ARRAY);
    refine->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "ElementId");
    refine->SetNumberOfRefinements(space < 0 ? 0 : 1);
    refine->SetLocalSpace(std::max(space, 0));
    refine->SetLowerThreshold(0.0);
    refine->SetUpperThreshold(3.0);
    vtkNew<vtkRigidAlignment> filter;
    vtkNew<MessageRecorder> recorder;
    recorder->Watch(filter);
    filter->SetInputDataObject(scan);
    filter->SetCoarse(false);
    filter->SetTargetConnection(refine->GetOutputPort());
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError) << space;
    EXPECT_EQ(Number(filter, "Signed"), 1.0);
    rms.push_back(Number(filter, "Rms"));
  }
  EXPECT_NEAR(rms[1], rms[0], 1e-9);
  EXPECT_NEAR(rms[2], rms[0], 1e-9);
}

TEST(vtkRigidAlignment, AmbiguousAndUnsettledPosesWarn)
{
  vtkNew<vtkPolyData> box;
  const TriangleMesh mesh = fits::BoxTriangles(4);
  box->SetPoints(MakePoints(mesh.Points * Eigen::Vector3d(3.0, 2.0, 1.0).asDiagonal()));
  vtkNew<vtkCellArray> cells;
  for (const auto& triangle : mesh.Triangles)
  {
    cells->InsertNextCell({ triangle[0], triangle[1], triangle[2] });
  }
  box->SetPolys(cells);
  vtkNew<vtkRigidAlignment> filter;
  filter->SetInputDataObject(Moved(box));
  filter->SetTargetData(box);
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_EQ(Number(filter, "EqualPoses"), 4.0);
  EXPECT_EQ(Number(filter, "Ambiguous"), 1.0);
  ASSERT_EQ(recorder->Warnings.size(), 1u);
  EXPECT_NE(recorder->Warnings[0].find("in 4 poses"), std::string::npos);
  recorder->Warnings.clear();
  filter->SetMaximumIterations(1);
  filter->SetCoarse(true);
  filter->SetInputDataObject(Moved(Block()));
  filter->SetTargetData(Block());
  filter->Update();
  EXPECT_EQ(Number(filter, "Converged"), 0.0);
  ASSERT_EQ(recorder->Warnings.size(), 1u);
  EXPECT_NE(recorder->Warnings[0].find("did not settle"), std::string::npos);
}

TEST(vtkRigidAlignment, ScansOfAnotherUnitWarn)
{
  const auto inches = Block();
  for (vtkIdType i = 0; i < inches->GetNumberOfPoints(); ++i)
  {
    double point[3];
    inches->GetPoint(i, point);
    inches->GetPoints()->SetPoint(i, point[0] / 25.4, point[1] / 25.4, point[2] / 25.4);
  }
  vtkNew<vtkRigidAlignment> filter;
  filter->SetInputDataObject(Moved(inches));
  filter->SetTargetData(Block());
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  ASSERT_FALSE(recorder->Warnings.empty());
  EXPECT_NE(recorder->Warnings[0].find("0.04 times as large"), std::string::npos)
    << recorder->Warnings[0];
}

TEST(vtkRigidAlignment, Errors)
{
  vtkNew<vtkRigidAlignment> filter;
  const auto block = Block();
  filter->SetTargetData(block);
  vtkNew<vtkPolyData> empty;
  filter->SetInputDataObject(empty);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(Scan(filter)->GetNumberOfPoints(), 0);
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::CUBE));
  ExpectFailure(filter, ErrorCode::InvalidParameter, "the scan");
  const auto bad = Block();
  bad->GetPoints()->SetPoint(7, 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  filter->SetInputDataObject(bad);
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "point 7");
  vtkNew<vtkPolyData> two;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0.0, 0.0, 0.0);
  points->InsertNextPoint(1.0, 0.0, 0.0);
  two->SetPoints(points);
  filter->SetInputDataObject(two);
  ExpectFailure(filter, ErrorCode::SingularSystem, "one line");
  filter->SetInputDataObject(block);
  filter->SetTargetData(ShapeGrid(vtkSplineSource::CUBE));
  ExpectFailure(filter, ErrorCode::NotConverged, "come near the target");
  filter->SetTargetData(empty);
  ExpectFailure(filter, ErrorCode::EmptyInput, "target");
  filter->SetTargetData(bad);
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "target: ");
  filter->SetTargetData(ShapeGrid(vtkSplineSource::ARC));
  ExpectFailure(filter, ErrorCode::EmptyInput, "no faces");
}

TEST(vtkRigidAlignment, ProgressAndAbort)
{
  vtkNew<vtkRigidAlignment> filter;
  filter->SetInputDataObject(Moved(Block()));
  filter->SetTargetData(Block());
  ExpectProgressAndAbort(filter, 2);
}
