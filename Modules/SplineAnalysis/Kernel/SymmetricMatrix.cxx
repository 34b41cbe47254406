// SPDX-License-Identifier: BSD-3-Clause
#include "SymmetricMatrix.h"

#include <algorithm>

namespace knotwork
{
template <int Width>
SymmetricMatrix<Width>::SymmetricMatrix(const Eigen::SparseMatrix<double>& lower, int threads)
  : Lower(lower), Threads(threads)
{
  const Eigen::Index n = lower.cols();
  for (std::size_t k = 0; k < NumBlocks; ++k)
  {
    const double share =
      static_cast<double>(lower.nonZeros()) / NumBlocks * static_cast<double>(k + 1);
    Eigen::Index end = this->Ends[k];
    while (end < n && (k + 1 == NumBlocks || lower.outerIndexPtr()[end] < share))
    {
      ++end;
    }
    Eigen::Index behind = end; // of the rows that the columns have entries in
    for (Eigen::Index j = this->Ends[k]; j < end; ++j)
    {
      behind = std::max(behind, Eigen::Index{ this->Row(this->End(j) - 1) } + 1);
    }
    this->Parts[k].resize(behind - this->Ends[k], Width);
    this->Ends[k + 1] = end;
  }
}

template <int Width>
void SymmetricMatrix<Width>::Multiply(const Columns& x, Columns& y)
{
  this->ForBlocks(
    [&](std::size_t k, Eigen::Index begin, Eigen::Index end)
    {
      Columns& part = this->Parts[k];
      part.setZero();
      for (Eigen::Index j = begin; j < end; ++j)
      {
        const ColumnSums<Width> xj = x.row(j);
        int place = this->Begin(j);
        ColumnSums<Width> sum = this->Value(place) * xj; // the diagonal
        for (++place; place < this->End(j); ++place)
        {
          const Eigen::Index i = this->Row(place);
          sum += this->Value(place) * x.row(i).array();
          part.row(i - begin).array() += this->Value(place) * xj;
        }
        part.row(j - begin).array() += sum;
      }
    });
  y.resize(x.rows(), Width);
  ForSegments(x.rows(), this->Threads,
    [&](Eigen::Index first, Eigen::Index count)
    {
      y.middleRows(first, count).setZero();
      for (std::size_t k = 0; k < NumBlocks; ++k)
      {
        const Eigen::Index begin = std::max(first, this->Ends[k]);
        const Eigen::Index end = std::min(first + count, this->Ends[k] + this->Parts[k].rows());
        if (begin < end)
        {
          y.middleRows(begin, end - begin) +=
            this->Parts[k].middleRows(begin - this->Ends[k], end - begin);
        }
      }
    });
}

template <int Width>
void SymmetricMatrix<Width>::GaussSeidel(const Columns& side, Columns& x) const
{
  x = side;
  this->ForBlocks(
    [&](std::size_t, Eigen::Index begin, Eigen::Index end)
    {
      for (Eigen::Index j = begin; j < end; ++j)
      {
        const ColumnSums<Width> xj = x.row(j).array() / this->Value(this->Begin(j));
        for (int place = this->Begin(j) + 1; place < this->End(j) && this->Row(place) < end;
             ++place)
        {
          x.row(this->Row(place)).array() -= this->Value(place) * xj;
        }
      }
      for (Eigen::Index j = end; j-- > begin;)
      {
        ColumnSums<Width> sum = x.row(j);
        for (int place = this->Begin(j) + 1; place < this->End(j) && this->Row(place) < end;
             ++place)
        {
          sum -= this->Value(place) * x.row(this->Row(place)).array();
        }
        x.row(j) = sum / this->Value(this->Begin(j));
      }
    });
}

template <int Width>
template <typename Body>
void SymmetricMatrix<Width>::ForBlocks(const Body& body) const
{
  ParallelFor(NumBlocks, 1, this->Threads,
    [&](std::size_t k, std::size_t) { body(k, this->Ends[k], this->Ends[k + 1]); });
}

template class SymmetricMatrix<1>;
template class SymmetricMatrix<4>;
}
