// SPDX-License-Identifier: BSD-3-Clause
// Pictures of tests against the baselines in Testing/Baseline.
#pragma once

#include "ImageDifference.h"

#include <string>

namespace knotwork
{

/// Compares the PNG file `rendering` with the PNG file `baseline`. Returns an empty string when
/// they agree; otherwise what is wrong, and leaves beside the rendering X.png a picture
/// X.difference.png (differing pixels black) and the mark X.rejected, which names the baseline: the
/// build target `accept-baselines` goes by it.
[[nodiscard]] std::string CompareWithBaseline(
  const std::string& rendering, const std::string& baseline, const ImageLimits& limits = {});

}
