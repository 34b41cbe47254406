// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzPointFile.h"
#include "FuzzSplineFile.h"
#include <knotwork/SplineIO/GoToolsG2.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace knotwork;
  CheckText(
    data, size, [](std::string_view text) { return ReadG2(text); },
    [](const SplineFile& file) { return WriteG2File(file); });
  CheckPoints(
    data, size, [](std::string_view text) { return ReadG2Points(text); },
    [](const PointFile& file) { return WriteG2Points(file); });
  return 0;
}
