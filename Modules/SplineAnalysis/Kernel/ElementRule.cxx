// SPDX-License-Identifier: BSD-3-Clause
#include "ElementRule.h"

#include "ElementGeometry.h"

#include <knotwork/JacobianValidation/CellPieces.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace knotwork
{
namespace
{
bool IsSimplex(CellShape shape)
{
  return shape == CellShape::Triangle || shape == CellShape::Tetrahedron;
}

/// Whether a Bernstein polynomial is not 0 on a side.
bool LiesOnSide(CellShape shape, const CellDegree& degree, int side, const std::array<int, 3>& i)
{
  if (IsSimplex(shape))
  {
    return side < NumParameters(shape) ? i[static_cast<std::size_t>(side)] == 0
                                       : i[0] + i[1] + i[2] == degree[0];
  }
  const std::size_t d = AcrossSide(side);
  return i[d] == (side % 2 == 0 ? 0 : degree[d]);
}
}

std::vector<std::array<int, 3>> SideCorners(CellShape shape, const CellDegree& degree, int side)
{
  std::vector<std::array<int, 3>> corners;
  for (int c = 0; c < NumCorners(shape); ++c)
  {
    const std::array<double, 3> u = CornerParameters(shape, c);
    std::array<int, 3> place{};
    for (std::size_t d = 0; d < 3; ++d)
    {
      place[d] = u[d] > 0.5 ? degree[d] : 0;
    }
    if (LiesOnSide(shape, degree, side, place))
    {
      corners.push_back(place);
    }
  }
  return corners;
}

FacetFrame MakeFacetFrame(CellShape shape, int side)
{
  FacetFrame frame;
  const int dimension = NumParameters(shape);
  const auto last = static_cast<std::size_t>(dimension - 1);
  if (IsSimplex(shape) && side == dimension)
  {
    frame.Origin[last] = 1.0;
    for (std::size_t k = 0; k < last; ++k)
    {
      frame.Tangents[k][k] = 1.0;
      frame.Tangents[k][last] = -1.0;
    }
    std::fill_n(frame.Normal.begin(), dimension, 1.0);
    return frame;
  }
  const auto across = IsSimplex(shape) ? static_cast<std::size_t>(side) : AcrossSide(side);
  const bool upper = !IsSimplex(shape) && side % 2 == 1;
  frame.Origin[across] = upper ? 1.0 : 0.0;
  frame.Normal[across] = upper ? 1.0 : -1.0;
  for (std::size_t d = 0, k = 0; d <= last; ++d)
  {
    if (d != across)
    {
      frame.Tangents[k++][d] = 1.0;
    }
  }
  return frame;
}

CellShape FacetShape(CellShape shape)
{
  return NumParameters(shape) == 2    ? CellShape::Curve
    : shape == CellShape::Tetrahedron ? CellShape::Triangle
                                      : CellShape::Quadrilateral;
}

CellRule MakeCellRule(CellShape shape, int points)
{
  const QuadratureRule line = GaussLegendre(points);
  const int dimension = NumParameters(shape);
  const std::size_t n = line.Nodes.size();
  CellRule rule;
  for (std::size_t k = 0; k < (dimension > 2 ? n : 1); ++k)
  {
    for (std::size_t j = 0; j < (dimension > 1 ? n : 1); ++j)
    {
      for (std::size_t i = 0; i < n; ++i)
      {
        std::array<double, 3> u{ line.Nodes[i], dimension > 1 ? line.Nodes[j] : 0.0,
          dimension > 2 ? line.Nodes[k] : 0.0 };
        double weight = line.Weights[i] * (dimension > 1 ? line.Weights[j] : 1.0) *
          (dimension > 2 ? line.Weights[k] : 1.0);
        if (IsSimplex(shape))
        {
          const double rest = 1.0 - u[0];
          weight *= rest;
          if (dimension == 3)
          {
            weight *= rest * (1.0 - u[1]);
            u[2] *= rest * (1.0 - u[1]);
          }
          u[1] *= rest;
        }
        rule.Points.push_back(u);
        rule.Weights.push_back(weight);
      }
    }
  }
  return rule;
}

CellRule MakeLatticeRule(CellShape shape, int points)
{
  const int n = points - 1;
  const int dimension = NumParameters(shape);
  CellRule rule;
  for (int k = 0; k <= (dimension > 2 ? n : 0); ++k)
  {
    for (int j = 0; j <= (dimension > 1 ? n : 0); ++j)
    {
      for (int i = 0; i <= (IsSimplex(shape) ? n - j - k : n); ++i)
      {
        rule.Points.push_back(
          { static_cast<double>(i) / n, static_cast<double>(j) / n, static_cast<double>(k) / n });
      }
    }
  }
  rule.Weights.assign(rule.Points.size(), 0.0);
  return rule;
}

CellRule MakeFacetRule(CellShape shape, int side, int points)
{
  const FacetFrame frame = MakeFacetFrame(shape, side);
  CellRule rule = MakeCellRule(FacetShape(shape), points);
  for (std::array<double, 3>& point : rule.Points)
  {
    point = frame.Point({ point[0], point[1] });
  }
  return rule;
}

int NumRulePoints(const GalerkinSpace& space, int element, double tolerance)
{
  const auto e = static_cast<std::size_t>(element);
  const CellDegree& degree = space.Degrees[e];
  const int p = *std::max_element(degree.begin(), degree.end());
  const int exact = space.Dimension == 3 ? (3 * p + 1) / 2 : p + 1;
  int points = std::max(p + (IsSimplex(space.Shapes[e]) ? 2 : 1), exact);
  if (space.Weights.size() > 0)
  {
    double low = space.Weights[space.Alive(element)[0]];
    double high = low;
    for (int a = 0; a < space.NumAlive(element); ++a)
    {
      low = std::min(low, space.Weights[space.Alive(element)[a]]);
      high = std::max(high, space.Weights[space.Alive(element)[a]]);
    }
    if (high > low * (1.0 + 1e-9))
    {
      // zeros of quadratic weights of this spread are nearer than those of linear ones by 0.4
      const double distance = 0.4 * (high + low) / (high - low);
      const double radius = std::log(distance + std::sqrt(distance * distance + 1.0));
      points =
        std::max(points, p + static_cast<int>(std::ceil(-std::log(tolerance) / (2 * radius))));
    }
  }
  return std::min(points, 24);
}

namespace
{
/// Values and derivatives of the Bernstein polynomials at a point: a row each.
void FillBernstein(
  const GalerkinSpace& space, int element, const double* u, Eigen::Ref<PointMatrix> rows)
{
  const auto e = static_cast<std::size_t>(element);
  EvaluateCellBasis(space.Shapes[e], space.Degrees[e], u, rows.data(), rows.data() + rows.cols());
}

/// Functions of an element from the Bernstein polynomials, a row each; the quotient rule where they
/// are rational.
void FillRows(const GalerkinSpace& space, int element, const PointMatrix& bernstein, double* rows)
{
  const int alive = space.NumAlive(element);
  const int stride = PaddedFunctions(alive);
  Eigen::Map<PointMatrix> all(rows, bernstein.rows(), stride);
  const Eigen::Map<const PointMatrix> extraction(space.Operator(element), alive, bernstein.cols());
  all.leftCols(alive).noalias() = bernstein * extraction.transpose();
  all.rightCols(stride - alive).setZero();
}

/// Rows of rational functions by the quotient rule. @param from  the rows without weights; may be
/// the same place.
void MakeRational(
  const GalerkinSpace& space, int element, const double* from, Eigen::Index numRows, double* rows)
{
  const int alive = space.NumAlive(element);
  const int stride = PaddedFunctions(alive);
  const int planes = 1 + space.Dimension;
  std::vector<double> weights(static_cast<std::size_t>(stride), 0.0);
  for (int a = 0; a < alive; ++a)
  {
    weights[static_cast<std::size_t>(a)] = space.Weights[space.Alive(element)[a]];
  }
  for (Eigen::Index first = 0; first < numRows; first += planes)
  {
    const double* given = from + first * stride;
    double* const values = rows + first * stride;
    const double inverse = 1.0 / Dot(weights.data(), given, stride);
    for (int a = 0; a < stride; ++a)
    {
      values[a] = weights[static_cast<std::size_t>(a)] * given[a] * inverse;
    }
    for (int k = 1; k < planes; ++k)
    {
      given += stride;
      double* const slopes = values + std::ptrdiff_t{ k } * stride;
      const double sum = Dot(weights.data(), given, stride);
      for (int a = 0; a < stride; ++a)
      {
        slopes[a] = (weights[static_cast<std::size_t>(a)] * given[a] - sum * values[a]) * inverse;
      }
    }
  }
}

template <int Dim>
void FinishAll(const GalerkinSpace& space, int element, const QuadratureFunctions& functions,
  const PointVisitor& visit)
{
  ElementGeometry<Dim> geometry;
  geometry.Take(space, element, functions.Stride);
  PointValues values;
  for (int q = 0; q < functions.NumPoints; ++q)
  {
    const double* rows = functions.Rows + std::ptrdiff_t{ q } * (Dim + 1) * functions.Stride;
    const Eigen::Map<const PointMatrix, 0, Eigen::OuterStride<>> local(
      rows, Dim + 1, functions.NumFunctions, Eigen::OuterStride<>(functions.Stride));
    const Eigen::Matrix<double, Dim, Dim> jacobian = geometry.Jacobian(rows + functions.Stride);
    const Eigen::Matrix<double, Dim, Dim> inverse = jacobian.inverse();
    values.Values = local.row(0).transpose();
    values.Position = geometry.Position(rows);
    values.Determinant = jacobian.determinant();
    values.Inverse = inverse;
    values.Gradients = local.template bottomRows<Dim>().transpose().lazyProduct(inverse);
    visit(static_cast<std::size_t>(q), values);
  }
}

void VisitPoints(const GalerkinSpace& space, int element, const QuadratureFunctions& functions,
  const PointVisitor& visit)
{
  space.Dimension == 2 ? FinishAll<2>(space, element, functions, visit)
                       : FinishAll<3>(space, element, functions, visit);
}
}

void EvaluateFunctions(
  const GalerkinSpace& space, int element, const double* u, PointValues& values)
{
  const auto e = static_cast<std::size_t>(element);
  PointMatrix bernstein(
    1 + space.Dimension, NumCellCoefficients(space.Shapes[e], space.Degrees[e]));
  FillBernstein(space, element, u, bernstein);
  const int alive = space.NumAlive(element);
  PointMatrix rows(bernstein.rows(), PaddedFunctions(alive));
  FillRows(space, element, bernstein, rows.data());
  if (space.Weights.size() > 0)
  {
    MakeRational(space, element, rows.data(), rows.rows(), rows.data());
  }
  VisitPoints(space, element, { 1, alive, PaddedFunctions(alive), rows.data(), nullptr },
    [&](std::size_t, const PointValues& at) { values = at; });
}

void RuleTables::Prepare(const GalerkinSpace& space)
{
  constexpr std::size_t Limit = std::size_t{ 64 } << 20; // bytes of shared rows
  constexpr int Repeats = 4;                             // of an operator whose rows are shared
  this->Prepared = &space;
  this->Tables.clear();
  this->Shared.clear();
  const auto count = static_cast<std::size_t>(space.NumElements());
  this->TableOf.resize(count);
  this->SharedOf.assign(count, -1);
  std::map<std::tuple<CellShape, CellDegree, int>, int> known;
  std::map<std::pair<int, std::size_t>, std::pair<int, int>> uses; // number of uses, shared rows
  for (std::size_t e = 0; e < count; ++e)
  {
    const CellShape shape = space.Shapes[e];
    const CellDegree& degree = space.Degrees[e];
    const int points = this->IsLattice
      ? *std::max_element(degree.begin(), degree.end()) + 1
      : NumRulePoints(space, static_cast<int>(e), this->Tolerance) + this->ExtraPoints;
    const auto place =
      known.try_emplace({ shape, degree, points }, static_cast<int>(this->Tables.size()));
    if (place.second)
    {
      Table& table = this->Tables.emplace_back();
      table.Rule = this->IsLattice ? MakeLatticeRule(shape, points) : MakeCellRule(shape, points);
      const Eigen::Index rows = 1 + space.Dimension;
      table.Bernstein.resize(rows * static_cast<Eigen::Index>(table.Rule.Points.size()),
        NumCellCoefficients(shape, degree));
      for (std::size_t q = 0; q < table.Rule.Points.size(); ++q)
      {
        FillBernstein(space, static_cast<int>(e), table.Rule.Points[q].data(),
          table.Bernstein.middleRows(static_cast<Eigen::Index>(q) * rows, rows));
      }
    }
    this->TableOf[e] = place.first->second;
    ++uses.try_emplace({ this->TableOf[e], space.Operators[e] }, 0, -1).first->second.first;
  }
  std::size_t bytes = 0;
  for (std::size_t e = 0; e < count; ++e)
  {
    auto& use = uses[{ this->TableOf[e], space.Operators[e] }];
    if (use.second < 0 && use.first >= Repeats)
    {
      const int element = static_cast<int>(e);
      const PointMatrix& bernstein =
        this->Tables[static_cast<std::size_t>(this->TableOf[e])].Bernstein;
      const std::size_t size =
        static_cast<std::size_t>(bernstein.rows() * PaddedFunctions(space.NumAlive(element)));
      if (bytes + size * sizeof(double) > Limit)
      {
        continue;
      }
      bytes += size * sizeof(double);
      use.second = static_cast<int>(this->Shared.size());
      this->Shared.emplace_back(size);
      FillRows(space, element, bernstein, this->Shared.back().data());
    }
    this->SharedOf[e] = use.second;
  }
}

QuadratureFunctions RuleTables::Functions(
  const GalerkinSpace& space, int element, std::vector<double>& memory) const
{
  const auto e = static_cast<std::size_t>(element);
  const Table& table = this->Tables[static_cast<std::size_t>(this->TableOf[e])];
  QuadratureFunctions functions;
  functions.NumPoints = static_cast<int>(table.Rule.Points.size());
  functions.NumFunctions = space.NumAlive(element);
  functions.Stride = PaddedFunctions(functions.NumFunctions);
  functions.Weights = table.Rule.Weights.data();
  const bool rational = space.Weights.size() > 0;
  const int shared = this->SharedOf[e];
  if (shared >= 0 && !rational)
  {
    functions.Rows = this->Shared[static_cast<std::size_t>(shared)].data();
    return functions;
  }
  memory.resize(static_cast<std::size_t>(table.Bernstein.rows() * functions.Stride));
  if (shared < 0)
  {
    FillRows(space, element, table.Bernstein, memory.data());
  }
  if (rational)
  {
    const double* const from =
      shared < 0 ? memory.data() : this->Shared[static_cast<std::size_t>(shared)].data();
    MakeRational(space, element, from, table.Bernstein.rows(), memory.data());
  }
  functions.Rows = memory.data();
  return functions;
}

void RuleTables::Visit(const GalerkinSpace& space, int element, const PointVisitor& visit)
{
  if (this->Prepared != &space)
  {
    this->Prepare(space);
  }
  const QuadratureFunctions functions = this->Functions(space, element, this->Memory);
  this->Weights = functions.Weights;
  this->NumPoints = functions.NumPoints;
  VisitPoints(space, element, functions, visit);
}

Eigen::VectorXd AreaVector(const FacetFrame& frame, const PointValues& values)
{
  const Eigen::Map<const Eigen::VectorXd> normal(frame.Normal.data(), values.Inverse.rows());
  return std::abs(values.Determinant) * (values.Inverse.transpose() * normal);
}

std::vector<int> TraceFunctions(const GalerkinSpace& space, const CellSide& facet)
{
  const auto e = static_cast<std::size_t>(facet.Cell);
  const CellShape shape = space.Shapes[e];
  const CellDegree& degree = space.Degrees[e];
  const int n = NumCellCoefficients(shape, degree);
  std::vector<int> places;
  for (int k = 0; k <= degree[2]; ++k)
  {
    for (int j = 0; j <= degree[1]; ++j)
    {
      for (int i = 0; i <= degree[0]; ++i)
      {
        if ((!IsSimplex(shape) || i + j + k <= degree[0]) &&
          LiesOnSide(shape, degree, facet.Side, { i, j, k }))
        {
          places.push_back(CellCoefficient(shape, degree, i, j, k));
        }
      }
    }
  }
  std::vector<int> functions;
  for (int a = 0; a < space.NumAlive(facet.Cell); ++a)
  {
    const double* row = space.Operator(facet.Cell) + std::ptrdiff_t{ a } * n;
    if (std::any_of(places.begin(), places.end(), [&](int j) { return std::abs(row[j]) > 1e-13; }))
    {
      functions.push_back(space.Alive(facet.Cell)[a]);
    }
  }
  std::sort(functions.begin(), functions.end());
  return functions;
}
}
