// SPDX-License-Identifier: BSD-3-Clause
#include "PartSnapping.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
class Snapping
{
public:
  Snapping(std::vector<TrianglePart>& parts, const std::vector<char>& divided,
    const ExactPoints& points, double distance)
    : Parts(parts), Divided(divided), Points(points), Distance(distance)
  {
  }

  /// Points that are near each other become one. @return whether there are any.
  bool JoinPoints()
  {
    std::map<int, int> target;
    const auto find = [&](int point)
    {
      for (auto found = target.find(point); found != target.end(); found = target.find(point))
      {
        point = found->second;
      }
      return point;
    };
    for (const TrianglePart& part : this->Parts)
    {
      if (!this->MayGo(part))
      {
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int a = find(part.Corners[k]);
        const int b = find(part.Corners[(k + 1) % 3]);
        // points of the input have the lower numbers
        if (a != b && std::max(a, b) >= this->Points.NumGiven &&
          (this->At(a) - this->At(b)).norm() < this->Distance)
        {
          target[std::max(a, b)] = std::min(a, b);
        }
      }
    }
    if (target.empty())
    {
      return false;
    }
    for (TrianglePart& part : this->Parts)
    {
      for (int& corner : part.Corners)
      {
        corner = find(corner);
      }
    }
    this->DropFolded();
    return true;
  }

  /// The longest edge of a flat triangle is led through the point across.
  /// @return whether there are any.
  bool LeadEdges()
  {
    std::map<std::pair<int, int>, int> led; // edges, and the points that they are led through
    std::set<int> used;
    for (const TrianglePart& part : this->Parts)
    {
      const auto [longest, height] = this->Flatness(part.Corners);
      const int a = part.Corners[longest];
      const int b = part.Corners[(longest + 1) % 3];
      const int c = part.Corners[(longest + 2) % 3];
      if (height < this->Distance && this->MayGo(part) && used.count(a) == 0 &&
        used.count(b) == 0 && used.count(c) == 0)
      {
        led[{ std::min(a, b), std::max(a, b) }] = c;
        used.insert({ a, b, c });
      }
    }
    if (led.empty())
    {
      return false;
    }
    std::vector<TrianglePart> next;
    for (const TrianglePart& part : this->Parts)
    {
      bool isLed = false;
      for (std::size_t k = 0; k < 3 && !isLed; ++k)
      {
        const int a = part.Corners[k];
        const int b = part.Corners[(k + 1) % 3];
        const int c = part.Corners[(k + 2) % 3];
        const auto found = led.find({ std::min(a, b), std::max(a, b) });
        if (found != led.end())
        {
          isLed = true;
          next.push_back({ { a, found->second, c }, part.Source });
          next.push_back({ { found->second, b, c }, part.Source });
        }
      }
      if (!isLed)
      {
        next.push_back(part);
      }
    }
    this->Parts = std::move(next);
    this->DropFolded();
    return true;
  }

private:
  bool MayGo(const TrianglePart& part) const
  {
    return this->Divided[static_cast<std::size_t>(part.Source)] != 0;
  }
  Eigen::Vector3d At(int point) const { return Rounded(this->Points[point]).transpose(); }
  /// The longest edge, and the height above it.
  std::pair<std::size_t, double> Flatness(const MeshTriangle& corners) const
  {
    std::size_t longest = 0;
    double length = -1.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const double own = (this->At(corners[(k + 1) % 3]) - this->At(corners[k])).norm();
      if (own > length)
      {
        length = own;
        longest = k;
      }
    }
    const Eigen::Vector3d a = this->At(corners[longest]);
    const Eigen::Vector3d b = this->At(corners[(longest + 1) % 3]);
    const Eigen::Vector3d c = this->At(corners[(longest + 2) % 3]);
    return { longest, length > 0.0 ? (b - a).cross(c - a).norm() / length : 0.0 };
  }
  void DropFolded()
  {
    this->Parts.erase(std::remove_if(this->Parts.begin(), this->Parts.end(),
                        [](const TrianglePart& part)
                        {
                          const auto& [a, b, c] = part.Corners;
                          return a == b || b == c || c == a;
                        }),
      this->Parts.end());
  }

  std::vector<TrianglePart>& Parts;
  const std::vector<char>& Divided; ///< triangles of the input
  const ExactPoints& Points;
  double Distance;
};
}

void SnapParts(std::vector<TrianglePart>& parts, const std::vector<char>& divided,
  const ExactPoints& points, double distance)
{
  Snapping snapping(parts, divided, points, distance);
  constexpr int MostRounds = 10;
  for (int round = 0; round < MostRounds; ++round)
  {
    const bool any = snapping.JoinPoints();
    if (!snapping.LeadEdges() && !any)
    {
      return;
    }
  }
}
}
