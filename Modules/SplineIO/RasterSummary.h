// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <cstdint>

namespace knotwork
{
/// What a raster that was written holds.
struct RasterSummary
{
  int Columns = 0;
  int Rows = 0;
  RealArray<2> Lower{}; ///< outer corners of the raster
  RealArray<2> Upper{};
  std::int64_t NumWithData = 0;
  double Lowest = 0.0; ///< height
  double Highest = 0.0;
};
}
