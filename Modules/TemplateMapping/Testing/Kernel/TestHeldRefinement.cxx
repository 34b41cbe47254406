// SPDX-License-Identifier: BSD-3-Clause
// Strongly folding targets in space: what the guard costs, and what finer cells where it holds
// elements back win.
#include "SurfaceCases.h"
#include <knotwork/TemplateMapping/TemplateMap.h>

#include <gtest/gtest.h>

#include <cstdio>

using namespace knotwork;

namespace
{
TemplateMapResult<3> MapCase(unsigned seed, bool guard, TemplateRefinement refinement)
{
  const Skeleton<3> sphere{ cases::Sphere(3) };
  TemplateMapParams<3> params;
  params.InnerKnots.fill(4);
  params.Iterations = 12;
  params.RefineEvery = 3;
  params.MaxLevel = 1;
  params.Injectivity = false;
  params.Guard = guard;
  params.Refinement = refinement;
  params.Domain = ParametricBox<3>{ { 0, 0, 0 }, { 1, 1, 1 } };
  auto result = MapTemplate(sphere, cases::TwistedLobes(sphere, seed), params);
  EXPECT_TRUE(result) << result.Status.Message();
  return std::move(result.Value);
}
}

TEST(HeldRefinement, HalvesTheGapToPlainOnFoldingData_PropertyOracle)
{
  int gaps = 0;
  int halved = 0;
  std::printf("seed  plain error  folded   guarded / plain  refined / plain  functions\n");
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    const auto plain = MapCase(seed, false, TemplateRefinement::None);
    const auto guarded = MapCase(seed, true, TemplateRefinement::None);
    const auto refined = MapCase(seed, true, TemplateRefinement::Held);
    EXPECT_GT(guarded.MinJacobianBound, 0.0) << seed;
    EXPECT_GT(refined.MinJacobianBound, 0.0) << seed;
    EXPECT_EQ(refined.Certificate.Verdict, Verdict::Valid) << seed;
    const double error = plain.History.back().SquaredError;
    const double before = guarded.History.back().SquaredError / error;
    const double after = refined.History.back().SquaredError / error;
    std::printf("%4u  %11.3e  %5.2f %%  %15.3f  %15.3f  %9d\n", seed, error,
      100.0 * plain.History.back().NegativeShare, before, after, refined.History.back().Functions);
    gaps += before > 1.3 ? 1 : 0;
    halved += before > 1.3 && after <= 0.5 * before ? 1 : 0;
  }
  EXPECT_GE(gaps, 4); // or the cases say nothing
  EXPECT_GE(2 * halved, gaps);
}

TEST(HeldRefinement, NothingIsRefinedWhereNothingIsHeld_ExactOracle)
{
  for (const unsigned seed : { 3u, 8u })
  {
    const auto without = MapCase(seed, true, TemplateRefinement::None);
    const auto with = MapCase(seed, true, TemplateRefinement::Held);
    ASSERT_EQ(without.History.back().HeldElements, 0);
    EXPECT_EQ(with.Map.ControlPoints, without.Map.ControlPoints);
  }
  const auto plain = MapCase(1, false, TemplateRefinement::Held);
  EXPECT_EQ(plain.History.back().Functions, plain.History.front().Functions);
}
