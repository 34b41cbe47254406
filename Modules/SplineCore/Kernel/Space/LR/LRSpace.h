// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BoxLocator.h>
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// The multiplicity of a mesh line from a knot of the other direction on, up to the next piece or
/// the end of the domain; 0 is no line.
struct LRPiece
{
  int Knot = 0;
  int Multiplicity = 0;

  bool operator==(const LRPiece& other) const
  {
    return this->Knot == other.Knot && this->Multiplicity == other.Multiplicity;
  }
};
/// Ascending by knot, the first at knot 0, neighbours different.
using LRLine = std::vector<LRPiece>;

/// Definition of a space of LR B-splines: a mesh of axis-parallel lines on a box, and B-splines of
/// minimal support on it, N_i(u, v) = gamma_i B[t_i](u) B[s_i](v), which sum to one. Indices below
/// are indices into Knots.
/// @source  Dokken, Lyche, Pettersen, CAGD 30 (2013) 331-356.
struct LRBasis
{
  IntArray<2> Degree{};
  /// Distinct values, ascending; the first and the last are the ends of the domain.
  std::array<std::vector<double>, 2> Knots;
  /// Lines[d][k]: the line on which parameter d is Knots[d][k]; pieces count in Knots[1 - d].
  std::array<std::vector<LRLine>, 2> Lines;
  /// Local knots of every function: p_0 + 2 indices of direction 0, then p_1 + 2 of direction 1,
  /// not descending. Functions ascend by the second direction's knots, then by the first's (a
  /// tensor-product space has its usual order).
  std::vector<int> LocalKnots;
  std::vector<double> Scaling; ///< gamma_i > 0

  int NumFunctions() const { return static_cast<int>(this->Scaling.size()); }
  int Stride() const { return this->Degree[0] + this->Degree[1] + 4; }
  const int* Local(int function, int direction) const
  {
    return this->LocalKnots.data() + std::ptrdiff_t{ function } * this->Stride() +
      (direction == 0 ? 0 : this->Degree[0] + 2);
  }
  bool operator==(const LRBasis& other) const
  {
    return this->Degree == other.Degree && this->Knots == other.Knots &&
      this->Lines == other.Lines && this->LocalKnots == other.LocalKnots &&
      this->Scaling == other.Scaling;
  }
};

/// Smallest multiplicity of a line between two knots of the other direction, low < high.
int LRMultiplicity(const LRLine& line, int low, int high);

/// Data of a space of kind LocallyRefined beside the general form. Elements ascend by their lower
/// corners, second direction first.
struct LRData
{
  LRBasis Basis;
  /// Box of every element as knot indices: lower corner, upper corner.
  std::vector<std::array<int, 4>> ElementKnots;
  /// Ids of the functions alive on element e, ascending: AliveFunctions[AliveStart[e] ...
  /// AliveStart[e + 1]).
  std::vector<std::size_t> AliveStart;
  std::vector<int> AliveFunctions;
  BoxLocator Locator;
};

/// The space of a definition. Its local functions are the Bernstein polynomials of the elements,
/// the rows of T the coefficients of gamma_i B_i; SplineSpace::Knots are the knots of the smallest
/// tensor-product space that contains it.
/// @return InvalidDegree, InvalidKnots, SizeMismatch, InvalidTopology: lines that do not divide the
/// domain into boxes, ends of multiplicity other than p + 1, functions that are not of minimal
/// support on the mesh, or whose sum differs from 1 by more than 1e-9. TooLarge: 2^31 Bernstein
/// coefficients, or 16 (p + 1)(q + 1) functions alive on an element on average.
/// @param threads  0 = all cores; the space is the same for any number.
/// @complexity O(functions * elements in a support * (p+1)^2).
Result<SplineSpacePtr<2>> MakeLRSpace(LRBasis basis, int threads);

/// The definition of a tensor-product space as LR B-splines; functions keep their numbers.
/// @return DimensionMismatch unless the space is of kind Tensor; InvalidKnots when an end has not
/// multiplicity p + 1.
Result<LRBasis> LRBasisOfTensor(const SplineSpace<2>& space);

/// Box partition of an LR mesh: every element as knot indices, lower corner, upper corner, ordered
/// as in LRData. @return InvalidTopology naming the place where a line ends inside an element.
Result<std::vector<std::array<int, 4>>> LRElements(const LRBasis& basis);

/// The family's entry in the table; only the one for two parameters has spaces.
template <int Dim>
const SpaceFamily<Dim>& LRFamily();
}
