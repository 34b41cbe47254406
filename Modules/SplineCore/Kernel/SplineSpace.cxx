// SPDX-License-Identifier: BSD-3-Clause
#include "SplineSpace.h"

#include "FactorPool.h"

#include <algorithm>
#include <cmath>

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

template <int Dim>
int SplineSpace<Dim>::Locate(const double* u, double* local) const
{
  if (!this->HasDomain)
  {
    return -1;
  }
  std::size_t cell = 0;
  std::size_t stride = 1;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const KnotVector& knots = this->Knots[d];
    const double slack = 1e-12 * (knots.End() - knots.Begin());
    if (!(u[d] >= knots.Begin() - slack && u[d] <= knots.End() + slack))
    {
      return -1;
    }
    const int e = knots.FindElement(u[d]);
    const double lower = knots.Breaks()[static_cast<std::size_t>(e)];
    const double upper = knots.Breaks()[static_cast<std::size_t>(e) + 1];
    local[d] = std::clamp((u[d] - lower) / (upper - lower), 0.0, 1.0);
    cell += stride * static_cast<std::size_t>(e);
    stride *= static_cast<std::size_t>(knots.NumElements());
  }
  int node = this->RootCells[cell];
  while (node < 0)
  {
    std::size_t child = 0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      // doubling and subtracting one are exact, so no error builds up over the levels
      const bool upper = local[d] >= 0.5;
      local[d] = 2.0 * local[d] - (upper ? 1.0 : 0.0);
      child |= static_cast<std::size_t>(upper) << d;
    }
    node = this->Tree[(static_cast<std::size_t>(-1 - node) << Dim) + child];
  }
  return node;
}

template <int Dim>
PointMatrix SplineSpace<Dim>::LocalCoefficients(const PointMatrixView& controlPoints) const
{
  if (this->IsIdentityMap())
  {
    return controlPoints;
  }
  PointMatrix q = PointMatrix::Zero(this->NumLocalFunctions, controlPoints.cols());
  for (int j = 0; j < this->NumLocalFunctions; ++j)
  {
    const std::size_t end = this->RowStart[static_cast<std::size_t>(j) + 1];
    for (std::size_t k = this->RowStart[static_cast<std::size_t>(j)]; k < end; ++k)
    {
      q.row(j) += this->RowCoefficient[k] * controlPoints.row(this->RowFunction[k]);
    }
  }
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
