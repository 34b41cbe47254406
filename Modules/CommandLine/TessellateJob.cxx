// SPDX-License-Identifier: BSD-3-Clause
#include "FilterProperties.h"
#include "Jobs.h"
#include "Options.h"
#include "Session.h"
#include "Shares.h"
#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SplineCore/FileEnding.h>

#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/SplineBlocks.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <knotwork/SplineIO/PieceFiles.h>
#include <knotwork/SplineIO/vtkCADReader.h>

#include <vtkCellType.h>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkUnstructuredGrid.h>

#include <memory>

namespace knotwork
{
namespace
{
bool HasOnlyCurves(vtkDataObject* splines)
{
  for (const auto& [block, grid] : GridsByBlock(splines))
  {
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
    {
      if (grid->GetCellType(cell) != VTK_BEZIER_CURVE)
      {
        return false;
      }
    }
  }
  return true;
}

struct TessellateJob
{
  std::string Input;
  std::string Output;
  vtkNew<vtkSplineTessellate> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status CheckFormat(Session& session, vtkDataObject* like, bool isLines) const
  {
    const FileFormat* format = FormatOfEnding(LowerEnding(this->Output));
    const unsigned contents = format ? format->Writes : 0U;
    if (isLines && (contents & PolygonContent) != 0 && (contents & PolylineContent) == 0)
    {
      return { ErrorCode::InvalidParameter,
        "'" + this->Output +
          "': curves have no polygons, and the format has nothing else; write "
          ".vtp" };
    }
    return session.CheckFormat(like, this->Output);
  }

  /// Trimmed faces have a triangulation of their own.
  Status RunCAD(Session& session)
  {
    if (Status status = session.Files.CheckInput(this->Input); !status)
    {
      return status;
    }
    vtkNew<vtkCADReader> reader;
    reader->SetFileName(this->Input.c_str());
    reader->SetChordalTolerance(this->Filter->GetChordalTolerance());
    reader->SetRelativeTolerance(this->Filter->GetRelativeTolerance());
    reader->SetThreads(session.Threads);
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    if (Status status = this->CheckFormat(session, reader->GetOutputDataObject(2), false); !status)
    {
      return status;
    }
    if (Status status = session.Run(reader, "'" + this->Input + "'"); !status)
    {
      return status;
    }
    session.NoteReader(reader, this->Input);
    vtkDataObject* result = reader->GetOutputDataObject(2);
    session.Report["number_of_points"] = result->GetNumberOfElements(vtkDataObject::POINT);
    session.Report["number_of_cells"] = result->GetNumberOfElements(vtkDataObject::CELL);
    return session.Write(result, this->Output);
  }

  Status Run(Session& session)
  {
    if (HasCADEnding(this->Input) && Processes::Count() > 1)
    {
      return { ErrorCode::InvalidParameter,
        "'" + this->Input +
          "': trimmed faces are tessellated by one process; start it without "
          "mpirun" };
    }
    if (HasCADEnding(this->Input))
    {
      return this->RunCAD(session);
    }
    auto input = session.Read(this->Input);
    if (!input)
    {
      return input.Status;
    }
    // of a grid, each process makes its part; of a collection, its blocks
    const bool isByParts =
      Processes::Count() > 1 && !vtkPartitionedDataSetCollection::SafeDownCast(input.Value);
    if (isByParts)
    {
      this->Filter->SetPart(Processes::Own(), Processes::Count(), true);
    }
    this->Filter->SetInputDataObject(isByParts ? input.Value : ShareOf(input.Value, Share::Blocks));
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    this->Filter->SetThreads(session.Threads);
    this->Filter->UpdateDataObject();
    vtkDataObject* like = this->Filter->GetOutputDataObject(0);
    if (Status status =
          Processes::Agree(this->CheckFormat(session, like, HasOnlyCurves(input.Value)));
        !status)
    {
      return status;
    }
    if (Status status = session.Run(this->Filter, "'" + this->Input + "'"); !status)
    {
      return status;
    }
    vtkDataObject* result = this->Filter->GetOutputDataObject(0);
    session.Report["number_of_points"] = isByParts
      ? NumberOfTessellationPoints(result)
      : Session::Total(result->GetNumberOfElements(vtkDataObject::POINT));
    session.Report["number_of_cells"] =
      Session::Total(result->GetNumberOfElements(vtkDataObject::CELL));
    if (isByParts && IsPieceIndex(this->Output))
    {
      return session.Write(result, this->Output);
    }
    const auto whole = isByParts ? UniteTessellation(result) : AppendShares(result);
    const Status united = Processes::Agree(whole.Status);
    return united ? session.Write(whole.Value, this->Output) : united;
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<TessellateJob>();
  app
    .add_option("input", job->Input,
      "spline grid (.vtu .vtpc .xml .g2 .bext .mesh), or trimmed faces (.step .iges)")
    ->required();
  AddOutput(
    app, "--output", job->Output, Endings::Cells, "linear cells (surface .vtp, volume .vtu)")
    ->required();
  job->FilterOptions = std::make_unique<Options>(app);
  AddProperties(*job->FilterOptions, job->Filter);
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "tessellate", "turn a spline into polygons within a tolerance",
  "plate.vtu --chordal-tolerance 1e-4 --output plate.vtp", Make, JobProcesses::Several };
}
}
