// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"

#include <gtest/gtest.h>

#include <set>

using namespace knotwork;
using namespace meshes;

namespace
{
template <int Dim>
MeshTopology<Dim> TopologyOf(const CellMesh<Dim>& mesh)
{
  auto made = MeshTopology<Dim>::Make(mesh);
  EXPECT_TRUE(made) << made.Status.Message();
  return std::move(made.Value);
}

template <int Dim>
std::set<int> PointsOfSide(const CellMesh<Dim>& mesh, int cell, int side)
{
  std::set<int> points;
  for (int corner = 0; corner < (1 << Dim); ++corner)
  {
    if ((corner >> (side / 2) & 1) == side % 2)
    {
      points.insert(mesh.Cell(cell)[corner]);
    }
  }
  return points;
}

/// Neighbours, crossings and opposites by comparing points of all cells with all.
template <int Dim>
void ExpectTopologyByPoints(const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology)
{
  std::map<std::set<int>, std::vector<CellSide>> facets;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int side = 0; side < 2 * Dim; ++side)
    {
      facets[PointsOfSide(mesh, c, side)].push_back({ c, side });
    }
  }
  const auto intersection = [](const std::set<int>& a, const std::set<int>& b)
  {
    std::set<int> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(both, both.end()));
    return both;
  };
  std::int64_t inside = 0;
  for (const auto& [points, sides] : facets)
  {
    if (sides.size() == 1)
    {
      EXPECT_TRUE(topology.IsBoundary(sides[0].Cell, sides[0].Side));
      continue;
    }
    ++inside;
    for (std::size_t i = 0; i < 2; ++i)
    {
      const auto [c, side] = sides[i];
      ASSERT_EQ(topology.Neighbour(c, side), sides[1 - i].Cell);
      const auto& crossing = topology.Crossing(c, side);
      ASSERT_EQ(crossing.Side, sides[1 - i].Side);
      EXPECT_EQ(crossing.Image[static_cast<std::size_t>(side)], crossing.Side ^ 1);
      for (int across = 0; across < 2 * Dim; ++across)
      {
        if (across / 2 == side / 2)
        {
          continue;
        }
        const auto ridge = intersection(points, PointsOfSide(mesh, c, across));
        const int image = crossing.Image[static_cast<std::size_t>(across)];
        EXPECT_EQ(intersection(points, PointsOfSide(mesh, sides[1 - i].Cell, image)), ridge);
      }
    }
  }
  EXPECT_EQ(topology.NumInteriorFacets, inside);
  EXPECT_EQ(topology.NumBoundaryFacets, static_cast<std::int64_t>(facets.size()) - inside);

  // cells around a ridge: those that have all its points
  std::set<std::set<int>> extraordinary;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int ridge = 0; ridge < MeshTopology<Dim>::NumRidges; ++ridge)
    {
      const auto [first, second] = MeshTopology<Dim>::SidesOf(ridge);
      ASSERT_EQ(MeshTopology<Dim>::RidgeOf(first, second), ridge);
      const auto points = intersection(PointsOfSide(mesh, c, first), PointsOfSide(mesh, c, second));
      std::size_t numFacets = 0; // that have the ridge
      std::size_t numInside = 0;
      std::set<int> cells;
      for (const auto& [ofFacet, sides] : facets)
      {
        if (intersection(ofFacet, points).size() == points.size())
        {
          ++numFacets;
          numInside += sides.size() - 1;
          for (const CellSide& side : sides)
          {
            cells.insert(side.Cell);
          }
        }
      }
      const bool isInside = numInside == numFacets;
      const bool isRegular = isInside ? cells.size() == 4 : cells.size() <= 2;
      EXPECT_EQ(topology.IsExtraordinary(c, ridge), !isRegular);
      EXPECT_EQ(topology.IsRegularInside(c, ridge), isInside && isRegular);
      if (!isRegular)
      {
        extraordinary.insert(points);
      }
      std::set<int> around;
      EXPECT_EQ(
        topology.Around(c, ridge, [&](int cell, int, int) { around.insert(cell); }), isInside);
      EXPECT_EQ(around, cells);
      if (isInside && isRegular)
      {
        const CellSide opposite = topology.Opposite(c, first, second);
        EXPECT_NE(opposite.Cell, c);
        EXPECT_NE(opposite.Cell, topology.Neighbour(c, first));
        const int next = topology.Neighbour(opposite.Cell, opposite.Side);
        EXPECT_NE(next, c);
        EXPECT_NE(next, topology.Neighbour(c, first));
        EXPECT_EQ(intersection(PointsOfSide(mesh, opposite.Cell, opposite.Side), points), points);
      }
    }
  }
  EXPECT_EQ(topology.NumExtraordinaryRidges, static_cast<std::int64_t>(extraordinary.size()));
}

template <int Dim>
void ExpectRefused(const CellMesh<Dim>& mesh, ErrorCode code, const std::string& words)
{
  const auto made = MeshTopology<Dim>::Make(mesh);
  EXPECT_EQ(made.Status.Code, code);
  EXPECT_NE(made.Status.Detail.find(words), std::string::npos) << made.Status.Message();
}
}

TEST(CellMesh, RandomMeshesHangTogetherByTheirPoints_IndependentOracle)
{
  for (unsigned seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto quads = RandomMesh<2>(random, 60);
    ExpectTopologyByPoints(quads, TopologyOf(quads));
    const auto hexes = RandomMesh<3>(random, 30);
    ExpectTopologyByPoints(hexes, TopologyOf(hexes));
  }
}

TEST(CellMesh, KnownMeshes_ExactOracle)
{
  const auto grid = TopologyOf(Grid<2>({ 4, 3 }));
  EXPECT_EQ(grid.NumInteriorFacets, 3 * 3 + 4 * 2);
  EXPECT_EQ(grid.NumBoundaryFacets, 14);
  EXPECT_EQ(grid.NumExtraordinaryRidges, 0);
  EXPECT_EQ(grid.FindSheets().Count, 7);
  EXPECT_EQ(TopologyOf(Grid<3>({ 2, 3, 4 })).FindSheets().Count, 9);
  EXPECT_EQ(TopologyOf(Grid<2>({ 3, 3 }, { true, true })).NumBoundaryFacets, 0);
  for (const int valence : { 3, 5, 64 })
  {
    const auto star = TopologyOf(Star(valence, 2));
    EXPECT_EQ(star.NumExtraordinaryRidges, 1);
    EXPECT_EQ(star.FindSheets().Count, 2 * valence);
  }
  const auto sphere = TopologyOf(CubeSphere(3));
  EXPECT_EQ(sphere.NumExtraordinaryRidges, 8);
  EXPECT_EQ(sphere.FindSheets().Count, 9);
  EXPECT_TRUE(sphere.IsOrientable);
  // the inner edges of the ball of 7 blocks have 3 cells, like the edges from its corners outward
  EXPECT_EQ(TopologyOf(Blocks<3>(1, 1)).NumExtraordinaryRidges, 12 + 8);
  EXPECT_EQ(TopologyOf(Blocks<2>(3, 2)).NumExtraordinaryRidges, 4);
  // a strip of one cell's width that closes with a twist: the edges across are one sheet
  const auto moebius = TopologyOf(Twisted(5, 1, false));
  EXPECT_FALSE(moebius.IsOrientable);
  EXPECT_EQ(moebius.NumBoundaryFacets, 10);
  EXPECT_EQ(moebius.FindSheets().Count, 6);
  const auto klein = TopologyOf(Twisted(4, 3, true));
  EXPECT_FALSE(klein.IsOrientable);
  EXPECT_EQ(klein.NumBoundaryFacets, 0);
  // two triangles that are cut into three cells each: 2 centres, 9 halves of edges, 5 of them
  // shared
  Random random(1);
  const auto cut = TopologyOf(CutSimplices<2>(random, { 1, 1 }, 1.0));
  EXPECT_EQ(cut.NumCells(), 6);
  EXPECT_EQ(cut.NumBoundaryFacets, 8);
  EXPECT_EQ(cut.NumInteriorFacets, 8);
}

TEST(CellMesh, EveryFailureNamesTheCells_ExactOracle)
{
  ExpectRefused<2>({}, ErrorCode::EmptyInput, "no cells");
  ExpectRefused<2>({ 3, { 0, 1, 2 } }, ErrorCode::SizeMismatch, "3 corners");
  ExpectRefused<2>({ 4, { 0, 1, 2, 4 } }, ErrorCode::InvalidTopology, "cell 0 has point 4 of 4");
  ExpectRefused<2>({ 4, { 0, 1, 2, 1 } }, ErrorCode::InvalidTopology, "cell 0 has point 1 twice");
  ExpectRefused<2>({ 5, { 0, 1, 2, 3 } }, ErrorCode::InvalidTopology, "point 4 belongs to no cell");
  ExpectRefused<2>(
    { 4, { 0, 1, 2, 3, 3, 2, 1, 0 } }, ErrorCode::InvalidTopology, "cells 0 and 1 have the same");
  ExpectRefused<2>({ 8, { 0, 1, 2, 3, 1, 4, 3, 5, 3, 1, 6, 7 } }, ErrorCode::InvalidTopology,
    "cells 0, 1 and 2 have one edge");
  // 1 is between the two cells alone
  ExpectRefused<2>(
    { 5, { 0, 1, 3, 2, 0, 4, 1, 2 } }, ErrorCode::InvalidTopology, "cells 0 and 1 have two");
  ExpectRefused<2>(
    { 7, { 0, 1, 2, 3, 3, 4, 5, 6 } }, ErrorCode::InvalidTopology, "cells 0 and 1 meet at a point");
  ExpectRefused<2>({ 6, { 0, 1, 2, 3, 1, 4, 3, 5 } }, ErrorCode::Ok, "");
  ExpectRefused<2>(
    { 6, { 0, 1, 2, 3, 4, 1, 5, 3 } }, ErrorCode::InvalidTopology, "cells 0 and 1 are inverted");
  const CellMesh<3> two = Grid<3>({ 2, 1, 1 });
  CellMesh<3> other = two;
  std::swap(other.Corners[8], other.Corners[10]); // the common face, crossed
  ExpectRefused(other, ErrorCode::InvalidTopology, "cells 0 and 1 have the corners of a common");
  other = two;
  for (int i = 8; i < 16; i += 2)
  {
    std::swap(other.Corners[i], other.Corners[i + 1]);
  }
  ExpectRefused(other, ErrorCode::InvalidTopology, "cells 0 and 1 are inverted");
  // cells of a grid of 2 x 2 x 2 at opposite ends of a diagonal
  const CellMesh<3> grid = Grid<3>({ 2, 2, 2 });
  const auto pick = [&](std::initializer_list<int> cells)
  {
    Maker<3> maker;
    for (const int c : cells)
    {
      for (int corner = 0; corner < 8; ++corner)
      {
        maker.AddCorner({ grid.Cell(c)[corner] });
      }
    }
    return maker.Done();
  };
  ExpectRefused(pick({ 0, 7 }), ErrorCode::InvalidTopology, "cells 0 and 1 meet at point");
  ExpectRefused(pick({ 0, 3 }), ErrorCode::InvalidTopology, "cells 0 and 1 meet at an edge");
  CellMesh<3> ring; // a grid closed with a reflection: right-handed cells cannot all be
  {
    Maker<3> maker;
    for (int c = 0; c < 3; ++c)
    {
      for (int corner = 0; corner < 8; ++corner)
      {
        const int i = c + (corner & 1);
        const int j = corner >> 1 & 1;
        maker.AddCorner({ i % 3, i == 3 ? 1 - j : j, corner >> 2 });
      }
    }
    ring = maker.Done();
  }
  ExpectRefused(ring, ErrorCode::InvalidTopology, "cannot be oriented");
}

TEST(CellMesh, MeshesOfFiles_PropertyOracle)
{
  bool any = false;
  for (const char* name : { "bl_rod_764.off", "gs_bitorus.off", "gs_polycube.off" })
  {
    const auto mesh = ReadMesh<2>(name);
    any = any || !mesh.Corners.empty();
    if (!mesh.Corners.empty())
    {
      SCOPED_TRACE(name);
      ExpectTopologyByPoints(mesh, TopologyOf(mesh));
    }
  }
  if (!any)
  {
    GTEST_SKIP() << "KNOTWORK_UNSTRUCTURED_MESHES names no folder of meshes";
  }
}
