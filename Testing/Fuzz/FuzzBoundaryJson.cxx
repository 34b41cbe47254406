// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzSplineFile.h"
#include <knotwork/SplineIO/BoundaryJson.h>
#include <knotwork/SplineIO/GismoXml.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace knotwork;
  // Boundaries are read only: what was read goes through another format.
  CheckText(
    data, size, [](std::string_view text) { return ReadBoundaryJson(text); },
    [](const SplineFile& file) { return WriteGismoXml(file); },
    [](std::string_view text) { return ReadGismoXml(text); });
  return 0;
}
