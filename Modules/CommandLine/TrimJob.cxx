// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"
#include "FlattenNumbers.h"

#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/MeshParameterization/vtkMeshParameterization.h>
#include <knotwork/SurfaceTrimming/vtkAnalyticModel.h>
#include <knotwork/SurfaceTrimming/vtkTrimmedSurface.h>

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <algorithm>
#include <memory>

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

struct TrimJob
{
  std::string Input;
  std::string Output;
  std::string FlatFile;
  std::string TriangleFile;
  std::string SurfaceFile;
  std::string CurveFile;
  std::string DeviationFile;
  std::string TableFile;
  bool Features = true;
  CLI::App* App = nullptr;
  vtkNew<vtkAnalyticModel> Model;
  vtkNew<vtkMeshParameterization> Flatten;
  vtkNew<vtkTrimmedSurface> Trim;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    const bool asCAD = HasCADEnding(this->Output);
    auto input = session.Read(this->Input);
    if (!input)
    {
      return input.Status;
    }
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    const std::string what = "'" + this->Input + "'";
    vtkDataObject* mesh = input.Value;
    session.Report["analytic"] = false;
    if (this->Features && !HasPlane(mesh) && this->FlatFile.empty() && this->DeviationFile.empty())
    {
      bool done = false;
      Status status = this->RunModel(mesh, what, session, done);
      if (!status || done)
      {
        return status;
      }
    }
    session.Report["flatten_method"] = "given";
    session.Report["fallback"] = false;
    session.Report["injective"] = true; // else there is no result
    session.Report["flipped_triangles"] = 0;
    std::vector<std::string> warnings; // of the chart; a face that fails says more of it
    if (!HasPlane(mesh))
    {
      this->Flatten->SetInputDataObject(mesh);
      this->Flatten->SetThreads(session.Threads);
      if (Status status = session.Run(this->Flatten, what, 0, &warnings); !status)
      {
        return status;
      }
      ReportFlattening(this->Flatten, "flatten_", session.Report);
      mesh = this->Flatten->GetOutputDataObject(0);
      if (!this->FlatFile.empty())
      {
        if (Status status = session.Write(mesh, this->FlatFile); !status)
        {
          return status;
        }
      }
    }
    this->Trim->SetInputDataObject(mesh);
    this->Trim->SetTriangulation(!this->TriangleFile.empty());
    this->Trim->SetThreads(session.Threads);
    if (Status status = session.Run(this->Trim, what, Surfaces); !status)
    {
      return status;
    }
    session.Warn(warnings);
    this->AddNumbers(mesh, session.Report);
    Status status = asCAD ? this->WriteFaces(this->Trim, session)
                          : session.Write(this->Trim->GetOutputDataObject(Surfaces), this->Output);
    return status ? session.WriteOutputs(this->Trim,
                      { this->TriangleFile, this->SurfaceFile, this->CurveFile, this->DeviationFile,
                        this->TableFile })
                  : status;
  }

  /// Planes, cylinders, ... when the mesh is made of such.
  /// @param done  result: false when it is not, and spline faces are to be made.
  Status RunModel(vtkDataObject* mesh, const std::string& what, Session& session, bool& done)
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
    const Status made = session.Run(this->Model, what, Surfaces, &warnings);
    vtkTable* table = vtkTable::SafeDownCast(this->Model->GetOutputDataObject(NumbersOfModel));
    done = made && warnings.empty();
    if (!done)
    {
      // meshes that are no surface at all are refused there too, with more to say
      session.Report["why_not_analytic"] = made ? warnings.front() : made.Detail;
      return made.Code == ErrorCode::Aborted ? made : Status();
    }
    session.Report["analytic"] = true;
    this->WarnOfUnused(session);
    session.Report["points"] = mesh->GetNumberOfElements(vtkDataObject::POINT);
    session.Report["triangles"] = mesh->GetNumberOfElements(vtkDataObject::CELL);
    ReportTruths(table, 0, { "WithinTolerance", "LoopsProved" }, session.Report);
    ReportRow(table, 0,
      { "Tolerance", "MaxDeviation", "MaxNormalAngle", "MaxSag", "MaxEdgeDistance", "MaxEdgeGap",
        "MinNormalBound", "Area", "MeshArea", "Faces", "Planes", "Cylinders", "Spheres", "Cones",
        "Tori", "Extrusions", "Revolutions", "FreeFaces", "Loops", "Edges", "Lines", "Circles",
        "SharpEdges", "Vertices", "ControlPoints", "Verdict", "LoopVerdict", "SnappedSurfaces",
        "CommonDirections", "CommonPositions", "CommonSizes", "MaxTurn" },
      session.Report);
    Status status = HasCADEnding(this->Output)
      ? this->WriteFaces(this->Model, session)
      : session.Write(this->Model->GetOutputDataObject(Surfaces), this->Output);
    return status ? session.WriteOutputs(this->Model,
                      { this->TriangleFile, this->SurfaceFile, this->CurveFile, this->TableFile })
                  : status;
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
  /// @param filter  of the surfaces and curves.
  Status WriteFaces(vtkAlgorithm* filter, Session& session)
  {
    CADSummary found;
    Status status = session.WriteFaces(filter->GetOutputDataObject(Surfaces),
      filter->GetOutputDataObject(Curves), this->Output, found);
    if (!status)
    {
      return status;
    }
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
      "triangle mesh (.off .obj .ply .stl .vtp .vtu); with a point array UV it is used as it is, "
      "else it is laid into the plane first")
    ->required();
  AddOutput(
    app, "--output", job->Output, Endings::Surfaces, "the trimmed faces, or their surfaces alone")
    ->required();
  AddOutput(app, "--surface", job->SurfaceFile, Endings::Spline, "the surfaces as Bezier grid");
  AddOutput(app, "--curves", job->CurveFile, Endings::Grid, "the trimming curves as Bezier grid");
  AddOutput(
    app, "--triangles", job->TriangleFile, Endings::Polygons, "the faces as watertight triangles");
  AddOutput(
    app, "--deviation", job->DeviationFile, Endings::Polygons, "the mesh with its deviation");
  AddOutput(app, "--flat", job->FlatFile, Endings::Polygons, "the mesh with plane coordinates UV");
  AddOutput(app, "--table", job->TableFile, Endings::Table, "the numbers");
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
  "shell.off --tolerance 0.01 --output shell.step --report shell.json", Make };
}
}
