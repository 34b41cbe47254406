// SPDX-License-Identifier: BSD-3-Clause
#include "PlaneParameters.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace knotwork
{
namespace
{
constexpr double Flat = 1e-10; ///< ratio of standard deviations below which points are on a line
constexpr double Rounding = 4e-15; ///< of coordinates, relative to the largest

/// Direction of the largest variance around the origin, its largest entry positive; RMS distance
/// along it.
std::pair<Eigen::Vector3d, double> LongestDirection(const PointMatrix& local)
{
  const Eigen::Matrix3d covariance = local.transpose() * local / static_cast<double>(local.rows());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  Eigen::Vector3d axis = solver.eigenvectors().col(2); // eigenvalues ascend
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  axis *= axis[largest] > 0.0 ? 1.0 : -1.0;
  return { axis, std::sqrt(std::max(0.0, solver.eigenvalues()[2])) };
}
}

Result<PointMatrix> PlaneParameters(const PointMatrix& points)
{
  if (points.rows() < 3)
  {
    return { ErrorCode::EmptyInput,
      std::to_string(points.rows()) + " points; three make a plane to project on" };
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    if (!points.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput, "point " + std::to_string(i) };
    }
  }
  const Eigen::RowVector3d middle = points.colwise().mean();
  PointMatrix local = points.rowwise() - middle;
  // Two steps: the variances of one matrix are off by rounding of the largest, which hides the
  // width of a strip.
  const auto [along, length] = LongestDirection(local);
  const PointMatrix rest = local - (local * along) * along.transpose();
  const auto [across, width] = LongestDirection(rest);
  if (!(width > Flat * length + Rounding * points.cwiseAbs().maxCoeff()))
  {
    return { ErrorCode::SingularSystem,
      "the points lie on a line; there is no plane to project them on" };
  }
  Eigen::Matrix3d axes;
  axes.col(0) = along;
  axes.col(1) = (across - along.dot(across) * along).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return PointMatrix((local * axes).leftCols<2>());
}
}
