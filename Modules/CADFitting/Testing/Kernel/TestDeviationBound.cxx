// SPDX-License-Identifier: BSD-3-Clause
// Proved distances between splines and triangles.
#include "FitCases.h"
#include <knotwork/CADFitting/DeviationBound.h>
#include <knotwork/SplineCore/ClosestPoint.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace fits;

namespace
{
TriangleIndex<3> IndexOf(const TriangleMesh& mesh)
{
  return { mesh.Points, mesh.Triangles };
}

/// The spline without a target, through the points of a mesh.
BezierForm<2> Through(const PlacedMesh<2>& mesh, int degree)
{
  CADFitParams params;
  params.Space.Degree = degree;
  params.TargetSamples = 0;
  const auto fit = FitToTarget<2>(mesh.Mesh, mesh.Points, nullptr, params);
  EXPECT_TRUE(fit) << fit.Status.Message();
  return MakeBezierForm(fit->Value, 1);
}

/// A rectangle of n x m cells at a height, its middle in the origin.
PlacedMesh<2> Rectangle(double a, double b, double height, int n, int m)
{
  Placer<2> placer;
  AddBlock<2>(placer, { n, m },
    [&](const double* u)
    { return Eigen::RowVector3d(a * (u[0] - 0.5), b * (u[1] - 0.5), height); });
  return placer.Done();
}

TriangleMesh Halved(const PlacedMesh<2>& quads)
{
  TriangleMesh mesh;
  mesh.Points = quads.Points;
  for (int c = 0; c < quads.Mesh.NumCells(); ++c)
  {
    const int* corners = quads.Mesh.Cell(c);
    mesh.Triangles.push_back({ corners[0], corners[1], corners[3] });
    mesh.Triangles.push_back({ corners[0], corners[3], corners[2] });
  }
  return mesh;
}
}

/// A rectangle over a larger one: h one way, and from the corners the other way. Cuts of the
/// triangles cross those of the elements.
TEST(DeviationBound, RectangleOverALargerOne_ExactOracle)
{
  const BezierForm<2> surface = Through(Rectangle(2.0, 1.0, 0.25, 3, 2), 2);
  const auto mesh = IndexOf(Halved(Rectangle(4.0, 2.0, 0.0, 7, 5)));
  DeviationBoundParams params;
  params.Ratio = 1.0001;
  const auto bound = BoundSurfaceDeviation(surface, mesh, params);
  ASSERT_TRUE(bound) << bound.Status.Message();
  EXPECT_LE(bound->Flatness, 1e-12);
  EXPECT_GE(bound->OfSurface, 0.25);
  EXPECT_LE(bound->OfSurface, 0.25 * 1.0001 + 1e-9);
  const double corner = std::sqrt(1.0 + 0.25 + 0.0625);
  EXPECT_GE(bound->OfMesh, corner);
  EXPECT_LE(bound->OfMesh, 1.0001 * corner + 1e-9);
  ASSERT_EQ(bound->OfElements.size(), 6u);
  ASSERT_EQ(bound->OfTriangles.size(), 70u);
  // each by itself
  for (const double own : bound->OfElements)
  {
    EXPECT_GE(own, 0.25);
    EXPECT_LE(own, 0.25 * 1.0001 + 1e-9);
  }
}

/// A sphere and triangles through it: the sag of the largest triangle, bounded by dense samples
/// from below.
TEST(DeviationBound, HoldsWhatSamplesFind_PropertyOracle)
{
  const PlacedMesh<2> fine = Sphere(8);
  TriangleMesh triangles = Halved(fine);
  // a spike that only triangles have
  Eigen::Index tip = 0;
  (triangles.Points.rowwise() - Eigen::RowVector3d(0.0, 0.0, 1.0)).rowwise().norm().minCoeff(&tip);
  triangles.Points.row(tip) *= 1.2;
  const auto mesh = IndexOf(triangles);
  CADFitParams fitParams;
  fitParams.Space.Degree = 3;
  fitParams.TargetSamples = 0;
  const PlacedMesh<2> coarse = Sphere(5);
  const auto fit = FitToTarget<2>(coarse.Mesh, coarse.Points, Ellipsoid(1.0, 1.0, 1.0), fitParams);
  ASSERT_TRUE(fit) << fit.Status.Message();
  const BezierForm<2> surface = MakeBezierForm(fit->Value, 1);
  DeviationBoundParams params;
  params.Tolerance = 1e-3;
  params.Enough = 1e-3;
  params.Threads = 1;
  const auto bound = BoundSurfaceDeviation(surface, mesh, params);
  ASSERT_TRUE(bound) << bound.Status.Message();
  EXPECT_LE(bound->Flatness, 1e-3);

  const auto rule = MakeElementQuadrature<2>({ 12, 12 });
  double ofSurface = 0.0;
  for (int e = 0; e < surface.Space->NumElements(); ++e)
  {
    EvaluationBatch batch;
    EvaluateElements<2>(surface, std::vector<int>(static_cast<std::size_t>(rule.Local.rows()), e),
      rule.Local, {}, batch);
    double own = 0.0;
    for (Eigen::Index i = 0; i < batch.Values.rows(); ++i)
    {
      const Eigen::RowVector3d x = batch.Values.row(i);
      own = std::max(own, std::sqrt(mesh.Nearest(x.data()).SquaredDistance));
    }
    EXPECT_LE(own, bound->OfElements[static_cast<std::size_t>(e)]) << e;
    EXPECT_LE(bound->OfElements[static_cast<std::size_t>(e)], 1.35 * own + 2e-3) << e;
    ofSurface = std::max(ofSurface, own);
  }
  EXPECT_LE(ofSurface, bound->OfSurface);
  // the spike is as long as it is, and the surface is not near it
  EXPECT_GE(bound->OfMesh, 0.2 - 1e-2);
  EXPECT_LE(bound->OfMesh, 1.1 * 0.2 + 1e-2);
  EXPECT_LT(bound->OfSurface, 0.15);
  const auto search = ClosestPointSearch<2>::Create({ surface });
  ASSERT_TRUE(search);
  for (std::size_t t = 0; t < triangles.Triangles.size(); ++t)
  {
    PointMatrix middle(1, 3);
    const auto& corners = triangles.Triangles[t];
    middle.row(0) = (triangles.Points.row(corners[0]) + triangles.Points.row(corners[1]) +
                      triangles.Points.row(corners[2])) /
      3.0;
    ClosestPoints feet;
    ASSERT_TRUE(search.Value.Find(middle, feet));
    EXPECT_LE(feet.Distances[0], bound->OfTriangles[t]) << t;
  }

  params.Threads = 3;
  const auto other = BoundSurfaceDeviation(surface, mesh, params);
  EXPECT_EQ(other->OfElements, bound->OfElements);
  EXPECT_EQ(other->OfTriangles, bound->OfTriangles);
  // what is enough is not refined
  params.Enough = 1.0;
  const auto rough = BoundSurfaceDeviation(surface, mesh, params);
  EXPECT_GE(rough->OfSurface, bound->OfSurface);
  EXPECT_LE(rough->OfMesh, 1.0 + 1e-3);
}

TEST(DeviationBound, OfAFitToTriangles_PropertyOracle)
{
  const auto target = MakeMeshTarget(Halved(Sphere(9)));
  ASSERT_TRUE(target) << target.Status.Message();
  const PlacedMesh<2> mesh = Sphere(4);
  CADFitParams params;
  params.Space.Degree = 2;
  params.TargetSamples = 500;
  const auto fit = FitToTarget<2>(mesh.Mesh, mesh.Points, target.Value, params);
  ASSERT_TRUE(fit) << fit.Status.Message();
  EXPECT_GE(fit->Bound.OfSurface, fit->Distances.ToTarget.Largest);
  EXPECT_LE(fit->Bound.OfSurface, 1.4 * fit->Distances.ToTarget.Largest);
  EXPECT_GE(fit->Bound.OfMesh, fit->Distances.FromTarget.Largest);
  EXPECT_EQ(fit->Bound.OfElements.size(), fit->Distances.OfElements.size());
  for (std::size_t i = 0; i < fit->Bound.OfElements.size(); ++i)
  {
    EXPECT_GE(fit->Bound.OfElements[i], fit->Distances.OfElements[i]);
  }
  params.BoundedElements = mesh.Mesh.NumCells() - 1;
  EXPECT_EQ(FitToTarget<2>(mesh.Mesh, mesh.Points, target.Value, params)->Bound.OfSurface, -1.0);
  // a sphere that is none of triangles has none
  params.BoundedElements = 1000;
  EXPECT_EQ(
    FitToTarget<2>(mesh.Mesh, mesh.Points, Ellipsoid(1.0, 1.0, 1.0), params)->Bound.OfSurface,
    -1.0);
}

TEST(DeviationBound, Errors)
{
  const BezierForm<2> surface = Through(Rectangle(1.0, 1.0, 0.0, 2, 2), 2);
  const auto mesh = IndexOf(Halved(Rectangle(1.0, 1.0, 0.0, 1, 1)));
  const auto code = [&](const DeviationBoundParams& params)
  { return BoundSurfaceDeviation(surface, mesh, params).Status.Code; };
  EXPECT_EQ(BoundSurfaceDeviation(surface, {}).Status.Code, ErrorCode::EmptyInput);
  DeviationBoundParams params;
  params.Tolerance = 0.0;
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
  params = {};
  params.Ratio = 1.0;
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(code(params), ErrorCode::Aborted);
}
