// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"

#include <gtest/gtest.h>
#include <limits>

namespace knotwork
{
namespace
{
TriangleMesh Mesh(std::vector<std::array<double, 3>> points, std::vector<std::array<int, 3>> cells)
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

void ExpectError(const TriangleMesh& mesh, ErrorCode code, const std::string& text)
{
  const auto result = CheckMesh(mesh);
  EXPECT_EQ(result.Status.Code, code) << result.Status.Message();
  EXPECT_NE(result.Status.Detail.find(text), std::string::npos) << result.Status.Message();
}

TEST(TriangleMesh, LoopsOfPlateKeepTrianglesOnTheLeft_ExactOracle)
{
  const MeshCase plate = PlateWithHoles(0.1);
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc) << disc.Status.Message();
  ASSERT_EQ(disc->Loops.size(), 3u);
  double total = 0.0;
  for (std::size_t l = 0; l < 3; ++l)
  {
    double area = 0.0;
    const auto& loop = disc->Loops[l];
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const Eigen::Vector3d a = disc->Point(loop[i]);
      const Eigen::Vector3d b = disc->Point(loop[(i + 1) % loop.size()]);
      area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    EXPECT_EQ(area > 0.0, l == 0) << l; // the outer loop is the longest one
    total += area;
  }
  EXPECT_NEAR(disc->Area, total, 1e-13); // Green; rounding of some hundred terms
}

TEST(TriangleMesh, FansAreClosedPathsOfEdges_PropertyOracle)
{
  const auto disc = CheckMesh(CylinderWithHoles(0.1).Mesh);
  ASSERT_TRUE(disc);
  std::size_t triangles = 0;
  for (std::size_t v = 0; v < disc->OnBoundary.size(); ++v)
  {
    const int degree = disc->FanStart[v + 1] - disc->FanStart[v];
    triangles += static_cast<std::size_t>(degree - (disc->OnBoundary[v] ? 1 : 0));
  }
  EXPECT_EQ(triangles, 3 * disc->Triangles.size());
}

TEST(TriangleMesh, TrianglesThatLookTheOtherWayAreTurned_PropertyOracle)
{
  MeshCase plate = PlateWithHoles(0.1);
  const auto truth = CheckMesh(plate.Mesh);
  for (std::size_t t : { 3u, 17u, 40u })
  {
    std::swap(plate.Mesh.Triangles[t][0], plate.Mesh.Triangles[t][1]);
  }
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  EXPECT_EQ(disc->Reversed, 3);
  EXPECT_EQ(disc->Loops, truth->Loops);
}

TEST(TriangleMesh, BadCoordinatesAndCornersAreNamed_ExactOracle)
{
  ExpectError({}, ErrorCode::EmptyInput, "no triangles");
  TriangleMesh mesh = PlateWithHoles(0.2).Mesh;
  TriangleMesh bad = mesh;
  bad.Points(5, 1) = std::numeric_limits<double>::quiet_NaN();
  bad.Points(9, 2) = std::numeric_limits<double>::infinity();
  ExpectError(bad, ErrorCode::NonFiniteInput, "2 points (5, 9)");
  bad = mesh;
  bad.Triangles[4][1] = 100000;
  ExpectError(bad, ErrorCode::InvalidTopology, "no points in 1 triangle (4)");
  bad = mesh;
  bad.Triangles[6][1] = bad.Triangles[6][0];
  ExpectError(bad, ErrorCode::InvalidTopology, "1 degenerate triangle (6)");
  bad = mesh;
  const auto& corners = bad.Triangles[8];
  bad.Points.row(corners[2]) = 0.5 * (bad.Points.row(corners[0]) + bad.Points.row(corners[1]));
  ExpectError(bad, ErrorCode::InvalidTopology, "degenerate triangle");
}

TEST(TriangleMesh, EdgeOfThreeTrianglesIsNamed_ExactOracle)
{
  ExpectError(Mesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 } },
                { { 0, 1, 2 }, { 1, 0, 3 }, { 0, 1, 4 } }),
    ErrorCode::InvalidTopology, "1 edges of more than two triangles (points 0-1)");
}

TEST(TriangleMesh, PinchedVertexIsNamed_ExactOracle)
{
  // two triangles joined by a strip, touching once more in point 2
  ExpectError(Mesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 1, 0 }, { 0, 2, 0 }, { 1, 2, 0 },
                     { 1, -1, 0 }, { 2, 3, 0 } },
                { { 0, 1, 2 }, { 2, 4, 3 }, { 0, 5, 1 }, { 1, 5, 6 }, { 1, 6, 4 }, { 4, 6, 3 } }),
    ErrorCode::InvalidTopology, "1 point (2)");
}

TEST(TriangleMesh, PointsOfNoTriangleAndComponentsCanBeDropped_ExactOracle)
{
  TriangleMesh mesh = PlateWithHoles(0.2).Mesh;
  const Eigen::Index n = mesh.Points.rows();
  mesh.Points.conservativeResize(n + 1, Eigen::NoChange);
  mesh.Points.row(n) << 9, 9, 9;
  ExpectError(
    mesh, ErrorCode::InvalidTopology, "1 point (" + std::to_string(n) + ") of no triangle");
  mesh.Points.conservativeResize(n + 3, Eigen::NoChange);
  mesh.Points.row(n + 1) << 10, 9, 9;
  mesh.Points.row(n + 2) << 9, 10, 9;
  const int first = static_cast<int>(n);
  mesh.Triangles.insert(mesh.Triangles.begin(), { first, first + 1, first + 2 });
  ExpectError(mesh, ErrorCode::InvalidTopology, "2 components");
  const auto disc = CheckMesh(mesh, true);
  ASSERT_TRUE(disc) << disc.Status.Message();
  EXPECT_EQ(disc->Components, 2);
  EXPECT_EQ(disc->Points.rows(), n);
  EXPECT_EQ(disc->TriangleIds.front(), 1);
  EXPECT_EQ(disc->PointIds.back(), n - 1);
}

TEST(TriangleMesh, ComponentsHangTogetherByEdges_ExactOracle)
{
  // triangles 0, 2 share the edge between (1, 0, 0) and (0, 1, 0), whose points are there twice;
  // triangle 4 touches triangle 2 in (1, 1, 0) alone; triangles 1, 3 have two equal corners
  const TriangleMesh mesh = Mesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 1, 1, 0 },
                                   { 0, 1, 0 }, { 2, 1, 0 }, { 2, 2, 0 } },
    { { 0, 1, 2 }, { 1, 1, 2 }, { 3, 4, 5 }, { 0, 1, 3 }, { 4, 6, 7 } });
  const auto components = ConnectedComponents(mesh);
  ASSERT_EQ(components.size(), 2u);
  EXPECT_EQ(components[0].TriangleIds, (std::vector<int>{ 0, 2 }));
  EXPECT_EQ(components[1].TriangleIds, (std::vector<int>{ 4 }));
  EXPECT_EQ(components[0].PointIds, (std::vector<int>{ 0, 1, 2, 4 }));
  EXPECT_EQ(components[1].PointIds, (std::vector<int>{ 4, 6, 7 }));
  const std::vector<std::array<int, 3>> joined = { { 0, 1, 2 }, { 1, 3, 2 } };
  EXPECT_EQ(components[0].Mesh.Triangles, joined);
  EXPECT_EQ(components[0].Mesh.Points.row(3), mesh.Points.row(4));
  for (const MeshComponent& component : components)
  {
    const auto surface = CheckComponent(mesh, component);
    ASSERT_TRUE(surface) << surface.Status.Message();
    EXPECT_EQ(surface->PointIds, component.PointIds);
    EXPECT_EQ(surface->TriangleIds, component.TriangleIds);
  }
  EXPECT_TRUE(ConnectedComponents(Mesh({ { 0, 0, 0 }, { 1, 0, 0 } }, { { 0, 1, 1 } })).empty());
}

TEST(TriangleMesh, ComponentsOfBadMeshesAreTheWhole_ExactOracle)
{
  TriangleMesh mesh = PlateWithHoles(0.2).Mesh;
  mesh.Points(5, 1) = std::numeric_limits<double>::quiet_NaN();
  auto components = ConnectedComponents(mesh);
  ASSERT_EQ(components.size(), 1u);
  EXPECT_EQ(components[0].Mesh.Triangles, mesh.Triangles);
  EXPECT_EQ(components[0].TriangleIds.back() + 1, static_cast<int>(mesh.Triangles.size()));
  EXPECT_EQ(CheckComponent(mesh, components[0]).Status.Code, ErrorCode::NonFiniteInput);
  mesh.Points(5, 1) = 0.0;
  mesh.Triangles[4][1] = -1;
  components = ConnectedComponents(mesh);
  ASSERT_EQ(components.size(), 1u);
  EXPECT_EQ(CheckComponent(mesh, components[0]).Status.Code, ErrorCode::InvalidTopology);
}

TEST(TriangleMesh, MessagesOfComponentsHaveTheNumbersOfTheWhole_ExactOracle)
{
  // a triangle, and three at the edge of points 3, 4
  const TriangleMesh mesh = Mesh({ { 9, 9, 9 }, { 8, 9, 9 }, { 9, 8, 9 }, { 0, 0, 0 }, { 1, 0, 0 },
                                   { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 } },
    { { 0, 1, 2 }, { 3, 4, 5 }, { 4, 3, 6 }, { 3, 4, 7 } });
  const auto components = ConnectedComponents(mesh);
  ASSERT_EQ(components.size(), 2u);
  EXPECT_TRUE(CheckComponent(mesh, components[0]));
  const auto bad = CheckComponent(mesh, components[1]);
  EXPECT_EQ(bad.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(bad.Status.Detail.find("(points 3-4)"), std::string::npos) << bad.Status.Message();
}

TEST(TriangleMesh, ClosedSurfaceIsRefused_ExactOracle)
{
  ExpectError(Mesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
                { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } }),
    ErrorCode::InvalidTopology, "closed");
}

/// Strip of quadrilaterals with its ends joined, the second one turned by `twists` half turns.
TriangleMesh Band(int twists)
{
  TriangleMesh mesh;
  const int n = 24;
  const double pi = std::acos(-1.0);
  mesh.Points.resize(2 * n, 3);
  for (int i = 0; i < n; ++i)
  {
    const double angle = 2.0 * pi * i / n;
    for (int k = 0; k < 2; ++k)
    {
      const double s = (k - 0.5) * 0.4;
      const double r = 1.0 + s * std::cos(0.5 * twists * angle);
      mesh.Points.row(2 * i + k) << r * std::cos(angle), r * std::sin(angle),
        s * std::sin(0.5 * twists * angle);
    }
  }
  for (int i = 0; i < n; ++i)
  {
    const int flip = i == n - 1 ? twists % 2 : 0;
    const int a = 2 * ((i + 1) % n) + flip;
    const int b = 2 * ((i + 1) % n) + 1 - flip;
    mesh.Triangles.push_back({ 2 * i, a, b });
    mesh.Triangles.push_back({ 2 * i, b, 2 * i + 1 });
  }
  return mesh;
}

TEST(TriangleMesh, SurfaceOfOneSideIsRefused_ExactOracle)
{
  ExpectError(Band(1), ErrorCode::InvalidTopology, "one side only");
  const auto ring = CheckMesh(Band(2)); // a ring twisted in space is a ring
  ASSERT_TRUE(ring) << ring.Status.Message();
  EXPECT_EQ(ring->Loops.size(), 2u);
}

TEST(TriangleMesh, HandlesAreCounted_ExactOracle)
{
  // a torus without one of its quadrilaterals
  const int n = 8;
  const double pi = std::acos(-1.0);
  TriangleMesh mesh;
  mesh.Points.resize(n * n, 3);
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      const double a = 2.0 * pi * i / n;
      const double b = 2.0 * pi * j / n;
      mesh.Points.row(i * n + j) << (2.0 + std::cos(b)) * std::cos(a),
        (2.0 + std::cos(b)) * std::sin(a), std::sin(b);
      if (i + j > 0)
      {
        const int right = ((i + 1) % n) * n + j;
        const int up = i * n + (j + 1) % n;
        const int both = ((i + 1) % n) * n + (j + 1) % n;
        mesh.Triangles.push_back({ i * n + j, right, both });
        mesh.Triangles.push_back({ i * n + j, both, up });
      }
    }
  }
  ExpectError(mesh, ErrorCode::InvalidTopology, "1 handle");
}
}
}
