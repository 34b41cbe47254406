// SPDX-License-Identifier: BSD-3-Clause
#include "AffineMap.h"

#include <Eigen/QR>

namespace knotwork
{
Result<AffineMap> FitAffineMap(const PointMatrix& from, const PointMatrix& to)
{
  if (from.rows() != to.rows() || from.cols() != 3 || to.cols() != 3)
  {
    return { ErrorCode::SizeMismatch,
      "points of three coordinates, as many as images: there are " + std::to_string(from.rows()) +
        " x " + std::to_string(from.cols()) + " and " + std::to_string(to.rows()) + " x " +
        std::to_string(to.cols()) };
  }
  if (from.rows() == 0)
  {
    return { ErrorCode::EmptyInput, "there are no points" };
  }
  if (!from.allFinite() || !to.allFinite())
  {
    return { ErrorCode::NonFiniteInput, "points or images" };
  }
  const Eigen::RowVector3d center = from.colwise().mean();
  const Eigen::RowVector3d image = to.colwise().mean();
  const Eigen::MatrixXd arms = from.rowwise() - center;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-9);
  solver.compute(arms);
  AffineMap map;
  map.Linear = solver.solve(Eigen::MatrixXd(to.rowwise() - image));
  map.Shift = image - center * map.Linear;
  map.MaxResidual = (map.Apply(from) - to).rowwise().norm().maxCoeff();
  return map;
}
}
