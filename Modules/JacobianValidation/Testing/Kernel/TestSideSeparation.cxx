// SPDX-License-Identifier: BSD-3-Clause
#include "SideSeparation.h"
#include "SplineOracle.h"
#include "TestCells.h"

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
/// A side that interpolates a function, with its own corners and edges; equal positions of corners
/// are one place.
struct Sides
{
  std::vector<BoundarySide> List;
  CellLatticeTable Lattices;
  int NumComponents = 2;

  void Add(CellShape shape, int degree, const CellFunction& function)
  {
    BernsteinCells cells;
    cells.NumComponents = this->NumComponents;
    AddInterpolant(cells, shape, UniformDegree(shape, degree), function);
    BoundarySide side;
    side.Frame.Shape = shape;
    side.Frame.NumCorners = NumCorners(shape);
    side.Degree = cells.Degrees[0];
    side.Data = cells.Data;
    const int number = static_cast<int>(this->List.size());
    for (int k = 0; k < side.Frame.NumCorners; ++k)
    {
      side.Places[static_cast<std::size_t>(k)] = 4 * number + k;
      side.Edges[static_cast<std::size_t>(k)] = 4 * number + k;
    }
    this->Lattices.try_emplace({ static_cast<int>(shape), side.Degree }, shape, side.Degree);
    this->List.push_back(side);
  }
  SeparationState Separate(int a, int b) const
  {
    SeparationInput input;
    input.Sides = &this->List;
    input.Lattices = &this->Lattices;
    input.NumComponents = this->NumComponents;
    input.CollapseTolerance = 0x1p-46;
    return SeparateSides(input, a, b, 200000).State;
  }
};

using Point = std::array<double, 3>;
}

// (t^2 - 1, t^3 - t) meets itself at t = -1 and 1.
TEST(SideSeparation, NodalCubicMeetsItself_ExactOracle)
{
  for (const double reach : { 1.4, 1.01, 0.99, 0.5 })
  {
    SCOPED_TRACE(reach);
    const auto node = [&](double s, double z)
    {
      const double t = reach * (2.0 * s - 1.0) * (1.0 + 0.001 * s);
      return Point{ t * t - 1.0, t * t * t - t, z };
    };
    Sides curves;
    curves.Add(CellShape::Curve, 6, [&](const Point& u) { return node(u[0], 0.0); });
    Sides surfaces;
    surfaces.NumComponents = 3;
    surfaces.Add(CellShape::Quadrilateral, 6, [&](const Point& u) { return node(u[0], u[1]); });
    surfaces.Add(
      CellShape::Triangle, 6, [&](const Point& u) { return node(u[0], 0.1 * u[1] + 0.05 * u[0]); });
    if (reach > 1.0)
    {
      EXPECT_EQ(curves.Separate(0, 0), SeparationState::Stuck);
      EXPECT_NE(surfaces.Separate(0, 0), SeparationState::Separate);
    }
    else
    {
      EXPECT_EQ(curves.Separate(0, 0), SeparationState::Separate);
      EXPECT_EQ(surfaces.Separate(0, 0), SeparationState::Separate);
      EXPECT_EQ(surfaces.Separate(1, 1), SeparationState::Separate);
    }
  }
}

// A line and the parabola y = x (a - x): they share the origin, and meet again at x = a.
TEST(SideSeparation, CurvesFromOneCorner_ExactOracle)
{
  for (const double a : { 0.5, 0.001, 1.001, -0.1, 0.0 })
  {
    SCOPED_TRACE(a);
    Sides curves;
    curves.Add(CellShape::Curve, 1, [](const Point& u) { return Point{ u[0], 0.0, 0.0 }; });
    curves.Add(CellShape::Curve, 2,
      [a](const Point& u) {
        return Point{ u[0], u[0] * (a - u[0]), 0.0 };
      });
    curves.List[1].Places[0] = curves.List[0].Places[0];
    // a = 0: tangent there, which no line through the corner tells apart
    const bool separate = a > 1.0 || a < 0.0;
    EXPECT_EQ(curves.Separate(0, 1) == SeparationState::Separate, separate);
    EXPECT_EQ(curves.Separate(1, 0) == SeparationState::Separate, separate);
  }
}

// The plane z = 0 and z = y (a - y): a common edge y = 0, and they meet again in y = a.
TEST(SideSeparation, SurfacesFromOneEdge_ExactOracle)
{
  for (const CellShape shape : { CellShape::Quadrilateral, CellShape::Triangle })
  {
    for (const double a : { 0.5, 0.01, 1.01, -0.1 })
    {
      SCOPED_TRACE(a);
      Sides surfaces;
      surfaces.NumComponents = 3;
      surfaces.Add(shape, 2, [](const Point& u) { return Point{ u[0], u[1], 0.0 }; });
      surfaces.Add(CellShape::Quadrilateral, 2,
        [a](const Point& u) {
          return Point{ u[0], u[1], u[1] * (a - u[1]) };
        });
      surfaces.List[1].Edges[0] = surfaces.List[0].Edges[0];
      surfaces.List[1].Places[0] = surfaces.List[0].Places[0];
      surfaces.List[1].Places[1] = surfaces.List[0].Places[1];
      const bool separate = a > 1.0 || a < 0.0;
      EXPECT_EQ(surfaces.Separate(0, 1) == SeparationState::Separate, separate);
      EXPECT_EQ(surfaces.Separate(1, 0) == SeparationState::Separate, separate);
    }
  }
}

// Quarters of the plane that share a corner, bent out of it on the other side or across.
TEST(SideSeparation, SurfacesFromOneCorner_ExactOracle)
{
  for (const double a : { 0.5, -0.5 })
  {
    Sides surfaces;
    surfaces.NumComponents = 3;
    surfaces.Add(CellShape::Quadrilateral, 2,
      [](const Point& u) {
        return Point{ u[0], u[1], 0.0 };
      });
    surfaces.Add(CellShape::Quadrilateral, 2,
      [a](const Point& u) {
        return Point{ u[0], 0.9 * u[1] + 0.05 * u[0], (u[0] + u[1]) * (a - u[0]) };
      });
    surfaces.Add(CellShape::Quadrilateral, 2,
      [](const Point& u) {
        return Point{ -u[0], -u[1], u[0] * u[1] };
      });
    surfaces.List[1].Places[0] = surfaces.List[0].Places[0];
    surfaces.List[2].Places[0] = surfaces.List[0].Places[0];
    EXPECT_EQ(surfaces.Separate(0, 1) == SeparationState::Separate, a < 0.0);
    EXPECT_EQ(surfaces.Separate(0, 2), SeparationState::Separate);
  }
}

// A sector of the plane z = 0 between the x axis and y = x, whose edge t = 0 is the origin, and a
// surface that begins at the x axis too: x e + v d + x v f, regular at the origin. Their other
// common points have v > 0 and z = v (d_z + x f_z) = 0, so they are on the line x = -d_z / f_z, on
// the sector where d_y + x f_y > 0.
TEST(SideSeparation, RegularSurfaceAtThePoleOfAnother_CrossOracle)
{
  oracle::Random random(23);
  int meeting = 0;
  int apart = 0;
  int proved = 0;
  for (int seed = 0; seed < 400; ++seed)
  {
    SCOPED_TRACE(seed);
    Eigen::Vector3d d(random.In(-1, 1), random.In(-1, 1), random.In(-1, 1));
    Eigen::Vector3d f(random.In(-1, 1), random.In(-1, 1), random.In(-1, 1));
    const double at = std::ldexp(1.0, -random.Int(1, 16));
    if (seed % 2 == 0) // they meet close to the pole, if at all
    {
      f[2] = f[2] < 0.0 ? -0.5 : 0.5;
      d[2] = -f[2] * at;
    }
    if (seed % 8 == 1) // they meet along the edge of the surface that comes from the pole
    {
      d = { 1.0, random.In(0.2, 0.8), 0.0 };
      f[2] = f[2] < 0.0 ? -1.0 : 1.0;
    }
    const auto heightAt = [&](double x) { return d[2] + x * f[2]; };
    const double zero = f[2] != 0.0 ? -d[2] / f[2] : -1.0;
    const bool crosses = zero >= 0.0 && zero < 1.0 && d[1] + zero * f[1] > 0.0;
    double least = 10.0; // angle between the surface and the sector along the common edge
    for (int i = 0; i <= 100; ++i)
    {
      least = std::min(least, std::abs(std::atan2(heightAt(i / 100.0), d[1] + i / 100.0 * f[1])));
    }
    Sides surfaces;
    surfaces.NumComponents = 3;
    surfaces.Add(CellShape::Quadrilateral, 2,
      [](const Point& u) {
        return Point{ u[1], u[1] * u[0], 0.0 };
      });
    surfaces.Add(CellShape::Quadrilateral, 2,
      [&](const Point& u)
      {
        return Point{ u[0] + u[1] * (d[0] + u[0] * f[0]), u[1] * (d[1] + u[0] * f[1]),
          u[1] * heightAt(u[0]) };
      });
    surfaces.List[0].CollapsedEdges[0] = true;
    surfaces.List[0].Places[1] = surfaces.List[0].Places[0];
    surfaces.List[1].Places[0] = surfaces.List[0].Places[0];
    surfaces.List[1].Places[1] = surfaces.List[0].Places[2];
    surfaces.List[1].Edges[0] = surfaces.List[0].Edges[3];
    for (const auto& [a, b] : { std::pair{ 0, 1 }, std::pair{ 1, 0 } })
    {
      const bool separate = surfaces.Separate(a, b) == SeparationState::Separate;
      if (crosses)
      {
        EXPECT_FALSE(separate) << "at " << zero;
        ++meeting;
      }
      else if (least > 1.0)
      {
        proved += separate;
        ++apart;
      }
    }
  }
  EXPECT_GT(meeting, 200);
  // what is apart may stay open, but not often where the angle between them is large
  EXPECT_GT(apart, 150);
  EXPECT_GT(proved, apart * 9 / 10) << apart;
}

TEST(SideSeparation, LimitOfBoxesIsKept_ExactOracle)
{
  Sides curves;
  curves.Add(CellShape::Curve, 2, [](const Point& u) { return Point{ u[0], u[0] * u[0], 0.0 }; });
  curves.Add(CellShape::Curve, 2,
    [](const Point& u) {
      return Point{ u[0], u[0] * u[0] + 1e-4, 0.0 };
    });
  SeparationInput input;
  input.Sides = &curves.List;
  input.Lattices = &curves.Lattices;
  const SeparationResult few = SeparateSides(input, 0, 1, 5);
  EXPECT_EQ(few.State, SeparationState::Boxes);
  EXPECT_EQ(few.Boxes, 6);
  EXPECT_EQ(SeparateSides(input, 0, 1, 100000).State, SeparationState::Separate);
}
