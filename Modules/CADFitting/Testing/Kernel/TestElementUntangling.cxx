// SPDX-License-Identifier: BSD-3-Clause
// Points inside are pushed through the elements around them: what comes back is the straight
// elements, which are the minimum.
#include "ElementUntangling.h"
#include "FitCases.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace knotwork;

namespace
{
constexpr int Across = 3;

/// A cube of side 1 as hexahedra, or each of these as six tetrahedra.
StraightElements Cube(CellShape shape)
{
  StraightElements cube;
  const int n = Across + 1;
  cube.Points.resize(n * n * n, 3);
  for (int i = 0; i < n * n * n; ++i)
  {
    cube.Points.row(i) << i % n, i / n % n, i / n / n;
  }
  cube.Points /= Across;
  for (int i = 0; i < Across * Across * Across; ++i)
  {
    const int low = i % Across + n * (i / Across % Across + n * (i / Across / Across));
    std::array<int, 8> corners{};
    for (int k = 0; k < 8; ++k)
    {
      corners[static_cast<std::size_t>(k)] = low + k % 2 + n * (k / 2 % 2) + n * n * (k / 4);
    }
    if (shape == CellShape::Hexahedron)
    {
      cube.Add(shape, { corners.begin(), corners.end() });
      continue;
    }
    for (const auto& [a, b] :
      { std::array<std::size_t, 2>{ 1, 3 }, { 5, 1 }, { 3, 2 }, { 2, 6 }, { 4, 5 }, { 6, 4 } })
    {
      cube.Add(shape, { corners[0], corners[a], corners[b], corners[7] });
    }
  }
  return cube;
}

/// Points of straight elements of an order: places of the lattice on all edges, faces and insides.
PointMatrix StraightPoints(const NodeLattice& lattice, const PointMatrix& corners)
{
  PointMatrix points = PointMatrix::Zero(lattice.NumNodes(), 3);
  points.topRows(lattice.NumCorners) = corners;
  for (int edge = 0; edge < static_cast<int>(lattice.Edges.size()); ++edge)
  {
    const auto& [a, b] = lattice.Edges[static_cast<std::size_t>(edge)];
    for (int k = 1; k < lattice.Order; ++k)
    {
      const double t = static_cast<double>(k) / lattice.Order;
      points.row(lattice.EdgeNode(edge, k)) = (1.0 - t) * corners.row(a) + t * corners.row(b);
    }
  }
  for (int e = 0; e < lattice.NumElements(); ++e)
  {
    const auto index = static_cast<std::size_t>(e);
    const int* nodes = lattice.Nodes.data() + lattice.Begin[index];
    const auto count = static_cast<int>(lattice.Begin[index + 1] - lattice.Begin[index]);
    for (int i = 0; i < count; ++i)
    {
      if (lattice.Shapes[index] == CellShape::Hexahedron) // of order 2: 3 x 3 x 3 places
      {
        const Eigen::RowVector3d low = corners.row(nodes[0]);
        const Eigen::RowVector3d size = corners.row(nodes[count - 1]) - low;
        points.row(nodes[i]) =
          low + 0.5 * Eigen::RowVector3d(i % 3, i / 3 % 3, i / 9).cwiseProduct(size);
      }
    }
  }
  return points;
}

void ExpectRecovered(CellShape shape)
{
  const StraightElements cube = Cube(shape);
  const NodeLattice lattice(cube, 2);
  const PointMatrix straight = StraightPoints(lattice, cube.Points);
  std::vector<char> isFree;
  for (const auto& point : straight.rowwise())
  {
    isFree.push_back(point.minCoeff() > 1e-9 && point.maxCoeff() < 1.0 - 1e-9 ? 1 : 0);
  }
  PointMatrix points = straight;
  const double size = 1.0 / Across;
  const int n = Across + 1;
  const int inner = 1 + n + n * n; // a corner inside, moved by more than an element
  points.row(inner) += Eigen::RowVector3d(1.4, 1.2, 0.3) * size;
  double least = 1.0;
  std::vector<int> all;
  for (int e = 0; e < lattice.NumElements(); ++e)
  {
    all.push_back(e);
    least = std::min(least, CornerDeterminant(lattice, points, e));
  }
  ASSERT_LT(least, 0.0);
  ASSERT_TRUE(UntangleInside(lattice, all, straight, isFree, 0, {}, points));
  EXPECT_LT((points - straight).cwiseAbs().maxCoeff(), 0.02 * size); // of the stopping rule
  for (std::size_t i = 0; i < isFree.size(); ++i)
  {
    if (isFree[i] == 0)
    {
      const auto row = static_cast<Eigen::Index>(i);
      EXPECT_EQ(points.row(row), straight.row(row));
    }
  }
}
}

TEST(ElementUntangling, TetrahedraUnfold_ExactOracle)
{
  ExpectRecovered(CellShape::Tetrahedron);
}

TEST(ElementUntangling, HexahedraUnfold_ExactOracle)
{
  ExpectRecovered(CellShape::Hexahedron);
}

TEST(ElementUntangling, Stops)
{
  const StraightElements cube = Cube(CellShape::Tetrahedron);
  const NodeLattice lattice(cube, 2);
  PointMatrix points = StraightPoints(lattice, cube.Points);
  const PointMatrix straight = points;
  const std::vector<char> isFree(static_cast<std::size_t>(points.rows()), 1);
  points.row(21) *= 2.0;
  EXPECT_EQ(UntangleInside(
              lattice, { 0, 1, 2 }, straight, isFree, 1, [](double) { return false; }, points)
              .Code,
    ErrorCode::Aborted);
}
