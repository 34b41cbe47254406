// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceSides.h"

namespace knotwork
{
/// A function on the points of a surface whose zero line is the cut between two sides: positive on
/// side 1. Away from creases the line is smooth (a few steps of heat flow from +-1); points of
/// creases between the sides have exactly 0, those of holes the sign of their hole; where the line
/// comes near a point that point has exactly 0, so that no small triangles are cut off.
/// @param creaseAngle  radians: edges between the sides that are sharper are kept.
/// Less smooth, and at last along edges, where much would be lost of one of the sides.
Eigen::VectorXd CutFunction(const SurfaceParts& parts, const Sides& sides, double creaseAngle);
}
