// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "CADExchange.h"
#include "vtkSplineTrimToPoints.h"

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkPointSet.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <memory>

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

struct CropJob
{
  std::string Surface;
  std::string Points;
  std::string Output;
  std::string TriangleFile;
  std::string CurveFile;
  vtkNew<vtkSplineTrimToPoints> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    auto surface = session.Read(this->Surface);
    auto points = surface ? session.Read(this->Points) : surface.Status;
    if (!points)
    {
      return points.Status;
    }
    if (!vtkPointSet::SafeDownCast(points.Value))
    {
      return { ErrorCode::InvalidTopology,
        "'" + this->Points + "' is no single set of points; give one of its parts" };
    }
    this->Filter->SetInputDataObject(0, surface.Value);
    this->Filter->SetInputDataObject(1, points.Value);
    session.Report["surface"] = this->Surface;
    session.Report["points"] = this->Points;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    this->Filter->SetTriangulation(!this->TriangleFile.empty());
    this->Filter->SetThreads(session.Threads);
    if (Status status = session.Run(
          this->Filter, "'" + this->Surface + "' with '" + this->Points + "'", Surfaces);
        !status)
    {
      return status;
    }
    vtkTable* table = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(Numbers));
    for (const char* name : { "Faces", "Loops", "Edges", "ControlPoints", "PointsOutside" })
    {
      session.Report[Options::SnakeCase(name)] = table->GetValueByName(0, name).ToInt();
    }
    for (const char* name : { "CellSize", "MaximumGap", "Tolerance", "MaxTrimDistance" })
    {
      session.Report[Options::SnakeCase(name)] = table->GetValueByName(0, name).ToDouble();
    }
    for (const char* name : { "LoopsProved", "FacesRegular" })
    {
      session.Report[Options::SnakeCase(name)] = table->GetValueByName(0, name).ToInt() != 0;
    }
    Status status;
    if (HasCADEnding(this->Output))
    {
      CADSummary found;
      status = session.WriteFaces(this->Filter->GetOutputDataObject(Surfaces),
        this->Filter->GetOutputDataObject(Curves), this->Output, found);
      session.Report["brep_valid"] = found.Valid;
      session.Report["file_area"] = found.Area;
    }
    else
    {
      status = session.Write(this->Filter->GetOutputDataObject(Surfaces), this->Output);
    }
    return status
      ? session.WriteOutputs(this->Filter, { this->TriangleFile, std::string(), this->CurveFile })
      : status;
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<CropJob>();
  app.add_option("surface", job->Surface, "a spline surface (.vtu .xml .g2)")->required();
  app
    .add_option("points", job->Points,
      "the points it was fitted to (.xyz .txt .csv .ply .g2 .vtp .vtu); with the array UV unless "
      "the surface is a height field")
    ->required();
  AddOutput(
    app, "--output", job->Output, Endings::Surfaces, "the trimmed faces, or their surface alone")
    ->required();
  AddOutput(app, "--triangles", job->TriangleFile, Endings::Polygons, "the faces as triangles");
  AddOutput(app, "--curves", job->CurveFile, Endings::Grid, "the trimming curves as Bezier grid");
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkSplineTrimToPoints* filter = job->Filter;
  KNOTWORK_OPTION(options, filter, CellSize,
    "side of the cells that tell where points are; 0: 2.5 times the mean spacing");
  KNOTWORK_OPTION(
    options, filter, MaximumGap, "holes and bays up to this width are closed; 0: two cells");
  KNOTWORK_OPTION(options, filter, MinimumCells, "separate parts with fewer cells are left out");
  KNOTWORK_OPTION(options, filter, Tolerance,
    "largest distance between outline and trimming curves; 0: a third of a cell");
  KNOTWORK_OPTION(options, filter, ChordalTolerance,
    "largest distance between triangles and faces; 0: a quarter of the tolerance");
  KNOTWORK_OPTION(options, filter, MaximumFunctions, "larger tensor products are not made");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "crop", "trim a fitted surface to where its points are",
  "terrain.vtu scan.xyz --output face.step --report crop.json", Make };
}
}
