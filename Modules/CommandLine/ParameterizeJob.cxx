// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/DomainParameterization/vtkDomainParameterization.h>

#include <vtkFieldData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

namespace knotwork
{
namespace
{
class ParameterizeJob : public FilterJob<vtkDomainParameterization>
{
public:
  explicit ParameterizeJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "boundary",
      "four curves or six faces, one patch a side (.vtu .vtpc .xml .g2 .json)", "", "input");
    this->AddInput(1, "--layout",
      "a mesh of quadrilaterals or hexahedra, one a patch: the boundary then has a curve or face "
      "for every edge or face on its boundary (.vtu .vtp)",
      " with ");
    this->AddOutput(0, "--output", Endings::Spline, "the map as Bezier grid");
    this->AddOutput(1, "--first-map", Endings::Spline, "the map before the optimization");
    this->AddOutput(2, "--table", Endings::Table, "the convergence table");
    Options& options = this->FilterOptions;
    vtkDomainParameterization* filter = this->Filter;
    KNOTWORK_CHOICE(options, filter, InitialMap, "the map the optimization begins with",
      "automatic", "coons", "spring", "harmonic");
    KNOTWORK_CHOICE(
      options, filter, Optimizer, "how it is minimized", "automatic", "lbfgs", "newton");
    KNOTWORK_CHOICE(options, filter, Foldover, "how folds of the first map are removed",
      "automatic", "penalty", "relu");
    KNOTWORK_CHOICE(options, filter, Weights,
      "whether inner weights move too; automatic: when control points alone give no valid map",
      "automatic", "fixed", "optimized");
    KNOTWORK_CHOICE(options, filter, Objective,
      "what is made best; least-jacobian: from Winslow's functional on, the largest least det J",
      "winslow", "least-jacobian");
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
    KNOTWORK_OPTION(options, filter, MaximumRefinements,
      "rounds of local refinement of a space that is too poor");
    KNOTWORK_OPTION(
      options, filter, GapTolerance, "ends of sides this part of the size apart are one corner");
    KNOTWORK_OPTION(
      options, filter, MetricSamples, "samples a direction of the metrics; 0: 501, in space 51");
    KNOTWORK_OPTION(
      options, filter, CertificateGap, "relative gap of the proved bounds of elements");
    KNOTWORK_OPTION(options, filter, MaximumFunctions, "a larger map is refused");
    KNOTWORK_OPTION(options, filter, MinimumDegree, "with a layout: of directions of patches");
    KNOTWORK_OPTION(options, filter, MinimumElements, "with a layout: of directions of patches");
    KNOTWORK_FREE_OPTION(
      options, filter, MoveInterfaces, "with a layout: whether sides between patches move");
  }

protected:
  Status AddNumbers(Session& session) override
  {
    vtkFieldData* data = this->Filter->GetOutputDataObject(0)->GetFieldData();
    const auto number = [data](const char* name) { return data->GetArray(name)->GetTuple1(0); };
    const auto text = [data](const char* name)
    { return vtkStringArray::SafeDownCast(data->GetAbstractArray(name))->GetValue(0); };
    session.Report["verdict"] = text("Verdict");
    session.Report["injective"] = text("Injective");
    session.Report["min_jacobian_lower"] = number("JacobianMinLower");
    session.Report["min_jacobian_upper"] = number("JacobianMinUpper");
    session.Report["area"] = number("Area");
    session.Report["min_det_over_area"] = number("MinDetOverArea");
    session.Report["max_det_over_area"] = number("MaxDetOverArea");
    session.Report["min_scaled_jacobian"] = number("MinScaledJacobian");
    session.Report["mean_scaled_jacobian"] = number("MeanScaledJacobian");
    session.Report["mean_condition_number"] = number("MeanConditionNumber");
    session.Report["iterations"] = static_cast<long long>(number("Iterations"));
    session.Report["functions"] = static_cast<long long>(number("Functions"));
    session.Report["patches"] = static_cast<long long>(number("Patches"));
    session.Report["stopped"] = text("Stopped");
    session.Report["work"] = number("Work");
    session.Report["seconds_with_certificate"] = this->Filter->GetSecondsWithCertificate();
    return {};
  }
};

const JobRegistration Registration{ "parameterize",
  "fill a boundary with a spline map that is proved valid",
  "boundary.json --output map.vtu --report map.json", MakeJob<ParameterizeJob> };
}
}
