// SPDX-License-Identifier: BSD-3-Clause
#include "ResultFields.h"

#include "ElementRule.h"
#include "StiffnessMatrix.h"
#include <knotwork/MeshParameterization/SparseCholesky.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
/// Of quadrature on rational elements: what is drawn needs no more, and every point is a row.
constexpr double FieldTolerance = 1e-6;

/// The row of GaussValues of a gradient.
Eigen::RowVectorXd ResultRow(
  const GalerkinProblem& problem, int element, const Eigen::MatrixXd& gradient)
{
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(NumResultColumns(problem.Equation));
  if (problem.Equation == GalerkinEquation::Poisson)
  {
    row.head(gradient.cols()) = MaterialOf(problem, element).Conductivity * gradient.row(0);
    return row;
  }
  const Eigen::Matrix3d s = ElasticStress(problem, element, gradient);
  const Eigen::Vector3d principal =
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(s, Eigen::EigenvaluesOnly).eigenvalues();
  row << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2), VonMisesStress(s), principal[2],
    principal[1], principal[0];
  return row;
}

double LargestAtCorners(
  const GalerkinSpace& space, const std::vector<CellSide>& facets, const PointMatrix& coefficients)
{
  double largest = 0.0;
  PointValues values;
  for (const CellSide& facet : facets)
  {
    const auto e = static_cast<std::size_t>(facet.Cell);
    const CellDegree& degree = space.Degrees[e];
    for (const auto& corner : SideCorners(space.Shapes[e], degree, facet.Side))
    {
      const double u[] = { static_cast<double>(corner[0] > 0), static_cast<double>(corner[1] > 0),
        static_cast<double>(corner[2] > 0) };
      EvaluateFunctions(space, facet.Cell, u, values);
      Eigen::RowVectorXd value = Eigen::RowVectorXd::Zero(coefficients.cols());
      for (int a = 0; a < space.NumAlive(facet.Cell); ++a)
      {
        value += values.Values[a] * coefficients.row(space.Alive(facet.Cell)[a]);
      }
      largest = std::max(largest, value.norm());
    }
  }
  return largest;
}

/// Half of the density of a(u, u).
double EnergyDensity(const GalerkinProblem& problem, int element, const Eigen::MatrixXd& gradient)
{
  if (problem.Equation == GalerkinEquation::Poisson)
  {
    return 0.5 * MaterialOf(problem, element).Conductivity * gradient.squaredNorm();
  }
  const Eigen::Index n = gradient.cols();
  return 0.5 *
    (ElasticStress(problem, element, gradient).topLeftCorner(n, n).array() * gradient.array())
      .sum();
}
}

std::vector<int> FunctionsOnFacets(const GalerkinSpace& space, const std::vector<CellSide>& facets)
{
  std::set<int> all;
  for (const CellSide& facet : facets)
  {
    const std::vector<int> own = TraceFunctions(space, facet);
    all.insert(own.begin(), own.end());
  }
  return { all.begin(), all.end() };
}

double FacetMeasure(const GalerkinSpace& space, const std::vector<CellSide>& facets)
{
  double measure = 0.0;
  PointValues values;
  for (const CellSide& facet : facets)
  {
    const CellShape shape = space.Shapes[static_cast<std::size_t>(facet.Cell)];
    const FacetFrame frame = MakeFacetFrame(shape, facet.Side);
    const CellRule rule = MakeFacetRule(shape, facet.Side, NumRulePoints(space, facet.Cell, 1e-10));
    for (std::size_t q = 0; q < rule.Points.size(); ++q)
    {
      EvaluateFunctions(space, facet.Cell, rule.Points[q].data(), values);
      measure += rule.Weights[q] * AreaVector(frame, values).norm();
    }
  }
  return measure;
}

int NumResultColumns(GalerkinEquation equation)
{
  return equation == GalerkinEquation::Poisson ? 3 : 10;
}

Result<ResultFields> MakeResultFields(const GalerkinSpace& space, const GalerkinProblem& problem,
  const std::vector<CellSide>& boundary, const PointMatrix& coefficients,
  const GalerkinParams& params, const ProgressCallback& progress)
{
  const int columns = NumResultColumns(problem.Equation);
  const bool isElastic = problem.Equation != GalerkinEquation::Poisson;
  ResultFields fields;
  fields.Energy.setZero(space.NumElements());
  fields.LargestVonMises.setZero(isElastic ? space.NumElements() : 0);
  std::vector<double> values;
  std::vector<double> points;
  Eigen::SparseMatrix<double> mass;
  if (const Status status = MakePattern(space, 1, params.Threads, mass); !status)
  {
    return status;
  }
  Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(space.NumFunctions(), columns);
  RuleTables tables(std::max(params.QuadratureTolerance, FieldTolerance));
  Eigen::MatrixXd gradient(coefficients.cols(), space.Dimension);
  Eigen::RowVectorXd value(coefficients.cols());
  double largest = 0.0; // squared
  Eigen::MatrixXd block;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    if (progress && e % 256 == 0 && !progress(0.7 * e / space.NumElements()))
    {
      return { ErrorCode::Aborted, "while stresses were projected" };
    }
    const int alive = space.NumAlive(e);
    block.setZero(alive, alive);
    tables.Visit(space, e,
      [&](std::size_t q, const PointValues& at)
      {
        gradient.setZero();
        value.setZero();
        for (int a = 0; a < alive; ++a)
        {
          const auto row = coefficients.row(space.Alive(e)[a]);
          gradient += row.transpose() * at.Gradients.row(a);
          value += at.Values[a] * row;
        }
        largest = std::max(largest, value.squaredNorm());
        const double weight = tables.Weights[q] * std::abs(at.Determinant);
        const Eigen::RowVectorXd row = ResultRow(problem, e, gradient);
        fields.Energy[e] += weight * EnergyDensity(problem, e, gradient);
        if (isElastic)
        {
          fields.LargestVonMises[e] = std::max(fields.LargestVonMises[e], row[6]);
        }
        values.insert(values.end(), row.begin(), row.end());
        points.insert(points.end(), at.Position.begin(), at.Position.end());
        fields.GaussElements.push_back(e);
        block.noalias() += weight * at.Values * at.Values.transpose();
        for (int a = 0; a < alive; ++a)
        {
          sides.row(space.Alive(e)[a]) += weight * at.Values[a] * row;
        }
      });
    AddElement(space, e, block, mass);
  }
  fields.LargestValue =
    std::max(std::sqrt(largest), LargestAtCorners(space, boundary, coefficients));
  const auto count = static_cast<Eigen::Index>(fields.GaussElements.size());
  fields.GaussValues = Eigen::Map<const PointMatrix>(values.data(), count, columns);
  fields.GaussPoints = Eigen::Map<const PointMatrix>(points.data(), count, space.Dimension);
  SparseCholesky factor;
  if (!factor.Factorize(mass))
  {
    return { ErrorCode::SingularSystem,
      "functions are dependent, so stresses cannot be projected; refine otherwise" };
  }
  factor.Solve(sides);
  fields.Projected = sides;
  return fields;
}
}
