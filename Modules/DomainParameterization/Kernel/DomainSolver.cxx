// SPDX-License-Identifier: BSD-3-Clause
#include "DomainSolver.h"

#include "FastLaplacian.h"
#include "GluedSystem.h"
#include "NewtonSystem.h"

#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// Smallest det J over S from where the quality functional goes on by itself.
constexpr double EnoughDet = 0.02;
/// Nanoseconds of a quadrature point where sums are factorized, and of one of its functions where
/// they are not: what WorkBudget counts.
template <int Dim>
constexpr double PointCost = Dim == 2 ? 10.0 : 40.0;
constexpr double FunctionCost = 8.0;
/// The same of a free number in a step of the optimizer, and of a multiplication in its
/// preconditioner.
constexpr double StepCost = 40.0;
constexpr double ProductCost = 0.5;
/// Weights stay within a factor of 100 of 1.
constexpr double LargestLogarithm = 4.6;
}

template <int Dim>
DomainSolver<Dim>::DomainSolver(
  const GluedMap<Dim>& map, double area, const DomainParams& params, WorkBudget& budget)
  : Params(params), Budget(budget), NumFunctions(map.NumFunctions()),
    Scale(std::pow(area, 1.0 / Dim))
{
  this->Center = GluedPoints<Dim>(map).colwise().mean();
  for (std::size_t i = 0; i < map.Fixed.size(); ++i)
  {
    if (!map.Fixed[i])
    {
      this->Free.push_back(static_cast<int>(i));
    }
  }
  this->SetMap(map);
  this->SetQuadrature(std::vector<int>(static_cast<std::size_t>(map.NumElements()), 0));
  if (map.Patches.size() == 1 && map.Patches.front().Space->Kind == SpaceKind::Tensor)
  {
    this->Precondition = [laplacian = FastLaplacian<Dim>(map.Patches.front().Space->Knots)](
                           Eigen::VectorXd& planes) mutable { laplacian.Apply(planes); };
  }
  else
  {
    const auto laplacian = std::make_shared<const GluedSystem<Dim>>(map, GluedOperator::Laplacian);
    this->Precondition = [laplacian](Eigen::VectorXd& planes) { laplacian->Apply(planes); };
  }
}

template <int Dim>
void DomainSolver<Dim>::SetMap(const GluedMap<Dim>& map)
{
  this->Current = map;
  const std::size_t n = static_cast<std::size_t>(this->NumFunctions);
  this->Planes.resize(Dim * n);
  this->PlaneGradients.resize(this->Planes.size());
  this->Weights.resize(map.IsRational() ? n : 0);
  this->WeightGradients.resize(this->Weights.size());
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    const Spline<Dim>& patch = map.Patches[p];
    for (std::size_t i = 0; i < map.Functions[p].size(); ++i)
    {
      const std::size_t number = static_cast<std::size_t>(map.Functions[p][i]);
      const Eigen::Index row = static_cast<Eigen::Index>(i);
      for (int c = 0; c < Dim; ++c)
      {
        this->Planes[static_cast<std::size_t>(c) * n + number] =
          (patch.ControlPoints(row, c) - this->Center[c]) / this->Scale;
      }
      if (patch.IsRational())
      {
        this->Weights[number] = patch.Weights[row];
      }
    }
  }
}

template <int Dim>
void DomainSolver<Dim>::SetQuadrature(const std::vector<int>& extra)
{
  this->NumPoints.clear();
  this->Cost = 0.0;
  std::vector<std::unique_ptr<JacobianField<Dim>>> fields;
  for (const Spline<Dim>& patch : this->Current.Patches)
  {
    const SplineSpace<Dim>& space = *patch.Space;
    const std::size_t first = this->NumPoints.size();
    for (const auto& element : space.Elements)
    {
      int degree = 0;
      for (int p : element.Degree)
      {
        degree = std::max(degree, p);
      }
      this->NumPoints.push_back(std::min(64, degree + 1 + extra[this->NumPoints.size()]));
    }
    if (space.Kind != SpaceKind::Tensor)
    {
      fields.push_back(MakeElementField<Dim>(space,
        { this->NumPoints.begin() + static_cast<std::ptrdiff_t>(first), this->NumPoints.end() }));
      std::size_t alive = 0;
      for (std::size_t e = 0; e < space.Elements.size(); ++e)
      {
        alive = std::max(alive, space.AliveFunctions(static_cast<int>(e)).size());
      }
      this->Cost += FunctionCost * static_cast<double>(alive) * fields.back()->NumPoints();
      continue;
    }
    std::array<LinePoints, Dim> lines;
    std::size_t stride = 1;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const KnotVector& knots = space.Knots[d];
      std::vector<int> counts(static_cast<std::size_t>(knots.NumElements()), knots.Degree() + 1);
      for (std::size_t e = 0; e < space.Elements.size(); ++e)
      {
        int& count = counts[e / stride % counts.size()];
        count = std::max(count, std::min(64, knots.Degree() + 1 + extra[first + e]));
      }
      stride *= counts.size();
      lines[d] = GaussLine(knots, counts);
    }
    fields.push_back(MakeTensorField<Dim>(space.Knots, lines));
    this->Cost += PointCost<Dim> * fields.back()->NumPoints();
  }
  std::unique_ptr<JacobianField<Dim>> field = fields.size() == 1
    ? std::move(fields.front())
    : MakeGluedField<Dim>(std::move(fields), this->Current.Functions, this->NumFunctions);
  this->Functional = std::make_unique<DomainEnergy<Dim>>(std::move(field), this->NumFunctions);
  double products = 0.0; // a number in the preconditioner
  const SplineSpace<Dim>& space = *this->Current.Patches.front().Space;
  if (this->Current.Patches.size() == 1 && space.Kind == SpaceKind::Tensor)
  {
    for (const KnotVector& knots : space.Knots)
    {
      products += knots.NumFunctions();
    }
  }
  else
  {
    // entries of a column of a sparse factor, about
    const double n = this->NumFunctions;
    products = Dim == 2 ? 8.0 * std::log2(n + 1.0) : 2.0 * std::pow(n, 2.0 / 3.0);
  }
  this->Cost += Dim * this->NumFunctions * (StepCost + ProductCost * products);
}

template <int Dim>
EnergyValue DomainSolver<Dim>::Evaluate(
  const Density& density, double* gradient, double* weightGradient)
{
  ++this->Evaluations;
  this->Budget.Spend(this->Cost);
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
  const std::size_t n = static_cast<std::size_t>(this->NumFunctions);
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
  const std::size_t n = static_cast<std::size_t>(this->NumFunctions);
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
  const std::size_t n = static_cast<std::size_t>(this->NumFunctions);
  for (std::size_t p = 0; p < this->Current.Patches.size(); ++p)
  {
    Spline<Dim>& patch = this->Current.Patches[p];
    for (std::size_t i = 0; i < this->Current.Functions[p].size(); ++i)
    {
      const std::size_t number = static_cast<std::size_t>(this->Current.Functions[p][i]);
      const Eigen::Index row = static_cast<Eigen::Index>(i);
      if (this->Current.Fixed[number])
      {
        continue;
      }
      for (int c = 0; c < Dim; ++c)
      {
        patch.ControlPoints(row, c) =
          this->Center[c] + this->Scale * this->Planes[static_cast<std::size_t>(c) * n + number];
      }
      if (patch.IsRational())
      {
        patch.Weights[row] = this->Weights[number];
      }
    }
  }
}

template <int Dim>
void DomainSolver<Dim>::Minimize(
  DomainStage stage, const Density& density, const MinimizeParams& params, double stopAtMinDet)
{
  if (!this->Budget.MayGoOn())
  {
    return;
  }
  const bool weights = stage == DomainStage::Weights;
  const std::size_t n = static_cast<std::size_t>(this->NumFunctions);
  const std::size_t count = this->Free.size();
  double lastMinDet = 0.0;
  const auto collect = [&](const std::vector<double>& full, std::size_t plane, double* free)
  {
    for (std::size_t k = 0; k < count; ++k)
    {
      free[k] = full[plane * n + static_cast<std::size_t>(this->Free[k])];
    }
  };
  // when the budget is used up no step is better than none: the search ends at once
  const Objective ofPoints = [&](const Eigen::VectorXd& x, Eigen::VectorXd& gradient)
  {
    if (!this->Budget.MayGoOn())
    {
      return std::numeric_limits<double>::infinity();
    }
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
    if (!(x.cwiseAbs().maxCoeff() <= LargestLogarithm) || !this->Budget.MayGoOn())
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
    row.Functions = this->NumFunctions;
    this->History.push_back(row);
    return this->Budget.MayGoOn() && !(lastMinDet >= stopAtMinDet);
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
    this->Gather(x);
    if (this->Params.Optimizer == DomainOptimizer::Newton &&
      (density.Kind == DensityKind::Quality || density.Kind == DensityKind::Penalty))
    {
      NewtonSystem<Dim> system(this->Current, this->NumPoints, this->Free);
      const NewtonStep newton =
        [&](const Eigen::VectorXd& at, const Eigen::VectorXd& gradient, Eigen::VectorXd& step)
      {
        this->Scatter(at);
        system.Assemble(density, this->Planes.data(), true);
        const bool solved = system.Solve(-gradient, step);
        this->Budget.Spend(system.Work());
        return solved;
      };
      result = MinimizeNewton(x, ofPoints, newton, params, hook);
    }
    else
    {
      result = MinimizeLbfgs(x, ofPoints, params, this->Precondition, hook);
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
  const GluedMap<Dim> start = this->Current;
  if (this->UnfoldRelu(4, 60))
  {
    return true;
  }
  this->SetMap(start);
  return this->Budget.MayGoOn() && this->UnfoldPenalty();
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
  for (int k = 0; k < rounds && !(minDet > 0.0) && this->Budget.MayGoOn();
       ++k, density.Delta *= 0.1)
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
  for (int k = 0; k < 40 && !(minDet > 0.0) && this->Budget.MayGoOn(); ++k)
  {
    density.Delta = std::sqrt(1e-8 + 0.04 * minDet * minDet);
    minimize.EnergyTolerance = k < 5 ? 1e-4 : 1e-6;
    this->Minimize(DomainStage::Foldover, density, minimize, EnoughDet);
    minDet = this->MinDet();
  }
  return minDet > 0.0;
}

/// To the end, as the parameters say.
template <int Dim>
void DomainSolver<Dim>::MinimizeQuality(DomainStage stage, const Density& density)
{
  MinimizeParams minimize;
  minimize.MaxIterations = this->Params.MaxIterations;
  minimize.EnergyTolerance = this->Params.EnergyTolerance;
  this->Minimize(stage, density, minimize, std::numeric_limits<double>::infinity());
}

template <int Dim>
void DomainSolver<Dim>::ImprovePoints()
{
  Density density;
  density.Lambda = this->Params.UniformityWeight;
  density.Epsilon = this->Params.WinslowEpsilon;
  this->MinimizeQuality(DomainStage::Quality, density);
}

template <int Dim>
void DomainSolver<Dim>::RaiseLeastJacobian(double power)
{
  Density density;
  density.Kind = DensityKind::Inverse;
  density.Delta = this->MinDet();
  density.Power = power;
  density.Lambda = this->Params.UniformityWeight;
  this->MinimizeQuality(DomainStage::Quality, density);
}

template <int Dim>
void DomainSolver<Dim>::MakeRational()
{
  if (this->Weights.empty())
  {
    GluedMap<Dim> map = this->Current;
    for (Spline<Dim>& patch : map.Patches)
    {
      patch.Weights = Eigen::VectorXd::Ones(patch.Space->NumFunctions);
    }
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
  this->MinimizeQuality(DomainStage::Weights, density);
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
  for (int k = 0; k < 40 && !(minDet > 0.0) && this->Budget.MayGoOn(); ++k)
  {
    density.Delta = std::sqrt(1e-8 + 0.04 * minDet * minDet);
    minimize.EnergyTolerance = k < 8 ? 1e-4 : 1e-6;
    this->Minimize(
      k % 2 ? DomainStage::Foldover : DomainStage::Weights, density, minimize, EnoughDet);
    minDet = this->MinDet();
  }
  return minDet > 0.0;
}

template class DomainSolver<2>;
template class DomainSolver<3>;
}
