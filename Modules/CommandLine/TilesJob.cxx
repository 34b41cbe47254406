// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Ranges.h"
#include "Session.h"

#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineIO/CloudTiles.h>
#include <knotwork/SplineIO/MapOutput.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <system_error>

namespace knotwork
{
namespace
{
struct TilesJob
{
  std::string Input;
  std::string Output;
  SplitParams Params;
  std::string ReferenceSystem; ///< as it is stated

  Status Run(Session& session)
  {
    if (Status status = session.Files.CheckInput(this->Input); !status)
    {
      return status;
    }
    auto& report = session.Report;
    report["input"] = this->Input;
    report["output"] = this->Output;
    report["tile_size"] = this->Params.TileSize;
    report["points_per_tile"] = this->Params.PointsPerTile;
    report["halo"] = this->Params.Halo;
    const auto stated = WktOfReferenceSystem(this->ReferenceSystem);
    if (!stated)
    {
      return stated.Status;
    }
    auto staged = session.Files.Stage(this->Output);
    if (!staged)
    {
      return staged.Status;
    }
    std::filesystem::path folder = staged.Value;
    folder.replace_extension();
    std::error_code error;
    if (!std::filesystem::create_directory(folder, error))
    {
      return { ErrorCode::FileError,
        "'" + this->Output + "' cannot be written: its folder: " + error.message() };
    }
    this->Params.Threads = session.Threads;
    Result<SplitCloud> split;
    Status status = session.Measure(
      [&]
      {
        split = SplitIntoTiles(this->Input, folder, this->Params);
        return split.Status;
      });
    if (!status)
    {
      // a tile's file is in a temporary folder: the one that was asked for is named
      const std::string lead = "' cannot be written: ";
      const std::size_t at = status.Detail.find(lead);
      return at == std::string::npos
        ? status
        : Status(status.Code, "'" + this->Output + lead + status.Detail.substr(at + lead.size()));
    }
    session.Warn(split->Warnings);
    for (const std::string& part : split->LeftOut)
    {
      session.LeftOut.push_back("'" + this->Input + "': " + part);
      session.Warn({ session.LeftOut.back() });
    }
    TileIndex& index = split->Index;
    index.ReferenceSystem = stated->empty() ? index.ReferenceSystem : stated.Value;
    std::uint64_t largest = 0;
    std::uint64_t written = 0;
    for (const CloudTile& tile : index.Tiles)
    {
      largest = std::max(largest, tile.NumPoints + tile.NumNeighbours);
      written += tile.NumPoints + tile.NumNeighbours;
    }
    report["points"] = index.NumPoints;
    report["cells_without_data"] = split->NumWithoutData;
    report["tiles"] = index.Tiles.size();
    report["points_written"] = written;
    report["points_of_largest_tile"] = largest;
    report["sides_of_tiles"] = index.Grid.Size;
    report["lower"] = index.Lower;
    report["upper"] = index.Upper;
    report["reference_system"] = index.ReferenceSystem;
    // the text goes where the tiles already are
    return AboutFile(
      PutText(WriteTileIndex(index), staged->string()), this->Output, staged->string());
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<TilesJob>();
  SplitParams& params = job->Params;
  app
    .add_option("cloud", job->Input,
      "points, read piece by piece: as many as there are (.las .tif .xyz .txt .csv .ply)")
    ->required();
  AddOutput(app, "--output", job->Output, ".tiles",
    "the index of the tiles; their points go into a folder of its name")
    ->required();
  app
    .add_option("--tile-size", params.TileSize,
      "length of the sides of tiles, unit of the points; 0: by --points-per-tile (.las .tif)")
    ->check(InRange(0.0, 1e300))
    ->capture_default_str();
  app
    .add_option("--points-per-tile", params.PointsPerTile,
      "points of a tile, about, where they are spread evenly")
    ->check(InRange(std::uint64_t{ 1 }, std::uint64_t{ 1000000000 }))
    ->capture_default_str();
  app
    .add_option(
      "--halo", params.Halo, "how much of its neighbours a tile knows, as a share of its sides")
    ->check(InRange(0.0, 0.5))
    ->capture_default_str();
  app.add_option("--crs", job->ReferenceSystem,
    "coordinate reference system of the points, such as EPSG:25832; without it theirs");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "tiles",
  "split a cloud that is too large for the memory into tiles",
  "scan.xyz --tile-size 0.5 --output scan.tiles --report tiles.json", Make };
}
}
