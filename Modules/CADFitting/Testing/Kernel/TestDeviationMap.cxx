// SPDX-License-Identifier: BSD-3-Clause
// Scans that differ from their models by known amounts.
#include "AlignmentCases.h"
#include "FitCases.h"
#include <knotwork/CADFitting/DeviationMap.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

using namespace knotwork;
using namespace alignment;

namespace
{
DeviationMap Mapped(const TriangleMesh& scan, const TopoDS_Shape& model, double sag,
  const DeviationMapParams& params = {})
{
  const auto map = MapDeviation(scan, *TargetOf(model), MeshOf(model, sag), params);
  EXPECT_TRUE(map) << map.Status.Message();
  return map.Value;
}

double AreaOf(const TriangleMesh& mesh)
{
  double area = 0.0;
  for (const auto& triangle : mesh.Triangles)
  {
    area += TriangleArea(mesh.Points, triangle);
  }
  return area;
}

/// The unit square as 10 x 4 rectangles at x = (i / 10)^2, raised by a share of x.
TriangleMesh UnevenGrid(double raise)
{
  TriangleMesh mesh;
  mesh.Points.resize(55, 3);
  for (int i = 0; i < 11; ++i)
  {
    for (int j = 0; j < 5; ++j)
    {
      const double x = 0.01 * i * i;
      mesh.Points.row(5 * i + j) << x, 0.25 * j, raise * x;
      if (i < 10 && j < 4)
      {
        const int a = 5 * i + j;
        mesh.Triangles.push_back({ a, a + 5, a + 6 });
        mesh.Triangles.push_back({ a, a + 6, a + 1 });
      }
    }
  }
  return mesh;
}
}

TEST(DeviationMap, BallsOfTwoRadii_ExactOracle)
{
  const TopoDS_Shape model = BRepPrimAPI_MakeSphere(1.0).Shape();
  for (const double excess : { 0.02, -0.03 })
  {
    const double sag = 1e-3;
    const DeviationMap map =
      Mapped(MeshOf(BRepPrimAPI_MakeSphere(1.0 + excess).Shape(), sag), model, 0.01);
    // vertices of the scan lie on its sphere, its triangles up to the sag inside
    EXPECT_NEAR(map.ScanProfile.Min, excess, 1e-9);
    EXPECT_NEAR(map.ScanProfile.Max, excess, 1e-9);
    EXPECT_GE(map.ModelProfile.Min, excess - 2.0 * sag);
    EXPECT_LE(map.ModelProfile.Max, excess + 1e-9);
    EXPECT_GE(map.Model.Points.rows(), 20000);
    EXPECT_LE((map.Model.Points.rowwise().norm().array() - 1.0).abs().maxCoeff(), 1e-9);
    for (const double percentile : map.ScanProfile.Percentiles)
    {
      EXPECT_NEAR(percentile, std::abs(excess), 1e-9);
    }
  }
}

/// A pocket of 1 x 1 and 0.1 deep, in a block of 22 square units: its bottom lies inside.
TEST(DeviationMap, Pocket_ExactOracle)
{
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(3.0, 2.0, 1.0).Shape();
  const TopoDS_Shape scan = BRepAlgoAPI_Cut(
    block, BRepPrimAPI_MakeBox(gp_Pnt(1.0, 0.5, 0.9), gp_Pnt(2.0, 1.5, 2.0)).Shape())
                              .Shape();
  DeviationMapParams params;
  params.Samples = 40000;
  const DeviationMap map = Mapped(MeshOf(scan, 0.01), block, 0.01, params);
  EXPECT_NEAR(map.ScanProfile.Min, -0.1, 1e-9);
  EXPECT_NEAR(map.ScanProfile.Max, 0.0, 1e-9);
  EXPECT_NEAR(map.ModelProfile.Min, -0.1, 1e-9);
  EXPECT_NEAR(map.ModelProfile.Max, 0.0, 1e-9);
  // 0.8 x 0.8 of the surface is as far from the bottom as the pocket is deep: 2.9 % of the area
  EXPECT_NEAR(map.ModelProfile.Percentiles[1], 0.0, 1e-12);
  EXPECT_NEAR(map.ModelProfile.Percentiles[3], 0.1, 1e-9);
  for (Eigen::Index i = 0; i < map.OfModel.size(); ++i)
  {
    EXPECT_NEAR(
      (map.ScanPoints.row(i) - map.Model.Points.row(i)).norm(), std::abs(map.OfModel[i]), 1e-12);
  }
  double area = 0.0; // that is as deep
  for (const auto& triangle : map.Model.Triangles)
  {
    for (const int corner : triangle)
    {
      const double third = TriangleArea(map.Model.Points, triangle) / 3.0;
      area += map.OfModel[corner] < -0.0999 ? third : 0.0;
    }
  }
  EXPECT_NEAR(area, 0.64, 0.02);
  // over the mouth the distance is 0.1 or that from the rim: 0.1 x 0.64 and 2 x^2 - 8/3 x^3 at 0.1
  EXPECT_NEAR(map.ModelProfile.Mean, -(0.064 + 0.02 - 0.008 / 3.0) / 22.0, 5e-5);
  EXPECT_NEAR(map.ModelProfile.MeanAbsolute, -map.ModelProfile.Mean, 1e-15);
  EXPECT_NEAR(AreaOf(map.Model), 22.0, 1e-9); // dividing leaves neither gaps nor folds
}

/// A square and a slope of 45 degrees over it, both denser at one side: of the square area counts,
/// of the slope points.
TEST(DeviationMap, MeansOfUnevenMeshes_ExactOracle)
{
  const TriangleMesh square = UnevenGrid(0.0);
  const TriangleMesh slope = UnevenGrid(1.0);
  const FitTargetPtr target = MakeMeshTarget(square).Value;
  DeviationMapParams params;
  params.Samples = 100;
  for (const bool isMesh : { true, false })
  {
    const TriangleMesh scan{ slope.Points,
      isMesh ? slope.Triangles : std::vector<std::array<int, 3>>() };
    const auto map = MapDeviation(scan, *target, square, params);
    ASSERT_TRUE(map) << map.Status.Message();
    // (i / 10)^2, i to 10: heights over the square
    EXPECT_NEAR(map->ScanProfile.Mean, 385.0 / 1100.0, 1e-12);
    EXPECT_NEAR(map->ScanProfile.MeanAbsolute, 385.0 / 1100.0, 1e-12);
    EXPECT_NEAR(map->ScanProfile.Rms, std::sqrt(25333.0 / 110000.0), 1e-12);
    if (isMesh)
    {
      // x / sqrt(2) over [0, 1]: linear, so that thirds of triangles integrate it exactly
      EXPECT_NEAR(map->ModelProfile.Mean, std::sqrt(0.5) / 2.0, 1e-12);
      EXPECT_NEAR(map->ModelProfile.MeanAbsolute, std::sqrt(0.5) / 2.0, 1e-12);
      EXPECT_NEAR(map->ModelProfile.Rms, std::sqrt(1.0 / 6.0), 3e-3);
      // half of the area has x up to 1 / 2
      EXPECT_NEAR(map->ModelProfile.Percentiles[0], std::sqrt(0.5) / 2.0, 0.05);
    }
  }
}

/// Triangles of equal sides, a bit shorter than edges that are halved: too few points as they are.
TEST(DeviationMap, PointsAreAtLeastAsManyAsSamples_ExactOracle)
{
  TriangleMesh sheet; // 12 x 12 parallelograms, 169 points
  sheet.Points.resize(169, 3);
  for (int i = 0; i < 13; ++i)
  {
    for (int j = 0; j < 13; ++j)
    {
      sheet.Points.row(13 * i + j) << i + 0.5 * j, std::sqrt(0.75) * j, 0.0;
      if (i < 12 && j < 12)
      {
        const int a = 13 * i + j;
        sheet.Triangles.push_back({ a, a + 13, a + 1 });
        sheet.Triangles.push_back({ a + 13, a + 14, a + 1 });
      }
    }
  }
  const FitTargetPtr target = MakeMeshTarget(sheet).Value;
  for (const int samples : { 100, 169, 170, 200, 270, 1000 })
  {
    DeviationMapParams params;
    params.Samples = samples;
    const auto map = MapDeviation(sheet, *target, sheet, params);
    ASSERT_TRUE(map);
    EXPECT_GE(map->Model.Points.rows(), samples);
    EXPECT_EQ(map->Model.Points.rows() == 169, samples <= 169);
    EXPECT_NEAR(AreaOf(map->Model), AreaOf(sheet), 1e-9);
  }
}

TEST(DeviationMap, SameForAnyNumberOfThreads_ExactOracle)
{
  const FitTargetPtr target = TargetOf(Bracket());
  TriangleMesh scan = MeshOf(Bracket(), 0.02);
  scan.Points = Seeded(3).Motion(0.3).Move(scan.Points);
  for (const bool isMesh : { true, false })
  {
    DeviationMapParams params;
    params.Threads = 1;
    const TriangleMesh model = MeshOf(Bracket(), 0.05);
    const auto one = MapDeviation(scan, *target, model, params);
    params.Threads = 3;
    const auto three = MapDeviation(scan, *target, model, params);
    ASSERT_TRUE(one && three);
    EXPECT_EQ(one->OfScan.Distances, three->OfScan.Distances);
    EXPECT_EQ(one->Model.Points, three->Model.Points);
    EXPECT_EQ(one->OfModel, three->OfModel);
    EXPECT_EQ(one->ScanPoints, three->ScanPoints);
    EXPECT_EQ(one->ModelProfile.Rms, three->ModelProfile.Rms);
    EXPECT_EQ(one->ModelProfile.Percentiles, three->ModelProfile.Percentiles);
    if (isMesh)
    {
      scan.Triangles.clear();
    }
  }
}

/// Every call of the progress can stop the work, whatever stage it is of.
TEST(DeviationMap, StopsWhereverItIsAsked)
{
  const TriangleMesh box = fits::BoxTriangles(3);
  const FitTargetPtr target = MakeMeshTarget(box).Value;
  for (const bool isMesh : { true, false })
  {
    const TriangleMesh scan{ box.Points, isMesh ? box.Triangles : decltype(box.Triangles)() };
    std::vector<double> shares;
    DeviationMapParams params;
    params.Progress = [&](double share)
    {
      shares.push_back(share);
      return true;
    };
    ASSERT_TRUE(MapDeviation(scan, *target, box, params));
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    const auto hasWithin = [&](double begin, double end)
    {
      return std::any_of(
        shares.begin(), shares.end(), [&](double share) { return share >= begin && share < end; });
    };
    EXPECT_TRUE(hasWithin(0.51, 0.6)); // triangles are divided
    EXPECT_TRUE(hasWithin(0.81, 1.0)); // distances from the scan
    for (const double last : shares)
    {
      params.Progress = [last](double share) { return share < last; };
      EXPECT_EQ(MapDeviation(scan, *target, box, params).Status.Code, ErrorCode::Aborted) << last;
    }
  }
}

TEST(DeviationMap, WhatNobodyScannedHasNoDistance_ExactOracle)
{
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(3.0, 2.0, 1.0).Shape();
  Seeded random(2);
  const PointMatrix all = CloudOn(*TargetOf(block), 20000, 0.0, 0.0, random);
  PointMatrix half(all.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < all.rows(); ++i)
  {
    if (all(i, 0) < 1.5)
    {
      half.row(count++) = all.row(i);
    }
  }
  DeviationMapParams params;
  params.MaximumDistance = 0.05;
  const DeviationMap map = Mapped({ half.topRows(count), {} }, block, 0.01, params);
  EXPECT_NEAR(map.NumWithout, 0.5 * static_cast<double>(map.OfModel.size()),
    0.05 * static_cast<double>(map.OfModel.size()));
  EXPECT_EQ(map.ModelProfile.NumPoints, map.OfModel.size() - map.NumWithout);
  EXPECT_LE(map.ModelProfile.Percentiles.back(), 0.05);
  for (Eigen::Index i = 0; i < map.OfModel.size(); ++i)
  {
    const double nearest =
      (half.topRows(count).rowwise() - map.Model.Points.row(i)).rowwise().norm().minCoeff();
    ASSERT_NEAR((map.ScanPoints.row(i) - map.Model.Points.row(i)).norm(), nearest, 1e-12) << i;
    ASSERT_EQ(std::isnan(map.OfModel[i]), nearest > 0.05) << i;
    ASSERT_TRUE(nearest > 0.05 || std::abs(map.OfModel[i]) == nearest ||
      std::abs(std::abs(map.OfModel[i]) - nearest) < 1e-12);
  }
}

/// The scan's top alone, an open mesh turned either way, and triangles that are no surface.
TEST(DeviationMap, OpenScans_ExactOracle)
{
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(3.0, 2.0, 1.0).Shape();
  for (const int kind : { 0, 1, 2 })
  {
    TriangleMesh top;
    top.Points.resize(5, 3);
    top.Points << 0.0, 0.0, 1.05, 3.0, 0.0, 1.05, 3.0, 2.0, 1.05, 0.0, 2.0, 1.05, 1.5, 1.0, 1.05;
    top.Triangles = { { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } };
    for (auto& triangle : top.Triangles)
    {
      if (kind == 1)
      {
        std::swap(triangle[0], triangle[1]);
      }
    }
    if (kind == 2)
    {
      top.Triangles.push_back(top.Triangles[0]); // an edge of three triangles
      top.Triangles.push_back(top.Triangles[0]);
    }
    DeviationMapParams params;
    params.MaximumDistance = 0.051;
    const DeviationMap map = Mapped(top, block, 0.01, params);
    EXPECT_NEAR(map.ScanProfile.Min, 0.05, 1e-12);
    EXPECT_NEAR(map.ModelProfile.Min, 0.05, 1e-12) << kind;
    EXPECT_NEAR(map.ModelProfile.Max, 0.05, 2e-3);
  }
}

TEST(DeviationMap, EveryFailureIsReachable)
{
  const TriangleMesh box = fits::BoxTriangles(3);
  const FitTargetPtr target = MakeMeshTarget(box).Value;
  const auto code = [&](const TriangleMesh& scan, const TriangleMesh& triangles,
                      const DeviationMapParams& params = {})
  { return MapDeviation(scan, *target, triangles, params).Status.Code; };
  EXPECT_EQ(code({ PointMatrix(0, 3), {} }, box), ErrorCode::EmptyInput);
  EXPECT_EQ(code(box, {}), ErrorCode::EmptyInput);
  TriangleMesh bad = box;
  bad.Points(2, 0) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code(bad, box), ErrorCode::NonFiniteInput);
  bad = box;
  bad.Triangles[0][0] = -1;
  EXPECT_EQ(code(bad, box), ErrorCode::InvalidTopology);
  DeviationMapParams params;
  params.Samples = 5;
  EXPECT_EQ(code(box, box, params), ErrorCode::InvalidParameter);
  params = {};
  params.MaximumDistance = -1.0;
  EXPECT_EQ(code(box, box, params), ErrorCode::InvalidParameter);
  params = {};
  params.Samples = 30000000;
  const auto large = MapDeviation(box, *target, box, params);
  EXPECT_EQ(large.Status.Code, ErrorCode::TooLarge);
  EXPECT_NE(large.Status.Detail.find("30000000 samples"), std::string::npos);
  // nothing of the model was scanned
  params = {};
  params.MaximumDistance = 0.5;
  bad = box;
  bad.Points.array() += 10.0;
  for (const bool isMesh : { true, false })
  {
    bad.Triangles = isMesh ? box.Triangles : decltype(box.Triangles)();
    const auto apart = MapDeviation(bad, *target, box, params);
    EXPECT_EQ(apart.Status.Code, ErrorCode::InvalidParameter);
    EXPECT_NE(apart.Status.Detail.find("within 0.5 of the scan"), std::string::npos);
  }
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(code(box, box, params), ErrorCode::Aborted);
}
