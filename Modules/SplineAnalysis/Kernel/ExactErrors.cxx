// SPDX-License-Identifier: BSD-3-Clause
#include "ExactErrors.h"

#include "ElementRule.h"

#include <cmath>
#include <string>

namespace knotwork
{
namespace
{
/// Gradient by central differences of the fourth order, components x dimension.
void Differentiate(
  const PointFunction& function, Eigen::VectorXd x, double step, Eigen::MatrixXd& gradient)
{
  Eigen::VectorXd value = Eigen::VectorXd::Zero(gradient.rows());
  for (Eigen::Index d = 0; d < x.size(); ++d)
  {
    const double middle = x[d];
    gradient.col(d).setZero();
    for (const auto& [place, weight] :
      { std::pair(-2, 1.0), std::pair(-1, -8.0), std::pair(1, 8.0), std::pair(2, -1.0) })
    {
      x[d] = middle + place * step;
      function(x.data(), value.data());
      gradient.col(d) += weight / (12.0 * step) * value;
    }
    x[d] = middle;
  }
}
}

Result<ExactErrors> CompareWithExact(const GalerkinSpace& space, const GalerkinProblem& problem,
  const PointMatrixView& coefficients, const PointFunction& exact)
{
  constexpr double Step = 1e-3; // of an element's size
  const Eigen::Index components = coefficients.cols();
  Eigen::VectorXd value = Eigen::VectorXd::Zero(components);
  Eigen::MatrixXd gradient(components, space.Dimension);
  ExactErrors sums; // of squares
  Status status;
  RuleTables tables(1e-10, 2);
  for (int e = 0; e < space.NumElements() && status; ++e)
  {
    tables.Visit(space, e,
      [&](std::size_t q, const PointValues& at)
      {
        exact(at.Position.data(), value.data());
        const double size = std::pow(std::abs(at.Determinant), 1.0 / space.Dimension);
        Differentiate(exact, at.Position, Step * size, gradient);
        if (!value.allFinite() || !gradient.allFinite())
        {
          std::string place;
          for (const double x : at.Position)
          {
            place += (place.empty() ? "(" : ", ") + std::to_string(x);
          }
          status = { ErrorCode::NonFiniteInput,
            "the exact solution is no number at or near " + place + "); mend its expression" };
        }
        const double weight = tables.Weights[q] * std::abs(at.Determinant);
        sums.Size.L2 += weight * value.squaredNorm();
        sums.Size.H1 += weight * gradient.squaredNorm();
        sums.EnergySize += weight * 2.0 * EnergyDensity(problem, e, gradient);
        for (int a = 0; a < space.NumAlive(e); ++a)
        {
          const auto row = coefficients.row(space.Alive(e)[a]);
          value -= at.Values[a] * row.transpose();
          gradient -= row.transpose() * at.Gradients.row(a);
        }
        sums.Error.L2 += weight * value.squaredNorm();
        sums.Error.H1 += weight * gradient.squaredNorm();
        sums.EnergyError += weight * 2.0 * EnergyDensity(problem, e, gradient);
      });
  }
  if (!status)
  {
    return status;
  }
  for (double* sum : { &sums.Error.L2, &sums.Error.H1, &sums.Size.L2, &sums.Size.H1,
         &sums.EnergyError, &sums.EnergySize })
  {
    *sum = std::sqrt(*sum);
  }
  return sums;
}
}
