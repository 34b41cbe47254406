// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>

#include <cstdint>

namespace knotwork
{
/// Cells in Bernstein form. Local parameters lie in [0, 1]^d (Curve, Quadrilateral, Hexahedron), in
/// the unit simplex u, v(, w) >= 0, u + v(+ w) <= 1 (Triangle, Tetrahedron), or in triangle (u, v)
/// times [0, 1] (Wedge).
enum class CellShape : std::uint8_t
{
  Curve,
  Quadrilateral,
  Hexahedron,
  Triangle,
  Tetrahedron,
  Wedge
};
inline constexpr int NumCellShapes = 6;

/// Number of parameters: 1, 2 or 3.
int NumParameters(CellShape shape);
/// Corners: 2, 4, 8, 3, 4, 6.
int NumCorners(CellShape shape);
/// Corner c's parameters (0 or 1 each; the unused ones 0). Tensor-product shapes: bit d of c is the
/// end in direction d. Triangle: origin, u, v; Tetrahedron: origin, u, v, w; Wedge: the triangle at
/// w = 0, then at w = 1.
std::array<double, 3> CornerParameters(CellShape shape, int corner);

/// Degree per parameter; the unused entries are 0. Simplices repeat theirs: Triangle (p, p, 0),
/// Tetrahedron (p, p, p), Wedge (p, p, q).
using CellDegree = std::array<int, 3>;

/// Bernstein coefficients of a polynomial on a cell. Order, first index fastest:
/// tensor-product shapes  (i, j, k), 0 <= i <= p, 0 <= j <= q, 0 <= k <= r, of
///                        B_i^p(u) B_j^q(v) B_k^r(w);
/// Triangle               (i, j), i + j <= p, of p! / (i! j! l!) u^i v^j (1 - u - v)^l, l = p - i -
/// j; Tetrahedron            (i, j, k), i + j + k <= p, alike; Wedge                  (i, j, k), i
/// + j <= p, 0 <= k <= q: a triangle's block for each k.
int NumCellCoefficients(CellShape shape, const CellDegree& degree);
/// Place of (i, j, k) in that order. @pre the index is in range.
int CellCoefficient(CellShape shape, const CellDegree& degree, int i, int j, int k);

/// Cells of any shape and degree, each a block of planes (components; the weights last when
/// rational) of NumCellCoefficients values. Rational cells are homogeneous, (w x, w y, ..., w), as
/// in BezierForm. What certificates and measures take.
struct BernsteinCells
{
  int NumComponents = 0; ///< of the Euclidean point
  bool Rational = false;
  std::vector<CellShape> Shapes;
  std::vector<CellDegree> Degrees;
  std::vector<std::size_t> Offsets{ 0 }; ///< NumCells + 1 offsets into Data
  std::vector<double> Data;
  /// Empty: the stored numbers are the geometry. Otherwise one number >= 0 a cell: every stored
  /// value may be off by so much (rounding of a conversion from another basis), and what is proved
  /// holds for every geometry within.
  std::vector<double> Errors;
  /// Empty, or one number for each of Data, by which it is nearer: Data + Remainders is off by
  /// Errors less the largest remainder of the cell, so by nothing where that is all (products w x
  /// that are no doubles). Remainders of weights are 0.
  std::vector<double> Remainders;

  int NumCells() const { return static_cast<int>(this->Shapes.size()); }
  int NumPlanes() const { return this->NumComponents + (this->Rational ? 1 : 0); }
  const double* Block(int cell) const
  {
    return this->Data.data() + this->Offsets[static_cast<std::size_t>(cell)];
  }
  double* Block(int cell)
  {
    return this->Data.data() + this->Offsets[static_cast<std::size_t>(cell)];
  }
  /// What Data + Remainders of a cell may be off by.
  double Uncertainty(int cell) const;
  /// Two cells are of one shape and degree.
  bool AreAlike(std::size_t a, std::size_t b) const
  {
    return this->Shapes[a] == this->Shapes[b] && this->Degrees[a][0] == this->Degrees[b][0] &&
      this->Degrees[a][1] == this->Degrees[b][1] && this->Degrees[a][2] == this->Degrees[b][2];
  }
  /// Appends a cell of zeros and gives its number; fill Block(number).
  int Add(CellShape shape, const CellDegree& degree);

  /// Sizes fit, degrees lie in [1, 9], values and errors are finite, weights are positive; the
  /// detail names the first bad cell.
  Status Check() const;
  /// The same without looking at the values.
  Status CheckStructure() const;
};

/// Euclidean point of a cell at local parameters (those the shape does not have are ignored).
/// @param point  NumComponents numbers.
void EvaluateCell(
  const BernsteinCells& cells, int cell, const std::array<double, 3>& parameters, double* point);

/// The elements of a Bezier form, in order: curves, quadrilaterals or hexahedra.
template <int Dim>
BernsteinCells MakeBernsteinCells(const BezierForm<Dim>& form);
}
