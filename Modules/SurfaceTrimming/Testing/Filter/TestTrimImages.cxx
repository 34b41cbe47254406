// SPDX-License-Identifier: BSD-3-Clause
// Pictures of trimmed surfaces.
#include "HeightTiles.h"
#include "Rendering.h"
#include <knotwork/SurfaceTrimming/vtkSplineTrimToPoints.h>

#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <cmath>

using namespace knotwork;

TEST(TrimImages, TrimToPoints_GoldenOracle)
{
  // a lattice with a round hole and a corner that is missing
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 61 * 61; ++i)
  {
    const double x = (i % 61) / 30.0;
    const double y = (i / 61) / 30.0;
    if (std::hypot(x - 0.7, y - 1.2) > 0.35 && x + y < 3.3)
    {
      points->InsertNextPoint(x, y, 0.0);
    }
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkSplineTrimToPoints> trim;
  trim->SetInputDataObject(0,
    GridOfPatches({ HeightTile(0, { { 0, 0 }, { 2, 2 } }, 5,
      [](double u, double v) { return 0.2 * std::sin(2 * u) * v; }) }));
  trim->SetPointsData(cloud);
  trim->Update();
  RenderOptions options;
  options.From = { -0.5, -1.0, 1.6 };
  options.Up = { 0.0, 0.0, 1.0 };
  EXPECT_TRUE(RenderAndCompare(
    vtkPolyData::SafeDownCast(trim->GetOutputDataObject(0)), "SplineTrimToPoints", options));
}
