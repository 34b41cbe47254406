// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"
#include <knotwork/SplineCore/MeshSpline.h>
#include <knotwork/SplineCore/MeshUntangling.h>
#include <knotwork/SplineCore/UntangledSpline.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <limits>

using namespace knotwork;
using namespace meshes;

namespace
{
/// Points of a grid of cells of whole numbers.
template <int Dim>
PointMatrix GridPoints(const std::array<int, Dim>& n, int columns)
{
  int count = 1;
  for (const int cells : n)
  {
    count *= cells + 1;
  }
  PointMatrix points = PointMatrix::Zero(count, columns);
  for (int i = 0; i < count; ++i)
  {
    for (int d = 0, rest = i; d < Dim; rest /= n[d] + 1, ++d)
    {
      points(i, d) = rest % (n[d] + 1);
    }
  }
  return points;
}

/// Lowest determinant of the multilinear map of a cell at random points, by differences of its
/// values.
template <int Dim>
double LowestDeterminant(
  const CellMesh<Dim>& mesh, const PointMatrix& points, int cell, Random& random)
{
  const auto value = [&](const std::array<double, Dim>& at)
  {
    Eigen::Matrix<double, Dim, 1> sum = Eigen::Matrix<double, Dim, 1>::Zero();
    for (int corner = 0; corner < (1 << Dim); ++corner)
    {
      double weight = 1.0;
      for (int d = 0; d < Dim; ++d)
      {
        weight *= (corner >> d & 1) != 0 ? at[d] : 1.0 - at[d];
      }
      sum += weight * points.row(mesh.Cell(cell)[corner]).template head<Dim>().transpose();
    }
    return sum;
  };
  double lowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 20; ++k)
  {
    std::array<double, Dim> at;
    for (double& t : at)
    {
      t = random.Unit();
    }
    Eigen::Matrix<double, Dim, Dim> jacobian;
    for (int d = 0; d < Dim; ++d)
    {
      std::array<double, Dim> low = at; // linear in each direction: differences are exact
      std::array<double, Dim> high = at;
      low[d] = 0.0;
      high[d] = 1.0;
      jacobian.col(d) = value(high) - value(low);
    }
    lowest = std::min(lowest, jacobian.determinant());
  }
  return lowest;
}

template <int Dim>
Result<UntangledMesh> Untangle(
  const CellMesh<Dim>& mesh, const PointMatrix& points, const UntanglingParams& params = {})
{
  return UntangleMesh<Dim>(mesh, MeshTopology<Dim>::Make(mesh).Value, points, params);
}

/// Points inside of a grid thrown further than cells are wide.
template <int Dim>
void Throw(
  PointMatrix& points, const std::array<int, Dim>& n, int number, double far, Random& random)
{
  for (int k = 0; k < number; ++k)
  {
    int id = 0;
    int stride = 1;
    for (int d = 0; d < Dim; ++d)
    {
      id += stride * random.Int(1, n[d] - 1);
      stride *= n[d] + 1;
    }
    for (int d = 0; d < Dim; ++d)
    {
      points(id, d) += far * random.In(-1.0, 1.0);
    }
  }
}
}

TEST(MeshUntangling, GridsWithThrownPointsAreUntangledAndKeepTheirShape_PropertyOracle)
{
  const std::array<int, 2> n2{ 9, 8 };
  const std::array<int, 3> n3{ 6, 5, 7 };
  const CellMesh<2> mesh2 = Grid<2>(n2);
  const CellMesh<3> mesh3 = Grid<3>(n3);
  Random random(31);
  for (int seed = 0; seed < 20; ++seed)
  {
    PointMatrix points = GridPoints<2>(n2, seed % 2 == 0 ? 2 : 3);
    Throw<2>(points, n2, 4, 2.5, random);
    const auto result = Untangle<2>(mesh2, points);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_TRUE(result->Folded.empty()) << seed;
    EXPECT_EQ(result->Points.cols(), points.cols());
    EXPECT_LE(result->Points.col(0).maxCoeff(), 9.0 + 1e-12);
    EXPECT_GE(result->Points.col(0).minCoeff(), -1e-12);
    for (int c = 0; c < mesh2.NumCells(); ++c)
    {
      EXPECT_GT(LowestDeterminant<2>(mesh2, result->Points, c, random), 0.0) << seed;
    }
    for (int i = 0; i < mesh2.NumPoints; ++i)
    {
      // rims slide along their lines, a rounding of their coordinates away
      const int x = i % 10;
      const int y = i / 10;
      EXPECT_TRUE(x % 9 != 0 || std::abs(result->Points(i, 0) - x) < 1e-12);
      EXPECT_TRUE(y % 8 != 0 || std::abs(result->Points(i, 1) - y) < 1e-12);
    }

    PointMatrix solid = GridPoints<3>(n3, 3);
    Throw<3>(solid, n3, 5, 2.0, random);
    const auto untangled = Untangle<3>(mesh3, solid);
    ASSERT_TRUE(untangled) << untangled.Status.Message();
    EXPECT_FALSE(untangled->FoldedBefore.empty());
    EXPECT_TRUE(untangled->Folded.empty()) << seed;
    for (int c = 0; c < mesh3.NumCells(); ++c)
    {
      EXPECT_GT(LowestDeterminant<3>(mesh3, untangled->Points, c, random), 0.0) << seed;
    }
    for (int i = 0; i < mesh3.NumPoints; ++i)
    {
      const std::array<int, 3> at{ i % 7, i / 7 % 6, i / 42 };
      for (int d = 0; d < 3; ++d)
      {
        EXPECT_TRUE(at[d] % n3[d] != 0 || std::abs(untangled->Points(i, d) - at[d]) < 1e-12);
      }
    }
  }
}

TEST(MeshUntangling, WhatIsNotFoldedStaysToTheLastBit_ExactOracle)
{
  const std::array<int, 2> n{ 20, 20 };
  const CellMesh<2> mesh = Grid<2>(n);
  PointMatrix points = GridPoints<2>(n, 3);
  Random random(3);
  for (int i = 0; i < mesh.NumPoints; ++i)
  {
    points(i, 2) = 0.1 * random.Unit();
  }
  const auto same = Untangle<2>(mesh, points);
  EXPECT_EQ(same->Points, points);
  EXPECT_EQ(same->NumMoved, 0);
  EXPECT_EQ(same->LargestMove, 0.0);
  EXPECT_TRUE(same->FoldedBefore.empty());

  const int thrown = 10 * 21 + 10;
  points(thrown, 0) += 1.6;
  const auto folded = FoldedCells<2>(mesh, points);
  EXPECT_EQ(folded.Value, (std::vector<int>{ 190, 210 })); // beyond the point's right neighbours
  const auto moved = Untangle<2>(mesh, points);
  EXPECT_EQ(moved->FoldedBefore, folded.Value);
  EXPECT_TRUE(moved->Folded.empty());
  EXPECT_GT(moved->NumMoved, 0);
  int stay = 0;
  for (int i = 0; i < mesh.NumPoints; ++i)
  {
    const bool isNear = std::abs(i % 21 - 10) <= 6 && std::abs(i / 21 - 10) <= 6;
    EXPECT_TRUE(isNear || moved->Points.row(i) == points.row(i)) << i;
    stay += moved->Points.row(i) == points.row(i) ? 1 : 0;
  }
  EXPECT_EQ(stay + moved->NumMoved, mesh.NumPoints);
}

// On a sphere the points slide on the quadrilaterals, which are flat within h^2 / 8.
TEST(MeshUntangling, PointsOfSurfacesSlideOnTheSurface_PropertyOracle)
{
  const int n = 12;
  const CellMesh<2> mesh = CubeSphere(n);
  PointMatrix points = CubeSpherePoints(mesh, n);
  Random random(8);
  for (int k = 0; k < 12; ++k)
  {
    auto point = points.row(random.Int(0, mesh.NumPoints - 1));
    for (int d = 0; d < 3; ++d)
    {
      point[d] += 0.3 * random.In(-1.0, 1.0);
    }
    point.normalize();
  }
  UntanglingParams params;
  params.FeatureAngle = 180.0;
  const auto result = Untangle<2>(mesh, points, params);
  ASSERT_TRUE(result);
  EXPECT_GT(result->FoldedBefore.size(), 8U);
  EXPECT_TRUE(result->Folded.empty());
  const Eigen::VectorXd radii = result->Points.rowwise().norm();
  EXPECT_LE(radii.maxCoeff(), 1.0 + 1e-12);
  EXPECT_GE(radii.minCoeff(), 0.93); // chords of the longest edges that folding made
}

TEST(MeshUntangling, SharpEdgesAndCornersOfHexahedraStay_PropertyOracle)
{
  // a bar with an edge that is sharp, and cells at it that are folded
  const std::array<int, 3> n{ 4, 4, 8 };
  const CellMesh<3> mesh = Grid<3>(n);
  PointMatrix points = GridPoints<3>(n, 3);
  const auto id = [](int i, int j, int k) { return i + 5 * (j + 5 * k); };
  points(id(0, 0, 4), 2) += 1.3; // along its edge, past the next point
  points(id(2, 0, 4), 0) += 1.4; // on its side, past the next point
  const auto result = Untangle<3>(mesh, points);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->Folded.empty());
  for (int k = 0; k <= 8; ++k)
  {
    EXPECT_NEAR(result->Points(id(0, 0, k), 0), 0.0, 1e-12);
    EXPECT_NEAR(result->Points(id(0, 0, k), 1), 0.0, 1e-12);
  }
  for (int i = 0; i <= 4; ++i)
  {
    EXPECT_NEAR(result->Points(id(i, 0, 4), 1), 0.0, 1e-12);
  }
  for (const int corner : { id(0, 0, 0), id(4, 0, 0), id(0, 4, 8), id(4, 4, 8) })
  {
    EXPECT_EQ(result->Points.row(corner), points.row(corner));
  }
}

TEST(MeshUntangling, MarkedEdgesOfQuadrilateralsStay_PropertyOracle)
{
  const std::array<int, 2> n{ 8, 8 };
  const CellMesh<2> mesh = Grid<2>(n);
  PointMatrix points = GridPoints<2>(n, 3);
  points(4 + 9 * 4, 1) += 1.4; // on the marked line x = 4, past the next point
  UntanglingParams params;
  for (int row = 0; row < 8; ++row)
  {
    params.Features.push_back({ 4 + 8 * row, 0 });
  }
  for (const bool isMarked : { false, true })
  {
    // beside it, so that the points of the line would move
    points(5 + 9 * 4, 0) -= isMarked ? 0.0 : 0.7;
    const auto result = Untangle<2>(mesh, points, isMarked ? params : UntanglingParams());
    EXPECT_TRUE(result->Folded.empty());
    double off = 0.0;
    for (int row = 0; row <= 8; ++row)
    {
      off = std::max(off, std::abs(result->Points(4 + 9 * row, 0) - 4.0));
    }
    EXPECT_TRUE(isMarked ? off < 1e-12 : off > 1e-3) << off;
  }
}

TEST(MeshUntangling, PoorCellsGetBetterShapes_PropertyOracle)
{
  const std::array<int, 2> n{ 8, 8 };
  const CellMesh<2> mesh = Grid<2>(n);
  PointMatrix points = GridPoints<2>(n, 2);
  points(4 + 9 * 4, 0) += 0.8;
  UntanglingParams params;
  EXPECT_EQ(Untangle<2>(mesh, points, params)->NumMoved, 0);
  params.Poor = { 4 + 8 * 4 };
  const auto better = Untangle<2>(mesh, points, params);
  EXPECT_NEAR(better->Points(4 + 9 * 4, 0), 4.0, 0.05); // the grid is the best there is
}

// Points thrown along a surface: the spline through them turns over, that through the mesh where
// they have slid does not.
TEST(MeshUntangling, SplinesOfUntangledMeshesDoNotTurnOver_PropertyOracle)
{
  const std::array<int, 3> n{ 5, 5, 5 };
  UnstructuredParams spaceParams;
  spaceParams.Degree = 2;
  Random random(77);
  int foldedBefore = 0;
  int foldedAfter = 0;
  for (int seed = 0; seed < 5; ++seed)
  {
    const CellMesh<3> mesh = Grid<3>(n);
    const auto space = MakeUnstructuredSpace<3>(mesh, spaceParams);
    PointMatrix points = GridPoints<3>(n, 4); // a field behind the coordinates
    points.col(3) = Eigen::VectorXd::LinSpaced(points.rows(), 0.0, 1.0);
    Throw<3>(points, n, 3, 1.2, random);
    UntangledSplineParams params;
    params.Threads = 1;
    params.Scope = UntanglingScope::None;
    const auto plain = MakeUntangledSpline<3>(space->Space, points, 3, params);
    EXPECT_EQ(
      plain->Value.ControlPoints, SplineThroughVertices<3>(space->Space, points, 1)->ControlPoints);
    EXPECT_EQ(plain->NumMoved, 0);
    EXPECT_TRUE(plain->FoldedCells.empty());
    Spline<3> geometry = plain->Value;
    geometry.ControlPoints = plain->Value.ControlPoints.leftCols(3);
    foldedBefore += static_cast<int>(FoldedElements<3>(geometry, 1).size());

    params.Scope = UntanglingScope::Elements;
    const auto made = MakeUntangledSpline<3>(space->Space, points, 3, params);
    ASSERT_TRUE(made) << made.Status.Message();
    EXPECT_TRUE(made->StillFolded.empty());
    geometry.ControlPoints = made->Value.ControlPoints.leftCols(3);
    EXPECT_EQ(static_cast<int>(FoldedElements<3>(geometry, 1).size()), made->FoldedElements);
    foldedAfter += made->FoldedElements;
    EXPECT_EQ(made->Vertices.col(3), points.col(3));
    params.Threads = 3;
    EXPECT_EQ(MakeUntangledSpline<3>(space->Space, points, 3, params)->Value.ControlPoints,
      made->Value.ControlPoints);
  }
  EXPECT_GT(foldedBefore, 40);
  EXPECT_EQ(foldedAfter, 0);
}

TEST(MeshUntangling, FoldedElementsAreThoseWhoseMapTurnsOver_ExactOracle)
{
  // on one cell of degree 2 x(u) is u + 4 a u (1 - u): folded for a > 1 / 4
  const CellMesh<2> mesh = Grid<2>({ 3, 3 });
  UnstructuredParams spaceParams;
  spaceParams.Degree = 2;
  const auto space = MakeUnstructuredSpace<2>(mesh, spaceParams);
  for (const int columns : { 2, 3 })
  {
    auto spline = SplineThroughVertices<2>(space->Space, GridPoints<2>({ 3, 3 }, columns));
    EXPECT_TRUE(FoldedElements<2>(spline.Value).empty());
    spline->ControlPoints.col(0) *= -1.0; // all mirrored: none is folded
    EXPECT_TRUE(FoldedElements<2>(spline.Value).empty());
    Eigen::Index corner = 0;
    spline->ControlPoints.rowwise().sum().minCoeff(&corner);
    EXPECT_EQ(spline->ControlPoints.col(0).size(), 25);
    spline->ControlPoints(corner, 0) += 2.0;
    EXPECT_EQ(FoldedElements<2>(spline.Value).size(), 1U);
  }
}

TEST(MeshUntangling, ErrorsNameWhatIsWrong_ExactOracle)
{
  const std::array<int, 2> n{ 3, 3 };
  const CellMesh<2> mesh = Grid<2>(n);
  PointMatrix points = GridPoints<2>(n, 2);
  EXPECT_EQ(Untangle<2>(mesh, points.topRows(3)).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(FoldedCells<2>(mesh, points.topRows(3)).Status.Code, ErrorCode::SizeMismatch);
  UntanglingParams params;
  params.Rings = -1;
  EXPECT_EQ(Untangle<2>(mesh, points, params).Status.Code, ErrorCode::InvalidParameter);
  params = {};
  params.FeatureAngle = 181.0;
  EXPECT_EQ(Untangle<2>(mesh, points, params).Status.Code, ErrorCode::InvalidParameter);
  params = {};
  params.MaxSweeps = 0;
  EXPECT_EQ(Untangle<2>(mesh, points, params).Status.Code, ErrorCode::InvalidParameter);
  params = {};
  params.Poor = { 9 };
  EXPECT_EQ(Untangle<2>(mesh, points, params).Status.Code, ErrorCode::InvalidParameter);
  points(5, 0) += 2.0;
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(Untangle<2>(mesh, points, params).Status.Code, ErrorCode::Aborted);
  points(5, 1) = std::numeric_limits<double>::quiet_NaN();
  const Status status = Untangle<2>(mesh, points).Status;
  EXPECT_EQ(status.Code, ErrorCode::NonFiniteInput);
  EXPECT_NE(status.Detail.find("point 5"), std::string::npos);
}
