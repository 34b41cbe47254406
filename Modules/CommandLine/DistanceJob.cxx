// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkSplinePointDistance.h"

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkPointSet.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <memory>

namespace knotwork
{
namespace
{
struct DistanceJob
{
  std::string Points;
  std::string Surface;
  std::string Output;
  std::string ClassFile;
  std::vector<double> Tolerances;
  vtkNew<vtkSplinePointDistance> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    auto points = session.Read(this->Points);
    auto surface = points ? session.Read(this->Surface) : points.Status;
    if (!surface)
    {
      return surface.Status;
    }
    if (!vtkPointSet::SafeDownCast(points.Value))
    {
      return { ErrorCode::InvalidTopology,
        "'" + this->Points + "' is no single set of points; give one of its parts" };
    }
    if (Status status = session.CheckFormat(points.Value, this->Output); !status)
    {
      return status;
    }
    this->Filter->SetInputDataObject(0, points.Value);
    this->Filter->SetInputDataObject(1, surface.Value);
    session.Report["points"] = this->Points;
    session.Report["surface"] = this->Surface;
    session.Report["output"] = this->Output;
    this->FilterOptions->Apply(session.Report);
    for (const double tolerance : this->Tolerances)
    {
      this->Filter->AddTolerance(tolerance);
    }
    session.Report["tolerances"] = this->Tolerances;
    this->Filter->SetThreads(session.Threads);
    if (Status status =
          session.Run(this->Filter, "'" + this->Points + "' from '" + this->Surface + "'");
        !status)
    {
      return status;
    }
    this->AddNumbers(session.Report);
    Status status = this->Output.empty()
      ? Status()
      : session.Write(this->Filter->GetOutputDataObject(0), this->Output);
    return status && !this->ClassFile.empty()
      ? session.Write(this->Filter->GetOutputDataObject(1), this->ClassFile)
      : status;
  }

  void AddNumbers(nlohmann::ordered_json& report)
  {
    vtkTable* all = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(2));
    vtkTable* classes = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(1));
    report["kind"] = all->GetValueByName(0, "Kind").ToString();
    report["points_measured"] = all->GetValueByName(0, "Points").ToLongLong();
    report["points_without"] = all->GetValueByName(0, "PointsWithout").ToLongLong();
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
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<DistanceJob>();
  app
    .add_option("points", job->Points, "points (.xyz .txt .csv .ply .g2 .vtp .vtu .off .obj .stl)")
    ->required();
  app.add_option("surface", job->Surface, "spline surfaces (.vtu .vtpc .xml .g2 .step .iges)")
    ->required();
  AddOutput(app, "--output", job->Output, Endings::Sampled,
    "the points with their distances and classes (.vtp or .vtu, as they are)")
    ->required();
  AddOutput(app, "--class-table", job->ClassFile, Endings::Table, "statistics of every class");
  app.add_option("--tolerances", job->Tolerances, "limits of the classes, ascending");
  job->FilterOptions = std::make_unique<Options>(app);
  vtkSplinePointDistance* filter = job->Filter;
  job->FilterOptions->AddChoice(
    "Kind", { "automatic", "vertical", "closest" }, filter->GetKind(),
    [filter](int kind) { filter->SetKind(kind); },
    "vertical distances, those from closest points, or vertical ones of height fields");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "distance", "measure how far points are from spline surfaces",
  "scan.xyz terrain.vtu --tolerances 0.01 0.05 --output distances.vtp --report distances.json",
  Make };
}
}
