// SPDX-License-Identifier: BSD-3-Clause
// Tetrahedra of a mesher that is a table: a cube of six, whose measures are known.
#include "SurfaceParts.h"
#include "TetrahedronShapes.h"
#include <knotwork/CADFitting/ImplicitTarget.h>
#include <knotwork/SurfaceRemeshing/SolidCheck.h>
#include <knotwork/TetMeshing/SolidMesh.h>

#include <Eigen/LU>

#include <gtest/gtest.h>

#include <limits>
#include <map>

using namespace knotwork;

namespace
{
/// The unit cube, or one moved and scaled, of six tetrahedra around a diagonal.
Tetrahedra KuhnCube()
{
  Tetrahedra cube;
  cube.Points.resize(8, 3);
  for (int i = 0; i < 8; ++i)
  {
    cube.Points.row(i) << i % 2, i / 2 % 2, i / 4;
  }
  const int steps[6][2] = { { 1, 3 }, { 5, 1 }, { 3, 2 }, { 2, 6 }, { 4, 5 }, { 6, 4 } };
  for (const auto& [a, b] : steps)
  {
    std::array<int, 4> cell{ 0, a, b, 7 };
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
    {
      edges.row(k) = cube.Points.row(cell[static_cast<std::size_t>(k + 1)]) - cube.Points.row(0);
    }
    if (edges.determinant() < 0.0)
    {
      std::swap(cell[1], cell[2]);
    }
    cube.Cells.push_back(cell);
  }
  return cube;
}

/// Faces of one tetrahedron, outward.
TriangleMesh SurfaceOf(Tetrahedra& solid)
{
  std::map<std::array<int, 3>, std::vector<std::array<int, 3>>> faces;
  for (const auto& c : solid.Cells)
  {
    for (const auto& face : { std::array<int, 3>{ c[1], c[2], c[3] }, { c[0], c[3], c[2] },
           { c[0], c[1], c[3] }, { c[0], c[2], c[1] } })
    {
      std::array<int, 3> key = face;
      std::sort(key.begin(), key.end());
      faces[key].push_back(face);
    }
  }
  TriangleMesh surface;
  surface.Points = solid.Points;
  for (const auto& [key, found] : faces)
  {
    if (found.size() == 1)
    {
      solid.Sources.push_back(static_cast<int>(surface.Triangles.size()));
      solid.Triangles.push_back(found.front());
      surface.Triangles.push_back(found.front());
    }
  }
  return surface;
}

/// A mesher that hands over what it was made of, whatever order the points come in.
TetrahedraMaker Ready(const Tetrahedra& solid)
{
  return [solid](const TriangleMesh&, const TetrahedraParams&)
  { return Result<Tetrahedra>(solid); };
}

FitTargetPtr Ball(double radius)
{
  ImplicitTargetParams params;
  params.Lower = { -2.0, -2.0, -2.0 };
  params.Upper = { 2.0, 2.0, 2.0 };
  return MakeImplicitTarget(
    [radius](const double* x, double* gradient)
    {
      for (int k = 0; k < 3; ++k)
      {
        gradient[k] = 2.0 * x[k];
      }
      return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - radius * radius;
    },
    params)
    .Value;
}
}

TEST(TetrahedronShapes, RegularTetrahedron)
{
  PointMatrix points(4, 3);
  points << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1;
  const TetrahedronShapes shapes = MeasureTetrahedra(points, { { 0, 1, 2, 3 } });
  EXPECT_NEAR(shapes.MinDihedral, std::acos(1.0 / 3.0) * 180.0 / M_PI, 1e-10);
  EXPECT_NEAR(shapes.MaxDihedral, shapes.MinDihedral, 1e-10);
  EXPECT_NEAR(shapes.WorstRadiusEdgeRatio, std::sqrt(6.0) / 4.0, 1e-12);
  EXPECT_NEAR(std::abs(shapes.Volume), 8.0 / 3.0, 1e-12);
}

// Oracle: parts of known places
TEST(SurfaceParts, DividedTrianglesAreMeasuredBothWays)
{
  PointMatrix surface(4, 3);
  surface << 0, 0, 0, 4, 0, 0, 0, 4, 0, 4, 4, 3;
  const std::vector<MeshTriangle> triangles{ { 0, 1, 2 }, { 2, 1, 3 } };
  PointMatrix points(7, 3);
  points << surface, 2, 2, 0, 1, 1, 0, 2, 0, 0;
  const std::vector<MeshTriangle> parts{ { 0, 6, 5 }, { 6, 1, 5 }, { 5, 1, 4 }, { 5, 4, 2 },
    { 0, 5, 2 }, { 2, 4, 3 }, { 4, 1, 3 } };
  const std::vector<int> sources{ 0, 0, 0, 0, 0, 1, 1 };
  PartsDistance found = MeasureParts(surface, triangles, points, parts, sources, 0.5);
  EXPECT_EQ(found.OfParts, 0.0);
  EXPECT_EQ(found.OfSurface, 0.0);
  EXPECT_TRUE(found.Open.empty());

  points(5, 2) = 0.25; // inside
  found = MeasureParts(surface, triangles, points, parts, sources, 0.5);
  EXPECT_EQ(found.OfParts, 0.25);
  EXPECT_EQ(found.OfSurface, 0.25);

  points(5, 2) = 0.0;
  points(6, 1) = -0.25; // on a side
  found = MeasureParts(surface, triangles, points, parts, sources, 0.5);
  EXPECT_EQ(found.OfParts, 0.25);
  EXPECT_EQ(found.OfSurface, 0.75);

  // a part that is missing, one that is there twice, and all of them twice
  points(6, 1) = 0.0;
  const auto open = [&](const std::vector<MeshTriangle>& some, const std::vector<int>& of)
  { return MeasureParts(surface, triangles, points, some, of, 0.5).Open.size(); };
  EXPECT_EQ(open({ parts.begin() + 1, parts.end() }, { sources.begin() + 1, sources.end() }), 1u);
  std::vector<MeshTriangle> more = parts;
  more.push_back(parts[3]);
  EXPECT_EQ(open(more, { 0, 0, 0, 0, 0, 1, 1, 0 }), 1u);
  more.insert(more.end(), { parts[0], parts[1], parts[2], parts[4] });
  EXPECT_EQ(open(more, { 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0 }), 1u);
}

TEST(SolidMesh, CubeOfSix)
{
  Tetrahedra cube = KuhnCube();
  const TriangleMesh surface = SurfaceOf(cube);
  for (int order = 1; order <= 3; ++order)
  {
    SolidMeshParams params;
    params.Order = order;
    const auto mesh = MeshSolid(surface, nullptr, Ready(cube), params);
    ASSERT_TRUE(mesh) << mesh.Status.Message();
    EXPECT_EQ(mesh->Cells.size(), 6u);
    EXPECT_EQ(static_cast<int>(mesh->Cells.front().size()), NumTetrahedronPoints(order));
    EXPECT_EQ(mesh->NumRegions, 1);
    EXPECT_EQ(mesh->Certificate.Verdict, Verdict::Valid);
    EXPECT_NEAR(mesh->Numbers.Volume, 1.0, 1e-12);
    EXPECT_NEAR(mesh->Numbers.SurfaceVolume, 1.0, 1e-12);
    EXPECT_EQ(mesh->Numbers.DistanceToSurface, 0.0);
    EXPECT_NEAR(mesh->Numbers.MinDihedral, 45.0, 1e-10);
    EXPECT_NEAR(mesh->Numbers.MaxDihedral, 90.0, 1e-10);
    // det J of every cell is 1 whatever the order
    EXPECT_NEAR(mesh->Certificate.MinLower, 1.0, 1e-10);
  }
}

/// On a ball around the cube all corners and edges of the boundary come to lie on it; what is too
/// far stays. The cube's cells become invalid at no order that is certified.
TEST(SolidMesh, CubeBulgesOntoABall)
{
  Tetrahedra cube = KuhnCube();
  cube.Points.array() -= 0.5;
  const TriangleMesh surface = SurfaceOf(cube);
  const FitTargetPtr ball = Ball(std::sqrt(0.75));
  for (int order = 2; order <= 3; ++order)
  {
    SolidMeshParams params;
    params.Order = order;
    const auto mesh = MeshSolid(surface, ball.get(), Ready(cube), params);
    ASSERT_TRUE(mesh) << mesh.Status.Message();
    EXPECT_EQ(mesh->Certificate.Verdict, Verdict::Valid);
    EXPECT_GT(mesh->Numbers.Volume, 1.2);
    EXPECT_LT(mesh->Numbers.Volume, 4.0 / 3.0 * M_PI * std::pow(0.75, 1.5));
    EXPECT_EQ(mesh->Numbers.BoundaryElements, 6);
    // of faces the middle is the farthest
    EXPECT_NEAR(mesh->Numbers.StraightToTarget, std::sqrt(0.75) - 0.5, 1e-9);
  }
}

TEST(SolidMesh, ErrorsNameThePlace)
{
  Tetrahedra cube = KuhnCube();
  const TriangleMesh good = SurfaceOf(cube);
  const auto error = [&](const TriangleMesh& surface)
  { return MeshSolid(surface, nullptr, Ready(cube)).Status; };
  EXPECT_EQ(error({}).Code, ErrorCode::EmptyInput);
  TriangleMesh bad = good;
  bad.Points(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error(bad).Code, ErrorCode::NonFiniteInput);
  bad = good;
  bad.Points(3, 1) = 1e70;
  EXPECT_EQ(error(bad).Code, ErrorCode::NonFiniteInput);
  bad = good;
  bad.Triangles.pop_back();
  EXPECT_NE(error(bad).Detail.find("3 open edges, at ("), std::string::npos) << error(bad).Detail;
  bad = good;
  std::swap(bad.Triangles[2][0], bad.Triangles[2][1]);
  EXPECT_NE(error(bad).Detail.find("3 edges whose two triangles are turned"), std::string::npos);
  bad = good;
  bad.Triangles[0][1] = bad.Triangles[0][0];
  EXPECT_NE(error(bad).Detail.find("without an area"), std::string::npos);
  bad = good;
  bad.Triangles.push_back(bad.Triangles[4]);
  EXPECT_NE(error(bad).Detail.find("twice"), std::string::npos);
  bad = good;
  bad.Triangles[0][1] = 99;
  EXPECT_EQ(error(bad).Code, ErrorCode::InvalidTopology);
  bad = good;
  bad.Points.row(7) << 0.5, 0.4, -0.5; // a corner through the opposite face
  const Status crossed = error(bad);
  EXPECT_NE(crossed.Detail.find("intersect, "), std::string::npos) << crossed.Detail;
  EXPECT_NE(crossed.Detail.find("(triangles "), std::string::npos);
  SolidMeshParams params;
  for (const auto& spoil : std::vector<std::function<void()>>{ [&] { params.Order = 4; },
         [&] { params.Tetrahedra.RadiusEdgeRatio = 0.5; },
         [&] { params.Tetrahedra.MinDihedralAngle = 50.0; },
         [&] { params.Tetrahedra.MaxVolume = -1.0; },
         [&] { params.Tetrahedra.MaxSteinerPoints = -1; } })
  {
    params = {};
    spoil();
    EXPECT_EQ(
      MeshSolid(good, nullptr, Ready(cube), params).Status.Code, ErrorCode::InvalidParameter);
  }
  params = {};
  params.Tetrahedra.RegionSizes = { { { 0.5, 0.5, 0.4 }, 1.0 } };
  EXPECT_TRUE(MeshSolid(good, nullptr, Ready(cube), params));
  params.Tetrahedra.RegionSizes.push_back({ { 1.5, 0.5, 0.4 }, 1.0 });
  const Status outside = MeshSolid(good, nullptr, Ready(cube), params).Status;
  EXPECT_EQ(outside.Code, ErrorCode::InvalidParameter);
  EXPECT_NE(outside.Detail.find("(1.5, 0.5, 0.4)"), std::string::npos) << outside.Detail;
  params.Tetrahedra.RegionSizes = { { { 0.5, 0.5, 0.4 }, 0.0 } };
  EXPECT_EQ(MeshSolid(good, nullptr, Ready(cube), params).Status.Code, ErrorCode::InvalidParameter);
  params = {};
  params.Tetrahedra.Sizes.Points = cube.Points;
  params.Tetrahedra.Sizes.Cells = { { 0, 1, 2, 4 } };
  EXPECT_EQ(MeshSolid(good, nullptr, Ready(cube), params).Status.Code, ErrorCode::SizeMismatch);
  params.Tetrahedra.Sizes.Lengths = { { 1.0, 1.0, -1.0, 1.0 } };
  EXPECT_EQ(MeshSolid(good, nullptr, Ready(cube), params).Status.Code, ErrorCode::InvalidParameter);
  params.Tetrahedra.Sizes.Lengths = { { 1.0, 1.0, 1.0, 1.0 } };
  params.Tetrahedra.Sizes.Cells = { { 0, 1, 2, 400 } };
  EXPECT_EQ(MeshSolid(good, nullptr, Ready(cube), params).Status.Code, ErrorCode::InvalidParameter);
  // a mesher that leaves a cell out, or has none
  Tetrahedra less = cube;
  less.Cells.pop_back();
  EXPECT_EQ(MeshSolid(good, nullptr, Ready(less)).Status.Code, ErrorCode::LibraryError);
  EXPECT_EQ(MeshSolid(good, nullptr, Ready({})).Status.Code, ErrorCode::LibraryError);
  // one that is flat: the corner 6 on the plane of 0, 4, 7
  Tetrahedra flat = cube;
  flat.Points.row(4) = 0.5 * (flat.Points.row(0) + flat.Points.row(6));
  EXPECT_EQ(MeshSolid(good, nullptr, Ready(flat)).Status.Code, ErrorCode::NotConverged);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(MeshSolid(good, nullptr, Ready(cube), params).Status.Code, ErrorCode::Aborted);
}

TEST(SolidMesh, WhatBoundsNoSolidIsRepaired)
{
  Tetrahedra cube = KuhnCube();
  TriangleMesh open = SurfaceOf(cube);
  open.Triangles.pop_back();
  SolidMeshParams params;
  params.Repair = true;
  const auto mesh = MeshSolid(open, nullptr, Ready(cube), params);
  ASSERT_TRUE(mesh) << mesh.Status.Message();
  EXPECT_TRUE(mesh->Numbers.Repaired);
  EXPECT_NEAR(mesh->Numbers.Volume, 1.0, 1e-12);
}
