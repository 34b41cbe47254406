// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ContourCells.h"

/// Private to ContourCells: points on an arc until its chords keep near the contour.
namespace knotwork
{
/// Where g rises or falls along at least one parameter.
struct MonotoneCell
{
  const double* G = nullptr; ///< Bernstein coefficients on the cell
  RealArray<2> Lower{};      ///< corners, local parameters of the element
  RealArray<2> Upper{};
  std::array<bool, 2> Monotone{}; ///< along which parameters
};

class ContourArcs
{
public:
  void SetElement(const ContourElement& element);

  /// Appends points of the arc between two of its points, both left out, until every chord is
  /// within the tolerances; none where g is not monotone.
  /// @param from, to, points  local parameters of the element.
  /// @return bound of |g| on the chords.
  double Refine(const MonotoneCell& cell, const RealArray<2>& from, const RealArray<2>& to,
    std::vector<RealArray<2>>& points);

private:
  double RefineChord(const MonotoneCell& cell, const RealArray<2>& a, const RealArray<2>& b,
    bool force, std::vector<RealArray<2>>& points);
  /// Coefficients (degree p + q) of a polynomial on a straight line between two points.
  void Restrict(
    const double* coefficients, const RealArray<2>& a, const RealArray<2>& b, double* onChord);
  bool IsStraight(const RealArray<2>& a, const RealArray<2>& b);
  RealArray<2> PointBetween(
    const MonotoneCell& cell, const RealArray<2>& a, const RealArray<2>& b) const;

  ContourElement Element;
  IntArray<2> Degree{ -1, -1 };
  int Budget = 0;            // points an arc may still take
  std::vector<double> Share; // of coefficient (i, j) in coefficient i + j of the chord
  std::vector<double> Box;
};
}
