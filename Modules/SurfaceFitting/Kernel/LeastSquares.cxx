// SPDX-License-Identifier: BSD-3-Clause
#include "LeastSquares.h"

#include "Parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr std::size_t ElementChunk = 64;
constexpr std::size_t RowChunk = 512;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Matrices and right-hand sides of the functions alive on every element.
struct ElementMatrices
{
  std::vector<std::size_t> Start; ///< of an element's alive^2 numbers
  std::vector<double> Matrices;
  std::vector<double> Right; ///< an entry of ElementFunctions x components
};

ElementMatrices MakeElementMatrices(const ElementFunctions& functions,
  const ElementMoments& moments, const IntArray<2>& degree, int components,
  const LeastSquaresParams& params)
{
  const int n = functions.PerElement;
  const int numElements = functions.NumElements();
  double weight = 0.0;
  for (int e = 0; e < numElements; ++e)
  {
    weight += moments.Weight(e);
  }
  std::vector<double> energy = ThinPlateMatrix(degree);
  for (double& value : energy)
  {
    value *= params.Smoothing * weight / numElements;
  }
  ElementMatrices result;
  result.Start.assign(At(numElements) + 1, 0);
  for (int e = 0; e < numElements; ++e)
  {
    result.Start[At(e) + 1] = result.Start[At(e)] + At(functions.Alive(e) * functions.Alive(e));
  }
  result.Matrices.resize(result.Start.back());
  result.Right.resize(functions.Functions.size() * At(components));
  ParallelFor(At(numElements), ElementChunk, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<double> gram(At(n * n));
      std::vector<double> product(At(n));
      for (std::size_t e = begin; e < end; ++e)
      {
        const int id = static_cast<int>(e);
        moments.Gram(id, gram.data());
        for (std::size_t i = 0; i < gram.size(); ++i)
        {
          gram[i] += energy[i];
        }
        const int alive = functions.Alive(id);
        double* matrix = result.Matrices.data() + result.Start[e];
        for (int k = 0; k < alive; ++k)
        {
          const double* row = functions.Row(functions.First(id) + At(k));
          std::fill(product.begin(), product.end(), 0.0);
          for (int a = 0; a < n; ++a)
          {
            if (const double r = row[a]; r != 0.0)
            {
              const double* from = gram.data() + a * n;
              for (int b = 0; b < n; ++b)
              {
                product[At(b)] += r * from[b];
              }
            }
          }
          for (int l = 0; l <= k; ++l)
          {
            const double* other = functions.Row(functions.First(id) + At(l));
            double sum = 0.0;
            for (int b = 0; b < n; ++b)
            {
              sum += product[At(b)] * other[b];
            }
            matrix[k * alive + l] = sum;
            matrix[l * alive + k] = sum;
          }
          for (int c = 0; c < components; ++c)
          {
            const double* right = moments.Right(id, c);
            double sum = 0.0;
            for (int b = 0; b < n; ++b)
            {
              sum += row[b] * right[b];
            }
            result.Right[(functions.First(id) + At(k)) * At(components) + At(c)] = sum;
          }
        }
      }
    });
  return result;
}

/// Rows of the matrix of all functions, in chunks that are made and used by themselves.
class SystemMatrix
{
public:
  SystemMatrix(
    const ElementFunctions& functions, const ElementMatrices& elements, int components, int threads)
    : N(functions.NumFunctions), Threads(threads), Chunks((At(this->N) + RowChunk - 1) / RowChunk),
      Diagonal(this->N), Right(this->N, components)
  {
    ParallelFor(At(this->N), RowChunk, threads,
      [&](std::size_t begin, std::size_t end) { this->MakeRows(functions, elements, begin, end); });
  }

  void Multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const
  {
    ParallelFor(At(this->N), RowChunk, this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        const Chunk& chunk = this->Chunks[begin / RowChunk];
        for (std::size_t i = begin; i < end; ++i)
        {
          double sum = 0.0;
          for (std::size_t k = chunk.Start[i - begin]; k < chunk.Start[i - begin + 1]; ++k)
          {
            sum += chunk.Values[k] * x[chunk.Columns[k]];
          }
          y[static_cast<Eigen::Index>(i)] = sum;
        }
      });
  }

  int N;
  int Threads;

private:
  struct Chunk
  {
    std::vector<std::size_t> Start;
    std::vector<int> Columns;
    std::vector<double> Values;
  };

  void MakeRows(const ElementFunctions& functions, const ElementMatrices& elements,
    std::size_t begin, std::size_t end)
  {
    Chunk& chunk = this->Chunks[begin / RowChunk];
    std::vector<int> place(At(this->N), -1);
    const auto components = this->Right.cols();
    chunk.Start.push_back(0);
    for (std::size_t i = begin; i < end; ++i)
    {
      const std::size_t first = chunk.Columns.size();
      this->Right.row(static_cast<Eigen::Index>(i)).setZero();
      for (std::size_t use = functions.UseStart[i]; use < functions.UseStart[i + 1]; ++use)
      {
        const std::size_t entry = functions.Uses[use];
        const int e = functions.ElementOfEntry[entry];
        const std::size_t start = functions.First(e);
        const int alive = functions.Alive(e);
        const double* row =
          elements.Matrices.data() + elements.Start[At(e)] + (entry - start) * At(alive);
        for (int l = 0; l < alive; ++l)
        {
          const int column = functions.Functions[start + At(l)];
          int& where = place[At(column)];
          if (where < static_cast<int>(first))
          {
            where = static_cast<int>(chunk.Columns.size());
            chunk.Columns.push_back(column);
            chunk.Values.push_back(0.0);
          }
          chunk.Values[At(where)] += row[l];
        }
        for (Eigen::Index c = 0; c < components; ++c)
        {
          this->Right(static_cast<Eigen::Index>(i), c) +=
            elements
              .Right[entry * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)];
        }
      }
      this->Diagonal[static_cast<Eigen::Index>(i)] = chunk.Values[At(place[i])];
      chunk.Start.push_back(chunk.Columns.size());
    }
  }

  std::vector<Chunk> Chunks;

public:
  Eigen::VectorXd Diagonal;
  PointMatrix Right;
};

/// In pieces of a fixed size, so that the sum does not depend on who adds up what.
double Dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b)
{
  return a.dot(b);
}

/// Conjugate gradients with the diagonal as preconditioner.
bool Solve(const SystemMatrix& matrix, const Eigen::VectorXd& right,
  const LeastSquaresParams& params, Eigen::VectorXd& x)
{
  Eigen::VectorXd product(matrix.N);
  matrix.Multiply(x, product);
  Eigen::VectorXd residual = right - product;
  Eigen::VectorXd scaled = residual.cwiseQuotient(matrix.Diagonal);
  Eigen::VectorXd direction = scaled;
  double rho = Dot(residual, scaled);
  for (int k = 0; k < params.MaxIterations; ++k)
  {
    if (scaled.lpNorm<Eigen::Infinity>() <= params.Accuracy)
    {
      return true;
    }
    matrix.Multiply(direction, product);
    const double curvature = Dot(direction, product);
    if (!(curvature > 0.0) || !std::isfinite(curvature))
    {
      return false;
    }
    const double step = rho / curvature;
    x += step * direction;
    residual -= step * product;
    scaled = residual.cwiseQuotient(matrix.Diagonal);
    const double next = Dot(residual, scaled);
    direction = scaled + next / rho * direction;
    rho = next;
  }
  return true;
}
}

bool SolveLeastSquares(const ElementFunctions& functions, const ElementMoments& moments,
  const IntArray<2>& degree, const LeastSquaresParams& params, PointMatrix& coefficients)
{
  const auto components = static_cast<int>(coefficients.cols());
  SystemMatrix matrix(functions,
    MakeElementMatrices(functions, moments, degree, components, params), components,
    params.Threads);
  const double floor = 1e-300 + 1e-14 * matrix.Diagonal.maxCoeff();
  matrix.Diagonal = matrix.Diagonal.cwiseMax(floor);
  bool solved = true;
  for (int c = 0; c < components; ++c)
  {
    Eigen::VectorXd x = coefficients.col(c);
    solved = Solve(matrix, matrix.Right.col(c), params, x) && solved;
    coefficients.col(c) = x;
  }
  return solved;
}
}
