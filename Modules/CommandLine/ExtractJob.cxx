// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/vtkSplineExtract.h>

#include <vtkDataObject.h>

namespace knotwork
{
namespace
{
class ExtractJob : public FilterJob<vtkSplineExtract>
{
public:
  explicit ExtractJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "input", "spline surfaces (.vtu .vtpc .xml .g2 .step .iges)");
    this->AddOutput(0, "--output", Endings::Splines, "the part or curve");
    app.add_option("--box", this->Box, "keep the part over u0 u1 v0 v1 only")->expected(4);
    Options& options = this->FilterOptions;
    vtkSplineExtract* filter = this->Filter;
    KNOTWORK_FREE_OPTION(options, filter, SwapParameters, "whether the parameters are exchanged");
    KNOTWORK_FREE_OPTION(options, filter, ReverseFirst, "whether the first parameter is reversed");
    KNOTWORK_FREE_OPTION(
      options, filter, ReverseSecond, "whether the second parameter is reversed");
    KNOTWORK_FREE_OPTION(
      options, filter, ExpandToTensor, "whether LR surfaces become tensor products");
    KNOTWORK_CHOICE(options, filter, IsoCurve,
      "the parameter that is constant on a curve that is taken instead of the surface", "none",
      "first", "second");
    KNOTWORK_FREE_OPTION(options, filter, IsoValue, "its value");
    KNOTWORK_OPTION(options, filter, MaximumFunctions, "more functions are not made");
  }

protected:
  Status Prepare(Session& session) override
  {
    if (!this->Box.empty())
    {
      session.Report["box"] = this->Box;
      this->Filter->RestrictToBoxOn();
      this->Filter->SetBox(this->Box.data());
    }
    const bool asCurves = this->Filter->GetIsoCurve() != 0;
    return session.CheckGridFormat(this->Input(0), this->MainOutput(), asCurves);
  }

  Status AddNumbers(Session& session) override
  {
    session.Report["elements"] =
      this->Filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL);
    return {};
  }

private:
  std::vector<double> Box;
};

const JobRegistration Registration{ "extract",
  "take a part or an iso-curve of surfaces, or exchange, reverse, expand",
  "terrain.vtu --box 0.2 0.8 0.2 0.8 --output part.vtu", MakeJob<ExtractJob> };
}
}
