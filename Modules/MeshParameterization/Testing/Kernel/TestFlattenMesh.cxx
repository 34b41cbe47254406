// SPDX-License-Identifier: BSD-3-Clause
#include "FlattenReport.h"
#include "InjectiveMap.h"
#include "MeshCases.h"
#include "MeshWeights.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
FlattenParams Method(FlattenMethod method)
{
  FlattenParams params;
  params.Method = method;
  params.Fallback = false;
  return params;
}

MeshParameterization Flatten(const MeshCase& data, const FlattenParams& params)
{
  auto result = FlattenMesh(data.Mesh, params);
  EXPECT_TRUE(result) << result.Status.Message();
  return std::move(result.Value);
}

TEST(FlattenMesh, PlateComesBackByIsometricMethods_ExactOracle)
{
  const MeshCase plate = PlateWithHoles(0.05);
  for (FlattenMethod method : { FlattenMethod::Hlle, FlattenMethod::Lscm, FlattenMethod::Arap })
  {
    const auto map = Flatten(plate, Method(method));
    EXPECT_EQ(map.Used, method);
    EXPECT_EQ(map.Measures.FlippedTriangles, 0);
    // linear functions are in the kernel of each functional: the error is rounding over the gap
    EXPECT_LE(RigidError(map.UV, plate.Flat), 1e-7) << ToString(method);
    EXPECT_LE(map.Measures.IsometryError, 1e-6) << ToString(method);
    EXPECT_NEAR(map.Measures.MeanStretch, 1.0, 1e-6);
    EXPECT_NEAR(map.Measures.MeanAreaDistortion, 1.0, 1e-6);
  }
}

TEST(FlattenMesh, CylinderWithHolesUnrolls_ExactOracle)
{
  const MeshCase roll = CylinderWithHoles(0.04);
  // chords: (0.04)^2 / 24 / 0.25 = 2.7e-4 of lengths across the axis
  for (FlattenMethod method : { FlattenMethod::Hlle, FlattenMethod::Lscm, FlattenMethod::Arap })
  {
    const auto map = Flatten(roll, Method(method));
    EXPECT_EQ(map.Measures.FlippedTriangles, 0);
    EXPECT_LE(RigidError(map.UV, roll.Flat), 5e-4) << ToString(method);
  }
}

TEST(FlattenMesh, SOnConeFoldsByIsomapAndNotByHlle_ExactOracle)
{
  const MeshCase letter = SOnCone(0.06);
  const auto hlle = Flatten(letter, Method(FlattenMethod::Hlle));
  EXPECT_EQ(hlle.Measures.FlippedTriangles, 0);
  EXPECT_LE(RigidError(hlle.UV, letter.Flat), 3e-4);
  const auto isomap = Flatten(letter, Method(FlattenMethod::Isomap));
  EXPECT_GT(RigidError(isomap.UV, letter.Flat), 0.02); // geodesics around the bends are too long
  const auto laplacian = Flatten(letter, Method(FlattenMethod::Laplacian));
  EXPECT_GT(laplacian.Measures.IsometryError, 0.3);
}

TEST(FlattenMesh, AffineNormalizationIsWhatMakesHlleIsometric_PropertyOracle)
{
  const MeshCase plate = PlateWithHoles(0.08);
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  Eigen::Matrix2d shear;
  shear << 2.0, 0.3, -0.4, 0.5;
  PointMatrix uv = plate.Flat * shear;
  NormalizeAffinely(disc.Value, uv);
  EXPECT_LE(RigidError(uv, plate.Flat), 1e-13);
}

TEST(FlattenMesh, IsomapIsRightOnConvexDomains_PropertyOracle)
{
  MeshCase roll = FlatCase(0.0, 2.0, 0.0, 1.0, 0.05, [](double, double) { return true; });
  Lift(roll,
    [](double x, double y)
    { return Eigen::RowVector3d(0.5 * std::cos(2.0 * x), 0.5 * std::sin(2.0 * x), y); });
  FlattenParams params = Method(FlattenMethod::Isomap);
  const auto better = Flatten(roll, params);
  params.Geodesics = GeodesicEstimator::EdgeGraph;
  const auto paper = Flatten(roll, params);
  EXPECT_EQ(better.Measures.FlippedTriangles, 0);
  // ways that the zigzag of the boundary bends are what is left
  EXPECT_LE(RigidError(better.UV, roll.Flat), 2e-3);
  EXPECT_GT(RigidError(paper.UV, roll.Flat), 2.0 * RigidError(better.UV, roll.Flat));
}

TEST(FlattenMesh, LaplacianOfARectangleIsCosines_ExactOracle)
{
  // cos(pi x / 2.5) and cos(2 pi x / 2.5) would come first on longer plates; here cos(pi y) does
  const MeshCase plate = FlatCase(0.0, 1.5, 0.0, 1.0, 0.03, [](double, double) { return true; });
  const auto map = Flatten(plate, Method(FlattenMethod::Laplacian));
  const double pi = std::acos(-1.0);
  const Eigen::ArrayXd x = plate.Flat.col(0).array() * (pi / 1.5);
  const Eigen::ArrayXd y = plate.Flat.col(1).array() * pi;
  const auto correlation = [](const Eigen::VectorXd& a, const Eigen::VectorXd& b)
  {
    const Eigen::VectorXd p = a.array() - a.mean();
    const Eigen::VectorXd q = b.array() - b.mean();
    return std::abs(p.dot(q)) / p.norm() / q.norm();
  };
  EXPECT_GT(correlation(map.UV.col(0), x.cos()), 0.999); // discretization: (pi * 0.03)^2
  EXPECT_GT(correlation(map.UV.col(1), y.cos()), 0.999);
}

TEST(FlattenMesh, GraphWeightsGiveEigenvectorsOfTheGraph_PropertyOracle)
{
  const MeshCase hill = Hill(0.06, 0.3);
  FlattenParams params = Method(FlattenMethod::Laplacian);
  params.Weights = LaplacianWeights::Graph;
  const auto map = Flatten(hill, params);
  const Eigen::SparseMatrix<double> lower = GraphLaplacian(map.Mesh);
  const Eigen::VectorXd degrees = lower.diagonal();
  for (int d = 0; d < 2; ++d)
  {
    Eigen::VectorXd u = map.UV.col(d); // centred: the constant part has to go again
    u.array() -= degrees.dot(u) / degrees.sum();
    const Eigen::VectorXd image = lower.selfadjointView<Eigen::Lower>() * u;
    const Eigen::VectorXd weighted = degrees.cwiseProduct(u);
    const double value = u.dot(image) / u.dot(weighted);
    EXPECT_LE((image - value * weighted).norm(), 1e-6 * value * weighted.norm());
  }
}

TEST(FlattenMesh, HillHasNoFlipsAndBoundedStretch_PropertyOracle)
{
  const MeshCase hill = Hill(0.04, 0.3);
  for (FlattenMethod method : { FlattenMethod::Hlle, FlattenMethod::Lscm, FlattenMethod::Arap })
  {
    const auto map = Flatten(hill, Method(method));
    EXPECT_EQ(map.Measures.FlippedTriangles, 0) << ToString(method);
    EXPECT_GT(map.Measures.MaxStretch, 1.01);
    EXPECT_LT(map.Measures.MeanStretch, 1.3) << ToString(method);
  }
  const double arap = Flatten(hill, Method(FlattenMethod::Arap)).Measures.IsometryError;
  const double lscm = Flatten(hill, Method(FlattenMethod::Lscm)).Measures.IsometryError;
  EXPECT_LT(arap, lscm);
}

/// A deep hat over the square: conformal and rigid maps of it fold.
MeshCase Hat(double height)
{
  MeshCase hat = FlatCase(-1.0, 1.0, -1.0, 1.0, 0.1, [](double, double) { return true; });
  Lift(hat,
    [height](double x, double y)
    { return Eigen::RowVector3d(x, y, height * std::exp(-8.0 * (x * x + y * y))); });
  return hat;
}

TEST(FlattenMesh, BarycentricMapFlipsNothing_PropertyOracle)
{
  for (const MeshCase& data : { Hat(4.0), SOnCone(0.1), PlateWithHoles(0.05) })
  {
    const auto disc = CheckMesh(data.Mesh);
    ASSERT_TRUE(disc);
    const auto map = BarycentricMap(disc.Value);
    ASSERT_TRUE(map) << map.Status.Message();
    EXPECT_EQ(CountFlips(disc.Value, map.Value.UV), 0);
    EXPECT_NEAR(map.Value.UV.rowwise().norm().maxCoeff(), 1.0, 1e-12);
  }
}

TEST(FlattenMesh, InjectiveFlipsNothingAndIsIsometricWherePossible_ExactOracle)
{
  const MeshCase roll = CylinderWithHoles(0.06);
  const auto flat = Flatten(roll, Method(FlattenMethod::Injective));
  EXPECT_EQ(flat.Measures.FlippedTriangles, 0);
  EXPECT_LE(RigidError(flat.UV, roll.Flat), 2e-3); // chords of 0.06, and where iterations end
  const auto hat = Flatten(Hat(4.0), Method(FlattenMethod::Injective));
  EXPECT_EQ(hat.Measures.FlippedTriangles, 0);
  const auto conformal = Flatten(Hat(4.0), Method(FlattenMethod::Lscm));
  EXPECT_LT(hat.Measures.MeanStretch, conformal.Measures.MeanStretch);
}

TEST(FlattenMesh, FallbackOfFoldedHlleFlipsNothing_PropertyOracle)
{
  const MeshCase hat = Hat(4.0);
  ASSERT_GT(Flatten(hat, Method(FlattenMethod::Hlle)).Measures.FlippedTriangles, 0);
  const auto map = Flatten(hat, {});
  EXPECT_EQ(map.Measures.FlippedTriangles, 0);
  EXPECT_NE(map.Used, FlattenMethod::Hlle);
  EXPECT_NE(map.FallbackReason.find("hlle flips"), std::string::npos);
}

TEST(FlattenMesh, MeasuresOfALinearMapAreItsSingularValues_ExactOracle)
{
  const MeshCase plate = PlateWithHoles(0.1);
  const auto disc = CheckMesh(plate.Mesh);
  ASSERT_TRUE(disc);
  PointMatrix uv = plate.Flat;
  uv.col(0) *= 2.0;
  uv.col(1) *= 0.25;
  const FlattenMeasures m = MeasureMap(disc.Value, uv, GeodesicEstimator::Unfolding);
  EXPECT_EQ(m.FlippedTriangles, 0);
  EXPECT_NEAR(m.MeanStretch, 4.0, 1e-10);
  EXPECT_NEAR(m.MaxStretch, 4.0, 1e-10);
  EXPECT_NEAR(m.MinSingularValue, 0.25, 1e-10);
  EXPECT_NEAR(m.MaxSingularValue, 2.0, 1e-10);
  EXPECT_NEAR(m.MeanAreaDistortion, 2.0, 1e-10);
  EXPECT_NEAR(m.IsometryError, std::hypot(1.0, 0.75), 1e-10);
  uv.col(0) *= -1.0;
  EXPECT_EQ(MeasureMap(disc.Value, uv, GeodesicEstimator::Unfolding).FlippedTriangles,
    static_cast<int>(disc->Triangles.size()));
  NormalizeSimilarity(disc.Value, uv);
  EXPECT_EQ(MeasureMap(disc.Value, uv, GeodesicEstimator::Unfolding).FlippedTriangles, 0);
}

TEST(FlattenMesh, LoopsAreOuterFirstAndOriented_PropertyOracle)
{
  const auto map = Flatten(CylinderWithHoles(0.05), {});
  ASSERT_EQ(map.Mesh.Loops.size(), 3u);
  for (std::size_t l = 0; l < 3; ++l)
  {
    const auto& loop = map.Mesh.Loops[l];
    double area = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const int a = loop[i];
      const int b = loop[(i + 1) % loop.size()];
      area += 0.5 * (map.UV(a, 0) * map.UV(b, 1) - map.UV(b, 0) * map.UV(a, 1));
    }
    EXPECT_EQ(area > 0.0, l == 0) << l;
  }
}

TEST(FlattenMesh, FallbackIsAnnounced_PropertyOracle)
{
  MeshCase small; // too few points for eigenvectors
  small.Mesh.Points.resize(4, 3);
  small.Mesh.Points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  small.Mesh.Triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  const auto map = Flatten(small, {});
  EXPECT_EQ(map.Used, FlattenMethod::Arap);
  EXPECT_NE(map.FallbackReason.find("hlle"), std::string::npos);
  EXPECT_LE(map.Measures.IsometryError, 1e-9);
  EXPECT_EQ(
    FlattenMesh(small.Mesh, Method(FlattenMethod::Hlle)).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_TRUE(Flatten(PlateWithHoles(0.08), {}).FallbackReason.empty());
}

TEST(FlattenMesh, EigenvectorsOnASmallPartAreRejected_PropertyOracle)
{
  // linear functions on a plate live on about 5/9 of it, and are the first two eigenvectors
  const MeshCase plate = PlateWithHoles(0.06);
  FlattenParams params = Method(FlattenMethod::Hlle);
  params.MinParticipation = 0.3;
  EXPECT_EQ(Flatten(plate, params).RejectedEigenvectors, 0);
  params.MinParticipation = 0.95;
  const Status status = FlattenMesh(plate.Mesh, params).Status;
  EXPECT_EQ(status.Code, ErrorCode::SingularSystem);
  EXPECT_NE(status.Detail.find("few vertices"), std::string::npos);
  params.Fallback = true;
  const auto map = Flatten(plate, params);
  EXPECT_EQ(map.Used, FlattenMethod::Arap);
  EXPECT_NE(map.FallbackReason.find("few vertices"), std::string::npos);
}

TEST(FlattenMesh, DoesNotDependOnThreads_ExactOracle)
{
  const MeshCase hill = Hill(0.02, 0.3);
  FlattenParams params;
  params.Threads = 1;
  const auto one = Flatten(hill, params);
  params.Threads = 4;
  EXPECT_TRUE(one.UV == Flatten(hill, params).UV);
}

TEST(FlattenMesh, OptionsOutsideTheirRangesAreRefused_ExactOracle)
{
  const MeshCase plate = PlateWithHoles(0.2);
  const auto refused = [&](const auto& change)
  {
    FlattenParams params;
    change(params);
    return FlattenMesh(plate.Mesh, params).Status.Code == ErrorCode::InvalidParameter;
  };
  EXPECT_TRUE(refused([](FlattenParams& p) { p.Neighbours = 5; }));
  EXPECT_TRUE(refused([](FlattenParams& p) { p.Landmarks = 2; }));
  EXPECT_TRUE(refused([](FlattenParams& p) { p.MaxIterations = 0; }));
  EXPECT_TRUE(refused([](FlattenParams& p) { p.MinParticipation = 1.0; }));
}
}
}
