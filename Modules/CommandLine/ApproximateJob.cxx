// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SurfaceFitting/vtkSplineVolumeFit.h>

#include <vtkPointSet.h>
#include <vtkTable.h>
#include <vtkVariant.h>

namespace knotwork
{
namespace
{
class ApproximateJob : public FilterJob<vtkSplineVolumeFit>
{
public:
  explicit ApproximateJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "points", "points with values (.csv .txt .vtp .vtu .ply)", "", "input");
    this->AddOutput(0, "--output", Endings::Spline, "the volume with its field");
    this->AddOutput(1, "--points", Endings::Points, "the points with their distances");
    this->AddOutput(2, "--table", Endings::Table, "the iterations");
    app.add_option(
      "--values", this->Array, "point array of the values; without one the active scalars");
    this->AddProperties();
  }

protected:
  Status Prepare(Session& session) override
  {
    if (!this->Array.empty())
    {
      this->Filter->SetInputArrayToProcess(
        0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, this->Array.c_str());
    }
    session.Report["value_array"] = this->Array;
    return this->RequirePointSet(0);
  }

  Status AddNumbers(Session& session) override
  {
    vtkTable* table = this->Table(2);
    const vtkIdType last = table->GetNumberOfRows() - 1;
    const auto value = [&](const char* name) { return table->GetValueByName(last, name); };
    auto& report = session.Report;
    report["points"] =
      vtkPointSet::SafeDownCast(this->Filter->GetOutputDataObject(1))->GetNumberOfPoints();
    report["functions"] = value("Functions").ToLongLong();
    report["elements"] = value("Elements").ToLongLong();
    report["iterations"] = last;
    report["max_error"] = value("MaxError").ToDouble();
    report["rms_error"] = value("RmsError").ToDouble();
    report["points_outside"] = value("PointsOutside").ToLongLong();
    report["within_tolerance"] = value("PointsOutside").ToLongLong() == 0;
    return {};
  }

private:
  std::string Array;
};

const JobRegistration Registration{ "approximate",
  "fit a spline volume to values at scattered points in space",
  "samples.csv --values Temperature --tolerance 0.01 --output field.vtu --report field.json",
  MakeJob<ApproximateJob> };
}
}
