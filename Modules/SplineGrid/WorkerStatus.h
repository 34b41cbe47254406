// SPDX-License-Identifier: BSD-3-Clause
// What the programs of workers (Worker/) and those that start them have agreed on.
#pragma once
#include <cstdint>

namespace knotwork
{
/// The socket on which parts go both ways: each its length, then its bytes. A worker gets parts
/// first; those that it sends begin with an error code and the error's detail.
constexpr int WorkerDescriptor = 3;
/// In place of the length of another part.
constexpr std::uint64_t WorkerLastPart = ~std::uint64_t{ 0 };
/// Exit status.
constexpr int WorkerOutOfMemory = 3;
/// Exit status of knotwork-run where the other program does not start.
constexpr int WorkerNotStarted = 127;
}
