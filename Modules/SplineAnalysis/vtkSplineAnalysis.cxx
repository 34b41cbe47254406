// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineAnalysis.h"

#include "AnalysisData.h"
#include "AnalysisResults.h"
#include "Expression.h"
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineGrid/SplineBlocks.h>

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>

using namespace knotwork;

vtkStandardNewMacro(vtkSplineAnalysis);

namespace
{
Result<std::string> ReadText(const char* text, const char* file)
{
  const bool hasText = text && *text;
  const bool hasFile = file && *file;
  if (hasText && hasFile)
  {
    return { ErrorCode::InvalidParameter,
      "Problem and ProblemFile are both given; give one of them" };
  }
  if (!hasFile)
  {
    return std::string(hasText ? text : "{}");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string all{ std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>() };
  if (!stream)
  {
    return { ErrorCode::FileError, "'" + std::string(file) + "' cannot be read" };
  }
  return all;
}

GalerkinEquation EquationOf(int equation, int plane, int dimension)
{
  if (equation == vtkSplineAnalysis::POISSON)
  {
    return GalerkinEquation::Poisson;
  }
  return dimension == 3                  ? GalerkinEquation::Solid
    : plane == vtkSplineAnalysis::STRAIN ? GalerkinEquation::PlaneStrain
                                         : GalerkinEquation::PlaneStress;
}

/// Position in the list of materials of every element.
Result<std::vector<int>> ReadMaterials(
  const ProblemDescription& problem, const AnalysisBody& body, vtkDataObject* input)
{
  std::vector<int> ids;
  if (problem.MaterialArray.empty())
  {
    return ids;
  }
  const auto add = [&](vtkUnstructuredGrid* grid, const std::vector<vtkIdType>& cells) -> Status
  {
    vtkDataArray* array = grid->GetCellData()->GetArray(problem.MaterialArray.c_str());
    if (!array || array->GetNumberOfComponents() != 1)
    {
      return { ErrorCode::InvalidParameter,
        "there is no cell array \"" + problem.MaterialArray + "\" of one component" };
    }
    for (const vtkIdType cell : cells)
    {
      const double number = array->GetComponent(cell, 0);
      const std::vector<long long>& known = problem.MaterialNumbers;
      const auto found = std::find(known.begin(), known.end(), number);
      if (found == known.end() && !(known.empty() && number == 0.0))
      {
        return { ErrorCode::InvalidParameter,
          "cell " + std::to_string(cell) + " has material " + Digits(number) +
            ", which the problem does not describe; add it to \"materials\"" };
      }
      ids.push_back(known.empty() ? 0 : static_cast<int>(found - known.begin()));
    }
    return {};
  };
  Status status;
  const auto grids = GridsByBlock(input);
  for (const SplinePatch& patch : body.Model.Patches)
  {
    status = status ? add(grids.at(patch.Block), patch.Cells) : status;
  }
  if (body.Model.Patches.empty())
  {
    status = add(grids.at(0), body.Cells);
  }
  return status ? Result<std::vector<int>>(std::move(ids)) : Result<std::vector<int>>(status);
}

/// A stated and solved problem.
struct SolvedProblem
{
  std::vector<ConditionPlace> Places;
  GalerkinProblem Problem;
  GalerkinSolution Solution;
  ErrorEstimate Estimate;
  std::vector<AdaptiveStep> History;
};

Result<SolvedProblem> Solve(const ProblemDescription& description, const AnalysisBody& body,
  vtkDataObject* input, const GalerkinParams& params, const ProgressCallback& progress)
{
  SolvedProblem solved;
  auto problem =
    MakeProblem(description, body.Space, body.Boundary, CompileWithVtk, &solved.Places);
  auto materials =
    problem ? ReadMaterials(description, body, input) : Result<std::vector<int>>(problem.Status);
  if (!materials)
  {
    return materials.Status;
  }
  solved.Problem = std::move(problem.Value);
  solved.Problem.MaterialIds = std::move(materials.Value);
  auto solution = SolveGalerkin(
    body.Space, solved.Problem, params, [&](double share) { return progress(0.8 * share); });
  if (!solution)
  {
    return solution.Status;
  }
  solved.Solution = std::move(solution.Value);
  auto estimate = EstimateError(body.Space, solved.Problem, solved.Solution.Coefficients,
    params.Threads, [&](double share) { return progress(0.8 + 0.2 * share); });
  if (!estimate)
  {
    return estimate.Status;
  }
  solved.Estimate = std::move(estimate.Value);
  AdaptiveStep step;
  step.Functions = body.Space.NumFunctions();
  step.Elements = body.Space.NumElements();
  step.Estimate = solved.Estimate.Total;
  step.Energy = solved.Solution.Energy;
  solved.History.push_back(step);
  return solved;
}

/// @param body  becomes the refined one.
template <int Dim>
Result<SolvedProblem> SolvePatchAdaptively(const ProblemDescription& description,
  AnalysisBody& body, const AdaptiveParams& params, const ProgressCallback& progress)
{
  SplineModel model = body.Model;
  SplinePatch& patch = model.Patches.front();
  auto refined = SolveAdaptively<Dim>(
    std::get<Spline<Dim>>(patch.Geometry),
    [&](const Spline<Dim>&, const GalerkinSpace& space) -> Result<GalerkinProblem>
    {
      auto facets = BoundaryFacets(space);
      if (!facets)
      {
        return facets.Status;
      }
      return MakeProblem(description, space, { std::move(facets.Value), {}, {} }, CompileWithVtk);
    },
    params, progress);
  if (!refined)
  {
    return refined.Status;
  }
  patch.Geometry = refined->Spline;
  patch.Fields.clear();
  patch.Cells.clear();
  model.Topology = {};
  auto made = MakeBody(std::move(model));
  if (!made)
  {
    return made.Status;
  }
  body = std::move(made.Value);
  SolvedProblem solved;
  const auto problem =
    MakeProblem(description, body.Space, body.Boundary, CompileWithVtk, &solved.Places);
  if (!problem)
  {
    return problem.Status;
  }
  solved.Problem = std::move(refined->Problem);
  solved.Solution = std::move(refined->Solution);
  solved.Estimate = std::move(refined->Estimate);
  solved.History = std::move(refined->History);
  return solved;
}

Result<SolvedProblem> SolveBodyAdaptively(const ProblemDescription& description, AnalysisBody& body,
  const AdaptiveParams& params, const ProgressCallback& progress)
{
  if (body.Model.Patches.size() != 1)
  {
    return { ErrorCode::InvalidParameter,
      "MaxSteps above 1 is for one patch, and the input has " +
        std::to_string(body.Model.Patches.size()) + "; refine it before, or set it to 1" };
  }
  if (!description.MaterialArray.empty())
  {
    return { ErrorCode::InvalidParameter,
      "MaxSteps above 1 is for one material, and the problem has a \"material_array\"" };
  }
  return body.Space.Dimension == 2 ? SolvePatchAdaptively<2>(description, body, params, progress)
                                   : SolvePatchAdaptively<3>(description, body, params, progress);
}

bool IsEmpty(vtkDataObject* data)
{
  for (const auto& [block, grid] : GridsByBlock(data))
  {
    if (grid->GetNumberOfCells() > 0)
    {
      return false;
    }
  }
  return true;
}
}

vtkSplineAnalysis::vtkSplineAnalysis()
{
  this->SetNumberOfOutputPorts(5);
}

vtkSplineAnalysis::~vtkSplineAnalysis()
{
  this->SetProblem(nullptr);
  this->SetProblemFile(nullptr);
}

double vtkSplineAnalysis::GetSeconds(int step)
{
  return step >= 0 && step < 4 ? this->Seconds[static_cast<std::size_t>(step)] : 0.0;
}

int vtkSplineAnalysis::FillOutputPortInformation(int port, vtkInformation* info)
{
  if (port == 0)
  {
    return this->Superclass::FillOutputPortInformation(port, info);
  }
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 1 ? "vtkPolyData" : "vtkTable");
  return 1;
}

int vtkSplineAnalysis::RequestDataObject(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Superclass::RequestDataObject(request, inputs, outputs);
  return this->MakeDeclaredOutputs(outputs);
}

Status vtkSplineAnalysis::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0], 0);
  this->Seconds = {};
  if (IsEmpty(input))
  {
    return {}; // as VTK's filters: nothing of nothing
  }
  const auto text = ReadText(this->Problem, this->ProblemFile);
  if (!text)
  {
    return text.Status;
  }
  Result<AnalysisBody> body;
  if (IsOfSplines(input))
  {
    auto model = this->DecodeInput(input);
    body = model ? MakeBody(std::move(model.Value)) : Result<AnalysisBody>(model.Status);
  }
  else
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
    body = grid ? MakeBody(grid)
                : Result<AnalysisBody>(Status{ ErrorCode::InvalidTopology,
                    "a collection holds splines; give elements as one unstructured grid" });
  }
  if (!body)
  {
    return body.Status;
  }
  if (body->NumLeftOut > 0 && body->Boundary.Groups.empty())
  {
    this->ReportWarnings(
      { std::to_string(body->NumLeftOut) + " cells of fewer dimensions than others are left out" });
  }
  const auto description =
    ReadProblem(text.Value, EquationOf(this->Equation, this->Plane, body->Space.Dimension),
      { this->Conductivity, this->YoungsModulus, this->PoissonsRatio });
  if (!description)
  {
    return description.Status;
  }
  AdaptiveParams params;
  params.Theta = this->Theta;
  params.Tolerance = this->ErrorTolerance;
  params.MaxFunctions = this->MaximumFunctions;
  params.MaxSteps = this->MaxSteps;
  params.Galerkin.DirectLimit = this->DirectLimit;
  params.Galerkin.Tolerance = this->Tolerance;
  params.Galerkin.Threads = this->KernelThreads();
  const ProgressCallback progress = [whole = this->Progress()](double share)
  { return whole(0.7 * share); };
  const bool losesArrays =
    body->Model.Patches.size() == 1 && !body->Model.Patches.front().Fields.empty();
  const auto solved = this->MaxSteps > 1
    ? SolveBodyAdaptively(description.Value, body.Value, params, progress)
    : Solve(description.Value, body.Value, input, params.Galerkin, progress);
  if (!solved)
  {
    return solved.Status;
  }
  if (this->MaxSteps > 1 && losesArrays)
  {
    this->ReportWarnings({ "point arrays of the input are not carried to the refined patch; "
                           "solve with MaxSteps 1 to keep them" });
  }
  const auto start = std::chrono::steady_clock::now();
  const auto fields = MakeResultFields(body->Space, solved->Problem, body->Boundary.Facets,
    solved->Solution.Coefficients, params.Galerkin,
    [whole = this->Progress()](double share) { return whole(0.7 + 0.3 * share); });
  if (!fields)
  {
    return fields.Status;
  }
  const double seconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  this->Seconds = { solved->Solution.SecondsCertificate, solved->Solution.SecondsAssembly,
    solved->Solution.SecondsSolve, seconds };
  const AnalysisResults results{ description.Value, body.Value, solved->Problem, solved->Places,
    solved->Solution, solved->Estimate, fields.Value };
  EncodeGaussPoints(results, vtkPolyData::GetData(outputs, 1));
  EncodeConditions(results, vtkTable::GetData(outputs, 2));
  EncodeNumbers(results, vtkTable::GetData(outputs, 3));
  EncodeHistory(solved->History, vtkTable::GetData(outputs, 4));
  return EncodeBody(body.Value, PointFields(results), CellFields(results), input,
    vtkDataObject::GetData(outputs, 0));
}
