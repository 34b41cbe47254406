// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/PointFile.h>

#include <string_view>

namespace knotwork
{
/// Reads what an SVG picture draws as polylines: paths (all commands, relative and absolute), line,
/// polyline, polygon, rect without rounded corners, circle and ellipse, with the transforms of
/// groups and elements. Curves and arcs get a point every 64th part; y points up, so of the
/// picture's coordinates it is the negative. A subpath is a line; what begins and ends at one point
/// is closed. Texts, images, uses of other elements and rounded rectangles are left out and named;
/// definitions (defs, symbol, clipPath, mask, marker, pattern) are passed over. Units and view
/// boxes are not looked at.
/// @return InvalidFormat naming the element and the place in it; EmptyInput: nothing is drawn;
/// TooLarge: more than 10 million points.
Result<PointFile> ReadSvg(std::string_view text);

/// Whether a text may be one.
bool LooksLikeSvg(std::string_view beginning);
}
