// SPDX-License-Identifier: BSD-3-Clause
// A closed surface around triangles of any kind, private to the kernel.
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

namespace knotwork
{
/// A closed, oriented surface without intersections around all triangles, however they meet, that a
/// ball of a radius does not pass; at a distance outside of them.
/// @param alpha  radius, > 0. @param offset  > 0.
/// @source Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez, Alpha wrapping with an offset,
/// ACM TOG 41 (2022) 127.
TriangleMesh WrapTriangles(const TriangleMesh& mesh, double alpha, double offset);
}
