// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"
#include <knotwork/MeshParameterization/GeodesicMarch.h>

#include <algorithm>
#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
constexpr double Rounding = 1e-10; // of some hundred unfolded triangles

MeshCase Plate(double edge)
{
  return FlatCase(0.0, 2.0, 0.0, 1.0, edge, [](double, double) { return true; });
}

TEST(GeodesicMarch, StraightWaysOnThePlateAreExact_ExactOracle)
{
  const MeshCase plate = Plate(0.05);
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  GeodesicMarch march(disc.Value);
  const int source = disc->NumPoints() / 2;
  const std::vector<double> distances = march.Distances(source);
  int exact = 0;
  double worst = 0.0;
  for (int v = 0; v < disc->NumPoints(); ++v)
  {
    const double truth = (plate.Flat.row(v) - plate.Flat.row(source)).norm();
    const double error = distances[static_cast<std::size_t>(v)] - truth;
    EXPECT_GE(error, -Rounding);
    worst = std::max(worst, error);
    exact += error < Rounding ? 1 : 0;
  }
  // the boundary zigzags by the jitter, and bends ways along it
  EXPECT_GE(exact, disc->NumPoints() * 9 / 10);
  EXPECT_LE(worst, 0.02);
}

TEST(GeodesicMarch, EdgeGraphIsTooLong_PropertyOracle)
{
  const MeshCase plate = Plate(0.05);
  const auto disc = CheckMesh(plate.Mesh);
  GeodesicMarch march(disc.Value);
  GeodesicMarch edges(disc.Value, GeodesicEstimator::EdgeGraph);
  const std::vector<double> better = march.Distances(0);
  const std::vector<double> worse = edges.Distances(0);
  double sum = 0.0;
  for (std::size_t v = 1; v < better.size(); ++v)
  {
    EXPECT_GE(worse[v], better[v] * (1.0 - 1e-9));
    sum += worse[v] / better[v] / static_cast<double>(better.size() - 1);
  }
  EXPECT_GT(sum, 1.02);
}

TEST(GeodesicMarch, UnfoldedPlacesOnTheCylinderAreTheFlatOnes_CrossOracle)
{
  // chords of a cylinder of radius 0.5 with edges of 0.02 are shorter by (0.02)^2 / 24 / 0.25
  const MeshCase plate = CylinderWithHoles(0.02);
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  GeodesicMarch march(disc.Value);
  std::vector<int> vertices;
  PointMatrix places;
  for (int source = 0; source < disc->NumPoints(); source += 37)
  {
    march.Nearest(source, 12, vertices, places);
    ASSERT_EQ(vertices.size(), 13u);
    EXPECT_EQ(vertices.front(), source);
    PointMatrix flat(13, 2);
    for (Eigen::Index i = 0; i < 13; ++i)
    {
      flat.row(i) = plate.Flat.row(
        disc->PointIds[static_cast<std::size_t>(vertices[static_cast<std::size_t>(i)])]);
    }
    EXPECT_LE(RigidError(places, flat), 1e-3) << source;
  }
}

TEST(GeodesicMarch, NearestOnTheRollAreOfOneLayer_PropertyOracle)
{
  // layers half an edge apart: Euclidean neighbours would be those of the next layer
  MeshCase roll = FlatCase(0.0, 6.0, 0.0, 1.0, 0.05, [](double, double) { return true; });
  Lift(roll,
    [](double x, double y)
    {
      const double pitch = 0.025 / (2.0 * std::acos(-1.0));
      const double r = 0.4 + pitch * x / 0.4;
      return Eigen::RowVector3d(r * std::cos(x / 0.4), r * std::sin(x / 0.4), y);
    });
  const auto disc = CheckMesh(roll.Mesh);
  ASSERT_TRUE(disc);
  GeodesicMarch march(disc.Value);
  std::vector<int> vertices;
  PointMatrix places;
  for (int source = 0; source < disc->NumPoints(); source += 11)
  {
    march.Nearest(source, 12, vertices, places);
    for (int v : vertices)
    {
      EXPECT_LE((roll.Flat.row(v) - roll.Flat.row(source)).norm(), 0.3);
    }
  }
}

TEST(GeodesicMarch, DistancesAreSymmetric_PropertyOracle)
{
  const auto disc = CheckMesh(Hill(0.05, 0.5).Mesh);
  ASSERT_TRUE(disc);
  GeodesicMarch march(disc.Value);
  const int a = 3;
  const int b = disc->NumPoints() - 5;
  const double there = march.Distances(a)[static_cast<std::size_t>(b)];
  const double back = march.Distances(b)[static_cast<std::size_t>(a)];
  EXPECT_NEAR(there, back, 0.01 * there); // an estimator, not an exact algorithm
}
}
}
