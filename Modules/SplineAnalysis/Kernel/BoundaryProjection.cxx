// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryProjection.h"

#include "ElementRule.h"
#include "StiffnessMatrix.h"
#include <knotwork/MeshParameterization/SparseCholesky.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
/// Growth of rounding from which on traces count as dependent: those of one element of degree 9 in
/// both directions reach 1e10, dependent ones the inverse of the rounding unit.
constexpr double MostAmplified = 1e11;

/// The largest eigenvalue of the inverse, from below, by a few steps of inverse iteration.
double LargestInverse(const SparseCholesky& factor, Eigen::Index size)
{
  Eigen::MatrixXd vector(size, 1);
  for (Eigen::Index i = 0; i < size; ++i)
  {
    vector(i, 0) =
      1.0 + 0.5 * std::sin(static_cast<double>(7 * i + 1)); // no symmetry of the matrix has this
  }
  double largest = 0.0;
  for (int step = 0; step < 4; ++step)
  {
    vector /= vector.norm();
    factor.Solve(vector);
    largest = std::max(largest, vector.norm());
  }
  return largest;
}

/// The conditions of one component: mass matrix and right-hand side on their facets.
class TraceSystem
{
public:
  TraceSystem(const GalerkinSpace& space, int components, double tolerance)
    : Space(space), Components(components), Tolerance(tolerance)
  {
  }

  Status Add(const CellSide& facet, int component, const PointFunction& function)
  {
    for (const int f : TraceFunctions(this->Space, facet))
    {
      this->Numbers.emplace(f, static_cast<int>(this->Numbers.size()));
    }
    std::vector<std::pair<int, int>> traces; // number, place among the element's functions
    for (int a = 0; a < this->Space.NumAlive(facet.Cell); ++a)
    {
      const auto found = this->Numbers.find(this->Space.Alive(facet.Cell)[a]);
      if (found != this->Numbers.end())
      {
        traces.emplace_back(found->second, a);
      }
    }
    Eigen::VectorXd row(static_cast<Eigen::Index>(traces.size()));
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(row.size(), row.size());
    this->Right.resize(this->Numbers.size(), 0.0);
    const CellShape shape = this->Space.Shapes[static_cast<std::size_t>(facet.Cell)];
    const FacetFrame frame = MakeFacetFrame(shape, facet.Side);
    const CellRule rule =
      MakeFacetRule(shape, facet.Side, NumRulePoints(this->Space, facet.Cell, this->Tolerance));
    PointValues values;
    std::vector<double> given(static_cast<std::size_t>(this->Components), 0.0);
    for (std::size_t q = 0; q < rule.Points.size(); ++q)
    {
      EvaluateFunctions(this->Space, facet.Cell, rule.Points[q].data(), values);
      const double weight = rule.Weights[q] * AreaVector(frame, values).norm();
      if (function)
      {
        function(values.Position.data(), given.data());
      }
      const double value = given[static_cast<std::size_t>(component)];
      if (!std::isfinite(value))
      {
        return { ErrorCode::NonFiniteInput,
          "a prescribed value on side " + std::to_string(facet.Side) + " of element " +
            std::to_string(facet.Cell) + " is no number; mend the function" };
      }
      for (Eigen::Index i = 0; i < row.size(); ++i)
      {
        row[i] = values.Values[traces[static_cast<std::size_t>(i)].second];
        this->Right[static_cast<std::size_t>(traces[static_cast<std::size_t>(i)].first)] +=
          weight * value * row[i];
      }
      mass.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    }
    for (std::size_t i = 0; i < traces.size(); ++i)
    {
      for (std::size_t j = 0; j <= i; ++j)
      {
        const double entry = mass(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        if (entry != 0.0)
        {
          const auto [lower, upper] = std::minmax(traces[i].first, traces[j].first);
          this->Mass.emplace_back(upper, lower, entry);
        }
      }
    }
    return {};
  }

  Status Solve(int component, GivenCoefficients& result)
  {
    if (this->Numbers.empty())
    {
      return {};
    }
    const auto size = static_cast<Eigen::Index>(this->Right.size());
    Eigen::SparseMatrix<double> mass(size, size);
    mass.setFromTriplets(this->Mass.begin(), this->Mass.end());
    // traces of one size: what is small then is a dependence
    const Eigen::VectorXd scale = mass.diagonal().cwiseSqrt().cwiseInverse();
    mass = scale.asDiagonal() * mass * scale.asDiagonal();
    SparseCholesky factor;
    if (!factor.Factorize(mass) || LargestInverse(factor, size) > MostAmplified)
    {
      return { ErrorCode::SingularSystem,
        "functions are dependent on the facets of the prescribed values of component " +
          std::to_string(component) + "; prescribe them on whole sides" };
    }
    Eigen::MatrixXd values =
      scale.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(this->Right.data(), size));
    factor.Solve(values);
    values = scale.asDiagonal() * values;
    for (const auto& number : this->Numbers)
    {
      const auto unknown = static_cast<std::size_t>(number.first * this->Components + component);
      result.IsGiven[unknown] = 1;
      result.Values[static_cast<Eigen::Index>(unknown)] = values(number.second, 0);
    }
    return {};
  }

private:
  const GalerkinSpace& Space;
  int Components;
  double Tolerance;
  std::map<int, int> Numbers;
  std::vector<double> Right;
  std::vector<Eigen::Triplet<double>> Mass;
};
}

Result<GivenCoefficients> ProjectPrescribed(
  const GalerkinSpace& space, const GalerkinProblem& problem, const GalerkinParams& params)
{
  const int components = NumSolutionComponents(problem.Equation);
  const auto size = static_cast<std::size_t>(space.NumFunctions() * components);
  GivenCoefficients result;
  result.IsGiven.assign(size, 0);
  result.Values.setZero(static_cast<Eigen::Index>(size));
  for (int component = 0; component < components; ++component)
  {
    TraceSystem system(space, components, params.QuadratureTolerance);
    std::set<std::pair<int, int>> seen;
    for (const PrescribedValues& condition : problem.Prescribed)
    {
      if (condition.Component != -1 && condition.Component != component)
      {
        continue;
      }
      for (const CellSide& facet : condition.Facets)
      {
        if (!seen.insert({ facet.Cell, facet.Side }).second)
        {
          return { ErrorCode::InvalidParameter,
            "component " + std::to_string(component) + " is prescribed twice on side " +
              std::to_string(facet.Side) + " of element " + std::to_string(facet.Cell) +
              "; keep one of the conditions" };
        }
        if (const Status status = system.Add(facet, component, condition.Values); !status)
        {
          return status;
        }
      }
    }
    if (const Status status = system.Solve(component, result); !status)
    {
      return status;
    }
  }
  for (const PointSupport& support : problem.Supports)
  {
    const auto unknown =
      static_cast<std::size_t>(support.Function * components + support.Component);
    result.IsGiven[unknown] = 1;
    result.Values[static_cast<Eigen::Index>(unknown)] = support.Value;
  }
  return result;
}
}
