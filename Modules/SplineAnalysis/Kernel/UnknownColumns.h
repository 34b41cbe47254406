// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Core>

#include <vector>

/// Columns of numbers, a row an unknown, that are worked on together: the matrix is read once for
/// all. Sums are those of chunks, in order, so their bits do not depend on the number of threads.
namespace knotwork
{
template <int Width>
using UnknownColumns =
  Eigen::Matrix<double, Eigen::Dynamic, Width, Width == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
template <int Width>
using ColumnSums = Eigen::Array<double, 1, Width>;

/// Calls for segments of rows.
template <typename Body>
void ForSegments(Eigen::Index size, int threads, const Body& body)
{
  constexpr std::size_t Chunk = 4096;
  ParallelFor(static_cast<std::size_t>(size), Chunk, threads,
    [&](std::size_t begin, std::size_t end)
    { body(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin)); });
}

/// Of each column with its own.
template <int Width>
ColumnSums<Width> Dot(const UnknownColumns<Width>& a, const UnknownColumns<Width>& b, int threads)
{
  constexpr Eigen::Index Chunk = 4096;
  std::vector<ColumnSums<Width>> sums(static_cast<std::size_t>((a.rows() + Chunk - 1) / Chunk));
  ForSegments(a.rows(), threads,
    [&](Eigen::Index first, Eigen::Index count)
    {
      sums[static_cast<std::size_t>(first / Chunk)] =
        a.middleRows(first, count).cwiseProduct(b.middleRows(first, count)).colwise().sum();
    });
  ColumnSums<Width> sum = ColumnSums<Width>::Zero();
  for (const ColumnSums<Width>& part : sums)
  {
    sum += part;
  }
  return sum;
}
}
