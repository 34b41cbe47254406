// SPDX-License-Identifier: BSD-3-Clause
#include "ConstrainedProjection.h"

#include "Bernstein.h"
#include "DualFunctionals.h"

#include <Eigen/Cholesky>

#include <map>
#include <tuple>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Products of the p + 1 local functions of one direction, integrated over [0, 1].
Eigen::MatrixXd GramMatrix(int degree, const double* factor)
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

/// Changes of all local coefficients by those of the given ones.
template <int Dim>
class LocalConstraints
{
public:
  explicit LocalConstraints(const SplineSpace<Dim>& space) : Space(space) {}

  /// @param isGiven  of every local function. @return n x n: columns of others are zero.
  const Eigen::MatrixXd& Spread(int e, const std::vector<char>& isGiven)
  {
    const auto& element = this->Space.Elements[At(e)];
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
    const auto& degree = this->Space.Elements[At(e)].Degree;
    const int count = NumTensorFunctions<Dim>(degree);
    std::array<Eigen::MatrixXd, Dim> grams;
    for (int d = 0; d < Dim; ++d)
    {
      grams[At(d)] = GramMatrix(degree[At(d)], this->Space.Factor(e, d));
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
      (isGiven[At(i)] != 0 ? given : free).push_back(i);
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

/// Integral of a local function over its element, in the parameters of the domain.
template <int Dim>
double Integral(const SplineSpace<Dim>& space, int e, int local)
{
  const auto& element = space.Elements[At(e)];
  const auto index = TensorIndex<Dim>(element.Degree, local);
  double integral = 1.0;
  for (int d = 0; d < Dim; ++d)
  {
    integral *= (element.Box.Upper[At(d)] - element.Box.Lower[At(d)]) *
      IntegralsOf(element.Degree[At(d)], space.Factor(e, d))[index[At(d)]];
  }
  return integral;
}
}

template <int Dim>
Result<PointMatrix> ConstrainCoefficients(const SplineSpace<Dim>& space,
  const PointMatrix& coefficients, const std::vector<int>& functions, const PointMatrix& values)
{
  if (coefficients.rows() != space.NumFunctions || values.cols() != coefficients.cols() ||
    values.rows() != static_cast<Eigen::Index>(functions.size()))
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(coefficients.rows()) + " coefficients of " +
        std::to_string(space.NumFunctions) + " functions, " + std::to_string(values.rows()) +
        " values of " + std::to_string(functions.size()) };
  }
  std::vector<char> isGiven(At(space.NumFunctions), 0);
  PointMatrix change = PointMatrix::Zero(coefficients.rows(), coefficients.cols());
  for (std::size_t i = 0; i < functions.size(); ++i)
  {
    if (functions[i] < 0 || functions[i] >= space.NumFunctions)
    {
      return { ErrorCode::InvalidParameter,
        "there is no function " + std::to_string(functions[i]) };
    }
    isGiven[At(functions[i])] = 1;
    change.row(functions[i]) =
      values.row(static_cast<Eigen::Index>(i)) - coefficients.row(functions[i]);
  }
  LocalConstraints<Dim> constraints(space);
  PointMatrix sums = PointMatrix::Zero(coefficients.rows(), coefficients.cols());
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(coefficients.rows());
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const int count = NumTensorFunctions<Dim>(space.Elements[At(e)].Degree);
    std::vector<char> isLocal(At(count), 0);
    PointMatrix local = PointMatrix::Zero(count, coefficients.cols());
    bool isAny = false;
    for (int i = 0; i < count; ++i)
    {
      const int function = OwnFunction(space, space.LocalFunctions(e)[i]);
      if (function >= 0 && isGiven[At(function)] != 0)
      {
        isLocal[At(i)] = 1;
        local.row(i) = change.row(function);
        isAny = true;
      }
    }
    if (isAny)
    {
      local = constraints.Spread(e, isLocal) * local;
    }
    for (int i = 0; i < count; ++i)
    {
      const int function = OwnFunction(space, space.LocalFunctions(e)[i]);
      if (function >= 0)
      {
        const double weight = Integral(space, e, i);
        sums.row(function) += weight * local.row(i);
        weights[function] += weight;
      }
    }
  }
  Result<PointMatrix> result(coefficients);
  for (int f = 0; f < space.NumFunctions; ++f)
  {
    if (isGiven[At(f)] == 0 && weights[f] > 0.0)
    {
      result->row(f) += sums.row(f) / weights[f];
    }
  }
  for (std::size_t i = 0; i < functions.size(); ++i)
  {
    result->row(functions[i]) = values.row(static_cast<Eigen::Index>(i));
  }
  return result;
}

template Result<PointMatrix> ConstrainCoefficients(
  const SplineSpace<1>&, const PointMatrix&, const std::vector<int>&, const PointMatrix&);
template Result<PointMatrix> ConstrainCoefficients(
  const SplineSpace<2>&, const PointMatrix&, const std::vector<int>&, const PointMatrix&);
template Result<PointMatrix> ConstrainCoefficients(
  const SplineSpace<3>&, const PointMatrix&, const std::vector<int>&, const PointMatrix&);
}
