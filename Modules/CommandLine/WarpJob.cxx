// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/vtkSplineWarp.h>

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointSet.h>

namespace knotwork
{
namespace
{
class WarpJob : public FilterJob<vtkSplineWarp>
{
public:
  explicit WarpJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "input", "points or splines to send (.vtu .vtp .vtpc .xml .g2 .step .iges)");
    this->AddInput(1, "map", "the spline map (.vtu .xml .g2 .step .iges)", " through ");
    this->AddOutput(0, "--output", Endings::Anything, "the image, same type as the input");
    Options& options = this->FilterOptions;
    vtkSplineWarp* filter = this->Filter;
    KNOTWORK_FREE_OPTION(options, filter, MapPatchId, "patch of the map; -1: the only one");
    KNOTWORK_FREE_OPTION(
      options, filter, Clamp, "whether points outside the domain are moved to its border");
    KNOTWORK_OPTION(
      options, filter, Tolerance, "wanted distance of projected splines; 0: no refinement");
    KNOTWORK_OPTION(options, filter, MaxLevel, "levels that refinement may add");
    KNOTWORK_OPTION(options, filter, MaximumFunctions, "more functions are not made");
  }

protected:
  Status Prepare(Session& session) override
  {
    return session.CheckFormat(this->Input(0), this->MainOutput());
  }

  Status AddNumbers(Session& session) override
  {
    vtkDataObject* result = this->Filter->GetOutputDataObject(0);
    session.Report["number_of_points"] = result->GetNumberOfElements(vtkDataObject::POINT);
    session.Report["number_of_cells"] = result->GetNumberOfElements(vtkDataObject::CELL);
    auto* dataSet = vtkPointSet::SafeDownCast(result);
    if (vtkDataArray* distance = dataSet ? dataSet->GetCellData()->GetArray("Distance") : nullptr)
    {
      session.Report["max_distance"] = distance->GetRange()[1];
    }
    return {};
  }
};

const JobRegistration Registration{ "warp", "send points or splines through a spline map",
  "scan.xyz plate.vtu --output warped.vtp", MakeJob<WarpJob> };
}
}
