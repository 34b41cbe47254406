// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineAnalysis/vtkSplineVersusMesh.h>
#include <knotwork/TetMeshing/vtkVolumeComparison.h>

#include <vtkVariant.h>

#include <vector>

namespace knotwork
{
namespace
{
/// Outputs of both filters are told apart by numbers of ports that the first one has not.
constexpr int FirstSolvedPort = 10;

enum Branches
{
  OfShapes = 1,
  OfSolutions
};

/// Shapes, or with --solve solutions of a problem.
class CompareJob : public FilterJob<vtkVolumeComparison>
{
public:
  explicit CompareJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "spline",
      "spline volumes (.vtu .xml .g2 .bext .mesh); with --solve planar surfaces too, and several "
      "patches (.vtpc)");
    this->AddInput(1, "mesh",
      "tetrahedra, wedges or hexahedra, straight or curved (.vtu .msh .inp .mesh)", " and ");
    this->AddInput(2, "--reference",
      "the shape that both stand for: a CAD part (.step .stp .iges .igs .brep), triangles (.stl "
      ".off .obj .ply .vtp) or a spline (.vtu .xml .g2); else it is the spline. With --solve: a "
      "finer spline or mesh",
      " by ");
    this->AddOutput(ShapeNumbers, "--output", Endings::Table, "the numbers, one row a body");
    this->AddOutput(2, "--histogram", Endings::Table, "cells by their least scaled Jacobian");
    this->AddOutput(0, "--spline-boundary", Endings::Polygons,
      "the spline's boundary with its distances from the reference");
    this->AddOutput(1, "--mesh-boundary", Endings::Polygons, "the same of the mesh");
    this->AddOutput(FirstSolvedPort, "--spline-solution", ".vtu|.vtpc",
      "with --solve: the spline with the solution");
    this->AddOutput(
      FirstSolvedPort + 1, "--mesh-solution", ".vtu", "with --solve: the mesh with the solution");
    app.add_option("--solve", this->Problem,
      "a problem (.json, as solve has it): the solutions are compared, not the shapes");
    this->FilterOptions.Begin(OfShapes, "the comparison of shapes");
    this->AddProperties();
    this->FilterOptions.Begin(OfSolutions, "the comparison of solutions (--solve)");
    this->FilterOptions.LeaveOut({ "Problem", "ProblemFile" });
    knotwork::AddProperties(this->FilterOptions, this->Solutions);
  }

protected:
  Result<int> Branch() override
  {
    const auto isGiven = [this](int port) { return !this->OutputFile(port).empty(); };
    const bool solves = !this->Problem.empty();
    if (solves ? isGiven(0) || isGiven(1) || isGiven(2)
               : isGiven(FirstSolvedPort) || isGiven(FirstSolvedPort + 1))
    {
      return { ErrorCode::InvalidParameter,
        solves ? "--solve compares no shapes: leave --histogram, --spline-boundary and "
                 "--mesh-boundary out"
               : "--spline-solution and --mesh-solution need --solve" };
    }
    return solves ? OfSolutions : OfShapes;
  }

  Status Prepare(Session& session) override
  {
    if (this->Problem.empty())
    {
      return {};
    }
    session.Report["solve"] = this->Problem;
    for (int port = 0; port < 3; ++port)
    {
      this->Solutions->SetInputDataObject(port, this->Input(port));
    }
    this->Solutions->SetProblemFile(this->Problem.c_str());
    this->Solutions->SetThreads(session.Threads);
    this->Algorithm = this->Solutions;
    return {};
  }

  Status AddNumbers(Session& session) override
  {
    if (this->Problem.empty())
    {
      this->ReportShapes(session.Report);
    }
    else
    {
      this->ReportSolutions(session.Report);
    }
    return {};
  }

  Status Write(Session& session) override
  {
    return this->Problem.empty() ? FilterJob::Write(session)
                                 : session.WriteOutputs(this->Solutions,
                                     { this->OutputFile(FirstSolvedPort),
                                       this->OutputFile(FirstSolvedPort + 1), this->MainOutput() });
  }

private:
  static constexpr int ShapeNumbers = 3;
  static constexpr int SolutionNumbers = 2;

  /// The report is flat.
  static void AddPrefixed(const std::string& prefix, const nlohmann::ordered_json& numbers,
    nlohmann::ordered_json& report)
  {
    for (const auto& [key, value] : numbers.items())
    {
      report[prefix + "_" + key] = value;
    }
  }

  void ReportShapes(nlohmann::ordered_json& report)
  {
    vtkTable* const table = this->Table(ShapeNumbers);
    ReportRow(table, 0, { "ReferenceVolume", "ReferenceVolumeBound", "Diagonal" }, report);
    for (const auto& [row, prefix] : { std::pair(0, "spline"), std::pair(1, "mesh") })
    {
      nlohmann::ordered_json numbers;
      ReportRow(table, row,
        { "Elements", "Functions", "ValidElements", "ReversedElements", "InvalidElements",
          "UndecidedElements", "MinJacobianLower", "ScaledJacobianLower", "ScaledJacobianUpper",
          "ScaledJacobianMean", "Volume", "VolumeError", "ToReference", "FromReference",
          "LargestDistance", "RmsToReference", "RmsFromReference", "ChordalBound", "BoundaryPoints",
          "Memory" },
        numbers);
      numbers["certificate_seconds"] = this->Filter->GetSeconds(row, 0);
      numbers["measure_seconds"] = this->Filter->GetSeconds(row, 1);
      numbers["distance_seconds"] = this->Filter->GetSeconds(row, 2);
      AddPrefixed(prefix, numbers, report);
    }
  }

  void ReportSolutions(nlohmann::ordered_json& report)
  {
    vtkTable* const table = this->Table(SolutionNumbers);
    for (int row = 0; row < static_cast<int>(table->GetNumberOfRows()); ++row)
    {
      nlohmann::ordered_json numbers;
      ReportRow(table, row,
        { "Elements", "Functions", "Unknowns", "Energy", "Potential", "EstimatedError", "Peak" },
        numbers);
      for (const char* column : { "EnergyError", "L2Error", "PeakError" })
      {
        if (table->GetColumnByName(column))
        {
          ReportRow(table, row, { column }, numbers);
        }
      }
      numbers["certificate_seconds"] = this->Solutions->GetSeconds(row, 0);
      numbers["assembly_seconds"] = this->Solutions->GetSeconds(row, 1);
      numbers["solution_seconds"] = this->Solutions->GetSeconds(row, 2);
      AddPrefixed(table->GetValueByName(row, "Body").ToString(), numbers, report);
    }
  }

  std::string Problem;
  vtkNew<vtkSplineVersusMesh> Solutions;
};

const JobRegistration Registration{ "compare",
  "compare a spline volume and a mesh of the same solid with a reference",
  "solid.vtu mesh.vtu --reference solid.step --output table.csv --report compare.json",
  MakeJob<CompareJob> };
}
}
