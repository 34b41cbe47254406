// SPDX-License-Identifier: BSD-3-Clause
#include "Base64Stream.h"

#include <vtkBase64Utilities.h>
#include <vtkObjectFactory.h>

#include <algorithm>
#include <array>
#include <ostream>

namespace knotwork
{
vtkStandardNewMacro(Base64Stream);

int Base64Stream::Write(void const* data, size_t length)
{
  constexpr std::size_t block = 3 << 14; // bytes
  std::array<unsigned char, block / 3 * 4> text;
  const auto* bytes = static_cast<const unsigned char*>(data);
  // what was left of the bytes before, up to a multiple of three
  const std::size_t first = std::min<std::size_t>((3 - this->BufferLength) % 3, length);
  int done = first > 0 ? this->vtkBase64OutputStream::Write(bytes, first) : 1;
  std::size_t at = first;
  for (; done != 0 && this->BufferLength == 0 && length - at >= 3;)
  {
    const std::size_t count = std::min(block, (length - at) / 3 * 3);
    for (std::size_t i = 0; i < count; i += 3)
    {
      unsigned char* four = text.data() + i / 3 * 4;
      const unsigned char* three = bytes + at + i;
      vtkBase64Utilities::EncodeTriplet(
        three[0], three[1], three[2], four, four + 1, four + 2, four + 3);
    }
    this->Stream->write(
      reinterpret_cast<const char*>(text.data()), static_cast<std::streamsize>(count / 3 * 4));
    done = this->Stream->fail() ? 0 : 1;
    at += count;
  }
  return done != 0 && at < length ? this->vtkBase64OutputStream::Write(bytes + at, length - at)
                                  : done;
}
}
