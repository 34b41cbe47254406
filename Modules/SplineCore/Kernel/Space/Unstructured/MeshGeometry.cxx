// SPDX-License-Identifier: BSD-3-Clause
#include "MeshGeometry.h"

#include <knotwork/SplineCore/AngleBetween.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace knotwork
{
namespace
{
using Edge = std::array<int, 2>;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

template <int Dim>
Status CheckPoints(const CellMesh<Dim>& mesh, const PointMatrixView& points)
{
  if (points.rows() != mesh.NumPoints || points.cols() < Dim || points.cols() > 3)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(points.rows()) + " points of " + std::to_string(points.cols()) +
        " coordinates for a mesh of " + std::to_string(mesh.NumPoints) };
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    if (!points.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput, "point " + std::to_string(i) };
    }
  }
  return {};
}

/// Visits the edges of a cell along a direction, from the lower to the upper end.
template <int Dim, class Visit>
void ForEdges(const CellMesh<Dim>& mesh, int cell, int direction, Visit&& visit)
{
  const int* corners = mesh.Cell(cell);
  for (int low = 0; low < (1 << Dim); ++low)
  {
    if ((low >> direction & 1) == 0)
    {
      visit(corners[low], corners[low | 1 << direction]);
    }
  }
}

/// The points that edges join with each point.
class EdgeGraph
{
public:
  EdgeGraph(Eigen::Index numPoints, const std::vector<Edge>& oneWay)
    : First(static_cast<std::size_t>(numPoints) + 1, 0)
  {
    std::vector<Edge> edges; // both ways
    for (const Edge& edge : oneWay)
    {
      edges.push_back(edge);
      edges.push_back({ edge[1], edge[0] });
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (const Edge& edge : edges)
    {
      ++this->First[At(edge[0]) + 1];
      this->Ends.push_back(edge[1]);
    }
    for (std::size_t i = 1; i < this->First.size(); ++i)
    {
      this->First[i] += this->First[i - 1];
    }
  }
  const int* Begin(int point) const { return this->Ends.data() + this->First[At(point)]; }
  const int* End(int point) const { return this->Ends.data() + this->First[At(point) + 1]; }
  bool Has(int a, int b) const { return std::binary_search(this->Begin(a), this->End(a), b); }

private:
  std::vector<int> First;
  std::vector<int> Ends;
};

/// Straight within an angle of 1e-5.
constexpr double Straight = 1.0 - 5e-11;
/// Points of a chain to each side of one: edges that are cut into up to 8 pieces are found.
constexpr std::size_t MostSteps = 4;

/// Points that edges lead to from a point, straight away from another.
std::vector<int> StraightAway(
  const EdgeGraph& graph, const PointMatrixView& points, int from, int at)
{
  std::vector<int> chain;
  while (chain.size() < MostSteps)
  {
    const auto step = (points.row(at) - points.row(from)).eval();
    int next = -1;
    for (const int* end = graph.Begin(at); end != graph.End(at) && next < 0; ++end)
    {
      const auto ahead = (points.row(*end) - points.row(at)).eval();
      const double cosine = step.dot(ahead);
      next = cosine > 0.0 && cosine >= Straight * step.norm() * ahead.norm() ? *end : -1;
    }
    if (next < 0)
    {
      break;
    }
    chain.push_back(next);
    from = at;
    at = next;
  }
  return chain;
}

template <int Dim>
int CellOfEdge(const CellMesh<Dim>& mesh, int a, int b)
{
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    bool has = false;
    for (int d = 0; d < Dim; ++d)
    {
      ForEdges(mesh, c, d,
        [&](int low, int high)
        { has = has || (low == a && high == b) || (low == b && high == a); });
    }
    if (has)
    {
      return c;
    }
  }
  return -1;
}
}

HangingPoint FindHangingPoint(
  const std::vector<std::array<int, 2>>& edges, const PointMatrixView& points)
{
  const EdgeGraph graph(points.rows(), edges);
  for (int m = 0; m < static_cast<int>(points.rows()); ++m)
  {
    for (const int* end = graph.Begin(m); end != graph.End(m); ++end)
    {
      // the chain a ... m ... b, seen from m: one neighbour, and what lies behind m
      const std::vector<int> behind = StraightAway(graph, points, *end, m);
      if (behind.empty())
      {
        continue;
      }
      std::vector<int> before = StraightAway(graph, points, m, *end);
      before.insert(before.begin(), *end);
      for (const int a : before)
      {
        for (const int b : behind)
        {
          if (graph.Has(a, b))
          {
            return { m, { m, *end }, { a, b } };
          }
        }
      }
    }
  }
  return {};
}

template <int Dim>
Status CheckConforming(const CellMesh<Dim>& mesh, const PointMatrixView& points)
{
  if (const Status status = CheckPoints(mesh, points); !status)
  {
    return status;
  }
  std::vector<Edge> edges;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int d = 0; d < Dim; ++d)
    {
      ForEdges(mesh, c, d, [&](int a, int b) { edges.push_back({ a, b }); });
    }
  }
  const HangingPoint found = FindHangingPoint(edges, points);
  if (found.Point < 0)
  {
    return {};
  }
  return { ErrorCode::InvalidTopology,
    "point " + std::to_string(found.Point) + " of cell " +
      std::to_string(CellOfEdge(mesh, found.Own[0], found.Own[1])) + " lies on an edge of cell " +
      std::to_string(CellOfEdge(mesh, found.Edge[0], found.Edge[1])) +
      ": the mesh is not conforming; refine that cell, too" };
}

template <int Dim>
Result<std::vector<double>> MeanSheetLengths(
  const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology, const PointMatrixView& points)
{
  if (const Status status = CheckPoints(mesh, points); !status)
  {
    return status;
  }
  const auto sheets = topology.FindSheets();
  std::vector<double> sums(At(sheets.Count), 0.0);
  std::vector<double> counts(At(sheets.Count), 0.0);
  double sum = 0.0;
  double count = 0.0;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int d = 0; d < Dim; ++d)
    {
      const std::size_t sheet = At(sheets.Of[At(c * Dim + d)]);
      ForEdges(mesh, c, d,
        [&](int a, int b)
        {
          const double length = (points.row(a) - points.row(b)).norm();
          sums[sheet] += length;
          counts[sheet] += 1.0;
          sum += length;
          count += 1.0;
        });
    }
  }
  for (std::size_t s = 0; s < sums.size(); ++s)
  {
    sums[s] = sums[s] / counts[s] / (sum / count);
    if (!(sums[s] > 0.0) || !std::isfinite(sums[s]))
    {
      return { ErrorCode::InvalidParameter,
        "the edges of sheet " + std::to_string(s) + " have no length" };
    }
  }
  return sums;
}

Result<std::vector<CellSide>> SharpEdges(const CellMesh<2>& mesh, const MeshTopology<2>& topology,
  const PointMatrixView& points, double degrees)
{
  if (const Status status = CheckPoints(mesh, points); !status)
  {
    return status;
  }
  if (points.cols() != 3)
  {
    return { ErrorCode::SizeMismatch, "points need 3 coordinates" };
  }
  if (!(degrees >= 0.0 && degrees <= 180.0))
  {
    return { ErrorCode::InvalidParameter, "the angle must lie in [0, 180] degrees" };
  }
  PointMatrix normals(mesh.NumCells(), 3);
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    const int* corners = mesh.Cell(c);
    const Eigen::Vector3d a = points.row(corners[3]) - points.row(corners[0]);
    const Eigen::Vector3d b = points.row(corners[2]) - points.row(corners[1]);
    normals.row(c) = a.cross(b).transpose();
  }
  const double most = degrees * static_cast<double>(EIGEN_PI) / 180.0;
  std::vector<CellSide> sharp;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int side = 0; side < 4; ++side)
    {
      const int other = topology.Neighbour(c, side);
      if (other <= c)
      {
        continue;
      }
      const double sign = topology.Crossing(c, side).Coherent ? 1.0 : -1.0;
      const Eigen::Vector3d a = normals.row(c);
      const Eigen::Vector3d b = sign * normals.row(other);
      if (AngleBetween(a, b) > most)
      {
        sharp.push_back({ c, side });
      }
    }
  }
  return sharp;
}

template <int Dim>
Result<std::vector<CellSide>> FacetsBetween(
  const MeshTopology<Dim>& topology, const std::vector<double>& labels)
{
  if (labels.size() != At(topology.NumCells()))
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(labels.size()) + " labels for " + std::to_string(topology.NumCells()) +
        " cells" };
  }
  std::vector<CellSide> between;
  for (int c = 0; c < topology.NumCells(); ++c)
  {
    for (int side = 0; side < 2 * Dim; ++side)
    {
      const int other = topology.Neighbour(c, side);
      if (other > c && labels[At(other)] != labels[At(c)])
      {
        between.push_back({ c, side });
      }
    }
  }
  return between;
}

Result<MidpointMesh> SplitAtMidpoints(int numPoints, const std::vector<std::vector<int>>& polygons)
{
  if (polygons.empty())
  {
    return { ErrorCode::EmptyInput, "there are no polygons" };
  }
  std::size_t corners = 0;
  for (std::size_t i = 0; i < polygons.size(); ++i)
  {
    const bool inRange = std::all_of(polygons[i].begin(), polygons[i].end(),
      [&](int point) { return point >= 0 && point < numPoints; });
    if (polygons[i].size() < 3 || !inRange)
    {
      return { ErrorCode::InvalidTopology,
        "polygon " + std::to_string(i) + " has less than three corners, or one that is no point" };
    }
    corners += polygons[i].size();
  }
  if (At(numPoints) + corners + polygons.size() >
    static_cast<std::size_t>(std::numeric_limits<int>::max()) / 4)
  {
    return { ErrorCode::TooLarge, std::to_string(corners) + " quadrilaterals" };
  }
  MidpointMesh split;
  std::map<Edge, int> middles;
  const auto addPoint = [&](std::vector<int> of)
  {
    split.Means.push_back(std::move(of));
    return numPoints + static_cast<int>(split.Means.size()) - 1;
  };
  const auto middleOf = [&](int a, int b)
  {
    const auto [place, isNew] = middles.try_emplace({ std::min(a, b), std::max(a, b) }, 0);
    if (isNew)
    {
      place->second = addPoint({ a, b });
    }
    return place->second;
  };
  for (std::size_t i = 0; i < polygons.size(); ++i)
  {
    const std::vector<int>& polygon = polygons[i];
    const int centre = addPoint(polygon);
    for (std::size_t k = 0; k < polygon.size(); ++k)
    {
      const int before = polygon[(k + polygon.size() - 1) % polygon.size()];
      const int after = polygon[(k + 1) % polygon.size()];
      const int next = middleOf(polygon[k], after);
      const int last = middleOf(before, polygon[k]);
      split.Mesh.Corners.insert(split.Mesh.Corners.end(), { polygon[k], next, last, centre });
      split.Polygon.push_back(static_cast<int>(i));
    }
  }
  split.Mesh.NumPoints = numPoints + static_cast<int>(split.Means.size());
  return split;
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Status CheckConforming<Dim>(const CellMesh<Dim>&, const PointMatrixView&);              \
  template Result<std::vector<double>> MeanSheetLengths<Dim>(                                      \
    const CellMesh<Dim>&, const MeshTopology<Dim>&, const PointMatrixView&);                       \
  template Result<std::vector<CellSide>> FacetsBetween<Dim>(                                       \
    const MeshTopology<Dim>&, const std::vector<double>&);
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
