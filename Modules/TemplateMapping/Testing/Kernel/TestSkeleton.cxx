// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceCases.h"
#include "TemplateCases.h"
#include <knotwork/TemplateMapping/PatchGeometry.h>

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>
#include <set>

using namespace knotwork;

namespace
{
struct Cases
{
  Skeleton<2> Template = cases::CircleTemplate(101);
  Skeleton<2> Target = cases::LobedTarget({}, 20);
};

/// A plate with parameters, a sphere and a cube; the plate and the sphere have targets.
struct SurfaceCases
{
  Skeleton<3> Template{ cases::Plate(3), cases::Sphere(1), cases::Cube() };
  Skeleton<3> Target{ cases::Plate(4), cases::Sphere(2) };

  SurfaceCases()
  {
    this->Template[1].Id = this->Target[1].Id = 1;
    this->Template[2].Id = 2;
  }
};

template <typename Cases>
Status StatusAfter(const std::function<void(Cases&)>& damage)
{
  Cases cases;
  damage(cases);
  return CheckSkeletons(cases.Template, cases.Target);
}

template <typename Cases>
void ExpectError(
  ErrorCode code, const std::string& words, const std::function<void(Cases&)>& damage)
{
  SCOPED_TRACE(words);
  const Status status = StatusAfter<Cases>(damage);
  EXPECT_EQ(status.Code, code);
  EXPECT_NE(status.Detail.find(words), std::string::npos) << status.Message();
}
}

TEST(Skeleton, EveryFaultIsNamed)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(StatusAfter<Cases>([](Cases&) {}));
  ExpectError<Cases>(ErrorCode::EmptyInput, "template", [](Cases& c) { c.Template.clear(); });
  ExpectError<Cases>(ErrorCode::EmptyInput, "target", [](Cases& c) { c.Target.clear(); });
  ExpectError<Cases>(ErrorCode::InvalidTopology, "two patches of the template have the id 2",
    [](Cases& c) { c.Template[1].Id = 2; });
  ExpectError<Cases>(ErrorCode::InvalidTopology, "two patches of the target have the id 3",
    [](Cases& c) { c.Target[0].Id = 3; });
  ExpectError<Cases>(ErrorCode::InvalidTopology, "target patches 17, 23",
    [](Cases& c)
    {
      c.Target[1].Id = 23;
      c.Target[2].Id = 17;
    });
  ExpectError<Cases>(ErrorCode::InvalidTopology, "target patch 1 has 1 points",
    [](Cases& c) { c.Target[1].Points.conservativeResize(1, 2); });
  ExpectError<Cases>(ErrorCode::InvalidTopology, "template patch 4 has 0 points",
    [](Cases& c) { c.Template[4].Points.resize(0, 2); });
  ExpectError<Cases>(ErrorCode::InvalidTopology, "target patch 2 is a single point",
    [](Cases& c) { c.Target[2].Points.setConstant(0.5); });
  ExpectError<Cases>(ErrorCode::DimensionMismatch, "template patch 0 has points of 3 coordinates",
    [](Cases& c) { c.Template[0].Points = PointMatrix::Random(9, 3); });
  ExpectError<Cases>(ErrorCode::NonFiniteInput, "target patch 3, point 7",
    [&](Cases& c) { c.Target[3].Points(7, 1) = nan; });
  ExpectError<Cases>(ErrorCode::NonFiniteInput, "target patch 4, normal 5",
    [&](Cases& c) { c.Target[4].Normals(5, 0) = nan; });
  ExpectError<Cases>(ErrorCode::NonFiniteInput, "template patch 4, parameter 0",
    [&](Cases& c) { c.Template[4].Parameters = PointMatrix::Constant(101, 1, nan); });
  ExpectError<Cases>(ErrorCode::SizeMismatch, "target patch 4 has 20 points but 19",
    [](Cases& c) { c.Target[4].Normals.conservativeResize(19, 2); });
  ExpectError<Cases>(ErrorCode::InvalidParameter, "target patch 4, normal 6 is zero",
    [](Cases& c) { c.Target[4].Normals.row(6).setZero(); });
  ExpectError<Cases>(ErrorCode::InvalidParameter, "template patch 4, point 50",
    [](Cases& c)
    {
      c.Template[4].Parameters = Eigen::VectorXd::LinSpaced(101, 0.0, 1.0);
      c.Template[4].Parameters(50) = c.Template[4].Parameters(49);
    });
  ExpectError<Cases>(ErrorCode::InvalidParameter, "target patch 1, point 19",
    [](Cases& c) { c.Target[1].Parameters = Eigen::VectorXd::LinSpaced(20, 0.0, 1.01); });
  // An id without a target is a free patch, not a fault; orders need not agree.
  EXPECT_TRUE(StatusAfter<Cases>(
    [](Cases& c)
    {
      c.Target.erase(c.Target.begin() + 1);
      std::swap(c.Target[0], c.Target[3]);
    }));
}

TEST(Skeleton, NormalsOfPolylines_ExactOracle)
{
  // A regular polygon has normals through its centre at every vertex, at the seam too.
  SkeletonPatch<2> polygon;
  polygon.Points = cases::Polyline(
    13, [](double t) { return 2.0 + std::cos(2 * cases::Pi * t); },
    [](double t) { return -1.0 + std::sin(2 * cases::Pi * t); });
  const PointMatrix normals = UnitNormals(polygon);
  const PointMatrix radial = polygon.Points.rowwise() - Eigen::RowVector2d(2.0, -1.0);
  EXPECT_LE((normals - radial).cwiseAbs().maxCoeff(), 1e-14); // rounding of unit vectors

  // Open: the end pieces' own normals; a repeated point takes its neighbours'.
  SkeletonPatch<2> corner;
  corner.Points.resize(4, 2);
  corner.Points << 0, 0, 2, 0, 2, 0, 2, 2;
  const double half = std::sqrt(0.5);
  PointMatrix expected(4, 2);
  expected << 0, -1, half, -half, half, -half, 1, 0;
  EXPECT_LE((UnitNormals(corner) - expected).cwiseAbs().maxCoeff(), 1e-15);

  // A spike has no mean direction: that of the way in. Given normals are scaled to length 1.
  SkeletonPatch<2> spike;
  spike.Points.resize(3, 2);
  spike.Points << 0, 0, 1, 0, 0, 0;
  EXPECT_TRUE(UnitNormals(spike).allFinite());
  spike.Normals = PointMatrix::Constant(3, 2, -4.0);
  EXPECT_LE((UnitNormals(spike).array() + half).abs().maxCoeff(), 1e-15);
}

TEST(Skeleton, PatchIsLinearBetweenItsPoints_ExactOracle)
{
  PointMatrix points(3, 2);
  points << 0, 0, 1, 2, 5, 2;
  const PatchCurve curve(points, Eigen::Vector3d(1.0, 1.5, 3.5));
  const auto expect = [&](double t, double x, double y, double dx, double dy)
  {
    double position[2];
    double along[2];
    curve.Evaluate(t, position, along);
    EXPECT_DOUBLE_EQ(position[0], x) << t;
    EXPECT_DOUBLE_EQ(position[1], y) << t;
    EXPECT_DOUBLE_EQ(along[0], dx) << t;
    EXPECT_DOUBLE_EQ(along[1], dy) << t;
  };
  expect(1.0, 0, 0, 2, 4);
  expect(1.25, 0.5, 1, 2, 4);
  expect(1.5, 1, 2, 2, 0);
  expect(2.5, 3, 2, 2, 0);
  expect(3.5, 5, 2, 2, 0);
  expect(0.0, 0, 0, 2, 4); // clamped
  expect(9.0, 5, 2, 2, 0);
  EXPECT_EQ(curve.SampleParameters(0), Eigen::Vector3d(1.0, 1.5, 3.5));
  EXPECT_EQ(curve.SampleParameters(3), Eigen::Vector3d(1.0, 2.25, 3.5));
}

TEST(Skeleton, EveryFaultOfAMeshIsNamed)
{
  using S = SurfaceCases;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect =
    [](ErrorCode code, const std::string& words, const std::function<void(S&)>& damage)
  { ExpectError<S>(code, words, damage); };
  EXPECT_TRUE(StatusAfter<S>([](S&) {}));
  expect(ErrorCode::EmptyInput, "template", [](S& c) { c.Template.clear(); });
  expect(ErrorCode::EmptyInput, "target", [](S& c) { c.Target.clear(); });
  expect(ErrorCode::InvalidTopology, "two patches of the template have the id 2",
    [](S& c) { c.Template[0].Id = 2; });
  expect(
    ErrorCode::InvalidTopology, "target patches 7 have no patch", [](S& c) { c.Target[1].Id = 7; });
  expect(ErrorCode::InvalidTopology, "target patch 1 has 2 points; a patch needs at least 3",
    [](S& c) { c.Target[1].Points.conservativeResize(2, 3); });
  expect(ErrorCode::DimensionMismatch, "template patch 0 has points of 2 coordinates",
    [](S& c) { c.Template[0].Points = PointMatrix::Random(16, 2); });
  expect(ErrorCode::NonFiniteInput, "target patch 1, point 7",
    [&](S& c) { c.Target[1].Points(7, 2) = nan; });
  expect(ErrorCode::NonFiniteInput, "template patch 0, parameter 3",
    [&](S& c) { c.Template[0].Parameters(3, 1) = nan; });
  expect(ErrorCode::TooLarge, "target patch 1", [](S& c) { c.Target[1].Points(7, 2) = 1e61; });
  expect(ErrorCode::SizeMismatch, "16 points but 15 x 2 values as parameters",
    [](S& c) { c.Template[0].Parameters.conservativeResize(15, 2); });
  expect(ErrorCode::SizeMismatch, "25 points but 25 x 2 values as normals",
    [](S& c) { c.Target[0].Normals = PointMatrix::Ones(25, 2); });
  expect(ErrorCode::InvalidParameter, "target patch 0, normal 4 is zero",
    [](S& c)
    {
      c.Target[0].Normals = PointMatrix::Ones(25, 3);
      c.Target[0].Normals.row(4).setZero();
    });
  expect(ErrorCode::InvalidTopology, "template patch 2 has no triangles",
    [](S& c) { c.Template[2].Simplices.clear(); });
  expect(ErrorCode::InvalidTopology, "template patch 2, triangle 3 has the point 8 of 8",
    [](S& c) { c.Template[2].Simplices[3][1] = 8; });
  expect(ErrorCode::InvalidTopology, "template patch 2, triangle 4 has the point -1 of 8",
    [](S& c) { c.Template[2].Simplices[4][0] = -1; });
  expect(ErrorCode::InvalidTopology, "target patch 1, triangle 5 has a corner twice",
    [](S& c) { c.Target[1].Simplices[5][2] = c.Target[1].Simplices[5][0]; });
  expect(ErrorCode::InvalidTopology, "template patch 2, point 8 belongs to no triangle",
    [](S& c) { c.Template[2].Points.conservativeResizeLike(PointMatrix::Zero(9, 3)); });
  expect(ErrorCode::InvalidTopology, "target patch 0 lies on a line or a point",
    [](S& c)
    {
      for (Eigen::Index i = 0; i < 25; ++i)
      {
        c.Target[0].Points.row(i) = Eigen::RowVector3d(0.1, 0.2, 0.3) * double(i);
      }
    });
  for (const double offset : { 0.3, 100.0, 1e6 }) // coordinates are rounded by so much more
  {
    expect(ErrorCode::InvalidTopology, "target patch 0 lies on a line or a point",
      [&](S& c)
      {
        for (Eigen::Index i = 0; i < 25; ++i)
        {
          c.Target[0].Points.row(i) = Eigen::RowVector3d(0.13, 0.29, 0.31) * double(i) +
            Eigen::RowVector3d(offset, -0.7 * offset, 0.9 * offset);
        }
      });
  }
  expect(ErrorCode::InvalidTopology, "target patch 0 lies on a line or a point",
    [](S& c) { c.Target[0].Points.setConstant(0.5); });
  expect(ErrorCode::InvalidParameter, "template patch 0, triangles 0 and 3: parameters fold",
    [](S& c) { c.Template[0].Parameters.row(0) << 0.5, 0.3; });
  expect(ErrorCode::InvalidParameter,
    "template patch 0: the parameters of its points lie on a line",
    [](S& c) { c.Template[0].Parameters.col(1) = 2.0 * c.Template[0].Parameters.col(0); });
  expect(ErrorCode::InvalidParameter, "target patch 0, point 2: parameter 1.5",
    [](S& c) { c.Target[0].Parameters(2, 1) = 1.5; });

  // No faults: parameters on one side only, single triangles without area, free patches, edges of
  // three triangles, triangles turned either way.
  EXPECT_TRUE(StatusAfter<S>([](S& c) { c.Template[0].Parameters.resize(0, 2); }));
  EXPECT_TRUE(StatusAfter<S>([](S& c) { c.Target[0].Parameters.resize(0, 2); }));
  EXPECT_TRUE(StatusAfter<S>([](S& c) { c.Target[1].Points.row(0) = c.Target[1].Points.row(20); }));
  EXPECT_TRUE(StatusAfter<S>([](S& c) { c.Target.pop_back(); }));
  EXPECT_TRUE(StatusAfter<S>([](S& c) { c.Template[2].Simplices.push_back({ 0, 7, 3 }); }));
  EXPECT_TRUE(StatusAfter<S>(
    [](S& c) { std::swap(c.Template[0].Simplices[3][0], c.Template[0].Simplices[3][1]); }));
}

TEST(Skeleton, NormalsOfMeshes_ExactOracle)
{
  // A plate; turning some of its triangles or repeating points changes nothing but the sign.
  SkeletonPatch<3> plate = cases::Plate(3);
  const PointMatrix up = Eigen::RowVector3d(0, 0, 1).replicate(16, 1);
  EXPECT_EQ(UnitNormals(plate), up);
  std::swap(plate.Simplices[7][0], plate.Simplices[7][1]);
  std::swap(plate.Simplices[16][1], plate.Simplices[16][2]);
  EXPECT_EQ(UnitNormals(plate), up);

  // Corners of the cube: the diagonals of the cells where as many triangles of each face meet; the
  // weights are areas, so the mean is between the faces' normals as areas say.
  const SkeletonPatch<3> cube = cases::Cube();
  const PointMatrix normals = UnitNormals(cube);
  PointMatrix sums = PointMatrix::Zero(8, 3);
  for (std::size_t t = 0; t < 12; ++t)
  {
    const int direction = t < 4 ? 2 : t < 8 ? 1 : 0;
    const double sign = (t / 2) % 2 ? 1.0 : -1.0;
    for (int corner : cube.Simplices[t])
    {
      sums(corner, direction) += sign; // all areas are equal
    }
  }
  EXPECT_LE((normals - sums.rowwise().normalized()).cwiseAbs().maxCoeff(), 1e-15);

  // Loose triangles with corners of their own: the same normals at equal coordinates.
  SkeletonPatch<3> loose;
  loose.Points.resize(36, 3);
  for (int t = 0; t < 12; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      loose.Points.row(3 * t + k) =
        cube.Points.row(cube.Simplices[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)]);
    }
    loose.Simplices.push_back({ 3 * t, 3 * t + 1, 3 * t + 2 });
  }
  const PointMatrix looseNormals = UnitNormals(loose);
  for (int t = 0; t < 12; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int corner = cube.Simplices[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)];
      EXPECT_EQ(looseNormals.row(3 * t + k), normals.row(corner));
    }
  }

  // Sphere: the radii, to a third of the edge length (0.1 radians at four cuts).
  SkeletonPatch<3> sphere = cases::Sphere(4);
  const PointMatrix radii =
    (sphere.Points.rowwise() - Eigen::RowVector3d(0.5, 0.5, 0.5)).rowwise().normalized();
  EXPECT_LE((UnitNormals(sphere) - radii).rowwise().norm().maxCoeff(), 0.033);
  sphere.Normals = -3.0 * radii;
  EXPECT_LE((UnitNormals(sphere) + radii).cwiseAbs().maxCoeff(), 1e-15);

  // A point whose triangles have no area, and one where two sheets cancel.
  SkeletonPatch<3> odd;
  odd.Points.resize(5, 3);
  odd.Points << 0, 0, 0, 2, 0, 0, 0, 2, 0, 1, 0, 0, 1.5, 0, 0;
  odd.Simplices = { { 0, 1, 2 }, { 0, 3, 1 }, { 3, 4, 1 } };
  EXPECT_EQ(UnitNormals(odd), Eigen::RowVector3d(0, 0, 1).replicate(5, 1));
  SkeletonPatch<3> sheets;
  sheets.Points.resize(3, 3);
  sheets.Points << 0, 0, 0, 2, 0, 0, 0, 2, 0;
  sheets.Simplices = { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 } };
  EXPECT_EQ(
    UnitNormals(sheets).cwiseAbs(), PointMatrix(Eigen::RowVector3d(0, 0, 1).replicate(3, 1)));
}

TEST(Skeleton, SamplesOfAMeshCutItsTriangles_PropertyOracle)
{
  for (const SkeletonPatch<3>& patch : { cases::Cube(), cases::Sphere(1), cases::Plate(3) })
  {
    const PatchSurface surface(patch);
    std::vector<std::array<int, 3>> simplices;
    PointMatrix own = surface.SamplePlaces(0, simplices);
    EXPECT_EQ(simplices, patch.Simplices);
    ASSERT_EQ(own.rows(), patch.Points.rows());
    for (Eigen::Index i = 0; i < own.rows(); ++i)
    {
      Eigen::RowVector3d point;
      surface.Evaluate(own.row(i).data(), point.data(), nullptr);
      EXPECT_EQ(point, patch.Points.row(i));
    }
    double area = 0.0;
    const auto addArea = [&](const PointMatrix& points, const MeshTriangle& t)
    {
      const Eigen::RowVector3d ab = points.row(t[1]) - points.row(t[0]);
      const Eigen::RowVector3d ac = points.row(t[2]) - points.row(t[0]);
      area += std::sqrt(ab.squaredNorm() * ac.squaredNorm() - std::pow(ab.dot(ac), 2)) / 2;
    };
    for (const MeshTriangle& t : patch.Simplices)
    {
      addArea(patch.Points, t);
    }
    const double whole = area;
    for (const int count : { 10, 100, 1000 })
    {
      SCOPED_TRACE(count);
      const PointMatrix places = surface.SamplePlaces(count, simplices);
      EXPECT_GE(places.rows(), count);
      PointMatrix points(places.rows(), 3);
      for (Eigen::Index i = 0; i < places.rows(); ++i)
      {
        surface.Evaluate(places.row(i).data(), points.row(i).data(), nullptr);
      }
      EXPECT_EQ(points.topRows(patch.Points.rows()), patch.Points);
      // Shared edges are shared: as many open edges as before, all samples different, same area.
      EXPECT_EQ(simplices.size() % patch.Simplices.size(), 0U);
      const auto cuts = static_cast<long>(
        std::lround(std::sqrt(double(simplices.size()) / double(patch.Simplices.size()))));
      const auto open = [](const std::vector<MeshTriangle>& triangles)
      {
        long edges = 0;
        for (const MeshTriangle& t : TriangleNeighbours(triangles))
        {
          edges += std::count(t.begin(), t.end(), -1);
        }
        return edges;
      };
      EXPECT_EQ(open(simplices), cuts * open(patch.Simplices));
      const std::vector<int> first = FirstOfEqualPoints(points);
      for (std::size_t i = 0; i < first.size(); ++i)
      {
        EXPECT_EQ(first[i], static_cast<int>(i));
      }
      area = 0.0;
      for (const MeshTriangle& t : simplices)
      {
        addArea(points, t);
      }
      EXPECT_NEAR(area, whole, 1e-12);
    }
  }
}

TEST(Skeleton, TargetParametersAreFoundInTheTemplate_ExactOracle)
{
  const SkeletonPatch<3> plate = cases::Plate(4);
  const PatchSurface surface(plate);
  SkeletonPatch<3> target = cases::Plate(7);
  const PointMatrix places = surface.FirstPlaces(target);
  ASSERT_EQ(places.rows(), 64);
  for (Eigen::Index i = 0; i < 64; ++i)
  {
    Eigen::RowVector3d point;
    surface.Evaluate(places.row(i).data(), point.data(), nullptr);
    EXPECT_LE((point - target.Points.row(i)).norm(), 1e-15);
  }
  target.Parameters.resize(0, 2);
  EXPECT_EQ(surface.FirstPlaces(target).rows(), 0);
  EXPECT_EQ(PatchSurface(cases::Cube()).FirstPlaces(plate).rows(), 0);
}
