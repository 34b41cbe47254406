// SPDX-License-Identifier: BSD-3-Clause
// The cost of models of many patches: proportional to their number.
#include "FilterCases.h"
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>

#include "vtkAppendFilter.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>

using namespace knotwork;

namespace
{
/// n x n biquadratic patches of a wavy sheet, side by side.
vtkSmartPointer<vtkUnstructuredGrid> Sheet(int n)
{
  const KnotVector bezier = KnotVector::Create(2, { 0, 0, 0, 1, 1, 1 }).Value;
  const auto space = MakeTensorSpace<2>({ bezier, bezier });
  SplineModel model;
  for (int p = 0; p < n * n; ++p)
  {
    Spline<2> spline;
    spline.Space = space.Value;
    spline.ControlPoints.resize(9, 3);
    for (int k = 0; k < 9; ++k)
    {
      const double x = p % n + 0.5 * (k % 3);
      const double y = p / n + 0.5 * (k / 3);
      spline.ControlPoints.row(k) << x, y, 0.2 * std::sin(3.0 * x) * std::cos(2.0 * y);
    }
    SplinePatch patch;
    patch.Id = p;
    patch.Geometry = std::move(spline);
    model.Patches.push_back(std::move(patch));
  }
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  EXPECT_TRUE(EncodeSplineModel(model, nullptr, grid));
  return grid;
}

/// Processor seconds of the fastest of three.
double Seconds(const std::function<void()>& work)
{
  double least = 1e300;
  for (int i = 0; i < 3; ++i)
  {
    const std::clock_t begin = std::clock();
    work();
    least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

/// Of 16 times as many patches, 16 times the work; where each patch looks at all, 256 times.
void ExpectProportional(const std::function<void(vtkUnstructuredGrid*)>& work)
{
  const auto few = Sheet(32);
  const auto many = Sheet(128);
  const double one = Seconds([&] { work(few); });
  const double all = Seconds([&] { work(many); });
  EXPECT_LT(all, 64.0 * one) << one << " s, " << all << " s";
}

void ExpectDecoded(vtkUnstructuredGrid* grid)
{
  const auto model = DecodeSplineModel(grid, 1);
  ASSERT_TRUE(model) << model.Status.Message();
  ASSERT_EQ(static_cast<vtkIdType>(model.Value.Patches.size()), grid->GetNumberOfCells());
  EXPECT_FALSE(model.Value.Patches.back().Recovered);
}
}

TEST(ManyPatches, DecodingIsProportional_PropertyOracle)
{
  ExpectProportional(ExpectDecoded);
}

TEST(ManyPatches, DecodingRenumberedPatchesIsProportional_PropertyOracle)
{
  ExpectProportional(
    [](vtkUnstructuredGrid* grid)
    {
      vtkNew<vtkUnstructuredGrid> copy;
      copy->ShallowCopy(grid);
      vtkNew<vtkIntArray> ids;
      ids->SetName("PatchId");
      for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
      {
        ids->InsertNextValue(static_cast<int>(cell) + 1000000);
      }
      copy->GetCellData()->AddArray(ids);
      ExpectDecoded(copy);
    });
}

TEST(ManyPatches, AppendedPatchesAreNumberedInProportionalTime_PropertyOracle)
{
  ExpectProportional(
    [](vtkUnstructuredGrid* grid)
    {
      vtkNew<vtkAppendFilter> twice;
      twice->AddInputData(grid);
      twice->AddInputData(grid);
      twice->Update();
      twice->GetOutput()->GetFieldData()->ShallowCopy(grid->GetFieldData());
      ExpectDecoded(twice->GetOutput());
    });
}

TEST(ManyPatches, TessellatingIsProportional_PropertyOracle)
{
  ExpectProportional(
    [](vtkUnstructuredGrid* grid)
    {
      vtkNew<vtkSplineTessellate> filter;
      filter->SetInputDataObject(grid);
      filter->SetChordalTolerance(0.05);
      filter->RelativeToleranceOff();
      filter->SetThreads(1);
      filter->Update();
      EXPECT_GE(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfCells(),
        grid->GetNumberOfCells());
    });
}
