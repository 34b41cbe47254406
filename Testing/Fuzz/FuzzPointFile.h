// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/PointFile.h>

#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace knotwork
{
/// NaN is the same as NaN.
inline bool SameNumbers(const PointMatrix& a, const PointMatrix& b)
{
  return a.rows() == b.rows() && a.cols() == b.cols() &&
    (a.array() == b.array() || (a.array().isNaN() && b.array().isNaN())).all();
}

/// A text gives an error of one line, or points that are written and read again bit for bit.
template <typename Read, typename Write, typename ReadAgain>
void CheckPoints(const std::uint8_t* data, std::size_t size, const Read& read, const Write& write,
  const ReadAgain& readAgain)
{
  const Result<PointFile> file = read({ reinterpret_cast<const char*>(data), size });
  if (!file)
  {
    if (file.Status.Detail.empty() || file.Status.Detail.find('\n') != std::string::npos)
    {
      std::abort();
    }
    return;
  }
  const Result<std::string> text = write(file.Value);
  const Result<PointFile> again = text ? readAgain(text.Value) : Result<PointFile>(text.Status);
  if (!again || again->Points != file->Points || !SameNumbers(again->Channels, file->Channels))
  {
    std::abort();
  }
}

template <typename Read, typename Write>
void CheckPoints(const std::uint8_t* data, std::size_t size, const Read& read, const Write& write)
{
  CheckPoints(data, size, read, write, read);
}
}
