// SPDX-License-Identifier: BSD-3-Clause
#include "FilterProperties.h"
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineIO/MapOutput.h>
#include <knotwork/SplineIO/Messages.h>
#include <knotwork/SplineIO/vtkGeoTIFFWriter.h>

#include <CLI/CLI.hpp>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <memory>

namespace knotwork
{
namespace
{
struct RasterJob
{
  std::string Input;
  std::string Output;
  vtkNew<vtkGeoTIFFWriter> Writer;
  std::unique_ptr<Options> WriterOptions;

  Status Run(Session& session)
  {
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    this->WriterOptions->Apply(session.Report);
    const auto data = session.Read(this->Input);
    if (!data)
    {
      return data.Status;
    }
    if (vtkPolyData::SafeDownCast(data.Value))
    {
      return { ErrorCode::InvalidTopology,
        "'" + this->Input + "' holds no splines; a raster has heights of spline surfaces" };
    }
    const auto system = StateReferenceSystem(this->Writer->GetReferenceSystem(), data.Value);
    const auto staged = system ? session.Files.Stage(this->Output) : system.Status;
    if (!staged)
    {
      return staged.Status;
    }
    this->Writer->SetInputDataObject(data.Value);
    this->Writer->SetFileName(staged->c_str());
    this->Writer->UseThreads(session.Threads);
    MessageCapture messages;
    session.Measure(
      [this]
      {
        this->Writer->Write();
        return Status();
      });
    session.Warn(messages.Warnings());
    if (this->Writer->GetErrorCode() != 0)
    {
      const Status status(CodeOfFilter(this->Writer), messages.FirstError());
      return status.Code == ErrorCode::FileError
        ? AboutFile(status, this->Output, staged->string())
        : Status(status.Code, "'" + this->Input + "': " + status.Detail);
    }
    const RasterSummary& summary = this->Writer->GetSummary();
    auto& report = session.Report;
    report["reference_system"] = system.Value;
    report["columns"] = summary.Columns;
    report["rows"] = summary.Rows;
    report["lower"] = summary.Lower;
    report["upper"] = summary.Upper;
    report["cells_with_data"] = summary.NumWithData;
    report["cells_without_data"] =
      static_cast<std::int64_t>(summary.Columns) * summary.Rows - summary.NumWithData;
    report["lowest"] = summary.Lowest;
    report["highest"] = summary.Highest;
    return {};
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<RasterJob>();
  app
    .add_option("surfaces", job->Input,
      "surfaces of heights, as fit, tiles and stitch make them, or faces that crop has trimmed "
      "(.vtu .vtpc .xml .g2 .step .iges)")
    ->required();
  AddOutput(
    app, "--output", job->Output, Endings::Writing(HeightRasterContent), "the heights as GeoTIFF")
    ->required();
  job->WriterOptions = std::make_unique<Options>(app);
  job->WriterOptions->Rename("ReferenceSystem", "CRS");
  AddProperties(*job->WriterOptions, job->Writer);
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "raster", "write the heights of surfaces on a raster",
  "terrain.vtu --cell-size 0.05 --crs EPSG:25832 --output heights.tif --report heights.json",
  Make };
}
}
