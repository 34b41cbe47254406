// SPDX-License-Identifier: BSD-3-Clause
// What the program knotwork-mesh3 takes and hands over, as arrays of the machine's numbers
// (TetGenParts.h).
#pragma once
#include "TetGenParts.h"

namespace knotwork
{
/// Parts of the input: numbers of points in each direction (int), their distances (double), values
/// of the points, x first (double); Bounds (double); a point in each region that has a length of
/// edges of its own, and that (double, four each); a background grid as of TetGen. Coordinates are
/// from the image's first point on, along its axes.
/// Parts of the answer: coordinates (double), corners of tetrahedra, their labels, corners of the
/// triangles between cells of two labels or beside one, seen from the side of the larger label.
enum class ImageMeshInput
{
  Size,
  Spacing,
  Values,
  Bounds,
  Regions,
  SizePoints,
  SizeCells,
  Sizes,
  Count
};
enum class ImageMeshAnswer
{
  Points,
  Tetrahedra,
  Labels,
  Triangles,
  Count
};

/// What is solid.
enum class ImageSolid
{
  Below,
  Above,
  Labels
};

/// Places of numbers among Bounds.
enum class ImageMeshBound
{
  Solid, ///< an ImageSolid
  Level,
  Distance, ///< of triangles from the surface
  RadiusEdgeRatio,
  MinDihedralAngle,
  EdgeLength, ///< 0: none
  MaxPoints,
  Count
};
}
