// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <ostream>
#include <streambuf>
#include <vector>

namespace knotwork
{
/// A text in memory that is never copied while it grows, unlike that of std::ostringstream: of
/// large files this is half of the memory and of the time. A writer may go back and replace
/// characters.
class TextChunks : public std::streambuf
{
public:
  TextChunks() = default;

  std::streamoff Size() const;
  void WriteTo(std::ostream& stream) const;

protected:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* text, std::streamsize count) override;
  pos_type seekoff(
    off_type offset, std::ios_base::seekdir from, std::ios_base::openmode mode) override;
  pos_type seekpos(pos_type position, std::ios_base::openmode mode) override;

private:
  static constexpr std::streamoff ChunkSize = 1 << 20;

  std::streamoff Position() const;
  /// Makes the chunk of a position the one that is written.
  void Open(std::size_t chunk, std::streamoff within);

  std::vector<std::unique_ptr<char[]>> Chunks;
  std::size_t Current = 0;
  std::streamoff Farthest = 0; ///< end of the text, but for what the present chunk has beyond it
};
}
