// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace knotwork::name
{
/// Cell array of Bezier cells that were read with the mesh which they belong to: the numbers of the
/// mesh's vertices at the corners of every cell, in VTK's order, -1 behind the last. Corners of one
/// number are one vertex, whether or not the cells share the point.
constexpr const char* MeshVertices = "MeshVertices";
}
