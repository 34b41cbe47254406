// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzSplineFile.h"
#include "GoToolsG2.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace knotwork;
  CheckText(
    data, size, [](std::string_view text) { return ReadG2(text); },
    [](const SplineFile& file) { return WriteG2File(file); });
  return 0;
}
