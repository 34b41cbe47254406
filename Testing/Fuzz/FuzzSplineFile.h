// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/SplineFile.h>

#include <cstdint>
#include <cstdlib>

namespace knotwork
{
/// A text gives an error or splines; what was read can be written, and readAgain makes of that what
/// is written as the same text.
template <typename Read, typename Write, typename ReadAgain>
void CheckText(const std::uint8_t* data, std::size_t size, const Read& read, const Write& write,
  const ReadAgain& readAgain)
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
  const Result<SplineFile> again = text ? readAgain(text.Value) : Result<SplineFile>(text.Status);
  if (!again || write(again.Value).Value != text.Value)
  {
    std::abort();
  }
}

/// The same for a format that is read and written.
template <typename Read, typename Write>
void CheckText(const std::uint8_t* data, std::size_t size, const Read& read, const Write& write)
{
  CheckText(data, size, read, write, read);
}
}
