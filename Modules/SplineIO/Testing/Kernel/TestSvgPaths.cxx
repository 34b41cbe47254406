// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineIO/SvgPaths.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace knotwork;

namespace
{
std::string Picture(const std::string& content)
{
  return "<?xml version=\"1.0\"?><svg xmlns=\"http://www.w3.org/2000/svg\">" + content + "</svg>";
}

std::string Path(const std::string& commands)
{
  return Picture("<path d=\"" + commands + "\"/>");
}

/// Points of a line, y as in the file.
PointMatrix LineOf(const Result<PointFile>& file, std::size_t line)
{
  PointMatrix points(static_cast<Eigen::Index>(file.Value.Lines.at(line).size()), 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const int row = file.Value.Lines[line][static_cast<std::size_t>(i)];
    points.row(i) << file.Value.Points(row, 0), -file.Value.Points(row, 1);
  }
  return points;
}

PointMatrix Drawn(const std::string& content)
{
  const auto file = ReadSvg(content);
  EXPECT_TRUE(file) << file.Status.Detail;
  EXPECT_EQ(file.Value.Lines.size(), 1U);
  return file && !file.Value.Lines.empty() ? LineOf(file, 0) : PointMatrix::Zero(1, 2);
}

constexpr double Rounding = 1e-13; // of a few products of numbers up to 10
}

TEST(SvgPaths, RelativeAndAbsoluteCommandsAgree_ExactOracle)
{
  const PointMatrix absolute =
    Drawn(Path("M1 2 L3 4 H5 V6 C6 7 8 7 9 6 S12 5 13 6 Q14 7 15 6 T17 6 A2 1 30 0 1 20 8 Z"));
  const PointMatrix relative =
    Drawn(Path("m1,2l2,2h2v2c1,1 3,1 4,0s3-1 4 0q1 1 2 0t2 0a2 1 30 013 2z"));
  ASSERT_EQ(absolute.rows(), relative.rows());
  EXPECT_LT((absolute - relative).cwiseAbs().maxCoeff(), Rounding);
  EXPECT_EQ(absolute.row(0), absolute.row(absolute.rows() - 1));
  EXPECT_EQ(absolute.rows(), 1 + 3 + 5 * 64 + 1);
}

TEST(SvgPaths, NumbersNeedNoBlanks_ExactOracle)
{
  PointMatrix expected(4, 2);
  expected << 0.5, 0.25, -10.0, 2.0, 3.0, -4.5, 0.75, 0.0;
  const PointMatrix sound = Drawn(Path("M.5.25-1e1+2 3-4.5.75 0"));
  EXPECT_EQ(sound, expected);
}

TEST(SvgPaths, CurvesAreOnTheirPolynomials_ExactOracle)
{
  const PointMatrix line = Drawn(Path("M0 0 C0 3 3 3 3 0"));
  ASSERT_EQ(line.rows(), 65);
  EXPECT_NEAR(line(32, 0), 1.5, Rounding);
  EXPECT_NEAR(line(32, 1), 2.25, Rounding); // 3/8 (3 + 3)
  const PointMatrix quadratic = Drawn(Path("M0 0 Q2 4 4 0"));
  EXPECT_NEAR(quadratic(32, 1), 2.0, Rounding);
  EXPECT_NEAR(quadratic(16, 1), 1.5, Rounding); // 2 (1/4) (3/4) 4
}

TEST(SvgPaths, ArcsLieOnTheirEllipses_ExactOracle)
{
  for (const char* flags : { "0 0", "0 1", "1 0", "1 1" })
  {
    const PointMatrix line = Drawn(Path(std::string("M2 0 A2 2 0 ") + flags + " 0 2"));
    // the two circles of radius 2 through (2, 0) and (0, 2) have their centres at 0 and (2, 2)
    const bool isFar = std::string(flags) == "0 0" || std::string(flags) == "1 1";
    const Eigen::RowVector2d centre(isFar ? 2.0 : 0.0, isFar ? 2.0 : 0.0);
    for (Eigen::Index i = 0; i < line.rows(); ++i)
    {
      EXPECT_NEAR((line.row(i) - centre).norm(), 2.0, Rounding) << flags;
    }
    double length = 0.0;
    for (Eigen::Index i = 1; i < line.rows(); ++i)
    {
      length += (line.row(i) - line.row(i - 1)).norm();
    }
    EXPECT_NEAR(length, flags[0] == '1' ? 3.0 * M_PI : M_PI, 1e-2) << flags;
  }
  // radii that do not reach grow
  const PointMatrix grown = Drawn(Path("M0 0 A1 1 0 0 1 4 0"));
  EXPECT_NEAR((grown.row(32) - Eigen::RowVector2d(2.0, 0.0)).norm(), 2.0, Rounding);
}

TEST(SvgPaths, TransformsOfGroupsNest_ExactOracle)
{
  const PointMatrix line = Drawn(Picture("<g transform=\"translate(10, 20) rotate(90)\"><g "
                                         "transform=\"scale(2 3)\"><path d=\"M1 0 L0 1\" "
                                         "transform=\"matrix(1 0 0 1 1 1)\"/></g></g>"));
  PointMatrix expected(2, 2);
  expected << 10.0 - 3.0, 20.0 + 4.0, 10.0 - 6.0, 20.0 + 2.0; // (2, 1) and (1, 2), scaled, turned
  EXPECT_LT((line - expected).cwiseAbs().maxCoeff(), Rounding);
  const PointMatrix skewed =
    Drawn(Picture("<g transform=\"skewX(45)\"><line x1=\"0\" y1=\"0\" x2=\"1\" y2=\"2\"/></g>"));
  EXPECT_NEAR(skewed(1, 0), 3.0, Rounding);
  const PointMatrix turned =
    Drawn(Picture("<g transform=\"rotate(180 1 1)\"><polyline points=\"0,0 1,0\"/></g>"));
  EXPECT_NEAR(turned(0, 0), 2.0, Rounding);
  EXPECT_NEAR(turned(0, 1), 2.0, Rounding);
}

TEST(SvgPaths, ShapesAndWhatIsLeftOut_ExactOracle)
{
  const auto file = ReadSvg(Picture(
    "<defs><path d=\"M0 0 L9 9\"/></defs><rect x=\"1\" y=\"2\" width=\"3\" height=\"4\"/>"
    "<circle cx=\"1\" cy=\"1\" r=\"2\"/><polygon points=\"0 0 1 0 1 1\"/><text>words</text>"));
  ASSERT_TRUE(file) << file.Status.Detail;
  ASSERT_EQ(file.Value.Lines.size(), 3U);
  const PointMatrix box = LineOf(file, 0);
  EXPECT_EQ(box.rows(), 5);
  EXPECT_EQ(box.row(2), Eigen::RowVector2d(4.0, 6.0));
  const PointMatrix circle = LineOf(file, 1);
  EXPECT_EQ(circle.rows(), 129);
  EXPECT_NEAR((circle.row(77) - Eigen::RowVector2d(1.0, 1.0)).norm(), 2.0, Rounding);
  EXPECT_EQ(LineOf(file, 2).rows(), 4);
  ASSERT_EQ(file.Value.LeftOut.size(), 1U);
  EXPECT_NE(file.Value.LeftOut[0].find("<text>"), std::string::npos);
}

TEST(SvgPaths, EveryFailureNamesItsPlace)
{
  const auto fails = [](const std::string& text, ErrorCode code, const std::string& words)
  {
    const auto file = ReadSvg(text);
    EXPECT_EQ(file.Status.Code, code) << text;
    EXPECT_NE(file.Status.Detail.find(words), std::string::npos) << file.Status.Detail;
  };
  fails("<svg><path", ErrorCode::InvalidFormat, "well-formed");
  fails("<html/>", ErrorCode::InvalidFormat, "<html>");
  fails(Picture(""), ErrorCode::EmptyInput, "no line");
  fails(Path("L1 2"), ErrorCode::InvalidFormat, "begins with M");
  fails(Path("M1 2 L3"), ErrorCode::InvalidFormat, "command L");
  fails(Path("M1 2 B3 4"), ErrorCode::InvalidFormat, "command B");
  fails(Path("M1 2 Z 3 4"), ErrorCode::InvalidFormat, "command is missing");
  fails(Path("M1 2 L1e999 0"), ErrorCode::InvalidFormat, "command L");
  fails(Path("M1 2 A1 1 0 2 0 3 3"), ErrorCode::InvalidFormat, "command A");
  fails(Picture("<path id=\"rim\" d=\"M1 2 L3\"/>"), ErrorCode::InvalidFormat, "id=\"rim\"");
  fails(Picture("<g transform=\"turn(3)\"><path d=\"M0 0 L1 1\"/></g>"), ErrorCode::InvalidFormat,
    "turn(3)");
  std::string deep;
  for (int i = 0; i < 300; ++i)
  {
    deep += "<g>";
  }
  for (int i = 0; i < 300; ++i)
  {
    deep += "</g>";
  }
  fails(Picture(deep), ErrorCode::TooLarge, "ungroup");
}

TEST(SvgPaths, DamagedTextsEnd_PropertyOracle)
{
  const std::string sound = Picture("<g transform=\"translate(1 2) rotate(3 4 5)\"><path d=\"M1 2 "
                                    "C3 4 5 6 7 8 A1 2 3 0 1 4 5 Z\"/></g>");
  std::mt19937 random(7);
  for (int run = 0; run < 3000; ++run)
  {
    std::string text = sound;
    for (int k = 0; k < 3; ++k)
    {
      text[random() % text.size()] = static_cast<char>(32 + random() % 95);
    }
    const auto file =
      ReadSvg(text.substr(0, random() % 4 == 0 ? random() % text.size() : text.size()));
    EXPECT_TRUE(file || !file.Status.Detail.empty());
    EXPECT_TRUE(!file || file.Value.Points.allFinite());
  }
}
