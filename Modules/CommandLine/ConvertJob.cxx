// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Ranges.h"
#include "Session.h"
#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineGrid/ReferenceSystem.h>
#include <knotwork/SplineGrid/SplineBlocks.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineIO/FileFormats.h>
#include <knotwork/SplineIO/PieceFiles.h>

#include <CLI/CLI.hpp>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <memory>

namespace knotwork
{
namespace
{
struct ConvertJob
{
  std::string Input;
  std::string Output;
  std::string Curves;
  std::string Encoding = "binary";
  std::size_t Pieces = 1;

  /// STEP and IGES: faces are surfaces and trimming curves, whatever else their grids hold.
  Status RunCAD(Session& session, vtkDataObject* surfaces)
  {
    const bool fromCAD = HasCADEnding(this->Input);
    vtkSmartPointer<vtkDataObject> curves = session.Curves;
    if (!fromCAD && !this->Curves.empty())
    {
      auto read = session.Read(this->Curves);
      if (!read)
      {
        return read.Status;
      }
      curves = read.Value;
    }
    if (fromCAD && !this->Curves.empty())
    {
      if (Status status = session.Write(curves, this->Curves, this->Written()); !status)
      {
        return status;
      }
    }
    if (!HasCADEnding(this->Output) || !curves)
    {
      return session.Write(surfaces, this->Output, this->Written());
    }
    CADSummary found;
    Status status = session.WriteFaces(surfaces, curves, this->Output, found);
    if (!status && !fromCAD && !this->Curves.empty())
    {
      status.Detail += " (curves of '" + this->Curves + "')";
    }
    return status;
  }

  /// Boundary curves of g2: from the file or --curves to the file or --curves.
  Status CarryBoundaries(Session& session)
  {
    if (LowerEnding(this->Input) == ".g2")
    {
      session.BoundaryCurves = session.Curves;
      return this->Curves.empty() || !session.Curves
        ? Status()
        : session.Write(session.Curves, this->Curves, this->Written());
    }
    if (LowerEnding(this->Output) == ".g2" && !this->Curves.empty())
    {
      auto read = session.Read(this->Curves);
      session.BoundaryCurves = read.Value;
      return read.Status;
    }
    return {};
  }

  DataFileParams Written() const
  {
    DataFileParams params;
    params.Encoding = this->Encoding;
    params.Pieces = this->Pieces;
    return params;
  }

  /// What cannot be written is the input's fault too.
  Status Run(Session& session)
  {
    Status status = this->Convert(session);
    if (!status && status.Detail.find(this->Input) == std::string::npos)
    {
      status.Detail += " (of '" + this->Input + "')";
    }
    return status;
  }

  /// From or to a solver's mesh, whose cells are no splines.
  bool CarriesMesh() const
  {
    const FileFormat* from = FormatOfEnding(LowerEnding(this->Input));
    const FileFormat* to = FormatOfEnding(LowerEnding(this->Output));
    const auto isMesh = [](unsigned contents)
    { return (contents & GridContent) != 0 && (contents & SplineGridContent) == 0; };
    return from && to && (to->Writes & GridContent) != 0 &&
      (isMesh(from->Reads) || isMesh(to->Writes));
  }

  Status Convert(Session& session)
  {
    const bool writesCurves = HasCADEnding(this->Input) || LowerEnding(this->Input) == ".g2";
    if (writesCurves && !this->Curves.empty())
    {
      Status status = PlanOutput("--curves", this->Curves, Endings::Splines, session.Files);
      if (!status)
      {
        return status;
      }
    }
    auto input = session.Read(this->Input);
    if (!input)
    {
      return input.Status;
    }
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    session.Report["encoding"] = this->Encoding;
    vtkSmartPointer<vtkDataObject> data = input.Value;
    const bool toGrid = LowerEnding(this->Output) == ".vtu";
    if (HasCADEnding(this->Output) || (HasCADEnding(this->Input) && toGrid))
    {
      return this->RunCAD(session, data);
    }
    if (Status status = this->CarryBoundaries(session); !status)
    {
      return status;
    }
    const bool isOfPieces = IsPieceIndex(this->Input) || IsPieceIndex(this->Output);
    if (!vtkPolyData::SafeDownCast(data) && !this->CarriesMesh() &&
      (!isOfPieces || HoldsSplines(data)))
    {
      // a decoded model written again has its attributes tagged and its schema complete
      Result<SplineModel> model = DecodeSplineModel(data, session.Threads);
      if (!model)
      {
        return { model.Status.Code, "'" + this->Input + "': " + model.Status.Message() };
      }
      if (model->Patches.empty())
      {
        return { ErrorCode::EmptyInput, "'" + this->Input + "' holds no splines, only points" };
      }
      session.Warn(model->Warnings);
      session.Report["patches"] = model->Patches.size();
      const bool collection = LowerEnding(this->Output) == ".vtpc";
      if (collection && !vtkPartitionedDataSetCollection::SafeDownCast(data))
      {
        vtkNew<vtkPartitionedDataSetCollection> like;
        like->SetNumberOfPartitionedDataSets(1);
        like->SetPartition(0, 0, data);
        data = like;
      }
      vtkSmartPointer<vtkDataObject> output = !collection
        ? vtkSmartPointer<vtkDataObject>(vtkSmartPointer<vtkUnstructuredGrid>::New())
        : vtkSmartPointer<vtkDataObject>(vtkSmartPointer<vtkPartitionedDataSetCollection>::New());
      const Status status = !collection
        ? EncodeSplineGrid(model.Value, vtkUnstructuredGrid::SafeDownCast(output))
        : EncodeSplineModel(model.Value, data, output);
      if (!status)
      {
        return { status.Code, "'" + this->Input + "': " + status.Message() };
      }
      SetReferenceSystem(output, ReferenceSystemOf(input.Value));
      data = output;
    }
    return session.Write(data, this->Output, this->Written());
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<ConvertJob>();
  app
    .add_option("input", job->Input,
      "spline grid, skeleton, mesh or points (.vtu .vtp .vtpc .vtk .xml .g2 .bext .mesh .msh .inp "
      ".step .iges .stl .off .obj .ply .xyz .txt .csv)")
    ->required();
  AddOutput(app, "--output", job->Output,
    Endings::Writing(
      SplineGridContent | SplineCollectionContent | PointContent | PolygonContent | GridContent),
    "the same data (.vtu .vtp .vtpc .xml .g2 .bext .json .step .iges, points .xyz .txt .csv .g2, "
    "meshes .stl .obj .ply .msh .mesh)")
    ->required();
  app.add_option("--curves", job->Curves,
    "trimming curves (.vtu): written when the input is STEP, IGES or g2, else read");
  app.add_option("--encoding", job->Encoding, "how numbers are written in .vtu .vtp .vtpc .msh")
    ->check(CLI::IsMember({ "ascii", "binary", "appended" }))
    ->capture_default_str();
  app.add_option("--pieces", job->Pieces, "parts of a .pvtu, for as many processes")
    ->check(InRange(1, 1000000))
    ->capture_default_str();
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "convert", "write a dataset in another format or encoding",
  "plate.vtu --output plate.step", Make };
}
}
