// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/LRSpace.h>

#include <memory>

namespace knotwork
{
/// A segment of a mesh line: parameter Direction has Value, the other one runs from Start to End.
struct LRSegment
{
  int Direction = 0;
  double Value = 0.0;
  double Start = 0.0;
  double End = 0.0;
  /// The line's multiplicity along the segment becomes at least this, in [1, degree + 1].
  int Multiplicity = 1;
};

/// LR B-splines while their mesh grows: mutable, and cheap a segment. The functions' coefficients
/// are carried along, so the map does not change.
///
/// Local knots are indices that keep their meaning while knots are added; functions are indexed by
/// the knots they start at, with the ranges of their supports beside, so that a segment meets the
/// functions near it and no others; equal functions are found by a hash of their local knots.
/// @source  Dokken, Lyche, Pettersen, CAGD 30 (2013) 331-356, algorithm 2.5.
class LRRefinement
{
public:
  /// @pre space is of kind LocallyRefined. @param rows  NumFunctions x c coefficients (c may be 0),
  /// homogeneous where they belong to a rational spline.
  LRRefinement(const SplineSpace<2>& space, const PointMatrixView& rows);
  LRRefinement(LRRefinement&&) noexcept;
  LRRefinement& operator=(LRRefinement&&) noexcept;
  ~LRRefinement();

  /// Inserts a segment and splits functions until all have minimal support again. What the line has
  /// already is no error. Values within 1e-12 of the domain's size of a knot are that knot.
  /// @return InvalidParameter (direction, multiplicity, Start >= End), NonFiniteInput;
  /// OutsideDomain; InvalidTopology when Start or End is no knot, when the segment ends inside an
  /// element, or traverses the support of no function: longer segments do. Nothing has changed
  /// then.
  /// @post  the set of functions is the same for every order in which each insertion succeeds;
  /// scaling factors and (for linearly independent functions) coefficients up to rounding.
  Status Insert(const LRSegment& segment);
  /// What of these errors no further line of the mesh can mend: all but InvalidTopology.
  Status Check(const LRSegment& segment) const;

  int NumFunctions() const;

  /// The space as it is now. @param rows  its functions' coefficients, when not null.
  /// @param threads  0 = all cores; the space is the same for any number.
  Result<SplineSpacePtr<2>> Finish(PointMatrix* rows, int threads) const;

private:
  struct State;
  std::unique_ptr<State> S;
};

/// The same map in the larger space. A tensor-product spline becomes LocallyRefined first.
/// @return what LRBasisOfTensor and Insert return, naming the segment; DimensionMismatch for other
/// kinds.
/// @param threads  0 = all cores.
Result<Spline<2>> InsertSegments(
  const Spline<2>& spline, const std::vector<LRSegment>& segments, int threads);
/// The same for segments as a user has them, in any order: parts of a line that meet or overlap are
/// one segment, the part of a line that has a higher multiplicity is inserted after all of it, and
/// a segment that is not legal yet waits for the others. The result is the same for every order, to
/// the last bit.
/// @param maxFunctions  more than that are TooLarge.
/// @complexity that of InsertSegments when no segment waits; every round of waiting tries all that
/// wait.
Result<Spline<2>> InsertAllSegments(
  const Spline<2>& spline, const std::vector<LRSegment>& segments, int maxFunctions, int threads);
/// The same as InsertSegments of a space.
Result<SplineSpacePtr<2>> InsertSegments(
  const SplineSpacePtr<2>& space, const std::vector<LRSegment>& segments, int threads);
}
