// SPDX-License-Identifier: BSD-3-Clause
// Models of solids whose faces, edges, areas and volumes are known in closed form.
#include "ProfiledMeshes.h"
#include "RegionModel.h"
#include "TriangleSag.h"
#include "TrimmedMesh.h"
#include <knotwork/SplineCore/SurfaceProfile.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace knotwork
{
namespace
{
constexpr double Pi = 0.5 * TwoPi;

/// The box from 0 to (a, b, c), without the triangles of some of its six sides.
TriangleMesh Box(double a, double b, double c, const std::vector<int>& open = {})
{
  TriangleMesh mesh;
  mesh.Points.resize(8, 3);
  for (Eigen::Index i = 0; i < 8; ++i)
  {
    mesh.Points.row(i) << (i & 1 ? a : 0.0), (i & 2 ? b : 0.0), (i & 4 ? c : 0.0);
  }
  const std::array<std::array<int, 4>, 6> sides{ { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 },
    { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } } };
  for (int s = 0; s < 6; ++s)
  {
    if (std::find(open.begin(), open.end(), s) == open.end())
    {
      const auto& q = sides[static_cast<std::size_t>(s)];
      mesh.Triangles.push_back({ q[0], q[1], q[2] });
      mesh.Triangles.push_back({ q[0], q[2], q[3] });
    }
  }
  return mesh;
}

TriangleMesh Both(const TriangleMesh& first, const TriangleMesh& second)
{
  TriangleMesh both = first;
  const auto shift = static_cast<int>(first.Points.rows());
  both.Points.conservativeResize(shift + second.Points.rows(), 3);
  both.Points.bottomRows(second.Points.rows()) = second.Points;
  for (const std::array<int, 3>& t : second.Triangles)
  {
    both.Triangles.push_back({ t[0] + shift, t[1] + shift, t[2] + shift });
  }
  return both;
}

/// The model with what holds for every one.
RegionModel ModelOf(const TriangleMesh& mesh, double tolerance = 0.0)
{
  RecognitionParams recognition;
  recognition.Tolerance = tolerance;
  recognition.MaximumSag = 30.0;
  auto model = ModelMesh(mesh, recognition);
  EXPECT_TRUE(model) << model.Status.Message();
  EXPECT_TRUE(model->Model.Check());
  for (const LoopVerdict verdict : model->Verdicts)
  {
    EXPECT_EQ(verdict, LoopVerdict::SimpleNested);
  }
  for (const FaceCertificate& certificate : model->Certificates)
  {
    EXPECT_EQ(certificate.Verdict, Verdict::Valid);
  }
  EXPECT_LE(model->MaxPointDistance, 1e-7);
  EXPECT_LE(model->MaxEdgeGap, 1e-7);
  return std::move(model.Value);
}

struct Measures
{
  double Area = 0.0;
  double Volume = 0.0;
};

/// Of a fine triangulation, whose normals tell inside from outside.
Measures MeasuresOf(const RegionModel& model, double tolerance)
{
  TrimmedMeshParams params;
  params.Tolerance = tolerance;
  const auto mesh = TriangulateFaces(model.Model, params);
  EXPECT_TRUE(mesh) << mesh.Status.Message();
  Measures measures;
  for (const std::array<int, 3>& t : mesh->Triangles)
  {
    measures.Area += TriangleArea(mesh->Points, t);
    const Eigen::Vector3d a = mesh->Points.row(t[0]).transpose();
    const Eigen::Vector3d b = mesh->Points.row(t[1]).transpose();
    const Eigen::Vector3d c = mesh->Points.row(t[2]).transpose();
    measures.Volume += a.dot(b.cross(c)) / 6.0;
  }
  return measures;
}

struct Solid
{
  const char* Name;
  TriangleMesh Mesh;
  std::array<int, NumSurfaceTypes> Types; ///< planes, cylinders, spheres, cones, tori, free form
  int Edges;                              ///< without seams
  double Area;
  double Volume;
};

/// Chords of arcs of `sides` corners.
std::vector<Solid> Solids()
{
  constexpr int sides = 64;
  const double slant = std::sqrt(5.0);
  return {
    { "cylinder", Turned({ 0, 0 }, { { { 1, 0 } }, { { 1, 2 } }, { { 0, 2 } } }, sides),
      { 2, 1, 0, 0, 0, 0 }, 2, 6.0 * Pi, 2.0 * Pi },
    { "cone", Turned({ 0, 0 }, { { { 1, 0 } }, { { 0, 2 } } }, sides), { 1, 0, 0, 1, 0, 0 }, 1,
      Pi * (1.0 + slant), 2.0 * Pi / 3.0 },
    { "frustum", Turned({ 0, 0 }, { { { 2, 0 } }, { { 1, 2 } }, { { 0, 2 } } }, sides),
      { 2, 0, 0, 1, 0, 0 }, 2, Pi * (4.0 + 1.0 + 3.0 * slant), 2.0 * Pi * 7.0 / 3.0 },
    { "ball", Turned({ 0, -1 }, { { { 0, 1 }, { 0, 0 }, 32 } }, sides), { 0, 0, 1, 0, 0, 0 }, 0,
      4.0 * Pi, 4.0 * Pi / 3.0 },
    { "half a ball", Turned({ 0, 0 }, { { { 1, 0 } }, { { 0, 1 }, { 0, 0 }, 16 } }, sides),
      { 1, 0, 1, 0, 0, 0 }, 1, 3.0 * Pi, 2.0 * Pi / 3.0 },
    { "ring",
      Turned({ 4, 0 },
        { { { 3, 1 }, { 3, 0 }, 16 }, { { 2, 0 }, { 3, 0 }, 16 }, { { 3, -1 }, { 3, 0 }, 16 },
          { { 4, 0 }, { 3, 0 }, 16 } },
        128),
      { 0, 0, 0, 0, 1, 0 }, 0, 12.0 * Pi * Pi, 6.0 * Pi * Pi },
    { "tube", Turned({ 1, 0 }, { { { 2, 0 } }, { { 2, 3 } }, { { 1, 3 } }, { { 1, 0 } } }, sides),
      { 2, 2, 0, 0, 0, 0 }, 4, 2.0 * Pi * 3.0 + 18.0 * Pi, 9.0 * Pi },
    { "rounded cylinder",
      Turned(
        { 0, 0 }, { { { 2, 0 } }, { { 2, 1 } }, { { 1, 2 }, { 1, 1 }, 16 }, { { 0, 2 } } }, sides),
      { 2, 1, 0, 0, 1, 0 }, 3, 4.0 * Pi + 4.0 * Pi + Pi + Pi * (Pi + 2.0),
      4.0 * Pi + Pi + Pi * Pi / 2.0 + 2.0 * Pi / 3.0 },
  };
}
}

/// The bound of the area's error: chords within 1e-3 of surfaces of radii 1 to 4 lose less than
/// two parts in a thousand.
TEST(RegionModel, SolidsOfRevolution_Exact)
{
  for (const Solid& solid : Solids())
  {
    SCOPED_TRACE(solid.Name);
    const RegionModel model = ModelOf(solid.Mesh);
    EXPECT_EQ(model.NumOfType, solid.Types);
    EXPECT_EQ(model.NumEdges, solid.Edges);
    // but for the two of the torus
    EXPECT_EQ(
      model.NumSharpEdges, solid.Edges - (solid.Types[0] == 2 && solid.Types[4] == 1 ? 2 : 0));
    EXPECT_EQ(model.NumCircles, solid.Edges);
    EXPECT_EQ(model.NumRims, 0);
    const Measures found = MeasuresOf(model, 1e-3);
    EXPECT_NEAR(found.Area / solid.Area, 1.0, 2e-3);
    EXPECT_NEAR(found.Volume / solid.Volume, 1.0, 2e-3);
  }
}

TEST(RegionModel, BoxesAreExact)
{
  const RegionModel model = ModelOf(Box(1, 2, 3));
  EXPECT_EQ(model.Model.Faces.size(), 6u);
  EXPECT_EQ(model.NumLines, 12);
  EXPECT_EQ(model.NumEdges, 12);
  EXPECT_EQ(model.NumVertices, 8);
  EXPECT_LE(model.MaxDistance, 1e-15);
  EXPECT_LE(model.MaxEdgeDistance, 1e-14);
  for (const TrimmedFace& face : model.Model.Faces)
  {
    EXPECT_EQ(face.Type, SurfaceType::Plane);
    EXPECT_EQ(face.Surface.ControlPoints.rows(), 4);
  }
  const Measures found = MeasuresOf(model, 1e-3);
  EXPECT_NEAR(found.Area, 22.0, 1e-12);
  EXPECT_NEAR(found.Volume, 6.0, 1e-12);
}

TEST(RegionModel, OpenMeshesAreShells)
{
  const RegionModel open = ModelOf(Box(1, 2, 3, { 1 }));
  EXPECT_EQ(open.Model.Faces.size(), 5u);
  EXPECT_EQ(open.NumLines, 12);
  EXPECT_EQ(open.NumSharpEdges, 8); // without those of the rim
  EXPECT_EQ(open.NumRims, 1);
  EXPECT_EQ(ModelOf(Box(1, 2, 3, { 0, 1 })).NumRims, 2);
  // the side of a cylinder
  const RegionModel tube = ModelOf(Turned({ 1, 0 }, { { { 1, 2 } } }, 48));
  EXPECT_EQ(tube.NumOfType[1], 1);
  EXPECT_EQ(tube.NumRims, 2);
  EXPECT_EQ(tube.NumCircles, 2);
  EXPECT_NEAR(MeasuresOf(tube, 1e-3).Area, 4.0 * Pi, 2e-2);
}

/// Nothing but the mesh says where a rim is.
TEST(RegionModel, RimsFollowTheMesh_ExactOracle)
{
  // half a disc: the chord of its arc lies in its plane, too
  TriangleMesh half;
  constexpr int sides = 90;
  half.Points = PointMatrix::Zero(sides + 2, 3);
  for (int i = 0; i <= sides; ++i)
  {
    half.Points.row(i + 1) << std::cos(Pi * i / sides), std::sin(Pi * i / sides), 0.0;
    if (i > 0)
    {
      half.Triangles.push_back({ 0, i, i + 1 });
    }
  }
  const RegionModel disc = ModelOf(half);
  EXPECT_EQ(disc.NumOfType[0], 1);
  EXPECT_EQ(disc.NumLines, 1);
  EXPECT_EQ(disc.NumCircles, 1);
  EXPECT_NEAR(MeasuresOf(disc, 1e-4).Area, 0.5 * Pi, 1e-3);
  // a cylinder whose rims swing: a curve of few spans lies on it as well
  constexpr int around = 120;
  constexpr double end = 3.0;
  TriangleMesh wavy;
  wavy.Points.resize(4 * (around + 1), 3);
  for (int i = 0; i <= around; ++i)
  {
    const double angle = end * i / around;
    for (int k = 0; k < 4; ++k)
    {
      const double height = (k - 1.5) * (1.0 + 0.2 * std::sin(4.0 * angle));
      wavy.Points.row(4 * i + k) << std::cos(angle), std::sin(angle), height;
      if (i > 0 && k > 0)
      {
        const int p = 4 * i + k;
        wavy.Triangles.push_back({ p - 5, p - 1, p });
        wavy.Triangles.push_back({ p - 5, p, p - 4 });
      }
    }
  }
  RecognitionParams recognition;
  recognition.Tolerance = 1e-3;
  const auto model = ModelMesh(wavy, recognition);
  ASSERT_TRUE(model) << model.Status.Message();
  EXPECT_EQ(model->NumOfType[1], 1);
  EXPECT_EQ(model->Model.Faces.size(), 1u);
  EXPECT_EQ(model->NumRims, 1);
  EXPECT_LE(model->MaxPointDistance, 0.25e-3); // as rims are asked to be
  EXPECT_LE(
    model->MaxEdgeDistance, 1e-3); // and the sag of chords, (3 / 120)^2 times 1.5 * 0.2 * 16 / 8
  const double area = 3.0 * (end + 0.05 * (1.0 - std::cos(4.0 * end)));
  EXPECT_NEAR(MeasuresOf(model.Value, 1e-4).Area, area, 4.0 * end * 0.4e-3); // a chord's sag
}

TEST(RegionModel, PartsAreInOneModel)
{
  TriangleMesh inner = Box(1, 1, 1);
  inner.Points.array() += 1.0;
  for (std::array<int, 3>& t : inner.Triangles)
  {
    std::swap(t[0], t[1]);
  }
  const RegionModel model = ModelOf(Both(Box(3, 3, 3), inner));
  EXPECT_EQ(model.Model.Faces.size(), 12u);
  EXPECT_EQ(model.NumVertices, 16);
  EXPECT_EQ(model.NumLines, 24);
  EXPECT_NEAR(MeasuresOf(model, 1e-3).Volume, 27.0 - 1.0, 1e-11);
}

/// A cylinder's end cut aslant: the edge is an ellipse, which is neither a line nor a circle.
TEST(RegionModel, OtherCurvesAreSplinesOnBothSurfaces_Property)
{
  TriangleMesh mesh = Turned({ 0, 0 }, { { { 1, 0 } }, { { 1, 2 } }, { { 0, 2 } } }, 96);
  const Eigen::Vector3d axis =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()) * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d origin(3, 1, 2);
  const Eigen::Vector3d across = axis.unitOrthogonal();
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    const Eigen::Vector3d offset = mesh.Points.row(i).transpose() - origin;
    if (offset.dot(axis) > 1.0)
    {
      mesh.Points.row(i) += 0.5 * offset.dot(across) * axis.transpose();
    }
  }
  const RegionModel model = ModelOf(mesh);
  EXPECT_EQ(model.NumOfType, (std::array<int, NumSurfaceTypes>{ 2, 1, 0, 0, 0, 0 }));
  EXPECT_EQ(model.NumEdges, 2);
  EXPECT_EQ(model.NumCircles, 1);
  EXPECT_EQ(model.NumLines, 0);
  const Measures found = MeasuresOf(model, 1e-3);
  EXPECT_NEAR(found.Volume / (2.0 * Pi), 1.0, 2e-3);
}

TEST(RegionModel, Refusals)
{
  const TriangleMesh box = Box(1, 2, 3);
  EXPECT_EQ(ModelMesh({}, {}).Status.Code, ErrorCode::EmptyInput);
  const auto surface = CheckSurface(box);
  auto regions = RecognizeSurfaces(surface.Value);
  RegionModelParams params;
  params.CornerAngle = 0.0;
  EXPECT_EQ(
    ModelRegions(surface.Value, regions.Value, params).Status.Code, ErrorCode::InvalidParameter);
  regions->Regions[2].Surface.Type = SurfaceType::FreeForm;
  const Status free = ModelRegions(surface.Value, regions.Value).Status;
  EXPECT_EQ(free.Code, ErrorCode::NotInSpace);
  EXPECT_NE(free.Detail.find("region 2"), std::string::npos);
  regions->RegionOfTriangle.pop_back();
  EXPECT_EQ(ModelRegions(surface.Value, regions.Value).Status.Code, ErrorCode::SizeMismatch);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(ModelMesh(box, {}, params).Status.Code, ErrorCode::Aborted);
  // a ring that is bent into a knot of facets: nothing but small planes
  TriangleMesh facets;
  std::mt19937 random(3);
  constexpr int n = 16;
  facets.Points.resize(n * n, 3);
  for (int i = 0; i < n * n; ++i)
  {
    facets.Points.row(i) << i % n, i / n, static_cast<double>(random()) / 4294967296.0;
  }
  for (int i = 0; i < n * n; ++i)
  {
    if (i % n + 1 < n && i / n + 1 < n)
    {
      facets.Triangles.push_back({ i, i + 1, i + n + 1 });
      facets.Triangles.push_back({ i, i + n + 1, i + n });
    }
  }
  EXPECT_EQ(ModelMesh(facets, {}).Status.Code, ErrorCode::NotInSpace);
}

/// The volume between the profile's bound and what chords cut off.
TEST(RegionModel, WavesAreOneFace_Exact)
{
  const TriangleMesh bar = WavyBar(48, 2.0);
  const TriangleMesh vase = Vase(48, 64);
  const std::array<int, NumSurfaceTypes> types[] = { { 5, 0, 0, 0, 0, 0, 1, 0 },
    { 2, 0, 0, 0, 0, 0, 0, 1 } };
  const double volumes[] = { 2.0 * WaveArea(), Pi * WaveSquares() };
  for (const bool turns : { false, true })
  {
    SCOPED_TRACE(turns);
    const auto model = ModelMesh(turns ? vase : bar, {});
    ASSERT_TRUE(model) << model.Status.Message();
    EXPECT_TRUE(model->Model.Check());
    EXPECT_EQ(model->NumOfType, types[turns ? 1 : 0]);
    EXPECT_EQ(model->NumEdges, turns ? 2 : 12);
    EXPECT_EQ(model->NumCircles, turns ? 2 : 0);
    EXPECT_EQ(model->NumSharpEdges, model->NumEdges);
    for (std::size_t f = 0; f < model->Verdicts.size(); ++f)
    {
      EXPECT_EQ(model->Verdicts[f], LoopVerdict::SimpleNested) << f;
      EXPECT_EQ(model->Certificates[f].Verdict, Verdict::Valid) << f;
    }
    EXPECT_LE(model->MaxPointDistance, 0.35 * model->Tolerance);
    EXPECT_LE(model->MaxEdgeGap, model->Tolerance);
    EXPECT_GT(model->MaxDistance, model->MaxPointDistance); // chords sag
    EXPECT_LE(model->MaxDistance, 5.0 * model->Tolerance);
    const Measures found = MeasuresOf(model.Value, 1e-3);
    EXPECT_NEAR(found.Volume / volumes[turns ? 1 : 0], 1.0, 2e-3);
  }
}

/// Against samples: never below, and not far above.
TEST(TriangleSag, BoundsTheDistance_IndependentOracle)
{
  std::mt19937 random(9);
  const auto draw = [&](double a, double b)
  { return a + (b - a) * static_cast<double>(random()) / 4294967296.0; };
  for (const SurfaceType type : { SurfaceType::Plane, SurfaceType::Cylinder, SurfaceType::Sphere,
         SurfaceType::Cone, SurfaceType::Torus, SurfaceType::Extrusion, SurfaceType::Revolution })
  {
    AnalyticSurface surface;
    surface.Type = type;
    surface.Radius = 2.0;
    surface.MinorRadius = 0.5;
    surface.Angle = 0.5;
    Spline<1> bend; // from (2.25, -1) by (2, 0) to (2.25, 1)
    bend.Space = MakeTensorSpace<1>({ KnotVector::Uniform(2, 1, -1.0, 1.0) }).Value;
    bend.ControlPoints.resize(3, 2);
    bend.ControlPoints << 2.25, -1.0, 1.75, 0.0, 2.25, 1.0;
    surface.Profile = std::make_shared<const SurfaceProfile>(bend, Eigen::Vector3d::UnitX());
    for (int trial = 0; trial < 50; ++trial)
    {
      std::array<Eigen::Vector3d, 3> corners;
      for (Eigen::Vector3d& corner : corners)
      {
        const double out = type == SurfaceType::Torus ? 2.5 : 2.0;
        corner = Eigen::Vector3d(out + draw(0.0, 0.1), draw(-0.15, 0.15), draw(-0.15, 0.15));
        corner -= surface.Distance(corner) * surface.Normal(corner); // about on it
      }
      double found = 0.0;
      for (int k = 0; k < 400; ++k)
      {
        double a = draw(0, 1);
        double b = draw(0, 1);
        if (a + b > 1.0)
        {
          a = 1.0 - a;
          b = 1.0 - b;
        }
        const Eigen::Vector3d point =
          corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]);
        found = std::max(found, std::abs(surface.Distance(point)));
      }
      const double bound = BoundDistance(surface, corners);
      EXPECT_GE(bound, found - 1e-15) << ToString(type);
      EXPECT_LE(bound, 2.0 * found + 2e-3) << ToString(type);
    }
  }
}
}
