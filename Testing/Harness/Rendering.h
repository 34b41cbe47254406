// SPDX-License-Identifier: BSD-3-Clause
// What filter tests call to draw a picture and to compare it with its baseline.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>

class vtkPolyData;
class vtkRenderer;

namespace knotwork
{

/// How RenderAndCompare(vtkPolyData...) draws.
struct RenderOptions
{
  int Size = 300; ///< pixels of each side, at most 400
  std::array<double, 3> From{ 0, 0,
    1 }; ///< direction from the data to the eye; parallel projection, fitted
  std::array<double, 3> Up{ 0, 1, 0 }; ///< not parallel to From
  std::string
    ColorBy;         ///< cell or point array of whole numbers, one bright colour each; empty: blue
  bool Edges = true; ///< black cell edges
};

/// Renders off screen: white background, no multisampling, size x size pixels. The camera is the
/// caller's, or the renderer's own fit. Writes KNOTWORK_OUTPUT_DIR/<name>.png, compares it with
/// KNOTWORK_BASELINE_DIR/<name>.png.
[[nodiscard]] ::testing::AssertionResult RenderAndCompare(
  vtkRenderer* renderer, const std::string& name, int size = 300);

/// The same for one data set in flat colours.
[[nodiscard]] ::testing::AssertionResult RenderAndCompare(
  vtkPolyData* data, const std::string& name, const RenderOptions& options = {});

}
