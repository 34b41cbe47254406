// SPDX-License-Identifier: BSD-3-Clause
// Control points of surfaces in space that are moved until elements are valid.
#include "ElementMending.h"
#include "ElementUnfolding.h"
#include "FitCases.h"

#include <gtest/gtest.h>

#include <random>

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

/// All of them slide on the whole target.
ControlPointPlaces Sliding(Eigen::Index count)
{
  const auto n = static_cast<std::size_t>(count);
  return { std::vector<char>(n, 0), std::vector<char>(n, 1), std::vector<TargetPart>(n) };
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

/// Control points slide on the cylinder until no element is folded, and stay on it.
TEST(ElementUnfolding, AFoldIsUnfoldedAlongTheTarget_PropertyOracle)
{
  const Spline<2> folded = FoldedCylinder();
  const auto before = CertifyElements<2>(folded, 1);
  ASSERT_FALSE(before->Bad.empty());
  const FitTargetPtr cylinder = Cylinder();
  ControlPointPlaces places = Sliding(folded.ControlPoints.rows());
  UnfoldingParams params;
  Spline<2> mended = folded;
  const auto changed = Unfold<2>(mended, before->Bad, false, places, *cylinder, params);
  ASSERT_TRUE(changed) << changed.Status.Message();
  EXPECT_GT(changed.Value, 0);
  EXPECT_TRUE(CertifyElements<2>(mended, 1)->Bad.empty());
  const auto radius = [](const Eigen::RowVector3d& x) { return std::hypot(x[0], x[1]) - 1.0; };
  EXPECT_LE(MeanDistance(mended, radius), 1.1 * MeanDistance(folded, radius));

  std::fill(places.IsHeld.begin(), places.IsHeld.end(), 1);
  mended = folded;
  EXPECT_EQ(Unfold<2>(mended, before->Bad, false, places, *cylinder, params).Value, 0);
  EXPECT_EQ(mended.ControlPoints, folded.ControlPoints);

  std::fill(places.IsHeld.begin(), places.IsHeld.end(), 0);
  params.Progress = [](double) { return false; };
  EXPECT_EQ(Unfold<2>(mended, before->Bad, false, places, *cylinder, params).Status.Code,
    ErrorCode::Aborted);
}

/// A patch that is seen from nowhere: it goes round a whole sphere.
TEST(ElementUnfolding, HoweverMuchThePatchBends_PropertyOracle)
{
  const PlacedMesh<2> mesh = Sphere(4);
  const FitTargetPtr sphere = Ellipsoid(1.0, 1.0, 1.0);
  CADFitParams fitParams;
  fitParams.Space.Degree = 2;
  fitParams.TargetSamples = 0;
  const auto fit = FitToTarget<2>(mesh.Mesh, mesh.Points, sphere, fitParams);
  ASSERT_TRUE(fit) << fit.Status.Message();
  Spline<2> spline = fit->Value;
  // what is near a place goes there
  const Eigen::RowVector3d place = Eigen::RowVector3d(0.2, 0.2, 1.0).normalized();
  for (Eigen::Index i = 0; i < spline.ControlPoints.rows(); ++i)
  {
    if ((spline.ControlPoints.row(i) - place).norm() < 0.65)
    {
      spline.ControlPoints.row(i) = place;
    }
  }
  const auto before = CertifyElements<2>(spline, 1);
  ASSERT_FALSE(before->Bad.empty());
  const ControlPointPlaces places = Sliding(spline.ControlPoints.rows());
  UnfoldingParams params;
  params.Rings = 10;
  const auto changed = Unfold<2>(spline, before->Bad, false, places, *sphere, params);
  ASSERT_TRUE(changed) << changed.Status.Message();
  EXPECT_TRUE(CertifyElements<2>(spline, 1)->Bad.empty());
  EXPECT_LE(MeanDistance(spline, FromUnitSphere), 0.02);
}

/// A cube with a control point that has gone past its neighbours: inside it goes anywhere, on a
/// side it slides.
TEST(ElementUnfolding, VolumesInside_PropertyOracle)
{
  Placer<3> placer;
  AddBlock<3>(
    placer, { 4, 4, 4 }, [](const double* u) { return Eigen::RowVector3d(u[0], u[1], u[2]); });
  const PlacedMesh<3> mesh = placer.Done();
  const auto target = MakeMeshTarget(BoxTriangles(4));
  ASSERT_TRUE(target) << target.Status.Message();
  CADFitParams fitParams;
  fitParams.Space.Degree = 2;
  fitParams.TargetSamples = 0;
  const auto fit = FitToTarget<3>(mesh.Mesh, mesh.Points, target.Value, fitParams);
  ASSERT_TRUE(fit) << fit.Status.Message();
  const Spline<3> straight = fit->Value;
  const auto count = straight.ControlPoints.rows();
  ControlPointPlaces places = Sliding(count);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const auto at = static_cast<std::size_t>(i);
    const Eigen::RowVector3d x = straight.ControlPoints.row(i);
    const bool isOnLid = std::abs(x[2] - 1.0) < 1e-9;
    const int sides =
      static_cast<int>((x.array().abs() < 1e-9).count() + ((x.array() - 1.0).abs() < 1e-9).count());
    places.IsOnSurface[at] = sides > 0 ? 1 : 0;
    places.IsHeld[at] = sides > 1 || (sides == 1 && !isOnLid) ? 1 : 0;
  }
  for (const double height : { 0.375, 1.0 }) // inside, and on the upper side
  {
    Spline<3> folded = straight;
    Eigen::Index moved = 0;
    (straight.ControlPoints.rowwise() - Eigen::RowVector3d(0.375, 0.375, height))
      .rowwise()
      .norm()
      .minCoeff(&moved);
    ASSERT_EQ(places.IsOnSurface[static_cast<std::size_t>(moved)] != 0, height == 1.0);
    folded.ControlPoints(moved, 0) += 0.5;
    const auto before = CertifyElements<3>(folded, 1);
    ASSERT_FALSE(before->Bad.empty()) << height;
    UnfoldingParams params;
    params.Threads = 1;
    Spline<3> mended = folded;
    const auto changed =
      Unfold<3>(mended, before->Bad, before->IsReversed, places, *target.Value, params);
    ASSERT_TRUE(changed) << changed.Status.Message();
    EXPECT_GT(changed.Value, 0);
    EXPECT_TRUE(CertifyElements<3>(mended, 1)->Bad.empty()) << height;
    for (Eigen::Index i = 0; i < count; ++i)
    {
      const auto at = static_cast<std::size_t>(i);
      if (places.IsHeld[at] != 0)
      {
        EXPECT_EQ(mended.ControlPoints.row(i), folded.ControlPoints.row(i));
      }
      else if (places.IsOnSurface[at] != 0)
      {
        EXPECT_NEAR(mended.ControlPoints(i, 2), 1.0, 1e-12);
      }
    }
    params.Threads = 3;
    Spline<3> other = folded;
    EXPECT_TRUE(Unfold<3>(other, before->Bad, before->IsReversed, places, *target.Value, params));
    EXPECT_EQ(other.ControlPoints, mended.ControlPoints);
  }
}

// Nets may be inverted although every element is proved valid: what is mended then are these. The
// verdicts stay.
TEST(ElementMending, InvertedNetsOfValidElements_PropertyOracle)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shake(-0.04, 0.04);
  int inverted = 0;
  for (int round = 0; round < 40; ++round)
  {
    Placer<2> placer;
    AddBlock<2>(
      placer, { 4, 4 }, [](const double* u) { return Eigen::RowVector3d(u[0], u[1], 0.0); });
    PlacedMesh<2> mesh = placer.Done();
    for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
    {
      mesh.Points.row(i) += Eigen::RowVector3d(shake(random), shake(random), 0.0);
    }
    CADFitParams params;
    params.Space.Degree = 3;
    params.TargetSamples = 0;
    params.Smoothing = FitSmoothing::Off;
    const auto plain = FitToTarget<2>(mesh.Mesh, mesh.Points, nullptr, params);
    ASSERT_TRUE(plain) << plain.Status.Message();
    const auto verdicts = CertifyElements<2>(plain->Value, 1);
    params.Smoothing = FitSmoothing::Net;
    const auto mended = FitToTarget<2>(mesh.Mesh, mesh.Points, nullptr, params);
    ASSERT_TRUE(mended) << mended.Status.Message();
    EXPECT_LE(CertifyElements<2>(mended->Value, 1)->Bad.size(), verdicts->Bad.size());
    const bool isNet = verdicts->Bad.empty() && !InvertedNets<2>(plain->Value, false).empty();
    inverted += isNet ? 1 : 0;
  }
  EXPECT_GT(inverted, 3);
}
