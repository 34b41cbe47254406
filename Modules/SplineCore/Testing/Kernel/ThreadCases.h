// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Parallel.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <thread>

namespace knotwork::testing
{
/// Threads of this process, or 0 where the system does not tell.
inline int NumThreadsOfProcess()
{
  std::error_code error;
  int count = 0;
  for (std::filesystem::directory_iterator task("/proc/self/task", error), end; task != end;
       task.increment(error))
  {
    ++count;
  }
  return count;
}

/// Ends the process: successfully unless the work has started threads.
inline void ExitByThreads(const std::function<bool()>& work)
{
  const int before = NumThreadsOfProcess();
  const bool succeeded = work();
  const int after = NumThreadsOfProcess();
  std::cerr << (succeeded ? "succeeded" : "failed") << " with " << after - before
            << " threads more";
  std::exit(succeeded && after == before ? 0 : 1);
}

/// Expects that work that was given one thread stays in the calling one. It runs in a process of
/// its own, where no test before it has started the pool of threads.
inline void ExpectOneThread(const std::function<bool()>& work)
{
  if (NumThreadsOfProcess() == 0 || std::thread::hardware_concurrency() < 2)
  {
    GTEST_SKIP() << "the threads of a process cannot be counted here, or there is one core";
  }
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto everywhere = []
  {
    ParallelFor(1000, 1, 0, [](std::size_t, std::size_t) {});
    return true;
  };
  EXPECT_EXIT(ExitByThreads(everywhere), ::testing::ExitedWithCode(1), "threads more");
  EXPECT_EXIT(ExitByThreads(work), ::testing::ExitedWithCode(0), "succeeded with 0 threads more");
}
}
