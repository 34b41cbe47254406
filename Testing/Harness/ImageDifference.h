// SPDX-License-Identifier: BSD-3-Clause
// Compares two pictures as an eye would that does not care about a pixel's width.
#pragma once

#include <vector>

namespace knotwork
{

/// Rows of RGB bytes, Width x Height x 3 of them; which row comes first does not matter.
struct Image
{
  int Width = 0;
  int Height = 0;
  std::vector<unsigned char> Rgb;
};

/// How far a picture may be from its baseline. Made for flat bright colours on white, at most 400
/// pixels wide, no multisampling: there, redrawing on another machine moves edges by a pixel and
/// rounds colours by a few steps.
struct ImageLimits
{
  int Channel = 32;    ///< steps of 255 that a colour may be off
  double Share = 5e-4; ///< of all pixels that may differ (45 of 300 x 300)
  int WorstBlock = 12; ///< pixels that may differ in any 16 x 16 block: fewer than a 4 x 4 marker
};

/// What two pictures differ in.
struct ImageDifference
{
  bool SameSize = false;
  double Share = 1;     ///< differing pixels / all pixels
  int WorstBlock = 256; ///< differing pixels in the worst 16 x 16 block
  int BlockColumn = 0;  ///< first column and row of that block
  int BlockRow = 0;
  std::vector<bool> Differs; ///< one a pixel; empty when the sizes differ

  /// True when the difference is within the limits.
  [[nodiscard]] bool Within(const ImageLimits& limits = {}) const;
};

/// A pixel differs when its colour lies more than limits.Channel outside the range that the other
/// picture's colours have in the 3 x 3 pixels around it, in any channel, in either direction. So
/// edges may move by one pixel and be smoothed differently, but nothing may be missing, added, or
/// of another colour.
/// @complexity O(pixels)
[[nodiscard]] ImageDifference CompareImages(
  const Image& image, const Image& baseline, const ImageLimits& limits = {});

}
