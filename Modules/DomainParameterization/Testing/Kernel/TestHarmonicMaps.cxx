// SPDX-License-Identifier: BSD-3-Clause
// Harmonic first maps against maps that are known by formulas: those of complex functions.
#include "DomainCases.h"
#include "GluedSystem.h"
#include "HarmonicMaps.h"
#include "InitialMaps.h"
#include <knotwork/DomainParameterization/DomainParameterization.h>
#include <knotwork/DomainParameterization/ParameterizeLayout.h>
#include <knotwork/SplineCore/Refinement.h>

#include "LayoutCases.h"

#include <gtest/gtest.h>

#include <complex>

namespace knotwork
{
namespace
{
using Complex = std::complex<double>;
/// Bernstein coefficients of t and t^2, degree 2.
const double Linear[] = { 0.0, 0.5, 1.0 };
const double Quadratic[] = { 0.0, 0.0, 1.0 };

/// z = alpha u + beta v + gamma: conformal in u and v when beta = i alpha.
struct Plane
{
  Complex Alpha, Beta, Gamma;
  Complex Value(int i, int j) const
  {
    return this->Alpha * Linear[i] + this->Beta * Linear[j] + this->Gamma;
  }
  double SquaredNorm(int i, int j) const
  {
    return std::norm(this->Alpha) * Quadratic[i] + std::norm(this->Beta) * Quadratic[j] +
      std::norm(this->Gamma) +
      2.0 *
      std::real(this->Alpha * std::conj(this->Beta) * Linear[i] * Linear[j] +
        std::conj(this->Gamma) * (this->Alpha * Linear[i] + this->Beta * Linear[j]));
  }
  Complex Square(int i, int j) const
  {
    return this->Alpha * this->Alpha * Quadratic[i] + this->Beta * this->Beta * Quadratic[j] +
      2.0 * this->Alpha * this->Beta * Linear[i] * Linear[j] +
      2.0 * this->Gamma * (this->Alpha * Linear[i] + this->Beta * Linear[j]) +
      this->Gamma * this->Gamma;
  }
};
const Plane Conformal{ { 0.9, 0.2 }, { -0.2, 0.9 }, { 1.1, -0.4 } };
const Plane Skewed{ { 1.4, 0.1 }, { 0.5, 0.8 }, { 1.1, -0.4 } };

template <int Dim>
Spline<Dim> Refined(Spline<Dim> map)
{
  for (int d = 0; d < Dim; ++d)
  {
    map = InsertKnots<Dim>(map, d, { 0.3, 0.55 + 0.05 * d }).Value;
  }
  return map;
}

/// (a z + b) / (c z + d) as a biquadratic rational map, refined.
Spline<2> Moebius(const Plane& plane)
{
  const Complex a{ 1.0, 0.3 }, b{ -0.2, 0.5 }, c{ 0.25, 0.15 }, d{ 1.0, -0.1 };
  Spline<2> map;
  map.Space = MakeTensorSpace<2>({ KnotVector::Uniform(2, 1), KnotVector::Uniform(2, 1) }).Value;
  map.ControlPoints.resize(9, 2);
  map.Weights.resize(9);
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      const Complex z = plane.Value(i, j);
      const double square = plane.SquaredNorm(i, j);
      const double weight =
        std::norm(c) * square + std::norm(d) + 2.0 * std::real(c * std::conj(d) * z);
      const Complex product = a * std::conj(c) * square + a * std::conj(d) * z +
        b * std::conj(c) * std::conj(z) + b * std::conj(d);
      map.ControlPoints.row(i + 3 * j) << product.real() / weight, product.imag() / weight;
      map.Weights[i + 3 * j] = weight;
    }
  }
  return Refined<2>(map);
}

/// z^2, and in space a third coordinate w + u / 2.
template <int Dim>
Spline<Dim> SquareMap(const Plane& plane)
{
  Spline<Dim> map;
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(2, 1));
  map.Space = MakeTensorSpace<Dim>(knots).Value;
  map.ControlPoints.resize(map.Space->NumFunctions, Dim);
  for (int f = 0; f < map.Space->NumFunctions; ++f)
  {
    const int i = f % 3;
    const Complex value = plane.Square(i, f / 3 % 3);
    map.ControlPoints(f, 0) = value.real();
    map.ControlPoints(f, 1) = value.imag();
    if (Dim == 3)
    {
      map.ControlPoints(f, 2) = Linear[f / 9] + 0.5 * Linear[i];
    }
  }
  return Refined<Dim>(map);
}

/// Inner control points are forgotten, then filled.
template <int Dim, typename Fill>
double ErrorAfter(const Spline<Dim>& exact, const Fill& fill)
{
  Spline<Dim> map = exact;
  const std::vector<bool> fixed = BoundaryFunctions<Dim>(*map.Space);
  for (std::size_t i = 0; i < fixed.size(); ++i)
  {
    if (!fixed[i])
    {
      map.ControlPoints.row(static_cast<Eigen::Index>(i)).setConstant(7.0);
    }
  }
  EXPECT_TRUE(fill(map));
  return (map.ControlPoints - exact.ControlPoints).cwiseAbs().maxCoeff();
}
}

// Condition of squared second derivatives, some 1e5 times rounding.
TEST(HarmonicMaps, HarmonicKnowsTheWeights_ExactOracle)
{
  const Spline<2> exact = Moebius(Conformal);
  const auto harmonic = [](Spline<2>& map) { return FillHarmonic<2>(map); };
  EXPECT_LT(ErrorAfter<2>(exact, harmonic), 1e-9);
  Spline<2> polynomial = exact;
  polynomial.Weights.resize(0);
  EXPECT_GT(ErrorAfter<2>(polynomial, harmonic), 1e-3); // as if polynomial: another map
}

// Harmonic functions have the least int |grad|^2: of all rational maps with these weights, but for
// the quadrature of rational functions.
TEST(HarmonicMaps, LeastEnergyKnowsTheWeights_ExactOracle)
{
  const GluedMap<2> exact = SingleMap<2>(Moebius(Conformal));
  const auto errorOf = [&](GluedOperator kind)
  {
    GluedMap<2> map = exact;
    for (std::size_t i = 0; i < map.Fixed.size(); ++i)
    {
      if (!map.Fixed[i])
      {
        map.Patches[0].ControlPoints.row(static_cast<Eigen::Index>(i)).setConstant(7.0);
      }
    }
    const GluedSystem<2> system(map, kind);
    EXPECT_TRUE(system.Fill(map));
    return (map.Patches[0].ControlPoints - exact.Patches[0].ControlPoints).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(errorOf(GluedOperator::Rational), 1e-8);
  EXPECT_GT(errorOf(GluedOperator::Laplacian), 1e-4);
}

TEST(HarmonicMaps, EqualWeightsAreNone_CrossOracle)
{
  const auto boundary = MakeCompatible<2>(cases::Bite(0.4, 0.5, 2.0, 3));
  ASSERT_TRUE(boundary);
  Spline<2> polynomial = MapOfBoundary<2>(boundary.Value);
  polynomial.Weights.resize(0);
  Spline<2> rational = polynomial;
  rational.Weights = Eigen::VectorXd::Constant(rational.Space->NumFunctions, 3.0);
  ASSERT_TRUE(FillHarmonic<2>(polynomial));
  ASSERT_TRUE(FillHarmonic<2>(rational));
  EXPECT_LT((polynomial.ControlPoints - rational.ControlPoints).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(HarmonicMaps, MapsWithAHarmonicInverseAreReproduced_ExactOracle)
{
  const auto variational = [](auto& map) { return FillVariationalHarmonic(map); };
  EXPECT_LT(ErrorAfter<2>(SquareMap<2>(Conformal), variational), 1e-8);
  EXPECT_LT(ErrorAfter<2>(SquareMap<2>(Skewed), variational), 1e-8);
  EXPECT_LT(ErrorAfter<2>(Moebius(Conformal), variational), 1e-8);
  EXPECT_LT(ErrorAfter<2>(Moebius(Skewed), variational), 1e-8);
  EXPECT_LT(ErrorAfter<3>(SquareMap<3>(Skewed), variational), 1e-8);
  // the harmonic map is another one there
  const auto harmonic = [](auto& map) { return FillHarmonic(map); };
  EXPECT_GT(ErrorAfter<2>(SquareMap<2>(Skewed), harmonic), 1e-3);
  EXPECT_GT(ErrorAfter<3>(SquareMap<3>(Skewed), harmonic), 1e-3);
}

TEST(HarmonicMaps, WeightsAreBlendedOrOne_ExactOracle)
{
  const auto boundary = MakeCompatible<2>(cases::AnnulusSector());
  ASSERT_TRUE(boundary);
  Spline<2> map = MapOfBoundary<2>(boundary.Value);
  map = InsertKnots<2>(map, 0, { 0.5 }).Value;
  map = InsertKnots<2>(map, 1, { 0.5 }).Value;
  const std::vector<bool> fixed = BoundaryFunctions<2>(*map.Space);
  const Eigen::VectorXd before = map.Weights;
  const int n = map.Space->Knots[0].NumFunctions();
  for (const InitialWeights kind : { InitialWeights::Blended, InitialWeights::Ones })
  {
    FillWeights<2>(map, kind);
    for (int i = 0; i < map.Space->NumFunctions; ++i)
    {
      // blended weights depend on the direction along the arcs alone
      const double expected = fixed[static_cast<std::size_t>(i)] ? before[i]
        : kind == InitialWeights::Ones                           ? 1.0
                                                                 : before[i - i % n];
      EXPECT_NEAR(map.Weights[i], expected, 1e-14) << i;
    }
  }
}

TEST(HarmonicMaps, TheDomainBeginsThere_PropertyOracle)
{
  DomainParams params;
  params.InitialMap = InitialMapMethod::VariationalHarmonic;
  for (const auto& boundary :
    { cases::Bite(0.4, 0.5, 1.2, 3), cases::BumpedSector(0.3, 0.5, 4, 2) })
  {
    const auto result = ParameterizeDomain<2>(boundary, params);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_EQ(result->UsedInitialMap, InitialMapMethod::VariationalHarmonic);
    EXPECT_TRUE(result->IsValid());
    Spline<2> map = MapOfBoundary<2>(result->Boundary);
    FillWeights<2>(map);
    ASSERT_TRUE(FillVariationalHarmonic<2>(map));
    EXPECT_EQ(result->InitialMap.ControlPoints, map.ControlPoints);
  }
}

TEST(HarmonicMaps, LayoutsBeginWithTheirWeights_PropertyOracle)
{
  DomainParams params;
  params.InitialMap = InitialMapMethod::Harmonic;
  const auto result = ParameterizeLayout<2>(cases::Ring(), {}, params);
  ASSERT_TRUE(result) << result.Status.Message();
  ASSERT_TRUE(result->InitialMap.IsRational());
  const auto changeBy = [&](GluedOperator kind)
  {
    GluedMap<2> map = result->InitialMap;
    EXPECT_TRUE(GluedSystem<2>(map, kind).Fill(map));
    double change = 0.0;
    for (std::size_t p = 0; p < map.Patches.size(); ++p)
    {
      const PointMatrix& before = result->InitialMap.Patches[p].ControlPoints;
      change = std::max(change, (map.Patches[p].ControlPoints - before).cwiseAbs().maxCoeff());
    }
    return change;
  };
  EXPECT_LT(changeBy(GluedOperator::Rational), 1e-12); // it is least already
  EXPECT_GT(changeBy(GluedOperator::Laplacian), 1e-3);
}

TEST(HarmonicMaps, EveryFailureIsReachable)
{
  DomainParams params;
  params.InitialMap = InitialMapMethod::VariationalHarmonic;
  const auto linear = ParameterizeDomain<2>(cases::Square(), params);
  EXPECT_EQ(linear.Status.Code, ErrorCode::InvalidDegree);
  EXPECT_NE(linear.Status.Detail.find("degree 2 or more"), std::string::npos);
  const auto layout = ParameterizeLayout<2>(cases::Ring(), {}, params);
  EXPECT_EQ(layout.Status.Code, ErrorCode::InvalidParameter);
  EXPECT_NE(layout.Status.Detail.find("single patch"), std::string::npos);
}
}
