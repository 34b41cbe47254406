// SPDX-License-Identifier: BSD-3-Clause
#include "ParallelZLib.h"

#include <knotwork/SplineCore/Parallel.h>

#include <vtkObjectFactory.h>
#include <vtk_zlib.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace knotwork
{
namespace
{
constexpr std::size_t PieceSize = 1 << 18;
constexpr std::size_t MostAroundPiece = 64; ///< bytes that a piece needs more than in one stream
constexpr std::array<unsigned char, 2> Header = { 0x78, 0x01 };

/// A part of a raw deflate stream (RFC 1951) that ends at a byte; empty: out of memory.
std::string Deflate(unsigned char const* data, std::size_t size, int level, bool isLast)
{
  z_stream stream{};
  constexpr int window = -15; // raw
  constexpr int memory = 8;   // zlib's default
  if (deflateInit2(&stream, level, Z_DEFLATED, window, memory, Z_DEFAULT_STRATEGY) != Z_OK)
  {
    return {};
  }
  std::string part(compressBound(static_cast<uLong>(size)) + MostAroundPiece, '\0');
  stream.next_in = const_cast<unsigned char*>(data);
  stream.avail_in = static_cast<uInt>(size);
  stream.next_out = reinterpret_cast<unsigned char*>(part.data());
  stream.avail_out = static_cast<uInt>(part.size());
  const int end = deflate(&stream, isLast ? Z_FINISH : Z_SYNC_FLUSH);
  part.resize(end == (isLast ? Z_STREAM_END : Z_OK) ? part.size() - stream.avail_out : 0);
  deflateEnd(&stream);
  return part;
}
}

vtkStandardNewMacro(ParallelZLib);

size_t ParallelZLib::GetMaximumCompressionSpace(size_t size)
{
  return this->vtkZLibDataCompressor::GetMaximumCompressionSpace(size) +
    (size / PieceSize + 1) * MostAroundPiece;
}

size_t ParallelZLib::CompressBuffer(
  unsigned char const* data, size_t size, unsigned char* compressed, size_t compressionSpace)
{
  if (size <= PieceSize)
  {
    return this->vtkZLibDataCompressor::CompressBuffer(data, size, compressed, compressionSpace);
  }
  const std::size_t count = (size + PieceSize - 1) / PieceSize;
  std::vector<std::string> parts(count);
  std::vector<uLong> sums(count);
  ParallelFor(count, 1, this->Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const std::size_t length = std::min(PieceSize, size - i * PieceSize);
        const unsigned char* piece = data + i * PieceSize;
        parts[i] = Deflate(piece, length, this->CompressionLevel, i + 1 == count);
        sums[i] = adler32(1, piece, static_cast<uInt>(length));
      }
    });
  // the stream of RFC 1950: header, parts, sum of all that was compressed
  std::size_t at = Header.size();
  uLong sum = 1;
  std::copy(Header.begin(), Header.end(), compressed);
  for (std::size_t i = 0; i < count; ++i)
  {
    if (parts[i].empty() || at + parts[i].size() + 4 > compressionSpace)
    {
      return 0;
    }
    std::copy(parts[i].begin(), parts[i].end(), compressed + at);
    at += parts[i].size();
    sum = adler32_combine(
      sum, sums[i], static_cast<z_off_t>(std::min(PieceSize, size - i * PieceSize)));
  }
  for (int shift = 24; shift >= 0; shift -= 8)
  {
    compressed[at++] = static_cast<unsigned char>(sum >> shift);
  }
  return at;
}
}
