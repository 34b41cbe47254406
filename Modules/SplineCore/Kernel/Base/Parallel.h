// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <functional>

namespace knotwork
{
/// Runs body(begin, end) over chunks of fixed size of [0, count).
///
/// The chunks depend on count and chunk only, never on the number of threads, so a body that
/// writes to its own range gives bit-identical results for any number of threads.
/// @param threads  0: all cores; 1: the calling thread only, in order; n: at most n threads.
/// @param body     must not throw.
void ParallelFor(std::size_t count, std::size_t chunk, int threads,
  const std::function<void(std::size_t begin, std::size_t end)>& body);
}
