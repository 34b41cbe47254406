// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineIO/PlyPoints.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

using namespace knotwork;

namespace
{
const std::string Header =
  "element vertex 3\nproperty double x\nproperty float quality\nproperty double y\n"
  "property short z\nelement edge 2\nproperty list uchar float weights\n"
  "property int id\nelement face 1\nproperty list uchar int vertex_indices\n"
  "end_header\n";
const std::string Ascii = "ply\nformat ascii 1.0\ncomment by hand\n" + Header +
  "0.1 0.5 500000.125 -3\n1 0.25 2 4\n5 6 7 8\n2 0.5 0.5 7\n0 8\n3 2 1 0\n";

template <typename T>
void Append(std::string& text, T value, bool big)
{
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  if (big)
  {
    std::reverse(bytes, bytes + sizeof(T));
  }
  text.append(bytes, sizeof(T));
}

std::string Binary(bool big)
{
  std::string text = std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
    "_endian 1.0\nobj_info nothing\n" + Header;
  const double rows[3][4] = { { 0.1, 0.5, 500000.125, -3 }, { 1, 0.25, 2, 4 }, { 5, 6, 7, 8 } };
  for (const auto& row : rows)
  {
    Append(text, row[0], big);
    Append(text, static_cast<float>(row[1]), big);
    Append(text, row[2], big);
    Append(text, static_cast<std::int16_t>(row[3]), big);
  }
  Append(text, std::uint8_t(2), big);
  Append(text, 0.5F, big);
  Append(text, 0.5F, big);
  Append(text, std::int32_t(7), big);
  Append(text, std::uint8_t(0), big);
  Append(text, std::int32_t(8), big);
  Append(text, std::uint8_t(3), big);
  for (std::int32_t corner : { 2, 1, 0 })
  {
    Append(text, corner, big);
  }
  return text;
}

std::string With(std::string text, const std::string& part, const std::string& replacement)
{
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.replace(at, part.size(), replacement);
}
}

TEST(PlyPoints, EveryEncodingHoldsTheSame_GoldenOracle)
{
  for (const std::string& text : { Ascii, Binary(false), Binary(true) })
  {
    const auto file = ReadPly(text);
    ASSERT_TRUE(file) << file.Status.Message();
    PointMatrix points(3, 3);
    points << 0.1, 500000.125, -3, 1, 2, 4, 5, 7, 8;
    EXPECT_EQ(file->Points, points);
    EXPECT_EQ(file->Names, (std::vector<std::string>{ "quality" }));
    EXPECT_EQ(file->Channels(1, 0), 0.25);
    ASSERT_EQ(file->Polygons.size(), 1U);
    ASSERT_EQ(file->LeftOut.size(), 1U);
    EXPECT_NE(file->LeftOut[0].find("2 elements 'edge'"), std::string::npos);
    EXPECT_EQ(file->Polygons[0], (std::vector<int>{ 2, 1, 0 }));
  }
}

TEST(PlyPoints, EveryDamageIsOneErrorWithItsPlace_ExactOracle)
{
  const struct
  {
    std::string Text;
    ErrorCode Code;
    const char* Words;
  } cases[] = {
    { "", ErrorCode::InvalidFormat, "line 1" },
    { "off\n", ErrorCode::InvalidFormat, "begins with the line 'ply'" },
    { "ply\nformat ascii 1.0\n", ErrorCode::InvalidFormat, "header of the PLY file does not end" },
    { With(Ascii, "ascii", "text"), ErrorCode::InvalidFormat, "line 2: 'text'" },
    { With(Ascii, "vertex 3", "vertex three"), ErrorCode::InvalidFormat, "'three'" },
    { With(Ascii, "vertex 3", "vertex 2000000000"), ErrorCode::InvalidFormat, "2000000000" },
    { With(Ascii, "vertex 3", "vertex 0"), ErrorCode::InvalidFormat, "" },
    { With(Ascii, "double x", "quad x"), ErrorCode::InvalidFormat, "'quad'" },
    { With(Ascii, "double x", "double u"), ErrorCode::InvalidFormat,
      "2 of the properties x, y, z" },
    { With(Ascii, "property float quality", "property list uchar float quality"),
      ErrorCode::InvalidFormat, "is a list" },
    { With(Ascii, "edge 2\nproperty list uchar float weights\nproperty int id",
        "vertex 2\nproperty double x\nproperty double y\nproperty double z"),
      ErrorCode::InvalidFormat, "line 9: a second element 'vertex'" },
    { With(Ascii, "float quality", "float y"), ErrorCode::InvalidFormat,
      "line 7: vertices have the property 'y' twice" },
    { With(Ascii, "comment", "words"), ErrorCode::InvalidFormat, "line 3: 'words'" },
    { With(Ascii, "1 0.25 2 4", "1 0.25 nan 4"), ErrorCode::NonFiniteInput, "vertex 1: 'nan'" },
    { With(Ascii, "1 0.25 2 4", "1 0.25 two 4"), ErrorCode::InvalidFormat, "vertex 1: 'two'" },
    { With(Ascii, "3 2 1 0", "3 2 1 3"), ErrorCode::InvalidTopology, "corner 3" },
    { With(Ascii, "3 2 1 0", "3 2 1 -1"), ErrorCode::InvalidFormat, "face 0" },
    { With(Ascii, "3 2 1 0", "2 2 1"), ErrorCode::InvalidFormat, "face 0: it has 2 corners" },
    { Ascii + "3 0 1 2\n", ErrorCode::InvalidFormat,
      "line 21: '3' stands behind the last element" },
    { Binary(false) + "x", ErrorCode::InvalidFormat, "1 bytes stand behind the last element" },
    { With(Ascii, "3 2 1 0", "-3 2 1 0"), ErrorCode::InvalidFormat, "face 0" },
    { "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n",
      ErrorCode::EmptyInput, "no vertices" },
  };
  for (const auto& test : cases)
  {
    SCOPED_TRACE(test.Text);
    const auto file = ReadPly(test.Text);
    EXPECT_EQ(file.Status.Code, test.Code) << file.Status.Detail;
    EXPECT_NE(file.Status.Detail.find(test.Words), std::string::npos) << file.Status.Detail;
  }
}

TEST(PlyPoints, CutAndSpoiledBytesGiveAnErrorOrPoints_PropertyOracle)
{
  const std::string good = Binary(false);
  for (std::size_t cut = 0; cut < good.size(); ++cut)
  {
    EXPECT_FALSE(ReadPly(good.substr(0, cut))) << cut;
  }
  std::mt19937 random(1);
  for (int run = 0; run < 2000; ++run)
  {
    std::string text = run % 2 == 0 ? good : Ascii;
    for (int change = 0; change < 3; ++change)
    {
      text[random() % text.size()] = static_cast<char>(random() % 256);
    }
    const auto file = ReadPly(text);
    EXPECT_TRUE(file ? file->Points.allFinite() : !file.Status.Detail.empty());
  }
}
