// SPDX-License-Identifier: BSD-3-Clause
#include "CloudTiles.h"

#include "FileText.h"
#include "RasterPoints.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <numeric>
#include <system_error>

namespace fs = std::filesystem;

namespace knotwork
{
namespace
{
constexpr std::size_t MostTiles = 100000;

Status About(const std::string& file, const Status& status)
{
  return { status.Code, "'" + file + "': " + status.Detail };
}

/// A file as bytes that are read when they are needed.
class FileSource
{
public:
  explicit FileSource(const std::string& file) : Stream(file, std::ios::binary | std::ios::ate)
  {
    std::error_code ignored;
    const bool isFile = this->Stream && fs::is_regular_file(file, ignored);
    if (!isFile)
    {
      this->Outcome = { ErrorCode::FileError,
        "'" + file + "' cannot be read; check its name and permissions" };
      return;
    }
    this->Bytes.Size = static_cast<std::uint64_t>(this->Stream.tellg());
    this->Bytes.Read = [this](std::uint64_t at, char* to, std::size_t count)
    {
      this->Stream.seekg(static_cast<std::streamoff>(at));
      this->Stream.read(to, static_cast<std::streamsize>(count));
      return static_cast<bool>(this->Stream);
    };
  }

  ByteSource Bytes;
  Status Outcome;

private:
  std::ifstream Stream;
};

/// A tile whose file grows.
struct GrowingTile
{
  fs::path File;
  std::uint64_t NumPoints = 0; ///< that belong to it
  PointSummary All;            ///< of the file
  std::uint64_t Checksum = 14695981039346656037ULL;
  std::size_t Place = 0; ///< among all tiles
  bool IsBegun = false;
};

/// FNV-1a of the coordinates' bits, a number at a time.
void AddToChecksum(const double* position, std::uint64_t& sum)
{
  std::array<std::uint64_t, 3> bits{};
  std::memcpy(bits.data(), position, sizeof(bits));
  for (const std::uint64_t each : bits)
  {
    sum = (sum ^ each) * 1099511628211ULL;
    sum ^= sum >> 32; // a product's upper bits never reach the lower ones
  }
}

std::string HexadecimalOf(std::uint64_t number)
{
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(number));
  return text.data();
}

Status CannotWrite(const fs::path& file)
{
  return { ErrorCode::FileError,
    "'" + file.string() +
      "' cannot be written: " + std::generic_category().message(errno != 0 ? errno : EIO) };
}

class Splitter
{
public:
  Splitter(PointStream& stream, fs::path folder, const SplitParams& params, const TileGrid& grid)
    : Stream(stream), Folder(std::move(folder)), Params(params), Grid(grid)
  {
  }

  Status Split()
  {
    constexpr std::size_t most = 9; // tiles that a point is given to
    this->Waiting.reserve(this->Params.BufferBytes + most * this->Stream.RecordBytes);
    PointBlock block;
    while (true)
    {
      Status status = this->Stream.Next(block);
      if (!status || block.Count == 0)
      {
        return status;
      }
      for (std::size_t i = 0; i < block.Count && status; ++i)
      {
        status =
          this->Add(block.Positions.data() + 3 * i, block.Records + i * this->Stream.RecordBytes);
      }
      if (!status)
      {
        return status;
      }
    }
  }

  /// Ends the files and says what they hold.
  Result<TileIndex> Finish()
  {
    if (this->All.Count == 0)
    {
      return { ErrorCode::EmptyInput, "it holds no points" };
    }
    Status status = this->Flush();
    status = status ? this->TrimGrid() : status;
    TileIndex index;
    index.Grid = this->Grid;
    index.Lower = this->All.Lower;
    index.Upper = this->All.Upper;
    index.ReferenceSystem = this->Stream.ReferenceSystem;
    this->JoinOuterTiles();
    for (auto& [number, tile] : this->Tiles)
    {
      if (status && tile.NumPoints > 0)
      {
        status = this->FinishTile({ number.second, number.first }, tile, index);
      }
      else if (tile.IsBegun)
      {
        std::error_code ignored;
        fs::remove(tile.File, ignored); // neighbours' points alone
      }
    }
    const bool isWhole = index.NumPoints == this->All.Count &&
      (this->Stream.NumPoints == 0 || index.NumPoints == this->Stream.NumPoints);
    if (status && !isWhole)
    {
      status = { ErrorCode::InvalidTopology,
        "its tiles have " + std::to_string(index.NumPoints) + " points, it has " +
          std::to_string(std::max(this->Stream.NumPoints, this->All.Count)) +
          "; do not use the tiles" };
    }
    return status ? Result<TileIndex>(std::move(index)) : Result<TileIndex>(status);
  }

private:
  Status Add(const double* position, const char* record)
  {
    IntArray<2> number{};
    for (std::size_t d = 0; d < 2; ++d)
    {
      number[d] = this->Grid.Number(d, position[d]);
      // also where the numbers are so large that neighbours begin at the same place
      if (std::abs(number[d]) >= TileGrid::Farthest ||
        !(this->Grid.Edge(d, number[d]) < this->Grid.Edge(d, number[d] + 1)))
      {
        return { ErrorCode::OutsideDomain,
          "point " + std::to_string(this->All.Count) + " at " + PointText(position, 3) +
            " is too far away for tiles of " + Digits(this->Grid.Size[d]) +
            "; remove it, or choose larger tiles" };
      }
    }
    const unsigned returned = this->Stream.ReturnMask == 0
      ? 0U
      : static_cast<unsigned char>(record[14]) & this->Stream.ReturnMask;
    this->All.Add(position, returned);
    for (int row = number[1] - 1; row <= number[1] + 1; ++row)
    {
      for (int column = number[0] - 1; column <= number[0] + 1; ++column)
      {
        const bool isOwn = row == number[1] && column == number[0];
        if (!isOwn &&
          !(this->Grid.IsNear(0, column, position[0]) && this->Grid.IsNear(1, row, position[1])))
        {
          continue;
        }
        GrowingTile* tile = this->Find({ row, column });
        if (!tile)
        {
          return { ErrorCode::TooLarge,
            "it would become more than " + std::to_string(MostTiles) +
              " tiles; choose larger ones" };
        }
        tile->NumPoints += isOwn ? 1 : 0;
        tile->All.Add(position, returned);
        AddToChecksum(position, tile->Checksum);
        this->Waiting.append(record, this->Stream.RecordBytes);
        this->Owners.push_back(tile);
      }
    }
    return this->Waiting.size() < this->Params.BufferBytes ? Status() : this->Flush();
  }

  /// A tile by row and column; null: there are too many.
  GrowingTile* Find(const std::pair<int, int>& number)
  {
    if (this->Latest && this->LatestNumber == number)
    {
      return this->Latest;
    }
    auto found = this->Tiles.find(number);
    if (found == this->Tiles.end())
    {
      if (this->Tiles.size() >= MostTiles)
      {
        return nullptr;
      }
      found = this->Tiles.emplace(number, GrowingTile()).first;
      found->second.Place = this->Tiles.size() - 1;
      found->second.File =
        this->Folder / ("part-" + std::to_string(this->Tiles.size()) + this->Stream.Ending);
    }
    this->LatestNumber = number;
    this->Latest = &found->second;
    return this->Latest;
  }

  /// What waits goes into the files, one after the other: not many files are open.
  Status Flush()
  {
    // records by their tiles, in the order in which they came
    std::vector<std::size_t> ends(this->Tiles.size() + 1, 0);
    for (const GrowingTile* owner : this->Owners)
    {
      ++ends[owner->Place + 1];
    }
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    std::vector<std::uint32_t> order(this->Owners.size());
    std::vector<std::size_t> next(ends.begin(), ends.end() - 1);
    for (std::size_t i = 0; i < this->Owners.size(); ++i)
    {
      order[next[this->Owners[i]->Place]++] = static_cast<std::uint32_t>(i);
    }
    const std::size_t bytes = this->Stream.RecordBytes;
    std::string records;
    for (std::size_t begin = 0; begin < order.size();)
    {
      GrowingTile& tile = *this->Owners[order[begin]];
      records.clear();
      for (; begin < ends[tile.Place + 1]; ++begin)
      {
        records.append(this->Waiting, order[begin] * bytes, bytes);
      }
      if (Status status = this->Append(records, tile); !status)
      {
        return status;
      }
    }
    this->Waiting.clear();
    this->Owners.clear();
    return {};
  }

  Status Append(const std::string& records, GrowingTile& tile) const
  {
    errno = 0;
    std::ofstream stream(tile.File, std::ios::binary | std::ios::app);
    if (!tile.IsBegun)
    {
      stream << this->Stream.Head({}); // its length counts, the numbers follow
      tile.IsBegun = true;
    }
    stream.write(records.data(), static_cast<std::streamsize>(records.size()));
    stream.close();
    return stream ? Status() : CannotWrite(tile.File);
  }

  /// Ends the grid with the points. An outermost tile that they fill by no more than the halo is
  /// left out: the file of its neighbour has its points.
  Status TrimGrid()
  {
    IntArray<2> first{ TileGrid::Farthest, TileGrid::Farthest };
    IntArray<2> last{ -TileGrid::Farthest, -TileGrid::Farthest };
    for (const auto& [number, tile] : this->Tiles)
    {
      const IntArray<2> own{ number.second, number.first };
      for (std::size_t d = 0; d < 2 && tile.NumPoints > 0; ++d)
      {
        first[d] = std::min(first[d], own[d]);
        last[d] = std::max(last[d], own[d]);
      }
    }
    for (std::size_t d = 0; d < 2; ++d)
    {
      if (!(this->All.Lower[d] < this->All.Upper[d]))
      {
        return { ErrorCode::InvalidTopology,
          std::string("its points have no area: all have the same ") + (d == 0 ? "x" : "y") };
      }
      const double halo = this->Grid.Halo[d];
      if (first[d] < last[d] && this->All.Upper[d] <= this->Grid.Edge(d, last[d]) + halo)
      {
        --last[d];
      }
      if (first[d] < last[d] && this->All.Lower[d] >= this->Grid.Edge(d, first[d] + 1) - halo)
      {
        ++first[d];
      }
      this->Grid.First[d] = first[d];
      this->Grid.Last[d] = last[d];
    }
    return {};
  }

  /// Points of tiles that the grid has no longer belong to its outermost ones.
  void JoinOuterTiles()
  {
    const TileGrid& grid = this->Grid;
    for (auto& [number, tile] : this->Tiles)
    {
      const std::pair<int, int> kept{ std::clamp(number.first, grid.First[1], grid.Last[1]),
        std::clamp(number.second, grid.First[0], grid.Last[0]) };
      if (kept != number && tile.NumPoints > 0)
      {
        this->Tiles[kept].NumPoints += tile.NumPoints;
        tile.NumPoints = 0;
      }
    }
  }

  Status FinishTile(const IntArray<2>& number, GrowingTile& tile, TileIndex& index)
  {
    const std::string head = this->Stream.Head(tile.All);
    errno = 0;
    std::fstream stream(tile.File, std::ios::binary | std::ios::in | std::ios::out);
    stream.write(head.data(), static_cast<std::streamsize>(head.size()));
    stream.close();
    if (!stream)
    {
      return CannotWrite(tile.File);
    }
    std::error_code error;
    if (fs::file_size(tile.File, error) != head.size() + tile.All.Count * this->Stream.RecordBytes)
    {
      return { ErrorCode::InvalidTopology,
        "'" + tile.File.string() + "' has not the size of its " + std::to_string(tile.All.Count) +
          " points; check the disk" };
    }
    const std::string name = "tile-" + std::to_string(number[0] - index.Grid.First[0]) + "-" +
      std::to_string(number[1] - index.Grid.First[1]) + this->Stream.Ending;
    fs::rename(tile.File, this->Folder / name, error);
    if (error)
    {
      return { ErrorCode::FileError,
        "'" + (this->Folder / name).string() + "' cannot be written: " + error.message() };
    }
    CloudTile done;
    done.File = this->Folder.filename().string() + "/" + name;
    done.Number = number;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const TileGrid& grid = index.Grid;
      done.Box.Lower[d] = number[d] == grid.First[d] ? index.Lower[d] : grid.Edge(d, number[d]);
      done.Box.Upper[d] = number[d] == grid.Last[d] ? index.Upper[d] : grid.Edge(d, number[d] + 1);
    }
    done.NumPoints = tile.NumPoints;
    done.NumNeighbours = tile.All.Count - tile.NumPoints;
    done.Checksum = HexadecimalOf(tile.Checksum);
    index.NumPoints += tile.NumPoints;
    index.Tiles.push_back(std::move(done));
    return {};
  }

  PointStream& Stream;
  fs::path Folder;
  const SplitParams& Params;
  TileGrid Grid;
  std::map<std::pair<int, int>, GrowingTile> Tiles; ///< by row and column
  std::pair<int, int> LatestNumber;
  GrowingTile* Latest = nullptr;
  std::string Waiting;              ///< records that are not in their files yet
  std::vector<GrowingTile*> Owners; ///< of these records
  PointSummary All;
};

/// Where the tiles are, before the points are known.
Result<TileGrid> MakeGrid(const PointStream& stream, const SplitParams& params)
{
  TileGrid grid;
  RealArray<2> extent{};
  bool hasBox = stream.HasBox;
  for (std::size_t d = 0; d < 2; ++d)
  {
    extent[d] = stream.Upper[d] - stream.Lower[d];
    hasBox = hasBox && std::isfinite(extent[d]) && extent[d] > 0.0;
  }
  if (!hasBox && params.TileSize == 0.0)
  {
    return { ErrorCode::InvalidParameter,
      "it does not tell the box of its points; give the size of the tiles (--tile-size)" };
  }
  const std::uint64_t points = std::max(stream.NumPoints, stream.MostPoints);
  const double tiles =
    std::max(1.0, static_cast<double>(points) / static_cast<double>(params.PointsPerTile));
  const double size =
    params.TileSize > 0.0 ? params.TileSize : std::sqrt(extent[0] / tiles * extent[1]);
  for (std::size_t d = 0; d < 2; ++d)
  {
    grid.Size[d] = size;
    if (hasBox)
    {
      grid.Size[d] = extent[d] / std::max(1.0, std::round(extent[d] / size));
      grid.Origin[d] = stream.Lower[d];
    }
    grid.Halo[d] = params.Halo * grid.Size[d];
    if (!(grid.Size[d] > 0.0) || !std::isfinite(grid.Size[d]))
    {
      return { ErrorCode::InvalidParameter,
        "tiles of " + Digits(size) + " do not divide its box; choose another size" };
    }
  }
  return grid;
}

Result<SplitCloud> Split(const std::string& file, const fs::path& folder, const SplitParams& params)
{
  const FileSource source(file);
  if (!source.Outcome)
  {
    return source.Outcome;
  }
  const std::string ending = LowerEnding(file);
  auto stream = IsRasterEnding(ending) ? OpenRasterStream(file)
                                       : OpenPointStream(ending, source.Bytes, params.Threads);
  if (!stream && IsRasterEnding(ending))
  {
    return stream.Status; // names the file
  }
  auto grid = stream ? MakeGrid(*stream.Value, params) : stream.Status;
  if (!grid)
  {
    return About(file, grid.Status);
  }
  Splitter splitter(*stream.Value, folder, params, grid.Value);
  Status status = splitter.Split();
  auto index = status ? splitter.Finish() : status;
  if (!index)
  {
    const bool isNamed = index.Status.Detail.substr(0, 1) == "'"; // a tile's file, a raster
    return isNamed ? index.Status : About(file, index.Status);
  }
  SplitCloud split;
  split.Index = std::move(index.Value);
  split.Warnings = stream.Value->Warnings;
  split.LeftOut = stream.Value->LeftOut;
  split.NumWithoutData = stream.Value->MostPoints - split.Index.NumPoints;
  return split;
}
}

Result<SplitCloud> SplitIntoTiles(
  const std::string& file, const fs::path& folder, const SplitParams& params)
{
  if (!(params.TileSize >= 0.0) || params.PointsPerTile == 0 ||
    !(params.Halo >= 0.0 && params.Halo <= 0.5))
  {
    return { ErrorCode::InvalidParameter,
      "tiles have a size of at least 0, a point or more, and a halo of 0 to 0.5" };
  }
  try
  {
    return Split(file, folder, params);
  }
  catch (...) // out of memory
  {
    return StatusOfException();
  }
}

Result<TileIndex> ReadTileFile(const std::string& file)
{
  const auto text = TextOfFile(file);
  if (!text)
  {
    return text.Status;
  }
  auto index = ReadTileIndex(text.Value);
  return index ? std::move(index) : About(file, index.Status);
}

Result<PointMatrix> ReadTilePoints(const std::string& file, std::uint64_t expected)
{
  const FileSource source(file);
  if (!source.Outcome)
  {
    return source.Outcome;
  }
  auto stream = OpenPointStream(LowerEnding(file), source.Bytes, 1);
  if (!stream)
  {
    return About(file, stream.Status);
  }
  if (stream.Value->NumPoints != expected)
  {
    return { ErrorCode::SizeMismatch,
      "'" + file + "' has " + std::to_string(stream.Value->NumPoints) +
        " points, the index of the tiles tells " + std::to_string(expected) +
        "; make the tiles again" };
  }
  PointMatrix points(static_cast<Eigen::Index>(expected), 3);
  PointBlock block;
  double* to = points.data();
  for (std::uint64_t done = 0; done < expected; done += block.Count)
  {
    const Status status = stream.Value->Next(block);
    if (!status || block.Count == 0 || block.Count > expected - done)
    {
      return About(file,
        status ? Status(ErrorCode::SizeMismatch, "it has another number of points than it tells")
               : status);
    }
    to = std::copy(block.Positions.begin(), block.Positions.end(), to);
  }
  return points;
}
}
