// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SplineOracle.h"

#include <cmath>
#include <random>

/// Values and derivatives of splines straight from the definitions, and random splines of mild
/// knots: what evaluation is compared with.
namespace knotwork
{
/// Orders of differentiation of every term: value, first, second derivatives.
template <int Dim>
std::vector<IntArray<Dim>> OracleTerms(int order)
{
  std::vector<IntArray<Dim>> terms(1);
  for (std::size_t d = 0; order >= 1 && d < Dim; ++d)
  {
    terms.push_back({});
    ++terms.back()[d];
  }
  for (std::size_t d = 0; order >= 2 && d < Dim; ++d)
  {
    for (std::size_t e = d; e < Dim; ++e)
    {
      terms.push_back({});
      ++terms.back()[d];
      ++terms.back()[e];
    }
  }
  return terms;
}

/// A derivative of one function of a tensor-product space at u.
template <int Dim>
double OracleFunction(
  const SplineSpace<Dim>& space, int function, const double* u, const IntArray<Dim>& orders)
{
  double product = 1.0;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const KnotVector& knots = space.Knots[d];
    const int i = function % knots.NumFunctions();
    function /= knots.NumFunctions();
    product *= static_cast<double>(oracle::BasisDerivative(i, knots.Degree(), knots.Knots(),
      oracle::FindSpan(knots.Degree(), knots.Knots(), u[d]), u[d], orders[d]));
  }
  return product;
}

/// Value and derivatives (rows, in the order of the terms) of a tensor-product spline at u.
template <int Dim>
Eigen::MatrixXd OracleEvaluate(const Spline<Dim>& spline, const double* u, int order)
{
  const auto terms = OracleTerms<Dim>(order);
  const PointMatrix points = spline.HomogeneousPoints();
  PointMatrix result = PointMatrix::Zero(static_cast<Eigen::Index>(terms.size()), points.cols());
  for (int i = 0; i < spline.Space->NumFunctions; ++i)
  {
    for (std::size_t k = 0; k < terms.size(); ++k)
    {
      result.row(static_cast<Eigen::Index>(k)) +=
        OracleFunction<Dim>(*spline.Space, i, u, terms[k]) * points.row(i);
    }
  }
  if (!spline.IsRational())
  {
    return result;
  }
  // Leibniz: (w x)_k = sum of binomial * w_j x_{k-j}, solved for x term by term
  const int c = spline.NumComponents();
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(result.rows(), c);
  const auto weight = [&](const IntArray<Dim>& orders)
  {
    double sum = 0.0;
    for (int i = 0; i < spline.Space->NumFunctions; ++i)
    {
      sum += OracleFunction<Dim>(*spline.Space, i, u, orders) * spline.Weights[i];
    }
    return sum;
  };
  const IntArray<Dim> none{};
  for (std::size_t k = 0; k < terms.size(); ++k)
  {
    Eigen::RowVectorXd rest = result.row(static_cast<Eigen::Index>(k)).head(c);
    for (std::size_t j = 0; j < k; ++j)
    {
      IntArray<Dim> difference{};
      double binomial = 1.0;
      bool below = true;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        difference[d] = terms[k][d] - terms[j][d];
        below = below && difference[d] >= 0;
        binomial *= terms[k][d] == 2 && terms[j][d] == 1 ? 2.0 : 1.0;
      }
      if (below)
      {
        rest -= binomial * weight(difference) * x.row(static_cast<Eigen::Index>(j));
      }
    }
    x.row(static_cast<Eigen::Index>(k)) = rest / weight(none);
  }
  return x;
}

inline double RandomNumber(std::mt19937_64& random, double lower = 0.0, double upper = 1.0)
{
  return lower + (upper - lower) * static_cast<double>(random() >> 11) * 0x1p-53;
}

inline PointMatrix RandomMatrix(std::mt19937_64& random, int rows, int columns)
{
  PointMatrix m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i)
  {
    m.data()[i] = RandomNumber(random, -1.0, 1.0);
  }
  return m;
}

/// Clamped or not, unequal elements, some knots repeated; about [0.5, 3].
inline KnotVector RandomKnots(std::mt19937_64& random, int degree, int elements)
{
  std::vector<double> t;
  double u = 0.5;
  const bool clamped = random() % 3 != 0;
  const auto step = [&] { return RandomNumber(random, 0.2, 1.0) * 2.5 / elements; };
  for (int i = 0; i < degree; ++i)
  {
    t.push_back(u);
    u += clamped ? 0.0 : step();
  }
  for (int e = 0; e <= elements; ++e)
  {
    const bool inside = e > 0 && e < elements;
    const int multiplicity = inside && random() % 3 == 0
      ? 1 + static_cast<int>(random() % static_cast<unsigned>(degree))
      : 1;
    t.insert(t.end(), static_cast<std::size_t>(multiplicity), u);
    u += e < elements ? step() : 0.0;
  }
  for (int i = 0; i < degree; ++i)
  {
    u += clamped ? 0.0 : step();
    t.push_back(u);
  }
  return KnotVector::Create(degree, t).Value;
}

template <int Dim>
Spline<Dim> RandomTensorSpline(std::mt19937_64& random, const IntArray<Dim>& degree,
  const IntArray<Dim>& elements, int components, bool rational)
{
  std::array<KnotVector, Dim> knots;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    knots[d] = RandomKnots(random, degree[d], elements[d]);
  }
  Spline<Dim> spline;
  spline.Space = MakeTensorSpace<Dim>(knots).Value;
  spline.ControlPoints = RandomMatrix(random, spline.Space->NumFunctions, components);
  if (rational)
  {
    spline.Weights =
      (RandomMatrix(random, spline.Space->NumFunctions, 1).array() * 0.5 + 1.0).matrix();
  }
  return spline;
}

/// Points of the domain: random ones, then every break of the first directions' corners and ends.
template <int Dim>
PointMatrix RandomParameters(std::mt19937_64& random, const SplineSpace<Dim>& space, int numRandom)
{
  const auto box = space.Domain();
  const auto& breaks = space.Knots[0].Breaks();
  PointMatrix u(numRandom + static_cast<int>(breaks.size()) + 2, Dim);
  for (Eigen::Index i = 0; i < u.rows(); ++i)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      u(i, static_cast<Eigen::Index>(d)) = RandomNumber(random, box.Lower[d], box.Upper[d]);
    }
  }
  for (std::size_t b = 0; b < breaks.size(); ++b)
  {
    u(numRandom + static_cast<Eigen::Index>(b), 0) = breaks[b];
  }
  for (std::size_t d = 0; d < Dim; ++d)
  {
    u(u.rows() - 2, static_cast<Eigen::Index>(d)) = box.Lower[d];
    u(u.rows() - 1, static_cast<Eigen::Index>(d)) = box.Upper[d];
  }
  return u;
}

/// Largest |d^k N / du^k| of B-splines is below (2 p / h)^k with h the shortest element.
template <int Dim>
double DerivativeSize(const SplineSpace<Dim>& space, int order)
{
  double size = 1.0;
  for (const KnotVector& knots : space.Knots)
  {
    const auto& breaks = knots.Breaks();
    for (std::size_t b = 0; b + 1 < breaks.size(); ++b)
    {
      size = std::max(size, 2.0 * knots.Degree() / (breaks[b + 1] - breaks[b]));
    }
  }
  return std::pow(size, order);
}
}
