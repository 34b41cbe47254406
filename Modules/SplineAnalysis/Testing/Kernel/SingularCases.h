// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "AnalysisCases.h"
#include <knotwork/SplineAnalysis/AdaptiveSolution.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <gtest/gtest.h>

/// Bodies with a re-entrant corner and solutions on them that are known.
namespace knotwork::testing
{
/// The square (-1, 1)^2 without x > 0, y < 0, in space times (0, 1), of n elements along each of
/// its four legs: one patch, C^0 on the diagonal. The first parameter runs along the legs, the
/// second from the re-entrant sides outwards.
template <int Dim>
Spline<Dim> LShape(int degree, int n)
{
  std::vector<double> along(static_cast<std::size_t>(degree) + 1, 0.0);
  for (int i = 1; i < 2 * n; ++i)
  {
    along.insert(along.end(), i == n ? static_cast<std::size_t>(degree) : 1, 1.0 * i / n);
  }
  along.insert(along.end(), static_cast<std::size_t>(degree) + 1, 2.0);
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(degree, n));
  knots[0] = KnotVector::Create(degree, along).Value;
  Spline<Dim> spline;
  spline.Space = MakeTensorSpace<Dim>(knots).Value;
  spline.ControlPoints = GrevillePoints(*spline.Space);
  for (Eigen::Index i = 0; i < spline.ControlPoints.rows(); ++i)
  {
    const double a = spline.ControlPoints(i, 0);
    const double b = spline.ControlPoints(i, 1);
    const double first = std::min(a, 1.0);        // of the leg up
    const double second = std::max(a - 1.0, 0.0); // of the leg to the right
    spline.ControlPoints(i, 0) = second - b + b * second;
    spline.ControlPoints(i, 1) = first - 1.0 + b * first;
  }
  return spline;
}

/// Angle at the re-entrant corner, from 0 at +x to 3 pi / 2 at -y.
inline double CornerAngle(const double* x)
{
  const double angle = std::atan2(x[1], x[0]);
  return angle < -0.1 ? angle + 8.0 * std::atan(1.0) : angle;
}

/// r^(2/3) sin(2 angle / 3), harmonic, 0 on the re-entrant sides.
inline void CornerSolution(const double* x, double* u)
{
  u[0] = std::pow(std::hypot(x[0], x[1]), 2.0 / 3.0) * std::sin(2.0 / 3.0 * CornerAngle(x));
}
/// Of dimension n.
inline PointFunction CornerGradient(int n)
{
  return [n](const double* x, double* g)
  {
    // derivative of the imaginary part of z^(2/3)
    const double r = std::hypot(x[0], x[1]);
    const double angle = CornerAngle(x) / 3.0;
    const double size = r > 0.0 ? 2.0 / 3.0 * std::pow(r, -1.0 / 3.0) : 0.0;
    g[0] = -size * std::sin(angle);
    g[1] = size * std::cos(angle);
    if (n == 3)
    {
      g[2] = 0.0;
    }
  };
}

/// 0 on the re-entrant sides and the flux of the solution on all others.
template <int Dim>
Result<GalerkinProblem> CornerProblem(const Spline<Dim>& spline, const GalerkinSpace&)
{
  GalerkinProblem problem;
  problem.Prescribed.push_back({ FacetsOfSide(*spline.Space, 2).Value, -1, {} });
  FacetLoad load;
  for (const int side : { 0, 1, 3, 4, 5 })
  {
    if (side < 2 * Dim)
    {
      const auto facets = FacetsOfSide(*spline.Space, side).Value;
      load.Facets.insert(load.Facets.end(), facets.begin(), facets.end());
    }
  }
  load.Values = [](const double* x, const double* normal, double* flux)
  {
    std::array<double, 2> g{};
    CornerGradient(2)(x, g.data());
    flux[0] = g[0] * normal[0] + g[1] * normal[1];
  };
  problem.Loads.push_back(load);
  return problem;
}

/// Half of a(u, u) of the corner's solution on the L-shape: the work of its flux on the outer
/// sides.
inline double CornerEnergy()
{
  double sum = 0.0;
  const QuadratureRule rule = GaussLegendre(40);
  const auto add = [&](double ax, double ay, double bx, double by, double nx, double ny)
  {
    for (std::size_t q = 0; q < rule.Nodes.size(); ++q)
    {
      const double t = rule.Nodes[q];
      const std::array<double, 2> x{ ax + t * (bx - ax), ay + t * (by - ay) };
      double u = 0.0;
      std::array<double, 2> g{};
      CornerSolution(x.data(), &u);
      CornerGradient(2)(x.data(), g.data());
      sum += 0.5 * rule.Weights[q] * std::hypot(bx - ax, by - ay) * u * (g[0] * nx + g[1] * ny);
    }
  };
  add(-1, -1, 0, -1, 0, -1);
  add(-1, -1, -1, 1, -1, 0);
  add(-1, 1, 1, 1, 0, 1);
  add(1, 0, 1, 1, 1, 0);
  return sum;
}
/// Error in the norm of energy of a solution of CornerProblem, whose values are 0 where they are
/// prescribed: what its energy lacks.
inline double CornerError(double energy)
{
  return std::sqrt(std::max(0.0, 2.0 * (CornerEnergy() - energy)));
}

/// The field of symmetric opening at the re-entrant corner, which is free: plane strain, E = 1,
/// Poisson's ratio 0.3, r^0.5445. @source  Szabo, Babuska, Finite Element Analysis, 1991, 4.2; the
/// form of Alberty and others, Computing 69 (2002) 239-263, section 6.
class OpenedCorner
{
public:
  static GalerkinMaterial Material() { return { 1.0, 1.0, 0.3 }; }

  PointFunction Values() const
  {
    return [field = *this](const double* x, double* u)
    {
      const Polar at(field, x);
      Eigen::Map<Eigen::Vector2d>(u, 2) =
        at.Size * (at.Radial * at.Value[0] + at.Turned * at.Value[1]);
    };
  }
  PointFunction Gradient() const
  {
    return [field = *this](const double* x, double* g)
    {
      const Polar at(field, x);
      const Eigen::Vector2d along =
        field.Order * (at.Radial * at.Value[0] + at.Turned * at.Value[1]);
      const Eigen::Vector2d across =
        at.Radial * (at.Slope[0] - at.Value[1]) + at.Turned * (at.Slope[1] + at.Value[0]);
      const double r = std::hypot(x[0], x[1]);
      Eigen::Map<Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>(g, 2, 2) =
        at.Size / r * (along * at.Radial.transpose() + across * at.Turned.transpose());
    };
  }
  /// Values on all sides but the re-entrant ones.
  Result<GalerkinProblem> Problem(const Spline<2>& spline) const
  {
    GalerkinProblem problem;
    problem.Equation = GalerkinEquation::PlaneStrain;
    problem.Materials[0] = Material();
    PrescribedValues values;
    values.Values = this->Values();
    for (const int side : { 0, 1, 3 })
    {
      const auto facets = FacetsOfSide(*spline.Space, side).Value;
      values.Facets.insert(values.Facets.end(), facets.begin(), facets.end());
    }
    problem.Prescribed.push_back(values);
    return problem;
  }

private:
  double Order = 0.544483736782464; // a sin(3 pi / 2) + sin(3 pi a / 2) = 0

  /// Radial and angular components and their derivatives by the angle, without r^Order.
  struct Polar
  {
    Eigen::Vector2d Radial, Turned;
    std::array<double, 2> Value, Slope;
    double Size;

    Polar(const OpenedCorner& field, const double* x)
    {
      const double pi = 4.0 * std::atan(1.0);
      const double a = field.Order;
      const double half = 0.75 * pi;
      const double shear = Material().YoungsModulus / (2.0 * (1.0 + Material().PoissonsRatio));
      const double c1 = -std::cos((a + 1.0) * half) / std::cos((a - 1.0) * half);
      const double c2 = 4.0 * (1.0 - Material().PoissonsRatio); // 2 (l + 2 m) / (l + m)
      const double angle = CornerAngle(x);
      const double t = angle - half; // from the axis of symmetry
      this->Radial << std::cos(angle), std::sin(angle);
      this->Turned << -std::sin(angle), std::cos(angle);
      this->Size = std::pow(std::hypot(x[0], x[1]), a) / (2.0 * shear);
      this->Value[0] =
        -(a + 1.0) * std::cos((a + 1.0) * t) + (c2 - a - 1.0) * c1 * std::cos((a - 1.0) * t);
      this->Value[1] =
        (a + 1.0) * std::sin((a + 1.0) * t) + (c2 + a - 1.0) * c1 * std::sin((a - 1.0) * t);
      this->Slope[0] = (a + 1.0) * (a + 1.0) * std::sin((a + 1.0) * t) -
        (c2 - a - 1.0) * c1 * (a - 1.0) * std::sin((a - 1.0) * t);
      this->Slope[1] = (a + 1.0) * (a + 1.0) * std::cos((a + 1.0) * t) +
        (c2 + a - 1.0) * c1 * (a - 1.0) * std::cos((a - 1.0) * t);
    }
  };
};
/// Slope of errors against functions, by least squares in logarithms over the last rows.
inline double Slope(const std::vector<std::array<double, 2>>& rows, std::size_t last)
{
  const auto count = static_cast<Eigen::Index>(last);
  Eigen::ArrayXd x(count);
  Eigen::ArrayXd y(count);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const auto& row = rows[rows.size() - static_cast<std::size_t>(count - i)];
    x[i] = std::log(row[0]);
    y[i] = std::log(row[1]);
  }
  x -= x.mean();
  return -(x * (y - y.mean())).sum() / x.square().sum();
}

/// Functions at which errors that fall with a row for each space reach one, between rows by their
/// slope. The last row when it is not reached.
inline double FunctionsAt(const std::vector<std::array<double, 2>>& rows, double error)
{
  for (std::size_t i = 1; i < rows.size(); ++i)
  {
    if (rows[i][1] <= error)
    {
      const double share = std::log(rows[i - 1][1] / error) / std::log(rows[i - 1][1] / rows[i][1]);
      return rows[i - 1][0] * std::pow(rows[i][0] / rows[i - 1][0], share);
    }
  }
  return rows.back()[0];
}

/// Error of the corner's solution on a uniform mesh, with its functions.
template <int Dim>
std::array<double, 2> UniformCorner(int degree, int n)
{
  const Spline<Dim> spline = LShape<Dim>(degree, n);
  const auto space = MakeGalerkinSpace(spline);
  GalerkinParams params;
  params.DirectLimit = Dim == 2 ? 300000 : 20000; // factors of solids are large
  const auto solution =
    SolveGalerkin(space.Value, CornerProblem<Dim>(spline, space.Value).Value, params);
  EXPECT_TRUE(solution) << solution.Status.Message();
  return { static_cast<double>(space->NumFunctions()), CornerError(solution->Energy) };
}

/// Rows (functions, error) of an adaptive solution of the corner, whose estimates must be right.
inline std::vector<std::array<double, 2>> CornerRows(const std::vector<AdaptiveStep>& history)
{
  std::vector<std::array<double, 2>> rows;
  for (const AdaptiveStep& step : history)
  {
    const double error = CornerError(step.Energy);
    rows.push_back({ static_cast<double>(step.Functions), error });
    EXPECT_GT(step.Estimate / error, 0.5) << step.Functions << " functions";
    EXPECT_LT(step.Estimate / error, 4.0) << step.Functions << " functions";
    std::printf(
      "[ step     ] %6d functions %6d elements: error %.3e estimate %.3f of it, %d marked, "
      "seconds %.2f %.2f %.2f\n",
      step.Functions, step.Elements, error, step.Estimate / error, step.Marked, step.SecondsSolve,
      step.SecondsEstimate, step.SecondsRefine);
  }
  return rows;
}

/// The re-entrant edge in space: functions of an adaptive solution with the error of a uniform one
/// of n elements along a leg.
inline void ExpectEdge(int degree, int maxFunctions, int n, double share)
{
  AdaptiveParams params;
  params.MaxFunctions = maxFunctions;
  const auto result = SolveAdaptively<3>(LShape<3>(degree, 2), CornerProblem<3>, params);
  ASSERT_TRUE(result) << result.Status.Message();
  const auto rows = CornerRows(result->History);
  const auto uniform = UniformCorner<3>(degree, n);
  const double needed = FunctionsAt(rows, uniform[1]);
  std::printf(
    "[ edge     ] error %.2e of %.0f uniform functions needs %.0f; order of the last steps "
    "%.3f\n",
    uniform[1], uniform[0], needed, Slope(rows, 4));
  EXPECT_LE(rows.back()[1], uniform[1]);
  EXPECT_LE(needed, share * uniform[0]);
}
}
