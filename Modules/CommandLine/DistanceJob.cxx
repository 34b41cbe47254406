// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SurfaceFitting/vtkSplinePointDistance.h>

#include <vtkVariant.h>

namespace knotwork
{
namespace
{
class DistanceJob : public FilterJob<vtkSplinePointDistance>
{
public:
  explicit DistanceJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "points", "points (.xyz .txt .csv .ply .g2 .vtp .vtu .off .obj .stl)");
    this->AddInput(
      1, "surface", "spline surfaces (.vtu .vtpc .xml .g2 .bext .mesh .step .iges)", " from ");
    this->AddOutput(0, "--output", Endings::Sampled,
      "the points with their distances and classes (.vtp or .vtu, as they are)");
    this->AddOutput(1, "--class-table", Endings::Table, "statistics of every class");
    app.add_option("--tolerances", this->Tolerances, "limits of the classes, ascending");
    this->AddProperties();
  }

protected:
  Status Prepare(Session& session) override
  {
    for (const double tolerance : this->Tolerances)
    {
      this->Filter->AddTolerance(tolerance);
    }
    session.Report["tolerances"] = this->Tolerances;
    const Status status = this->RequirePointSet(0);
    return status ? session.CheckFormat(this->Input(0), this->MainOutput()) : status;
  }

  Status AddNumbers(Session& session) override
  {
    nlohmann::ordered_json& report = session.Report;
    vtkTable* classes = this->Table(1);
    vtkTable* all = this->Table(2);
    ReportRow(all, 0, { "Kind", "PointsWithout" }, report);
    report["points_measured"] = all->GetValueByName(0, "Points").ToLongLong();
    for (const char* name : { "Min", "Max", "Mean", "MeanAbsolute", "Rms" })
    {
      report[Options::SnakeCase(name) + "_distance"] = all->GetValueByName(0, name).ToDouble();
    }
    std::vector<int> numbers;
    std::vector<long long> counts;
    for (vtkIdType row = 0; row < classes->GetNumberOfRows(); ++row)
    {
      numbers.push_back(classes->GetValueByName(row, "Class").ToInt());
      counts.push_back(classes->GetValueByName(row, "Points").ToLongLong());
    }
    report["classes"] = numbers;
    report["class_points"] = counts;
    return {};
  }

private:
  std::vector<double> Tolerances;
};

const JobRegistration Registration{ "distance", "measure how far points are from spline surfaces",
  "scan.xyz terrain.vtu --tolerances 0.01 0.05 --output distances.vtp --report distances.json",
  MakeJob<DistanceJob> };
}
}
