// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleMesh.h"

#include "TriangleAdjacency.h"

#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/TriangleIndex.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double SmallestHeight = 1e-12; // of a triangle, over its longest edge

/// "3 triangles (1, 5, 7)"; of more than five ids the first ones.
std::string List(const std::vector<int>& ids, const std::string& what)
{
  std::string text = std::to_string(ids.size()) + " " + what + (ids.size() == 1 ? " (" : "s (");
  for (std::size_t i = 0; i < std::min<std::size_t>(5, ids.size()); ++i)
  {
    text += (i > 0 ? ", " : "") + std::to_string(ids[i]);
  }
  return text + (ids.size() > 5 ? ", ...)" : ")");
}

Status CheckTriangles(const TriangleMesh& mesh)
{
  const int n = static_cast<int>(mesh.Points.rows());
  std::vector<int> bad;
  for (int i = 0; i < n; ++i)
  {
    if (!mesh.Points.row(i).allFinite())
    {
      bad.push_back(i);
    }
  }
  if (!bad.empty())
  {
    return { ErrorCode::NonFiniteInput, "coordinates of " + List(bad, "point") };
  }
  std::vector<int> outside;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const auto& corners = mesh.Triangles[t];
    if (std::any_of(corners.begin(), corners.end(), [n](int c) { return c < 0 || c >= n; }))
    {
      outside.push_back(static_cast<int>(t));
      continue;
    }
    const Eigen::RowVector3d a = mesh.Points.row(corners[0]);
    const Eigen::RowVector3d ab = mesh.Points.row(corners[1]) - a;
    const Eigen::RowVector3d ac = mesh.Points.row(corners[2]) - a;
    const double longest = std::max({ ab.norm(), ac.norm(), (ac - ab).norm() });
    if (!(ab.cross(ac).norm() > SmallestHeight * longest * longest))
    {
      bad.push_back(static_cast<int>(t));
    }
  }
  if (!outside.empty())
  {
    return { ErrorCode::InvalidTopology,
      "corners that are no points in " + List(outside, "triangle") };
  }
  if (!bad.empty())
  {
    return { ErrorCode::InvalidTopology,
      List(bad, "degenerate triangle") + "; remove them, for example with vtkCleanPolyData" };
  }
  return {};
}

/// Component of each triangle; turns triangles over so that neighbours agree.
Status Orient(std::vector<std::array<int, 3>>& triangles, const TriangleAdjacency& adjacency,
  std::vector<int>& component, std::vector<int>& sizes, std::vector<char>& turned)
{
  component.assign(triangles.size(), -1);
  turned.assign(triangles.size(), 0);
  std::vector<int> stack;
  for (std::size_t start = 0; start < triangles.size(); ++start)
  {
    if (component[start] >= 0)
    {
      continue;
    }
    const int number = static_cast<int>(sizes.size());
    sizes.push_back(0);
    component[start] = number;
    stack.push_back(static_cast<int>(start));
    while (!stack.empty())
    {
      const auto t = static_cast<std::size_t>(stack.back());
      stack.pop_back();
      ++sizes.back();
      for (std::size_t k = 0; k < 3; ++k)
      {
        if (adjacency.Triangle[t][k] < 0)
        {
          continue;
        }
        const auto other = static_cast<std::size_t>(adjacency.Triangle[t][k]);
        const auto side = static_cast<std::size_t>(adjacency.Side[t][k]);
        // sides as given run the same way: one of the two has to be turned
        const bool same = triangles[t][k] == triangles[other][side];
        const char wanted = static_cast<char>(turned[t] != (same ? 1 : 0) ? 1 : 0);
        if (component[other] < 0)
        {
          component[other] = number;
          turned[other] = wanted;
          stack.push_back(static_cast<int>(other));
        }
        else if (turned[other] != wanted)
        {
          return { ErrorCode::InvalidTopology,
            "the surface has one side only (triangles " + std::to_string(t) + " and " +
              std::to_string(other) + " cannot be oriented alike)" };
        }
      }
    }
  }
  // within a component the side of the majority stays
  std::vector<int> count(sizes.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    count[static_cast<std::size_t>(component[t])] += turned[t];
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const auto c = static_cast<std::size_t>(component[t]);
    if (2 * count[c] > sizes[c])
    {
      turned[t] = static_cast<char>(1 - turned[t]);
    }
    if (turned[t])
    {
      std::swap(triangles[t][1], triangles[t][2]);
    }
  }
  return {};
}

/// Fans, lengths and boundary marks of an oriented mesh.
Status BuildFans(DiscMesh& mesh)
{
  const auto n = static_cast<std::size_t>(mesh.Points.rows());
  std::vector<int> count(n + 1, 0);
  for (const auto& corners : mesh.Triangles)
  {
    for (int c : corners)
    {
      ++count[static_cast<std::size_t>(c) + 1];
    }
  }
  for (std::size_t v = 0; v < n; ++v)
  {
    count[v + 1] += count[v];
  }
  std::vector<std::array<int, 2>> sides(static_cast<std::size_t>(count[n])); // opposite v
  std::vector<int> used(n, 0);
  for (const auto& corners : mesh.Triangles)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto v = static_cast<std::size_t>(corners[k]);
      sides[static_cast<std::size_t>(count[v] + used[v]++)] = { corners[(k + 1) % 3],
        corners[(k + 2) % 3] };
    }
  }
  mesh.FanStart.assign(1, 0);
  mesh.Fan.clear();
  mesh.OnBoundary.assign(n, 0);
  std::vector<int> pinched;
  // of the last vertex that a point lies around: where sides that begin and end there are, so that
  // a vertex costs its sides and not their square
  std::vector<std::array<int, 2>> places(n, { -1, -1 });
  for (std::size_t v = 0; v < n; ++v)
  {
    const auto begin = sides.begin() + count[v];
    const auto end = sides.begin() + count[v + 1];
    const auto place = [&](int point, std::size_t which)
    {
      const int at = places[static_cast<std::size_t>(point)][which];
      return at < count[v] ? end : sides.begin() + at;
    };
    for (auto side = end; side != begin;) // of equal ones the first stays
    {
      --side;
      for (std::size_t which = 0; which < 2; ++which)
      {
        places[static_cast<std::size_t>((*side)[which])][which] =
          static_cast<int>(side - sides.begin());
      }
    }
    auto current = begin;
    for (auto side = begin; side != end; ++side) // an open fan begins where no side ends
    {
      const bool starts = place((*side)[0], 1) == end;
      if (starts)
      {
        current = side;
        mesh.OnBoundary[v] = 1;
        break;
      }
    }
    std::ptrdiff_t visited = 0;
    const int first = (*current)[0];
    mesh.Fan.push_back(first);
    int last = first;
    while (current != end && visited < end - begin)
    {
      ++visited;
      last = (*current)[1];
      if (last == first)
      {
        break;
      }
      mesh.Fan.push_back(last);
      current = place(last, 0);
    }
    if (visited != end - begin)
    {
      pinched.push_back(mesh.PointIds[v]);
    }
    mesh.FanStart.push_back(static_cast<int>(mesh.Fan.size()));
  }
  if (!pinched.empty())
  {
    return { ErrorCode::InvalidTopology,
      "triangles touch in a point only, without a common edge, at " + List(pinched, "point") };
  }
  mesh.Spokes.resize(mesh.Fan.size());
  mesh.Rims.resize(mesh.Fan.size());
  for (std::size_t v = 0; v < n; ++v)
  {
    const int begin = mesh.FanStart[v];
    const int end = mesh.FanStart[v + 1];
    for (int j = begin; j < end; ++j)
    {
      const auto at = static_cast<std::size_t>(j);
      const int a = mesh.Fan[at];
      mesh.Spokes[at] = (mesh.Points.row(a) - mesh.Points.row(static_cast<int>(v))).norm();
      const bool open = j + 1 == end && mesh.OnBoundary[v];
      const int b = mesh.Fan[static_cast<std::size_t>(j + 1 == end ? begin : j + 1)];
      mesh.Rims[at] = open ? 0.0 : (mesh.Points.row(a) - mesh.Points.row(b)).norm();
    }
  }
  return {};
}

void BuildLoops(DiscMesh& mesh)
{
  const auto n = static_cast<std::size_t>(mesh.NumPoints());
  std::vector<char> done(n, 0);
  std::vector<double> lengths;
  std::vector<std::vector<int>> loops;
  for (std::size_t start = 0; start < n; ++start)
  {
    if (!mesh.OnBoundary[start] || done[start])
    {
      continue;
    }
    std::vector<int> loop;
    double length = 0.0;
    std::size_t v = start;
    while (!done[v]) // the first spoke of an open fan has its triangle on the left
    {
      done[v] = 1;
      loop.push_back(static_cast<int>(v));
      const auto first = static_cast<std::size_t>(mesh.FanStart[v]);
      length += mesh.Spokes[first];
      v = static_cast<std::size_t>(mesh.Fan[first]);
    }
    loops.push_back(std::move(loop));
    lengths.push_back(length);
  }
  std::vector<std::size_t> order(loops.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    order[i] = i;
  }
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return lengths[a] > lengths[b]; });
  for (std::size_t i : order)
  {
    mesh.Loops.push_back(std::move(loops[i]));
  }
}

Status KeepComponent(const TriangleMesh& mesh, const std::vector<std::array<int, 3>>& triangles,
  const std::vector<int>& component, const std::vector<int>& sizes, bool largest, DiscMesh& disc)
{
  const int kept = static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<char> referenced(static_cast<std::size_t>(mesh.Points.rows()), 0);
  for (const auto& corners : triangles)
  {
    for (int c : corners)
    {
      referenced[static_cast<std::size_t>(c)] = 1;
    }
  }
  std::vector<int> unreferenced;
  for (std::size_t v = 0; v < referenced.size(); ++v)
  {
    if (!referenced[v])
    {
      unreferenced.push_back(static_cast<int>(v));
    }
  }
  if (!largest && !unreferenced.empty())
  {
    return { ErrorCode::InvalidTopology,
      List(unreferenced, "point") +
        " of no triangle; the option for the largest component drops them" };
  }
  if (!largest && sizes.size() > 1)
  {
    return { ErrorCode::InvalidTopology,
      std::to_string(sizes.size()) + " components; the option for the largest component keeps " +
        std::to_string(sizes[static_cast<std::size_t>(kept)]) + " of " +
        std::to_string(triangles.size()) + " triangles" };
  }
  std::vector<int> number(referenced.size(), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    if (component[t] == kept)
    {
      disc.Triangles.push_back(triangles[t]);
      disc.TriangleIds.push_back(static_cast<int>(t));
      for (int c : triangles[t])
      {
        number[static_cast<std::size_t>(c)] = 0;
      }
    }
  }
  for (std::size_t v = 0; v < number.size(); ++v)
  {
    if (number[v] == 0)
    {
      number[v] = static_cast<int>(disc.PointIds.size());
      disc.PointIds.push_back(static_cast<int>(v));
    }
  }
  for (auto& corners : disc.Triangles)
  {
    for (int& c : corners)
    {
      c = number[static_cast<std::size_t>(c)];
    }
  }
  disc.Points.resize(static_cast<Eigen::Index>(disc.PointIds.size()), 3);
  for (std::size_t v = 0; v < disc.PointIds.size(); ++v)
  {
    disc.Points.row(static_cast<Eigen::Index>(v)) = mesh.Points.row(disc.PointIds[v]);
  }
  return {};
}
}

Result<DiscMesh> CheckSurface(const TriangleMesh& mesh, bool largestComponent)
{
  if (mesh.Points.rows() == 0 || mesh.Triangles.empty())
  {
    return { ErrorCode::EmptyInput, "the mesh has no triangles" };
  }
  if (mesh.Points.cols() != 3)
  {
    return { ErrorCode::DimensionMismatch, "points of a mesh have three coordinates" };
  }
  if (Status status = CheckTriangles(mesh); !status)
  {
    return status;
  }
  const auto adjacency = FindAdjacency(mesh.Triangles);
  if (!adjacency)
  {
    return adjacency.Status;
  }
  std::vector<std::array<int, 3>> triangles = mesh.Triangles;
  std::vector<int> component;
  std::vector<int> sizes;
  std::vector<char> turned;
  if (Status status = Orient(triangles, adjacency.Value, component, sizes, turned); !status)
  {
    return status;
  }
  Result<DiscMesh> result;
  DiscMesh& disc = result.Value;
  disc.Components = static_cast<int>(sizes.size());
  if (Status status = KeepComponent(mesh, triangles, component, sizes, largestComponent, disc);
      !status)
  {
    return status;
  }
  for (int t : disc.TriangleIds)
  {
    disc.Reversed += turned[static_cast<std::size_t>(t)];
  }
  if (Status status = BuildFans(disc); !status)
  {
    return status;
  }
  BuildLoops(disc);
  for (const auto& corners : disc.Triangles)
  {
    const Eigen::Vector3d a = disc.Point(corners[0]);
    disc.Area += 0.5 * (disc.Point(corners[1]) - a).cross(disc.Point(corners[2]) - a).norm();
  }
  return result;
}

Status CheckDisc(const DiscMesh& disc)
{
  const auto loops = static_cast<int>(disc.Loops.size());
  if (loops == 0)
  {
    return { ErrorCode::InvalidTopology, "the surface is closed; cut it open first" };
  }
  // every inner edge is the spoke of two fans, every boundary edge too
  const int euler = disc.NumPoints() - static_cast<int>(disc.Fan.size() / 2) +
    static_cast<int>(disc.Triangles.size());
  if (const int genus = (2 - loops - euler) / 2; genus > 0)
  {
    return { ErrorCode::InvalidTopology,
      "the surface has " + std::to_string(genus) + (genus == 1 ? " handle" : " handles") +
        " (genus); cut it open first" };
  }
  return {};
}

Result<DiscMesh> CheckMesh(const TriangleMesh& mesh, bool largestComponent)
{
  auto result = CheckSurface(mesh, largestComponent);
  if (result)
  {
    result.Status = CheckDisc(result.Value);
  }
  return result;
}

double TriangleArea(const PointMatrix& points, const std::array<int, 3>& triangle)
{
  const Eigen::RowVector3d corner = points.row(triangle[0]);
  const Eigen::RowVector3d first = points.row(triangle[1]) - corner;
  const Eigen::RowVector3d second = points.row(triangle[2]) - corner;
  return 0.5 * first.cross(second).norm();
}

std::vector<MeshComponent> ConnectedComponents(const TriangleMesh& mesh)
{
  std::vector<MeshComponent> all;
  const bool areCornersThere = std::all_of(mesh.Triangles.begin(), mesh.Triangles.end(),
    [&](const MeshTriangle& triangle)
    {
      return std::all_of(triangle.begin(), triangle.end(),
        [&](int corner) { return corner >= 0 && corner < mesh.Points.rows(); });
    });
  if (!areCornersThere || mesh.Points.cols() != 3 || !mesh.Points.allFinite())
  {
    MeshComponent& whole = all.emplace_back();
    whole.Mesh = mesh;
    whole.PointIds.resize(static_cast<std::size_t>(mesh.Points.rows()));
    std::iota(whole.PointIds.begin(), whole.PointIds.end(), 0);
    whole.TriangleIds.resize(mesh.Triangles.size());
    std::iota(whole.TriangleIds.begin(), whole.TriangleIds.end(), 0);
    return all;
  }
  const std::vector<MeshTriangle> joined =
    ReplaceCorners(mesh.Triangles, FirstOfEqualPoints(mesh.Points));
  const auto isDegenerate = [](const MeshTriangle& triangle) {
    return triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
  };
  DisjointSets sets(static_cast<int>(joined.size()));
  std::map<std::array<int, 2>, int> firstOfEdge; // a triangle
  for (std::size_t t = 0; t < joined.size(); ++t)
  {
    for (std::size_t k = 0; k < 3 && !isDegenerate(joined[t]); ++k)
    {
      const int a = joined[t][k];
      const int b = joined[t][(k + 1) % 3];
      const auto [first, isNew] = firstOfEdge.emplace(
        std::array<int, 2>{ std::min(a, b), std::max(a, b) }, static_cast<int>(t));
      if (!isNew)
      {
        sets.Unite(static_cast<int>(t), first->second);
      }
    }
  }
  std::map<int, std::size_t> componentOf; // by the first triangle
  for (std::size_t t = 0; t < joined.size(); ++t)
  {
    if (!isDegenerate(joined[t]))
    {
      const auto [found, isNew] = componentOf.emplace(sets.Find(static_cast<int>(t)), all.size());
      MeshComponent& own = isNew ? all.emplace_back() : all[found->second];
      own.TriangleIds.push_back(static_cast<int>(t));
    }
  }
  std::vector<int> number(static_cast<std::size_t>(mesh.Points.rows()), -1);
  for (MeshComponent& own : all)
  {
    for (const int t : own.TriangleIds)
    {
      MeshTriangle corners = joined[static_cast<std::size_t>(t)];
      for (int& corner : corners)
      {
        int& place = number[static_cast<std::size_t>(corner)];
        if (place < 0)
        {
          place = static_cast<int>(own.PointIds.size());
          own.PointIds.push_back(corner);
        }
        corner = place;
      }
      own.Mesh.Triangles.push_back(corners);
    }
    own.Mesh.Points.resize(static_cast<Eigen::Index>(own.PointIds.size()), 3);
    for (std::size_t i = 0; i < own.PointIds.size(); ++i)
    {
      own.Mesh.Points.row(static_cast<Eigen::Index>(i)) = mesh.Points.row(own.PointIds[i]);
      number[static_cast<std::size_t>(own.PointIds[i])] = -1; // parts may touch
    }
  }
  return all;
}

Result<DiscMesh> CheckComponent(const TriangleMesh& mesh, const MeshComponent& component)
{
  auto surface = CheckSurface(component.Mesh, true);
  if (!surface)
  {
    TriangleMesh whole; // once more, for the numbers of points in the message
    whole.Points = mesh.Points;
    for (MeshTriangle corners : component.Mesh.Triangles)
    {
      for (int& corner : corners)
      {
        const bool isThere = corner >= 0 && corner < static_cast<int>(component.PointIds.size());
        corner = isThere ? component.PointIds[static_cast<std::size_t>(corner)] : corner;
      }
      whole.Triangles.push_back(corners);
    }
    return CheckSurface(whole, true).Status;
  }
  for (int& point : surface->PointIds)
  {
    point = component.PointIds[static_cast<std::size_t>(point)];
  }
  for (int& triangle : surface->TriangleIds)
  {
    triangle = component.TriangleIds[static_cast<std::size_t>(triangle)];
  }
  return surface;
}
}
