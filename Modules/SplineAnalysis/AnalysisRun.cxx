// SPDX-License-Identifier: BSD-3-Clause
#include "AnalysisRun.h"

#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineGrid/SplineBlocks.h>

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>

namespace knotwork
{
namespace
{
GalerkinEquation EquationOf(const AnalysisOptions& options, int dimension)
{
  if (options.IsPoisson)
  {
    return GalerkinEquation::Poisson;
  }
  return dimension == 3     ? GalerkinEquation::Solid
    : options.IsPlaneStrain ? GalerkinEquation::PlaneStrain
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

Result<AnalysisResults> Solve(const ProblemDescription& description, const AnalysisBody& body,
  vtkDataObject* input, const AnalysisOptions& options, const ProgressCallback& progress)
{
  const GalerkinParams& params = options.Params.Galerkin;
  AnalysisResults solved;
  auto problem =
    MakeProblem(description, body.Space, body.Boundary, options.Compile, &solved.Places);
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

/// The elements of a space that those of a refined one lie in. @pre both have the same domain.
template <int Dim>
std::vector<int> ParentsOf(const SplineSpace<Dim>& refined, const SplineSpace<Dim>& coarse)
{
  const auto count = refined.Elements.size();
  std::vector<double> middles;
  for (const auto& element : refined.Elements)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      middles.push_back(0.5 * (element.Box.Lower[d] + element.Box.Upper[d]));
    }
  }
  std::vector<int> parents(count);
  std::vector<double> local(count * Dim);
  coarse.Locate(middles.data(), Dim, count, parents.data(), local.data());
  return parents;
}

/// @param body       becomes the refined one.
/// @param materials  of the elements of the body; empty: one for all.
template <int Dim>
Result<AnalysisResults> SolvePatchesAdaptively(const ProblemDescription& description,
  const std::vector<int>& materials, AnalysisBody& body, const AnalysisOptions& options,
  const ProgressCallback& progress)
{
  SplineModel model = body.Model;
  const MultiPatch<Dim> coarse = GluedPatches<Dim>(model);
  auto refined = SolveAdaptively<Dim>(
    coarse,
    [&](const MultiPatch<Dim>& patches, const GalerkinSpace& space) -> Result<GalerkinProblem>
    {
      auto facets = BoundaryFacets(space);
      if (!facets)
      {
        return facets.Status;
      }
      BoundaryGroups boundary;
      boundary.Facets = std::move(facets.Value);
      auto problem = MakeProblem(description, space, boundary, options.Compile);
      std::size_t first = 0; // element of the unrefined patch
      for (std::size_t i = 0; problem && !materials.empty() && i < patches.Patches.size(); ++i)
      {
        const SplineSpace<Dim>& before = *coarse.Patches[i].Space;
        for (const int parent : ParentsOf(*patches.Patches[i].Space, before))
        {
          problem->MaterialIds.push_back(materials[first + static_cast<std::size_t>(parent)]);
        }
        first += before.Elements.size();
      }
      return problem;
    },
    options.Params, progress);
  if (!refined)
  {
    return refined.Status;
  }
  for (std::size_t i = 0; i < model.Patches.size(); ++i)
  {
    model.Patches[i].Geometry = refined->Body.Patches[i];
    model.Patches[i].Fields.clear();
    std::vector<vtkIdType> cells; // that elements come from
    for (const int parent : ParentsOf(*refined->Body.Patches[i].Space, *coarse.Patches[i].Space))
    {
      cells.push_back(model.Patches[i].Cells[static_cast<std::size_t>(parent)]);
    }
    model.Patches[i].Cells = std::move(cells);
  }
  model.Topology = refined->Body.Topology;
  auto made = MakeBody(std::move(model));
  if (!made)
  {
    return made.Status;
  }
  body = std::move(made.Value);
  AnalysisResults solved;
  const auto problem =
    MakeProblem(description, body.Space, body.Boundary, options.Compile, &solved.Places);
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

Result<AnalysisResults> SolveBodyAdaptively(const ProblemDescription& description,
  AnalysisBody& body, vtkDataObject* input, const AnalysisOptions& options,
  const ProgressCallback& progress)
{
  if (body.Model.Patches.empty())
  {
    return {
      ErrorCode::InvalidParameter,
      "MaxSteps above 1 is for splines, and the input is a mesh; refine it before, or set it to 1"
    };
  }
  const auto materials = ReadMaterials(description, body, input);
  if (!materials)
  {
    return materials.Status;
  }
  return body.Space.Dimension == 2
    ? SolvePatchesAdaptively<2>(description, materials.Value, body, options, progress)
    : SolvePatchesAdaptively<3>(description, materials.Value, body, options, progress);
}

/// Fields and, where the solution is known, its errors.
Status AddResults(
  AnalysisResults& results, const AnalysisOptions& options, const ProgressCallback& progress)
{
  const auto start = std::chrono::steady_clock::now();
  auto fields = MakeResultFields(results.Body.Space, results.Problem, results.Body.Boundary.Facets,
    results.Solution.Coefficients, options.KeepsGaussPoints, options.Params.Galerkin, progress);
  if (!fields)
  {
    return fields.Status;
  }
  results.Fields = std::move(fields.Value);
  results.SecondsFields =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto exact = MakeExact(results.Description, results.Body.Space.Dimension, options.Compile);
  if (!exact || !exact.Value)
  {
    return exact.Status;
  }
  const auto errors = CompareWithExact(
    results.Body.Space, results.Problem, results.Solution.Coefficients, exact.Value);
  if (errors)
  {
    results.Exact = errors.Value;
  }
  return errors.Status;
}
}

Result<std::string> ReadProblemText(const char* text, const char* file)
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

bool HasNoCells(vtkDataObject* data)
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

Result<AnalysisBody> ReadBody(
  vtkDataObject* input, const std::function<Result<SplineModel>(vtkDataObject*)>& decode)
{
  if (IsOfSplines(input))
  {
    auto model = decode(input);
    return model ? MakeBody(std::move(model.Value)) : Result<AnalysisBody>(model.Status);
  }
  auto* const grid = vtkUnstructuredGrid::SafeDownCast(input);
  return grid ? MakeBody(grid)
              : Result<AnalysisBody>(Status{ ErrorCode::InvalidTopology,
                  "a collection holds splines; give elements as one unstructured grid" });
}

Result<AnalysisResults> RunAnalysis(AnalysisBody body, vtkDataObject* input,
  const AnalysisOptions& options, const ProgressCallback& progress)
{
  auto description =
    ReadProblem(options.Problem, EquationOf(options, body.Space.Dimension), options.Material);
  if (!description)
  {
    return description.Status;
  }
  const ProgressCallback solving = [&](double share) { return progress(0.7 * share); };
  auto results = options.Params.MaxSteps > 1
    ? SolveBodyAdaptively(description.Value, body, input, options, solving)
    : Solve(description.Value, body, input, options, solving);
  if (!results)
  {
    return results.Status;
  }
  results->Description = std::move(description.Value);
  results->Body = std::move(body);
  const Status status =
    AddResults(results.Value, options, [&](double share) { return progress(0.7 + 0.3 * share); });
  return status ? std::move(results) : Result<AnalysisResults>(status);
}
}
