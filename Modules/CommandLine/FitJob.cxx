// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"
#include "FitTiles.h"

#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/ReferenceSystem.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineIO/CloudTiles.h>
#include <knotwork/SplineIO/DataFile.h>
#include <knotwork/SplineIO/MapOutput.h>
#include <knotwork/SplineIO/PieceFiles.h>
#include <knotwork/SurfaceFitting/vtkSplineSurfaceFit.h>

#include <pugixml.hpp>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <system_error>

namespace knotwork
{
namespace
{
/// Points of a grid as polydata, for formats of points.
vtkSmartPointer<vtkPolyData> AsPolyData(vtkPointSet* data)
{
  if (auto* polydata = vtkPolyData::SafeDownCast(data))
  {
    return polydata;
  }
  auto points = vtkSmartPointer<vtkPolyData>::New();
  points->SetPoints(data->GetPoints());
  points->GetPointData()->ShallowCopy(data->GetPointData());
  vtkNew<vtkCellArray> vertices;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    vertices->InsertNextCell(1, &i);
  }
  points->SetVerts(vertices);
  return points;
}

/// Of vtkSplineSurfaceFit.
enum Port
{
  Surface,
  Points,
  Iterations,
  Features,
  Elements
};

class FitJob : public FilterJob<vtkSplineSurfaceFit>
{
public:
  explicit FitJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "points",
      "points (.xyz .txt .csv .g2 .las .tif .ply .vtp .vtu, meshes .stl .obj .off), or the tiles "
      "of "
      "a cloud (.tiles)",
      "", "input");
    this->AddInput(1, "--start", "the spline surface that the fit starts from and updates",
      " starting from ", "start");
    this->Divide(0, Share::Points);
    this->DivideInto(Points);
    this->AddOutput(Surface, "--output", Endings::Splines,
      "the surface (of tiles .vtu, or .vtpc: a block a tile)");
    this->AddOutput(
      Points, "--points", Endings::Points, "the points with distances, tolerances, outliers");
    this->AddOutput(Iterations, "--table", Endings::Table, "the iterations; of tiles a row a tile");
    this->AddOutput(Features, "--features", Endings::Image, "the feature grid");
    this->AddOutput(Elements, "--elements", Endings::Cells, "the elements with their features");
    this->App.add_option("--resume", this->ResumeFolder,
      "folder that keeps what is done of tiles: the same run goes on with it when it was ended");
    this->App.add_option("--crs", this->ReferenceSystem,
      "coordinate reference system of the points, such as EPSG:25832; without it theirs");
    this->AddArrayOptions();
    this->AddProperties();
  }

  Status Run(Session& session)
  {
    const std::string& output = this->MainOutput();
    const bool isOfTiles = LowerEnding(this->InputFile(0)) == ".tiles";
    if (!isOfTiles && !this->ResumeFolder.empty())
    {
      return { ErrorCode::InvalidParameter,
        "'" + this->InputFile(0) + "': --resume is of tiles (.tiles); leave it out" };
    }
    if (!isOfTiles && LowerEnding(output) == ".vtpc")
    {
      return { ErrorCode::InvalidParameter,
        "'" + output + "': a collection is written of tiles (.tiles); write one surface as " +
          JoinEndings(EndingsThatWrite(SplineGridContent)) };
    }
    nlohmann::ordered_json asked;
    this->FilterOptions.Apply(asked); // inputs are divided by what is asked for
    return isOfTiles ? this->RunTiles(session) : FilterJob::Run(session);
  }

protected:
  /// What needs all points in one process is done by the first one.
  Share ShareOfInput(vtkDataObject* data) const override
  {
    return vtkPointSet::SafeDownCast(data) && this->Filter->NeedsWholeInput().empty()
      ? Share::Points
      : Share::Blocks;
  }

  Status Prepare(Session& session) override
  {
    for (const std::string& name : this->Fields)
    {
      this->Filter->AddFieldArray(name.c_str());
    }
    for (std::size_t i = 0; i < this->Arrays.size(); ++i)
    {
      if (!this->Arrays[i].empty())
      {
        this->Filter->SetInputArrayToProcess(static_cast<int>(i), 0, 0,
          vtkDataObject::FIELD_ASSOCIATION_POINTS, this->Arrays[i].c_str());
      }
    }
    this->AddToleranceBoxes();
    if (!this->ReferenceSystem.empty())
    {
      const auto name = StateReferenceSystem(this->ReferenceSystem, this->Input(0));
      if (!name)
      {
        return name.Status;
      }
      session.Report["reference_system"] = name.Value;
    }
    session.Report["fields"] = this->Fields;
    session.Report["parameter_array"] = this->Arrays[0];
    session.Report["tolerance_array"] = this->Arrays[1];
    session.Report["significant_array"] = this->Arrays[2];
    session.Report["tolerance_boxes"] = this->ToleranceBoxes;
    return this->RequirePointSet(0);
  }

  Status AddNumbers(Session& session) override
  {
    auto* points = vtkPointSet::SafeDownCast(this->Filter->GetOutputDataObject(Points));
    vtkTable* table = this->Table(Iterations);
    const vtkIdType last = table->GetNumberOfRows() - 1;
    const auto value = [&](const char* name) { return table->GetValueByName(last, name); };
    constexpr double Infinity = std::numeric_limits<double>::infinity();
    double tolerances[2] = { Infinity, -Infinity };
    vtkDataArray* own = points->GetPointData()->GetArray("Tolerance");
    if (own && own->GetNumberOfTuples() > 0)
    {
      own->GetRange(tolerances);
    }
    // the first process has all points, or each its own
    const vtkIdType count =
      this->DividedOutputStays() || Processes::Own() == 0 ? points->GetNumberOfPoints() : 0;
    auto& report = session.Report;
    report["points"] = Session::Total(count);
    report["smallest_tolerance"] = -Session::Largest(-tolerances[0]);
    report["largest_tolerance"] = Session::Largest(tolerances[1]);
    report["functions"] = value("Functions").ToLongLong();
    report["elements"] = value("Elements").ToLongLong();
    report["iterations"] = value("Iteration").ToLongLong();
    report["max_error"] = value("MaxError").ToDouble();
    report["mean_error"] = value("MeanError").ToDouble();
    report["rms_error"] = value("RmsError").ToDouble();
    report["points_outside"] = value("PointsOutside").ToLongLong();
    report["outliers"] = value("Outliers").ToLongLong();
    report["significant_points"] = value("SignificantPoints").ToLongLong();
    report["max_significant_error"] = value("MaxSignificantError").ToDouble();
    report["mean_significant_error"] = value("MeanSignificantError").ToDouble();
    report["significant_outside"] = value("SignificantOutside").ToLongLong();
    report["aic"] = value("AIC").ToDouble();
    report["bic"] = value("BIC").ToDouble();
    report["within_tolerance"] = value("PointsOutside").ToLongLong() == 0;
    report["seconds_of_fit"] = this->Filter->GetSeconds();
    return {};
  }

  Status Write(Session& session) override
  {
    Status status = this->WriteSurface(session);
    status = status ? session.WriteOutputs(this->Filter,
                        { {}, {}, this->OutputFile(Iterations), this->OutputFile(Features),
                          this->OutputFile(Elements) })
                    : status;
    return status && !this->OutputFile(Points).empty()
      ? session.Write(
          AsPolyData(vtkPointSet::SafeDownCast(this->Filter->GetOutputDataObject(Points))),
          this->OutputFile(Points))
      : status;
  }

private:
  /// Options that are of one set of points alone.
  Status RefuseOptions() const
  {
    for (const char* name : { "--start", "--points", "--features", "--elements", "--field",
           "--all-fields", "--parameter-array", "--tolerance-array", "--significant-array",
           "--parameterization", "--correct-parameters", "--space", "--domain", "--hold-edges",
           "--held-sides", "--feature-grid-size", "--element-features", "--feature-iterations" })
    {
      if (this->App.get_option(name)->count() > 0)
      {
        return { ErrorCode::InvalidParameter,
          "'" + this->InputFile(0) + "': " + name + " is not of tiles; leave it out" };
      }
    }
    const std::string ending = LowerEnding(this->MainOutput());
    return ending == ".vtu" || ending == ".vtpc"
      ? Status()
      : Status(ErrorCode::InvalidParameter,
          "'" + this->MainOutput() + "': the surface of tiles is written as .vtu or .vtpc");
  }

  Status RunTiles(Session& session)
  {
    const std::string& file = this->InputFile(0);
    Status status = this->RefuseOptions();
    status = status ? session.Files.CheckInput(file) : status;
    auto index = status ? ReadTileFile(file) : status;
    status = Processes::Agree(index.Status);
    if (!status)
    {
      return status;
    }
    const auto stated = WktOfReferenceSystem(this->ReferenceSystem);
    if (!stated)
    {
      return stated.Status;
    }
    this->ReferenceSystem = stated->empty() ? index->ReferenceSystem : stated.Value;
    TileFitParams params;
    params.IndexFile = file;
    params.ResumeFolder = this->ResumeFolder;
    this->FilterOptions.Apply(params.Options);
    params.Options["tolerance_boxes"] = this->ToleranceBoxes;
    this->AddToleranceBoxes();
    if (this->Filter->GetTolerance() == 0.0) // as of all points at once
    {
      this->Filter->SetTolerance(1e-3 * (index->Upper[2] - index->Lower[2]));
    }
    this->Filter->SetThreads(session.Threads);
    session.Report["input"] = file;
    session.Report["output"] = this->MainOutput();
    session.Report["resume"] = this->ResumeFolder;
    session.Report.update(params.Options);
    session.Report["tolerance"] = this->Filter->GetTolerance();
    SplineModel model;
    const bool isCollection = LowerEnding(this->MainOutput()) == ".vtpc";
    if (isCollection)
    {
      auto staged = session.Stage(this->MainOutput());
      if (!staged)
      {
        return staged.Status;
      }
      this->Staged = staged.Value;
      std::error_code error;
      std::filesystem::create_directory(this->Staged.parent_path() / this->Staged.stem(), error);
    }
    const auto fit = FitTiles(session, this->Filter, index.Value, params,
      [&](SplinePatch&& patch)
      {
        model.Patches.push_back(std::move(patch));
        return isCollection ? this->WritePiece(model) : Status();
      });
    if (!fit)
    {
      return fit.Status;
    }
    this->ReportTiles(session, index.Value, fit.Value);
    if (!this->OutputFile(Iterations).empty())
    {
      status = session.Write(TableOf(index.Value, fit.Value), this->OutputFile(Iterations));
    }
    if (status && isCollection)
    {
      status = Processes::Agree(
        Processes::Own() == 0 ? this->WriteCollection(index->Tiles.size()) : Status());
    }
    return status && !isCollection ? this->WriteGrid(session, model) : status;
  }

  void ReportTiles(Session& session, const TileIndex& index, const TileFit& fit) const
  {
    FittedTile all;
    double weight = 0.0;
    for (std::size_t t = 0; t < fit.Tiles.size(); ++t)
    {
      const FittedTile& tile = fit.Tiles[t];
      const auto points =
        static_cast<double>(index.Tiles[t].NumPoints) - static_cast<double>(tile.NumOutliers);
      all.NumFunctions += tile.NumFunctions;
      all.NumOutliers += tile.NumOutliers;
      all.NumOutside += tile.NumOutside;
      all.MaxError = std::max(all.MaxError, tile.MaxError);
      all.MeanError += points * tile.MeanError;
      all.RmsError += points * tile.RmsError * tile.RmsError;
      weight += points;
    }
    weight = std::max(weight, 1.0);
    auto& report = session.Report;
    report["points"] = index.NumPoints;
    report["tiles"] = index.Tiles.size();
    report["tiles_resumed"] = fit.NumResumed;
    if (fit.NumOfProcess.size() > 1)
    {
      report["rank_tiles"] = fit.NumOfProcess;
    }
    report["functions"] = all.NumFunctions;
    report["max_error"] = all.MaxError;
    report["mean_error"] = all.MeanError / weight;
    report["rms_error"] = std::sqrt(all.RmsError / weight);
    report["points_outside"] = all.NumOutside;
    report["outliers"] = all.NumOutliers;
    report["within_tolerance"] = all.NumOutside == 0;
    report["edges"] = fit.NumEdges;
    report["max_jump_before"] = fit.MaxJumpBefore;
    report["max_jump"] = fit.MaxJump;
    report["max_slope_jump_before"] = fit.MaxSlopeJumpBefore;
    report["max_slope_jump"] = fit.MaxSlopeJump;
    if (all.NumOutside > 0)
    {
      session.Warn({ "'" + this->InputFile(0) + "': " + std::to_string(all.NumOutside) + " of " +
        std::to_string(index.NumPoints) +
        " points are farther away than their tolerance; --table says in which tiles" });
    }
  }

  template <typename Array, typename Get>
  static void AddTileColumn(
    vtkTable* table, const char* name, const TileIndex& index, const TileFit& fit, Get get)
  {
    const auto column = NamedArray<Array>(name);
    for (std::size_t t = 0; t < fit.Tiles.size(); ++t)
    {
      column->InsertNextValue(get(index.Tiles[t], fit.Tiles[t]));
    }
    table->AddColumn(column);
  }

  static vtkSmartPointer<vtkTable> TableOf(const TileIndex& index, const TileFit& fit)
  {
    using In = const CloudTile&;
    using Out = const FittedTile&;
    auto table = vtkSmartPointer<vtkTable>::New();
    const auto count = [&](const char* name, auto get)
    {
      AddTileColumn<vtkIdTypeArray>(table, name, index, fit,
        [&](In tile, Out fitted) { return static_cast<vtkIdType>(get(tile, fitted)); });
    };
    const auto size = [&](const char* name, auto get)
    { AddTileColumn<vtkDoubleArray>(table, name, index, fit, get); };
    count("Column", [&](In tile, Out) { return tile.Number[0] - index.Grid.First[0]; });
    count("Row", [&](In tile, Out) { return tile.Number[1] - index.Grid.First[1]; });
    count("Points", [](In tile, Out) { return tile.NumPoints; });
    count("PointsOfNeighbours", [](In tile, Out) { return tile.NumNeighbours; });
    count("Functions", [](In, Out tile) { return tile.NumFunctions; });
    size("MaxError", [](In, Out tile) { return tile.MaxError; });
    size("MeanError", [](In, Out tile) { return tile.MeanError; });
    size("RmsError", [](In, Out tile) { return tile.RmsError; });
    count("PointsOutside", [](In, Out tile) { return tile.NumOutside; });
    count("Outliers", [](In, Out tile) { return tile.NumOutliers; });
    return table;
  }

  Status WriteGrid(Session& session, const SplineModel& model) const
  {
    vtkNew<vtkUnstructuredGrid> grid;
    const Status status = EncodeSplineGrid(model, grid);
    SetReferenceSystem(grid, this->ReferenceSystem);
    return status ? session.Write(grid, this->MainOutput()) : status;
  }

  /// The name of a piece of the collection, as VTK gives them.
  std::string PieceOf(int tile) const
  {
    const std::string stem = this->Staged.stem().string();
    return stem + "/" + stem + "_" + std::to_string(tile) + "_0.vtu";
  }

  /// Writes the one tile of a model, which is empty then: the surface of a large cloud is never in
  /// memory as a whole.
  Status WritePiece(SplineModel& model) const
  {
    vtkNew<vtkUnstructuredGrid> grid;
    const std::string piece =
      (this->Staged.parent_path() / this->PieceOf(model.Patches[0].Id)).string();
    Status status = EncodeSplineGrid(model, grid);
    SetReferenceSystem(grid, this->ReferenceSystem);
    status = status ? WriteDataFile(grid, piece).Status : status;
    model = {};
    return AboutFile(status, this->MainOutput(), piece);
  }

  /// The file that names the pieces, as VTK reads collections.
  Status WriteCollection(std::size_t tiles) const
  {
    std::string text = "<?xml version=\"1.0\"?>\n"
                       "<VTKFile type=\"vtkPartitionedDataSetCollection\" version=\"1.0\">\n"
                       "  <vtkPartitionedDataSetCollection>\n";
    for (std::size_t t = 0; t < tiles; ++t)
    {
      pugi::xml_document document; // quotes what a name may hold
      pugi::xml_node partitions = document.append_child("Partitions");
      partitions.append_attribute("index") = static_cast<unsigned>(t);
      pugi::xml_node piece = partitions.append_child("DataSet");
      piece.append_attribute("index") = 0;
      piece.append_attribute("file") = this->PieceOf(static_cast<int>(t)).c_str();
      std::ostringstream stream;
      document.save(stream, "  ", pugi::format_indent | pugi::format_no_declaration);
      text += stream.str();
    }
    text += "  </vtkPartitionedDataSetCollection>\n</VTKFile>\n";
    return AboutFile(
      PutText(text, this->Staged.string()), this->MainOutput(), this->Staged.string());
  }

  void AddToleranceBoxes()
  {
    const std::vector<double>& boxes = this->ToleranceBoxes;
    for (std::size_t i = 0; i + 4 < boxes.size(); i += 5)
    {
      this->Filter->AddToleranceBox(
        boxes[i], boxes[i + 1], boxes[i + 2], boxes[i + 3], boxes[i + 4]);
    }
  }

  /// A surface that is too large as the tensor product that its format needs is not lost.
  Status WriteSurface(Session& session)
  {
    vtkDataObject* surface = this->Filter->GetOutputDataObject(Surface);
    const std::string& file = this->MainOutput();
    Status status = session.Write(surface, file);
    const std::string instead = std::filesystem::path(file).replace_extension(".vtu").string();
    if (status.Code != ErrorCode::TooLarge || std::filesystem::exists(instead))
    {
      return status;
    }
    session.Files.Drop(file);
    session.LeftOut.push_back(status.Detail + "; the surface is in '" + instead + "'");
    session.Warn({ session.LeftOut.back() });
    return session.Write(surface, instead);
  }

  void AddArrayOptions()
  {
    this->App.add_option("--field", this->Fields, "point arrays that are fitted along")
      ->expected(1)
      ->take_all();
    this->App.add_option("--parameter-array", this->Arrays[0],
      "point array of given parameters; without one UV, then the texture coordinates");
    this->App.add_option("--tolerance-array", this->Arrays[1], "point array of tolerances");
    this->App.add_option("--significant-array", this->Arrays[2],
      "point array that is not 0 where a point is significant");
    this->App
      .add_option("--tolerance-box", this->ToleranceBoxes,
        "u0 u1 v0 v1 tolerance of the points in a box of parameters; several boxes one after the "
        "other")
      ->type_size(5)
      ->expected(1, 100000);
  }

  std::string ResumeFolder;
  std::filesystem::path Staged; ///< the collection of tiles
  std::string ReferenceSystem;  ///< as it is stated, then of the tiles
  std::vector<std::string> Fields;
  std::array<std::string, 3> Arrays; ///< parameters, tolerances, significant points
  std::vector<double> ToleranceBoxes;
};

const JobRegistration Registration{ "fit", "fit a spline surface to scattered points",
  "scan.xyz --tolerance 0.01 --output terrain.vtu --report terrain.json", MakeJob<FitJob>,
  JobProcesses::Several };
}
}
