// SPDX-License-Identifier: BSD-3-Clause
// Oracles: volumes and places that are known exactly (prisms, twisted and tapered bars, tori,
// shears), determinants at the corners of cells.
#include "Sweep.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace knotwork;
using Eigen::Vector3d;
constexpr double Pi = 3.14159265358979323846;

struct Quads
{
  CellMesh<2> Mesh;
  PointMatrix Points;
};

/// n x n squares of [0, 1]^2 at z = 0, moved.
Quads Grid(int n, const Vector3d& origin = Vector3d::Zero())
{
  Quads grid;
  grid.Mesh.NumPoints = (n + 1) * (n + 1);
  grid.Points.resize(grid.Mesh.NumPoints, 3);
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      grid.Points.row(j * (n + 1) + i) =
        (origin + Vector3d(static_cast<double>(i) / n, static_cast<double>(j) / n, 0.0))
          .transpose();
    }
  }
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const int a = j * (n + 1) + i;
      grid.Mesh.Corners.insert(grid.Mesh.Corners.end(), { a, a + 1, a + n + 1, a + n + 2 });
    }
  }
  return grid;
}

/// Sum of the volumes of trilinear cells, by Gauss points (exact: cubic in each parameter), and the
/// least determinant at corners.
struct Cells
{
  double Volume = 0.0;
  double Least = 1e300;
};
Cells Measure(const SweptMesh& swept)
{
  Cells found;
  for (int c = 0; c < swept.Mesh.NumCells(); ++c)
  {
    const auto jacobian = [&](const std::array<double, 3>& t)
    {
      Eigen::Matrix3d columns = Eigen::Matrix3d::Zero();
      for (int corner = 0; corner < 8; ++corner)
      {
        for (int d = 0; d < 3; ++d)
        {
          double factor = 1.0;
          for (int e = 0; e < 3; ++e)
          {
            const bool end = (corner >> e & 1) != 0;
            const double at = t[static_cast<std::size_t>(e)];
            factor *= e == d ? (end ? 1.0 : -1.0) : (end ? at : 1.0 - at);
          }
          columns.col(d) += factor * swept.Points.row(swept.Mesh.Cell(c)[corner]).transpose();
        }
      }
      return columns.determinant();
    };
    const double a = 0.5 - std::sqrt(1.0 / 12.0);
    for (int g = 0; g < 8; ++g)
    {
      const auto at = [&](int d) { return (g >> d & 1) != 0 ? 1.0 - a : a; };
      found.Volume += jacobian({ at(0), at(1), at(2) }) / 8.0;
      found.Least = std::min(
        found.Least, jacobian({ g & 1 ? 1.0 : 0.0, g & 2 ? 1.0 : 0.0, g & 4 ? 1.0 : 0.0 }));
    }
  }
  return found;
}

PointMatrix Line(std::initializer_list<Vector3d> points)
{
  PointMatrix path(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::Index row = 0;
  for (const Vector3d& point : points)
  {
    path.row(row++) = point.transpose();
  }
  return path;
}

PathSweepParams Straight(int layers)
{
  PathSweepParams params;
  params.Path = Line({ Vector3d(0.5, 0.5, 0.0), Vector3d(0.5, 0.5, 3.0) });
  params.Layers = layers;
  return params;
}

/// Points of the rim of Grid(n).
std::vector<int> RimOf(int n)
{
  std::vector<int> rim;
  for (int v = 0; v < (n + 1) * (n + 1); ++v)
  {
    const int i = v % (n + 1);
    const int j = v / (n + 1);
    if (i == 0 || j == 0 || i == n || j == n)
    {
      rim.push_back(v);
    }
  }
  return rim;
}

/// Columns of a motion of space, map(point, share of the way).
template <class Map>
LinkedSweepParams Columns(
  const Quads& source, const std::vector<int>& rim, int layers, const Map& map)
{
  LinkedSweepParams params;
  params.Rim = rim;
  for (const int v : rim)
  {
    PointMatrix column(layers + 1, 3);
    for (int k = 0; k <= layers; ++k)
    {
      column.row(k) =
        map(Vector3d(source.Points.row(v).transpose()), static_cast<double>(k) / layers)
          .transpose();
    }
    params.Columns.push_back(column);
  }
  return params;
}
}

TEST(Sweep, AStraightPathMakesPrisms)
{
  for (const double sign : { 1.0, -1.0 }) // both ways round: cells are right-handed
  {
    const Quads source = Grid(3);
    PathSweepParams params = Straight(5);
    params.Path(1, 2) *= sign;
    const auto swept = SweepAlongPath(source.Mesh, source.Points, params);
    ASSERT_TRUE(swept) << swept.Status.Message();
    EXPECT_EQ(swept->Mesh.NumCells(), 45);
    EXPECT_EQ(swept->Points.rows(), 16 * 6);
    const Cells cells = Measure(swept.Value);
    EXPECT_NEAR(cells.Volume, 3.0, 1e-12);
    EXPECT_NEAR(cells.Least, 3.0 / 45.0, 1e-12);
    EXPECT_TRUE(MeshTopology<3>::Make(swept->Mesh));
    EXPECT_EQ(swept->Points.topRows(16), source.Points);
  }
}

TEST(Sweep, TwistAndScaleTurnAndShrinkAboutThePath)
{
  const Quads source = Grid(2);
  PathSweepParams params = Straight(64);
  params.Twist = 90.0;
  params.Scale = 0.5;
  const auto swept = SweepAlongPath(source.Mesh, source.Points, params);
  ASSERT_TRUE(swept);
  // the corner (1, 0) lies at (0.5, -0.5) from the path: a quarter turn brings it to (0.5, 0.5)
  const Eigen::RowVector3d corner = swept->Points.row(64 * 9 + 2);
  EXPECT_LT((corner - Eigen::RowVector3d(0.75, 0.75, 3.0)).norm(), 1e-12);
  // sections of side 1 - t/2; twist alone changes nothing but what flat layers cost, O(h^2)
  EXPECT_NEAR(Measure(swept.Value).Volume, 3.0 * (1.0 - 0.125 / 0.75 * 2.5), 2e-3);
}

TEST(Sweep, ARingIsATorus)
{
  const int pieces = 96;
  PathSweepParams params;
  params.Path.resize(pieces + 1, 3);
  for (int i = 0; i <= pieces; ++i)
  {
    const double angle = 2.0 * Pi * (i % pieces) / pieces;
    params.Path.row(i) << 3.0 * std::cos(angle), 0.0, 3.0 * std::sin(angle);
  }
  params.Layers = pieces;
  const Quads source = Grid(3, Vector3d(2.5, -0.5, 0.0));
  const auto swept = SweepAlongPath(source.Mesh, source.Points, params);
  ASSERT_TRUE(swept) << swept.Status.Message();
  EXPECT_TRUE(swept->IsRing);
  EXPECT_EQ(swept->Points.rows(), pieces * 16);
  const auto topology = MeshTopology<3>::Make(swept->Mesh);
  ASSERT_TRUE(topology);
  EXPECT_EQ(topology->NumBoundaryFacets, 12 * pieces); // none across the ring
  const Cells cells = Measure(swept.Value);
  // Pappus, of a polygon of as many sides: area times perimeter sin(x) cos(x) / x^2 to second order
  EXPECT_NEAR(cells.Volume, 6.0 * Pi, 6.0 * Pi * 2.0 * std::pow(Pi / pieces, 2));
  EXPECT_GT(cells.Least, 0.0);
  params.Twist = 360.0;
  const auto twisted = SweepAlongPath(source.Mesh, source.Points, params);
  ASSERT_TRUE(twisted);
  EXPECT_GT(Measure(twisted.Value).Least, 0.0);
}

TEST(Sweep, FramesOfSpaceCurvesCloseAndTurnLittle)
{
  // a closed curve that is not plane: its frames would come back turned
  const int pieces = 240;
  PathSweepParams params;
  params.Path.resize(pieces + 1, 3);
  for (int i = 0; i <= pieces; ++i)
  {
    const double t = 2.0 * Pi * (i % pieces) / pieces;
    params.Path.row(i) << 3.0 * std::cos(t), 3.0 * std::sin(t), std::sin(2.0 * t);
  }
  params.Layers = pieces / 2;
  const Vector3d tangent = Vector3d(0.0, 3.0, 2.0).normalized();
  Quads source = Grid(2, Vector3d(-0.5, -0.5, 0.0));
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), tangent);
  for (Eigen::Index i = 0; i < source.Points.rows(); ++i)
  {
    source.Points.row(i) =
      (turn * Vector3d(source.Points.row(i).transpose()) + Vector3d(3.0, 0.0, 0.0)).transpose();
  }
  const auto swept = SweepAlongPath(source.Mesh, source.Points, params);
  ASSERT_TRUE(swept);
  const Cells cells = Measure(swept.Value);
  double length = 0.0;
  for (int i = 0; i < pieces; ++i)
  {
    length += (params.Path.row(i + 1) - params.Path.row(i)).norm();
  }
  EXPECT_NEAR(cells.Volume, length, 2e-3 * length); // a section of area 1, centred on the path
  EXPECT_GT(cells.Least, 0.0);
}

TEST(Sweep, ColumnsOfAnAffineMotionGiveItInside)
{
  // turn, stretch and shear: the map of the rim is the motion, so inner points follow exactly
  const auto motion = [](const Vector3d& p, double t)
  {
    const Eigen::AngleAxisd turn(0.7 * t, Vector3d(1.0, 2.0, 3.0).normalized());
    Vector3d q = turn * p;
    q[0] += 0.4 * t * q[1];
    return Vector3d((1.0 + 0.5 * t) * q + Vector3d(0.3 * t, 0.1 * t * t, 2.0 * t));
  };
  const int n = 5;
  const Quads source = Grid(n);
  const auto swept = SweepBetween(source.Mesh, source.Points, Columns(source, RimOf(n), 6, motion));
  ASSERT_TRUE(swept) << swept.Status.Message();
  for (int k = 0; k <= 6; ++k)
  {
    for (int v = 0; v < source.Mesh.NumPoints; ++v)
    {
      const Vector3d expected = motion(source.Points.row(v).transpose(), k / 6.0);
      EXPECT_LT(
        (swept->Points.row(k * source.Mesh.NumPoints + v).transpose() - expected).norm(), 1e-11);
    }
  }
  EXPECT_GT(Measure(swept.Value).Least, 0.0);
}

TEST(Sweep, ATargetIsMetAndCurvedColumnsAreFollowed)
{
  // from a square to a domed square, sides bulging: rims and ends to the bit, cells unfolded
  const int n = 8;
  const Quads source = Grid(n);
  const auto bulge = [](const Vector3d& p, double t)
  {
    const Vector3d centre(0.5, 0.5, 0.0);
    const Vector3d out = (1.0 + 0.8 * std::sin(Pi * t)) * (p - centre) + centre;
    return Vector3d(out[0], out[1], 2.0 * t);
  };
  LinkedSweepParams params = Columns(source, RimOf(n), 7, bulge);
  params.Target = source.Points;
  for (Eigen::Index v = 0; v < params.Target.rows(); ++v)
  {
    const double x = params.Target(v, 0);
    const double y = params.Target(v, 1);
    params.Target(v, 2) = 2.0 + 4.0 * x * (1.0 - x) * y * (1.0 - y);
  }
  const auto swept = SweepBetween(source.Mesh, source.Points, params);
  ASSERT_TRUE(swept);
  EXPECT_EQ(swept->Points.topRows(source.Mesh.NumPoints), source.Points);
  for (std::size_t i = 0; i < params.Rim.size(); ++i)
  {
    for (int k = 0; k <= 7; ++k)
    {
      EXPECT_EQ(
        swept->Points.row(k * source.Mesh.NumPoints + params.Rim[i]), params.Columns[i].row(k));
    }
  }
  const Eigen::Index middle = 7 * source.Mesh.NumPoints + n / 2 * (n + 1) + n / 2;
  EXPECT_EQ(swept->Points(middle, 2), 2.25);
  EXPECT_GT(Measure(swept.Value).Least, 0.0);
}

TEST(Sweep, WrongInputIsNamed)
{
  const Quads source = Grid(2);
  const auto along = [&](const PathSweepParams& params)
  { return SweepAlongPath(source.Mesh, source.Points, params).Status.Code; };
  PathSweepParams params = Straight(0);
  EXPECT_EQ(along(params), ErrorCode::InvalidParameter);
  params = Straight(4);
  params.Scale = 0.0;
  EXPECT_EQ(along(params), ErrorCode::InvalidParameter);
  params.Scale = std::nan("");
  EXPECT_EQ(along(params), ErrorCode::NonFiniteInput);
  params = Straight(4);
  params.Path.row(1) = params.Path.row(0);
  EXPECT_EQ(along(params), ErrorCode::InvalidTopology);
  params.Path.resize(1, 3);
  EXPECT_EQ(along(params), ErrorCode::EmptyInput);
  params.Path = Line({ Vector3d(0, 0, 0), Vector3d(0, 0, 1), Vector3d(0, 0, 0.5) });
  EXPECT_EQ(along(params), ErrorCode::InvalidTopology);
  params.Path =
    Line({ Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 0) });
  params.Twist = 10.0;
  EXPECT_EQ(along(params), ErrorCode::InvalidParameter);
  params = Straight(2000000000);
  EXPECT_EQ(along(params), ErrorCode::TooLarge);
  params = Straight(4);
  params.Progress = [](double) { return false; };
  EXPECT_EQ(along(params), ErrorCode::Aborted);
  Quads broken = source;
  broken.Mesh.Corners[3] = 99;
  EXPECT_EQ(SweepAlongPath(broken.Mesh, broken.Points, Straight(1)).Status.Code,
    ErrorCode::InvalidTopology);
  broken = source;
  broken.Points(4, 1) = std::nan("");
  EXPECT_EQ(
    SweepAlongPath(broken.Mesh, broken.Points, Straight(1)).Status.Code, ErrorCode::NonFiniteInput);
  EXPECT_EQ(SweepAlongPath({}, PointMatrix(), Straight(1)).Status.Code, ErrorCode::EmptyInput);

  const auto still = [](const Vector3d& p, double t) { return Vector3d(p[0], p[1], t); };
  const auto between = [&](const LinkedSweepParams& linked)
  { return SweepBetween(source.Mesh, source.Points, linked).Status.Code; };
  LinkedSweepParams linked = Columns(source, RimOf(2), 3, still);
  EXPECT_EQ(between(linked), ErrorCode::Ok);
  linked.Columns[2].conservativeResize(3, 3);
  EXPECT_EQ(between(linked), ErrorCode::SizeMismatch);
  linked = Columns(source, RimOf(2), 3, still);
  linked.Columns.pop_back();
  EXPECT_EQ(between(linked), ErrorCode::SizeMismatch);
  linked.Rim.pop_back();
  EXPECT_EQ(between(linked), ErrorCode::InvalidTopology);
  linked = Columns(source, RimOf(2), 3, still);
  linked.Columns[1](2, 2) = INFINITY;
  EXPECT_EQ(between(linked), ErrorCode::NonFiniteInput);
  linked = Columns(source, RimOf(2), 3, still);
  linked.Target = PointMatrix::Zero(4, 3);
  EXPECT_EQ(between(linked), ErrorCode::SizeMismatch);
  linked = Columns(source, RimOf(2), 3, still);
  linked.Progress = [](double) { return false; };
  EXPECT_EQ(between(linked), ErrorCode::Aborted);
}
