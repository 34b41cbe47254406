// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/FitTarget.h>
#include <knotwork/MeshParameterization/MeshFeatures.h>

namespace knotwork
{
/// The surface of a triangle mesh as a target: its faces are the regions between sharp edges and
/// rims, its curves and vertices their chains and corners.
/// @return the errors of CheckSurface and FindMeshFeatures.
/// @complexity O(n log n); a query near the one before about O(1), else O(log n).
Result<FitTargetPtr> MakeMeshTarget(const TriangleMesh& mesh, const MeshFeatureParams& params = {});
}
