// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineIO/PlyPoints.h>
#include <knotwork/SplineIO/PointStream.h>
#include <knotwork/SplineIO/PointText.h>
#include <knotwork/SplineIO/TileIndex.h>

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <cstring>
#include <random>

using namespace knotwork;

namespace
{
ByteSource Source(const std::string& bytes)
{
  return { bytes.size(),
    [&bytes](std::uint64_t at, char* to, std::size_t count)
    {
      EXPECT_LE(at + count, bytes.size());
      std::memcpy(to, bytes.data() + at, count);
      return true;
    } };
}

/// All blocks of a stream as a file of its records.
Result<std::string> Copied(const std::string& ending, const std::string& bytes)
{
  const ByteSource source = Source(bytes);
  auto stream = OpenPointStream(ending, source, 2);
  if (!stream)
  {
    return stream.Status;
  }
  PointSummary summary;
  std::string records;
  PointBlock block;
  Status status;
  while ((status = stream.Value->Next(block)) && block.Count > 0)
  {
    for (std::size_t i = 0; i < block.Count; ++i)
    {
      summary.Add(block.Positions.data() + 3 * i, 1);
    }
    records.append(block.Records, block.Count * stream.Value->RecordBytes);
  }
  return status ? Result<std::string>(stream.Value->Head(summary) + records)
                : Result<std::string>(status);
}

const std::string Rows = "0.1 2 -3 7\n1e5 0.25 4 8\n5 6 1e-300 0.3\n";
const std::string AsciiPly =
  "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
  "property double z\nproperty float heat\nelement face 1\n"
  "property list uchar int vertex_indices\nend_header\n";
}

TEST(PointStream, RecordsAreTheNumbersOfTheFile_CrossOracle)
{
  std::mt19937 random(3);
  std::string lines = "x,y,z,heat\n";
  while (lines.size() < (std::size_t{ 1 } << 25U)) // more than a block
  {
    lines += std::to_string(random()) + ".5," + std::to_string(random()) + ",0.125,17\n";
  }
  const auto whole = ReadPointText(lines);
  ASSERT_TRUE(whole) << whole.Status.Message();
  const auto copy = Copied(".csv", lines);
  ASSERT_TRUE(copy) << copy.Status.Message();
  const auto again = ReadPly(copy.Value);
  ASSERT_TRUE(again) << again.Status.Message();
  EXPECT_EQ(again->Points, whole->Points);
  EXPECT_EQ(again->Channels, whole->Channels);
  EXPECT_EQ(again->Names, whole->Names);
}

TEST(PointStream, PlyOfEveryEncodingIsTheSame_CrossOracle)
{
  const std::string text = AsciiPly + Rows + "3 0 1 2\n";
  const auto whole = ReadPly(text);
  ASSERT_TRUE(whole) << whole.Status.Message();
  const auto copy = Copied(".ply", text); // binary, which is copied once more
  ASSERT_TRUE(copy) << copy.Status.Message();
  const auto twice = Copied(".ply", copy.Value);
  ASSERT_TRUE(twice) << twice.Status.Message();
  EXPECT_EQ(twice.Value, copy.Value);
  const auto again = ReadPly(twice.Value);
  ASSERT_TRUE(again) << again.Status.Message();
  EXPECT_EQ(again->Points, whole->Points);
  EXPECT_EQ(again->Channels, whole->Channels);
}

TEST(PointStream, DamageIsNamedWithItsPlace_GoldenOracle)
{
  std::string lines = "# x y z\n";
  while (lines.size() < (std::size_t{ 1 } << 24U) + 1000)
  {
    lines += "0.5 0.25 1\n";
  }
  const auto count = std::count(lines.begin(), lines.end(), '\n');
  const struct
  {
    const char* Ending;
    std::string Bytes;
    ErrorCode Code;
    std::string Words;
  } cases[] = {
    { ".xyz", lines + "0.5 abc 1\n", ErrorCode::InvalidFormat,
      "line " + std::to_string(count + 1) + ", column 2" },
    { ".xyz", lines + "0.5 1\n", ErrorCode::InvalidFormat, "line " + std::to_string(count + 1) },
    { ".xyz", "1 2 inf\n", ErrorCode::NonFiniteInput, "line 1, column 3" },
    { ".xyz", "1 2 3 " + std::string(std::size_t{ 1 } << 25U, '1'), ErrorCode::InvalidFormat,
      "longer than 16 MB" },
    { ".xyz", "", ErrorCode::EmptyInput, "no points" },
    { ".ply", AsciiPly + "0 0 0 0.000001\n1 1 1 1.000001\n", ErrorCode::InvalidFormat,
      "1 of 3 points" },
    { ".ply", AsciiPly, ErrorCode::InvalidFormat, "3 vertices" },
    { ".ply", "ply\nformat ascii 1.0\nelement face 0\nend_header\n", ErrorCode::InvalidFormat,
      "do not come first" },
    { ".ply", AsciiPly + "0 0 0 0\n1 nan 1 1\n2 2 2 2\n", ErrorCode::NonFiniteInput, "line 12" },
    { ".vtp", "", ErrorCode::InvalidParameter, "convert" },
    { ".las", "LASF", ErrorCode::InvalidFormat, "truncated" },
  };
  for (const auto& one : cases)
  {
    const auto copy = Copied(one.Ending, one.Bytes);
    EXPECT_EQ(copy.Status.Code, one.Code) << copy.Status.Message();
    EXPECT_NE(copy.Status.Detail.find(one.Words), std::string::npos) << copy.Status.Message();
  }
}

TEST(TileGrid, EveryCoordinateLiesBetweenTheEdgesOfItsTile_PropertyOracle)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 100000; ++i)
  {
    TileGrid grid;
    grid.Size = { std::pow(10.0, 3.0 * uniform(random)), 1.0 };
    grid.Origin = { 1e6 * uniform(random), 0.0 };
    const double x = i % 3 == 0 ? grid.Edge(0, static_cast<int>(random() % 2000) - 1000)
                                : grid.Origin[0] + 1000.0 * grid.Size[0] * uniform(random);
    const int number = grid.Number(0, x);
    EXPECT_LE(grid.Edge(0, number), x) << i;
    EXPECT_LT(x, grid.Edge(0, number + 1)) << i;
    EXPECT_TRUE(grid.IsNear(0, number, x));
  }
}

namespace
{
TileIndex MakeIndex()
{
  TileIndex index;
  index.Grid.Origin = { 0.1, -1e6 / 3.0 };
  index.Grid.Size = { 1.0 / 3.0, 2.0 };
  index.Grid.Halo = { 0.1, 0.0 };
  index.Grid.First = { 0, 0 };
  index.Grid.Last = { 1, 0 };
  index.Lower = { 0.1, -1e6 / 3.0 - 0.5, 0.0 };
  index.Upper = { 0.7, -1e6 / 3.0 + 0.7, 1.0 };
  index.NumPoints = 7;
  index.ReferenceSystem = "LOCAL_CS[\"site\"]";
  for (int column = 0; column < 2; ++column)
  {
    CloudTile tile;
    tile.File = "scan/tile-" + std::to_string(column) + "-0.las";
    tile.Number = { column, 0 };
    tile.Box.Lower = { column == 0 ? 0.1 : index.Grid.Edge(0, 1), index.Lower[1] };
    tile.Box.Upper = { column == 0 ? index.Grid.Edge(0, 1) : 0.7, index.Upper[1] };
    tile.NumPoints = 3 + static_cast<std::uint64_t>(column);
    tile.NumNeighbours = 1;
    tile.Checksum = "00ff";
    index.Tiles.push_back(tile);
  }
  return index;
}

TileIndex Reversed(TileIndex index)
{
  std::reverse(index.Tiles.begin(), index.Tiles.end());
  return index;
}

std::string With(std::string text, const std::string& part, const std::string& replacement)
{
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), replacement);
}
}

TEST(TileIndex, ComesBackBitForBit_PropertyOracle)
{
  const std::string text = WriteTileIndex(MakeIndex());
  const auto index = ReadTileIndex(text);
  ASSERT_TRUE(index) << index.Status.Message();
  EXPECT_EQ(WriteTileIndex(index.Value), text);
  EXPECT_EQ(index->Grid.Size, MakeIndex().Grid.Size);
  EXPECT_EQ(index->Tiles[1].Checksum, "00ff");
  EXPECT_EQ(index->Tiles[1].Box.Lower, MakeIndex().Tiles[1].Box.Lower);
}

TEST(TileIndex, DamageIsNamed_GoldenOracle)
{
  const std::string good = WriteTileIndex(MakeIndex());
  const std::pair<std::string, const char*> cases[] = {
    { "", "no index of tiles" },
    { "[1, 2]", "no index of tiles" },
    { With(good, "knotwork tiles", "others"), "no index of tiles" },
    { good.substr(0, good.size() / 2), "no index of tiles" },
    { With(good, "\"version\": 1", "\"version\": 2"), "'version' is not 1" },
    { With(good, "\"points\": 7", "\"points\": \"seven\""), "'points' is missing" },
    { With(good, "\"points\": 7", "\"points\": 8"), "have 7 points, the index tells 8" },
    { With(good, "\"tile_size\"", "\"size\""), "'tile_size' is missing" },
    { With(good, "\"tiles\": [", "\"others\": ["), "'tiles' is missing" },
    { With(good, "scan/tile-0", "../tile-0"), "tile 0: 'file' does not lie beside" },
    { With(good, "scan/tile-1", "/tile-1"), "tile 1: 'file' does not lie beside" },
    { With(good, "\"checksum\": \"00ff\"", "\"sum\": 0"), "tile 0: 'checksum' is missing" },
    { With(good, "\"column\": 1", "\"column\": 0"), "tile 1: 'box'" },
    { WriteTileIndex(Reversed(MakeIndex())), "row by row" },
  };
  for (const auto& [text, words] : cases)
  {
    const auto index = ReadTileIndex(text);
    EXPECT_EQ(index.Status.Code, ErrorCode::InvalidFormat);
    EXPECT_NE(index.Status.Detail.find(words), std::string::npos)
      << index.Status.Detail << " lacks " << words;
  }
}
