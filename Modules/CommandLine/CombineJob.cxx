// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkSplineCombine.h"

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <algorithm>
#include <memory>

namespace knotwork
{
namespace
{
struct CombineJob
{
  std::array<std::string, 2> Inputs;
  std::string Output;
  vtkNew<vtkSplineCombine> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    for (int port = 0; port < 2; ++port)
    {
      auto input = session.Read(this->Inputs[static_cast<std::size_t>(port)]);
      if (!input)
      {
        return input.Status;
      }
      Status status = port == 0 ? session.CheckGridFormat(input.Value, this->Output) : Status();
      if (!status)
      {
        return status;
      }
      this->Filter->SetInputDataObject(port, input.Value);
    }
    session.Report["first"] = this->Inputs[0];
    session.Report["second"] = this->Inputs[1];
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    this->Filter->SetThreads(session.Threads);
    const std::string what = "'" + this->Inputs[0] + "' and '" + this->Inputs[1] + "'";
    if (Status status = session.Run(this->Filter, what); !status)
    {
      return status;
    }
    vtkTable* table = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(1));
    int functions = 0;
    double lower = table->GetValueByName(0, "MinBound").ToDouble();
    double upper = table->GetValueByName(0, "MaxBound").ToDouble();
    for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
    {
      functions += table->GetValueByName(row, "Functions").ToInt();
      lower = std::min(lower, table->GetValueByName(row, "MinBound").ToDouble());
      upper = std::max(upper, table->GetValueByName(row, "MaxBound").ToDouble());
    }
    session.Report["patches"] = table->GetNumberOfRows();
    session.Report["functions"] = functions;
    session.Report["min_bound"] = lower;
    session.Report["max_bound"] = upper;
    return session.Write(this->Filter->GetOutputDataObject(0), this->Output);
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<CombineJob>();
  app.add_option("first", job->Inputs[0], "spline surfaces (.vtu .vtpc .xml .g2 .step .iges)")
    ->required();
  app.add_option("second", job->Inputs[1], "spline surfaces over the same domains")->required();
  AddOutput(app, "--output", job->Output, Endings::Splines, "the combination")->required();
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkSplineCombine* filter = job->Filter;
  options.AddChoice(
    "Mode", { "difference", "average", "weighted" }, filter->GetMode(),
    [filter](int mode) { filter->SetMode(mode); }, "first - second, their mean, or any sum");
  KNOTWORK_FREE_OPTION(options, filter, FirstWeight, "weight of the first surface, for weighted");
  KNOTWORK_FREE_OPTION(options, filter, SecondWeight, "weight of the second surface, for weighted");
  KNOTWORK_FREE_OPTION(
    options, filter, CommonDomain, "whether surfaces are cut to what their domains have in common");
  KNOTWORK_OPTION(options, filter, MaximumFunctions, "more functions are not made");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "combine", "subtract or average two spline surfaces",
  "new.vtu old.vtu --mode difference --output change.vtu --report change.json", Make };
}
}
