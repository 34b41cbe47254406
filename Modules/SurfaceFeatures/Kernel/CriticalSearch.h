// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CriticalPoints.h"
#include "ScalarPieces.h"

/// Private to FindCriticalPoints: the searches of elements, lines and corners.
namespace knotwork
{
/// What a point or box belongs to: boxes on one side of a slit do not hold points of the other.
struct Layer
{
  static constexpr int Area = 0;
  static constexpr int Crease = 1;
  static constexpr int Side = 2; ///< + the side of the elements: boundary
  static constexpr int Corner = 6;
};

/// A critical point in the coordinates and scale of the pieces.
struct FoundPoint
{
  CriticalKind Kind = CriticalKind::Minimum;
  CriticalPlace Place = CriticalPlace::Interior;
  int Element = -1;
  PlaneBox Reach; ///< proved to hold no other point of its layer
  PlaneBox Box;   ///< nor of any other one: off the lines on which the reach ends
  PlaneBox Enclosure;
  Interval Value; ///< of the spline
  RealArray<2> Eigenvalues{};
  int Index = 0;
  int InwardSign = 0;
  int Layer = knotwork::Layer::Area;
};

struct OpenBox
{
  int Element = -1;
  PlaneBox Box;
  int Layer = knotwork::Layer::Area;
};

struct FoundPoints
{
  std::vector<FoundPoint> Points;
  std::vector<OpenBox> Undecided;
  std::int64_t NumTested = 0;
};

/// Points with a zero gradient in the closed element, except those on its creases and on the
/// boundary that are zero of one side only.
void SearchElement(
  const ScalarPieces& pieces, int e, const CriticalPointParams& params, FoundPoints& result);

/// Critical points on those parts of an element's sides that are creases (each crease from the
/// element below it) or the boundary, corners left out.
void SearchSides(
  const ScalarPieces& pieces, int e, const CriticalPointParams& params, FoundPoints& result);

/// Critical points at corners of elements where creases or the boundary turn or cross.
/// @param characteristic  receives the domain's Euler characteristic.
void SearchCorners(const ScalarPieces& pieces, const CriticalPointParams& params,
  FoundPoints& result, int& characteristic);

/// A box of an element's local parameters in the plane, rounded outward.
PlaneBox BoxInPlane(const ScalarPiece& piece, const PlaneBox& local);

/// The box without those of its ends that lie on sides of the elements: drawn half way to the
/// enclosure.
PlaneBox OffLines(const ScalarPieces& pieces, const std::vector<int>& elements, const PlaneBox& box,
  const PlaneBox& enclosure);

inline bool Holds(const PlaneBox& box, const PlaneBox& inner)
{
  return box[0].Holds(inner[0]) && box[1].Holds(inner[1]);
}
inline bool Meet(const PlaneBox& a, const PlaneBox& b)
{
  return a[0].Meets(b[0]) && a[1].Meets(b[1]);
}
}
