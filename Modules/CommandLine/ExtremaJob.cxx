// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SurfaceFeatures/vtkSplineExtrema.h>

#include <vtkTable.h>
#include <vtkVariant.h>

#include <iostream>

namespace knotwork
{
namespace
{
class ExtremaJob : public FilterJob<vtkSplineExtrema>
{
public:
  explicit ExtremaJob(CLI::App& app) : FilterJob(app)
  {
    this->DecisivePort = Numbers; // no point of the chosen kinds is a result, too
    this->AddInput(0, "input", "spline surfaces (.vtu .vtpc .xml .g2 .step .iges)");
    this->Divide(0, Share::Blocks);
    this->AddOutput(0, "--output", Endings::Points, "critical points as vertices");
    this->AddOutput(1, "--boxes", Endings::Polygons, "boxes that hold one point, or a cluster");
    this->AddOutput(Numbers, "--table", Endings::Table, "numbers of points and clusters");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    vtkTable* table = this->Table(Numbers);
    ReportRow(table, 0,
      { "Minima", "Maxima", "Saddles", "Clusters", "ClusterBoxes", "IndexSum",
        "EulerCharacteristic" },
      session.Report);
    ReportTruths(table, 0, { "Proved" }, session.Report);
    session.Report["boundary"] = table->GetValueByName(0, "OnBoundary").ToInt();
    if (!session.Quiet && Processes::Own() == 0)
    {
      const nlohmann::ordered_json& report = session.Report;
      std::cout << report["minima"] << " minima, " << report["maxima"] << " maxima, "
                << report["saddles"] << " saddles (" << report["boundary"] << " on the boundary), "
                << report["clusters"] << " clusters\n";
    }
    return {};
  }

private:
  static constexpr int Numbers = 2;
};

const JobRegistration Registration{ "extrema",
  "find all minima, maxima and saddles of a surface, proved",
  "terrain.vtu --output points.vtp --report extrema.json", MakeJob<ExtremaJob>,
  JobProcesses::Several };
}
}
