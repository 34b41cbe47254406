// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineIO/OneLine.h>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <random>

using knotwork::OneLine;

TEST(OneLine, TextStaysAsItIs)
{
  for (const std::string text :
    { "", " ", "'a b.vtu': point 3  is NaN", "Größe € 𝄞 日本", "back\\slash" })
  {
    EXPECT_EQ(OneLine(text), text);
  }
}

TEST(OneLine, WhatTerminalsObeyIsEscaped)
{
  EXPECT_EQ(OneLine("a\nb\r\tc"), "a\\nb\\r\\tc");
  EXPECT_EQ(OneLine("\x1b[31mred\x7f"), "\\x1b[31mred\\x7f");
  EXPECT_EQ(OneLine(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(OneLine("\xc2\x9b"), "\\u009b");                      // a control of ISO 6429
  EXPECT_EQ(OneLine("\xe2\x80\xaegpj.exe"), "\\u202egpj.exe");    // right to left
  EXPECT_EQ(OneLine("caf\xe9"), "caf\\xe9");                      // Latin-1
  EXPECT_EQ(OneLine("\xc0\xaf"), "\\xc0\\xaf");                   // overlong
  EXPECT_EQ(OneLine("\xed\xa0\x80"), "\\xed\\xa0\\x80");          // surrogate
  EXPECT_EQ(OneLine("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80"); // above the last character
  EXPECT_EQ(OneLine("\xe2\x82"), "\\xe2\\x82");                   // cut off
}

TEST(OneLine, LongOnesLoseTheirMiddle)
{
  const std::string path = "'/" + std::string(5000, 'x') + "/part.vtu'";
  const std::string line = OneLine(path + ": damaged");
  EXPECT_LT(line.size(), 330U);
  EXPECT_NE(line.find("/part.vtu': damaged"), std::string::npos);
  EXPECT_NE(line.find("..."), std::string::npos);
  std::string many;
  for (int i = 0; i < 2000; ++i)
  {
    many += "word ";
  }
  EXPECT_LE(OneLine(many + "end").size(), 2000U);
  std::string wide;
  for (int i = 0; i < 1000; ++i)
  {
    wide += "€";
  }
  EXPECT_NO_THROW(nlohmann::json(OneLine(wide)).dump()); // cut between characters
}

// Any bytes become one line that JSON takes, which it does for valid UTF-8 alone.
TEST(OneLine, AnyBytesBecomeOneLineOfUTF8)
{
  for (unsigned seed = 1; seed <= 200; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 generator(seed);
    std::string bytes(generator() % 3000, '\0');
    for (char& c : bytes)
    {
      c = static_cast<char>(generator() % (seed % 2 == 0 ? 256 : 0x90));
    }
    const std::string line = OneLine(bytes);
    EXPECT_NO_THROW(nlohmann::json(line).dump());
    for (unsigned char c : line)
    {
      EXPECT_TRUE(c >= 0x20 && c != 0x7F);
    }
    EXPECT_LE(line.size(), 2000U);
  }
}
