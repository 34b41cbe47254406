// SPDX-License-Identifier: BSD-3-Clause
#include "TileIndex.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace knotwork
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr const char* Kind = "knotwork tiles";
constexpr int Version = 1;

/// Reads members of an object; the first failure is kept.
class Members
{
public:
  Members(const Json& object, std::string place) : Object(object), Place(std::move(place)) {}

  template <typename T>
  void Get(const char* key, T& value)
  {
    try
    {
      value = this->Object.at(key).get<T>();
    }
    catch (const Json::exception&)
    {
      this->Fail(key, "is missing or of another type");
    }
  }

  template <std::size_t N>
  void GetNumbers(const char* key, std::array<double, N>& values)
  {
    this->Get(key, values);
    for (const double value : values)
    {
      if (!std::isfinite(value))
      {
        this->Fail(key, "is not finite");
      }
    }
  }

  void Fail(const std::string& key, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { ErrorCode::InvalidFormat,
        this->Place + "'" + key + "' " + what + "; make the tiles again" };
    }
  }

  Status Outcome;

private:
  const Json& Object;
  std::string Place;
};

/// A path below the index's folder.
bool LiesBeside(const std::string& file)
{
  return !file.empty() && file.front() != '/' && file.find("..") == std::string::npos &&
    file.find('\0') == std::string::npos;
}

Result<CloudTile> ReadTile(const Json& object, std::size_t number, const TileIndex& index)
{
  Members members(object, "tile " + std::to_string(number) + ": ");
  CloudTile tile;
  std::array<double, 4> box{};
  members.Get("file", tile.File);
  members.Get("column", tile.Number[0]);
  members.Get("row", tile.Number[1]);
  members.GetNumbers("box", box);
  members.Get("points", tile.NumPoints);
  members.Get("neighbours", tile.NumNeighbours);
  members.Get("checksum", tile.Checksum);
  tile.Box = { { box[0], box[2] }, { box[1], box[3] } };
  if (members.Outcome && !LiesBeside(tile.File))
  {
    members.Fail("file", "does not lie beside the index");
  }
  for (std::size_t d = 0; d < 2 && members.Outcome; ++d)
  {
    const TileGrid& grid = index.Grid;
    const int n = tile.Number[d];
    const bool isThere = n >= grid.First[d] && n <= grid.Last[d];
    const double lower = n == grid.First[d] ? index.Lower[d] : grid.Edge(d, n);
    const double upper = n == grid.Last[d] ? index.Upper[d] : grid.Edge(d, n + 1);
    if (!isThere || tile.Box.Lower[d] != lower || tile.Box.Upper[d] != upper || !(lower < upper))
    {
      members.Fail("box", "is not that of its column and row");
    }
  }
  return members.Outcome ? Result<CloudTile>(std::move(tile)) : Result<CloudTile>(members.Outcome);
}
}

int TileGrid::Number(std::size_t direction, double x) const
{
  const double guess = std::floor((x - this->Origin[direction]) / this->Size[direction]);
  int number = static_cast<int>(
    std::clamp(guess, static_cast<double>(-Farthest), static_cast<double>(Farthest)));
  // the edges decide, not the quotient's rounding
  number -= x < this->Edge(direction, number) ? 1 : 0;
  number += x >= this->Edge(direction, number + 1) ? 1 : 0;
  return std::clamp(number, this->First[direction], this->Last[direction]);
}

std::string WriteTileIndex(const TileIndex& index)
{
  Json json;
  json["format"] = Kind;
  json["version"] = Version;
  json["points"] = index.NumPoints;
  json["lower"] = index.Lower;
  json["upper"] = index.Upper;
  json["origin"] = index.Grid.Origin;
  json["tile_size"] = index.Grid.Size;
  json["halo"] = index.Grid.Halo;
  json["first"] = index.Grid.First;
  json["last"] = index.Grid.Last;
  json["reference_system"] = index.ReferenceSystem;
  json["tiles"] = Json::array();
  for (const CloudTile& tile : index.Tiles)
  {
    json["tiles"].push_back(
      { { "file", tile.File }, { "column", tile.Number[0] }, { "row", tile.Number[1] },
        { "box", { tile.Box.Lower[0], tile.Box.Upper[0], tile.Box.Lower[1], tile.Box.Upper[1] } },
        { "points", tile.NumPoints }, { "neighbours", tile.NumNeighbours },
        { "checksum", tile.Checksum } });
  }
  // not all text of a file is UTF-8
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<TileIndex> ReadTileIndex(std::string_view text)
{
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("format") || json["format"] != Kind)
  {
    return { ErrorCode::InvalidFormat,
      "it is no index of tiles; the job `tiles` makes one of a cloud" };
  }
  Members members(json, "");
  TileIndex index;
  int version = 0;
  members.Get("version", version);
  if (version != Version)
  {
    members.Fail("version", "is not " + std::to_string(Version));
  }
  members.Get("points", index.NumPoints);
  members.GetNumbers("lower", index.Lower);
  members.GetNumbers("upper", index.Upper);
  members.GetNumbers("origin", index.Grid.Origin);
  members.GetNumbers("tile_size", index.Grid.Size);
  members.GetNumbers("halo", index.Grid.Halo);
  members.Get("first", index.Grid.First);
  members.Get("last", index.Grid.Last);
  members.Get("reference_system", index.ReferenceSystem);
  for (std::size_t d = 0; d < 2; ++d)
  {
    const TileGrid& grid = index.Grid;
    if (members.Outcome &&
      !(grid.Size[d] > 0.0 && grid.Halo[d] >= 0.0 && grid.Halo[d] <= grid.Size[d] / 2 &&
        grid.First[d] >= -TileGrid::Farthest && grid.Last[d] <= TileGrid::Farthest &&
        grid.First[d] <= grid.Last[d]))
    {
      members.Fail("tile_size", "does not go with 'halo', 'first' and 'last'");
    }
  }
  if (members.Outcome && (!json.contains("tiles") || !json["tiles"].is_array()))
  {
    members.Fail("tiles", "is missing");
  }
  if (!members.Outcome)
  {
    return members.Outcome;
  }
  std::uint64_t points = 0;
  bool isSorted = true; // so no place is there twice
  for (const Json& object : json["tiles"])
  {
    auto tile = ReadTile(object, index.Tiles.size(), index);
    if (!tile)
    {
      return tile.Status;
    }
    points += tile->NumPoints;
    if (!index.Tiles.empty())
    {
      const IntArray<2>& last = index.Tiles.back().Number;
      isSorted = isSorted &&
        std::make_pair(last[1], last[0]) < std::make_pair(tile->Number[1], tile->Number[0]);
    }
    index.Tiles.push_back(std::move(tile.Value));
  }
  if (!isSorted)
  {
    return { ErrorCode::InvalidFormat,
      "its tiles do not stand row by row, each once; make the tiles again" };
  }
  if (index.Tiles.empty() || points != index.NumPoints)
  {
    return { ErrorCode::InvalidFormat,
      "its " + std::to_string(index.Tiles.size()) + " tiles have " + std::to_string(points) +
        " points, the index tells " + std::to_string(index.NumPoints) + "; make the tiles again" };
  }
  return index;
}
}
