// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceFit.h"

#include <functional>
#include <string>

namespace knotwork
{
/// The processes that fit one surface together, each with a part of the points, as each of them
/// sees them. All call these functions in the same order.
struct FitProcesses
{
  int Own = 0; ///< number of this one, from 0
  int Count = 1;
  /// What every process gives, to all of them, in their order.
  std::function<std::vector<std::string>(const std::string&)> Exchange;
  /// What this process has for each, itself too; what each has for this one, in their order.
  std::function<std::vector<std::string>(std::vector<std::string>)> Deal;
  /// What is to be said against the points of neighbouring elements; empty: nothing.
  std::function<Status(const PointMatrix& parameters, const PointMatrix& values)> Check;
};

/// Fits one surface to the points of all processes, the same everywhere, bit for bit what one
/// process makes of all points in the order of the processes. The elements of the first space are
/// divided among the processes, in their order and with about as many points each, and the points
/// go to where their elements are; parts of elements stay there. What is summed up in an element is
/// told to all, the space and its equations are everywhere. Distances, Tolerances and Outliers of
/// the result are those of the process's own part, all other numbers those of all points.
/// @param part  may be empty, but not in all of them; given up when its points have gone (move it
/// here where memory is short). Params.Progress of any may stop the fit.
/// @return in all processes the same failure: those of FitSurface, of Check, and InvalidParameter
/// where FindOutliers, CorrectParameters, Side or FeatureGridSize ask for what lies beyond a
/// process's elements.
/// @complexity a process holds about its share of the points; an iteration tells (2p + 1)^2 +
/// (p + 1)^2 numbers of every element that is new or weighs otherwise.
Result<SurfaceFit> FitSurface(
  PointCloud part, const FitParams& params, const FitProcesses& processes);
}
