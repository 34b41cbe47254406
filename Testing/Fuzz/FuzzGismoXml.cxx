// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzSplineFile.h"
#include <knotwork/SplineIO/GismoXml.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace knotwork;
  CheckText(
    data, size, [](std::string_view text) { return ReadGismoXml(text); },
    [](const SplineFile& file) { return WriteGismoXml(file); });
  return 0;
}
