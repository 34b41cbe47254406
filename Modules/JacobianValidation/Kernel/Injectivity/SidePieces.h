// SPDX-License-Identifier: BSD-3-Clause
// Pieces of sides and what is measured on them; private to the separation of sides.
#pragma once
#include "RoundingBound.h"
#include "SideSeparation.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
/// A piece of a side with what the tests need, and its halves once it was bisected.
struct BoundaryPiece
{
  CellPiece Piece;
  PieceHull Hull;
  double Size = 0.0;    ///< largest extent
  double Largest = 0.0; ///< largest coordinate
  int Children[2] = { -1, -1 };
};

/// Range of a linear functional.
struct FunctionalRange
{
  double Low = std::numeric_limits<double>::infinity();
  double High = -std::numeric_limits<double>::infinity();
  void Add(double x)
  {
    this->Low = std::min(this->Low, x);
    this->High = std::max(this->High, x);
  }
  void Widen(double by)
  {
    this->Low -= by;
    this->High += by;
  }
  double Size() const { return std::max(std::abs(this->Low), std::abs(this->High)); }
};

inline double OneNorm(const Eigen::Vector3d& d)
{
  return d.cwiseAbs().sum();
}

/// Derivatives along a direction of a piece, from corner to corner, times the weight function:
/// (N - c W)' - (S - c) W'. Any linear functional of them lies in the range of the differences,
/// widened by what the second term and the rounding add.
struct PieceSlopes
{
  std::vector<Eigen::Vector3d> Differences;
  double WeightSlope = 0.0;
  double Rounding = 0.0; ///< of each coordinate
  const BoundaryPiece* Of = nullptr;
  Eigen::Vector3d Mean = Eigen::Vector3d::Zero();
};

/// How far normals turn on a piece.
struct PieceTurn
{
  int Direction = -1;
  double Size = 0.1;
};

/// Values of pieces, up to the tolerances of a proof.
class PieceMeasures
{
public:
  explicit PieceMeasures(const SeparationInput& input) : Input(input) {}

  int NumPlanes() const { return this->Input.NumComponents + (this->Input.Rational ? 1 : 0); }
  Eigen::Vector3d PointOf(const BoundaryPiece& node, int i) const
  {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    const double* p = node.Hull.Point(i);
    for (int d = 0; d < this->Input.NumComponents; ++d)
    {
      x[d] = p[d];
    }
    return x;
  }
  Eigen::Vector3d Centre(const BoundaryPiece& node) const;
  /// @param largest  coordinate, of the moved sides.
  double CollapseDistance(double largest) const
  {
    return this->Input.CollapseTolerance * std::max(largest, this->Input.Distance);
  }
  /// Control points that rounding alone tells apart are one point.
  bool IsOnePoint(const BoundaryPiece& node, int i, int j) const;
  /// Whether an edge is one point.
  bool IsCollapsed(const CellLattice& lattice, const BoundaryPiece& node, int edge) const;
  /// Hull and sizes of a piece.
  void Complete(const CellLattice& lattice, BoundaryPiece& node) const;
  PieceSlopes MakeSlopes(
    const CellLattice& lattice, const BoundaryPiece& node, int from, int to) const;
  FunctionalRange RangeOf(const Eigen::Vector3d& functional, const PieceSlopes& slopes) const;
  /// The direction in which the normals at the corners turn most, or -1 where they are nearly one.
  /// A face that turns in a narrow strip is cut along the strip, however long that is. Triangles
  /// are best kept equilateral.
  PieceTurn FindTurn(const CellLattice& lattice, const BoundaryPiece& node) const;
  /// A curve whose control points, projected to its chord, follow each other: it is one-to-one. The
  /// numerator of (f / w)' = (f' w - f w') / w^2 is a sum over i > k of non-negative Bernstein
  /// polynomials times (i - k) w_i w_k (x_i - x_k), x the projected points. Neighbours that are one
  /// point add nothing: the curve stands still at its end there, and goes on inside as long as some
  /// follow each other.
  bool IsMonotoneCurve(const BoundaryPiece& a) const;

  const SeparationInput& Input;
};
}
