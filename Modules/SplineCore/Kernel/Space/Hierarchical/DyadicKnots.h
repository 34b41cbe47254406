// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "KnotVector.h"

#include <cstdint>

namespace knotwork
{
/// Deepest level of a hierarchy.
inline constexpr int MaxHierarchyLevel = 24;

/// The dyadically refined knot vectors of one direction, by arithmetic instead of storage.
///
/// Level l has 2^l cells in every level-0 element and simple new knots between them; level-0 knots
/// keep their multiplicities, knots outside the domain stay as they are (l times
/// KnotVector::Dyadic()). Cell K of level l is the dyadic part K mod 2^l of level-0 element K >> l.
/// Lengths are measured in cells from a cell nearby, so no precision is lost on deep levels.
/// The knot vector must outlive the object.
class DyadicKnots
{
public:
  explicit DyadicKnots(const KnotVector& knots) : Base(&knots) {}

  int Degree() const { return this->Base->Degree(); }
  int NumRootCells() const { return this->Base->NumElements(); }
  std::int64_t NumCells(int level) const
  {
    return static_cast<std::int64_t>(this->Base->NumElements()) << level;
  }
  std::int64_t NumFunctions(int level) const
  {
    return this->Base->NumFunctions() + this->NumCells(level) - this->Base->NumElements();
  }

  /// The functions alive on a cell are FirstFunction ... FirstFunction + p.
  std::int64_t FirstFunction(int level, std::int64_t cell) const
  {
    const int e = static_cast<int>(cell >> level);
    return this->Base->Span(e) - e + cell - this->Degree();
  }

  /// First and last cell of a function's support inside the domain; first > last when there is
  /// none.
  struct CellRange
  {
    std::int64_t First;
    std::int64_t Last;
    int Size() const { return static_cast<int>(this->Last - this->First + 1); }
  };
  CellRange Support(int level, std::int64_t function) const;

  /// Left end of a cell; cell = NumCells(level) gives the domain's end.
  double Break(int level, std::int64_t cell) const;
  double Greville(int level, std::int64_t function) const;

  /// Cells of the same class in the same level-0 element have the same extraction operator.
  int NumExtractionClasses() const { return 2 * this->Degree() + 1; }
  int ExtractionClass(int level, std::int64_t cell) const;
  /// (p + 1) x (p + 1) row-major, see KnotVector::Extraction.
  void Extraction(int level, std::int64_t cell, double* matrix) const;

  /// Coefficient of a function of this level as a combination of those of the next coarser level:
  /// c_child = sum_k Weight[k] c_{First + k}. Weights are positive and sum to one (unless knots
  /// outside the domain cut the sum off).
  struct TwoScaleRow
  {
    std::int64_t First = 0;
    int Count = 0;
    double Weight[MaxDegree + 1] = {};
  };
  /// @param level  >= 1.  @param child  a function whose support meets the domain.
  /// @source  Cohen, Lyche, Riesenfeld, Computer Graphics and Image Processing 14 (1980) 87-111.
  TwoScaleRow Parents(int level, std::int64_t child) const;

private:
  /// Where a knot lies: dyadic part Fraction of level-0 element Element (the domain's end is
  /// element NumElements, fraction 0), or knot Outer of level 0 outside the domain.
  struct Position
  {
    int Element = 0;
    std::int64_t Fraction = 0;
    int Outer = -1;
  };
  Position Locate(int level, std::int64_t knot) const;
  double Value(int level, const Position& position) const;
  /// Distance from the left end of a cell, in units of that cell.
  double Offset(int level, std::int64_t cell, const Position& position) const;
  /// Index of the last knot equal to the left end of a level-0 element.
  std::int64_t LastKnot(int level, int element) const
  {
    return this->Base->Span(element) + (static_cast<std::int64_t>(element) << level) - element;
  }

  const KnotVector* Base;
};
}
