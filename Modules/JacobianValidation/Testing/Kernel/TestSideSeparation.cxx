// SPDX-License-Identifier: BSD-3-Clause
#include "SideSeparation.h"
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
