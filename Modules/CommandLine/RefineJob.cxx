// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/vtkSplineRefine.h>

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkSphere.h>

namespace knotwork
{
namespace
{
class RefineJob : public FilterJob<vtkSplineRefine>
{
public:
  explicit RefineJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "input", "spline grid (.vtu .vtpc .xml .g2 .step .iges)");
    this->AddOutput(0, "--output", Endings::Splines, "the refined grid, same type");
    auto* array =
      app.add_option("--array", this->Array, "refine cells by the value of this cell array");
    auto* sphere =
      app.add_option("--sphere", this->Sphere, "refine at a sphere: centre and radius")
        ->expected(4)
        ->excludes(array);
    app.add_option("--plane", this->Plane, "refine at a plane: origin and normal")
      ->expected(6)
      ->excludes(array)
      ->excludes(sphere);
    Options& options = this->FilterOptions;
    vtkSplineRefine* filter = this->Filter;
    KNOTWORK_OPTION(options, filter, NumberOfRefinements, "how often");
    KNOTWORK_FREE_OPTION(options, filter, GlobalRefinement,
      "whether a patch with marked elements is refined everywhere");
    KNOTWORK_OPTION(options, filter, DegreeElevation, "degrees added before elements are refined");
    KNOTWORK_FREE_OPTION(options, filter, LowerThreshold, "lowest value of a marked cell");
    KNOTWORK_FREE_OPTION(options, filter, UpperThreshold, "highest value of a marked cell");
    KNOTWORK_CHOICE(options, filter, ImplicitRegion, "which cells at the sphere or plane",
      "crossed", "crossed-or-inside");
    KNOTWORK_OPTION(options, filter, Extension,
      "rings of new cells around marked ones that are split too; -1: as few as bring new "
      "functions");
    KNOTWORK_OPTION(options, filter, AdmissibleClass,
      "functions alive on an element belong to at most so many levels; 0: no limit");
    KNOTWORK_OPTION(options, filter, MaxLevel, "cells of this level are not split");
    KNOTWORK_CHOICE(options, filter, LocalSpace,
      "what local refinement makes of tensor-product surfaces", "thb", "lr");
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
  }

protected:
  Status Prepare(Session& session) override
  {
    this->ChooseElements(session);
    return session.CheckGridFormat(this->Input(0), this->MainOutput());
  }

  Status AddNumbers(Session& session) override
  {
    session.Report["elements"] =
      this->Filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL);
    return {};
  }

private:
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

  std::string Array;
  std::vector<double> Sphere;
  std::vector<double> Plane;
};

const JobRegistration Registration{ "refine", "refine a spline, uniformly or locally",
  "plate.vtu --sphere 1 0 0 0.3 --output fine.vtu", MakeJob<RefineJob> };
}
}
