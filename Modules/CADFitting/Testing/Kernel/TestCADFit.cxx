// SPDX-License-Identifier: BSD-3-Clause
// Fits against shapes whose distances have formulas.
#include "FitCases.h"
#include <knotwork/SplineCore/MeshGeometry.h>

#include <gtest/gtest.h>

#include <functional>

using namespace knotwork;
using namespace fits;

namespace
{
CADFitParams Params(int degree, CreasePolicy policy = CreasePolicy::Full)
{
  CADFitParams params;
  params.Space.Degree = degree;
  params.Space.Policy = policy;
  params.TargetSamples = 0;
  return params;
}

template <int Dim>
CADFit<Dim> Fit(const PlacedMesh<Dim>& mesh, const FitTargetPtr& target, const CADFitParams& params)
{
  auto fit = FitToTarget<Dim>(mesh.Mesh, mesh.Points, target, params);
  EXPECT_TRUE(fit) << fit.Status.Message();
  return std::move(fit.Value);
}

double Rate(double coarse, double fine)
{
  return std::log2(coarse / fine);
}

Spline<2> BoundaryOf(const CADFit<3>& fit)
{
  const auto topology = MeshTopology<3>::Make(fit.Mesh);
  const auto trace = TraceOnFacets(*fit.Value.Space, BoundaryFacets<3>(topology.Value));
  EXPECT_TRUE(trace) << trace.Status.Message();
  return TraceOf<2>(fit.Value, trace.Value);
}
}

/// Equiangular cube-sphere: order p + 1 across extraordinary points. The distance is | |x| - 1 |,
/// by quadrature of its own.
TEST(CADFit, CubeSphereReachesTheOrder)
{
  const FitTargetPtr sphere = Ellipsoid(1.0, 1.0, 1.0);
  const std::map<int, std::array<double, 3>> limits{ { 2, { 2.5e-4, 3.1e-5, 3.8e-6 } },
    { 3, { 6e-5, 2.6e-6, 1.5e-7 } } };
  for (const auto& [degree, most] : limits)
  {
    for (int k = 0; k < 3; ++k)
    {
      const auto fit = Fit<2>(Sphere(4 << k), sphere, Params(degree));
      const double distance = MeanDistance(fit.Value, FromUnitSphere);
      EXPECT_LE(distance, most[static_cast<std::size_t>(k)]) << degree << ' ' << k;
      // the report samples fewer points
      EXPECT_NEAR(fit.Distances.ToTarget.RootMeanSquare, distance, 0.02 * distance);
      EXPECT_EQ(fit.Certificate.Verdict, Verdict::Valid);
      EXPECT_NEAR(fit.Volume, 4.0 * EIGEN_PI / 3.0, 20.0 * distance);
    }
  }
}

TEST(CADFit, EllipsoidAndTorusReachTheOrder)
{
  for (const int degree : { 2, 3 })
  {
    double last = 0.0;
    for (const int n : { 8, 16 })
    {
      PlacedMesh<2> mesh = Sphere(n);
      mesh.Points.col(0) *= 1.3;
      mesh.Points.col(1) *= 0.8;
      const auto fit = Fit<2>(mesh, Ellipsoid(1.3, 0.8, 1.0), Params(degree));
      const double distance = fit.Distances.ToTarget.RootMeanSquare;
      EXPECT_TRUE(n == 8 || Rate(last, distance) >= degree + 0.8) << degree << ' ' << distance;
      last = distance;
    }
    for (const int n : { 8, 16 })
    {
      const auto fit = Fit<2>(Torus(n), TorusTarget(), Params(degree));
      const double distance = MeanDistance(fit.Value,
        [](const Eigen::RowVector3d& x)
        { return std::hypot(std::hypot(x[0], x[1]) - 1.0, x[2]) - 0.4; });
      EXPECT_TRUE(n == 8 || Rate(last, distance) >= degree + 0.8) << degree << ' ' << distance;
      last = distance;
    }
  }
}

/// The rim of a plane mesh goes onto a cylinder, the inside stays in the plane.
TEST(CADFit, RimOfADiscIsACircle)
{
  for (const auto& [n, most] : { std::pair(8, 3e-6), std::pair(16, 2e-7) })
  {
    const auto fit = Fit<2>(Disc(n), Cylinder(), Params(3));
    const auto topology = MeshTopology<2>::Make(fit.Mesh);
    const auto rims = TraceOnFacets(*fit.Value.Space, BoundaryFacets<2>(topology.Value));
    ASSERT_TRUE(rims) << rims.Status.Message();
    ASSERT_EQ(rims->size(), 1u);
    const Spline<1> rim = TraceOf<1>(fit.Value, rims->front());
    PointMatrix local(50, 1);
    double largest = 0.0;
    for (int e = 0; e < rim.Space->NumElements(); ++e)
    {
      local.col(0).setLinSpaced(0.0, 1.0);
      EvaluationBatch batch;
      ASSERT_TRUE(
        EvaluateElements<1>(MakeBezierForm(rim, 1), std::vector<int>(50, e), local, {}, batch));
      largest = std::max(
        largest, (batch.Values.leftCols(2).rowwise().norm().array() - 1.0).abs().maxCoeff());
    }
    EXPECT_LE(largest, most) << n;
    EXPECT_EQ(fit.Certificate.Verdict, Verdict::Valid);
    EXPECT_EQ(fit.Value.ControlPoints.col(2).cwiseAbs().maxCoeff(), 0.0);
    EXPECT_NEAR(fit.Area, EIGEN_PI, 10.0 * most);
  }
}

TEST(CADFit, BallOfSevenBlocks)
{
  const auto fit = Fit<3>(Ball(4), Ellipsoid(1.0, 1.0, 1.0), Params(3));
  EXPECT_LE(MeanDistance(BoundaryOf(fit), FromUnitSphere), 6e-5);
  EXPECT_EQ(fit.Certificate.Verdict, Verdict::Valid);
  EXPECT_NEAR(fit.Volume, 4.0 * EIGEN_PI / 3.0, 1e-3);
  EXPECT_NEAR(fit.Area, 4.0 * EIGEN_PI, 1e-3);
  EXPECT_EQ(fit.LayerCells, 0);
}

/// The surface is that of the plain fit, and the inside nearer to the map of the mesh: mean square
/// distances at Gauss points.
TEST(CADFit, ConstrainedVolumesStayNearerToTheMesh)
{
  const PlacedMesh<3> mesh = Ball(2);
  CADFitParams params = Params(2);
  const auto ball = Ellipsoid(1.0, 1.0, 1.0);
  const auto plain = Fit<3>(mesh, ball, params);
  params.Constrain = true;
  const auto constrained = Fit<3>(mesh, ball, params);
  const auto before = Fit<3>(mesh, nullptr, params);
  EXPECT_EQ(constrained.Certificate.Verdict, Verdict::Valid);
  const PointMatrix change = constrained.Value.ControlPoints - plain.Value.ControlPoints;
  EXPECT_GT(change.cwiseAbs().maxCoeff(), 1e-4);
  const std::vector<int> surface =
    TraceOnFacets(*plain.Value.Space, plain.SurfaceElements)->Functions;
  EXPECT_EQ(change(surface, Eigen::all).cwiseAbs().maxCoeff(), 0.0);
  const auto distance = [&](const CADFit<3>& fit)
  {
    Spline<3> difference = fit.Value;
    difference.ControlPoints -= before.Value.ControlPoints;
    const auto rule = MakeElementQuadrature<3>({ 4, 4, 4 });
    const BezierForm<3> form = MakeBezierForm(difference, 1);
    double sum = 0.0;
    for (int e = 0; e < difference.Space->NumElements(); ++e)
    {
      EvaluationBatch batch;
      EvaluateElements<3>(form, std::vector<int>(rule.Local.rows(), e), rule.Local, {}, batch);
      sum += rule.Weights.dot(batch.Values.rowwise().squaredNorm());
    }
    return std::sqrt(sum);
  };
  EXPECT_LT(distance(constrained), 0.9 * distance(plain));
}

/// Sharp edges stay sharp where points of the mesh have moved away from them.
TEST(CADFit, BoxKeepsItsEdges)
{
  meshes::Random random(7);
  PlacedMesh<3> mesh;
  Placer<3> placer;
  AddBlock<3>(
    placer, { 4, 4, 4 }, [](const double* u) { return Eigen::RowVector3d(u[0], u[1], u[2]); });
  mesh = placer.Done();
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    for (int d = 0; d < 3; ++d)
    {
      mesh.Points(i, d) += random.In(-0.02, 0.02);
    }
  }
  const auto target = MakeMeshTarget(BoxTriangles(8));
  ASSERT_TRUE(target) << target.Status.Message();
  EXPECT_EQ(target.Value->NumFaces(), 6);
  EXPECT_EQ(target.Value->Curves().size(), 12u);
  CADFitParams params = Params(2, CreasePolicy::Automatic);
  params.TargetSamples = 1000;
  for (const bool constrain : { false, true })
  {
    params.Constrain = constrain;
    const auto fit = Fit<3>(mesh, target.Value, params);
    EXPECT_TRUE(fit.UnmatchedFeatures.empty());
    // a box is a polynomial of the space
    EXPECT_LE(fit.Distances.ToTarget.Largest, 1e-9);
    EXPECT_LE(fit.Distances.FromTarget.Largest, 1e-9);
    EXPECT_NEAR(fit.Volume, 1.0, 1e-9);
    EXPECT_EQ(fit.Certificate.Verdict, Verdict::Valid);
    int curves = 0;
    for (const EntityDistance& entity : fit.Distances.Entities)
    {
      curves += entity.Part.Entity == TargetEntity::Curve ? 1 : 0;
      EXPECT_LE(entity.Distance.Largest, 1e-9);
    }
    EXPECT_EQ(curves, 12);
  }
}

namespace
{
/// A place by the share of the way around, and how far across.
using TubeShape = std::function<Eigen::RowVector3d(double around, double across)>;

TriangleMesh TubeTriangles(const TubeShape& shape, int around, int across, double width)
{
  TriangleMesh triangles;
  triangles.Points.resize(around * (across + 1), 3);
  for (int j = 0; j <= across; ++j)
  {
    for (int i = 0; i < around; ++i)
    {
      triangles.Points.row(j * around + i) =
        shape(static_cast<double>(i) / around, width * j / across);
      const int next = (i + 1) % around;
      if (j < across)
      {
        const int a = j * around;
        const int b = a + around;
        triangles.Triangles.push_back({ a + i, b + i, b + next });
        triangles.Triangles.push_back({ a + i, b + next, a + next });
      }
    }
  }
  return triangles;
}

/// @param rows  how far across, and by how many columns turned. @param first  column of point 0.
PlacedMesh<2> TubeQuads(const TubeShape& shape, int columns,
  const std::vector<std::array<double, 2>>& rows, int first = 0)
{
  PlacedMesh<2> mesh;
  mesh.Mesh.NumPoints = columns * static_cast<int>(rows.size());
  mesh.Points.resize(mesh.Mesh.NumPoints, 3);
  for (int j = 0; j < static_cast<int>(rows.size()); ++j)
  {
    const auto& [across, turn] = rows[static_cast<std::size_t>(j)];
    for (int i = 0; i < columns; ++i)
    {
      mesh.Points.row(j * columns + i) = shape((i + first + turn) / columns, across);
      const int next = (i + 1) % columns;
      if (j + 1 < static_cast<int>(rows.size()))
      {
        for (const int corner :
          { j * columns + i, j * columns + next, (j + 1) * columns + i, (j + 1) * columns + next })
        {
          mesh.Mesh.Corners.push_back(corner);
        }
      }
    }
  }
  return mesh;
}

/// 0 to 1 down a cylinder, 1 to 2 out on a plane.
Eigen::RowVector3d Hat(double around, double across)
{
  const double radius = across < 1.0 ? 20.0 : 20.0 + 10.0 * (across - 1.0);
  const double angle = 2.0 * EIGEN_PI * around;
  return { radius * std::cos(angle), radius * std::sin(angle),
    across < 1.0 ? 10.0 * (1.0 - across) : 0.0 };
}

/// A wall around a drop: three quarters of a circle of radius 1, and its tangents to a tip at the
/// beginning; by equal lengths.
Eigen::RowVector3d Drop(double around, double across)
{
  constexpr double Pi = EIGEN_PI;
  const double whole = 2.0 + 1.5 * Pi;
  const double length = whole * (around - std::floor(around));
  const Eigen::RowVector3d tip(std::sqrt(2.0), 0.0, across);
  if (length < 1.0 || length > whole - 1.0)
  {
    const double side = length < 1.0 ? 1.0 : -1.0;
    const double way = length < 1.0 ? length : whole - length;
    return tip + way * std::sqrt(0.5) * Eigen::RowVector3d(-1.0, side, 0.0);
  }
  const double angle = 0.25 * Pi + length - 1.0;
  return { std::cos(angle), std::sin(angle), across };
}
}

/// A circle between a plane and a cylinder has all of its edges, though points beside it lie nearer
/// to places where it is divided than its own.
TEST(CADFit, AClosedEdgeKeepsItsPoints)
{
  const auto target = MakeMeshTarget(TubeTriangles(Hat, 110, 16, 2.0));
  ASSERT_TRUE(target) << target.Status.Message();
  // the row outside of the circle is near, and turned
  const PlacedMesh<2> mesh =
    TubeQuads(Hat, 22, { { 0.0, 0.0 }, { 0.5, 0.0 }, { 1.0, 0.0 }, { 1.14, 0.13 }, { 2.0, 0.26 } });
  CADFitParams params = Params(2, CreasePolicy::Automatic);
  params.BoundedElements = 0;
  const auto fit = Fit<2>(mesh, target.Value, params);
  EXPECT_TRUE(fit.UnmatchedFeatures.empty());
  EXPECT_LE(fit.Distances.ToTarget.Largest, 0.1);
}

/// Edges that begin and end at one corner are met wherever the numbers of the mesh begin, and also
/// by a mesh whose points lie beside the target.
TEST(CADFit, EdgesAroundADropAreMet)
{
  const auto target = MakeMeshTarget(TubeTriangles(Drop, 400, 20, 1.0));
  ASSERT_TRUE(target) << target.Status.Message();
  ASSERT_EQ(target.Value->Curves().size(), 3U); // the tip's line, and both rims
  EXPECT_EQ(target.Value->Vertices().rows(), 2);
  for (const int first : { 0, 7 })
  {
    for (const double beside : { 0.0, 0.02 })
    {
      SCOPED_TRACE(std::to_string(first) + ", " + std::to_string(beside));
      PlacedMesh<2> mesh = TubeQuads(Drop, 24,
        { { 0.0, 0.0 }, { 0.25, 0.0 }, { 0.5, 0.0 }, { 0.75, 0.0 }, { 1.0, 0.0 } }, first);
      mesh.Points.leftCols(2) *= 1.0 + beside;
      CADFitParams params = Params(2, CreasePolicy::Automatic);
      params.BoundedElements = 0;
      const auto fit = Fit<2>(mesh, target.Value, params);
      EXPECT_TRUE(fit.UnmatchedFeatures.empty());
      EXPECT_EQ(fit.Certificate.Verdict, Verdict::Valid);
      // of quadratics of length 0.28, in some of which line and circle meet
      EXPECT_LE(fit.Distances.ToTarget.Largest, 4e-3);
      EXPECT_LE(fit.Distances.FromTarget.Largest, 4e-3);
    }
  }
}

/// Three cubes that touch along an edge and by whole faces, each with points of its own: all of
/// their edges, which coincide in part, are met.
TEST(CADFit, BodiesThatTouchHaveTheirOwnEdges)
{
  TrimmedModel model;
  PlacedMesh<3> mesh;
  int body = 0;
  for (const Eigen::RowVector3d& lower : { Eigen::RowVector3d(0, 0, 0), { 1, 0, 1 }, { 0, 0, 1 } })
  {
    AddSplineBox(model, lower, body++);
    Placer<3> placer;
    AddBlock<3>(placer, { 3, 3, 3 },
      [&](const double* u)
      { return Eigen::RowVector3d(lower + Eigen::RowVector3d(u[0], u[1], u[2])); });
    const PlacedMesh<3> cube = placer.Done();
    for (const int corner : cube.Mesh.Corners)
    {
      mesh.Mesh.Corners.push_back(corner + mesh.Mesh.NumPoints);
    }
    mesh.Points.conservativeResize(mesh.Mesh.NumPoints + cube.Mesh.NumPoints, 3);
    mesh.Points.bottomRows(cube.Mesh.NumPoints) = cube.Points;
    mesh.Mesh.NumPoints += cube.Mesh.NumPoints;
  }
  const auto target = MakeModelTarget(model);
  ASSERT_TRUE(target) << target.Status.Message();
  EXPECT_EQ(target.Value->Curves().size(), 36U);
  EXPECT_EQ(target.Value->Vertices().rows(), 24);
  CADFitParams params = Params(2, CreasePolicy::Automatic);
  params.TargetSamples = 1000;
  const auto fit = Fit<3>(mesh, target.Value, params);
  EXPECT_TRUE(fit.UnmatchedFeatures.empty()) << fit.UnmatchedFeatures.size();
  EXPECT_EQ(fit.Certificate.Verdict, Verdict::Valid);
  EXPECT_LE(fit.Distances.ToTarget.Largest, 1e-9);
  EXPECT_NEAR(fit.Volume, 3.0, 1e-9);
}

/// Rows of very different heights: with equal knot intervals elements fold, with mean ones not.
TEST(CADFit, UnevenRowsGetUnevenKnotIntervals)
{
  const auto target = MakeMeshTarget(TubeTriangles(Drop, 400, 20, 1.0));
  ASSERT_TRUE(target) << target.Status.Message();
  const PlacedMesh<2> mesh =
    TubeQuads(Drop, 24, { { 0.0, 0.0 }, { 0.3, 0.0 }, { 0.31, 0.3 }, { 0.7, 0.0 }, { 1.0, 0.0 } });
  CADFitParams params = Params(2, CreasePolicy::Automatic);
  params.BoundedElements = 0;
  std::array<bool, 3> hasMean{};
  std::array<std::size_t, 3> uncertified{};
  for (const auto lengths : { FitLengths::Uniform, FitLengths::Mean, FitLengths::Automatic })
  {
    params.Lengths = lengths;
    const auto fit = Fit<2>(mesh, target.Value, params);
    const auto at = static_cast<std::size_t>(lengths);
    hasMean[at] = fit.HasMeanLengths;
    uncertified[at] = fit.Uncertified.size();
  }
  EXPECT_EQ(hasMean, (std::array<bool, 3>{ false, true, true }));
  EXPECT_GT(uncertified[0], 0U);
  EXPECT_EQ(uncertified[1], 0U);
  EXPECT_EQ(uncertified[2], 0U);
}

/// What lies behind an edge that no edges of the mesh meet belongs to no other face.
TEST(CADFit, FacesEndAtEdgesThatAreNotMet)
{
  const auto target = MakeMeshTarget(TubeTriangles(Hat, 110, 16, 2.0));
  ASSERT_TRUE(target) << target.Status.Message();
  // seven rows on the cylinder, two that reach across its edge, one on the plane
  std::vector<std::array<double, 2>> rows;
  for (const double across : { 0.0, 0.14, 0.28, 0.42, 0.56, 0.7, 0.84, 1.16, 1.3 })
  {
    rows.push_back({ across, 0.0 });
  }
  CADFitParams params = Params(2, CreasePolicy::Automatic);
  params.BoundedElements = 0;
  const auto fit = Fit<2>(TubeQuads(Hat, 44, rows), target.Value, params);
  EXPECT_FALSE(fit.UnmatchedFeatures.empty());
  // the plane's row stays where it is: at most half of the row that is round there is lost
  const PointMatrix& points = fit.Points;
  for (int i = 0; i < 44; ++i)
  {
    EXPECT_NEAR(points(8 * 44 + i, 2), 0.0, 1e-6);
  }
  EXPECT_LE(fit.Distances.ToTarget.Largest, 1.0);
}

/// A mesh whose cells have two faces on a smooth surface has no valid map there without a layer.
TEST(CADFit, LayerUnderASmoothSurface)
{
  Placer<3> placer;
  AddBlock<3>(placer, { 4, 4, 4 },
    [](const double* u)
    {
      // a cube pressed into the ball: its edges lie inside of the sphere
      const Eigen::RowVector3d x(2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0, 2.0 * u[2] - 1.0);
      const double size = x.cwiseAbs().maxCoeff();
      return Eigen::RowVector3d(size > 0.0 ? x * (size / x.norm()) : x);
    });
  const auto mesh = placer.Done();
  CADFitParams params = Params(2);
  const auto fit = Fit<3>(mesh, Ellipsoid(1.0, 1.0, 1.0), params);
  EXPECT_GT(fit.InvalidBefore, 0);
  EXPECT_EQ(fit.Certificate.Verdict, Verdict::Valid) << fit.Uncertified.size();
  EXPECT_NEAR(fit.Volume, 4.0 * EIGEN_PI / 3.0, 0.02);
}

TEST(CADFit, EqualBitsForAnyNumberOfThreads)
{
  CADFitParams params = Params(2);
  params.TargetSamples = 500;
  params.Threads = 1;
  const auto one = Fit<2>(Sphere(6), Ellipsoid(1.1, 1.0, 0.9), params);
  params.Threads = 3;
  const auto three = Fit<2>(Sphere(6), Ellipsoid(1.1, 1.0, 0.9), params);
  EXPECT_EQ(one.Value.ControlPoints, three.Value.ControlPoints);
  EXPECT_EQ(one.Distances.ToTarget.RootMeanSquare, three.Distances.ToTarget.RootMeanSquare);
  EXPECT_EQ(one.Distances.FromTarget.Largest, three.Distances.FromTarget.Largest);
}

TEST(CADFit, WithoutATargetTheMeshIsTheTarget)
{
  const auto fit = Fit<2>(Sphere(8), nullptr, Params(3));
  EXPECT_LE(MeanDistance(fit.Value, FromUnitSphere), 1e-4);
  EXPECT_GT(fit.Distances.ToTarget.RootMeanSquare, 1e-3); // from its flat triangles
}

/// Largest deviation of a radius from the one that is meant on some facets.
double FarFromRadius(const Spline<2>& surface, const std::vector<int>& elements, double radius)
{
  const auto rule = MakeElementQuadrature<2>({ 4, 4 });
  const BezierForm<2> form = MakeBezierForm(surface, 1);
  double largest = 0.0;
  for (const int e : elements)
  {
    EvaluationBatch batch;
    EvaluateElements<2>(form, std::vector<int>(rule.Local.rows(), e), rule.Local, {}, batch);
    largest = std::max(largest, (batch.Values.rowwise().norm().array() - radius).abs().maxCoeff());
  }
  return largest;
}

/// Quadrilaterals of a face of the cube on a larger sphere, the others where the mesh has them.
TEST(CADFit, ChosenQuadrilateralsAloneAreFitted)
{
  const PlacedMesh<2> mesh = Sphere(8);
  const auto target = Ellipsoid(1.05, 1.05, 1.05);
  CADFitParams params = Params(2);
  params.FittedCells.assign(6 * 64, 0);
  std::vector<int> chosen;
  std::vector<int> away; // farther from these than any function reaches
  for (int c = 0; c < mesh.Mesh.NumCells(); ++c)
  {
    double highest = -1.0;
    double lowest = 1.0;
    for (int k = 0; k < 4; ++k)
    {
      const double z = mesh.Points(mesh.Mesh.Cell(c)[k], 2);
      highest = std::max(highest, z);
      lowest = std::min(lowest, z);
    }
    if (lowest > 0.3)
    {
      params.FittedCells[static_cast<std::size_t>(c)] = 1;
      chosen.push_back(c);
    }
    else if (highest < -0.5)
    {
      away.push_back(c);
    }
  }
  for (const bool constrain : { false, true })
  {
    params.Constrain = constrain;
    const auto fit = Fit<2>(mesh, target, params);
    EXPECT_LT(FarFromRadius(fit.Value, chosen, 1.05), 5e-4);
    EXPECT_LT(FarFromRadius(fit.Value, away, 1.0), 5e-4);
    EXPECT_LT(fit.Distances.ToTarget.Largest, 5e-4);  // of the chosen ones
    EXPECT_LT(fit.Distances.FromTarget.Largest, 0.0); // not measured
    EXPECT_EQ(fit.Certificate.Verdict, Verdict::Valid);
    EXPECT_GT(fit.Volume, 4.0 / 3.0 * EIGEN_PI); // of the whole
    EXPECT_LT(fit.Volume, 1.1 * 4.0 / 3.0 * EIGEN_PI);
    const auto own = Fit<2>(mesh, nullptr, params);
    for (const int e : away)
    {
      for (const int f : fit.Value.Space->AliveFunctions(e))
      {
        EXPECT_LT((fit.Value.ControlPoints.row(f) - own.Value.ControlPoints.row(f)).norm(), 1e-12);
      }
    }
  }
}

/// One block of a ball on a larger sphere; a part of it needs creases.
TEST(CADFit, ChosenHexahedraAloneAreFitted)
{
  const PlacedMesh<3> mesh = Ball(4);
  const auto target = Ellipsoid(1.03, 1.03, 1.03);
  CADFitParams params = Params(3);
  // cells of a block from a row of its second direction on
  const auto choose = [&](int block, int row)
  {
    params.FittedCells.assign(7 * 64, 0);
    for (int c = 0; c < 64; ++c)
    {
      params.FittedCells[static_cast<std::size_t>(64 * block + c)] = c / 4 % 4 >= row ? 1 : 0;
    }
  };
  const auto check = [&](const CADFit<3>& fit)
  {
    EXPECT_EQ(fit.Certificate.Verdict, Verdict::Valid);
    EXPECT_LT(fit.Distances.ToTarget.Largest, 1e-3);
    const auto facets = BoundaryFacets<3>(MeshTopology<3>::Make(mesh.Mesh).Value);
    const auto trace = TraceOnFacets(*fit.Value.Space, facets);
    std::vector<int> chosen;
    std::vector<int> others;
    for (std::size_t i = 0; i < facets.size(); ++i)
    {
      const auto cell = static_cast<std::size_t>(facets[i].Cell);
      if (params.FittedCells[cell] != 0)
      {
        chosen.push_back(static_cast<int>(i));
      }
      else if (facets[i].Cell / 64 == 5) // opposite
      {
        others.push_back(static_cast<int>(i));
      }
    }
    const Spline<2> surface = TraceOf<2>(fit.Value, trace.Value);
    EXPECT_LT(FarFromRadius(surface, chosen, 1.03), 1e-3);
    EXPECT_LT(FarFromRadius(surface, others, 1.0), 5e-3); // as near as the mesh itself
  };
  choose(6, 0);
  check(Fit<3>(mesh, target, params));
  choose(6, 2);
  const auto refused = FitToTarget<3>(mesh.Mesh, mesh.Points, target, params);
  EXPECT_EQ(refused.Status.Code, ErrorCode::NotInSpace);
  EXPECT_NE(refused.Status.Detail.find("mark those as features"), std::string::npos);
  const auto topology = MeshTopology<3>::Make(mesh.Mesh);
  const std::vector<double> labels(params.FittedCells.begin(), params.FittedCells.end());
  params.Space.Features = FacetsBetween<3>(topology.Value, labels).Value;
  check(Fit<3>(mesh, target, params));
  // none on the surface
  choose(0, 0);
  EXPECT_EQ(FitToTarget<3>(mesh.Mesh, mesh.Points, target, params).Status.Code,
    ErrorCode::InvalidParameter);
  params.FittedCells.pop_back();
  EXPECT_EQ(
    FitToTarget<3>(mesh.Mesh, mesh.Points, target, params).Status.Code, ErrorCode::SizeMismatch);
}

TEST(CADFit, Errors)
{
  const FitTargetPtr sphere = Ellipsoid(1.0, 1.0, 1.0);
  PlacedMesh<2> mesh = Sphere(3);
  const auto code = [](const auto& result) { return result.Status.Code; };
  EXPECT_EQ(code(FitToTarget<2>({}, PointMatrix(0, 3), sphere)), ErrorCode::EmptyInput);
  EXPECT_EQ(
    code(FitToTarget<2>(mesh.Mesh, mesh.Points.leftCols(2), sphere)), ErrorCode::SizeMismatch);
  PointMatrix broken = mesh.Points;
  broken(5, 1) = std::nan("");
  const auto notFinite = FitToTarget<2>(mesh.Mesh, broken, sphere);
  EXPECT_EQ(code(notFinite), ErrorCode::NonFiniteInput);
  EXPECT_NE(notFinite.Status.Detail.find("point 5"), std::string::npos);
  // the same shape in another unit
  const auto far = FitToTarget<2>(mesh.Mesh, 25.4 * mesh.Points, sphere);
  EXPECT_EQ(code(far), ErrorCode::InvalidParameter);
  EXPECT_NE(far.Status.Detail.find("same unit"), std::string::npos);
  CADFitParams params;
  params.ExtraPoints = 17;
  EXPECT_EQ(
    code(FitToTarget<2>(mesh.Mesh, mesh.Points, sphere, params)), ErrorCode::InvalidParameter);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(code(FitToTarget<2>(mesh.Mesh, mesh.Points, sphere, params)), ErrorCode::Aborted);
  // an open surface and hexahedra
  TriangleMesh open = BoxTriangles(2);
  open.Triangles.pop_back();
  const auto target = MakeMeshTarget(open);
  ASSERT_TRUE(target);
  Placer<3> placer;
  AddBlock<3>(
    placer, { 2, 2, 2 }, [](const double* u) { return Eigen::RowVector3d(u[0], u[1], u[2]); });
  const auto box = placer.Done();
  EXPECT_EQ(code(FitToTarget<3>(box.Mesh, box.Points, target.Value)), ErrorCode::InvalidTopology);
}
