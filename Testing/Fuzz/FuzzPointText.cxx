// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzPointFile.h"
#include <knotwork/SplineIO/PointText.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace knotwork;
  CheckPoints(
    data, size, [](std::string_view text) { return ReadPointText(text, 1); },
    [](const PointFile& file) { return WritePointText(file, ','); });
  return 0;
}
