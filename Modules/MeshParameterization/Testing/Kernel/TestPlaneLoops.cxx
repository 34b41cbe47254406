// SPDX-License-Identifier: BSD-3-Clause
#include "ClosedCases.h"
#include "FlattenCharts.h"
#include "MeshCases.h"

#include <knotwork/MeshParameterization/PlaneLoops.h>

#include <gtest/gtest.h>
#include <random>
#include <set>

namespace knotwork
{
namespace
{
__extension__ typedef __int128 LongInteger;

/// Pairs of triangles whose interiors have a point in common: no side of one has the other on its
/// right. Triangles that only touch are told from others by `gap` of the size of the picture. Looks
/// at all pairs: knows nothing of boundaries.
int CountOverlaps(const std::vector<std::array<int, 3>>& triangles, const PointMatrix& uv)
{
  const double gap =
    1e-11 * (uv.colwise().maxCoeff() - uv.colwise().minCoeff()).norm(); // beyond rounding
  const auto corner = [&](std::size_t t, std::size_t k) -> Eigen::RowVector2d
  { return uv.row(triangles[t][k % 3]); };
  const auto separates = [&](std::size_t s, std::size_t t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Eigen::RowVector2d a = corner(s, k);
      const Eigen::RowVector2d along = (corner(s, k + 1) - a).normalized();
      double inside = -1.0;
      for (std::size_t l = 0; l < 3; ++l)
      {
        const Eigen::RowVector2d to = corner(t, l) - a;
        inside = std::max(inside, along[0] * to[1] - along[1] * to[0]);
      }
      if (inside <= gap)
      {
        return true;
      }
    }
    return false;
  };
  std::vector<Eigen::Array4d> boxes; // low, -high
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const Eigen::RowVector2d low = corner(t, 0).cwiseMin(corner(t, 1)).cwiseMin(corner(t, 2));
    const Eigen::RowVector2d high = corner(t, 0).cwiseMax(corner(t, 1)).cwiseMax(corner(t, 2));
    boxes.emplace_back(low[0], low[1], -high[0], -high[1]);
  }
  int overlaps = 0;
  for (std::size_t s = 0; s < triangles.size(); ++s)
  {
    const Eigen::Array4d turned(-boxes[s][2], -boxes[s][3], -boxes[s][0], -boxes[s][1]);
    for (std::size_t t = s + 1; t < triangles.size(); ++t)
    {
      overlaps += (boxes[t] <= turned).all() && !separates(s, t) && !separates(t, s) ? 1 : 0;
    }
  }
  return overlaps;
}

/// A strip beside a curve in space, flat parameters (along, across).
TriangleMesh Strip(double length, double width, double edge,
  const std::function<Eigen::RowVector3d(double, double)>& place)
{
  MeshCase strip = FlatCase(0.0, length, -width, width, edge, [](double, double) { return true; });
  Lift(strip, place);
  return strip.Mesh;
}

/// Spiral staircase without steps: its image in the plane lies over itself after a turn.
TriangleMesh Helicoid(double turns, double pitch)
{
  return Strip(turns * 2.0 * std::acos(-1.0), 0.3, 0.1,
    [=](double x, double y)
    { return Eigen::RowVector3d((1.0 + y) * std::cos(x), (1.0 + y) * std::sin(x), pitch * x); });
}

/// Flat spiral, one layer.
TriangleMesh Spiral()
{
  return Strip(14.0, 0.2, 0.1,
    [](double x, double y)
    {
      const double r = 1.0 + 0.1 * x + y;
      return Eigen::RowVector3d(r * std::cos(x), r * std::sin(x), 0.0);
    });
}

/// Open tube along a helix.
TriangleMesh HelicalTube(int rings, int sectors)
{
  const double pi = std::acos(-1.0);
  TriangleMesh mesh;
  mesh.Points.resize(rings * sectors, 3);
  for (int i = 0; i < rings; ++i)
  {
    const double s = 4.0 * pi * i / (rings - 1);
    const Eigen::RowVector3d out(std::cos(s), std::sin(s), 0.0);
    for (int j = 0; j < sectors; ++j)
    {
      const double a = 2.0 * pi * j / sectors;
      mesh.Points.row(i * sectors + j) =
        (2.0 + 0.5 * std::cos(a)) * out + Eigen::RowVector3d(0.0, 0.0, 0.3 * s + 0.5 * std::sin(a));
      if (i + 1 < rings)
      {
        const int next = (j + 1) % sectors;
        const int here = i * sectors;
        mesh.Triangles.push_back({ here + j, here + sectors + j, here + sectors + next });
        mesh.Triangles.push_back({ here + j, here + sectors + next, here + next });
      }
    }
  }
  return mesh;
}

/// Half of a torus about z, as a tube: the outer side shrinks or the inner one stretches.
TriangleMesh HalfTorus()
{
  return Without(Torus(16), [](const Eigen::Vector3d& p) { return p[1] < 0.0; });
}

void ExpectInjectiveCharts(const TriangleMesh& mesh, FlattenMethod method, double stretch)
{
  FlattenParams params;
  params.Method = method;
  ChartParams charts;
  charts.MaxStretch = stretch;
  const auto charted = FlattenCharts(mesh, params, charts);
  ASSERT_TRUE(charted) << charted.Status.Message();
  EXPECT_TRUE(charted->WithinLimit);
  for (const MeshParameterization& chart : charted->Charts)
  {
    EXPECT_TRUE(chart.Injective) << chart.Injective.Message();
    EXPECT_EQ(CountOverlaps(chart.Mesh.Triangles, chart.UV), 0);
  }
}

TEST(PlaneLoops, TurnIsTheSignOfWholeNumbers_ExactOracle)
{
  std::mt19937_64 random(3);
  std::uniform_int_distribution<std::int64_t> number(-(1LL << 52), 1LL << 52);
  std::uniform_int_distribution<std::int64_t> small(-2, 2);
  int zeros = 0;
  for (int i = 0; i < 20000; ++i)
  {
    std::array<std::array<std::int64_t, 2>, 3> p{};
    const std::int64_t parts = 1 << (i % 20);
    for (std::size_t d = 0; d < 2; ++d) // c on the line of a and b, or next to it
    {
      p[0][d] = number(random);
      const std::int64_t step = number(random) / (4 * parts);
      p[1][d] = p[0][d] / 2 + step * parts + small(random) / 2;
      p[2][d] = p[0][d] / 2 + step + small(random) / 2;
      p[0][d] /= 2;
    }
    const auto difference = [&](std::size_t k, std::size_t d)
    { return static_cast<LongInteger>(p[k][d] - p[0][d]); };
    const LongInteger area =
      difference(1, 0) * difference(2, 1) - difference(1, 1) * difference(2, 0);
    PointMatrix uv(3, 2);
    for (int k = 0; k < 3; ++k)
    {
      for (int d = 0; d < 2; ++d)
      {
        uv(k, d) = std::ldexp(
          static_cast<double>(p[static_cast<std::size_t>(k)][static_cast<std::size_t>(d)]), -50);
      }
    }
    const int sign = (area > 0 ? 1 : 0) - (area < 0 ? 1 : 0);
    zeros += sign == 0 ? 1 : 0;
    ASSERT_EQ(Turn(uv, 0, 1, 2), sign);
    ASSERT_EQ(Turn(uv, 1, 2, 0), sign);
    ASSERT_EQ(Turn(uv, 1, 0, 2), -sign);
  }
  EXPECT_GT(zeros, 100);
}

TEST(PlaneLoops, ABoundaryThatTurnsBackIsFound_ExactOracle)
{
  // four quarters around point 0, which is on the boundary: the last spoke lies on the first one
  TriangleMesh mesh;
  mesh.Triangles = { { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 4 }, { 0, 4, 5 } };
  mesh.Points.resize(6, 3);
  mesh.Points << 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0, 2, 0, 1;
  const auto disc = CheckMesh(mesh);
  ASSERT_TRUE(disc) << disc.Status.Message();
  PointMatrix uv = mesh.Points.leftCols(2);
  const Status status = CheckInjective(disc.Value, uv);
  EXPECT_EQ(status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(status.Detail.find("boundary edges"), std::string::npos) << status.Detail;
  uv(5, 1) = -1e-300; // a gap of next to nothing
  EXPECT_TRUE(CheckInjective(disc.Value, uv));
  uv(5, 1) = 1e-3;
  EXPECT_FALSE(CheckInjective(disc.Value, uv));
  EXPECT_EQ(CountOverlaps(mesh.Triangles, uv), 1);
  uv.row(2) << 0.0, -0.1;
  EXPECT_NE(CheckInjective(disc.Value, uv).Detail.find("counterclockwise"), std::string::npos);
}

TEST(PlaneLoops, ANarrowSlitIsACrossing_ExactOracle)
{
  // three quarters of a disc around point 0: the missing one becomes a slit in the plane
  const double pi = std::acos(-1.0);
  const int n = 12;
  TriangleMesh mesh;
  mesh.Points = PointMatrix::Zero(n + 2, 3);
  for (int i = 0; i <= n; ++i)
  {
    const double angle = 1.5 * pi * i / n;
    mesh.Points.row(i + 1) << std::cos(angle), std::sin(angle), 0.0;
    if (i < n)
    {
      mesh.Triangles.push_back({ 0, i + 1, i + 2 });
    }
  }
  const auto disc = CheckMesh(mesh);
  ASSERT_TRUE(disc) << disc.Status.Message();
  const auto closed = [&](double degrees)
  {
    PointMatrix uv = PointMatrix::Zero(n + 2, 2);
    for (int i = 0; i <= n; ++i)
    {
      const double angle = (2.0 * pi - degrees * pi / 180.0) * i / n;
      uv.row(i + 1) << std::cos(angle), std::sin(angle);
    }
    EXPECT_TRUE(CheckInjective(disc.Value, uv));
    return FindCrossing(disc.Value, uv);
  };
  EXPECT_FALSE(closed(90.0));
  EXPECT_FALSE(closed(16.0)); // the sine is above a quarter
  const EdgeCrossing slit = closed(13.0);
  ASSERT_TRUE(slit);
  const std::set<int> ends{ slit.First[0], slit.First[1], slit.Second[0], slit.Second[1] };
  EXPECT_EQ(ends, (std::set<int>{ 0, 1, n + 1 }));
}

TEST(PlaneLoops, ProofAndBruteForceAgree_CrossOracle)
{
  // plates with holes, bent in the plane by a turn that grows along them: some hit themselves
  int injective = 0;
  int overlapping = 0;
  for (int seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(static_cast<unsigned>(seed));
    std::uniform_real_distribution<double> number(0.0, 1.0);
    const double angle = 4.0 + 6.0 * number(random);
    const double growth = 0.12 * number(random);
    const MeshCase plate = FlatCase(0.0, 2.0, 0.0, 0.5, 0.1,
      [](double x, double y) { return std::hypot(x - 0.5, y - 0.25) > 0.15; });
    const auto disc = CheckMesh(plate.Mesh);
    ASSERT_TRUE(disc);
    PointMatrix uv(disc->NumPoints(), 2);
    for (Eigen::Index i = 0; i < uv.rows(); ++i)
    {
      const double a = 0.5 * angle * plate.Flat(i, 0);
      const double r = 0.7 - plate.Flat(i, 1) + growth * a;
      uv.row(i) << r * std::sin(a), -r * std::cos(a);
    }
    ASSERT_TRUE(IsCounterclockwise(disc.Value, uv));
    const Status status = CheckInjective(disc.Value, uv);
    const int overlaps = CountOverlaps(disc->Triangles, uv);
    EXPECT_EQ(static_cast<bool>(status), overlaps == 0) << status.Message() << " " << overlaps;
    EXPECT_EQ(static_cast<bool>(FindOverlap(disc->Loops, uv)), overlaps > 0);
    (overlaps == 0 ? injective : overlapping) += 1;
  }
  EXPECT_GE(injective, 5);
  EXPECT_GE(overlapping, 5);
}

TEST(PlaneLoops, OneChartOverItselfIsSaid_CrossOracle)
{
  const auto map = FlattenMesh(Helicoid(2.0, 0.05));
  ASSERT_TRUE(map) << map.Status.Message();
  EXPECT_EQ(map->Measures.FlippedTriangles, 0);
  EXPECT_GT(CountOverlaps(map->Mesh.Triangles, map->UV), 0);
  EXPECT_FALSE(map->Injective);
  EXPECT_NE(map->Injective.Detail.find("lies over itself"), std::string::npos);
  const auto whole = FlattenMesh(Spiral());
  ASSERT_TRUE(whole);
  EXPECT_EQ(CountOverlaps(whole->Mesh.Triangles, whole->UV), 0);
  EXPECT_TRUE(whole->Injective) << whole->Injective.Message();
}

TEST(PlaneLoops, ChartsCoverNoPointTwice_CrossOracle)
{
  for (const double stretch : { 3.0, 1.5 })
  {
    for (const FlattenMethod method : { FlattenMethod::Hlle, FlattenMethod::Injective })
    {
      ExpectInjectiveCharts(Helicoid(2.5, 0.05), method, stretch);
      ExpectInjectiveCharts(Helicoid(1.2, 0.4), method, stretch);
      ExpectInjectiveCharts(Spiral(), method, stretch);
      ExpectInjectiveCharts(HelicalTube(81, 14), method, stretch);
      ExpectInjectiveCharts(HalfTorus(), method, stretch);
      ExpectInjectiveCharts(Torus(12), method, stretch);
      ExpectInjectiveCharts(Fuselage(4.0, 3), method, stretch);
      ExpectInjectiveCharts(Cube(4), method, stretch);
      ExpectInjectiveCharts(Hill(0.1, 1.5).Mesh, method, stretch);
    }
  }
}

TEST(PlaneLoops, ChartsOfOtherMethodsCoverNoPointTwice_CrossOracle)
{
  for (const FlattenMethod method :
    { FlattenMethod::Lscm, FlattenMethod::Arap, FlattenMethod::Isomap, FlattenMethod::Laplacian })
  {
    ExpectInjectiveCharts(Helicoid(2.5, 0.05), method, 2.0);
    ExpectInjectiveCharts(HelicalTube(61, 10), method, 2.0);
  }
}
}
}
