// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/LRStrategies.h>

namespace knotwork
{
/// A spline in a larger space: the same map, weights included, up to rounding.
template <int Dim>
struct RefinedSpline
{
  Spline<Dim> Value;
  /// Element of the given spline that holds each element of Value.
  std::vector<int> Parents;
};

/// Halves every element in every direction: knots at the midpoints (Tensor), one more level
/// everywhere (Hierarchical), full-span segments (LocallyRefined), de Casteljau's subdivision
/// (Bezier: elements stay glued exactly where they were, so the faces that two elements share must
/// carry the same functions).
/// @return the failures of the kernels it calls; InvalidTopology when a Bezier element has a
/// function twice.
/// @complexity O(elements * (p+1)^(Dim+1)).
template <int Dim>
Result<RefinedSpline<Dim>> RefineAllElements(const Spline<Dim>& spline);

/// Splits the marked elements of a Tensor or Hierarchical spline; the result is Hierarchical (the
/// given spline when nothing is marked). Elements of a LocallyRefined spline are halved by
/// full-span segments in both directions; params do not matter.
/// @param marked  element ids. @return DimensionMismatch for the kind Bezier, InvalidParameter.
template <int Dim>
Result<RefinedSpline<Dim>> RefineMarkedElements(
  const Spline<Dim>& spline, const std::vector<int>& marked, const RefinementParams& params = {});

/// How a step of refinement by LR B-splines goes.
struct LRRefinementParams
{
  LRStrategyParams Segments;
  /// Functions are split instead of elements: those with at least half of their support marked, and
  /// for every marked element the one alive on it with the largest part marked, the first of
  /// equals.
  bool ByFunction = false;
  /// Segments are added until the functions are linearly independent (ResolveDependence), also when
  /// nothing is marked.
  bool KeepIndependent = false;
  int Threads = 0; ///< 0 = all cores
};

/// Splits the marked elements of a Tensor or LocallyRefined surface; the result is LocallyRefined
/// (the given spline when there is nothing to do).
/// @param marked  element ids. @return DimensionMismatch for other kinds, InvalidParameter;
/// InvalidKnots when an end of a Tensor space has not multiplicity p + 1; NotConverged when a
/// dependence is not resolved.
Result<RefinedSpline<2>> RefineMarkedLR(
  const Spline<2>& spline, const std::vector<int>& marked, const LRRefinementParams& params = {});

/// Inserts mesh line segments, in any order (InsertAllSegments), into a Tensor or LocallyRefined
/// surface; the result is LocallyRefined.
/// @param params  KeepIndependent and Threads. @param maxFunctions  more than that are TooLarge.
/// @return DimensionMismatch for other kinds; what LRRefinement::Insert returns, naming the
/// segment; InvalidKnots and NotConverged as RefineMarkedLR.
Result<RefinedSpline<2>> RefineBySegments(const Spline<2>& spline,
  const std::vector<LRSegment>& segments, int maxFunctions, const LRRefinementParams& params = {});

/// Element of the coarser space that holds the centre of each element of the finer one.
template <int Dim>
std::vector<int> ParentElements(
  const SplineSpace<Dim>& coarse, const SplineSpace<Dim>& fine, int threads);

/// Raises the degree in every direction by times >= 0 (result at most 9). Continuity stays as it
/// is. @return DimensionMismatch for the kinds Hierarchical and LocallyRefined: finer levels of an
/// elevated hierarchy are smoother than the map; InvalidDegree.
template <int Dim>
Result<Spline<Dim>> ElevateAllDegrees(const Spline<Dim>& spline, int times);
}
