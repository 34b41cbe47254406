// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SurfaceTrimming/ChartMesh.h>

#include <array>
#include <vector>

/// Grids of lines over the plane of a chart.
namespace knotwork
{
/// Points at the crossings of grid lines, some of them known.
struct KnownGrid
{
  std::array<std::vector<double>, 2> Lines;
  PointMatrix Points; ///< first direction fastest
  std::vector<char> Known;

  int Size(std::size_t direction) const { return static_cast<int>(this->Lines[direction].size()); }
  Eigen::Index Place(int i, int j) const
  {
    return static_cast<Eigen::Index>(j) * this->Size(0) + i;
  }
  bool IsKnown(int i, int j) const
  {
    return i >= 0 && j >= 0 && i < this->Size(0) && j < this->Size(1) &&
      this->Known[static_cast<std::size_t>(this->Place(i, j))];
  }
};

/// The grid of lines, its points in the chart known: linear interpolation in the triangles.
KnownGrid GridOfChart(const ChartMesh& chart, std::array<std::vector<double>, 2> lines);
}
