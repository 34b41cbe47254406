// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/vtkSplineEvaluate.h>

#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

namespace knotwork
{
namespace
{
class EvaluateJob : public FilterJob<vtkSplineEvaluate>
{
public:
  explicit EvaluateJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "input", "spline grid (.vtu .vtpc .xml .g2 .bext .mesh .step .iges)");
    this->AddInput(1, "points", "points (.vtp .vtu)", " at ");
    this->Divide(1, Share::Points);
    this->AddOutput(0, "--output", Endings::Sampled, "the points on the spline, with derivatives");
    this->AddProperties();
  }

protected:
  Status Prepare(Session& session) override
  {
    return session.CheckFormat(this->Input(1), this->MainOutput());
  }

  Status AddNumbers(Session& session) override
  {
    auto* result = vtkPointSet::SafeDownCast(this->Filter->GetOutputDataObject(0));
    session.Report["number_of_points"] = Session::Total(result->GetNumberOfPoints());
    if (this->Filter->GetMode() == vtkSplineEvaluate::PROBE)
    {
      vtkDataArray* distance = result->GetPointData()->GetArray("Distance"); // null without points
      session.Report["max_distance"] = Session::Largest(distance ? distance->GetRange()[1] : 0.0);
    }
    return {};
  }
};

const JobRegistration Registration{ "evaluate", "evaluate a spline at points, with derivatives",
  "terrain.vtu scan.xyz --mode probe --output values.vtp", MakeJob<EvaluateJob>,
  JobProcesses::Several };
}
}
