// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzPointFile.h"
#include <knotwork/SplineIO/LasFile.h>
#include <knotwork/SplineIO/PointText.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace knotwork;
  CheckPoints(
    data, size, [](std::string_view text) { return ReadLas(text); },
    [](const PointFile& file) { return WritePointText(file, ','); },
    [](std::string_view text) { return ReadPointText(text, 1); });
  return 0;
}
