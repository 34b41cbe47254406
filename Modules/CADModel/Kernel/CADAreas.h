// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>

namespace knotwork
{
/// Between what the area of a face lies: the cells of its surface that are proved to lie inside of
/// its loops, and those that do not lie outside. Integrals over cells are Gauss-Legendre sums.
struct AreaBounds
{
  double Lower = 0.0;
  double Upper = 0.0;
  std::array<double, 3> BoxLower{}; ///< of points in the face; equal to BoxUpper: none is known
  std::array<double, 3> BoxUpper{};
};

/// @return failures of TrimmedRegion::Create and EvaluateParameters.
Result<AreaBounds> BoundArea(const TrimmedFace& face);
}
