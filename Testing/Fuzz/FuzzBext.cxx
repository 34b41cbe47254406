// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzSplineFile.h"
#include <knotwork/SplineIO/BextFile.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace knotwork;
  // a JSON text may have a longer number of its patch than a text has columns for
  CheckText(
    data, size, [](std::string_view text) { return ReadBext(text); },
    [](const SplineFile& file) { return WriteBextJson(file); });
  CheckText(
    data, size,
    [](std::string_view text)
    {
      Result<SplineFile> file = ReadBext(text);
      file.Value.Ids.clear();
      return file;
    },
    [](const SplineFile& file)
    {
      SplineFile unnumbered = file;
      unnumbered.Ids.clear();
      return WriteBext(unnumbered);
    });
  return 0;
}
