// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/SplineCore/Shapes.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace knotwork;

namespace
{
constexpr double Pi = 3.14159265358979323846;

ShapeParams Params(ShapeKind kind)
{
  ShapeParams params;
  params.Kind = kind;
  params.InnerRadius = 0.4;
  params.OuterRadius = 1.3;
  params.Angle = 250.0;
  params.PolarAngle = 100.0;
  params.Height = 1.7;
  params.Twist = -200.0;
  params.Size = { 2.1, 1.5, 3.2 };
  return params;
}

std::vector<ShapeKind> AllKinds()
{
  std::vector<ShapeKind> kinds;
  for (int i = 0; i < NumShapeKinds; ++i)
  {
    kinds.push_back(static_cast<ShapeKind>(i));
  }
  return kinds;
}

std::vector<AnySpline> Make(const ShapeParams& params)
{
  auto shape = MakeShape(params);
  EXPECT_TRUE(shape) << shape.Status.Message();
  return shape.Value;
}

/// Length, area or volume by its definition.
double ExactMeasure(const ShapeParams& s)
{
  const double angle = s.Angle * Pi / 180.0;
  const double r = s.InnerRadius;
  const double R = s.OuterRadius;
  const double disc = Pi * R * R;
  switch (s.Kind)
  {
    case ShapeKind::Line:
      return s.Size[0];
    case ShapeKind::Arc:
      return R * angle;
    case ShapeKind::Square:
      return s.Size[0] * s.Size[1];
    case ShapeKind::AnnulusSector:
      return 0.5 * angle * (R * R - r * r);
    case ShapeKind::Disc:
      return disc;
    case ShapeKind::PlateWithHole:
      return s.Size[0] * s.Size[1] - Pi * r * r;
    case ShapeKind::QuarterPlateWithHole:
      return (s.Size[0] * s.Size[1] - Pi * r * r) / 4;
    case ShapeKind::CylinderSurface:
      return R * angle * s.Height;
    case ShapeKind::SphereSurface:
      return 4 * disc;
    case ShapeKind::PolarSphereSurface:
      return 2 * angle * R * R;
    case ShapeKind::TorusSurface:
      return angle * R * 2 * Pi * r;
    case ShapeKind::Cube:
    case ShapeKind::TwistedBar:
      return s.Size[0] * s.Size[1] * s.Size[2];
    case ShapeKind::SolidTube:
      return 0.5 * angle * (R * R - r * r) * s.Height;
    case ShapeKind::SolidCylinder:
      return disc * s.Height;
    case ShapeKind::BallSector:
      return angle * 2 * std::sin(s.PolarAngle * Pi / 360.0) * (R * R * R - r * r * r) / 3;
    case ShapeKind::Ball:
      return 4 * disc * R / 3;
    case ShapeKind::SolidTorus:
      return Pi * r * r * R * angle;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// Points and first derivatives of all elements at the same local parameters.
template <int Dim>
EvaluationBatch Evaluate(const Spline<Dim>& spline, const PointMatrix& local)
{
  const BezierForm<Dim> form = MakeBezierForm(spline);
  std::vector<int> elements;
  PointMatrix all(spline.Space->NumElements() * local.rows(), Dim);
  for (int e = 0; e < spline.Space->NumElements(); ++e)
  {
    elements.insert(elements.end(), static_cast<std::size_t>(local.rows()), e);
    all.middleRows(e * local.rows(), local.rows()) = local;
  }
  EvaluationBatch batch;
  EvaluationParams params;
  params.Derivatives = 1;
  const Status status = EvaluateElements(form, elements, all, params, batch);
  EXPECT_TRUE(status) << status.Message();
  return batch;
}

/// n equally spaced values a direction in [begin, end].
template <int Dim>
PointMatrix Lattice(int n, double begin = 0.0, double end = 1.0)
{
  PointMatrix points(static_cast<int>(std::pow(n, Dim) + 0.5), Dim);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    Eigen::Index rest = i;
    for (int d = 0; d < Dim; ++d, rest /= n)
    {
      points(i, d) = begin + (end - begin) * static_cast<double>(rest % n) / (n - 1);
    }
  }
  return points;
}

/// Length, area or volume element at a row: signed for volumes and plane surfaces.
template <int Dim>
double Density(const EvaluationBatch& batch, Eigen::Index row, bool plane)
{
  Eigen::Matrix<double, 3, Dim> j;
  for (int d = 0; d < Dim; ++d)
  {
    j.col(d) = batch.First.row(row).segment(3 * d, 3).transpose();
  }
  if constexpr (Dim == 3)
  {
    return j.determinant();
  }
  else if constexpr (Dim == 2)
  {
    const Eigen::Vector3d normal = j.col(0).cross(j.col(1));
    return plane ? normal.z() : normal.norm();
  }
  else
  {
    return j.norm();
  }
}

bool IsPlane(ShapeKind kind)
{
  return kind <= ShapeKind::QuarterPlateWithHole;
}

bool IsDegenerate(const ShapeParams& s)
{
  return s.Kind == ShapeKind::PolarSphereSurface ||
    (s.Kind == ShapeKind::BallSector && (s.InnerRadius == 0.0 || s.PolarAngle == 180.0));
}

double Measure(const std::vector<AnySpline>& patches, ShapeKind kind)
{
  double sum = 0.0;
  for (const AnySpline& patch : patches)
  {
    std::visit(
      [&](const auto& spline)
      {
        using Space = typename std::decay_t<decltype(*spline.Space)>;
        constexpr int Dim = std::tuple_size<decltype(typename Space::Element{}.Degree)>::value;
        IntArray<Dim> n;
        n.fill(20);
        const auto rule = MakeElementQuadrature<Dim>(n);
        const EvaluationBatch batch = Evaluate<Dim>(spline, rule.Local);
        for (int e = 0; e < spline.Space->NumElements(); ++e)
        {
          const auto& box = spline.Space->Elements[static_cast<std::size_t>(e)].Box;
          double volume = 1.0;
          for (std::size_t d = 0; d < Dim; ++d)
          {
            volume *= box.Upper[d] - box.Lower[d];
          }
          for (Eigen::Index i = 0; i < rule.Local.rows(); ++i)
          {
            sum += volume * rule.Weights[i] *
              Density<Dim>(batch, e * rule.Local.rows() + i, IsPlane(kind));
          }
        }
      },
      patch);
  }
  return sum;
}

/// Smallest density of all patches over the largest.
double SmallestDensity(const std::vector<AnySpline>& patches, const ShapeParams& s)
{
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (const AnySpline& patch : patches)
  {
    std::visit(
      [&](const auto& spline)
      {
        using Space = typename std::decay_t<decltype(*spline.Space)>;
        constexpr int Dim = std::tuple_size<decltype(typename Space::Element{}.Degree)>::value;
        const double margin = IsDegenerate(s) ? 0.01 : 0.0;
        const EvaluationBatch batch = Evaluate<Dim>(spline, Lattice<Dim>(9, margin, 1.0 - margin));
        for (Eigen::Index i = 0; i < batch.Values.rows(); ++i)
        {
          const double density = Density<Dim>(batch, i, IsPlane(s.Kind));
          smallest = std::min(smallest, density);
          largest = std::max(largest, density);
        }
      },
      patch);
  }
  return smallest / largest;
}

/// Distance from zero of the equation that every point with local parameter 1 in `direction` (or
/// every point when it is negative) has to fulfil.
template <int Dim, typename Equation>
double WorstEquation(const AnySpline& patch, int direction, double at, const Equation& equation)
{
  const Spline<Dim>& spline = std::get<Spline<Dim>>(patch);
  PointMatrix local = Lattice<Dim>(8);
  if (direction >= 0)
  {
    local.col(direction).setConstant(at);
  }
  const EvaluationBatch batch = Evaluate<Dim>(spline, local);
  double worst = 0.0;
  for (Eigen::Index i = 0; i < batch.Values.rows(); ++i)
  {
    worst = std::max(worst, std::abs(equation(Eigen::Vector3d(batch.Values.row(i).transpose()))));
  }
  return worst;
}

/// Homogeneous control points of one side: lower or upper end of a direction.
struct Side
{
  int Patch = 0;
  std::vector<int> Size;
  PointMatrix Points;
};

std::vector<Side> Sides(const std::vector<AnySpline>& patches)
{
  std::vector<Side> sides;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    std::visit(
      [&](const auto& spline)
      {
        const auto& knots = spline.Space->Knots;
        PointMatrix rows(spline.Space->NumFunctions, 4);
        rows.leftCols(3) = spline.ControlPoints;
        rows.col(3).setOnes();
        if (spline.IsRational())
        {
          rows.col(3) = spline.Weights;
        }
        for (std::size_t d = 0; d < knots.size(); ++d)
        {
          for (const int at : { 0, knots[d].NumFunctions() - 1 })
          {
            Side side;
            side.Patch = static_cast<int>(p);
            side.Points.resize(rows.rows() / knots[d].NumFunctions(), 4);
            for (std::size_t k = 0; k < knots.size(); ++k)
            {
              if (k != d)
              {
                side.Size.push_back(knots[k].NumFunctions());
              }
            }
            Eigen::Index next = 0;
            for (Eigen::Index i = 0; i < rows.rows(); ++i)
            {
              Eigen::Index rest = i;
              for (std::size_t k = 0; k < d; ++k)
              {
                rest /= knots[k].NumFunctions();
              }
              if (rest % knots[d].NumFunctions() == at)
              {
                side.Points.row(next++) = rows.row(i);
              }
            }
            sides.push_back(side);
          }
        }
      },
      patches[p]);
  }
  return sides;
}

/// Largest difference of two sides in their best relative orientation.
double Distance(const Side& a, const Side& b)
{
  double best = std::numeric_limits<double>::infinity();
  if (a.Points.rows() != b.Points.rows())
  {
    return best;
  }
  const int n = a.Size[0];
  const int m = a.Size.size() > 1 ? a.Size[1] : 1;
  for (int orientation = 0; orientation < 8; ++orientation)
  {
    const bool swap = (orientation & 4) != 0;
    if (swap ? (b.Size[0] != m || b.Size.back() != n) : (b.Size[0] != n))
    {
      continue;
    }
    double worst = 0.0;
    for (int j = 0; j < m; ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        const int k = (orientation & 1) != 0 ? n - 1 - i : i;
        const int l = (orientation & 2) != 0 ? m - 1 - j : j;
        const int at = swap ? l + m * k : k + n * l;
        worst = std::max(worst, (a.Points.row(i + n * j) - b.Points.row(at)).cwiseAbs().maxCoeff());
      }
    }
    best = std::min(best, worst);
  }
  return best;
}
}

TEST(Shapes, MeasureIsThatOfTheBody_ExactOracle)
{
  for (const ShapeKind kind : AllKinds())
  {
    SCOPED_TRACE(ToString(kind));
    ShapeParams params = Params(kind);
    params.Elements = { 2, 2, 2 }; // the quadrature of rational integrands converges to rounding
    const double exact = ExactMeasure(params);
    EXPECT_NEAR(Measure(Make(params), kind), exact, 1e-11 * exact);
    params.Center = { 3.0, -2.0, 5.0 };
    params.Degree = 5;
    params.Elements = { 1, 2, 1 };
    EXPECT_NEAR(Measure(Make(params), kind), exact, 1e-7 * exact);
  }
}

TEST(Shapes, MapsAreRightHandedAndRegular_PropertyOracle)
{
  for (const ShapeKind kind : AllKinds())
  {
    SCOPED_TRACE(ToString(kind));
    for (const double angle : { 30.0, 90.0, 250.0, 360.0 })
    {
      ShapeParams params = Params(kind);
      params.Angle = angle;
      const double share = SmallestDensity(Make(params), params);
      EXPECT_GT(share, IsDegenerate(params) ? 1e-4 : 0.01) << "angle " << angle;
      params.Degree = 3;
      params.Elements = { 2, 3, 1 };
      EXPECT_GT(SmallestDensity(Make(params), params), IsDegenerate(params) ? 1e-5 : 0.01);
    }
  }
}

TEST(Shapes, NormalsOfSurfacesPointOutward_PropertyOracle)
{
  for (const ShapeKind kind : { ShapeKind::CylinderSurface, ShapeKind::SphereSurface,
         ShapeKind::PolarSphereSurface, ShapeKind::TorusSurface })
  {
    SCOPED_TRACE(ToString(kind));
    const ShapeParams params = Params(kind);
    for (const AnySpline& patch : Make(params))
    {
      const EvaluationBatch batch =
        Evaluate<2>(std::get<Spline<2>>(patch), Lattice<2>(7, 0.02, 0.98));
      for (Eigen::Index i = 0; i < batch.Values.rows(); ++i)
      {
        Eigen::Vector3d out = batch.Values.row(i).transpose();
        if (kind == ShapeKind::CylinderSurface)
        {
          out.z() = 0.0;
        }
        if (kind == ShapeKind::TorusSurface)
        {
          out.head<2>() -= params.OuterRadius * out.head<2>().normalized();
        }
        const Eigen::Vector3d u = batch.First.row(i).head<3>().transpose();
        const Eigen::Vector3d v = batch.First.row(i).tail<3>().transpose();
        EXPECT_GT(u.cross(v).normalized().dot(out.normalized()), 1.0 - 1e-12);
      }
    }
  }
}

TEST(Shapes, RoundSidesAreExact_ExactOracle)
{
  for (const bool finer : { false, true })
  {
    SCOPED_TRACE(finer ? "degree 5, 3 elements" : "as it is");
    const auto make = [&](ShapeKind kind)
    {
      ShapeParams params = Params(kind);
      if (finer)
      {
        params.Degree = 5;
        params.Elements = { 3, 3, 3 };
      }
      return Make(params);
    };
    const ShapeParams s = Params(ShapeKind::Line);
    // rounding of sums of positive terms; elevation and knots add some more
    const double tolerance = (finer ? 4e-14 : 1e-14) * s.OuterRadius;
    const auto ring = [](double radius)
    { return [radius](const Eigen::Vector3d& p) { return p.head<2>().norm() - radius; }; };
    const auto ball = [](double radius)
    { return [radius](const Eigen::Vector3d& p) { return p.norm() - radius; }; };
    const auto torus = [&s](const Eigen::Vector3d& p)
    { return std::hypot(p.head<2>().norm() - s.OuterRadius, p.z()) - s.InnerRadius; };
    EXPECT_LE(WorstEquation<1>(make(ShapeKind::Arc)[0], -1, 0, ring(s.OuterRadius)), tolerance);
    EXPECT_LE(
      WorstEquation<2>(make(ShapeKind::CylinderSurface)[0], -1, 0, ring(s.OuterRadius)), tolerance);
    for (const AnySpline& face : make(ShapeKind::SphereSurface))
    {
      EXPECT_LE(WorstEquation<2>(face, -1, 0, ball(s.OuterRadius)), tolerance);
    }
    EXPECT_LE(WorstEquation<2>(make(ShapeKind::PolarSphereSurface)[0], -1, 0, ball(s.OuterRadius)),
      tolerance);
    EXPECT_LE(WorstEquation<2>(make(ShapeKind::TorusSurface)[0], -1, 0, torus), tolerance);
    if (finer)
    {
      continue; // local parameter 1 of every element is not the outer side any more
    }
    const auto disc = make(ShapeKind::Disc);
    const auto solid = make(ShapeKind::SolidCylinder);
    const auto ballPatches = make(ShapeKind::Ball);
    const auto torusPatches = make(ShapeKind::SolidTorus);
    for (std::size_t i = 1; i < 5; ++i)
    {
      EXPECT_LE(WorstEquation<2>(disc[i], 0, 1.0, ring(s.OuterRadius)), tolerance);
      EXPECT_LE(WorstEquation<3>(solid[i], 0, 1.0, ring(s.OuterRadius)), tolerance);
      EXPECT_LE(WorstEquation<3>(torusPatches[i], 0, 1.0, torus), tolerance);
    }
    for (std::size_t i = 1; i < 7; ++i)
    {
      EXPECT_LE(WorstEquation<3>(ballPatches[i], 2, 1.0, ball(s.OuterRadius)), tolerance);
    }
    for (const AnySpline& patch : make(ShapeKind::PlateWithHole))
    {
      EXPECT_LE(WorstEquation<2>(patch, 0, 0.0, ring(s.InnerRadius)), tolerance);
    }
    const auto sector = make(ShapeKind::BallSector);
    EXPECT_LE(WorstEquation<3>(sector[0], 0, 0.0, ball(s.InnerRadius)), tolerance);
    EXPECT_LE(WorstEquation<3>(sector[0], 0, 1.0, ball(s.OuterRadius)), tolerance);
    const auto tube = make(ShapeKind::SolidTube);
    EXPECT_LE(WorstEquation<3>(tube[0], 0, 0.0, ring(s.InnerRadius)), tolerance);
    EXPECT_LE(WorstEquation<3>(tube[0], 0, 1.0, ring(s.OuterRadius)), tolerance);
  }
}

TEST(Shapes, PatchesMeetInPointsWeightsAndKnots_GoldenOracle)
{
  // sides that another patch has too, counted by hand: two for every inner edge or face
  const std::vector<std::pair<ShapeKind, int>> cases{ { ShapeKind::Disc, 16 },
    { ShapeKind::PlateWithHole, 8 }, { ShapeKind::QuarterPlateWithHole, 2 },
    { ShapeKind::SphereSurface, 24 }, { ShapeKind::SolidCylinder, 16 }, { ShapeKind::Ball, 36 },
    { ShapeKind::SolidTorus, 16 } };
  for (const auto& [kind, expected] : cases)
  {
    SCOPED_TRACE(ToString(kind));
    for (const bool finer : { false, true })
    {
      ShapeParams params = Params(kind);
      if (finer)
      {
        params.Degree = 5;
        params.Elements = { 2, 3, 2 };
      }
      const std::vector<Side> sides = Sides(Make(params));
      int shared = 0;
      for (const Side& a : sides)
      {
        for (const Side& b : sides)
        {
          shared += a.Patch != b.Patch && Distance(a, b) < 1e-13 ? 1 : 0;
        }
      }
      EXPECT_EQ(shared, expected);
    }
  }
}

TEST(Shapes, DegreeAndElementsAreThoseAskedFor_GoldenOracle)
{
  ShapeParams params = Params(ShapeKind::SolidTube); // 250 degrees: three knot spans
  params.Degree = 3;
  params.Elements = { 2, 4, 5 };
  const auto tube = std::get<Spline<3>>(Make(params)[0]);
  EXPECT_EQ(tube.Space->NumElements(), 2 * (3 * 4) * 5);
  for (const KnotVector& knots : tube.Space->Knots)
  {
    EXPECT_EQ(knots.Degree(), 3);
  }
  EXPECT_TRUE(tube.IsRational());
  EXPECT_EQ(tube.Space->NumFunctions, (3 + 2) * (3 + 12 + 2 * 2) * (3 + 5));

  params = Params(ShapeKind::Disc);
  params.Elements = { 2, 3, 1 };
  const auto disc = Make(params);
  EXPECT_EQ(std::get<Spline<2>>(disc[0]).Space->NumElements(), 9);
  EXPECT_FALSE(std::get<Spline<2>>(disc[0]).IsRational());
  EXPECT_EQ(std::get<Spline<2>>(disc[1]).Space->NumElements(), 6);
}

TEST(Shapes, NamesAndDimensionsFit_GoldenOracle)
{
  for (const ShapeKind kind : AllKinds())
  {
    ASSERT_NE(ToString(kind), nullptr);
    for (const AnySpline& patch : Make(Params(kind)))
    {
      EXPECT_EQ(static_cast<int>(patch.index()) + 1, NumParameters(kind)) << ToString(kind);
    }
  }
  EXPECT_EQ(ToString(static_cast<ShapeKind>(NumShapeKinds)), nullptr);
}

TEST(Shapes, EveryFailureIsReachable)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expectBad = [](ShapeKind kind, const char* word, auto change)
  {
    ShapeParams params;
    params.Kind = kind;
    change(params);
    const auto shape = MakeShape(params);
    EXPECT_EQ(shape.Status.Code, ErrorCode::InvalidParameter) << word;
    EXPECT_NE(shape.Status.Detail.find(word), std::string::npos) << shape.Status.Detail;
    EXPECT_TRUE(shape.Value.empty());
  };
  using P = ShapeParams;
  expectBad(static_cast<ShapeKind>(99), "no shape number", [](P&) {});
  expectBad(ShapeKind::Square, "degree", [](P& p) { p.Degree = 10; });
  expectBad(ShapeKind::Square, "number of elements", [](P& p) { p.Elements[1] = 0; });
  expectBad(ShapeKind::Square, "centre", [&](P& p) { p.Center[2] = nan; });
  expectBad(ShapeKind::Square, "sizes", [](P& p) { p.Size[1] = 0.0; });
  expectBad(ShapeKind::Disc, "inner radius must be positive", [](P& p) { p.InnerRadius = 0.0; });
  expectBad(ShapeKind::Disc, "less than", [](P& p) { p.InnerRadius = 1.0; });
  expectBad(ShapeKind::Arc, "outer radius", [&](P& p) { p.OuterRadius = nan; });
  expectBad(ShapeKind::PlateWithHole, "hole", [](P& p) { p.InnerRadius = 0.5; });
  expectBad(ShapeKind::Arc, "angle", [](P& p) { p.Angle = 361.0; });
  expectBad(ShapeKind::BallSector, "polar angle", [](P& p) { p.PolarAngle = 0.0; });
  expectBad(ShapeKind::TwistedBar, "twist", [&](P& p) { p.Twist = nan; });
  expectBad(ShapeKind::SolidTube, "height", [](P& p) { p.Height = -1.0; });
  ShapeParams huge;
  huge.Kind = ShapeKind::Cube;
  huge.Elements = { 2000, 2000, 2000 };
  EXPECT_EQ(MakeShape(huge).Status.Code, ErrorCode::TooLarge);
}

// Oracle: the ring of sectors covers the annulus and neighbours' sides are the same numbers.
TEST(Shapes, SectorsShareTheirSidesBitForBit_ExactOracle)
{
  ShapeParams params = Params(ShapeKind::AnnulusSector);
  params.Angle = 360.0;
  params.Sectors = 7;
  const auto patches = Make(params);
  ASSERT_EQ(patches.size(), 7u);
  for (std::size_t k = 0; k < patches.size(); ++k)
  {
    const auto& spline = std::get<Spline<2>>(patches[k]);
    const auto& next = std::get<Spline<2>>(patches[(k + 1) % 7]);
    const Eigen::Index last = spline.ControlPoints.rows() - 2; // radial direction first, two points
    EXPECT_EQ(spline.ControlPoints.row(last), next.ControlPoints.row(0)) << "inner end of " << k;
    EXPECT_EQ(spline.ControlPoints.row(last + 1), next.ControlPoints.row(1))
      << "outer end of " << k;
  }
  params.Sectors = 0;
  EXPECT_EQ(MakeShape(params).Status.Code, ErrorCode::InvalidParameter);
}
