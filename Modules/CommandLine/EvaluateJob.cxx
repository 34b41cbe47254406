// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkSplineEvaluate.h"

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <memory>

namespace knotwork
{
namespace
{
struct EvaluateJob
{
  std::string Input;
  std::string Points;
  std::string Output;
  vtkNew<vtkSplineEvaluate> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    const std::string* files[] = { &this->Input, &this->Points };
    for (int port = 0; port < 2; ++port)
    {
      auto input = session.Read(*files[port]);
      if (!input)
      {
        return input.Status;
      }
      Status status = port == 1 ? session.CheckFormat(input.Value, this->Output) : Status();
      if (!status)
      {
        return status;
      }
      this->Filter->SetInputDataObject(port, input.Value);
    }
    session.Report["input"] = this->Input;
    session.Report["points"] = this->Points;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    this->Filter->SetThreads(session.Threads);
    if (Status status =
          session.Run(this->Filter, "'" + this->Input + "' at '" + this->Points + "'");
        !status)
    {
      return status;
    }
    auto* result = vtkPointSet::SafeDownCast(this->Filter->GetOutputDataObject(0));
    session.Report["number_of_points"] = result->GetNumberOfPoints();
    if (this->Filter->GetMode() == vtkSplineEvaluate::PROBE)
    {
      session.Report["max_distance"] = result->GetPointData()->GetArray("Distance")->GetRange()[1];
    }
    return session.Write(result, this->Output);
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<EvaluateJob>();
  app.add_option("input", job->Input, "spline grid (.vtu .vtpc .xml .g2 .step .iges)")->required();
  app.add_option("points", job->Points, "points (.vtp .vtu)")->required();
  AddOutput(
    app, "--output", job->Output, Endings::Sampled, "the points on the spline, with derivatives")
    ->required();
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkSplineEvaluate* filter = job->Filter;
  options.AddChoice(
    "Mode", { "parameters", "probe" }, filter->GetMode(),
    [filter](int mode) { filter->SetMode(mode); },
    "points are parameters, or positions whose nearest point on the spline is wanted");
  KNOTWORK_OPTION(options, filter, Derivatives, "highest order of derivatives");
  KNOTWORK_FREE_OPTION(
    options, filter, ParameterArray, "point array of parameters; empty: the coordinates");
  KNOTWORK_FREE_OPTION(options, filter, PatchIdArray, "point array with the patch of each point");
  KNOTWORK_FREE_OPTION(options, filter, PatchId, "patch of all points; -1: the only one");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "evaluate", "evaluate a spline at points, with derivatives",
  "terrain.vtu scan.xyz --mode probe --output values.vtp", Make };
}
}
