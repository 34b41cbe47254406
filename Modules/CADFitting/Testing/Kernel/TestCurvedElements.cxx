// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedNodes.h"
#include "FitCases.h"
#include <knotwork/CADFitting/CurvedElements.h>
#include <knotwork/SplineCore/LatticeInterpolation.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <set>

using namespace knotwork;

namespace
{
constexpr double Pi = static_cast<double>(EIGEN_PI);
constexpr CellShape Shapes[] = { CellShape::Quadrilateral, CellShape::Hexahedron,
  CellShape::Triangle, CellShape::Tetrahedron, CellShape::Wedge };

template <int Dim>
StraightElements FromCells(const fits::PlacedMesh<Dim>& mesh)
{
  StraightElements elements;
  elements.Points = mesh.Points;
  for (int c = 0; c < mesh.Mesh.NumCells(); ++c)
  {
    const int* corners = mesh.Mesh.Cell(c);
    elements.Add(Dim == 2 ? CellShape::Quadrilateral : CellShape::Hexahedron,
      { corners, corners + (1 << Dim) });
  }
  return elements;
}

/// Quadrilaterals as two triangles each.
StraightElements Triangles(const StraightElements& quads)
{
  StraightElements triangles;
  triangles.Points = quads.Points;
  for (int e = 0; e < quads.NumElements(); ++e)
  {
    const int* c = quads.Corners.data() + quads.Begin[static_cast<std::size_t>(e)];
    triangles.Add(CellShape::Triangle, { c[0], c[1], c[3] });
    triangles.Add(CellShape::Triangle, { c[0], c[3], c[2] });
  }
  return triangles;
}

/// Every hexahedron as the pyramids of its lowest corner, divided along the diagonals from the
/// lowest corner of each face: conforming.
StraightElements Tetrahedra(const StraightElements& hexahedra)
{
  StraightElements cells;
  cells.Points = hexahedra.Points;
  for (int e = 0; e < hexahedra.NumElements(); ++e)
  {
    const int* c = hexahedra.Corners.data() + hexahedra.Begin[static_cast<std::size_t>(e)];
    const int apex = *std::min_element(c, c + 8);
    for (const FaceCorners& face : FacesOf(CellShape::Hexahedron))
    {
      std::array<int, 4> q{};
      for (std::size_t i = 0; i < 4; ++i)
      {
        q[i] = c[face[i]];
      }
      if (std::find(q.begin(), q.end(), apex) != q.end())
      {
        continue;
      }
      std::rotate(q.begin(), std::min_element(q.begin(), q.end()), q.end());
      cells.Add(CellShape::Tetrahedron, { q[0], q[2], q[1], apex });
      cells.Add(CellShape::Tetrahedron, { q[0], q[3], q[2], apex });
    }
  }
  return cells;
}

/// Elements over those of a plane, of unit height in layers.
StraightElements Extruded(const StraightElements& plane, int layers)
{
  StraightElements solid;
  const Eigen::Index n = plane.Points.rows();
  solid.Points = plane.Points.replicate(layers + 1, 1);
  for (int layer = 0; layer <= layers; ++layer)
  {
    solid.Points.middleRows(layer * n, n).col(2).array() = static_cast<double>(layer) / layers;
  }
  for (int layer = 0; layer < layers; ++layer)
  {
    for (std::size_t e = 0; e < plane.Shapes.size(); ++e)
    {
      std::vector<int> corners;
      for (int end = 0; end < 2; ++end)
      {
        for (std::size_t i = plane.Begin[e]; i < plane.Begin[e + 1]; ++i)
        {
          corners.push_back(plane.Corners[i] + (layer + end) * static_cast<int>(n));
        }
      }
      solid.Add(corners.size() == 6 ? CellShape::Wedge : CellShape::Hexahedron, corners);
    }
  }
  return solid;
}

StraightElements Cylinder(int n)
{
  return Extruded(Triangles(FromCells<2>(fits::Disc(n))), n);
}

/// Faces whose corners all lie at a distance from the third axis.
std::vector<FaceCorners> FacesAtRadius(const StraightElements& elements, double radius)
{
  std::vector<FaceCorners> found;
  for (const FaceCorners& face : NodeLattice(elements, 1).Faces)
  {
    const bool isAt = std::all_of(face.begin(), face.end(),
      [&](int corner) {
        return corner < 0 ||
          std::abs(elements.Points.row(corner).head<2>().norm() - radius) < 1e-12;
      });
    if (isAt)
    {
      found.push_back(face);
    }
  }
  return found;
}

FitTargetPtr UnitSphere()
{
  return fits::Ellipsoid(1.0, 1.0, 1.0);
}

/// log2 of the ratio of errors of meshes, the second with edges half as long.
double Rate(double coarse, double fine)
{
  return std::log2(std::abs(coarse / fine));
}

CurvedElements Curve(const StraightElements& elements, const FitTargetPtr& target, int order,
  const std::vector<FaceCorners>& facets = {})
{
  CurvedElementsParams params;
  params.Facets = facets;
  params.Order = order;
  const auto curved = CurveElements(elements, target.get(), params);
  EXPECT_TRUE(curved) << curved.Status.Message();
  EXPECT_EQ(curved->Certificate.NumValid, elements.NumElements());
  return curved.Value;
}

/// The elements of control points.
BernsteinCells CellsOf(const CurvedElements& curved, int order)
{
  BernsteinCells cells;
  cells.NumComponents = 3;
  for (std::size_t e = 0; e < curved.Shapes.size(); ++e)
  {
    const int cell = cells.Add(curved.Shapes[e], DegreeOf(curved.Shapes[e], order));
    const std::size_t count = curved.Begin[e + 1] - curved.Begin[e];
    for (std::size_t i = 0; i < count; ++i)
    {
      for (int d = 0; d < 3; ++d)
      {
        cells.Block(cell)[static_cast<std::size_t>(d) * count + i] =
          curved.Points(curved.Nodes[curved.Begin[e] + i], d);
      }
    }
  }
  return cells;
}
}

/// Points that are the values of a polynomial at the lattice give that polynomial.
TEST(NodeTable, BernsteinFormOfAPolynomial_ExactOracle)
{
  for (const CellShape shape : Shapes)
  {
    for (int order = 1; order <= 4; ++order)
    {
      const auto map = [order](const std::array<double, 3>& x)
      { return std::pow(x[0] + 2.0 * x[1] - x[2] + 0.3, order); };
      const CellDegree degree = DegreeOf(shape, order);
      const auto lattice = LatticeParameters(shape, degree);
      Eigen::VectorXd values(static_cast<Eigen::Index>(lattice.size()));
      for (std::size_t i = 0; i < lattice.size(); ++i)
      {
        values[static_cast<Eigen::Index>(i)] = map(lattice[i]);
      }
      const NodeTable table = MakeNodeTable(shape, order);
      BernsteinCells cells;
      cells.NumComponents = 1;
      cells.Add(shape, degree);
      const Eigen::VectorXd coefficients = table.ToBezier * values;
      std::copy(coefficients.begin(), coefficients.end(), cells.Block(0));
      for (std::array<double, 3> at : { std::array<double, 3>{ 0.2, 0.3, 0.1 }, { 0.5, 0.1, 0.3 } })
      {
        at[2] = NumParameters(shape) == 3 ? at[2] : 0.0;
        double found = 0.0;
        EvaluateCell(cells, 0, at, &found);
        EXPECT_NEAR(found, map(at), 1e-11);
      }
    }
  }
}

/// Points inside follow maps of degree 2 on simplices; what is bilinear, and any curve along one
/// direction, on the others.
TEST(NodeTable, BlendingReproduces_ExactOracle)
{
  for (const CellShape shape : Shapes)
  {
    for (int order = 2; order <= 4; ++order)
    {
      const bool isTensor = shape == CellShape::Quadrilateral || shape == CellShape::Hexahedron;
      const auto map = [&](const std::array<double, 3>& x)
      {
        return isTensor ? x[0] * x[1] + std::pow(x[0], order) * (1.0 + x[2]) + x[1] * x[2]
                        : 1.0 + x[0] * x[1] + 3.0 * x[0] * x[0] - x[1] * x[2] + x[1];
      };
      const NodeTable table = MakeNodeTable(shape, order);
      const auto lattice = LatticeParameters(shape, DegreeOf(shape, order));
      Eigen::VectorXd values(static_cast<Eigen::Index>(lattice.size()));
      for (std::size_t i = 0; i < lattice.size(); ++i)
      {
        values[static_cast<Eigen::Index>(i)] = map(lattice[i]);
      }
      for (const int inside : table.Inside) // those within have no weight
      {
        values[inside] = 1e9;
      }
      const Eigen::VectorXd found = table.Blend * values;
      for (std::size_t i = 0; i < table.Inside.size(); ++i)
      {
        EXPECT_NEAR(found[static_cast<Eigen::Index>(i)],
          map(lattice[static_cast<std::size_t>(table.Inside[i])]), 1e-12)
          << static_cast<int>(shape) << " of order " << order;
      }
    }
  }
}

/// All elements agree on the points of common faces: of straight elements those are where the
/// multilinear map has them, whichever element says so.
TEST(NodeLattice, ElementsShareTheirFaces_PropertyOracle)
{
  const StraightElements ball = FromCells<3>(fits::Ball(1));
  for (const StraightElements& elements : { ball, Cylinder(2), Tetrahedra(ball) })
  {
    for (int order = 1; order <= 4; ++order)
    {
      const NodeLattice lattice(elements, order);
      const CurvedNodes nodes(lattice, elements.Points, false);
      std::set<int> used(lattice.Nodes.begin(), lattice.Nodes.end());
      EXPECT_EQ(static_cast<int>(used.size()), lattice.NumNodes());
      for (int e = 0; e < elements.NumElements(); ++e)
      {
        const auto at = static_cast<std::size_t>(e);
        const CellShape shape = elements.Shapes[at];
        BernsteinCells cells;
        cells.NumComponents = 3;
        cells.Add(shape, DegreeOf(shape, 1));
        const int count = NumCorners(shape);
        for (int c = 0; c < count; ++c)
        {
          const int corner = elements.Corners[elements.Begin[at] + static_cast<std::size_t>(c)];
          for (int d = 0; d < 3; ++d)
          {
            cells.Block(0)[d * count + c] = elements.Points(corner, d);
          }
        }
        std::size_t node = lattice.Begin[at];
        for (const auto& place : LatticeParameters(shape, DegreeOf(shape, order)))
        {
          Eigen::RowVector3d expected;
          EvaluateCell(cells, 0, place, expected.data());
          EXPECT_LT((nodes.Positions().row(lattice.Nodes[node++]) - expected).norm(), 1e-14);
        }
      }
    }
  }
}

/// Volumes of balls of hexahedra and tetrahedra, and of a cylinder of wedges, the faces of which on
/// its barrel are told: errors fall with h^(p + 1) at least.
TEST(CurvedElements, VolumesReachTheOrder_ConvergenceOracle)
{
  struct Case
  {
    std::function<StraightElements(int)> Mesh;
    FitTargetPtr Target;
    double Volume;
    bool IsBall;
  };
  const Case cases[] = { { [](int n) { return FromCells<3>(fits::Ball(2 * n)); }, UnitSphere(),
                           4.0 / 3.0 * Pi, true },
    { [](int n) { return Tetrahedra(FromCells<3>(fits::Ball(n))); }, UnitSphere(), 4.0 / 3.0 * Pi,
      true },
    { Cylinder, fits::Cylinder(), Pi, false } };
  for (const Case& one : cases)
  {
    for (int order = 2; order <= 4; ++order)
    {
      std::array<double, 3> errors{};
      for (int step = 0; step < 3; ++step)
      {
        const StraightElements mesh = one.Mesh(1 << step);
        const CurvedElements curved = Curve(mesh, one.Target, order,
          one.IsBall ? std::vector<FaceCorners>() : FacesAtRadius(mesh, 1.0));
        errors[static_cast<std::size_t>(step)] = curved.Volume - one.Volume;
        EXPECT_LT(curved.CurvedToTarget.Largest, 0.2 * curved.StraightToTarget.Largest);
        EXPECT_EQ(std::count(curved.Relaxed.begin(), curved.Relaxed.end(), 1), 0);
      }
      EXPECT_GT(Rate(errors[1], errors[2]), order + 0.8)
        << errors[0] << ' ' << errors[1] << ' ' << errors[2];
    }
  }
}

/// Areas of a sphere and a torus, and distances from them.
TEST(CurvedElements, SurfacesReachTheOrder_ConvergenceOracle)
{
  struct Case
  {
    std::function<StraightElements(int)> Mesh;
    FitTargetPtr Target;
    double Area;
  };
  const Case cases[] = { { [](int n) { return FromCells<2>(fits::Sphere(2 * n)); }, UnitSphere(),
                           4.0 * Pi },
    { [](int n) { return Triangles(FromCells<2>(fits::Sphere(2 * n))); }, UnitSphere(), 4.0 * Pi },
    { [](int n) { return FromCells<2>(fits::Torus(8 * n)); }, fits::TorusTarget(),
      4.0 * Pi * Pi * 0.4 },
    { [](int n) { return Triangles(FromCells<2>(fits::Torus(8 * n))); }, fits::TorusTarget(),
      4.0 * Pi * Pi * 0.4 } };
  for (const Case& one : cases)
  {
    for (int order = 2; order <= 4; ++order)
    {
      const CurvedElements coarse = Curve(one.Mesh(2), one.Target, order);
      const CurvedElements fine = Curve(one.Mesh(4), one.Target, order);
      EXPECT_GT(Rate(coarse.Area - one.Area, fine.Area - one.Area), order + 0.8)
        << coarse.Area - one.Area << ' ' << fine.Area - one.Area;
      EXPECT_GT(Rate(coarse.CurvedToTarget.RootMeanSquare, fine.CurvedToTarget.RootMeanSquare),
        order + 0.7);
    }
  }
}

/// Both bases are one geometry, and the simple verifier confirms what is proved of it.
TEST(CurvedElements, BezierAndLagrangeAreOne_CrossOracle)
{
  const StraightElements ball = FromCells<3>(fits::Ball(1));
  const FitTargetPtr sphere = UnitSphere();
  for (const StraightElements& elements : { ball, Tetrahedra(ball) })
  {
    CurvedElementsParams params;
    params.Order = 3;
    const auto lagrange = CurveElements(elements, sphere.get(), params);
    params.Bezier = true;
    const auto bezier = CurveElements(elements, sphere.get(), params);
    ASSERT_TRUE(lagrange && bezier);
    EXPECT_EQ(lagrange->Nodes, bezier->Nodes);
    EXPECT_DOUBLE_EQ(lagrange->Volume, bezier->Volume);
    const BernsteinCells cells = CellsOf(bezier.Value, 3);
    for (int e = 0; e < cells.NumCells(); ++e)
    {
      const auto at = static_cast<std::size_t>(e);
      std::size_t node = lagrange->Begin[at];
      for (const auto& place : LatticeParameters(cells.Shapes[at], cells.Degrees[at]))
      {
        Eigen::RowVector3d found;
        EvaluateCell(cells, e, place, found.data());
        EXPECT_LT((lagrange->Points.row(lagrange->Nodes[node++]) - found).norm(), 1e-14);
      }
    }
    EXPECT_EQ(VerifyCertificate(cells, bezier->Certificate).Refuted, 0);
  }
}

/// Layers thinner than the bulge of the surface would fold: points inside follow, and the boundary
/// stays where it was placed.
TEST(CurvedElements, ThinLayersFollow_PropertyOracle)
{
  fits::Placer<3> placer;
  // a quarter of a tube around the third axis, whose first layer is thinner than the bulge
  for (const auto& [inner, outer] : { std::array<double, 2>{ 1.0, 1.03 }, { 1.03, 1.5 } })
  {
    fits::AddBlock<3>(placer, { 1, 2, 1 },
      [&, low = inner, high = outer](const double* u)
      {
        const double angle = 0.5 * Pi * u[1];
        const double r = low + (high - low) * u[0];
        return Eigen::RowVector3d(r * std::cos(angle), r * std::sin(angle), u[2]);
      });
  }
  const StraightElements tube = FromCells<3>(placer.Done());
  const FitTargetPtr cylinder = fits::Cylinder();
  for (int order = 2; order <= 4; ++order)
  {
    CurvedElementsParams params;
    params.Order = order;
    params.Facets = FacesAtRadius(tube, 1.0);
    ASSERT_EQ(params.Facets.size(), 2u);
    const auto curved = CurveElements(tube, cylinder.get(), params);
    ASSERT_TRUE(curved) << curved.Status.Message();
    EXPECT_EQ(curved->Certificate.Verdict, Verdict::Valid);
    EXPECT_EQ(curved->Placed.Left, 0);
    EXPECT_GT(curved->Following, 0);
    EXPECT_EQ(std::count(curved->Relaxed.begin(), curved->Relaxed.end(), 1), 0);
    EXPECT_LT(curved->CurvedToTarget.Largest, 0.02 * curved->StraightToTarget.Largest);
  }
}

/// Tetrahedra with two faces on one smooth surface have no valid map along their common edge: what
/// comes out is between the straight ones and the ball.
TEST(CurvedElements, FoldsAreRelaxed_PropertyOracle)
{
  StraightElements cube;
  cube.Points.resize(8, 3);
  for (int i = 0; i < 8; ++i)
  {
    cube.Points.row(i) << i % 2 - 0.5, i / 2 % 2 - 0.5, i / 4 - 0.5;
  }
  cube.Points *= 2.0 / std::sqrt(3.0);
  cube.Add(CellShape::Hexahedron, { 0, 1, 2, 3, 4, 5, 6, 7 });
  const StraightElements elements = Tetrahedra(cube);
  std::ptrdiff_t relaxed = 0; // low orders may bend less than they would have to fold
  for (int order = 2; order <= 4; ++order)
  {
    CurvedElementsParams params;
    params.Order = order;
    params.FarShare = 1.0;
    const auto curved = CurveElements(elements, UnitSphere().get(), params);
    ASSERT_TRUE(curved) << curved.Status.Message();
    EXPECT_EQ(curved->Certificate.NumValid, elements.NumElements());
    relaxed += std::count(curved->Relaxed.begin(), curved->Relaxed.end(), 1);
    EXPECT_GT(curved->Volume, 8.0 / std::sqrt(27.0) + 0.01);
    EXPECT_LT(curved->Volume, 4.0 / 3.0 * Pi);
    EXPECT_LT(curved->CurvedToTarget.Largest, curved->StraightToTarget.Largest);
  }
  EXPECT_GT(relaxed, 0);
}

/// A block that is thin along one of its arcs, which cannot bulge there; its other arc, which a
/// thick block has too, stays on the cylinder.
TEST(CurvedElements, WhatNeedNotMoveBackStays_ExactOracle)
{
  fits::Placer<3> placer;
  fits::AddBlock<3>(placer, { 1, 1, 2 },
    [](const double* u)
    {
      const double angle = 0.25 * Pi * u[1];
      const double r = 1.0 + (u[2] == 0.0 ? 0.03 : 0.5) * u[0];
      return Eigen::RowVector3d(r * std::cos(angle), r * std::sin(angle), 2.0 * u[2]);
    });
  const StraightElements blocks = FromCells<3>(placer.Done());
  const auto onCylinder = [](Eigen::RowVector3d at)
  {
    at.head<2>().normalize();
    return at;
  };
  const auto isOnIt = [&](int corner)
  { return std::abs(blocks.Points.row(corner).head<2>().norm() - 1.0) < 1e-9; };
  for (int order = 2; order <= 4; ++order)
  {
    const NodeLattice lattice(blocks, order);
    CurvedNodes nodes(lattice, blocks.Points, false);
    for (int node = 0; node < lattice.NumNodes(); ++node)
    {
      nodes.Hold(node); // nothing follows
    }
    for (int e = 0; e < static_cast<int>(lattice.Edges.size()); ++e)
    {
      const auto [a, b] = lattice.Edges[static_cast<std::size_t>(e)];
      for (int k = 1; k < order && isOnIt(a) && isOnIt(b); ++k)
      {
        const Eigen::RowVector3d base = nodes.EdgeBase(e, k);
        nodes.Place(lattice.EdgeNode(e, k), base, onCylinder(base));
      }
    }
    for (int f = 0; f < static_cast<int>(lattice.Faces.size()); ++f)
    {
      const FaceCorners& corners = lattice.Faces[static_cast<std::size_t>(f)];
      const PointMatrix base = nodes.FaceBase(f);
      const std::vector<int> inside = nodes.InsideFace(f);
      for (std::size_t i = 0; i < inside.size(); ++i)
      {
        if (std::all_of(corners.begin(), corners.end(), isOnIt))
        {
          const Eigen::RowVector3d at = base.row(static_cast<Eigen::Index>(i));
          nodes.Place(inside[i], at, onCylinder(at));
        }
      }
    }
    std::vector<char> relaxed;
    const auto certificate = nodes.Relax(blocks, 1, {}, relaxed);
    ASSERT_TRUE(certificate) << certificate.Status.Message();
    EXPECT_EQ(certificate->Verdict, Verdict::Valid);
    EXPECT_EQ(relaxed, (std::vector<char>{ 1, 0 })) << order;
  }
}

TEST(CurvedElements, EqualBitsForAnyNumberOfThreads_ExactOracle)
{
  const StraightElements ball = Tetrahedra(FromCells<3>(fits::Ball(2)));
  const FitTargetPtr sphere = UnitSphere();
  CurvedElementsParams params;
  params.Order = 3;
  params.Threads = 1;
  const auto one = CurveElements(ball, sphere.get(), params);
  params.Threads = 3;
  const auto three = CurveElements(ball, sphere.get(), params);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->Points, three->Points);
  EXPECT_EQ(one->Distance, three->Distance);
  EXPECT_EQ(one->Area, three->Area);
}

TEST(CurvedElements, ReversedElementsAreTurned_ExactOracle)
{
  StraightElements ball = Tetrahedra(FromCells<3>(fits::Ball(1)));
  const CurvedElements expected = Curve(ball, UnitSphere(), 2);
  EXPECT_EQ(expected.Turned, 0);
  for (std::size_t e = 0; e < ball.Shapes.size(); e += 3)
  {
    std::swap(ball.Corners[ball.Begin[e]], ball.Corners[ball.Begin[e] + 1]);
  }
  const CurvedElements turned = Curve(ball, UnitSphere(), 2);
  EXPECT_EQ(turned.Turned, static_cast<int>(ball.Shapes.size() + 2) / 3);
  EXPECT_NEAR(turned.Volume, expected.Volume, 1e-14);
}

TEST(CurvedElements, WithoutATargetElementsStayStraight_ExactOracle)
{
  const StraightElements ball = FromCells<3>(fits::Ball(1));
  const CurvedElements curved = Curve(ball, nullptr, 4);
  EXPECT_NEAR(curved.Volume, Curve(ball, nullptr, 1).Volume, 1e-13);
  EXPECT_EQ(curved.Placed.OnFaces, 0);
}

TEST(CurvedElements, EveryFailureIsReachable)
{
  const StraightElements good = FromCells<3>(fits::Ball(1));
  const FitTargetPtr sphere = UnitSphere();
  const auto error = [&](const StraightElements& elements, const CurvedElementsParams& params = {})
  { return CurveElements(elements, sphere.get(), params).Status; };
  EXPECT_EQ(error({}).Code, ErrorCode::EmptyInput);
  CurvedElementsParams params;
  params.Order = 5;
  EXPECT_EQ(error(good, params).Code, ErrorCode::InvalidParameter);
  params = {};
  params.FarShare = 0.0;
  EXPECT_EQ(error(good, params).Code, ErrorCode::InvalidParameter);
  params = {};
  params.Regions = { 1, 2 };
  EXPECT_EQ(error(good, params).Code, ErrorCode::SizeMismatch);
  params = {};
  params.Facets = { { 0, 1, 2, -1 } };
  EXPECT_NE(error(good, params).Detail.find("no element has the facet"), std::string::npos);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(error(good, params).Code, ErrorCode::Aborted);
  StraightElements bad = good;
  bad.Points(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error(bad).Code, ErrorCode::NonFiniteInput);
  bad = good;
  bad.Corners[5] = bad.Corners[4];
  EXPECT_NE(error(bad).Detail.find("element 0 has one point at two corners"), std::string::npos);
  bad = good;
  bad.Corners[5] = 99;
  EXPECT_NE(error(bad).Detail.find("a corner that is no point"), std::string::npos);
  bad = good;
  bad.Add(CellShape::Triangle, { 0, 1, 2 });
  EXPECT_NE(error(bad).Detail.find("element 7 is none of a surface"), std::string::npos);
  bad = good;
  bad.Add(CellShape::Hexahedron, { bad.Corners.begin(), bad.Corners.begin() + 8 });
  EXPECT_NE(error(bad).Detail.find("leave out what is there twice"), std::string::npos);
  bad = good;
  bad.Points.row(bad.Corners[0]) = bad.Points.row(bad.Corners[7]);
  EXPECT_EQ(error(bad).Code, ErrorCode::NotConverged);
  bad = good;
  bad.Points *= 5.0;
  EXPECT_NE(error(bad).Detail.find("give both in the same unit and place"), std::string::npos);
  // two wedges on a hexahedron, whose face their triangles meet
  StraightElements mixed = FromCells<3>(fits::Ball(1));
  const std::vector<int> c(mixed.Corners.begin(), mixed.Corners.begin() + 8);
  mixed.Shapes.erase(mixed.Shapes.begin());
  mixed.Corners.erase(mixed.Corners.begin(), mixed.Corners.begin() + 8);
  mixed.Begin.pop_back();
  mixed.Add(CellShape::Wedge, { c[0], c[1], c[3], c[4], c[5], c[7] });
  mixed.Add(CellShape::Wedge, { c[0], c[3], c[2], c[4], c[7], c[6] });
  EXPECT_NE(error(mixed).Detail.find("a quadrilateral is met by triangles"), std::string::npos)
    << error(mixed).Detail;
  // a box of two boxes beside one that is not divided
  StraightElements hanging;
  hanging.Points.resize(14, 3);
  hanging.Points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1, //
    2, 0, 0, 2, 1, 0, 2, 0, 1, 2, 1, 1, 1, 0.5, 0, 2, 0.5, 0;
  hanging.Points.conservativeResize(16, 3);
  hanging.Points.row(14) << 1, 0.5, 1;
  hanging.Points.row(15) << 2, 0.5, 1;
  hanging.Add(CellShape::Hexahedron, { 0, 1, 2, 3, 4, 5, 6, 7 });
  hanging.Add(CellShape::Hexahedron, { 1, 8, 12, 13, 5, 10, 14, 15 });
  hanging.Add(CellShape::Hexahedron, { 12, 13, 3, 9, 14, 15, 7, 11 });
  EXPECT_NE(error(hanging).Detail.find("point 12 lies on the edge from point"), std::string::npos)
    << error(hanging).Detail;
}
