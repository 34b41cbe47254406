// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkSplineExtract.h"

#include <vtkDataObject.h>
#include <vtkNew.h>

#include <memory>

namespace knotwork
{
namespace
{
struct ExtractJob
{
  std::string Input;
  std::string Output;
  std::vector<double> Box;
  vtkNew<vtkSplineExtract> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    auto input = session.Read(this->Input);
    if (!input)
    {
      return input.Status;
    }
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    this->Filter->SetInputDataObject(input.Value);
    if (!this->Box.empty())
    {
      session.Report["box"] = this->Box;
      this->Filter->RestrictToBoxOn();
      this->Filter->SetBox(this->Box.data());
    }
    this->FilterOptions->Apply(session.Report);
    this->Filter->SetThreads(session.Threads);
    const bool asCurves = this->Filter->GetIsoCurve() != 0;
    if (Status status = session.CheckGridFormat(input.Value, this->Output, asCurves); !status)
    {
      return status;
    }
    if (Status status = session.Run(this->Filter, "'" + this->Input + "'"); !status)
    {
      return status;
    }
    session.Report["elements"] =
      this->Filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL);
    return session.Write(this->Filter->GetOutputDataObject(0), this->Output);
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<ExtractJob>();
  app.add_option("input", job->Input, "spline surfaces (.vtu .vtpc .xml .g2 .step .iges)")
    ->required();
  AddOutput(app, "--output", job->Output, Endings::Splines, "the part or curve")->required();
  app.add_option("--box", job->Box, "keep the part over u0 u1 v0 v1 only")->expected(4);
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkSplineExtract* filter = job->Filter;
  KNOTWORK_FREE_OPTION(options, filter, SwapParameters, "whether the parameters are exchanged");
  KNOTWORK_FREE_OPTION(options, filter, ReverseFirst, "whether the first parameter is reversed");
  KNOTWORK_FREE_OPTION(options, filter, ReverseSecond, "whether the second parameter is reversed");
  KNOTWORK_FREE_OPTION(
    options, filter, ExpandToTensor, "whether LR surfaces become tensor products");
  options.AddChoice(
    "IsoCurve", { "none", "first", "second" }, filter->GetIsoCurve(),
    [filter](int direction) { filter->SetIsoCurve(direction); },
    "the parameter that is constant on a curve that is taken instead of the surface");
  KNOTWORK_FREE_OPTION(options, filter, IsoValue, "its value");
  KNOTWORK_OPTION(options, filter, MaximumFunctions, "more functions are not made");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "extract",
  "take a part or an iso-curve of surfaces, or exchange, reverse, expand",
  "terrain.vtu --box 0.2 0.8 0.2 0.8 --output part.vtu", Make };
}
}
