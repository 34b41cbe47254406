// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineIO/FileFormats.h>

#include <gtest/gtest.h>

#include <set>

using namespace knotwork;

TEST(FileFormats, NoEndingStandsTwiceAndEachIsFound_Property)
{
  std::set<std::string> seen;
  for (const FileFormat& format : FileFormats())
  {
    ASSERT_FALSE(format.Endings.empty()) << format.Name;
    EXPECT_NE(format.Reads | format.Writes, 0U) << format.Name;
    EXPECT_EQ(format.Reads != 0, format.Read != nullptr) << format.Name;
    EXPECT_EQ(format.Writes != 0, format.Write != nullptr) << format.Name;
    for (const std::string& ending : format.Endings)
    {
      EXPECT_TRUE(seen.insert(ending).second) << ending;
      EXPECT_EQ(LowerEnding("file" + ending), ending) << format.Name;
      EXPECT_EQ(FormatOfEnding(ending), &format) << ending;
    }
  }
}

TEST(FileFormats, WhatIsNoFormatIsNotFound_ExactOracle)
{
  for (const char* ending : { "", ".", "vtu", ".VTU", ".vt", ".docx", ".step ", ".vtuu" })
  {
    EXPECT_EQ(FormatOfEnding(ending), nullptr) << ending;
  }
}

/// Which data a file takes are facts of the formats: STL has triangles alone, OFF has no writer,
/// collections are not in one .vtp.
TEST(FileFormats, EndingsFollowTheContent_ExactOracle)
{
  const auto writing = [](unsigned contents) { return JoinEndings(EndingsThatWrite(contents)); };
  EXPECT_EQ(writing(SplineGridContent), ".vtu .pvtu .xml .g2 .step .stp .iges .igs .bext .json");
  EXPECT_EQ(writing(SplineCollectionContent), ".vtpc .xml .g2 .step .stp .iges .igs .bext .json");
  EXPECT_EQ(writing(TrimmedFaceContent), ".vtu .step .stp .iges .igs");
  EXPECT_EQ(writing(PolygonCollectionContent), ".vtpc .stl .obj .ply");
  EXPECT_EQ(writing(PolygonContent), ".vtp .pvtp .stl .obj .ply .mesh .msh");
  EXPECT_EQ(writing(PolylineContent | SplineCurveContent),
    ".vtp .vtu .pvtp .xml .g2 .gpkg .bext .json .mesh .msh");
  EXPECT_EQ(writing(PointContent), ".vtp .pvtp .xyz .txt .csv .g2");
  EXPECT_EQ(writing(ImageContent), ".vti");
  EXPECT_EQ(writing(HeightRasterContent), ".tif .tiff");
  EXPECT_EQ(writing(TableContent), ".csv");
  EXPECT_EQ(writing(0), "");
  EXPECT_EQ(JoinEndings(EndingsThatRead(AnyContent)),
    ".vtp .vtu .pvtu .pvtp .vtpc .vtk .vti .xml .xyz .txt .csv .g2 .step .stp .iges .igs .brep "
    ".stl "
    ".obj .ply .las "
    ".laz .tif .tiff .off .svg "
    ".bext "
    ".json .mesh .msh .inp");
  EXPECT_EQ(JoinEndings(EndingsThatRead(PointContent)),
    ".vtp .pvtp .xyz .txt .csv .g2 .stl .obj .ply .las .laz .tif .tiff .off .svg");
  EXPECT_EQ(writing(GridContent), ".vtu .pvtu .mesh .msh");
}
