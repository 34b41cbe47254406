// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorEstimate.h"

#include "CheckProblem.h"
#include "ElementFacets.h"
#include "ElementSolution.h"
#include "StiffnessMatrix.h"
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace knotwork
{
namespace
{
/// Constants of the parts. That of the interior is (h / 2 pi)^2 without h: in one parameter the
/// error of the smoothest splines of high degree p is about a Bernoulli polynomial of degree p + 1
/// on every element, whose derivatives are each a factor h / 2 pi smaller than the next. Those of
/// sides are measured.
struct EstimateFactors
{
  double Interior;
  double Flux;
  double Values;
};
EstimateFactors FactorsOf(const CellDegree& degree)
{
  const double pi = 4.0 * std::atan(1.0);
  const int p = *std::max_element(degree.begin(), degree.end());
  return { 1.0 / (4.0 * pi * pi), 0.1 / p, 1.0 * p };
}

std::size_t At(int element)
{
  return static_cast<std::size_t>(element);
}

/// Gauss points a direction.
int NumPoints(const CellDegree& degree)
{
  return *std::max_element(degree.begin(), degree.end()) + 1;
}

/// Basis of all points of a rule, as many rows each.
struct RuleBasis
{
  CellRule Rule;
  PointMatrix Rows;
};
using RuleBases = std::map<std::pair<CellShape, CellDegree>, RuleBasis>;

/// What is given on a side of an element.
struct SideConditions
{
  std::vector<const FacetLoad*> Loads;
  std::vector<const PrescribedValues*> Values;
};

/// The conditions of a problem by side.
using ConditionMap = std::map<std::pair<int, int>, SideConditions>;
ConditionMap MakeConditions(const GalerkinProblem& problem)
{
  ConditionMap conditions;
  for (const FacetLoad& load : problem.Loads)
  {
    for (const CellSide& facet : load.Facets)
    {
      conditions[{ facet.Cell, facet.Side }].Loads.push_back(&load);
    }
  }
  for (const PrescribedValues& values : problem.Prescribed)
  {
    for (const CellSide& facet : values.Facets)
    {
      conditions[{ facet.Cell, facet.Side }].Values.push_back(&values);
    }
  }
  return conditions;
}

/// A side inside, or on the boundary (its second cell is -1).
struct EstimateFacet
{
  InnerFacet Place;
  std::array<const SideConditions*, 2> Conditions{};
};

/// Squares that a facet adds to the elements on it.
struct FacetSquares
{
  std::array<double, 2> Flux{};
  double Values = 0.0; ///< to the first
};

template <int Dim>
class Estimator
{
public:
  using Vector = Eigen::Matrix<double, Dim, 1>;

  Estimator(
    const GalerkinSpace& space, const GalerkinProblem& problem, const PointMatrixView& coefficients)
    : Space(space), Problem(problem), Coefficients(coefficients),
      Components(NumSolutionComponents(problem.Equation))
  {
    for (int e = 0; e < space.NumElements(); ++e)
    {
      const auto index = At(e);
      RuleBasis& basis = this->Bases[{ space.Shapes[index], space.Degrees[index] }];
      if (basis.Rows.size() == 0)
      {
        basis.Rule = MakeCellRule(space.Shapes[index], NumPoints(space.Degrees[index]));
        const auto count = static_cast<Eigen::Index>(basis.Rule.Points.size());
        for (Eigen::Index q = 0; q < count; ++q)
        {
          const double* u = basis.Rule.Points[static_cast<std::size_t>(q)].data();
          const PointMatrix rows =
            BasisDerivatives(space.Shapes[index], space.Degrees[index], u, 2);
          basis.Rows.conservativeResize(count * rows.rows(), rows.cols());
          basis.Rows.middleRows(q * rows.rows(), rows.rows()) = rows;
        }
        const CellShape facet = FacetShape(space.Shapes[index]);
        const int points = NumPoints(space.Degrees[index]);
        this->FacetRules[{ facet, points }] = MakeCellRule(facet, points);
      }
    }
  }

  /// What is left of equilibrium without the source, at a point.
  struct Residual
  {
    Vector Position;
    Vector Force;
    double Weight = 0.0;
  };
  void FillResiduals(int element, std::vector<Residual>& residuals) const
  {
    const auto e = At(element);
    const RuleBasis& basis =
      this->Bases.find({ this->Space.Shapes[e], this->Space.Degrees[e] })->second;
    const ElementSolution<Dim> solution(this->Space, this->Coefficients, element);
    const double factor = FactorsOf(this->Space.Degrees[e]).Interior / this->Modulus(element);
    const GalerkinMaterial& material = MaterialOf(this->Problem, element);
    const LameConstants lame = MakeLameConstants(this->Problem.Equation, material);
    const std::vector<SolutionPoint<Dim>> points = solution.AtAll(basis.Rows, 2);
    residuals.resize(points.size());
    for (std::size_t q = 0; q < points.size(); ++q)
    {
      const SolutionPoint<Dim>& point = points[q];
      Residual& residual = residuals[q];
      residual.Position = point.Position;
      residual.Force.setZero();
      if (this->Problem.Equation == GalerkinEquation::Poisson)
      {
        residual.Force[0] = material.Conductivity * point.Hessian[0].trace();
      }
      else
      {
        for (int i = 0; i < Dim; ++i)
        {
          const auto& hessian = point.Hessian[At(i)];
          residual.Force[i] += lame.Shear * hessian.trace();
          residual.Force += (lame.First + lame.Shear) * hessian.row(i).transpose();
        }
      }
      residual.Weight =
        factor * basis.Rule.Weights[q] * std::abs(point.Determinant) * point.Length * point.Length;
    }
  }

  /// Callables of the facet's conditions are called.
  FacetSquares FacetTerms(const EstimateFacet& facet) const
  {
    std::vector<ElementSolution<Dim>> solutions;
    int count = 0;
    double modulus = 0.0;
    for (const CellSide& side : facet.Place.Sides)
    {
      if (side.Cell >= 0)
      {
        solutions.emplace_back(this->Space, this->Coefficients, side.Cell);
        count = std::max(count, NumPoints(this->Space.Degrees[At(side.Cell)]));
        modulus += this->Modulus(side.Cell);
      }
    }
    const CellShape shape = this->Space.Shapes[At(facet.Place.Sides[0].Cell)];
    const CellRule& rule = this->FacetRules.find({ FacetShape(shape), count })->second;
    const Eigen::Map<const Vector> normal(facet.Place.Frames[0].Normal.data());
    FacetSquares squares;
    std::array<SolutionPoint<Dim>, 2> points;
    for (std::size_t q = 0; q < rule.Points.size(); ++q)
    {
      for (std::size_t s = 0; s < solutions.size(); ++s)
      {
        const auto e = At(facet.Place.Sides[s].Cell);
        const auto u = facet.Place.Frames[s].Point({ rule.Points[q][0], rule.Points[q][1] });
        points[s] = solutions[s].At(
          BasisDerivatives(this->Space.Shapes[e], this->Space.Degrees[e], u.data(), 1), 1);
      }
      const Vector area =
        std::abs(points[0].Determinant) * (points[0].Inverse.transpose() * normal);
      const double weight = rule.Weights[q] * area.norm();
      Vector outward = area.normalized();
      Vector rest = Vector::Zero();
      Vector isFree = Vector::Ones();
      for (std::size_t s = 0; s < solutions.size(); ++s)
      {
        rest -= this->Flux(facet.Place.Sides[s].Cell, points[s].Gradient, outward);
        if (facet.Conditions[s])
        {
          this->AddLoads(*facet.Conditions[s], points[s], outward, rest);
          squares.Values += weight *
            this->ValuesTerm(*facet.Conditions[s], facet.Place.Sides[s].Cell, points[s], isFree);
        }
        outward = -outward; // of the second element
      }
      // what there is on an inner facet is halved: the modulus is a sum there
      const double square = weight * rest.cwiseProduct(isFree).squaredNorm() / modulus;
      for (std::size_t s = 0; s < solutions.size(); ++s)
      {
        const CellDegree& degree = this->Space.Degrees[At(facet.Place.Sides[s].Cell)];
        squares.Flux[s] += FactorsOf(degree).Flux * points[s].Length * square;
      }
    }
    return squares;
  }

private:
  /// What the energy of a gradient is measured by: in elasticity between that of shear, 2 m, and
  /// that of a compressed rod that cannot widen, 2 m + l.
  double Modulus(int element) const
  {
    const GalerkinMaterial& material = MaterialOf(this->Problem, element);
    if (this->Problem.Equation == GalerkinEquation::Poisson)
    {
      return material.Conductivity;
    }
    const LameConstants lame = MakeLameConstants(this->Problem.Equation, material);
    return std::sqrt(2.0 * lame.Shear * (2.0 * lame.Shear + lame.First));
  }

  Vector Flux(
    int element, const typename SolutionPoint<Dim>::Square& gradient, const Vector& n) const
  {
    const GalerkinMaterial& material = MaterialOf(this->Problem, element);
    Vector flux = Vector::Zero();
    if (this->Problem.Equation == GalerkinEquation::Poisson)
    {
      flux[0] = material.Conductivity * gradient.row(0).dot(n);
      return flux;
    }
    const LameConstants lame = MakeLameConstants(this->Problem.Equation, material);
    return lame.Shear * (gradient * n + gradient.transpose() * n) +
      lame.First * gradient.trace() * n;
  }

  void AddLoads(const SideConditions& conditions, const SolutionPoint<Dim>& point,
    const Vector& outward, Vector& rest) const
  {
    for (const FacetLoad* load : conditions.Loads)
    {
      Vector given = Vector::Zero();
      load->Values(point.Position.data(), outward.data(), given.data());
      rest += given;
    }
  }

  /// The square of what prescribed values differ by. Components that are prescribed are not free.
  double ValuesTerm(const SideConditions& conditions, int element, const SolutionPoint<Dim>& point,
    Vector& isFree) const
  {
    double sum = 0.0;
    for (const PrescribedValues* values : conditions.Values)
    {
      Vector given = Vector::Zero();
      if (values->Values)
      {
        values->Values(point.Position.data(), given.data());
      }
      for (int i = 0; i < this->Components; ++i)
      {
        if (values->Component == -1 || values->Component == i)
        {
          isFree[i] = 0.0;
          const double rest = given[i] - point.Value[i];
          sum += rest * rest;
        }
      }
    }
    return FactorsOf(this->Space.Degrees[At(element)]).Values * this->Modulus(element) /
      point.Length * sum;
  }

  const GalerkinSpace& Space;
  const GalerkinProblem& Problem;
  const PointMatrixView& Coefficients;
  int Components;
  RuleBases Bases;
  std::map<std::pair<CellShape, int>, CellRule> FacetRules;
};

/// Parts of the estimate as squares, by element.
struct SquareSums
{
  std::vector<double> Elements;
  double Interior = 0.0;
  double Jumps = 0.0;
  double Loads = 0.0;
  double Values = 0.0;
};

template <int Dim>
Status AddInterior(const Estimator<Dim>& estimator, const GalerkinSpace& space,
  const GalerkinProblem& problem, int threads, const ProgressCallback& progress, SquareSums& sums)
{
  constexpr int Batch = 512; // elements whose points are held at a time
  using Residuals = std::vector<typename Estimator<Dim>::Residual>;
  const int count = space.NumElements();
  std::vector<Residuals> batch(static_cast<std::size_t>(std::min(Batch, count)));
  for (int first = 0; first < count; first += Batch)
  {
    const int size = std::min(Batch, count - first);
    ParallelFor(static_cast<std::size_t>(size), 64, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          estimator.FillResiduals(first + static_cast<int>(i), batch[i]);
        }
      });
    for (int i = 0; i < size; ++i)
    {
      double sum = 0.0;
      for (const auto& residual : batch[At(i)])
      {
        Eigen::Matrix<double, Dim, 1> force = Eigen::Matrix<double, Dim, 1>::Zero();
        if (problem.Source)
        {
          problem.Source(residual.Position.data(), force.data());
        }
        sum += residual.Weight * (force + residual.Force).squaredNorm();
      }
      sums.Elements[At(first + i)] += sum;
      sums.Interior += sum;
    }
    if (progress && !progress(0.5 * (first + size) / count))
    {
      return { ErrorCode::Aborted, "while the error was estimated inside elements" };
    }
  }
  return {};
}

/// Sides inside that the flux may jump across, then those of the boundary. @return as MatchSides.
Result<std::vector<EstimateFacet>> MakeFacets(
  const GalerkinSpace& space, const GalerkinProblem& problem, const ConditionMap& conditions)
{
  const std::vector<int>& ids = problem.MaterialIds;
  const bool areAlike =
    std::adjacent_find(ids.begin(), ids.end(), std::not_equal_to<>()) == ids.end();
  const auto found = FindFacets(space, !areAlike);
  if (!found)
  {
    return found.Status;
  }
  std::vector<EstimateFacet> facets;
  for (const InnerFacet& facet : found->Inner)
  {
    // between materials the flux jumps however smooth functions are
    const auto& [one, other] = facet.Sides;
    const auto isSmooth = [&](const CellSide& side)
    { return (space.SmoothSides[At(side.Cell)] >> side.Side & 1U) != 0; };
    if (areAlike || ids[At(one.Cell)] != ids[At(other.Cell)] || !isSmooth(one) || !isSmooth(other))
    {
      facets.push_back({ facet, {} });
    }
  }
  for (const CellSide& side : found->Boundary)
  {
    const CellShape shape = space.Shapes[At(side.Cell)];
    EstimateFacet facet;
    facet.Place.Sides = { side, CellSide{} };
    facet.Place.Frames[0] = MakeFacetFrame(shape, side.Side);
    facets.push_back(facet);
  }
  for (EstimateFacet& facet : facets)
  {
    for (std::size_t s = 0; s < 2; ++s)
    {
      const CellSide& side = facet.Place.Sides[s];
      const auto own = conditions.find({ side.Cell, side.Side });
      facet.Conditions[s] = own == conditions.end() ? nullptr : &own->second;
    }
  }
  return facets;
}

template <int Dim>
Status AddFacets(const Estimator<Dim>& estimator, const GalerkinSpace& space,
  const GalerkinProblem& problem, int threads, SquareSums& sums)
{
  const ConditionMap conditions = MakeConditions(problem);
  const auto facets = MakeFacets(space, problem, conditions);
  if (!facets)
  {
    return facets.Status;
  }
  const auto hasConditions = [](const EstimateFacet& facet)
  { return facet.Conditions[0] || facet.Conditions[1]; };
  std::vector<FacetSquares> squares(facets.Value.size());
  ParallelFor(squares.size(), 64, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        if (!hasConditions(facets.Value[i]))
        {
          squares[i] = estimator.FacetTerms(facets.Value[i]);
        }
      }
    });
  for (std::size_t i = 0; i < squares.size(); ++i)
  {
    const EstimateFacet& facet = facets.Value[i];
    if (hasConditions(facet))
    {
      squares[i] = estimator.FacetTerms(facet);
    }
    for (std::size_t s = 0; s < 2; ++s)
    {
      if (const int cell = facet.Place.Sides[s].Cell; cell >= 0)
      {
        sums.Elements[At(cell)] += squares[i].Flux[s];
      }
    }
    sums.Elements[At(facet.Place.Sides[0].Cell)] += squares[i].Values;
    const bool inner = facet.Place.Sides[1].Cell >= 0;
    (inner ? sums.Jumps : sums.Loads) += squares[i].Flux[0] + squares[i].Flux[1];
    sums.Values += squares[i].Values;
  }
  return {};
}

template <int Dim>
Result<ErrorEstimate> Estimate(const GalerkinSpace& space, const GalerkinProblem& problem,
  const PointMatrixView& coefficients, int threads, const ProgressCallback& progress)
{
  const Estimator<Dim> estimator(space, problem, coefficients);
  SquareSums sums;
  sums.Elements.assign(static_cast<std::size_t>(space.NumElements()), 0.0);
  if (const Status status = AddInterior(estimator, space, problem, threads, progress, sums);
      !status)
  {
    return status;
  }
  if (const Status status = AddFacets(estimator, space, problem, threads, sums); !status)
  {
    return status;
  }
  ErrorEstimate estimate;
  double total = 0.0;
  for (const double square : sums.Elements)
  {
    total += square;
    estimate.Elements.push_back(std::sqrt(square));
  }
  if (!std::isfinite(total))
  {
    return { ErrorCode::NonFiniteInput,
      "a source, load or prescribed value is no number, or a map is singular; mend the function or "
      "the geometry" };
  }
  estimate.Total = std::sqrt(total);
  estimate.Interior = std::sqrt(sums.Interior);
  estimate.Jumps = std::sqrt(sums.Jumps);
  estimate.Loads = std::sqrt(sums.Loads);
  estimate.Values = std::sqrt(sums.Values);
  if (progress && !progress(1.0))
  {
    return { ErrorCode::Aborted, "after the error was estimated" };
  }
  return estimate;
}
}

Result<ErrorEstimate> EstimateError(const GalerkinSpace& space, const GalerkinProblem& problem,
  const PointMatrixView& coefficients, int threads, const ProgressCallback& progress)
{
  if (const Status status = CheckProblem(space, problem, {}); !status)
  {
    return status;
  }
  if (coefficients.rows() != space.NumFunctions() ||
    coefficients.cols() != NumSolutionComponents(problem.Equation))
  {
    return { ErrorCode::SizeMismatch,
      "there must be a row of coefficients a function, with a column a component of the solution" };
  }
  if (!coefficients.allFinite())
  {
    return { ErrorCode::NonFiniteInput, "a coefficient is no number; solve the problem first" };
  }
  return space.Dimension == 2 ? Estimate<2>(space, problem, coefficients, threads, progress)
                              : Estimate<3>(space, problem, coefficients, threads, progress);
}
}
