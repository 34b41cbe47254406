// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/TemplateMapping/vtkTemplateMapping.h>

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

namespace knotwork
{
namespace
{
/// The space, what is minimized, and when that ends.
void AddFitOptions(Options& options, vtkTemplateMapping* filter)
{
  KNOTWORK_CHOICE(options, filter, Method,
    "fixed parameters, point or tangent distance minimization, or both weighted", "fixed", "pdm",
    "tdm", "weighted");
  KNOTWORK_OPTION(options, filter, Iterations, "number of iterations");
  KNOTWORK_OPTION(options, filter, Degree, "degree of the map");
  KNOTWORK_OPTION(options, filter, InnerKnots, "inner knots in each direction");
  KNOTWORK_VECTOR_OPTION(options, filter, InnerKnotsPerDirection, int,
    "the same of the single directions; -1: the common number");
  KNOTWORK_OPTION(options, filter, TemplateSamples,
    "samples of each template patch for closest points; 0: the points as given");
  KNOTWORK_OPTION(options, filter, NewtonSteps, "Newton steps after the closest sample");
  KNOTWORK_OPTION(options, filter, PdmWeight, "of point distances, with --method weighted");
  KNOTWORK_OPTION(options, filter, TdmWeight, "of tangent distances, with --method weighted");
  KNOTWORK_OPTION(options, filter, TikhonovWeight, "weight of the distance to the last iterate");
  KNOTWORK_OPTION(options, filter, UniformityWeight, "of the integral of sum |s_kl|^2");
  KNOTWORK_OPTION(options, filter, LengthWeight, "of the integral of sum |s_k|^2");
  KNOTWORK_OPTION(options, filter, OrthogonalityWeight, "of the integral of sum (s_k . s_l)^2");
  KNOTWORK_OPTION(
    options, filter, SkewnessWeight, "of the integral of sum cos^4 of the angles of s_k and s_l");
  KNOTWORK_OPTION(
    options, filter, EccentricityWeight, "of the integral of sum ((s_k . s_kk) / |s_k|^2)^2");
  KNOTWORK_OPTION(options, filter, AreaWeight, "of the integral of (det J)^2");
  KNOTWORK_OPTION(
    options, filter, SelfIntersectionWeight, "of the integral of sum 1 / (|s_k|^2 + 1e-7)^2");
  KNOTWORK_CHOICE(options, filter, InitialMap,
    "the first map: the identity, or that with control points moved by mean displacements",
    "identity", "moved");
  options.AddChoice(
    "Guard", { "off", "on" }, filter->GetGuard() ? 1 : 0,
    [filter](int guard) { filter->SetGuard(guard == 1); },
    "keep every iterate regular: det J > 0 is proved everywhere");
  options.AddChoice(
    "Injectivity", { "off", "on" }, filter->GetInjectivity() ? 1 : 0,
    [filter](int prove) { filter->SetInjectivity(prove == 1); },
    "whether the map as a whole is proved injective");
  KNOTWORK_OPTION(options, filter, Accuracy, "end when the largest error is not above this");
  KNOTWORK_OPTION(options, filter, MaxIrregularShare,
    "end with the iterate before when det J < 0 at a larger share of a million points");
}

/// How the space grows.
void AddRefinementOptions(Options& options, vtkTemplateMapping* filter)
{
  options.AddChoice(
    "Refine", { "none", "local", "global" }, filter->GetRefinement(),
    [filter](int refinement) { filter->SetRefinement(refinement); },
    "smaller cells between iterations: where errors are large, or everywhere");
  KNOTWORK_OPTION(
    options, filter, RefineEvery, "after so many iterations; 0: when the error stagnates");
  KNOTWORK_OPTION(options, filter, StagnationRatio,
    "the error stagnates when it falls by a smaller part of itself in an iteration");
  KNOTWORK_OPTION(options, filter, RefineThreshold, "local: errors from this on mark their cell");
  KNOTWORK_OPTION(options, filter, RefineShare,
    "local: the errors of this share of the samples mark their cell; 0: the threshold alone does");
  KNOTWORK_OPTION(options, filter, Extension, "local: cells of the new level around a marked one");
  KNOTWORK_OPTION(options, filter, MaxLevel, "cells of this level are not refined");
  KNOTWORK_OPTION(options, filter, MaxFunctions, "a refinement to more functions is not made");
}

class MapJob : public FilterJob<vtkTemplateMapping>
{
public:
  explicit MapJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "template", "skeleton of the template (.vtp .vtu)");
    this->AddInput(1, "target", "target patches with the same PatchId (.vtp .vtu)", " onto ");
    this->AddInput(
      2, "--initial", "the map to start with: spline grid of one patch (.vtu)", " from ");
    this->AddOutput(0, "--output", Endings::Spline, "the map as Bezier grid");
    this->AddOutput(1, "--mapped", Endings::Points, "the mapped skeleton with distances");
    this->AddOutput(2, "--table", Endings::Table, "the convergence table");
    app
      .add_option("--domain", this->Domain,
        "box of the map: xmin xmax ymin ymax [zmin zmax]; without it the template's")
      ->expected(4, 6)
      ->check(CLI::Number);
    AddFitOptions(this->FilterOptions, this->Filter);
    AddRefinementOptions(this->FilterOptions, this->Filter);
  }

protected:
  Status Prepare(Session& session) override
  {
    if (this->Domain.size() == 5)
    {
      return { ErrorCode::InvalidParameter, "--domain takes 4 or 6 numbers, not 5" };
    }
    if (!this->Domain.empty())
    {
      session.Report["domain"] = this->Domain;
      this->Domain.resize(6, 0.0);
      this->Filter->SetDomain(this->Domain.data());
      this->Filter->UseDomainOn();
    }
    return {};
  }

  Status AddNumbers(Session& session) override
  {
    nlohmann::ordered_json& report = session.Report;
    vtkTable* table = this->Table(2);
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
    const auto counts = [&](const char* name)
    {
      const std::vector<double> values = column(name);
      return std::vector<long long>(values.begin(), values.end());
    };
    report["functions_per_iteration"] = counts("Functions");
    report["held_elements"] = counts("HeldElements");
    report["step_lengths"] = column("StepLength");
    vtkFieldData* data = this->Filter->GetOutputDataObject(0)->GetFieldData();
    report["min_jacobian_bound"] = data->GetArray("MinJacobianBound")->GetTuple1(0);
    if (auto* injective = vtkStringArray::SafeDownCast(data->GetAbstractArray("Injective")))
    {
      report["injective"] = injective->GetValue(0);
    }
    return {};
  }

private:
  std::vector<double> Domain;
};

const JobRegistration Registration{ "map", "carry a template skeleton onto target patches",
  "template.vtp target.vtp --output map.vtu --report map.json", MakeJob<MapJob> };
}
}
