// SPDX-License-Identifier: BSD-3-Clause
#include "FanTruncation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <numeric>

namespace knotwork
{
namespace
{
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;

Point ToPoint(const Eigen::Vector3d& p)
{
  return { p[0], p[1], p[2] };
}
}

// Ears are clipped from the polygon of directions on the sphere around the tip.
std::vector<MeshTriangle> CapOfFan(
  const Eigen::Vector3d& tip, const std::vector<Eigen::Vector3d>& ring, bool inside)
{
  const Point center = ToPoint(tip);
  std::vector<Point> points;
  points.reserve(ring.size());
  for (const Eigen::Vector3d& p : ring)
  {
    points.push_back(ToPoint(p));
  }
  const int sign = inside ? 1 : -1;
  const auto side = [&](int a, int b, int c)
  {
    return sign *
      static_cast<int>(CGAL::orientation(points[static_cast<std::size_t>(a)],
        points[static_cast<std::size_t>(b)], points[static_cast<std::size_t>(c)], center));
  };
  std::vector<int> left(ring.size());
  std::iota(left.begin(), left.end(), 0);
  std::vector<MeshTriangle> cap;
  while (left.size() > 3)
  {
    const std::size_t n = left.size();
    bool clipped = false;
    for (std::size_t i = 0; i < n && !clipped; ++i)
    {
      const int a = left[(i + n - 1) % n];
      const int b = left[i];
      const int c = left[(i + 1) % n];
      if (side(a, b, c) <= 0)
      {
        continue;
      }
      const bool isFree = std::none_of(left.begin(), left.end(),
        [&](int d)
        {
          return d != a && d != b && d != c && side(a, b, d) >= 0 && side(b, c, d) >= 0 &&
            side(c, a, d) >= 0;
        });
      if (isFree)
      {
        cap.push_back({ a, b, c });
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
        clipped = true;
      }
    }
    if (!clipped)
    {
      return {};
    }
  }
  if (left.size() < 3 || side(left[0], left[1], left[2]) <= 0)
  {
    return {};
  }
  cap.push_back({ left[0], left[1], left[2] });
  return cap;
}
}
