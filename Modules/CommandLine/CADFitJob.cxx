// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/CADFitting/vtkCADFit.h>
#include <knotwork/CADFitting/vtkElementCurving.h>
#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SplineCore/FileEnding.h>

#include <vtkVariant.h>

#include <algorithm>

namespace knotwork
{
namespace
{
/// Of vtkCADFit.
enum Port
{
  SplineGrid,
  Numbers,
  Entities,
  TargetPoints,
  Unmatched
};

enum Branches
{
  SmoothSpline = 1,
  Elements
};

constexpr int ElementNumbers = 1; ///< of vtkElementCurving

class CADFitJob : public FilterJob<vtkCADFit>
{
public:
  explicit CADFitJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "mesh",
      "mesh of quadrilaterals or hexahedra, with --elements-only also of triangles, tetrahedra and "
      "wedges (.off .obj .ply .vtk .vtp .vtu .mesh .msh)",
      "", "input");
    this->AddInput(1, "--target",
      "what to fit to: a CAD part (.step .stp .iges .igs .brep), triangles (.stl .off .obj "
      ".ply .vtp) or a spline (.vtu .xml .g2); without it the mesh itself",
      " onto ");
    this->AddOutput(SplineGrid, "--output", Endings::Writing(SplineGridContent | GridContent),
      "the spline, or the elements");
    this->AddOutput(Numbers, "--table", Endings::Table, "its numbers");
    this->AddOutput(
      Entities, "--entities", Endings::Table, "distances on every face and curve of the target");
    this->AddOutput(TargetPoints, "--target-points", Endings::Points,
      "points on the target with their distances from the spline");
    this->AddOutput(Unmatched, "--unmatched", Endings::Points,
      "points at sharp edges of the target that the mesh has no edges for");
    this->FilterOptions.Add<bool>(
      "ElementsOnly", false, [this](const bool& on) { this->ElementsOnly = on; },
      "whether elements of higher order are made instead of a smooth spline");
    this->FilterOptions.Begin(SmoothSpline, "a smooth spline");
    this->AddProperties({ "TargetType" });
    this->FilterOptions.Begin(Elements, "elements alone (--elements-only)");
    knotwork::AddProperties(this->FilterOptions, this->Curving);
  }

protected:
  Result<int> Branch() override
  {
    if (this->ElementsOnly && this->InputFile(1).empty())
    {
      return { ErrorCode::InvalidParameter,
        "--elements-only needs --target: what the elements are curved onto" };
    }
    for (const int port : { Entities, TargetPoints, Unmatched })
    {
      if (this->ElementsOnly && !this->OutputFile(port).empty())
      {
        return { ErrorCode::InvalidParameter,
          "'" + this->OutputFile(port) +
            "' is of a smooth spline: leave it out, or "
            "--elements-only" };
      }
    }
    return this->ElementsOnly ? Elements : SmoothSpline;
  }

  Status Prepare(Session& session) override
  {
    if (Status status = this->CheckEnding(); !status)
    {
      return status;
    }
    if (this->ElementsOnly)
    {
      this->Curving->SetInputDataObject(0, this->Input(0));
      this->Curving->SetInputDataObject(1, this->Input(1));
      this->Curving->SetThreads(session.Threads);
      this->Algorithm = this->Curving;
    }
    return this->RequirePointSet(0);
  }

  Status AddNumbers(Session& session) override
  {
    if (this->ElementsOnly)
    {
      return this->ReportElements(session);
    }
    vtkTable* table = this->Table(Numbers);
    ReportRow(table, 0,
      { "Functions", "Elements", "Patches", "MaxDistance", "RmsDistance", "MaxDistanceBack",
        "RmsDistanceBack", "MaxDistanceBound", "MaxDistanceBackBound", "MeshMaxDistance",
        "MeshRmsDistance", "MeshMaxDistanceBack", "MeshRmsDistanceBack", "MinJacobianLower",
        "UncertifiedElements", "InvalidElementsBefore", "SmoothedElements", "LayerElements",
        "FoldedCells", "StillFolded", "UnmatchedFeatures", "Area", "Volume" },
      session.Report);
    session.Report["verdict"] = table->GetValueByName(0, "Verdict").ToString();
    session.Report["knot_intervals"] = table->GetValueByName(0, "KnotIntervals").ToString();
    session.Report["path"] = table->GetValueByName(0, "Path").ToString();
    const std::string note = table->GetValueByName(0, "PathNote").ToString();
    if (!note.empty())
    {
      session.Report["path_tried"] = table->GetValueByName(0, "PathTried").ToString();
      session.Report["path_note"] = note;
    }
    return {};
  }

private:
  /// Not every format has both, and none but VTK's has Bezier elements.
  Status CheckEnding() const
  {
    const auto endings = EndingsThatWrite(this->ElementsOnly ? GridContent : SplineGridContent);
    const std::string ending = LowerEnding(this->MainOutput());
    const bool isVtk = ending == ".vtu" || ending == ".vtk";
    if (std::find(endings.begin(), endings.end(), ending) != endings.end() &&
      (!this->ElementsOnly || isVtk || this->Curving->GetBasis() == vtkElementCurving::LAGRANGE))
    {
      return {};
    }
    return { ErrorCode::InvalidParameter,
      "'" + this->MainOutput() + "' cannot hold " +
        (this->ElementsOnly ? "such elements; write .vtu, or Lagrange elements"
                            : "a smooth spline; write .vtu, or give --elements-only") };
  }

  Status ReportElements(Session& session)
  {
    vtkTable* table = this->Table(ElementNumbers);
    ReportRow(table, 0,
      { "Points", "Elements", "CertifiedElements", "RelaxedElements", "TurnedElements",
        "BoundaryElements", "Facets", "PointsOnVertices", "PointsOnCurves", "PointsOnFaces",
        "PointsLeft", "PointsInside", "UnmatchedCurves", "CellsLeftOut", "StraightMaxDistance",
        "StraightRmsDistance", "MaxDistance", "RmsDistance", "MinJacobianLower", "Area", "Volume" },
      session.Report);
    session.Report["verdict"] = table->GetValueByName(0, "Verdict").ToString();
    return this->ReportTarget(session);
  }

  /// What the part itself measures, as its kernel says.
  Status ReportTarget(Session& session) const
  {
    const std::string& file = this->InputFile(1);
    const FileFormat* const format = FormatOfEnding(LowerEnding(file));
    if (!format || format->IsOfVTK || (format->Reads & TrimmedFaceContent) == 0)
    {
      return {};
    }
    const auto part = CheckCAD(file);
    if (!part)
    {
      return part.Status;
    }
    const auto compare = [&](const char* name, double target)
    {
      session.Report[std::string("target_") + name] = target;
      session.Report[std::string(name) + "_error"] =
        session.Report[name].get<double>() / target - 1.0;
    };
    if (part->Area > 0.0)
    {
      compare("area", part->Area);
    }
    if (part->Volume > 0.0 && session.Report["volume"].get<double>() > 0.0)
    {
      compare("volume", part->Volume);
    }
    return {};
  }

  vtkNew<vtkElementCurving> Curving;
  bool ElementsOnly = false;
};

const JobRegistration Registration{ "cadfit",
  "fit one smooth spline on a mesh to a CAD part, a scan or another shape",
  "part.off --target scan.off --degree 2 --output part.vtu --report part.json",
  MakeJob<CADFitJob> };
}
}
