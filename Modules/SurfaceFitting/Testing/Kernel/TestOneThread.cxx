// SPDX-License-Identifier: BSD-3-Clause
// Each work in a process of its own (ThreadCases.h): its surfaces are made there, on one thread.
#include "HillSurfaces.h"
#include "ThreadCases.h"
#include <knotwork/SurfaceFitting/CombineSplines.h>
#include <knotwork/SurfaceFitting/StitchTiles.h>
#include <knotwork/SurfaceFitting/SurfaceDistance.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

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
