// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/DomainParameterization/vtkDomainParameterization.h>

#include <vtkFieldData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

namespace knotwork
{
namespace
{
class ParameterizeJob : public FilterJob<vtkDomainParameterization>
{
public:
  explicit ParameterizeJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "boundary",
      "four curves or six faces, one patch a side (.vtu .vtpc .xml .g2 .json), such in each block "
      "of a collection, or lines drawn by hand, one closed or four (.svg .csv .vtp)",
      "", "input");
    this->Divide(0, Share::Blocks);
    this->AddInput(1, "--layout",
      "a mesh of quadrilaterals or hexahedra, one a patch: the boundary then has a curve or face "
      "for every edge or face on its boundary (.vtu .vtp)",
      " with ");
    this->AddOutput(0, "--output", Endings::Spline, "the map as Bezier grid");
    this->AddOutput(1, "--first-map", Endings::Spline, "the map before the optimization");
    this->AddOutput(2, "--table", Endings::Table, "the convergence table");
    this->AddProperties();
  }

protected:
  Share ShareOfInput(vtkDataObject* boundary) const override
  {
    // the sides of a layout are one boundary, in however many blocks they are
    return this->InputFile(1).empty() && vtkDomainParameterization::HoldsDomains(boundary)
      ? Share::Blocks
      : Share::First;
  }

  Status AddNumbers(Session& session) override
  {
    vtkFieldData* data = this->Filter->GetOutputDataObject(0)->GetFieldData();
    const auto number = [data](const char* name) { return data->GetArray(name)->GetTuple1(0); };
    const auto text = [data](const char* name)
    { return vtkStringArray::SafeDownCast(data->GetAbstractArray(name))->GetValue(0); };
    session.Report["verdict"] = text("Verdict");
    session.Report["injective"] = text("Injective");
    session.Report["min_jacobian_lower"] = number("JacobianMinLower");
    session.Report["min_jacobian_upper"] = number("JacobianMinUpper");
    session.Report["area"] = number("Area");
    session.Report["min_det_over_area"] = number("MinDetOverArea");
    session.Report["max_det_over_area"] = number("MaxDetOverArea");
    session.Report["min_scaled_jacobian"] = number("MinScaledJacobian");
    session.Report["mean_scaled_jacobian"] = number("MeanScaledJacobian");
    session.Report["mean_condition_number"] = number("MeanConditionNumber");
    session.Report["iterations"] = static_cast<long long>(number("Iterations"));
    session.Report["functions"] = static_cast<long long>(number("Functions"));
    session.Report["patches"] = static_cast<long long>(number("Patches"));
    session.Report["stopped"] = text("Stopped");
    session.Report["work"] = number("Work");
    if (data->GetArray("OutlineDistance"))
    {
      session.Report["outline_distance"] = number("OutlineDistance");
      for (const char* counted :
        { "OutlineCorners", "OutlineLines", "OutlineArcs", "OutlineCurves" })
      {
        session.Report[Options::SnakeCase(counted)] = static_cast<long long>(number(counted));
      }
    }
    session.Report["seconds_with_certificate"] = this->Filter->GetSecondsWithCertificate();
    return {};
  }
};

const JobRegistration Registration{ "parameterize",
  "fill a boundary with a spline map that is proved valid",
  "boundary.json --output map.vtu --report map.json", MakeJob<ParameterizeJob>,
  JobProcesses::Several };
}
}
