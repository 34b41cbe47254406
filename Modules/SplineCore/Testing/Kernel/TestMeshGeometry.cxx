// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"
#include <knotwork/SplineCore/MeshGeometry.h>

#include <gtest/gtest.h>

#include <limits>
#include <set>

using namespace knotwork;
using namespace meshes;

namespace
{
/// Cells that are boxes of whole numbers: lower and upper corners.
template <int Dim>
struct Boxes
{
  CellMesh<Dim> Mesh;
  PointMatrix Points;

  explicit Boxes(const std::vector<std::array<std::array<int, Dim>, 2>>& boxes)
  {
    std::map<std::array<int, Dim>, int> numbers;
    for (const auto& box : boxes)
    {
      for (int corner = 0; corner < (1 << Dim); ++corner)
      {
        std::array<int, Dim> point;
        for (int d = 0; d < Dim; ++d)
        {
          point[d] = box[corner >> d & 1][d];
        }
        this->Mesh.Corners.push_back(
          numbers.emplace(point, static_cast<int>(numbers.size())).first->second);
      }
    }
    this->Mesh.NumPoints = static_cast<int>(numbers.size());
    this->Points.resize(this->Mesh.NumPoints, Dim);
    for (const auto& [point, number] : numbers)
    {
      for (int d = 0; d < Dim; ++d)
      {
        this->Points(number, d) = point[d];
      }
    }
  }
};

/// Four cells around a square, which is left whole, or cut into n by n.
Boxes<2> Ring(int n)
{
  std::vector<std::array<std::array<int, 2>, 2>> boxes;
  const int s = 12;
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      if (i != 1 || j != 1)
      {
        boxes.push_back({ { { i * s, j * s }, { i * s + s, j * s + s } } });
      }
    }
  }
  const int h = s / n;
  for (int k = 0; k < n * n; ++k)
  {
    const int x = s + k % n * h;
    const int y = s + k / n * h;
    boxes.push_back({ { { x, y }, { x + h, y + h } } });
  }
  return Boxes<2>(boxes);
}
}

TEST(MeshGeometry, HangingPointsAreNamed_ExactOracle)
{
  for (const int n : { 1, 2, 3, 4, 6 })
  {
    const Boxes<2> ring = Ring(n);
    EXPECT_EQ(CheckConforming<2>(ring.Mesh, ring.Points).Code,
      n == 1 ? ErrorCode::Ok : ErrorCode::InvalidTopology)
      << n;
  }
  // cell 1 is next to cells 2 and 3, whose point between is not its own
  const Boxes<2> three({ { { { 0, 0 }, { 1, 2 } } }, { { { 1, 0 }, { 3, 2 } } },
    { { { 3, 0 }, { 4, 1 } } }, { { { 3, 1 }, { 4, 2 } } } });
  const Status status = CheckConforming<2>(three.Mesh, three.Points);
  EXPECT_NE(status.Detail.find("lies on an edge of cell 1"), std::string::npos) << status.Detail;
  EXPECT_NE(status.Detail.find("of cell 2"), std::string::npos) << status.Detail;
  const Boxes<3> solid({ { { { 0, 0, 0 }, { 2, 2, 2 } } }, { { { 2, 0, 0 }, { 4, 1, 2 } } },
    { { { 2, 1, 0 }, { 4, 2, 2 } } } });
  EXPECT_EQ(CheckConforming<3>(solid.Mesh, solid.Points).Code, ErrorCode::InvalidTopology);
}

TEST(MeshGeometry, ConformingMeshesPass_PropertyOracle)
{
  // a grid whose points are moved: a point that is nearly on an edge elsewhere is no fault
  Random random(1);
  const CellMesh<3> grid = Grid<3>({ 4, 3, 3 });
  PointMatrix points(grid.NumPoints, 3);
  for (int i = 0; i < grid.NumPoints; ++i)
  {
    points.row(i) << i % 5, i / 5 % 4, i / 20;
  }
  EXPECT_TRUE(CheckConforming<3>(grid, points));
  for (Eigen::Index i = 0; i < points.size(); ++i)
  {
    points.data()[i] += random.In(-0.2, 0.2);
  }
  EXPECT_TRUE(CheckConforming<3>(grid, points));
}

TEST(MeshGeometry, LengthsAreMeansOfSheets_ExactOracle)
{
  const Boxes<2> boxes({ { { { 0, 0 }, { 1, 4 } } }, { { { 1, 0 }, { 4, 4 } } } });
  const auto topology = MeshTopology<2>::Make(boxes.Mesh);
  const auto lengths = MeanSheetLengths<2>(boxes.Mesh, topology.Value, boxes.Points);
  ASSERT_TRUE(lengths) << lengths.Status.Message();
  // edges of both cells: 1, 1, 3, 3 and four times 4; their mean is 3
  EXPECT_EQ(lengths.Value, (std::vector<double>{ 1.0 / 3.0, 4.0 / 3.0, 1.0 }));
}

TEST(MeshGeometry, SharpEdgesOfACubeAreThoseOfTheCube_ExactOracle)
{
  const CellMesh<2> mesh = CubeSphere(3);
  PointMatrix points = CubeSpherePoints(mesh, 3);
  for (auto row : points.rowwise())
  {
    row /= row.cwiseAbs().maxCoeff(); // back onto the cube
  }
  const auto topology = MeshTopology<2>::Make(mesh);
  const auto count = [&](double angle)
  {
    const auto sharp = SharpEdges(mesh, topology.Value, points, angle);
    EXPECT_TRUE(sharp) << sharp.Status.Message();
    return sharp->size();
  };
  EXPECT_EQ(count(89.999), 36U);
  EXPECT_EQ(count(90.001), 0U);
  EXPECT_EQ(count(1e-6), 36U);
  // a sheet that cannot be oriented has no edges sharper than it is bent: 360 degrees in 12 cells
  const CellMesh<2> strip = Twisted(12, 1, false);
  const PointMatrix ring = MoebiusPoints(strip, 12);
  const auto topologyOfStrip = MeshTopology<2>::Make(strip);
  EXPECT_FALSE(topologyOfStrip->IsOrientable);
  const auto sharp = SharpEdges(strip, topologyOfStrip.Value, ring, 40.0);
  ASSERT_TRUE(sharp) << sharp.Status.Message();
  EXPECT_TRUE(sharp->empty());
}

TEST(MeshGeometry, LabelsPartCells_ExactOracle)
{
  const auto topology = MeshTopology<2>::Make(Grid<2>({ 3, 2 }));
  const auto between = FacetsBetween<2>(topology.Value, { 0, 0, 1, 0, 2, 1 });
  ASSERT_TRUE(between) << between.Status.Message();
  std::set<std::array<int, 2>> found;
  for (const CellSide& facet : between.Value)
  {
    found.insert({ facet.Cell, facet.Side });
  }
  EXPECT_EQ(found, (std::set<std::array<int, 2>>{ { 1, 1 }, { 1, 3 }, { 3, 1 }, { 4, 1 } }));
}

TEST(MeshGeometry, PolygonsAreSplitAtTheirMiddles_ExactOracle)
{
  // a triangle and a quadrilateral with a common edge
  const auto split = SplitAtMidpoints(5, { { 0, 1, 2 }, { 1, 3, 4, 2 } });
  ASSERT_TRUE(split) << split.Status.Message();
  EXPECT_EQ(split->Mesh.NumCells(), 7);
  EXPECT_EQ(split->Mesh.NumPoints, 5 + 6 + 2);
  EXPECT_EQ(split->Polygon, (std::vector<int>{ 0, 0, 0, 1, 1, 1, 1 }));
  const auto topology = MeshTopology<2>::Make(split->Mesh);
  ASSERT_TRUE(topology) << topology.Status.Message();
  EXPECT_EQ(topology->NumInteriorFacets, 3 + 4 + 2);
  EXPECT_EQ(topology->NumBoundaryFacets, 10);
  std::size_t middles = 0;
  for (const std::vector<int>& points : split->Means)
  {
    middles += points.size() == 2 ? 1 : 0;
  }
  EXPECT_EQ(middles, 6U);
  EXPECT_EQ(split->Means[static_cast<std::size_t>(split->Mesh.Cell(0)[3] - 5)],
    (std::vector<int>{ 0, 1, 2 }));
}

TEST(MeshGeometry, EveryFailureIsReachable_ExactOracle)
{
  const CellMesh<2> grid = Grid<2>({ 1, 1 });
  const auto topology = MeshTopology<2>::Make(grid);
  PointMatrix points = PointMatrix::Zero(4, 3);
  EXPECT_EQ(CheckConforming<2>(grid, PointMatrix::Zero(3, 3)).Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(CheckConforming<2>(grid, PointMatrix::Zero(4, 4)).Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(
    MeanSheetLengths<2>(grid, topology.Value, points).Status.Code, ErrorCode::InvalidParameter);
  points(2, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(CheckConforming<2>(grid, points).Code, ErrorCode::NonFiniteInput);
  EXPECT_EQ(
    MeanSheetLengths<2>(grid, topology.Value, points).Status.Code, ErrorCode::NonFiniteInput);
  points(2, 1) = 0.0;
  EXPECT_EQ(
    SharpEdges(grid, topology.Value, points, 181.0).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(SharpEdges(grid, topology.Value, points.leftCols(2), 30.0).Status.Code,
    ErrorCode::SizeMismatch);
  EXPECT_EQ(
    SharpEdges(grid, topology.Value, points.topRows(3), 30.0).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(FacetsBetween<2>(topology.Value, {}).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(SplitAtMidpoints(3, {}).Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(SplitAtMidpoints(3, { { 0, 1 } }).Status.Code, ErrorCode::InvalidTopology);
  EXPECT_EQ(SplitAtMidpoints(3, { { 0, 1, 3 } }).Status.Code, ErrorCode::InvalidTopology);
  EXPECT_EQ(SplitAtMidpoints(std::numeric_limits<int>::max(), { { 0, 1, 2 } }).Status.Code,
    ErrorCode::TooLarge);
}
