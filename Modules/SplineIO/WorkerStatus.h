// SPDX-License-Identifier: BSD-3-Clause
// What the programs of Worker/ and those that start them have agreed on.
#pragma once
#include <cstdint>

namespace knotwork
{
/// The file that a worker writes parts to: each its length, then its bytes. The first is an error
/// code, the second the error's detail.
constexpr int WorkerDescriptor = 3;
/// In place of the length of another part.
constexpr std::uint64_t WorkerLastPart = ~std::uint64_t{ 0 };
/// Exit status.
constexpr int WorkerOutOfMemory = 3;
}
