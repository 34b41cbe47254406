// SPDX-License-Identifier: BSD-3-Clause
#include "CriticalPoints.h"

#include "CriticalSearch.h"
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/Parallel.h>

#include <numeric>

namespace knotwork
{
namespace
{
Status CheckInput(const Spline<2>& spline, const CriticalPointParams& params)
{
  const Status status = spline.Check();
  if (!status)
  {
    return status;
  }
  const auto wrong = [](const std::string& what) {
    return Status{ ErrorCode::InvalidParameter, what };
  };
  if (params.Component < 0 || params.Component >= spline.NumComponents())
  {
    return wrong("Component is " + std::to_string(params.Component) + " and must lie in [0, " +
      std::to_string(spline.NumComponents() - 1) + "]");
  }
  if (params.MaxDepth < 1 || params.MaxDepth > 50)
  {
    return wrong("MaxDepth is " + std::to_string(params.MaxDepth) + " and must lie in [1, 50]");
  }
  if (params.MaxBoxes < 4 || params.MaxBoxes > 4096)
  {
    return wrong("MaxBoxes is " + std::to_string(params.MaxBoxes) + " and must lie in [4, 4096]");
  }
  return {};
}

/// Points on edges are found from several elements: keeps the first of each.
void RemoveRepeated(std::vector<FoundPoint>& points, std::vector<OpenBox>& undecided)
{
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b)
    { return points[a].Enclosure[0].Lo < points[b].Enclosure[0].Lo; });
  std::vector<bool> dropped(points.size(), false);
  std::vector<std::size_t> open;
  for (const std::size_t i : order)
  {
    const PlaneBox& mine = points[i].Enclosure;
    std::size_t kept = 0;
    for (const std::size_t k : open)
    {
      if (points[k].Enclosure[0].Hi < mine[0].Lo)
      {
        continue;
      }
      open[kept++] = k;
      if (points[k].Layer != points[i].Layer || points[i].Layer == Layer::Corner ||
        !Meet(points[k].Enclosure, mine))
      {
        continue;
      }
      if (Holds(points[k].Reach, mine) || Holds(points[i].Reach, points[k].Enclosure))
      {
        dropped[std::max(i, k)] = true;
        continue;
      }
      // one point or two: neither box tells
      dropped[i] = dropped[k] = true;
      undecided.push_back({ points[i].Element, points[i].Box, points[i].Layer });
      undecided.push_back({ points[k].Element, points[k].Box, points[k].Layer });
    }
    open.resize(kept);
    open.push_back(i);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (!dropped[i])
    {
      points[kept++] = points[i];
    }
  }
  points.resize(kept);
}

/// Undecided boxes inside uniqueness boxes say nothing new.
void RemoveCovered(const std::vector<FoundPoint>& points, std::vector<OpenBox>& undecided)
{
  if (undecided.empty() || points.empty())
  {
    return;
  }
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return points[a].Box[0].Lo < points[b].Box[0].Lo; });
  double widest = 0.0;
  for (const FoundPoint& point : points)
  {
    widest = std::max(widest, point.Box[0].Width());
  }
  const auto covered = [&](const OpenBox& box)
  {
    auto at = std::upper_bound(order.begin(), order.end(), box.Box[0].Lo,
      [&](double x, std::size_t i) { return x < points[i].Box[0].Lo; });
    while (at != order.begin())
    {
      --at;
      const FoundPoint& point = points[*at];
      if (point.Box[0].Lo < box.Box[0].Lo - 2.0 * widest)
      {
        return false;
      }
      const bool sameSide = box.Layer < Layer::Side || box.Layer == point.Layer;
      if (sameSide && box.Layer != Layer::Corner && Holds(point.Box, box.Box))
      {
        return true;
      }
    }
    return false;
  };
  undecided.erase(std::remove_if(undecided.begin(), undecided.end(), covered), undecided.end());
}

/// From the plane of the pieces to what the spline's parameters are.
struct OutputFrame
{
  const ScalarPieces& Pieces;

  PlaneBox Of(int e, const PlaneBox& box) const
  {
    if (this->Pieces.HasDomain)
    {
      return box;
    }
    const auto at = static_cast<std::size_t>(e);
    PlaneBox local;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const auto axis = static_cast<std::size_t>(this->Pieces.Axis[at][d]);
      const Interval& side = this->Pieces[e].Box[axis];
      local[d] = this->Pieces.Reversed[at][d] ? Interval(side.Hi) - box[axis]
                                              : box[axis] - Interval(side.Lo);
    }
    return local;
  }
  static ParametricBox<2> ToBox(const PlaneBox& box)
  {
    return { { box[0].Lo, box[1].Lo }, { box[0].Hi, box[1].Hi } };
  }
};

/// Joins boxes that touch, of the same element and of neighbours, and numbers the sets by their
/// first box.
std::vector<int> NumberClusters(
  const ScalarPieces& pieces, const std::vector<OpenBox>& boxes, int& count)
{
  DisjointSets sets(static_cast<int>(boxes.size()));
  // boxes ascend by element
  std::vector<std::size_t> start(static_cast<std::size_t>(pieces.NumPieces()) + 1, 0);
  for (const OpenBox& box : boxes)
  {
    ++start[static_cast<std::size_t>(box.Element) + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  const auto join = [&](std::size_t i, int element)
  {
    const auto e = static_cast<std::size_t>(element);
    for (std::size_t k = start[e]; k < start[e + 1]; ++k)
    {
      if (k != i && Meet(boxes[i].Box, boxes[k].Box))
      {
        sets.Unite(static_cast<int>(i), static_cast<int>(k));
      }
    }
  };
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    const int e = boxes[i].Element;
    join(i, e);
    for (const PieceJoin* j = pieces.BeginJoins(e); j != pieces.EndJoins(e); ++j)
    {
      if (j->Neighbor >= 0)
      {
        join(i, j->Neighbor);
      }
    }
  }
  std::vector<int> number(boxes.size(), -1);
  count = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    const auto first = static_cast<std::size_t>(sets.Find(static_cast<int>(i)));
    if (number[first] < 0)
    {
      number[first] = count++;
    }
    number[i] = number[first];
  }
  return number;
}

void AddClusters(const ScalarPieces& pieces, std::vector<OpenBox>& boxes, CriticalPoints& result)
{
  std::stable_sort(boxes.begin(), boxes.end(),
    [](const OpenBox& a, const OpenBox& b) { return a.Element < b.Element; });
  int count = 0;
  const std::vector<int> number = NumberClusters(pieces, boxes, count);
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return number[a] < number[b]; });
  result.Clusters.resize(static_cast<std::size_t>(count));
  const OutputFrame frame{ pieces };
  for (const std::size_t i : order)
  {
    CriticalCluster& cluster = result.Clusters[static_cast<std::size_t>(number[i])];
    Interval value = pieces.ValueRange(boxes[i].Element, boxes[i].Box);
    if (cluster.NumBoxes == 0)
    {
      cluster.FirstBox = result.Boxes.size();
    }
    else
    {
      value.Merge({ cluster.ValueBounds[0], cluster.ValueBounds[1] });
    }
    ++cluster.NumBoxes;
    cluster.ValueBounds = { value.Lo, value.Hi };
    result.Boxes.push_back(
      { boxes[i].Element, OutputFrame::ToBox(frame.Of(boxes[i].Element, boxes[i].Box)) });
  }
}

void AddPoint(const ScalarPieces& pieces, const FoundPoint& found, CriticalPoints& result)
{
  const OutputFrame frame{ pieces };
  CriticalPoint point;
  point.Kind = found.Kind;
  point.Place = found.Place;
  point.Element = found.Element;
  point.Box = OutputFrame::ToBox(frame.Of(found.Element, found.Box));
  const PlaneBox enclosure = frame.Of(found.Element, found.Enclosure);
  point.Enclosure = OutputFrame::ToBox(enclosure);
  point.Parameters = { enclosure[0].Middle(), enclosure[1].Middle() };
  point.ValueBounds = { found.Value.Lo, found.Value.Hi };
  point.Value = found.Value.Middle();
  point.Eigenvalues = { found.Eigenvalues[0] * pieces.Scale, found.Eigenvalues[1] * pieces.Scale };
  point.Index = found.Index;
  point.InwardSign = found.InwardSign;
  (point.Kind == CriticalKind::Minimum      ? result.NumMinima
      : point.Kind == CriticalKind::Maximum ? result.NumMaxima
                                            : result.NumSaddles)++;
  result.NumOnBoundary +=
    point.Place == CriticalPlace::Boundary || point.Place == CriticalPlace::Corner ? 1 : 0;
  result.IndexSum += point.Index;
  result.Points.push_back(point);
}

/// Searches all elements; false when aborted.
bool SearchAll(const ScalarPieces& pieces, const CriticalPointParams& params, FoundPoints& all)
{
  constexpr std::size_t chunk = 16;
  const std::size_t count = pieces.Pieces.size();
  const std::size_t round = std::max<std::size_t>(4096, count / 16 / chunk * chunk);
  for (std::size_t first = 0; first < count; first += round)
  {
    if (params.Progress &&
      !params.Progress(static_cast<double>(first) / static_cast<double>(count)))
    {
      return false;
    }
    const std::size_t size = std::min(round, count - first);
    std::vector<FoundPoints> parts((size + chunk - 1) / chunk);
    ParallelFor(size, chunk, params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          const int e = static_cast<int>(first + i);
          SearchElement(pieces, e, params, parts[i / chunk]);
          SearchSides(pieces, e, params, parts[i / chunk]);
        }
      });
    for (const FoundPoints& part : parts)
    {
      all.Points.insert(all.Points.end(), part.Points.begin(), part.Points.end());
      all.Undecided.insert(all.Undecided.end(), part.Undecided.begin(), part.Undecided.end());
      all.NumTested += part.NumTested;
    }
  }
  return true;
}
}

Result<CriticalPoints> FindCriticalPoints(
  const Spline<2>& spline, const CriticalPointParams& params)
{
  const Status status = CheckInput(spline, params);
  if (!status)
  {
    return status;
  }
  const Result<ScalarPieces> made = MakeScalarPieces(spline, params.Component, params.Threads);
  if (!made)
  {
    return made.Status;
  }
  const ScalarPieces& pieces = made.Value;
  FoundPoints all;
  CriticalPoints result;
  if (!SearchAll(pieces, params, all))
  {
    return { ErrorCode::Aborted, "the search of critical points was stopped" };
  }
  SearchCorners(pieces, params, all, result.EulerCharacteristic);
  RemoveRepeated(all.Points, all.Undecided);
  RemoveCovered(all.Points, all.Undecided);
  std::sort(all.Points.begin(), all.Points.end(),
    [](const FoundPoint& a, const FoundPoint& b)
    {
      if (a.Element != b.Element)
      {
        return a.Element < b.Element;
      }
      return a.Enclosure[0].Lo != b.Enclosure[0].Lo ? a.Enclosure[0].Lo < b.Enclosure[0].Lo
                                                    : a.Enclosure[1].Lo < b.Enclosure[1].Lo;
    });
  for (const FoundPoint& point : all.Points)
  {
    AddPoint(pieces, point, result);
  }
  AddClusters(pieces, all.Undecided, result);
  result.NumTested = all.NumTested;
  result.Proved = result.Clusters.empty();
  if (params.Progress && !params.Progress(1.0))
  {
    return { ErrorCode::Aborted, "the search of critical points was stopped" };
  }
  return result;
}
}
