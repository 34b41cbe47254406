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
    this->AddInput(
      0, "input", "spline surfaces, or volumes with --boundary (.vtu .vtpc .xml .g2 .step .iges)");
    this->Divide(0, Share::Blocks);
    this->AddOutput(0, "--output", Endings::Splines, "the part or curve");
    app.add_option("--box", this->Box, "keep the part over u0 u1 v0 v1 only")->expected(4);
    app.add_option("--domain", this->Domain, "make u0 u1 v0 v1 the domain of the parameters")
      ->expected(4);
    this->AddProperties({ "RestrictToBox", "Box", "MoveDomain", "Domain" });
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
    if (!this->Domain.empty())
    {
      session.Report["domain"] = this->Domain;
      this->Filter->MoveDomainOn();
      this->Filter->SetDomain(this->Domain.data());
    }
    if (this->Filter->GetBoundary()) // what the input is says nothing of the output
    {
      return {};
    }
    const bool asCurves = this->Filter->GetIsoCurve() != 0;
    return session.CheckGridFormat(this->Input(0), this->MainOutput(), asCurves);
  }

  Status AddNumbers(Session& session) override
  {
    session.Report["elements"] = Session::Total(
      this->Filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL));
    return {};
  }

private:
  std::vector<double> Box;
  std::vector<double> Domain;
};

const JobRegistration Registration{ "extract",
  "take a part or an iso-curve of surfaces, or the boundary of volumes and surfaces; exchange, "
  "reverse, expand",
  "terrain.vtu --box 0.2 0.8 0.2 0.8 --output part.vtu", MakeJob<ExtractJob>,
  JobProcesses::Several };
}
}
