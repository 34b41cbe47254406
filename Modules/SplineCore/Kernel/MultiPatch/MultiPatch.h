// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/PatchSides.h>
#include <knotwork/SplineCore/Spline.h>

#include <unordered_map>

namespace knotwork
{
/// Two sides that are one, wholly or in part. Both may be of one patch (a ring), or one and the
/// same (a side folded on itself).
struct PatchInterface
{
  std::array<PatchSide, 2> Sides;
  SideOrientation Orientation; ///< how Sides[1] lies on Sides[0]
  bool Partial = false;
  /// Partial: what of each side, in its own parameters.
  std::array<ParametricBox<2>, 2> Parts{};
};

/// What patches have to do with each other.
struct PatchTopology
{
  std::vector<PatchInterface> Interfaces;
  std::vector<PatchSide> Boundary; ///< sides that are stated to be no interface
};

/// Patches that know their neighbours.
template <int Dim>
struct MultiPatch
{
  std::vector<Spline<Dim>> Patches;
  PatchTopology Topology;
};

/// @return InvalidTopology naming the first interface or side that is not one of `numPatches`
/// patches, or whose orientation is not one of sides of `dimension` - 1 directions.
Status CheckTopology(const PatchTopology& topology, int numPatches, int dimension);

/// Finds sides that are one because they have the same points, whatever these are: vertices,
/// control points, ids.
class SharedSides
{
public:
  /// @param numbers  of the points, count[0] x count[1] of them, first direction fastest (count[1]
  /// is 1 for sides of one direction, both are for points).
  void Add(const PatchSide& side, const std::array<std::int64_t, 2>& count,
    const std::vector<int>& numbers);
  /// Every side with the first that has its points, in the order of the calls.
  std::vector<PatchInterface> Interfaces;

private:
  struct First
  {
    PatchSide Side;
    SideOrientation Orientation; ///< how it lies on the canonical one
  };
  std::unordered_map<std::string, First> Known;
};

/// Sides that are one because they have the same control points, weights (as PointClusters.h says)
/// and knots (but for an affine change): each with the first that it is one with. Sides of
/// tensor-product and hierarchical patches with p + 1 equal end knots; others have none.
/// @complexity O(n log n) a patch of n functions.
template <int Dim>
std::vector<PatchInterface> FindInterfaces(const std::vector<Spline<Dim>>& patches);

/// A side by points of it on a regular grid, first direction fastest.
struct SideSamples
{
  PatchSide Side;
  std::array<std::int64_t, 2> Count{ 1, 1 };
  PointMatrix Points;
};

/// Of every side of every patch, samples^(Dim - 1) points at equal shares of its domain.
/// @return DimensionMismatch for a patch without a parameter domain; InvalidParameter for fewer
/// than 2 samples; Spline::Check's codes with the patch.
template <int Dim>
Result<std::vector<SideSamples>> SampleSides(
  const std::vector<Spline<Dim>>& patches, int samples, int threads);

/// The orientations, by number, in which all points of a side lie within the tolerance of those of
/// another.
std::vector<SideOrientation> FittingOrientations(
  const SideSamples& side, const SideSamples& on, double tolerance);

/// Whether a side is a point or, a face, a curve: all points of every line of one direction lie
/// within the tolerance of its first.
bool IsCollapsed(const SideSamples& side, double tolerance);

/// All pairs of sides that are one by geometry, in one orientation each, the first that fits; a
/// side with itself where it is folded and not collapsed. Pairs are in the order of their second
/// side, then their first.
/// @complexity O(n log n) for n sides whose centres are apart.
std::vector<PatchInterface> FindInterfaces(const std::vector<SideSamples>& sides, double tolerance);

/// Sides of boxes of one parameter domain that are one: wholly where they agree, else in part. By
/// the first box, then the second, then the direction. @pre no two boxes overlap.
template <int Dim>
std::vector<PatchInterface> FindInterfaces(const std::vector<ParametricBox<Dim>>& boxes);

/// Control point of a corner of a tensor-product patch with clamped knots.
template <int Dim>
int CornerFunction(const SplineSpace<Dim>& space, int corner);

/// Functions of a tensor-product patch with clamped knots along one side, first direction fastest.
template <int Dim>
std::vector<int> SideFunctions(const SplineSpace<Dim>& space, int side);

/// A side as a spline of its own on the side's directions: exact, coefficients are copied (kind
/// LocallyRefined: by IsoCurve).
/// @return InvalidParameter when there is no such side; InvalidKnots when the knots across it are
/// not clamped; DimensionMismatch for patches without a parameter domain.
template <int Dim>
Result<Spline<Dim - 1>> SideSpline(const Spline<Dim>& patch, int side);
}
