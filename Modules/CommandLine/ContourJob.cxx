// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineIO/MapOutput.h>

#include <knotwork/SurfaceFeatures/vtkSplineContour.h>

#include <vtkTable.h>
#include <vtkVariant.h>

#include <algorithm>

namespace knotwork
{
namespace
{
/// Of vtkSplineContour.
enum Port
{
  Polylines,
  Curves,
  Levels,
  Undecided
};

class ContourJob : public FilterJob<vtkSplineContour>
{
public:
  explicit ContourJob(CLI::App& app) : FilterJob(app)
  {
    this->DecisivePort = Levels;
    this->AddInput(0, "input", "surfaces (.vtu .vtpc .xml .g2)");
    this->Divide(0, Share::Blocks);
    this->AddOutput(Polylines, "--output", Endings::Contours,
      "polylines (.vtp .gpkg), or spline curves with the same bound");
    this->AddOutput(Levels, "--table", Endings::Table, "table of the levels");
    this->AddOutput(
      Undecided, "--undecided", Endings::Polygons, "what stayed undecided, if anything");
    app.add_option("--levels", this->GivenLevels, "values of the contours");
    app.add_option("--crs", this->ReferenceSystem,
      "coordinate reference system of the surfaces, such as EPSG:25832; without it theirs");
    this->FilterOptions.Rename("NumberOfLevels", "Number");
    this->FilterOptions.Rename("FieldName", "Field");
    this->AddProperties({ "Curves" });
  }

protected:
  Status Prepare(Session& session) override
  {
    // a map tells its system, and one that is not known is refused before the work
    if (!this->ReferenceSystem.empty() || LowerEnding(this->MainOutput()) == ".gpkg")
    {
      const auto name = StateReferenceSystem(this->ReferenceSystem, this->Input(0));
      if (!name)
      {
        return name.Status;
      }
      session.Report["reference_system"] = name.Value;
    }
    for (double level : this->GivenLevels)
    {
      this->Filter->AddLevel(level);
    }
    const std::string ending = LowerEnding(this->MainOutput());
    const bool curves = ending != ".vtp" && ending != ".gpkg";
    this->Filter->SetCurves(curves);
    this->WriteMainFrom(curves ? Curves : Polylines);
    return {};
  }

  Status AddNumbers(Session& session) override
  {
    nlohmann::ordered_json& report = session.Report;
    vtkTable* table = this->Table(Levels);
    std::vector<double> levels;
    std::vector<int> components;
    std::vector<int> closed;
    std::vector<int> undecided;
    long long points = 0;
    double maxError = 0.0;
    for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
    {
      levels.push_back(table->GetValueByName(row, "Level").ToDouble());
      components.push_back(table->GetValueByName(row, "Components").ToInt());
      closed.push_back(table->GetValueByName(row, "Closed").ToInt());
      undecided.push_back(table->GetValueByName(row, "Undecided").ToInt());
      points += table->GetValueByName(row, "Points").ToLongLong();
      maxError = std::max(maxError, table->GetValueByName(row, "MaxError").ToDouble());
    }
    const auto sum = [](const std::vector<int>& counts)
    {
      long long total = 0;
      for (int count : counts)
      {
        total += count;
      }
      return total;
    };
    report["tolerance"] = table->GetValueByName(0, "Tolerance").ToDouble();
    report["levels"] = levels;
    report["components"] = sum(components);
    report["closed"] = sum(closed);
    report["undecided"] = sum(undecided);
    report["points"] = points;
    report["max_error"] = maxError;
    report["level_components"] = components;
    report["level_closed"] = closed;
    report["level_undecided"] = undecided;
    return {};
  }

private:
  std::vector<double> GivenLevels;
  std::string ReferenceSystem;
};

const JobRegistration Registration{ "contour",
  "iso-curves of a spline surface to a guaranteed tolerance",
  "terrain.vtu --levels 0.05 0.1 --tolerance 1e-3 --output lines.vtp --report lines.json",
  MakeJob<ContourJob>, JobProcesses::Several };
}
}
