// SPDX-License-Identifier: BSD-3-Clause
// Solids that touch along edges and at vertices alone are meshed apart. Private to the kernel.
#pragma once
#include <knotwork/CADModel/CADTopology.h>

namespace knotwork
{
/// Solids that share faces, directly or through others, are a group, and what shares an edge with a
/// shell or a face outside of solids. @return number of the group of every body, from 0 on.
std::vector<int> GroupsOfBodies(const CADTopology& model);

/// Points of cells of several groups become as many, so that what touches only along them is not
/// joined there; the first group with a cell keeps the point.
/// @param corners  numbers of points, as many of every cell, which are changed.
/// @param groupOf  of every cell.
/// @return old numbers of the new points, which follow all others.
std::vector<int> SeparatePoints(
  std::vector<int>& corners, const std::vector<int>& groupOf, int numPoints);
}
