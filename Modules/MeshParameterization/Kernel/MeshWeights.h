// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TriangleMesh.h"

#include <Eigen/SparseCore>

namespace knotwork
{
/// A third of the areas of the triangles at each vertex.
Eigen::VectorXd VertexAreas(const DiscMesh& mesh);

/// Triangle t laid into the plane: columns are the sides corner 0 -> 1 (along the first axis) and
/// corner 0 -> 2; the determinant is twice the area.
Eigen::Matrix2d LayTriangle(const DiscMesh& mesh, std::size_t t);

/// Half the cotangents of a triangle's corners; the one of corner k belongs to the opposite edge.
Eigen::Vector3d HalfCotangents(const DiscMesh& mesh, std::size_t t);

/// Lower triangle of the matrix of int |grad u|^2 = u' L u of piecewise linear functions.
Eigen::SparseMatrix<double> CotangentLaplacian(const DiscMesh& mesh);

/// Lower triangle of D - W with weight 1 an edge.
Eigen::SparseMatrix<double> GraphLaplacian(const DiscMesh& mesh);
}
