// SPDX-License-Identifier: BSD-3-Clause
#include "PlanarRegion.h"

#include <knotwork/SplineCore/BoxTree.h>

#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Whether c, on the line through a and b, lies between them.
bool Between(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c)
{
  return std::min(a[0], b[0]) <= c[0] && c[0] <= std::max(a[0], b[0]) &&
    std::min(a[1], b[1]) <= c[1] && c[1] <= std::max(a[1], b[1]);
}

/// Segments from one point to a and b: whether they leave it in the same direction.
bool Overlap(const PlanarPoint& common, const PlanarPoint& a, const PlanarPoint& b)
{
  return Orientation(common, a, b) == 0 && !Between(a, b, common);
}

bool Meet(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c, const PlanarPoint& d)
{
  const int abc = Orientation(a, b, c);
  const int abd = Orientation(a, b, d);
  const int cda = Orientation(c, d, a);
  const int cdb = Orientation(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0)
  {
    return true;
  }
  return (abc == 0 && Between(a, b, c)) || (abd == 0 && Between(a, b, d)) ||
    (cda == 0 && Between(c, d, a)) || (cdb == 0 && Between(c, d, b));
}

bool Cross(const std::vector<PlanarPoint>& points, const PlanarSegment& s, const PlanarSegment& t)
{
  for (int i = 0; i < 2; ++i)
  {
    for (int j = 0; j < 2; ++j)
    {
      if (s[At(i)] == t[At(j)])
      {
        return s[At(1 - i)] == t[At(1 - j)] ||
          Overlap(points[At(s[At(i)])], points[At(s[At(1 - i)])], points[At(t[At(1 - j)])]);
      }
    }
  }
  return Meet(points[At(s[0])], points[At(s[1])], points[At(t[0])], points[At(t[1])]);
}

/// Triangles by their directed edges.
class HalfEdges
{
public:
  HalfEdges(std::size_t numPoints, const std::vector<std::array<int, 3>>& triangles)
    : Start(numPoints + 1, 0), Ends(3 * triangles.size())
  {
    for (const auto& corners : triangles)
    {
      for (int corner : corners)
      {
        ++this->Start[At(corner) + 1];
      }
    }
    std::partial_sum(this->Start.begin(), this->Start.end(), this->Start.begin());
    std::vector<std::size_t> next(this->Start.begin(), this->Start.end() - 1);
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      for (int i = 0; i < 3; ++i)
      {
        this->Ends[next[At(triangles[t][At(i)])]++] = { triangles[t][At((i + 1) % 3)],
          static_cast<int>(t) };
      }
    }
  }

  /// The triangle to the left of the edge from a to b, -1: none.
  int Left(int a, int b) const
  {
    for (std::size_t i = this->Start[At(a)]; i < this->Start[At(a) + 1]; ++i)
    {
      if (this->Ends[i][0] == b)
      {
        return this->Ends[i][1];
      }
    }
    return -1;
  }

private:
  std::vector<std::size_t> Start;
  std::vector<std::array<int, 2>> Ends; // end point and triangle
};
}

int Orientation(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c)
{
  const double x1 = a[0] - c[0];
  const double y1 = a[1] - c[1];
  const double x2 = b[0] - c[0];
  const double y2 = b[1] - c[1];
  const double left = x1 * y2;
  const double right = y1 * x2;
  // Rounding is monotonic: unequal rounded products are in the order of the exact ones. The errors
  // of equal ones are exact.
  if (left != right)
  {
    return left > right ? 1 : -1;
  }
  const double leftError = std::fma(x1, y2, -left);
  const double rightError = std::fma(y1, x2, -right);
  return leftError > rightError ? 1 : (leftError < rightError ? -1 : 0);
}

PlanarBoxes SegmentBoxes(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments)
{
  const Eigen::Index n = static_cast<Eigen::Index>(segments.size());
  PlanarBoxes boxes;
  boxes.Lower.resize(n, 2);
  boxes.Upper.resize(n, 2);
  for (Eigen::Index s = 0; s < n; ++s)
  {
    const auto& [a, b] = segments[static_cast<std::size_t>(s)];
    for (int d = 0; d < 2; ++d)
    {
      boxes.Lower(s, d) = std::min(points[At(a)][At(d)], points[At(b)][At(d)]);
      boxes.Upper(s, d) = std::max(points[At(a)][At(d)], points[At(b)][At(d)]);
    }
  }
  boxes.Tree = BoxTree(boxes.Lower, boxes.Upper);
  return boxes;
}

std::vector<std::array<int, 2>> FindCrossings(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments)
{
  const PlanarBoxes boxes = SegmentBoxes(points, segments);
  const PointMatrix& lower = boxes.Lower;
  const PointMatrix& upper = boxes.Upper;
  std::vector<std::array<int, 2>> crossings;
  for (int s = 0; s < static_cast<int>(segments.size()); ++s)
  {
    if (points[At(segments[At(s)][0])] == points[At(segments[At(s)][1])])
    {
      crossings.push_back({ s, s });
    }
    const std::size_t first = crossings.size();
    boxes.Tree.ForNear(lower.row(s).data(), upper.row(s).data(),
      [&](int t)
      {
        if (t > s && (lower.row(s).array() <= upper.row(t).array()).all() &&
          (lower.row(t).array() <= upper.row(s).array()).all() &&
          Cross(points, segments[At(s)], segments[At(t)]))
        {
          crossings.push_back({ s, t });
        }
      });
    std::sort(crossings.begin() + static_cast<std::ptrdiff_t>(first), crossings.end());
  }
  return crossings;
}

std::vector<bool> InsidePolygons(const std::vector<PlanarPoint>& points,
  const std::vector<PlanarSegment>& segments, const std::vector<PlanarPoint>& queries)
{
  // Rows of queries from below; a segment is active while its half-open range of heights has the
  // row.
  std::vector<int> order(queries.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](int a, int b) { return queries[At(a)][1] < queries[At(b)][1]; });
  struct Span
  {
    PlanarPoint Low;
    PlanarPoint High;
  };
  std::vector<Span> spans;
  for (const PlanarSegment& segment : segments)
  {
    Span span{ points[At(segment[0])], points[At(segment[1])] };
    if (span.Low[1] > span.High[1])
    {
      std::swap(span.Low, span.High);
    }
    if (span.Low[1] < span.High[1])
    {
      spans.push_back(span);
    }
  }
  std::sort(
    spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.Low[1] < b.Low[1]; });

  std::vector<bool> inside(queries.size(), false);
  std::vector<Span> active;
  std::vector<double> crossings;
  std::size_t nextSpan = 0;
  for (std::size_t i = 0; i < order.size();)
  {
    const double y = queries[At(order[i])][1];
    for (; nextSpan < spans.size() && spans[nextSpan].Low[1] <= y; ++nextSpan)
    {
      active.push_back(spans[nextSpan]);
    }
    active.erase(std::remove_if(active.begin(), active.end(),
                   [y](const Span& span) { return span.High[1] <= y; }),
      active.end());
    crossings.clear();
    for (const Span& span : active)
    {
      const double share = (y - span.Low[1]) / (span.High[1] - span.Low[1]);
      crossings.push_back(span.Low[0] + share * (span.High[0] - span.Low[0]));
    }
    std::sort(crossings.begin(), crossings.end());
    for (; i < order.size() && queries[At(order[i])][1] == y; ++i)
    {
      const auto right =
        std::upper_bound(crossings.begin(), crossings.end(), queries[At(order[i])][0]);
      inside[At(order[i])] = (crossings.end() - right) % 2 != 0;
    }
  }
  return inside;
}

PlanarRegion SelectRegion(std::size_t numPoints, const std::vector<std::array<int, 3>>& triangles,
  const std::vector<PlanarSegment>& segments)
{
  const HalfEdges edges(numPoints, triangles);
  // Which edges of triangles (bits) are segments.
  std::vector<unsigned char> fixed(triangles.size(), 0);
  const auto fix = [&](int triangle, int begin)
  {
    for (int i = 0; triangle >= 0 && i < 3; ++i)
    {
      if (triangles[At(triangle)][At(i)] == begin)
      {
        fixed[At(triangle)] = static_cast<unsigned char>(fixed[At(triangle)] | (1 << i));
      }
    }
  };
  for (const PlanarSegment& segment : segments)
  {
    fix(edges.Left(segment[0], segment[1]), segment[0]);
    fix(edges.Left(segment[1], segment[0]), segment[1]);
  }
  // Parts that segments separate.
  std::vector<int> part(triangles.size(), -1);
  std::vector<int> stack;
  int numParts = 0;
  for (std::size_t seed = 0; seed < triangles.size(); ++seed)
  {
    if (part[seed] >= 0)
    {
      continue;
    }
    stack.push_back(static_cast<int>(seed));
    part[seed] = numParts;
    while (!stack.empty())
    {
      const int t = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i)
      {
        if ((fixed[At(t)] & (1 << i)) != 0)
        {
          continue;
        }
        const int next = edges.Left(triangles[At(t)][At((i + 1) % 3)], triangles[At(t)][At(i)]);
        if (next >= 0 && part[At(next)] < 0)
        {
          part[At(next)] = numParts;
          stack.push_back(next);
        }
      }
    }
    ++numParts;
  }
  std::vector<bool> isLeft(At(numParts), false);
  std::vector<bool> isRight(At(numParts), false);
  const auto mark = [&](std::vector<bool>& parts, int triangle)
  {
    if (triangle >= 0)
    {
      parts[At(part[At(triangle)])] = true;
    }
  };
  for (const PlanarSegment& segment : segments)
  {
    mark(isLeft, edges.Left(segment[0], segment[1]));
    mark(isRight, edges.Left(segment[1], segment[0]));
  }
  PlanarRegion region;
  for (std::size_t s = 0; s < segments.size(); ++s)
  {
    const int left = edges.Left(segments[s][0], segments[s][1]);
    const int right = edges.Left(segments[s][1], segments[s][0]);
    if (left < 0 || isRight[At(part[At(left)])] || (right >= 0 && isLeft[At(part[At(right)])]))
    {
      region.Misplaced.push_back(static_cast<int>(s));
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    if (isLeft[At(part[t])])
    {
      region.Triangles.push_back(triangles[t]);
    }
  }
  return region;
}
}
