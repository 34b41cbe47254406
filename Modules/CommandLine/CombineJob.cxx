// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SurfaceFitting/vtkSplineCombine.h>

#include <vtkTable.h>
#include <vtkVariant.h>

#include <algorithm>

namespace knotwork
{
namespace
{
class CombineJob : public FilterJob<vtkSplineCombine>
{
public:
  explicit CombineJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "first", "spline surfaces (.vtu .vtpc .xml .g2 .step .iges)");
    this->AddInput(1, "second", "spline surfaces over the same domains", " and ");
    this->AddOutput(0, "--output", Endings::Splines, "the combination");
    this->AddProperties();
  }

protected:
  Status Prepare(Session& session) override
  {
    return session.CheckGridFormat(this->Input(0), this->MainOutput());
  }

  Status AddNumbers(Session& session) override
  {
    vtkTable* table = this->Table(1);
    int functions = 0;
    double lower = table->GetValueByName(0, "MinBound").ToDouble();
    double upper = table->GetValueByName(0, "MaxBound").ToDouble();
    for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
    {
      functions += table->GetValueByName(row, "Functions").ToInt();
      lower = std::min(lower, table->GetValueByName(row, "MinBound").ToDouble());
      upper = std::max(upper, table->GetValueByName(row, "MaxBound").ToDouble());
    }
    session.Report["patches"] = table->GetNumberOfRows();
    session.Report["functions"] = functions;
    session.Report["min_bound"] = lower;
    session.Report["max_bound"] = upper;
    return {};
  }
};

const JobRegistration Registration{ "combine", "subtract or average two spline surfaces",
  "new.vtu old.vtu --mode difference --output change.vtu --report change.json",
  MakeJob<CombineJob> };
}
}
