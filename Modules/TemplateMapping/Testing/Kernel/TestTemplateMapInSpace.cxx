// SPDX-License-Identifier: BSD-3-Clause
// MapTemplate for surfaces in space.
#include "MapCases.h"
#include "SurfaceCases.h"
#include <knotwork/SplineCore/QualityFunctionals.h>
#include <knotwork/TemplateMapping/TemplateMap.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace knotwork;

namespace
{
const ParametricBox<3> UnitCube{ { 0, 0, 0 }, { 1, 1, 1 } };

template <typename Move>
Skeleton<3> Moved(const Skeleton<3>& skeleton, const Move& move)
{
  Skeleton<3> moved = skeleton;
  for (SkeletonPatch<3>& patch : moved)
  {
    for (Eigen::Index i = 0; i < patch.Points.rows(); ++i)
    {
      patch.Points.row(i) = move(Eigen::RowVector3d(patch.Points.row(i)));
    }
  }
  return moved;
}

/// Three lobes around the axis through the middle, twisted along it.
Eigen::RowVector3d Lobed(const Eigen::RowVector3d& x, double amplitude)
{
  const Eigen::RowVector3d out = x.array() - 0.5;
  const double angle = std::atan2(out(1), out(0)) + out(2);
  const double reach = std::pow(std::hypot(out(0), out(1)) / 0.25, 3);
  return (1.0 + amplitude * reach * std::cos(3.0 * angle)) * out.array() + 0.5;
}

template <typename Change>
TemplateMapResult<3> Map(
  const Skeleton<3>& skeleton, const Skeleton<3>& target, const Change& change)
{
  TemplateMapParams<3> params;
  params.InnerKnots = { 4, 4, 4 };
  params.Iterations = 4;
  params.Domain = UnitCube;
  change(params);
  auto result = MapTemplate(skeleton, target, params);
  EXPECT_TRUE(result) << result.Status.Message();
  return std::move(result.Value);
}

template <typename Change>
TemplateMapResult<3> MapLobed(double amplitude, const Change& change)
{
  const Skeleton<3> sphere{ cases::Sphere(4) };
  return Map(sphere, Moved(sphere, [=](const auto& x) { return Lobed(x, amplitude); }), change);
}
}

TEST(TemplateMapInSpace, AffineTargetsAreReached_ExactOracle)
{
  const Skeleton<3> plate{ cases::Plate(8) };
  const Skeleton<3> target = Moved(plate,
    [](const Eigen::RowVector3d& x)
    { return Eigen::RowVector3d(1.2 * x(0) + 0.1 * x(1) + 1.0, 0.9 * x(1), x(2) - 0.2 * x(0)); });
  const auto result = Map(plate, target,
    [](auto& p)
    {
      p.InnerKnots = { 1, 1, 1 };
      p.TikhonovWeight = 1e-6;
      p.Method = TemplateMapMethod::Fixed; // at the parameters of the plates
    });
  // What is left belongs to the proximal term, whose share falls from step to step.
  EXPECT_LE(result.History.back().MaxError, 1e-6);
  EXPECT_EQ(result.Skeleton[0].Id, 0);
  EXPECT_GE(result.Skeleton[0].Triangles.size(), 128u);
}

TEST(TemplateMapInSpace, TheGuardKeepsItRegular_PropertyOracle)
{
  const auto eight = [](auto& p) { p.Iterations = 8; };
  const auto plain = MapLobed(0.4,
    [&](auto& p)
    {
      eight(p);
      p.Guard = false;
    });
  EXPECT_GT(plain.History.back().NegativeShare, 0.001);
  EXPECT_LT(plain.MinJacobianBound, 0.0);
  EXPECT_NE(plain.Injectivity.Verdict, InjectivityVerdict::Injective);
  const auto guarded = MapLobed(0.4, eight);
  EXPECT_GT(guarded.MinJacobianBound, 0.0);
  EXPECT_EQ(guarded.Certificate.Verdict, Verdict::Valid);
  EXPECT_EQ(guarded.Injectivity.Verdict, InjectivityVerdict::Injective);
  const PointMatrix grid = cases::GridOver<3>(30);
  EXPECT_GT(cases::Determinants(MakeBezierForm(guarded.Map), grid).minCoeff(), 0.0);
  EXPECT_LT(guarded.History.back().SquaredError, 2.0 * plain.History.back().SquaredError);
  EXPECT_LT(guarded.History.back().SquaredError, 0.1 * guarded.History.front().SquaredError);
}

TEST(TemplateMapInSpace, RefinementLowersTheError_PropertyOracle)
{
  const auto coarse = MapLobed(0.2, [](auto&) {});
  const auto local = MapLobed(0.2,
    [](auto& p)
    {
      p.Refinement = TemplateRefinement::Local;
      p.RefineEvery = 2;
      p.RefineThreshold = 1e-3;
    });
  const auto everywhere = MapLobed(0.2,
    [](auto& p)
    {
      p.Refinement = TemplateRefinement::Global;
      p.RefineEvery = 2;
    });
  EXPECT_EQ(coarse.History.back().Functions, 8 * 8 * 8);
  EXPECT_EQ(everywhere.History.back().Functions, 13 * 13 * 13);
  EXPECT_GT(local.History.back().Functions, 8 * 8 * 8);
  EXPECT_LT(local.History.back().Functions, 13 * 13 * 13);
  EXPECT_LT(local.History.back().SquaredError, 0.5 * coarse.History.back().SquaredError);
  EXPECT_LT(everywhere.History.back().SquaredError, 0.5 * coarse.History.back().SquaredError);
  EXPECT_GT(local.MinJacobianBound, 0.0);
  EXPECT_GT(everywhere.MinJacobianBound, 0.0);
}

TEST(TemplateMapInSpace, FunctionalsFallWithTheirWeights_PropertyOracle)
{
  const auto plain = MapLobed(0.2, [](auto&) {});
  const auto expect = [&](QualityKind kind, const auto& change)
  {
    EXPECT_LT(QualityValue(MakeBezierForm(MapLobed(0.2, change).Map), kind),
      0.999 * QualityValue(MakeBezierForm(plain.Map), kind));
  };
  expect(QualityKind::Uniformity, [](auto& p) { p.UniformityWeight = 1e-3; });
  expect(QualityKind::Orthogonality, [](auto& p) { p.OrthogonalityWeight = 1.0; });
}

TEST(TemplateMapInSpace, ItBeginsWhereItIsTold_PropertyOracle)
{
  const Skeleton<3> sphere{ cases::Sphere(3) };
  const Skeleton<3> target = Moved(sphere,
    [](const Eigen::RowVector3d& x)
    { return Eigen::RowVector3d(x + Eigen::RowVector3d(2.0, 0.0, -1.0)); });
  const auto first = [&](TemplateInitialMap start)
  {
    return Map(sphere, target,
      [&](auto& p)
      {
        p.Start = start;
        p.Iterations = 1;
        p.TikhonovWeight = 1.0;
      });
  };
  const auto identity = first(TemplateInitialMap::Identity);
  EXPECT_LT(first(TemplateInitialMap::Moved).History[0].SquaredError,
    0.5 * identity.History[0].SquaredError);
  const auto onward = Map(sphere, target, [&](auto& p) { p.InitialMap = identity.Map; });
  EXPECT_LT(onward.History.back().SquaredError, identity.History[0].SquaredError);
}

TEST(TemplateMapInSpace, ThreadsDoNotChangeABit_PropertyOracle)
{
  const auto with = [](int threads)
  {
    return MapLobed(0.4,
      [&](auto& p)
      {
        p.Threads = threads;
        p.Refinement = TemplateRefinement::Local;
        p.RefineThreshold = 1e-2;
      });
  };
  const auto one = with(1);
  const auto two = with(2);
  EXPECT_EQ(one.Map.ControlPoints, two.Map.ControlPoints);
  EXPECT_EQ(one.ElementErrors, two.ElementErrors);
  EXPECT_EQ(one.ElementMinJacobian, two.ElementMinJacobian);
}
