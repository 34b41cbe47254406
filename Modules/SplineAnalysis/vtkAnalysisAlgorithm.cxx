// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAnalysisAlgorithm.h"

#include "AnalysisRun.h"

using namespace knotwork;

struct vtkAnalysisAlgorithm::NamedFunctions
{
  ProblemFunctions ByName;
};

vtkAnalysisAlgorithm::vtkAnalysisAlgorithm() : Functions(std::make_unique<NamedFunctions>()) {}

vtkAnalysisAlgorithm::~vtkAnalysisAlgorithm()
{
  this->SetProblem(nullptr);
  this->SetProblemFile(nullptr);
}

void vtkAnalysisAlgorithm::SetFunction(const std::string& name,
  std::function<void(const double* position, const double* normal, double* values)> function)
{
  this->Functions->ByName.erase(name);
  if (function)
  {
    this->Functions->ByName.emplace(name, std::move(function));
  }
  this->Modified();
}

Result<AnalysisOptions> vtkAnalysisAlgorithm::MakeOptions() const
{
  auto text = ReadProblemText(this->Problem, this->ProblemFile);
  if (!text)
  {
    return text.Status;
  }
  AnalysisOptions options;
  options.IsPoisson = this->Equation == POISSON;
  options.IsPlaneStrain = this->Plane == STRAIN;
  options.Problem = std::move(text.Value);
  options.Compile = MakeCompiler(this->Functions->ByName);
  options.Material = { this->Conductivity, this->YoungsModulus, this->PoissonsRatio };
  options.Params.MaxSteps = 1;
  options.Params.Galerkin.DirectLimit = this->DirectLimit;
  options.Params.Galerkin.Tolerance = this->Tolerance;
  options.Params.Galerkin.Threads = this->KernelThreads();
  return options;
}
