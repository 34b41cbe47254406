// SPDX-License-Identifier: BSD-3-Clause
#include "ResultFields.h"

#include "BoundaryEdges.h"
#include "ElementGeometry.h"
#include "LinearSolver.h"
#include "StiffnessMatrix.h"
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
/// Of quadrature on rational elements: what is drawn needs no more, and every point is a row.
constexpr double FieldTolerance = 1e-6;
constexpr std::size_t BatchChunk = 32; ///< elements that a thread takes at a time

/// Of a map at most in space, without memory of its own.
using SmallGradient = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

/// Fills the row of GaussValues of a gradient. @param withPrincipal  whether principal stresses are
/// wanted, which take longer than the rest.
void FillRow(const GalerkinProblem& problem, int element, const SmallGradient& gradient,
  bool withPrincipal, Eigen::Ref<Eigen::RowVectorXd> row)
{
  row.setZero();
  if (problem.Equation == GalerkinEquation::Poisson)
  {
    row.head(gradient.cols()) = MaterialOf(problem, element).Conductivity * gradient.row(0);
    return;
  }
  const Eigen::Matrix3d s = ElasticStress(problem, element, gradient);
  row.head(7) << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2), VonMisesStress(s);
  if (withPrincipal)
  {
    row.tail(3) = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(s, Eigen::EigenvaluesOnly)
                    .eigenvalues()
                    .reverse()
                    .transpose();
  }
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

/// What is known of an element at points, for a step that adds it to the rest.
struct ElementResults
{
  QuadratureFunctions Functions;
  std::vector<double> Memory; ///< of the functions
  PointMatrix Rows;           ///< as ResultFields::GaussValues
  PointMatrix Positions;
  Eigen::VectorXd Weights; ///< times volumes
  double Energy = 0.0;
  double LargestValue = 0.0; ///< squared
  Eigen::MatrixXd Moments;   ///< of the rows, a row a function
};

/// Rows, positions and weights of the element's points, its energy and largest value.
template <int Dim>
void FindValues(const GalerkinSpace& space, const GalerkinProblem& problem,
  const PointMatrix& coefficients, const RuleTables& tables, bool withPrincipal, int e,
  ElementResults& element)
{
  element.Functions = tables.Functions(space, e, element.Memory);
  const QuadratureFunctions& functions = element.Functions;
  element.Rows.resize(functions.NumPoints, NumResultColumns(problem.Equation));
  element.Positions.resize(functions.NumPoints, Dim);
  element.Weights.resize(functions.NumPoints);
  element.Energy = 0.0;
  element.LargestValue = 0.0;
  ElementGeometry<Dim> geometry;
  geometry.Take(space, e, functions.Stride);
  LocalCoefficients local;
  local.Take(space, e, functions.Stride, coefficients);
  const int components = static_cast<int>(coefficients.cols());
  SmallGradient gradient(components, Dim);
  for (int q = 0; q < functions.NumPoints; ++q)
  {
    const double* rows = functions.Rows + std::ptrdiff_t{ q } * (Dim + 1) * functions.Stride;
    const Eigen::Matrix<double, Dim, Dim> jacobian = geometry.Jacobian(rows + functions.Stride);
    double square = 0.0;
    for (int c = 0; c < components; ++c)
    {
      for (int k = 0; k < Dim; ++k)
      {
        gradient(c, k) = local.Combine(c, rows + std::ptrdiff_t{ k + 1 } * functions.Stride);
      }
      const double value = local.Combine(c, rows);
      square += value * value;
    }
    gradient = gradient.lazyProduct(jacobian.inverse().eval()).eval();
    element.LargestValue = std::max(element.LargestValue, square);
    element.Weights[q] = functions.Weights[q] * std::abs(jacobian.determinant());
    element.Positions.row(q) = geometry.Position(rows).transpose();
    FillRow(problem, e, gradient, withPrincipal, element.Rows.row(q));
    element.Energy += element.Weights[q] * EnergyDensity(problem, e, gradient);
  }
}

/// The element's part of the mass matrix, as AddElements takes it, and the moments of its rows.
void Integrate(const GalerkinSpace& space, int e, std::vector<int>& order, ElementResults& element,
  double* matrix)
{
  const QuadratureFunctions& functions = element.Functions;
  const Eigen::Map<const PointMatrix, 0, Eigen::OuterStride<>> values(functions.Rows,
    functions.NumPoints, functions.NumFunctions,
    Eigen::OuterStride<>((space.Dimension + 1) * functions.Stride));
  const Eigen::MatrixXd weighted = element.Weights.asDiagonal() * values;
  const Eigen::MatrixXd block = values.transpose() * weighted;
  element.Moments.noalias() = weighted.transpose() * element.Rows;
  SortFunctions(space, e, order);
  for (int b = 0; b < functions.NumFunctions; ++b)
  {
    double* row = matrix + FirstEntry(b, functions.Stride) - b / FunctionBlock * FunctionBlock;
    for (int a = b; a < functions.NumFunctions; ++a)
    {
      row[a] = block(order[static_cast<std::size_t>(a)], order[static_cast<std::size_t>(b)]);
    }
  }
}

/// Calls for batches of elements whose values are found in parallel. @param withPrincipal  as
/// FillRow.
/// @param visit  (first, count, elements); ends with its failure.
template <typename Visitor>
Status ForBatches(const GalerkinSpace& space, const GalerkinProblem& problem,
  const PointMatrix& coefficients, const RuleTables& tables, bool withPrincipal, int threads,
  const Visitor& visit)
{
  constexpr int Batch = 512; // elements whose points are held at a time
  const auto find = space.Dimension == 2 ? FindValues<2> : FindValues<3>;
  std::vector<ElementResults> elements(
    static_cast<std::size_t>(std::min(Batch, space.NumElements())));
  for (int first = 0; first < space.NumElements(); first += Batch)
  {
    const int count = std::min(Batch, space.NumElements() - first);
    ParallelFor(static_cast<std::size_t>(count), BatchChunk, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          find(space, problem, coefficients, tables, withPrincipal, first + static_cast<int>(i),
            elements[i]);
        }
      });
    if (const Status status = visit(first, count, elements); !status)
    {
      return status;
    }
  }
  return {};
}

/// Fills the peak of the fields.
Status FindPeak(const GalerkinSpace& space, const GalerkinProblem& problem,
  const PointMatrix& coefficients, int threads, const ProgressCallback& progress,
  ResultFields& fields)
{
  RuleTables tables = RuleTables::OnLattice();
  tables.Prepare(space);
  const bool isElastic = problem.Equation != GalerkinEquation::Poisson;
  return ForBatches(space, problem, coefficients, tables, false, threads,
    [&](int first, int count, const std::vector<ElementResults>& elements) -> Status
    {
      for (int i = 0; i < count; ++i)
      {
        const ElementResults& element = elements[static_cast<std::size_t>(i)];
        for (Eigen::Index q = 0; q < element.Rows.rows(); ++q)
        {
          const double value = isElastic ? element.Rows(q, 6) : element.Rows.row(q).norm();
          if (value > fields.Peak || fields.PeakPosition.size() == 0)
          {
            fields.Peak = value;
            fields.PeakPosition = element.Positions.row(q);
          }
        }
      }
      return progress && !progress(static_cast<double>(first + count) / space.NumElements())
        ? Status{ ErrorCode::Aborted, "while the peak was searched" }
        : Status();
    });
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

double EdgeLength(const GalerkinSpace& space, const std::vector<ElementEdge>& edges)
{
  double sum = 0.0;
  for (const ElementEdge& edge : edges)
  {
    VisitEdge(space, edge, 1e-10, [&](double length, const PointValues&) { sum += length; });
  }
  return sum;
}

int NumResultColumns(GalerkinEquation equation)
{
  return equation == GalerkinEquation::Poisson ? 3 : 10;
}

Result<ResultFields> MakeResultFields(const GalerkinSpace& space, const GalerkinProblem& problem,
  const std::vector<CellSide>& boundary, const PointMatrix& coefficients, bool keepGaussPoints,
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
  if (const Status status = MakePattern(space, 1, params, mass); !status)
  {
    return status;
  }
  Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(space.NumFunctions(), columns);
  RuleTables tables(std::max(params.QuadratureTolerance, FieldTolerance));
  tables.Prepare(space);
  const std::size_t width = NumEntries(space, 1);
  std::vector<double> matrices;
  double largest = 0.0; // squared
  const Status status = ForBatches(space, problem, coefficients, tables, true, params.Threads,
    [&](int first, int count, std::vector<ElementResults>& elements) -> Status
    {
      matrices.resize(width * static_cast<std::size_t>(count));
      ParallelFor(static_cast<std::size_t>(count), BatchChunk, params.Threads,
        [&](std::size_t begin, std::size_t end)
        {
          std::vector<int> order;
          for (std::size_t i = begin; i < end; ++i)
          {
            Integrate(
              space, first + static_cast<int>(i), order, elements[i], matrices.data() + i * width);
          }
        });
      AddElements(
        space, first, static_cast<std::size_t>(count), matrices, width, 1, params.Threads, mass);
      for (int i = 0; i < count; ++i)
      {
        const ElementResults& element = elements[static_cast<std::size_t>(i)];
        const int e = first + i;
        largest = std::max(largest, element.LargestValue);
        fields.Energy[e] = element.Energy;
        if (isElastic)
        {
          fields.LargestVonMises[e] = element.Rows.col(6).maxCoeff();
        }
        for (int a = 0; a < space.NumAlive(e); ++a)
        {
          sides.row(space.Alive(e)[a]) += element.Moments.row(a);
        }
        if (keepGaussPoints)
        {
          values.insert(
            values.end(), element.Rows.data(), element.Rows.data() + element.Rows.size());
          points.insert(points.end(), element.Positions.data(),
            element.Positions.data() + element.Positions.size());
          fields.GaussElements.insert(
            fields.GaussElements.end(), static_cast<std::size_t>(element.Rows.rows()), e);
        }
      }
      return progress && !progress(0.4 * (first + count) / space.NumElements())
        ? Status{ ErrorCode::Aborted, "while stresses were projected" }
        : Status();
    });
  if (!status)
  {
    return status;
  }
  fields.LargestValue =
    std::max(std::sqrt(largest), LargestAtCorners(space, boundary, coefficients));
  const auto count = static_cast<Eigen::Index>(fields.GaussElements.size());
  fields.GaussValues = Eigen::Map<const PointMatrix>(values.data(), count, columns);
  fields.GaussPoints = Eigen::Map<const PointMatrix>(points.data(), count, space.Dimension);
  if (const Status peak = FindPeak(
        space, problem, coefficients, params.Threads,
        [&](double share) { return !progress || progress(0.4 + 0.3 * share); }, fields);
      !peak)
  {
    return peak;
  }
  if (const Status solved = SolveMass(space, mass, params.Threads, sides); !solved)
  {
    return { solved.Code, "stresses cannot be projected: " + solved.Detail };
  }
  fields.Projected = sides;
  return fields;
}
}
