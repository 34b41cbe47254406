// SPDX-License-Identifier: BSD-3-Clause
// The loop of all steps: mesh, surface, loops, certificates, triangles.
#include "ChartCases.h"
#include <knotwork/SurfaceTrimming/TrimSurface.h>

#include <gtest/gtest.h>

#include <limits>

using namespace knotwork;
using knotwork::testing::Saddle;
using knotwork::testing::SquareWithSquareHole;

namespace
{
const double Pi = std::acos(-1.0);

/// Rolled by 2 radians: developable, so UV is isometric.
Eigen::RowVector3d Roll(double u, double v)
{
  return { 0.5 * std::cos(2.0 * u), 0.5 * std::sin(2.0 * u), v };
}

/// Two pages of a book, bent by 120 degrees along v = 1/2.
Eigen::RowVector3d Book(double u, double v)
{
  const double across = v - 0.5;
  const double c = std::cos(Pi / 3.0);
  const double s = std::sin(Pi / 3.0);
  return { u, across * c, std::abs(across) * s };
}

double LargestDistance(const TrimmedMesh& mesh, const knotwork::testing::Place3& place)
{
  double largest = 0.0;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto& uv = mesh.TriangleUV[t][k];
      const Eigen::RowVector3d at = place(uv[0], uv[1]);
      largest = std::max(largest, (mesh.Points.row(mesh.Triangles[t][k]) - at).norm());
    }
  }
  return largest;
}
}

TEST(TrimSurface, ARolledPlateWithAWindow_ExactOracle)
{
  const ChartMesh chart = SquareWithSquareHole(24, Roll);
  TrimParams params;
  params.Tolerance = 2e-3;
  const auto trimmed = TrimSurface({ chart }, params);
  ASSERT_TRUE(trimmed) << trimmed.Status.Message();
  EXPECT_TRUE(trimmed->WithinTolerance);
  EXPECT_EQ(trimmed->Tolerance, 2e-3);
  EXPECT_LE(trimmed->MaxDeviation, 2e-3);
  EXPECT_LE(trimmed->RmsDeviation, trimmed->Deviations[0].MaxFound);
  ASSERT_TRUE(trimmed->Model.Check()) << trimmed->Model.Check().Message();
  ASSERT_EQ(trimmed->Model.Faces.size(), 1u);
  EXPECT_EQ(trimmed->Model.Faces[0].Loops.size(), 2u);
  EXPECT_EQ(trimmed->Loops.NumBoundaryLoops, 2);
  EXPECT_EQ(trimmed->Loops.Verdicts[0], LoopVerdict::SimpleNested);
  EXPECT_EQ(trimmed->Certificates[0].Verdict, Verdict::Valid);
  // The map is an isometry: |S_u x S_v| = 1 but for the deviation's slope.
  EXPECT_GT(trimmed->MinNormal, 0.5);
  EXPECT_LT(trimmed->MinNormal, 1.05);
  // From the triangles of the face to the cylinder: chords of the mesh (half of 1 - cos(1/24)),
  // deviation.
  EXPECT_LE(LargestDistance(trimmed->Mesh, Roll), 2e-3 + 0.5 * (1.0 - std::cos(1.0 / 24.0)));
  EXPECT_LE(trimmed->Mesh.Bound, 0.25 * 2e-3 * (1.0 + 1e-9));
}

TEST(TrimSurface, TheDefaultToleranceIsAThousandthOfTheDiagonal_ExactOracle)
{
  TrimParams params;
  params.Triangulation = false;
  const auto trimmed = TrimSurface({ SquareWithSquareHole(6, Saddle) }, params);
  ASSERT_TRUE(trimmed) << trimmed.Status.Message();
  const ChartMesh chart = SquareWithSquareHole(6, Saddle);
  const Eigen::RowVector3d size =
    chart.Points.colwise().maxCoeff() - chart.Points.colwise().minCoeff();
  EXPECT_DOUBLE_EQ(trimmed->Tolerance, 1e-3 * size.norm());
  EXPECT_TRUE(trimmed->Mesh.Triangles.empty());
}

TEST(TrimSurface, ANetThatIsTooCoarseIsAResultThatSaysSo_PropertyOracle)
{
  const ChartMesh chart = SquareWithSquareHole(12, Book);
  TrimParams params;
  params.Tolerance = 1e-3;
  params.Triangulation = false;
  params.BackMap.Elements = 4;
  const auto coarse = TrimSurface({ chart }, params);
  ASSERT_TRUE(coarse) << coarse.Status.Message();
  EXPECT_FALSE(coarse->WithinTolerance);
  EXPECT_GT(coarse->MaxDeviation, 1e-3);
  EXPECT_GE(coarse->MaxDeviation, coarse->Deviations[0].MaxFound);
  // As many spans as needed follow the sharp edge.
  params.BackMap.Elements = 0;
  const auto fine = TrimSurface({ chart }, params);
  ASSERT_TRUE(fine) << fine.Status.Message();
  EXPECT_TRUE(fine->WithinTolerance);
  EXPECT_EQ(fine->Certificates[0].Verdict, Verdict::Valid);
}

TEST(TrimSurface, EveryMethodGivesAFaceWithItsDeviation_PropertyOracle)
{
  const ChartMesh chart = SquareWithSquareHole(12, Roll);
  for (const auto method : { BackMapMethod::Nurbs, BackMapMethod::Rbf, BackMapMethod::Hybrid,
         BackMapMethod::Penalized, BackMapMethod::ContinuedLines })
  {
    SCOPED_TRACE(ToString(method));
    TrimParams params;
    params.Tolerance = 1e-2;
    params.Triangulation = false;
    params.BackMap.Method = method;
    const auto trimmed = TrimSurface({ chart }, params);
    ASSERT_TRUE(trimmed) << trimmed.Status.Message();
    EXPECT_TRUE(trimmed->WithinTolerance);
    EXPECT_EQ(trimmed->Certificates[0].Verdict, Verdict::Valid);
    EXPECT_TRUE(trimmed->Model.Check());
  }
}

TEST(TrimSurface, ThreadsDoNotChangeTheModel_ExactOracle)
{
  const ChartMesh chart = SquareWithSquareHole(12, Roll);
  TrimParams params;
  params.Threads = 1;
  const auto one = TrimSurface({ chart }, params);
  params.Threads = 3;
  const auto three = TrimSurface({ chart }, params);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->Model.Faces[0].Surface.ControlPoints, three->Model.Faces[0].Surface.ControlPoints);
  EXPECT_EQ(one->Mesh.Points, three->Mesh.Points);
  EXPECT_EQ(one->Mesh.Triangles, three->Mesh.Triangles);
  EXPECT_EQ(one->MaxDeviation, three->MaxDeviation);
}

TEST(TrimSurface, ErrorsNameTheirPlace)
{
  const ChartMesh chart = SquareWithSquareHole(6, Roll);
  EXPECT_EQ(TrimSurface({}, {}).Status.Code, ErrorCode::EmptyInput);

  TrimParams params;
  params.Tolerance = -1.0;
  EXPECT_EQ(TrimSurface({ chart }, params).Status.Code, ErrorCode::InvalidParameter);
  params.Tolerance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(TrimSurface({ chart }, params).Status.Code, ErrorCode::InvalidParameter);
  params.Tolerance = 0.0;
  params.ChordalTolerance = std::numeric_limits<double>::infinity();
  EXPECT_EQ(TrimSurface({ chart }, params).Status.Code, ErrorCode::InvalidParameter);

  ChartMesh flipped = chart;
  std::swap(flipped.Triangles[4][0], flipped.Triangles[4][1]);
  const auto refused = TrimSurface({ chart, flipped }, {});
  EXPECT_EQ(refused.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(refused.Status.Detail.find("chart 1"), std::string::npos);
  EXPECT_NE(refused.Status.Detail.find("4"), std::string::npos);

  ChartMesh corner = chart;
  corner.Triangles[0][2] = 1000;
  EXPECT_EQ(TrimSurface({ corner }, {}).Status.Code, ErrorCode::InvalidTopology);
  ChartMesh nan = chart;
  nan.Points(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(TrimSurface({ nan }, {}).Status.Code, ErrorCode::NonFiniteInput);
  nan = chart;
  nan.UV(3, 1) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(TrimSurface({ nan }, {}).Status.Code, ErrorCode::NonFiniteInput);
  ChartMesh rows = chart;
  rows.PointIds.pop_back();
  EXPECT_EQ(TrimSurface({ rows }, {}).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(TrimSurface({ ChartMesh{} }, {}).Status.Code, ErrorCode::EmptyInput);
}

/// Four triangles around a point whose corners are taken crosswise, as a damaged file has them:
/// sharp folds that no smooth face has within a thousandth, and that more smoothing does not help.
TEST(TrimSurface, EffortEndsWhatCannotBeReached_PropertyOracle)
{
  ChartMesh chart;
  chart.Points.resize(5, 3);
  chart.Points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0.5, 0.5, 0.1;
  chart.UV.resize(5, 2);
  chart.UV << -1, -1, 1, -1, 1, 1, -1, 1, 0, 0;
  chart.Triangles = { { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } };
  TrimParams params;
  params.Triangulation = false;
  params.Tolerance = 1e-5;
  params.Effort = 0.5;
  const auto trimmed = TrimSurface({ chart }, params);
  ASSERT_TRUE(trimmed) << trimmed.Status.Message();
  EXPECT_EQ(trimmed->Stop, BackMapStop::Effort);
  EXPECT_EQ(trimmed->StoppedChart, 0);
  EXPECT_LE(trimmed->Work, 1.1 * params.Effort); // and a first net
  // of each control point loops, certificates and a file, about as long as they take
  const double later =
    6e-5 * static_cast<double>(trimmed->Model.Faces[0].Surface.ControlPoints.rows());
  EXPECT_GE(trimmed->Work, trimmed->BackMaps[0].Work + later);
  EXPECT_GE(trimmed->MaxDeviation, trimmed->Deviations[0].MaxFound);
  EXPECT_FALSE(trimmed->WithinTolerance);

  // attempts to prove it regular cost at most two, or as much as the first fit
  params.Tolerance = 5e-3;
  params.Effort = 40.0;
  const auto reached = TrimSurface({ chart }, params);
  ASSERT_TRUE(reached) << reached.Status.Message();
  EXPECT_TRUE(reached->WithinTolerance); // not replaced by a worse one that more smoothing makes
  EXPECT_EQ(reached->Stop, BackMapStop::Finished);
  EXPECT_LE(reached->Work, 4.0);
}

/// Of two charts one is flat: what it leaves the other one has, and more than half of it.
TEST(TrimSurface, ChartsShareTheEffort_PropertyOracle)
{
  const ChartMesh hard = SquareWithSquareHole(12, Book);
  ChartMesh flat =
    SquareWithSquareHole(3, [](double u, double v) { return Eigen::RowVector3d(u + 5.0, v, 0.0); });
  flat.UV.col(0).array() += 5.0;
  flat.PointIds.clear();
  ChartMesh alone = hard;
  alone.PointIds.clear();
  TrimParams params;
  params.Triangulation = false;
  params.Tolerance = 1e-6;
  params.Effort = 0.5;
  const auto first = TrimSurface({ alone, flat }, params);
  ASSERT_TRUE(first) << first.Status.Message();
  const auto last = TrimSurface({ flat, alone }, params);
  ASSERT_TRUE(last) << last.Status.Message();
  EXPECT_EQ(first->Stop, BackMapStop::Effort);
  EXPECT_EQ(first->StoppedChart, 0);
  EXPECT_EQ(last->StoppedChart, 1);
  // the order does not matter: what is left is given to the one that needs it
  EXPECT_EQ(
    first->Model.Faces[0].Surface.ControlPoints, last->Model.Faces[1].Surface.ControlPoints);
  EXPECT_LE(first->Work, 1.1 * params.Effort);
}

TEST(TrimSurface, CanBeStopped_PropertyOracle)
{
  TrimParams params;
  params.Progress = [](double) { return false; };
  EXPECT_EQ(TrimSurface({ SquareWithSquareHole(6, Roll) }, params).Status.Code, ErrorCode::Aborted);
}
