// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Spline.h"

#include <string>
#include <vector>

namespace knotwork
{
/// One side of a patch: 1 and 2 are the lower and the upper side of the first parameter, 3 and 4 of
/// the second, 5 and 6 of the third (G+Smo's numbers).
struct PatchSide
{
  int Spline = 0; ///< index into SplineFile::Splines
  int Side = 1;
};

/// Two sides that are one: parameter d of the first patch runs along parameter DirectionMap[d] of
/// the second, in the same sense when SameSense[d] is 1 and in the opposite sense when 0. Entries
/// beyond the number of parameters are 0.
struct PatchInterface
{
  PatchSide First;
  PatchSide Second;
  std::array<int, 3> DirectionMap{};
  std::array<int, 3> SameSense{};
};

/// Patches of one parametric dimension that belong together, as the file states it; nothing here
/// compares geometry.
struct MultiPatch
{
  int Dimension = 0;
  std::vector<int> Splines; ///< indices into SplineFile::Splines
  std::vector<PatchInterface> Interfaces;
  std::vector<PatchSide> Boundaries;
};

/// What a file of splines holds.
struct SplineFile
{
  std::vector<AnySpline> Splines;
  std::vector<int> Ids; ///< of the splines, distinct and >= 0; empty: 0, 1, 2, ...
  std::vector<MultiPatch> MultiPatches;
  std::vector<std::string> Warnings; ///< what was left out in reading, one line each
};
}
