// SPDX-License-Identifier: BSD-3-Clause
#include "SparseLeastSquares.h"

#include "Parallel.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace knotwork
{
namespace
{
using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Columns = Eigen::SparseMatrix<double>;

/// The lower triangle of A^T A, a column at a time.
Columns NormalMatrix(const Rows& a, const Columns& columns, int threads)
{
  struct Column
  {
    std::vector<int> Rows;
    std::vector<double> Values;
  };
  const auto n = static_cast<std::size_t>(a.cols());
  std::vector<Column> found(n);
  // a chunk fills as many sums as there are columns: 64 chunks at most
  ParallelFor(n, std::max<std::size_t>(512, n / 64 + 1), threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<double> sums(n, 0.0);
      std::vector<char> met(n, 0);
      for (std::size_t c = begin; c < end; ++c)
      {
        Column& column = found[c];
        for (Columns::InnerIterator i(columns, static_cast<Eigen::Index>(c)); i; ++i)
        {
          for (Rows::InnerIterator k(a, i.row()); k; ++k)
          {
            const auto row = static_cast<std::size_t>(k.col());
            if (row < c)
            {
              continue;
            }
            if (!met[row])
            {
              met[row] = 1;
              column.Rows.push_back(static_cast<int>(row));
            }
            sums[row] += i.value() * k.value();
          }
        }
        std::sort(column.Rows.begin(), column.Rows.end());
        for (const int row : column.Rows)
        {
          column.Values.push_back(sums[static_cast<std::size_t>(row)]);
          sums[static_cast<std::size_t>(row)] = 0.0;
          met[static_cast<std::size_t>(row)] = 0;
        }
      }
    });
  std::size_t entries = 0;
  for (const Column& column : found)
  {
    entries += column.Rows.size() + 1;
  }
  Columns matrix(a.cols(), a.cols());
  matrix.reserve(static_cast<Eigen::Index>(entries));
  for (std::size_t c = 0; c < n; ++c)
  {
    const auto index = static_cast<Eigen::Index>(c);
    matrix.startVec(index);
    if (found[c].Rows.empty())
    {
      matrix.insertBack(index, index) = 0.0; // a column of zeros: the shift alone will be there
    }
    for (std::size_t i = 0; i < found[c].Rows.size(); ++i)
    {
      matrix.insertBack(found[c].Rows[i], index) = found[c].Values[i];
    }
  }
  matrix.finalize();
  return matrix;
}

/// Factor of A^T A plus a shift; the shift grows if rounding asks for it.
class ShiftedFactor
{
public:
  explicit ShiftedFactor(const Columns& normal)
  {
    Columns shifted = normal;
    this->Factor.analyzePattern(shifted);
    for (; this->Shift < 1.0; this->Shift *= 10.0)
    {
      for (Eigen::Index i = 0; i < normal.cols(); ++i)
      {
        shifted.coeffRef(i, i) = normal.coeff(i, i) + this->Shift;
      }
      this->Factor.factorize(shifted);
      if (this->Factor.info() == Eigen::Success)
      {
        return;
      }
    }
  }

  /// A step towards the solution. Its part in the kernel of A, which is rounding, is taken out: the
  /// factor divides that by the shift and all else by much more. Once leaves 1e-5 of it.
  Eigen::MatrixXd Step(const Eigen::MatrixXd& gradient) const
  {
    Eigen::MatrixXd step = this->Factor.solve(gradient);
    for (int i = 0; i < 2; ++i)
    {
      step -= (this->Shift * this->Factor.solve(step)).eval();
    }
    return step;
  }

  std::size_t Entries() const
  {
    return static_cast<std::size_t>(this->Factor.matrixL().nestedExpression().nonZeros());
  }

private:
  Eigen::SimplicialLLT<Columns, Eigen::Lower> Factor;
  double Shift = 1e-11;
};

/// Whether a column of the steps is above rounding and still gets smaller.
bool Gains(const Eigen::MatrixXd& step, const Eigen::MatrixXd& before, const Eigen::MatrixXd& x)
{
  constexpr double slowest = 0.95;
  for (Eigen::Index c = 0; c < x.cols(); ++c)
  {
    const double size = step.col(c).norm();
    if (size > std::numeric_limits<double>::epsilon() * x.col(c).norm() &&
      size < slowest * before.col(c).norm())
    {
      return true;
    }
  }
  return false;
}
}

SparseSolution SolveSparseLeastSquares(const Rows& a, const Eigen::MatrixXd& b, int threads)
{
  constexpr int maxSteps = 100;
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(a.cols());
  for (Eigen::Index j = 0; j < a.outerSize(); ++j)
  {
    for (Rows::InnerIterator i(a, j); i; ++i)
    {
      scale[i.col()] += i.value() * i.value();
    }
  }
  for (double& s : scale)
  {
    s = s > 0.0 ? 1.0 / std::sqrt(s) : 0.0;
  }
  const Rows scaled = a * scale.asDiagonal();
  const Columns columns = scaled;
  const ShiftedFactor factor(NormalMatrix(scaled, columns, threads));
  Eigen::MatrixXd step = factor.Step(columns.transpose() * b);
  Eigen::MatrixXd x = step;
  SparseSolution solution;
  solution.FactorEntries = factor.Entries();
  for (solution.Steps = 1; solution.Steps < maxSteps; ++solution.Steps)
  {
    Eigen::MatrixXd next = factor.Step(columns.transpose() * (b - scaled * x));
    if (!Gains(next, step, x))
    {
      break;
    }
    x += next;
    step = std::move(next);
  }
  solution.Value = scale.asDiagonal() * x;
  return solution;
}
}
