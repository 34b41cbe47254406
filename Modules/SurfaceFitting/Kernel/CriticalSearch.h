// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CriticalPoints.h"
#include "ScalarPieces.h"

/// Private to FindCriticalPoints: the searches of elements, lines and corners.
namespace knotwork
{
/// A critical point in the coordinates and scale of the pieces.
struct FoundPoint
{
  CriticalKind Kind = CriticalKind::Minimum;
  CriticalPlace Place = CriticalPlace::Interior;
  int Element = -1;
  PlaneBox Box;
  PlaneBox Enclosure;
  Interval Value; ///< of the spline
  RealArray<2> Eigenvalues{};
  int Index = 0;
  int InwardSign = 0;
};

struct UndecidedBox
{
  int Element = -1;
  PlaneBox Box;
};

struct SearchResult
{
  std::vector<FoundPoint> Points;
  std::vector<UndecidedBox> Undecided;
  std::int64_t NumTested = 0;
};

/// Points with a zero gradient in the closed element, except those on its creases and on the
/// boundary that are zero of one side only.
void SearchElement(
  const ScalarPieces& pieces, int e, const CriticalPointParams& params, SearchResult& result);

/// Critical points on those parts of an element's sides that are creases (each crease from the
/// element below it) or the boundary, corners left out.
void SearchSides(
  const ScalarPieces& pieces, int e, const CriticalPointParams& params, SearchResult& result);

/// Critical points at corners of elements where creases or the boundary turn or cross.
/// @param characteristic  receives the domain's Euler characteristic.
void SearchCorners(const ScalarPieces& pieces, const CriticalPointParams& params,
  SearchResult& result, int& characteristic);

/// A box of an element's local parameters in the plane, rounded outward.
PlaneBox BoxInPlane(const ScalarPiece& piece, const PlaneBox& local);

inline bool Holds(const PlaneBox& box, const PlaneBox& inner)
{
  return box[0].Holds(inner[0]) && box[1].Holds(inner[1]);
}
inline bool Meet(const PlaneBox& a, const PlaneBox& b)
{
  return a[0].Meets(b[0]) && a[1].Meets(b[1]);
}
}
