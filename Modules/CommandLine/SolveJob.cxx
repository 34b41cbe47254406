// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineAnalysis/vtkSplineAnalysis.h>

#include <vtkDataArray.h>

namespace knotwork
{
namespace
{
class SolveJob : public FilterJob<vtkSplineAnalysis>
{
public:
  explicit SolveJob(CLI::App& app) : FilterJob(app)
  {
    app.add_option("equation", this->Equation, "what is solved: poisson or elasticity")
      ->required()
      ->check(CLI::IsMember({ "poisson", "elasticity" }));
    this->AddInput(0, "body",
      "planar spline surfaces or volumes (.vtu .vtpc .xml .g2 .bext), or elements (.vtu .msh .inp "
      ".mesh)");
    this->AddFile("problem", "materials, source and conditions (.json)");
    // other formats would lose the solution
    this->AddOutput(0, "--output", ".vtu|.vtpc", "the body with the solution");
    this->AddOutput(
      1, "--gauss-points", Endings::Polygons, "fluxes or stresses where they are computed");
    this->AddOutput(
      2, "--conditions", Endings::Table, "what every condition chose, and its reaction");
    this->AddOutput(Numbers, "--numbers", Endings::Table, "the numbers of the report");
    this->AddOutput(
      4, "--history", Endings::Table, "one row a solution, when refinement is adaptive");
    this->AddProperties({ "Equation", "GaussPoints", "Problem", "ProblemFile" });
  }

protected:
  Status Prepare(Session& session) override
  {
    const bool isPoisson = this->Equation == "poisson";
    this->Filter->SetEquation(
      isPoisson ? vtkSplineAnalysis::POISSON : vtkSplineAnalysis::ELASTICITY);
    this->Filter->SetProblemFile(this->FileToRead().c_str());
    this->Filter->SetGaussPoints(!this->OutputFile(1).empty());
    session.Report["equation"] = this->Equation;
    return {};
  }

  Status AddNumbers(Session& session) override
  {
    vtkTable* const table = this->Table(Numbers);
    ReportRow(table, 0,
      { "Elements", "Functions", "Unknowns", "Conditions", "Energy", "Potential", "EstimatedError",
        "LargestValue", "Imbalance", "Residual", "Iterations" },
      session.Report);
    if (this->Equation == "elasticity")
    {
      ReportRow(table, 0, { "LargestVonMises", "PeakStress" }, session.Report);
    }
    else
    {
      ReportRow(table, 0, { "PeakFlux" }, session.Report);
    }
    if (table->GetColumnByName("ExactEnergy"))
    {
      ReportRow(table, 0,
        { "L2Error", "H1Error", "EnergyError", "ExactL2", "ExactH1", "ExactEnergy" },
        session.Report);
    }
    for (const char* name : { "PeakPosition", "TotalLoad", "TotalReaction" })
    {
      vtkDataArray* column = vtkDataArray::SafeDownCast(table->GetColumnByName(name));
      auto& entry = session.Report[Options::SnakeCase(name)];
      for (int c = 0; c < column->GetNumberOfComponents(); ++c)
      {
        entry.push_back(column->GetComponent(0, c));
      }
    }
    session.Report["certificate_seconds"] = this->Filter->GetSeconds(0);
    session.Report["assembly_seconds"] = this->Filter->GetSeconds(1);
    session.Report["solution_seconds"] = this->Filter->GetSeconds(2);
    session.Report["stress_seconds"] = this->Filter->GetSeconds(3);
    return {};
  }

private:
  static constexpr int Numbers = 3;
  std::string Equation;
};

const JobRegistration Registration{ "solve",
  "solve Poisson's equation or linear elasticity on a spline or a mesh",
  "elasticity plate.vtu problem.json --output solved.vtu --report solved.json", MakeJob<SolveJob> };
}
}
