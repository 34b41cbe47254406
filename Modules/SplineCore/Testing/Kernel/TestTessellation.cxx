// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SplineCore/Tessellation.h>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

namespace
{
using namespace knotwork;
using Vector = Eigen::RowVector3d;

template <int Dim>
std::vector<BezierForm<Dim>> Forms(const ShapeParams& params)
{
  std::vector<BezierForm<Dim>> forms;
  const Result<std::vector<AnySpline>> shape = MakeShape(params);
  EXPECT_TRUE(shape) << shape.Status.Message();
  for (const AnySpline& patch : shape.Value)
  {
    forms.push_back(MakeBezierForm<Dim>(std::get<Spline<Dim>>(patch), 1));
  }
  return forms;
}

ShapeParams Shape(ShapeKind kind, double angle = 360.0, std::array<int, 3> elements = { 1, 1, 1 })
{
  ShapeParams params;
  params.Kind = kind;
  params.Angle = angle;
  params.Elements = elements;
  return params;
}

TessellationParams Tolerance(double tolerance)
{
  TessellationParams params;
  params.Tolerance = tolerance;
  return params;
}

/// Bilinear or linear samples of all polygons.
std::vector<Vector> SampleCells(const TessellationMesh& mesh, int n)
{
  std::vector<Vector> samples;
  for (std::size_t c = 0; c < mesh.Shapes.size(); ++c)
  {
    const auto corner = [&](int k) -> Vector
    { return mesh.Points.row(mesh.Connectivity[std::size_t(mesh.Offsets[c] + k)]); };
    for (int i = 0; i <= n; ++i)
    {
      for (int j = 0; j <= n; ++j)
      {
        const double s = double(i) / n;
        const double t = double(j) / n;
        if (mesh.Shapes[c] == TessellationShape::Quadrilateral)
        {
          samples.push_back((1 - s) * ((1 - t) * corner(0) + t * corner(3)) +
            s * ((1 - t) * corner(1) + t * corner(2)));
        }
        else if (i + j <= n)
        {
          samples.push_back((1 - s - t) * corner(0) + s * corner(1) + t * corner(2));
        }
      }
    }
  }
  return samples;
}

/// Directed edges of the polygons; a closed, oriented surface has each once with its reverse.
std::map<std::pair<std::int64_t, std::int64_t>, int> Edges(const TessellationMesh& mesh)
{
  std::map<std::pair<std::int64_t, std::int64_t>, int> edges;
  for (std::size_t c = 0; c < mesh.Shapes.size(); ++c)
  {
    for (std::int64_t k = mesh.Offsets[c]; k < mesh.Offsets[c + 1]; ++k)
    {
      const std::int64_t next = k + 1 < mesh.Offsets[c + 1] ? k + 1 : mesh.Offsets[c];
      ++edges[{ mesh.Connectivity[std::size_t(k)], mesh.Connectivity[std::size_t(next)] }];
    }
  }
  return edges;
}

/// Number of edges without exactly one partner of opposite direction.
int OpenEdges(const TessellationMesh& mesh)
{
  const auto edges = Edges(mesh);
  int open = 0;
  for (const auto& [edge, count] : edges)
  {
    const auto reverse = edges.find({ edge.second, edge.first });
    open += count == 1 && reverse != edges.end() && reverse->second == 1 ? 0 : 1;
  }
  return open;
}

long EulerCharacteristic(const TessellationMesh& mesh)
{
  std::set<std::int64_t> used(mesh.Connectivity.begin(), mesh.Connectivity.end());
  return long(used.size()) - long(Edges(mesh).size() / 2) + long(mesh.Shapes.size());
}

double SphereDistance(const Vector& x)
{
  return std::abs(x.norm() - 1.0);
}
double TorusDistance(const Vector& x) // OuterRadius 1, InnerRadius 0.5
{
  return std::abs(std::hypot(std::hypot(x[0], x[1]) - 1.0, x[2]) - 0.5);
}

double Deviation(const TessellationMesh& mesh, double (*distance)(const Vector&))
{
  double largest = 0.0;
  for (const Vector& sample : SampleCells(mesh, 6))
  {
    largest = std::max(largest, distance(sample));
  }
  return largest;
}
}

TEST(Tessellate, DeviationOfSphereAndTorusIsBelowTolerance_ExactOracle)
{
  for (const double tolerance : { 1e-1, 1e-2, 1e-3 })
  {
    for (const auto& [kind, distance] : { std::pair{ ShapeKind::SphereSurface, &SphereDistance },
           std::pair{ ShapeKind::PolarSphereSurface, &SphereDistance },
           std::pair{ ShapeKind::TorusSurface, &TorusDistance } })
    {
      SCOPED_TRACE(std::string(ToString(kind)) + " " + std::to_string(tolerance));
      const auto mesh = Tessellate<2>(Forms<2>(Shape(kind)), Tolerance(tolerance));
      ASSERT_TRUE(mesh) << mesh.Status.Message();
      const double deviation = Deviation(mesh.Value, distance);
      EXPECT_LE(mesh->Bound, tolerance);
      EXPECT_LE(deviation, mesh->Bound); // rounding is far below the slack of the bound
      EXPECT_GE(deviation, tolerance / 60.0) << "far more cells than the tolerance asks for";
    }
  }
}

TEST(Tessellate, LinearInterpolationStaysWithinBound_PropertyOracle)
{
  // Hexahedra and lines: samples at equal convex combinations, the strong form of the promise.
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1.0, 1.0);
    Spline<3> spline;
    spline.Space = MakeTensorSpace<3>(
      { KnotVector::Uniform(2, 2), KnotVector::Uniform(3, 1), KnotVector::Uniform(1, 2) })
                     .Value;
    spline.ControlPoints = PointMatrix::NullaryExpr(
      spline.Space->NumFunctions, 3, [&](Eigen::Index, Eigen::Index) { return real(random); });
    spline.Weights = Eigen::VectorXd::NullaryExpr(
      spline.Space->NumFunctions, [&](Eigen::Index) { return 1.5 + real(random); });
    const BezierForm<3> form = MakeBezierForm<3>(spline, 1);
    TessellationParams params = Tolerance(0.3);
    params.MaximumSubdivision = 3;
    params.Output = TessellationOutput::Volume;
    const auto mesh = Tessellate<3>({ form }, params);
    ASSERT_TRUE(mesh) << mesh.Status.Message();
    // Corners of a cell in the parameters of its own element.
    double largest = 0.0;
    EvaluationBatch batch;
    for (std::size_t c = 0; c < mesh->Shapes.size(); c += 7)
    {
      const int element = mesh->CellElement[c];
      const auto& box = spline.Space->Elements[std::size_t(element)].Box;
      PointMatrix parameters(8, 3);
      PointMatrix corners(8, 3);
      for (int k = 0; k < 8; ++k)
      {
        const auto p = std::size_t(mesh->Connectivity[std::size_t(mesh->Offsets[c] + k)]);
        corners.row(k) = mesh->Points.row(Eigen::Index(p));
        const auto& owner = spline.Space->Elements[std::size_t(mesh->PointElement[p])].Box;
        for (std::size_t d = 0; d < 3; ++d)
        {
          const double u = owner.Lower[d] +
            mesh->PointLocal(Eigen::Index(p), Eigen::Index(d)) * (owner.Upper[d] - owner.Lower[d]);
          parameters(k, Eigen::Index(d)) = (u - box.Lower[d]) / (box.Upper[d] - box.Lower[d]);
        }
      }
      PointMatrix lambda(20, 8);
      for (Eigen::Index i = 0; i < lambda.rows(); ++i)
      {
        for (Eigen::Index k = 0; k < 8; ++k)
        {
          lambda(i, k) = -std::log(0.5 * (1.0 + real(random)) + 1e-12);
        }
        lambda.row(i) /= lambda.row(i).sum();
      }
      const PointMatrix local = (lambda * parameters).cwiseMax(0.0).cwiseMin(1.0);
      ASSERT_TRUE(EvaluateElements<3>(form, std::vector<int>(20, element), local, {}, batch));
      largest = std::max(largest, (lambda * corners - batch.Values).rowwise().norm().maxCoeff());
    }
    EXPECT_LE(largest, mesh->Bound);
    EXPECT_GT(largest, mesh->Bound / 1000.0);
  }
}

TEST(Tessellate, ClosedSurfacesAreWatertight_PropertyOracle)
{
  for (const double tolerance : { 0.2, 0.003 })
  {
    for (const auto& [kind, euler] : { std::pair{ ShapeKind::SphereSurface, 2 },
           std::pair{ ShapeKind::PolarSphereSurface, 2 }, std::pair{ ShapeKind::TorusSurface, 0 } })
    {
      SCOPED_TRACE(ToString(kind));
      const auto mesh =
        Tessellate<2>(Forms<2>(Shape(kind, 360.0, { 3, 2, 1 })), Tolerance(tolerance));
      ASSERT_TRUE(mesh) << mesh.Status.Message();
      EXPECT_EQ(OpenEdges(mesh.Value), 0);
      EXPECT_EQ(EulerCharacteristic(mesh.Value), euler);
    }
    for (const auto& [kind, euler] : { std::pair{ ShapeKind::Ball, 2 },
           std::pair{ ShapeKind::SolidCylinder, 2 }, std::pair{ ShapeKind::SolidTube, 0 },
           std::pair{ ShapeKind::TwistedBar, 2 }, std::pair{ ShapeKind::SolidTorus, 0 } })
    {
      SCOPED_TRACE(ToString(kind));
      const auto mesh =
        Tessellate<3>(Forms<3>(Shape(kind, 360.0, { 2, 3, 1 })), Tolerance(tolerance));
      ASSERT_TRUE(mesh) << mesh.Status.Message();
      EXPECT_EQ(OpenEdges(mesh.Value), 0);
      EXPECT_EQ(EulerCharacteristic(mesh.Value), euler);
    }
  }
}

TEST(Tessellate, HierarchicalLevelsAreWatertight_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto shape = MakeShape(Shape(ShapeKind::TorusSurface, 360.0, { 2, 1, 1 }));
    ASSERT_TRUE(shape);
    Spline<2> torus = std::get<Spline<2>>(shape.Value[0]);
    for (int step = 0; step < 4; ++step)
    {
      const int n = torus.Space->NumElements();
      const auto finer = RefineElements<2>(
        torus.Space, { int(random() % unsigned(n)), int(random() % unsigned(n)) });
      ASSERT_TRUE(finer) << finer.Status.Message();
      const auto moved = TransferToRefined<2>(torus, finer.Value);
      ASSERT_TRUE(moved) << moved.Status.Message();
      torus = moved.Value;
    }
    const auto mesh = Tessellate<2>({ MakeBezierForm<2>(torus, 1) }, Tolerance(0.05));
    ASSERT_TRUE(mesh) << mesh.Status.Message();
    // The seams agree element by element only where both sides have the same levels.
    int interior = 0;
    const auto edges = Edges(mesh.Value);
    for (const auto& [edge, count] : edges)
    {
      EXPECT_EQ(count, 1);
      if (!edges.count({ edge.second, edge.first }))
      {
        const auto onSeam = [&](std::int64_t p)
        {
          const auto& box =
            torus.Space->Elements[std::size_t(mesh->PointElement[std::size_t(p)])].Box;
          const auto domain = torus.Space->Domain();
          bool on = false;
          for (std::size_t d = 0; d < 2; ++d)
          {
            const double t = mesh->PointLocal(p, Eigen::Index(d));
            on = on || (t == 0.0 && box.Lower[d] == domain.Lower[d]) ||
              (t == 1.0 && box.Upper[d] == domain.Upper[d]);
          }
          return on;
        };
        interior += onSeam(edge.first) && onSeam(edge.second) ? 0 : 1;
      }
    }
    EXPECT_EQ(interior, 0);
    EXPECT_LE(Deviation(mesh.Value, TorusDistance), 0.05);
  }
}

TEST(Tessellate, HexahedraConformAndFillTheVolume_ExactOracle)
{
  TessellationParams params = Tolerance(1e-2);
  params.Output = TessellationOutput::Volume;
  for (const auto& [kind, exact] :
    { std::pair{ ShapeKind::Ball, 4.0 / 3.0 * M_PI }, std::pair{ ShapeKind::SolidCylinder, M_PI },
      std::pair{ ShapeKind::SolidTube, 0.75 * M_PI } })
  {
    SCOPED_TRACE(ToString(kind));
    const auto mesh = Tessellate<3>(Forms<3>(Shape(kind)), params);
    ASSERT_TRUE(mesh) << mesh.Status.Message();
    // Faces: twice inside, once outside; the volume by the divergence theorem over all faces.
    const int faces[6][4] = { { 0, 3, 2, 1 }, { 4, 5, 6, 7 }, { 0, 1, 5, 4 }, { 1, 2, 6, 5 },
      { 2, 3, 7, 6 }, { 3, 0, 4, 7 } };
    std::map<std::set<std::int64_t>, int> count;
    double volume = 0.0;
    for (std::size_t c = 0; c < mesh->Shapes.size(); ++c)
    {
      for (const auto& face : faces)
      {
        std::set<std::int64_t> corners;
        std::array<Vector, 4> x;
        for (std::size_t k = 0; k < 4; ++k)
        {
          const std::int64_t p = mesh->Connectivity[std::size_t(mesh->Offsets[c] + face[k])];
          corners.insert(p);
          x[k] = mesh->Points.row(p);
        }
        ++count[corners];
        volume += (x[0].dot(x[1].cross(x[2])) + x[0].dot(x[2].cross(x[3]))) / 6.0;
      }
    }
    int outside = 0;
    const double bottom = mesh->Points.col(2).minCoeff();
    const double top = mesh->Points.col(2).maxCoeff();
    for (const auto& [corners, n] : count)
    {
      EXPECT_LE(n, 2);
      for (const std::int64_t p : corners)
      {
        const Vector x = mesh->Points.row(p);
        const double radius = kind == ShapeKind::Ball ? x.norm() : std::hypot(x[0], x[1]);
        const bool wall = std::abs(radius - 1.0) < 1e-9 ||
          (kind == ShapeKind::SolidTube && std::abs(radius - 0.5) < 1e-9);
        const bool rim =
          wall || (kind != ShapeKind::Ball && (x[2] - bottom < 1e-9 || top - x[2] < 1e-9));
        outside += n == 1 && !rim ? 1 : 0;
      }
    }
    EXPECT_EQ(outside, 0) << "a face inside the solid has one hexahedron only";
    // A chordal error d on an area A changes the volume by less than A d (A < 20 here).
    EXPECT_NEAR(volume, exact, 20.0 * params.Tolerance);
    EXPECT_GT(std::abs(volume - exact), 1e-9);
  }
}

TEST(Tessellate, NormalsAreExact_ExactOracle)
{
  const auto sphere =
    Tessellate<2>(Forms<2>(Shape(ShapeKind::PolarSphereSurface)), Tolerance(0.01));
  ASSERT_TRUE(sphere);
  ASSERT_EQ(sphere->Normals.rows(), sphere->Points.rows());
  for (Eigen::Index i = 0; i < sphere->Points.rows(); ++i)
  {
    const Vector x = sphere->Points.row(i);
    // At the poles the limit is taken 1e-4 of an element away.
    const double tolerance = std::abs(x[2]) > 1.0 - 1e-12 ? 3e-4 : 1e-12;
    EXPECT_LE((sphere->Normals.row(i) - x).norm(), tolerance);
  }
  // Outward on all six sides of a solid; with splitting exact on both sides of its creases.
  TessellationParams params = Tolerance(0.01);
  params.Splitting = true;
  const auto cube = Tessellate<3>(Forms<3>(Shape(ShapeKind::Cube)), params);
  ASSERT_TRUE(cube);
  EXPECT_EQ(cube->Points.rows(), 24);
  for (Eigen::Index i = 0; i < cube->Points.rows(); ++i)
  {
    const Vector n = cube->Normals.row(i);
    EXPECT_NEAR(n.cwiseAbs().maxCoeff(), 1.0, 1e-12);
    const Vector x = cube->Points.row(i);
    Eigen::Index axis = 0;
    n.cwiseAbs().maxCoeff(&axis);
    EXPECT_NEAR(x[axis], 0.5 * (1.0 + n[axis]), 1.0) << "on the side the normal points to";
    EXPECT_GT(n[axis] * (x[axis] - cube->Points.col(axis).mean()), 0.0);
  }
  params.Splitting = false;
  EXPECT_EQ(Tessellate<3>(Forms<3>(Shape(ShapeKind::Cube)), params)->Points.rows(), 8);
}

TEST(Tessellate, FlatIsNotSubdivided_GoldenOracle)
{
  const auto square =
    Tessellate<2>(Forms<2>(Shape(ShapeKind::Square, 90.0, { 4, 3, 1 })), Tolerance(1e-9));
  ASSERT_TRUE(square);
  EXPECT_EQ(square->Shapes.size(), 12u);
  EXPECT_EQ(square->Points.rows(), 20);
  // Quarter circle of radius 1: n chords deviate by 1 - cos(pi / (4 n)) in the best case.
  const auto arc = Tessellate<1>(Forms<1>(Shape(ShapeKind::Arc, 90.0)), Tolerance(1e-3));
  ASSERT_TRUE(arc);
  EXPECT_GE(arc->Shapes.size(), 18u);
  EXPECT_LE(arc->Shapes.size(), 64u);
}

TEST(Tessellate, ClosedCurveIsOneLoop_PropertyOracle)
{
  const auto circle = Tessellate<1>(Forms<1>(Shape(ShapeKind::Arc)), Tolerance(1e-3));
  ASSERT_TRUE(circle);
  EXPECT_EQ(circle->Points.rows(), Eigen::Index(circle->Shapes.size()));
}

TEST(Tessellate, ThreadsGiveTheSameBits_PropertyOracle)
{
  TessellationParams params = Tolerance(1e-3);
  params.Threads = 1;
  const auto one = Tessellate<2>(Forms<2>(Shape(ShapeKind::TorusSurface)), params);
  params.Threads = 2;
  const auto two = Tessellate<2>(Forms<2>(Shape(ShapeKind::TorusSurface)), params);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->Points, two->Points);
  EXPECT_EQ(one->Normals, two->Normals);
  EXPECT_EQ(one->Connectivity, two->Connectivity);
}

TEST(Tessellate, TheFinestOfManySolidsInARowDecides_ExactOracle)
{
  std::vector<BezierForm<3>> row;
  for (int i = 0; i < 1500; ++i)
  {
    ShapeParams cube = Shape(ShapeKind::Cube);
    cube.Degree = 2;
    cube.Center = { double(i), 0.0, 0.0 };
    row.push_back(Forms<3>(cube).front());
  }
  for (const bool isFirst : { true, false })
  {
    std::vector<BezierForm<3>> forms = row;
    BezierForm<3>& finest = isFirst ? forms.front() : forms.back();
    // the middle of its far side is pulled out
    finest.Block(0)[(isFirst ? 0 : 2) + 3 * 4] += isFirst ? -0.5 : 0.5;
    TessellationParams params = Tolerance(0.02);
    params.Output = TessellationOutput::Volume;
    const auto mesh = Tessellate<3>(forms, params);
    ASSERT_TRUE(mesh);
    std::vector<Eigen::Index> cells(forms.size(), 0);
    for (const int patch : mesh->CellPatch)
    {
      ++cells[std::size_t(patch)];
    }
    const auto across = Eigen::Index(std::lround(std::sqrt(double(cells[1])))); // along y, z
    EXPECT_GT(across, 1);
    Eigen::Index along = 0;
    for (const Eigen::Index n : cells)
    {
      EXPECT_EQ(n % (across * across), 0);
      along += n / (across * across);
    }
    EXPECT_EQ(mesh->Points.rows(), (along + 1) * (across + 1) * (across + 1));
  }
}

TEST(Tessellate, ProgressGrows_PropertyOracle)
{
  std::vector<double> told;
  TessellationParams params = Tolerance(1e-5);
  params.Progress = [&told](double progress)
  {
    told.push_back(progress);
    return true;
  };
  ASSERT_TRUE(Tessellate<2>(Forms<2>(Shape(ShapeKind::TorusSurface)), params));
  EXPECT_GE(told.size(), 3U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_LE(told.back(), 1.0);
}

/// Joins the parts of a tessellation: what comes one after the other, and points by their numbers.
template <int Dim>
void ExpectPartsAreTheWhole(const std::vector<BezierForm<Dim>>& forms, TessellationParams params,
  int parts, const TessellationParams& ofWhole)
{
  const auto whole = Tessellate<Dim>(forms, ofWhole);
  ASSERT_TRUE(whole);
  TessellationMesh joined;
  joined.Offsets.push_back(0);
  params.Parts = parts;
  for (params.Part = 0; params.Part < parts; ++params.Part)
  {
    const auto part = Tessellate<Dim>(forms, params);
    ASSERT_TRUE(part);
    const std::size_t count = part->PointPatch.size();
    const std::size_t own = count - part->SharedPoints.size();
    EXPECT_EQ(part->FirstPoint, std::int64_t(joined.PointPatch.size()));
    EXPECT_EQ(part->NumPointsOfAll, whole->Points.rows());
    EXPECT_EQ(part->Bound, whole->Bound);
    std::vector<std::int64_t> numbers;
    for (std::size_t i = 0; i < count; ++i)
    {
      numbers.push_back(i < own ? part->FirstPoint + std::int64_t(i) : part->SharedPoints[i - own]);
      EXPECT_EQ(part->Points.row(Eigen::Index(i)), whole->Points.row(numbers.back()));
      EXPECT_EQ(part->PointLocal.row(Eigen::Index(i)), whole->PointLocal.row(numbers.back()));
      EXPECT_EQ(part->PointPatch[i], whole->PointPatch[std::size_t(numbers.back())]);
      EXPECT_EQ(part->PointElement[i], whole->PointElement[std::size_t(numbers.back())]);
      if (whole->Normals.rows() > 0)
      {
        EXPECT_EQ(part->Normals.row(Eigen::Index(i)), whole->Normals.row(numbers.back()));
      }
    }
    const auto append = [](auto& to, const auto& from, std::size_t n)
    { to.insert(to.end(), from.begin(), from.begin() + std::ptrdiff_t(n)); };
    append(joined.PointPatch, part->PointPatch, own);
    append(joined.Shapes, part->Shapes, part->Shapes.size());
    append(joined.CellPatch, part->CellPatch, part->CellPatch.size());
    append(joined.CellElement, part->CellElement, part->CellElement.size());
    append(joined.CellSide, part->CellSide, part->CellSide.size());
    for (const std::int64_t corner : part->Connectivity)
    {
      joined.Connectivity.push_back(numbers[std::size_t(corner)]);
    }
    const std::int64_t before = joined.Offsets.back();
    for (std::size_t c = 1; c < part->Offsets.size(); ++c)
    {
      joined.Offsets.push_back(before + part->Offsets[c]);
    }
  }
  EXPECT_EQ(joined.PointPatch, whole->PointPatch);
  EXPECT_EQ(joined.Shapes, whole->Shapes);
  EXPECT_EQ(joined.Offsets, whole->Offsets);
  EXPECT_EQ(joined.Connectivity, whole->Connectivity);
  EXPECT_EQ(joined.CellPatch, whole->CellPatch);
  EXPECT_EQ(joined.CellElement, whole->CellElement);
  EXPECT_EQ(joined.CellSide, whole->CellSide);
}

/// The bounds that the parts tell each other, as every part makes them first.
template <int Dim>
std::vector<double> BoundsOfParts(
  const std::vector<BezierForm<Dim>>& forms, TessellationParams params, int parts)
{
  std::vector<double> all;
  params.Parts = parts;
  for (params.Part = 0; params.Part < parts; ++params.Part)
  {
    params.Exchange = [&](const std::vector<double>& own)
    {
      all.insert(all.end(), own.begin(), own.end());
      return std::vector<double>(); // the others have failed
    };
    EXPECT_EQ(Tessellate<Dim>(forms, params).Status.Code, ErrorCode::Aborted);
  }
  return all;
}

template <int Dim>
void ExpectPartsThatShareBoundsAreTheWhole(
  const std::vector<BezierForm<Dim>>& forms, TessellationParams params, int parts)
{
  const std::vector<double> bounds = BoundsOfParts<Dim>(forms, params, parts);
  std::size_t told = 0;
  params.Exchange = [&](const std::vector<double>& own)
  {
    told += own.size();
    return bounds;
  };
  auto whole = params;
  whole.Exchange = nullptr;
  ExpectPartsAreTheWhole<Dim>(forms, params, parts, whole);
  EXPECT_EQ(told, bounds.size()); // each part has made its share alone
}

TEST(Tessellate, PartsThatShareBoundsAreTheWhole_ExactOracle)
{
  for (const int parts : { 2, 3, 40 })
  {
    TessellationParams params = Tolerance(3e-2);
    ExpectPartsThatShareBoundsAreTheWhole<2>(
      Forms<2>(Shape(ShapeKind::TorusSurface)), params, parts);
    ExpectPartsThatShareBoundsAreTheWhole<3>(Forms<3>(Shape(ShapeKind::Ball)), params, parts);
    params.Output = TessellationOutput::Volume;
    ExpectPartsThatShareBoundsAreTheWhole<3>(Forms<3>(Shape(ShapeKind::Ball)), params, parts);
  }
}

TEST(Tessellate, PartsAreTheWhole_ExactOracle)
{
  for (const int parts : { 2, 3, 40 }) // more than there are elements, too
  {
    for (const bool splits : { false, true })
    {
      TessellationParams params = Tolerance(3e-2);
      params.Splitting = splits;
      ExpectPartsAreTheWhole<1>(Forms<1>(Shape(ShapeKind::Arc)), params, parts, params);
      ExpectPartsAreTheWhole<2>(Forms<2>(Shape(ShapeKind::TorusSurface)), params, parts, params);
      ExpectPartsAreTheWhole<2>(
        Forms<2>(Shape(ShapeKind::PolarSphereSurface)), params, parts, params);
      ExpectPartsAreTheWhole<3>(Forms<3>(Shape(ShapeKind::Ball)), params, parts, params);
      params.Output = TessellationOutput::Volume;
      ExpectPartsAreTheWhole<3>(Forms<3>(Shape(ShapeKind::Ball)), params, parts, params);
    }
  }
}

TEST(Tessellate, EveryFailureIsReachable)
{
  const auto forms = Forms<2>(Shape(ShapeKind::Disc));
  EXPECT_EQ(Tessellate<2>({}, {}).Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(Tessellate<2>(forms, Tolerance(0.0)).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(Tessellate<2>(forms, Tolerance(NAN)).Status.Code, ErrorCode::InvalidParameter);
  TessellationParams params;
  params.MaximumSubdivision = 11;
  EXPECT_EQ(Tessellate<2>(forms, params).Status.Code, ErrorCode::InvalidParameter);
  params = Tolerance(1e-2);
  params.Part = 1;
  EXPECT_EQ(Tessellate<2>(forms, params).Status.Code, ErrorCode::InvalidParameter);
  auto broken = forms;
  broken[3].Block(0)[1] = NAN;
  const Status nonFinite = Tessellate<2>(broken).Status;
  EXPECT_EQ(nonFinite.Code, ErrorCode::NonFiniteInput);
  EXPECT_NE(nonFinite.Detail.find("patch 3"), std::string::npos) << nonFinite.Detail;
  broken = forms;
  broken[1].Data.back() = -1.0;
  EXPECT_EQ(Tessellate<2>(broken).Status.Code, ErrorCode::InvalidWeight);
  broken = forms;
  broken[0].NumComponents = 1;
  EXPECT_FALSE(Tessellate<2>(broken));
  params = Tolerance(1e-12);
  params.MaximumSubdivision = 10;
  EXPECT_EQ(
    Tessellate<2>(Forms<2>(Shape(ShapeKind::TorusSurface, 360.0, { 8, 8, 1 })), params).Status.Code,
    ErrorCode::TooLarge);
  params = Tolerance(1e-2);
  params.Progress = [](double) { return false; };
  EXPECT_EQ(Tessellate<2>(forms, params).Status.Code, ErrorCode::Aborted);
  broken = forms;
  broken[2].Offsets.pop_back();
  const Status formless = Tessellate<2>(broken).Status;
  EXPECT_EQ(formless.Code, ErrorCode::SizeMismatch);
  EXPECT_NE(formless.Detail.find("patch 2"), std::string::npos) << formless.Detail;
  // The limit is no failure, the bound tells.
  params = Tolerance(1e-6);
  params.MaximumSubdivision = 1;
  const auto coarse = Tessellate<2>(forms, params);
  ASSERT_TRUE(coarse);
  EXPECT_GT(coarse->Bound, 1e-6);
}

// Whenever the callback asks for it, whatever is being done then.
template <int Dim>
void ExpectAbortAtEveryCall(const std::vector<BezierForm<Dim>>& forms)
{
  int calls = 0;
  TessellationParams params = Tolerance(1e-2);
  params.Progress = [&](double)
  {
    ++calls;
    return true;
  };
  ASSERT_TRUE(Tessellate<Dim>(forms, params));
  const int all = calls;
  ASSERT_GT(all, 1);
  for (int last = 1; last <= all; ++last)
  {
    calls = 0;
    params.Progress = [&](double) { return ++calls < last; };
    const auto result = Tessellate<Dim>(forms, params);
    EXPECT_EQ(result.Status.Code, ErrorCode::Aborted) << "call " << last << " of " << all;
    EXPECT_EQ(calls, last);
    EXPECT_EQ(result->Points.rows(), 0);
  }
}

TEST(Tessellate, AbortsAtEveryCall_PropertyOracle)
{
  ExpectAbortAtEveryCall<2>(Forms<2>(Shape(ShapeKind::Disc)));
  ExpectAbortAtEveryCall<3>(Forms<3>(Shape(ShapeKind::SolidCylinder)));
}
