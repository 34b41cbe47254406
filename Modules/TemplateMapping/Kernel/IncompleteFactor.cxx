// SPDX-License-Identifier: BSD-3-Clause
#include "IncompleteFactor.h"

#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double DropTolerance = 1e-2;
constexpr std::size_t BatchSize = 32; // elements whose dense matrices exist at a time

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using ColumnMatrix = Eigen::SparseMatrix<double>;

/// Lower triangle by blocks: column f has the rows Rows[First[f]] ... ascending, f itself first.
template <int Dim>
struct BlockColumns
{
  using Block = Eigen::Matrix<double, Dim, Dim>;
  std::vector<std::size_t> First;
  std::vector<int> Rows;
  std::vector<Block> Blocks;

  /// Couples the functions of each list.
  BlockColumns(int numFunctions, const std::vector<std::vector<int>>& lists)
  {
    const std::size_t n = static_cast<std::size_t>(numFunctions);
    std::vector<std::vector<int>> listsOf(n);
    for (std::size_t k = 0; k < lists.size(); ++k)
    {
      for (int f : lists[k])
      {
        listsOf[static_cast<std::size_t>(f)].push_back(static_cast<int>(k));
      }
    }
    std::vector<int> seenBy(n, -1);
    this->First.push_back(0);
    for (int f = 0; f < numFunctions; ++f)
    {
      this->Rows.push_back(f);
      for (int k : listsOf[static_cast<std::size_t>(f)])
      {
        for (int g : lists[static_cast<std::size_t>(k)])
        {
          if (g > f && seenBy[static_cast<std::size_t>(g)] != f)
          {
            seenBy[static_cast<std::size_t>(g)] = f;
            this->Rows.push_back(g);
          }
        }
      }
      std::sort(
        this->Rows.begin() + static_cast<std::ptrdiff_t>(this->First.back()), this->Rows.end());
      this->First.push_back(this->Rows.size());
    }
    this->Blocks.assign(this->Rows.size(), Block::Zero());
  }

  /// Adds a matrix of blocks at ascending functions of a list, its lower triangle is read.
  void Add(const std::vector<int>& functions, const Eigen::MatrixXd& values)
  {
    for (std::size_t j = 0; j < functions.size(); ++j)
    {
      std::size_t k = this->First[static_cast<std::size_t>(functions[j])];
      for (std::size_t i = j; i < functions.size(); ++i)
      {
        while (this->Rows[k] != functions[i])
        {
          ++k;
        }
        this->Blocks[k] += values.block<Dim, Dim>(
          static_cast<Eigen::Index>(i) * Dim, static_cast<Eigen::Index>(j) * Dim);
      }
    }
  }
};

/// tau^T W tau of an element in the given functions, lower triangle.
template <int Dim>
Eigen::MatrixXd ElementMatrix(const SplineSpace<Dim>& space, const DataTerms<Dim>& data, int group,
  const RowMatrix& truncation, const std::vector<int>& functions)
{
  const Eigen::Index samples = data.NumSamples(group);
  const Eigen::Index count = static_cast<Eigen::Index>(functions.size());
  const int* ids = space.LocalFunctions(data.Element(group));
  const int numLocal = NumTensorFunctions<Dim>(space.Elements.front().Degree);
  Eigen::MatrixXd tau = Eigen::MatrixXd::Zero(count, samples); // a column a sample
  const auto place = [&](int f)
  { return std::lower_bound(functions.begin(), functions.end(), f) - functions.begin(); };
  for (int j = 0; j < numLocal; ++j)
  {
    const auto add = [&](int f, double factor)
    {
      const Eigen::Index row = place(f);
      for (Eigen::Index s = 0; s < samples; ++s)
      {
        tau(row, s) += factor * data.Values(group, static_cast<int>(s))[j];
      }
    };
    if (truncation.rows() == 0)
    {
      add(ids[j], 1.0);
      continue;
    }
    for (RowMatrix::InnerIterator k(truncation, ids[j]); k; ++k)
    {
      add(static_cast<int>(k.col()), k.value());
    }
  }
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(count * Dim, count * Dim);
  if (data.NormalWeight() > 0.0)
  {
    Eigen::MatrixXd along(count * Dim, samples);
    for (Eigen::Index s = 0; s < samples; ++s)
    {
      Eigen::Map<PointMatrix>(along.col(s).data(), count, Dim) =
        tau.col(s) * data.ScaledNormal(group, static_cast<int>(s)).transpose();
    }
    result.selfadjointView<Eigen::Lower>().rankUpdate(along);
  }
  if (data.PointWeight() > 0.0)
  {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(count, count);
    gram.selfadjointView<Eigen::Lower>().rankUpdate(tau, data.PointWeight());
    for (Eigen::Index j = 0; j < count; ++j)
    {
      for (Eigen::Index i = j; i < count; ++i)
      {
        result.block<Dim, Dim>(i * Dim, j * Dim).diagonal().array() += gram(i, j);
      }
    }
  }
  return result;
}
}

template <int Dim>
bool IncompleteFactor<Dim>::Compute(const SplineSpace<Dim>& space, const DataTerms<Dim>& data,
  const RowMatrix& truncation, const std::vector<Block>& diagonal,
  const std::vector<const ColumnMatrix*>& scalar, int threads)
{
  std::vector<std::vector<int>> functions;
  for (int g = 0; g < data.NumGroups(); ++g)
  {
    functions.push_back(space.AliveFunctions(data.Element(g)));
  }
  BlockColumns<Dim> columns(space.NumFunctions, functions);
  std::vector<Eigen::MatrixXd> batch(BatchSize);
  for (std::size_t begin = 0; begin < functions.size(); begin += BatchSize)
  {
    const std::size_t count = std::min(BatchSize, functions.size() - begin);
    ParallelFor(count, 1, threads,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t k = first; k < last; ++k)
        {
          batch[k] = ElementMatrix<Dim>(
            space, data, static_cast<int>(begin + k), truncation, functions[begin + k]);
        }
      });
    for (std::size_t k = 0; k < count; ++k)
    {
      columns.Add(functions[begin + k], batch[k]);
    }
  }

  // All blocks of a column, the large ones kept.
  const Eigen::Index n = space.NumFunctions;
  Eigen::VectorXd norms(n);
  for (Eigen::Index f = 0; f < n; ++f)
  {
    norms(f) = diagonal[static_cast<std::size_t>(f)].norm();
  }
  struct Entry
  {
    int Row;
    bool IsScalar;
    Block Value;
  };
  std::vector<std::vector<Entry>> kept(static_cast<std::size_t>(n));
  PointMatrix dropped = PointMatrix::Zero(n, Dim);
  std::vector<double> sums(static_cast<std::size_t>(n), 0.0); // of the scalar matrices' column
  std::vector<char> isIn(static_cast<std::size_t>(n), 0);
  std::vector<int> rows;
  for (int f = 0; f < static_cast<int>(n); ++f)
  {
    rows.clear();
    for (const ColumnMatrix* matrix : scalar)
    {
      for (ColumnMatrix::InnerIterator entry(*matrix, f); entry; ++entry)
      {
        const std::size_t g = static_cast<std::size_t>(entry.row());
        if (entry.row() > f && !isIn[g])
        {
          isIn[g] = 1;
          rows.push_back(static_cast<int>(g));
        }
        sums[g] += entry.value();
      }
    }
    sums[static_cast<std::size_t>(f)] = 0.0; // the diagonal is given
    std::sort(rows.begin(), rows.end());
    std::vector<Entry>& column = kept[static_cast<std::size_t>(f)];
    const auto take = [&](int g, bool isScalar, const Block& block)
    {
      if (block.norm() > DropTolerance * std::sqrt(norms(f) * norms(g)))
      {
        column.push_back({ g, isScalar, block });
        return;
      }
      dropped.row(g) += block.cwiseAbs().rowwise().sum().transpose();
      dropped.row(f) += block.cwiseAbs().colwise().sum();
    };
    std::size_t k = columns.First[static_cast<std::size_t>(f)] + 1;
    const std::size_t last = columns.First[static_cast<std::size_t>(f) + 1];
    std::size_t s = 0;
    while (k < last || s < rows.size())
    {
      const bool hasData = k < last && (s == rows.size() || columns.Rows[k] <= rows[s]);
      const int g = hasData ? columns.Rows[k] : rows[s];
      Block block = hasData ? columns.Blocks[k] : Block(Block::Zero());
      if (s < rows.size() && rows[s] == g)
      {
        block.diagonal().array() += sums[static_cast<std::size_t>(g)];
        sums[static_cast<std::size_t>(g)] = 0.0;
        isIn[static_cast<std::size_t>(g)] = 0;
        ++s;
      }
      k += hasData ? 1 : 0;
      take(g, !hasData, block);
    }
  }

  ColumnMatrix matrix(n * Dim, n * Dim);
  Eigen::VectorXi sizes(n * Dim);
  for (Eigen::Index f = 0; f < n; ++f)
  {
    for (int d = 0; d < Dim; ++d)
    {
      int size = Dim - d;
      for (const Entry& entry : kept[static_cast<std::size_t>(f)])
      {
        size += entry.IsScalar ? 1 : Dim;
      }
      sizes(f * Dim + d) = size;
    }
  }
  matrix.reserve(sizes);
  for (int f = 0; f < static_cast<int>(n); ++f)
  {
    for (int d = 0; d < Dim; ++d)
    {
      for (int c = d; c < Dim; ++c)
      {
        matrix.insert(f * Dim + c, f * Dim + d) =
          diagonal[static_cast<std::size_t>(f)](c, d) + (c == d ? dropped(f, d) : 0.0);
      }
      for (const Entry& entry : kept[static_cast<std::size_t>(f)])
      {
        for (int c = entry.IsScalar ? d : 0; c < (entry.IsScalar ? d + 1 : Dim); ++c)
        {
          matrix.insert(entry.Row * Dim + c, f * Dim + d) = entry.Value(c, d);
        }
      }
    }
  }
  matrix.makeCompressed();
  this->Factor.compute(matrix);
  return this->Factor.info() == Eigen::Success;
}

template <int Dim>
PointMatrix IncompleteFactor<Dim>::Solve(const PointMatrix& right) const
{
  const Eigen::Map<const Eigen::VectorXd> flat(right.data(), right.size());
  PointMatrix result(right.rows(), Dim);
  Eigen::Map<Eigen::VectorXd>(result.data(), result.size()) = this->Factor.solve(flat);
  return result;
}

template class IncompleteFactor<2>;
template class IncompleteFactor<3>;
}
