// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include <string>
#include <vector>

namespace knotwork
{
/// Points of a file that belong together.
struct PointGroup
{
  Eigen::Index Begin = 0; ///< first row; ends where the next group begins
  bool HasColor = false;
  std::array<int, 4> Color{}; ///< red, green, blue, opacity, each in [0, 255]
};

/// What a file of points holds.
struct PointFile
{
  PointMatrix Points;                     ///< n x 3
  PointMatrix Channels;                   ///< n x c, numbers of the points
  std::vector<std::string> Names;         ///< c, of the channels
  std::vector<PointGroup> Groups;         ///< empty: all points are one, without a colour
  std::vector<std::vector<int>> Polygons; ///< rows of Points, at least three each
  std::vector<std::vector<int>> Lines;    ///< rows of Points, at least two each
  std::string ReferenceSystem;            ///< of the coordinates, as the file says it; empty: none
  std::vector<std::string> Warnings;      ///< what is not as it should be, one line each
  std::vector<std::string> LeftOut;       ///< parts of the file that are not here, one line each
};

/// What writers of points ask of them. @return NonFiniteInput naming point and coordinate.
Status CheckCoordinates(const PointMatrix& points);
}
