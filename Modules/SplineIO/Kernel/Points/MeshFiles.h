// SPDX-License-Identifier: BSD-3-Clause
// Meshes as text or bytes. A number that is none, NaN or infinity, corners that are no points, and
// what stands behind the last face are errors that name the line: nothing is taken for 0. Numbers
// are read independently of the locale and rounded to the nearest double. Time and memory are
// O(size of the text), whatever counts it claims.
#pragma once
#include <knotwork/SplineIO/PointFile.h>

#include <string_view>

namespace knotwork
{
/// Reads an OFF mesh: OFF, COFF, NOFF or CNOFF, then the numbers of points and faces (and edges),
/// a point a line, a face a line; comments from # on. Colours and normals behind the coordinates
/// and colours behind the corners must be numbers and are not looked at further.
/// @return EmptyInput without points; InvalidFormat naming line and word (also a face of fewer than
/// three corners, a corner that is no point, words behind the last face); NonFiniteInput.
Result<PointFile> ReadOff(std::string_view text);

/// Reads a Wavefront OBJ mesh: points (v), faces (f) and polylines (l) with numbers from 1 or
/// counted backwards; \ continues a line. Texture coordinates (vt) become channels TCoords:0,
/// TCoords:1 where every point of the faces has one pair of them. Normals, groups, materials,
/// weights and colours of points are not looked at; of curves, surfaces and tags of subdivision
/// (curv, surf, t) LeftOut says that they are not here.
/// @return EmptyInput without points; InvalidFormat naming line and word (also an unknown keyword);
/// NonFiniteInput.
Result<PointFile> ReadObj(std::string_view text);

/// Reads an STL mesh, binary or text, of one or several solids. Corners of equal coordinates are
/// one point; points are numbered as they come. Facets with equal corners are no facets, a warning
/// counts them. Normals are not looked at.
/// @return EmptyInput without a facet; InvalidFormat naming line and word or the facet (also bytes
/// behind the last facet); NonFiniteInput.
Result<PointFile> ReadStl(std::string_view text);
}
