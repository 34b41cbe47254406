// SPDX-License-Identifier: BSD-3-Clause
#include "FinerSpace.h"
#include "MapCases.h"

#include <gtest/gtest.h>

using namespace knotwork;

namespace
{
template <int Dim>
int LevelAt(const SplineSpace<Dim>& space, const PointMatrix& point)
{
  double local[Dim];
  return space.Elements[static_cast<std::size_t>(space.Locate(point.row(0).data(), local))].Level;
}

PointMatrix Point(double x, double y)
{
  PointMatrix point(1, 2);
  point << x, y;
  return point;
}
}

// Cells of 1/4; the point lies in cell (1, 2), in the lower left of its quarters: (2, 4) of
// level 1. Boxes around it grow to whole cells of level 0.
TEST(FinerSpace, ExtensionCountsCellsOfTheNewLevel_ExactOracle)
{
  const SplineSpacePtr<2> space = cases::IdentityMap<2>(2, 4).Space;
  const PointMatrix point = Point(0.3, 0.6);
  const int refined[] = { 1, 4, 9, 12 }; // [2, 3) x [4, 5), [1, 4) x [3, 6), [0, 5) x [2, 7), ...
  for (int extension = 0; extension < 4; ++extension)
  {
    const auto finer = RefineAround<2>(space, point, extension, 24);
    ASSERT_TRUE(finer);
    EXPECT_EQ(LevelAt(*finer.Value, point), 1);
    EXPECT_EQ(static_cast<int>(finer.Value->Elements.size()), 16 + 3 * refined[extension])
      << extension;
  }
}

TEST(FinerSpace, PointsGoDownLevelByLevel_ExactOracle)
{
  SplineSpacePtr<2> space = cases::IdentityMap<2>(3, 4).Space;
  const PointMatrix point = Point(1.0, 0.0); // a corner belongs to the cell it closes
  for (int level = 1; level <= 3; ++level)
  {
    const auto finer = RefineAround<2>(space, point, 1, 3);
    ASSERT_TRUE(finer);
    EXPECT_EQ(LevelAt(*finer.Value, point), level);
    EXPECT_GT(finer.Value->NumFunctions, space->NumFunctions);
    EXPECT_EQ(LevelAt(*finer.Value, Point(0.0, 1.0)), 0);
    space = finer.Value;
  }
  EXPECT_EQ(RefineAround<2>(space, point, 1, 3).Value, space); // as deep as allowed
  EXPECT_EQ(RefineAround<2>(space, PointMatrix(0, 2), 1, 24).Value, space);
  EXPECT_EQ(RefineAround<2>(space, point, 1, 25).Status.Code, ErrorCode::InvalidParameter);
}

TEST(FinerSpace, InSpaceACellBecomesEight_ExactOracle)
{
  const SplineSpacePtr<3> space = cases::IdentityMap<3>(2, 3).Space;
  PointMatrix points(3, 3);
  points << 0.1, 0.1, 0.1, 0.12, 0.11, 0.1, 0.9, 0.5, 0.5; // two in one cell
  const auto finer = RefineAround<3>(space, points, 0, 24);
  ASSERT_TRUE(finer);
  EXPECT_EQ(finer.Value->Elements.size(), 27u + 2 * 7u);
}

TEST(FinerSpace, EverywhereHalvesEveryCell_ExactOracle)
{
  SplineSpacePtr<2> space = cases::IdentityMap<2>(3, 12).Space;
  for (const int functions : { 27 * 27, 51 * 51, 99 * 99 })
  {
    space = RefineEverywhere<2>(space, 24).Value;
    EXPECT_EQ(space->NumFunctions, functions);
  }
  EXPECT_EQ(RefineEverywhere<2>(space, 3).Value->NumFunctions, 99 * 99);
  EXPECT_EQ(RefineEverywhere<3>(cases::IdentityMap<3>(2, 2).Space, 24).Value->NumFunctions, 216);
}

// Elements of 1/4, 16 of them; cell (1, 2) of level 0 is element 9.
TEST(FinerSpace, HeldElementsAreHalved_ExactOracle)
{
  const SplineSpacePtr<2> space = cases::IdentityMap<2>(2, 4).Space;
  const PointMatrix inside = Point(0.3, 0.6);
  double local[2];
  const int e = space->Locate(inside.row(0).data(), local);
  const int refined[] = { 1, 9, 9, 16 }; // whole cells around [2, 4) x [4, 6) of level 1
  for (int extension = 0; extension < 4; ++extension)
  {
    const auto finer = RefineHeld<2>(space, { e }, extension, 24);
    ASSERT_TRUE(finer);
    EXPECT_EQ(LevelAt(*finer.Value, inside), 1);
    EXPECT_EQ(static_cast<int>(finer.Value->Elements.size()), 16 + 3 * refined[extension])
      << extension;
  }
  EXPECT_EQ(RefineHeld<2>(space, {}, 1, 24).Value, space);
  EXPECT_EQ(RefineHeld<2>(space, { e }, 1, 0).Value, space);
}
