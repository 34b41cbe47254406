// SPDX-License-Identifier: BSD-3-Clause
// Lengths that edges should have, private to the kernel.
#pragma once
#include "SurfaceRemesh.h"

namespace knotwork
{
/// Largest normal curvature at every point of a surface; across sharp edges none. Of each region
/// between these the mean of the triangles around, of several the largest, and that of the lines.
/// @source Rusinkiewicz, Estimating curvatures and their derivatives on triangle meshes, 3DPVT
/// 2004.
std::vector<double> LargestCurvatures(const DiscMesh& surface, const MeshFeatures& features);

/// Longest edge that is nowhere farther than tolerance from a surface of a curvature.
double ChordOf(double curvature, double tolerance);

/// Lowers lengths until along no edge they grow by more than half of it.
void LimitGrowth(const DiscMesh& surface, std::vector<double>& sizes);
}
