// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/CADFitting/vtkCADFit.h>

#include <vtkVariant.h>

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

class CADFitJob : public FilterJob<vtkCADFit>
{
public:
  explicit CADFitJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "mesh",
      "mesh of quadrilaterals or hexahedra (.off .obj .ply .vtk .vtp .vtu .mesh)", "", "input");
    this->AddInput(1, "--target",
      "what to fit to: a CAD part (.step .stp .iges .igs .brep), triangles (.stl .off .obj "
      ".ply .vtp) or a spline (.vtu .xml .g2); without it the mesh itself",
      " onto ");
    this->AddOutput(SplineGrid, "--output", Endings::Spline, "the spline");
    this->AddOutput(Numbers, "--table", Endings::Table, "its numbers");
    this->AddOutput(
      Entities, "--entities", Endings::Table, "distances on every face and curve of the target");
    this->AddOutput(TargetPoints, "--target-points", Endings::Points,
      "points on the target with their distances from the spline");
    this->AddOutput(Unmatched, "--unmatched", Endings::Points,
      "points at sharp edges of the target that the mesh has no edges for");
    this->AddProperties({ "TargetType" });
  }

protected:
  Status Prepare(Session&) override { return this->RequirePointSet(0); }

  Status AddNumbers(Session& session) override
  {
    vtkTable* table = this->Table(Numbers);
    ReportRow(table, 0,
      { "Functions", "Elements", "Patches", "MaxDistance", "RmsDistance", "MaxDistanceBack",
        "RmsDistanceBack", "MeshMaxDistance", "MeshRmsDistance", "MeshMaxDistanceBack",
        "MeshRmsDistanceBack", "MinJacobianLower", "UncertifiedElements", "InvalidElementsBefore",
        "SmoothedElements", "LayerElements", "FoldedCells", "StillFolded", "UnmatchedFeatures",
        "Area", "Volume" },
      session.Report);
    session.Report["verdict"] = table->GetValueByName(0, "Verdict").ToString();
    session.Report["path"] = table->GetValueByName(0, "Path").ToString();
    const std::string note = table->GetValueByName(0, "PathNote").ToString();
    if (!note.empty())
    {
      session.Report["path_tried"] = table->GetValueByName(0, "PathTried").ToString();
      session.Report["path_note"] = note;
    }
    return {};
  }
};

const JobRegistration Registration{ "cadfit",
  "fit one smooth spline on a mesh to a CAD part, a scan or another shape",
  "part.off --target scan.off --degree 2 --output part.vtu --report part.json",
  MakeJob<CADFitJob> };
}
}
