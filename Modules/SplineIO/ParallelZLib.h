// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vtkZLibDataCompressor.h>

namespace knotwork
{
/// Streams of zlib whose pieces are compressed by several threads; everything that reads zlib reads
/// them. To VTK's writers it is a vtkZLibDataCompressor, whose name they write. The bytes do not
/// depend on the number of threads.
class ParallelZLib : public vtkZLibDataCompressor
{
public:
  static ParallelZLib* New();

  int Threads = 0; ///< 0: all cores

  size_t GetMaximumCompressionSpace(size_t size) override;

protected:
  ParallelZLib() = default;

  size_t CompressBuffer(unsigned char const* data, size_t size, unsigned char* compressed,
    size_t compressionSpace) override;
};
}
