// SPDX-License-Identifier: BSD-3-Clause
// What a surface is by CGAL's own functions on polygon meshes, which the repair does not use.
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

#include <string>

namespace knotwork
{
/// What keeps a mesh from being the boundary of a solid, outward: empty when nothing does.
std::string WhyNoSolid(const TriangleMesh& mesh);

/// Largest distance of samples on a mesh, a grid of points a triangle, from another one.
double SampledDistance(const TriangleMesh& from, const TriangleMesh& to);
}
