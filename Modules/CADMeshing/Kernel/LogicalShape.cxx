// SPDX-License-Identifier: BSD-3-Clause
#include "LogicalShape.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Angle inside of a face where a use of its outer loop begins, on the surface; where a pole lies
/// there, between the edges beside it. Zero: the use is a pole, or two of them meet.
double InnerAngle(const CADTopology& model, const FaceChart& chart, int use)
{
  constexpr double Near = 1e-3; ///< share of an edge
  const int face = chart.Face();
  const auto& loop = model.Faces[At(face)].Loops.front();
  const auto n = static_cast<int>(loop.size());
  const bool atPole = loop[At((use + n - 1) % n)].Edge < 0;
  const int before = (use + n - (atPole ? 2 : 1)) % n;
  if (loop[At(use)].Edge < 0 || loop[At(before)].Edge < 0)
  {
    return 0.0;
  }
  const auto placeOf = [&](int of, double share)
  { return chart.FromParameters(model.UseParameters(face, 0, of, share)); };
  const Eigen::Vector2d nextPlace = placeOf(use, Near);
  const Eigen::Vector2d beforePlace = placeOf(before, 1.0 - Near);
  const Eigen::Vector3d here = chart.Point(placeOf(use, 0.0));
  const Eigen::Vector3d next = chart.Point(nextPlace) - here;
  const Eigen::Vector3d back = chart.Point(beforePlace) - here;
  const Eigen::Vector3d normal = atPole
    ? Eigen::Vector3d(chart.Normal(nextPlace) + chart.Normal(beforePlace))
    : chart.Normal(placeOf(use, 0.0));
  const double angle = std::atan2(next.cross(back).dot(normal), next.dot(back) * normal.norm());
  return angle < 0.0 ? angle + 2.0 * Pi : angle;
}

double LengthOf(const CADTopology& model, const std::vector<CADTopologyUse>& loop)
{
  double length = 0.0;
  for (const CADTopologyUse& use : loop)
  {
    length += model.Edges[At(use.Edge)].Length;
  }
  return length;
}

bool IsRing(const CADTopology& model, const CADTopologyFace& face)
{
  // lines of the grid are as far apart on both loops, or twice; but for rounding
  constexpr double MostLonger = 2.0 + 1e-6;
  std::set<int> edges;
  for (const auto& loop : face.Loops)
  {
    for (const CADTopologyUse& use : loop)
    {
      if (use.Edge < 0 || !edges.insert(use.Edge).second)
      {
        return false; // a pole or a seam
      }
    }
  }
  if (face.Loops.size() != 2)
  {
    return false;
  }
  const double outer = LengthOf(model, face.Loops[0]);
  const double inner = LengthOf(model, face.Loops[1]);
  return std::max(outer, inner) <= MostLonger * std::min(outer, inner);
}
}

LogicalShape LogicalShapeOf(const CADTopology& model, const FaceChart& chart)
{
  // between these a corner, or a point of a side
  constexpr double Least = 20.0 / 180.0 * Pi;
  constexpr double Most = 140.0 / 180.0 * Pi;
  constexpr double MostStraight = 220.0 / 180.0 * Pi;
  const CADTopologyFace& face = model.Faces[At(chart.Face())];
  LogicalShape shape;
  if (face.Loops.size() != 1)
  {
    shape.Kind = IsRing(model, face) ? LogicalShapeKind::Ring : LogicalShapeKind::Other;
    return shape;
  }
  bool hasPole = false;
  bool hasSeam = false;
  std::set<int> edges;
  for (int use = 0; use < static_cast<int>(face.Loops.front().size()); ++use)
  {
    const int edge = face.Loops.front()[At(use)].Edge;
    if (edge < 0)
    {
      hasPole = true;
      continue;
    }
    hasSeam = !edges.insert(edge).second || hasSeam;
    const double angle = InnerAngle(model, chart, use);
    if (angle < Least || angle > MostStraight)
    {
      return {};
    }
    if (angle < Most)
    {
      shape.Corners.push_back(use);
    }
  }
  const std::size_t corners = shape.Corners.size();
  if (corners == 4)
  {
    shape.Kind = hasPole ? LogicalShapeKind::Other : LogicalShapeKind::Rectangle;
  }
  else if (!hasSeam)
  {
    shape.Kind = corners == 0                        ? LogicalShapeKind::Disc
      : corners == 2                                 ? LogicalShapeKind::Segment
      : corners == 3 || corners == 5 || corners == 6 ? LogicalShapeKind::Polygon
                                                     : LogicalShapeKind::Other;
  }
  if (shape.Kind == LogicalShapeKind::Other)
  {
    shape.Corners.clear();
  }
  return shape;
}
}
