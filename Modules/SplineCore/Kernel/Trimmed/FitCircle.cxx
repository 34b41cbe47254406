// SPDX-License-Identifier: BSD-3-Clause
#include "FitCircle.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double Turn = 2.0 * 3.14159265358979323846;
}

Eigen::Vector3d CircularArc::Point(double share) const
{
  const double angle = this->Begin + share * this->Sweep;
  return this->Centre + std::cos(angle) * this->X + std::sin(angle) * this->Y;
}

double CircularArc::AngleOf(const Eigen::Vector3d& point) const
{
  const Eigen::Vector3d offset = point - this->Centre;
  return std::atan2(offset.dot(this->Y), offset.dot(this->X));
}

double CircularArc::Distance(const Eigen::Vector3d& point) const
{
  const Eigen::Vector3d offset = point - this->Centre;
  const double across = offset.dot(this->X.cross(this->Y).normalized());
  const double out = std::sqrt(std::max(0.0, offset.squaredNorm() - across * across));
  return std::hypot(across, out - this->Radius());
}

bool FitCircle(const std::vector<Eigen::Vector3d>& points, CircularArc& arc)
{
  constexpr double flattest = 1e3;   // radius by the points' extent
  constexpr double straight = 1e-14; // of the variances along and across a line
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points)
  {
    centre += point / static_cast<double>(n);
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points)
  {
    spread += (point - centre) * (point - centre).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const Eigen::Vector3d x = axes.eigenvectors().col(2);
  const Eigen::Vector3d y = axes.eigenvectors().col(1);
  const double extent = std::sqrt(axes.eigenvalues()[2] / static_cast<double>(n));
  if (n < 3 || !(axes.eigenvalues()[1] > straight * axes.eigenvalues()[2]))
  {
    return false;
  }
  Eigen::MatrixXd left(n, 3);
  Eigen::VectorXd right(n);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const Eigen::Vector3d offset = (points[static_cast<std::size_t>(i)] - centre) / extent;
    const double a = offset.dot(x);
    const double b = offset.dot(y);
    left.row(i) << 2.0 * a, 2.0 * b, 1.0;
    right[i] = a * a + b * b;
  }
  const Eigen::Vector3d solved = left.colPivHouseholderQr().solve(right);
  const double radius =
    extent * std::sqrt(solved[0] * solved[0] + solved[1] * solved[1] + solved[2]);
  if (!(radius < flattest * extent))
  {
    return false;
  }
  arc.Centre = centre + extent * (solved[0] * x + solved[1] * y);
  arc.X = radius * x;
  arc.Y = radius * y;
  arc.Begin = arc.AngleOf(points.front());
  double last = arc.Begin;
  for (const Eigen::Vector3d& point : points)
  {
    const double next = arc.AngleOf(point);
    last = next + Turn * std::round((last - next) / Turn);
  }
  arc.Sweep = last - arc.Begin;
  if (points.front() == points.back())
  {
    arc.Sweep = arc.Sweep < 0.0 ? -Turn : Turn;
  }
  return true;
}
}
