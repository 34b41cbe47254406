// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SplineFile.h"

#include <cstdint>
#include <cstdlib>

namespace knotwork
{
/// A text gives an error or splines; what was read can be written and reads as the same text again.
template <typename Read, typename Write>
void CheckText(const std::uint8_t* data, std::size_t size, Read&& read, Write&& write)
{
  const Result<SplineFile> file = read({ reinterpret_cast<const char*>(data), size });
  if (!file)
  {
    if (file.Status.Detail.empty() || file.Status.Detail.find('\n') != std::string::npos)
    {
      std::abort();
    }
    return;
  }
  const Result<std::string> text = write(file.Value);
  const Result<SplineFile> again = text ? read(text.Value) : Result<SplineFile>(text.Status);
  if (!again || write(again.Value).Value != text.Value)
  {
    std::abort();
  }
}
}
