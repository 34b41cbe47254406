// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/TemplateMapping/vtkTemplateMapping.h>

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

namespace knotwork
{
namespace
{
class MapJob : public FilterJob<vtkTemplateMapping>
{
public:
  explicit MapJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "template", "skeleton of the template (.vtp .vtu)");
    this->AddInput(1, "target", "target patches with the same PatchId (.vtp .vtu)", " onto ");
    this->AddInput(
      2, "--initial", "the map to start with: spline grid of one patch (.vtu)", " from ");
    this->AddOutput(0, "--output", Endings::Spline, "the map as Bezier grid");
    this->AddOutput(1, "--mapped", Endings::Points, "the mapped skeleton with distances");
    this->AddOutput(2, "--table", Endings::Table, "the convergence table");
    app
      .add_option("--domain", this->Domain,
        "box of the map: xmin xmax ymin ymax [zmin zmax]; without it the template's")
      ->expected(4, 6)
      ->check(CLI::Number);
    Options& options = this->FilterOptions;
    options.Rename("Refinement", "Refine");
    vtkTemplateMapping* filter = this->Filter;
    options.AddChoice(
      "Guard", { "off", "on" }, filter->GetGuard() ? 1 : 0,
      [filter](int guard) { filter->SetGuard(guard == 1); },
      "keep every iterate regular: det J > 0 is proved everywhere");
    options.AddChoice(
      "Injectivity", { "off", "on" }, filter->GetInjectivity() ? 1 : 0,
      [filter](int prove) { filter->SetInjectivity(prove == 1); },
      "whether the map as a whole is proved injective");
    this->AddProperties({ "Guard", "Injectivity", "UseDomain", "Domain" });
  }

protected:
  Status Prepare(Session& session) override
  {
    if (this->Domain.size() == 5)
    {
      return { ErrorCode::InvalidParameter, "--domain takes 4 or 6 numbers, not 5" };
    }
    if (!this->Domain.empty())
    {
      session.Report["domain"] = this->Domain;
      this->Domain.resize(6, 0.0);
      this->Filter->SetDomain(this->Domain.data());
      this->Filter->UseDomainOn();
    }
    return {};
  }

  Status AddNumbers(Session& session) override
  {
    nlohmann::ordered_json& report = session.Report;
    vtkTable* table = this->Table(2);
    const auto column = [table](const char* name)
    {
      std::vector<double> values;
      auto* array = vtkDataArray::SafeDownCast(table->GetColumnByName(name));
      for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
      {
        values.push_back(array->GetTuple1(i));
      }
      return values;
    };
    const std::vector<double> errors = column("SquaredL2Error");
    const std::vector<double> negative = column("NegativeJacobianPercent");
    report["squared_l2_error"] = errors.back();
    report["max_error"] = column("MaxError").back();
    report["negative_jacobian_percent"] = negative.back();
    report["functions"] = static_cast<long long>(column("Functions").back());
    report["iterations"] = static_cast<long long>(column("Iteration").back());
    report["squared_l2_errors"] = errors;
    report["negative_jacobian_percents"] = negative;
    const auto counts = [&](const char* name)
    {
      const std::vector<double> values = column(name);
      return std::vector<long long>(values.begin(), values.end());
    };
    report["functions_per_iteration"] = counts("Functions");
    report["held_elements"] = counts("HeldElements");
    report["step_lengths"] = column("StepLength");
    vtkFieldData* data = this->Filter->GetOutputDataObject(0)->GetFieldData();
    report["min_jacobian_bound"] = data->GetArray("MinJacobianBound")->GetTuple1(0);
    if (auto* injective = vtkStringArray::SafeDownCast(data->GetAbstractArray("Injective")))
    {
      report["injective"] = injective->GetValue(0);
    }
    return {};
  }

private:
  std::vector<double> Domain;
};

const JobRegistration Registration{ "map", "carry a template skeleton onto target patches",
  "template.vtp target.vtp --output map.vtu --report map.json", MakeJob<MapJob> };
}
}
