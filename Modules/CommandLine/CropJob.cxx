// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SurfaceTrimming/vtkSplineTrimToPoints.h>

#include <vtkDataObject.h>

namespace knotwork
{
namespace
{
/// Of vtkSplineTrimToPoints.
enum Port
{
  Triangles,
  Surfaces,
  Curves,
  Numbers
};

class CropJob : public FilterJob<vtkSplineTrimToPoints>
{
public:
  explicit CropJob(CLI::App& app) : FilterJob(app)
  {
    this->DecisivePort = Surfaces;
    this->AddInput(0, "surface", "a spline surface (.vtu .xml .g2)");
    this->AddInput(1, "points",
      "the points it was fitted to (.xyz .txt .csv .ply .g2 .vtp .vtu); with the array UV unless "
      "the surface is a height field",
      " with ");
    this->AddOutput(
      Surfaces, "--output", Endings::Surfaces, "the trimmed faces, or their surface alone");
    this->AddOutput(Triangles, "--triangles", Endings::Polygons, "the faces as triangles");
    this->AddOutput(Curves, "--curves", Endings::Grid, "the trimming curves as Bezier grid");
    this->AddProperties({ "Triangulation" });
  }

protected:
  Status Prepare(Session&) override
  {
    this->Filter->SetTriangulation(!this->OutputFile(Triangles).empty());
    return this->RequirePointSet(1);
  }

  Status AddNumbers(Session& session) override
  {
    vtkTable* table = this->Table(Numbers);
    ReportRow(table, 0,
      { "Faces", "Loops", "Edges", "ControlPoints", "PointsOutside", "CellSize", "MaximumGap",
        "Tolerance", "MaxTrimDistance" },
      session.Report);
    ReportTruths(table, 0, { "LoopsProved", "FacesRegular" }, session.Report);
    return {};
  }

  Status Write(Session& session) override
  {
    vtkDataObject* surfaces = this->Filter->GetOutputDataObject(Surfaces);
    Status status;
    if (HasCADEnding(this->MainOutput()))
    {
      CADSummary found;
      status = session.WriteFaces(
        surfaces, this->Filter->GetOutputDataObject(Curves), this->MainOutput(), found);
      session.Report["brep_valid"] = found.Valid;
      session.Report["file_area"] = found.Area;
    }
    else
    {
      status = session.Write(surfaces, this->MainOutput());
    }
    return status ? session.WriteOutputs(
                      this->Filter, { this->OutputFile(Triangles), {}, this->OutputFile(Curves) })
                  : status;
  }
};

const JobRegistration Registration{ "crop", "trim a fitted surface to where its points are",
  "terrain.vtu scan.xyz --output face.step --report crop.json", MakeJob<CropJob> };
}
}
