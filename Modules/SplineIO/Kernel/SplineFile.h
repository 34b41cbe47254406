// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/MultiPatch.h>

#include <string>
#include <vector>

namespace knotwork
{
/// Patches of one parametric dimension that belong together, as the file states it; nothing here
/// compares geometry.
struct StatedPatches
{
  int Dimension = 0;
  std::vector<int> Splines; ///< indices into SplineFile::Splines, which the topology refers to
  PatchTopology Topology;
};

/// A curve that bounds a surface: in its parameter plane, in space, or both. A spline without a
/// space is not there.
struct LoopCurve
{
  Spline<1> Parameter; ///< 2 coordinates
  Spline<1> Space;     ///< 3 coordinates
  bool PreferParameter = true;
};

/// Curves end to end.
struct SurfaceLoop
{
  std::vector<LoopCurve> Curves;
  double Tolerance = 0.0; ///< of the file: within which curves meet
};

/// A trimmed surface: the loops bound the part that is kept, the outer loop first.
struct BoundedSurface
{
  int Spline = 0; ///< index into SplineFile::Splines
  std::vector<SurfaceLoop> Loops;
};

/// What a file of splines holds.
struct SplineFile
{
  std::vector<AnySpline> Splines;
  std::vector<int> Ids; ///< of the splines, distinct and >= 0; empty: 0, 1, 2, ...
  std::vector<StatedPatches> MultiPatches;
  std::vector<BoundedSurface> Bounded; ///< at most one a spline
  std::vector<std::string> Warnings;   ///< what is not as it should be, one line each
  std::vector<std::string> LeftOut;    ///< parts of the file that are not here, one line each
};
}
