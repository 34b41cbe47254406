// SPDX-License-Identifier: BSD-3-Clause
// Each work in a process of its own (ThreadCases.h): its splines are made there, on one thread.
#include "ThreadCases.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SplineCore/LROperations.h>
#include <knotwork/SplineCore/Recovery.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
/// A rational LR surface with several chunks of everything that runs in parallel.
Spline<2> Surface()
{
  constexpr int elements = 40;
  const auto tensor = MakeTensorSpace<2>(
    { KnotVector::Uniform(2, elements, 0, 1), KnotVector::Uniform(2, elements, 0, 1) });
  Spline<2> surface;
  surface.Space = tensor.Value;
  surface.ControlPoints = GrevillePoints(*surface.Space);
  surface.Weights = (1.0 + surface.ControlPoints.col(0).array()).matrix();
  return InsertSegments(surface, { { 0, 0.51, 0, 0.5, 1 } }, 1).Value;
}
}

TEST(OneThread, Recovery_PropertyOracle)
{
  ExpectOneThread(
    []
    {
      const Spline<2> surface = Surface();
      const Spline<2> field{ surface.Space, surface.ControlPoints, {} };
      return RecoverSpline(MakeBezierForm(surface, 1), 1) &&
        RecoverField(MakeBezierForm(field, 1), surface.Weights, 1);
    });
}

TEST(OneThread, Operations_PropertyOracle)
{
  ExpectOneThread(
    []
    {
      const Spline<2> surface = Surface();
      return ExpandToTensor(surface, 1) && SwapParameters(surface, 1) &&
        ReverseParameter(surface, 0, 1) &&
        RestrictToBox(surface, { { 0.1, 0.2 }, { 0.9, 0.7 } }, 1) && IsoCurve(surface, 0, 0.3, 1) &&
        ResolveDependence(surface, 1, 1) &&
        CollocationMatrix<2>(*surface.Space, surface.ControlPoints, 1);
    });
}
