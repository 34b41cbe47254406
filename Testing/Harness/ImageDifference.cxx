// SPDX-License-Identifier: BSD-3-Clause
#include "ImageDifference.h"

#include <algorithm>

namespace knotwork
{

namespace
{

constexpr int BlockSize = 16;
constexpr int BlockStride =
  4; // blocks overlap, so that none of the limits depends on where a detail lies

/// Marks the pixels of `image` whose colour is foreign to the neighbourhood in `other`.
void MarkForeignPixels(
  const Image& image, const Image& other, int tolerance, std::vector<bool>& differs)
{
  for (int row = 0; row < image.Height; ++row)
  {
    for (int column = 0; column < image.Width; ++column)
    {
      const int pixel = row * image.Width + column;
      for (int channel = 0; channel < 3; ++channel)
      {
        int low = 255;
        int high = 0;
        for (int r = std::max(row - 1, 0); r <= std::min(row + 1, image.Height - 1); ++r)
        {
          for (int c = std::max(column - 1, 0); c <= std::min(column + 1, image.Width - 1); ++c)
          {
            const int value = other.Rgb[3 * (r * image.Width + c) + channel];
            low = std::min(low, value);
            high = std::max(high, value);
          }
        }
        const int value = image.Rgb[3 * pixel + channel];
        if (value < low - tolerance || value > high + tolerance)
        {
          differs[pixel] = true;
        }
      }
    }
  }
}

}

bool ImageDifference::Within(const ImageLimits& limits) const
{
  return this->SameSize && this->Share <= limits.Share && this->WorstBlock <= limits.WorstBlock;
}

ImageDifference CompareImages(const Image& image, const Image& baseline, const ImageLimits& limits)
{
  ImageDifference result;
  const int pixels = image.Width * image.Height;
  if (image.Width != baseline.Width || image.Height != baseline.Height || pixels == 0)
  {
    return result;
  }
  result.SameSize = true;
  result.Differs.assign(pixels, false);
  MarkForeignPixels(image, baseline, limits.Channel, result.Differs);
  MarkForeignPixels(baseline, image, limits.Channel, result.Differs);

  result.Share =
    static_cast<double>(std::count(result.Differs.begin(), result.Differs.end(), true)) / pixels;
  result.WorstBlock = 0;
  for (int row = 0; row < image.Height; row += BlockStride)
  {
    for (int column = 0; column < image.Width; column += BlockStride)
    {
      int count = 0;
      for (int r = row; r < std::min(row + BlockSize, image.Height); ++r)
      {
        const auto first = result.Differs.begin() + r * image.Width;
        count += static_cast<int>(
          std::count(first + column, first + std::min(column + BlockSize, image.Width), true));
      }
      if (count > result.WorstBlock)
      {
        result.WorstBlock = count;
        result.BlockColumn = column;
        result.BlockRow = row;
      }
    }
  }
  return result;
}

}
