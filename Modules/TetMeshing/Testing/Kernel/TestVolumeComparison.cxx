// SPDX-License-Identifier: BSD-3-Clause
// A cube whose distances from a larger cube are known, and facets that are shared or not.
#include <knotwork/CADFitting/MeshTarget.h>
#include <knotwork/TetMeshing/VolumeComparison.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

using namespace knotwork;

namespace
{
/// n x 1 x 1 unit hexahedra, of which a coordinate may be curved.
struct Bar
{
  BernsteinCells Cells;
  std::vector<int> Corners;
};

Bar MakeBar(int count)
{
  Bar bar;
  bar.Cells.NumComponents = 3;
  for (int cell = 0; cell < count; ++cell)
  {
    const int number = bar.Cells.Add(CellShape::Hexahedron, { 1, 1, 1 });
    double* const block = bar.Cells.Block(number);
    for (int corner = 0; corner < 8; ++corner)
    {
      block[corner] = cell + corner % 2;
      block[8 + corner] = corner / 2 % 2;
      block[16 + corner] = corner / 4;
      bar.Corners.push_back(4 * (cell + corner % 2) + corner / 2);
    }
  }
  return bar;
}
}

TEST(VolumeComparison, SharedFacetsAreNoBoundary_ExactOracle)
{
  for (const int count : { 1, 3 })
  {
    const Bar bar = MakeBar(count);
    const auto boundary = TriangulateFacets(bar.Cells, bar.Corners, 1e-3);
    ASSERT_TRUE(boundary) << boundary.Status.Message();
    EXPECT_TRUE(boundary->Closed);
    EXPECT_NEAR(boundary->Area, 2.0 + 4.0 * count, 1e-12);
    EXPECT_NEAR(boundary->Volume, count, 1e-12);
    EXPECT_NEAR(boundary->Bound, 0.0, 1e-15);
    // Euler's formula of a sphere: points = 2 + triangles / 2
    EXPECT_EQ(boundary->Mesh.Points.rows() * 2,
      4 + static_cast<Eigen::Index>(boundary->Mesh.Triangles.size()));
  }
}

TEST(VolumeComparison, CubeInACube_ExactOracle)
{
  const Bar bar = MakeBar(1);
  const auto boundary = TriangulateFacets(bar.Cells, bar.Corners, 1e-3);
  ASSERT_TRUE(boundary);
  // the reference is larger by a tenth on every side
  TriangleMesh larger = boundary->Mesh;
  larger.Points = ((larger.Points.array() - 0.5) * 1.2 + 0.5).matrix();
  const auto target = MakeMeshTarget(larger);
  ASSERT_TRUE(target);
  const auto compared = CompareVolume(bar.Cells, boundary.Value, *target.Value, larger);
  ASSERT_TRUE(compared) << compared.Status.Message();
  EXPECT_NEAR(compared->ToReference, 0.1, 1e-12);
  EXPECT_NEAR(compared->FromReference, 0.1 * std::sqrt(3.0), 1e-12); // at the corners
  EXPECT_NEAR(compared->Measures.Total.Measure, 1.0, 1e-12);
  EXPECT_EQ(compared->Certificate.NumValid, 1);
  EXPECT_LE(compared->Measures.Cells[0].ScaledLower, 1.0);
  EXPECT_GE(compared->Measures.Cells[0].ScaledLower, 0.99);
}

TEST(VolumeComparison, HistogramsCountEveryCell_PropertyOracle)
{
  CellMeasures measures;
  for (const double value : { -1.0, -0.25, 0.3, 1.0 })
  {
    measures.Cells.emplace_back();
    measures.Cells.back().ScaledMin = value;
    measures.Cells.back().ScaledLower = std::max(-1.0, value - 0.5);
  }
  const QualityHistogram histogram = MakeHistogram(measures, 4);
  EXPECT_EQ(histogram.Edges, (std::vector<double>{ -1.0, -0.5, 0.0, 0.5, 1.0 }));
  EXPECT_EQ(histogram.Attained, (std::vector<int>{ 1, 1, 1, 1 }));
  EXPECT_EQ(histogram.Guaranteed, (std::vector<int>{ 2, 1, 0, 1 }));
}

TEST(VolumeComparison, EveryFailureIsReachable)
{
  Bar bar = MakeBar(1);
  const Bar twice = MakeBar(2);
  std::vector<int> corners = bar.Corners;
  corners.pop_back();
  EXPECT_EQ(TriangulateFacets(bar.Cells, corners, 1e-3).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(TriangulateFacets({}, {}, 1e-3).Status.Code, ErrorCode::EmptyInput);
  BernsteinCells thrice = MakeBar(3).Cells;
  std::vector<int> same;
  for (int i = 0; i < 3; ++i)
  {
    same.insert(same.end(), bar.Corners.begin(), bar.Corners.end());
  }
  EXPECT_EQ(TriangulateFacets(thrice, same, 1e-3).Status.Code, ErrorCode::InvalidTopology);
  bar.Cells.Add(CellShape::Triangle, { 1, 1, 0 });
  EXPECT_EQ(
    TriangulateFacets(bar.Cells, bar.Corners, 1e-3).Status.Code, ErrorCode::DimensionMismatch);
}
