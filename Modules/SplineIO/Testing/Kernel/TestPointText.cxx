// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineIO/GoToolsG2.h>
#include <knotwork/SplineIO/PointText.h>

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

using namespace knotwork;

namespace
{
PointFile Points(const std::string& text)
{
  auto file = ReadPointText(text);
  EXPECT_TRUE(file) << file.Status.Message();
  return file.Value;
}

PointMatrix Matrix(std::initializer_list<std::initializer_list<double>> rows)
{
  PointMatrix matrix(rows.size(), rows.begin()->size());
  Eigen::Index i = 0;
  for (const auto& row : rows)
  {
    Eigen::Index j = 0;
    for (double value : row)
    {
      matrix(i, j++) = value;
    }
    ++i;
  }
  return matrix;
}

/// Numbers of every size, seeded.
PointFile RandomPoints(unsigned seed, Eigen::Index n, int channels)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::uniform_int_distribution<int> power(-300, 300);
  PointFile file;
  file.Points.resize(n, 3);
  file.Channels.resize(n, channels);
  for (int c = 0; c < channels; ++c)
  {
    file.Names.push_back("c" + std::to_string(c));
  }
  for (Eigen::Index i = 0; i < n; ++i)
  {
    for (int c = 0; c < 3 + channels; ++c)
    {
      (c < 3 ? file.Points(i, c) : file.Channels(i, c - 3)) =
        std::ldexp(unit(random), c == 0 ? power(random) : 0);
    }
  }
  return file;
}
}

TEST(PointText, TwoNamedColumnsAreAPlane_ExactOracle)
{
  const auto file = ReadPointText("X, y\n1,2\n3.5,-4\n");
  ASSERT_TRUE(file) << file.Status.Detail;
  PointMatrix expected(2, 3);
  expected << 1.0, 2.0, 0.0, 3.5, -4.0, 0.0;
  EXPECT_EQ(file.Value.Points, expected);
  EXPECT_TRUE(file.Value.Names.empty());
  EXPECT_FALSE(ReadPointText("y, x\n1,2\n")); // no other two
}

TEST(PointText, ReadsWhatIsWrittenByHand_GoldenOracle)
{
  const PointMatrix expected = Matrix({ { 0.5, -1.25, 3e-3 }, { 1.0, 2.0, 4.0 } });
  const std::string texts[] = {
    "0.5 -1.25 3e-3\n1 2 4\n",
    "# points\n\n  0.5\t-1.25   3e-3\r\n\r\n% more\n// and more\n+1 2 4",
    "0.5,-1.25,3e-3\n1,2,4\n",
    "0.5, -1.25, 3e-3,\n1 ,2,4,\n",
    "0.5;-1.25;3e-3\n1; 2;4\n",
    "\xEF\xBB\xBFX,Y,Z\n0.5,-1.25,3e-3\n1,2,4\n",
    "\"Points:0\",\"Points:1\",\"Points:2\"\n.5,-1.25,3E-3\n1.,2e0,4\n",
  };
  for (const std::string& text : texts)
  {
    SCOPED_TRACE(text);
    const PointFile file = Points(text);
    EXPECT_EQ(file.Points, expected);
    EXPECT_EQ(file.Channels.cols(), 0);
    EXPECT_TRUE(file.Names.empty());
  }
}

TEST(PointText, FindsColumnsByName_GoldenOracle)
{
  const PointFile named = Points("id,z,\"y\",x,intensity\n7,3,2,1,0.5\n8,30,20,10,0.25\n");
  EXPECT_EQ(named.Points, Matrix({ { 1, 2, 3 }, { 10, 20, 30 } }));
  EXPECT_EQ(named.Channels, Matrix({ { 7, 0.5 }, { 8, 0.25 } }));
  EXPECT_EQ(named.Names, (std::vector<std::string>{ "id", "intensity" }));
  // without names of coordinates they are the first three
  const PointFile other = Points("east north up w\n1 2 3 4\n");
  EXPECT_EQ(other.Points, Matrix({ { 1, 2, 3 } }));
  EXPECT_EQ(other.Names, (std::vector<std::string>{ "w" }));
  EXPECT_EQ(Points("1 2 3 4 5\n").Names, (std::vector<std::string>{ "Column4", "Column5" }));
  EXPECT_EQ(Points("# x y z w\n1 2 3 4\n").Names, (std::vector<std::string>{ "w" }));
  EXPECT_EQ(Points("# some words are here\n1 2 3 4\n").Names[0], "Column4");
}

TEST(PointText, ComesBackBitForBit_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const PointFile file = RandomPoints(seed, 50, static_cast<int>(seed % 4));
    for (char separator : { ' ', ',' })
    {
      const auto text = WritePointText(file, separator);
      ASSERT_TRUE(text);
      const PointFile again = Points(text.Value);
      EXPECT_EQ(again.Points, file.Points);
      EXPECT_EQ(again.Channels, file.Channels);
      EXPECT_EQ(again.Names, file.Names);
      EXPECT_EQ(WritePointText(again, separator).Value, text.Value);
    }
    const auto text = WriteG2Points(file);
    ASSERT_TRUE(text);
    const auto again = ReadG2Points(text.Value);
    ASSERT_TRUE(again) << again.Status.Message();
    EXPECT_EQ(again->Points, file.Points);
    EXPECT_EQ(WriteG2Points(again.Value).Value, text.Value);
  }
}

TEST(PointText, WhatHasNoValueComesBack_PropertyOracle)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  PointFile file;
  file.Points = Matrix({ { 1, 2, 3 }, { 4, 5, 6 }, { 7, 8, 9 } });
  file.Channels = Matrix({ { nan, 1 }, { -nan, -inf }, { 0.5, inf } });
  file.Names = { "distance", "limit" };
  for (char separator : { ' ', ',' })
  {
    const auto text = WritePointText(file, separator);
    ASSERT_TRUE(text) << text.Status.Message();
    const auto again = ReadPointText(text.Value);
    ASSERT_TRUE(again) << again.Status.Message();
    EXPECT_EQ(again->Points, file.Points);
    EXPECT_TRUE(std::isnan(again->Channels(0, 0)) && std::isnan(again->Channels(1, 0)));
    EXPECT_EQ(again->Channels(2, 0), 0.5);
    EXPECT_EQ(again->Channels.col(1), file.Channels.col(1));
    EXPECT_EQ(WritePointText(again.Value, separator).Value, text.Value);
  }
  // columns by name: a coordinate behind a channel
  EXPECT_TRUE(ReadPointText("d,x,y,z\nNaN,1,2,3\n"));
  EXPECT_EQ(ReadPointText("d,x,y,z\n1,1,2,nan\n").Status.Detail,
    "line 2, column 4: 'nan' is not a finite number; correct or remove the line");
  for (double value : { nan, inf })
  {
    file.Points(1, 2) = value;
    for (const auto& text :
      { WritePointText(file, ' '), WritePointText(file, ','), WriteG2Points(file) })
    {
      EXPECT_EQ(text.Status.Code, ErrorCode::NonFiniteInput);
      EXPECT_EQ(
        text.Status.Detail, "point 1 has a coordinate z that is not finite; remove the point");
    }
  }
}

TEST(PointText, EightMegabytesInPartsAreThoseOfOnePart_CrossOracle)
{
  // %.17g, as other programs write; the C library reads every line again
  const PointFile file = RandomPoints(3, 120000, 1);
  std::string text;
  char line[128];
  for (Eigen::Index i = 0; i < file.Points.rows(); ++i)
  {
    text += i % 1000 == 0 ? "# a comment\n\n" : "";
    const int length = std::snprintf(line, sizeof line, "%.17g %.17g %.17g %.17g\n",
      file.Points(i, 0), file.Points(i, 1), file.Points(i, 2), file.Channels(i, 0));
    text.append(line, static_cast<std::size_t>(length));
  }
  ASSERT_GT(text.size(), 8u << 20);
  for (int threads : { 1, 2, 4 })
  {
    const auto read = ReadPointText(text, threads);
    ASSERT_TRUE(read) << read.Status.Message();
    EXPECT_EQ(read->Points, file.Points);
    EXPECT_EQ(read->Channels, file.Channels);
  }
  // damage far behind is found in its line, whatever part it is in
  const std::size_t at = text.find('\n', text.size() / 2) + 1;
  const auto lineNumber = std::count(text.begin(), text.begin() + static_cast<long>(at), '\n') + 1;
  text.insert(at, "1 2 oops 4\n");
  for (int threads : { 1, 2 })
  {
    const auto damaged = ReadPointText(text, threads);
    EXPECT_EQ(damaged.Status.Code, ErrorCode::InvalidFormat);
    EXPECT_EQ(damaged.Status.Detail,
      "line " + std::to_string(lineNumber) +
        ", column 3: 'oops' is not a number; correct or remove the line");
  }
}

TEST(PointText, ReadsCloudsOfG2_GoldenOracle)
{
  const auto file = ReadG2Points("400 1 0 0\n3\n0 0 0\n1 2 3\n0.1 0.2 0.3\n\n"
                                 "400 1 0 4 255 128 0 255\n1\n4 5 6\n");
  ASSERT_TRUE(file) << file.Status.Message();
  EXPECT_EQ(file->Points, Matrix({ { 0, 0, 0 }, { 1, 2, 3 }, { 0.1, 0.2, 0.3 }, { 4, 5, 6 } }));
  ASSERT_EQ(file->Groups.size(), 2u);
  EXPECT_FALSE(file->Groups[0].HasColor);
  EXPECT_EQ(file->Groups[1].Begin, 3);
  EXPECT_EQ(file->Groups[1].Color, (std::array<int, 4>{ 255, 128, 0, 255 }));
  EXPECT_EQ(WriteG2Points(file.Value).Value,
    "400 1 0 0\n3\n0 0 0\n1 2 3\n0.1 0.2 0.3\n\n400 1 0 4 255 128 0 255\n1\n4 5 6\n\n");
  // a curve beside it is left out with a word, and the points when splines are asked for
  const std::string curve = "100 1 0 0\n3 0\n2 2\n0 0 1 1\n0 0 0\n1 1 1\n";
  const auto both = ReadG2Points(curve + "400 1 0 0\n1\n1 2 3\n");
  ASSERT_TRUE(both);
  EXPECT_EQ(both->Points.rows(), 1);
  EXPECT_EQ(both->LeftOut.size(), 1u);
  const auto splines = ReadG2("400 1 0 0\n1\n1 2 3\n" + curve);
  ASSERT_TRUE(splines);
  EXPECT_EQ(splines->Splines.size(), 1u);
  EXPECT_EQ(splines->LeftOut.size(), 1u);
  EXPECT_TRUE(BeginsWithG2Points("400 1 0 0\n1\n"));
  EXPECT_FALSE(BeginsWithG2Points(curve));
  EXPECT_FALSE(BeginsWithG2Points("400"));
}

TEST(PointText, EveryDamageHasItsLineAndRemedy_ExactOracle)
{
  const struct
  {
    const char* Text;
    ErrorCode Code;
    const char* Detail;
  } cases[] = {
    { "", ErrorCode::EmptyInput, "the text holds no points" },
    { "\n\n# only words\n", ErrorCode::EmptyInput, "the text holds no points" },
    { "x,y,z\n", ErrorCode::EmptyInput, "the text holds no points, only names of columns" },
    { "1 2\n", ErrorCode::InvalidFormat,
      "line 1 has 2 columns ('1'); a line has x, y, z, separated by blanks, commas or semicolons" },
    { "hello\n", ErrorCode::InvalidFormat,
      "line 1 has 1 column ('hello'); a line has x, y, z, separated by blanks, commas or "
      "semicolons" },
    { "1 2 3\n4 5\n6 7 8\n", ErrorCode::InvalidFormat,
      "line 2 has 2 columns, line 1 has 3; correct or remove the line" },
    { "1 2 3\n4 5 6 7\n", ErrorCode::InvalidFormat,
      "line 2 has 4 columns, line 1 has 3; correct or remove the line" },
    { "1 2 3\n4 5", ErrorCode::InvalidFormat,
      "line 2 has 2 columns, line 1 has 3; the file is truncated, or the line incomplete" },
    { "1 2 3\nnan 5 6\n", ErrorCode::NonFiniteInput,
      "line 2, column 1: 'nan' is not a finite number; correct or remove the line" },
    { "nan 2 3\n", ErrorCode::NonFiniteInput,
      "line 1, column 1: 'nan' is not a finite number; correct or remove the line" },
    { "1 2 3\n4 -inf 6\n", ErrorCode::NonFiniteInput,
      "line 2, column 2: '-inf' is not a finite number; correct or remove the line" },
    { "1x 2 3\n4 5 6\n", ErrorCode::InvalidFormat,
      "line 1, column 1: '1x' is not a number; correct or remove the line" },
    { "x 2 3\n4 5 6\n", ErrorCode::InvalidFormat,
      "line 1, column 1: 'x' is not a number; correct or remove the line" },
    { "1 2 3\n4 5 1e999\n", ErrorCode::InvalidFormat,
      "line 2, column 3: '1e999' is outside the range of double-precision numbers; correct or "
      "remove the line" },
    { "1,2,3\n4,,6\n", ErrorCode::InvalidFormat,
      "line 2, column 2: there is no number; correct or remove the line" },
    { "1 2 3\n4,0 5,0 6,0\n", ErrorCode::InvalidFormat,
      "line 2, column 1: '4,0' is not a number; decimals have a point, and all lines are separated "
      "alike" },
    { "1;2;3\n4,5;5;6\n", ErrorCode::InvalidFormat,
      "line 2, column 1: '4,5' is not a number; decimals have a point, and all lines are separated "
      "alike" },
    { "1 2 3\n4 5 6x\n", ErrorCode::InvalidFormat,
      "line 2, column 3: '6x' is not a number; correct or remove the line" },
  };
  for (const auto& test : cases)
  {
    SCOPED_TRACE(test.Text);
    const auto file = ReadPointText(test.Text);
    EXPECT_EQ(file.Status.Code, test.Code);
    EXPECT_EQ(file.Status.Detail, test.Detail);
  }
  const struct
  {
    const char* Text;
    const char* Words;
  } clouds[] = {
    { "400 1 0 0\n", "number of points is missing" },
    { "400 1 0 0\n1000000000\n1 2 3\n", "too short for 1000000000 points" },
    { "400 1 0 0\n-1\n", "number of points: '-1'" },
    { "400 1 0 0\n1\n1 2 x\n", "line 3, word 8, coordinate of a point: 'x' is not a number" },
    { "400 1 0 0\n1\n1 2 nan\n", "'nan' is not a finite number" },
    { "400 1 0 4 256 0 0 0\n1\n1 2 3\n", "the share 256, outside 0 to 255" },
    { "400 1 0 0\n0\n", "no point cloud (400)" },
    { "400 1 0 0\n1\n1 2 3\n4 5 6\n", "an object has class 4" },
  };
  for (const auto& test : clouds)
  {
    SCOPED_TRACE(test.Text);
    const auto file = ReadG2Points(test.Text);
    EXPECT_FALSE(file);
    EXPECT_NE(file.Status.Detail.find(test.Words), std::string::npos) << file.Status.Detail;
  }
  PointFile empty;
  EXPECT_EQ(WritePointText(empty, ' ').Value, "# x y z\n"); // what was looked for, and not found
  EXPECT_EQ(WritePointText(empty, ',').Value, "x,y,z\n");
  EXPECT_EQ(WriteG2Points(empty).Status.Code, ErrorCode::EmptyInput);
  PointFile bad = RandomPoints(1, 3, 2);
  bad.Names.pop_back();
  EXPECT_EQ(WritePointText(bad, ' ').Status.Code, ErrorCode::SizeMismatch);
  bad.Groups.resize(2);
  EXPECT_EQ(WriteG2Points(bad).Status.Code, ErrorCode::SizeMismatch);
}
