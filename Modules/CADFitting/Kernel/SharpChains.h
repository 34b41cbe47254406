// SPDX-License-Identifier: BSD-3-Clause
// Edges joined to the curves of a target, private to the kernel.
#pragma once
#include "FitTarget.h"

namespace knotwork
{
struct SharpChains
{
  std::vector<TargetCurve> Curves;
  PointMatrix Vertices; ///< n x 3: the corners
  std::vector<int> VertexBodies;
  std::vector<std::vector<int>> Members; ///< a curve: the edges that it is made of, in order
};

/// Joins edges that meet: corners are where other than two ends come together, or where two turn.
/// @param lines  points along every edge, two at least. @param tolerance  within which ends are
/// one.
/// @param cornerAngle  in degrees.
/// @param bodies  of every edge: those of different ones do not meet.
SharpChains JoinChains(const std::vector<PointMatrix>& lines, const std::vector<int>& bodies,
  double tolerance, double cornerAngle);
}
