// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "AnalysisCases.h"
#include "ElementRule.h"
#include "StiffnessMatrix.h"

/// Solutions that are known, and errors in the norm of energy.
namespace knotwork::testing
{
/// Stress, or the flux of Poisson's equation, of a gradient: a row a component.
inline Eigen::MatrixXd StressOf(
  GalerkinEquation equation, const GalerkinMaterial& material, const Eigen::MatrixXd& gradient)
{
  if (equation == GalerkinEquation::Poisson)
  {
    return material.Conductivity * gradient;
  }
  const LameConstants lame = MakeLameConstants(equation, material);
  Eigen::MatrixXd stress = lame.Shear * (gradient + gradient.transpose());
  stress.diagonal().array() += lame.First * gradient.trace();
  return stress;
}

/// sqrt(a(u - u_h, u - u_h)) by quadrature. @param gradient  fills components x dimension, by rows.
inline double EnergyError(const GalerkinSpace& space, const GalerkinProblem& problem,
  const PointMatrix& coefficients, const PointFunction& gradient, int extraPoints = 3)
{
  double sum = 0.0;
  RuleTables tables(1e-10, extraPoints);
  PointMatrix error(coefficients.cols(), space.Dimension);
  for (int e = 0; e < space.NumElements(); ++e)
  {
    tables.Visit(space, e,
      [&](std::size_t q, const PointValues& at)
      {
        gradient(at.Position.data(), error.data());
        for (int a = 0; a < space.NumAlive(e); ++a)
        {
          error -= coefficients.row(space.Alive(e)[a]).transpose() * at.Gradients.row(a);
        }
        sum += tables.Weights[q] * std::abs(at.Determinant) *
          StressOf(problem.Equation, MaterialOf(problem, e), error).cwiseProduct(error).sum();
      });
  }
  return std::sqrt(sum);
}

/// Components sin(a_i . x + i) with their source and fluxes: a solution of every equation.
struct PlaneWaves
{
  GalerkinEquation Equation = GalerkinEquation::Poisson;
  GalerkinMaterial Material;
  int Dimension = 2;
  Eigen::MatrixXd Directions; ///< a row a component

  PlaneWaves(GalerkinEquation equation, int dimension, double frequency)
    : Equation(equation), Dimension(dimension)
  {
    Eigen::MatrixXd directions(3, 3);
    directions << 1.0, 0.6, 0.3, -0.5, 0.9, 0.4, 0.2, -0.7, 0.8;
    this->Directions =
      frequency * directions.topLeftCorner(NumSolutionComponents(equation), dimension);
    this->Material = { 2.0, 10.0, 0.3 };
  }
  PointFunction Values() const
  {
    return [a = this->Directions](const double* x, double* u)
    {
      for (Eigen::Index i = 0; i < a.rows(); ++i)
      {
        u[i] = std::sin(
          a.row(i).dot(Eigen::Map<const Eigen::RowVectorXd>(x, a.cols())) + static_cast<double>(i));
      }
    };
  }
  PointFunction Gradient() const
  {
    return [a = this->Directions](const double* x, double* g)
    {
      for (Eigen::Index i = 0; i < a.rows(); ++i)
      {
        const double phase =
          a.row(i).dot(Eigen::Map<const Eigen::RowVectorXd>(x, a.cols())) + static_cast<double>(i);
        Eigen::Map<Eigen::RowVectorXd>(g + i * a.cols(), a.cols()) = std::cos(phase) * a.row(i);
      }
    };
  }
  PointFunction Source() const
  {
    return [*this](const double* x, double* f)
    {
      const Eigen::MatrixXd& a = this->Directions;
      std::array<double, 3> u{};
      this->Values()(x, u.data());
      const LameConstants lame = MakeLameConstants(this->Equation, this->Material);
      for (Eigen::Index i = 0; i < a.rows(); ++i)
      {
        const double square = a.row(i).squaredNorm() * u[static_cast<std::size_t>(i)];
        f[i] = this->Equation == GalerkinEquation::Poisson ? this->Material.Conductivity * square
                                                           : lame.Shear * square;
        for (Eigen::Index j = 0; j < a.rows() && this->Equation != GalerkinEquation::Poisson; ++j)
        {
          f[i] += (lame.First + lame.Shear) * a(j, i) * a(j, j) * u[static_cast<std::size_t>(j)];
        }
      }
    };
  }
  FacetFunction Flux() const
  {
    return [*this](const double* x, const double* normal, double* flux)
    {
      PointMatrix gradient(this->Directions.rows(), this->Dimension);
      this->Gradient()(x, gradient.data());
      const Eigen::MatrixXd stress = StressOf(this->Equation, this->Material, gradient);
      Eigen::Map<Eigen::VectorXd>(flux, stress.rows()) =
        stress * Eigen::Map<const Eigen::VectorXd>(normal, this->Dimension);
    };
  }
  /// Values on the facets of even places, fluxes on the others.
  GalerkinProblem Problem(const std::vector<CellSide>& boundary, bool valuesAlone) const
  {
    GalerkinProblem problem;
    problem.Equation = this->Equation;
    problem.Materials[0] = this->Material;
    problem.Source = this->Source();
    problem.Prescribed.push_back({ {}, -1, this->Values() });
    FacetLoad load;
    load.Values = this->Flux();
    for (const CellSide& facet : boundary)
    {
      (valuesAlone || facet.Side == boundary.front().Side ? problem.Prescribed[0].Facets
                                                          : load.Facets)
        .push_back(facet);
    }
    if (!load.Facets.empty())
    {
      problem.Loads.push_back(load);
    }
    return problem;
  }
};
}
