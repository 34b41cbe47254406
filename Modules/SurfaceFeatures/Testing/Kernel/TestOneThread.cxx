// SPDX-License-Identifier: BSD-3-Clause
// Each work in a process of its own (ThreadCases.h): its surfaces are made there, on one thread.
#include "HillSurfaces.h"
#include "ThreadCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SurfaceFeatures/Contours.h>
#include <knotwork/SurfaceFeatures/CriticalPoints.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

TEST(OneThread, ContoursAndExtrema_PropertyOracle)
{
  ExpectOneThread(
    []
    {
      const Spline<2> surface = Hills(SpaceKind::LocallyRefined);
      ContourParams contours;
      contours.Component = 2;
      contours.Levels = { 0.1, 0.5 };
      contours.Threads = 1;
      CriticalPointParams extrema;
      extrema.Component = 2;
      extrema.Threads = 1;
      return TraceContours(MakeBezierForm(surface, 1), contours) &&
        FindCriticalPoints(surface, extrema);
    });
}
