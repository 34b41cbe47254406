// SPDX-License-Identifier: BSD-3-Clause
#include "KnownEdges.h"

#include <knotwork/SplineCore/TriangleIndex.h>

#include <algorithm>
#include <sstream>

namespace knotwork
{
namespace
{
bool IsInOrder(const TriangleMesh& mesh)
{
  return !mesh.Triangles.empty() && mesh.Points.cols() == 3 && mesh.Points.allFinite() &&
    std::all_of(mesh.Triangles.begin(), mesh.Triangles.end(),
      [&](const MeshTriangle& triangle)
      {
        return std::all_of(triangle.begin(), triangle.end(),
          [&](int corner) { return corner >= 0 && corner < mesh.Points.rows(); });
      });
}
}

Result<std::vector<std::array<int, 2>>> EdgesOfLines(
  const TriangleMesh& mesh, const PointMatrix& points, const std::vector<std::vector<int>>& lines)
{
  std::vector<std::array<int, 2>> edges;
  if (!IsInOrder(mesh))
  {
    return edges;
  }
  const double tolerance = KnownEdgeTolerance *
    (mesh.Points.colwise().maxCoeff() - mesh.Points.colwise().minCoeff()).norm();
  const TriangleIndex<3> index(mesh.Points, mesh.Triangles);
  std::vector<int> pointOf(static_cast<std::size_t>(points.rows()), -1);
  std::string far;
  int count = 0;
  for (const std::vector<int>& line : lines)
  {
    for (const int id : line)
    {
      int& own = pointOf[static_cast<std::size_t>(id)];
      if (own >= 0)
      {
        continue;
      }
      const Eigen::RowVector3d point = points.row(id);
      if (!point.allFinite())
      {
        return { ErrorCode::NonFiniteInput,
          "point " + std::to_string(id) + " of the known edges; remove it" };
      }
      double least = std::numeric_limits<double>::infinity();
      for (const int corner :
        mesh.Triangles[static_cast<std::size_t>(index.Nearest(point.data()).Triangle)])
      {
        const double distance = (mesh.Points.row(corner) - point).norm();
        if (distance < least)
        {
          least = distance;
          own = corner;
        }
      }
      if (least > tolerance && count++ < 5)
      {
        far += (far.empty() ? "" : ", ") + std::to_string(id);
      }
    }
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
    {
      const int a = pointOf[static_cast<std::size_t>(line[i])];
      const int b = pointOf[static_cast<std::size_t>(line[i + 1])];
      if (a != b)
      {
        edges.push_back({ a, b });
      }
    }
  }
  if (count > 0)
  {
    std::ostringstream text;
    text << count << (count == 1 ? " point (" : " points (") << far << (count > 5 ? ", ..." : "")
         << ") of the known edges: farther than " << tolerance
         << " from all points of the mesh; draw edges through points of the mesh";
    return { ErrorCode::OutsideDomain, text.str() };
  }
  return edges;
}
}
