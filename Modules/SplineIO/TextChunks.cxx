// SPDX-License-Identifier: BSD-3-Clause
#include "TextChunks.h"

#include <algorithm>
#include <cstring>

namespace knotwork
{
std::streamoff TextChunks::Position() const
{
  return this->Chunks.empty() ? 0
                              : static_cast<std::streamoff>(this->Current) * ChunkSize +
      static_cast<std::streamoff>(this->pptr() - this->pbase());
}

std::streamoff TextChunks::Size() const
{
  return std::max(this->Farthest, this->Position());
}

void TextChunks::Open(std::size_t chunk, std::streamoff within)
{
  this->Farthest = this->Size();
  this->Current = chunk;
  char* begin = this->Chunks[chunk].get();
  this->setp(begin, begin + ChunkSize);
  this->pbump(static_cast<int>(within));
}

TextChunks::int_type TextChunks::overflow(int_type c)
{
  const std::size_t next = this->Chunks.empty() ? 0 : this->Current + 1;
  if (next == this->Chunks.size())
  {
    this->Chunks.emplace_back(new char[ChunkSize]);
  }
  this->Open(next, 0);
  return traits_type::eq_int_type(c, traits_type::eof())
    ? traits_type::not_eof(c)
    : this->sputc(traits_type::to_char_type(c));
}

std::streamsize TextChunks::xsputn(const char* text, std::streamsize count)
{
  for (std::streamsize left = count; left > 0;)
  {
    if (this->pptr() == this->epptr())
    {
      this->overflow(traits_type::eof());
    }
    const auto part = std::min<std::streamsize>(left, this->epptr() - this->pptr());
    std::memcpy(this->pptr(), text, static_cast<std::size_t>(part));
    this->pbump(static_cast<int>(part));
    text += part;
    left -= part;
  }
  return count;
}

TextChunks::pos_type TextChunks::seekoff(
  off_type offset, std::ios_base::seekdir from, std::ios_base::openmode mode)
{
  const off_type base = from == std::ios_base::beg ? 0
    : from == std::ios_base::cur                   ? this->Position()
                                                   : this->Size();
  return this->seekpos(base + offset, mode);
}

TextChunks::pos_type TextChunks::seekpos(pos_type position, std::ios_base::openmode)
{
  const auto to = static_cast<std::streamoff>(position);
  if (to < 0 || to > this->Size())
  {
    return pos_type(off_type(-1));
  }
  if (to != this->Position())
  {
    const std::streamoff chunk =
      std::min(to / ChunkSize, static_cast<std::streamoff>(this->Chunks.size()) - 1);
    this->Open(static_cast<std::size_t>(chunk), to - chunk * ChunkSize);
  }
  return position;
}

void TextChunks::WriteTo(std::ostream& stream) const
{
  std::streamoff left = this->Size();
  for (const auto& chunk : this->Chunks)
  {
    stream.write(chunk.get(), std::min(left, ChunkSize));
    left -= std::min(left, ChunkSize);
  }
}
}
