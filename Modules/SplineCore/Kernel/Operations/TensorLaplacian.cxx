// SPDX-License-Identifier: BSD-3-Clause
#include "TensorLaplacian.h"

#include "Parallel.h"
#include "Quadrature.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <utility>

namespace knotwork
{
LineIntegrals IntegrateLine(const KnotVector& knots)
{
  const int p = knots.Degree();
  const int n = knots.NumFunctions();
  LineIntegrals line;
  line.Mass = line.Stiffness = line.Bending = line.Mixed = Eigen::MatrixXd::Zero(n, n);
  const QuadratureRule rule = GaussLegendre(p + 1);
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> values(3, p + 1);
  for (int e = 0; e < knots.NumElements(); ++e)
  {
    const double begin = knots.Breaks()[static_cast<std::size_t>(e)];
    const double length = knots.Breaks()[static_cast<std::size_t>(e) + 1] - begin;
    const int first = knots.Span(e) - p;
    for (std::size_t q = 0; q < rule.Nodes.size(); ++q)
    {
      knots.EvaluateFunctions(e, begin + length * rule.Nodes[q], 2, values.data());
      const double w = length * rule.Weights[q];
      line.Mass.block(first, first, p + 1, p + 1) += w * values.row(0).transpose() * values.row(0);
      line.Stiffness.block(first, first, p + 1, p + 1) +=
        w * values.row(1).transpose() * values.row(1);
      line.Bending.block(first, first, p + 1, p + 1) +=
        w * values.row(2).transpose() * values.row(2);
      line.Mixed.block(first, first, p + 1, p + 1) += w * values.row(2).transpose() * values.row(0);
    }
  }
  return line;
}

TensorModes FindTensorModes(
  const std::vector<Eigen::MatrixXd>& masses, const std::vector<Eigen::MatrixXd>& stiffnesses)
{
  TensorModes found;
  found.Sums = Eigen::VectorXd::Zero(1);
  for (std::size_t d = 0; d < masses.size(); ++d)
  {
    const Eigen::Index n = masses[d].rows();
    Eigen::VectorXd eigenvalues(n);
    found.Modes.emplace_back(n, n);
    if (n > 0)
    {
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
        stiffnesses[d], masses[d]);
      eigenvalues = solver.eigenvalues();
      found.Modes[d] = solver.eigenvectors();
    }
    Eigen::VectorXd grown(found.Sums.size() * n);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      grown.segment(i * found.Sums.size(), found.Sums.size()) = found.Sums.array() + eigenvalues[i];
    }
    found.Sums = grown;
  }
  return found;
}

TensorLaplacian::TensorLaplacian(const std::vector<Eigen::MatrixXd>& masses,
  const std::vector<Eigen::MatrixXd>& stiffnesses, int threads)
  : Threads(threads)
{
  TensorModes found = FindTensorModes(masses, stiffnesses);
  this->Modes = std::move(found.Modes);
  const Eigen::VectorXd& sums = found.Sums;
  if (sums.size() > 0)
  {
    const double zero = 1e-12 * sums.maxCoeff();
    const double least = (sums.array() > zero).select(sums.array(), sums.maxCoeff()).minCoeff();
    this->Inverse = sums.cwiseMax(least).cwiseInverse();
  }
  this->Values.resize(sums.size());
  this->Other.resize(sums.size());
}

void TensorLaplacian::Apply(double* values)
{
  constexpr std::size_t Chunk = 4096;
  const Eigen::Index size = this->Size();
  if (size == 0)
  {
    return;
  }
  const auto forSegments = [&](const auto& body)
  {
    ParallelFor(static_cast<std::size_t>(size), Chunk, this->Threads,
      [&](std::size_t begin, std::size_t end)
      { body(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin)); });
  };
  forSegments([&](Eigen::Index first, Eigen::Index count)
    { std::copy_n(values + first, count, this->Values.data() + first); });
  this->Multiply(true);
  forSegments([&](Eigen::Index first, Eigen::Index count)
    { this->Values.segment(first, count).array() *= this->Inverse.segment(first, count).array(); });
  this->Multiply(false);
  forSegments([&](Eigen::Index first, Eigen::Index count)
    { std::copy_n(this->Values.data() + first, count, values + first); });
}

/// The values by the modes of all directions, or by their transposes.
void TensorLaplacian::Multiply(bool transposed)
{
  using Strided = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  constexpr std::size_t Rows = 256; // of a product at a time
  const Eigen::Index size = this->Size();
  Eigen::Index inner = 1;
  for (std::size_t d = 0; d < this->Modes.size(); ++d)
  {
    const Eigen::MatrixXd& modes = this->Modes[d];
    const Eigen::Index n = modes.rows();
    const Eigen::MatrixXd matrix = transposed ? modes : Eigen::MatrixXd(modes.transpose());
    if (d == 0)
    {
      ParallelFor(static_cast<std::size_t>(size / n), Rows, this->Threads,
        [&](std::size_t begin, std::size_t end)
        {
          const auto first = static_cast<Eigen::Index>(begin) * n;
          const auto columns = static_cast<Eigen::Index>(end - begin);
          Eigen::Map<Eigen::MatrixXd>(this->Other.data() + first, n, columns).noalias() =
            matrix.transpose() *
            Eigen::Map<Eigen::MatrixXd>(this->Values.data() + first, n, columns);
        });
    }
    else
    {
      const Eigen::Index slabs = size / (inner * n);
      const auto parts = (static_cast<std::size_t>(inner) + Rows - 1) / Rows;
      ParallelFor(static_cast<std::size_t>(slabs) * parts, 1, this->Threads,
        [&](std::size_t k, std::size_t)
        {
          const auto row = static_cast<Eigen::Index>(k % parts * Rows);
          const Eigen::Index rows = std::min<Eigen::Index>(Rows, inner - row);
          const Eigen::Index first = static_cast<Eigen::Index>(k / parts) * inner * n + row;
          const Eigen::OuterStride<> stride(inner);
          Strided(this->Other.data() + first, rows, n, stride).noalias() =
            Strided(this->Values.data() + first, rows, n, stride) * matrix;
        });
    }
    this->Values.swap(this->Other);
    inner *= n;
  }
}
}
