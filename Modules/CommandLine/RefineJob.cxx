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
    this->Divide(0, Share::Blocks);
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
    this->AddTableInput(2, "--segments",
      "insert these mesh lines: a table (.csv .txt) with the columns Direction, Value, Start, End, "
      "Multiplicity, PatchId, or lines in the parameter plane (.vtp)");
    this->AddProperties({ "Mode" });
  }

protected:
  Status Prepare(Session& session) override
  {
    this->ChooseElements(session);
    return session.CheckGridFormat(this->Input(0), this->MainOutput());
  }

  Status AddNumbers(Session& session) override
  {
    session.Report["elements"] = Session::Total(
      this->Filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL));
    return {};
  }

private:
  /// An array, a sphere or a plane says which elements are refined, segments where lines go; none
  /// of them: all.
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
    else if (!this->InputFile(2).empty())
    {
      this->Filter->SetMode(vtkSplineRefine::SEGMENTS);
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
  "plate.vtu --sphere 1 0 0 0.3 --output fine.vtu", MakeJob<RefineJob>, JobProcesses::Several };
}
}
