// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include "vtkSplineVolumeFit.h"
#include <knotwork/SplineCore/LRVolume.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/SplineModel.h>

#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <random>

using namespace knotwork;

namespace
{
/// A peak in a box of lengths 2, 1, 1, and a vector field.
vtkSmartPointer<vtkPolyData> Samples(int n)
{
  std::mt19937_64 engine(3);
  const auto unit = [&engine] { return static_cast<double>(engine() >> 11) * 0x1.0p-53; };
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const auto values = NamedArray<vtkDoubleArray>("Temperature");
  const auto vectors = NamedArray<vtkDoubleArray>("Velocity", 3);
  for (int i = 0; i < n; ++i)
  {
    const double x[3] = { 2.0 * unit(), unit(), unit() };
    points->InsertNextPoint(x);
    const double square =
      (x[0] - 0.5) * (x[0] - 0.5) + (x[1] - 0.5) * (x[1] - 0.5) + (x[2] - 0.5) * (x[2] - 0.5);
    values->InsertNextValue(std::exp(-30.0 * square));
    vectors->InsertNextTuple3(x[0] * x[1], x[2], 1.0 - x[0]);
  }
  data->SetPoints(points);
  data->GetPointData()->SetScalars(values);
  data->GetPointData()->AddArray(vectors);
  return data;
}
}

TEST(vtkSplineVolumeFit, ValuesBecomeAFieldOverTheirBox_CrossOracle)
{
  for (const int space : { vtkSplineVolumeFit::LR, vtkSplineVolumeFit::THB })
  {
    vtkNew<vtkSplineVolumeFit> fit;
    fit->SetInputData(Samples(8000));
    fit->SetTolerance(0.02);
    fit->SetSpace(space);
    fit->Update();
    auto* grid = vtkUnstructuredGrid::SafeDownCast(fit->GetOutputDataObject(0));
    ASSERT_GT(grid->GetNumberOfCells(), 8);
    const SplineModel model = DecodePatches(grid);
    ASSERT_EQ(model.Patches.size(), 1U);
    EXPECT_EQ(model.Patches[0].Fields[0].Name, "Temperature");
    const auto& volume = std::get<Spline<3>>(model.Patches[0].Geometry);
    EXPECT_EQ(volume.Space->Kind,
      space == vtkSplineVolumeFit::LR ? SpaceKind::LocallyRefined : SpaceKind::Hierarchical);
    // Bezier points on corners of the box are the box
    double bounds[6];
    grid->GetBounds(bounds);
    const ParametricBox<3> domain = volume.Space->Domain();
    for (std::size_t d = 0; d < 3; ++d)
    {
      EXPECT_NEAR(bounds[2 * d], domain.Lower[d], 1e-12);
      EXPECT_NEAR(bounds[2 * d + 1], domain.Upper[d], 1e-12);
    }
    auto* points = vtkPointSet::SafeDownCast(fit->GetOutputDataObject(1));
    double range[2];
    points->GetPointData()->GetArray("Distance")->GetRange(range);
    EXPECT_LE(range[1], 0.02);
    auto* table = vtkTable::SafeDownCast(fit->GetOutputDataObject(2));
    const vtkIdType last = table->GetNumberOfRows() - 1;
    EXPECT_EQ(table->GetValueByName(last, "PointsOutside").ToInt(), 0);
    EXPECT_EQ(table->GetValueByName(last, "Functions").ToInt(), volume.Space->NumFunctions);
    EXPECT_EQ(table->GetValueByName(last, "MaxError").ToDouble(), range[1]);
  }
}

TEST(vtkSplineVolumeFit, VectorsAreFittedByName_ExactOracle)
{
  vtkNew<vtkSplineVolumeFit> fit;
  fit->SetInputData(Samples(2000));
  fit->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Velocity");
  fit->SetTolerance(1e-6); // quadratic functions are in the space
  fit->Update();
  const SplineModel model =
    DecodePatches(vtkUnstructuredGrid::SafeDownCast(fit->GetOutputDataObject(0)));
  EXPECT_EQ(model.Patches[0].Fields[0].Coefficients.cols(), 3);
  EXPECT_EQ(vtkTable::SafeDownCast(fit->GetOutputDataObject(2))->GetNumberOfRows(), 1);
}

TEST(vtkSplineVolumeFit, EveryFailureIsReachable)
{
  const auto check = [](vtkPolyData* data, const char* name, ErrorCode code, const char* words)
  {
    vtkNew<vtkSplineVolumeFit> fit;
    fit->SetInputData(data);
    if (name)
    {
      fit->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
    }
    ExpectFailure(fit, code, words);
  };
  const auto good = Samples(100);
  check(good, "Pressure", ErrorCode::InvalidParameter, "Pressure");
  vtkNew<vtkPolyData> bare;
  bare->SetPoints(good->GetPoints());
  check(bare, nullptr, ErrorCode::InvalidParameter, "name a point array");
  const auto shorter = NamedArray<vtkDoubleArray>("Few", 1, 7);
  shorter->Fill(0.0);
  bare->GetPointData()->AddArray(shorter);
  check(bare, "Few", ErrorCode::SizeMismatch, "7 rows");
}
