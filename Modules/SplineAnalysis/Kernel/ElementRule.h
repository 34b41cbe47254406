// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinSpace.h"

#include <map>
#include <tuple>

/// Quadrature on elements and their sides, and functions at its points.
namespace knotwork
{
/// Affine parameters of a side of an element, the unit interval, square or triangle.
struct FacetFrame
{
  std::array<double, 3> Origin{};
  std::array<std::array<double, 3>, 2> Tangents{};
  /// Outward, as long as the tangents' parallelogram (edge) is large.
  std::array<double, 3> Normal{};

  std::array<double, 3> Point(const std::array<double, 2>& s) const
  {
    std::array<double, 3> u = this->Origin;
    for (std::size_t d = 0; d < 3; ++d)
    {
      u[d] += s[0] * this->Tangents[0][d] + s[1] * this->Tangents[1][d];
    }
    return u;
  }
};
FacetFrame MakeFacetFrame(CellShape shape, int side);

/// Points (rows of 3, unused ones 0) and weights in the parameters of a shape.
struct CellRule
{
  std::vector<std::array<double, 3>> Points;
  std::vector<double> Weights;
};
/// Gauss points on tensor-product shapes, collapsed ones on simplices. @param points  a direction.
CellRule MakeCellRule(CellShape shape, int points);
/// The same on a side.
CellRule MakeFacetRule(CellShape shape, int side, int points);

/// Gauss points a direction that integrate stiffness of constant gradients exactly where elements
/// are polynomial; where they are rational, as far as the distance of the weights' zeros lets
/// quadrature converge to the tolerance (at most 24). @source  Davis, Rabinowitz, Methods of
/// Numerical Integration, 1984, 4.6 (Gauss rules of functions analytic in an ellipse).
int NumRulePoints(const GalerkinSpace& space, int element, double tolerance);

/// Functions of an element at a point.
struct PointValues
{
  Eigen::VectorXd Values;   ///< of the alive functions
  PointMatrix Gradients;    ///< alive functions x dimension, with respect to x
  Eigen::VectorXd Position; ///< of the point
  Eigen::MatrixXd Inverse;  ///< d(parameters) / dx
  double Determinant = 0.0; ///< of dx / d(parameters)
};
/// @param u  local parameters.
void EvaluateFunctions(
  const GalerkinSpace& space, int element, const double* u, PointValues& values);

using PointVisitor = std::function<void(std::size_t point, const PointValues& values)>;

/// Rules of elements with the Bernstein polynomials at their points, each made once. One a thread.
class RuleTables
{
public:
  /// @param extraPoints  a direction, beyond NumRulePoints.
  explicit RuleTables(double tolerance, int extraPoints = 0)
    : Tolerance(tolerance), ExtraPoints(extraPoints)
  {
  }
  /// Calls for every point of the element's rule.
  void Visit(const GalerkinSpace& space, int element, const PointVisitor& visit);
  const double* Weights = nullptr; ///< of the points of the element visited last
  int NumPoints = 0;

private:
  struct Table
  {
    CellRule Rule;
    PointMatrix Bernstein;
  };
  double Tolerance;
  int ExtraPoints;
  std::map<std::tuple<CellShape, CellDegree, int>, Table> Tables;
};

/// The area vector of a side at a point where the functions are known: outward, for the unit of the
/// side's parameters.
Eigen::VectorXd AreaVector(const FacetFrame& frame, const PointValues& values);

/// Functions that are not 0 on a side, ascending.
std::vector<int> TraceFunctions(const GalerkinSpace& space, const CellSide& facet);
}
