// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/MeshSpline.h>
#include <knotwork/SplineCore/TangentPlanes.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

using namespace knotwork;
using namespace meshes;

namespace
{
Spline<2> Through(const CellMesh<2>& mesh, const PointMatrix& points, int degree,
  CreasePolicy policy, const std::vector<CellSide>& features = {})
{
  UnstructuredParams params;
  params.Degree = degree;
  params.Policy = policy;
  params.Features = features;
  const auto made = MakeUnstructuredSpace<2>(mesh, params);
  EXPECT_TRUE(made) << made.Status.Message();
  return SplineThroughVertices<2>(made->Space, points, 1).Value;
}

/// Largest angle in degrees between normals of the cells around extraordinary points, up to sign.
double AngleAtPoints(const Spline<2>& surface)
{
  const CellMesh<2>& mesh = MeshOf(*surface.Space);
  const auto topology = MeshTopology<2>::Make(mesh);
  std::vector<int> elements;
  std::vector<int> points;
  PointMatrix local(4 * mesh.NumCells(), 2);
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int corner = 0; corner < 4; ++corner)
    {
      if (topology->IsExtraordinary(c, corner))
      {
        local.row(static_cast<Eigen::Index>(elements.size())) << corner % 2, corner / 2;
        elements.push_back(c);
        points.push_back(mesh.Cell(c)[corner]);
      }
    }
  }
  EvaluationParams params;
  params.Derivatives = 1;
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateElements<2>(MakeBezierForm(surface, 1), elements,
    local.topRows(static_cast<Eigen::Index>(elements.size())), params, batch));
  std::map<int, Eigen::Vector3d> first;
  double largest = 0.0;
  for (std::size_t i = 0; i < elements.size(); ++i)
  {
    const Eigen::Vector3d u = batch.First.row(static_cast<Eigen::Index>(i)).head<3>();
    const Eigen::Vector3d v =
      batch.First.row(static_cast<Eigen::Index>(i)).segment<3>(surface.NumComponents());
    const Eigen::Vector3d normal = u.cross(v).normalized();
    const Eigen::Vector3d& other = first.emplace(points[i], normal).first->second;
    largest =
      std::max(largest, std::atan2(normal.cross(other).norm(), std::abs(normal.dot(other))));
  }
  return largest * 180.0 / static_cast<double>(EIGEN_PI);
}

/// Root of the mean square of distances from the unit sphere.
double DistanceFromSphere(const Spline<2>& surface)
{
  Random random(3);
  std::vector<int> elements;
  PointMatrix local(3000, 2);
  for (int i = 0; i < local.rows(); ++i)
  {
    elements.push_back(random.Int(0, surface.Space->NumElements() - 1));
    local.row(i) << random.Unit(), random.Unit();
  }
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateElements<2>(MakeBezierForm(surface, 1), elements, local, {}, batch));
  return std::sqrt((batch.Values.rowwise().norm().array() - 1.0).square().mean());
}
}

TEST(TangentPlanes, SpheresKeepTheirAccuracy_PublishedOracle)
{
  for (const int p : { 2, 3, 4 })
  {
    for (const int n : { 8, 16 })
    {
      SCOPED_TRACE("degree " + std::to_string(p) + ", n " + std::to_string(n));
      const CellMesh<2> mesh = CubeSphere(n);
      const Spline<2> before = Through(mesh, CubeSpherePoints(mesh, n), p, CreasePolicy::Full);
      const auto made = MakeTangentPlanes(before, {}, CubeSpherePoints(mesh, n));
      ASSERT_TRUE(made) << made.Status.Message();
      EXPECT_EQ(made->NumVertices, 8);
      EXPECT_EQ(made->NumLeftOut, 0);
      EXPECT_GT(made->LargestMove, 0.0);
      EXPECT_GT(AngleAtPoints(before), 1e-4);
      EXPECT_LE(AngleAtPoints(made->Value), 1e-6);
      EXPECT_LE(LargestCreaseAngle(made->Value), 1.05 * LargestCreaseAngle(before));
      EXPECT_LE(DistanceFromSphere(made->Value), 1.05 * DistanceFromSphere(before));
    }
  }
}

namespace
{
/// Points of a star of n by n cells in every sector: `mesh` is Star(valence, n). Columns: a bent
/// sheet with a little noise, and one more.
PointMatrix StarPoints(const CellMesh<2>& mesh, int valence, int n, Random& random)
{
  PointMatrix points(mesh.NumPoints, 4);
  const double bend = random.In(-0.3, 0.3) / n;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    const int sector = c / (n * n);
    for (int corner = 0; corner < 4; ++corner)
    {
      const double i = c % n + (corner & 1);
      const double j = c / n % n + (corner >> 1);
      const auto angle = [valence](int s)
      { return 2.0 * s * static_cast<double>(EIGEN_PI) / valence; };
      const double x = i * std::cos(angle(sector)) + j * std::cos(angle(sector + 1));
      const double y = i * std::sin(angle(sector)) + j * std::sin(angle(sector + 1));
      points.row(mesh.Cell(c)[corner]) << x, y, bend * (x * x - y * y + x * y), x - y;
    }
  }
  for (Eigen::Index k = 0; k < points.rows(); ++k)
  {
    points(k, 2) += random.In(-0.05, 0.05);
  }
  return points;
}

void ExpectPlanes(const Spline<2>& before, const PointMatrix& points)
{
  const int numExtraordinary =
    static_cast<int>(MeshTopology<2>::Make(MeshOf(*before.Space))->NumExtraordinaryRidges);
  const auto made = MakeTangentPlanes(before, {}, points);
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_EQ(made->NumVertices, numExtraordinary);
  EXPECT_EQ(made->NumLeftOut, 0);
  EXPECT_GT(AngleAtPoints(before), 1e-3);
  EXPECT_LE(AngleAtPoints(made->Value), 1e-6);
  EXPECT_EQ(made->Value.ControlPoints.rightCols(points.cols() - 3),
    before.ControlPoints.rightCols(points.cols() - 3));
  EXPECT_LE(made->LargestMove, 0.5);
  // once more nothing moves, but for what degree 2 gains first
  const auto again = MakeTangentPlanes(made->Value);
  EXPECT_LE(again->LargestMove, 1e-8);
}
}

TEST(TangentPlanes, RandomSheetsHaveThemEverywhere_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto policy = static_cast<CreasePolicy>(1 + seed % 3);
    const int degree = random.Int(2, 4);
    const int valence = 3 + 2 * random.Int(0, 2);
    const int n = random.Int(1, 4);
    const CellMesh<2> star = Star(valence, n);
    const PointMatrix places = StarPoints(star, valence, n, random);
    ExpectPlanes(Through(star, places, degree, policy), places);
    const int side = random.Int(1, 3); // of one cell neighbours have control points in common
    const CellMesh<2> cube = CubeSphere(side);
    PointMatrix points = CubeSpherePoints(cube, side);
    for (double& x : points.reshaped())
    {
      x += random.In(-0.02, 0.02);
    }
    ExpectPlanes(Through(cube, points, degree, policy), points);
  }
}

TEST(TangentPlanes, FoldedCornersAreLeftOut_ExactOracle)
{
  // of six edges at a point one is bent back over its neighbour
  const CellMesh<2> star = Star(6, 2);
  Random random(1);
  PointMatrix points = StarPoints(star, 6, 2, random);
  for (const int c : { 0, 2 }) // along the second edge
  {
    for (const int corner : { 0, 2 })
    {
      const double length = points.row(star.Cell(c)[corner]).head<2>().norm();
      points.row(star.Cell(c)[corner]).head<2>() << 0.8 * length, -0.3 * length;
    }
  }
  const auto made = MakeTangentPlanes(Through(star, points, 3, CreasePolicy::Full));
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_EQ(made->NumVertices, 0);
  EXPECT_EQ(made->NumLeftOut, 1);
  EXPECT_EQ(made->LargestMove, 0.0);
}

TEST(TangentPlanes, PointsOnFeaturesStay_ExactOracle)
{
  const int n = 6;
  const CellMesh<2> mesh = CubeSphere(n);
  const PointMatrix points = CubeSpherePoints(mesh, n);
  const auto topology = MeshTopology<2>::Make(mesh);
  // the edges of a side of the cube, at four of its corners
  std::vector<CellSide> features;
  for (int c = 0; c < n * n; ++c)
  {
    for (int side = 0; side < 4; ++side)
    {
      if (topology->Neighbour(c, side) >= n * n)
      {
        features.push_back({ c, side });
      }
    }
  }
  ASSERT_EQ(features.size(), 4U * n);
  const auto made =
    MakeTangentPlanes(Through(mesh, points, 3, CreasePolicy::Full, features), features);
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_EQ(made->NumVertices, 4);
  EXPECT_EQ(made->NumLeftOut, 4);
  // degree 1 has nothing to move
  EXPECT_EQ(MakeTangentPlanes(Through(mesh, points, 1, CreasePolicy::Full))->NumLeftOut, 8);
}

TEST(TangentPlanes, EveryFailureIsReachable_ExactOracle)
{
  EXPECT_EQ(MakeTangentPlanes({}).Status.Code, ErrorCode::EmptyInput);
  const KnotVector knots = KnotVector::Uniform(2, 3);
  Spline<2> tensor;
  tensor.Space = MakeTensorSpace<2>({ knots, knots }).Value;
  EXPECT_EQ(MakeTangentPlanes(tensor).Status.Code, ErrorCode::DimensionMismatch);
  const CellMesh<2> mesh = CubeSphere(3);
  Spline<2> surface = Through(mesh, CubeSpherePoints(mesh, 3), 2, CreasePolicy::Full);
  Spline<2> plane = surface;
  plane.ControlPoints = PointMatrix(surface.ControlPoints.leftCols(2));
  EXPECT_EQ(MakeTangentPlanes(plane).Status.Code, ErrorCode::SizeMismatch);
  surface.Weights = Eigen::VectorXd::Ones(surface.Space->NumFunctions);
  EXPECT_EQ(MakeTangentPlanes(surface).Status.Code, ErrorCode::SizeMismatch);
  surface.Weights.resize(0);
  EXPECT_EQ(
    MakeTangentPlanes(surface, {}, PointMatrix::Zero(3, 3)).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(
    MakeTangentPlanes(surface, {}, PointMatrix::Constant(mesh.NumPoints, 3, NAN)).Status.Code,
    ErrorCode::NonFiniteInput);
  surface.ControlPoints.conservativeResize(4, 3);
  EXPECT_EQ(MakeTangentPlanes(surface).Status.Code, ErrorCode::SizeMismatch);
}
