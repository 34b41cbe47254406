// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshParameterization.h"

namespace knotwork
{
/// Hessian eigenmaps (HLLE): eigenvectors of the Hessian functional, made near-isometric by one
/// linear map. Eigenvectors that live on few vertices are rejected; where the first two fold, the
/// pair of the first six that folds least is taken.
/// @return SingularSystem; NotConverged; InvalidParameter: fewer than 8 points.
/// @source Donoho, Grimes, PNAS 100 (2003) 5591-5596.
Result<FlatMesh> HessianEigenmap(const DiscMesh& mesh, const FlattenParams& params);

/// Laplacian eigenmaps: the first two eigenvectors beside the constant one.
/// @source Belkin, Niyogi, Neural Computation 15 (2003) 1373-1396.
Result<FlatMesh> LaplacianEigenmap(const DiscMesh& mesh, const FlattenParams& params);

/// Isomap with landmarks: places of farthest points by classical scaling of their geodesic
/// distances, all others from their distances to these.
/// @return SingularSystem: the distances are those of a line.
/// @source Tenenbaum, de Silva, Langford, Science 290 (2000) 2319; de Silva, Tenenbaum (2004).
Result<FlatMesh> LandmarkIsomap(const DiscMesh& mesh, const FlattenParams& params);
}
