// SPDX-License-Identifier: BSD-3-Clause
// Cells that lie flat on the surface, in a box of six tetrahedra around a diagonal and in one cell.
#include "FlatCorners.h"
#include "TetrahedronShapes.h"

#include <gtest/gtest.h>

using namespace knotwork;

namespace
{
/// A box 1 x 1 x height; its diagonal is its one edge inside.
Tetrahedra Box(double height)
{
  Tetrahedra box;
  box.Points.resize(8, 3);
  for (int i = 0; i < 8; ++i)
  {
    box.Points.row(i) << i % 2, i / 2 % 2, height * (i / 4);
  }
  box.Cells = { { 0, 1, 3, 7 }, { 0, 5, 1, 7 }, { 0, 3, 2, 7 }, { 0, 2, 6, 7 }, { 0, 4, 5, 7 },
    { 0, 6, 4, 7 } };
  box.Triangles = { { 0, 3, 1 }, { 1, 3, 7 }, { 0, 1, 5 }, { 5, 1, 7 }, { 0, 2, 3 }, { 3, 2, 7 },
    { 0, 6, 2 }, { 2, 6, 7 }, { 0, 5, 4 }, { 4, 5, 7 }, { 0, 4, 6 }, { 6, 4, 7 } };
  box.Sources = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11 };
  return box;
}

double VolumeOf(const Tetrahedra& mesh)
{
  return MeasureTetrahedra(mesh.Points, mesh.Cells).Volume;
}
}

TEST(FlatCorners, SteepOnesStay_ExactOracle)
{
  Tetrahedra cube = Box(1.0); // edges with unit vectors of volume 1 / sqrt(2)
  EXPECT_EQ(DivideFlatCorners(cube, 100), 0);
  EXPECT_EQ(cube.Cells, Box(1.0).Cells);
}

TEST(FlatCorners, TheEdgeInsideIsHalved_ExactOracle)
{
  Tetrahedra box = Box(0.2);
  EXPECT_EQ(DivideFlatCorners(box, 100), 1);
  ASSERT_EQ(box.Points.rows(), 9);
  EXPECT_EQ(box.Points.row(8), Eigen::RowVector3d(0.5, 0.5, 0.1));
  EXPECT_EQ(box.Cells.size(), 12u);
  EXPECT_NEAR(VolumeOf(box), 0.2, 1e-15); // sums of twelve products
  EXPECT_EQ(box.Triangles, Box(0.2).Triangles);
  for (const auto& cell : box.Cells)
  {
    Tetrahedra alone{ box.Points, { cell }, {}, {}, {} };
    EXPECT_GT(VolumeOf(alone), 0.0);
  }
}

TEST(FlatCorners, ACellWithNoEdgeInsideGetsAMiddle_ExactOracle)
{
  Tetrahedra cell;
  cell.Points.resize(4, 3);
  cell.Points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.3, 0.3, 0.1;
  cell.Cells = { { 0, 1, 2, 3 } };
  cell.Triangles = { { 1, 2, 3 }, { 0, 3, 2 }, { 0, 1, 3 }, { 0, 2, 1 } };
  EXPECT_EQ(DivideFlatCorners(cell, 100), 1);
  EXPECT_EQ(cell.Cells.size(), 4u);
  EXPECT_NEAR(VolumeOf(cell), 0.1 / 6.0, 1e-16);
}

TEST(FlatCorners, PointsHaveALimit_ExactOracle)
{
  Tetrahedra box = Box(0.2);
  EXPECT_EQ(DivideFlatCorners(box, 0), 0);
  EXPECT_EQ(box.Cells, Box(0.2).Cells);
}
