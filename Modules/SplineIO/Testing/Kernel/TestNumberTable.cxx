// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineIO/NumberTable.h>

#include <gtest/gtest.h>

using namespace knotwork;

TEST(NumberTable, ColumnsHaveNames_ExactOracle)
{
  for (const char* text : { "a,b\n1,2\n3,4\n", "# about it\n a ; b\n\n1;2\n% between\n3;4",
         "\"a\" b\r\n+1 2e0\r\n 3\t4 \r\n" })
  {
    const auto table = ReadNumberTable(text);
    ASSERT_TRUE(table) << table.Status.Message();
    EXPECT_EQ(table->Names, (std::vector<std::string>{ "a", "b" })) << text;
    ASSERT_EQ(table->Numbers.rows(), 2) << text;
    EXPECT_EQ(table->Numbers, (PointMatrix(2, 2) << 1.0, 2.0, 3.0, 4.0).finished()) << text;
  }
  EXPECT_EQ(ReadNumberTable("only\n7\n")->Numbers(0, 0), 7.0);
}

TEST(NumberTable, EveryFailureIsReachable_ExactOracle)
{
  struct Failure
  {
    const char* Text;
    ErrorCode Code;
    const char* Detail;
  };
  for (const Failure& failure : {
         Failure{ "", ErrorCode::EmptyInput, "holds no numbers" },
         Failure{ "a,b\n", ErrorCode::EmptyInput, "no row" },
         Failure{ "1,2\n3,4\n", ErrorCode::InvalidFormat, "line 1 does not name the columns" },
         Failure{ "a,b\n1,2\n3,x\n", ErrorCode::InvalidFormat, "line 3, column 2" },
         Failure{ "a,b\n1,2,3\n", ErrorCode::InvalidFormat, "line 2 has 3 columns" },
         Failure{ "a,b\n1,2\n3", ErrorCode::InvalidFormat, "truncated" },
       })
  {
    const auto table = ReadNumberTable(failure.Text);
    EXPECT_EQ(table.Status.Code, failure.Code) << failure.Text;
    EXPECT_NE(table.Status.Detail.find(failure.Detail), std::string::npos) << table.Status.Detail;
  }
}
