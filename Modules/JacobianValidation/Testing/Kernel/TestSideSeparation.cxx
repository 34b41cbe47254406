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
  bool Rational = false;

  void Add(CellShape shape, int degree, const CellFunction& function)
  {
    BernsteinCells cells;
    cells.NumComponents = this->NumComponents;
    AddInterpolant(cells, shape, UniformDegree(shape, degree), function);
    this->Add(shape, cells.Degrees[0], cells.Data);
  }
  void Add(CellShape shape, const CellDegree& degree, const std::vector<double>& data)
  {
    BoundarySide side;
    side.Frame.Shape = shape;
    side.Frame.NumCorners = NumCorners(shape);
    side.Degree = degree;
    side.Data = data;
    const int number = static_cast<int>(this->List.size());
    for (int k = 0; k < side.Frame.NumCorners; ++k)
    {
      side.Places[static_cast<std::size_t>(k)] = 4 * number + k;
      side.Edges[static_cast<std::size_t>(k)] = 4 * number + k;
    }
    this->Lattices.try_emplace({ static_cast<int>(shape), side.Degree }, shape, side.Degree);
    this->List.push_back(side);
  }
  SeparationState Separate(int a, int b, std::int64_t boxes = 200000) const
  {
    SeparationInput input;
    input.Sides = &this->List;
    input.Lattices = &this->Lattices;
    input.NumComponents = this->NumComponents;
    input.Rational = this->Rational;
    input.CollapseTolerance = 0x1p-46;
    return SeparateSides(input, a, b, boxes).State;
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

// The same curve stands still at its beginning: t = reach (2 s^2 - 1). Swept, it is a surface that
// stands still along an edge.
TEST(SideSeparation, NodalCubicThatStandsStillMeetsItself_ExactOracle)
{
  for (const double reach : { 1.4, 1.01, 0.99, 0.5 })
  {
    SCOPED_TRACE(reach);
    const auto node = [&](double s, double z)
    {
      const double t = reach * (2.0 * s * s - 1.0);
      return Point{ t * t - 1.0, t * t * t - t, z };
    };
    Sides curves;
    curves.Add(CellShape::Curve, 6, [&](const Point& u) { return node(u[0], 0.0); });
    Sides surfaces;
    surfaces.NumComponents = 3;
    surfaces.Add(CellShape::Quadrilateral, 6, [&](const Point& u) { return node(u[0], u[1]); });
    surfaces.Add(CellShape::Quadrilateral, 6,
      [&](const Point& u) { return node(1.0 - u[0], u[1] * (1.0 - 0.2 * u[1])); });
    EXPECT_EQ(curves.Separate(0, 0) == SeparationState::Separate, reach < 1.0);
    EXPECT_EQ(surfaces.Separate(0, 0) == SeparationState::Separate, reach < 1.0);
    EXPECT_EQ(surfaces.Separate(1, 1) == SeparationState::Separate, reach < 1.0);
  }
}

// z = 0 and z = y (a - y) over y = v^2: both stand still along their common edge y = 0.
TEST(SideSeparation, SurfacesThatStandStillAtTheirCommonEdge_ExactOracle)
{
  for (const double a : { 0.5, 0.01, 1.01, -0.1 })
  {
    SCOPED_TRACE(a);
    Sides surfaces;
    surfaces.NumComponents = 3;
    surfaces.Add(CellShape::Quadrilateral, 2,
      [](const Point& u) {
        return Point{ u[0], u[1] * u[1], 0.0 };
      });
    surfaces.Add(CellShape::Quadrilateral, 4,
      [a](const Point& u)
      {
        const double y = u[1] * u[1];
        return Point{ u[0], y, y * (a - y) };
      });
    surfaces.List[1].Edges[0] = surfaces.List[0].Edges[0];
    surfaces.List[1].Places[0] = surfaces.List[0].Places[0];
    surfaces.List[1].Places[1] = surfaces.List[0].Places[1];
    const bool separate = a > 1.0 || a < 0.0;
    EXPECT_EQ(surfaces.Separate(0, 1) == SeparationState::Separate, separate);
    EXPECT_EQ(surfaces.Separate(1, 0) == SeparationState::Separate, separate);
  }
}

namespace
{
/// Control points and weights of a piece of a surface.
struct Net
{
  CellShape Shape;
  CellDegree Degree;
  std::vector<Eigen::Vector3d> Points;
  std::vector<double> Weights;

  Net(CellShape shape, int degree, oracle::Random& random, double noise, double decades)
    : Shape(shape), Degree(UniformDegree(shape, degree))
  {
    for (int j = 0; j <= degree; ++j)
    {
      for (int i = 0; i + (shape == CellShape::Triangle ? j : 0) <= degree; ++i)
      {
        this->Points.emplace_back(static_cast<double>(i) / degree + noise * random.In(-1, 1),
          static_cast<double>(j) / degree + noise * random.In(-1, 1), noise * random.In(-1, 1));
        this->Weights.push_back(std::pow(10.0, decades * random.In(-1, 1)));
      }
    }
  }
  std::size_t At(int i, int j) const
  {
    return static_cast<std::size_t>(CellCoefficient(this->Shape, this->Degree, i, j, 0));
  }
  /// The factors of the control points in the point at u.
  std::vector<double> Factors(double u, double v) const
  {
    std::vector<double> factors(this->Points.size());
    const double at[3] = { u, v, 0.0 };
    EvaluateCellBasis(this->Shape, this->Degree, at, factors.data(), nullptr);
    double sum = 0.0;
    for (std::size_t i = 0; i < factors.size(); ++i)
    {
      factors[i] *= this->Weights[i];
      sum += factors[i];
    }
    for (double& f : factors)
    {
      f /= sum;
    }
    return factors;
  }
  Eigen::Vector3d Point(const std::vector<double>& factors) const
  {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < factors.size(); ++i)
    {
      x += factors[i] * this->Points[i];
    }
    return x;
  }
  std::vector<double> Data(bool rational) const
  {
    std::vector<double> data;
    for (int d = 0; d < 3; ++d)
    {
      for (std::size_t i = 0; i < this->Points.size(); ++i)
      {
        data.push_back((rational ? this->Weights[i] : 1.0) * this->Points[i][d]);
      }
    }
    if (rational)
    {
      data.insert(data.end(), this->Weights.begin(), this->Weights.end());
    }
    return data;
  }
};

/// The place of the largest entry from the row j = first on.
std::size_t Largest(const Net& net, const std::vector<double>& x, int first)
{
  std::size_t best = net.At(0, first);
  for (std::size_t i = best; i < x.size(); ++i)
  {
    best = std::abs(x[i]) > std::abs(x[best]) ? i : best;
  }
  return best;
}

/// A parameter of the open domain, the nearer to the edge v = 0 the larger the seed.
std::array<double, 2> RandomPlace(CellShape shape, oracle::Random& random, double height)
{
  const double v = height * random.In(0.3, 0.9);
  const double most = shape == CellShape::Triangle ? 1.0 - v : 1.0;
  return { most * random.In(0.1, 0.9), v };
}
}

// Pieces that pass one point twice: a control point is moved so that they do.
TEST(SideSeparation, PiecesThatMeetThemselvesAreNotProved_PropertyOracle)
{
  oracle::Random random(41);
  for (int seed = 0; seed < 240; ++seed)
  {
    SCOPED_TRACE(seed);
    const CellShape shape = seed % 2 == 0 ? CellShape::Quadrilateral : CellShape::Triangle;
    Sides sides;
    sides.NumComponents = 3;
    sides.Rational = seed % 3 != 0;
    Net net(shape, 2 + seed / 2 % 2, random, 0.2, sides.Rational ? random.In(0.0, 3.0) : 0.0);
    if (seed % 5 == 0) // stands still at a corner
    {
      net.Points[1] = net.Points[0];
      net.Weights[1] = net.Weights[0];
    }
    const auto p = RandomPlace(shape, random, 1.0);
    auto q = RandomPlace(shape, random, 1.0);
    const double near = std::ldexp(1.0, -random.Int(0, 12));
    q = { p[0] + near * (q[0] - p[0]), p[1] + near * (q[1] - p[1]) };
    const auto atP = net.Factors(p[0], p[1]);
    auto change = net.Factors(q[0], q[1]);
    const Eigen::Vector3d gap = net.Point(change) - net.Point(atP);
    for (std::size_t i = 0; i < change.size(); ++i)
    {
      change[i] -= atP[i];
    }
    const std::size_t k = Largest(net, change, 1);
    net.Points[k] -= gap / change[k];
    const double size = net.Points[k].norm();
    ASSERT_LT((net.Point(net.Factors(p[0], p[1])) - net.Point(net.Factors(q[0], q[1]))).norm(),
      1e-13 * (1.0 + size));
    sides.Add(shape, net.Degree, net.Data(sides.Rational));
    EXPECT_NE(sides.Separate(0, 0, 1000), SeparationState::Separate);
  }
}

// Two pieces with a common edge v = 0 that meet once more, or that lie on two sides of a plane.
TEST(SideSeparation, PiecesWithACommonEdge_PropertyOracle)
{
  oracle::Random random(43);
  int apart = 0;
  int proved = 0;
  for (int seed = 0; seed < 450; ++seed)
  {
    SCOPED_TRACE(seed);
    const int degree = 1 + seed / 4 % 3;
    const CellShape shapes[2] = { seed % 2 == 0 ? CellShape::Quadrilateral : CellShape::Triangle,
      seed % 4 < 2 ? CellShape::Quadrilateral : CellShape::Triangle };
    Sides sides;
    sides.NumComponents = 3;
    sides.Rational = seed % 3 != 0;
    const double decades = sides.Rational ? random.In(0.0, 3.0) : 0.0;
    Net a(shapes[0], degree, random, 0.15, decades);
    Net b(shapes[1], degree, random, 0.15, decades);
    const bool meet = seed % 5 < 3;
    const double opening = std::pow(10.0, random.In(-2.0, 0.5));
    // above and below the plane z = 0, their common edge in it
    for (Net* net : { &a, &b })
    {
      for (std::size_t i = 0; i < net->Points.size(); ++i)
      {
        const bool onEdge = i <= static_cast<std::size_t>(degree);
        double& z = net->Points[i][2];
        z = onEdge ? 0.0 : (net == &a ? 1.0 : -1.0) * opening * (0.1 + std::abs(z));
      }
    }
    for (int i = 0; i <= degree; ++i)
    {
      const std::size_t at = static_cast<std::size_t>(i);
      b.Points[at] = a.Points[at];
      b.Weights[at] = a.Weights[at];
    }
    if (seed % 7 == 0 && degree > 1 && !sides.Rational) // both stand still at its first corner
    {
      a.Points[1] = b.Points[1] = a.Points[0];
    }
    if (meet)
    {
      const double height = std::ldexp(1.0, -random.Int(0, 12));
      const auto p = RandomPlace(shapes[0], random, height);
      const auto q = RandomPlace(shapes[1], random, height);
      const auto factors = b.Factors(q[0], q[1]);
      const std::size_t k = Largest(b, factors, 1);
      b.Points[k] += (a.Point(a.Factors(p[0], p[1])) - b.Point(factors)) / factors[k];
      if (!(b.Points[k].norm() < 1e6))
      {
        continue;
      }
    }
    Eigen::Matrix3d turn;
    for (int i = 0; i < 9; ++i)
    {
      turn(i / 3, i % 3) = random.In(-1, 1) + (i % 4 == 0 ? 1.5 : 0.0);
    }
    for (Net* net : { &a, &b })
    {
      for (auto& x : net->Points)
      {
        x = (turn * x).eval();
      }
      sides.Add(net->Shape, net->Degree, net->Data(sides.Rational));
    }
    sides.List[1].Edges[0] = sides.List[0].Edges[0];
    sides.List[1].Places[0] = sides.List[0].Places[0];
    sides.List[1].Places[1] = sides.List[0].Places[1];
    for (const auto& [first, second] : { std::pair{ 0, 1 }, std::pair{ 1, 0 } })
    {
      const bool separate = sides.Separate(first, second, 1000) == SeparationState::Separate;
      if (meet)
      {
        EXPECT_FALSE(separate);
      }
      else
      {
        ++apart;
        proved += separate;
      }
    }
  }
  EXPECT_GT(apart, 300);
  EXPECT_GT(proved, apart * 9 / 10) << apart;
  std::printf("%d of %d pairs that are apart are proved\n", proved, apart);
}

// Two pieces of the plane with a common edge from (0, 0) to (-0.47, 1) and positive Jacobians. Each
// edge of the outline is a curve that runs along its chord, and neighbours have nothing but their
// corner in common. The lower end of the left piece (a curve from (0.33, -0.62) past (0.75, -1.05))
// lies over the inner edge of the right one, a line through (0, 0), which is not its neighbour, or
// stays away from it.
TEST(SideSeparation, OutlinesThatCrossFarFromCommonCorners_ExactOracle)
{
  using Plane = Eigen::Vector2d;
  const Plane inner(0.0, 0.0);
  const Plane outer(-0.47, 1.0);
  const Plane left[3][3] = { { inner, 0.5 * (inner + outer), outer },
    { { 0.0, -0.43 }, { -0.55, -1.07 }, { -0.49, -0.41 } },
    { { 0.33, -0.62 }, { 1.39, -1.45 }, { -0.51, -1.82 } } };
  for (const bool cross : { true, false })
  {
    SCOPED_TRACE(cross ? "crossing" : "apart");
    const Plane right = cross ? Plane(1.04, -1.7) : Plane(2.5, -1.0);
    // the end of the left piece at s = 0.35 is on the right of the line
    const Plane at =
      0.65 * 0.65 * left[2][0] + 2 * 0.65 * 0.35 * left[2][1] + 0.35 * 0.35 * left[2][2];
    ASSERT_EQ(right[0] * at[1] - right[1] * at[0] > 0.0, cross);
    Sides sides;
    sides.NumComponents = 3;
    sides.Add(CellShape::Quadrilateral, 2,
      [&](const Point& u)
      {
        const auto factors = [](double x) {
          return std::array<double, 3>{ (1 - x) * (1 - x), 2 * x * (1 - x), x * x };
        };
        const auto away = factors(u[0]);
        const auto along = factors(u[1]);
        Plane x = Plane::Zero();
        for (std::size_t i = 0; i < 3; ++i)
        {
          for (std::size_t j = 0; j < 3; ++j)
          {
            x += away[i] * along[j] * left[i][j];
          }
        }
        return Point{ x[0], x[1], 0.0 };
      });
    sides.Add(CellShape::Quadrilateral, 1,
      [&](const Point& u)
      {
        const Plane x = (1 - u[0]) * ((1 - u[1]) * inner + u[1] * outer) +
          u[0] * ((1 - u[1]) * right + u[1] * Plane(3.0, 0.5));
        return Point{ x[0], x[1], 0.0 };
      });
    sides.List[1].Edges[3] = sides.List[0].Edges[3];
    sides.List[1].Places[0] = sides.List[0].Places[0];
    sides.List[1].Places[2] = sides.List[0].Places[2];
    for (const auto& [a, b] : { std::pair{ 0, 1 }, std::pair{ 1, 0 } })
    {
      EXPECT_EQ(sides.Separate(a, b, 10000) == SeparationState::Separate, !cross);
    }
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
