// SPDX-License-Identifier: BSD-3-Clause
// Each work in a process of its own (ThreadCases.h): its surfaces are made there, on one thread.
#include "BezierForm.h"
#include "CombineSplines.h"
#include "Contours.h"
#include "CriticalPoints.h"
#include "HierarchicalSpace.h"
#include "LRRefinement.h"
#include "StitchTiles.h"
#include "SurfaceDistance.h"
#include "TensorSpace.h"
#include "ThreadCases.h"
#include "TrimToPoints.h"

#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
/// z = sin 5x cos 4y at the Greville points, x from `left` on; large enough for several chunks of
/// everything that runs in parallel.
Spline<2> Hills(SpaceKind kind, double left = 0.0)
{
  constexpr int elements = 40;
  const auto tensor = MakeTensorSpace<2>(
    { KnotVector::Uniform(2, elements, left, left + 1), KnotVector::Uniform(2, elements, 0, 1) });
  Spline<2> surface;
  surface.Space = tensor.Value;
  const PointMatrix at = GrevillePoints(*surface.Space);
  surface.ControlPoints.resize(at.rows(), 3);
  for (Eigen::Index i = 0; i < at.rows(); ++i)
  {
    surface.ControlPoints.row(i) << at(i, 0), at(i, 1),
      std::sin(5.0 * at(i, 0)) * std::cos(4.0 * at(i, 1));
  }
  if (kind == SpaceKind::LocallyRefined)
  {
    return InsertSegments(surface, { { 0, left + 0.51, 0, 0.5, 1 } }, 1).Value;
  }
  if (kind == SpaceKind::Hierarchical)
  {
    const auto finer =
      MakeHierarchicalSpace<2>(surface.Space->Knots, { { 1, { 0, 0 }, { elements, elements } } });
    return TransferToRefined<2>(surface, finer.Value).Value;
  }
  return surface;
}

PointMatrix GridPoints(int n, int columns)
{
  PointMatrix points = PointMatrix::Zero(n * n, columns);
  for (int i = 0; i < n * n; ++i)
  {
    points(i, 0) = (i % n + 0.5) / n;
    points(i, 1) = (i / n + 0.5) / n;
  }
  return points;
}
}

TEST(OneThread, Combining_PropertyOracle)
{
  ExpectOneThread(
    []
    {
      CombineParams params;
      params.Threads = 1;
      return static_cast<bool>(CombineSplines(
        Hills(SpaceKind::Hierarchical), Hills(SpaceKind::LocallyRefined), 1.0, -1.0, params));
    });
}

TEST(OneThread, CombiningOnTheCommonDomain_PropertyOracle)
{
  ExpectOneThread(
    []
    {
      CombineParams params;
      params.Threads = 1;
      params.CommonDomain = true;
      return static_cast<bool>(CombineSplines(Hills(SpaceKind::LocallyRefined),
        Hills(SpaceKind::LocallyRefined, 0.3), 1.0, -1.0, params));
    });
}

TEST(OneThread, Stitching_PropertyOracle)
{
  ExpectOneThread(
    []
    {
      StitchParams params;
      params.Threads = 1;
      // the gap makes the second tile's knots move
      bool succeeded = static_cast<bool>(StitchTiles(
        { Hills(SpaceKind::Hierarchical), Hills(SpaceKind::LocallyRefined, 1.0 + 1e-8) }, params));
      params.Matching = TileMatching::Geometry;
      params.Tolerance = 0.1;
      succeeded = succeeded &&
        StitchTiles({ Hills(SpaceKind::Tensor), Hills(SpaceKind::Tensor, 1.0) }, params);
      return succeeded;
    });
}

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

TEST(OneThread, Distances_PropertyOracle)
{
  ExpectOneThread(
    []
    {
      SurfaceDistanceParams params;
      params.Threads = 1;
      const PointMatrix points = GridPoints(50, 3);
      bool succeeded = true;
      for (const DistanceKind kind : { DistanceKind::Vertical, DistanceKind::Closest })
      {
        params.Kind = kind;
        succeeded = succeeded &&
          MeasureSurfaceDistances(points, { Hills(SpaceKind::LocallyRefined) }, params);
      }
      return succeeded;
    });
}

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
