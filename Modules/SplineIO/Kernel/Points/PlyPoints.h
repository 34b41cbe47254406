// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/PointFile.h>

#include <string_view>

namespace knotwork
{
/// Reads the vertices of a PLY file (ascii, binary of either byte order) with all their properties:
/// x, y, z with the precision they are stored with, others as channels of the property's name.
/// Faces (the list vertex_indices or vertex_index) become polygons; LeftOut names other elements.
/// @return InvalidFormat naming line, or element and number (also a face of fewer than three
/// corners, words or bytes behind the last element); NonFiniteInput naming the vertex;
/// InvalidTopology for a face of a vertex that is not there; EmptyInput without vertices.
/// @complexity time and memory O(size of the text), whatever counts the header claims.
Result<PointFile> ReadPly(std::string_view text);
}
