// SPDX-License-Identifier: BSD-3-Clause
#include "GalerkinProblem.h"

#include "BoundaryEdges.h"
#include "BoundaryProjection.h"
#include "CheckProblem.h"
#include "ElementRule.h"
#include "LinearSolver.h"
#include "RigidMotions.h"
#include "SourceMoments.h"
#include "StiffnessMatrix.h"
#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
using Clock = std::chrono::steady_clock;
double SecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Status CheckFacets(
  const GalerkinSpace& space, const std::vector<CellSide>& facets, const std::string& place)
{
  if (facets.empty())
  {
    return { ErrorCode::InvalidParameter, place + " selects no facets; choose some" };
  }
  for (const CellSide& facet : facets)
  {
    if (facet.Cell < 0 || facet.Cell >= space.NumElements() || facet.Side < 0 ||
      facet.Side >= NumElementSides(space.Shapes[static_cast<std::size_t>(facet.Cell)]))
    {
      return { ErrorCode::InvalidParameter,
        place + ": side " + std::to_string(facet.Side) + " of element " +
          std::to_string(facet.Cell) + " does not exist" };
    }
  }
  return {};
}

Status CheckMaterials(const GalerkinSpace& space, const GalerkinProblem& problem)
{
  if (problem.Materials.empty())
  {
    return { ErrorCode::EmptyInput, "there is no material; give one" };
  }
  for (std::size_t i = 0; i < problem.Materials.size(); ++i)
  {
    const GalerkinMaterial& material = problem.Materials[i];
    const double limit = problem.Equation == GalerkinEquation::PlaneStress ? 1.0 : 0.5;
    const bool fits = problem.Equation == GalerkinEquation::Poisson
      ? std::isfinite(material.Conductivity) && material.Conductivity > 0.0
      : std::isfinite(material.YoungsModulus) && material.YoungsModulus > 0.0 &&
        material.PoissonsRatio > -1.0 && material.PoissonsRatio < limit;
    if (!fits)
    {
      return { ErrorCode::InvalidParameter,
        "material " + std::to_string(i) +
          ": conductivity and Young's modulus must be positive, Poisson's ratio above -1 and "
          "below " +
          (limit == 1.0 ? "1" : "0.5") };
    }
  }
  if (!problem.MaterialIds.empty() &&
    problem.MaterialIds.size() != static_cast<std::size_t>(space.NumElements()))
  {
    return { ErrorCode::SizeMismatch, "there must be one material id an element, or none" };
  }
  for (std::size_t e = 0; e < problem.MaterialIds.size(); ++e)
  {
    const int id = problem.MaterialIds[e];
    if (id < 0 || id >= static_cast<int>(problem.Materials.size()))
    {
      return { ErrorCode::InvalidParameter,
        "element " + std::to_string(e) + " has material " + std::to_string(id) +
          ", which does not exist" };
    }
  }
  return {};
}
}

Status CheckProblem(
  const GalerkinSpace& space, const GalerkinProblem& problem, const GalerkinParams& params)
{
  if (space.NumElements() == 0)
  {
    return { ErrorCode::EmptyInput, "the space has no elements" };
  }
  const int components = NumSolutionComponents(problem.Equation);
  if (components > 1 && components != space.Dimension)
  {
    return { ErrorCode::DimensionMismatch,
      "plane stress and strain need elements in the plane, solids such in space" };
  }
  if (!(params.QuadratureTolerance > 0.0 && params.QuadratureTolerance < 1.0) ||
    !(params.Tolerance > 0.0 && params.Tolerance < 1.0) || params.DirectLimit < 0 ||
    params.MaxIterations < 1 || params.MaxEntries < 1)
  {
    return { ErrorCode::InvalidParameter,
      "tolerances must be in (0, 1), the limit of factorization at least 0, those of iterations "
      "and entries at least 1" };
  }
  if (const Status status = CheckMaterials(space, problem); !status)
  {
    return status;
  }
  for (std::size_t i = 0; i < problem.Prescribed.size(); ++i)
  {
    const PrescribedValues& condition = problem.Prescribed[i];
    const std::string place = "prescribed values " + std::to_string(i);
    if (condition.Component < -1 || condition.Component >= components)
    {
      return { ErrorCode::InvalidParameter,
        place + ": there is no component " + std::to_string(condition.Component) };
    }
    if (const Status status = CheckFacets(space, condition.Facets, place); !status)
    {
      return status;
    }
  }
  for (std::size_t i = 0; i < problem.Loads.size(); ++i)
  {
    const std::string place = "load " + std::to_string(i);
    if (!problem.Loads[i].Values)
    {
      return { ErrorCode::InvalidParameter, place + " has no values; give a function" };
    }
    if (const Status status = CheckFacets(space, problem.Loads[i].Facets, place); !status)
    {
      return status;
    }
  }
  for (std::size_t i = 0; i < problem.EdgeLoads.size(); ++i)
  {
    const EdgeLoad& load = problem.EdgeLoads[i];
    const std::string place = "edge load " + std::to_string(i);
    if (!load.Values || load.Edges.empty() || space.Dimension != 3)
    {
      return { ErrorCode::InvalidParameter,
        place + " needs edges of a body in space and a function" };
    }
    for (const ElementEdge& edge : load.Edges)
    {
      if (edge.Cell < 0 || edge.Cell >= space.NumElements())
      {
        return { ErrorCode::InvalidParameter,
          place + ": element " + std::to_string(edge.Cell) + " does not exist" };
      }
    }
  }
  const auto exists = [&](int function, int component, double value)
  {
    return function >= 0 && function < space.NumFunctions() && component >= 0 &&
      component < components && std::isfinite(value);
  };
  for (std::size_t i = 0; i < problem.Supports.size(); ++i)
  {
    const PointSupport& support = problem.Supports[i];
    if (!exists(support.Function, support.Component, support.Value))
    {
      return { ErrorCode::InvalidParameter,
        "support " + std::to_string(i) +
          " names a function or component that does not exist, or no number" };
    }
  }
  for (std::size_t i = 0; i < problem.PointLoads.size(); ++i)
  {
    const PointLoad& load = problem.PointLoads[i];
    if (!exists(load.Function, load.Component, load.Value))
    {
      return { ErrorCode::InvalidParameter,
        "point load " + std::to_string(i) +
          " names a function or component that does not exist, or no number" };
    }
  }
  return {};
}

namespace
{
/// Refuses elements that are proved to fold, with the place.
Status CheckGeometry(const GalerkinSpace& space, int threads)
{
  JacobianParams params;
  params.Threads = threads;
  const auto certificate = ValidateJacobian(MakeBernsteinCells(space), params);
  if (!certificate)
  {
    return certificate.Status;
  }
  for (const JacobianWitness& witness : certificate.Value.Witnesses)
  {
    if (certificate.Value.Cells[static_cast<std::size_t>(witness.Cell)].Verdict == Verdict::Invalid)
    {
      std::string at;
      for (int d = 0; d < space.Dimension; ++d)
      {
        at += (d > 0 ? ", " : "") + std::to_string(witness.Parameters[static_cast<std::size_t>(d)]);
      }
      return { ErrorCode::InvalidTopology,
        "element " + std::to_string(space.Label(witness.Cell)) +
          " is folded: its Jacobian is at most " + std::to_string(witness.Upper) +
          " at local parameters (" + at + "); mend the geometry" };
    }
  }
  return {};
}

/// Loads in all coefficients.
Result<Eigen::VectorXd> AssembleLoads(
  const GalerkinSpace& space, const GalerkinProblem& problem, const GalerkinParams& params)
{
  const int components = NumSolutionComponents(problem.Equation);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(Eigen::Index{ space.NumFunctions() } * components);
  Eigen::VectorXd given = Eigen::VectorXd::Zero(components);
  PointValues values;
  const auto add = [&](int element, double weight, const PointValues& at)
  {
    for (int a = 0; a < space.NumAlive(element); ++a)
    {
      right.segment(Eigen::Index{ space.Alive(element)[a] } * components, components) +=
        weight * at.Values[a] * given;
    }
  };
  if (problem.Source)
  {
    AddMoments(space, components, problem.Source, params, right);
  }
  for (const FacetLoad& load : problem.Loads)
  {
    for (const CellSide& facet : load.Facets)
    {
      const CellShape shape = space.Shapes[static_cast<std::size_t>(facet.Cell)];
      const FacetFrame frame = MakeFacetFrame(shape, facet.Side);
      const CellRule rule = MakeFacetRule(
        shape, facet.Side, NumRulePoints(space, facet.Cell, params.QuadratureTolerance));
      for (std::size_t q = 0; q < rule.Points.size(); ++q)
      {
        EvaluateFunctions(space, facet.Cell, rule.Points[q].data(), values);
        const Eigen::VectorXd area = AreaVector(frame, values);
        const Eigen::VectorXd normal = area.normalized();
        load.Values(values.Position.data(), normal.data(), given.data());
        add(facet.Cell, rule.Weights[q] * area.norm(), values);
      }
    }
  }
  for (const EdgeLoad& load : problem.EdgeLoads)
  {
    for (const ElementEdge& edge : load.Edges)
    {
      VisitEdge(space, edge, params.QuadratureTolerance,
        [&](double length, const PointValues& at)
        {
          load.Values(at.Position.data(), given.data());
          add(edge.Cell, length, at);
        });
    }
  }
  for (const PointLoad& load : problem.PointLoads)
  {
    right[Eigen::Index{ load.Function } * components + load.Component] += load.Value;
  }
  if (!right.allFinite())
  {
    return { ErrorCode::NonFiniteInput, "a load or source is no number; mend the function" };
  }
  return right;
}

/// The equations of the coefficients that are not given: lower triangle.
Eigen::SparseMatrix<double> FreeEquations(const Eigen::SparseMatrix<double>& matrix,
  const std::vector<int>& numbers, int count, int threads)
{
  constexpr std::size_t Chunk = 4096;
  const auto forColumns = [&](const auto& visit)
  {
    ParallelFor(numbers.size(), Chunk, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t column = begin; column < end; ++column)
        {
          for (Eigen::SparseMatrix<double>::InnerIterator it(
                 matrix, static_cast<Eigen::Index>(column));
               it && numbers[column] >= 0; ++it)
          {
            if (const int row = numbers[static_cast<std::size_t>(it.row())]; row >= 0)
            {
              visit(numbers[column], row, it.value());
            }
          }
        }
      });
  };
  Eigen::SparseMatrix<double> free(count, count);
  int* outer = free.outerIndexPtr();
  std::fill_n(outer, count + 1, 0);
  forColumns([&](int column, int, double) { ++outer[column + 1]; });
  std::partial_sum(outer, outer + count + 1, outer);
  free.resizeNonZeros(outer[count]);
  std::vector<int> next(outer, outer + count);
  forColumns(
    [&](int column, int row, double value)
    {
      const int place = next[static_cast<std::size_t>(column)]++;
      free.innerIndexPtr()[place] = row;
      free.valuePtr()[place] = value;
    });
  return free;
}
}

Result<GalerkinSolution> SolveGalerkin(const GalerkinSpace& space, const GalerkinProblem& problem,
  const GalerkinParams& params, const ProgressCallback& progress)
{
  if (const Status status = CheckProblem(space, problem, params); !status)
  {
    return status;
  }
  GalerkinSolution solution;
  auto start = Clock::now();
  if (const Status status = CheckGeometry(space, params.Threads); !status)
  {
    return status;
  }
  solution.SecondsCertificate = SecondsSince(start);
  const auto given = ProjectPrescribed(space, problem, params);
  if (!given)
  {
    return given.Status;
  }
  if (const Status status = CheckRigidMotions(space, problem.Equation, given.Value.IsGiven);
      !status)
  {
    return status;
  }
  start = Clock::now();
  const auto right = AssembleLoads(space, problem, params);
  if (!right)
  {
    return right.Status;
  }
  const auto matrix = AssembleStiffness(space, problem, params, progress);
  if (!matrix)
  {
    return matrix.Status;
  }
  solution.SecondsAssembly = SecondsSince(start);

  start = Clock::now();
  const auto size = static_cast<std::size_t>(right.Value.size());
  std::vector<int> numbers(size, -1);
  for (std::size_t i = 0; i < size; ++i)
  {
    if (!given.Value.IsGiven[i])
    {
      numbers[i] = solution.Unknowns++;
    }
  }
  Eigen::VectorXd all = given.Value.Values;
  const auto full = matrix.Value.selfadjointView<Eigen::Lower>();
  Eigen::VectorXd rest = right.Value - full * all;
  if (solution.Unknowns > 0)
  {
    Eigen::MatrixXd sides(solution.Unknowns, 1);
    for (std::size_t i = 0; i < size; ++i)
    {
      if (numbers[i] >= 0)
      {
        sides(numbers[i], 0) = rest[static_cast<Eigen::Index>(i)];
      }
    }
    const double scale = sides.norm();
    const auto free = FreeEquations(matrix.Value, numbers, solution.Unknowns, params.Threads);
    const Eigen::MatrixXd before = sides;
    LinearSolverReport report;
    if (const Status status = SolveUnknowns(
          space, NumSolutionComponents(problem.Equation), numbers, free, params, sides, report);
        !status)
    {
      return status;
    }
    solution.Iterations = report.Iterations;
    solution.Preconditioner = report.Preconditioner;
    solution.Residual =
      scale > 0.0 ? (before - free.selfadjointView<Eigen::Lower>() * sides).norm() / scale : 0.0;
    for (std::size_t i = 0; i < size; ++i)
    {
      if (numbers[i] >= 0)
      {
        all[static_cast<Eigen::Index>(i)] = sides(numbers[i], 0);
      }
    }
  }
  solution.SecondsSolve = SecondsSince(start);
  const int components = NumSolutionComponents(problem.Equation);
  const Eigen::VectorXd forces = full * all;
  solution.Energy = 0.5 * all.dot(forces);
  solution.Potential = solution.Energy - all.dot(right.Value);
  Eigen::VectorXd reactions = forces - right.Value;
  for (std::size_t i = 0; i < size; ++i)
  {
    if (numbers[i] >= 0)
    {
      reactions[static_cast<Eigen::Index>(i)] = 0.0;
    }
  }
  const auto rows = [&](const Eigen::VectorXd& values) -> PointMatrix
  { return Eigen::Map<const PointMatrix>(values.data(), space.NumFunctions(), components); };
  solution.Coefficients = rows(all);
  solution.Reactions = rows(reactions);
  solution.TotalLoad = rows(right.Value).colwise().sum().transpose();
  solution.TotalReaction = solution.Reactions.colwise().sum().transpose();
  if (progress && !progress(1.0))
  {
    return { ErrorCode::Aborted, "after the solution" };
  }
  return solution;
}

GalerkinPoint EvaluateSolution(const GalerkinSpace& space, const GalerkinProblem& problem,
  const PointMatrixView& coefficients, int element, const double* u)
{
  PointValues values;
  EvaluateFunctions(space, element, u, values);
  GalerkinPoint point;
  point.Position = values.Position;
  point.Value.setZero(coefficients.cols());
  point.Gradient.setZero(coefficients.cols(), space.Dimension);
  for (int a = 0; a < space.NumAlive(element); ++a)
  {
    const Eigen::VectorXd row = coefficients.row(space.Alive(element)[a]).transpose();
    point.Value += values.Values[a] * row;
    point.Gradient += row * values.Gradients.row(a);
  }
  if (problem.Equation == GalerkinEquation::Poisson)
  {
    return point;
  }
  point.Stress = ElasticStress(problem, element, point.Gradient);
  return point;
}

Eigen::Matrix3d ElasticStress(
  const GalerkinProblem& problem, int element, const Eigen::Ref<const Eigen::MatrixXd>& gradient)
{
  const GalerkinMaterial& material = MaterialOf(problem, element);
  const LameConstants lame = MakeLameConstants(problem.Equation, material);
  const Eigen::Index n = gradient.cols();
  double trace = 0.0;
  for (Eigen::Index i = 0; i < n; ++i)
  {
    trace += gradient(i, i);
  }
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < n; ++i)
  {
    for (Eigen::Index j = 0; j < n; ++j)
    {
      stress(i, j) =
        lame.Shear * (gradient(i, j) + gradient(j, i)) + (i == j ? lame.First * trace : 0.0);
    }
  }
  if (problem.Equation == GalerkinEquation::PlaneStrain)
  {
    stress(2, 2) = material.PoissonsRatio * (stress(0, 0) + stress(1, 1));
  }
  return stress;
}

double EnergyDensity(
  const GalerkinProblem& problem, int element, const Eigen::Ref<const Eigen::MatrixXd>& gradient)
{
  if (problem.Equation == GalerkinEquation::Poisson)
  {
    return 0.5 * MaterialOf(problem, element).Conductivity * gradient.squaredNorm();
  }
  const Eigen::Matrix3d stress = ElasticStress(problem, element, gradient);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < gradient.rows(); ++i)
  {
    for (Eigen::Index j = 0; j < gradient.cols(); ++j)
    {
      sum += stress(i, j) * gradient(i, j);
    }
  }
  return 0.5 * sum;
}

double VonMisesStress(const Eigen::Matrix3d& stress)
{
  const Eigen::Matrix3d deviator = stress - stress.trace() / 3.0 * Eigen::Matrix3d::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

ErrorNorms SolutionError(const GalerkinSpace& space, const PointMatrixView& coefficients,
  const PointFunction& exact, const PointFunction& gradient, int extraPoints)
{
  ErrorNorms sum;
  const Eigen::Index components = coefficients.cols();
  Eigen::VectorXd value(components);
  PointMatrix slope(components, space.Dimension);
  RuleTables tables(1e-10, extraPoints);
  for (int e = 0; e < space.NumElements(); ++e)
  {
    tables.Visit(space, e,
      [&](std::size_t q, const PointValues& at)
      {
        exact(at.Position.data(), value.data());
        gradient(at.Position.data(), slope.data());
        for (int a = 0; a < space.NumAlive(e); ++a)
        {
          const auto row = coefficients.row(space.Alive(e)[a]);
          value -= at.Values[a] * row.transpose();
          slope -= row.transpose() * at.Gradients.row(a);
        }
        const double weight = tables.Weights[q] * std::abs(at.Determinant);
        sum.L2 += weight * value.squaredNorm();
        sum.H1 += weight * slope.squaredNorm();
      });
  }
  return { std::sqrt(sum.L2), std::sqrt(sum.H1) };
}
}
