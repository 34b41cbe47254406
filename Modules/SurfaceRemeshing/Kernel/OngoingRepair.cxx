// SPDX-License-Identifier: BSD-3-Clause
#include "OngoingRepair.h"

#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <set>

namespace knotwork
{
Eigen::Vector3d MiddleOfRim(const RepairSoup& soup, const std::vector<int>& rim)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int point : rim)
  {
    sum += soup.Point(point);
  }
  return sum / static_cast<double>(rim.size());
}

double DiagonalOf(const PointMatrix& points, const std::vector<int>& numbers)
{
  Eigen::Vector3d lower = points.row(numbers.front()).transpose();
  Eigen::Vector3d upper = lower;
  for (const int i : numbers)
  {
    lower = lower.cwiseMin(points.row(i).transpose());
    upper = upper.cwiseMax(points.row(i).transpose());
  }
  return (upper - lower).norm();
}

std::vector<int> UsedPoints(const std::vector<MeshTriangle>& triangles)
{
  std::set<int> used;
  for (const MeshTriangle& corners : triangles)
  {
    used.insert(corners.begin(), corners.end());
  }
  return { used.begin(), used.end() };
}

MeshTriangle Sorted(MeshTriangle corners)
{
  std::sort(corners.begin(), corners.end());
  return corners;
}

void OngoingRepair::AddIntersections(
  const RepairSoup& soup, const std::vector<std::pair<int, int>>& pairs)
{
  for (const auto& [s, t] : pairs)
  {
    this->Add(RepairKind::Intersection, 0.5 * (soup.MiddleOf(s) + soup.MiddleOf(t)),
      std::min(soup.AreaOf(s), soup.AreaOf(t)));
  }
}

std::string PlaceText(const Eigen::Vector3d& point)
{
  return PointText(point.data(), 3);
}

std::string PlacesText(const std::string& what, const std::vector<Eigen::Vector3d>& places)
{
  constexpr int Named = 5;
  std::string text = what + (places.size() == 1 ? ", at " : ", some of them at ");
  if (places.size() > 1 && places.size() <= Named)
  {
    text = what + ", at ";
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(places.size(), Named); ++i)
  {
    text += (i > 0 ? ", " : "") + PlaceText(places[i]);
  }
  return text;
}
}
