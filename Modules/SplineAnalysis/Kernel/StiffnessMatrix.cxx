// SPDX-License-Identifier: BSD-3-Clause
#include "StiffnessMatrix.h"

#include "ElementRule.h"
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Entries of an element, all components of a pair of functions together: dense, both triangles.
Eigen::MatrixXd ElementMatrix(
  const GalerkinSpace& space, const GalerkinProblem& problem, int element, RuleTables& tables)
{
  const int alive = space.NumAlive(element);
  const int dimension = space.Dimension;
  const int components = NumSolutionComponents(problem.Equation);
  const GalerkinMaterial& material = MaterialOf(problem, element);
  const LameConstants lame = MakeLameConstants(problem.Equation, material);
  // products[i, j](a, b) = integral of d_i N_a d_j N_b
  std::vector<Eigen::MatrixXd> gradients(static_cast<std::size_t>(dimension));
  Eigen::VectorXd weights;
  tables.Visit(space, element,
    [&](std::size_t q, const PointValues& values)
    {
      if (q == 0)
      {
        weights.resize(tables.NumPoints);
        for (Eigen::MatrixXd& component : gradients)
        {
          component.resize(alive, tables.NumPoints);
        }
      }
      const auto column = static_cast<Eigen::Index>(q);
      weights[column] = tables.Weights[q] * std::abs(values.Determinant);
      for (int d = 0; d < dimension; ++d)
      {
        gradients[static_cast<std::size_t>(d)].col(column) = values.Gradients.col(d);
      }
    });
  const auto product = [&](int i, int j) -> Eigen::MatrixXd
  {
    return (gradients[static_cast<std::size_t>(i)] * weights.asDiagonal()) *
      gradients[static_cast<std::size_t>(j)].transpose();
  };
  Eigen::MatrixXd laplace = Eigen::MatrixXd::Zero(alive, alive);
  Eigen::MatrixXd matrix(alive * components, alive * components);
  if (problem.Equation == GalerkinEquation::Poisson)
  {
    for (int d = 0; d < dimension; ++d)
    {
      laplace += product(d, d);
    }
    return material.Conductivity * laplace;
  }
  for (int i = 0; i < dimension; ++i)
  {
    for (int j = 0; j <= i; ++j)
    {
      const Eigen::MatrixXd ij = product(i, j);
      if (i == j)
      {
        laplace += ij;
      }
      // component i of test function a, component j of trial function b
      for (int b = 0; b < alive; ++b)
      {
        for (int a = 0; a < alive; ++a)
        {
          const double value = lame.First * ij(a, b) + lame.Shear * ij(b, a);
          matrix(a * components + i, b * components + j) = value;
          matrix(b * components + j, a * components + i) = value;
        }
      }
    }
  }
  for (int b = 0; b < alive; ++b)
  {
    for (int a = 0; a < alive; ++a)
    {
      for (int i = 0; i < components; ++i)
      {
        matrix(a * components + i, b * components + i) += lame.Shear * laplace(a, b);
      }
    }
  }
  return matrix;
}

}

Eigen::SparseMatrix<double> MakePattern(const GalerkinSpace& space, int components)
{
  const auto n = static_cast<std::size_t>(space.NumFunctions());
  std::vector<std::vector<int>> below(n);
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const int* alive = space.Alive(e);
    for (int a = 0; a < space.NumAlive(e); ++a)
    {
      auto& list = below[static_cast<std::size_t>(alive[a])];
      for (int b = 0; b < space.NumAlive(e); ++b)
      {
        if (alive[b] >= alive[a])
        {
          list.push_back(alive[b]);
        }
      }
      // lists stay short: a function's are repeated on every element of its support
      if (list.size() > 4096)
      {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
      }
    }
  }
  const Eigen::Index size = space.NumFunctions() * Eigen::Index{ components };
  Eigen::SparseMatrix<double> matrix(size, size);
  Eigen::Index entries = 0;
  for (auto& list : below)
  {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    const auto c = static_cast<Eigen::Index>(components);
    entries += static_cast<Eigen::Index>(list.size()) * c * c;
    entries -= list.empty() ? 0 : c * (c - 1) / 2; // the diagonal block's upper triangle
  }
  matrix.resizeNonZeros(entries);
  int* outer = matrix.outerIndexPtr();
  int* inner = matrix.innerIndexPtr();
  int next = 0;
  for (std::size_t f = 0; f < n; ++f)
  {
    for (int c = 0; c < components; ++c)
    {
      *outer++ = next;
      for (const int row : below[f])
      {
        for (int i = row == static_cast<int>(f) ? c : 0; i < components; ++i)
        {
          inner[next++] = row * components + i;
        }
      }
    }
  }
  *outer = next;
  std::fill_n(matrix.valuePtr(), entries, 0.0);
  return matrix;
}

void AddElement(const Eigen::MatrixXd& block, const int* alive, int count, int components,
  Eigen::SparseMatrix<double>& matrix)
{
  for (int b = 0; b < count; ++b)
  {
    for (int j = 0; j < components; ++j)
    {
      const int column = alive[b] * components + j;
      const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
      const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
      for (int a = 0; a < count; ++a)
      {
        if (alive[a] < alive[b])
        {
          continue;
        }
        const int first = alive[a] == alive[b] ? j : 0;
        const int* place = std::lower_bound(begin, end, alive[a] * components + first);
        double* value = matrix.valuePtr() + (place - matrix.innerIndexPtr());
        for (int i = first; i < components; ++i)
        {
          *value++ += block(a * components + i, b * components + j);
        }
      }
    }
  }
}

int NumSolutionComponents(GalerkinEquation equation)
{
  switch (equation)
  {
    case GalerkinEquation::Poisson:
      return 1;
    case GalerkinEquation::PlaneStress:
    case GalerkinEquation::PlaneStrain:
      return 2;
    case GalerkinEquation::Solid:
      break;
  }
  return 3;
}

LameConstants MakeLameConstants(GalerkinEquation equation, const GalerkinMaterial& material)
{
  const double nu = material.PoissonsRatio;
  const double shear = material.YoungsModulus / (2.0 * (1.0 + nu));
  const double first = equation == GalerkinEquation::PlaneStress
    ? 2.0 * shear * nu / (1.0 - nu)
    : 2.0 * shear * nu / (1.0 - 2.0 * nu);
  return { first, shear };
}

const GalerkinMaterial& MaterialOf(const GalerkinProblem& problem, int element)
{
  return problem.Materials[problem.MaterialIds.empty()
      ? 0
      : static_cast<std::size_t>(problem.MaterialIds[static_cast<std::size_t>(element)])];
}

Result<Eigen::SparseMatrix<double>> AssembleStiffness(const GalerkinSpace& space,
  const GalerkinProblem& problem, const GalerkinParams& params, const ProgressCallback& progress)
{
  constexpr int Batch = 512; // element matrices held at a time
  const int components = NumSolutionComponents(problem.Equation);
  Eigen::SparseMatrix<double> matrix = MakePattern(space, components);
  const int count = space.NumElements();
  std::vector<Eigen::MatrixXd> blocks(static_cast<std::size_t>(std::min(Batch, count)));
  for (int first = 0; first < count; first += Batch)
  {
    const int size = std::min(Batch, count - first);
    ParallelFor(static_cast<std::size_t>(size), 64, params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        RuleTables tables(params.QuadratureTolerance);
        for (std::size_t i = begin; i < end; ++i)
        {
          blocks[i] = ElementMatrix(space, problem, first + static_cast<int>(i), tables);
        }
      });
    for (int i = 0; i < size; ++i)
    {
      const Eigen::MatrixXd& block = blocks[static_cast<std::size_t>(i)];
      if (!block.allFinite())
      {
        return { ErrorCode::InvalidTopology,
          "the map of element " + std::to_string(first + i) + " is singular; mend the geometry" };
      }
      AddElement(block, space.Alive(first + i), space.NumAlive(first + i), components, matrix);
    }
    if (progress && !progress(0.1 + 0.4 * (first + size) / count))
    {
      return { ErrorCode::Aborted, "while the matrix was assembled" };
    }
  }
  return matrix;
}
}
