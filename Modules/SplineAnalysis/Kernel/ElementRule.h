// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinSpace.h"

#include <functional>

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
/// Of the sides of an element: all have one.
CellShape FacetShape(CellShape shape);

/// Points (rows of 3, unused ones 0) and weights in the parameters of a shape.
struct CellRule
{
  std::vector<std::array<double, 3>> Points;
  std::vector<double> Weights;
};
/// Gauss points on tensor-product shapes, collapsed ones on simplices. @param points  a direction.
CellRule MakeCellRule(CellShape shape, int points);
/// Evenly spaced points with the corners among them; weights are 0. @param points  a direction, at
/// least 2.
CellRule MakeLatticeRule(CellShape shape, int points);
/// Gauss points on a side.
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

/// Functions that inner loops take at a time.
inline constexpr int FunctionBlock = 4;
/// @return the number of an element's functions, up to whole blocks.
inline int PaddedFunctions(int functions)
{
  return (functions + FunctionBlock - 1) / FunctionBlock * FunctionBlock;
}

/// Functions of an element at the points of its rule, and their derivatives by the parameters.
struct QuadratureFunctions
{
  int NumPoints = 0;
  int NumFunctions = 0; ///< alive
  int Stride = 0;       ///< PaddedFunctions(NumFunctions)
  /// Row point * (dimension + 1) + k has Stride entries, 0 behind NumFunctions: values (k = 0) or
  /// derivatives by parameter k - 1.
  const double* Rows = nullptr;
  const double* Weights = nullptr; ///< of the points
};

/// Rules of the elements of a space, with the functions at their points: elements of equal
/// operators share them.
class RuleTables
{
public:
  /// @param extraPoints  a direction, beyond NumRulePoints.
  explicit RuleTables(double tolerance, int extraPoints = 0)
    : Tolerance(tolerance), ExtraPoints(extraPoints)
  {
  }
  /// Evenly spaced points in place of a rule: degree + 1 a direction.
  static RuleTables OnLattice()
  {
    RuleTables tables(1.0);
    tables.IsLattice = true;
    return tables;
  }
  /// Makes the rules of a space's elements, and the functions of operators that repeat: at most 64
  /// MB of them.
  void Prepare(const GalerkinSpace& space);
  /// May be called by several threads at a time. @param memory  for the rows, where they are not
  /// shared. @pre  Prepare(space).
  QuadratureFunctions Functions(
    const GalerkinSpace& space, int element, std::vector<double>& memory) const;
  /// Calls for every point of the element's rule. Prepares when the space is another one.
  void Visit(const GalerkinSpace& space, int element, const PointVisitor& visit);
  const double* Weights = nullptr; ///< of the points of the element visited last
  int NumPoints = 0;

private:
  struct Table
  {
    CellRule Rule;
    PointMatrix Bernstein; ///< rows as those of QuadratureFunctions
  };
  double Tolerance;
  int ExtraPoints;
  bool IsLattice = false;
  const GalerkinSpace* Prepared = nullptr;
  std::vector<Table> Tables;
  std::vector<int> TableOf;                ///< element
  std::vector<int> SharedOf;               ///< element; -1: rows are its own
  std::vector<std::vector<double>> Shared; ///< rows
  std::vector<double> Memory;
};

/// The area vector of a side at a point where the functions are known: outward, for the unit of the
/// side's parameters.
Eigen::VectorXd AreaVector(const FacetFrame& frame, const PointValues& values);

/// Functions that are not 0 on a side, ascending.
std::vector<int> TraceFunctions(const GalerkinSpace& space, const CellSide& facet);
}
