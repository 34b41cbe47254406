// SPDX-License-Identifier: BSD-3-Clause
#include "LRCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/FunctionGraph.h>

#include <limits>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
void ExpectGraph(Random& random, const SplineSpacePtr<2>& space)
{
  const Spline<2> function = RandomSpline(random, space, 1, false);
  const auto graph = GraphOfFunction(function, 0);
  ASSERT_TRUE(graph) << graph.Status.Message();
  EXPECT_EQ(graph->Space, space);
  EXPECT_EQ(graph->ControlPoints.col(2), function.ControlPoints.col(0));
  const PointMatrix parameters = RandomParameters(random, *space, 100);
  EvaluationBatch points;
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(graph.Value), parameters, {}, points));
  // roundings of a sum of some dozen products, and those of the recovery: 64 eps of the size
  EXPECT_LE((points.Values.leftCols(2) - parameters).cwiseAbs().maxCoeff(),
    64 * oracle::Epsilon * (1.0 + parameters.cwiseAbs().maxCoeff()));
}
}

TEST(FunctionGraph, HasTheParametersThemselves_ExactOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto tensor = RandomTensorSpace<2>(random, 4, 5);
    ExpectGraph(random, tensor);
    ExpectGraph(random, RandomHierarchicalSpace<2>(random, 3, 4, 3));
    const Spline<2> surface = RandomClampedSurface(random, 3, 5, 1, false);
    const auto local = InsertSegments(surface.Space, RandomSegments(random, surface.Space, 8), 0);
    ASSERT_TRUE(local) << local.Status.Message();
    ExpectGraph(random, local.Value);
  }
}

TEST(FunctionGraph, EveryFailureIsReachable_ExactOracle)
{
  Random random(1);
  const auto space = RandomTensorSpace<2>(random, 3, 3);
  EXPECT_EQ(GraphOfFunction(RandomSpline(random, space, 2, false), 0).Status.Code,
    ErrorCode::DimensionMismatch);
  EXPECT_EQ(GraphOfFunction(RandomSpline(random, space, 1, true), 0).Status.Code,
    ErrorCode::InvalidParameter);
  EXPECT_EQ(GraphOfFunction({}, 0).Status.Code, ErrorCode::EmptyInput);
  Spline<2> bad = RandomSpline(random, space, 1, false);
  bad.ControlPoints(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(GraphOfFunction(bad, 0).Status.Code, ErrorCode::NonFiniteInput);
}
