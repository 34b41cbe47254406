// SPDX-License-Identifier: BSD-3-Clause
#include "FitTiles.h"

#include "Session.h"
#include "Shares.h"

#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineCore/LROperations.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineIO/CloudTiles.h>
#include <knotwork/SplineIO/DataFile.h>
#include <knotwork/SurfaceFitting/StitchTiles.h>
#include <knotwork/SurfaceFitting/vtkSplineSurfaceFit.h>

#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <system_error>

namespace fs = std::filesystem;

namespace knotwork
{
namespace
{
constexpr const char* RunFile = "run.json"; ///< what the surfaces in the folder are of

/// FNV-1a.
std::uint64_t HashOf(const std::string& text)
{
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text)
  {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  return hash;
}

/// Surfaces of tiles that outlive the run.
class KeptTiles
{
public:
  explicit KeptTiles(std::string folder) : Folder(std::move(folder)) {}

  /// Makes the folder, or sees what it is of. @param run  what this run is.
  Status Open(const nlohmann::ordered_json& run) const
  {
    if (this->Folder.empty())
    {
      return {};
    }
    std::error_code error;
    fs::create_directory(this->Folder, error);
    if (error || !fs::is_directory(this->Folder, error))
    {
      return { ErrorCode::FileError,
        "'" + this->Folder + "' cannot be made: " +
          (error ? error.message() : std::string("there is a file of that name")) };
    }
    const std::string text = run.dump(1) + "\n";
    if (fs::is_empty(this->Folder, error))
    {
      return PutText(text, this->PathOf(RunFile));
    }
    std::ifstream stream(this->PathOf(RunFile), std::ios::binary);
    const std::string found{ std::istreambuf_iterator<char>(stream), {} };
    if (found.empty())
    {
      return { ErrorCode::InvalidParameter,
        "'" + this->Folder + "' (--resume) holds other files; give another folder" };
    }
    return found == text
      ? Status()
      : Status(ErrorCode::InvalidParameter,
          "'" + this->Folder +
            "' (--resume) holds surfaces of other tiles, options or another version; give another "
            "folder");
  }

  /// The surface of a name; null: it has not been kept.
  Result<vtkSmartPointer<vtkUnstructuredGrid>> Find(const std::string& name) const
  {
    std::error_code ignored;
    const std::string file = this->PathOf(name + ".vtu");
    if (this->Folder.empty() || !fs::exists(file, ignored))
    {
      return vtkSmartPointer<vtkUnstructuredGrid>();
    }
    auto read = ReadDataFile(file);
    auto* grid = vtkUnstructuredGrid::SafeDownCast(read.Value.Data);
    if (!grid)
    {
      return { read ? ErrorCode::InvalidFormat : read.Status.Code,
        (read ? "'" + file + "' holds no surface" : read.Status.Detail) +
          "; remove it, and the tile is fitted again" };
    }
    return vtkSmartPointer<vtkUnstructuredGrid>(grid);
  }

  /// A file is there whole or not at all, whenever the run ends.
  Status Keep(const std::string& name, vtkUnstructuredGrid* grid) const
  {
    if (this->Folder.empty())
    {
      return {};
    }
    const std::string half = this->PathOf("half-" + name + ".vtu");
    auto written = WriteDataFile(grid, half);
    if (!written)
    {
      return written.Status;
    }
    std::error_code error;
    fs::rename(half, this->PathOf(name + ".vtu"), error);
    return error ? Status(ErrorCode::FileError,
                     "'" + this->PathOf(name + ".vtu") + "' cannot be written: " + error.message())
                 : Status();
  }

  bool FindNumbers(const std::string& name, FittedTile& tile) const
  {
    std::ifstream stream(this->PathOf(name + ".json"), std::ios::binary);
    const auto json = nlohmann::json::parse(stream, nullptr, false);
    if (this->Folder.empty() || !json.is_array() || json.size() != 6 ||
      !std::all_of(json.begin(), json.end(), [](const auto& value) { return value.is_number(); }))
    {
      return false;
    }
    tile = { json[0], json[1], json[2], json[3], json[4], json[5] };
    return true;
  }

  Status KeepNumbers(const std::string& name, const FittedTile& tile) const
  {
    const nlohmann::json json = { tile.NumFunctions, tile.NumOutliers, tile.NumOutside,
      tile.MaxError, tile.MeanError, tile.RmsError };
    return this->Folder.empty() ? Status()
                                : PutText(json.dump() + "\n", this->PathOf(name + ".json"));
  }

private:
  std::string PathOf(const std::string& name) const
  {
    return (fs::path(this->Folder) / name).string();
  }

  std::string Folder;
};

class TileFitter
{
public:
  TileFitter(Session& session, vtkSplineSurfaceFit* filter, const TileIndex& index,
    const TileFitParams& params)
    : Run(session), Filter(filter), Index(index), Params(params), Kept(params.ResumeFolder),
      Guesses(filter->GetInitialElementsU() == 0 && filter->GetInitialElementsV() == 0)
  {
  }

  Result<TileFit> Fit(const TakeTile& take)
  {
    nlohmann::ordered_json run = this->Params.Options;
    run["version"] = KNOTWORK_VERSION;
    run["tiles"] = HashOf(WriteTileIndex(this->Index));
    // the first process makes the folder, the others see what it is of
    Status status = Processes::Agree(Processes::Own() == 0 ? this->Kept.Open(run) : Status());
    status = status ? Processes::Agree(this->Kept.Open(run)) : status;
    this->Found.Tiles.resize(this->Index.Tiles.size());
    this->Shared.resize(this->Index.Tiles.size());
    std::vector<std::size_t> before; // tiles of the last row
    std::vector<Spline<2>> tiles;    // theirs, then those of the row
    for (std::size_t begin = 0; begin < this->Index.Tiles.size() && status;)
    {
      std::vector<std::size_t> row = this->RowFrom(begin);
      begin += row.size();
      status = status ? this->FitRow(row, tiles) : status;
      status = status ? this->Stitch(before, row, tiles) : status;
      status = status ? this->Finish(before, tiles, take) : status;
      before = std::move(row);
    }
    status = status ? this->Finish(before, tiles, take) : status;
    this->Found.NumResumed = static_cast<int>(Session::Total(this->Found.NumResumed));
    this->Found.NumOfProcess = Processes::ExchangeNumber(this->NumOwn);
    return status ? Result<TileFit>(std::move(this->Found)) : Result<TileFit>(status);
  }

private:
  std::string NameOf(std::size_t tile) const
  {
    const CloudTile& one = this->Index.Tiles[tile];
    return std::to_string(one.Number[0] - this->Index.Grid.First[0]) + "-" +
      std::to_string(one.Number[1] - this->Index.Grid.First[1]);
  }

  std::string FileOf(std::size_t tile) const
  {
    return (fs::path(this->Params.IndexFile).parent_path() / this->Index.Tiles[tile].File).string();
  }

  /// The points of a tile's file that lie in a box, or those that belong to the tile.
  Result<vtkSmartPointer<vtkPolyData>> PointsOf(
    std::size_t tile, const ParametricBox<2>& box, bool isOwn) const
  {
    const CloudTile& one = this->Index.Tiles[tile];
    auto points = ReadTilePoints(this->FileOf(tile), one.NumPoints + one.NumNeighbours);
    if (!points)
    {
      return points.Status;
    }
    vtkNew<vtkDoubleArray> coordinates;
    coordinates->SetNumberOfComponents(3);
    coordinates->Allocate(points->size());
    for (Eigen::Index i = 0; i < points->rows(); ++i)
    {
      const double* x = points->row(i).data();
      bool isIn = true;
      for (std::size_t d = 0; d < 2; ++d)
      {
        isIn = isIn && x[d] >= box.Lower[d] && x[d] <= box.Upper[d] &&
          (!isOwn || this->Index.Grid.Number(d, x[d]) == one.Number[d]);
      }
      if (isIn)
      {
        coordinates->InsertNextTypedTuple(x);
      }
    }
    const auto count = static_cast<std::uint64_t>(coordinates->GetNumberOfTuples());
    if (isOwn && count != one.NumPoints)
    {
      return { ErrorCode::SizeMismatch,
        "'" + this->FileOf(tile) + "' has " + std::to_string(count) +
          " points of its tile, the index tells " + std::to_string(one.NumPoints) +
          "; make the tiles again" };
    }
    vtkNew<vtkPoints> places;
    places->SetData(coordinates);
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(places);
    return data;
  }

  /// With the halo, as far as there are points.
  ParametricBox<2> DomainOf(std::size_t tile) const
  {
    ParametricBox<2> box = this->Index.Tiles[tile].Box;
    for (std::size_t d = 0; d < 2; ++d)
    {
      box.Lower[d] = std::max(box.Lower[d] - this->Index.Grid.Halo[d], this->Index.Lower[d]);
      box.Upper[d] = std::min(box.Upper[d] + this->Index.Grid.Halo[d], this->Index.Upper[d]);
    }
    return box;
  }

  /// Neighbours are alike: a tile begins with a quarter of the functions that the nearest one of
  /// the row before needed, which saves iterations in which most points are outside. What other
  /// tiles of its row need is not asked for: several processes fit them at once.
  void GuessElements(std::size_t tile)
  {
    if (!this->Guesses)
    {
      return;
    }
    int functions = 0;
    int nearest = std::numeric_limits<int>::max();
    for (const auto& [column, needed] : this->FunctionsBefore)
    {
      const int distance = std::abs(column - this->Index.Tiles[tile].Number[0]);
      if (distance < nearest)
      {
        nearest = distance;
        functions = needed;
      }
    }
    const ParametricBox<2>& box = this->Index.Tiles[tile].Box;
    const double ratio = (box.Upper[0] - box.Lower[0]) / (box.Upper[1] - box.Lower[1]);
    const double elements = 0.25 * functions;
    constexpr double most = 1000.0;
    constexpr double least = 8.0; // fewer are the kernel's own choice
    const double u = std::min(std::sqrt(elements * ratio), most);
    const double v = std::min(std::sqrt(elements / ratio), most);
    const bool isMany = u >= least && v >= least;
    this->Filter->SetInitialElementsU(isMany ? static_cast<int>(u) : 0);
    this->Filter->SetInitialElementsV(isMany ? static_cast<int>(v) : 0);
  }

  /// Messages of single tiles are not shown: the job counts at the end.
  Status Update(std::size_t tile)
  {
    std::vector<std::string> ignored;
    return this->Run.Run(this->Filter, "'" + this->FileOf(tile) + "'", 0, &ignored);
  }

  /// The surface of a grid.
  Result<SplineModel> Decode(vtkDataObject* grid) const
  {
    auto decoded = DecodeSplineModel(grid, this->Run.Threads);
    const bool isSurface = decoded && decoded->Patches.size() == 1 &&
      std::holds_alternative<Spline<2>>(decoded->Patches[0].Geometry);
    return isSurface || !decoded
      ? std::move(decoded)
      : Result<SplineModel>(ErrorCode::DimensionMismatch, "a tile is not one surface");
  }

  static Result<vtkSmartPointer<vtkUnstructuredGrid>> Encode(Spline<2> surface)
  {
    SplineModel model;
    model.Patches.resize(1);
    model.Patches[0].Geometry = std::move(surface);
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    const Status status = EncodeSplineGrid(model, grid);
    return { status ? Result<vtkSmartPointer<vtkUnstructuredGrid>>(grid) : status };
  }

  /// The surface of a tile before it is stitched.
  Result<vtkSmartPointer<vtkUnstructuredGrid>> FitTile(std::size_t tile)
  {
    const Processes::Alone alone;
    const std::string name = "fitted-" + this->NameOf(tile);
    auto grid = this->Kept.Find(name);
    this->Found.NumResumed += grid && grid.Value ? 1 : 0;
    if (grid && !grid.Value)
    {
      const ParametricBox<2> domain = this->DomainOf(tile);
      auto points = this->PointsOf(tile, domain, false);
      if (!points)
      {
        return points.Status;
      }
      this->Filter->SetInputDataObject(0, points.Value);
      this->Filter->SetInputDataObject(1, nullptr);
      this->Filter->SetHoldEdges(vtkSplineSurfaceFit::NO_EDGES);
      this->Filter->AssumeNoLayers(false);
      this->Filter->SetDomain(domain.Lower[0], domain.Upper[0], domain.Lower[1], domain.Upper[1]);
      if (Status status = this->Update(tile); !status)
      {
        return status;
      }
      auto decoded = this->Decode(this->Filter->GetOutputDataObject(0));
      auto restricted = decoded ? RestrictToBox(std::get<Spline<2>>(decoded->Patches[0].Geometry),
                                    this->Index.Tiles[tile].Box, this->Run.Threads)
                                : decoded.Status;
      grid = restricted ? Encode(std::move(restricted.Value)) : restricted.Status;
      Status status = grid ? this->Kept.Keep(name, grid.Value) : grid.Status;
      if (!status)
      {
        return { status.Code, "'" + this->FileOf(tile) + "': " + status.Detail };
      }
    }
    return grid;
  }

  /// Which process works on a tile. They are dealt out through all rows: what a row has too many
  /// for all to get the same number is not the same process's in every row.
  static int WorkerOf(std::size_t tile)
  {
    return static_cast<int>(tile % static_cast<std::size_t>(Processes::Count()));
  }

  /// The tiles of a row, one process each; all get all of them.
  Status FitRow(const std::vector<std::size_t>& row, std::vector<Spline<2>>& tiles)
  {
    Status status;
    std::vector<vtkSmartPointer<vtkUnstructuredGrid>> grids(row.size());
    for (std::size_t i = 0; i < row.size() && status; ++i)
    {
      if (WorkerOf(row[i]) == Processes::Own())
      {
        ++this->NumOwn;
        this->GuessElements(row[i]);
        auto fitted = this->FitTile(row[i]);
        status = fitted.Status;
        grids[i] = fitted.Value;
      }
    }
    status = Processes::Agree(status);
    this->FunctionsBefore.clear();
    for (std::size_t i = 0; i < row.size() && status; ++i)
    {
      // through the grid in any case: a run that goes on has the same bits
      auto decoded = this->Decode(SameForAll(grids[i], WorkerOf(row[i])));
      status = decoded.Status;
      if (status)
      {
        tiles.push_back(std::move(std::get<Spline<2>>(decoded->Patches[0].Geometry)));
        this->FunctionsBefore[this->Index.Tiles[row[i]].Number[0]] =
          tiles.back().Space->NumFunctions;
      }
    }
    return Processes::Agree(status);
  }

  /// The tiles of a row, which stand one after the other in the index.
  std::vector<std::size_t> RowFrom(std::size_t begin) const
  {
    std::vector<std::size_t> row;
    for (std::size_t t = begin; t < this->Index.Tiles.size() &&
         this->Index.Tiles[t].Number[1] == this->Index.Tiles[begin].Number[1];
         ++t)
    {
      row.push_back(t);
    }
    return row;
  }

  /// Stitches the tiles of a row to each other and to the row before. Edges within that row are
  /// stitched again, which changes nothing but rounding: the points where all four tiles of two
  /// rows meet need both.
  Status Stitch(const std::vector<std::size_t>& before, const std::vector<std::size_t>& row,
    std::vector<Spline<2>>& tiles)
  {
    std::vector<std::size_t> numbers = before;
    numbers.insert(numbers.end(), row.begin(), row.end());
    if (!this->HasEdges(numbers))
    {
      return {};
    }
    StitchParams params;
    params.Continuity = this->Filter->GetDegree() < 2 ? 0 : 1;
    params.NumMeasured = 3;
    params.Threads = this->Run.Threads;
    Result<StitchedTiles> stitched;
    const Status status = this->Run.Measure(
      [&]
      {
        stitched = StitchTiles(std::move(tiles), params);
        return stitched.Status;
      });
    if (!status)
    {
      return { status.Code, "'" + this->Params.IndexFile + "': " + status.Message() };
    }
    tiles = std::move(stitched->Tiles);
    for (const StitchedEdge& edge : stitched->Edges)
    {
      bool isNew = false;
      for (const PatchSide& side : edge.Interface.Sides)
      {
        const auto place = static_cast<std::size_t>(side.Patch);
        this->Shared[numbers[place]][static_cast<std::size_t>(side.Side)] = 1;
        isNew = isNew || place >= before.size();
      }
      TileFit& found = this->Found;
      found.NumEdges += isNew ? 1 : 0;
      found.MaxJumpBefore = std::max(found.MaxJumpBefore, edge.JumpBefore);
      found.MaxSlopeJumpBefore = std::max(found.MaxSlopeJumpBefore, edge.SlopeJumpBefore);
      found.MaxJump = std::max(found.MaxJump, edge.Jump);
      found.MaxSlopeJump = std::max(found.MaxSlopeJump, edge.SlopeJump);
    }
    return {};
  }

  /// Whether two of the tiles are neighbours. Tiles without any are no case for stitching.
  bool HasEdges(const std::vector<std::size_t>& numbers) const
  {
    std::set<IntArray<2>> places;
    for (const std::size_t t : numbers)
    {
      places.insert(this->Index.Tiles[t].Number);
    }
    return std::any_of(places.begin(), places.end(),
      [&](const IntArray<2>& at) {
        return places.count({ at[0] + 1, at[1] }) > 0 || places.count({ at[0], at[1] + 1 }) > 0;
      });
  }

  /// Updates the first tiles, one process each, and hands them over in the first process; they are
  /// taken out.
  Status Finish(
    const std::vector<std::size_t>& numbers, std::vector<Spline<2>>& tiles, const TakeTile& take)
  {
    Status status;
    std::vector<vtkSmartPointer<vtkUnstructuredGrid>> grids(numbers.size());
    for (std::size_t i = 0; i < numbers.size() && status; ++i)
    {
      if (WorkerOf(numbers[i]) == Processes::Own())
      {
        auto updated = this->UpdateTile(numbers[i], std::move(tiles[i]));
        status = updated.Status;
        grids[i] = updated.Value;
      }
    }
    status = Processes::Agree(status);
    for (std::size_t i = 0; i < numbers.size() && status; ++i)
    {
      const int worker = WorkerOf(numbers[i]);
      FittedTile& found = this->Found.Tiles[numbers[i]];
      found =
        Processes::Exchange(std::vector<FittedTile>{ found })[static_cast<std::size_t>(worker)]
          .front();
      const auto shared = SameForAll(grids[i], worker);
      grids[i] = nullptr;
      if (Processes::Own() == 0)
      {
        status = this->HandOver(numbers[i], vtkUnstructuredGrid::SafeDownCast(shared), take);
      }
      status = Processes::Agree(status);
    }
    tiles.erase(tiles.begin(), tiles.begin() + static_cast<std::ptrdiff_t>(numbers.size()));
    return status;
  }

  Status HandOver(std::size_t tile, vtkUnstructuredGrid* grid, const TakeTile& take) const
  {
    auto decoded = this->Decode(grid);
    if (!decoded)
    {
      return decoded.Status;
    }
    SplinePatch& patch = decoded->Patches[0];
    patch.Id = static_cast<int>(tile);
    patch.Cells.clear();
    return take(std::move(patch));
  }

  Result<vtkSmartPointer<vtkUnstructuredGrid>> UpdateTile(std::size_t tile, Spline<2> surface)
  {
    const Processes::Alone alone;
    const std::string name = "updated-" + this->NameOf(tile);
    FittedTile& numbers = this->Found.Tiles[tile];
    vtkSmartPointer<vtkUnstructuredGrid> grid;
    if (this->Kept.FindNumbers(name, numbers)) // written after the surface
    {
      auto kept = this->Kept.Find(name);
      if (!kept)
      {
        return kept.Status;
      }
      grid = kept.Value;
    }
    this->Found.NumResumed += grid ? 1 : 0;
    if (!grid)
    {
      auto points = this->PointsOf(tile, this->Index.Tiles[tile].Box, true);
      auto start = Encode(std::move(surface));
      if (!points || !start)
      {
        return points ? start.Status : points.Status;
      }
      std::array<int, 4> held = this->Shared[tile];
      const bool holds = std::any_of(held.begin(), held.end(), [](int side) { return side != 0; });
      this->Filter->SetInputDataObject(0, points.Value);
      this->Filter->SetInputDataObject(1, start.Value);
      this->Filter->SetHeldSides(held.data());
      this->Filter->SetHoldEdges(!holds   ? vtkSplineSurfaceFit::NO_EDGES
          : this->Filter->GetDegree() < 2 ? vtkSplineSurfaceFit::VALUES
                                          : vtkSplineSurfaceFit::DERIVATIVES);
      this->Filter->AssumeNoLayers(true); // all of them were there when the tile was fitted
      if (Status status = this->Update(tile); !status)
      {
        return status;
      }
      grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
      grid->ShallowCopy(this->Filter->GetOutputDataObject(0));
      this->TakeNumbers(numbers);
      Status status = this->Kept.Keep(name, grid);
      status = status ? this->Kept.KeepNumbers(name, numbers) : status;
      if (!status)
      {
        return status;
      }
    }
    return grid;
  }

  void TakeNumbers(FittedTile& numbers) const
  {
    auto* table = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(2));
    const vtkIdType last = table->GetNumberOfRows() - 1;
    const auto value = [&](const char* name) { return table->GetValueByName(last, name); };
    numbers.NumFunctions = value("Functions").ToLongLong();
    numbers.NumOutliers = value("Outliers").ToLongLong();
    numbers.NumOutside = value("PointsOutside").ToLongLong();
    numbers.MaxError = value("MaxError").ToDouble();
    numbers.MeanError = value("MeanError").ToDouble();
    numbers.RmsError = value("RmsError").ToDouble();
  }

  Session& Run;
  vtkSplineSurfaceFit* Filter;
  const TileIndex& Index;
  const TileFitParams& Params;
  KeptTiles Kept;
  bool Guesses;                           ///< no initial elements are asked for
  std::map<int, int> FunctionsBefore;     ///< of the tiles of the row before, by column
  std::vector<std::array<int, 4>> Shared; ///< by tile and side, not 0 where it has a neighbour
  int NumOwn = 0;                         ///< tiles that this process has fitted
  TileFit Found;
};
}

Result<TileFit> FitTiles(Session& session, vtkSplineSurfaceFit* filter, const TileIndex& index,
  const TileFitParams& params, const TakeTile& take)
{
  return TileFitter(session, filter, index, params).Fit(take);
}
}
