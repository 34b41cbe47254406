// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkDomainParameterization.h"

#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <memory>

namespace knotwork
{
namespace
{
struct ParameterizeJob
{
  std::string Input;
  std::string Layout;
  std::string Output;
  std::string FirstMap;
  std::string Table;
  vtkNew<vtkDomainParameterization> Filter;
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
    if (!this->Layout.empty())
    {
      auto layout = session.Read(this->Layout);
      if (!layout)
      {
        return layout.Status;
      }
      session.Report["layout"] = this->Layout;
      this->Filter->SetInputDataObject(1, layout.Value);
    }
    this->FilterOptions->Apply(session.Report);
    this->Filter->SetThreads(session.Threads);
    const std::string what =
      "'" + this->Input + "'" + (this->Layout.empty() ? "" : " with '" + this->Layout + "'");
    if (Status status = session.Run(this->Filter, what); !status)
    {
      return status;
    }
    this->AddNumbers(session.Report);
    return session.WriteOutputs(this->Filter, { this->Output, this->FirstMap, this->Table });
  }

  void AddNumbers(nlohmann::ordered_json& report)
  {
    vtkFieldData* data = this->Filter->GetOutputDataObject(0)->GetFieldData();
    const auto number = [data](const char* name) { return data->GetArray(name)->GetTuple1(0); };
    const auto text = [data](const char* name)
    { return vtkStringArray::SafeDownCast(data->GetAbstractArray(name))->GetValue(0); };
    report["verdict"] = text("Verdict");
    report["injective"] = text("Injective");
    report["min_jacobian_lower"] = number("JacobianMinLower");
    report["min_jacobian_upper"] = number("JacobianMinUpper");
    report["area"] = number("Area");
    report["min_det_over_area"] = number("MinDetOverArea");
    report["max_det_over_area"] = number("MaxDetOverArea");
    report["min_scaled_jacobian"] = number("MinScaledJacobian");
    report["mean_scaled_jacobian"] = number("MeanScaledJacobian");
    report["mean_condition_number"] = number("MeanConditionNumber");
    report["iterations"] = static_cast<long long>(number("Iterations"));
    report["functions"] = static_cast<long long>(number("Functions"));
    report["patches"] = static_cast<long long>(number("Patches"));
    report["stopped"] = text("Stopped");
    report["work"] = number("Work");
    report["seconds_with_certificate"] = this->Filter->GetSecondsWithCertificate();
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<ParameterizeJob>();
  app
    .add_option("boundary", job->Input,
      "four curves or six faces, one patch a side (.vtu .vtpc .xml .g2 .json)")
    ->required();
  AddOutput(app, "--output", job->Output, Endings::Spline, "the map as Bezier grid")->required();
  app.add_option("--layout", job->Layout,
    "a mesh of quadrilaterals or hexahedra, one a patch: the boundary then has a curve or face for "
    "every edge or face on its boundary (.vtu .vtp)");
  AddOutput(app, "--first-map", job->FirstMap, Endings::Spline, "the map before the optimization");
  AddOutput(app, "--table", job->Table, Endings::Table, "the convergence table");
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkDomainParameterization* filter = job->Filter;
  options.AddChoice(
    "InitialMap", { "automatic", "coons", "spring", "harmonic" }, filter->GetInitialMap(),
    [filter](int map) { filter->SetInitialMap(map); }, "the map the optimization begins with");
  options.AddChoice(
    "Optimizer", { "automatic", "lbfgs", "newton" }, filter->GetOptimizer(),
    [filter](int optimizer) { filter->SetOptimizer(optimizer); }, "how it is minimized");
  options.AddChoice(
    "Foldover", { "automatic", "penalty", "relu" }, filter->GetFoldover(),
    [filter](int foldover) { filter->SetFoldover(foldover); },
    "how folds of the first map are removed");
  options.AddChoice(
    "Weights", { "automatic", "fixed", "optimized" }, filter->GetWeights(),
    [filter](int weights) { filter->SetWeights(weights); },
    "whether inner weights move too; automatic: when control points alone give no valid map");
  options.AddChoice(
    "Objective", { "winslow", "least-jacobian" }, filter->GetObjective(),
    [filter](int objective) { filter->SetObjective(objective); },
    "what is made best; least-jacobian: from Winslow's functional on, the largest least det J");
  KNOTWORK_OPTION(options, filter, Effort,
    "work at most, about as many seconds of one core, but counted; then the best map so far");
  KNOTWORK_OPTION(
    options, filter, TimeLimit, "seconds at most, then the best map so far; 0: no limit");
  KNOTWORK_OPTION(
    options, filter, FoldoverMargin, "det J over the area that foldover removal by ReLU aims at");
  KNOTWORK_OPTION(
    options, filter, WinslowEpsilon, "added to det J over the area in the functional");
  KNOTWORK_OPTION(options, filter, AlternationTolerance,
    "rounds of control points and weights end when they gain less");
  KNOTWORK_OPTION(options, filter, UniformityWeight, "weight of the variation of det J");
  KNOTWORK_OPTION(options, filter, MaximumIterations, "iterations of one minimization at most");
  KNOTWORK_OPTION(
    options, filter, EnergyTolerance, "a minimization ends when iterations gain a smaller part");
  KNOTWORK_OPTION(
    options, filter, MaximumAlternations, "rounds of control points and weights at most");
  KNOTWORK_OPTION(
    options, filter, MaximumRefinements, "rounds of local refinement of a space that is too poor");
  KNOTWORK_OPTION(
    options, filter, GapTolerance, "ends of sides this part of the size apart are one corner");
  KNOTWORK_OPTION(
    options, filter, MetricSamples, "samples a direction of the metrics; 0: 501, in space 51");
  KNOTWORK_OPTION(options, filter, CertificateGap, "relative gap of the proved bounds of elements");
  KNOTWORK_OPTION(options, filter, MinimumDegree, "with a layout: of directions of patches");
  KNOTWORK_OPTION(options, filter, MinimumElements, "with a layout: of directions of patches");
  KNOTWORK_FREE_OPTION(
    options, filter, MoveInterfaces, "with a layout: whether sides between patches move");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "parameterize",
  "fill a boundary with a spline map that is proved valid",
  "boundary.json --output map.vtu --report map.json", Make };
}
}
