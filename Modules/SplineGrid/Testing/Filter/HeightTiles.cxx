// SPDX-License-Identifier: BSD-3-Clause
#include "HeightTiles.h"

#include <knotwork/SplineCore/LRStrategies.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

#include <cmath>

namespace knotwork
{
SplinePatch HeightTile(
  int id, const ParametricBox<2>& box, int elements, const HeightFunction& height)
{
  std::array<KnotVector, 2> knots;
  for (std::size_t d = 0; d < 2; ++d)
  {
    knots[d] = KnotVector::Uniform(2, elements, box.Lower[d], box.Upper[d]);
  }
  auto space = InsertSegments(MakeTensorSpace<2>(knots).Value, {}, 0).Value;
  const auto segments = SegmentsForElements(*space, { 0, 1 });
  space = InsertSegments(space, segments.Value, 0).Value;
  EXPECT_NE(space, nullptr);
  const LRBasis& basis = space->LocallyRefined->Basis;
  Spline<2> surface;
  surface.Space = space;
  surface.ControlPoints.resize(space->NumFunctions, 3);
  SplineField field{ "Slope", PointMatrix(space->NumFunctions, 1) };
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    for (int d = 0; d < 2; ++d)
    {
      const int* local = basis.Local(f, d);
      const std::vector<double>& t = basis.Knots[static_cast<std::size_t>(d)];
      surface.ControlPoints(f, d) =
        0.5 * (t[static_cast<std::size_t>(local[1])] + t[static_cast<std::size_t>(local[2])]);
    }
    const double z = height(surface.ControlPoints(f, 0), surface.ControlPoints(f, 1));
    surface.ControlPoints(f, 2) = z;
    field.Coefficients(f, 0) = z * z;
  }
  SplinePatch patch;
  patch.Id = id;
  patch.Geometry = std::move(surface);
  patch.Fields.push_back(std::move(field));
  return patch;
}

vtkSmartPointer<vtkUnstructuredGrid> GridOfPatches(std::vector<SplinePatch> patches)
{
  SplineModel model;
  model.Patches = std::move(patches);
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  const Status status = EncodeSplineGrid(model, grid);
  EXPECT_TRUE(status) << status.Message();
  return grid;
}

std::vector<SplinePatch> FourTiles(double lift)
{
  std::vector<SplinePatch> patches;
  for (int t = 0; t < 4; ++t)
  {
    const double x = t % 2;
    const double y = t / 2;
    patches.push_back(HeightTile(t, { { x, y }, { x + 1.0, y + 1.0 } }, 5 + t,
      [t, lift](double u, double v)
      {
        return 0.7 * std::exp(-3.0 * ((u - 0.9) * (u - 0.9) + (v - 1.1) * (v - 1.1))) +
          lift * (t - 1.5);
      }));
  }
  return patches;
}
}
