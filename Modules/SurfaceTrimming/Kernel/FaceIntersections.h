// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>
#include <knotwork/SplineCore/Types.h>

namespace knotwork
{
enum class IntersectionVerdict : std::int8_t
{
  Absent,    ///< proved
  Undecided, ///< parts come nearer than the search went, or the search ended at its limit
  Found      ///< two points that coincide
};
/// "absent", "undecided", "found".
const char* ToString(IntersectionVerdict verdict);

struct FaceIntersectionParams
{
  /// Where points of both faces lie within this distance of edges of theirs, they may meet: edges
  /// of neighbours agree only so far. Unit of the points; 0: a thousandth of the diagonal of the
  /// model's box.
  double Tolerance = 0.0;
  /// Pairs of parts looked at for a pair of faces, >= 1.
  std::int64_t MaxPairs = 1000000;
  int Threads = 0; ///< 0: all cores; the result does not depend on it
  ProgressCallback Progress;
};

/// Two faces that meet, or one that meets itself.
struct FaceMeeting
{
  IntersectionVerdict Verdict = IntersectionVerdict::Undecided; ///< Found or Undecided
  std::array<int, 2> Faces{ -1, -1 };
  /// Found: parameters on both faces whose points agree within 1e-10 of the model's size.
  /// Undecided: of the first place that is open.
  std::array<RealArray<2>, 2> Parameters{};
  std::array<double, 3> Position{};
  /// Pairs of parts that were not told from each other; the search ends with 64 of them, or with
  /// one at its limit.
  int OpenPlaces = 0;
};

struct FaceIntersections
{
  IntersectionVerdict Verdict = IntersectionVerdict::Absent; ///< Found before Undecided
  double Tolerance = 0.0;                                    ///< that was used
  std::vector<FaceMeeting> Meetings; ///< at most one a pair of faces, by their numbers
  std::int64_t PairsOfFaces = 0;     ///< whose boxes meet, and every face with itself
  std::int64_t Pairs = 0;            ///< of parts that were looked at
};

/// Whether the trimmed parts of a model's faces meet each other, or themselves, elsewhere than
/// along edges. Faces are halved, what lies outside the loops is dropped; parts of two faces are
/// told from each other by boxes and slabs of their control points. A part of one face does not
/// meet itself when two vectors w and z have w.S_u > 0, w.S_v > 0, z.S_u > 0, z.S_v < 0 throughout
/// (the tangents lie in cones that only have 0 in common): displacements along any path that is
/// monotone in both parameters are not zero then. Absent is proved, but for edges as
/// FaceIntersectionParams::Tolerance states, and a margin of 1e-12 of the size for rounding.
/// @return failures of TrimmedModel::Check; EmptyInput without faces; DimensionMismatch (tensor
/// products in space are wanted); InvalidParameter; Aborted.
/// @complexity elements + pairs; along common edges of length l about 30 l / Tolerance pairs.
/// @source  tangent cones: Sederberg, Meyers, CAGD 5 (1988) 161-171; Volino, Magnenat-Thalmann,
/// Computer Graphics Forum 13 (1994) 155-166.
Result<FaceIntersections> FindFaceIntersections(
  const TrimmedModel& model, const FaceIntersectionParams& params = {});
}
