// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkTemplateMapping.h"

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkTable.h>

#include <memory>

namespace knotwork
{
namespace
{
struct MapJob
{
  std::string Template;
  std::string Target;
  std::string Output;
  std::string Mapped;
  std::string Table;
  vtkNew<vtkTemplateMapping> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    const std::string* files[] = { &this->Template, &this->Target };
    for (int port = 0; port < 2; ++port)
    {
      auto input = session.Read(*files[port]);
      if (!input)
      {
        return input.Status;
      }
      this->Filter->SetInputDataObject(port, input.Value);
    }
    session.Report["template"] = this->Template;
    session.Report["target"] = this->Target;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    this->Filter->SetThreads(session.Threads);
    if (Status status =
          session.Run(this->Filter, "'" + this->Template + "' onto '" + this->Target + "'");
        !status)
    {
      return status;
    }
    this->AddNumbers(session.Report);
    return session.WriteOutputs(this->Filter, { this->Output, this->Mapped, this->Table });
  }

  void AddNumbers(nlohmann::ordered_json& report)
  {
    auto* table = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(2));
    const auto column = [table](const char* name)
    {
      std::vector<double> values;
      auto* array = vtkDataArray::SafeDownCast(table->GetColumnByName(name));
      for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
      {
        values.push_back(array->GetTuple1(i));
      }
      return values;
    };
    const std::vector<double> errors = column("SquaredL2Error");
    const std::vector<double> negative = column("NegativeJacobianPercent");
    report["squared_l2_error"] = errors.back();
    report["max_error"] = column("MaxError").back();
    report["negative_jacobian_percent"] = negative.back();
    report["functions"] = static_cast<long long>(column("Functions").back());
    report["iterations"] = static_cast<long long>(column("Iteration").back());
    report["squared_l2_errors"] = errors;
    report["negative_jacobian_percents"] = negative;
  }
};
}

Job MakeMapJob(CLI::App& app)
{
  auto job = std::make_shared<MapJob>();
  app.add_option("template", job->Template, "skeleton of the template (.vtp)")->required();
  app.add_option("target", job->Target, "target patches with the same PatchId (.vtp)")->required();
  app.add_option("--output", job->Output, "the map as Bezier grid (.vtu)")->required();
  app.add_option("--mapped", job->Mapped, "the mapped skeleton with distances (.vtp)");
  app.add_option("--table", job->Table, "the convergence table (.csv)");
  job->FilterOptions = std::make_unique<Options>(app);
  vtkTemplateMapping* filter = job->Filter;
  job->FilterOptions->AddChoice(
    "Method", { "fixed", "pdm", "tdm" }, filter->GetMethod(),
    [filter](int method) { filter->SetMethod(method); },
    "fixed parameters, point or tangent distance minimization");
  Options& options = *job->FilterOptions;
  KNOTWORK_OPTION(options, filter, Iterations, "number of iterations");
  KNOTWORK_OPTION(options, filter, Degree, "degree of the map");
  KNOTWORK_OPTION(options, filter, InnerKnots, "inner knots in each direction");
  KNOTWORK_OPTION(options, filter, TemplateSamples,
    "samples of each template patch for closest points; 0: the points as given");
  KNOTWORK_OPTION(options, filter, NewtonSteps, "Newton steps after the closest sample");
  KNOTWORK_OPTION(options, filter, TikhonovWeight, "weight of the distance to the last iterate");
  return [job](Session& session) { return job->Run(session); };
}
}
