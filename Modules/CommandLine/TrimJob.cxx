// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"
#include "FlattenNumbers.h"
#include "Shares.h"

#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/MeshParameterization/vtkMeshParameterization.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>
#include <knotwork/SurfaceTrimming/vtkAnalyticModel.h>
#include <knotwork/SurfaceTrimming/vtkTrimmedSurface.h>

#include <vtkAppendPolyData.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>

namespace knotwork
{
namespace
{
/// Meshes that a single map would stretch more are cut into charts, unless the option says
/// otherwise: nets follow the plane, so what is stretched costs control points.
constexpr double ChartStretch = 3.0;

/// Of vtkTrimmedSurface.
enum Port
{
  Triangles,
  Surfaces,
  Curves,
  Deviation,
  Numbers
};

/// Of vtkAnalyticModel.
constexpr int NumbersOfModel = 3;

/// Of an output: not a port of the filters.
constexpr std::size_t Flat = Numbers + 1;
constexpr std::size_t NumOutputs = Flat + 1;

/// What is made of a mesh.
struct TrimmedPart
{
  nlohmann::ordered_json Report = nlohmann::ordered_json::object();
  std::array<vtkSmartPointer<vtkDataObject>, NumOutputs> Data;

  /// Filters are used again for the next mesh.
  void Keep(std::size_t output, vtkDataObject* data)
  {
    this->Data[output] = vtkSmartPointer<vtkDataObject>::Take(data->NewInstance());
    this->Data[output]->ShallowCopy(data);
  }
};

using Meshes = std::vector<vtkSmartPointer<vtkDataObject>>;

/// The meshes of a file: one, or the blocks of a collection.
Result<Meshes> MeshesOf(vtkDataObject* data)
{
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data);
  if (!collection)
  {
    return Meshes{ data };
  }
  Meshes meshes;
  for (unsigned int b = 0; b < collection->GetNumberOfPartitionedDataSets(); ++b)
  {
    const unsigned int pieces = collection->GetNumberOfPartitions(b);
    if (pieces != 1 || !collection->GetPartition(b, 0))
    {
      return { pieces > 1 ? ErrorCode::InvalidTopology : ErrorCode::EmptyInput,
        "block " + std::to_string(b) +
          (pieces > 1 ? " has several pieces: make one mesh of them" : " is empty: leave it out") };
    }
    meshes.emplace_back(collection->GetPartition(b, 0));
  }
  return meshes;
}

/// Numbers of all parts: counts and areas are summed; of bounds the worst is taken, and a truth is
/// one of all of them. Words stand where they are the same in all.
nlohmann::ordered_json TotalsOf(const nlohmann::ordered_json& parts)
{
  auto report = nlohmann::ordered_json::object();
  const auto begins = [](const std::string& key, const char* with)
  { return key.rfind(with, 0) == 0; };
  std::set<std::string> differing;
  for (const auto& part : parts)
  {
    for (const auto& [key, value] : part.items())
    {
      const bool isNew = !report.contains(key);
      nlohmann::ordered_json& total = report[key];
      if (isNew)
      {
        total = value;
      }
      else if (value.is_boolean())
      {
        const bool isAny = key == "fallback";
        total =
          isAny ? total.get<bool>() || value.get<bool>() : total.get<bool>() && value.get<bool>();
      }
      else if (value.is_number_float())
      {
        const double a = total;
        const double b = value;
        total = begins(key, "max_") || begins(key, "rms_") || key == "tolerance" ? std::max(a, b)
          : begins(key, "min_")                                                  ? std::min(a, b)
                                                                                 : a + b;
      }
      else if (value.is_number())
      {
        total = total.get<long long>() + value.get<long long>();
      }
      else if (total != value)
      {
        differing.insert(key);
      }
    }
  }
  for (const std::string& key : differing)
  {
    report.erase(key);
  }
  return report;
}

struct TrimJob
{
  std::string Input;
  std::string Output;
  std::array<std::string, NumOutputs> Files; ///< but for Output
  bool Features = true;
  CLI::App* App = nullptr;
  vtkNew<vtkAnalyticModel> Model;
  vtkNew<vtkMeshParameterization> Flatten;
  vtkNew<vtkTrimmedSurface> Trim;
  std::unique_ptr<Options> FilterOptions;

  /// Meshes are divided among processes.
  Status Run(Session& session)
  {
    auto input = session.Read(this->Input);
    if (!input)
    {
      return input.Status;
    }
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    const bool isCollection = vtkPartitionedDataSetCollection::SafeDownCast(input.Value) != nullptr;
    const auto meshes = MeshesOf(input.Value);
    if (!meshes)
    {
      return { meshes.Status.Code, "'" + this->Input + "': " + meshes.Status.Detail };
    }
    if (isCollection && !this->Files[Numbers].empty())
    {
      return { ErrorCode::InvalidParameter,
        "--table has the numbers of one mesh: leave it out; `parts` of the report has those of "
        "each" };
    }
    const Processes::Part own =
      Processes::PartOf(meshes->size(), Processes::Own(), Processes::Count());
    std::vector<TrimmedPart> parts(own.End - own.Begin);
    Status status;
    for (std::size_t b = own.Begin; status && b < own.End; ++b)
    {
      const Processes::Alone alone;
      const std::string what =
        "'" + this->Input + "'" + (isCollection ? ", block " + std::to_string(b) : "");
      status = this->TrimMesh(meshes.Value[b], what, session, parts[b - own.Begin]);
    }
    status = Processes::Agree(status);
    status = status ? this->Join(parts, own.Begin, isCollection, session) : status;
    return status ? this->Write(session, parts.front()) : status;
  }

  /// What all processes have made, as one part of the first one.
  /// @param first  block that this process has.
  Status Join(
    std::vector<TrimmedPart>& parts, std::size_t first, bool isCollection, Session& session) const
  {
    if (parts.empty()) // of processes with nothing to do
    {
      parts.resize(1);
    }
    if (!isCollection)
    {
      session.Report.update(parts.front().Report);
      return {};
    }
    auto own = nlohmann::ordered_json::array();
    for (const TrimmedPart& part : parts)
    {
      if (!part.Report.empty())
      {
        own.push_back(part.Report);
      }
    }
    auto all = nlohmann::ordered_json::array();
    for (const std::string& text : Processes::Collect(own.dump()))
    {
      for (auto& part : nlohmann::ordered_json::parse(text))
      {
        all.push_back(std::move(part));
      }
    }
    session.Report.update(TotalsOf(all));
    session.Report["parts"] = std::move(all);
    TrimmedPart whole;
    for (std::size_t output = 0; output < NumOutputs; ++output)
    {
      const bool isGrid = output == Surfaces || output == Curves;
      if (output == Numbers || (!isGrid && this->Files[output].empty()))
      {
        continue;
      }
      const auto joined = AppendShares(BlocksOf(parts, first, output));
      if (!joined)
      {
        return joined.Status;
      }
      if (Processes::Own() == 0)
      {
        whole.Data[output] = isGrid ? joined.Value : AppendBlocks(joined.Value);
      }
    }
    parts.assign(1, std::move(whole));
    return Processes::Agree(Processes::Own() == 0 ? MakeOneModel(parts.front()) : Status());
  }

  /// What this process has made, in the blocks of its meshes.
  static vtkSmartPointer<vtkPartitionedDataSetCollection> BlocksOf(
    const std::vector<TrimmedPart>& parts, std::size_t first, std::size_t output)
  {
    auto collection = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
      if (auto* made = vtkDataSet::SafeDownCast(parts[i].Data[output]))
      {
        collection->SetPartition(static_cast<unsigned int>(first + i), 0, made);
      }
    }
    return collection;
  }

  /// Polygons of all blocks, which a cell array tells: faces are numbered within a block.
  static vtkSmartPointer<vtkDataObject> AppendBlocks(vtkDataObject* blocks)
  {
    auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(blocks);
    vtkNew<vtkAppendPolyData> append;
    append->AddInputData(vtkNew<vtkPolyData>()); // there may be no block
    for (unsigned int b = 0; b < collection->GetNumberOfPartitionedDataSets(); ++b)
    {
      if (auto* polygons = vtkPolyData::SafeDownCast(collection->GetPartition(b, 0)))
      {
        vtkNew<vtkIntArray> block;
        block->SetName("Block");
        block->SetNumberOfValues(polygons->GetNumberOfCells());
        block->FillValue(static_cast<int>(b));
        polygons->GetCellData()->AddArray(block);
        append->AddInputData(polygons);
      }
    }
    append->Update();
    return append->GetOutputDataObject(0);
  }

  /// Faces, edges and bodies of all parts get numbers of their own.
  static Status MakeOneModel(TrimmedPart& whole)
  {
    const auto model = DecodeTrimmedModel(whole.Data[Surfaces], whole.Data[Curves]);
    if (!model)
    {
      return model.Status;
    }
    const auto surfaces = vtkSmartPointer<vtkUnstructuredGrid>::New();
    const auto curves = vtkSmartPointer<vtkUnstructuredGrid>::New();
    const Status status = EncodeTrimmedModel(model.Value, surfaces, curves);
    whole.Data[Surfaces] = surfaces;
    whole.Data[Curves] = curves;
    return status;
  }

  static vtkSmartPointer<vtkDataObject> NothingOf(std::size_t output)
  {
    if (output == Surfaces || output == Curves)
    {
      return vtkSmartPointer<vtkUnstructuredGrid>::New();
    }
    return output == Numbers ? vtkSmartPointer<vtkDataObject>(vtkSmartPointer<vtkTable>::New())
                             : vtkSmartPointer<vtkDataObject>(vtkSmartPointer<vtkPolyData>::New());
  }

  /// Every file that is asked for.
  Status Write(Session& session, TrimmedPart& made)
  {
    for (std::size_t output = 0; output < NumOutputs; ++output)
    {
      if (!made.Data[output]) // in other processes than the first
      {
        made.Data[output] = NothingOf(output);
      }
    }
    Status status = HasCADEnding(this->Output)
      ? this->WriteFaces(made.Data[Surfaces], made.Data[Curves], session)
      : session.Write(made.Data[Surfaces], this->Output);
    for (std::size_t output = 0; status && output < NumOutputs; ++output)
    {
      if (!this->Files[output].empty())
      {
        status = session.Write(made.Data[output], this->Files[output]);
      }
    }
    return status;
  }

  Status TrimMesh(vtkDataObject* mesh, const std::string& what, Session& session, TrimmedPart& made)
  {
    made.Report["analytic"] = false;
    if (this->Features && !HasPlane(mesh) && this->Files[Flat].empty() &&
      this->Files[Deviation].empty())
    {
      bool done = false;
      Status status = this->RunModel(mesh, what, session, made, done);
      if (!status || done)
      {
        return status;
      }
    }
    made.Report["flatten_method"] = "given";
    made.Report["fallback"] = false;
    made.Report["injective"] = true; // else there is no result
    made.Report["flipped_triangles"] = 0;
    std::vector<std::string> warnings; // of the chart; a face that fails says more of it
    if (!HasPlane(mesh))
    {
      this->Flatten->SetInputDataObject(mesh);
      this->Flatten->SetThreads(session.Threads);
      if (Status status = session.Run(this->Flatten, what, 0, &warnings); !status)
      {
        return status;
      }
      ReportFlattening(this->Flatten, "flatten_", made.Report);
      mesh = this->Flatten->GetOutputDataObject(0);
      made.Keep(Flat, mesh);
    }
    this->Trim->SetInputDataObject(mesh);
    this->Trim->SetTriangulation(!this->Files[Triangles].empty());
    this->Trim->SetThreads(session.Threads);
    if (Status status = session.Run(this->Trim, what, Surfaces); !status)
    {
      return status;
    }
    session.Warn(warnings);
    this->AddNumbers(mesh, made.Report);
    for (const Port port : { Triangles, Surfaces, Curves, Deviation, Numbers })
    {
      made.Keep(port, this->Trim->GetOutputDataObject(port));
    }
    return {};
  }

  /// Planes, cylinders, ... when the mesh is made of such.
  /// @param done  result: false when it is not, and spline faces are to be made.
  Status RunModel(
    vtkDataObject* mesh, const std::string& what, Session& session, TrimmedPart& made, bool& done)
  {
    this->Model->SetInputDataObject(mesh);
    this->Model->SetThreads(session.Threads);
    this->Model->SetTolerance(this->Trim->GetTolerance());
    this->Model->SetCornerAngle(this->Trim->GetCornerAngle());
    this->Model->SetChordalTolerance(this->Trim->GetChordalTolerance());
    this->Model->SetEffort(this->Trim->GetEffort());
    this->Model->SetTimeLimit(this->Trim->GetTimeLimit());
    this->Model->SetMaximumStretch(this->Flatten->GetMaximumStretch());
    std::vector<std::string> warnings;
    const Status status = session.Run(this->Model, what, Surfaces, &warnings);
    vtkTable* table = vtkTable::SafeDownCast(this->Model->GetOutputDataObject(NumbersOfModel));
    done = status && warnings.empty();
    if (!done)
    {
      // meshes that are no surface at all are refused there too, with more to say
      made.Report["why_not_analytic"] = status ? warnings.front() : status.Detail;
      return status.Code == ErrorCode::Aborted ? status : Status();
    }
    made.Report["analytic"] = true;
    this->WarnOfUnused(session);
    made.Report["points"] = mesh->GetNumberOfElements(vtkDataObject::POINT);
    made.Report["triangles"] = mesh->GetNumberOfElements(vtkDataObject::CELL);
    ReportTruths(table, 0, { "WithinTolerance", "LoopsProved" }, made.Report);
    ReportRow(table, 0,
      { "Tolerance", "MaxDeviation", "MaxNormalAngle", "MaxSag", "MaxEdgeDistance", "MaxEdgeGap",
        "MinNormalBound", "Area", "MeshArea", "Faces", "Planes", "Cylinders", "Spheres", "Cones",
        "Tori", "Extrusions", "Revolutions", "FreeFaces", "Loops", "Edges", "Lines", "Circles",
        "SharpEdges", "Vertices", "ControlPoints", "Verdict", "LoopVerdict", "SnappedSurfaces",
        "CommonDirections", "CommonPositions", "CommonSizes", "MaxTurn" },
      made.Report);
    for (const Port port : { Triangles, Surfaces, Curves })
    {
      made.Keep(port, this->Model->GetOutputDataObject(port));
    }
    made.Keep(Numbers, table);
    return {};
  }

  /// Options that were given and count for charts and nets of splines alone.
  void WarnOfUnused(Session& session) const
  {
    std::string unused;
    for (const char* name :
      { "--method", "--degree", "--elements", "--maximum-elements", "--margin", "--smoothing",
        "--centres", "--maximum-functions", "--flatten", "--laplacian-weights", "--geodesics",
        "--neighbours", "--landmarks", "--maximum-iterations", "--minimum-participation",
        "--fallback", "--maximum-charts", "--crease-angle" })
    {
      if (this->App->get_option(name)->count() > 0)
      {
        unused += (unused.empty() ? "" : ", ") + std::string(name);
      }
    }
    if (!unused.empty())
    {
      session.Warn({ unused +
        " did not count: the mesh has planes, cylinders, spheres, cones or "
        "tori; --features off makes splines alone" });
    }
  }

  /// Writes the file, reads it again and reports what was found in it.
  Status WriteFaces(vtkDataObject* surfaces, vtkDataObject* curves, Session& session)
  {
    CADSummary found;
    Status status = session.WriteFaces(surfaces, curves, this->Output, found);
    if (status && Processes::Own() == 0)
    {
      status = this->CheckWritten(found, session);
    }
    return Processes::Agree(status);
  }

  Status CheckWritten(const CADSummary& found, Session& session) const
  {
    const double tolerance = session.Report["tolerance"];
    session.Report["brep_valid"] = found.Valid;
    session.Report["max_edge_tolerance"] = found.MaxEdgeTolerance;
    session.Report["max_vertex_tolerance"] = found.MaxVertexTolerance;
    session.Report["file_faces"] = found.NumFaces;
    session.Report["file_loops"] = found.NumFreeLoops;
    session.Report["file_area"] = found.Area;
    if (!found.Valid)
    {
      return { ErrorCode::InvalidTopology,
        "'" + this->Input + "': its faces are not valid when '" + this->Output +
          "' is read again: " +
          (found.Defects.empty() ? "no reason given" : found.Defects.front()) +
          "; look for points far off or edges below the tolerance, and ask for a smaller one" };
    }
    std::vector<std::string> warnings;
    if (std::max(found.MaxEdgeTolerance, found.MaxVertexTolerance) > tolerance)
    {
      warnings.push_back("'" + this->Output + "' has an edge or vertex tolerance of " +
        std::to_string(std::max(found.MaxEdgeTolerance, found.MaxVertexTolerance)) +
        ", above the tolerance " + std::to_string(tolerance));
    }
    session.Warn(warnings);
    return {};
  }

  static bool HasPlane(vtkDataObject* mesh)
  {
    auto* points = vtkPointSet::SafeDownCast(mesh);
    vtkDataArray* uv = points ? points->GetPointData()->GetArray("UV") : nullptr;
    return uv && uv->GetNumberOfComponents() == 2;
  }

  void AddNumbers(vtkDataObject* mesh, nlohmann::ordered_json& report)
  {
    vtkTable* table = vtkTable::SafeDownCast(this->Trim->GetOutputDataObject(Numbers));
    const auto value = [table](const char* name) { return table->GetValueByName(0, name); };
    report["points"] = mesh->GetNumberOfElements(vtkDataObject::POINT);
    report["triangles"] = mesh->GetNumberOfElements(vtkDataObject::CELL);
    ReportTruths(table, 0, { "WithinTolerance", "LoopsProved" }, report);
    ReportRow(table, 0,
      { "Tolerance", "MaxDeviation", "MaxDeviationFound", "RmsDeviation", "MaxBoundaryDistance",
        "MaxEdgeGap", "MinNormalBound", "Area", "MeshArea", "Faces", "Loops", "Edges", "Vertices",
        "ControlPoints", "Passes", "Work", "Stopped", "Verdict", "LoopVerdict", "Nets" },
      report);
    report["charts"] = value("Faces").ToInt();
    for (const char* type : { "planes", "cylinders", "spheres", "cones", "tori" })
    {
      report[type] = 0;
    }
    report["free_faces"] = value("Faces").ToInt();
    report["centres_used"] = value("Centres").ToInt();
    report["face_triangles"] = value("Triangles").ToInt();
    report["seconds_of_trimming"] = this->Trim->GetSeconds();
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<TrimJob>();
  job->App = &app;
  app
    .add_option("mesh", job->Input,
      "triangle mesh (.off .obj .ply .stl .vtp .vtu), or one in each block of a collection "
      "(.vtpc); "
      "with a point array UV it is used as it is, else it is laid into the plane first")
    ->required();
  AddOutput(
    app, "--output", job->Output, Endings::Surfaces, "the trimmed faces, or their surfaces alone")
    ->required();
  AddOutput(app, "--surface", job->Files[Surfaces], Endings::Spline, "the surfaces as Bezier grid");
  AddOutput(
    app, "--curves", job->Files[Curves], Endings::Grid, "the trimming curves as Bezier grid");
  AddOutput(app, "--triangles", job->Files[Triangles], Endings::Polygons,
    "the faces as watertight triangles");
  AddOutput(
    app, "--deviation", job->Files[Deviation], Endings::Polygons, "the mesh with its deviation");
  AddOutput(
    app, "--flat", job->Files[Flat], Endings::Polygons, "the mesh with plane coordinates UV");
  AddOutput(app, "--table", job->Files[Numbers], Endings::Table, "the numbers");
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  options.Add<bool>(
    "Features", true, [job = job.get()](const bool& on) { job->Features = on; },
    "whether planes, cylinders, spheres, cones and tori in a mesh become faces of these, with "
    "splines beside them, instead of splines alone (not with --flat or --deviation)");
  options.Add<double>(
    "SnapDistance", 0.0,
    [job = job.get()](const double& distance) { job->Model->SetSnapDistance(distance); },
    "directions, positions and sizes of planes, cylinders, spheres, cones and tori that are nearly "
    "equal become equal where surfaces then move by this distance at most at the points of their "
    "regions, unit of the points, up to the tolerance; 0: all keep their own");
  options.LeaveOut({ "Triangulation" });
  AddProperties(options, job->Trim);
  job->Flatten->SetMaximumStretch(ChartStretch);
  options.LeaveOut({ "FlatOutput" });
  options.Rename("Method", "Flatten");
  AddProperties(options, job->Flatten);
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "trim", "turn a triangle mesh into trimmed spline faces",
  "shell.off --tolerance 0.01 --output shell.step --report shell.json", Make,
  JobProcesses::Several };
}
}
