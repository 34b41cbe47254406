// SPDX-License-Identifier: BSD-3-Clause
#include "PlaneParameters.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <vector>

namespace knotwork
{
namespace
{
constexpr Eigen::Index PointsOfCell = 16;
constexpr Eigen::Index FewestPoints = 6; ///< of a cell that is judged: twice those of a plane
constexpr double ShareOfLayers = 0.05;
constexpr double Flat = 1e-10; ///< ratio of standard deviations below which points are on a line
constexpr double Rounding = 4e-15; ///< of coordinates, relative to the largest

/// RMS distance of heights over the plane from a plane of their own.
double Roughness(const PointMatrix& local, const std::vector<Eigen::Index>& rows)
{
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd a(n, 3);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const auto row = local.row(rows[static_cast<std::size_t>(i)]);
    a.row(i) << 1.0, row[0], row[1];
    b[i] = row[2];
  }
  a.col(1).array() -= a.col(1).mean();
  a.col(2).array() -= a.col(2).mean();
  const Eigen::VectorXd residual = b - a * a.colPivHouseholderQr().solve(b);
  return std::sqrt(residual.squaredNorm() / static_cast<double>(n));
}

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

/// Share of the cells in which points lie in layers.
/// @param local  n x 3: parameters and heights.
double LayeredShare(const PointMatrix& local)
{
  const Eigen::RowVector2d lower = local.leftCols<2>().colwise().minCoeff();
  const Eigen::RowVector2d size = local.leftCols<2>().colwise().maxCoeff() - lower;
  const double cells =
    std::max(1.0, static_cast<double>(local.rows()) / static_cast<double>(PointsOfCell));
  const double side = std::max(std::sqrt(size[0] * size[1] / cells), size.maxCoeff() / cells);
  const auto columns = static_cast<Eigen::Index>(size[0] / side) + 1;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> order; // cell, point
  for (Eigen::Index i = 0; i < local.rows(); ++i)
  {
    const auto column = static_cast<Eigen::Index>((local(i, 0) - lower[0]) / side);
    const auto row = static_cast<Eigen::Index>((local(i, 1) - lower[1]) / side);
    order.emplace_back(column + columns * row, i);
  }
  std::sort(order.begin(), order.end());
  int judged = 0;
  int layered = 0;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    rows.push_back(order[i].second);
    if (i + 1 < order.size() && order[i + 1].first == order[i].first)
    {
      continue;
    }
    if (static_cast<Eigen::Index>(rows.size()) >= FewestPoints)
    {
      ++judged;
      layered += Roughness(local, rows) > side ? 1 : 0;
    }
    rows.clear();
  }
  return judged == 0 ? 0.0 : static_cast<double>(layered) / judged;
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
  local *= axes;
  const double share = LayeredShare(local);
  if (share > ShareOfLayers)
  {
    return { ErrorCode::NotInSpace,
      "the points lie in layers over their plane of least squares (in " +
        std::to_string(static_cast<int>(std::lround(100.0 * share))) +
        " % of its cells), where a projection folds; mesh the scan and `trim` it, or give "
        "parameters" };
  }
  return PointMatrix(local.leftCols<2>());
}
}
