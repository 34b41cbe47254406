// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Contours.h"

#include <memory>

/// Private to TraceContours: the contour of one polynomial g on one element.
namespace knotwork
{
/// Where the contour crosses the border of the element, as all elements agree on it.
struct BorderRoot
{
  double Position = 0.0; ///< along the side
  int Id = -1;           ///< of the whole surface
};

/// A side of the element: crossings ascending, and the sign of g at the lower corner.
struct BorderSide
{
  std::vector<BorderRoot> Roots;
  bool Positive = false;
};

/// A run of a contour through an element, with g >= 0 on its left in the parameter plane.
struct ContourPath
{
  int Level = 0;
  int Element = 0;
  int From = -1; ///< ids of roots; -1, -1: a loop inside the element
  int To = -1;
  std::size_t FirstPoint = 0; ///< both ends are points; a loop's first point is not repeated
  std::size_t NumPoints = 0;
  double MaxValue = 0.0; ///< bound of |g| on it
};

/// What elements have given so far.
struct ContourPieces
{
  std::vector<ContourPath> Paths;
  std::vector<RealArray<2>> Points; ///< local parameters
  std::vector<UndecidedBox> Undecided;
};

/// An element and what is wanted of its contour.
struct ContourElement
{
  IntArray<2> Degree{};
  int Level = 0; ///< for the records
  int Element = 0;
  double Tolerance = 0.0;      ///< of |g| on chords
  double ChordTolerance = 0.0; ///< of chords in space, 0: none
  int MaxCells = 0;
  int NumComponents = 0;      ///< of the points of Block
  int NumSpaceComponents = 0; ///< the first ones
  bool Rational = false;
  const double* Block = nullptr; ///< as in a BezierForm
};

/// Divides an element into cells in which g has no zero or rises or falls along one parameter all
/// over, so that the contour is a graph over the other one there. Roots on lines between cells are
/// found once; so arcs of cells join to paths.
class ContourCells
{
public:
  ContourCells();
  ~ContourCells();
  ContourCells(const ContourCells&) = delete;
  ContourCells& operator=(const ContourCells&) = delete;

  /// @param g  Bernstein coefficients.
  void Trace(const ContourElement& element, const double* g, const std::array<BorderSide, 4>& sides,
    ContourPieces& pieces);

private:
  class Work;
  std::unique_ptr<Work> Scratch;
};
}
