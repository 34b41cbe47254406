// SPDX-License-Identifier: BSD-3-Clause
#include "FaceCases.h"
#include "RandomSplines.h"
#include "SurfaceCells.h"

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
TrimmedMeshParams Within(double tolerance)
{
  TrimmedMeshParams params;
  params.Tolerance = tolerance;
  return params;
}

TrimmedMesh Triangulated(const TrimmedModel& model, const TrimmedMeshParams& params)
{
  const Result<TrimmedMesh> mesh = TriangulateFaces(model, params);
  EXPECT_TRUE(mesh) << mesh.Status.Message();
  return mesh.Value;
}

TrimmedModel OneFace(Spline<2> surface)
{
  TrimmedModel model;
  model.Faces.emplace_back();
  model.Faces.front().Surface = std::move(surface);
  return model;
}

/// A circle of `waves` waves, clockwise when turns is -1.
Path Wavy(std::array<double, 2> middle, double radius, double wave, int waves, double turns)
{
  return [=](double t) -> std::array<double, 2>
  {
    const double angle = 2.0 * Pi * turns * t;
    const double r = radius + wave * std::cos(waves * angle);
    return { middle[0] + r * std::cos(angle), middle[1] + r * std::sin(angle) };
  };
}

/// Hills with a straight outer loop and a wavy hole.
TrimmedModel HillsWithHole(unsigned seed)
{
  TrimmedModel model = OneFace(Hills(seed, 0.3));
  TrimmedFace& face = model.Faces.front();
  AddPolygon(model, face, { { 0.02, 0.02 }, { 0.98, 0.02 }, { 0.98, 0.98 }, { 0.02, 0.98 } },
    KnotVector::Uniform(3, 12));
  AddClosed(model, face, Wavy({ 0.5, 0.5 }, 0.25, 0.08, 5, -1.0), KnotVector::Uniform(3, 240));
  return model;
}

/// A curve y(x) as control points (x, y) of one cubic on [0, 1].
const std::array<std::array<double, 2>, 4> Arch{ { { 0, 0 }, { 0.2, 0.8 }, { 0.9, 0.7 },
  { 1, 0 } } };

/// The cylinder over the arch, of height 1, and its lid at z = 0: they share the arch.
TrimmedModel CylinderWithLid()
{
  TrimmedModel model;
  model.Faces.resize(2);
  Spline<2>& wall = model.Faces[0].Surface;
  wall.Space = MakeTensorSpace<2>({ KnotVector::Uniform(3, 1), KnotVector::Uniform(1, 1) }).Value;
  wall.ControlPoints.resize(8, 3);
  for (int i = 0; i < 8; ++i)
  {
    const auto& p = Arch[static_cast<std::size_t>(i % 4)];
    wall.ControlPoints.row(i) << p[0], p[1], i / 4;
  }
  Spline<2>& lid = model.Faces[1].Surface;
  lid = Plane(1.0, 1.0);
  const KnotVector cubic = KnotVector::Uniform(3, 1);
  model.NumVertices = 4;
  model.NumEdges = 5;
  TrimmedLoop around;
  around.Curves.push_back(Along(wall, Straight({ 0, 0 }, { 1, 0 }), cubic, 0, { 0, 1 }));
  around.Curves.push_back(Along(wall, Straight({ 1, 0 }, { 1, 1 }), {}, 1, { 1, 2 }));
  around.Curves.push_back(Along(wall, Straight({ 1, 1 }, { 0, 1 }), cubic, 2, { 2, 3 }));
  around.Curves.push_back(Along(wall, Straight({ 0, 1 }, { 0, 0 }), {}, 3, { 3, 0 }));
  model.Faces[0].Loops.push_back(around);
  TrimmedLoop under;
  under.Curves.push_back(around.Curves[0]); // the same curve, seen from the lid: from its end
  under.Curves[0].UV = wall.ControlPoints.topLeftCorner(4, 2);
  under.Curves[0].Reversed = true;
  under.Curves.push_back(Along(lid, Straight({ 0, 0 }, { 1, 0 }), {}, 4, { 0, 1 }));
  model.Faces[1].Loops.push_back(under);
  return model;
}
}

TEST(TriangulateFaces, SquareMinusSquare_ExactOracle)
{
  TrimmedModel model = OneFace(Plane(4.0, 4.0));
  AddPolygon(model, model.Faces[0], { { 0, 0 }, { 4, 0 }, { 4, 4 }, { 0, 4 } });
  AddPolygon(model, model.Faces[0], { { 1, 1 }, { 1, 3 }, { 3, 3 }, { 3, 1 } });
  const TrimmedMesh mesh = Triangulated(model, Within(1e-3));
  EXPECT_EQ(mesh.Triangles.size(), 8u); // V - E + F = 0 with the 8 corners alone
  EXPECT_NEAR(Area(mesh), 12.0, 1e-14 * 12.0);
  const MeshTopology topology = TopologyOf(mesh);
  EXPECT_TRUE(topology.Manifold);
  EXPECT_EQ(topology.Euler, 0);
  EXPECT_EQ(topology.BoundaryLoops, 2);
  EXPECT_DOUBLE_EQ(WorstNormal(mesh), 1.0);
  EXPECT_LE(mesh.Bound, 1e-14);
}

TEST(TriangulateFaces, ReversedFaceTurnsTrianglesAndNormals_ExactOracle)
{
  TrimmedModel model = OneFace(Plane());
  model.Faces[0].Reversed = true;
  AddPolygon(model, model.Faces[0], { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
  const TrimmedMesh mesh = Triangulated(model, Within(1e-3));
  EXPECT_DOUBLE_EQ(WorstNormal(mesh), 1.0);
  EXPECT_DOUBLE_EQ(mesh.Normals.col(2).maxCoeff(), -1.0);
}

TEST(TriangulateFaces, ConcaveLoopHasItsArea_ExactOracle)
{
  // A comb with teeth of width 1 and gaps of width 1.
  TrimmedModel model = OneFace(Plane(9.0, 4.0));
  std::vector<std::array<double, 2>> comb{ { 0, 0 }, { 9, 0 } };
  for (int tooth = 8; tooth >= 0; tooth -= 2)
  {
    comb.push_back({ tooth + 1.0, 4 });
    comb.push_back({ tooth + 0.0, 4 });
    if (tooth > 0)
    {
      comb.push_back({ tooth + 0.0, 1 });
      comb.push_back({ tooth - 1.0, 1 });
    }
  }
  AddPolygon(model, model.Faces[0], comb);
  const TrimmedMesh mesh = Triangulated(model, Within(1e-3));
  EXPECT_NEAR(Area(mesh), 9.0 + 15.0, 1e-13);
  const MeshTopology topology = TopologyOf(mesh);
  EXPECT_TRUE(topology.Manifold);
  EXPECT_EQ(topology.Euler, 1);
  EXPECT_EQ(topology.BoundaryLoops, 1);
}

TEST(TriangulateFaces, QuarterCylinderIsNearItsRadius_ExactOracle)
{
  ShapeParams shape;
  shape.Kind = ShapeKind::CylinderSurface;
  shape.OuterRadius = 2.0;
  const TrimmedModel model = OneFace(Shape(shape));
  for (double tolerance : { 1e-1, 1e-2, 1e-3, 1e-4 })
  {
    SCOPED_TRACE(tolerance);
    const TrimmedMesh mesh = Triangulated(model, Within(tolerance));
    EXPECT_LE(mesh.Bound, tolerance);
    double off = 0.0;
    for (const auto& t : mesh.Triangles)
    {
      for (std::size_t i = 0; i < 3; ++i)
      {
        const Eigen::RowVector3d middle =
          0.5 * (mesh.Points.row(t[i]) + mesh.Points.row(t[(i + 1) % 3]));
        off = std::max(off, 2.0 - middle.head<2>().norm());
      }
    }
    EXPECT_LE(off, mesh.Bound);
    EXPECT_GE(off, 0.05 * tolerance); // not many more triangles than needed
    // n equal chords of an angle a: 2 r (1 - cos(a / 2)) sagitta.
    const double chords = std::ceil(Pi / 2.0 / (2.0 * std::acos(1.0 - tolerance / 2.0)));
    EXPECT_LE(static_cast<double>(mesh.Triangles.size()), 8.0 * chords + 8.0);
    EXPECT_GE(WorstNormal(mesh), 0.7);
    const MeshTopology topology = TopologyOf(mesh);
    EXPECT_TRUE(topology.Manifold);
    EXPECT_EQ(topology.Euler, 1);
  }
}

TEST(TriangulateFaces, PolarSphereHasNoCollapsedTriangles_ExactOracle)
{
  ShapeParams shape;
  shape.Kind = ShapeKind::PolarSphereSurface;
  const TrimmedModel model = OneFace(Shape(shape));
  const TrimmedMesh mesh = Triangulated(model, Within(1e-3));
  EXPECT_LE(mesh.Bound, 1e-3);
  EXPECT_NEAR(Area(mesh), Pi, 4e-3 * Pi); // a quarter of the sphere
  EXPECT_LE(Area(mesh), Pi);
  EXPECT_TRUE(TopologyOf(mesh).Manifold);
  // At the poles normals are those of the triangles around.
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    EXPECT_NEAR(mesh.Normals.row(i).norm(), 1.0, 1e-14);
    EXPECT_GE(mesh.Normals.row(i).dot(mesh.Points.row(i)), 0.9);
  }
}

TEST(TriangulateFaces, WavyHoleInHillsIsWithinTolerance_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const TrimmedModel model = HillsWithHole(seed);
    for (double tolerance : { 1e-2, 1e-3 })
    {
      const TrimmedMesh mesh = Triangulated(model, Within(tolerance));
      const double sampled = SampledDeviation(model, mesh);
      EXPECT_LE(mesh.Bound, tolerance);
      EXPECT_LE(sampled, mesh.Bound);
      EXPECT_GE(sampled, 0.1 * tolerance); // and the bound is no idle one
      const MeshTopology topology = TopologyOf(mesh);
      EXPECT_TRUE(topology.Manifold);
      EXPECT_EQ(topology.Euler, 0);
      EXPECT_EQ(topology.BoundaryLoops, 2);
      EXPECT_GE(WorstNormal(mesh), 0.2);
    }
  }
}

TEST(TriangulateFaces, FacesShareTheirEdge_ExactOracle)
{
  const TrimmedModel model = CylinderWithLid();
  for (double tolerance : { 1e-2, 1e-4 })
  {
    const TrimmedMesh mesh = Triangulated(model, Within(tolerance));
    EXPECT_LE(mesh.Bound, tolerance);
    EXPECT_LE(SampledDeviation(model, mesh), mesh.Bound);
    const MeshTopology topology = TopologyOf(mesh);
    EXPECT_TRUE(topology.Manifold); // the lid's triangles run the arch the other way
    EXPECT_EQ(topology.Euler, 1);
    EXPECT_EQ(topology.BoundaryLoops, 1);
    std::set<int> wall;
    std::set<int> lid;
    for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
    {
      (mesh.TriangleFace[t] == 0 ? wall : lid)
        .insert(mesh.Triangles[t].begin(), mesh.Triangles[t].end());
    }
    int shared = 0;
    for (int point : wall)
    {
      shared += static_cast<int>(lid.count(point));
      EXPECT_EQ(lid.count(point) > 0, mesh.Points(point, 2) == 0.0);
    }
    EXPECT_GE(shared, 4);
  }
}

TEST(TriangulateFaces, SeamOfATubeIsClosed_ExactOracle)
{
  // A whole cylinder, whose loop runs its seam twice: an annulus with two boundary loops.
  ShapeParams shape;
  shape.Kind = ShapeKind::CylinderSurface;
  shape.Angle = 360.0;
  TrimmedModel model = OneFace(Shape(shape));
  TrimmedFace& face = model.Faces[0];
  const KnotVector fine = KnotVector::Uniform(3, 64);
  TrimmedLoop loop;
  loop.Curves.push_back(Along(face.Surface, Straight({ 0, 0 }, { 1, 0 }), fine, 0, { 0, 0 }));
  loop.Curves.push_back(Along(face.Surface, Straight({ 1, 0 }, { 1, 1 }), {}, 1, { 0, 1 }));
  loop.Curves.push_back(Along(face.Surface, Straight({ 0, 1 }, { 1, 1 }), fine, 2, { 1, 1 }, true));
  loop.Curves.push_back(loop.Curves[1]);
  loop.Curves[3].UV << 0, 0, 0, 1;
  loop.Curves[3].Reversed = true;
  face.Loops.push_back(loop);
  model.NumEdges = 3;
  model.NumVertices = 2;
  ASSERT_EQ(face.Surface.Space->Domain().Upper[0], 1.0);
  const TrimmedMesh mesh = Triangulated(model, Within(1e-3));
  const MeshTopology topology = TopologyOf(mesh);
  EXPECT_TRUE(topology.Manifold);
  EXPECT_EQ(topology.Euler, 0);
  EXPECT_EQ(topology.BoundaryLoops, 2);
  EXPECT_NEAR(Area(mesh), 2.0 * Pi, 2e-3 * 2.0 * Pi);
}

TEST(TriangulateFaces, ThinSliverBetweenCurves_ExactOracle)
{
  // Between y = x (1 - x) and the same raised by 1e-4, with ends that are that short; the upper
  // curve runs at another speed, so its chords and those below cross at first.
  TrimmedModel model = OneFace(Plane());
  TrimmedFace& face = model.Faces[0];
  const double width = 1e-4;
  const Path low = [](double t) -> std::array<double, 2> {
    return { t, 0.1 + t * (1.0 - t) };
  };
  const Path high = [width](double t) -> std::array<double, 2>
  {
    const double x = 1.0 - t * (1.0 + t) / 2.0;
    return { x, 0.1 + width + x * (1.0 - x) };
  };
  TrimmedLoop loop;
  loop.Curves.push_back(Along(face.Surface, low, KnotVector::Uniform(4, 1), 0, { 0, 1 }));
  loop.Curves.push_back(
    Along(face.Surface, Straight({ 1, 0.1 }, { 1, 0.1 + width }), {}, 1, { 1, 2 }));
  loop.Curves.push_back(Along(face.Surface, high, KnotVector::Uniform(4, 1), 2, { 2, 3 }));
  loop.Curves.push_back(
    Along(face.Surface, Straight({ 0, 0.1 + width }, { 0, 0.1 }), {}, 3, { 3, 0 }));
  face.Loops.push_back(loop);
  model.NumEdges = 4;
  model.NumVertices = 4;
  const TrimmedMesh mesh = Triangulated(model, Within(0.05));
  const MeshTopology topology = TopologyOf(mesh);
  EXPECT_TRUE(topology.Manifold);
  EXPECT_EQ(topology.Euler, 1);
  EXPECT_EQ(topology.BoundaryLoops, 1);
  EXPECT_LE(mesh.Bound, 0.05);
  EXPECT_GT(mesh.Triangles.size(), 20u); // chords were divided until they left each other alone
  const TrimmedMesh fine = Triangulated(model, Within(1e-7));
  EXPECT_NEAR(Area(fine), width, 2e-7); // chords of both sides are within the tolerance
}

TEST(TriangulateFaces, NeighboursFollowEdgesThatAreDivided_ExactOracle)
{
  // A sliver whose loop crosses itself until its edges are divided, and a wide face above that
  // would not need it.
  TrimmedModel model;
  model.Faces.resize(2);
  for (TrimmedFace& face : model.Faces)
  {
    face.Surface = Plane();
  }
  const double width = 1e-4;
  const Path low = [](double t) -> std::array<double, 2> {
    return { t, 0.1 + t * (1.0 - t) };
  };
  const Path high = [width](double t) -> std::array<double, 2>
  {
    const double x = t * (1.0 + t) / 2.0;
    return { x, 0.1 + width + x * (1.0 - x) };
  };
  const Spline<2>& plane = model.Faces[0].Surface;
  const double y = 0.1 + width;
  TrimmedLoop sliver;
  sliver.Curves.push_back(Along(plane, low, KnotVector::Uniform(4, 1), 0, { 0, 1 }));
  sliver.Curves.push_back(Along(plane, Straight({ 1, 0.1 }, { 1, y }), {}, 1, { 1, 2 }));
  sliver.Curves.push_back(Along(plane, high, KnotVector::Uniform(4, 1), 2, { 3, 2 }, true));
  sliver.Curves.push_back(Along(plane, Straight({ 0, y }, { 0, 0.1 }), {}, 3, { 3, 0 }));
  model.Faces[0].Loops.push_back(sliver);
  TrimmedLoop wide;
  wide.Curves.push_back(sliver.Curves[2]);
  wide.Curves[0].Reversed = false;
  wide.Curves.push_back(Along(plane, Straight({ 1, y }, { 1, 1 }), {}, 4, { 2, 4 }));
  wide.Curves.push_back(Along(plane, Straight({ 1, 1 }, { 0, 1 }), {}, 5, { 4, 5 }));
  wide.Curves.push_back(Along(plane, Straight({ 0, 1 }, { 0, y }), {}, 6, { 5, 3 }));
  model.Faces[1].Loops.push_back(wide);
  model.NumEdges = 7;
  model.NumVertices = 6;
  const TrimmedMesh mesh = Triangulated(model, Within(0.05));
  const MeshTopology topology = TopologyOf(mesh);
  EXPECT_TRUE(topology.Manifold);
  EXPECT_EQ(topology.Euler, 1);
  EXPECT_EQ(topology.BoundaryLoops, 1); // nothing open along the common edge
}

TEST(TriangulateFaces, ChordsOfACircleCountInTheBound_ExactOracle)
{
  TrimmedModel model = OneFace(Plane());
  AddClosed(
    model, model.Faces[0], Wavy({ 0.5, 0.5 }, 0.4, 0.0, 1, 1.0), KnotVector::Uniform(3, 80));
  for (double tolerance : { 5e-2, 1e-2, 1e-3 })
  {
    const TrimmedMesh mesh = Triangulated(model, Within(tolerance));
    const Eigen::RowVector2d middle(0.5, 0.5);
    double off = 0.0;
    for (const auto& t : mesh.Triangles)
    {
      for (std::size_t i = 0; i < 3; ++i)
      {
        const Eigen::RowVector2d a = mesh.Points.row(t[i]).head<2>() - middle;
        const Eigen::RowVector2d b = mesh.Points.row(t[(i + 1) % 3]).head<2>() - middle;
        const bool isNext = a.dot(b) > 0.0 && a[0] * b[1] - a[1] * b[0] > 0.0;
        const double sagitta = 0.4 - (0.5 * (a + b)).norm();
        const double half = Pi / static_cast<double>(mesh.Points.rows());
        if (isNext && sagitta < 2.0 * 0.4 * (1.0 - std::cos(half))) // a side of the polygon
        {
          off = std::max(off, sagitta);
        }
      }
    }
    EXPECT_GT(off, 0.0);
    EXPECT_LE(off, mesh.Bound);
    EXPECT_LE(mesh.Bound, tolerance);
    EXPECT_NEAR(Area(mesh), 0.16 * Pi, 0.8 * Pi * tolerance);
  }
}

TEST(TriangulateFaces, RandomFacesKeepTheirBound_PropertyOracle)
{
  // Polynomial and rational surfaces of degrees 1 to 4, with creases; edges interpolate the
  // surface, so at creases they are off it.
  for (int seed = 1; seed <= 25; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const bool rational = random.Int(0, 1) > 0;
    const auto space = RandomTensorSpace<2>(random, random.Int(1, 4), random.Int(1, 6));
    TrimmedModel model = OneFace(RandomSpline<2>(random, space, 3, rational));
    TrimmedFace& face = model.Faces[0];
    face.Surface.ControlPoints.leftCols(2) = GrevillePoints<2>(*space);
    face.Surface.ControlPoints.col(2) *= random.In(0.0, 0.2);
    const ParametricBox<2> box = space->Domain();
    const auto star = [&](double x, double y, double radius, double turns) -> Path
    {
      const double wave = random.In(0.0, 0.4);
      const double phase = random.In(0.0, 6.0);
      const int waves = random.Int(1, 9);
      return [=](double t) -> std::array<double, 2>
      {
        const double angle = 2.0 * Pi * turns * t;
        const double r = radius * (1.0 + wave * std::cos(waves * angle + phase)) / 1.4;
        return { box.Lower[0] + (box.Upper[0] - box.Lower[0]) * (x + r * std::cos(angle)),
          box.Lower[1] + (box.Upper[1] - box.Lower[1]) * (y + r * std::sin(angle)) };
      };
    };
    AddClosed(model, face, star(0.5, 0.5, 0.48, 1.0), KnotVector::Uniform(3, random.Int(60, 200)));
    const int holes = random.Int(0, 3);
    for (int k = 0; k < holes; ++k)
    {
      const double angle = 2.0 * Pi * k / 3;
      AddClosed(model, face,
        star(0.5 + 0.09 * std::cos(angle), 0.5 + 0.09 * std::sin(angle), 0.05, -1.0),
        KnotVector::Uniform(3, random.Int(20, 40)));
    }
    const TrimmedMesh mesh = Triangulated(model, Within(std::pow(10.0, random.In(-2.0, -0.5))));
    EXPECT_LE(SampledDeviation(model, mesh, 4), mesh.Bound);
    const MeshTopology topology = TopologyOf(mesh);
    EXPECT_TRUE(topology.Manifold);
    EXPECT_EQ(topology.Euler, 1 - holes);
    EXPECT_EQ(topology.BoundaryLoops, 1 + holes);
  }
}

TEST(SurfaceCells, BoundsHoldInAnyBox_PropertyOracle)
{
  for (int seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = RandomTensorSpace<2>(random, 4, 4);
    const BezierForm<2> form =
      MakeBezierForm(RandomSpline<2>(random, space, 3, random.Int(0, 1) > 0));
    const auto cells = SurfaceCells::Create(form, 0.5, 1000000, 1);
    ASSERT_TRUE(cells) << cells.Status.Message();
    for (int k = 0; k < 20; ++k)
    {
      ParametricBox<2> box;
      for (std::size_t d = 0; d < 2; ++d)
      {
        const ParametricBox<2> domain = space->Domain();
        const double a = random.In(domain.Lower[d], domain.Upper[d]);
        const double b = random.In(domain.Lower[d], domain.Upper[d]);
        box.Lower[d] = std::min(a, b);
        box.Upper[d] = std::max(a, b);
      }
      PointMatrix inside(30, 2);
      for (int i = 0; i < 30; ++i)
      {
        inside.row(i) << random.In(box.Lower[0], box.Upper[0]),
          random.In(box.Lower[1], box.Upper[1]);
      }
      EvaluationBatch batch;
      EvaluateParameters<2>(form, inside, { 2, 1 }, batch);
      const auto bounds = cells->Bound(box);
      const auto largest = [](const PointMatrix& values, int part)
      { return values.middleCols(3 * part, 3).rowwise().norm().maxCoeff(); };
      for (int d = 0; d < 2; ++d) // rounding: some hundred operations
      {
        EXPECT_LE(largest(batch.First, d), bounds.First[static_cast<std::size_t>(d)] * (1 + 1e-12));
      }
      for (int d = 0; d < 3; ++d)
      {
        EXPECT_LE(largest(batch.Second, d),
          bounds.Second[static_cast<std::size_t>(d)] * (1 + 1e-12) + 1e-11);
      }
    }
  }
}

TEST(TriangulateFaces, HoleBesideACoarseChordStaysInside_PropertyOracle)
{
  // The tolerance allows four chords for the outer circle, which leave the hole outside.
  TrimmedModel model = OneFace(Plane());
  TrimmedFace& face = model.Faces[0];
  AddClosed(model, face, Wavy({ 0.5, 0.5 }, 0.45, 0.0, 1, 1.0), KnotVector::Uniform(3, 40));
  const double diagonal = 0.5 + 0.42 / std::sqrt(2.0);
  AddClosed(
    model, face, Wavy({ diagonal, diagonal }, 0.01, 0.0, 1, -1.0), KnotVector::Uniform(3, 10));
  const TrimmedMesh mesh = Triangulated(model, Within(1.0));
  const MeshTopology topology = TopologyOf(mesh);
  EXPECT_TRUE(topology.Manifold);
  EXPECT_EQ(topology.Euler, 0);
  EXPECT_EQ(topology.BoundaryLoops, 2);
}

TEST(TriangulateFaces, CreasesAreFollowed_ExactOracle)
{
  // A roof of degree 1: triangles that keep to its ridge are exact.
  Spline<2> roof;
  roof.Space = MakeTensorSpace<2>({ KnotVector::Uniform(1, 2), KnotVector::Uniform(1, 1) }).Value;
  roof.ControlPoints.resize(6, 3);
  roof.ControlPoints << 0, 0, 0, 0.5, 0, 0.5, 1, 0, 0, 0, 1, 0, 0.5, 1, 0.5, 1, 1, 0;
  TrimmedModel model = OneFace(roof);
  // Edges run across the ridge: broken at it, as their splines are.
  AddPolygon(model, model.Faces[0], { { 0.1, 0.2 }, { 0.9, 0.2 }, { 0.9, 0.8 }, { 0.1, 0.8 } },
    KnotVector::Uniform(1, 2));
  const TrimmedMesh mesh = Triangulated(model, Within(1e-6));
  EXPECT_LE(mesh.Bound, 1e-6);
  EXPECT_LE(SampledDeviation(model, mesh), 1e-12);
  EXPECT_NEAR(Area(mesh), 0.8 * 0.6 * std::sqrt(2.0), 1e-12);
  EXPECT_LE(mesh.Triangles.size(), 40u);
}

TEST(TriangulateFaces, EdgesOffTheSurfaceCountInTheBound_ExactOracle)
{
  TrimmedModel model = OneFace(Plane());
  AddPolygon(model, model.Faces[0], { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
  for (TrimmingCurve& curve : model.Faces[0].Loops[0].Curves)
  {
    curve.Curve.ControlPoints.col(2).setConstant(0.25);
  }
  const TrimmedMesh mesh = Triangulated(model, Within(1e-3));
  EXPECT_NEAR(mesh.Bound, 0.25, 1e-12);
  EXPECT_EQ(mesh.Points.col(2).minCoeff(), 0.25);
}

TEST(TriangulateFaces, MaxTrianglesIsKeptAndTheBoundStaysTrue_PropertyOracle)
{
  const TrimmedModel model = HillsWithHole(3);
  double last = 1e300;
  for (int most : { 40, 200, 1000, 5000 })
  {
    SCOPED_TRACE(most);
    TrimmedMeshParams params = Within(1e-7);
    params.MaxTriangles = most;
    const TrimmedMesh mesh = Triangulated(model, params);
    EXPECT_LE(mesh.Triangles.size(), static_cast<std::size_t>(most));
    EXPECT_GE(mesh.Triangles.size(), static_cast<std::size_t>(most) / 8);
    EXPECT_GT(mesh.Bound, params.Tolerance);
    EXPECT_LE(SampledDeviation(model, mesh), mesh.Bound);
    EXPECT_LT(mesh.Bound, last);
    last = mesh.Bound;
    EXPECT_TRUE(TopologyOf(mesh).Manifold);
  }
}

TEST(TriangulateFaces, AnyNumberOfThreadsGivesTheSameBits_PropertyOracle)
{
  TrimmedModel model = HillsWithHole(2);
  const TrimmedModel other = CylinderWithLid();
  for (TrimmedFace face : other.Faces)
  {
    for (TrimmingCurve& curve : face.Loops[0].Curves)
    {
      curve.Edge += model.NumEdges;
      curve.Vertices = { curve.Vertices[0] + model.NumVertices,
        curve.Vertices[1] + model.NumVertices };
    }
    model.Faces.push_back(face);
  }
  model.NumEdges += other.NumEdges;
  model.NumVertices += other.NumVertices;
  TrimmedMeshParams params = Within(2e-4);
  params.Threads = 1;
  const TrimmedMesh one = Triangulated(model, params);
  for (int threads : { 2, 4, 0 })
  {
    params.Threads = threads;
    const TrimmedMesh many = Triangulated(model, params);
    EXPECT_EQ(one.Points, many.Points);
    EXPECT_EQ(one.Normals, many.Normals);
    EXPECT_EQ(one.Triangles, many.Triangles);
    EXPECT_EQ(one.TriangleUV, many.TriangleUV);
    EXPECT_EQ(one.Bound, many.Bound);
  }
}

TEST(TriangulateFaces, EveryFailureIsReachable)
{
  const auto code = [](const TrimmedModel& model, const TrimmedMeshParams& params)
  { return TriangulateFaces(model, params).Status.Code; };
  EXPECT_EQ(code({}, Within(1e-3)), ErrorCode::EmptyInput);

  TrimmedModel square = OneFace(Plane());
  AddPolygon(square, square.Faces[0], { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
  EXPECT_EQ(code(square, Within(0.0)), ErrorCode::InvalidParameter);
  EXPECT_EQ(code(square, Within(std::nan(""))), ErrorCode::InvalidParameter);
  TrimmedMeshParams params = Within(1e-3);
  params.MaxTriangles = 0;
  EXPECT_EQ(code(square, params), ErrorCode::InvalidParameter);
  params.MaxTriangles = 1; // two are the fewest
  EXPECT_EQ(code(square, params), ErrorCode::TooLarge);
  params.MaxTriangles = 2;
  EXPECT_EQ(code(square, params), ErrorCode::Ok);
  params.Progress = [](double) { return false; };
  EXPECT_EQ(code(square, params), ErrorCode::Aborted);

  TrimmedModel eight = OneFace(Plane());
  AddPolygon(eight, eight.Faces[0], { { 0, 0 }, { 1, 1 }, { 1, 0 }, { 0, 1 } });
  EXPECT_EQ(code(eight, Within(1e-3)), ErrorCode::InvalidTopology);

  TrimmedModel clockwise = OneFace(Plane());
  AddPolygon(clockwise, clockwise.Faces[0], { { 0, 0 }, { 0, 1 }, { 1, 1 }, { 1, 0 } });
  EXPECT_EQ(code(clockwise, Within(1e-3)), ErrorCode::InvalidTopology);

  TrimmedModel outside = OneFace(Plane());
  AddPolygon(outside, outside.Faces[0], { { 0, 0 }, { 0.4, 0 }, { 0.4, 1 }, { 0, 1 } });
  AddPolygon(outside, outside.Faces[0], { { 0.6, 0.4 }, { 0.6, 0.6 }, { 0.8, 0.6 }, { 0.8, 0.4 } });
  EXPECT_EQ(code(outside, Within(1e-3)), ErrorCode::InvalidTopology);

  TrimmedModel twice = square; // an edge over itself
  twice.Faces[0].Loops.push_back(twice.Faces[0].Loops[0]);
  EXPECT_EQ(code(twice, Within(1e-3)), ErrorCode::InvalidTopology);

  TrimmedModel different = CylinderWithLid(); // uses of an edge that are not the same curve
  different.Faces[1].Loops[0].Curves[0].Curve.Space =
    MakeTensorSpace<1>({ KnotVector::Uniform(3, 1, 0.0, 2.0) }).Value;
  EXPECT_EQ(code(different, Within(1e-3)), ErrorCode::InvalidTopology);
}
