// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/DomainParameterization/DomainBoundary.h>
#include <knotwork/DomainParameterization/GluedMap.h>

namespace knotwork
{
/// A domain cut into quadrilateral (hexahedral) patches. Two patches that have all vertices of a
/// side in common meet there (so a ring needs three patches at least); a side of one patch alone is
/// part of the boundary.
template <int Dim>
struct PatchLayout
{
  PointMatrix Vertices; ///< n x Dim
  /// Vertices of the corners of every patch: bit d of the corner's number is the end in direction
  /// d, so a quadrilateral has (0, 0), (1, 0), (0, 1), (1, 1).
  std::vector<std::array<int, 1 << Dim>> Patches;
  /// Curves (faces) that join vertices, in any order and directions, as DomainBoundary takes them:
  /// one for every side on the boundary, and any number of those between patches.
  std::vector<Spline<Dim - 1>> Sides;
};

struct LayoutParams
{
  /// Corners of sides at most this part of the size apart from a vertex lie at it, in [0, 0.1]; the
  /// size is the diagonal of the bounding box of the sides' control points.
  double GapTolerance = 1e-9;
  /// Directions have at least this degree, [1, 9], and so many elements, [1, 1000]: more than the
  /// boundary needs, so that the interior can move.
  int MinDegree = 2;
  int MinElements = 4;
  /// Functions of all patches together at most, those that they share counted in each, >= 1.
  int MaxFunctions = DefaultMaxFunctions;
  /// False: sides between patches stay as they are given, straight those that are not.
  bool MoveInterfaces = true;
};

/// A layout whose patches have spaces that fit together, and the control points of given sides.
template <int Dim>
struct CompatibleLayout
{
  GluedMap<Dim> Map;       ///< points that no given side has are zero, their weights one
  std::vector<bool> Given; ///< numbers of control points of given sides
  PointMatrix Vertices;
  /// As given, but mirrored in the last direction when the patches enclose a negative area
  /// (volume).
  std::vector<std::array<int, 1 << Dim>> Corners;
  std::vector<std::array<int, 2 * Dim>> Inputs; ///< per patch: given side, -1: none
  std::vector<std::array<bool, 2 * Dim>> Fixed; ///< per patch: sides that do not move
  std::vector<PatchInterface> Shared;           ///< sides of two patches that are one
  double Area = 0.0;                            ///< enclosed (volume), > 0
  double Size = 0.0;
  double LargestGap = 0.0; ///< that was closed at a vertex or edge
};

/// Finds how patches and sides meet, and brings all directions that must agree (rows of patches) to
/// one degree and one knot vector. Exact up to rounding, as MakeCompatible of one patch; weights of
/// sides that meet are matched in the same way.
/// @return EmptyInput; NonFiniteInput; SizeMismatch; InvalidParameter; InvalidTopology naming what
/// does not fit: a vertex that does not exist or is twice in a patch, more than two patches at a
/// side, patches that touch at a vertex (edge) alone, neighbours oriented differently, a side on
/// the boundary without a curve, a curve that joins no side, the gap between a curve and its
/// vertex, no area; of a curve: as MakeCompatible; TooLarge.
template <int Dim>
Result<CompatibleLayout<Dim>> MakeCompatible(
  const PatchLayout<Dim>& layout, const LayoutParams& params = {});

/// Numbers the functions of patches that meet as the interfaces say. Control points that are shared
/// become those of the first patch; nothing is fixed. @return InvalidTopology: see MakeCompatible.
template <int Dim>
Result<GluedMap<Dim>> Glue(
  const MultiPatch<Dim>& patches, const std::vector<std::array<int, 1 << Dim>>& corners);
}
