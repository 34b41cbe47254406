// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkSplineRefine.h"

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkSphere.h>

#include <memory>

namespace knotwork
{
namespace
{
struct RefineJob
{
  std::string Input;
  std::string Output;
  std::string Array;
  std::vector<double> Sphere;
  std::vector<double> Plane;
  vtkNew<vtkSplineRefine> Filter;
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
    if (Status status = session.CheckGridFormat(input.Value, this->Output); !status)
    {
      return status;
    }
    this->Filter->SetInputDataObject(input.Value);
    this->FilterOptions->Apply(session.Report);
    this->Filter->SetThreads(session.Threads);
    this->ChooseElements(session);
    if (Status status = session.Run(this->Filter, "'" + this->Input + "'"); !status)
    {
      return status;
    }
    session.Report["elements"] =
      this->Filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL);
    return session.Write(this->Filter->GetOutputDataObject(0), this->Output);
  }

  /// An array, a sphere or a plane says which elements are refined; none of them: all.
  void ChooseElements(Session& session)
  {
    if (!this->Array.empty())
    {
      session.Report["array"] = this->Array;
      this->Filter->SetMode(vtkSplineRefine::CELL_ARRAY);
      this->Filter->SetInputArrayToProcess(
        0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, this->Array.c_str());
    }
    else if (!this->Sphere.empty())
    {
      session.Report["sphere"] = this->Sphere;
      vtkNew<vtkSphere> sphere;
      sphere->SetCenter(this->Sphere.data());
      sphere->SetRadius(this->Sphere[3]);
      this->Filter->SetMode(vtkSplineRefine::IMPLICIT_FUNCTION);
      this->Filter->SetImplicitFunction(sphere);
    }
    else if (!this->Plane.empty())
    {
      session.Report["plane"] = this->Plane;
      vtkNew<vtkPlane> plane;
      plane->SetOrigin(this->Plane.data());
      plane->SetNormal(this->Plane.data() + 3);
      this->Filter->SetMode(vtkSplineRefine::IMPLICIT_FUNCTION);
      this->Filter->SetImplicitFunction(plane);
    }
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<RefineJob>();
  app.add_option("input", job->Input, "spline grid (.vtu .vtpc .xml .g2 .step .iges)")->required();
  AddOutput(app, "--output", job->Output, Endings::Splines, "the refined grid, same type")
    ->required();
  auto* array =
    app.add_option("--array", job->Array, "refine cells by the value of this cell array");
  auto* sphere = app.add_option("--sphere", job->Sphere, "refine at a sphere: centre and radius")
                   ->expected(4)
                   ->excludes(array);
  app.add_option("--plane", job->Plane, "refine at a plane: origin and normal")
    ->expected(6)
    ->excludes(array)
    ->excludes(sphere);
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkSplineRefine* filter = job->Filter;
  KNOTWORK_OPTION(options, filter, NumberOfRefinements, "how often");
  KNOTWORK_FREE_OPTION(options, filter, GlobalRefinement,
    "whether a patch with marked elements is refined everywhere");
  KNOTWORK_OPTION(options, filter, DegreeElevation, "degrees added before elements are refined");
  KNOTWORK_FREE_OPTION(options, filter, LowerThreshold, "lowest value of a marked cell");
  KNOTWORK_FREE_OPTION(options, filter, UpperThreshold, "highest value of a marked cell");
  options.AddChoice(
    "ImplicitRegion", { "crossed", "crossed-or-inside" }, filter->GetImplicitRegion(),
    [filter](int region) { filter->SetImplicitRegion(region); },
    "which cells at the sphere or plane");
  KNOTWORK_OPTION(options, filter, Extension,
    "rings of new cells around marked ones that are split too; -1: as few as bring new functions");
  KNOTWORK_OPTION(options, filter, AdmissibleClass,
    "functions alive on an element belong to at most so many levels; 0: no limit");
  KNOTWORK_OPTION(options, filter, MaxLevel, "cells of this level are not split");
  options.AddChoice(
    "LocalSpace", { "thb", "lr" }, filter->GetLocalSpace(),
    [filter](int space) { filter->SetLocalSpace(space); },
    "what local refinement makes of tensor-product surfaces");
  options.AddChoice(
    "LrStrategy", { "full-span", "minimum-span", "structured-mesh" }, filter->GetLRStrategy(),
    [filter](int strategy) { filter->SetLRStrategy(strategy); },
    "how long lines of LR patches are");
  options.AddChoice(
    "LrTarget", { "elements", "functions" }, filter->GetLRTarget(),
    [filter](int target) { filter->SetLRTarget(target); }, "what is halved in LR patches");
  options.AddChoice(
    "LrDirections", { "both", "alternating", "first", "second" }, filter->GetLRDirections(),
    [filter](int directions) { filter->SetLRDirections(directions); },
    "the parameter that is constant on new lines of LR patches");
  KNOTWORK_FREE_OPTION(options, filter, KeepIndependent,
    "whether the functions of LR patches are made linearly independent, with no refinements too");
  KNOTWORK_OPTION(options, filter, MaximumFunctions, "more functions are not made");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "refine", "refine a spline, uniformly or locally",
  "plate.vtu --sphere 1 0 0 0.3 --output fine.vtu", Make };
}
}
