// SPDX-License-Identifier: BSD-3-Clause
#include "CutLine.h"

#include "HeatFlow.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr std::array<double, 3> SmoothingLengths{ 3.0, 1.0, 0.3 }; // in edges of the cut
constexpr int HeatSteps = 2;
constexpr double SnapShare = 0.15; // of an edge
constexpr double LeastShare = 0.2; // of the area of a side that is left of it

/// Side of each hole: of the larger part of the area of its triangles.
std::vector<int> HoleSides(const SurfaceParts& parts, const Sides& sides)
{
  const int holes = 1 + *std::max_element(parts.Holes.begin(), parts.Holes.end());
  std::vector<double> sums(static_cast<std::size_t>(std::max(holes, 0)), 0.0);
  for (std::size_t t = 0; t < sides.size(); ++t)
  {
    for (int c : parts.Mesh.Triangles[t])
    {
      if (const int hole = parts.Holes[static_cast<std::size_t>(c)]; hole >= 0)
      {
        sums[static_cast<std::size_t>(hole)] += sides[t] ? parts.Areas[t] : -parts.Areas[t];
      }
    }
  }
  std::vector<int> result;
  for (double sum : sums)
  {
    result.push_back(sum > 0.0 ? 1 : -1);
  }
  return result;
}

/// +-1 at points of one side only, 0 between.
Eigen::VectorXd EdgeFunction(const SurfaceParts& parts, const Sides& sides)
{
  const int n = parts.Mesh.NumPoints();
  Eigen::VectorXi found = Eigen::VectorXi::Zero(n); // bit 1: side 0, bit 2: side 1
  for (std::size_t t = 0; t < sides.size(); ++t)
  {
    for (int c : parts.Mesh.Triangles[t])
    {
      found[c] |= sides[t] ? 2 : 1;
    }
  }
  Eigen::VectorXd values(n);
  for (int v = 0; v < n; ++v)
  {
    values[v] = found[v] == 3 ? 0.0 : (found[v] == 2 ? 1.0 : -1.0);
  }
  return values;
}

/// Where the line comes near a point it goes through it.
void Snap(const SurfaceParts& parts, const std::vector<char>& held, Eigen::VectorXd& values)
{
  std::vector<char> near(held.size(), 0);
  for (int v = 0; v < parts.Mesh.NumPoints(); ++v)
  {
    const auto at = static_cast<std::size_t>(v);
    for (int j = parts.Mesh.FanStart[at]; j < parts.Mesh.FanStart[at + 1] && !held[at]; ++j)
    {
      const double other = values[parts.Mesh.Fan[static_cast<std::size_t>(j)]];
      if (values[v] * other < 0.0 && values[v] / (values[v] - other) < SnapShare)
      {
        near[at] = 1;
      }
    }
  }
  for (std::size_t v = 0; v < near.size(); ++v)
  {
    if (near[v])
    {
      values[static_cast<Eigen::Index>(v)] = 0.0;
    }
  }
}

/// Area of triangles where the function is positive or negative in the mean.
std::array<double, 2> SideAreas(const SurfaceParts& parts, const Eigen::VectorXd& values)
{
  std::array<double, 2> areas{ 0.0, 0.0 };
  for (std::size_t t = 0; t < parts.Areas.size(); ++t)
  {
    const auto& corners = parts.Mesh.Triangles[t];
    const double sum = values[corners[0]] + values[corners[1]] + values[corners[2]];
    areas[sum > 0.0 ? 1 : 0] += sum != 0.0 ? parts.Areas[t] : 0.0;
  }
  return areas;
}
}

Eigen::VectorXd CutFunction(const SurfaceParts& parts, const Sides& sides, double creaseAngle)
{
  const DiscMesh& mesh = parts.Mesh;
  const int n = mesh.NumPoints();
  Eigen::VectorXd values = EdgeFunction(parts, sides);
  std::vector<char> held(static_cast<std::size_t>(n), 0);
  double length = 0.0;
  int count = 0;
  for (std::size_t t = 0; t < sides.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int other = parts.Adjacency.Triangle[t][k];
      if (other < 0 || sides[static_cast<std::size_t>(other)] == sides[t])
      {
        continue;
      }
      length += parts.SideLength(t, k);
      ++count;
      if (parts.Dihedral(t, k) > creaseAngle)
      {
        held[static_cast<std::size_t>(mesh.Triangles[t][k])] = 1;
        held[static_cast<std::size_t>(mesh.Triangles[t][(k + 1) % 3])] = 1;
      }
    }
  }
  if (count == 0)
  {
    return values;
  }
  const std::vector<int> holeSides = HoleSides(parts, sides);
  for (int v = 0; v < n; ++v)
  {
    if (const int hole = parts.Holes[static_cast<std::size_t>(v)]; hole >= 0)
    {
      values[v] = holeSides[static_cast<std::size_t>(hole)];
      held[static_cast<std::size_t>(v)] = 1;
    }
  }
  std::array<double, 2> wanted{ 0.0, 0.0 };
  for (std::size_t t = 0; t < sides.size(); ++t)
  {
    wanted[static_cast<std::size_t>(sides[t])] += parts.Areas[t];
  }
  for (const double smoothing : SmoothingLengths)
  {
    const double width = smoothing * length / count;
    Eigen::VectorXd smooth = values;
    const bool solved =
      static_cast<bool>(FlowHeat(mesh, held, 0.5 * width * width / HeatSteps, HeatSteps, smooth));
    Snap(parts, held, smooth);
    const std::array<double, 2> got = SideAreas(parts, smooth);
    if (solved && got[0] >= LeastShare * wanted[0] && got[1] >= LeastShare * wanted[1])
    {
      return smooth;
    }
  }
  return values;
}
}
