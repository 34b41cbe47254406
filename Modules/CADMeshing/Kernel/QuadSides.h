// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

namespace knotwork
{
/// Quadrilaterals by their sides.
class QuadSides
{
public:
  using Quad = std::array<int, 4>;
  using Side = std::pair<int, int>;

  static Side SideOf(int a, int b) { return std::minmax(a, b); }

  void Add(const Quad& quad)
  {
    const auto id = static_cast<int>(this->Quads.size());
    this->Quads.push_back(quad);
    for (std::size_t i = 0; i < 4; ++i)
    {
      this->Sides[SideOf(quad[i], quad[(i + 1) % 4])].push_back(id);
    }
  }

  /// A quadrilateral at a side, other than one; -1: none.
  int Beside(int a, int b, int other) const
  {
    const auto found = this->Sides.find(SideOf(a, b));
    if (found != this->Sides.end())
    {
      for (const int quad : found->second)
      {
        if (quad != other)
        {
          return quad;
        }
      }
    }
    return -1;
  }

  /// The corners behind a side: the one beside its end, then the one beside its begin.
  Side Across(int quad, int a, int b) const
  {
    const Quad& corners = this->Quads[static_cast<std::size_t>(quad)];
    const auto at =
      static_cast<std::size_t>(std::find(corners.begin(), corners.end(), a) - corners.begin());
    return corners[(at + 1) % 4] == b ? Side{ corners[(at + 2) % 4], corners[(at + 3) % 4] }
                                      : Side{ corners[(at + 2) % 4], corners[(at + 1) % 4] };
  }

  std::vector<Quad> Quads;
  std::map<Side, std::vector<int>> Sides;
};
}
