// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TriangleMesh.h"

#include <Eigen/SparseCore>

namespace knotwork
{
/// Lower triangle of the matrix of the Hessian functional int |Hess f|^2 of functions on a mesh, up
/// to a factor. Around each vertex, the vertex and its `neighbours` nearest ones by geodesic
/// distance are unfolded; three orthonormal combinations of their values vanish on linear functions
/// and measure u^2, sqrt(2) u v and v^2 (QR). Weights: area over the fourth power of the
/// neighbourhood's radius, so that the size of triangles does not matter.
/// @param neighbours  at least 5. @param threads  0: all cores; does not change the result.
/// @complexity O(n * neighbours^2).
/// @source Donoho, Grimes, PNAS 100 (2003) 5591-5596.
Eigen::SparseMatrix<double> HessianMatrix(const DiscMesh& mesh, int neighbours, int threads);
}
