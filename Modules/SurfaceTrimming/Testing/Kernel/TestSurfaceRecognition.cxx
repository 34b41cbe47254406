// SPDX-License-Identifier: BSD-3-Clause
// Oracle: surfaces whose points are computed from their parameters.
#include "ProfiledMeshes.h"
#include "RegionDivision.h"
#include "SurfaceRecognition.h"
#include <knotwork/SplineCore/FitAnalyticSurface.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <string>

namespace knotwork
{
namespace
{
using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double Pi = 3.14159265358979323846;

const Vector3d TiltedAxis =
  Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()) * Vector3d::UnitZ();

SurfaceRecognition Recognize(const TriangleMesh& mesh, double tolerance = 0.0)
{
  const auto surface = CheckSurface(mesh);
  EXPECT_TRUE(surface) << surface.Status.Message();
  RecognitionParams params;
  params.Tolerance = tolerance;
  auto result = RecognizeSurfaces(surface.Value, params);
  EXPECT_TRUE(result) << result.Status.Message();
  return result.Value;
}

/// Planes, cylinders, spheres, cones, tori, free form.
using Counts = std::array<int, NumSurfaceTypes>;

const RecognizedRegion* Find(const SurfaceRecognition& result, SurfaceType type)
{
  for (const RecognizedRegion& region : result.Regions)
  {
    if (region.Surface.Type == type)
    {
      return &region;
    }
  }
  return nullptr;
}

TriangleMesh UnitCube()
{
  TriangleMesh cube;
  cube.Points.resize(8, 3);
  cube.Points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1;
  cube.Triangles = { { 0, 2, 1 }, { 0, 3, 2 }, { 4, 5, 6 }, { 4, 6, 7 }, { 0, 1, 5 }, { 0, 5, 4 },
    { 1, 2, 6 }, { 1, 6, 5 }, { 2, 3, 7 }, { 2, 7, 6 }, { 3, 0, 4 }, { 3, 4, 7 } };
  return cube;
}

/// Both, with points of their own.
TriangleMesh Together(const TriangleMesh& first, const TriangleMesh& second)
{
  TriangleMesh both = first;
  const auto count = static_cast<int>(first.Points.rows());
  both.Points.conservativeResize(count + second.Points.rows(), Eigen::NoChange);
  both.Points.bottomRows(second.Points.rows()) = second.Points;
  for (const auto& corners : second.Triangles)
  {
    both.Triangles.push_back({ corners[0] + count, corners[1] + count, corners[2] + count });
  }
  return both;
}

/// Moves every point by up to a radius.
void Shake(TriangleMesh& mesh, double radius, std::mt19937& random)
{
  std::normal_distribution<double> normal;
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    const Vector3d way(normal(random), normal(random), normal(random));
    mesh.Points.row(i) +=
      radius * std::cbrt(random() / 4294967296.0) * way.normalized().transpose();
  }
}

TEST(SurfaceRecognition, PolyhedraArePlanes)
{
  const TriangleMesh cube = UnitCube();
  EXPECT_EQ(Recognize(cube).NumOfType, (Counts{ 6, 0, 0, 0, 0, 0 }));
  TriangleMesh other = cube;
  other.Points.rowwise() += Eigen::RowVector3d::Ones();
  const TriangleMesh touching = Together(cube, other); // in a point
  const auto both = RecognizeSurfaces(touching);
  ASSERT_TRUE(both) << both.Status.Message();
  EXPECT_EQ(both->NumOfType, (Counts{ 12, 0, 0, 0, 0, 0 }));
  TriangleMesh tetrahedron;
  tetrahedron.Points.resize(4, 3);
  tetrahedron.Points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  tetrahedron.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } };
  EXPECT_EQ(Recognize(tetrahedron).NumOfType, (Counts{ 4, 0, 0, 0, 0, 0 }));
}

TEST(SurfaceRecognition, StripsOfACylinderAreOneFace)
{
  const auto result = Recognize(Turned({ 0, 0 }, { { { 1, 0 } }, { { 1, 2 } }, { { 0, 2 } } }, 48));
  EXPECT_EQ(result.NumOfType, (Counts{ 2, 1, 0, 0, 0, 0 }));
  const RecognizedRegion* region = Find(result, SurfaceType::Cylinder);
  ASSERT_NE(region, nullptr);
  EXPECT_NEAR(region->Surface.Radius, 1.0, 1e-10);
  EXPECT_NEAR(std::abs(region->Surface.Axis.dot(TiltedAxis)), 1.0, 1e-10);
  EXPECT_LT((Vector3d(3, 1, 2) - region->Surface.Point).cross(TiltedAxis).norm(), 1e-10);
  EXPECT_LT(region->MaxDistance, 1e-10);
  EXPECT_NEAR(region->MaxSag, 1.0 - std::cos(Pi / 48), 1e-10);
  EXPECT_FALSE(region->Reversed);
}

/// A cylinder of height 2 between two rims of as many points each, with flat ends.
/// @param rims  steps of the points, of 48 in a turn, ascending.
TriangleMesh CylinderOfRims(const std::array<std::vector<double>, 2>& rims)
{
  constexpr double sides = 48.0;
  const auto count = static_cast<int>(rims[0].size());
  TriangleMesh mesh;
  mesh.Points.resize(2 * count + 2, 3);
  for (int i = 0; i < count; ++i)
  {
    for (int r = 0; r < 2; ++r)
    {
      const double angle =
        2.0 * Pi * rims[static_cast<std::size_t>(r)][static_cast<std::size_t>(i)] / sides;
      mesh.Points.row(r * count + i) << std::cos(angle), std::sin(angle), 2.0 * r;
    }
  }
  mesh.Points.bottomRows(2) << 0, 0, 0, 0, 0, 2;
  int a = 0;
  int b = 0;
  const auto step = [&](int r, int i)
  {
    return rims[static_cast<std::size_t>(r)][static_cast<std::size_t>(i % count)] +
      (i < count ? 0.0 : sides);
  };
  while (a < count || b < count)
  {
    const bool isLower = b == count || (a < count && step(0, a + 1) <= step(1, b + 1));
    const int next = isLower ? (a + 1) % count : count + (b + 1) % count;
    mesh.Triangles.push_back({ a % count, next, count + b % count });
    (isLower ? a : b) += 1;
  }
  for (int i = 0; i < count; ++i)
  {
    mesh.Triangles.push_back({ 2 * count, (i + 1) % count, i });
    mesh.Triangles.push_back({ 2 * count + 1, count + i, count + (i + 1) % count });
  }
  return mesh;
}

/// Gaps of a quarter turn, not above each other: two triangles beside them have their corners on
/// the cylinder alone.
std::array<std::vector<double>, 2> RimsWithGaps()
{
  std::array<std::vector<double>, 2> rims;
  for (int i = 0; i < 48; ++i)
  {
    if (i <= 3 || i >= 15)
    {
      rims[0].push_back(i);
    }
    if (i <= 9 || i >= 21)
    {
      rims[1].push_back(i);
    }
  }
  return rims;
}

TEST(SurfaceRecognition, WideTrianglesBelongToTheCylinder)
{
  const auto result = Recognize(CylinderOfRims(RimsWithGaps()));
  EXPECT_EQ(result.NumOfType, (Counts{ 2, 1, 0, 0, 0, 0 }));
  const RecognizedRegion* cylinder = Find(result, SurfaceType::Cylinder);
  ASSERT_NE(cylinder, nullptr);
  EXPECT_NEAR(cylinder->Surface.Radius, 1.0, 1e-9);
  EXPECT_EQ(cylinder->Triangles.size(), 74u); // all but the flat ends'
  EXPECT_GT(cylinder->MaxSag, 0.05);
}

/// With noise two triangles of a gap above a gap are one plane, too.
TEST(SurfaceRecognition, WideTrianglesWithNoiseBelongToTheCylinder)
{
  std::mt19937 random(1);
  std::array<std::vector<double>, 2> rims = RimsWithGaps();
  for (std::vector<double>& rim : rims)
  {
    rim.erase(std::remove_if(
                rim.begin(), rim.end(), [](double step) { return step > 30.0 && step < 38.0; }),
      rim.end());
  }
  *std::find(rims[1].begin(), rims[1].end(), 38.0) += 0.05;
  for (int i = 0; i < 5; ++i)
  {
    TriangleMesh mesh = CylinderOfRims(rims);
    Shake(mesh, 0.25 * 3.5e-3, random); // of a tolerance of about a thousandth of the diagonal
    EXPECT_EQ(Recognize(mesh).NumOfType, (Counts{ 2, 1, 0, 0, 0, 0 })) << "mesh " << i;
  }
}

/// One strip of a cylinder above a hollow fillet: it lies on tori too.
TEST(SurfaceRecognition, StripAboveAFilletIsACylinder)
{
  const auto result = Recognize(Turned({ 0, 0 },
    { { { 3, 0 } }, { { 3, 1 } }, { { 2, 1 } }, { { 1, 2 }, { 2, 2 }, 12 }, { { 1, 3 } },
      { { 0, 3 } } },
    48));
  EXPECT_EQ(result.NumOfType, (Counts{ 3, 2, 0, 0, 1, 0 }));
}

TEST(SurfaceRecognition, ShortCylinderIsNoSphere)
{
  // two circles lie on a sphere, too; the rulings tell
  const auto result =
    Recognize(Turned({ 0, 0 }, { { { 1, 0 } }, { { 1, 0.1 } }, { { 0, 0.1 } } }, 48));
  EXPECT_EQ(result.NumOfType, (Counts{ 2, 1, 0, 0, 0, 0 }));
}

/// A piece of a cylinder has a facet of the flat end: the cylinder takes the others, the end takes
/// that one.
TEST(RegionDivision, PiecesJoinWithoutWhatLiesOnAThirdSurface)
{
  std::mt19937 random(1);
  TriangleMesh mesh = Turned({ 0, 0 }, { { { 1, 0 } }, { { 1, 2 } }, { { 0, 2 } } }, 48);
  Shake(mesh, 1e-3, random);
  const auto surface = CheckSurface(mesh);
  ASSERT_TRUE(surface);
  const FacetClusters facets = FindFacetClusters(surface.Value, 1e-9);
  const SurfaceGrowth growth(surface.Value, facets, 4e-3, 2e-2);
  enum
  {
    Side,
    Piece,
    Top,
    Bottom
  };
  Division division;
  division.Regions.resize(4);
  const Vector3d foot(3, 1, 2);
  const auto setSurface = [&](int region, SurfaceType type, double height, const Vector3d& axis)
  {
    AnalyticSurface& on = division.Regions[std::size_t(region)].Surface;
    on.Type = type;
    on.Point = foot + height * TiltedAxis;
    on.Axis = axis;
    on.Radius = 1.0;
  };
  setSurface(Side, SurfaceType::Cylinder, 0.0, TiltedAxis);
  setSurface(Piece, SurfaceType::Cylinder, 0.0, TiltedAxis);
  setSurface(Top, SurfaceType::Plane, 2.0, TiltedAxis);
  setSurface(Bottom, SurfaceType::Plane, 0.0, -TiltedAxis);
  const Vector3d across = TiltedAxis.unitOrthogonal();
  int moved = -1; // the facet of the end
  for (std::size_t c = 0; c < facets.Clusters.size(); ++c)
  {
    const FlatPiece& piece = facets.Clusters[c].Piece;
    const double along = piece.Normal.dot(TiltedAxis);
    const bool isAtPiece = (piece.Centre - foot).dot(across) > 0.6;
    int region = along > 0.5 ? Top : along < -0.5 ? Bottom : isAtPiece ? Piece : Side;
    if (region == Top && isAtPiece && moved < 0)
    {
      moved = int(c);
      region = Piece;
    }
    division.RegionOfCluster.push_back(region);
    division.Regions[std::size_t(region)].Clusters.push_back(int(c));
  }
  ASSERT_GE(moved, 0);
  for (GrownRegion& region : division.Regions)
  {
    region.NumPoints = int(region.Clusters.size());
  }
  const auto before = division.RegionOfCluster;
  JoinEqual(surface.Value, facets, 4e-3, false, growth, division);
  for (std::size_t c = 0; c < before.size(); ++c)
  {
    const int expected = int(c) == moved ? Top : before[c] == Piece ? Side : before[c];
    EXPECT_EQ(division.RegionOfCluster[c], expected) << "cluster " << c;
  }
  EXPECT_TRUE(division.Regions[Piece].Clusters.empty());
}

/// One row of facets lies on a sphere, too.
TEST(SurfaceRecognition, ChamfersAreCones)
{
  std::mt19937 random(1);
  for (const double width : { 0.04, 0.08, 0.2, 0.4 })
  {
    for (const double share : { 0.0, 0.25 }) // of the tolerance
    {
      TriangleMesh mesh = Turned({ 0, 0 },
        { { { 1, 0 } }, { { 1, 1 } }, { { 1 - width, 1 + width } }, { { 0, 1 + width } } }, 48);
      Shake(mesh, share * 3e-3, random);
      EXPECT_EQ(Recognize(mesh).NumOfType, (Counts{ 2, 1, 0, 1, 0, 0 })) << width << ", " << share;
    }
  }
}

TEST(SurfaceRecognition, ConeWithTipAndFrustum)
{
  const auto result =
    Recognize(Turned({ 0, 0 }, { { { 2, 0 } }, { { 1, 1 } }, { { 0, 1.5 } } }, 64));
  EXPECT_EQ(result.NumOfType, (Counts{ 1, 0, 0, 2, 0, 0 }));
  const RecognizedRegion* region = Find(result, SurfaceType::Cone);
  ASSERT_NE(region, nullptr);
  EXPECT_NEAR(region->Surface.Angle, Pi / 4, 1e-9);
}

TEST(SurfaceRecognition, SphereCapAndTangentFillet)
{
  const auto dome =
    Recognize(Turned({ 0, 0 }, { { { 1, 0 } }, { { 1, 1 } }, { { 0, 2 }, { 0, 1 }, 12 } }, 48));
  EXPECT_EQ(dome.NumOfType, (Counts{ 1, 1, 1, 0, 0, 0 }));
  const auto fillet = Recognize(Turned(
    { 0, 0 }, { { { 1, 0 } }, { { 1, 1 } }, { { 0.8, 1.2 }, { 0.8, 1 }, 5 }, { { 0, 1.2 } } }, 48));
  EXPECT_EQ(fillet.NumOfType, (Counts{ 2, 1, 0, 0, 1, 0 }));
  const RecognizedRegion* region = Find(fillet, SurfaceType::Torus);
  ASSERT_NE(region, nullptr);
  EXPECT_NEAR(region->Surface.Radius, 0.8, 1e-9);
  EXPECT_NEAR(region->Surface.MinorRadius, 0.2, 1e-9);
}

TEST(SurfaceRecognition, RingIsATorus)
{
  const Vector2d centre(2, 0);
  const auto result = Recognize(Turned({ 3, 0 },
    { { { 2, 1 }, centre, 8 }, { { 1, 0 }, centre, 8 }, { { 2, -1 }, centre, 8 },
      { { 3, 0 }, centre, 8 } },
    64));
  EXPECT_EQ(result.NumOfType, (Counts{ 0, 0, 0, 0, 1, 0 }));
}

TEST(SurfaceRecognition, NoiseOfAQuarterOfTheTolerance)
{
  const double tolerance = 3.5e-3; // about a thousandth of the diagonal
  const auto result = Recognize(
    Turned({ 0, 0 }, { { { 1, 0 } }, { { 1, 2 } }, { { 0, 2 } } }, 48, 0.25 * tolerance / 2.0),
    tolerance);
  EXPECT_EQ(result.NumOfType[static_cast<int>(SurfaceType::Cylinder)], 1);
  EXPECT_EQ(result.NumOfType[static_cast<int>(SurfaceType::Plane)], 2);
}

TEST(SurfaceRecognition, OtherShapesAreOfFreeForm)
{
  TriangleMesh mesh; // a saddle with waves
  constexpr int n = 20;
  mesh.Points.resize(n * n, 3);
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const double x = 2.0 * i / (n - 1) - 1.0;
      const double y = 2.0 * j / (n - 1) - 1.0;
      mesh.Points.row(j * n + i) << x, y,
        0.3 * x * x * x - 0.4 * y * y + 0.2 * std::sin(3.0 * x * y);
      if (i > 0 && j > 0)
      {
        const int d = j * n + i;
        mesh.Triangles.push_back({ d - n - 1, d - n, d });
        mesh.Triangles.push_back({ d - n - 1, d, d - 1 });
      }
    }
  }
  const auto result = Recognize(mesh);
  ASSERT_FALSE(result.Regions.empty());
  EXPECT_EQ(result.Regions.front().Surface.Type, SurfaceType::FreeForm);
  EXPECT_GT(result.Regions.front().Triangles.size(), mesh.Triangles.size() / 2);
}

TEST(SurfaceRecognition, PartsAndTheirTrianglesKeepTheirNumbers)
{
  // a cylinder whose triangles have their corners for themselves, a cone, and between them a
  // triangle of two equal corners
  const TriangleMesh cylinder = Turned({ 0, 0 }, { { { 1, 0 } }, { { 1, 2 } }, { { 0, 2 } } }, 48);
  const TriangleMesh cone = Turned({ 0, 0 }, { { { 2, 0 } }, { { 0, 2 } } }, 64);
  const auto numOfCylinder = static_cast<Eigen::Index>(cylinder.Triangles.size());
  TriangleMesh mesh;
  mesh.Points.resize(3 * numOfCylinder + cone.Points.rows(), 3);
  for (Eigen::Index t = 0; t < numOfCylinder; ++t)
  {
    const int first = static_cast<int>(3 * t);
    for (int k = 0; k < 3; ++k)
    {
      const auto& corners = cylinder.Triangles[static_cast<std::size_t>(t)];
      mesh.Points.row(first + k) = cylinder.Points.row(corners[static_cast<std::size_t>(k)]);
    }
    mesh.Triangles.push_back({ first, first + 1, first + 2 });
  }
  mesh.Triangles.push_back({ 0, 1, 1 });
  mesh.Points.bottomRows(cone.Points.rows()) =
    cone.Points.rowwise() + Eigen::RowVector3d(20.0, 0.0, 0.0);
  for (const auto& corners : cone.Triangles)
  {
    const int first = static_cast<int>(3 * numOfCylinder);
    mesh.Triangles.push_back({ corners[0] + first, corners[1] + first, corners[2] + first });
  }
  const auto result = RecognizeSurfaces(mesh);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->NumOfType, (Counts{ 3, 1, 0, 1, 0, 0 }));
  ASSERT_EQ(result->RegionOfTriangle.size(), mesh.Triangles.size());
  ASSERT_EQ(result->Regions.size(), 5u);
  const auto none = static_cast<std::size_t>(numOfCylinder);
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const int region = result->RegionOfTriangle[t];
    if (t == none)
    {
      EXPECT_EQ(region, -1);
      continue;
    }
    ASSERT_GE(region, 0);
    EXPECT_EQ(region < 3, t < none); // part by part
    const auto& own = result->Regions[static_cast<std::size_t>(region)].Triangles;
    EXPECT_TRUE(std::binary_search(own.begin(), own.end(), static_cast<int>(t)));
  }
  const double diagonal =
    (mesh.Points.colwise().maxCoeff() - mesh.Points.colwise().minCoeff()).norm();
  EXPECT_NEAR(result->Tolerance, 1e-3 * diagonal, 1e-12); // of the whole
}

TEST(SurfaceRecognition, MeshesThatAreNone)
{
  EXPECT_EQ(RecognizeSurfaces(TriangleMesh()).Status.Code, ErrorCode::EmptyInput);
  TriangleMesh mesh = Turned({ 0, 0 }, { { { 1, 0 } }, { { 0, 2 } } }, 12);
  mesh.Points(3, 1) = std::nan("");
  EXPECT_EQ(RecognizeSurfaces(mesh).Status.Code, ErrorCode::NonFiniteInput);
  mesh.Points(3, 1) = 0.0;
  mesh.Triangles[2][0] = 100000;
  EXPECT_EQ(RecognizeSurfaces(mesh).Status.Code, ErrorCode::InvalidTopology);
}

/// One face of the wave, not one of every strip or of every bend; its direction or axis is right.
TEST(SurfaceRecognition, WavesAreOneSurface_Exact)
{
  const auto tilt = Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized());
  const auto bar = Recognize(WavyBar(48, 2.0));
  EXPECT_EQ(bar.NumOfType, (Counts{ 5, 0, 0, 0, 0, 0, 1, 0 }));
  if (const RecognizedRegion* wave = Find(bar, SurfaceType::Extrusion))
  {
    EXPECT_LT(wave->Surface.Axis.cross(tilt * Vector3d::UnitY()).norm(), 1e-5);
    EXPECT_LT(wave->MaxDistance, 0.35 * bar.Tolerance);
    EXPECT_EQ(wave->Triangles.size(), 96u);
  }
  const auto vase = Recognize(Vase(48, 64));
  EXPECT_EQ(vase.NumOfType, (Counts{ 2, 0, 0, 0, 0, 0, 0, 1 }));
  if (const RecognizedRegion* wave = Find(vase, SurfaceType::Revolution))
  {
    EXPECT_LT(wave->Surface.Axis.cross(TiltedAxis).norm(), 1e-5);
    EXPECT_LT(wave->MaxDistance, 0.35 * vase.Tolerance);
  }
}

/// Points around a gear: involute flanks between arcs at tips and roots.
/// @param perFlank  points of a flank.
std::vector<Vector2d> GearOutline(int teeth, double pressure, int perFlank)
{
  const double base = std::cos(pressure) * teeth / 2.0; // of module 1
  const double root = std::max(teeth / 2.0 - 1.25, base);
  const double tip = teeth / 2.0 + 1.0;
  const auto involute = [&](double radius)
  {
    const double roll = std::sqrt(radius * radius / (base * base) - 1.0);
    return roll - std::atan(roll);
  };
  const double half = Pi / (2.0 * teeth) + std::tan(pressure) - pressure; // of a tooth at the base
  std::vector<Vector2d> outline;
  for (int tooth = 0; tooth < teeth; ++tooth)
  {
    const double middle = 2.0 * Pi * tooth / teeth;
    for (int side = -1; side <= 1; side += 2)
    {
      for (int i = 0; i < perFlank; ++i)
      {
        const double share = static_cast<double>(i) / (perFlank - 1);
        const double radius = side < 0 ? root + share * (tip - root) : tip - share * (tip - root);
        const double angle = middle + side * (half - involute(radius));
        outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
      }
    }
  }
  return outline;
}

/// A solid between two outlines that are seen as a star from the axis.
TriangleMesh Extruded(const std::vector<Vector2d>& outline, double height)
{
  const auto count = static_cast<int>(outline.size());
  const Eigen::AngleAxisd tilt(0.7, Vector3d(1, 2, -1).normalized());
  TriangleMesh mesh;
  mesh.Points.resize(2 * count + 2, 3);
  mesh.Points.row(2 * count).setZero();
  mesh.Points.row(2 * count + 1) = (tilt * Vector3d(0, 0, height)).transpose();
  for (int i = 0; i < count; ++i)
  {
    const Vector2d& at = outline[static_cast<std::size_t>(i)];
    const int next = (i + 1) % count;
    mesh.Points.row(i) = (tilt * Vector3d(at.x(), at.y(), 0)).transpose();
    mesh.Points.row(count + i) = (tilt * Vector3d(at.x(), at.y(), height)).transpose();
    mesh.Triangles.push_back({ i, next, count + next });
    mesh.Triangles.push_back({ i, count + next, count + i });
    mesh.Triangles.push_back({ next, i, 2 * count });
    mesh.Triangles.push_back({ count + i, count + next, 2 * count + 1 });
  }
  return mesh;
}

/// A flat and the first strips of the roundings beside it lie on one wide cylinder exactly.
std::vector<Vector2d> RoundedSquare(int perQuarter)
{
  std::vector<Vector2d> outline;
  for (int corner = 0; corner < 4; ++corner)
  {
    const double begin = Pi / 2.0 * corner;
    const Vector2d middle =
      std::sqrt(2.0) * Vector2d(std::cos(begin + Pi / 4.0), std::sin(begin + Pi / 4.0));
    for (int i = 0; i <= perQuarter; ++i)
    {
      const double angle = begin + Pi / 2.0 * i / perQuarter;
      outline.emplace_back(middle + Vector2d(std::cos(angle), std::sin(angle)));
    }
  }
  return outline;
}

TEST(SurfaceRecognition, FlatsBetweenRoundingsArePlanes_Exact)
{
  constexpr int perQuarter = 10;
  const auto result = Recognize(Extruded(RoundedSquare(perQuarter), 8.0));
  EXPECT_EQ(result.NumOfType, (Counts{ 6, 4, 0, 0, 0, 0 }));
  for (const RecognizedRegion& region : result.Regions)
  {
    if (region.Surface.Type == SurfaceType::Cylinder)
    {
      EXPECT_NEAR(region.Surface.Radius, 1.0, 1e-9);
      EXPECT_EQ(region.Triangles.size(), 2u * perQuarter);
    }
  }
}

TEST(SurfaceRecognition, FlatsBetweenRoundingsWithNoiseArePlanes)
{
  std::mt19937 random(1);
  for (int i = 0; i < 5; ++i)
  {
    TriangleMesh mesh = Extruded(RoundedSquare(9), 2.0);
    Shake(mesh, 0.25 * 5.4e-3, random);
    EXPECT_EQ(Recognize(mesh).NumOfType, (Counts{ 6, 4, 0, 0, 0, 0 })) << "mesh " << i;
  }
}

/// Largest distance of points from a closed polygon.
double FarthestFrom(const std::vector<Vector2d>& polygon, const std::vector<Vector2d>& points)
{
  double farthest = 0.0;
  for (const Vector2d& point : points)
  {
    double nearest = HUGE_VAL;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
      const Vector2d& from = polygon[i];
      const Vector2d side = polygon[(i + 1) % polygon.size()] - from;
      const double at = std::clamp((point - from).dot(side) / side.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (point - from - at * side).norm());
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

int NumSame(const Counts& a, const Counts& b)
{
  int same = 0;
  for (std::size_t t = 0; t < a.size(); ++t)
  {
    same += std::min(a[t], b[t]);
  }
  return same;
}

/// The surfaces of a gear do not hang on how many points its flanks have, nor on noise of a quarter
/// of the tolerance.
TEST(SurfaceRecognition, GearsKeepTheirTypes)
{
  std::mt19937 random(21);
  for (int gear = 0; gear < 3; ++gear)
  {
    const int teeth = 12 + static_cast<int>(random() % 20);
    const double pressure = (14.5 + 10.5 * random() / 4294967296.0) * Pi / 180.0;
    const double height = 2.0 + 4.0 * random() / 4294967296.0;
    const std::vector<Vector2d> outline = GearOutline(teeth, pressure, 9);
    const TriangleMesh exactMesh = Extruded(outline, height);
    const double diagonal =
      (exactMesh.Points.colwise().maxCoeff() - exactMesh.Points.colwise().minCoeff()).norm();
    const Counts exact = Recognize(exactMesh, 1e-3 * diagonal).NumOfType;
    const int total = std::accumulate(exact.begin(), exact.end(), 0);
    EXPECT_LE(total, 4 * teeth + 2) << teeth << " teeth";
    EXPECT_EQ(exact[static_cast<std::size_t>(SurfaceType::FreeForm)], 0);
    const auto expectSame = [&](const TriangleMesh& mesh, const std::string& what)
    {
      const Counts counts = Recognize(mesh, 1e-3 * diagonal).NumOfType;
      EXPECT_GE(NumSame(counts, exact), 0.9 * total)
        << what << ", " << teeth << " teeth, " << pressure << " "
        << ::testing::PrintToString(counts) << " for " << ::testing::PrintToString(exact);
    };
    int coarser = 0; // as in a decimation within half of the tolerance
    for (const int perFlank : { 8, 7, 6, 5, 4 })
    {
      const std::vector<Vector2d> coarse = GearOutline(teeth, pressure, perFlank);
      if (FarthestFrom(coarse, outline) <= 0.5e-3 * diagonal)
      {
        ++coarser;
        expectSame(Extruded(coarse, height), std::to_string(perFlank) + " points");
      }
    }
    EXPECT_GE(coarser, 2);
    TriangleMesh noisy = exactMesh;
    Shake(noisy, 0.25e-3 * diagonal, random);
    expectSame(noisy, "noise");
  }
}

/// Fine meshes: a waved ball is on no surface, a rounded shaft is, with noise too.
TEST(SurfaceRecognition, FreeShapesAreToldFromParts)
{
  constexpr int sides = 160;
  RecognitionParams params;
  params.MaxRegions = 1000;
  const std::vector<ProfilePiece> ball = { { { 0, 1 }, { 0, 0 }, 80 } };
  TriangleMesh waved = Turned({ 0, -1 }, ball, sides);
  for (Eigen::Index p = 0; p < waved.Points.rows(); ++p)
  {
    const Eigen::RowVector3d way = waved.Points.row(p) - Eigen::RowVector3d(3, 1, 2);
    const double wave = std::sin(5.0 * way[0]) * std::sin(4.0 * way[1] + 1.0) +
      0.5 * std::sin(7.0 * way[2] + 2.0 * way[0]);
    waved.Points.row(p) += 0.1 * wave * way;
  }
  const auto surface = CheckSurface(waved);
  ASSERT_TRUE(surface);
  const Status refused = RecognizeSurfaces(surface.Value, params).Status;
  EXPECT_EQ(refused.Code, ErrorCode::NotInSpace) << refused.Message();
  EXPECT_NE(refused.Detail.find("free shape"), std::string::npos) << refused.Detail;

  const std::vector<ProfilePiece> shaft = { { { 1, 0 } }, { { 1, 2 } },
    { { 0.5, 2.5 }, { 0.5, 2 }, 40 }, { { 0, 2.5 } } };
  for (const double noise : { 0.0, 2e-4 })
  {
    const auto part = CheckSurface(Turned({ 0, 0 }, shaft, sides, noise));
    ASSERT_TRUE(part);
    const auto found = RecognizeSurfaces(part.Value, params);
    ASSERT_TRUE(found) << noise << found.Status.Message();
    EXPECT_EQ(found->NumOfType, (Counts{ 2, 1, 0, 0, 1, 0 })) << noise;
  }
}

/// Two stepped shafts side by side, their points moved: what is one value in both is made one
/// again.
TEST(SurfaceRecognition, NearlyEqualValuesBecomeEqual)
{
  const double noise = 5e-4;
  const std::vector<ProfilePiece> shaft = { { { 1, 0 } }, { { 1, 2 } }, { { 0.5, 2 } },
    { { 0.5, 3 } }, { { 0, 3 } } };
  TriangleMesh other = Turned({ 0, 0 }, shaft, 48, 1.1 * noise); // moved by other ways
  other.Points.rowwise() += 4.0 * TiltedAxis.unitOrthogonal().transpose();
  const TriangleMesh mesh = Together(Turned({ 0, 0 }, shaft, 48, noise), other);
  RecognitionParams params;
  params.Tolerance = 5e-3;
  const auto own = RecognizeSurfaces(mesh, params);
  params.SnapDistance = 2e-3;
  const auto snapped = RecognizeSurfaces(mesh, params);
  ASSERT_TRUE(own && snapped) << own.Status.Message() << snapped.Status.Message();
  ASSERT_EQ(own->NumOfType, (Counts{ 6, 4, 0, 0, 0, 0 }));
  EXPECT_EQ(own->Snapped.NumSurfaces, 0);
  EXPECT_EQ(snapped->NumOfType, own->NumOfType);
  EXPECT_EQ(snapped->RegionOfTriangle, own->RegionOfTriangle);
  EXPECT_EQ(snapped->Snapped.NumSurfaces, 10);
  EXPECT_EQ(snapped->Snapped.NumDirections, 1); // normals along the axes
  EXPECT_EQ(snapped->Snapped.NumPositions, 5);  // two axes, and planes beside each other
  EXPECT_EQ(snapped->Snapped.NumSizes, 2);
  double worst = 0.0;
  std::map<int, double> radii;
  for (std::size_t r = 0; r < own->Regions.size(); ++r)
  {
    const RecognizedRegion& region = snapped->Regions[r];
    const AnalyticSurface& surface = region.Surface;
    const AnalyticSurface& before = own->Regions[r].Surface;
    EXPECT_EQ(region.Direction, 0);
    EXPECT_TRUE(surface.Axis == snapped->Regions[0].Surface.Axis ||
      surface.Axis == -snapped->Regions[0].Surface.Axis);
    worst = std::max(worst, before.Axis.cross(TiltedAxis).norm());
    EXPECT_GT(surface.Axis.dot(before.Axis), 0.0);
    EXPECT_LE(region.MaxDistance, params.Tolerance);
    if (surface.Type == SurfaceType::Cylinder)
    {
      const auto [at, isNew] = radii.emplace(region.Size, surface.Radius);
      EXPECT_EQ(at->second, surface.Radius);
      EXPECT_NEAR(surface.Radius, surface.Radius > 0.7 ? 1.0 : 0.5, noise);
    }
    for (std::size_t q = 0; q < r; ++q)
    {
      const RecognizedRegion& beside = snapped->Regions[q];
      if (beside.Position == region.Position)
      {
        EXPECT_EQ(beside.Surface.Type, surface.Type);
        const Vector3d way = beside.Surface.Point - surface.Point;
        EXPECT_LT(surface.Type == SurfaceType::Plane ? std::abs(way.dot(surface.Axis))
                                                     : way.cross(surface.Axis).norm(),
          1e-14);
      }
    }
  }
  EXPECT_EQ(radii.size(), 2u);
  EXPECT_LT(snapped->Regions[0].Surface.Axis.cross(TiltedAxis).norm(), worst);
  EXPECT_GT(snapped->Snapped.MaxTurn, 0.0);

  params.SnapDistance = 1e-9; // nothing is that nearly equal
  const auto exact = RecognizeSurfaces(mesh, params);
  ASSERT_TRUE(exact);
  EXPECT_EQ(exact->Snapped.NumSurfaces, 0);
  EXPECT_EQ(exact->Snapped.NumSizes, 0);
}

/// What differs by more than two degrees or a twentieth is not nearly equal.
TEST(SurfaceRecognition, DifferentValuesStay_Exact)
{
  const TriangleMesh shaft = Turned(
    { 0, 0 }, { { { 1, 0 } }, { { 1, 2 } }, { { 1.1, 2 } }, { { 1.1, 4 } }, { { 0, 4 } } }, 60);
  RecognitionParams params;
  params.Tolerance = 0.02;
  params.SnapDistance = 0.02;
  const auto own = Recognize(shaft, params.Tolerance);
  const auto snapped = RecognizeSurfaces(shaft, params);
  ASSERT_TRUE(snapped);
  ASSERT_EQ(snapped->NumOfType, (Counts{ 3, 2, 0, 0, 0, 0 }));
  EXPECT_EQ(snapped->Snapped.NumSizes, 0);
  EXPECT_EQ(snapped->Snapped.NumDirections, 1);
  EXPECT_EQ(snapped->Snapped.NumPositions, 1); // of the axes: they are common already
  for (std::size_t r = 0; r < own.Regions.size(); ++r)
  {
    EXPECT_NEAR(snapped->Regions[r].Surface.Radius, own.Regions[r].Surface.Radius, 1e-9);
    EXPECT_LT(snapped->Regions[r].MaxDistance, 1e-9);
  }
  for (const double degrees : { 1.0, 3.0 })
  {
    TriangleMesh turned = UnitCube();
    turned.Points =
      (turned.Points *
        Eigen::AngleAxisd(degrees * Pi / 180.0, Vector3d::UnitZ()).toRotationMatrix().transpose())
        .rowwise() +
      Eigen::RowVector3d(3.0, 0.0, 0.5);
    const auto cubes = RecognizeSurfaces(Together(UnitCube(), turned), params);
    ASSERT_TRUE(cubes);
    EXPECT_EQ(cubes->Snapped.NumDirections, degrees < 2.0 ? 3 : 5);
    EXPECT_NEAR(cubes->Snapped.MaxTurn, degrees < 2.0 ? degrees / 2.0 : 0.0, 1e-6);
  }
}

TEST(SurfaceRecognition, ParametersOutOfRange)
{
  RecognitionParams params;
  const auto surface = CheckSurface(Turned({ 0, 0 }, { { { 1, 0 } }, { { 0, 2 } } }, 48));
  ASSERT_TRUE(surface);
  params.Tolerance = -1.0;
  EXPECT_EQ(RecognizeSurfaces(surface.Value, params).Status.Code, ErrorCode::InvalidParameter);
  params.Tolerance = 0.0;
  params.MaximumSag = -1.0;
  EXPECT_EQ(RecognizeSurfaces(surface.Value, params).Status.Code, ErrorCode::InvalidParameter);
  params.MaximumSag = 5.0;
  params.SnapDistance = -1.0;
  EXPECT_EQ(RecognizeSurfaces(surface.Value, params).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(
    RecognizeSurfaces(Turned({ 0, 0 }, { { { 1, 0 } }, { { 0, 2 } } }, 48), params).Status.Code,
    ErrorCode::InvalidParameter);
  params.SnapDistance = 0.0;
  params.MaxRegions = -1;
  EXPECT_EQ(RecognizeSurfaces(surface.Value, params).Status.Code, ErrorCode::InvalidParameter);
  params.MaxRegions = 1; // there are a cone and a plane
  EXPECT_EQ(RecognizeSurfaces(surface.Value, params).Status.Code, ErrorCode::TooLarge);
  params.MaxRegions = 2;
  EXPECT_TRUE(RecognizeSurfaces(surface.Value, params));
  params.Progress = [](double) { return false; };
  EXPECT_EQ(RecognizeSurfaces(surface.Value, params).Status.Code, ErrorCode::Aborted);
}

/// Three rows of points along a large torus: its axis is that of the circle which they follow.
TEST(FitAnalyticSurface, NarrowPieceOfALargeTorus_Exact)
{
  const Eigen::AngleAxisd tilt(0.7, Vector3d(1, 2, -1).normalized());
  std::vector<Vector3d> points;
  for (int i = 0; i <= 24; ++i)
  {
    for (const double turn : { 0.2, 0.5, 0.8 })
    {
      const double angle = 0.05 * i;
      const double out = 60.0 + std::cos(turn);
      points.push_back(
        tilt * Vector3d(out * std::cos(angle), out * std::sin(angle), std::sin(turn)));
    }
  }
  AnalyticSurface torus;
  ASSERT_TRUE(GuessCircleAxis(points, torus));
  EXPECT_NEAR((torus.Axis.cross(TiltedAxis)).norm(), 0.0, 1e-2);
  ASSERT_TRUE(GuessTorusAbout(points, torus));
  ASSERT_TRUE(FitSurface(points, torus, 1.0, 300));
  EXPECT_NEAR(torus.Radius, 60.0, 1e-5);
  EXPECT_NEAR(torus.MinorRadius, 1.0, 1e-5);
  const std::vector<Vector3d> line = { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } };
  EXPECT_FALSE(GuessCircleAxis(line, torus));
}

TEST(FitAnalyticSurface, DerivativesLeadToTheSurface)
{
  // far guesses of every type end on the surface that the points are of
  AnalyticSurface torus;
  torus.Type = SurfaceType::Torus;
  torus.Radius = 2.0;
  torus.MinorRadius = 0.5;
  std::vector<Vector3d> points;
  for (int i = 0; i < 40; ++i)
  {
    const double u = 0.04 * i;
    const double v = 1.7 * i;
    const double radius = 2.0 + 0.5 * std::cos(v);
    points.emplace_back(radius * std::cos(u), radius * std::sin(u), 0.5 * std::sin(v));
  }
  EXPECT_LT(MaxDistance(points, torus), 1e-14);
  AnalyticSurface guess = torus;
  guess.Point = Vector3d(0.2, -0.1, 0.1);
  guess.Axis = Vector3d(0.1, 0.1, 1.0).normalized();
  guess.Radius = 2.3;
  guess.MinorRadius = 0.4;
  ASSERT_TRUE(FitSurface(points, guess));
  EXPECT_LT(MaxDistance(points, guess), 1e-12);
  EXPECT_NEAR(guess.Radius, 2.0, 1e-10);
  EXPECT_NEAR(guess.MinorRadius, 0.5, 1e-10);
}
}
}
