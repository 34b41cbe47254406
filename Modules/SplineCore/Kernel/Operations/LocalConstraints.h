// SPDX-License-Identifier: BSD-3-Clause
// L2 projections on elements with given coefficients, private to the kernel.
#pragma once
#include "Bernstein.h"
#include "DualFunctionals.h"

#include <Eigen/Cholesky>

#include <map>
#include <tuple>

namespace knotwork
{
/// Products of the p + 1 local functions of one direction, integrated over [0, 1].
inline Eigen::MatrixXd GramMatrix(int degree, const double* factor)
{
  Eigen::MatrixXd gram(degree + 1, degree + 1);
  for (int j = 0; j <= degree; ++j)
  {
    for (int k = 0; k <= degree; ++k)
    {
      gram(j, k) = Binomial(degree, j) * Binomial(degree, k) /
        ((2.0 * degree + 1.0) * Binomial(2 * degree, j + k));
    }
  }
  if (!factor)
  {
    return gram;
  }
  const Eigen::Map<const PointMatrix> rows(factor, degree + 1, degree + 1);
  return rows * gram * rows.transpose();
}

/// Changes of all local coefficients by those of given ones: the others change such that the
/// polynomials on the element are the nearest in L2 to what they were.
template <int Dim>
class LocalConstraints
{
public:
  explicit LocalConstraints(const SplineSpace<Dim>& space) : Space(space) {}

  /// @param isGiven  of every local function. @return n x n: columns of others are zero.
  const Eigen::MatrixXd& Spread(int e, const std::vector<char>& isGiven)
  {
    const auto& element = this->Space.Elements[static_cast<std::size_t>(e)];
    auto [found, isNew] = this->Matrices.try_emplace({ element.Degree, element.Factor, isGiven });
    if (isNew)
    {
      found->second = this->Make(e, isGiven);
    }
    return found->second;
  }

private:
  Eigen::MatrixXd Make(int e, const std::vector<char>& isGiven) const
  {
    const auto& degree = this->Space.Elements[static_cast<std::size_t>(e)].Degree;
    const int count = NumTensorFunctions<Dim>(degree);
    std::array<Eigen::MatrixXd, Dim> grams;
    for (int d = 0; d < Dim; ++d)
    {
      grams[static_cast<std::size_t>(d)] =
        GramMatrix(degree[static_cast<std::size_t>(d)], this->Space.Factor(e, d));
    }
    const auto product = [&](int i, int j)
    {
      const auto a = TensorIndex<Dim>(degree, i);
      const auto b = TensorIndex<Dim>(degree, j);
      double value = 1.0;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        value *= grams[d](a[d], b[d]);
      }
      return value;
    };
    std::vector<int> given;
    std::vector<int> free;
    for (int i = 0; i < count; ++i)
    {
      (isGiven[static_cast<std::size_t>(i)] != 0 ? given : free).push_back(i);
    }
    Eigen::MatrixXd own(free.size(), free.size());
    Eigen::MatrixXd across(free.size(), given.size());
    for (std::size_t i = 0; i < free.size(); ++i)
    {
      for (std::size_t j = 0; j < free.size(); ++j)
      {
        own(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = product(free[i], free[j]);
      }
      for (std::size_t j = 0; j < given.size(); ++j)
      {
        across(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          product(free[i], given[j]);
      }
    }
    Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(count, count);
    for (const int i : given)
    {
      spread(i, i) = 1.0;
    }
    if (!free.empty())
    {
      spread(free, given) = -own.llt().solve(across);
    }
    return spread;
  }

  const SplineSpace<Dim>& Space;
  std::map<std::tuple<IntArray<Dim>, IntArray<Dim>, std::vector<char>>, Eigen::MatrixXd> Matrices;
};
}
