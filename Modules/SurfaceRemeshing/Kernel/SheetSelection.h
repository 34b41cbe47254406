// SPDX-License-Identifier: BSD-3-Clause
// Which sheets of an arrangement are the surface, and how they come apart, private to the kernel.
#pragma once
#include "SheetArrangement.h"

#include <functional>

namespace knotwork
{
struct SheetChoice
{
  /// Winding number on the inner side of each sheet: 1 on what bounds the solid, more where it
  /// overlaps itself, at most 0 where it is inside out.
  std::vector<int> Levels;
  std::vector<char> Kept;
};

/// Keeps the sheets that bound the solid, and others that are farther from those than a depth.
/// @param triangles  that the sheets were made of.
SheetChoice ChooseSheets(const SheetMesh& sheets, const PointMatrix& points,
  const std::vector<MeshTriangle>& triangles, double depth, int threads);

/// The kept sheets, without points that none uses.
SheetMesh KeepSheets(const SheetMesh& sheets, SheetChoice& choice);

/// Moves points that are in one place apart, into what their sheets bound, so that nothing meets.
/// @param step  how far at first; halved where it is too far.
/// @param cut  places where it was cut are added.
/// @param goesOn  asked now and then; false: nothing more is done.
void SeparateSheets(SheetMesh& sheets, const std::vector<int>& levels, double step, int threads,
  std::vector<Eigen::Vector3d>& cut, const std::function<bool()>& goesOn);

/// Winding number of closed triangles around a point.
/// @param leftOut  a triangle that does not count.
double WindingNumber(const PointMatrix& points, const std::vector<MeshTriangle>& triangles,
  const Eigen::Vector3d& point, int leftOut = -1);
}
