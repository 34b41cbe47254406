// SPDX-License-Identifier: BSD-3-Clause
// Stand-ins for the program that makes quadrilaterals: what holds is taken, what does not is
// refused for the right reason.
#include "QuadRemesh.h"

#include "QuadQuality.h"
#include "SoupTopology.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <map>

using namespace knotwork;

namespace
{
/// n x m quadrilaterals of a torus around z, outward, of the radii 2 and 1.
PolygonMesh Torus(int n, int m)
{
  PolygonMesh mesh;
  mesh.Points.resize(n * m, 3);
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < m; ++j)
    {
      const double u = 2 * M_PI * i / n;
      const double v = 2 * M_PI * j / m;
      mesh.Points.row(i * m + j) << (2 + std::cos(v)) * std::cos(u),
        (2 + std::cos(v)) * std::sin(u), std::sin(v);
      const int next = (i + 1) % n;
      mesh.Faces.push_back(
        { i * m + j, next * m + j, next * m + (j + 1) % m, i * m + (j + 1) % m });
    }
  }
  return mesh;
}

/// Six times n x n quadrilaterals of a cube of side 2 about a middle, outward.
PolygonMesh Cube(int n, const Eigen::RowVector3d& middle = { 0, 0, 0 })
{
  PolygonMesh mesh;
  std::map<std::array<int, 3>, int> numbers;
  std::vector<Eigen::RowVector3d> points;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const int end : { 0, n })
    {
      const auto point = [&](int i, int j)
      {
        std::array<int, 3> at{};
        at[static_cast<std::size_t>(axis)] = end;
        at[static_cast<std::size_t>((axis + 1) % 3)] = end > 0 ? i : j;
        at[static_cast<std::size_t>((axis + 2) % 3)] = end > 0 ? j : i;
        const auto [found, added] = numbers.emplace(at, static_cast<int>(points.size()));
        if (added)
        {
          points.push_back(middle + 2.0 / n * Eigen::RowVector3d(at[0], at[1], at[2]) -
            Eigen::RowVector3d(1, 1, 1));
        }
        return found->second;
      };
      for (int i = 0; i < n; ++i)
      {
        for (int j = 0; j < n; ++j)
        {
          mesh.Faces.push_back(
            { point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1) });
        }
      }
    }
  }
  mesh.Points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mesh.Points.row(static_cast<Eigen::Index>(i)) = points[i];
  }
  return mesh;
}

PolygonMesh Together(const PolygonMesh& a, const PolygonMesh& b)
{
  PolygonMesh both;
  both.Points.resize(a.Points.rows() + b.Points.rows(), 3);
  both.Points << a.Points, b.Points;
  both.Faces = a.Faces;
  for (std::vector<int> face : b.Faces)
  {
    for (int& corner : face)
    {
      corner += static_cast<int>(a.Points.rows());
    }
    both.Faces.push_back(face);
  }
  return both;
}

TriangleMesh Halved(const PolygonMesh& mesh)
{
  TriangleMesh halved;
  halved.Points = mesh.Points;
  for (const auto& face : mesh.Faces)
  {
    halved.Triangles.push_back({ face[0], face[1], face[2] });
    halved.Triangles.push_back({ face[0], face[2], face[3] });
  }
  return halved;
}

/// What a program gives back that sees the triangles of a mesh scaled: another mesh, scaled alike.
class StandIn
{
public:
  StandIn(PolygonMesh answer, const TriangleMesh& given) : Answer(std::move(answer)), Given(given)
  {
  }
  Result<PolygonMesh> operator()(const TriangleMesh& scaled, const QuadRequest&) const
  {
    const Eigen::RowVector3d extent =
      this->Given.Points.colwise().maxCoeff() - this->Given.Points.colwise().minCoeff();
    const Eigen::RowVector3d middle =
      0.5 * (this->Given.Points.colwise().maxCoeff() + this->Given.Points.colwise().minCoeff());
    const double scale =
      (scaled.Points.colwise().maxCoeff() - scaled.Points.colwise().minCoeff()).norm() /
      extent.norm();
    PolygonMesh made = this->Answer;
    made.Points = (made.Points.rowwise() - middle) * scale;
    return made;
  }

private:
  PolygonMesh Answer;
  TriangleMesh Given;
};

/// The error of an answer to the halves of a torus.
Status Refused(const PolygonMesh& answer)
{
  const TriangleMesh given = Halved(Torus(24, 12));
  QuadRemeshParams params;
  params.KeepSharp = false;
  params.Smoothing = 0;
  params.Way = QuadWay::Program;
  const auto made = RemeshToQuads(given, StandIn(answer, given), params);
  EXPECT_FALSE(made);
  EXPECT_EQ(made.Status.Code, ErrorCode::NotConverged);
  return made.Status;
}

void ExpectRefusal(const PolygonMesh& answer, const std::string& words)
{
  SCOPED_TRACE(words);
  const Status refused = Refused(answer);
  EXPECT_NE(refused.Detail.find("2000 faces: " + words), std::string::npos) << refused.Detail;
}
}

TEST(QuadRemesh, AGoodAnswerIsTakenAsItIs_ExactOracle)
{
  const PolygonMesh torus = Torus(24, 12);
  const TriangleMesh given = Halved(torus);
  QuadRemeshParams params;
  params.Smoothing = 0;
  const auto made = RemeshToQuads(given, StandIn(torus, given), params);
  ASSERT_TRUE(made) << made.Status.Message();
  ASSERT_EQ(made->Quads.size(), torus.Faces.size());
  EXPECT_LE((made->Points - torus.Points).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(made->Parts, 1);
  EXPECT_EQ(made->LooseParts, 0);
  EXPECT_EQ(made->EulerNumber, 0);
  EXPECT_EQ(made->ExtraordinaryPoints, 0);
  ASSERT_EQ(made->Tries.size(), 1U);
  EXPECT_EQ(made->Tries[0].Request.Faces, 2000);
  EXPECT_TRUE(made->Tries[0].Request.KeepSharp);
  EXPECT_TRUE(made->Tries[0].Refusal.empty());
  EXPECT_NEAR(made->Volume, made->InputVolume, 0.02 * made->InputVolume); // another diagonal
  EXPECT_LE(made->DistanceFromInput, 0.01 * made->Diagonal);
  EXPECT_EQ(made->PartIds, std::vector<int>(torus.Faces.size(), 0));
}

TEST(QuadRemesh, ACubeHasEightExtraordinaryPoints_ExactOracle)
{
  const PolygonMesh cube = Cube(4);
  const TriangleMesh given = Halved(cube);
  const auto made = RemeshToQuads(given, StandIn(cube, given));
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_EQ(made->ExtraordinaryPoints, 8);
  EXPECT_EQ(made->EulerNumber, 2);
  EXPECT_NEAR(made->Volume, 8.0, 1e-12);
  EXPECT_NEAR(made->LeastScaledJacobian, 1.0, 1e-12);
  EXPECT_LE(made->DistanceToInput, 2e-3 * made->Diagonal);
}

TEST(QuadRemesh, WhatDoesNotHoldIsRefused_PropertyOracle)
{
  const PolygonMesh torus = Torus(24, 12);
  PolygonMesh bad = torus;
  bad.Faces.clear();
  ExpectRefusal(bad, "no faces came back");
  for (const auto& triangle : Halved(torus).Triangles)
  {
    bad.Faces.push_back({ triangle[0], triangle[1], triangle[2] });
  }
  ExpectRefusal(bad, "it was refused: the triangles came back as they are");
  bad = torus;
  bad.Faces[7].pop_back();
  ExpectRefusal(bad, "1 face is no quadrilateral");
  bad = torus;
  bad.Faces[7][2] = 24 * 12;
  ExpectRefusal(bad, "a corner that is no point came back");
  bad = torus;
  bad.Points(5, 1) = std::numeric_limits<double>::quiet_NaN();
  ExpectRefusal(bad, "points that are no finite numbers came back");
  bad = torus;
  bad.Faces.pop_back();
  ExpectRefusal(bad, "4 edges are open");
  bad = torus;
  bad.Points.row(0) = bad.Points.row(1);
  bad.Points.row(12) = bad.Points.row(13);
  ExpectRefusal(bad, "1 quadrilateral has no area");
  bad = torus;
  for (auto& face : bad.Faces)
  {
    std::swap(face[1], face[3]);
  }
  ExpectRefusal(bad, "it is inside out");
  std::swap(bad.Faces[0][1], bad.Faces[0][3]);
  ExpectRefusal(bad, "");
  bad = torus;
  bad.Points *= 1.3;
  ExpectRefusal(bad, "it is 0.");
  ExpectRefusal(Cube(8), "its Euler number is 2 instead of 0");
}

TEST(QuadRemesh, PointsOfTwoFansAreRefused_PropertyOracle)
{
  // points on opposite sides of the tube become one
  PolygonMesh bad = Torus(24, 12);
  for (auto& face : bad.Faces)
  {
    for (int& corner : face)
    {
      corner = corner == 6 ? 0 : corner;
    }
  }
  ExpectRefusal(bad, "");
  EXPECT_EQ(Refused(bad).Detail.find("Euler"), std::string::npos) << Refused(bad).Detail;
}

TEST(QuadRemesh, OtherSizesAreTriedUntilOneHolds_PropertyOracle)
{
  const PolygonMesh torus = Torus(24, 12);
  const TriangleMesh given = Halved(torus);
  const StandIn good(torus, given);
  std::vector<QuadRequest> asked;
  const auto maker = [&](const TriangleMesh& mesh, const QuadRequest& request)
  {
    asked.push_back(request);
    return request.Faces == 700 && !request.KeepSharp
      ? good(mesh, request)
      : Result<PolygonMesh>(ErrorCode::NotConverged, "not now");
  };
  QuadRemeshParams params;
  params.Faces = 1000;
  const auto made = RemeshToQuads(given, maker, params);
  ASSERT_TRUE(made) << made.Status.Message();
  ASSERT_EQ(made->Tries.size(), 6U);
  const int faces[] = { 1000, 1000, 1400, 1400, 700, 700 };
  for (std::size_t i = 0; i < 6; ++i)
  {
    EXPECT_EQ(asked[i].Faces, faces[i]);
    EXPECT_EQ(asked[i].KeepSharp, i % 2 == 0);
    EXPECT_EQ(made->Tries[i].Refusal, i < 5 ? "not now" : "");
  }
}

TEST(QuadRemesh, OneErrorHasTheReasonOfEveryTry)
{
  const TriangleMesh given = Halved(Torus(24, 12));
  QuadRemeshParams params;
  params.Way = QuadWay::Program;
  const auto made = RemeshToQuads(
    given,
    [](const TriangleMesh&, const QuadRequest& request) -> Result<PolygonMesh> {
      return { ErrorCode::NotConverged, "reason " + std::to_string(request.Faces) };
    },
    params);
  EXPECT_EQ(made.Status.Code, ErrorCode::NotConverged);
  for (const char* words : { "none of 6 tries", "2000 faces with sharp edges: reason 2000",
         "2000 faces: reason 2000", "2800 faces: reason 2800", "1400 faces: reason 1400", "Limit" })
  {
    EXPECT_NE(made.Status.Detail.find(words), std::string::npos) << made.Status.Detail;
  }
}

TEST(QuadRemesh, TrianglesAreDividedWhereNoAnswerHolds_ExactOracle)
{
  const PolygonMesh cube = Cube(4);
  const TriangleMesh given = Halved(cube); // 192 triangles, 98 points, 288 edges
  QuadRemeshParams params;
  params.Smoothing = 0;
  const auto made = RemeshToQuads(
    given,
    [](const TriangleMesh&, const QuadRequest&) -> Result<PolygonMesh> {
      return { ErrorCode::NotConverged, "never" };
    },
    params);
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_EQ(made->DividedParts, 1);
  ASSERT_EQ(made->Tries.size(), 7U);
  EXPECT_FALSE(made->Tries[5].OfTriangles);
  EXPECT_TRUE(made->Tries[6].OfTriangles);
  EXPECT_EQ(made->Tries[6].Request.Faces, 3 * 192); // fewer than are wanted: no edge is collapsed
  EXPECT_EQ(made->Quads.size(), 3U * 192U);
  EXPECT_EQ(made->Points.rows(), 98 + 288 + 192);
  EXPECT_EQ(made->EulerNumber, 2);
  EXPECT_NEAR(made->Volume, 8.0, 1e-12);
  for (const auto& quad : made->Quads)
  {
    EXPECT_NEAR(DiagonalProduct(made->Points, quad).norm() / 2, 1.0 / 24, 1e-12); // thirds of 1/8
  }
}

TEST(QuadRemesh, CollapsedTrianglesKeepTopologyAndShape_PropertyOracle)
{
  const TriangleMesh given = Halved(Torus(96, 48)); // 9216 triangles
  QuadRemeshParams params;
  params.Way = QuadWay::Triangles;
  params.Smoothing = 0; // which would cost volume that collapsing keeps
  int calls = 0;
  for (const int faces : { 1500, 6000 })
  {
    params.Faces = faces;
    const auto made = RemeshToQuads(
      given,
      [&](const TriangleMesh&, const QuadRequest&) -> Result<PolygonMesh>
      {
        ++calls;
        return { ErrorCode::LibraryError, "it is missing" };
      },
      params);
    ASSERT_TRUE(made) << made.Status.Message();
    EXPECT_EQ(made->Tries.size(), 1U);
    EXPECT_LE(made->Quads.size(), static_cast<std::size_t>(faces));
    EXPECT_GE(made->Quads.size(), static_cast<std::size_t>(faces - 9));
    EXPECT_EQ(made->EulerNumber, 0);
    EXPECT_GT(made->LeastScaledJacobian, 0.0);
    EXPECT_NEAR(made->Volume, made->InputVolume, 1e-3 * made->InputVolume);
    EXPECT_LE(std::max(made->DistanceFromInput, made->DistanceToInput), 0.02 * made->Diagonal);
  }
  EXPECT_EQ(calls, 0);
}

TEST(QuadRemesh, MoreTrianglesStayUntilTheLimitHolds_PropertyOracle)
{
  const TriangleMesh given = Halved(Torus(48, 24));
  QuadRemeshParams params;
  params.Way = QuadWay::Triangles;
  params.Faces = 60;
  params.Limit = 0.05;
  const auto made = RemeshToQuads(given, StandIn({}, given), params);
  ASSERT_TRUE(made) << made.Status.Message();
  ASSERT_EQ(made->Tries.size(), 3U); // of farthest distances 0.24, 0.073 and 0.042
  EXPECT_EQ(made->Tries[0].Request.Faces, 60);
  EXPECT_EQ(made->Tries[1].Request.Faces, 120);
  EXPECT_FALSE(made->Tries[0].Refusal.empty());
  params.Limit = 1e-6; // below what distances are known to
  const auto refused = RemeshToQuads(given, StandIn({}, given), params);
  EXPECT_EQ(refused.Status.Code, ErrorCode::NotConverged);
  EXPECT_NE(refused.Status.Detail.find("480 faces of triangles: "), std::string::npos)
    << refused.Status.Detail;
}

TEST(QuadRemesh, TwoExhaustedTriesEndThoseOfTheProgram_ExactOracle)
{
  const TriangleMesh given = Halved(Torus(24, 12));
  int calls = 0;
  const auto late = [&](const TriangleMesh&, const QuadRequest&) -> Result<PolygonMesh>
  {
    ++calls;
    return { ErrorCode::TooLarge, "late" };
  };
  QuadRemeshParams params;
  params.Way = QuadWay::Program;
  const auto refused = RemeshToQuads(given, late, params);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(refused.Status.Code, ErrorCode::NotConverged);
  EXPECT_NE(refused.Status.Detail.find("none of 2 tries"), std::string::npos)
    << refused.Status.Detail;
  params.Way = QuadWay::Automatic;
  const auto made = RemeshToQuads(given, late, params);
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_EQ(calls, 4);
  EXPECT_EQ(made->DividedParts, 1);
}

TEST(QuadRemesh, OtherFailuresEndTheSearch)
{
  const TriangleMesh given = Halved(Torus(24, 12));
  for (const ErrorCode code : { ErrorCode::LibraryError, ErrorCode::FileError, ErrorCode::Aborted })
  {
    int calls = 0;
    const auto made = RemeshToQuads(given,
      [&](const TriangleMesh&, const QuadRequest&) -> Result<PolygonMesh>
      {
        ++calls;
        return { code, "it is missing" };
      });
    EXPECT_EQ(calls, 1);
    EXPECT_EQ(made.Status.Code, code);
    EXPECT_EQ(made.Status.Detail, "it is missing");
  }
}

TEST(QuadRemesh, TrianglesAreScaledBeforeTheyAreGiven_PropertyOracle)
{
  for (const double size : { 1e-3, 1.0, 1e4 })
  {
    PolygonMesh torus = Torus(24, 12);
    torus.Points.col(2) *= 1e-3; // edges of 1e-4 beside those of 0.5
    torus.Points *= size;
    torus.Points.rowwise() += Eigen::RowVector3d(5, 6, 7) * size;
    const TriangleMesh given = Halved(torus);
    const StandIn good(torus, given);
    const auto maker = [&](const TriangleMesh& mesh, const QuadRequest& request)
    {
      double shortest = std::numeric_limits<double>::infinity();
      for (const auto& corners : mesh.Triangles)
      {
        for (std::size_t k = 0; k < 3; ++k)
        {
          shortest = std::min(
            shortest, (mesh.Points.row(corners[k]) - mesh.Points.row(corners[(k + 1) % 3])).norm());
        }
      }
      EXPECT_GE(shortest, 2e-3 * (1 - 1e-9));
      EXPECT_LE(mesh.Points.colwise().sum().norm() / mesh.Points.cwiseAbs().maxCoeff(), 1e-6);
      return good(mesh, request);
    };
    const auto made = RemeshToQuads(given, maker);
    ASSERT_TRUE(made) << made.Status.Message();
    EXPECT_LE(made->DistanceFromInput, 0.01 * made->Diagonal);
  }
}

TEST(QuadRemesh, EveryPartIsMadeAlone_PropertyOracle)
{
  const PolygonMesh first = Cube(6);
  const PolygonMesh second = Cube(3, { 5, 0, 0 });
  const TriangleMesh given = Halved(Together(first, second));
  std::vector<int> faces;
  const auto maker = [&](const TriangleMesh& mesh, const QuadRequest& request)
  {
    faces.push_back(request.Faces);
    return mesh.Triangles.size() == 2 * first.Faces.size()
      ? StandIn(first, Halved(first))(mesh, request)
      : StandIn(second, Halved(second))(mesh, request);
  };
  const auto made = RemeshToQuads(given, maker);
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_EQ(made->Parts, 2);
  EXPECT_EQ(made->EulerNumber, 4);
  EXPECT_EQ(faces, std::vector<int>({ 1000, 1000 })); // areas are equal
  EXPECT_EQ(made->PartIds.front(), 0);
  EXPECT_EQ(made->PartIds.back(), 1);
  EXPECT_NEAR(made->Volume, 16.0, 1e-12);
}

TEST(QuadRemesh, SmallPartsGetAHundredFaces_ExactOracle)
{
  PolygonMesh small = Cube(3);
  small.Points = 0.01 * small.Points;
  small.Points.col(0).array() += 5.0;
  std::vector<int> faces;
  const auto maker = [&](const TriangleMesh& mesh, const QuadRequest& request)
  {
    faces.push_back(request.Faces);
    return mesh.Triangles.size() == 2 * small.Faces.size()
      ? StandIn(small, Halved(small))(mesh, request)
      : StandIn(Cube(6), Halved(Cube(6)))(mesh, request);
  };
  const auto made = RemeshToQuads(Halved(Together(Cube(6), small)), maker);
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_EQ(faces, std::vector<int>({ 2000, 100 }));
}

TEST(QuadRemesh, BallsThatAProgramLeavesGo_PropertyOracle)
{
  const PolygonMesh torus = Torus(24, 12);
  PolygonMesh crumb = Cube(1);
  crumb.Points = 0.1 * crumb.Points;
  crumb.Points.col(0).array() += 2.0;
  const TriangleMesh given = Halved(torus);
  const auto made = RemeshToQuads(given, StandIn(Together(crumb, torus), given));
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_EQ(made->LooseParts, 1);
  EXPECT_EQ(made->EulerNumber, 0);
  EXPECT_EQ(made->Quads.size(), torus.Faces.size());
}

TEST(QuadRemesh, SmoothingRaisesTheWorstAndKeepsTheShape_PropertyOracle)
{
  const PolygonMesh torus = Torus(48, 24);
  const TriangleMesh given = Halved(torus);
  PolygonMesh crooked = torus;
  for (Eigen::Index i = 0; i < crooked.Points.rows(); i += 5)
  {
    crooked.Points.row(i) +=
      0.7 * (crooked.Points.row((i + 25) % crooked.Points.rows()) - crooked.Points.row(i));
  }
  QuadRemeshParams params;
  const auto made = RemeshToQuads(given, StandIn(crooked, given), params);
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_LT(made->LeastScaledJacobianBefore, 0.7);
  EXPECT_GT(made->LeastScaledJacobian, made->LeastScaledJacobianBefore + 0.05);
  params.Smoothing = 0;
  const auto still = RemeshToQuads(given, StandIn(crooked, given), params);
  ASSERT_TRUE(still);
  EXPECT_EQ(still->LeastScaledJacobian, made->LeastScaledJacobianBefore);
  EXPECT_LE(std::max(made->DistanceFromInput, made->DistanceToInput),
    std::max(still->DistanceFromInput, still->DistanceToInput) + 2e-3 * made->Diagonal);
}

TEST(QuadRemesh, SmoothingMendsWhatHasNoArea_PropertyOracle)
{
  PolygonMesh flat = Torus(24, 12);
  const TriangleMesh given = Halved(flat);
  flat.Points.row(0) = flat.Points.row(1);
  flat.Points.row(12) = flat.Points.row(13);
  const auto made = RemeshToQuads(given, StandIn(flat, given));
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_EQ(made->LeastScaledJacobianBefore, -1.0);
  EXPECT_GT(made->LeastScaledJacobian, 0.1);
}

TEST(QuadRemesh, SharpEdgesOfTheResultStay_ExactOracle)
{
  PolygonMesh cube = Cube(6);
  const TriangleMesh given = Halved(cube);
  for (Eigen::Index i = 0; i < cube.Points.rows(); ++i) // points inside of the sides go aside
  {
    if ((cube.Points.row(i).cwiseAbs().array() > 1.0 - 1e-9).count() == 1)
    {
      cube.Points(i, cube.Points(i, 0) * cube.Points(i, 0) < 0.99 ? 0 : 1) += 0.1 * (i % 3);
    }
  }
  const auto made = RemeshToQuads(given, StandIn(cube, given));
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_GT(made->LeastScaledJacobian, made->LeastScaledJacobianBefore);
  EXPECT_NEAR(made->Volume, 8.0, 1e-12); // edges and sides are where they were
}

TEST(QuadRemesh, InputThatIsNotClosedIsRefused)
{
  const StandIn none({}, Halved(Cube(2)));
  EXPECT_EQ(RemeshToQuads({}, none).Status.Code, ErrorCode::EmptyInput);
  TriangleMesh open = Halved(Cube(2));
  open.Triangles.pop_back();
  const Status refused = RemeshToQuads(open, none).Status;
  EXPECT_EQ(refused.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(refused.Detail.find("1 hole"), std::string::npos) << refused.Detail;
  EXPECT_NE(refused.Detail.find("repair"), std::string::npos) << refused.Detail;
  TriangleMesh bad = Halved(Cube(2));
  bad.Points(3, 0) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(RemeshToQuads(bad, none).Status.Code, ErrorCode::NonFiniteInput);
  bad = Halved(Cube(2));
  bad.Triangles.push_back(bad.Triangles.front());
  EXPECT_EQ(RemeshToQuads(bad, none).Status.Code, ErrorCode::InvalidTopology);
}

TEST(QuadRemesh, OptionsOutOfRangeAreRefused)
{
  const TriangleMesh given = Halved(Cube(2));
  const StandIn good(Cube(2), given);
  const auto code = [&](const QuadRemeshParams& params)
  { return RemeshToQuads(given, good, params).Status.Code; };
  QuadRemeshParams params;
  params.Faces = 7;
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
  params.Faces = 1000001;
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
  params = {};
  params.Limit = 0.0;
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
  params.Limit = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
  params = {};
  params.Smoothing = -1;
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
}

TEST(QuadRemesh, AbortEndsIt)
{
  const TriangleMesh given = Halved(Cube(2));
  QuadRemeshParams params;
  params.Progress = [](double) { return false; };
  EXPECT_EQ(RemeshToQuads(given, StandIn(Cube(2), given), params).Status.Code, ErrorCode::Aborted);
}

TEST(QuadQuality, ScaledJacobianIsTheSmallestSine_GoldenOracle)
{
  PointMatrix points(4, 3);
  points << 0, 0, 0, 2, 0, 0, 3, 1, 0, 1, 1, 0; // a parallelogram with angles of 45 degrees
  EXPECT_NEAR(ScaledJacobian(points, { 0, 1, 2, 3 }), std::sqrt(0.5), 1e-15);
  points << 0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0;
  EXPECT_NEAR(ScaledJacobian(points, { 0, 1, 2, 3 }), 1.0, 1e-15);
  points << 0, 0, 0, 1, 0, 0, 0.1, 0.1, 0, 0, 1, 0; // a dart
  EXPECT_LT(ScaledJacobian(points, { 0, 1, 2, 3 }), 0.0);
  points.row(1) = points.row(0);
  EXPECT_EQ(ScaledJacobian(points, { 0, 1, 2, 3 }), -1.0);
}
