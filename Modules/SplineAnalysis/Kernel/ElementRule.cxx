// SPDX-License-Identifier: BSD-3-Clause
#include "ElementRule.h"

#include <knotwork/JacobianValidation/CellPieces.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

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

CellRule MakeFacetRule(CellShape shape, int side, int points)
{
  const FacetFrame frame = MakeFacetFrame(shape, side);
  const CellShape facet = NumParameters(shape) == 2 ? CellShape::Curve
    : shape == CellShape::Tetrahedron               ? CellShape::Triangle
                                                    : CellShape::Quadrilateral;
  CellRule rule = MakeCellRule(facet, points);
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

/// What follows from functions in local parameters, a row each, (value, derivatives): not rational
/// yet, and points of the functions.
template <int Dim>
void Finish(const GalerkinSpace& space, int element,
  Eigen::Matrix<double, Eigen::Dynamic, Dim + 1>& local,
  const Eigen::Matrix<double, Eigen::Dynamic, Dim>& points, PointValues& values)
{
  if (space.Weights.size() > 0)
  {
    for (Eigen::Index a = 0; a < local.rows(); ++a)
    {
      local.row(a) *= space.Weights[space.Alive(element)[a]];
    }
    const Eigen::Matrix<double, 1, Dim + 1> sum = local.colwise().sum();
    local.col(0) /= sum[0];
    for (int d = 1; d <= Dim; ++d)
    {
      local.col(d) = (local.col(d) - local.col(0) * sum[d]) / sum[0];
    }
  }
  values.Values = local.col(0);
  values.Position = points.transpose() * local.col(0);
  // entry (component, parameter)
  const Eigen::Matrix<double, Dim, Dim> jacobian =
    points.transpose() * local.template rightCols<Dim>();
  const Eigen::Matrix<double, Dim, Dim> inverse = jacobian.inverse();
  values.Determinant = jacobian.determinant();
  values.Inverse = inverse;
  values.Gradients = local.template rightCols<Dim>() * inverse;
}

/// Functions at points whose Bernstein polynomials are known: one product for all of them.
template <int Dim>
void EvaluateAll(
  const GalerkinSpace& space, int element, const PointMatrix& bernstein, const PointVisitor& visit)
{
  const int alive = space.NumAlive(element);
  const Eigen::Map<const PointMatrix> extraction(space.Operator(element), alive, bernstein.cols());
  Eigen::Matrix<double, Eigen::Dynamic, Dim> points(alive, Dim);
  for (int a = 0; a < alive; ++a)
  {
    points.row(a) = space.Points.row(space.Alive(element)[a]);
  }
  const Eigen::MatrixXd all = extraction * bernstein.transpose();
  Eigen::Matrix<double, Eigen::Dynamic, Dim + 1> local;
  PointValues values;
  for (Eigen::Index q = 0; q < bernstein.rows() / (Dim + 1); ++q)
  {
    local = all.template middleCols<Dim + 1>(q * (Dim + 1));
    Finish<Dim>(space, element, local, points, values);
    visit(static_cast<std::size_t>(q), values);
  }
}
}

void EvaluateFunctions(
  const GalerkinSpace& space, int element, const double* u, PointValues& values)
{
  const auto e = static_cast<std::size_t>(element);
  PointMatrix bernstein(
    1 + space.Dimension, NumCellCoefficients(space.Shapes[e], space.Degrees[e]));
  FillBernstein(space, element, u, bernstein);
  const auto keep = [&](std::size_t, const PointValues& at) { values = at; };
  space.Dimension == 2 ? EvaluateAll<2>(space, element, bernstein, keep)
                       : EvaluateAll<3>(space, element, bernstein, keep);
}

void RuleTables::Visit(const GalerkinSpace& space, int element, const PointVisitor& visit)
{
  const auto e = static_cast<std::size_t>(element);
  const int count = NumRulePoints(space, element, this->Tolerance) + this->ExtraPoints;
  Table& table = this->Tables[{ space.Shapes[e], space.Degrees[e], count }];
  if (table.Rule.Points.empty())
  {
    table.Rule = MakeCellRule(space.Shapes[e], count);
    const Eigen::Index rows = 1 + space.Dimension;
    table.Bernstein.resize(rows * static_cast<Eigen::Index>(table.Rule.Points.size()),
      NumCellCoefficients(space.Shapes[e], space.Degrees[e]));
    for (std::size_t q = 0; q < table.Rule.Points.size(); ++q)
    {
      FillBernstein(space, element, table.Rule.Points[q].data(),
        table.Bernstein.middleRows(static_cast<Eigen::Index>(q) * rows, rows));
    }
  }
  this->Weights = table.Rule.Weights.data();
  this->NumPoints = static_cast<int>(table.Rule.Points.size());
  space.Dimension == 2 ? EvaluateAll<2>(space, element, table.Bernstein, visit)
                       : EvaluateAll<3>(space, element, table.Bernstein, visit);
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
