// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceMesh.h"

#include <knotwork/SplineCore/PatchSides.h>

#include <algorithm>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

void AddEdges(SurfaceMesh& surface, int numPoints)
{
  struct QuadEdge
  {
    std::array<int, 2> Ends;
    int Quad;
    int Edge;
  };
  std::vector<QuadEdge> all;
  for (std::size_t q = 0; q < surface.Quads.size(); ++q)
  {
    for (std::size_t k = 0; k < 4; ++k)
    {
      const int a = surface.Quads[q][k];
      const int b = surface.Quads[q][(k + 1) % 4];
      all.push_back(
        { { std::min(a, b), std::max(a, b) }, static_cast<int>(q), static_cast<int>(k) });
    }
  }
  std::stable_sort(
    all.begin(), all.end(), [](const QuadEdge& a, const QuadEdge& b) { return a.Ends < b.Ends; });
  surface.EdgesOf.resize(surface.Quads.size());
  for (const QuadEdge& edge : all)
  {
    if (surface.Edges.empty() || surface.Edges.back() != edge.Ends)
    {
      surface.Edges.push_back(edge.Ends);
      surface.QuadsOf.push_back({ edge.Quad, Rim });
    }
    else
    {
      surface.QuadsOf.back()[1] = edge.Quad;
    }
    surface.EdgesOf[At(edge.Quad)][At(edge.Edge)] = static_cast<int>(surface.Edges.size()) - 1;
  }
  surface.EdgeStart.assign(At(numPoints) + 1, 0);
  for (const auto& ends : surface.Edges)
  {
    ++surface.EdgeStart[At(ends[0]) + 1];
    ++surface.EdgeStart[At(ends[1]) + 1];
  }
  for (std::size_t i = 1; i < surface.EdgeStart.size(); ++i)
  {
    if (surface.EdgeStart[i] > 0)
    {
      surface.Points.push_back(static_cast<int>(i) - 1);
    }
    surface.EdgeStart[i] += surface.EdgeStart[i - 1];
  }
  surface.EdgesAt.resize(2 * surface.Edges.size());
  std::vector<int> next(surface.EdgeStart.begin(), surface.EdgeStart.end() - 1);
  for (std::size_t e = 0; e < surface.Edges.size(); ++e)
  {
    for (const int end : surface.Edges[e])
    {
      surface.EdgesAt[At(next[At(end)]++)] = static_cast<int>(e);
    }
  }
}

/// Edges of one quadrilateral that has a neighbour in the mesh.
template <int Dim>
void MarkEnds(const MeshTopology<Dim>& topology, SurfaceMesh& surface)
{
  constexpr std::array<int, 4> sideOfEdge{ 2, 1, 3, 0 };
  for (std::size_t e = 0; e < surface.Edges.size(); ++e)
  {
    auto& quads = surface.QuadsOf[e];
    if (quads[1] != Rim)
    {
      continue;
    }
    if constexpr (Dim == 2)
    {
      const auto& own = surface.EdgesOf[At(quads[0])];
      const auto place = std::find(own.begin(), own.end(), static_cast<int>(e)) - own.begin();
      if (topology.IsBoundary(
            surface.Facets[At(quads[0])].Cell, sideOfEdge[static_cast<std::size_t>(place)]))
      {
        continue;
      }
    }
    quads[1] = EndOfPart;
  }
}
}

template <int Dim>
SurfaceMesh MakeSurfaceMesh(
  const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology, const std::vector<char>& isMeant)
{
  SurfaceMesh surface;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    if (!isMeant.empty() && isMeant[At(c)] == 0)
    {
      continue;
    }
    const int* corners = mesh.Cell(c);
    if constexpr (Dim == 2)
    {
      surface.Facets.push_back({ c, -1 });
      surface.Quads.push_back({ corners[0], corners[1], corners[3], corners[2] });
      continue;
    }
    for (int side = 0; side < 2 * Dim; ++side)
    {
      if (!topology.IsBoundary(c, side))
      {
        continue;
      }
      std::array<int, 4> quad{ corners[PatchCorner<3>(side, 0)], corners[PatchCorner<3>(side, 1)],
        corners[PatchCorner<3>(side, 3)], corners[PatchCorner<3>(side, 2)] };
      if (SideSign(side) < 0)
      {
        std::swap(quad[1], quad[3]);
      }
      surface.Facets.push_back({ c, side });
      surface.Quads.push_back(quad);
    }
  }
  AddEdges(surface, mesh.NumPoints);
  MarkEnds(topology, surface);
  return surface;
}

template <int Dim>
std::vector<char> PointsBeside(
  const SurfaceMesh& part, const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology)
{
  std::vector<char> isBeside(At(mesh.NumPoints), 0);
  for (const int point : MakeSurfaceMesh<Dim>(mesh, topology).Points)
  {
    isBeside[At(point)] = 1;
  }
  for (const int point : part.Points)
  {
    isBeside[At(point)] = 0;
  }
  return isBeside;
}

std::vector<double> EdgeLengthsAt(const SurfaceMesh& surface, const PointMatrix& points)
{
  std::vector<double> lengths(surface.EdgeStart.size() - 1, 0.0);
  for (const int point : surface.Points)
  {
    double sum = 0.0;
    surface.ForEdges(point,
      [&](int edge)
      { sum += (points.row(surface.Across(edge, point)) - points.row(point)).norm(); });
    lengths[At(point)] = sum / (surface.EdgeStart[At(point) + 1] - surface.EdgeStart[At(point)]);
  }
  return lengths;
}

template SurfaceMesh MakeSurfaceMesh(
  const CellMesh<2>&, const MeshTopology<2>&, const std::vector<char>&);
template SurfaceMesh MakeSurfaceMesh(
  const CellMesh<3>&, const MeshTopology<3>&, const std::vector<char>&);
template std::vector<char> PointsBeside(
  const SurfaceMesh&, const CellMesh<2>&, const MeshTopology<2>&);
template std::vector<char> PointsBeside(
  const SurfaceMesh&, const CellMesh<3>&, const MeshTopology<3>&);
}
