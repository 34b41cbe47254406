// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/FileEnding.h>

#include <gtest/gtest.h>

using namespace knotwork;

TEST(FileEnding, IsTheLastOfTheName_ExactOracle)
{
  const struct
  {
    const char* File;
    const char* Ending;
  } cases[] = { { "a.g2", ".g2" }, { "LINES.VTP", ".vtp" }, { "run.g2/out.vtu", ".vtu" },
    { "run.g2/out", "" }, { "a.g2.Vtu", ".vtu" }, { "", "" }, { "plain", "" }, { ".g2", "" },
    { "run/.g2", "" }, { "ends.", "." } };
  for (const auto& test : cases)
  {
    EXPECT_EQ(LowerEnding(test.File), test.Ending) << test.File;
  }
}
