// SPDX-License-Identifier: BSD-3-Clause
#include "SplineSpace.h"

#include "FactorPool.h"
#include "Parallel.h"
#include "SpaceFamily.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace knotwork
{
template <int Dim>
ParametricBox<Dim> SplineSpace<Dim>::Domain() const
{
  ParametricBox<Dim> box;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    box.Lower[d] = this->Knots[d].Begin();
    box.Upper[d] = this->Knots[d].End();
  }
  return box;
}

namespace
{
constexpr std::size_t RowChunk = 4096;
}

template <int Dim>
void SplineSpace<Dim>::Locate(
  const double* u, std::ptrdiff_t stride, std::size_t n, int* elements, double* local) const
{
  FamilyOf(*this).Locate(*this, u, stride, n, elements, local);
}

template <int Dim>
int SplineSpace<Dim>::Locate(const double* u, double* local) const
{
  int element = -1;
  this->Locate(u, Dim, 1, &element, local);
  return element;
}

template <int Dim>
PointMatrix SplineSpace<Dim>::LocalCoefficients(
  const PointMatrixView& controlPoints, int threads) const
{
  if (this->IsIdentityMap())
  {
    return controlPoints;
  }
  PointMatrix q(this->NumLocalFunctions, controlPoints.cols());
  const auto apply = [&](auto columns, std::size_t begin, std::size_t end)
  {
    constexpr int C = decltype(columns)::value; // 0: any number
    const Eigen::Index c = C > 0 ? C : controlPoints.cols();
    for (std::size_t j = begin; j < end; ++j)
    {
      double* sum = q.data() + static_cast<Eigen::Index>(j) * c;
      std::fill_n(sum, c, 0.0);
      for (std::size_t k = this->RowStart[j]; k < this->RowStart[j + 1]; ++k)
      {
        const double w = this->RowCoefficient[k];
        const double* point =
          controlPoints.data() + controlPoints.outerStride() * this->RowFunction[k];
        for (Eigen::Index i = 0; i < c; ++i)
        {
          sum[i] += w * point[i];
        }
      }
    }
  };
  ParallelFor(static_cast<std::size_t>(this->NumLocalFunctions), RowChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      switch (q.cols())
      {
        case 1:
          return apply(std::integral_constant<int, 1>(), begin, end);
        case 3:
          return apply(std::integral_constant<int, 3>(), begin, end);
        case 4:
          return apply(std::integral_constant<int, 4>(), begin, end);
        default:
          return apply(std::integral_constant<int, 0>(), begin, end);
      }
    });
  return q;
}

template <int Dim>
std::vector<int> SplineSpace<Dim>::AliveFunctions(int e) const
{
  const int n = NumTensorFunctions<Dim>(this->Elements[static_cast<std::size_t>(e)].Degree);
  const int* ids = this->LocalFunctions(e);
  std::vector<int> alive;
  for (int i = 0; i < n; ++i)
  {
    if (this->IsIdentityMap())
    {
      alive.push_back(ids[i]);
      continue;
    }
    const std::size_t row = static_cast<std::size_t>(ids[i]);
    alive.insert(alive.end(),
      this->RowFunction.begin() + static_cast<std::ptrdiff_t>(this->RowStart[row]),
      this->RowFunction.begin() + static_cast<std::ptrdiff_t>(this->RowStart[row + 1]));
  }
  std::sort(alive.begin(), alive.end());
  alive.erase(std::unique(alive.begin(), alive.end()), alive.end());
  return alive;
}

template <int Dim>
Eigen::MatrixXd SplineSpace<Dim>::ExtractionOperator(int e) const
{
  const IntArray<Dim>& degree = this->Elements[static_cast<std::size_t>(e)].Degree;
  const int n = NumTensorFunctions<Dim>(degree);
  const int* ids = this->LocalFunctions(e);
  const std::vector<int> alive = this->AliveFunctions(e);
  const auto position = [&](int function)
  { return std::lower_bound(alive.begin(), alive.end(), function) - alive.begin(); };
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(alive.size()), n);
  for (int i = 0; i < n; ++i)
  {
    if (this->IsIdentityMap())
    {
      rows(position(ids[i]), i) += 1.0;
      continue;
    }
    const std::size_t row = static_cast<std::size_t>(ids[i]);
    for (std::size_t k = this->RowStart[row]; k < this->RowStart[row + 1]; ++k)
    {
      rows(position(this->RowFunction[k]), i) += this->RowCoefficient[k];
    }
  }
  // the local functions' Bernstein coefficients: Kronecker product of the 1D operators
  Eigen::MatrixXd bernstein = Eigen::MatrixXd::Ones(n, n);
  int stride = 1;
  for (int d = 0; d < Dim; ++d)
  {
    const int m = degree[static_cast<std::size_t>(d)] + 1;
    const double* factor = this->Factor(e, d);
    for (int i = 0; i < n; ++i)
    {
      for (int k = 0; k < n; ++k)
      {
        const int a = i / stride % m;
        const int b = k / stride % m;
        bernstein(i, k) *= factor ? factor[a * m + b] : (a == b ? 1.0 : 0.0);
      }
    }
    stride *= m;
  }
  return rows * bernstein;
}

int FactorPool::Add(int degree, const double* matrix)
{
  const std::size_t n = static_cast<std::size_t>((degree + 1) * (degree + 1));
  std::vector<std::int64_t> key(n + 1);
  key[n] = degree;
  bool identity = true;
  for (std::size_t i = 0; i < n; ++i)
  {
    key[i] = std::llround(matrix[i] * 1e13);
    const bool diagonal = i % static_cast<std::size_t>(degree + 2) == 0;
    identity = identity && key[i] == (diagonal ? 10000000000000 : 0);
  }
  if (identity)
  {
    return -1;
  }
  const auto [position, isNew] =
    this->Offsets.try_emplace(key, static_cast<int>(this->Data.size()));
  if (isNew)
  {
    this->Data.insert(this->Data.end(), matrix, matrix + n);
  }
  return position->second;
}

template class SplineSpace<1>;
template class SplineSpace<2>;
template class SplineSpace<3>;
}
