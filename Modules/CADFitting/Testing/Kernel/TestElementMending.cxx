// SPDX-License-Identifier: BSD-3-Clause
// Control points of surfaces in space that are moved until elements are valid.
#include "ElementMending.h"
#include "FitCases.h"

#include <gtest/gtest.h>

using namespace knotwork;
using namespace fits;

namespace
{
constexpr int CellsAcross = 6;

/// A sixth of a cylinder of radius 1 and height 1, biquadratic, one of its control points too far
/// round by 1.45 cells.
Spline<2> FoldedCylinder()
{
  Placer<2> placer;
  const auto at = [](double u, double v)
  {
    const double angle = u * static_cast<double>(EIGEN_PI) / 3.0;
    return Eigen::RowVector3d(std::cos(angle), std::sin(angle), v);
  };
  AddBlock<2>(
    placer, { CellsAcross, CellsAcross }, [&](const double* u) { return at(u[0], u[1]); });
  const PlacedMesh<2> mesh = placer.Done();
  CADFitParams params;
  params.Space.Degree = 2;
  params.TargetSamples = 0;
  auto fit = FitToTarget<2>(mesh.Mesh, mesh.Points, nullptr, params);
  EXPECT_TRUE(fit) << fit.Status.Message();
  Spline<2> spline = std::move(fit->Value);
  EXPECT_TRUE(CertifyElements<2>(spline, 1)->Bad.empty());
  Eigen::Index middle = 0;
  (spline.ControlPoints.rowwise() - at(0.5, 0.5)).rowwise().norm().minCoeff(&middle);
  spline.ControlPoints.row(middle) +=
    1.45 / CellsAcross * Eigen::RowVector3d(-0.5, std::sqrt(0.75), 0.0);
  return spline;
}
}

TEST(ElementMending, AFoldInABentSurfaceIsMended_PropertyOracle)
{
  const Spline<2> folded = FoldedCylinder();
  const auto before = CertifyElements<2>(folded, 1);
  ASSERT_FALSE(before->Bad.empty());
  std::vector<char> held(static_cast<std::size_t>(folded.ControlPoints.rows()), 1);
  MendingParams params;
  params.Rings = 1;
  Spline<2> mended = folded;
  EXPECT_EQ(MinimizeBarrier<2>(mended, before->Bad, before->IsReversed, held, params).Value, 0);
  EXPECT_EQ(mended.ControlPoints, folded.ControlPoints); // all are held
  params.Attraction = 3.0;
  const auto changed = MinimizeBarrier<2>(mended, before->Bad, before->IsReversed, held, params);
  ASSERT_TRUE(changed) << changed.Status.Message();
  EXPECT_GT(changed.Value, 0);
  EXPECT_TRUE(CertifyElements<2>(mended, 1)->Bad.empty());
  // half an element at most
  const Eigen::VectorXd moves = (mended.ControlPoints - folded.ControlPoints).rowwise().norm();
  EXPECT_LE(moves.maxCoeff(), 0.5 * 1.2 / CellsAcross);

  std::fill(held.begin(), held.end(), HeldFast);
  mended = folded;
  EXPECT_EQ(MinimizeBarrier<2>(mended, before->Bad, before->IsReversed, held, params).Value, 0);
  EXPECT_EQ(mended.ControlPoints, folded.ControlPoints);
}

/// The normals of a closed surface have no common side: it is seen from nowhere.
TEST(ElementMending, WhatBendsTooMuchStays_ExactOracle)
{
  const PlacedMesh<2> sphere = Sphere(4);
  CADFitParams fitParams;
  fitParams.Space.Degree = 2;
  fitParams.TargetSamples = 0;
  const auto fit = FitToTarget<2>(sphere.Mesh, sphere.Points, Ellipsoid(1.0, 1.0, 1.0), fitParams);
  ASSERT_TRUE(fit) << fit.Status.Message();
  Spline<2> spline = fit->Value;
  const std::vector<char> held(static_cast<std::size_t>(spline.ControlPoints.rows()), 1);
  MendingParams params;
  params.Rings = 10;
  params.Attraction = 1.0;
  EXPECT_EQ(MinimizeBarrier<2>(spline, { 0 }, false, held, params).Value, 0);
  EXPECT_EQ(spline.ControlPoints, fit->Value.ControlPoints);
}
