// SPDX-License-Identifier: BSD-3-Clause
// Small height fields as spline patches.
#pragma once
#include <knotwork/SplineGrid/SplineModel.h>

#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <functional>

namespace knotwork
{
using HeightFunction = std::function<double(double u, double v)>;

/// A biquadratic LR surface (u, v, z) whose coefficients of z are values of the function at the
/// Greville points; elements near the lower left corner are halved once. One field "Slope" of one
/// component with the coefficients z * z.
SplinePatch HeightTile(
  int id, const ParametricBox<2>& box, int elements, const HeightFunction& height);

/// A grid of patches; a failed encoding fails the test.
vtkSmartPointer<vtkUnstructuredGrid> GridOfPatches(std::vector<SplinePatch> patches);

/// Four tiles over [0, 2]^2 with a bump, each of its own resolution and lifted by a height of its
/// own; ids 0 to 3.
std::vector<SplinePatch> FourTiles(double lift);
}
