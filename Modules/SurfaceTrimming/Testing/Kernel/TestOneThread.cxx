// SPDX-License-Identifier: BSD-3-Clause
// Each work in a process of its own (ThreadCases.h): its surfaces are made there, on one thread.
#include "HillSurfaces.h"
#include "ThreadCases.h"
#include <knotwork/SurfaceTrimming/TrimToPoints.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

TEST(OneThread, TrimmingToPoints_PropertyOracle)
{
  ExpectOneThread(
    []
    {
      TrimToPointsParams params;
      params.Threads = 1;
      return static_cast<bool>(
        TrimToPoints(Hills(SpaceKind::Hierarchical), GridPoints(60, 2), params));
    });
}
