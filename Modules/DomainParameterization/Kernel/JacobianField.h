// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>

#include <memory>

namespace knotwork
{
/// Numbers in a row are padded to this, so that inner loops run over whole vectors.
inline constexpr int RowLanes = 4;
typedef double RowVector __attribute__((vector_size(32)));
/// The same anywhere in memory.
typedef double RowVectorAt __attribute__((vector_size(32), aligned(8), may_alias));
inline const RowVectorAt& At(const double* p)
{
  return *reinterpret_cast<const RowVectorAt*>(p);
}
inline RowVectorAt& At(double* p)
{
  return *reinterpret_cast<RowVectorAt*>(p);
}

/// What is done with a row of quadrature points. Fields of a row: plane t * NumPlanes + c has n
/// numbers; t = 0 the values of component c, t = 1 ... Dim its derivatives.
class RowBody
{
public:
  virtual ~RowBody() = default;
  /// @param n          points, padded to a multiple of RowLanes; padding has weight 0.
  /// @param gradients  receives the derivatives of the sum with respect to the fields (values only
  ///                   when the field asks for values), weights included; nullptr: not wanted.
  /// @param weights    n weights, each to be multiplied by factor.
  /// @param padding    n numbers: 1 for padding, 0 for points.
  virtual void Row(int n, const double* fields, double* gradients, const double* weights,
    double factor, const double* padding) = 0;
};

/// Values and derivatives of planes of coefficients at a fixed set of points, and the transpose of
/// that: gradients with respect to the coefficients.
template <int Dim>
class JacobianField
{
public:
  virtual ~JacobianField() = default;
  /// Visits all points, row by row, on the calling thread.
  /// @param coefficients  numPlanes planes of NumFunctions numbers.
  /// @param gradient      as many numbers, overwritten; nullptr: not wanted.
  /// @param values        whether values are wanted beside derivatives.
  virtual void Visit(
    const double* coefficients, double* gradient, int numPlanes, bool values, RowBody& body) = 0;
  virtual int NumPoints() const = 0;
};

/// Points of one direction, with weights.
struct LinePoints
{
  std::vector<int> Elements;
  std::vector<double> Local;   ///< in [0, 1] of the element
  std::vector<double> Weights; ///< with respect to the domain's parameter
};

/// Gauss points: numPoints[e] on element e.
LinePoints GaussLine(const KnotVector& knots, const std::vector<int>& numPoints);
/// Equally spaced points, both ends included, n >= 2, weights 1 / n.
LinePoints UniformLine(const KnotVector& knots, int n);

/// On a tensor-product space: points are the product of three lines, sums are factorized direction
/// by direction, the innermost loop runs along the first direction.
template <int Dim>
std::unique_ptr<JacobianField<Dim>> MakeTensorField(
  const std::array<KnotVector, Dim>& knots, const std::array<LinePoints, Dim>& lines);

/// On any space, element by element, with numPoints[e] Gauss points a direction.
template <int Dim>
std::unique_ptr<JacobianField<Dim>> MakeElementField(
  const SplineSpace<Dim>& space, const std::vector<int>& numPoints);

/// Fields side by side that share coefficients: coefficient i of field p is number numbers[p][i] of
/// numFunctions.
template <int Dim>
std::unique_ptr<JacobianField<Dim>> MakeGluedField(
  std::vector<std::unique_ptr<JacobianField<Dim>>> fields, std::vector<std::vector<int>> numbers,
  int numFunctions);
}
