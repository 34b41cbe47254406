// SPDX-License-Identifier: BSD-3-Clause
// Scans that differ from their models by known amounts.
#include "AlignmentCases.h"
#include "FitCases.h"
#include <knotwork/CADFitting/DeviationMap.h>

#include <gtest/gtest.h>

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
  double area = 0.0;
  for (Eigen::Index i = 0; i < map.OfModel.size(); ++i)
  {
    EXPECT_NEAR(
      (map.ScanPoints.row(i) - map.Model.Points.row(i)).norm(), std::abs(map.OfModel[i]), 1e-12);
    area += map.OfModel[i] < -0.0999 ? 1.0 : 0.0;
  }
  EXPECT_NEAR(area / static_cast<double>(map.OfModel.size()), 0.64 / 22.0, 0.01);
  EXPECT_NEAR(AreaOf(map.Model), 22.0, 1e-9); // dividing leaves neither gaps nor folds
}

TEST(DeviationMap, WhatNobodyScannedHasNoDistance_ExactOracle)
{
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(3.0, 2.0, 1.0).Shape();
  Seeded random(2);
  const PointMatrix all = CloudOn(*TargetOf(block), 40000, 0.0, 0.0, random);
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
    EXPECT_EQ(std::isnan(map.OfModel[i]),
      map.Model.Points(i, 0) > 1.5 &&
        (map.ScanPoints.row(i) - map.Model.Points.row(i)).norm() > 0.05);
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
  params.Progress = [](double) { return false; };
  EXPECT_EQ(code(box, box, params), ErrorCode::Aborted);
}
