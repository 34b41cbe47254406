// SPDX-License-Identifier: BSD-3-Clause
#include "ChartLayout.h"
#include "ClosedCases.h"
#include "CutLine.h"
#include "CutMesh.h"
#include "DivideChart.h"
#include "FlattenReport.h"
#include "GraphCut.h"
#include "HeatFlow.h"
#include "JoinCharts.h"
#include "MeshCases.h"
#include "PlaneLoops.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace knotwork
{
namespace
{
double Infinite()
{
  return std::numeric_limits<double>::infinity();
}

TEST(GraphCut, SmallGraphsAreCutAsByTrial_ExactOracle)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(0.0, 1.0);
  for (int trial = 0; trial < 200; ++trial)
  {
    const int n = 2 + static_cast<int>(random() % 8);
    std::vector<double> costs;
    std::vector<GraphEdge> edges;
    for (int i = 0; i < n; ++i)
    {
      costs.push_back(4.0 * value(random) - 2.0);
      for (int j = 0; j < i; ++j)
      {
        if (value(random) < 0.5)
        {
          edges.push_back({ i, j, value(random) });
        }
      }
    }
    const auto energy = [&](const auto& side)
    {
      double sum = 0.0;
      for (int i = 0; i < n; ++i)
      {
        sum += side(i) ? costs[static_cast<std::size_t>(i)] : 0.0;
      }
      for (const GraphEdge& edge : edges)
      {
        sum += side(edge.A) != side(edge.B) ? edge.Weight : 0.0;
      }
      return sum;
    };
    double least = Infinite();
    for (unsigned mask = 0; mask < 1U << n; ++mask)
    {
      least = std::min(least, energy([mask](int i) { return (mask >> i & 1U) != 0; }));
    }
    const auto sides = CutGraph(costs, edges);
    const double found = energy([&](int i) { return sides[static_cast<std::size_t>(i)] != 0; });
    EXPECT_NEAR(found, least, 1e-6); // weights are rounded to 2^-30 of their sum
  }
}

TEST(GraphCut, HeldNodesKeepTheirSides_ExactOracle)
{
  const std::vector<GraphEdge> chain{ { 0, 1, 3.0 }, { 1, 2, 1.0 }, { 2, 3, 2.0 } };
  const std::vector<char> expected{ 0, 0, 1, 1 };
  EXPECT_EQ(CutGraph({ Infinite(), 0.0, 0.0, -Infinite() }, chain), expected);
}

TEST(CutMesh, DivisionKeepsAreasPlacesAndOrientation_ExactOracle)
{
  const MeshCase plate = PlateWithHoles(0.2);
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  CutMesh mesh(disc.Value);
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      mesh.UV[t][k] = 2.0 * mesh.Points[static_cast<std::size_t>(mesh.Triangles[t][k])].head<2>();
    }
  }
  std::mt19937 random(5);
  std::uniform_real_distribution<double> weight(0.2, 0.8);
  for (int round = 0; round < 3; ++round) // triangles of one, two and three new points
  {
    std::unordered_map<std::uint64_t, int> points;
    const std::size_t count = mesh.Triangles.size();
    for (std::size_t t = 0; t < count; ++t)
    {
      const auto corners = mesh.Triangles[t];
      for (std::size_t k = 0; k < 3; ++k)
      {
        const auto key = CutMesh::EdgeKey(corners[k], corners[(k + 1) % 3]);
        if (random() % 2 == 0 && points.count(key) == 0)
        {
          points[key] = mesh.AddPoint(corners[k], corners[(k + 1) % 3], weight(random));
        }
      }
    }
    mesh.Split(points);
  }
  std::vector<double> areas(disc->Triangles.size(), 0.0);
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    std::array<Eigen::Vector2d, 3> at;
    for (std::size_t k = 0; k < 3; ++k)
    {
      at[k] = mesh.Points[static_cast<std::size_t>(mesh.Triangles[t][k])].head<2>();
      EXPECT_LE((mesh.UV[t][k] - 2.0 * at[k]).norm(), 1e-14);
    }
    const Eigen::Vector2d p = at[1] - at[0];
    const Eigen::Vector2d q = at[2] - at[0];
    const double area = 0.5 * (p[0] * q[1] - p[1] * q[0]);
    EXPECT_GT(area, 0.0);
    areas[static_cast<std::size_t>(mesh.TriangleIds[t])] += area;
  }
  for (std::size_t t = 0; t < areas.size(); ++t)
  {
    const auto& c = disc->Triangles[t];
    const Eigen::Vector3d p = disc->Point(c[1]) - disc->Point(c[0]);
    const Eigen::Vector3d q = disc->Point(c[2]) - disc->Point(c[0]);
    EXPECT_NEAR(areas[t], 0.5 * (p[0] * q[1] - p[1] * q[0]), 1e-15);
  }
  std::vector<int> all(mesh.Triangles.size());
  for (std::size_t t = 0; t < all.size(); ++t)
  {
    all[t] = static_cast<int>(t);
  }
  const auto part = TakePart(mesh, all); // conforming: the same loops
  ASSERT_TRUE(part) << part.Status.Message();
  EXPECT_EQ(part->Mesh.Loops.size(), 3u);
}

TEST(CutMesh, FansThatTouchGetPointsOfTheirOwn_ExactOracle)
{
  const auto disc =
    CheckMesh(FlatCase(0.0, 2.0, 0.0, 2.0, 1.0, [](double, double) { return true; }).Mesh);
  ASSERT_TRUE(disc);
  CutMesh mesh(disc.Value);
  // a ring around one corner triangle of the middle point, which is opened on one side
  int middle = 0;
  for (int v = 0; v < disc->NumPoints(); ++v)
  {
    middle = disc->OnBoundary[static_cast<std::size_t>(v)] ? middle : v;
  }
  std::vector<int> star;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const auto& c = mesh.Triangles[t];
    if (c[0] == middle || c[1] == middle || c[2] == middle)
    {
      star.push_back(static_cast<int>(t));
    }
  }
  ASSERT_EQ(star.size(), 6u);
  std::vector<int> all;
  for (int t = 0; t < static_cast<int>(mesh.Triangles.size()); ++t)
  {
    if (t != star[1] && t != star[4])
    {
      all.push_back(t);
    }
  }
  const auto components = Components(mesh, all);
  for (const auto& component : components)
  {
    const auto part = TakePart(mesh, component);
    ASSERT_TRUE(part) << part.Status.Message(); // refused by CheckSurface without copies
  }
}

/// Points of the boundary of [0, 6] x [0, 0.4] exactly on it.
PointMatrix Straight(const DiscMesh& mesh, PointMatrix uv)
{
  for (int v = 0; v < mesh.NumPoints(); ++v)
  {
    if (mesh.OnBoundary[static_cast<std::size_t>(v)])
    {
      uv(v, 0) = uv(v, 0) < 0.05 ? 0.0 : uv(v, 0) > 5.95 ? 6.0 : uv(v, 0);
      uv(v, 1) = uv(v, 1) < 0.05 ? 0.0 : uv(v, 1) > 0.35 ? 0.4 : uv(v, 1);
    }
  }
  return uv;
}

TEST(PlaneLoops, CrossingIsFoundAndOnlyThat_ExactOracle)
{
  const MeshCase plate = FlatCase(0.0, 6.0, 0.0, 0.4, 0.1, [](double, double) { return true; });
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  const auto roll = [&](double turns)
  {
    PointMatrix uv(plate.Flat.rows(), 2);
    for (Eigen::Index i = 0; i < uv.rows(); ++i)
    {
      const double angle = -2.0 * std::acos(-1.0) * turns * plate.Flat(i, 0) / 6.0;
      const double radius = 1.0 + plate.Flat(i, 1);
      uv.row(i) << radius * std::cos(angle), radius * std::sin(angle);
    }
    return uv;
  };
  EXPECT_FALSE(FindCrossing(disc.Value, plate.Flat));
  const Eigen::Rotation2Dd turn(0.3); // edges of one line, but for rounding, do not cross
  EXPECT_FALSE(FindCrossing(disc.Value, Straight(disc.Value, plate.Flat) * turn.matrix()));
  EXPECT_FALSE(FindCrossing(disc.Value, roll(0.9)));
  EXPECT_TRUE(FindCrossing(disc.Value, roll(0.995))); // a gap of a third of an edge
  const EdgeCrossing crossing = FindCrossing(disc.Value, roll(1.1));
  ASSERT_TRUE(crossing);
  // the two ends of the strip
  const double x = plate.Flat(crossing.First[0], 0);
  const double y = plate.Flat(crossing.Second[0], 0);
  EXPECT_GT(std::abs(x - y), 4.5);
}

/// The loop of the hole mirrored: it runs counterclockwise like the outer one, so that its disc is
/// covered, though no edges cross.
TEST(PlaneLoops, AHoleThatIsTurnedOverItsRimIsFound_ExactOracle)
{
  const auto inHole = [](double x, double y) { return std::hypot(x - 1.0, y - 1.0) < 0.5; };
  const MeshCase plate =
    FlatCase(0.0, 2.0, 0.0, 2.0, 0.1, [&](double x, double y) { return !inHole(x, y); });
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  ASSERT_EQ(disc->Loops.size(), 2u);
  EXPECT_FALSE(FindCrossing(disc.Value, plate.Flat));
  PointMatrix uv = plate.Flat;
  for (int v : disc->Loops[1])
  {
    uv(v, 0) = 2.0 - uv(v, 0);
  }
  const EdgeCrossing crossing = FindCrossing(disc.Value, uv);
  ASSERT_TRUE(crossing);
  const auto& hole = disc->Loops[1];
  for (int end : { crossing.First[0], crossing.First[1], crossing.Second[0], crossing.Second[1] })
  {
    EXPECT_NE(std::find(hole.begin(), hole.end(), end), hole.end());
  }
  // on opposite sides: nearly a diameter apart
  EXPECT_GT((uv.row(crossing.First[0]) - uv.row(crossing.Second[0])).norm(), 0.8);
}

TEST(HeatFlow, HarmonicFunctionOfARectangleIsLinear_ExactOracle)
{
  const MeshCase plate = FlatCase(0.0, 2.0, 0.0, 1.0, 0.1, [](double, double) { return true; });
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  Eigen::VectorXd values(disc->NumPoints());
  std::vector<char> held;
  for (int v = 0; v < disc->NumPoints(); ++v)
  {
    values[v] = disc->Points(v, 0);
    held.push_back(disc->OnBoundary[static_cast<std::size_t>(v)]);
  }
  const Eigen::VectorXd linear = values;
  for (int v = 0; v < disc->NumPoints(); ++v)
  {
    values[v] = held[static_cast<std::size_t>(v)] ? values[v] : 7.0;
  }
  ASSERT_TRUE(FlowHeat(disc.Value, held, Infinite(), 1, values));
  EXPECT_LE((values - linear).cwiseAbs().maxCoeff(), 1e-12);
  // the step conserves heat
  Eigen::VectorXd heat = linear.array().square();
  const Eigen::VectorXd before = heat;
  ASSERT_TRUE(FlowHeat(disc.Value, std::vector<char>(held.size(), 0), 0.1, 1, heat));
  EXPECT_LT(heat.maxCoeff(), before.maxCoeff());
  EXPECT_GT(heat.minCoeff(), before.minCoeff());
}

TEST(SurfaceSides, LongSurfaceIsHalved_PropertyOracle)
{
  const auto disc =
    CheckMesh(FlatCase(0.0, 4.0, 0.0, 1.0, 0.1, [](double, double) { return true; }).Mesh);
  ASSERT_TRUE(disc);
  const std::vector<int> holes(static_cast<std::size_t>(disc->NumPoints()), -1);
  const SurfaceParts parts(disc.Value, holes);
  EXPECT_TRUE(DivideByNormals(parts).empty()); // one direction only
  for (const Sides& sides : { DivideByLength(parts), DivideByPosition(parts) })
  {
    ASSERT_EQ(sides.size(), parts.Areas.size());
    double area = 0.0;
    for (std::size_t t = 0; t < sides.size(); ++t)
    {
      area += sides[t] ? parts.Areas[t] : 0.0;
      const auto& c = disc->Triangles[t];
      const double x =
        (disc->Points(c[0], 0) + disc->Points(c[1], 0) + disc->Points(c[2], 0)) / 3.0;
      EXPECT_TRUE(std::abs(x - 2.0) < 0.2 ||
        (sides[t] == sides[0]) == ((x < 2.0) == (disc->Points(disc->Triangles[0][0], 0) < 2.0)));
    }
    EXPECT_NEAR(area, 2.0, 0.15); // an edge's width
  }
}

TEST(SurfaceSides, FineRoofIsDividedAtItsRidge_ExactOracle)
{
  // more triangles than a graph that is cut has nodes
  auto roof = FlatCase(0.0, 2.0, 0.0, 1.0, 0.00625, [](double, double) { return true; }).Mesh;
  for (Eigen::Index i = 0; i < roof.Points.rows(); ++i)
  {
    roof.Points(i, 2) = -std::abs(roof.Points(i, 0) - 1.0);
  }
  const auto disc = CheckMesh(roof);
  ASSERT_TRUE(disc);
  ASSERT_GT(disc->Triangles.size(), 60000U);
  const std::vector<int> holes(static_cast<std::size_t>(disc->NumPoints()), -1);
  const SurfaceParts parts(disc.Value, holes);
  const Sides sides = DivideByNormals(parts);
  ASSERT_EQ(sides.size(), parts.Areas.size());
  int wrong = 0;
  for (std::size_t t = 0; t < sides.size(); ++t)
  {
    const bool same = parts.Normals[t].dot(parts.Normals[0]) > 0.9;
    wrong += (sides[t] == sides[0]) == same ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0);
}

TEST(SurfaceSides, IslandsJoinAndTheLargestStay_ExactOracle)
{
  // a chain of triangles
  TriangleAdjacency chain;
  const int n = 20;
  for (int i = 0; i < n; ++i)
  {
    chain.Triangle.push_back({ i - 1, i + 1 < n ? i + 1 : -1, -1 });
  }
  const std::vector<double> areas(n, 1.0);
  Sides sides(n, 0);
  sides[3] = 1;
  sides[10] = sides[11] = sides[12] = 1;
  JoinIslands(chain, areas, 0.1, sides);
  Sides expected(n, 0);
  expected[10] = expected[11] = expected[12] = 1;
  EXPECT_EQ(sides, expected);
}

TEST(DivideChart, HolesAreSmallAndOnOneSide_ExactOracle)
{
  const auto fuselage = CheckSurface(Fuselage(4.0, 3));
  ASSERT_TRUE(fuselage);
  std::vector<int> holes = FindSmallHoles(fuselage.Value);
  for (int v = 0; v < fuselage->NumPoints(); ++v)
  {
    EXPECT_EQ(holes[static_cast<std::size_t>(v)] >= 0,
      fuselage->OnBoundary[static_cast<std::size_t>(v)] != 0);
  }
  // the ends of a tube face all sides
  const auto tube = CheckSurface(
    Without(Fuselage(12.0, 1), [](const Eigen::Vector3d& p) { return p[0] < 0.1 || p[0] > 11.9; }));
  ASSERT_TRUE(tube);
  ASSERT_EQ(tube->Loops.size(), 4u);
  holes = FindSmallHoles(tube.Value);
  for (int v = 0; v < tube->NumPoints(); ++v)
  {
    const double x = tube->Points(v, 0);
    EXPECT_EQ(holes[static_cast<std::size_t>(v)] >= 0,
      tube->OnBoundary[static_cast<std::size_t>(v)] != 0 && x > 1.0 && x < 11.0);
  }
}

TEST(CutLine, LineIsSmoothAwayFromCreasesAndExactOnThem_ExactOracle)
{
  // sides by a slanted line across the triangles of a plate: labels zigzag, the line does not
  const MeshCase plate = FlatCase(0.0, 2.0, 0.0, 1.0, 0.05, [](double, double) { return true; });
  const auto divided = [](const DiscMesh& mesh, const auto& isOne)
  {
    Sides sides;
    for (const auto& c : mesh.Triangles)
    {
      const Eigen::Vector3d centre = (mesh.Point(c[0]) + mesh.Point(c[1]) + mesh.Point(c[2])) / 3.0;
      sides.push_back(isOne(centre) ? 1 : 0);
    }
    return sides;
  };
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  const std::vector<int> none(static_cast<std::size_t>(disc->NumPoints()), -1);
  const SurfaceParts parts(disc.Value, none);
  const auto slanted = [](const Eigen::Vector3d& p) { return p[0] - 1.0 > 0.3 * (p[1] - 0.5); };
  const Eigen::VectorXd line = CutFunction(parts, divided(disc.Value, slanted), 0.7);
  double square = 0.0;
  int count = 0;
  const auto meet = [&](const Eigen::Vector3d& p)
  {
    const double distance = (p[0] - 1.0 - 0.3 * (p[1] - 0.5)) / std::hypot(1.0, 0.3);
    square += distance * distance;
    ++count;
  };
  for (int v = 0; v < disc->NumPoints(); ++v)
  {
    if (line[v] == 0.0)
    {
      meet(disc->Point(v));
    }
    for (int j = disc->FanStart[static_cast<std::size_t>(v)];
         j < disc->FanStart[static_cast<std::size_t>(v) + 1]; ++j)
    {
      const int w = disc->Fan[static_cast<std::size_t>(j)];
      if (v < w && line[v] * line[w] < 0.0)
      {
        const double share = line[v] / (line[v] - line[w]);
        meet((1.0 - share) * disc->Point(v) + share * disc->Point(w));
      }
    }
  }
  ASSERT_GT(count, 20);
  // a quarter of an edge, most of it at the ends, which turn across the boundary; 0.36 along edges
  EXPECT_LE(std::sqrt(square / count), 0.25 * 0.05);
  // a cube's side: all its points are on creases
  const auto cube = CheckSurface(Cube(4));
  ASSERT_TRUE(cube);
  const std::vector<int> free(static_cast<std::size_t>(cube->NumPoints()), -1);
  const SurfaceParts sides(cube.Value, free);
  const Eigen::VectorXd exact = CutFunction(
    sides, divided(cube.Value, [](const Eigen::Vector3d& p) { return p[2] > 3.99; }), 0.7);
  for (int v = 0; v < cube->NumPoints(); ++v)
  {
    const bool above = cube->Points(v, 2) == 4.0;
    const bool rim = above &&
      (cube->Points(v, 0) == 0.0 || cube->Points(v, 0) == 4.0 || cube->Points(v, 1) == 0.0 ||
        cube->Points(v, 1) == 4.0);
    EXPECT_EQ(exact[v] == 0.0, rim);
    EXPECT_TRUE(rim || (exact[v] > 0.0) == above);
  }
}

TEST(JoinCharts, SmallChartsGoToTheirNeighbours_ExactOracle)
{
  const MeshCase plate = FlatCase(0.0, 2.0, 0.0, 1.0, 0.1, [](double, double) { return true; });
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  CutMesh mesh(disc.Value);
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const Eigen::Vector3d p = disc->Point(disc->Triangles[t][0]);
    mesh.Charts[t] = p[0] < 0.2 && p[1] < 0.25 ? 1 : p[0] > 1.0 ? 2 : 0;
  }
  std::vector<ChartMap> maps(3);
  ASSERT_TRUE(JoinCharts(mesh, {}, {}, maps));
  ASSERT_EQ(maps.size(), 2u); // the corner joins; halves are not small
  EXPECT_TRUE(maps[0].Good);
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    EXPECT_EQ(mesh.Charts[t], disc->Point(disc->Triangles[t][0])[0] > 1.0 ? 1 : 0);
  }
}

TEST(JoinCharts, ClosedSurfaceIsNotJoined_ExactOracle)
{
  const auto sphere = CheckSurface(Sphere(12));
  ASSERT_TRUE(sphere);
  CutMesh mesh(sphere.Value);
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    mesh.Charts[t] = sphere->Point(sphere->Triangles[t][0])[0] > 0.95 ? 1 : 0;
  }
  std::vector<ChartMap> maps(2);
  ASSERT_TRUE(JoinCharts(mesh, {}, {}, maps));
  EXPECT_EQ(maps.size(), 2u);
}

TEST(ChartLayout, ImagesLieSideBySide_PropertyOracle)
{
  std::vector<MeshParameterization> charts;
  for (const double length : { 3.0, 1.0, 2.0, 0.5 })
  {
    auto map =
      FlattenMesh(FlatCase(0.0, 0.4, 0.0, length, 0.1, [](double, double) { return true; }).Mesh);
    ASSERT_TRUE(map);
    charts.push_back(std::move(map.Value));
  }
  std::vector<PointMatrix> before;
  for (const auto& chart : charts)
  {
    before.push_back(chart.UV);
  }
  PlaceSideBySide(charts);
  for (std::size_t i = 0; i < charts.size(); ++i)
  {
    EXPECT_LE(RigidError(charts[i].UV, before[i]), 1e-14);
    EXPECT_EQ(CountFlips(charts[i].Mesh, charts[i].UV), 0);
    for (std::size_t j = 0; j < i; ++j)
    {
      const Eigen::RowVector2d low =
        charts[i].UV.colwise().minCoeff().cwiseMax(charts[j].UV.colwise().minCoeff());
      const Eigen::RowVector2d high =
        charts[i].UV.colwise().maxCoeff().cwiseMin(charts[j].UV.colwise().maxCoeff());
      EXPECT_TRUE((low.array() > high.array()).any());
    }
  }
  std::vector<MeshParameterization> one{ charts[0] };
  PlaceSideBySide(one);
  EXPECT_TRUE(one[0].UV == charts[0].UV);
}
}
}
