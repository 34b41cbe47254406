// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFeatures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

TriangleMesh Mesh(
  const std::vector<std::array<double, 3>>& points, std::vector<std::array<int, 3>> cells)
{
  TriangleMesh mesh;
  mesh.Points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mesh.Points.row(static_cast<Eigen::Index>(i)) << points[i][0], points[i][1], points[i][2];
  }
  mesh.Triangles = std::move(cells);
  return mesh;
}

MeshFeatures Features(const TriangleMesh& mesh, const MeshFeatureParams& params = {})
{
  const auto surface = CheckSurface(mesh);
  EXPECT_TRUE(surface) << surface.Status.Message();
  auto features = FindMeshFeatures(surface.Value, params);
  EXPECT_TRUE(features) << features.Status.Message();
  return features.Value;
}

TriangleMesh Cube()
{
  return Mesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
                { 1, 1, 1 }, { 0, 1, 1 } },
    { { 0, 2, 1 }, { 0, 3, 2 }, { 4, 5, 6 }, { 4, 6, 7 }, { 0, 1, 5 }, { 0, 5, 4 }, { 1, 2, 6 },
      { 1, 6, 5 }, { 2, 3, 7 }, { 2, 7, 6 }, { 3, 0, 4 }, { 3, 4, 7 } });
}

/// Prism of a regular polygon about z, closed by fans.
TriangleMesh Prism(int sides)
{
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 3>> cells;
  for (int i = 0; i < 2 * sides; ++i)
  {
    const double angle = 2.0 * Pi * (i % sides) / sides;
    points.push_back({ std::cos(angle), std::sin(angle), i < sides ? 0.0 : 1.0 });
  }
  points.push_back({ 0, 0, 0 });
  points.push_back({ 0, 0, 1 });
  for (int i = 0; i < sides; ++i)
  {
    const int j = (i + 1) % sides;
    cells.push_back({ i, j, sides + j });
    cells.push_back({ i, sides + j, sides + i });
    cells.push_back({ 2 * sides, j, i });
    cells.push_back({ 2 * sides + 1, sides + i, sides + j });
  }
  return Mesh(points, cells);
}

/// Two sides that meet on the y axis; the normals' angle there changes from the first to the last.
TriangleMesh Roof(int steps, double first, double last)
{
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 3>> cells;
  for (int i = 0; i <= steps; ++i)
  {
    const double slope = 0.5 * (first + (last - first) * i / steps) * Pi / 180.0;
    const double y = 0.1 * i;
    points.push_back({ -std::cos(slope), y, -std::sin(slope) });
    points.push_back({ 0, y, 0 });
    points.push_back({ std::cos(slope), y, -std::sin(slope) });
  }
  for (int i = 0; i < steps; ++i)
  {
    for (int side = 0; side < 2; ++side)
    {
      const int a = 3 * i + side;
      cells.push_back({ a, a + 1, a + 4 });
      cells.push_back({ a, a + 4, a + 3 });
    }
  }
  return Mesh(points, cells);
}

/// Number of points of the longest chain that stays on the crease of a roof; 0: none.
std::size_t CreaseOfRoof(const MeshFeatures& features)
{
  std::size_t most = 0;
  for (const FeatureChain& chain : features.Chains)
  {
    const auto onCrease = [](int p) { return p % 3 == 1; };
    if (std::all_of(chain.Points.begin(), chain.Points.end(), onCrease))
    {
      most = std::max(most, chain.Points.size());
    }
  }
  return most;
}

TEST(MeshFeatures, CubeHasTwelveEdgesEightCornersSixFaces_ExactOracle)
{
  const MeshFeatures features = Features(Cube());
  EXPECT_EQ(features.Corners, (std::vector<int>{ 0, 1, 2, 3, 4, 5, 6, 7 }));
  EXPECT_EQ(features.Chains.size(), 12u);
  for (const FeatureChain& chain : features.Chains)
  {
    EXPECT_FALSE(chain.Closed);
    EXPECT_EQ(chain.Points.size(), 2u);
  }
  EXPECT_EQ(features.NumRegions, 6);
  EXPECT_EQ(features.Regions, (std::vector<int>{ 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5 }));
}

TEST(MeshFeatures, CylinderHasTwoClosedChains_ExactOracle)
{
  const MeshFeatures features = Features(Prism(40)); // 9 degrees between its sides
  EXPECT_TRUE(features.Corners.empty());
  ASSERT_EQ(features.Chains.size(), 2u);
  for (const FeatureChain& chain : features.Chains)
  {
    EXPECT_TRUE(chain.Closed);
    EXPECT_EQ(chain.Points.size(), 40u);
  }
  EXPECT_EQ(features.NumRegions, 3);
}

TEST(MeshFeatures, AnglesAtTheLimitsReachThem_ExactOracle)
{
  // The sides of a hexagon's prism meet at 60 degrees, and its rims turn by as much.
  MeshFeatureParams params;
  params.SharpAngle = 60.0;
  params.WeakAngle = 60.0;
  MeshFeatures features = Features(Prism(6), params);
  EXPECT_EQ(features.NumRegions, 8);
  EXPECT_EQ(features.Chains.size(), 18u);
  params.SharpAngle = 60.001;
  params.WeakAngle = 60.001;
  features = Features(Prism(6), params);
  EXPECT_EQ(features.NumRegions, 3);
  EXPECT_EQ(features.Corners.size(), 12u); // the rims still turn
  params.CornerAngle = 60.001;
  EXPECT_TRUE(Features(Prism(6), params).Corners.empty());
}

TEST(MeshFeatures, WeakEdgesContinueSharpOnes_ExactOracle)
{
  const TriangleMesh roof = Roof(30, 70.0, 10.0);
  MeshFeatureParams params;
  const std::size_t weak = CreaseOfRoof(Features(roof, params));
  params.WeakAngle = params.SharpAngle;
  const std::size_t sharp = CreaseOfRoof(Features(roof, params));
  // 40 and 20 degrees are reached after 15 and 25 of 30 steps; an edge's angle is that somewhere
  // along it.
  EXPECT_NEAR(static_cast<double>(sharp), 16.0, 1.0);
  EXPECT_NEAR(static_cast<double>(weak), 26.0, 1.0);
}

TEST(MeshFeatures, WeakEdgesAloneAreNone_ExactOracle)
{
  const TriangleMesh roof = Roof(10, 30.0, 30.0);
  EXPECT_EQ(CreaseOfRoof(Features(roof)), 0u);
  EXPECT_EQ(Features(roof).NumRegions, 1);
  MeshFeatureParams params;
  params.SharpAngle = 25.0;
  EXPECT_EQ(CreaseOfRoof(Features(roof, params)), 11u);
  EXPECT_EQ(Features(roof, params).NumRegions, 2);
}

TEST(MeshFeatures, RimsOfOpenSurfacesAreChains_ExactOracle)
{
  const MeshFeatures features = Features(Roof(10, 0.0, 0.0)); // a flat rectangle
  EXPECT_EQ(features.Corners, (std::vector<int>{ 0, 2, 30, 32 }));
  EXPECT_EQ(features.Chains.size(), 4u);
}

TEST(MeshFeatures, AnglesOutsideTheirRangesAreRefused)
{
  const auto surface = CheckSurface(Cube());
  ASSERT_TRUE(surface);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [&](double sharp, double weak, double corner, const char* name)
  {
    MeshFeatureParams params;
    params.SharpAngle = sharp;
    params.WeakAngle = weak;
    params.CornerAngle = corner;
    const auto result = FindMeshFeatures(surface.Value, params);
    EXPECT_EQ(result.Status.Code, ErrorCode::InvalidParameter) << name;
    EXPECT_EQ(result.Status.Detail.find(name), 0u) << result.Status.Message();
  };
  expect(0.0, 20.0, 60.0, "SharpAngle");
  expect(180.0, 20.0, 60.0, "SharpAngle");
  expect(nan, 20.0, 60.0, "SharpAngle");
  expect(40.0, 0.0, 60.0, "WeakAngle");
  expect(40.0, 41.0, 60.0, "WeakAngle");
  expect(40.0, 20.0, 0.0, "CornerAngle");
  expect(40.0, 20.0, 181.0, "CornerAngle");
}
}
}
