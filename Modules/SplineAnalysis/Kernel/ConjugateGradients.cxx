// SPDX-License-Identifier: BSD-3-Clause
#include "ConjugateGradients.h"

#include <knotwork/SplineCore/Numbers.h>

#include <cmath>

namespace knotwork
{
template <int Width>
Status Iterate(SymmetricMatrix<Width>& matrix, Preconditioner<Width>& preconditioner,
  const IterationLimits& limits, int threads, UnknownColumns<Width>& x, int& iterations)
{
  using Columns = UnknownColumns<Width>;
  using Sums = ColumnSums<Width>;
  Columns residual = x;
  x.setZero();
  Sums norm = Dot<Width>(residual, residual, threads).sqrt();
  const Sums start = norm;
  const Sums goal = limits.Tolerance * start;
  Columns step;
  Columns product;
  preconditioner.Apply(residual, product);
  Columns way = product;
  Sums slope = Dot<Width>(residual, product, threads);
  for (iterations = 0; (norm > goal).any() && iterations < limits.Iterations; ++iterations)
  {
    // columns that are done stay as they are
    const auto ofOthers = [&norm, &goal](const Sums& values) -> Sums
    { return (norm > goal).select(values, 0.0); };
    matrix.Multiply(way, product);
    const Sums length = ofOthers(slope / Dot<Width>(way, product, threads));
    ForSegments(x.rows(), threads,
      [&](Eigen::Index first, Eigen::Index count)
      {
        x.middleRows(first, count) += way.middleRows(first, count) * length.matrix().asDiagonal();
        residual.middleRows(first, count) -=
          product.middleRows(first, count) * length.matrix().asDiagonal();
      });
    norm = Dot<Width>(residual, residual, threads).sqrt();
    if (!norm.isFinite().all())
    {
      break;
    }
    preconditioner.Apply(residual, step);
    const Sums next = Dot<Width>(residual, step, threads);
    const Sums keep = ofOthers(next / slope);
    slope = next;
    ForSegments(x.rows(), threads,
      [&](Eigen::Index first, Eigen::Index count)
      {
        way.middleRows(first, count) =
          step.middleRows(first, count) + way.middleRows(first, count) * keep.matrix().asDiagonal();
      });
  }
  if (!(norm <= goal).all())
  {
    Eigen::Index worst = 0;
    (norm - goal).maxCoeff(&worst);
    return { ErrorCode::NotConverged,
      "conjugate gradients stopped after " + std::to_string(iterations) +
        " iterations at a residual of " + Digits(norm[worst] / start[worst]) +
        "; raise the limit of factorization" };
  }
  return {};
}

template Status Iterate<1>(
  SymmetricMatrix<1>&, Preconditioner<1>&, const IterationLimits&, int, UnknownColumns<1>&, int&);
template Status Iterate<4>(
  SymmetricMatrix<4>&, Preconditioner<4>&, const IterationLimits&, int, UnknownColumns<4>&, int&);
}
