// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/SplineBlocks.h>
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
    this->AddInput(
      0, "input", "points or splines to send (.vtu .vtp .vtpc .xml .g2 .bext .mesh .step .iges)");
    this->AddInput(1, "map", "the spline map (.vtu .xml .g2 .step .iges)", " through ");
    this->Divide(0, Share::Points);
    this->AddOutput(0, "--output", Endings::Anything, "the image, same type as the input");
    this->AddProperties();
  }

protected:
  Share ShareOfInput(vtkDataObject* input) const override
  {
    return HoldsSplines(input) ? Share::Blocks : Share::Points;
  }

  Status Prepare(Session& session) override
  {
    return session.CheckFormat(this->Input(0), this->MainOutput());
  }

  Status AddNumbers(Session& session) override
  {
    vtkDataObject* result = this->Filter->GetOutputDataObject(0);
    // as many cells as the input has, of points a share has none
    const bool isOfPoints = !HoldsSplines(this->WholeInput());
    session.Report["number_of_points"] =
      Session::Total(result->GetNumberOfElements(vtkDataObject::POINT));
    session.Report["number_of_cells"] = isOfPoints
      ? this->WholeInput()->GetNumberOfElements(vtkDataObject::CELL)
      : Session::Total(result->GetNumberOfElements(vtkDataObject::CELL));
    auto* dataSet = vtkPointSet::SafeDownCast(result);
    if (vtkDataArray* distance = dataSet ? dataSet->GetCellData()->GetArray("Distance") : nullptr)
    {
      session.Report["max_distance"] = distance->GetRange()[1];
    }
    return {};
  }
};

const JobRegistration Registration{ "warp", "send points or splines through a spline map",
  "scan.xyz plate.vtu --output warped.vtp", MakeJob<WarpJob>, JobProcesses::Several };
}
}
