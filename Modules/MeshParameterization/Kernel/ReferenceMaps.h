// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshParameterization.h"

namespace knotwork
{
/// Least squares conformal map; two boundary points far from each other are held.
/// @source Levy, Petitjean, Ray, Maillot, ACM TOG 21 (2002) 362-371.
Result<FlatMesh> LeastSquaresConformalMap(const DiscMesh& mesh);

/// As-rigid-as-possible map, by local and global steps from the conformal one.
/// @source Liu, Zhang, Xu, Gotsman, Gortler, CGF 27 (2008) 1495-1504.
Result<FlatMesh> AsRigidAsPossibleMap(const DiscMesh& mesh, int maxIterations);
}
