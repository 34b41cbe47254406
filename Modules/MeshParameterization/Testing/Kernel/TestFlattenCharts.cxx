// SPDX-License-Identifier: BSD-3-Clause
#include "ClosedCases.h"
#include "CutMesh.h"
#include "FlattenReport.h"
#include "MeshCases.h"
#include "PlaneLoops.h"

#include <Eigen/Geometry>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <sstream>

namespace knotwork
{
namespace
{
double Area(const PointMatrix& points, const std::array<int, 3>& corners)
{
  const Eigen::RowVector3d a = points.row(corners[0]);
  const Eigen::RowVector3d b = points.row(corners[1]) - a;
  const Eigen::RowVector3d c = points.row(corners[2]) - a;
  return 0.5 * b.cross(c).norm();
}

/// Number of triangles that run along each edge; the first point is the lower one.
std::map<std::array<int, 2>, int> CountEdges(const std::vector<std::array<int, 3>>& triangles)
{
  std::map<std::array<int, 2>, int> count;
  for (const auto& corners : triangles)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int a = corners[k];
      const int b = corners[(k + 1) % 3];
      ++count[{ std::min(a, b), std::max(a, b) }];
    }
  }
  return count;
}

double BoundaryLength(const PointMatrix& points, const std::vector<std::array<int, 3>>& triangles)
{
  double length = 0.0;
  for (const auto& [edge, count] : CountEdges(triangles))
  {
    EXPECT_LE(count, 2);
    length += count == 1 ? (points.row(edge[0]) - points.row(edge[1])).norm() : 0.0;
  }
  return length;
}

int EulerCharacteristic(const std::vector<std::array<int, 3>>& triangles)
{
  std::set<int> used;
  for (const auto& corners : triangles)
  {
    used.insert(corners.begin(), corners.end());
  }
  return static_cast<int>(used.size()) - static_cast<int>(CountEdges(triangles).size()) +
    static_cast<int>(triangles.size());
}

/// Inner loops along the boundary of the whole surface.
int InnerLoops(const ChartedMesh& charted)
{
  const std::map<std::array<int, 2>, int> all = CountEdges(charted.Triangles);
  int loops = 0;
  for (const MeshParameterization& chart : charted.Charts)
  {
    for (std::size_t l = 1; l < chart.Mesh.Loops.size(); ++l)
    {
      const auto& loop = chart.Mesh.Loops[l];
      bool outside = true;
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        const int a = chart.Mesh.PointIds[static_cast<std::size_t>(loop[i])];
        const int b = chart.Mesh.PointIds[static_cast<std::size_t>(loop[(i + 1) % loop.size()])];
        outside = outside && all.at({ std::min(a, b), std::max(a, b) }) == 1;
      }
      loops += outside ? 1 : 0;
    }
  }
  return loops;
}

/// Edges between charts.
std::vector<std::array<int, 2>> Borders(const ChartedMesh& charted)
{
  std::map<std::array<int, 2>, int> all = CountEdges(charted.Triangles);
  std::vector<std::array<int, 2>> borders;
  for (const MeshParameterization& chart : charted.Charts)
  {
    std::vector<std::array<int, 3>> triangles;
    for (int t : chart.Mesh.TriangleIds)
    {
      triangles.push_back(charted.Triangles[static_cast<std::size_t>(t)]);
    }
    for (const auto& [edge, count] : CountEdges(triangles))
    {
      if (count == 1 && all.at(edge) == 2)
      {
        all.at(edge) = 0; // once
        borders.push_back(edge);
      }
    }
  }
  return borders;
}

void ExpectSameSurface(const TriangleMesh& mesh, const ChartedMesh& charted)
{
  ASSERT_EQ(charted.TriangleIds.size(), charted.Triangles.size());
  ASSERT_EQ(static_cast<Eigen::Index>(charted.Origins.size()), charted.Points.rows());
  const double size = (mesh.Points.colwise().maxCoeff() - mesh.Points.colwise().minCoeff()).norm();
  for (std::size_t i = 0; i < charted.Origins.size(); ++i)
  {
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k)
    {
      if (charted.Origins[i].Points[k] >= 0)
      {
        mean += charted.Origins[i].Weights[k] * mesh.Points.row(charted.Origins[i].Points[k]);
      }
    }
    // rounding of some linear interpolations
    EXPECT_LE((mean - charted.Points.row(static_cast<Eigen::Index>(i))).norm(), 1e-14 * size);
  }
  std::vector<double> areas(mesh.Triangles.size(), 0.0);
  for (std::size_t t = 0; t < charted.Triangles.size(); ++t)
  {
    areas[static_cast<std::size_t>(charted.TriangleIds[t])] +=
      Area(charted.Points, charted.Triangles[t]);
  }
  for (std::size_t t = 0; t < areas.size(); ++t)
  {
    EXPECT_NEAR(areas[t], Area(mesh.Points, mesh.Triangles[t]), 1e-13 * size * size);
  }
  EXPECT_EQ(EulerCharacteristic(charted.Triangles), EulerCharacteristic(mesh.Triangles));
  const double length = BoundaryLength(mesh.Points, mesh.Triangles);
  EXPECT_NEAR(BoundaryLength(charted.Points, charted.Triangles), length, 1e-12 * (length + size));
}

void ExpectGoodCharts(const ChartedMesh& charted, double limit)
{
  EXPECT_TRUE(charted.WithinLimit);
  std::vector<int> uses(charted.Triangles.size(), 0);
  for (const MeshParameterization& chart : charted.Charts)
  {
    TriangleMesh alone;
    alone.Points = chart.Mesh.Points;
    alone.Triangles = chart.Mesh.Triangles;
    const auto disc = CheckMesh(alone);
    ASSERT_TRUE(disc) << disc.Status.Message();
    EXPECT_EQ(disc->Reversed, 0);
    ASSERT_EQ(chart.Mesh.TriangleIds.size(), chart.Mesh.Triangles.size());
    for (std::size_t t = 0; t < chart.Mesh.Triangles.size(); ++t)
    {
      const auto whole = static_cast<std::size_t>(chart.Mesh.TriangleIds[t]);
      ++uses[whole];
      for (std::size_t k = 0; k < 3; ++k)
      {
        const auto c = static_cast<std::size_t>(chart.Mesh.Triangles[t][k]);
        EXPECT_EQ(chart.Mesh.PointIds[c], charted.Triangles[whole][k]);
      }
    }
    EXPECT_EQ(CountFlips(chart.Mesh, chart.UV), 0);
    EXPECT_LE(LargestStretch(chart.Mesh, chart.UV), limit * (1.0 + 1e-9)); // rounding on cut edges
    EXPECT_FALSE(FindCrossing(chart.Mesh, chart.UV));
    EXPECT_EQ(std::set<int>(chart.Mesh.PointIds.begin(), chart.Mesh.PointIds.end()).size(),
      chart.Mesh.PointIds.size()); // no chart touches itself
  }
  EXPECT_EQ(std::set<int>(uses.begin(), uses.end()), std::set<int>{ 1 });
}

ChartedMesh Flatten(const TriangleMesh& mesh, double limit)
{
  ChartParams params;
  params.MaxStretch = limit;
  auto result = FlattenCharts(mesh, {}, params);
  EXPECT_TRUE(result) << result.Status.Message();
  if (result)
  {
    ExpectSameSurface(mesh, result.Value);
    ExpectGoodCharts(result.Value, limit);
  }
  return std::move(result.Value);
}

TEST(FlattenCharts, SphereIsTwoHalves_ExactOracle)
{
  const ChartedMesh charted = Flatten(Sphere(20), 3.0);
  EXPECT_EQ(charted.Charts.size(), 2u);
  double length = 0.0;
  for (const auto& edge : Borders(charted))
  {
    length += (charted.Points.row(edge[0]) - charted.Points.row(edge[1])).norm();
  }
  EXPECT_NEAR(length, 2.0 * std::acos(-1.0), 0.03 * length); // a great circle
}

TEST(FlattenCharts, ClosedSurfacesGetDiscsWithinTheLimit_PropertyOracle)
{
  for (const double limit : { 3.0, 1.3 })
  {
    EXPECT_GE(Flatten(Sphere(12), limit).Charts.size(), 2u);
    EXPECT_GE(Flatten(Torus(14), limit).Charts.size(), 2u);
    EXPECT_GE(Flatten(Cube(3), limit).Charts.size(), 2u);
  }
}

TEST(FlattenCharts, CubeIsCutAlongItsEdges_ExactOracle)
{
  const TriangleMesh cube = Cube(6);
  for (const double limit : { 3.0, 1.1 })
  {
    const ChartedMesh charted = Flatten(cube, limit);
    EXPECT_LE(charted.Charts.size(), 6u);
    EXPECT_EQ(charted.Points.rows(), cube.Points.rows());
    for (const auto& edge : Borders(charted))
    {
      int straight = 0; // coordinates that stay at 0 or 6
      for (int d = 0; d < 3; ++d)
      {
        const double x = charted.Points(edge[0], d);
        straight += x == charted.Points(edge[1], d) && (x == 0.0 || x == 6.0) ? 1 : 0;
      }
      EXPECT_EQ(straight, 2);
    }
  }
}

TEST(FlattenCharts, WindowsStayWhole_ExactOracle)
{
  const TriangleMesh fuselage = Fuselage(7.0, 7);
  const auto surface = CheckSurface(fuselage);
  ASSERT_TRUE(surface) << surface.Status.Message();
  ASSERT_EQ(surface->Loops.size(), 14u);
  const ChartedMesh charted = Flatten(fuselage, 3.0);
  EXPECT_GE(charted.Charts.size(), 2u);
  EXPECT_LE(charted.Charts.size(), 6u);
  EXPECT_EQ(InnerLoops(charted), 14);
}

TEST(FlattenCharts, GoodMeshStaysAsItIs_ExactOracle)
{
  const MeshCase roll = CylinderWithHoles(0.06);
  const ChartedMesh charted = Flatten(roll.Mesh, 3.0);
  const auto whole = FlattenMesh(roll.Mesh);
  ASSERT_TRUE(whole);
  ASSERT_EQ(charted.Charts.size(), 1u);
  EXPECT_EQ(charted.Charts[0].Used, FlattenMethod::Hlle);
  EXPECT_TRUE(charted.Charts[0].FallbackReason.empty());
  EXPECT_TRUE(charted.Points == roll.Mesh.Points);
  EXPECT_TRUE(charted.Triangles == roll.Mesh.Triangles);
  EXPECT_EQ(charted.Charts[0].Mesh.Loops.size(), 3u);
  EXPECT_TRUE(charted.Charts[0].Mesh.Triangles == whole->Mesh.Triangles);
  EXPECT_TRUE(charted.Charts[0].UV == whole->UV);
}

/// Two turns of a ramp: flat, but it lies over itself in the plane.
TriangleMesh Ramp()
{
  MeshCase ramp = FlatCase(0.0, 12.0, 0.7, 1.3, 0.1, [](double, double) { return true; });
  Lift(ramp,
    [](double x, double y)
    { return Eigen::RowVector3d(y * std::cos(x), y * std::sin(x), 0.02 * x); });
  return ramp.Mesh;
}

TEST(FlattenCharts, SurfaceOverItselfIsCutAcross_PropertyOracle)
{
  const ChartedMesh charted = Flatten(Ramp(), 3.0);
  EXPECT_GE(charted.Charts.size(), 2u);
  EXPECT_LE(charted.Charts.size(), 4u);
}

/// A cube with a tiny triangle in one of its own, and a needle in that one.
TriangleMesh CubeWithTinyNeedle(double size, double height, double along, int inTriangle)
{
  TriangleMesh mesh = Cube(3);
  const auto n = static_cast<int>(mesh.Points.rows());
  const auto [a, b, c] = mesh.Triangles[static_cast<std::size_t>(inTriangle)];
  const Eigen::RowVector3d middle =
    (mesh.Points.row(a) + mesh.Points.row(b) + mesh.Points.row(c)) / 3.0;
  mesh.Points.conservativeResize(n + 4, Eigen::NoChange);
  int row = n;
  for (const int corner : { a, b, c })
  {
    mesh.Points.row(row++) = middle + size * (mesh.Points.row(corner) - middle);
  }
  const Eigen::RowVector3d foot =
    mesh.Points.row(n) + along * (mesh.Points.row(n + 1) - mesh.Points.row(n));
  mesh.Points.row(n + 3) = foot + height * (mesh.Points.row(n + 2) - foot);
  mesh.Triangles[static_cast<std::size_t>(inTriangle)] = { a, b, n + 1 };
  for (const std::array<int, 3>& triangle : std::vector<std::array<int, 3>>{ { a, n + 1, n },
         { b, c, n + 2 }, { b, n + 2, n + 1 }, { c, a, n }, { c, n, n + 2 }, { n, n + 1, n + 3 },
         { n + 1, n + 2, n + 3 }, { n + 2, n, n + 3 } })
  {
    mesh.Triangles.push_back(triangle);
  }
  return mesh;
}

/// Side by side with larger ones, the tiny chart is rounded: its needle would turn over.
TEST(FlattenCharts, ChartsThatRoundingFoldsAreDivided_PropertyOracle)
{
  int results = 0;
  int beyond = 0;
  for (unsigned seed = 1; seed <= 150; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(0.0, 1.0);
    const double size = std::pow(10.0, -6.0 - number(random));
    const double height = std::pow(10.0, -11.5 + 2.5 * number(random));
    const double along = 0.2 + 0.6 * number(random);
    TriangleMesh mesh =
      CubeWithTinyNeedle(size, height, along, static_cast<int>(108.0 * number(random)));
    Eigen::Quaterniond turn(number(random), number(random), number(random), number(random));
    mesh.Points = (mesh.Points * turn.normalized().toRotationMatrix()).eval();
    FlattenParams params;
    params.Fallback = true;
    const auto charted = FlattenCharts(mesh, params, {});
    if (!charted)
    {
      continue; // the needle has no map
    }
    ++results;
    bool good = true;
    for (const MeshParameterization& chart : charted->Charts)
    {
      good = good && chart.Injective && CountFlips(chart.Mesh, chart.UV) == 0;
    }
    EXPECT_EQ(good, charted->WithinLimit);
    beyond += good ? 0 : 1;
  }
  EXPECT_GE(results, 20);
  // 18 are folded at first; what is divided down to a triangle stays
  EXPECT_LE(beyond, 8);
}

TEST(FlattenCharts, PointsOfCutsLieInTriangles_PropertyOracle)
{
  const ChartedMesh charted = Flatten(Torus(20), 1.2); // cuts across cuts
  int made = 0;
  for (const PointOrigin& origin : charted.Origins)
  {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      EXPECT_EQ(origin.Points[k] >= 0, origin.Weights[k] > 0.0);
      sum += origin.Weights[k];
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    made += origin.Points[1] >= 0 ? 1 : 0;
  }
  EXPECT_GT(made, 0);
}

TEST(FlattenCharts, FewChartsAreAResultBeyondTheLimit_ExactOracle)
{
  const MeshCase hill = Hill(0.06, 1.5);
  ChartParams params;
  params.MaxStretch = 1.05;
  params.MaxCharts = 1;
  const auto one = FlattenCharts(hill.Mesh, {}, params);
  ASSERT_TRUE(one) << one.Status.Message();
  EXPECT_EQ(one->Charts.size(), 1u);
  EXPECT_FALSE(one->WithinLimit);
  EXPECT_GT(one->Charts[0].Measures.MaxStretch, 1.05);
  const Status closed = FlattenCharts(Torus(10), {}, params).Status;
  EXPECT_EQ(closed.Code, ErrorCode::NotConverged);
  EXPECT_NE(closed.Detail.find("1 of 1 charts"), std::string::npos);
}

TEST(FlattenCharts, WithoutFallbackTheMethodIsTheOnlyOne_PropertyOracle)
{
  FlattenParams params;
  params.Method = FlattenMethod::Lscm;
  params.Fallback = false;
  const auto charted = FlattenCharts(Sphere(12), params);
  ASSERT_TRUE(charted) << charted.Status.Message();
  for (const MeshParameterization& chart : charted->Charts)
  {
    EXPECT_EQ(chart.Used, FlattenMethod::Lscm);
    EXPECT_TRUE(chart.FallbackReason.empty());
  }
}

TEST(FlattenCharts, MethodThatNeedsMorePointsNeedsTheFallback_ExactOracle)
{
  FlattenParams params; // HLLE of a cube's corners
  params.Fallback = false;
  const Status status = FlattenCharts(Cube(1), params).Status;
  EXPECT_EQ(status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(status.Detail.find("allow the fallback"), std::string::npos);
  params.Fallback = true;
  EXPECT_TRUE(FlattenCharts(Cube(1), params));
}

TEST(FlattenCharts, FallbackOfAChartIsAnnounced_PropertyOracle)
{
  ChartParams params;
  params.MaxStretch = 1.6;
  const auto charted = FlattenCharts(Sphere(16), {}, params);
  ASSERT_TRUE(charted);
  for (const MeshParameterization& chart : charted->Charts)
  {
    EXPECT_EQ(chart.FallbackReason.empty(), chart.Used == FlattenMethod::Hlle);
    if (chart.Used != FlattenMethod::Hlle)
    {
      EXPECT_EQ(chart.FallbackReason.substr(0, 5), "hlle ");
    }
  }
}

TEST(FlattenCharts, RunsAndThreadsAgree_ExactOracle)
{
  const TriangleMesh mesh = Fuselage(4.0, 3);
  FlattenParams params;
  params.Threads = 1;
  ChartParams charts;
  charts.MaxStretch = 1.5;
  const auto one = FlattenCharts(mesh, params, charts);
  params.Threads = 4;
  const auto four = FlattenCharts(mesh, params, charts);
  ASSERT_TRUE(one && four);
  ASSERT_EQ(one->Charts.size(), four->Charts.size());
  EXPECT_TRUE(one->Points == four->Points);
  EXPECT_TRUE(one->Triangles == four->Triangles);
  for (std::size_t c = 0; c < one->Charts.size(); ++c)
  {
    EXPECT_TRUE(one->Charts[c].UV == four->Charts[c].UV);
  }
}

TEST(FlattenCharts, BadInputIsRefused_ExactOracle)
{
  const TriangleMesh cube = Cube(2);
  const auto refused = [&](double stretch, int charts, double angle)
  {
    return FlattenCharts(cube, {}, { stretch, charts, angle }).Status.Code ==
      ErrorCode::InvalidParameter;
  };
  EXPECT_FALSE(refused(3.0, 10, 40.0));
  EXPECT_TRUE(refused(1.0, 10, 40.0));
  EXPECT_TRUE(refused(std::nan(""), 10, 40.0));
  EXPECT_TRUE(refused(std::numeric_limits<double>::infinity(), 10, 40.0));
  EXPECT_TRUE(refused(3.0, 0, 40.0));
  EXPECT_TRUE(refused(3.0, 100001, 40.0));
  EXPECT_TRUE(refused(3.0, 10, 0.0));
  EXPECT_TRUE(refused(3.0, 10, 180.0));
  FlattenParams params;
  params.Neighbours = 1;
  EXPECT_EQ(FlattenCharts(cube, params).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(FlattenCharts({}).Status.Code, ErrorCode::EmptyInput);
  TriangleMesh bad = cube;
  bad.Triangles.push_back(bad.Triangles.front());
  EXPECT_EQ(FlattenCharts(bad).Status.Code, ErrorCode::InvalidTopology);
  bad = cube;
  bad.Points(3, 1) = std::nan("");
  EXPECT_EQ(FlattenCharts(bad).Status.Code, ErrorCode::NonFiniteInput);
}

TEST(FlattenCharts, AirplaneKeepsItsWindows_PropertyOracle)
{
  const char* folder = std::getenv("KNOTWORK_MESH_CASES");
  std::ifstream stream(std::filesystem::path(folder ? folder : "") / "plane_27holes.obj");
  if (!folder || !stream)
  {
    GTEST_SKIP() << "KNOTWORK_MESH_CASES names no folder with plane_27holes.obj";
  }
  TriangleMesh mesh;
  std::vector<double> coordinates;
  for (std::string line; std::getline(stream, line);)
  {
    std::istringstream words(line);
    std::string key;
    words >> key;
    for (int k = 0; k < 3 && key == "v"; ++k)
    {
      double x = 0.0;
      words >> x;
      coordinates.push_back(x);
    }
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < 3 && key == "f"; ++k)
    {
      std::string word;
      words >> word;
      corners[k] = std::stoi(word) - 1;
    }
    if (key == "f")
    {
      mesh.Triangles.push_back(corners);
    }
  }
  mesh.Points = Eigen::Map<const PointMatrix>(
    coordinates.data(), static_cast<Eigen::Index>(coordinates.size() / 3), 3);
  const ChartedMesh charted = Flatten(mesh, 3.0);
  EXPECT_EQ(InnerLoops(charted), 27);
  EXPECT_LE(charted.Charts.size(), 40u);
}
}
}
