// SPDX-License-Identifier: BSD-3-Clause
// Solids with machined faces beside faces of free form; volumes are known as integrals.
#include "RegionModel.h"
#include "TrimmedMesh.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
using Map = std::function<Eigen::Vector3d(double, double)>;

/// Triangles of (u, v) in the unit square, counterclockwise; equal points of several are one.
void AddGrid(const Map& map, int nu, int nv, TriangleMesh& mesh)
{
  const auto first = static_cast<int>(mesh.Points.rows());
  mesh.Points.conservativeResize(first + (nu + 1) * (nv + 1), 3);
  for (int j = 0; j <= nv; ++j)
  {
    for (int i = 0; i <= nu; ++i)
    {
      mesh.Points.row(first + j * (nu + 1) + i) =
        map(static_cast<double>(i) / nu, static_cast<double>(j) / nv).transpose();
    }
  }
  for (int j = 0; j < nv; ++j)
  {
    for (int i = 0; i < nu; ++i)
    {
      const int a = first + j * (nu + 1) + i;
      const int d = a + nu + 1;
      const auto isOne = [&](int p, int q) { return mesh.Points.row(p) == mesh.Points.row(q); };
      if (!isOne(a, a + 1))
      {
        mesh.Triangles.push_back({ a, a + 1, d + 1 });
      }
      if (!isOne(d, d + 1))
      {
        mesh.Triangles.push_back({ a, d + 1, d });
      }
    }
  }
}

/// A box whose upper face is z = height(x, y) over the unit square.
TriangleMesh BoxUnder(const std::function<double(double, double)>& height)
{
  constexpr int n = 32; // parameters are exact
  TriangleMesh mesh;
  mesh.Points.resize(0, 3);
  const auto at = [&](double x, double y, double t)
  { return Eigen::Vector3d(x, y, t * height(x, y)); };
  AddGrid([&](double u, double v) { return at(u, v, 1.0); }, n, n, mesh);
  AddGrid([&](double u, double v) { return at(v, u, 0.0); }, n, n, mesh);
  AddGrid([&](double u, double v) { return at(u, 0.0, v); }, n, 2, mesh);
  AddGrid([&](double u, double v) { return at(1.0, u, v); }, n, 2, mesh);
  AddGrid([&](double u, double v) { return at(1.0 - u, 1.0, v); }, n, 2, mesh);
  AddGrid([&](double u, double v) { return at(0.0, 1.0 - u, v); }, n, 2, mesh);
  return mesh;
}

/// A closed angle is the same number at both ends.
double Angle(double u)
{
  return 2.0 * Pi * (u >= 1.0 ? 0.0 : u);
}

/// A round bar of radius 1 from z = 0 to z = height(x, y).
TriangleMesh BarUnder(const std::function<double(double, double)>& height)
{
  constexpr int n = 48;
  TriangleMesh mesh;
  mesh.Points.resize(0, 3);
  const auto at = [&](double u, double r, double t)
  {
    const double x = r * std::cos(Angle(u));
    const double y = r * std::sin(Angle(u));
    return Eigen::Vector3d(x, y, t * height(x, y));
  };
  AddGrid([&](double u, double v) { return at(u, v, 1.0); }, n, 12, mesh);
  AddGrid([&](double u, double v) { return at(u, 1.0 - v, 0.0); }, n, 12, mesh);
  AddGrid([&](double u, double v) { return at(u, 1.0, v); }, n, 3, mesh);
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    // the discs run the other way around
    if (t < mesh.Triangles.size() - 2 * 3 * n)
    {
      std::swap(mesh.Triangles[t][0], mesh.Triangles[t][1]);
    }
  }
  return mesh;
}

double VolumeOf(const PointMatrix& points, const std::vector<std::array<int, 3>>& triangles)
{
  double volume = 0.0;
  for (const std::array<int, 3>& t : triangles)
  {
    const Eigen::Vector3d a = points.row(t[0]).transpose();
    const Eigen::Vector3d b = points.row(t[1]).transpose();
    const Eigen::Vector3d c = points.row(t[2]).transpose();
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

/// What holds for every model of a closed mesh: proofs, a bounded deviation, two faces an edge.
RegionModel ModelOf(const TriangleMesh& mesh, const RegionModelParams& params = {})
{
  auto model = ModelMesh(mesh, {}, params);
  EXPECT_TRUE(model) << model.Status.Message();
  if (!model)
  {
    return {};
  }
  EXPECT_TRUE(model->Model.Check());
  for (const LoopVerdict verdict : model->Verdicts)
  {
    EXPECT_EQ(verdict, LoopVerdict::SimpleNested);
  }
  for (const FaceCertificate& certificate : model->Certificates)
  {
    EXPECT_EQ(certificate.Verdict, Verdict::Valid);
  }
  EXPECT_LE(model->MaxPointDistance, model->Tolerance);
  EXPECT_LE(model->FreeDeviation, model->Tolerance);
  EXPECT_LE(model->MaxEdgeGap, model->Tolerance);
  std::map<int, int> uses;
  for (const TrimmedFace& face : model->Model.Faces)
  {
    for (const TrimmedLoop& loop : face.Loops)
    {
      for (const TrimmingCurve& curve : loop.Curves)
      {
        uses[curve.Edge] += curve.Reversed != face.Reversed ? -1 : 1;
        uses[-1 - curve.Edge] += 1;
      }
    }
  }
  for (const auto& [edge, count] : uses)
  {
    EXPECT_EQ(count, edge < 0 ? 2 : 0) << "edge " << edge;
  }
  return std::move(model.Value);
}

/// Of a triangulation, which is within a quarter of the tolerance of the model.
double VolumeOf(const RegionModel& model)
{
  TrimmedMeshParams params;
  params.Tolerance = 0.25 * model.Tolerance;
  const auto mesh = TriangulateFaces(model.Model, params);
  EXPECT_TRUE(mesh) << mesh.Status.Message();
  return VolumeOf(mesh->Points, mesh->Triangles);
}

int Count(const RegionModel& model, SurfaceType type)
{
  return model.NumOfType[static_cast<std::size_t>(type)];
}

/// Curved everywhere over the unit square, and nowhere as a torus is.
double OverSquare(double x, double y)
{
  return 1.0 + 0.4 * x * y + 0.2 * x * x * x - 0.3 * y * y * x;
}

/// The same over the unit disc.
double OverDisc(double x, double y)
{
  return 1.0 + 0.4 * x * y + 0.2 * x * x * x - 0.1 * y * y * x;
}
}

/// The volume is right to area times deviation, with a quarter of the tolerance for triangles: the
/// mesh's own chords are nearer than that.
TEST(FreeFaces, BoxUnderACubic_Integral)
{
  const RegionModel model = ModelOf(BoxUnder(OverSquare));
  EXPECT_EQ(Count(model, SurfaceType::Plane), 5);
  EXPECT_EQ(Count(model, SurfaceType::FreeForm), 1);
  EXPECT_EQ(model.Model.Faces.size(), 6u);
  EXPECT_EQ(model.NumEdges, 12);
  EXPECT_EQ(model.NumLines, 8);
  EXPECT_EQ(model.NumVertices, 8);
  EXPECT_EQ(model.NumSharpEdges, 12);
  const double exact = 1.0 + 0.4 / 4.0 + 0.2 / 4.0 - 0.3 / 6.0;
  EXPECT_NEAR(VolumeOf(model), exact, 6.0 * 1.25 * model.Tolerance);
}

/// Triangles of the curved end have chords of the bar's circle for sides, which sag more than the
/// edge may be off.
TEST(FreeFaces, BarUnderACubic_Integral)
{
  const RegionModel model = ModelOf(BarUnder(OverDisc));
  EXPECT_EQ(Count(model, SurfaceType::Plane), 1);
  EXPECT_EQ(Count(model, SurfaceType::Cylinder), 1);
  EXPECT_EQ(Count(model, SurfaceType::FreeForm), 1);
  double exact = 0.0; // midpoint rule in polar coordinates
  constexpr int n = 400;
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      const double r = (i + 0.5) / n;
      const double angle = 2.0 * Pi * (j + 0.5) / n;
      exact += OverDisc(r * std::cos(angle), r * std::sin(angle)) * r * 2.0 * Pi / (n * n);
    }
  }
  EXPECT_NEAR(VolumeOf(model), exact, 4.0 * Pi * 1.25 * model.Tolerance);
}

/// More than half a bulging ball on a plane: charts of one smooth region, whose angle is measured.
TEST(FreeFaces, SeveralChartsShareEdgesWithAPlane)
{
  constexpr double Deepest = 0.8 * Pi;
  const auto dome = [](double u, double t)
  {
    const double polar = Deepest * t;
    const double r = 1.0 + 0.12 * std::cos(3.0 * Angle(u)) * std::sin(polar);
    return Eigen::Vector3d(r * std::sin(polar) * std::cos(Angle(u)),
      r * std::sin(polar) * std::sin(Angle(u)), 1.4 * (std::cos(polar) - std::cos(Deepest)));
  };
  TriangleMesh mesh;
  mesh.Points.resize(0, 3);
  AddGrid([&](double u, double v) { return dome(u, 1.0 - v); }, 72, 48, mesh);
  AddGrid(
    [&](double u, double v)
    {
      Eigen::Vector3d rim = dome(u, 1.0);
      rim.head(2) *= v;
      rim.z() = 0.0;
      return v < 1.0 ? rim : dome(u, 1.0);
    },
    72, 6, mesh);
  RegionModelParams params;
  params.LeastAnalytic = 0.0;
  params.Charts.MaxStretch = 1.5;
  const RegionModel model = ModelOf(mesh, params);
  EXPECT_EQ(Count(model, SurfaceType::Plane), 1);
  EXPECT_GE(Count(model, SurfaceType::FreeForm), 2);
  EXPECT_GT(model.MaxNormalAngle, 0.0);
  EXPECT_LT(model.MaxNormalAngle, 10.0);
  EXPECT_NEAR(
    VolumeOf(model), VolumeOf(mesh.Points, mesh.Triangles), 12.0 * 1.25 * model.Tolerance);
  params.LeastAnalytic = 0.5;
  const Status few = ModelMesh(mesh, {}, params).Status;
  EXPECT_EQ(few.Code, ErrorCode::NotInSpace);
  EXPECT_NE(few.Detail.find("% of the area, less than 50 %"), std::string::npos) << few.Detail;
}

/// Both ends are curved, and the points of one rim lie between those of the other: the seam of the
/// bar ends at a point of the mesh at one end only, the other chart gets one for it.
TEST(FreeFaces, SeamsEndBetweenPointsOfTheMesh)
{
  constexpr int n = 48;
  const auto at = [](double u, double r, double t)
  {
    const double angle = Angle(u) + (2.0 * Pi / n) * 0.37 * t;
    const double x = r * std::cos(angle);
    const double y = r * std::sin(angle);
    return Eigen::Vector3d(x, y, (1.0 - t) * 0.2 * OverDisc(y, x) + t * (1.0 + OverDisc(x, y)));
  };
  TriangleMesh mesh;
  mesh.Points.resize(0, 3);
  AddGrid([&](double u, double v) { return at(u, 1.0 - v, 1.0); }, n, 12, mesh);
  AddGrid([&](double u, double v) { return at(u, v, 0.0); }, n, 12, mesh);
  AddGrid([&](double u, double v) { return at(u, 1.0, v); }, n, 3, mesh);
  const RegionModel model = ModelOf(mesh);
  EXPECT_EQ(Count(model, SurfaceType::Cylinder), 1);
  EXPECT_EQ(Count(model, SurfaceType::FreeForm), 2);
  EXPECT_EQ(model.NumSharpEdges, model.NumEdges);
  EXPECT_NEAR(VolumeOf(model), 1.8 * Pi, 4.0 * Pi * 1.25 * model.Tolerance);
}

/// Two flat squares in the upper face, one of them tilted, touch at a corner, and free form rises
/// from them all around: it touches itself there.
TEST(FreeFaces, RegionsMayTouchThemselvesInAPoint)
{
  const auto distance = [](double x, double y, double a, double b)
  {
    const double dx = std::max({ 0.0, a - x, x - b });
    const double dy = std::max({ 0.0, a - y, y - b });
    return std::hypot(dx, dy);
  };
  const RegionModel model = ModelOf(BoxUnder(
    [&](double x, double y)
    {
      const double first = distance(x, y, 0.25, 0.5);
      const double second = distance(x, y, 0.5, 0.75);
      const double tilt = first > 0.0 ? 0.3 * (x + y - 1.0) * first / (first + second) : 0.0;
      return 1.0 + tilt + 0.7 * first * second / (first + second + 0.02);
    }));
  EXPECT_EQ(Count(model, SurfaceType::Plane), 5 + 2);
  EXPECT_GE(Count(model, SurfaceType::FreeForm), 1);
}

/// Two deep domes on each other with a sharp rim that both share: charts of either are cut, some of
/// the cuts end on the rim.
TEST(FreeFaces, CutsOfBothSidesOfASharpEdge)
{
  const auto dome = [](double u, double t, double sign)
  {
    const double polar = 0.5 * Pi * t;
    const double r = 1.0 + 0.15 * std::cos(3.0 * Angle(u)) * std::sin(polar);
    return Eigen::Vector3d(r * std::sin(polar) * std::cos(Angle(u)),
      r * std::sin(polar) * std::sin(Angle(u)),
      t < 1.0 ? sign * 1.5 * std::pow(std::cos(polar), 0.75) : 0.0);
  };
  TriangleMesh mesh;
  mesh.Points.resize(0, 3);
  AddGrid([&](double u, double v) { return dome(u, 1.0 - v, 1.0); }, 64, 32, mesh);
  AddGrid([&](double u, double v) { return dome(u, v, -0.6); }, 64, 32, mesh);
  RegionModelParams params;
  params.LeastAnalytic = 0.0;
  params.Charts.MaxStretch = 1.4;
  const RegionModel model = ModelOf(mesh, params);
  EXPECT_GE(Count(model, SurfaceType::FreeForm), 3);
  EXPECT_NEAR(VolumeOf(model), VolumeOf(mesh.Points, mesh.Triangles), 2e-2);
}

TEST(FreeFaces, AreRefusedOnRequest)
{
  RegionModelParams params;
  params.FreeForm = false;
  const Status refused = ModelMesh(BoxUnder(OverSquare), {}, params).Status;
  EXPECT_EQ(refused.Code, ErrorCode::NotInSpace);
  EXPECT_NE(refused.Detail.find("is of free form"), std::string::npos) << refused.Detail;
}

/// A sheet that is rolled up is covered by a few cylinders within the tolerance, and is none.
TEST(FreeFaces, SmoothShapesInPiecesAreFree)
{
  TriangleMesh roll;
  roll.Points.resize(0, 3);
  AddGrid(
    [](double u, double v)
    {
      const double angle = 3.0 * Pi * u;
      const double r = 1.0 + 0.3 * angle;
      return Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 4.0 * v);
    },
    256, 16, roll);
  const Status refused = ModelMesh(roll, {}).Status;
  EXPECT_EQ(refused.Code, ErrorCode::NotInSpace);
  EXPECT_NE(refused.Detail.find("% of the area"), std::string::npos) << refused.Detail;
}

/// Noise of a quarter of the tolerance on all points: the sides are still planes.
TEST(FreeFaces, NoiseLeavesPlanesPlanes)
{
  TriangleMesh mesh = BoxUnder(OverSquare);
  std::map<std::array<double, 3>, Eigen::RowVector3d> moves; // equal points move together
  std::mt19937 random(7);
  const double size = std::sqrt(3.0) * 2.5e-4;
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    const std::array<double, 3> place{ mesh.Points(i, 0), mesh.Points(i, 1), mesh.Points(i, 2) };
    auto [move, isNew] = moves.try_emplace(place, Eigen::RowVector3d::Zero());
    for (Eigen::Index d = 0; isNew && d < 3; ++d)
    {
      move->second[d] =
        size / std::sqrt(3.0) * (2.0 * static_cast<double>(random()) / 4294967296.0 - 1.0);
    }
    mesh.Points.row(i) += move->second;
  }
  const RegionModel model = ModelOf(mesh);
  EXPECT_EQ(Count(model, SurfaceType::Plane), 5);
  EXPECT_GE(Count(model, SurfaceType::FreeForm), 1);
}

/// A vertex that is given divides the edge along it, and lies where it is said.
TEST(TrimSurface, GivenVerticesEndEdges)
{
  constexpr int n = 8;
  ChartMesh chart;
  TriangleMesh mesh;
  mesh.Points.resize(0, 3);
  AddGrid([](double u, double v) { return Eigen::Vector3d(u, v, 0.0); }, n, n, mesh);
  chart.Points = mesh.Points;
  chart.UV = mesh.Points.leftCols(2);
  chart.Triangles = mesh.Triangles;
  for (Eigen::Index i = 0; i < chart.Points.rows(); ++i)
  {
    chart.PointIds.push_back(100 + i);
  }
  TrimParams params;
  params.Tolerance = 1e-3;
  params.Triangulation = false;
  const auto plain = TrimSurface({ chart }, params);
  ASSERT_TRUE(plain) << plain.Status.Message();
  EXPECT_EQ(plain->Model.NumEdges, 4);
  LoopVertex vertex;
  vertex.PointId = 100 + n / 2; // of the side v = 0
  vertex.Point = Eigen::Vector3d(0.5, 1e-4, 2e-4);
  params.Vertices = { vertex };
  const auto divided = TrimSurface({ chart }, params);
  ASSERT_TRUE(divided) << divided.Status.Message();
  EXPECT_EQ(divided->Model.NumEdges, 5);
  EXPECT_EQ(divided->Model.NumVertices, 5);
  double nearest = HUGE_VAL;
  for (const TrimmingCurve& curve : divided->Model.Faces[0].Loops[0].Curves)
  {
    nearest =
      std::min(nearest, (curve.Curve.ControlPoints.row(0).transpose() - *vertex.Point).norm());
  }
  EXPECT_EQ(nearest, 0.0);
}
}
