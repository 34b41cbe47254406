// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkSplineWarp.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointSet.h>

#include <memory>

namespace knotwork
{
namespace
{
struct WarpJob
{
  std::string Input;
  std::string Map;
  std::string Output;
  vtkNew<vtkSplineWarp> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    const std::string* files[] = { &this->Input, &this->Map };
    for (int port = 0; port < 2; ++port)
    {
      auto input = session.Read(*files[port]);
      if (!input)
      {
        return input.Status;
      }
      Status status = port == 0 ? session.CheckFormat(input.Value, this->Output) : Status();
      if (!status)
      {
        return status;
      }
      this->Filter->SetInputDataObject(port, input.Value);
    }
    session.Report["input"] = this->Input;
    session.Report["map"] = this->Map;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    this->Filter->SetThreads(session.Threads);
    if (Status status =
          session.Run(this->Filter, "'" + this->Input + "' through '" + this->Map + "'");
        !status)
    {
      return status;
    }
    vtkDataObject* result = this->Filter->GetOutputDataObject(0);
    session.Report["number_of_points"] = result->GetNumberOfElements(vtkDataObject::POINT);
    session.Report["number_of_cells"] = result->GetNumberOfElements(vtkDataObject::CELL);
    auto* dataSet = vtkPointSet::SafeDownCast(result);
    if (vtkDataArray* distance = dataSet ? dataSet->GetCellData()->GetArray("Distance") : nullptr)
    {
      session.Report["max_distance"] = distance->GetRange()[1];
    }
    return session.Write(result, this->Output);
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<WarpJob>();
  app
    .add_option(
      "input", job->Input, "points or splines to send (.vtu .vtp .vtpc .xml .g2 .step .iges)")
    ->required();
  app.add_option("map", job->Map, "the spline map (.vtu .xml .g2 .step .iges)")->required();
  AddOutput(app, "--output", job->Output, Endings::Anything, "the image, same type as the input")
    ->required();
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkSplineWarp* filter = job->Filter;
  KNOTWORK_FREE_OPTION(options, filter, MapPatchId, "patch of the map; -1: the only one");
  KNOTWORK_FREE_OPTION(
    options, filter, Clamp, "whether points outside the domain are moved to its border");
  KNOTWORK_OPTION(
    options, filter, Tolerance, "wanted distance of projected splines; 0: no refinement");
  KNOTWORK_OPTION(options, filter, MaxLevel, "levels that refinement may add");
  KNOTWORK_OPTION(options, filter, MaximumFunctions, "more functions are not made");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "warp", "send points or splines through a spline map",
  "scan.xyz plate.vtu --output warped.vtp", Make };
}
}
