// SPDX-License-Identifier: BSD-3-Clause
#include "BasisEvaluation.h"
#include "BernsteinBasis.h"
#include "Parallel.h"
#include "QuotientRule.h"
#include "SparseLines.h"

#include <algorithm>
#include <limits>
#include <string>

namespace knotwork
{
namespace
{
constexpr int MaxOrder = 2;
constexpr int Stride = MaxDegree + 1;

/// Calls add(local function, its terms) for all local functions of an element, in their order.
template <int Dim, typename AddFunction>
void ForEachLocalFunction(
  const SplineSpace<Dim>& space, int e, const double* local, int order, const AddFunction& add)
{
  const auto& element = space.Elements[static_cast<std::size_t>(e)];
  double values[3][MaxOrder + 1][Stride]; // direction, order
  IntArray<3> size{ 1, 1, 1 };
  for (std::size_t d = 0; d < 3; ++d)
  {
    if (d < Dim)
    {
      EvaluateLocalLine(element.Degree[d], space.Factor(e, static_cast<int>(d)), local[d],
        element.Box.Upper[d] - element.Box.Lower[d], order, values[d][0]);
      size[d] = element.Degree[d] + 1;
    }
    else
    {
      values[d][0][0] = 1.0;
    }
  }
  double terms[NumDerivativeTerms(Dim, MaxOrder)] = {};
  int j = 0;
  for (int c = 0; c < size[2]; ++c)
  {
    for (int b = 0; b < size[1]; ++b)
    {
      for (int a = 0; a < size[0]; ++a, ++j)
      {
        const auto product = [&](const IntArray<3>& k)
        { return values[0][k[0]][a] * values[1][k[1]][b] * values[2][k[2]][c]; };
        int term = 0;
        terms[term++] = product({ 0, 0, 0 });
        for (std::size_t d = 0; order >= 1 && d < Dim; ++d)
        {
          IntArray<3> k{};
          k[d] = 1;
          terms[term++] = product(k);
        }
        for (std::size_t d = 0; order >= 2 && d < Dim; ++d)
        {
          for (std::size_t f = d; f < Dim; ++f)
          {
            IntArray<3> k{};
            ++k[d];
            ++k[f];
            terms[term++] = product(k);
          }
        }
        add(j, terms);
      }
    }
  }
}

/// Ids of the functions alive on an element, ascending, into memory that is kept.
template <int Dim>
void FindAliveFunctions(const SplineSpace<Dim>& space, int e, std::vector<int>& functions)
{
  const int n = NumTensorFunctions<Dim>(space.Elements[static_cast<std::size_t>(e)].Degree);
  const int* ids = space.LocalFunctions(e);
  functions.clear();
  if (space.IsIdentityMap())
  {
    functions.assign(ids, ids + n);
  }
  else
  {
    for (int j = 0; j < n; ++j)
    {
      const std::size_t row = static_cast<std::size_t>(ids[j]);
      functions.insert(functions.end(), space.RowFunction.data() + space.RowStart[row],
        space.RowFunction.data() + space.RowStart[row + 1]);
    }
  }
  std::sort(functions.begin(), functions.end());
  functions.erase(std::unique(functions.begin(), functions.end()), functions.end());
}

/// Multiplies the rows by their weights and divides by the weight function.
template <int Dim>
void MakeRational(int order, const Eigen::VectorXd& weights, FunctionValues& result)
{
  const Eigen::Index numTerms = result.Values.cols();
  double sum[NumDerivativeTerms(Dim, MaxOrder)] = {};
  for (Eigen::Index i = 0; i < result.Values.rows(); ++i)
  {
    const double w = weights[result.Functions[static_cast<std::size_t>(i)]];
    for (Eigen::Index k = 0; k < numTerms; ++k)
    {
      sum[k] += result.Values(i, k) *= w;
    }
  }
  for (Eigen::Index i = 0; i < result.Values.rows(); ++i)
  {
    DivideTerms<Dim>(order, sum, result.Values.data() + i * numTerms);
  }
}
}

void EvaluateLocalLine(
  int degree, const double* factor, double t, double length, int order, double* rows)
{
  double bernstein[(MaxOrder + 1) * Stride];
  const double scale = 1.0 / length;
  if (order == 0)
  {
    BernsteinBasis<0>(degree, t, scale, bernstein, Stride);
  }
  else if (order == 1)
  {
    BernsteinBasis<1>(degree, t, scale, bernstein, Stride);
  }
  else
  {
    BernsteinBasis<2>(degree, t, scale, bernstein, Stride);
  }
  for (int k = 0; k <= order; ++k)
  {
    const double* row = bernstein + k * Stride;
    for (int i = 0; i <= degree; ++i)
    {
      double sum = factor ? 0.0 : row[i];
      for (int j = 0; factor && j <= degree; ++j)
      {
        sum += factor[i * (degree + 1) + j] * row[j];
      }
      rows[k * Stride + i] = sum;
    }
  }
}

template <int Dim>
void EvaluateFunctions(const SplineSpace<Dim>& space, int element, const double* local, int order,
  const Eigen::VectorXd* weights, FunctionValues& result)
{
  const int numTerms = NumDerivativeTerms(Dim, order);
  std::vector<int>& functions = result.Functions;
  FindAliveFunctions(space, element, functions);
  result.Values.setZero(static_cast<Eigen::Index>(functions.size()), numTerms);

  const int* ids = space.LocalFunctions(element);
  const auto accumulate = [&](int function, double factor, const double* terms)
  {
    const auto row = std::lower_bound(functions.begin(), functions.end(), function);
    double* out = result.Values.data() + (row - functions.begin()) * numTerms;
    for (int k = 0; k < numTerms && k < NumDerivativeTerms(Dim, MaxOrder); ++k)
    {
      out[k] += factor * terms[k];
    }
  };
  ForEachLocalFunction(space, element, local, order,
    [&](int j, const double* terms)
    {
      if (space.IsIdentityMap())
      {
        accumulate(ids[j], 1.0, terms);
        return;
      }
      const std::size_t row = static_cast<std::size_t>(ids[j]);
      for (std::size_t k = space.RowStart[row]; k < space.RowStart[row + 1]; ++k)
      {
        accumulate(space.RowFunction[k], space.RowCoefficient[k], terms);
      }
    });
  if (weights)
  {
    MakeRational<Dim>(order, *weights, result);
  }
}

template <int Dim>
Result<Eigen::SparseMatrix<double, Eigen::RowMajor>> CollocationMatrix(
  const SplineSpace<Dim>& space, const PointMatrixView& parameters, int threads)
{
  if (parameters.cols() != Dim)
  {
    return { ErrorCode::SizeMismatch,
      "points have " + std::to_string(parameters.cols()) + " parameters, the space has " +
        std::to_string(Dim) };
  }
  if (!space.HasDomain())
  {
    return { ErrorCode::DimensionMismatch, "the space has no parameter domain" };
  }
  constexpr std::size_t chunkSize = 1024;
  const std::size_t numPoints = static_cast<std::size_t>(parameters.rows());
  std::vector<SparseLines> chunks((numPoints + chunkSize - 1) / chunkSize);
  std::vector<Eigen::Index> outside(chunks.size(), -1);
  ParallelFor(numPoints, chunkSize, threads,
    [&](std::size_t begin, std::size_t end)
    {
      SparseLines& chunk = chunks[begin / chunkSize];
      FunctionValues functions;
      for (std::size_t i = begin; i < end; ++i)
      {
        const Eigen::Index row = static_cast<Eigen::Index>(i);
        double local[Dim];
        const int e = space.Locate(parameters.data() + row * parameters.outerStride(), local);
        if (e < 0)
        {
          outside[begin / chunkSize] = row;
          return;
        }
        EvaluateFunctions<Dim>(space, e, local, 0, nullptr, functions);
        chunk.Sizes.push_back(static_cast<int>(functions.Functions.size()));
        chunk.Indices.insert(
          chunk.Indices.end(), functions.Functions.begin(), functions.Functions.end());
        chunk.Values.insert(chunk.Values.end(), functions.Values.data(),
          functions.Values.data() + functions.Values.size());
      }
    });

  std::size_t numEntries = 0;
  for (std::size_t c = 0; c < chunks.size(); ++c)
  {
    if (outside[c] >= 0)
    {
      return { ErrorCode::OutsideDomain, "point " + std::to_string(outside[c]) };
    }
    numEntries += chunks[c].Indices.size();
  }
  if (numEntries > static_cast<std::size_t>(std::numeric_limits<int>::max()))
  {
    return { ErrorCode::TooLarge,
      std::to_string(numEntries) + " entries, at most 2^31 - 1 are possible" };
  }
  return JoinLines<Eigen::RowMajor>(chunks, parameters.rows(), space.NumFunctions);
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template void EvaluateFunctions<Dim>(                                                            \
    const SplineSpace<Dim>&, int, const double*, int, const Eigen::VectorXd*, FunctionValues&);    \
  template Result<Eigen::SparseMatrix<double, Eigen::RowMajor>> CollocationMatrix<Dim>(            \
    const SplineSpace<Dim>&, const PointMatrixView&, int)
KNOTWORK_INSTANTIATE(1);
KNOTWORK_INSTANTIATE(2);
KNOTWORK_INSTANTIATE(3);
#undef KNOTWORK_INSTANTIATE
}
