// SPDX-License-Identifier: BSD-3-Clause
// Solids of known volume, meshed in a process; what cannot be meshed is one error.
#include "FilterCases.h"
#include <knotwork/JacobianValidation/vtkJacobianValidator.h>
#include <knotwork/SplineGrid/WorkerProcess.h>
#include <knotwork/TetMeshing/vtkTetGenMesher.h>

#include "vtkAppendPolyData.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkReverseSense.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

using namespace knotwork;

namespace
{
vtkSmartPointer<vtkPolyData> Box(double size, double at = 0.0, bool inward = false)
{
  vtkNew<vtkCubeSource> source;
  source->SetXLength(size);
  source->SetYLength(size);
  source->SetZLength(size);
  source->SetCenter(at, 0.0, 0.0);
  vtkNew<vtkReverseSense> reverse;
  reverse->SetInputConnection(source->GetOutputPort());
  reverse->Update();
  source->Update();
  auto box = vtkSmartPointer<vtkPolyData>::New();
  box->DeepCopy(inward ? reverse->GetOutput() : source->GetOutput());
  return box;
}

vtkSmartPointer<vtkPolyData> Together(vtkPolyData* a, vtkPolyData* b)
{
  vtkNew<vtkAppendPolyData> append;
  append->AddInputData(a);
  append->AddInputData(b);
  append->Update();
  return append->GetOutput();
}

double Number(vtkTetGenMesher* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(2))->GetValueByName(0, name).ToDouble();
}

vtkUnstructuredGrid* Cells(vtkTetGenMesher* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

std::vector<std::string> ErrorsOf(vtkTetGenMesher* filter)
{
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->Modified();
  filter->Update();
  EXPECT_EQ(Cells(filter)->GetNumberOfCells(), 0);
  // the pipeline says that the filter failed, too
  std::vector<std::string> errors;
  for (const std::string& error : recorder->Errors)
  {
    if (error.find("returned failure") == std::string::npos)
    {
      errors.push_back(error);
    }
  }
  filter->RemoveObserver(recorder);
  filter->GetExecutive()->RemoveObserver(recorder);
  return errors;
}
}

TEST(vtkTetGenMesher, BoxesHaveTheirVolumes)
{
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(Box(2.0));
  filter->SetEdgeLength(0.5);
  for (const bool kept : { true, false })
  {
    filter->SetKeepBoundary(kept);
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_NEAR(Number(filter, "Volume"), 8.0, 1e-11);
    EXPECT_NEAR(Number(filter, "SurfaceVolume"), 8.0, 1e-11);
    EXPECT_EQ(Number(filter, "BoundaryTriangles") == 12, kept);
    EXPECT_NEAR(Number(filter, "DistanceToSurface"), 0.0, 1e-3);
    if (!kept) // beside large triangles that stay cells stay large
    {
      EXPECT_GE(Cells(filter)->GetNumberOfCells(), 8.0 / (0.125 / 6.0 / std::sqrt(2.0)));
    }
  }
}

TEST(vtkTetGenMesher, PartsWithinAreVoidsOrRegions)
{
  for (const bool inward : { false, true })
  {
    vtkNew<vtkTetGenMesher> filter;
    filter->SetInputDataObject(Together(Together(Box(3.0), Box(2.0, 0.0, inward)), Box(1.0, 0.0)));
    filter->Update();
    EXPECT_NEAR(Number(filter, "Volume"), 27.0 - 8.0 + 1.0, 1e-10);
    EXPECT_NEAR(Number(filter, "SurfaceVolume"), 20.0, 1e-10);
    EXPECT_EQ(Number(filter, "Regions"), 2);
    filter->SetInner(vtkTetGenMesher::REGIONS);
    filter->Update();
    EXPECT_NEAR(Number(filter, "Volume"), 27.0, 1e-10);
    EXPECT_NEAR(Number(filter, "SurfaceVolume"), 27.0, 1e-10);
    EXPECT_EQ(Number(filter, "Regions"), 3);
  }
}

/// Curved cells of a ball and a torus: the volume's error falls with the fourth power of the size,
/// the distance is far below that of straight cells, and the validator agrees with the certificate.
TEST(vtkTetGenMesher, CurvedCellsFollowTheirTarget)
{
  const struct
  {
    int Shape;
    double Volume;
    double Tolerances[2];
  } cases[] = { { vtkSplineSource::BALL, 4.0 / 3.0 * M_PI, { 0.02, 0.005 } },
    { vtkSplineSource::SOLID_TORUS, M_PI * M_PI / 8.0, { 0.004, 0.001 } } };
  for (const auto& c : cases)
  {
    for (const int order : { 2, 3 })
    {
      SCOPED_TRACE(std::to_string(c.Shape) + ", order " + std::to_string(order));
      double errors[2] = {};
      for (int i = 0; i < 2; ++i)
      {
        vtkNew<vtkTetGenMesher> filter;
        filter->SetInputDataObject(ShapeGrid(c.Shape));
        filter->SetChordalTolerance(c.Tolerances[i]);
        filter->SetOrder(order);
        filter->Update();
        ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
        errors[i] = std::abs(Number(filter, "Volume") - c.Volume);
        EXPECT_LE(Number(filter, "CurvedToTarget"), 0.1 * Number(filter, "StraightToTarget"));
        EXPECT_LE(Number(filter, "RelaxedElements"), 0.02 * Number(filter, "BoundaryElements"));
        vtkNew<vtkJacobianValidator> validator;
        validator->SetInputDataObject(Cells(filter));
        validator->SetInjectivity(false);
        validator->SetMeasures(false);
        validator->Update();
        double verdicts[2];
        vtkUnstructuredGrid::SafeDownCast(validator->GetOutputDataObject(0))
          ->GetCellData()
          ->GetArray("JacobianVerdict")
          ->GetRange(verdicts);
        EXPECT_EQ(verdicts[0], 1.0);
        EXPECT_GT(Number(filter, "MinJacobianLower"), 0.0);
      }
      EXPECT_GT(errors[0] / errors[1], 10.0) << errors[0] << " " << errors[1];
    }
  }
}

TEST(vtkTetGenMesher, DamageIsOneErrorWithItsPlace)
{
  vtkNew<vtkTetGenMesher> filter;
  const auto expect = [&](vtkPolyData* surface, const char* words)
  {
    filter->SetInputDataObject(surface);
    const auto errors = ErrorsOf(filter);
    ASSERT_EQ(errors.size(), 1u) << words;
    EXPECT_NE(errors[0].find(words), std::string::npos) << errors[0];
  };
  auto open = Box(1.0);
  vtkNew<vtkCellArray> faces;
  for (vtkIdType f = 1; f < 6; ++f)
  {
    faces->InsertNextCell(open->GetCell(f));
  }
  open->SetPolys(faces);
  expect(open, "4 open edges");
  expect(Together(Box(1.0), Box(1.0, 0.4)), "intersect");
  auto flipped = Box(1.0);
  flipped->BuildCells();
  flipped->ReverseCell(0);
  expect(flipped, "turned against each other");
  auto spoiled = Box(1.0);
  spoiled->GetPoints()->SetPoint(0, std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  expect(spoiled, "cannot be divided"); // of triangles it is the kernel that looks
  auto flat = Box(1.0);
  for (vtkIdType i = 0; i < flat->GetNumberOfPoints(); ++i)
  {
    double x[3];
    flat->GetPoint(i, x);
    flat->GetPoints()->SetPoint(i, x[0], x[1], 0.0);
  }
  expect(flat, "cannot be divided");
  // it goes on living
  filter->SetInputDataObject(Box(1.0));
  filter->Update();
  EXPECT_NEAR(Number(filter, "Volume"), 1.0, 1e-12);
  filter->SetInputDataObject(open);
  filter->SetRepair(true);
  filter->Update();
  EXPECT_NEAR(Number(filter, "Volume"), 1.0, 1e-12);
  EXPECT_EQ(Number(filter, "Repaired"), 1);
}

TEST(vtkTetGenMesher, LimitsEndTheProcessAndNothingElse)
{
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(Box(1.0));
  filter->SetEdgeLength(0.002);
  filter->SetKeepBoundary(false);
  filter->SetMaxSteinerPoints(VTK_INT_MAX);
  filter->SetMemoryLimit(60);
  filter->SetTimeLimit(60);
  auto errors = ErrorsOf(filter);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("MemoryLimit"), std::string::npos) << errors[0];
  filter->SetMemoryLimit(100000);
  filter->SetTimeLimit(1);
  errors = ErrorsOf(filter);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("TimeLimit"), std::string::npos) << errors[0];
}

TEST(vtkTetGenMesher, AProgramThatCrashesOrIsNotThereIsAnError)
{
  const TemporaryFolder folder;
  setenv("KNOTWORK_WORKERS", folder.Path().c_str(), 1);
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(Box(1.0));
  auto errors = ErrorsOf(filter);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("is missing"), std::string::npos) << errors[0];
  std::ofstream(folder.Path() + "/knotwork-tetgen") << "#!/bin/sh\nkill -SEGV $$\n";
  std::filesystem::permissions(
    folder.Path() + "/knotwork-tetgen", std::filesystem::perms::owner_all);
  filter->Modified();
  errors = ErrorsOf(filter);
  unsetenv("KNOTWORK_WORKERS");
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("TetGen crashed"), std::string::npos) << errors[0];
}
