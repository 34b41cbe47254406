// SPDX-License-Identifier: BSD-3-Clause
#include "DomainSolver.h"

#include "HierarchicalSpace.h"
#include "NewtonSystem.h"

#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// Smallest det J over S from where the quality functional goes on by itself.
constexpr double EnoughDet = 0.02;
/// Weights stay within a factor of 100 of 1.
constexpr double LargestLogarithm = 4.6;
}

template <int Dim>
std::vector<bool> FixedFunctions(const SplineSpace<Dim>& space)
{
  std::vector<bool> fixed(static_cast<std::size_t>(space.NumFunctions));
  const auto functions = DescribeFunctions<Dim>(space);
  // numbers of functions of the level grids: a knot more in the middle of every element
  for (std::size_t i = 0; i < fixed.size(); ++i)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const KnotVector& knots = space.Knots[d];
      const std::int64_t grown =
        (std::int64_t(1) << functions[i].Level) * knots.NumElements() - knots.NumElements();
      const std::int64_t last = knots.NumFunctions() + grown - 1;
      fixed[i] = fixed[i] || functions[i].Index[d] == 0 || functions[i].Index[d] == last;
    }
  }
  return fixed;
}

template <int Dim>
DomainSolver<Dim>::DomainSolver(const Spline<Dim>& map, double area, const DomainParams& params)
  : Params(params), Area(area), Scale(std::pow(area, 1.0 / Dim))
{
  this->Center = map.ControlPoints.colwise().mean();
  this->Current = map;
  const std::vector<bool> fixed = FixedFunctions<Dim>(*map.Space);
  for (std::size_t i = 0; i < fixed.size(); ++i)
  {
    if (!fixed[i])
    {
      this->Free.push_back(static_cast<int>(i));
    }
  }
  this->SetMap(map);
  this->SetQuadrature(std::vector<int>(map.Space->Elements.size(), 0));
  if (map.Space->Kind == SpaceKind::Tensor)
  {
    this->Laplacian = std::make_unique<FastLaplacian<Dim>>(map.Space->Knots);
  }
}

template <int Dim>
void DomainSolver<Dim>::SetMap(const Spline<Dim>& map)
{
  this->Current = map;
  const int n = map.Space->NumFunctions;
  this->Planes.resize(static_cast<std::size_t>(Dim * n));
  this->PlaneGradients.resize(this->Planes.size());
  for (int c = 0; c < Dim; ++c)
  {
    for (int i = 0; i < n; ++i)
    {
      this->Planes[static_cast<std::size_t>(c * n + i)] =
        (map.ControlPoints(i, c) - this->Center[c]) / this->Scale;
    }
  }
  this->Weights.assign(map.Weights.data(), map.Weights.data() + map.Weights.size());
  this->WeightGradients.resize(this->Weights.size());
}

template <int Dim>
void DomainSolver<Dim>::SetQuadrature(const std::vector<int>& extra)
{
  const SplineSpace<Dim>& space = *this->Current.Space;
  std::unique_ptr<JacobianField<Dim>> field;
  this->NumPoints.clear();
  for (std::size_t e = 0; e < extra.size(); ++e)
  {
    int degree = 0;
    for (int p : space.Elements[e].Degree)
    {
      degree = std::max(degree, p);
    }
    this->NumPoints.push_back(std::min(64, degree + 1 + extra[e]));
  }
  if (space.Kind == SpaceKind::Tensor)
  {
    std::array<LinePoints, Dim> lines;
    int stride = 1;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const KnotVector& knots = space.Knots[d];
      std::vector<int> counts(static_cast<std::size_t>(knots.NumElements()), knots.Degree() + 1);
      for (std::size_t e = 0; e < extra.size(); ++e)
      {
        int& count = counts[e / static_cast<std::size_t>(stride) %
          static_cast<std::size_t>(knots.NumElements())];
        count = std::max(count, std::min(64, knots.Degree() + 1 + extra[e]));
      }
      stride *= knots.NumElements();
      lines[d] = GaussLine(knots, counts);
    }
    field = MakeTensorField<Dim>(space.Knots, lines);
  }
  else
  {
    field = MakeElementField<Dim>(space, this->NumPoints);
  }
  this->Functional = std::make_unique<DomainEnergy<Dim>>(std::move(field), space.NumFunctions);
}

template <int Dim>
EnergyValue DomainSolver<Dim>::Evaluate(
  const Density& density, double* gradient, double* weightGradient)
{
  ++this->Evaluations;
  return this->Functional->Evaluate(density, this->Planes.data(),
    this->Weights.empty() ? nullptr : this->Weights.data(), gradient, weightGradient);
}

template <int Dim>
double DomainSolver<Dim>::MinDet()
{
  Density density;
  density.Kind = DensityKind::Relu;
  return this->Evaluate(density, nullptr, nullptr).MinDet;
}

template <int Dim>
double DomainSolver<Dim>::Energy()
{
  Density density;
  density.Lambda = this->Params.UniformityWeight;
  density.Epsilon = this->Params.WinslowEpsilon;
  return this->Evaluate(density, nullptr, nullptr).Energy;
}

template <int Dim>
void DomainSolver<Dim>::Gather(Eigen::VectorXd& free) const
{
  const std::size_t n = static_cast<std::size_t>(this->Current.Space->NumFunctions);
  const std::size_t count = this->Free.size();
  free.resize(static_cast<Eigen::Index>(Dim * count));
  for (std::size_t c = 0; c < Dim; ++c)
  {
    for (std::size_t k = 0; k < count; ++k)
    {
      free[static_cast<Eigen::Index>(c * count + k)] =
        this->Planes[c * n + static_cast<std::size_t>(this->Free[k])];
    }
  }
}

template <int Dim>
void DomainSolver<Dim>::Scatter(const Eigen::VectorXd& free)
{
  const std::size_t n = static_cast<std::size_t>(this->Current.Space->NumFunctions);
  const std::size_t count = this->Free.size();
  for (std::size_t c = 0; c < Dim; ++c)
  {
    for (std::size_t k = 0; k < count; ++k)
    {
      this->Planes[c * n + static_cast<std::size_t>(this->Free[k])] =
        free[static_cast<Eigen::Index>(c * count + k)];
    }
  }
}

template <int Dim>
void DomainSolver<Dim>::Publish()
{
  const int n = this->Current.Space->NumFunctions;
  for (int i : this->Free)
  {
    for (int c = 0; c < Dim; ++c)
    {
      this->Current.ControlPoints(i, c) =
        this->Center[c] + this->Scale * this->Planes[static_cast<std::size_t>(c * n + i)];
    }
    if (this->Current.IsRational())
    {
      this->Current.Weights[i] = this->Weights[static_cast<std::size_t>(i)];
    }
  }
}

template <int Dim>
void DomainSolver<Dim>::Minimize(
  DomainStage stage, const Density& density, const MinimizeParams& params, double stopAtMinDet)
{
  const bool weights = stage == DomainStage::Weights;
  const std::size_t n = static_cast<std::size_t>(this->Current.Space->NumFunctions);
  const std::size_t count = this->Free.size();
  double lastMinDet = 0.0;
  const auto collect = [&](const std::vector<double>& full, std::size_t plane, double* free)
  {
    for (std::size_t k = 0; k < count; ++k)
    {
      free[k] = full[plane * n + static_cast<std::size_t>(this->Free[k])];
    }
  };
  const Objective ofPoints = [&](const Eigen::VectorXd& x, Eigen::VectorXd& gradient)
  {
    this->Scatter(x);
    const EnergyValue value = this->Evaluate(density, this->PlaneGradients.data(), nullptr);
    lastMinDet = value.MinDet;
    gradient.resize(x.size());
    for (std::size_t c = 0; c < Dim; ++c)
    {
      collect(this->PlaneGradients, c, gradient.data() + c * count);
    }
    return value.Energy;
  };
  const auto setWeights = [&](const Eigen::VectorXd& logarithms)
  {
    for (std::size_t k = 0; k < count; ++k)
    {
      this->Weights[static_cast<std::size_t>(this->Free[k])] =
        std::exp(logarithms[static_cast<Eigen::Index>(k)]);
    }
  };
  const Objective ofWeights = [&](const Eigen::VectorXd& x, Eigen::VectorXd& gradient)
  {
    gradient.resize(x.size());
    if (!(x.cwiseAbs().maxCoeff() <= LargestLogarithm))
    {
      return std::numeric_limits<double>::infinity();
    }
    setWeights(x);
    const EnergyValue value =
      this->Evaluate(density, this->PlaneGradients.data(), this->WeightGradients.data());
    lastMinDet = value.MinDet;
    collect(this->WeightGradients, 0, gradient.data());
    return value.Energy;
  };
  const MinimizeHook hook = [&](const MinimizeState& state)
  {
    DomainIteration row;
    row.Stage = stage;
    row.Iteration = state.Iteration;
    row.Energy = state.Value;
    row.MinDet = lastMinDet;
    row.GradientNorm = state.GradientNorm;
    row.Functions = this->Current.Space->NumFunctions;
    this->History.push_back(row);
    this->Aborted = this->Aborted || (this->Continue && !this->Continue());
    return !this->Aborted && !(lastMinDet >= stopAtMinDet);
  };
  Eigen::VectorXd x;
  MinimizeResult result;
  if (weights)
  {
    x.resize(static_cast<Eigen::Index>(count));
    collect(this->Weights, 0, x.data());
    x = x.array().log();
    result = MinimizeLbfgs(x, ofWeights, params, {}, hook);
    setWeights(x);
  }
  else
  {
    Preconditioner preconditioner;
    if (this->Laplacian)
    {
      preconditioner = [&](Eigen::VectorXd& v) { this->Laplacian->Apply(v); };
    }
    this->Gather(x);
    if (this->Params.Optimizer == DomainOptimizer::Newton && density.Kind != DensityKind::Relu)
    {
      const SplineSpace<Dim>& space = *this->Current.Space;
      NewtonSystem<Dim> system(space, this->NumPoints, this->Free, this->Current.Weights);
      const NewtonStep newton =
        [&](const Eigen::VectorXd& at, const Eigen::VectorXd& gradient, Eigen::VectorXd& step)
      {
        this->Scatter(at);
        system.Assemble(density, this->Planes.data(), true);
        return system.Solve(-gradient, step);
      };
      result = MinimizeNewton(x, ofPoints, newton, params, hook);
    }
    else
    {
      result = MinimizeLbfgs(x, ofPoints, params, preconditioner, hook);
    }
    this->Scatter(x);
  }
  this->Publish();
  this->Iterations += result.State.Iteration;
}

template <int Dim>
bool DomainSolver<Dim>::RemoveFolds()
{
  if (this->MinDet() > 0.0)
  {
    return true;
  }
  switch (this->Params.Foldover)
  {
    case FoldoverRemoval::Relu:
      return this->UnfoldRelu(10, this->Params.MaxIterations);
    case FoldoverRemoval::Penalty:
      return this->UnfoldPenalty();
    case FoldoverRemoval::Automatic:
      break;
  }
  // small folds go fast with the first, large ones safely with the second
  const Spline<Dim> start = this->Current;
  if (this->UnfoldRelu(4, 60))
  {
    return true;
  }
  this->SetMap(start);
  return !this->Aborted && this->UnfoldPenalty();
}

template <int Dim>
bool DomainSolver<Dim>::UnfoldRelu(int rounds, int iterations)
{
  Density density;
  density.Kind = DensityKind::Relu;
  density.Delta = this->Params.FoldoverMargin;
  MinimizeParams minimize;
  minimize.MaxIterations = std::min(iterations, this->Params.MaxIterations);
  minimize.EnergyTolerance = 1e-6;
  double minDet = 0.0;
  for (int k = 0; k < rounds && !(minDet > 0.0) && !this->Aborted; ++k, density.Delta *= 0.1)
  {
    this->Minimize(DomainStage::Foldover, density, minimize, EnoughDet);
    minDet = this->MinDet();
  }
  return minDet > 0.0;
}

template <int Dim>
bool DomainSolver<Dim>::UnfoldPenalty()
{
  Density density;
  density.Kind = DensityKind::Penalty;
  density.Lambda = this->Params.UniformityWeight;
  MinimizeParams minimize;
  minimize.MaxIterations = std::min(100, this->Params.MaxIterations);
  minimize.EnergyTolerance = 1e-4;
  double minDet = this->MinDet();
  for (int k = 0; k < 40 && !(minDet > 0.0) && !this->Aborted; ++k)
  {
    density.Delta = std::sqrt(1e-8 + 0.04 * minDet * minDet);
    minimize.EnergyTolerance = k < 5 ? 1e-4 : 1e-6;
    this->Minimize(DomainStage::Foldover, density, minimize, EnoughDet);
    minDet = this->MinDet();
  }
  return minDet > 0.0;
}

template <int Dim>
void DomainSolver<Dim>::ImprovePoints()
{
  Density density;
  density.Lambda = this->Params.UniformityWeight;
  density.Epsilon = this->Params.WinslowEpsilon;
  MinimizeParams minimize;
  minimize.MaxIterations = this->Params.MaxIterations;
  minimize.EnergyTolerance = this->Params.EnergyTolerance;
  this->Minimize(DomainStage::Quality, density, minimize, std::numeric_limits<double>::infinity());
}

template <int Dim>
void DomainSolver<Dim>::MakeRational()
{
  if (this->Weights.empty())
  {
    Spline<Dim> map = this->Current;
    map.Weights = Eigen::VectorXd::Ones(map.Space->NumFunctions);
    this->SetMap(map);
  }
}

template <int Dim>
void DomainSolver<Dim>::ImproveWeights()
{
  if (this->Free.empty())
  {
    return;
  }
  this->MakeRational();
  Density density;
  density.Lambda = this->Params.UniformityWeight;
  density.Epsilon = this->Params.WinslowEpsilon;
  MinimizeParams minimize;
  minimize.MaxIterations = this->Params.MaxIterations;
  minimize.EnergyTolerance = this->Params.EnergyTolerance;
  this->Minimize(DomainStage::Weights, density, minimize, std::numeric_limits<double>::infinity());
}

template <int Dim>
bool DomainSolver<Dim>::RemoveFoldsWithWeights()
{
  double minDet = this->MinDet();
  if (this->Free.empty() || minDet > 0.0)
  {
    return minDet > 0.0;
  }
  this->MakeRational();
  Density density;
  density.Kind = DensityKind::Penalty;
  density.Lambda = this->Params.UniformityWeight;
  MinimizeParams minimize;
  minimize.MaxIterations = std::min(100, this->Params.MaxIterations);
  minimize.EnergyTolerance = 1e-4;
  for (int k = 0; k < 40 && !(minDet > 0.0) && !this->Aborted; ++k)
  {
    density.Delta = std::sqrt(1e-8 + 0.04 * minDet * minDet);
    minimize.EnergyTolerance = k < 8 ? 1e-4 : 1e-6;
    this->Minimize(
      k % 2 ? DomainStage::Foldover : DomainStage::Weights, density, minimize, EnoughDet);
    minDet = this->MinDet();
  }
  return minDet > 0.0;
}

template std::vector<bool> FixedFunctions<2>(const SplineSpace<2>&);
template std::vector<bool> FixedFunctions<3>(const SplineSpace<3>&);
template class DomainSolver<2>;
template class DomainSolver<3>;
}
