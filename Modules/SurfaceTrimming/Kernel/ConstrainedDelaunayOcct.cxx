// SPDX-License-Identifier: BSD-3-Clause
#include "ConstrainedDelaunay.h"

#include <BRepMesh_DataStructureOfDelaun.hxx>
#include <BRepMesh_Delaun.hxx>
#include <Standard_Failure.hxx>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// OpenCASCADE takes points nearer than 1e-9 for one.
constexpr double UnitLength = 1e-8;

Result<std::vector<std::array<int, 3>>> Triangulate(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments)
{
  const Handle(NCollection_IncAllocator) allocator =
    new NCollection_IncAllocator(IMeshData::MEMORY_BLOCK_SIZE_HUGE);
  const int n = static_cast<int>(points.size());
  const Handle(BRepMesh_DataStructureOfDelaun) structure =
    new BRepMesh_DataStructureOfDelaun(allocator, n);
  IMeshData::VectorOfInteger nodes(256, allocator);
  for (const PlanarPoint& point : points)
  {
    nodes.Append(structure->AddNode(
      BRepMesh_Vertex(UnitLength * point[0], UnitLength * point[1], BRepMesh_Free), true));
  }
  std::vector<int> number(At(structure->NbNodes()) + 1, -1);
  for (int i = 0; i < n; ++i)
  {
    number[At(nodes(i))] = i;
  }
  for (const PlanarSegment& segment : segments)
  {
    structure->AddLink(BRepMesh_Edge(nodes(segment[0]), nodes(segment[1]), BRepMesh_Fixed));
  }
  const int cells = std::clamp(static_cast<int>(std::sqrt(n / 4.0)), 2, 1000);
  BRepMesh_Delaun triangulation(structure, nodes, cells, cells);

  std::vector<std::array<int, 3>> triangles;
  for (IMeshData::IteratorOfMapOfInteger it(structure->ElementsOfDomain()); it.More(); it.Next())
  {
    const BRepMesh_Triangle& element = structure->GetElement(it.Key());
    if (element.Movability() == BRepMesh_Deleted)
    {
      continue;
    }
    int corners[3];
    structure->ElementNodes(element, corners);
    std::array<int, 3> triangle{};
    for (int i = 0; i < 3; ++i)
    {
      if (corners[i] >= static_cast<int>(number.size()) || number[At(corners[i])] < 0)
      {
        return { ErrorCode::InvalidTopology, "a triangle with a point that is not of the input" };
      }
      triangle[At(i)] = number[At(corners[i])];
    }
    const int sign =
      Orientation(points[At(triangle[0])], points[At(triangle[1])], points[At(triangle[2])]);
    if (sign < 0)
    {
      std::swap(triangle[1], triangle[2]);
    }
    if (sign != 0)
    {
      std::rotate(
        triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
      triangles.push_back(triangle);
    }
  }
  std::sort(triangles.begin(), triangles.end());
  if (triangles.empty())
  {
    return { ErrorCode::InvalidTopology, "no triangles" };
  }
  return triangles;
}
}

Result<std::vector<std::array<int, 3>>> ConstrainedDelaunay(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments)
{
  try
  {
    return Triangulate(points, segments);
  }
  catch (const Standard_Failure& failure)
  {
    return { ErrorCode::InvalidTopology, failure.GetMessageString() };
  }
}
}
