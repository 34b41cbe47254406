// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BernsteinCells.h>

#include <optional>

/// Proofs about curves in the plane: that they are simple and disjoint, how closed ones turn. All
/// of them with bounds of the rounding, for every geometry within BernsteinCells::Errors.
namespace knotwork
{
enum class CurvesVerdict : std::int8_t
{
  Crossing = -1, ///< proved: two different points of the curves coincide
  Undecided = 0, ///< they touch, all but touch, or a limit was reached
  Simple = 1     ///< proved: they meet nowhere but in their common ends
};

struct SimpleCurvesParams
{
  /// Pairs of pieces looked at, over all, >= 1. Every pair of curves gets 4096 first; those still
  /// open share what is left.
  std::int64_t MaxBoxes = 1000000;
  int Threads = 0; ///< 0 = all cores; the result does not depend on it
};

struct SimpleCurvesProof
{
  CurvesVerdict Verdict = CurvesVerdict::Undecided;
  /// Unless Simple: the curves and about their parameters where they cross or were not told apart.
  std::array<int, 2> Curves{ -1, -1 };
  std::array<double, 2> Parameters{};
  std::array<double, 2> Position{};
  std::int64_t Boxes = 0;
};

/// Curves are bisected until their hulls are separated by a line; pieces that share an end by a
/// line through it; single pieces are simple when their hodograph lies in an open half plane. A
/// crossing is proved by two arcs that connect opposite sides of one parallelogram.
/// @param curves  plane cells of shape Curve, rational too.
/// @param ends    the points at begin and end of each curve, by numbers: curves with the same
///                number end in the same point exactly (their coefficients there may differ by
///                their Errors), others are expected not to.
/// @return what BernsteinCells::Check says; DimensionMismatch unless all cells are curves with two
/// components; SizeMismatch; InvalidParameter.
Result<SimpleCurvesProof> ProveSimpleCurves(const BernsteinCells& curves,
  const std::vector<std::array<int, 2>>& ends, const SimpleCurvesParams& params = {});

/// A curve on the way along a closed one.
struct CurveStep
{
  int Curve = 0;
  bool Reversed = false;
};

/// How often a closed curve winds around a point, counterclockwise positive. Sum of the angles of
/// pieces that do not surround the point.
/// @param error  of the point's coordinates. @return nothing when the curve comes too near.
/// @pre the curves' Check is Ok, they are plane, and each step ends where the next begins.
std::optional<int> CountWindings(const BernsteinCells& curves, const std::vector<CurveStep>& loop,
  const std::array<double, 2>& point, double error = 0.0);

/// Sign of the area that a closed curve encloses: 1 counterclockwise, -1 clockwise; nothing when it
/// is too small to tell. The polygon of the pieces' ends encloses it but for the sum of (distance
/// of a piece from its chord) x (length).
/// @pre as above.
std::optional<int> FindOrientation(
  const BernsteinCells& curves, const std::vector<CurveStep>& loop);
}
