// SPDX-License-Identifier: BSD-3-Clause
#include "ScanFeatures.h"

#include "FeatureCases.h"
#include "FittedNormals.h"
#include "MeshNoise.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

namespace knotwork
{
namespace
{
ScanFeatures Found(const TriangleMesh& mesh, const ScanFeatureParams& params = {})
{
  auto features = FindScanFeatures(mesh, params);
  EXPECT_TRUE(features) << features.Status.Message();
  return features.Value;
}

double Noise(const TriangleMesh& mesh)
{
  const auto surface = CheckSurface(mesh);
  EXPECT_TRUE(surface) << surface.Status.Message();
  const std::vector<int> noHoles;
  const auto noise = EstimateNoise(SurfaceParts(surface.Value, noHoles));
  EXPECT_TRUE(noise) << noise.Status.Message();
  return noise.Value;
}

int ClosedLines(const ScanFeatures& features)
{
  return static_cast<int>(std::count_if(features.Lines.begin(), features.Lines.end(),
    [](const FeatureLine& line) { return line.Chain.Closed; }));
}

/// A strip about the y axis, which bends there by an angle (degrees) of y in [0, 1]; points are
/// (row of 21) * 5 + column, those of the bend in column 2.
TriangleMesh Roof(const std::function<double(double)>& angle)
{
  TriangleMesh mesh;
  mesh.Points.resize(105, 3);
  for (int i = 0; i < 21; ++i)
  {
    const double y = 0.05 * i;
    const double slope = 0.5 * angle(y) * Pi / 180.0;
    for (int j = 0; j < 5; ++j)
    {
      const double x = 0.05 * (j - 2);
      mesh.Points.row(5 * i + j) << x * std::cos(slope), y, -std::abs(x) * std::sin(slope);
    }
  }
  for (int i = 0; i < 20; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      const int a = 5 * i + j;
      mesh.Triangles.push_back({ a, a + 1, a + 6 });
      mesh.Triangles.push_back({ a, a + 6, a + 5 });
    }
  }
  return mesh;
}

/// Two sides that meet at 70 degrees in a chamfer 0.006 wide along the x axis, whose upper bound
/// has 40 edges and whose lower one has one.
TriangleMesh ChamferedRoof(double upper)
{
  const int count = 40;
  const double first = upper * Pi / 180.0;
  const double both = 70.0 * Pi / 180.0;
  const Eigen::Vector2d low(0.006 * std::cos(first), -0.006 * std::sin(first));
  const Eigen::Vector2d foot = low + Eigen::Vector2d(std::cos(both), -std::sin(both));
  TriangleMesh mesh;
  mesh.Points.resize(count + 7, 3);
  for (int i = 0; i <= count; ++i)
  {
    mesh.Points.row(i) << static_cast<double>(i) / count, 0.0, 0.0;
  }
  const int back = count + 1;
  const int bottom = count + 3;
  const int end = count + 5;
  for (int i = 0; i < 2; ++i)
  {
    mesh.Points.row(back + i) << i, -1.0, 0.0;
    mesh.Points.row(bottom + i) << i, low[0], low[1];
    mesh.Points.row(end + i) << i, foot[0], foot[1];
  }
  mesh.Triangles = { { back, back + 1, count }, { bottom, bottom + 1, count },
    { bottom, end + 1, bottom + 1 }, { bottom, end, end + 1 } };
  for (int i = 0; i < count; ++i)
  {
    mesh.Triangles.push_back({ back, i + 1, i });
    mesh.Triangles.push_back({ i, i + 1, bottom });
  }
  return mesh;
}

/// Lengths of the lines that are no rims, ascending.
std::vector<double> Creases(const ScanFeatures& features)
{
  std::vector<double> lengths;
  for (const FeatureLine& line : features.Lines)
  {
    if (!line.IsRim)
    {
      lengths.push_back(line.Length);
    }
  }
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

/// A plate with a pyramid on it, of which each side is a hundredth of the whole or less.
TriangleMesh PlateWithPyramid()
{
  TriangleMesh mesh =
    Faces(1, 10, 10, [](int, double u, double v) { return Eigen::Vector3d(u, v, 0); });
  // the middle of four squares rises
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    if ((mesh.Points.row(i) - Eigen::RowVector3d(0.5, 0.5, 0.0)).norm() < 1e-6)
    {
      mesh.Points(i, 2) = 0.2;
    }
  }
  return mesh;
}

int PointAt(const TriangleMesh& mesh, double x, double y, double z)
{
  for (int i = 0; i < mesh.Points.rows(); ++i)
  {
    if ((mesh.Points.row(i) - Eigen::RowVector3d(x, y, z)).norm() < 1e-9)
    {
      return i;
    }
  }
  return -1;
}

/// Two meshes as one, the second one moved along x.
TriangleMesh Together(const TriangleMesh& a, const TriangleMesh& b, double x)
{
  TriangleMesh both = a;
  const auto first = static_cast<int>(a.Points.rows());
  both.Points.conservativeResize(first + b.Points.rows(), 3);
  both.Points.bottomRows(b.Points.rows()) = b.Points.rowwise() + Eigen::RowVector3d(x, 0.0, 0.0);
  for (const auto& [i, j, k] : b.Triangles)
  {
    both.Triangles.push_back({ first + i, first + j, first + k });
  }
  return both;
}

void ExpectFeaturesOfBoth(const TriangleMesh& a, const TriangleMesh& b, double x)
{
  // the second one where it is in the whole: differences by rounding are none of this test
  TriangleMesh moved = b;
  moved.Points.col(0).array() += x;
  const ScanFeatures own = Found(a);
  const ScanFeatures other = Found(moved);
  const ScanFeatures both = Found(Together(a, b, x));
  EXPECT_EQ(both.Noise, std::max(own.Noise, other.Noise));
  EXPECT_EQ(both.NumRegions, own.NumRegions + other.NumRegions);
  EXPECT_EQ(both.NumSharpEdges, own.NumSharpEdges + other.NumSharpEdges);
  EXPECT_EQ(both.NumJoined, own.NumJoined + other.NumJoined);
  EXPECT_EQ(both.NumClosedGaps, own.NumClosedGaps + other.NumClosedGaps);
  std::vector<int> corners = own.Corners;
  std::vector<int> regions = own.RegionOfTriangle;
  std::vector<std::vector<int>> lines;
  for (const FeatureLine& line : own.Lines)
  {
    lines.push_back(line.Chain.Points);
  }
  const auto first = static_cast<int>(a.Points.rows());
  for (const int corner : other.Corners)
  {
    corners.push_back(first + corner);
  }
  for (const int region : other.RegionOfTriangle)
  {
    regions.push_back(own.NumRegions + region);
  }
  for (const FeatureLine& line : other.Lines)
  {
    lines.push_back(line.Chain.Points);
    for (int& point : lines.back())
    {
      point += first;
    }
  }
  EXPECT_EQ(both.Corners, corners);
  EXPECT_EQ(both.RegionOfTriangle, regions);
  ASSERT_EQ(both.Lines.size(), lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    EXPECT_EQ(both.Lines[i].Chain.Points, lines[i]);
  }
}

void ExpectSameAsPlain(const TriangleMesh& mesh)
{
  const auto surface = CheckSurface(mesh);
  ASSERT_TRUE(surface);
  const auto plain = FindMeshFeatures(surface.Value);
  ASSERT_TRUE(plain);
  const ScanFeatures features = Found(mesh);
  EXPECT_EQ(features.RegionOfTriangle, plain->Regions);
  EXPECT_EQ(features.Corners, plain->Corners);
  EXPECT_EQ(features.NumJoined, 0);
  EXPECT_EQ(features.NumClosedGaps, 0);
  std::multiset<std::pair<bool, std::set<int>>> own; // where chains begin is of no account
  std::multiset<std::pair<bool, std::set<int>>> others;
  for (const FeatureLine& line : features.Lines)
  {
    own.emplace(
      line.Chain.Closed, std::set<int>(line.Chain.Points.begin(), line.Chain.Points.end()));
  }
  for (const FeatureChain& chain : plain->Chains)
  {
    others.emplace(chain.Closed, std::set<int>(chain.Points.begin(), chain.Points.end()));
  }
  EXPECT_EQ(own, others);
}
}

TEST(MeshNoise, NoneOfCleanMeshes_ExactOracle)
{
  EXPECT_LT(Noise(DividedCube(1)), 1e-15);
  EXPECT_LT(Noise(DividedCube(7)), 1e-15);
  EXPECT_LT(Noise(Turned({ { 0, 0 }, { 1, 0 }, { 1, 2 }, { 0, 2 } }, 30)), 1e-15);
  // a dome, all of which is curved
  const TriangleMesh dome = Faces(1, 40, 40,
    [](int, double u, double v)
    { return Eigen::Vector3d(u, v, std::sqrt(2.0 - u * u - v * v + 0.1 * u * v)); });
  EXPECT_LT(Noise(dome), 2e-6);
}

TEST(MeshNoise, IsThatWhichWasAdded_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const double deviation : { 1e-5, 1e-3, 4e-3 })
    {
      TriangleMesh cube = DividedCube(20);
      AddNoise(deviation, seed, cube);
      EXPECT_NEAR(Noise(cube), deviation, 0.1 * deviation);
      TriangleMesh dome = Faces(1, 40, 40,
        [](int, double u, double v) { return Eigen::Vector3d(u, v, 0.3 * std::cos(2.0 * u) * v); });
      AddNoise(deviation, seed, dome);
      EXPECT_NEAR(Noise(dome), deviation, 0.1 * deviation);
    }
  }
}

/// Two rings around each point of the rim would be 1e10 points: hours.
TEST(MeshNoise, HubsOfManyEdgesCostNoMore_ExactOracle)
{
  const int sides = 100000;
  EXPECT_LT(Noise(Turned({ { 0, 0 }, { 1, 0 }, { 1, 2 }, { 0, 2 } }, sides)), 1e-9);
  // beside a hub of a cap that is divided, noise is measured as elsewhere
  std::vector<std::array<double, 2>> profile{ { 0, 0 } };
  for (int i = 1; i <= 20; ++i)
  {
    profile.push_back({ 0.05 * i, 0 });
  }
  TriangleMesh disc = Turned(profile, 60);
  AddNoise(1e-3, 1, disc);
  EXPECT_NEAR(Noise(disc), 1e-3, 1e-4);
}

TEST(MeshNoise, ThreadsDoNotMatterAndItStops_PropertyOracle)
{
  TriangleMesh cube = DividedCube(20);
  AddNoise(1e-3, 2, cube);
  const auto surface = CheckSurface(cube);
  ASSERT_TRUE(surface);
  const std::vector<int> noHoles;
  const SurfaceParts parts(surface.Value, noHoles);
  EXPECT_EQ(EstimateNoise(parts, 1).Value, EstimateNoise(parts, 3).Value);
  double last = 0.0;
  const auto stopped = EstimateNoise(parts, 1,
    [&](double share)
    {
      EXPECT_GT(share, last);
      last = share;
      return share < 0.5;
    });
  EXPECT_EQ(stopped.Status.Code, ErrorCode::Aborted);
  EXPECT_LT(last, 0.6);
}

TEST(MeshNoise, TooFewTrianglesSayNothing_ExactOracle)
{
  TriangleMesh mesh;
  mesh.Points.resize(4, 3);
  mesh.Points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } };
  EXPECT_EQ(Noise(mesh), 0.0);
}

/// Noise of 0.2 % of the diagonal: up to 40 degrees between normals of neighbours in one face.
TEST(ScanFeatures, NoisyCubeHasTwelveEdgesEightCornersSixRegions_ExactOracle)
{
  for (const int n : { 1, 4, 10, 20, 40 })
  {
    for (unsigned seed = 1; seed <= 5; ++seed)
    {
      SCOPED_TRACE(std::to_string(n) + " parts, seed " + std::to_string(seed));
      TriangleMesh cube = DividedCube(n);
      const TriangleMesh exact = cube;
      AddNoise(0.002 * std::sqrt(3.0), seed, cube);
      const ScanFeatures features = Found(cube);
      EXPECT_EQ(features.Lines.size(), 12u);
      EXPECT_EQ(features.Corners.size(), 8u);
      EXPECT_EQ(features.NumRegions, 6);
      for (const int corner : features.Corners)
      {
        // corners of the cube, but for an edge of a triangle
        for (const double x :
          { exact.Points(corner, 0), exact.Points(corner, 1), exact.Points(corner, 2) })
        {
          EXPECT_LE(std::min(std::abs(x), std::abs(x - 1.0)), 1.5 / n);
        }
      }
      for (const FeatureLine& line : features.Lines)
      {
        EXPECT_NEAR(line.MeanAngle, 90.0, 5.0);
      }
    }
  }
}

TEST(ScanFeatures, NormalsOfTrianglesWouldFindThousands_Contrast)
{
  TriangleMesh cube = DividedCube(40);
  AddNoise(0.002 * std::sqrt(3.0), 1, cube);
  ScanFeatureParams params;
  params.Noise = 0.0;
  EXPECT_GT(Found(cube, params).Lines.size(), 5000u);
}

TEST(ScanFeatures, CleanMeshesAreAsByTheirTriangles_CrossOracle)
{
  ExpectSameAsPlain(DividedCube(1));
  ExpectSameAsPlain(DividedCube(5));
  ExpectSameAsPlain(Turned({ { 0, 0 }, { 1, 0 }, { 1, 2 }, { 0.5, 2.5 }, { 0, 2.5 } }, 30));
  ExpectSameAsPlain(Roof([](double y) { return 70.0 - 65.0 * y; }));
}

TEST(ScanFeatures, NarrowChamferIsOneCurve_ExactOracle)
{
  // 0.2 % of the diagonal wide; 30 degrees to the side, 60 to the top
  const double high = 0.004 * std::sin(Pi / 3.0);
  const double wide = 0.004 * std::cos(Pi / 3.0);
  for (const int sides : { 24, 60 })
  {
    SCOPED_TRACE(std::to_string(sides) + " sides");
    const TriangleMesh mesh =
      Turned({ { 0, 0 }, { 1, 0 }, { 1, 1.0 - high }, { 1.0 - wide, 1 }, { 0, 1 } }, sides);
    ScanFeatures features = Found(mesh);
    EXPECT_EQ(features.NumRegions, 3);
    ASSERT_EQ(features.Lines.size(), 2u);
    EXPECT_EQ(ClosedLines(features), 2);
    for (const FeatureLine& line : features.Lines)
    {
      // the sharper rim, with the angle of the two sides
      const double z = mesh.Points(line.Chain.Points.front(), 2);
      EXPECT_TRUE(z == 0.0 || z == 1.0) << z;
      EXPECT_NEAR(line.MeanAngle, 90.0, 1e-9);
    }
    ScanFeatureParams params;
    params.NarrowWidth = 0.0005; // then only that rim is sharp, and the chamfer part of the side
    features = Found(mesh, params);
    EXPECT_EQ(features.NumRegions, 3);
    EXPECT_NEAR(features.Lines.back().MeanAngle, 60.0, 1.0);
  }
}

TEST(ScanFeatures, ChamferOfEqualRimsIsOneCurveOrTwo_ExactOracle)
{
  const TriangleMesh mesh =
    Turned({ { 0, 0 }, { 1, 0 }, { 1, 0.996 }, { 0.996, 1 }, { 0, 1 } }, 60);
  EXPECT_EQ(Found(mesh).Lines.size(), 2u);
  ScanFeatureParams params;
  params.NarrowWidth = 0.0;
  EXPECT_EQ(Found(mesh, params).Lines.size(), 3u);
}

TEST(ScanFeatures, NarrowChamferOfANoisyMeshIsOneCurve_ExactOracle)
{
  // 0.27 % of the diagonal wide, one row between many
  std::vector<std::array<double, 2>> profile{ { 0, 0 } };
  for (int i = 1; i <= 20; ++i)
  {
    profile.push_back({ 0.05 * i, 0 });
  }
  for (int i = 1; i <= 20; ++i)
  {
    profile.push_back({ 1, 0.992 * 0.05 * i });
  }
  for (int i = 0; i <= 20; ++i)
  {
    profile.push_back({ 0.992 * (1.0 - 0.05 * i), 1 });
  }
  for (const double noise : { 1e-4, 3e-4, 5e-4 })
  {
    for (unsigned seed = 1; seed <= 5; ++seed)
    {
      SCOPED_TRACE(std::to_string(noise) + " of the diagonal, seed " + std::to_string(seed));
      TriangleMesh mesh = Turned(profile, 80);
      AddNoise(3.0 * noise, seed, mesh);
      const ScanFeatures features = Found(mesh);
      EXPECT_EQ(features.Lines.size(), 2u);
      EXPECT_EQ(ClosedLines(features), 2);
      EXPECT_EQ(features.NumRegions, 3);
    }
  }
}

TEST(ScanFeatures, RowOfBluntRimsIsACurve_ExactOracle)
{
  // a roof of 60 degrees whose ridge is a row of triangles: 30 degrees on both sides
  const double w = 0.004;
  const auto profile = [&](double ridge)
  {
    const double c = std::cos(Pi / 6.0);
    const double s = std::sin(Pi / 6.0);
    return std::vector<std::array<double, 2>>{ { 1, 0 }, { 1, 1 },
      { 1.0 - ridge * s, 1.0 + ridge * c },
      { 1.0 - ridge * s - 0.8 * std::sin(Pi / 3.0), 1.0 + ridge * c + 0.8 * std::cos(Pi / 3.0) } };
  };
  ScanFeatures features = Found(Turned(profile(w), 60));
  EXPECT_EQ(features.NumRegions, 2);
  EXPECT_EQ(Creases(features).size(), 1u);
  ScanFeatureParams params;
  params.NarrowWidth = 0.0;
  features = Found(Turned(profile(w), 60), params);
  EXPECT_EQ(features.NumRegions, 1);
  EXPECT_TRUE(Creases(features).empty());
  // a wide one is a face between two blunt edges, as ever
  EXPECT_EQ(Found(Turned(profile(0.1), 60)).NumRegions, 1);
}

TEST(ScanFeatures, NarrowRowsAreFoundHoweverTheyLie_PropertyOracle)
{
  for (const auto& [upper, edges] : { std::pair(33.0, 1), std::pair(37.0, 40), std::pair(35.0, 1) })
  {
    // the sharper bound stays, of equal ones the same in every direction
    const TriangleMesh roof = ChamferedRoof(upper);
    std::mt19937 random(1);
    for (int turn = 0; turn < 30; ++turn)
    {
      SCOPED_TRACE(std::to_string(upper) + " degrees, turn " + std::to_string(turn));
      TriangleMesh mesh = roof;
      if (turn > 0) // the first one along x
      {
        Eigen::Vector4d parts;
        for (double& part : parts)
        {
          part = static_cast<double>(random()) / 4294967296.0 - 0.5;
        }
        mesh.Points *= Eigen::Quaterniond(parts).normalized().toRotationMatrix();
      }
      const ScanFeatures features = Found(mesh);
      EXPECT_EQ(features.NumRegions, 2);
      EXPECT_EQ(features.NumSharpEdges, edges);
      ASSERT_EQ(Creases(features).size(), 1u);
      EXPECT_NEAR(Creases(features).front(), 1.0, 1e-12);
    }
  }
}

TEST(ScanFeatures, RimOfAThinPlateIsNoRow_ExactOracle)
{
  TriangleMesh plate = DividedCube(10);
  plate.Points.col(2) *= 0.003;
  const ScanFeatures features = Found(plate);
  EXPECT_EQ(features.NumRegions, 6);
  EXPECT_EQ(features.Lines.size(), 12u);
}

TEST(ScanFeatures, GapsWithAWeakAngleAreClosed_ExactOracle)
{
  const auto roof = [](double least)
  {
    return Roof([=](double y)
      { return least + (60.0 - least) * std::clamp(8.0 * std::abs(y - 0.5) - 0.8, 0.0, 1.0); });
  };
  ScanFeatureParams params;
  params.LargestGap = 0.35;
  ScanFeatures features = Found(roof(15.0), params);
  EXPECT_EQ(features.NumClosedGaps, 1);
  EXPECT_EQ(features.NumRegions, 2);
  ASSERT_EQ(Creases(features).size(), 1u);
  EXPECT_NEAR(Creases(features).front(), 1.0, 1e-12);
  features = Found(roof(5.0), params); // too flat
  EXPECT_EQ(features.NumClosedGaps, 0);
  EXPECT_EQ(features.NumRegions, 1);
  EXPECT_EQ(Creases(features).size(), 2u);
  params.LargestGap = 0.02; // too short
  features = Found(roof(15.0), params);
  EXPECT_EQ(features.NumClosedGaps, 0);
  EXPECT_EQ(features.NumRegions, 1);
}

TEST(ScanFeatures, SmallRegionsJoinNeighbours_ExactOracle)
{
  const TriangleMesh mesh = PlateWithPyramid();
  EXPECT_GT(Found(mesh).NumRegions, 3);
  ScanFeatureParams params;
  params.SmallestRegion = 0.1;
  const ScanFeatures features = Found(mesh, params);
  EXPECT_EQ(features.NumRegions, 1);
  EXPECT_GT(features.NumJoined, 2);
  EXPECT_TRUE(Creases(features).empty());
}

TEST(ScanFeatures, SmallRegionJoinsAcrossTheBluntestEdge_ExactOracle)
{
  // a step of a face in the middle: 50 degrees on one side, 80 on the other
  const double a = 50.0 * Pi / 180.0;
  const double b = 130.0 * Pi / 180.0;
  const TriangleMesh mesh = Faces(3, 4, 4,
    [&](int face, double u, double v)
    {
      const Eigen::Vector2d start(1.0, 0.0);
      const Eigen::Vector2d middle = start + 0.1 * Eigen::Vector2d(std::cos(a), std::sin(a));
      const Eigen::Vector2d end = middle + Eigen::Vector2d(std::cos(b), std::sin(b));
      const Eigen::Vector2d from = face == 0 ? Eigen::Vector2d(0, 0) : face == 1 ? start : middle;
      const Eigen::Vector2d to = face == 0 ? start : face == 1 ? middle : end;
      const Eigen::Vector2d p = (1.0 - u) * from + u * to;
      return Eigen::Vector3d(p[0], v, p[1]);
    });
  ScanFeatureParams params;
  EXPECT_EQ(Found(mesh, params).NumRegions, 3);
  params.SmallestRegion = 0.1;
  const ScanFeatures features = Found(mesh, params);
  EXPECT_EQ(features.NumRegions, 2);
  EXPECT_EQ(features.RegionOfTriangle[0], features.RegionOfTriangle[40]);
  EXPECT_NE(features.RegionOfTriangle[0], features.RegionOfTriangle[70]);
}

TEST(ScanFeatures, NoRegionIsNoMoreThanNoise_PropertyOracle)
{
  const auto expect = [](const TriangleMesh& mesh, double given)
  {
    ScanFeatureParams params;
    params.Noise = given;
    const ScanFeatures features = Found(mesh, params);
    // the rules of the page, from the same normals
    const double sharp = params.Angles.SharpAngle * Pi / 180.0;
    NormalFitParams fit;
    fit.Noise = features.Noise;
    fit.Precision = sharp / 16.0;
    fit.Bend = sharp / 2.0;
    fit.Known = sharp / 8.0;
    const auto surface = CheckSurface(mesh);
    ASSERT_TRUE(surface);
    const std::vector<int> noHoles;
    const SurfaceParts parts(surface.Value, noHoles);
    const auto fitted = FitNormals(parts, fit, [](std::size_t, std::size_t) { return false; });
    ASSERT_TRUE(fitted);
    const auto count = static_cast<std::size_t>(features.NumRegions);
    std::vector<double> areas(count, 0.0);
    std::vector<double> patches(count, 0.0);
    std::vector<char> isKnown(count, 0);
    for (std::size_t t = 0; t < parts.Areas.size(); ++t)
    {
      const auto r = static_cast<std::size_t>(features.RegionOfTriangle[t]);
      areas[r] += parts.Areas[t];
      patches[r] += parts.Areas[t] * fitted->Areas[t];
      isKnown[r] = isKnown[r] || fitted->Deviations[t] <= fit.Known;
    }
    for (std::size_t r = 0; count > 1 && r < count; ++r)
    {
      EXPECT_TRUE(isKnown[r]) << "region " << r << " of " << count;
      EXPECT_GE(areas[r] * areas[r], 0.5 * patches[r]) << "region " << r << " of " << count;
    }
  };
  for (const double noise : { 0.02, 0.03, 0.04, 0.05, 0.1 })
  {
    for (unsigned seed = 1; seed <= 3; ++seed)
    {
      SCOPED_TRACE(std::to_string(noise) + ", seed " + std::to_string(seed));
      TriangleMesh cube = DividedCube(20);
      AddNoise(noise, seed, cube);
      expect(cube, -1.0);
    }
  }
  expect(DividedCube(8), 10.0);
  expect(DividedCube(20), 0.05);
}

TEST(ScanFeatures, KnownEdgesExtendOrReplace_ExactOracle)
{
  const TriangleMesh cube = DividedCube(4);
  const auto at = [&](double x, double y, double z) { return PointAt(cube, x, y, z); };
  ScanFeatureParams params;
  params.Known.Edges = { { at(0.5, 0, 1), at(0.5, 1, 1) } }; // across the top
  ScanFeatures features = Found(cube, params);
  EXPECT_EQ(features.NumRegions, 7);
  EXPECT_EQ(features.NumSharpEdges, 12 * 4 + 4);
  EXPECT_EQ(features.Corners.size(), 10u);
  params.SmallestRegion = 0.1; // a half of the top is less, but may join the sides only
  params.Known.Edges.push_back({ at(0, 0, 1), at(1, 0, 1) });
  params.Known.Edges.push_back({ at(0, 1, 1), at(1, 1, 1) });
  params.Known.Edges.push_back({ at(0, 0, 1), at(0, 1, 1) });
  params.Known.Edges.push_back({ at(1, 0, 1), at(1, 1, 1) });
  EXPECT_EQ(Found(cube, params).NumRegions, 7); // nowhere over known edges
  params.Known.Only = true;
  features = Found(cube, params);
  EXPECT_EQ(features.NumRegions, 3);
  EXPECT_EQ(features.NumSharpEdges, 4 * 4 + 4);
}

TEST(ScanFeatures, KnownEdgesWherePartsTouch_ExactOracle)
{
  // two cubes that have a corner in common
  const TriangleMesh cube = DividedCube(4);
  TriangleMesh raised = cube;
  raised.Points.rightCols(2).array() += 1.0;
  ScanFeatureParams params;
  params.Known.Only = true;
  const auto expect = [&](const TriangleMesh& mesh)
  {
    const ScanFeatures features = Found(mesh, params);
    EXPECT_EQ(features.NumSharpEdges, 8);
    EXPECT_EQ(Creases(features), (std::vector<double>{ 1.0, 1.0 }));
  };
  for (const bool firstIsRaised : { false, true })
  {
    const TriangleMesh mesh =
      firstIsRaised ? Together(raised, cube, -1.0) : Together(cube, raised, 1.0);
    const double x = firstIsRaised ? 0.0 : 1.0;
    const int common = PointAt(mesh, x, 1, 1);
    params.Known.Edges = { { common, PointAt(mesh, x + 1.0, 1, 1) },
      { PointAt(mesh, x - 1.0, 1, 1), common } };
    expect(mesh);
  }
  // an arch that stands on two corners of a cube: the way along the cube is shorter
  const TriangleMesh arch = Faces(1, 10, 2,
    [](int, double u, double v)
    { return Eigen::Vector3d(u, (v - 0.5) * u * (1.0 - u), 1.0 + 4.0 * u * (1.0 - u)); });
  for (const TriangleMesh& mesh : { Together(arch, cube, 0.0), Together(cube, arch, 0.0) })
  {
    params.Known.Edges = { { PointAt(mesh, 0, 0, 1), PointAt(mesh, 1, 0, 1) } };
    const ScanFeatures features = Found(mesh, params);
    EXPECT_EQ(features.NumSharpEdges, 4);
    EXPECT_EQ(Creases(features), std::vector<double>{ 1.0 });
  }
}

TEST(ScanFeatures, KnownRegionsExtendOrReplace_ExactOracle)
{
  const TriangleMesh cube = DividedCube(4);
  ScanFeatureParams params;
  for (std::size_t t = 0; t < cube.Triangles.size(); ++t)
  {
    params.Known.Regions.push_back(t < 16 ? 7 : 3); // half of the first face
  }
  ScanFeatures features = Found(cube, params);
  EXPECT_EQ(features.NumRegions, 7);
  EXPECT_NE(features.RegionOfTriangle[0], features.RegionOfTriangle[31]);
  params.Known.Only = true;
  features = Found(cube, params);
  EXPECT_EQ(features.NumRegions, 2);
  EXPECT_EQ(features.RegionOfTriangle[0], features.RegionOfTriangle[15]);
  EXPECT_EQ(features.RegionOfTriangle[31], features.RegionOfTriangle[150]);
}

TEST(ScanFeatures, PartsAndCornersOfTheirOwn_ExactOracle)
{
  // two cubes, every triangle with points of its own, as in STL files
  const TriangleMesh cube = DividedCube(3);
  TriangleMesh mesh;
  mesh.Points.resize(static_cast<Eigen::Index>(6 * cube.Triangles.size()), 3);
  for (int copy = 0; copy < 2; ++copy)
  {
    for (const auto& triangle : cube.Triangles)
    {
      const int first = static_cast<int>(3 * mesh.Triangles.size());
      for (int k = 0; k < 3; ++k)
      {
        mesh.Points.row(first + k) = cube.Points.row(triangle[static_cast<std::size_t>(k)]) +
          Eigen::RowVector3d(2.0 * copy, 0.0, 0.0);
      }
      mesh.Triangles.push_back({ first, first + 1, first + 2 });
    }
  }
  ScanFeatures features = Found(mesh);
  EXPECT_EQ(features.NumRegions, 12);
  EXPECT_EQ(features.Lines.size(), 24u);
  EXPECT_EQ(features.Corners.size(), 16u);
  EXPECT_EQ(features.RegionOfTriangle.back(), 11);
  mesh.Triangles.push_back({ 0, 0, 1 });
  EXPECT_EQ(Found(mesh).RegionOfTriangle.back(), -1);
}

TEST(ScanFeatures, WhatLiesBesideAPartDoesNotMatter_PropertyOracle)
{
  const auto expect = [](const TriangleMesh& a, const TriangleMesh& b, double x)
  {
    ExpectFeaturesOfBoth(a, b, x);
    ExpectFeaturesOfBoth(b, a, x);
  };
  const auto noisy = [](int n, double noise)
  {
    TriangleMesh cube = DividedCube(n);
    AddNoise(noise, 1, cube);
    return cube;
  };
  expect(DividedCube(8), noisy(20, 0.004), 3.0);
  expect(DividedCube(12), noisy(12, 0.004), 2.0); // as many triangles: the order decided
  // all of it fine and curved, beside noise of more triangles
  std::vector<std::array<double, 2>> profile;
  for (int i = 0; i <= 20; ++i)
  {
    profile.push_back({ 1.0 + 0.1 * std::sin(0.3 * i), 0.05 * i });
  }
  expect(Turned(profile, 60), noisy(30, 0.003), 4.0);
  // widths and gaps are shares of a part
  const TriangleMesh chamfered =
    Turned({ { 0, 0 }, { 1, 0 }, { 1, 0.98 }, { 0.98, 1 }, { 0, 1 } }, 40);
  expect(chamfered, chamfered, 20.0);
  expect(chamfered, DividedCube(1), 1000.0);
}

TEST(ScanFeatures, ThreadsDoNotMatter_PropertyOracle)
{
  TriangleMesh cube = DividedCube(20);
  AddNoise(0.004, 3, cube);
  ScanFeatureParams params;
  params.Threads = 1;
  const ScanFeatures one = Found(cube, params);
  params.Threads = 3;
  const ScanFeatures three = Found(cube, params);
  EXPECT_EQ(one.RegionOfTriangle, three.RegionOfTriangle);
  EXPECT_EQ(one.Corners, three.Corners);
}

TEST(ScanFeatures, CommutesWithScale_PropertyOracle)
{
  TriangleMesh cube = DividedCube(20);
  AddNoise(0.003, 4, cube);
  const ScanFeatures own = Found(cube);
  cube.Points = (1024.0 * cube.Points).eval();
  const ScanFeatures scaled = Found(cube);
  EXPECT_EQ(own.RegionOfTriangle, scaled.RegionOfTriangle);
  EXPECT_NEAR(scaled.Noise, 1024.0 * own.Noise, 1e-9 * scaled.Noise);
}

TEST(ScanFeatures, EveryFailureIsReachable)
{
  const TriangleMesh cube = DividedCube(1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [](const TriangleMesh& mesh, const ScanFeatureParams& params, ErrorCode code,
                        const std::string& text)
  {
    const auto result = FindScanFeatures(mesh, params);
    EXPECT_EQ(result.Status.Code, code) << result.Status.Message();
    EXPECT_NE(result.Status.Detail.find(text), std::string::npos) << result.Status.Message();
  };
  expect({}, {}, ErrorCode::EmptyInput, "no triangles");
  TriangleMesh broken = cube;
  broken.Points(3, 1) = nan;
  expect(broken, {}, ErrorCode::NonFiniteInput, "1 point (3)");
  const auto with = [](const std::function<void(ScanFeatureParams&)>& change)
  {
    ScanFeatureParams params;
    change(params);
    return params;
  };
  const auto invalid = ErrorCode::InvalidParameter;
  expect(cube, with([](auto& p) { p.Angles.SharpAngle = 0.0; }), invalid, "SharpAngle");
  expect(cube, with([](auto& p) { p.Angles.SharpAngle = 10.0; }), invalid,
    "it is 20 degrees and SharpAngle 10: lower it to that, or raise SharpAngle");
  expect(cube, with([](auto& p) { p.Angles.WeakAngle = -1.0; }), invalid, "it is -1 degrees");
  expect(cube, with([](auto& p) { p.Angles.CornerAngle = 200.0; }), invalid, "it is 200");
  expect(cube, with([](auto& p) { p.Known.Only = true; }), invalid, "none are given");
  expect(cube, with([&](auto& p) { p.Noise = nan; }), invalid, "Noise");
  expect(cube, with([](auto& p) { p.SmallestRegion = 1.0; }), invalid, "SmallestRegion");
  expect(cube, with([](auto& p) { p.NarrowWidth = -0.1; }), invalid, "NarrowWidth");
  expect(cube, with([](auto& p) { p.LargestGap = 1.1; }), invalid, "LargestGap");
  expect(cube,
    with(
      [](auto& p) {
        p.Known.Regions = { 1, 2 };
      }),
    ErrorCode::SizeMismatch, "2 known regions for 12 triangles");
  expect(cube,
    with(
      [](auto& p) {
        p.Known.Edges = { { 0, 8 } };
      }),
    ErrorCode::OutsideDomain, "known edge 0 has the point 8");
  TriangleMesh two = cube;
  two.Points.conservativeResize(16, 3);
  two.Points.bottomRows(8) = cube.Points.array() + 3.0;
  for (const auto& [a, b, c] : cube.Triangles)
  {
    two.Triangles.push_back({ a + 8, b + 8, c + 8 });
  }
  expect(two,
    with(
      [](auto& p) {
        p.Known.Edges = { { 0, 9 } };
      }),
    ErrorCode::InvalidTopology, "known edge 0 (points 0 and 9)");
  expect(cube, with([](auto& p) { p.Progress = [](double) { return false; }; }), ErrorCode::Aborted,
    "stopped");
}
}
