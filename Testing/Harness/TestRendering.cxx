// SPDX-License-Identifier: BSD-3-Clause
// Rendering and comparison together, on the display that tests have.
#include "Baselines.h"
#include "Rendering.h"

#include <vtkNew.h>
#include <vtkRegularPolygonSource.h>

#include <filesystem>
#include <fstream>

namespace
{

namespace fs = std::filesystem;

vtkNew<vtkRegularPolygonSource> Polygon(int sides)
{
  vtkNew<vtkRegularPolygonSource> polygon;
  polygon->SetNumberOfSides(sides);
  polygon->Update();
  return polygon;
}

}

TEST(RenderAndCompare, CircleAgreesAndOctagonFails_GoldenOracle)
{
  EXPECT_TRUE(knotwork::RenderAndCompare(Polygon(40)->GetOutput(), "HarnessCircle"));

  // The octagon in the circle's place: refused, marked as such, with a picture of the difference.
  const fs::path folder = fs::path(KNOTWORK_OUTPUT_DIR) / "HarnessOctagon";
  fs::create_directories(folder);
  EXPECT_FALSE(knotwork::RenderAndCompare(Polygon(8)->GetOutput(), "HarnessOctagon/Octagon"))
    << "there is no such baseline";
  const std::string octagon = (folder / "Octagon.png").string();
  const std::string circle = std::string(KNOTWORK_BASELINE_DIR) + "/HarnessCircle.png";
  EXPECT_NE(knotwork::CompareWithBaseline(octagon, circle).find("differs from"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "Octagon.rejected"));
  EXPECT_TRUE(fs::exists(folder / "Octagon.difference.png"));

  // A picture that agrees again takes the marks away.
  fs::copy_file(circle, octagon, fs::copy_options::overwrite_existing);
  EXPECT_EQ(knotwork::CompareWithBaseline(octagon, circle), "");
  EXPECT_FALSE(fs::exists(folder / "Octagon.rejected"));
  EXPECT_FALSE(fs::exists(folder / "Octagon.difference.png"));
}
