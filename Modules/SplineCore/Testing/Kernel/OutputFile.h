// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

namespace knotwork
{
/// A file of the running test alone: tests run beside each other and may name their files alike.
inline std::string OutputFile(const std::string& name)
{
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string folder = std::string(test->test_suite_name()) + "." + test->name();
  std::replace(folder.begin(), folder.end(), '/', '.');
  const std::filesystem::path path = std::filesystem::path(KNOTWORK_OUTPUT_DIR) / "tests" / folder;
  std::filesystem::create_directories(path);
  return (path / name).string();
}
}
