// SPDX-License-Identifier: BSD-3-Clause
// The comparator itself: what it must let pass and what it must not.
#include "Baselines.h"
#include "ImageDifference.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>

namespace
{

using knotwork::CompareImages;
using knotwork::Image;

constexpr int Size = 300;
using Color = std::array<unsigned char, 3>;
constexpr Color White{ 255, 255, 255 };
constexpr Color Blue{ 26, 115, 230 };
constexpr Color Teal{ 26, 180, 230 };
constexpr Color Black{ 0, 0, 0 };

Image Blank()
{
  return { Size, Size, std::vector<unsigned char>(3 * Size * Size, 255) };
}

/// Paints where inside(x, y) is positive; a value in (0, 1) blends, as smoothed edges do.
template <class Function>
void Paint(Image& image, const Color& color, const Function& inside)
{
  for (int y = 0; y < Size; ++y)
  {
    for (int x = 0; x < Size; ++x)
    {
      const double share = std::clamp(static_cast<double>(inside(x, y)), 0.0, 1.0);
      for (int c = 0; c < 3; ++c)
      {
        auto& value = image.Rgb[3 * (y * Size + x) + c];
        value = static_cast<unsigned char>(std::lround((1 - share) * value + share * color[c]));
      }
    }
  }
}

/// A regular polygon with n corners of radius 100 around (x0, 150).
Image Polygon(int n, double x0 = 150, bool smooth = false, const Color& color = Blue)
{
  const double pi = std::acos(-1.0);
  Image image = Blank();
  Paint(image, color,
    [=](int x, int y)
    {
      const double dx = x - x0;
      const double dy = y - 150.0;
      double depth = 1e9; // distance to the nearest side, positive inside
      for (int i = 0; i < n; ++i)
      {
        const double angle = (2 * i + 1) * pi / n;
        depth =
          std::min(depth, 100 * std::cos(pi / n) - dx * std::cos(angle) - dy * std::sin(angle));
      }
      return smooth ? depth + 0.5 : (depth > 0 ? 1.0 : 0.0);
    });
  return image;
}

/// A 10 x 10 board of cells with black edges; the cell (skipColumn, skipRow) is left out.
Image Board(int skipColumn = -1, int skipRow = -1)
{
  Image image = Blank();
  Paint(image, Blue,
    [=](int x, int y)
    {
      const int column = (x - 20) / 26;
      const int row = (y - 20) / 26;
      const bool on = x >= 20 && y >= 20 && column < 10 && row < 10;
      return on && !(column == skipColumn && row == skipRow);
    });
  Paint(image, Black,
    [=](int x, int y)
    {
      return x >= 20 && y >= 20 && x <= 280 && y <= 280 &&
        ((x - 20) % 26 == 0 || (y - 20) % 26 == 0);
    });
  return image;
}

}

TEST(CompareImages, IdenticalPass_ExactOracle)
{
  const auto difference = CompareImages(Board(), Board());
  EXPECT_TRUE(difference.Within());
  EXPECT_EQ(difference.Share, 0);
  EXPECT_EQ(difference.WorstBlock, 0);
}

TEST(CompareImages, EdgesOfOnePixelPass_PropertyOracle)
{
  EXPECT_TRUE(CompareImages(Polygon(40), Polygon(40, 151)).Within());
  EXPECT_TRUE(CompareImages(Polygon(40), Polygon(40, 150, true)).Within());
  EXPECT_TRUE(CompareImages(Polygon(40, 150, true), Polygon(40, 150.7, true)).Within());
}

TEST(CompareImages, RoundedColorsPass_PropertyOracle)
{
  const Color nearly{ 30, 110, 233 };
  EXPECT_TRUE(CompareImages(Polygon(40), Polygon(40, 150, false, nearly)).Within());
}

TEST(CompareImages, CoarserCircleFails_PropertyOracle)
{
  EXPECT_FALSE(CompareImages(Polygon(8), Polygon(40)).Within());
  EXPECT_FALSE(CompareImages(Polygon(40), Polygon(8)).Within());
  EXPECT_FALSE(CompareImages(Polygon(12), Polygon(40)).Within());
}

TEST(CompareImages, ShiftOfFourPixelsFails_PropertyOracle)
{
  EXPECT_FALSE(CompareImages(Polygon(40), Polygon(40, 154)).Within());
}

TEST(CompareImages, WrongColorFails_PropertyOracle)
{
  EXPECT_FALSE(CompareImages(Polygon(40), Polygon(40, 150, false, Teal)).Within());
}

TEST(CompareImages, MissingCellFails_PropertyOracle)
{
  for (int cell = 0; cell < 100; cell += 11)
  {
    SCOPED_TRACE(cell);
    EXPECT_FALSE(CompareImages(Board(cell % 10, cell / 10), Board()).Within());
    EXPECT_FALSE(CompareImages(Board(), Board(cell % 10, cell / 10)).Within());
  }
}

TEST(CompareImages, MissingThinLineFails_PropertyOracle)
{
  Image line = Board();
  Paint(line, Black, [](int x, int y) { return x == 33 && y > 20 && y < 46; });
  EXPECT_FALSE(CompareImages(line, Board()).Within());
}

TEST(CompareImages, MissingMarkerFailsWhereverItLies_PropertyOracle)
{
  for (int offset = 0; offset < 16; ++offset)
  {
    SCOPED_TRACE(offset);
    Image marked = Blank();
    Paint(marked, Black,
      [=](int x, int y)
      { return x >= 100 + offset && x < 104 + offset && y >= 60 + offset && y < 64 + offset; });
    const auto difference = CompareImages(marked, Blank());
    EXPECT_EQ(difference.WorstBlock, 16);
    EXPECT_FALSE(difference.Within());
  }
}

TEST(CompareImages, OtherSizeAndEmptyFail_PropertyOracle)
{
  Image small = { 2, 1, std::vector<unsigned char>(6, 255) };
  Image turned = { 1, 2, std::vector<unsigned char>(6, 255) };
  EXPECT_FALSE(CompareImages(small, turned).Within());
  EXPECT_FALSE(CompareImages(Image(), Image()).Within());
}

TEST(CompareWithBaseline, MissingFilesAreNamed_PropertyOracle)
{
  const std::string none = std::string(KNOTWORK_OUTPUT_DIR) + "/NoSuchPicture.png";
  EXPECT_NE(knotwork::CompareWithBaseline(none, none).find("no picture at"), std::string::npos);
}
