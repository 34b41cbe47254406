// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BernsteinCells.h>

#include <map>

/// Sub-cells of Bernstein cells of any shape, made by bisection, with a bound of their rounding:
/// what the proofs of this module that are not about det J alone descend on.
namespace knotwork
{
/// The lattice of Bernstein coefficients of one shape and degree.
class CellLattice
{
public:
  /// Coefficients along parallels of one direction, from end to end: the restriction to such a line
  /// is a univariate Bernstein polynomial, so bisection across the direction is de Casteljau's
  /// algorithm on every line. The first line holds the corners From and To.
  struct Direction
  {
    int From = 0; ///< corner
    int To = 0;   ///< corner
    std::vector<std::vector<int>> Lines;
    /// Corners at the two ends of a line.
    std::vector<std::array<int, 2>> CornerPairs;
  };

  CellLattice() = default;
  CellLattice(CellShape shape, const CellDegree& degree);

  CellShape Shape = CellShape::Curve;
  CellDegree Degree{};
  int Size = 0;
  std::vector<int> Corners; ///< the corners' coefficients
  /// Tensor-product shapes: one a parameter, in order. Triangle: 01, 02, 12; Tetrahedron: all six
  /// edges; Wedge: the triangle's three, then the third parameter.
  std::vector<Direction> Directions;
};

/// Lattices by shape and degree.
using CellLatticeTable = std::map<std::pair<int, CellDegree>, CellLattice>;

/// One sub-cell.
struct CellPiece
{
  std::vector<double> Data; ///< planes of Size values as in BernsteinCells, rounded
  double Error = 0.0;       ///< every value of Data is off by at most so much
  /// Corners' local parameters in the cell: exact dyadic numbers.
  std::array<std::array<double, 3>, 8> Corners{};
  int Depth = 0;
};

/// The whole cell as a piece.
CellPiece MakePiece(const CellLattice& lattice, int numPlanes, const double* data, double error);

/// Both halves across Directions[direction]; the first keeps the corner From.
/// @source  de Casteljau; the mean of two doubles is off by at most half an ulp.
std::array<CellPiece, 2> Bisect(
  const CellLattice& lattice, int numPlanes, const CellPiece& piece, int direction);

/// Euclidean control points of a piece with their common error bound, and their box.
struct PieceHull
{
  int NumComponents = 0;
  std::vector<double> Points; ///< Size x NumComponents
  double Error = 0.0;         ///< of every coordinate
  std::array<double, 3> Lower{};
  std::array<double, 3> Upper{}; ///< box of the exact piece: Error is included

  const double* Point(int i) const
  {
    return this->Points.data() + static_cast<std::size_t>(i * this->NumComponents);
  }
};
PieceHull MakeHull(
  const CellLattice& lattice, int numComponents, bool rational, const CellPiece& piece);

/// Of all directions the one in which the piece's control polygons are longest.
int LongestDirection(const CellLattice& lattice, const PieceHull& hull);

/// Values of the Bernstein polynomials of a cell at local parameters u: Size values, and d x Size
/// derivatives when asked for.
void EvaluateCellBasis(
  CellShape shape, const CellDegree& degree, const double* u, double* values, double* derivatives);

/// Point of a cell and derivatives with respect to its local parameters.
struct CellPoint
{
  std::array<double, 3> Position{};
  std::array<std::array<double, 3>, 3> Derivative{}; ///< [parameter][component]
};
CellPoint EvaluateCell(const BernsteinCells& cells, int cell, const double* u);
}
