// SPDX-License-Identifier: BSD-3-Clause
#include "DenseCholesky.h"

#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/WideVectors.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cstring>

namespace knotwork
{
namespace
{
using Index = Eigen::Index;

/// Columns that are factorized at a time.
constexpr Index PanelWidth = 96;
/// Of the blocks of products.
constexpr Index BlockRows = 12;
constexpr Index BlockColumns = 4;
/// Blocks side by side that share the rows.
constexpr std::size_t BlocksOfChunk = 4;

/// Rows of a panel in groups, column by column; rows that are missing are 0.
VectorArray<double> PackRows(const Eigen::Ref<const Eigen::MatrixXd>& panel, Index groupSize)
{
  const Index groups = (panel.rows() + groupSize - 1) / groupSize;
  VectorArray<double> packed(static_cast<std::size_t>(groups * groupSize * panel.cols()), 0.0);
  for (Index g = 0; g < groups; ++g)
  {
    const Index count = std::min(groupSize, panel.rows() - g * groupSize);
    for (Index k = 0; k < panel.cols(); ++k)
    {
      std::copy_n(panel.col(k).data() + g * groupSize, count,
        packed.data() + (g * panel.cols() + k) * groupSize);
    }
  }
  return packed;
}

/// Products of a group of rows with one of columns, as many of these at a time as the processor has
/// registers for. Each is summed in the order of the panel's columns.
template <int Width>
inline void MultiplyBlock(const double* rows, const double* columns, Index depth, double* products)
{
  using Vector = Doubles<Width>;
  constexpr int Vectors = static_cast<int>(BlockRows) / Width;
  constexpr int AtOnce = Width == 4 ? 4 : 2;
  for (int first = 0; first < BlockColumns; first += AtOnce)
  {
    Vector sums[AtOnce][Vectors] = {};
    for (Index k = 0; k < depth; ++k)
    {
      Vector row[Vectors];
      for (int v = 0; v < Vectors; ++v)
      {
        row[v] = *reinterpret_cast<const typename DoublesInMemory<Width>::Type*>(
          rows + k * BlockRows + v * Width);
      }
      for (int c = 0; c < AtOnce; ++c)
      {
        const double factor = columns[k * BlockColumns + first + c];
        for (int v = 0; v < Vectors; ++v)
        {
          sums[c][v] += row[v] * factor;
        }
      }
    }
    std::memcpy(products + first * BlockRows, sums, sizeof(sums));
  }
}

/// Takes panel panel^T from a lower triangle.
void SubtractProducts(
  const Eigen::Ref<const Eigen::MatrixXd>& panel, Eigen::Ref<Eigen::MatrixXd> rest, int threads)
{
  const Index n = rest.rows();
  const Index depth = panel.cols();
  const VectorArray<double> rows = PackRows(panel, BlockRows);
  const VectorArray<double> columns = PackRows(panel, BlockColumns);
  const auto groups = static_cast<std::size_t>((n + BlockColumns - 1) / BlockColumns);
  ParallelFor(groups, BlocksOfChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      WithWidestVectors(
        [&](auto vector)
        {
          double products[BlockRows * BlockColumns];
          for (Index r = static_cast<Index>(begin) * BlockColumns / BlockRows; r * BlockRows < n;
               ++r)
          {
            const Index numRows = std::min(BlockRows, n - r * BlockRows);
            for (auto g = static_cast<Index>(begin); g < static_cast<Index>(end); ++g)
            {
              if ((r + 1) * BlockRows <= g * BlockColumns)
              {
                break; // above the diagonal
              }
              MultiplyBlock<decltype(vector)::value>(rows.data() + r * depth * BlockRows,
                columns.data() + g * depth * BlockColumns, depth, products);
              for (Index c = 0; c < std::min(BlockColumns, n - g * BlockColumns); ++c)
              {
                double* column = &rest(r * BlockRows, g * BlockColumns + c);
                for (Index i = 0; i < numRows; ++i)
                {
                  column[i] -= products[c * BlockRows + i];
                }
              }
            }
          }
        });
    });
}
}

bool FactorInPlace(Eigen::Ref<Eigen::MatrixXd> matrix, int threads)
{
  const Index n = matrix.rows();
  for (Index begin = 0; begin < n; begin += PanelWidth)
  {
    const Index width = std::min(PanelWidth, n - begin);
    const Index below = n - begin - width;
    const Eigen::LLT<Eigen::MatrixXd> diagonal(matrix.block(begin, begin, width, width));
    if (diagonal.info() != Eigen::Success)
    {
      return false;
    }
    matrix.block(begin, begin, width, width).triangularView<Eigen::Lower>() = diagonal.matrixL();
    auto panel = matrix.block(begin + width, begin, below, width);
    diagonal.matrixU().solveInPlace<Eigen::OnTheRight>(panel);
    SubtractProducts(panel, matrix.bottomRightCorner(below, below), threads);
  }
  return true;
}

void SolveFactored(const Eigen::Ref<const Eigen::MatrixXd>& factor, Eigen::Ref<Eigen::MatrixXd> b)
{
  factor.triangularView<Eigen::Lower>().solveInPlace(b);
  factor.triangularView<Eigen::Lower>().transpose().solveInPlace(b);
}
}
