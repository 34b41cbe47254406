// SPDX-License-Identifier: BSD-3-Clause
#include "NewtonSystem.h"

#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace knotwork
{
namespace
{
/// Derivatives of f(|J|^2, det J) that Newton's method needs.
struct DensityTerms
{
  double ByF = 0.0;
  double ByD = 0.0;
  double ByFD = 0.0;
  double ByDD = 0.0;
};

template <int Dim>
DensityTerms Differentiate(const Density& density, double f, double d)
{
  constexpr double a = 2.0 / Dim;
  DensityTerms terms;
  if (density.Kind == DensityKind::Quality)
  {
    const double chi = std::max(d, 0.0) + density.Epsilon;
    terms.ByF = std::pow(chi, -a);
    terms.ByD = -a * f * terms.ByF / chi;
    terms.ByFD = -a * terms.ByF / chi;
    terms.ByDD = a * (a + 1.0) * f * terms.ByF / (chi * chi);
  }
  else
  {
    const double root = std::sqrt(d * d + density.Delta * density.Delta);
    const double chi =
      d > 0.0 ? 0.5 * (d + root) : 0.5 * density.Delta * density.Delta / (root - d);
    terms.ByF = std::pow(chi, -a);
    terms.ByD = -a * f * terms.ByF / root;
    terms.ByFD = -a * terms.ByF / root;
    terms.ByDD = f * terms.ByF * a * ((a + 1.0) - (1.0 - d / root)) / (root * root);
  }
  terms.ByD += 2.0 * density.Lambda * (d - 1.0);
  terms.ByDD += 2.0 * density.Lambda;
  return terms;
}

/// Cofactors and second derivatives of the determinant, in the order Dim * c + k.
template <int Dim>
double Determinant(const Eigen::Matrix<double, Dim * Dim, 1>& j,
  Eigen::Matrix<double, Dim * Dim, 1>& cofactors,
  Eigen::Matrix<double, Dim * Dim, Dim * Dim>& second)
{
  second.setZero();
  if constexpr (Dim == 2)
  {
    cofactors << j[3], -j[2], -j[1], j[0];
    second(0, 3) = second(3, 0) = 1.0;
    second(1, 2) = second(2, 1) = -1.0;
  }
  else
  {
    for (int c = 0; c < 3; ++c)
    {
      const int a = (c + 1) % 3;
      const int b = (c + 2) % 3;
      for (int k = 0; k < 3; ++k)
      {
        const int l = (k + 1) % 3;
        const int m = (k + 2) % 3;
        cofactors[3 * c + k] = j[3 * a + l] * j[3 * b + m] - j[3 * a + m] * j[3 * b + l];
        second(3 * c + k, 3 * a + l) = j[3 * b + m];
        second(3 * c + k, 3 * b + m) = j[3 * a + l];
        second(3 * c + k, 3 * a + m) = -j[3 * b + l];
        second(3 * c + k, 3 * b + l) = -j[3 * a + m];
      }
    }
  }
  double det = 0.0;
  for (int k = 0; k < Dim; ++k)
  {
    det += j[k] * cofactors[k];
  }
  return det;
}
}

template <int Dim>
NewtonSystem<Dim>::NewtonSystem(
  const GluedMap<Dim>& map, const std::vector<int>& numPoints, const std::vector<int>& free)
  : NumFunctions(map.NumFunctions()), NumFree(static_cast<int>(free.size()))
{
  std::vector<int> unknown(static_cast<std::size_t>(this->NumFunctions), -1);
  for (std::size_t k = 0; k < free.size(); ++k)
  {
    unknown[static_cast<std::size_t>(free[k])] = static_cast<int>(k);
  }
  const int* points = numPoints.data();
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    const Spline<Dim>& patch = map.Patches[p];
    this->AddPatch(*patch.Space, points, patch.Weights, map.Functions[p], unknown);
    points += patch.Space->NumElements();
  }
}

template <int Dim>
void NewtonSystem<Dim>::AddPatch(const SplineSpace<Dim>& space, const int* numPoints,
  const Eigen::VectorXd& weights, const std::vector<int>& numbers, const std::vector<int>& unknown)
{
  FunctionValues basis;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    IntArray<Dim> counts;
    counts.fill(numPoints[e]);
    const ElementQuadrature<Dim> rule = MakeElementQuadrature<Dim>(counts);
    const auto& box = space.Elements[static_cast<std::size_t>(e)].Box;
    double volume = 1.0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      volume *= box.Upper[d] - box.Lower[d];
    }
    Block block;
    block.Weights = volume * rule.Weights;
    for (Eigen::Index q = 0; q < rule.Local.rows(); ++q)
    {
      EvaluateFunctions<Dim>(
        space, e, rule.Local.row(q).data(), 1, weights.size() > 0 ? &weights : nullptr, basis);
      if (q == 0)
      {
        block.Slopes.resize(
          static_cast<Eigen::Index>(Dim * basis.Functions.size()), rule.Local.rows());
        for (int f : basis.Functions)
        {
          const int number = numbers[static_cast<std::size_t>(f)];
          block.Functions.push_back(number);
          block.Unknowns.push_back(unknown[static_cast<std::size_t>(number)]);
        }
      }
      for (Eigen::Index f = 0; f < basis.Values.rows(); ++f)
      {
        for (Eigen::Index k = 0; k < Dim; ++k)
        {
          block.Slopes(f * Dim + k, q) = basis.Values(f, k + 1);
        }
      }
    }
    this->Blocks.push_back(std::move(block));
  }
}

template <int Dim>
void NewtonSystem<Dim>::Assemble(const Density& density, const double* points, bool project)
{
  using Vector = Eigen::Matrix<double, Dim * Dim, 1>;
  using Square = Eigen::Matrix<double, Dim * Dim, Dim * Dim>;
  this->Triplets.clear();
  Eigen::MatrixXd dense, slopes, product;
  for (const Block& block : this->Blocks)
  {
    const Eigen::Index n = static_cast<Eigen::Index>(block.Functions.size());
    dense.setZero(n * Dim, n * Dim); // unknowns c * n + f
    slopes.setZero(Dim * Dim, n * Dim);
    for (Eigen::Index q = 0; q < block.Slopes.cols(); ++q)
    {
      Vector j = Vector::Zero();
      for (Eigen::Index f = 0; f < n; ++f)
      {
        for (int c = 0; c < Dim; ++c)
        {
          const double x = points[c * this->NumFunctions + block.Functions[std::size_t(f)]];
          for (int k = 0; k < Dim; ++k)
          {
            slopes(Dim * c + k, c * n + f) = block.Slopes(f * Dim + k, q);
            j[Dim * c + k] += x * block.Slopes(f * Dim + k, q);
          }
        }
      }
      Vector cofactors;
      Square hessian;
      const double det = Determinant<Dim>(j, cofactors, hessian);
      const DensityTerms terms = Differentiate<Dim>(density, j.squaredNorm(), det);
      hessian *= terms.ByD;
      hessian += 2.0 * terms.ByFD * (j * cofactors.transpose() + cofactors * j.transpose());
      hessian += terms.ByDD * cofactors * cofactors.transpose();
      hessian.diagonal().array() += 2.0 * terms.ByF;
      if (project)
      {
        const Eigen::SelfAdjointEigenSolver<Square> solver(hessian);
        if (solver.eigenvalues()[0] < 0.0)
        {
          hessian = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
            solver.eigenvectors().transpose();
        }
      }
      product.noalias() = block.Weights[q] * hessian * slopes;
      dense.noalias() += slopes.transpose() * product;
    }
    for (Eigen::Index b = 0; b < n * Dim; ++b)
    {
      const int column = block.Unknowns[std::size_t(b % n)];
      for (Eigen::Index a = 0; column >= 0 && a < n * Dim; ++a)
      {
        const int row = block.Unknowns[std::size_t(a % n)];
        const int i = static_cast<int>(a / n) * this->NumFree + row;
        const int k = static_cast<int>(b / n) * this->NumFree + column;
        if (row >= 0 && i >= k)
        {
          this->Triplets.emplace_back(i, k, dense(a, b));
        }
      }
    }
  }
  this->Lower.resize(Dim * this->NumFree, Dim * this->NumFree);
  this->Lower.setFromTriplets(this->Triplets.begin(), this->Triplets.end());
}

template <int Dim>
double NewtonSystem<Dim>::Work() const
{
  double multiplications = 0.0;
  for (const Block& block : this->Blocks)
  {
    const double rows = static_cast<double>(block.Slopes.rows());
    multiplications += rows * rows * static_cast<double>(block.Weights.size());
  }
  if (this->Analyzed && this->Solver.info() == Eigen::Success)
  {
    const auto& factor = this->Solver.matrixL().nestedExpression();
    for (Eigen::Index column = 0; column < factor.outerSize(); ++column)
    {
      const double entries = factor.outerIndexPtr()[column + 1] - factor.outerIndexPtr()[column];
      multiplications += entries * entries;
    }
  }
  return multiplications;
}

template <int Dim>
bool NewtonSystem<Dim>::Solve(const Eigen::VectorXd& right, Eigen::VectorXd& step)
{
  if (!this->Analyzed)
  {
    this->Solver.analyzePattern(this->Lower);
    this->Analyzed = true;
  }
  // a projected Hessian may be singular: a shift far below the elliptic part
  this->Solver.setShift(1e-12 * this->Lower.diagonal().maxCoeff());
  this->Solver.factorize(this->Lower);
  if (this->Solver.info() != Eigen::Success)
  {
    return false;
  }
  step = this->Solver.solve(right);
  return step.allFinite();
}

MinimizeResult MinimizeNewton(Eigen::VectorXd& x, const Objective& objective,
  const NewtonStep& newton, const MinimizeParams& params, const MinimizeHook& hook)
{
  MinimizeResult result;
  Eigen::VectorXd gradient(x.size()), step, trial, trialGradient(x.size());
  double value = objective(x, gradient);
  ++result.Evaluations;
  const auto report = [&](int iteration)
  {
    result.State = { iteration, value, x.size() > 0 ? gradient.lpNorm<Eigen::Infinity>() : 0.0 };
    result.Stopped = hook && !hook(result.State);
  };
  report(0);
  if (x.size() == 0 || result.State.GradientNorm <= params.GradientTolerance)
  {
    result.Converged = true;
    return result;
  }
  for (int iteration = 1; iteration <= params.MaxIterations && !result.Stopped; ++iteration)
  {
    if (!newton(x, gradient, step))
    {
      return result;
    }
    const double slope = gradient.dot(step);
    if (!(slope < 0.0))
    {
      return result;
    }
    double length = 1.0;
    double trialValue = 0.0;
    bool lower = false;
    for (int search = 0; search < 40 && !lower; ++search, length *= 0.5)
    {
      trial = x + length * step;
      trialValue = objective(trial, trialGradient);
      ++result.Evaluations;
      lower = trialValue <= value + 1e-4 * length * slope;
    }
    if (!lower)
    {
      return result;
    }
    const double gain = value - trialValue;
    x.swap(trial);
    gradient.swap(trialGradient);
    value = trialValue;
    report(iteration);
    // quadratic convergence: one small gain is enough
    if (gain <= params.EnergyTolerance * std::abs(value) ||
      result.State.GradientNorm <= params.GradientTolerance)
    {
      result.Converged = true;
      return result;
    }
  }
  return result;
}

template class NewtonSystem<2>;
template class NewtonSystem<3>;
}
