// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeDivisions.h"

#include <knotwork/SplineCore/DisjointSets.h>

#include <algorithm>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Classes of edges that have as many segments.
class Intervals
{
public:
  Intervals(const CADTopology& model, const std::vector<int>& wishes,
    const std::vector<EqualChains>& required, const std::vector<RectangleFace>& rectangles)
    : Model(model), Sets(static_cast<int>(wishes.size()))
  {
    for (const EqualChains& chains : required)
    {
      this->Unite(chains.One, chains.Other);
    }
    for (const RectangleFace& rectangle : rectangles)
    {
      this->Unite(rectangle.Sides[0], rectangle.Sides[2]);
      this->Unite(rectangle.Sides[1], rectangle.Sides[3]);
    }
    this->Counts.assign(wishes.size(), 2);
    for (std::size_t e = 0; e < wishes.size(); ++e)
    {
      int& count = this->Counts[At(this->Sets.Find(static_cast<int>(e)))];
      count = std::max(count, wishes[e] + wishes[e] % 2);
    }
    this->Wishes = this->Counts;
  }

  int CountOf(int edge) const { return this->Counts[At(this->Sets.Find(edge))]; }
  int Sum(const std::vector<int>& side) const
  {
    int sum = 0;
    for (const int edge : side)
    {
      sum += this->CountOf(edge);
    }
    return sum;
  }

  /// @param most  times of the wish that an edge may get. @return false when the sides cannot be
  /// made equal.
  bool Balance(const std::vector<int>& one, const std::vector<int>& other, int most)
  {
    const int difference = this->Sum(other) - this->Sum(one);
    if (difference < 0)
    {
      return this->Balance(other, one, most);
    }
    // one segment pair after the other, to the edge whose segments are the longest
    for (int left = difference; left > 0; left -= 2)
    {
      int best = -1;
      double longest = 0.0;
      for (const int edge : one)
      {
        const int set = this->Sets.Find(edge);
        const double length = this->Model.Edges[At(edge)].Length / this->Counts[At(set)];
        if (length > longest && this->Counts[At(set)] + 2 <= most * this->Wishes[At(set)] &&
          this->Uses(one, set) == 1 && this->Uses(other, set) == 0)
        {
          longest = length;
          best = set;
        }
      }
      if (best < 0)
      {
        return false;
      }
      this->Counts[At(best)] += 2;
    }
    return true;
  }

private:
  void Unite(const std::vector<int>& one, const std::vector<int>& other)
  {
    if (one.size() == 1 && other.size() == 1)
    {
      this->Sets.Unite(one[0], other[0]);
    }
  }

  long Uses(const std::vector<int>& side, int set) const
  {
    return std::count_if(
      side.begin(), side.end(), [&](int edge) { return this->Sets.Find(edge) == set; });
  }

  const CADTopology& Model;
  DisjointSets Sets;
  std::vector<int> Counts; ///< of a set, at its smallest edge
  std::vector<int> Wishes;
};
}

Result<std::vector<int>> DivideEdges(const CADTopology& model, const std::vector<int>& wishes,
  const std::vector<EqualChains>& required, std::vector<RectangleFace>& rectangles)
{
  constexpr int MostOfRectangles = 3;
  constexpr int MostOfRequired = 100;
  Intervals intervals(model, wishes, required, rectangles);
  const auto balance =
    [&](const std::vector<int>& one, const std::vector<int>& other, int most, bool& changed)
  {
    if (intervals.Sum(one) == intervals.Sum(other))
    {
      return true;
    }
    changed = true;
    return intervals.Balance(one, other, most);
  };
  bool changed = true;
  while (changed)
  {
    changed = false;
    for (const EqualChains& chains : required)
    {
      if (!balance(chains.One, chains.Other, MostOfRequired, changed))
      {
        return { ErrorCode::InvalidTopology,
          "edge " + std::to_string(chains.One.front()) + " and those beside it, and edge " +
            std::to_string(chains.Other.front()) +
            " and those beside it, cannot have as many "
            "segments" };
      }
    }
    for (std::size_t r = 0; r < rectangles.size();)
    {
      const auto& sides = rectangles[r].Sides;
      if (balance(sides[0], sides[2], MostOfRectangles, changed) &&
        balance(sides[1], sides[3], MostOfRectangles, changed))
      {
        ++r;
      }
      else
      {
        rectangles.erase(rectangles.begin() + static_cast<std::ptrdiff_t>(r));
      }
    }
  }
  std::vector<int> counts;
  for (std::size_t e = 0; e < wishes.size(); ++e)
  {
    counts.push_back(intervals.CountOf(static_cast<int>(e)));
  }
  return counts;
}
}
