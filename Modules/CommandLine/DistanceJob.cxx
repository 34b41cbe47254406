// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/CADFitting/vtkDeviationMap.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SurfaceFitting/vtkSplinePointDistance.h>

#include <vtkPolyData.h>
#include <vtkVariant.h>

namespace knotwork
{
namespace
{
/// Of vtkDeviationMap.
enum MapPort
{
  ModelPort = 1,
  PercentilePort,
  MapNumbers
};
/// Outputs of both filters are told apart by numbers of ports that the first one has not.
constexpr int FirstMapPort = 10;

enum Branches
{
  OneWay = 1,
  BothWaysBranch
};

class DistanceJob : public FilterJob<vtkSplinePointDistance>
{
public:
  explicit DistanceJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "points", "points (.xyz .txt .csv .ply .g2 .vtp .vtu .off .obj .stl)");
    this->AddInput(1, "surface",
      "spline surfaces (.vtu .vtpc .xml .g2 .bext .mesh .step .iges); with --both-ways also "
      "triangles "
      "and CAD parts with trimmed faces (.brep .off .obj .ply .stl .vtp)",
      " from ");
    this->Divide(0, Share::Points);
    this->AddOutput(0, "--output", Endings::Sampled,
      "the points with their distances and classes (.vtp or .vtu, as they are)");
    this->AddOutput(1, "--class-table", Endings::Table, "statistics of every class");
    this->AddOutput(FirstMapPort + ModelPort, "--model", Endings::Polygons,
      "with --both-ways: triangles of the surface with their distances from the points");
    this->AddOutput(FirstMapPort + PercentilePort, "--percentiles", Endings::Table,
      "with --both-ways: percentiles of the distances, each way");
    app.add_option("--tolerances", this->Tolerances, "limits of the classes, ascending");
    this->FilterOptions.Begin(OneWay, "distances one way");
    this->AddProperties();
    this->FilterOptions.Begin(0, "");
    this->FilterOptions.Add<bool>(
      "BothWays", false, [this](const bool& on) { this->BothWays = on; },
      "whether the points (of triangles, where there are such) and the surface (trimmed faces, "
      "triangles, boundaries of volumes too) are compared both ways; positive is where the points "
      "lie outside");
    this->FilterOptions.Begin(BothWaysBranch, "distances both ways (--both-ways)");
    knotwork::AddProperties(this->FilterOptions, this->Map);
  }

protected:
  Result<int> Branch() override
  {
    if (this->BothWays && Processes::Count() > 1)
    {
      return { ErrorCode::InvalidParameter,
        "--both-ways is done by one process; start it without mpirun" };
    }
    const bool hasMapOutputs = !this->OutputFile(FirstMapPort + ModelPort).empty() ||
      !this->OutputFile(FirstMapPort + PercentilePort).empty();
    if (this->BothWays ? !this->Tolerances.empty() || !this->OutputFile(1).empty() : hasMapOutputs)
    {
      return { ErrorCode::InvalidParameter,
        this->BothWays ? "--both-ways has no classes: leave --tolerances and --class-table out"
                       : "--model and --percentiles need --both-ways" };
    }
    return this->BothWays ? BothWaysBranch : OneWay;
  }

  Status Prepare(Session& session) override
  {
    if (this->BothWays)
    {
      this->Map->SetInputDataObject(0, this->Input(0));
      this->Map->SetInputDataObject(1, this->Input(1));
      this->Map->SetThreads(session.Threads);
      this->Algorithm = this->Map;
    }
    else
    {
      for (const double tolerance : this->Tolerances)
      {
        this->Filter->AddTolerance(tolerance);
      }
      session.Report["tolerances"] = this->Tolerances;
      auto* const triangles = vtkPolyData::SafeDownCast(this->Input(1));
      if (triangles)
      {
        return { ErrorCode::InvalidTopology,
          "'" + this->InputFile(1) + "' " +
            (triangles->GetNumberOfPolys() > 0 ? "holds triangles: give --both-ways"
                                               : "holds no surface: give a spline, or triangles "
                                                 "and --both-ways") };
      }
    }
    const Status status = this->RequirePointSet(0);
    return status ? session.CheckFormat(this->Input(0), this->MainOutput()) : status;
  }

  Status AddNumbers(Session& session) override
  {
    nlohmann::ordered_json& report = session.Report;
    if (this->BothWays)
    {
      this->ReportMap(report);
      return {};
    }
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

  Status Write(Session& session) override
  {
    return this->BothWays ? session.WriteOutputs(this->Map,
                              { this->MainOutput(), this->OutputFile(FirstMapPort + ModelPort),
                                this->OutputFile(FirstMapPort + PercentilePort) })
                          : FilterJob::Write(session);
  }

private:
  void ReportMap(nlohmann::ordered_json& report) const
  {
    vtkTable* numbers = this->Table(MapNumbers);
    vtkTable* percentiles = this->Table(PercentilePort);
    ReportTruths(numbers, 0, { "Signed" }, report);
    ReportRow(numbers, 0,
      { "ScanPoints", "ScanMin", "ScanMax", "ScanMean", "ScanMeanAbsolute", "ScanRms",
        "ModelPoints", "ModelMin", "ModelMax", "ModelMean", "ModelMeanAbsolute", "ModelRms",
        "PointsWithout" },
      report);
    for (const auto& [key, column] :
      { std::pair("percentile_levels", "Percent"), std::pair("scan_percentiles", "ScanToModel"),
        std::pair("model_percentiles", "ModelToScan") })
    {
      std::vector<double> values;
      for (vtkIdType row = 0; row < percentiles->GetNumberOfRows(); ++row)
      {
        values.push_back(percentiles->GetValueByName(row, column).ToDouble());
      }
      report[key] = values;
    }
  }

  vtkNew<vtkDeviationMap> Map;
  bool BothWays = false;
  std::vector<double> Tolerances;
};

const JobRegistration Registration{ "distance",
  "measure how far points are from spline surfaces, or points and a CAD part both ways",
  "scan.xyz terrain.vtu --tolerances 0.01 0.05 --output distances.vtp --report distances.json",
  MakeJob<DistanceJob>, JobProcesses::Several };
}
}
