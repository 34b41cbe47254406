// SPDX-License-Identifier: BSD-3-Clause
#include "Rates.h"

#include <gtest/gtest.h>

#include <cstring>

namespace knotwork::testing
{
namespace
{
/// Quarter of a body around the origin: held on x = 0 and y = 0 as symmetry wants it.
GalerkinProblem SymmetricProblem(
  const AnalysisCase& body, GalerkinEquation equation, FacetFunction traction)
{
  GalerkinProblem problem;
  problem.Equation = equation;
  problem.Materials[0] = { 1.0, 10.0, 0.3 };
  problem.Prescribed.resize(2);
  problem.Prescribed[0].Component = 0;
  problem.Prescribed[1].Component = 1;
  FacetLoad load;
  load.Values = std::move(traction);
  for (const CellSide& facet : body.Boundary)
  {
    // planes of symmetry by the points of the facet
    std::array<double, 2> largest{};
    for (const double t : { 0.0, 0.5, 1.0 })
    {
      std::array<double, 3> u{ t, t, t };
      u[static_cast<std::size_t>(facet.Side / 2)] = facet.Side % 2;
      const Eigen::VectorXd x = EvaluateSolution(
        body.Space, {}, PointMatrix::Zero(body.Space.NumFunctions(), 1), facet.Cell, u.data())
                                  .Position;
      largest[0] = std::max(largest[0], std::abs(x[0]));
      largest[1] = std::max(largest[1], std::abs(x[1]));
    }
    (largest[0] < 1e-12      ? problem.Prescribed[0].Facets
        : largest[1] < 1e-12 ? problem.Prescribed[1].Facets
                             : load.Facets)
      .push_back(facet);
  }
  problem.Loads.push_back(load);
  return problem;
}
}

TEST(Convergence, PoissonOnSplines_ExactOracle)
{
  for (const int p : { 2, 3 })
  {
    ExpectRates("tensor", p, 8, [p](int n) { return CaseOf<2>("", BentBox<2>(p, n)); });
    ExpectRates("unstructured", p, 8, [p](int n) { return CaseOf<2>("", BentStar<2>(5, n, p)); });
    ExpectRates("THB", p, 8,
      [p](int n)
      {
        std::vector<int> marked; // a quarter of the elements
        for (int e = 0; e < n * n / 4; ++e)
        {
          marked.push_back(e % (n / 2) + e / (n / 2) * n);
        }
        return CaseOf<2>("", RefineMarkedElements(BentBox<2>(p, n), marked)->Value);
      });
    ExpectRates("LR", p, 8,
      [p](int n)
      {
        std::vector<int> marked;
        for (int e = 0; e < n * n / 4; ++e)
        {
          marked.push_back(e % (n / 2) + e / (n / 2) * n);
        }
        return CaseOf<2>("", RefineMarkedLR(BentBox<2>(p, n), marked)->Value);
      });
    ExpectRates("rational", p, 20,
      [p](int n)
      {
        ShapeParams ring;
        ring.Kind = ShapeKind::AnnulusSector;
        ring.Degree = p;
        ring.Elements = { n, n, 1 };
        return CaseOf<2>("", ShapePatches<2>(ring)[0]);
      });
    ExpectRates("multi-patch", p, 16,
      [p](int n)
      {
        ShapeParams disc;
        disc.Kind = ShapeKind::Disc;
        disc.Degree = p;
        disc.Elements = { n, n, 1 };
        return MultiPatchCase<2>("", disc);
      });
  }
}

TEST(Convergence, PoissonOnLagrangeElements_ExactOracle)
{
  for (const int p : { 1, 2, 3 })
  {
    ExpectRates("triangles", p, 10, [p](int n) { return LagrangeCase(CellShape::Triangle, p, n); });
    ExpectRates(
      "quadrilaterals", p, 8, [p](int n) { return LagrangeCase(CellShape::Quadrilateral, p, n); });
    ExpectRates("tetrahedra", p,
      p == 1     ? 8
        : p == 2 ? 4
                 : 3,
      [p](int n) { return LagrangeCase(CellShape::Tetrahedron, p, n); });
  }
}

// What straight sides cost: on a ring whose curved sides are held at 0, elements of order 2 lose
// half an order. Strang, Fix, An Analysis of the Finite Element Method, 1973, 4.4.
TEST(Convergence, StraightSidesLoseHalfAnOrder_ExactOracle)
{
  // u = (r - 1) (2 - r), -div grad u = 4 - 3 / r
  const auto ring = [](double* x)
  {
    const double r = 1.0 + x[0];
    const double angle = 2.0 * std::atan(1.0) * x[1];
    x[0] = r * std::cos(angle);
    x[1] = r * std::sin(angle);
  };
  const auto value = [](const double* x, double* u)
  {
    const double r = std::hypot(x[0], x[1]);
    u[0] = (r - 1.0) * (2.0 - r);
  };
  const auto gradient = [](const double* x, double* g)
  {
    const double r = std::hypot(x[0], x[1]);
    g[0] = (3.0 - 2.0 * r) * x[0] / r;
    g[1] = (3.0 - 2.0 * r) * x[1] / r;
  };
  for (const bool straight : { false, true })
  {
    std::array<double, 2> errors{};
    for (std::size_t k = 0; k < 2; ++k)
    {
      const AnalysisCase body =
        MappedLagrangeCase(CellShape::Triangle, 2, k == 0 ? 12 : 24, ring, straight);
      GalerkinProblem problem;
      problem.Source = [](const double* x, double* f)
      { f[0] = 4.0 - 3.0 / std::hypot(x[0], x[1]); };
      PrescribedValues curved;
      PrescribedValues ends;
      ends.Values = value;
      for (const CellSide& facet : body.Boundary)
      {
        // straight ends lie on the axes
        bool onAxis = true;
        for (const int f : { 0, 1 })
        {
          const auto corners = SideCorners(CellShape::Triangle, { 2, 2, 0 }, facet.Side);
          const double u[] = { corners[static_cast<std::size_t>(f)][0] / 2.0,
            corners[static_cast<std::size_t>(f)][1] / 2.0, 0.0 };
          const Eigen::VectorXd x = EvaluateSolution(
            body.Space, problem, PointMatrix::Zero(body.Space.NumFunctions(), 1), facet.Cell, u)
                                      .Position;
          onAxis = onAxis && std::min(std::abs(x[0]), std::abs(x[1])) < 1e-12;
        }
        (onAxis ? ends : curved).Facets.push_back(facet);
      }
      problem.Prescribed = { curved, ends };
      const auto solution = SolveGalerkin(body.Space, problem);
      ASSERT_TRUE(solution) << solution.Status.Message();
      errors[k] = SolutionError(body.Space, solution->Coefficients, value, gradient).H1;
    }
    const double rate = std::log2(errors[0] / errors[1]);
    std::printf(
      "[ rates    ] %s triangles of order 2: H1 %.3f\n", straight ? "straight" : "curved", rate);
    EXPECT_NEAR(rate, straight ? 1.5 : 2.0, 0.15);
  }
}

TEST(Convergence, ThickCylinderUnderPressure_ExactOracle)
{
  ShapeParams ring;
  ring.Kind = ShapeKind::AnnulusSector;
  ring.InnerRadius = 1.0;
  ring.OuterRadius = 2.0;
  ring.Degree = 3;
  ring.Elements = { 8, 8, 1 };
  const AnalysisCase body = CaseOf<2>("ring", ShapePatches<2>(ring)[0]);
  const double pressure = 3.0;
  const GalerkinProblem problem = SymmetricProblem(body, GalerkinEquation::PlaneStrain,
    [&](const double* x, const double* normal, double* traction)
    {
      const double p = std::hypot(x[0], x[1]) < 1.5 ? pressure : 0.0;
      traction[0] = -p * normal[0];
      traction[1] = -p * normal[1];
    });
  const auto solution = SolveGalerkin(body.Space, problem);
  ASSERT_TRUE(solution) << solution.Status.Message();
  // Lame: u_r = (1 + nu) p a^2 / (E (b^2 - a^2)) ((1 - 2 nu) r + b^2 / r)
  const double factor = 1.3 * pressure / (10.0 * 3.0);
  for (int e = 0; e < body.Space.NumElements(); ++e)
  {
    const std::array<double, 3> u{ 0.3, 0.6, 0.0 };
    const GalerkinPoint point =
      EvaluateSolution(body.Space, problem, solution.Value.Coefficients, e, u.data());
    const double r = point.Position.norm();
    const double exact = factor * (0.4 * r + 4.0 / r);
    EXPECT_NEAR(point.Value.dot(point.Position) / r, exact, 1e-6 * exact);
  }
  EXPECT_LE((solution.Value.TotalLoad + solution.Value.TotalReaction).norm(), 1e-10);
}

TEST(Convergence, PlateWithHole_ExactOracle)
{
  std::array<double, 2> errors{};
  std::array<double, 2> peaks{};
  for (std::size_t k = 0; k < 2; ++k)
  {
    ShapeParams plate;
    plate.Kind = ShapeKind::QuarterPlateWithHole;
    plate.InnerRadius = 1.0;
    plate.Size = { 8.0, 8.0, 1.0 };
    plate.Degree = 3;
    plate.Elements = { k == 0 ? 32 : 64, k == 0 ? 32 : 64, 1 };
    const AnalysisCase body = MultiPatchCase<2>("plate", plate);
    // Kirsch, J. VDI 42 (1898): tension 1 along x at infinity, hole of radius 1
    const auto stress = [](const double* x) -> Eigen::Matrix2d
    {
      const double q = 1.0 / (x[0] * x[0] + x[1] * x[1]);
      const double t = std::atan2(x[1], x[0]);
      Eigen::Matrix2d s;
      s(0, 0) = 1.0 - q * (1.5 * std::cos(2 * t) + std::cos(4 * t)) + 1.5 * q * q * std::cos(4 * t);
      s(1, 1) = -q * (0.5 * std::cos(2 * t) - std::cos(4 * t)) - 1.5 * q * q * std::cos(4 * t);
      s(0, 1) = -q * (0.5 * std::sin(2 * t) + std::sin(4 * t)) + 1.5 * q * q * std::sin(4 * t);
      s(1, 0) = s(0, 1);
      return s;
    };
    const GalerkinProblem problem = SymmetricProblem(body, GalerkinEquation::PlaneStress,
      [&](const double* x, const double* normal, double* traction)
      {
        const Eigen::Vector2d t = stress(x) * Eigen::Vector2d(normal[0], normal[1]);
        traction[0] = t[0];
        traction[1] = t[1];
      });
    const auto solution = SolveGalerkin(body.Space, problem);
    ASSERT_TRUE(solution) << solution.Status.Message();
    double peak = 0.0;
    double error = 0.0;
    for (int e = 0; e < body.Space.NumElements(); ++e)
    {
      for (const std::array<double, 3>& u : { std::array<double, 3>{ 0, 0, 0 }, { 1, 0, 0 },
             { 0, 1, 0 }, { 1, 1, 0 }, { 0.5, 0.5, 0 } })
      {
        const GalerkinPoint point =
          EvaluateSolution(body.Space, problem, solution.Value.Coefficients, e, u.data());
        peak = std::max(peak, point.Stress(0, 0));
        error = std::max(
          error, (point.Stress.topLeftCorner(2, 2) - stress(point.Position.data())).norm());
      }
    }
    errors[k] = error;
    peaks[k] = peak;
  }
  std::printf("[ plate    ] peak stress %.5f, %.5f, largest error of stress %.1e, %.1e\n", peaks[0],
    peaks[1], errors[0], errors[1]);
  EXPECT_NEAR(peaks[1], 3.0, 0.01 * 3.0);
  EXPECT_GE(std::log2(errors[0] / errors[1]), 2.7); // stress of degree 3: h^3
}

TEST(Convergence, BitsDoNotDependOnThreads_PropertyOracle)
{
  const AnalysisCase body = CaseOf<3>("box", BentBox<3>(2, 9));
  GalerkinProblem problem;
  problem.Equation = GalerkinEquation::Solid;
  problem.Source = [](const double*, double* f) { f[2] = -1.0; };
  problem.Prescribed.push_back({ { body.Boundary.begin(), body.Boundary.begin() + 81 }, -1, {} });
  GalerkinParams params;
  params.Threads = 1;
  for (const int limit : { 300000, 0 }) // factorized, and conjugate gradients
  {
    params.DirectLimit = limit;
    params.Threads = 1;
    const auto one = SolveGalerkin(body.Space, problem, params);
    ASSERT_TRUE(one) << one.Status.Message();
    EXPECT_LE((one->TotalLoad + one->TotalReaction).norm(), 1e-10);
    for (const int threads : { 2, 4 })
    {
      params.Threads = threads;
      const auto more = SolveGalerkin(body.Space, problem, params);
      ASSERT_TRUE(more) << more.Status.Message();
      EXPECT_EQ(std::memcmp(one->Coefficients.data(), more->Coefficients.data(),
                  static_cast<std::size_t>(one->Coefficients.size()) * sizeof(double)),
        0);
    }
    std::printf("[ speed    ] %d elements: assembly %.3f s, solve %.3f s, %d iterations\n",
      body.Space.NumElements(), one->SecondsAssembly, one->SecondsSolve, one->Iterations);
  }
}
}
