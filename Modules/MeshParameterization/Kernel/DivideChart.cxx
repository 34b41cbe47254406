// SPDX-License-Identifier: BSD-3-Clause
#include "DivideChart.h"

#include "CutLine.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>

namespace knotwork
{
namespace
{
constexpr double LeastCoherence = 0.5; // of normals at a hole: |sum| / sum of sizes
constexpr double LeastIsland = 0.02;   // of the area of the chart
constexpr int RepairRounds = 20;

/// Divides triangles along the zero line and gives them the sides of the line.
/// @param part  the chart, whose Sides are in the mesh.
void CutAlong(CutMesh& mesh, const ChartPart& part, const Eigen::VectorXd& values)
{
  const auto sign = [](double value) { return (value > 0.0 ? 1 : 0) - (value < 0.0 ? 1 : 0); };
  std::unordered_map<std::uint64_t, int> points;
  // of points of the mesh; those on the line, which are added, have 0
  std::vector<signed char> signs(mesh.Points.size(), 0);
  for (int v = 0; v < part.Mesh.NumPoints(); ++v)
  {
    const auto at = static_cast<std::size_t>(v);
    signs[static_cast<std::size_t>(part.Points[at])] = static_cast<signed char>(sign(values[v]));
    for (int j = part.Mesh.FanStart[at]; j < part.Mesh.FanStart[at + 1]; ++j)
    {
      const int w = part.Mesh.Fan[static_cast<std::size_t>(j)];
      if (v < w && values[v] * values[w] < 0.0)
      {
        const int a = part.Points[at];
        const int b = part.Points[static_cast<std::size_t>(w)];
        points[CutMesh::EdgeKey(a, b)] = mesh.AddPoint(a, b, values[v] / (values[v] - values[w]));
      }
    }
  }
  const int chart = mesh.Charts[static_cast<std::size_t>(part.Triangles.front())];
  mesh.Split(points);
  signs.resize(mesh.Points.size(), 0);
  for (int t : mesh.TrianglesOf(chart))
  {
    int sum = 0;
    for (int c : mesh.Triangles[static_cast<std::size_t>(t)])
    {
      sum += signs[static_cast<std::size_t>(c)];
    }
    if (sum != 0)
    {
      mesh.Sides[static_cast<std::size_t>(t)] = sum > 0 ? 1 : 0;
    }
  }
}

/// The triangle that lies between an entry of the fans and the next one; -1 behind the last of an
/// open fan.
std::vector<int> TrianglesOfFans(const DiscMesh& mesh)
{
  std::vector<int> found(mesh.Fan.size(), -1);
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto at = static_cast<std::size_t>(mesh.Triangles[t][k]);
      const auto begin = mesh.Fan.begin() + mesh.FanStart[at];
      const auto end = mesh.Fan.begin() + mesh.FanStart[at + 1];
      const auto entry = std::find(begin, end, mesh.Triangles[t][(k + 1) % 3]);
      found[static_cast<std::size_t>(entry - mesh.Fan.begin())] = static_cast<int>(t);
    }
  }
  return found;
}

/// Where a side touches itself in a point all triangles there get the side of most of the area.
/// @param ofFans  TrianglesOfFans.
/// @param holes   one a point; triangles at a hole give it all.
/// @return whether there was such a point.
bool JoinTouching(const DiscMesh& mesh, const std::vector<int>& ofFans,
  const std::vector<double>& areas, const std::vector<int>& holes, Sides& sides)
{
  bool any = false;
  std::vector<std::size_t> star;
  for (int v = 0; v < mesh.NumPoints(); ++v)
  {
    const auto at = static_cast<std::size_t>(v);
    star.clear();
    for (int j = mesh.FanStart[at]; j < mesh.FanStart[at + 1]; ++j)
    {
      if (const int triangle = ofFans[static_cast<std::size_t>(j)]; triangle >= 0)
      {
        star.push_back(static_cast<std::size_t>(triangle));
      }
    }
    int changes = mesh.OnBoundary[at] ? 1 : 0; // an open fan ends and begins
    for (std::size_t i = mesh.OnBoundary[at] ? 1 : 0; i < star.size(); ++i)
    {
      changes += sides[star[i]] != sides[star[(i + star.size() - 1) % star.size()]] ? 1 : 0;
    }
    if (changes <= 2)
    {
      continue;
    }
    any = true;
    double sum = 0.0;
    for (std::size_t t : star)
    {
      double weight = areas[t];
      for (int c : mesh.Triangles[t])
      {
        weight += holes[static_cast<std::size_t>(c)] >= 0 ? mesh.Area : 0.0;
      }
      sum += sides[t] ? weight : -weight;
    }
    for (std::size_t t : star)
    {
      sides[t] = sum > 0.0 ? 1 : 0;
    }
  }
  return any;
}

/// Holes of a part's points; cuts make points at no hole.
std::vector<int> HolesOf(const ChartPart& part, const std::vector<int>& holes)
{
  std::vector<int> result;
  for (int p : part.Points)
  {
    const auto at = static_cast<std::size_t>(p);
    result.push_back(at < holes.size() ? holes[at] : -1);
  }
  return result;
}

/// One component of a side gives up small islands, and points where it touches itself.
Status RepairSides(CutMesh& mesh, int chart, const std::vector<int>& holes)
{
  const auto part = TakePart(mesh, mesh.TrianglesOf(chart));
  if (!part)
  {
    return part.Status;
  }
  const std::vector<int> localHoles = HolesOf(part.Value, holes);
  const SurfaceParts parts(part.Value.Mesh, localHoles);
  Sides sides;
  for (int t : part.Value.Triangles)
  {
    sides.push_back(mesh.Sides[static_cast<std::size_t>(t)]);
  }
  const std::vector<int> ofFans = TrianglesOfFans(part.Value.Mesh);
  for (int round = 0; round < RepairRounds; ++round)
  {
    JoinIslands(parts.Adjacency, parts.Areas, LeastIsland, sides);
    if (!JoinTouching(part.Value.Mesh, ofFans, parts.Areas, localHoles, sides))
    {
      break;
    }
  }
  for (std::size_t i = 0; i < sides.size(); ++i)
  {
    mesh.Sides[static_cast<std::size_t>(part.Value.Triangles[i])] = sides[i];
  }
  return {};
}

bool HasBothSides(const CutMesh& mesh, const std::vector<int>& triangles)
{
  const auto side = [&](int t) { return mesh.Sides[static_cast<std::size_t>(t)]; };
  return std::any_of(
    triangles.begin(), triangles.end(), [&](int t) { return side(t) != side(triangles.front()); });
}

Sides DivideAtCrossing(
  const SurfaceParts& parts, const std::vector<int>& points, const EdgeCrossing& crossing)
{
  std::vector<int> first;
  std::vector<int> second;
  for (std::size_t v = 0; v < points.size(); ++v)
  {
    const int p = points[v];
    if (p == crossing.First[0] || p == crossing.First[1])
    {
      first.push_back(static_cast<int>(v));
    }
    if (p == crossing.Second[0] || p == crossing.Second[1])
    {
      second.push_back(static_cast<int>(v));
    }
  }
  return DivideBetween(parts, first, second);
}

void SetSides(CutMesh& mesh, const ChartPart& part, const Sides& sides)
{
  for (std::size_t i = 0; i < sides.size(); ++i)
  {
    mesh.Sides[static_cast<std::size_t>(part.Triangles[i])] = sides[i];
  }
}
}

std::vector<int> FindSmallHoles(const DiscMesh& mesh)
{
  std::vector<int> holes(static_cast<std::size_t>(mesh.NumPoints()), -1);
  int count = 0;
  for (const auto& loop : mesh.Loops)
  {
    double length = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      length += (mesh.Point(loop[(i + 1) % loop.size()]) - mesh.Point(loop[i])).norm();
    }
    if (length < std::sqrt(mesh.Area))
    {
      for (int v : loop)
      {
        holes[static_cast<std::size_t>(v)] = count;
      }
      ++count;
    }
  }
  std::vector<Eigen::Vector3d> sums(static_cast<std::size_t>(count), Eigen::Vector3d::Zero());
  std::vector<double> sizes(static_cast<std::size_t>(count), 0.0);
  for (const auto& corners : mesh.Triangles)
  {
    const Eigen::Vector3d a = mesh.Point(corners[0]);
    const Eigen::Vector3d normal = (mesh.Point(corners[1]) - a).cross(mesh.Point(corners[2]) - a);
    for (int c : corners)
    {
      if (const int hole = holes[static_cast<std::size_t>(c)]; hole >= 0)
      {
        sums[static_cast<std::size_t>(hole)] += normal;
        sizes[static_cast<std::size_t>(hole)] += normal.norm();
      }
    }
  }
  for (int& hole : holes)
  {
    const auto at = static_cast<std::size_t>(hole);
    hole = hole >= 0 && sums[at].norm() >= LeastCoherence * sizes[at] ? hole : -1;
  }
  return holes;
}

Result<std::vector<int>> DivideChart(CutMesh& mesh, int chart, const EdgeCrossing& crossing,
  const std::vector<int>& holes, double creaseAngle, int& numCharts)
{
  using Division = std::function<Sides(const SurfaceParts&, const std::vector<int>&)>;
  std::vector<Division> divisions;
  if (crossing)
  {
    divisions.emplace_back([&](const SurfaceParts& parts, const std::vector<int>& points)
      { return DivideAtCrossing(parts, points, crossing); });
  }
  for (const auto divide : { DivideByNormals, DivideByLength, DivideByPosition })
  {
    divisions.emplace_back(
      [divide](const SurfaceParts& parts, const std::vector<int>&) { return divide(parts); });
  }
  bool divided = false;
  for (std::size_t i = 0; i < divisions.size() && !divided;)
  {
    const auto part = TakePart(mesh, mesh.TrianglesOf(chart));
    if (!part)
    {
      return part.Status;
    }
    const std::vector<int> localHoles = HolesOf(part.Value, holes);
    const SurfaceParts parts(part.Value.Mesh, localHoles);
    Sides sides;
    for (; i < divisions.size() && sides.empty(); ++i)
    {
      sides = divisions[i](parts, part.Value.Points);
    }
    if (sides.empty())
    {
      break;
    }
    JoinIslands(parts.Adjacency, parts.Areas, LeastIsland, sides);
    SetSides(mesh, part.Value, sides);
    CutAlong(mesh, part.Value, CutFunction(parts, sides, creaseAngle));
    if (Status status = RepairSides(mesh, chart, holes); !status)
    {
      return status;
    }
    divided = HasBothSides(mesh, mesh.TrianglesOf(chart));
  }
  if (!divided) // repairs took it all: cut along edges as they are
  {
    const auto part = TakePart(mesh, mesh.TrianglesOf(chart));
    if (!part)
    {
      return part.Status;
    }
    const std::vector<int> localHoles = HolesOf(part.Value, holes);
    const Sides sides = DivideByPosition(SurfaceParts(part.Value.Mesh, localHoles));
    if (sides.empty())
    {
      return { ErrorCode::InvalidTopology,
        "a chart of one triangle is not laid out by the method; allow the fallback" };
    }
    SetSides(mesh, part.Value, sides);
  }
  const auto components = Components(mesh, mesh.TrianglesOf(chart));
  Result<std::vector<int>> result;
  for (std::size_t i = 0; i < components.size(); ++i)
  {
    const int number = i == 0 ? chart : numCharts++;
    for (int t : components[i])
    {
      mesh.Charts[static_cast<std::size_t>(t)] = number;
    }
    result.Value.push_back(number);
  }
  return result;
}
}
