// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ErrorEstimate.h"

#include <knotwork/SplineCore/HierarchicalSpace.h>

namespace knotwork
{
struct AdaptiveParams
{
  /// Share of the squared estimate that the marked elements have at least, in (0, 1].
  double Theta = 0.5;
  double Tolerance = 0.0;    ///< of the estimated error in energy, >= 0
  int MaxFunctions = 100000; ///< >= 1; a space with more is not solved
  int MaxSteps = 50;         ///< solutions, >= 1
  /// Of THB-splines. The margin is half of the degree in a step whose marked elements would make no
  /// new function without.
  RefinementParams Refinement{ 0, 2, 24 };
  GalerkinParams Galerkin;
};

/// Why refinement ended.
enum class AdaptiveStop
{
  Tolerance,    ///< the estimate is small enough
  MaxFunctions, ///< the next space is too large
  MaxSteps,
  MaxLevel ///< the marked elements must not be refined
};
const char* ToString(AdaptiveStop stop);

/// A row of the history: a space and its solution.
struct AdaptiveStep
{
  int Functions = 0;
  int Elements = 0;
  double Estimate = 0.0; ///< of the error in the norm of energy
  double Energy = 0.0;
  int Marked = 0; ///< elements; 0 in the last row
  double SecondsSolve = 0.0;
  double SecondsEstimate = 0.0;
  double SecondsRefine = 0.0;
};

template <int Dim>
struct AdaptiveSolution
{
  MultiPatch<Dim> Body; ///< the same maps in the refined spaces
  GalerkinSpace Space;
  GalerkinProblem Problem;
  GalerkinSolution Solution;
  ErrorEstimate Estimate;
  std::vector<AdaptiveStep> History;
  AdaptiveStop Stop = AdaptiveStop::Tolerance;
};

/// States the problem on a refined space: its facets, functions and elements have new numbers.
template <int Dim>
using BodyProblemMaker =
  std::function<Result<GalerkinProblem>(const MultiPatch<Dim>& body, const GalerkinSpace& space)>;
/// The same of a single patch.
template <int Dim>
using ProblemMaker =
  std::function<Result<GalerkinProblem>(const Spline<Dim>& spline, const GalerkinSpace& space)>;

/// Elements with the largest estimates, as few as have a share of the sum of squares, and those
/// that equal the smallest of them but for rounding: what is symmetric stays so.
/// @param theta  the share, in (0, 1]. @return ascending; empty when all estimates are 0.
/// @source  Doerfler, SIAM J. Numer. Anal. 33 (1996) 1106-1124.
std::vector<int> MarkElements(const std::vector<double>& estimates, double theta);

/// Splits the marked elements of patches, and those along interfaces that this leaves coarser than
/// their neighbours on the other side: functions of both sides stay the same, so that patches glued
/// C^0 stay so. Elements of Tensor and Hierarchical patches become those of THB-splines, elements
/// of LocallyRefined ones, which stand alone, are split by full-span segments.
/// @param marked  elements, of the patches in order.
/// @return what RefineMarkedElements says, with the patch.
template <int Dim>
Result<MultiPatch<Dim>> RefineMarkedElements(
  const MultiPatch<Dim>& body, const std::vector<int>& marked, const RefinementParams& params = {});

/// Solves, estimates the error, marks elements and splits them (RefineMarkedElements), until the
/// estimate is small enough or a limit is met. Marking is over the elements of all patches.
/// @param makeProblem  called from the calling thread on every space.
/// @return InvalidParameter for options; DimensionMismatch for a spline that cannot be refined
/// locally; what makeProblem, MakeGalerkinSpace, SolveGalerkin, EstimateError and
/// RefineMarkedElements say; Aborted.
/// @complexity of the last solution times the number of steps that have about as many functions.
/// @source  Buffa, Giannelli, M3AS 26 (2016) 1-25; Buffa, Giannelli, M3AS 27 (2017) 2781-2802
/// (optimal order on admissible meshes).
template <int Dim>
Result<AdaptiveSolution<Dim>> SolveAdaptively(const MultiPatch<Dim>& body,
  const BodyProblemMaker<Dim>& makeProblem, const AdaptiveParams& params = {},
  const ProgressCallback& progress = {});

/// The same of a single patch.
template <int Dim>
Result<AdaptiveSolution<Dim>> SolveAdaptively(const Spline<Dim>& spline,
  const ProblemMaker<Dim>& makeProblem, const AdaptiveParams& params = {},
  const ProgressCallback& progress = {});
}
