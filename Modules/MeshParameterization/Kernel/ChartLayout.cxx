// SPDX-License-Identifier: BSD-3-Clause
#include "ChartLayout.h"

#include "FlattenReport.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double GapShare = 0.02; // of the side of a square of the area of all boxes
}

void PlaceSideBySide(std::vector<MeshParameterization>& charts)
{
  if (charts.size() < 2)
  {
    return;
  }
  std::vector<Eigen::RowVector2d> sizes;
  double area = 0.0;
  double widest = 0.0;
  for (MeshParameterization& chart : charts)
  {
    TurnToAxes(chart.UV);
    const Eigen::RowVector2d low = chart.UV.colwise().minCoeff();
    chart.UV.rowwise() -= low;
    sizes.push_back(chart.UV.colwise().maxCoeff());
    area += sizes.back()[0] * sizes.back()[1];
    widest = std::max(widest, sizes.back()[0]);
  }
  const double gap = GapShare * std::sqrt(area);
  const double width = std::max(widest, 1.2 * std::sqrt(area));
  std::vector<std::size_t> order(charts.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return sizes[a][1] > sizes[b][1]; });
  Eigen::RowVector2d place(0.0, 0.0);
  double height = 0.0; // of the row
  for (std::size_t c : order)
  {
    if (place[0] > 0.0 && place[0] + sizes[c][0] > width)
    {
      place = Eigen::RowVector2d(0.0, place[1] + height + gap);
      height = 0.0;
    }
    charts[c].UV.rowwise() += place;
    place[0] += sizes[c][0] + gap;
    height = std::max(height, sizes[c][1]);
  }
  const Eigen::RowVector2d centre(0.5 * width, 0.5 * (place[1] + height));
  for (MeshParameterization& chart : charts)
  {
    chart.UV.rowwise() -= centre;
  }
}
}
