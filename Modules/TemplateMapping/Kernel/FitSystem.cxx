// SPDX-License-Identifier: BSD-3-Clause
#include "FitSystem.h"

#include "BasisEvaluation.h"

#include <algorithm>
#include <numeric>
#include <string>

namespace knotwork
{
namespace
{
/// Adds the lower triangle of a dense matrix at ascending unknowns; all entries exist.
void Scatter(Eigen::SparseMatrix<double>& matrix, const std::vector<int>& unknowns,
  const Eigen::MatrixXd& values)
{
  double* stored = matrix.valuePtr();
  for (std::size_t j = 0; j < unknowns.size(); ++j)
  {
    int k = matrix.outerIndexPtr()[unknowns[j]];
    for (std::size_t i = j; i < unknowns.size(); ++i)
    {
      while (matrix.innerIndexPtr()[k] != unknowns[i])
      {
        ++k;
      }
      stored[k] += values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
}

template <int Dim>
std::vector<int> Unknowns(const std::vector<int>& functions, bool coupled)
{
  if (!coupled)
  {
    return functions;
  }
  std::vector<int> unknowns;
  unknowns.reserve(functions.size() * Dim);
  for (int f : functions)
  {
    for (int d = 0; d < Dim; ++d)
    {
      unknowns.push_back(f * Dim + d);
    }
  }
  return unknowns;
}
}

template <int Dim>
FitSystem<Dim>::FitSystem(SplineSpacePtr<Dim> space, bool coupled)
  : Space(std::move(space)), Coupled(coupled)
{
  const int size = this->Space->NumFunctions * (coupled ? Dim : 1);
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(size));
  for (int e = 0; e < this->Space->NumElements(); ++e)
  {
    const std::vector<int> unknowns = Unknowns<Dim>(this->Space->AliveFunctions(e), coupled);
    for (std::size_t j = 0; j < unknowns.size(); ++j)
    {
      std::vector<int>& column = columns[static_cast<std::size_t>(unknowns[j])];
      column.insert(
        column.end(), unknowns.begin() + static_cast<std::ptrdiff_t>(j), unknowns.end());
    }
  }
  std::size_t entries = 0;
  for (std::size_t j = 0; j < columns.size(); ++j)
  {
    std::vector<int>& column = columns[j];
    column.push_back(static_cast<int>(j));
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    entries += column.size();
  }
  this->Matrix.resize(size, size);
  this->Matrix.reserve(static_cast<Eigen::Index>(entries));
  for (int j = 0; j < size; ++j)
  {
    this->Matrix.startVec(j);
    for (int i : columns[static_cast<std::size_t>(j)])
    {
      this->Matrix.insertBack(i, j) = 0.0;
    }
  }
  this->Matrix.finalize();
  this->Solver.analyzePattern(this->Matrix);
}

template <int Dim>
Result<PointMatrix> FitSystem<Dim>::Step(const FitSamples<Dim>& samples, const FitWeights& weights)
{
  const Eigen::Index n = samples.Parameters.rows();
  PointMatrix local(n, Dim);
  std::vector<int> elements(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const int e = this->Space->Locate(samples.Parameters.row(i).data(), local.row(i).data());
    if (e < 0)
    {
      return { ErrorCode::OutsideDomain, "sample " + std::to_string(i) };
    }
    elements[static_cast<std::size_t>(i)] = e;
  }
  std::vector<Eigen::Index> order(static_cast<std::size_t>(n)); // element by element
  std::iota(order.begin(), order.end(), Eigen::Index(0));
  std::stable_sort(order.begin(), order.end(),
    [&](Eigen::Index a, Eigen::Index b)
    { return elements[static_cast<std::size_t>(a)] < elements[static_cast<std::size_t>(b)]; });

  std::fill(this->Matrix.valuePtr(), this->Matrix.valuePtr() + this->Matrix.nonZeros(), 0.0);
  PointMatrix right = PointMatrix::Zero(this->Space->NumFunctions, Dim);
  FunctionValues values;
  for (std::size_t first = 0; first < order.size();)
  {
    const int e = elements[static_cast<std::size_t>(order[first])];
    std::size_t last = first;
    while (last < order.size() && elements[static_cast<std::size_t>(order[last])] == e)
    {
      ++last;
    }
    const Eigen::Index rows = static_cast<Eigen::Index>(last - first);
    // Rows: samples of the element. tau: values of the alive functions; along: tau times normal.
    Eigen::MatrixXd tau;
    Eigen::MatrixXd along;
    PointMatrix pull(rows, Dim); // what right-hand side a sample adds, times tau
    for (Eigen::Index r = 0; r < rows; ++r)
    {
      const Eigen::Index i = order[first + static_cast<std::size_t>(r)];
      EvaluateFunctions(*this->Space, e, local.row(i).data(), 0, nullptr, values);
      const Eigen::Index alive = static_cast<Eigen::Index>(values.Functions.size());
      if (r == 0)
      {
        tau.resize(rows, alive);
        along.resize(this->Coupled ? rows : 0, alive * Dim);
      }
      tau.row(r) = values.Values.col(0).transpose();
      pull.row(r) = weights.Point * samples.Residuals.row(i);
      if (this->Coupled)
      {
        const auto normal = samples.Normals.row(i);
        pull.row(r) += weights.Normal * samples.Residuals.row(i).dot(normal) * normal;
        for (Eigen::Index f = 0; f < alive; ++f)
        {
          along.row(r).segment(f * Dim, Dim) = tau(r, f) * normal;
        }
      }
    }
    const std::vector<int> unknowns = Unknowns<Dim>(values.Functions, this->Coupled);
    const Eigen::MatrixXd gram = weights.Point * tau.transpose() * tau;
    if (this->Coupled)
    {
      Eigen::MatrixXd block = weights.Normal * along.transpose() * along;
      for (int d = 0; d < Dim; ++d)
      {
        for (Eigen::Index j = 0; j < gram.cols(); ++j)
        {
          for (Eigen::Index i = 0; i < gram.rows(); ++i)
          {
            block(i * Dim + d, j * Dim + d) += gram(i, j);
          }
        }
      }
      Scatter(this->Matrix, unknowns, block);
    }
    else
    {
      Scatter(this->Matrix, unknowns, gram);
    }
    const PointMatrix sums = tau.transpose() * pull;
    for (std::size_t f = 0; f < values.Functions.size(); ++f)
    {
      right.row(values.Functions[f]) += sums.row(static_cast<Eigen::Index>(f));
    }
    first = last;
  }
  for (Eigen::Index j = 0; j < this->Matrix.cols(); ++j) // the diagonal is a column's first entry
  {
    this->Matrix.valuePtr()[this->Matrix.outerIndexPtr()[j]] += weights.Proximal;
  }

  this->Solver.factorize(this->Matrix);
  const auto pivots = this->Solver.vectorD();
  // Below this a pivot is what rounding left of zero.
  if (this->Solver.info() != Eigen::Success || !pivots.allFinite() ||
    pivots.minCoeff() <= 1e-14 * pivots.maxCoeff())
  {
    return { ErrorCode::SingularSystem,
      "some control points are determined by no sample; use a positive Tikhonov weight" };
  }
  PointMatrix step(this->Space->NumFunctions, Dim);
  if (this->Coupled)
  {
    const Eigen::Map<const Eigen::VectorXd> flat(right.data(), right.size());
    Eigen::Map<Eigen::VectorXd>(step.data(), step.size()) = this->Solver.solve(flat);
  }
  else
  {
    const Eigen::MatrixXd columns = right; // the solver's column order
    step = this->Solver.solve(columns);
  }
  if (!step.allFinite())
  {
    return { ErrorCode::SingularSystem, "the step is not finite" };
  }
  return step;
}

template class FitSystem<2>;
}
