// SPDX-License-Identifier: BSD-3-Clause
// What is written once for all families, on LR B-splines.
#include "LRCases.h"
#include <knotwork/SplineCore/ClosestPoint.h>
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SplineCore/Recovery.h>
#include <knotwork/SplineCore/Tessellation.h>

#include <gtest/gtest.h>

#include <map>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
/// A wavy graph over [0, 3] x [0, 2], refined at random.
Spline<2> WavySurface(unsigned seed, bool rational)
{
  Random random(seed);
  Spline<2> tensor;
  tensor.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(3, 3, 0.0, 3.0), KnotVector::Uniform(2, 4, 0.0, 2.0) })
      .Value;
  const PointMatrix greville = GrevillePoints(*tensor.Space);
  tensor.ControlPoints.resize(tensor.Space->NumFunctions, 3);
  tensor.Weights.resize(rational ? tensor.Space->NumFunctions : 0);
  for (Eigen::Index i = 0; i < greville.rows(); ++i)
  {
    tensor.ControlPoints.row(i) << greville(i, 0), greville(i, 1), random.In(-0.3, 0.3);
  }
  for (double& w : tensor.Weights)
  {
    w = random.In(0.8, 1.25);
  }
  return InsertSegments(tensor, RandomSegments(random, tensor.Space, 12), 0).Value;
}

/// Edges of polygons that one polygon has; an interior one would be a gap.
int InteriorOpenEdges(const TessellationMesh& mesh)
{
  std::map<std::array<std::int64_t, 2>, int> edges;
  for (std::size_t c = 0; c + 1 < mesh.Offsets.size(); ++c)
  {
    for (std::int64_t k = mesh.Offsets[c]; k < mesh.Offsets[c + 1]; ++k)
    {
      const std::int64_t a = mesh.Connectivity[k];
      const std::int64_t b =
        mesh.Connectivity[k + 1 == mesh.Offsets[c + 1] ? mesh.Offsets[c] : k + 1];
      ++edges[{ std::min(a, b), std::max(a, b) }];
    }
  }
  int open = 0;
  for (const auto& [edge, uses] : edges)
  {
    const auto a = mesh.Points.row(edge[0]);
    const auto b = mesh.Points.row(edge[1]);
    const auto on = [&](int d, double x)
    { return std::fabs(a(d) - x) < 1e-9 && std::fabs(b(d) - x) < 1e-9; };
    const bool onRim = on(0, 0.0) || on(0, 3.0) || on(1, 0.0) || on(1, 2.0);
    open += uses != 2 && !(uses == 1 && onRim);
  }
  return open;
}
}

TEST(LRGeometry, TessellationHasNoGaps_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Spline<2> surface = WavySurface(seed, false);
    TessellationParams params;
    params.Tolerance = 0.002;
    const auto mesh = Tessellate<2>({ MakeBezierForm(surface) }, params);
    ASSERT_TRUE(mesh) << mesh.Status.Message();
    EXPECT_LE(mesh->Bound, params.Tolerance);
    EXPECT_EQ(InteriorOpenEdges(mesh.Value), 0);
    for (Eigen::Index i = 0; i < mesh->Points.rows(); i += 7)
    {
      const auto& box = surface.Space->Elements[mesh->PointElement[i]].Box;
      double u[2];
      for (int d = 0; d < 2; ++d)
      {
        u[d] = box.Lower[d] + mesh->PointLocal(i, d) * (box.Upper[d] - box.Lower[d]);
      }
      const auto x = LREvaluate(surface, u[0], u[1]);
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_NEAR(mesh->Points(i, c), x[c], 1e-13);
      }
    }
  }
}

TEST(LRGeometry, ClosestPointsOfPointsOnTheSurface_ExactOracle)
{
  const Spline<2> surface = WavySurface(5, true);
  Random random(3);
  const PointMatrix parameters = RandomParameters(random, *surface.Space, 40);
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(surface), parameters, {}, batch));
  const auto search = ClosestPointSearch<2>::Create({ MakeBezierForm(surface) });
  ASSERT_TRUE(search) << search.Status.Message();
  ClosestPoints found;
  ASSERT_TRUE(search.Value.Find(batch.Values, found));
  EXPECT_LE(found.Distances.maxCoeff(), 1e-12);
}

TEST(LRGeometry, ControlPointsComeBackFromBezierPoints_ExactOracle)
{
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Spline<2> surface = WavySurface(seed, seed % 2 == 0);
    const auto recovered = RecoverSpline(MakeBezierForm(surface), 0);
    ASSERT_TRUE(recovered) << recovered.Status.Message();
    EXPECT_LE(recovered.Residual, 1e-12);
    const double difference =
      (recovered.Value.ControlPoints - surface.ControlPoints).cwiseAbs().maxCoeff();
    // the control points of dependent functions are not unique
    EXPECT_EQ(
      difference <= 1e-9, DecideDependence(*surface.Space)->Verdict == LRVerdict::Independent);
  }
}
