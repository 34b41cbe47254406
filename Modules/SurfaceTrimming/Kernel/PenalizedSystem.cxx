// SPDX-License-Identifier: BSD-3-Clause
#include "PenalizedSystem.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/SplineCore/QualityFunctionals.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr std::size_t SampleChunk = 4096;
constexpr Eigen::Index RowBlock = 512;
/// How much more the energy weighs on elements without samples: so much that slopes which waver
/// along a boundary within spans do not fold what goes on beyond it.
constexpr double OuterStiffness = 100.0;
using Sparse = Eigen::SparseMatrix<double>;

/// Samples that have a weight in the order of their elements.
struct SortedSamples
{
  std::vector<int> Order;
  std::vector<std::size_t> First; ///< a place in Order for each element and the end
  std::vector<double> Local;      ///< two a sample, as they come
};

SortedSamples Sort(const SplineSpace<2>& space, const ChartSamples& samples,
  const Eigen::VectorXd& weights, int threads)
{
  auto count = static_cast<std::size_t>(samples.Parameters.rows());
  while (count > 0 && !(weights[static_cast<Eigen::Index>(count) - 1] > 0.0))
  {
    --count; // most often those that are looked at only
  }
  std::vector<int> elements(count);
  SortedSamples sorted;
  sorted.Local.resize(2 * count);
  ParallelFor(count, SampleChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      space.Locate(samples.Parameters.data() + 2 * begin, 2, end - begin, elements.data() + begin,
        sorted.Local.data() + 2 * begin);
    });
  sorted.First.assign(space.Elements.size() + 1, 0);
  for (std::size_t i = 0; i < count; ++i)
  {
    sorted.First[static_cast<std::size_t>(elements[i]) + 1] +=
      weights[static_cast<Eigen::Index>(i)] > 0.0;
  }
  for (std::size_t e = 0; e < space.Elements.size(); ++e)
  {
    sorted.First[e + 1] += sorted.First[e];
  }
  std::vector<std::size_t> next(sorted.First.begin(), sorted.First.end() - 1);
  sorted.Order.resize(sorted.First.back());
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!(weights[static_cast<Eigen::Index>(i)] > 0.0))
    {
      continue;
    }
    sorted.Order[next[static_cast<std::size_t>(elements[i])]++] = static_cast<int>(i);
  }
  return sorted;
}

/// Where the products of functions lie in the columns of a lower triangle: all pairs of functions
/// that differ by at most p in both directions are there.
class LowerPattern
{
public:
  LowerPattern(const SplineSpace<2>& space, const Sparse& lower)
    : P(space.Knots[0].Degree()), N(space.Knots[0].NumFunctions()), Starts(lower.outerIndexPtr())
  {
  }
  /// @pre column <= row, numbers of functions.
  Eigen::Index Place(int row, int column) const
  {
    const int i = column % this->N;
    const int k = row % this->N;
    const int lines = row / this->N - column / this->N;
    const Eigen::Index start = this->Starts[column];
    if (lines == 0)
    {
      return start + k - i;
    }
    const int first = std::max(i - this->P, 0);
    const int last = std::min(i + this->P, this->N - 1);
    const int own = std::min(i + this->P, this->N - 1) - i + 1;
    return start + own + (lines - 1) * (last - first + 1) + k - first;
  }

private:
  int P;
  int N;
  const int* Starts;
};

/// Adds products of functions, and of functions and points, of one element's samples.
class ElementSums
{
public:
  ElementSums(const SplineSpace<2>& space, const ChartSamples& samples,
    const Eigen::VectorXd& weights, const SortedSamples& sorted)
    : Space(space), Samples(samples), Weights(weights), Sorted(sorted), P(space.Knots[0].Degree())
  {
    this->Size = (this->P + 1) * (this->P + 1);
    this->Rows.resize(RowBlock, this->Size);
    this->Points.resize(RowBlock, 3);
  }

  void Sum(int element)
  {
    this->Products.setZero(this->Size, this->Size);
    this->Sides.setZero(this->Size, 3);
    const auto e = static_cast<std::size_t>(element);
    Eigen::Index rows = 0;
    for (std::size_t s = this->Sorted.First[e]; s < this->Sorted.First[e + 1]; ++s)
    {
      const int i = this->Sorted.Order[s];
      double lines[2][MaxDegree + 1];
      for (int d = 0; d < 2; ++d)
      {
        EvaluateLocalLine(this->P, this->Space.Factor(element, d),
          this->Sorted.Local[static_cast<std::size_t>(2 * i + d)], 1.0, 0, lines[d]);
      }
      const double root = std::sqrt(this->Weights[i]);
      double* row = this->Rows.data() + rows * this->Size;
      for (int b = 0; b <= this->P; ++b)
      {
        for (int a = 0; a <= this->P; ++a)
        {
          *row++ = root * lines[0][a] * lines[1][b];
        }
      }
      this->Points.row(rows) = root * this->Samples.Points.row(i);
      if (++rows == RowBlock)
      {
        this->Flush(rows);
        rows = 0;
      }
    }
    this->Flush(rows);
  }

  /// Products of second derivatives instead: the thin-plate energy of an element, exact.
  void Bend(int element, double weight)
  {
    this->Products.setZero(this->Size, this->Size);
    this->Sides.setZero(this->Size, 3);
    const auto& box = this->Space.Elements[static_cast<std::size_t>(element)].Box;
    const std::array<double, 2> length{ box.Upper[0] - box.Lower[0], box.Upper[1] - box.Lower[1] };
    const QuadratureRule rule = GaussLegendre(this->P + 1);
    Eigen::Index rows = 0;
    for (std::size_t q = 0; q < rule.Nodes.size() * rule.Nodes.size(); ++q)
    {
      const std::array<std::size_t, 2> node{ q % rule.Nodes.size(), q / rule.Nodes.size() };
      double lines[2][3][MaxDegree + 1];
      for (std::size_t d = 0; d < 2; ++d)
      {
        EvaluateLocalLine(this->P, this->Space.Factor(element, static_cast<int>(d)),
          rule.Nodes[node[d]], length[d], 2, lines[d][0]);
      }
      const double root =
        std::sqrt(weight * length[0] * length[1] * rule.Weights[node[0]] * rule.Weights[node[1]]);
      for (int k = 0; k < 3; ++k) // uu, uv twice, vv
      {
        double* row = this->Rows.data() + rows * this->Size;
        for (int b = 0; b <= this->P; ++b)
        {
          for (int a = 0; a <= this->P; ++a)
          {
            *row++ = (k == 1 ? std::sqrt(2.0) : 1.0) * root * lines[0][2 - k][a] * lines[1][k][b];
          }
        }
        ++rows;
      }
    }
    this->Points.topRows(rows).setZero();
    this->Flush(rows);
  }
  Eigen::MatrixXd Products;
  PointMatrix Sides;

private:
  void Flush(Eigen::Index rows)
  {
    if (rows > 0)
    {
      const auto block = this->Rows.topRows(rows);
      this->Products.noalias() += block.transpose() * block;
      this->Sides.noalias() += block.transpose() * this->Points.topRows(rows);
    }
  }
  const SplineSpace<2>& Space;
  const ChartSamples& Samples;
  const Eigen::VectorXd& Weights;
  const SortedSamples& Sorted;
  int P;
  int Size;
  PointMatrix Rows;
  PointMatrix Points;
};

/// Adds the samples' equations, one row of elements after the other. Rows p + 1 apart have no
/// functions in common: they run at once, and every sum has its order.
void AddSamples(const SplineSpace<2>& space, const ChartSamples& samples,
  const Eigen::VectorXd& weights, double stiffness, int threads, Sparse& lower,
  Eigen::MatrixXd& sides)
{
  const SortedSamples sorted = Sort(space, samples, weights, threads);
  const LowerPattern pattern(space, lower);
  const int p = space.Knots[0].Degree();
  const int columns = space.Knots[0].NumElements();
  const int rows = space.Knots[1].NumElements();
  double* values = lower.valuePtr();
  const auto addRow = [&](int row)
  {
    ElementSums sums(space, samples, weights, sorted);
    for (int e = row * columns; e < (row + 1) * columns; ++e)
    {
      const auto index = static_cast<std::size_t>(e);
      if (sorted.First[index] == sorted.First[index + 1])
      {
        sums.Bend(e, stiffness);
      }
      else
      {
        sums.Sum(e);
      }
      const int* functions = space.LocalFunctions(e);
      for (int b = 0; b < (p + 1) * (p + 1); ++b)
      {
        for (int a = b; a < (p + 1) * (p + 1); ++a)
        {
          values[pattern.Place(functions[a], functions[b])] += sums.Products(a, b);
        }
        sides.row(functions[b]) += sums.Sides.row(b);
      }
    }
  };
  for (int color = 0; color <= std::min(p, rows - 1); ++color)
  {
    const int count = (rows - 1 - color) / (p + 1) + 1;
    ParallelFor(static_cast<std::size_t>(count), 1, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          addRow(color + static_cast<int>(k) * (p + 1));
        }
      });
  }
}
}

PenalizedSystem::PenalizedSystem(
  SplineSpacePtr<2> space, double smoothing, double stretching, int threads)
  : Space(std::move(space)), Threads(threads)
{
  this->Stiffness = OuterStiffness * smoothing;
  // symmetric: its rows are its columns
  const Eigen::SparseMatrix<double, Eigen::RowMajor> upper =
    QuadraticMatrix<2>(*this->Space, smoothing, stretching, threads).triangularView<Eigen::Upper>();
  this->Energy = upper.transpose();
}

Result<PointMatrix> PenalizedSystem::Solve(
  const ChartSamples& samples, const Eigen::VectorXd& weights)
{
  Sparse lower = this->Energy;
  Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(this->Space->NumFunctions, 3);
  AddSamples(*this->Space, samples, weights, this->Stiffness, this->Threads, lower, sides);
  const Status status = this->Cholesky.Factorize(lower);
  if (!status)
  {
    return status;
  }
  this->Cholesky.Solve(sides);
  if (!sides.allFinite())
  {
    return { ErrorCode::SingularSystem, "control points of the back-map are not determined" };
  }
  return PointMatrix(sides);
}
}
